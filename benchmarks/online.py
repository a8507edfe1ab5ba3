#!/usr/bin/env python3
"""How verdicts fare while a graph comes in, and whether they end where the batch ends.

Every graph clean and with 30 and 50 % false loops of three types, replayed in order of time by
`isotherm follow`; some beside batch methods that are run again every so many poses; how long calls
take beside one solution of the map; and what is left after a process is killed. Writes
docs/results/online.md, its figure, and docs/results/data/online.csv. Every cell is kept in
build/online, so that an interrupted run goes on where it stopped.
"""

import functools
import json
import pathlib
import sys
import tempfile
import textwrap

from support import online_memory, online_peers, online_prefixes, online_stops, online_times
from support.experiment import ROOT, argument_parser
from support.runs import Command, Results, read_csv, run_all, write_csv
from support.streams import CITY, prepare

GRAPHS = ["intel", "CSAIL", "kitti_00", "ringCity", "B25b_0.600", "Bovisa04", "parking-garage", CITY,
          "sphere2500", "city10000"]
TYPES = ["random-grouped", "local-grouped", "random"]
FRACTIONS = [0.5, 0.3]
COLUMNS = ["graph", "type", "fraction", "edges", "loops", "median_ms", "p99_ms", "worst_ms",
           "cpu_median_ms", "cpu_p99_ms", "cpu_worst_ms", "seconds", "batch_seconds", "ratio",
           "differ", "precision", "recall", "mean_precision", "mean_recall", "ambiguous",
           "delay_median", "delay_90"]


def seconds_of(usage):
    """CPU time, which other programs on the machine change little."""
    return usage.ru_utime + usage.ru_stime


def measure(command, data, graph, kind, fraction):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        stream = prepare(command, data, work, graph, kind, fraction)
        spent = seconds_of(command.run("follow", stream.graph, "--events", work / "e.jsonl",
                                       "--verdicts", work / "v.csv", "--json", work / "run.json"))
        batch = seconds_of(command.run("prune", stream.graph, "--verdicts", work / "b.csv"))
        run = json.loads((work / "run.json").read_text(encoding="utf-8"))
        fared = command.json(work, "eval", "online", work / "e.jsonl", stream.labels)
        online, whole = read_csv(work / "v.csv"), read_csv(work / "b.csv")
    wall, cpu = run["latency_ms"], run["cpu_ms"]
    return {"graph": graph, "type": kind, "fraction": fraction, "edges": run["edges"],
            "loops": run["loops"], "median_ms": wall["median"], "p99_ms": wall["p99"],
            "worst_ms": wall["worst"], "cpu_median_ms": cpu["median"], "cpu_p99_ms": cpu["p99"],
            "cpu_worst_ms": cpu["worst"], "seconds": spent, "batch_seconds": batch,
            "ratio": spent / batch,
            "differ": sum(a["verdict"] != b["verdict"] for a, b in zip(online, whole, strict=True)),
            "delay_median": fared["delay_poses"]["median"],
            "delay_90": fared["delay_poses"]["p90"]} | {
                key: fared[key] for key in
                ("precision", "recall", "mean_precision", "mean_recall", "ambiguous")}


def summary(rows, planned):
    """What the table says as a whole."""
    within = sum(row["ratio"] <= 5.0 for row in rows)
    rest = f" of {planned}, the rest of which are not measured yet" if len(rows) < planned else ""
    text = (f"{len(rows)} cells{rest}: {sum(row['differ'] for row in rows)} final verdicts of "
            f"{sum(row['loops'] for row in rows)} differ from the batch's. In CPU time the slowest "
            f"median of a call is {max(row['cpu_median_ms'] for row in rows):.1f} ms, the slowest "
            f"99 % {max(row['cpu_p99_ms'] for row in rows):.0f} ms and the slowest call "
            f"{max(row['cpu_worst_ms'] for row in rows):.0f} ms; {within} cells take at most five "
            f"batches, the worst {max(row['ratio'] for row in rows):.1f}. The longest median delay is "
            f"{max(row['delay_median'] for row in rows):.0f} poses.")
    return [*textwrap.wrap(text, 100), ""]


def cells_section(rows, planned):
    lines = ["Made by `benchmarks/online.py`; every cell is in [data/online.csv](data/online.csv).",
             "Each graph is replayed in order of time by `isotherm follow`, one thread, clean and with",
             "false loops by `isotherm corrupt` (`--fraction` of all loops). *ms* is the CPU time of a",
             "call, *wall* the same on the clock while other programs used the machine (load 3 to 5 on two",
             "cores); *batches* is the CPU time of it all, the end included, in runs of `isotherm prune`, and",
             "uncertain by a tenth under that load; *differ* counts final",
             "verdicts that are not the batch's. P and R are of what is kept, at the end and as the mean",
             "over all edges on the way; delay is in poses from a loop's coming to its final verdict, of",
             "loops that end right: median and nine of ten. All loops of a file count as true; Bovisa04's, of a",
             "bag of words, are not.", ""]
    lines += summary(rows, planned)
    lines += ["| graph | false loops | loops | ms: median | 99 % | worst | wall: 99 % | worst | batches |"
              " differ | P, R at the end | P, R on the way | delay |", "|---" * 13 + "|"]
    for row in rows:
        kind = "none" if row["type"] == "clean" else f"{row['fraction']:.0%} {row['type']}"
        lines.append(
            f"| {row['graph']} | {kind} | {row['loops']} | {row['cpu_median_ms']:.2f} | "
            f"{row['cpu_p99_ms']:.1f} | {row['cpu_worst_ms']:.0f} | {row['p99_ms']:.1f} | "
            f"{row['worst_ms']:.0f} | {row['ratio']:.1f} | {row['differ']} | "
            f"{row['precision']:.3f}, {row['recall']:.3f} | {row['mean_precision']:.3f}, "
            f"{row['mean_recall']:.3f} | {row['delay_median']:.0f}, {row['delay_90']:.0f} |")
    return lines + [""]


def cell_tasks(command, data, graphs):
    # What differs most comes first, for runs that are cut short.
    kinds = [("clean", 0.0)] + [(kind, share) for share in FRACTIONS for kind in TYPES]
    return {f"{graph} {kind} {fraction}": functools.partial(measure, command, data, graph, kind,
                                                            fraction)
            for kind, fraction in kinds for graph in graphs}


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("command", help="the isotherm command")
    parser.add_argument("--graphs", nargs="+", default=GRAPHS, choices=GRAPHS)
    arguments = parser.parse_args()
    command, results = Command(arguments.command), Results(ROOT / "build" / "online")
    cells = cell_tasks(command, arguments.data, arguments.graphs)
    others = {name: part.tasks(command, arguments.data)
              for name, part in (("prefixes", online_prefixes), ("peers", online_peers),
                                 ("times", online_times), ("stops", online_stops),
                                 ("memory", online_memory))}
    if not arguments.page_only:
        first = {key: task for key, task in cells.items() if not key.endswith(f" {FRACTIONS[-1]}")}
        for tasks in [first, *others.values(), cells]:
            run_all(tasks, results, arguments.jobs)
    measured = {name: {key: row for key in tasks if (row := results.get(key)) and "failed" not in row}
                for name, tasks in [*others.items(), ("cells", cells)]}
    found = {name: list(rows.values()) for name, rows in measured.items()}
    found["cells"].sort(key=lambda row: GRAPHS.index(row["graph"]))
    folder = ROOT / "docs" / "results"
    write_csv(folder / "data" / "online.csv", COLUMNS, found["cells"])
    lines = ["# Verdicts while a graph comes in", "", *cells_section(found["cells"], len(cells)),
             *online_prefixes.section(found["prefixes"]), *online_peers.section(measured["peers"]),
             *online_times.section(found["times"], folder),
             *online_stops.section(found["stops"]), *online_memory.section(found["memory"])]
    (folder / "online.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
