"""Trajectories of evo."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from isotherm.convert._needed import needed


def _in_space(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses of the plane as those of space, n x 7."""
    if poses.ndim != 2 or poses.shape[1] not in (3, 7):
        raise ValueError(f"poses: expected an array of shape (n, 3) or (n, 7), got {poses.shape}")
    if poses.shape[1] == 7:
        return poses
    rows = np.zeros((len(poses), 7))
    rows[:, :2] = poses[:, :2]
    rows[:, 5] = np.sin(poses[:, 2] / 2)
    rows[:, 6] = np.cos(poses[:, 2] / 2)
    return rows


def to_evo(poses: ArrayLike, timestamps: ArrayLike | None = None) -> Any:
    """A PosePath3D of evo, or, with times in seconds, a PoseTrajectory3D.

    Args:
        poses: n x 3 or n x 7; the plane becomes z = 0.
        timestamps: n.
    """
    trajectory = needed("evo.core.trajectory", "to_evo")
    rows = _in_space(np.asarray(poses, dtype=np.float64))
    places, quaternions = rows[:, :3], rows[:, [6, 3, 4, 5]]
    if timestamps is None:
        return trajectory.PosePath3D(places, quaternions)
    return trajectory.PoseTrajectory3D(places, quaternions, np.asarray(timestamps, dtype=np.float64))


def from_evo(path: Any) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Poses (n x 7) and times, if it has some, of a trajectory of evo."""
    quaternions = np.asarray(path.orientations_quat_wxyz)
    rows = np.concatenate([path.positions_xyz, quaternions[:, [1, 2, 3, 0]]], axis=1)
    return rows, getattr(path, "timestamps", None)
