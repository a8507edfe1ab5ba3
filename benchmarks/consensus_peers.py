"""CPU time of consensus beside GTSAM's GncOptimizer and g2o's DCS, in one run.

Half of the loops of each graph are false (vertigo, random, seed 1). Both start at the poses of
odometry. GNC has a truncated least-squares loss, odometry and the first pose being known inliers;
DCS its kernel of width 1 on the loops, and Levenberg's method for 100 iterations at most; everything
else is as GTSAM and g2o have it. On the large graphs they are stopped at ten times what consensus
takes. Reading files does not count for them; for Isotherm the whole command on one thread does.
Cubicle is left out: its odometry is in pieces, and gives no start.

usage: consensus_peers.py ISOTHERM DATA_FOLDER
It needs the packages gtsam, g2o-python and, for the latter, numpy<2.
"""

import multiprocessing
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import g2o
import gtsam
import numpy as np

SMALL = {
    "intel": "posegraph2d/intel/intel.g2o",
    "CSAIL": "posegraph2d/CSAIL/CSAIL.g2o",
    "kitti_00": "paper/kitti/kitti_00.g2o",
    "kitti_02": "paper/kitti/kitti_02.g2o",
    "ringCity": "posegraph2d/ringCity/originalDataset/ringCity.g2o",
}
LARGE = {
    "city10000": "posegraph2d/city10000/city10000.g2o",
    "sphere2500": "posegraph3d/sphere2500/sphere2500.g2o",
    "torus3D": "posegraph3d/torus3D/torus3D.g2o.gz",
    "parking-garage": "posegraph3d/parking-garage/parking-garage.g2o",
}
STOP_AT = 10  # times the CPU time of consensus, for the large ones
LEVENBERG_AT_MOST = 100  # iterations of DCS


def child_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def odometry_start(factors, pose):
    """Poses along the first edge from each to the next, and the indices of these edges."""
    steps = {}
    for index, factor in enumerate(factors):
        a, b = factor.keys()
        if b == a + 1:
            steps.setdefault(a, index)
    values, here = gtsam.Values(), pose()
    values.insert(0, here)
    for a in sorted(steps):
        here = here.compose(factors[steps[a]].measured())
        values.insert(a + 1, here)
    return values, list(steps.values())


def read(path):
    """Whether a file is in three dimensions, its graph, its factors, and odometry_start()."""
    is_3d = "EDGE_SE3" in path.read_text()
    graph, _ = gtsam.readG2o(str(path), is_3d)
    factors = [graph.at(k) for k in range(graph.size())]
    return is_3d, graph, factors, *odometry_start(factors, gtsam.Pose3 if is_3d else gtsam.Pose2)


def run_gnc(path):
    """The CPU time of GNC on a file, and the number of edges that it prunes."""
    is_3d, graph, factors, values, known = read(path)
    prior, pose, dof = ((gtsam.PriorFactorPose3, gtsam.Pose3, 6) if is_3d
                        else (gtsam.PriorFactorPose2, gtsam.Pose2, 3))
    graph.add(prior(0, pose(), gtsam.noiseModel.Isotropic.Sigma(dof, 1e-3)))
    known.append(graph.size() - 1)
    params = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
    params.setKnownInliers(known)
    start = time.process_time()
    optimizer = gtsam.GncLMOptimizer(graph, values, params)
    optimizer.optimize()
    seconds = time.process_time() - start
    weights = np.array(optimizer.getWeights())
    return seconds, int((weights[: len(factors)] < 0.5).sum())


def g2o_pose(pose, is_3d):
    if is_3d:
        return g2o.Isometry3d(pose.matrix())
    return g2o.SE2(pose.x(), pose.y(), pose.theta())


def g2o_information(factor, is_3d):
    """GTSAM has rotations first in three dimensions, and whole angles where g2o has half."""
    information = factor.noiseModel().information()
    if not is_3d:
        return information
    order = [3, 4, 5, 0, 1, 2]
    whole = np.array([1.0] * 3 + [2.0] * 3)
    return information[np.ix_(order, order)] * np.outer(whole, whole)


def g2o_problem(path):
    """The optimiser at the poses of odometry, and the loops with their kernels."""
    is_3d, _, factors, values, known = read(path)
    solver = (g2o.BlockSolverSE3(g2o.LinearSolverEigenSE3()) if is_3d
              else g2o.BlockSolverX(g2o.LinearSolverEigenX()))
    optimizer = g2o.SparseOptimizer()
    optimizer.set_algorithm(g2o.OptimizationAlgorithmLevenberg(solver))
    for key in values.keys():
        vertex = g2o.VertexSE3() if is_3d else g2o.VertexSE2()
        vertex.set_id(key)
        pose = values.atPose3(key) if is_3d else values.atPose2(key)
        vertex.set_estimate(g2o_pose(pose, is_3d))
        vertex.set_fixed(key == 0)
        optimizer.add_vertex(vertex)
    odometry, loops = set(known), []
    for index, factor in enumerate(factors):
        edge = g2o.EdgeSE3() if is_3d else g2o.EdgeSE2()
        for end, key in enumerate(factor.keys()):
            edge.set_vertex(end, optimizer.vertex(key))
        edge.set_measurement(g2o_pose(factor.measured(), is_3d))
        edge.set_information(g2o_information(factor, is_3d))
        if index not in odometry:
            edge.set_robust_kernel(g2o.RobustKernelDCS())
            loops.append(edge)
        optimizer.add_edge(edge)
    return optimizer, loops


def run_dcs(path):
    """The same of DCS: pruned are loops of a weight below a half."""
    optimizer, loops = g2o_problem(path)
    start = time.process_time()
    optimizer.initialize_optimization()
    optimizer.optimize(LEVENBERG_AT_MOST)
    seconds = time.process_time() - start
    pruned = 0
    for edge in loops:
        edge.compute_error()
        pruned += (2.0 / (1.0 + edge.chi2())) ** 2 < 0.5
    return seconds, pruned


def peer(run, path, limit):
    """What `run` says, or None if that takes more than `limit` seconds of CPU time, where there
    is a limit."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.Process(target=limited, args=(run, path, sender, limit))
    process.start()
    sender.close()
    try:
        return receiver.recv()
    except EOFError:
        return None
    finally:
        process.join()


def limited(run, path, sender, limit):
    os.chdir(path.parent)  # g2o leaves a file where it runs if its factorisation fails
    # What importing and reading take comes on top.
    if limit is not None:
        seconds = int(time.process_time() + limit) + 10
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    sender.send(run(path))


def columns(answer, ours):
    """Edges pruned, seconds, and these against ours."""
    if answer is None:
        return f"- | stopped | > {STOP_AT}"
    seconds, pruned = answer
    return f"{pruned} | {seconds:.2f} | {seconds / ours:.1f}"


def main():
    isotherm, data = sys.argv[1], Path(sys.argv[2])
    print("| graph | loops | pruned by consensus | s | by GNC | s | ratio | by DCS | s | ratio |")
    print("|---" * 10 + "|")
    with tempfile.TemporaryDirectory() as work:
        for name, file in (SMALL | LARGE).items():
            clean, bad = Path(work) / "clean.g2o", Path(work) / "bad.g2o"
            verdicts = Path(work) / "verdicts.csv"
            # Keeps the vertices that GTSAM's reader asks for.
            subprocess.run([isotherm, "optimize", data / file, "-o", clean, "-q"], check=True)
            subprocess.run([isotherm, "corrupt", clean, "-o", bad, "--labels", f"{work}/l.csv",
                            "--fraction", "0.5", "--seed", "1", "-q"], check=True)
            ours = child_seconds([isotherm, "prune", bad, "--threads", "1", "-q",
                                  "--verdicts", verdicts])
            rows = [line.split(",")[3] for line in verdicts.read_text().splitlines()[1:]]
            limit = STOP_AT * ours if name in LARGE else None
            print(f"| {name} | {len(rows)} | {rows.count('prune')} | {ours:.2f} | "
                  f"{columns(peer(run_gnc, bad, limit), ours)} | "
                  f"{columns(peer(run_dcs, bad, limit), ours)} |", flush=True)


main()
