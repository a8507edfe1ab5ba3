"""What is left when `follow` is killed at any moment."""

import functools
import json
import pathlib
import random
import subprocess
import tempfile
import time

from support.runs import read_csv
from support.streams import prepare

KILLS = 50
GRAPHS = ["CSAIL", "intel"]


def start(command, stream, work):
    return subprocess.Popen([command.path, "follow", stream.graph, "--state", work / "state",
                             "--events", work / "e.jsonl", "--verdicts", work / "v.csv", "--threads",
                             "1", "--quiet"], stderr=subprocess.DEVNULL)


def told(path):
    """Numbers of the edges of whole lines; a line that was cut was not told."""
    if not path.exists():
        return set()
    lines = path.read_text(encoding="utf-8").split("\n")[:-1]
    return {event["edge"] for event in map(json.loads, lines) if "edge" in event}


def kept_edges(path):
    if not path.exists():
        return 0
    return sum(line.startswith("EDGE") for line in path.read_text(encoding="utf-8").split("\n")[:-1])


def measure(command, data, graph):
    draw = random.Random(graph)
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        stream = prepare(command, data, work, graph, "random", 0.5)
        command.run("prune", stream.graph, "--verdicts", work / "b.csv")
        began = time.monotonic()
        command.run("follow", stream.graph, "--verdicts", work / "v.csv", "--events", work / "e.jsonl")
        whole = time.monotonic() - began
        lost, kills = 0, 0
        for _ in range(KILLS):
            process = start(command, stream, work)
            try:
                process.wait(timeout=draw.uniform(0.02, 0.5 * whole))
                (work / "state").unlink()  # it came to its end: from the start again
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
                known = kept_edges(work / "state")
                lost += sum(edge >= known for edge in told(work / "e.jsonl"))
            (work / "e.jsonl").unlink(missing_ok=True)
        start(command, stream, work).wait()
        last, batch = read_csv(work / "v.csv"), read_csv(work / "b.csv")
    return {"graph": graph, "kills": kills, "lost": lost,
            "differ": sum(a != b for a, b in zip(last, batch, strict=True))}


def tasks(command, data):
    return {f"stops {graph}": functools.partial(measure, command, data, graph) for graph in GRAPHS}


def section(rows):
    lines = ["## Killed at any moment", "",
             "`follow --state` killed (SIGKILL) at random moments and started again, until it comes to its",
             "end: verdicts that were told of edges which the state does not have, and final rows that are",
             "not those of `prune`.", "", "| graph | kills | lost | differ |", "|---|---|---|---|"]
    lines += [f"| {row['graph']}, 50% random | {row['kills']} | {row['lost']} | {row['differ']} |"
              for row in rows]
    return lines + ["", "A thousand random interleavings of odometry and loops, with repeated, reversed and late edges, in",
                    "the plane and in space, end in the same verdicts:",
                    "`ISOTHERM_INTERLEAVED_GRAPHS=50 build/test/tests/slam/slam_tests",
                    "--gtest_filter='OnlineInterleaving*'`, of which the tests run a tenth.", ""]
