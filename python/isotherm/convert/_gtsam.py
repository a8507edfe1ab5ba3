"""Factor graphs of GTSAM."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from isotherm.convert._needed import needed
from isotherm.slam import PoseGraph, PruneResult

# GTSAM's tangent vectors in space begin with the rotation.
_OUR_ORDER = np.array([3, 4, 5, 0, 1, 2])


@dataclass(frozen=True)
class GtsamGraph:
    """A pose graph, and the factor graph that it is of."""

    pose_graph: PoseGraph
    """Its edges are the factors between two poses."""

    factors: NDArray[np.int64]
    """The place in the factor graph of each edge."""

    factor_graph: Any
    """The NonlinearFactorGraph."""

    def keep(self, result: PruneResult, *, keep_ambiguous: bool = False) -> Any:
        """The factor graph without the loops that are pruned and, unless keep_ambiguous, without
        those that are ambiguous. All other factors, priors among them, stay as they are."""
        gtsam = needed("gtsam", "keep")
        verdicts = result.verdicts
        leave = verdicts.pruned if keep_ambiguous else ~verdicts.kept
        left_out = set(self.factors[verdicts.edge[leave]].tolist())
        kept = gtsam.NonlinearFactorGraph()
        for place in range(self.factor_graph.size()):
            if place not in left_out:
                kept.add(self.factor_graph.at(place))
        return kept

    def values(self, poses: ArrayLike) -> Any:
        """Values of GTSAM with these poses, n x 3 or n x 7."""
        return _values_of(self.pose_graph.ids, np.asarray(poses))


def _row2(pose: Any) -> list[float]:
    return [pose.x(), pose.y(), pose.theta()]


def _row3(pose: Any) -> list[float]:
    q = pose.rotation().toQuaternion()
    return [*pose.translation(), q.x(), q.y(), q.z(), q.w()]


def _pose_of(row: NDArray[np.float64]) -> Any:
    gtsam = needed("gtsam", "to_gtsam")
    if len(row) == 3:
        return gtsam.Pose2(*row)
    x, y, z, w = row[3:]
    return gtsam.Pose3(gtsam.Rot3.Quaternion(w, x, y, z), row[:3])


def _values_of(ids: NDArray[np.uint64], poses: NDArray[np.float64]) -> Any:
    values = needed("gtsam", "to_gtsam").Values()
    for key, row in zip(ids.tolist(), poses, strict=True):
        values.insert(key, _pose_of(row))
    return values


def _information(factor: Any, spatial: bool) -> NDArray[np.float64]:
    noise = factor.noiseModel()
    noise = noise.noise() if hasattr(noise, "noise") else noise  # below a robust one
    matrix = np.asarray(noise.information())
    return matrix[np.ix_(_OUR_ORDER, _OUR_ORDER)] if spatial else matrix


def _between(factor_graph: Any, kind: type) -> list[tuple[int, Any]]:
    places = range(factor_graph.size())
    factors = [(place, factor_graph.at(place)) for place in places if factor_graph.exists(place)]
    return [(place, factor) for place, factor in factors if isinstance(factor, kind)]


def _poses(ids: NDArray[np.uint64], get: Callable[[int], Any], row: Callable[[Any], list[float]]) -> Any:
    return np.array([row(get(key)) for key in ids.tolist()])


def from_gtsam(factor_graph: Any, values: Any = None) -> GtsamGraph:
    """The pose graph of a NonlinearFactorGraph's factors between two poses.

        graph = from_gtsam(factor_graph, values)
        result = slam.prune(graph.pose_graph)
        pruned = graph.keep(result)

    Keys are ids: odometry is what joins neighbours in their order, a robot (letter) at a time.
    A robust noise model counts as what it is around.

    Args:
        factor_graph: with BetweenFactorPose2 or BetweenFactorPose3, not both; others are kept.
        values: poses, if they are known.
    """
    gtsam = needed("gtsam", "from_gtsam")
    plane = _between(factor_graph, gtsam.BetweenFactorPose2)
    space = _between(factor_graph, gtsam.BetweenFactorPose3)
    if bool(plane) == bool(space):
        raise ValueError("factor_graph: expected factors between poses, of the plane or of space")
    spatial, row = bool(space), _row3 if space else _row2
    factors = space or plane
    keys = np.array([list(factor.keys()) for _, factor in factors], dtype=np.uint64)
    ids, ends = np.unique(keys, return_inverse=True)
    poses = None
    if values is not None and all(values.exists(key) for key in ids.tolist()):
        poses = _poses(ids, values.atPose3 if spatial else values.atPose2, row)
    pose_graph = PoseGraph(
        ends.reshape(-1, 2),
        [row(factor.measured()) for _, factor in factors],
        np.array([_information(factor, spatial) for _, factor in factors]),
        poses=poses,
        ids=ids,
    )
    return GtsamGraph(pose_graph, np.array([place for place, _ in factors]), factor_graph)


def to_gtsam(graph: PoseGraph) -> tuple[Any, Any]:
    """A NonlinearFactorGraph with a factor an edge, in order, and the poses as Values (those of
    chained odometry where the graph has none). There is no prior: GTSAM wants one."""
    gtsam = needed("gtsam", "to_gtsam")
    spatial = graph.dimension == 3
    kind = gtsam.BetweenFactorPose3 if spatial else gtsam.BetweenFactorPose2
    theirs = np.argsort(_OUR_ORDER)
    factors = gtsam.NonlinearFactorGraph()
    columns = zip(graph.ids[graph.edges].tolist(), graph.measurements, graph.information, strict=True)
    for (first, second), measured, information in columns:
        matrix = information[np.ix_(theirs, theirs)] if spatial else information
        noise = gtsam.noiseModel.Gaussian.Information(np.array(matrix))
        factors.add(kind(first, second, _pose_of(measured), noise))
    poses = graph.odometry_poses() if graph.poses is None else graph.poses
    return factors, _values_of(graph.ids, poses)
