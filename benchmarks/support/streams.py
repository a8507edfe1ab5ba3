"""Graphs in order of time, with false loops and their labels."""

import dataclasses
import pathlib

from harm import path_of


@dataclasses.dataclass(frozen=True)
class Stream:
    graph: pathlib.Path
    labels: pathlib.Path
    truth: pathlib.Path | None


CITY = "M3500-like"  # as many poses and loops as M3500, which is not among the data
NOISE_FREE = {"city10000": "posegraph2d", "sphere2500": "posegraph3d"}


def truth_of(command, data, work, name):
    """The true poses as a g2o file, or None."""
    target = work / "truth.g2o"
    if name == "ringCity":
        rows = (data / "posegraph2d" / name / "groundTruth" / "poses.txt").read_text(
            encoding="utf-8").splitlines()
        target.write_text("".join(f"VERTEX_SE2 {row}\n" for row in rows if row.strip()),
                          encoding="utf-8")
        return target
    if name not in NOISE_FREE:
        return None
    # Its edges are without noise: chained they are the truth.
    source = data / NOISE_FREE[name] / name / f"{name}_groundtruth.txt"
    command.run("optimize", source, "--initialization", "odometry", "--max-iterations", 0, "-o",
                target)
    return target


def source_of(command, data, work, name):
    """The clean graph, and its truth or None."""
    if name == CITY:
        command.run("simulate", "city", "--poses", 3500, "--loops", 1954, "--seed", 3500, "-o",
                    work / "city.g2o", "--ground-truth", work / "truth.g2o")
        return work / "city.g2o", work / "truth.g2o"
    if name == "Bovisa04":
        return data / "posegraph2d" / "bovisa04" / "Bovisa04_odometry_bow_tr.g2o", None
    return path_of(name, data), truth_of(command, data, work, name)


def prepare(command, data, work, name, kind, fraction, seed=1):
    """The graph with this share of false loops, in order of time."""
    graph, truth = source_of(command, data, work, name)
    wanted = ("--count", 0) if kind == "clean" else ("--type", kind, "--fraction", fraction)
    command.run("corrupt", graph, "-o", work / "corrupted.g2o", "--labels", work / "labels.csv",
                *wanted, "--seed", seed)
    command.run("convert", work / "corrupted.g2o", "--in-time-order", "-o", work / "stream.g2o",
                "--known-labels", work / "labels.csv", "--labels", work / "stream.csv")
    return Stream(work / "stream.g2o", work / "stream.csv", truth)
