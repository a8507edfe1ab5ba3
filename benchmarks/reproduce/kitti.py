"""KITTI: ground truth and recognised places."""

import numpy as np

import planar

# Loops made from ground truth: metres and radians.
SIGMA = np.array([0.1, 0.1, 0.01])
NEAR = 5.0  # metres between frames that show the same place, as in the candidate lists


def true_poses(data, sequence):
    """Ground truth in the frame of the pose graphs: x forward, y to the left."""
    rows = np.loadtxt(data / "paper" / "kitti" / f"poses_{sequence}.txt")[:, 1:]
    camera = rows.reshape(-1, 3, 4)
    heading = np.arctan2(-camera[:, 0, 2], camera[:, 2, 2])
    return np.column_stack([camera[:, 2, 3], -camera[:, 0, 3], heading])


def edges(data, sequence):
    return planar.read_edges(data / "paper" / "kitti" / f"kitti_{sequence}.g2o")


def recognised_places(data, sequence, candidates, seed):
    """Odometry, and loops from the best `candidates` of every place-recognition query.

    Transforms of true pairs come from ground truth with noise; false pairs claim to be
    one place, near the identity (0.3 m, 10 degrees).
    """
    random = np.random.default_rng(seed)
    truth = true_poses(data, sequence)
    rows = np.loadtxt(data / "paper" / "kitti" / f"ssc_top25_{sequence}.txt", dtype=int)
    information = tuple(np.diag(SIGMA ** -2)[np.triu_indices(3)])
    result = [edge for edge in edges(data, sequence) if edge.is_odometry()]
    for query, *found in rows[:, :1 + candidates]:
        for frame in found:
            same = np.linalg.norm(truth[query, :2] - truth[frame, :2]) < NEAR
            if same:
                pose = planar.compose(planar.between(truth[query], truth[frame]),
                                      random.normal(0.0, SIGMA))
            else:
                pose = random.normal(0.0, [0.3, 0.3, np.deg2rad(10.0)])
            pose[2] = planar.wrap(pose[2])
            result.append(planar.Edge(int(query), int(frame), pose, information))
    return result
