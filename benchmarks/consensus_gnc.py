"""CPU time of consensus beside GTSAM's GncOptimizer, in one run.

Half of the loops of each graph are false (vertigo, random, seed 1). GNC starts at the
poses of odometry with a truncated least-squares loss, odometry and the first pose being
known inliers, and everything else as GTSAM has it. On the large graphs it is stopped at
ten times what consensus takes. Reading files does not count for GTSAM; for Isotherm the
whole command on one thread does. Cubicle is left out: its odometry is in pieces, and
gives no start.

usage: consensus_gnc.py ISOTHERM DATA_FOLDER
"""

import multiprocessing
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

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


def run_gnc(path, answer):
    """Sends the CPU time of GNC on a file and the number of edges that it prunes."""
    is_3d = "EDGE_SE3" in path.read_text()
    pose, dof = (gtsam.Pose3, 6) if is_3d else (gtsam.Pose2, 3)
    prior = gtsam.PriorFactorPose3 if is_3d else gtsam.PriorFactorPose2
    graph, _ = gtsam.readG2o(str(path), is_3d)
    factors = [graph.at(k) for k in range(graph.size())]
    values, known = odometry_start(factors, pose)
    graph.add(prior(0, pose(), gtsam.noiseModel.Isotropic.Sigma(dof, 1e-3)))
    known.append(graph.size() - 1)
    params = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
    params.setKnownInliers(known)
    start = time.process_time()
    optimizer = gtsam.GncLMOptimizer(graph, values, params)
    optimizer.optimize()
    seconds = time.process_time() - start
    weights = np.array(optimizer.getWeights())
    answer.send((seconds, int((weights[: len(factors)] < 0.5).sum())))


def gnc(path, limit):
    """What run_gnc() says, or None if that takes more than `limit` seconds of CPU time,
    where there is a limit."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.Process(target=limited_gnc, args=(path, sender, limit))
    process.start()
    sender.close()
    try:
        return receiver.recv()
    except EOFError:
        return None
    finally:
        process.join()


def limited_gnc(path, answer, limit):
    # What importing and reading take comes on top.
    if limit is not None:
        seconds = int(time.process_time() + limit) + 10
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    run_gnc(path, answer)


def main():
    isotherm, data = sys.argv[1], Path(sys.argv[2])
    print("| graph | loops | pruned by consensus | by GNC | consensus, s | GNC, s | ratio |")
    print("|---|---|---|---|---|---|---|")
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
            answer = gnc(bad, STOP_AT * ours if name in LARGE else None)
            if answer:
                gnc_pruned, gnc_seconds = answer[1], f"{answer[0]:.2f}"
                ratio = f"{answer[0] / ours:.0f}"
            else:
                gnc_pruned, gnc_seconds, ratio = "-", "stopped", f"> {STOP_AT}"
            print(f"| {name} | {len(rows)} | {rows.count('prune')} | {gnc_pruned} | {ours:.2f} | "
                  f"{gnc_seconds} | {ratio} |", flush=True)


main()
