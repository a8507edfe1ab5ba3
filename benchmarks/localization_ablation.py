#!/usr/bin/env python3
"""What every constant of the localiser is worth, on networks that none was chosen on.

Builds a copy of the sources in which each constant of network/src/localize/constants.hpp is read
from the environment, and localises the same simulated networks with one changed at a time: all
noises, kinds and shares of wrong ranges. Writes docs/results/localization-ablation.md and
docs/results/data/localization_ablation.csv. Runs are kept in build/localization-ablation, so that
an interrupted run goes on where it stopped.
"""

import functools
import math
import pathlib
import statistics
import sys
import tempfile

from support.experiment import ROOT, argument_parser
from support.instrumented import Changed, Constant, build, read_from_environment, replace
from support.runs import Command, Results, read_csv, run_all, write_csv

ROOM = pathlib.Path("network/src/localize")
DEGREE = 12
FAULTS = [("false", 0.0), *((kind, share) for kind in ("false", "biased") for share in (0.1, 0.2, 0.3))]
FIRST_SEED = 700
# Nodes, noise, kind and share of wrong ranges.
NETWORKS = [(100, noise, *fault) for noise in (0.01, 0.05, 0.1) for fault in FAULTS]
NETWORKS += [(400, 0.05, "false", 0.1), (400, 0.05, "biased", 0.2)]

CONSTANTS = [
    Constant("kLikely", "0.5", "probability from which on something counts as so", (0.3, 0.7)),
    Constant("kHardlyNoise", "3", "deviations that noise hardly ever exceeds", (1.5, 6)),
    Constant("kProvisionalNoise", "0.05", "deviation of ranges that come without one, at first",
             (0.02, 0.2)),
    Constant("kSameNoise", "0.05", "change of a log deviation that matters", (0.01, 0.3)),
    Constant("kEnoughRanges", "10", "spare ranges from which stated deviations are corrected",
             (3, 100)),
    Constant("kMostRanges", "0.9", "part of the ranges that all but outliers keep within",
             (0.8, 0.97)),
    Constant("kAbsenceEnd", "1.5", "end of the curve of absence, in lengths of the longest of these",
             (1.25, 2)),
    Constant("kAbsenceBins", "16", "pieces of that curve", (8, 32)),
    Constant("kGranted", "3", "pairs without a range that each piece is given", (1, 10)),
    Constant("kLeastAbsent", "0.02", "least part of the pairs without a range in reach",
             (0.005, 0.1)),
    Constant("kStrangersAround", "2.5", "reaches around a node in which strangers count", (1.5, 4)),
    Constant("kBetter", "2", "twice the nats by which a map must be better", (0.5, 8)),
    Constant("kApart", "4", "deviations from which on two places are two", (2, 8)),
    Constant("kRoughMap", "1.5", "width of the springs' loss at first, in ranges", (0.75, 3)),
    Constant("kRepulsion", "0.05", "deviation of what keeps nodes apart, in reaches", (0.02, 0.2)),
    Constant("kRepulsionWidth", "6", "width of its loss, in deviations", (3, 12)),
    Constant("kFarOutside", "4", "widths of a loss beyond which a range is left out", (2, 8)),
    Constant("kHardlyAny", "0.005", "part of the pairs that may contradict a map", (0, 0.05)),
    Constant("kRegionSteps", "5", "ranges to the ends of a region that is drawn anew", (3, 8)),
    Constant("kLargestPart", "200", "nodes of the largest part that is folded", (20, 1000)),
    Constant("kBroken", "0.5", "costs of a range that break a pair", (0.25, 1)),
    Constant("kMostBroken", "10", "the same, that a fold may cost at first", (3, 30)),
    Constant("kAlike", "0.8", "part of the nodes that parts share which are alike", (0.6, 0.95)),
]


def instrument(tree):
    read_from_environment(tree / ROOM / "constants.hpp", CONSTANTS)
    # What follows from it is no longer known to the compiler.
    replace(tree / ROOM / "refine/refine.cpp",
            [("constexpr double kLongestStep = kApart", "const double kLongestStep = kApart")])


def simulate(command, folder, number, network):
    """Writes a network, once."""
    nodes, noise, kind, share = network
    folder.mkdir(parents=True, exist_ok=True)
    command.run("simulate", "network", "--nodes", nodes, "--degree", DEGREE, "--noise", noise,
                f"--{kind}-fraction", share, "--seed", FIRST_SEED + number, "-o",
                folder / "ranges.csv", "--anchor-file", folder / "anchors.csv", "--ground-truth",
                folder / "truth.csv", "--labels", folder / "labels.csv")
    return {"folder": str(folder)}


def places(path):
    return {row["node"]: (float(row["x"]), float(row["y"])) for row in read_csv(path)
            if row.get("status", "localised") == "localised"}


def measure(command, folders):
    """Errors by node, and verdicts, of each network."""
    rows = []
    for folder in map(pathlib.Path, folders):
        with tempfile.TemporaryDirectory() as work:
            found, verdicts = pathlib.Path(work) / "places.csv", pathlib.Path(work) / "verdicts.csv"
            usage = command.run("localize", folder / "ranges.csv", "--anchors",
                                folder / "anchors.csv", "-o", found, "--verdicts", verdicts)
            placed = places(found) if found.exists() else {}
            pruned = [row["verdict"] == "prune" for row in read_csv(verdicts)]
        truth = places(folder / "truth.csv")
        wrong = [row["label"] != "correct" for row in read_csv(folder / "labels.csv")]
        rows.append({"errors": {node: math.dist(at, truth[node]) for node, at in placed.items()},
                     "wrong": sum(wrong), "pruned": sum(pruned),
                     "both": sum(a and b for a, b in zip(wrong, pruned)),
                     "seconds": usage.ru_utime})
    return {"networks": rows}


def rms(errors):
    return math.sqrt(statistics.fmean(error * error for error in errors))


def ratio(row, base):
    """Of errors, on the nodes that both localise."""
    both = row["errors"].keys() & base["errors"].keys()
    if not both:
        return None
    return rms(row["errors"][node] for node in both) / rms(base["errors"][node] for node in both)


def summary(rows, base):
    """All networks in one line."""
    far = sum(error > 0.5 * math.sqrt(DEGREE / math.pi / network[0])
              for network, row in zip(NETWORKS, rows) for error in row["errors"].values())
    ratios = [r for row, before in zip(rows, base) if (r := ratio(row, before)) is not None]
    found = sum(row["both"] for row in rows)
    return {"localised": sum(len(row["errors"]) for row in rows), "far off": far,
            "ratio": statistics.median(ratios), "mean ratio": statistics.fmean(ratios),
            "precision": found / max(sum(row["pruned"] for row in rows), 1),
            "recall": found / max(sum(row["wrong"] for row in rows), 1),
            "seconds": sum(row["seconds"] for row in rows) / sum(row["seconds"] for row in base)}


def line_of(name, meaning, value, tried, of):
    return (f"| {name} | {meaning} | {value} | {tried} | {of['localised']} | {of['far off']} | "
            f"{of['ratio']:.2f} | {of['mean ratio']:.2f} | {of['precision']:.3f} | "
            f"{of['recall']:.3f} | {of['seconds']:.2f} |")


def page(rows):
    nodes = sum(network[0] for network in NETWORKS)
    lines = ["# What constants of the localiser are worth", "",
             "Made by `benchmarks/localization_ablation.py`: `isotherm localize` with one constant",
             f"changed at a time, on {len(NETWORKS)} simulated networks of {nodes} nodes in all",
             f"({DEGREE} ranges a node; noise of 1, 5 and 10 %; none, 10, 20 and 30 % of the ranges",
             "false or too long) that none was chosen on; every row is in",
             "[data/localization_ablation.csv](data/localization_ablation.csv). *Far off*: by more",
             "than half a radius. *Ratio* is that of the error to the one with all as they are, on the",
             "nodes that both localise: its median and mean over the networks. Precision and recall",
             "are of pruned ranges. *Seconds*: CPU time against the first row's.", "",
             "| constant | what it is | value | tried | localised | far off | ratio | mean ratio |"
             " precision | recall | seconds |", "|---" * 11 + "|",
             line_of("as they are", "", "", "", rows["base"])]
    for constant in CONSTANTS:
        lines += [line_of(f"`{constant.name}`", constant.meaning, constant.value, f"{value:g}",
                          rows[f"{constant.name}={value:g}"])
                  for value in constant.tried if f"{constant.name}={value:g}" in rows]
    return "\n".join(lines) + "\n"


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", help="a command built by this script before")
    options = parser.parse_args()
    folder = ROOT / "build" / "localization-ablation"
    program = options.isotherm or build(folder, instrument)
    made = Results(folder / "made")
    networks = {f"network {k}": functools.partial(simulate, Command(program), folder / f"network-{k}",
                                                  k, network) for k, network in enumerate(NETWORKS)}
    run_all(networks, made, options.jobs)
    folders = [made.get(key)["folder"] for key in networks]
    runs = {"base": {}} | {f"{constant.name}={value:g}": {constant.name: value}
                           for constant in CONSTANTS for value in constant.tried}
    results = Results(folder / "runs")
    if not options.page_only:
        run_all({name: functools.partial(measure, Changed(program, environment), folders)
                 for name, environment in runs.items()}, results, options.jobs)
    found = {name: row["networks"] for name in runs if (row := results.get(name)) and "networks" in row}
    rows = {name: summary(row, found["base"]) for name, row in found.items()}
    target = ROOT / "docs" / "results"
    write_csv(target / "data" / "localization_ablation.csv", ["run", *rows["base"]],
              [{"run": name} | row for name, row in rows.items()])
    (target / "localization-ablation.md").write_text(page(rows), encoding="utf-8")
    print(f"ablation: wrote {target / 'localization-ablation.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
