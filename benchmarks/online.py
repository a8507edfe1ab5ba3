#!/usr/bin/env python3
"""How verdicts fare while a graph comes in, and whether they end where the batch ends.

Every graph clean and with 30 and 50 % false loops of three types, replayed in order of time by
`isotherm follow`. Writes docs/results/online.md and docs/results/data/online.csv: latency of a
call, time against that of the batch, precision and recall through time, poses from a loop's coming
to its final verdict, and whether the final verdicts are those of `isotherm prune`. Every cell is
kept in build/online, so that an interrupted run goes on where it stopped.
"""

import csv
import functools
import json
import pathlib
import statistics
import sys
import tempfile

from harm import path_of
from support.experiment import ROOT, argument_parser
from support.runs import Command, Results, read_csv, run_all

GRAPHS = ["intel", "CSAIL", "kitti_00", "ringCity", "B25b_0.600", "sphere2500",
          "parking-garage", "city10000"]
TYPES = ["random-grouped", "local-grouped", "random"]
FRACTIONS = [0.5, 0.3]
COLUMNS = ["graph", "type", "fraction", "edges", "loops", "median_ms", "p99_ms", "worst_ms",
           "seconds", "batch_seconds", "ratio", "differ", "precision", "recall",
           "mean_precision", "mean_recall", "delay_median", "delay_90"]


def edge_lines(path):
    return [line for line in path.read_text(encoding="utf-8").splitlines()
            if line.startswith("EDGE")]


def prepare(command, data, work, graph, kind, fraction):
    """The graph in order of time, and which of its edges are false loops."""
    if kind == "clean":
        command.run("convert", path_of(graph, data), "--in-time-order", "-o", work / "t.g2o")
        return set()
    command.run("corrupt", path_of(graph, data), "-o", work / "c.g2o", "--labels",
                work / "l.csv", "--type", kind, "--fraction", fraction, "--seed", 1)
    command.run("convert", work / "c.g2o", "--in-time-order", "-o", work / "t.g2o")
    lines = edge_lines(work / "c.g2o")
    false = {lines[int(row["edge"])] for row in read_csv(work / "l.csv")
             if row["label"] == "incorrect"}
    return {k for k, line in enumerate(edge_lines(work / "t.g2o")) if line in false}


def poses_so_far(path):
    """Of each edge, how many poses the edges up to it touch."""
    seen, counts = set(), []
    for line in edge_lines(path):
        seen.update(line.split()[1:3])
        counts.append(len(seen))
    return counts


def through_time(events, false, edges):
    """Precision and recall of what is kept, at twenty times and at the end."""
    verdicts, rows, next_at = {}, [], 0
    times = [round(edges * k / 20) for k in range(1, 21)]
    for event in events + [{"at": edges + 1}]:
        while next_at < len(times) and event["at"] > times[next_at]:
            rows.append(precision_recall(verdicts, false))
            next_at += 1
        if "edge" in event:
            verdicts[event["edge"]] = event["verdict"]
    return [row for row in rows if row]


def precision_recall(verdicts, false):
    kept = {edge for edge, verdict in verdicts.items() if verdict == "keep"}
    true = set(verdicts) - false
    if not true:
        return None
    return (len(kept - false) / len(kept) if kept else 1.0, len(kept - false) / len(true))


def delays(events, false, poses):
    """Poses from a loop's coming to its final verdict, of those that end right."""
    came, settled, final = {}, {}, {}
    for event in events:
        edge = event["edge"]
        at = poses[min(event["at"], len(poses) - 1)]
        came.setdefault(edge, at)
        settled[edge], final[edge] = at, event["verdict"]
    right = [edge for edge in final if final[edge] == ("prune" if edge in false else "keep")]
    return sorted(settled[edge] - came[edge] for edge in right)


def seconds_of(usage):
    """CPU time, which other programs on the machine change little."""
    return usage.ru_utime + usage.ru_stime


def measure(command, data, graph, kind, fraction):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        false = prepare(command, data, work, graph, kind, fraction)
        spent = seconds_of(command.run("follow", work / "t.g2o", "--events", work / "e.jsonl",
                                       "--verdicts", work / "v.csv", "--json", work / "run.json"))
        batch = seconds_of(command.run("prune", work / "t.g2o", "--verdicts", work / "b.csv"))
        run = json.loads((work / "run.json").read_text(encoding="utf-8"))
        events = [json.loads(line) for line in (work / "e.jsonl").open(encoding="utf-8")]
        poses = poses_so_far(work / "t.g2o")
        online, whole = read_csv(work / "v.csv"), read_csv(work / "b.csv")
    events = [event for event in events if "edge" in event]
    history = through_time([event for event in events if event["at"] < run["edges"]], false,
                           run["edges"])
    final = precision_recall({int(row["edge"]): row["verdict"] for row in online}, false)
    late = delays(events, false, poses) or [0]
    return {"graph": graph, "type": kind, "fraction": fraction, "edges": run["edges"],
            "loops": run["loops"], "median_ms": run["latency_ms"]["median"],
            "p99_ms": run["latency_ms"]["p99"], "worst_ms": run["latency_ms"]["worst"],
            "seconds": spent, "batch_seconds": batch, "ratio": spent / batch,
            "differ": sum(a["verdict"] != b["verdict"] for a, b in zip(online, whole)),
            "precision": final[0], "recall": final[1],
            "mean_precision": statistics.mean(row[0] for row in history),
            "mean_recall": statistics.mean(row[1] for row in history),
            "delay_median": statistics.median(late), "delay_90": late[int(0.9 * len(late))]}


def page(rows):
    lines = ["# Verdicts while a graph comes in", "",
             "Made by `benchmarks/online.py`; every cell is in [data/online.csv](data/online.csv).",
             "Each graph is replayed in order of time by `isotherm follow`, one thread, clean and",
             "with false loops by `isotherm corrupt`. Latency is that of one call; *batches* is the CPU",
             "time of it all, the end included, in runs of `isotherm prune`; *differ* counts final verdicts",
             "that are not the batch's. Other programs used the machine meanwhile, which latency, in wall",
             "time, suffers from. P and R are of what is kept, at the end and as the mean over",
             "twenty times on the way; delay is in poses from a loop's coming to its final verdict,",
             "of loops that end right: median and nine of ten.", "",
             "| graph | false loops | loops | ms: median | 99 % | worst | batches | differ | P, R at the end"
             " | P, R on the way | delay |", "|---" * 11 + "|"]
    for row in rows:
        kind = "none" if row["type"] == "clean" else f"{row['fraction']:.0%} {row['type']}"
        lines.append(
            f"| {row['graph']} | {kind} | {row['loops']} | {row['median_ms']:.2f} | "
            f"{row['p99_ms']:.1f} | {row['worst_ms']:.0f} | {row['ratio']:.1f} | {row['differ']} | "
            f"{row['precision']:.3f}, {row['recall']:.3f} | {row['mean_precision']:.3f}, "
            f"{row['mean_recall']:.3f} | {row['delay_median']:.0f}, {row['delay_90']:.0f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("command", help="the isotherm command")
    parser.add_argument("--graphs", nargs="+", default=GRAPHS, choices=GRAPHS)
    arguments = parser.parse_args()
    command, results = Command(arguments.command), Results(ROOT / "build" / "online")
    # What differs most comes first, for runs that are cut short.
    kinds = [("clean", 0.0)] + [(kind, share) for share in FRACTIONS for kind in TYPES]
    cells = [(graph, kind, share) for kind, share in kinds for graph in arguments.graphs]
    tasks = {f"{graph} {kind} {fraction}": functools.partial(measure, command, arguments.data, graph,
                                                             kind, fraction)
             for graph, kind, fraction in cells}
    if not arguments.page_only:
        run_all(tasks, results, arguments.jobs)
    rows = [row for row in map(results.get, tasks) if row and "failed" not in row]
    rows.sort(key=lambda row: GRAPHS.index(row["graph"]))
    folder = ROOT / "docs" / "results"
    with open(folder / "data" / "online.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    (folder / "online.md").write_text(page(rows), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
