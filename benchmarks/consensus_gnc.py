"""CPU time of forward consensus beside GTSAM's GncOptimizer, in one run.

Half of the loops of each graph are false (vertigo, random, seed 1). GNC starts at the
poses of odometry with a truncated least-squares loss, odometry and the first pose being
known inliers, and everything else as GTSAM has it. Reading files does not count for
GTSAM; for Isotherm the whole command on one thread does.

usage: consensus_gnc.py ISOTHERM DATA_FOLDER
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gtsam
import numpy as np

GRAPHS = {
    "intel": "posegraph2d/intel/intel.g2o",
    "CSAIL": "posegraph2d/CSAIL/CSAIL.g2o",
    "kitti_00": "paper/kitti/kitti_00.g2o",
    "kitti_02": "paper/kitti/kitti_02.g2o",
    "ringCity": "posegraph2d/ringCity/originalDataset/ringCity.g2o",
}


def child_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def gnc_seconds(path):
    graph, _ = gtsam.readG2o(str(path), False)
    factors = [graph.at(k) for k in range(graph.size())]
    steps = {}
    for index, factor in enumerate(factors):
        a, b = factor.keys()
        if b == a + 1:
            steps.setdefault(a, index)
    values = gtsam.Values()
    values.insert(0, gtsam.Pose2())
    for a in sorted(steps):
        values.insert(a + 1, values.atPose2(a).compose(factors[steps[a]].measured()))
    known = list(steps.values())
    graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(), gtsam.noiseModel.Isotropic.Sigma(3, 1e-3)))
    known.append(graph.size() - 1)
    params = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
    params.setKnownInliers(known)
    start = time.process_time()
    optimizer = gtsam.GncLMOptimizer(graph, values, params)
    optimizer.optimize()
    seconds = time.process_time() - start
    weights = np.array(optimizer.getWeights())
    return seconds, int((weights[: len(factors)] < 0.5).sum())


def main():
    isotherm, data = sys.argv[1], Path(sys.argv[2])
    print("| graph | loops | pruned by consensus | by GNC | consensus, s | GNC, s | ratio |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as work:
        for name, file in GRAPHS.items():
            clean, bad = Path(work) / "clean.g2o", Path(work) / "bad.g2o"
            verdicts = Path(work) / "verdicts.csv"
            # Keeps the vertices that GTSAM's reader asks for.
            subprocess.run([isotherm, "optimize", data / file, "-o", clean, "-q"], check=True)
            subprocess.run([isotherm, "corrupt", clean, "-o", bad, "--labels", f"{work}/l.csv",
                            "--fraction", "0.5", "--seed", "1", "-q"], check=True)
            ours = child_seconds([isotherm, "prune", bad, "--threads", "1", "-q",
                                  "--verdicts", verdicts])
            rows = [line.split(",")[3] for line in verdicts.read_text().splitlines()[1:]]
            theirs, pruned = gnc_seconds(bad)
            print(f"| {name} | {len(rows)} | {rows.count('prune')} | {pruned} | {ours:.2f} | "
                  f"{theirs:.2f} | {theirs / ours:.0f} |", flush=True)


main()
