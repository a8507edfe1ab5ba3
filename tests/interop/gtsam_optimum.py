"""The optimum of `isotherm optimize` is GTSAM's, from the same start.

Chi-squared to 1e-6 (relative) and poses to 1e-4 m and rad; prints the times of
both Levenberg-Marquardt optimisers with their default settings.

usage: gtsam_optimum.py ISOTHERM DATASET...
"""

import os
import sys
import tempfile
import time

from isotherm_run import SKIP, data_or_skip, run_json

try:
    import gtsam
    import numpy as np
except ImportError:
    print("gtsam is not installed; see scripts/python-env.sh")
    sys.exit(SKIP)

FILES = {
    "intel": "posegraph2d/intel/intel.g2o",
    "kitti_00": "paper/kitti/kitti_00.g2o",
    "city10000": "posegraph2d/city10000/city10000.g2o",
    "sphere2500": "posegraph3d/sphere2500/sphere2500.g2o",
    "torus3D": "posegraph3d/torus3D/torus3D.g2o.gz",
    "parking-garage": "posegraph3d/parking-garage/parking-garage.g2o",
}
CHI2_TOLERANCE = 1e-6
POSE_TOLERANCE = 1e-4


def pose_of(fields):
    if len(fields) == 3:
        return gtsam.Pose2(*fields)
    x, y, z, qx, qy, qz, qw = fields[:3] + list(np.array(fields[3:]) / np.linalg.norm(fields[3:]))
    return gtsam.Pose3(gtsam.Rot3.Quaternion(qw, qx, qy, qz), np.array([x, y, z]))


def information_of(upper, dof):
    matrix = np.zeros((dof, dof))
    matrix[np.triu_indices(dof)] = upper
    matrix += np.triu(matrix, 1).T
    if dof == 6:  # GTSAM puts rotation first
        order = [3, 4, 5, 0, 1, 2]
        matrix = matrix[np.ix_(order, order)]
    return matrix


def read_g2o(path):
    """Vertex poses and edges (from, to, pose, information) in GTSAM's types. Edges that repeat
    another one to the last digit count once, as they do for Isotherm."""
    poses, edges, known = {}, [], set()
    with open(path, encoding="utf-8") as file:
        for line in file:
            tag, *rest = line.split()
            if tag in ("VERTEX_SE2", "VERTEX_SE3:QUAT"):
                poses[int(rest[0])] = pose_of([float(v) for v in rest[1:]])
            elif tag in ("EDGE_SE2", "EDGE_SE3:QUAT") and tuple(rest) not in known:
                known.add(tuple(rest))
                size, dof = (3, 3) if tag == "EDGE_SE2" else (7, 6)
                values = [float(v) for v in rest[2:]]
                information = information_of(values[size:], dof)
                edges.append((int(rest[0]), int(rest[1]), pose_of(values[:size]), information))
    return poses, edges


def factor_graph(poses, edges):
    """The edges, and a prior that only fixes the gauge at the first pose."""
    graph = gtsam.NonlinearFactorGraph()
    spatial = isinstance(edges[0][2], gtsam.Pose3)
    between = gtsam.BetweenFactorPose3 if spatial else gtsam.BetweenFactorPose2
    prior = gtsam.PriorFactorPose3 if spatial else gtsam.PriorFactorPose2
    for i, j, pose, information in edges:
        graph.add(between(i, j, pose, gtsam.noiseModel.Gaussian.Information(information)))
    first = min(poses)
    dof = 6 if spatial else 3
    graph.add(prior(first, poses[first], gtsam.noiseModel.Isotropic.Sigma(dof, 1e-3)))
    return graph


def values_of(poses):
    values = gtsam.Values()
    for key, pose in poses.items():
        values.insert(key, pose)
    return values


def gtsam_optimum(graph, start, tolerance):
    """(values, seconds) of GTSAM's Levenberg-Marquardt."""
    parameters = gtsam.LevenbergMarquardtParams()
    if tolerance is not None:
        parameters.setRelativeErrorTol(tolerance)
        parameters.setAbsoluteErrorTol(0.0)
        parameters.setMaxIterations(500)
    began = time.perf_counter()
    values = gtsam.LevenbergMarquardtOptimizer(graph, start, parameters).optimize()
    return values, time.perf_counter() - began


def undamped(graph, values):
    """Two steps of Gauss-Newton more: damped ones end short of the optimum along weak modes."""
    parameters = gtsam.GaussNewtonParams()
    parameters.setMaxIterations(2)
    return gtsam.GaussNewtonOptimizer(graph, values, parameters).optimize()


def largest_pose_difference(ours, values):
    spatial = isinstance(next(iter(ours.values())), gtsam.Pose3)
    at = values.atPose3 if spatial else values.atPose2
    logmap = gtsam.Pose3.Logmap if spatial else gtsam.Pose2.Logmap
    return max(np.abs(logmap(pose.between(at(key)))).max() for key, pose in ours.items())


def compare(command, name, folder):
    path = data_or_skip(FILES[name])
    start_path = os.path.join(folder, "start.g2o")
    # The start alone, so that both optimisers get the same one.
    run_json(command, ["optimize", path, "-o", start_path, "--max-iterations", "0"], codes=(4,))
    poses, edges = read_g2o(start_path)
    graph, start = factor_graph(poses, edges), values_of(poses)

    from_file = ["optimize", start_path, "--initialization", "file"]
    seconds = min(run_json(command, from_file)["seconds"] for _ in range(3))
    gtsam_seconds = min(gtsam_optimum(graph, start, None)[1] for _ in range(3))

    exact_path = os.path.join(folder, "exact.g2o")
    exact = run_json(command, [*from_file, "-o", exact_path, "--cost-tolerance", "1e-12"])
    values = undamped(graph, gtsam_optimum(graph, start, 1e-12)[0])
    chi2, gtsam_chi2 = exact["final_cost"], 2 * graph.error(values)
    default_chi2 = run_json(command, from_file)["final_cost"]
    apart = largest_pose_difference(read_g2o(exact_path)[0], values)
    relative = abs(chi2 - gtsam_chi2) / gtsam_chi2
    print(
        f"| {name} | {chi2:.9g} | {gtsam_chi2:.9g} | {relative:.1e} | {apart:.1e} "
        f"| {seconds:.3f} | {gtsam_seconds:.3f} | {seconds / gtsam_seconds:.2f} |",
        flush=True,
    )
    same = relative <= CHI2_TOLERANCE and apart <= POSE_TOLERANCE
    return same and abs(default_chi2 - gtsam_chi2) <= CHI2_TOLERANCE * gtsam_chi2


def main():
    command, names = sys.argv[1], sys.argv[2:]
    print("| graph | chi2 | GTSAM | relative difference | poses | seconds | GTSAM | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        different = [name for name in names if not compare(command, name, folder)]
    if different:
        sys.exit(f"not the same optimum: {', '.join(different)}")


if __name__ == "__main__":
    main()
