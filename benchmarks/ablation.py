#!/usr/bin/env python3
"""What every constant and move of consensus is worth, on graphs that none was chosen on.

Builds a copy of the sources in which each constant below is read from the environment, and whether
each move is made, and judges the same graphs with one changed at a time: every small graph in some
of the variants of support/variants.py, drawn with another seed than those that the search was
looked at with, clean and with half of the loops false. Writes docs/results/ablation.md and
docs/results/data/ablation.csv. Runs are kept in build/ablation, so that an interrupted run goes on where it stopped.
"""

import functools
import json
import pathlib
import random
import sys
import tempfile

from corrupted import TYPES, counted, precision_recall, true_loops
from harm import FEW, SMALL, path_of
from support import variants
from support.experiment import ROOT, argument_parser
from support.instrumented import PREFIX, Changed, Constant, build, read_from_environment, replace
from support.runs import Command, Results, read_csv, run_all, write_csv

SEED = 7  # of variants and of false loops
EVERY = 12  # cells of all, so that it takes an hour
ROOM = pathlib.Path("slam/src/prune/consensus")
NATS = 1.0

CONSTANTS = [
    Constant("kScaleDeviation", "2 ln 10",
             "deviation of the log of a factor on covariances: ten in the error", (2.3, 9.2)),
    Constant("kBiasDeviation", "0.1",
             "deviation of the mean error of odometry's turns, in those of a step", (0.03, 0.3)),
    Constant("kScaleStep", "3", "of variances, from one kind of loop to the next", (2, 10)),
    Constant("kLoopsBefore", "1", "loops of either kind that count as seen before any is", (0.5, 4)),
    Constant("kFalseFollowing", "0.05", "share of false loops after a false one that follow it",
             (0.005, 0.3)),
    Constant("kFalseByChance", "100",
             "false loops by chance that count as seen, against one wrong measurement", (10, 1000)),
    Constant("kTailDof", "4", "degrees of freedom of Student's t of what loops measure", (2, 8)),
    Constant("kReach", "3.5", "deviations to which a kernel of near pairs reaches", (2, 7)),
    Constant("kFewLoops", "5", "loops of which none is pruned if there are fewer", (0, 20)),
    Constant("kLeastSample", "200", "loops that a sample holds at least", (20, 1e9)),
    Constant("kBetter", "1", "nats by which a move must be better", (0.1, 3)),
    Constant("kMoreTelling", "2", "times as many loops tell scales anew", (1, 1000)),
    Constant("kMostExpectedFalse", "0.5", "loops of a batch that may be expected false", (0.1, 5)),
    Constant("kBatchGrowth", "10", "times as many loops as before in a batch", (3, 100)),
    Constant("kSettled", "0.01", "deviations below which a step of poses does not matter",
             (0.001, 0.1)),
    Constant("kSameWeight", "0.05", "change of a log weight that matters", (0.005, 0.5)),
]
# Of each move the place in a source behind which it is left out, and how.
CLIMB = "climb/climb.cpp"
POSITION = "climb/position.cpp"
SLIPS = "climb/slip_trials.cpp"
MOVES = {
    "lessons of the common scales alone":
        (POSITION, "    if (failures_.of[trial]) continue;\n",
         "if (trial == Trial::lesson_of_scales && {off}) continue;"),
    "most loops called wider or sharper":
        ("climb/learn.cpp", "sharper_most(shares)}) {\n", "if (start.factor != 1.0 && {off}) continue;"),
    "scales of starts taken for known":
        (CLIMB, "  const Explanation<Pose> none = none_at(scale);\n",
         "if ({off}) {{ start(none); return climb(); }}"),
    "far starts": ("search/search.cpp", ": std::span(kStarts).subspan(kStartsAlways)) {\n",
                   "if ({off}) break;"),
    "the map laid out anew": (POSITION, "::try_another_map() {\n", "if ({off}) return false;"),
    "all loops true": (CLIMB, "::all_true(const Explanation<Pose>& found, double least) {\n",
                       "if ({off}) return found;"),
    "loops weighed by the others": (CLIMB, "::weigh_by_others() {\n", "if ({off}) return false;"),
    "the look afar": (CLIMB, "::weigh_afar() {\n", "if ({off}) return false;"),
    "the bias of odometry":
        ("objective/objective.cpp",
         "::bias_prior(const Explanation<Pose>& explanation,\n" + 44 * " " +
         "const ScaledGraph<Pose>& graph) const {\n",
         "if ({off}) return {{{{}}, TurnBias<Pose>::Zero(), TurnBias<Pose>::Zero()}};"),
    "labels in runs":
        ("runs/runs.hpp", "Index leader(Index loop) const {", " if ({off}) return kNone;"),
    "slips of odometry": (POSITION, "::find_slips() {\n", "if ({off}) return false;"),
    "slips for rejected runs": (SLIPS, "::for_rejected_runs() {\n", "if ({off}) return false;"),
    "slips as if loops were accurate":
        (SLIPS, "::as_if_accurate() {\n", "if ({off}) return false;"),
    "all accepted that are not false beyond doubt":
        (CLIMB, "::accept_undecided() {\n", "if ({off}) return false;"),
    "runs in doubt dropped": (CLIMB, "::drop_doubted_run() {\n", "if ({off}) return false;"),
    "climbs ended where an earlier one passed":
        ("climb/peaks.cpp", "::beyond(const Explanation<Pose>& now) const {\n",
         "if ({off}) return nullptr;"),
    "loops refuted by bounds on their covariances":
        ("climb/assessment.cpp", "::refute(Explanation<Pose>& now, Index loop) const {\n",
         "if ({off}) return false;"),
    "the search ended where as good as all loops are true":
        (CLIMB, "::explains_all(const Explanation<Pose>& found) const {\n",
         "if ({off}) return false;"),
    "scales settled anew":
        ("search/starts.hpp", "void settle_on(Climb<Pose>& climb, const std::vector<bool> accepted,\n"
         "               std::vector<Explanation<Pose>>& found) {\n", "if ({off}) return;"),
}
MODEL_MOVES = ("the bias of odometry", "labels in runs")  # of the objective, not of the search
STARTS = ["as stated", "odometry x 100", "loops x 0.01", "both x 0.01"]
FLAGS = {"window 5": ["--window", 5], "window 80": ["--window", 80],
         "scales as stated": ["--no-calibrate"]}


def instrument(tree):
    room = tree / ROOM
    read_from_environment(room / "constants.hpp", CONSTANTS)
    # What follows from them is no longer known to the compiler.
    replace(room / "climb/learn.cpp", [("constexpr double kMostApart", "const double kMostApart")])
    replace(room / "climb/climb.cpp",
            [("constexpr double kWorthTelling", "const double kWorthTelling")])
    replace(room / "objective/scale_prior.hpp",
            [("inline constexpr double kMostScale", "inline const double kMostScale")])
    replace(room / "objective/error_scales.cpp",
            [(f"constexpr {name}", f"const {name}")
             for name in ("double kWorst", "double kOther", "ByScale kPriorLoops")])
    replace(tree / "slam/src/online/engine.cpp", [("constexpr Index kFirst", "const Index kFirst")])
    replace(room / "constants.hpp",
            [("namespace isotherm::slam::detail {\n",
              "namespace isotherm::slam::detail {\ninline bool is_off(int move) {\n"
              f'  const char* off = std::getenv("{PREFIX}kMoves");\n'
              "  return off && std::atoi(off) == move;\n}\n")])
    replace(room / "runs/runs.hpp",
            [("#pragma once\n", '#pragma once\n#include "prune/consensus/constants.hpp"\n')])
    for k, (source, behind, left_out) in enumerate(MOVES.values()):
        text = behind + left_out.format(off=f"is_off({k})") + "\n"
        replace(room / source, [(behind, text)])
    loop = "for (const StartScales& start : std::span(kStarts).first(kStartsAlways)) {"
    replace(room / "search/starts.hpp",
            [(loop, f'int number = 0;\n  {loop}\n'
                    f'    const char* without = std::getenv("{PREFIX}kStarts");\n'
                    "    if (without && number++ == std::atoi(without)) continue;"),
             ("#pragma once\n", "#pragma once\n#include <cstdlib>\n")])


def prepare(command, data, graph, variant, kind, cells):
    """Writes the graph of a cell and its labels, once; how it went, as run_all() wants it."""
    name = f"{graph}-{variant}-{kind}"
    changed = variants.VARIANTS[variant](variants.read(path_of(graph, data)),
                                         random.Random(f"{graph} {SEED}"))
    if all(edge.is_odometry for edge in changed.edges):
        return {"file": None}
    with tempfile.TemporaryDirectory() as folder:
        clean = pathlib.Path(folder) / "clean.g2o"
        variants.write(changed, clean)
        fraction = ["--fraction", 0.5, "--type", kind] if kind != "clean" else ["--count", 0]
        command.run("corrupt", clean, "-o", cells / f"{name}.g2o", "--labels",
                    cells / f"{name}.csv", "--seed", SEED, *fraction)
    return {"file": str(cells / name)}


def measure(command, flags, cells):
    """All cells in one row."""
    row = {"cells": 0, "right": 0, "true pruned": 0, "true ambiguous": 0, "false kept": 0,
           "false ambiguous": 0, "seconds": 0.0, "evidence": []}
    for cell in cells:
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            usage = command.run("prune", cell + ".g2o", "--verdicts", work / "v.csv", "--json",
                                work / "r.json", *flags)
            counts = counted(read_csv(work / "v.csv"), read_csv(cell + ".csv"))
            answer = json.loads((work / "r.json").read_text("utf-8"))
        row["evidence"].append(answer["consensus"]["log_evidence"])
        row["seconds"] += usage.ru_utime
        for key in ("true pruned", "true ambiguous", "false kept", "false ambiguous"):
            row[key] += counts[key]
        if true_loops(counts) >= FEW:
            row["cells"] += 1
            row["right"] += min(precision_recall(counts)) >= 0.98
    return row


def page(base, rows, cell_count):
    lines = ["# What constants and moves are worth", "",
             "Made by `benchmarks/ablation.py`: consensus with one constant changed at a time, or",
             f"one move of its search not made, on {cell_count} graphs that none was chosen on",
             f"(variants and false loops drawn with seed {SEED}, clean and with half of the loops",
             "false; every row is in [data/ablation.csv](data/ablation.csv)). *Right*: cells with at least "
             f"{FEW} true loops whose", "precision and recall of what is not pruned are both "
             "≥ .98. *Evidence*: cells in which that of", f"the answer is higher and lower by more "
             f"than {NATS:g} nat; where the model itself is changed it", "cannot be compared. "
             "*Seconds*: CPU time against the first row's.", "",
             f"As they are: {base['right']} of {base['cells']} cells right.", "",
             "| constant | what it is | value | tried | right | true loops pruned | true ambiguous |"
             " false kept | false ambiguous | evidence +/- | seconds |",
             "|---|---|---|---|---|---|---|---|---|---|---|",
             line_of("as they are", "", "", "", base, base, True)]
    for constant in CONSTANTS:
        model = constant.name in ("kScaleDeviation", "kScaleStep", "kLoopsBefore", "kTailDof",
                                  "kReach", "kBiasDeviation", "kFalseFollowing",
                                  "kFalseByChance")
        lines += [line_of(f"`{constant.name}`", constant.meaning, constant.value, f"{value:g}",
                          rows[f"{constant.name}={value:g}"], base, not model)
                  for value in constant.tried if f"{constant.name}={value:g}" in rows]
    lines += [line_of("`kStarts`", "scales that climbs start from", "four", f"without {name}",
                      rows[f"kStarts={k}"], base, True)
              for k, name in enumerate(STARTS) if f"kStarts={k}" in rows]
    lines += [line_of("move", name, "made", "not", rows[f"kMoves={k}"], base,
                      name not in MODEL_MOVES)
              for k, name in enumerate(MOVES) if f"kMoves={k}" in rows]
    lines += [line_of("option", "", "20" if "window" in name else "learnt", name, rows[name], base,
                      False) for name in FLAGS if name in rows]
    return "\n".join(lines) + "\n"


def line_of(name, meaning, value, tried, row, base, comparable):
    pairs = list(zip(row["evidence"], base["evidence"]))
    higher = sum(a > b + NATS for a, b in pairs)
    lower = sum(a < b - NATS for a, b in pairs)
    evidence = f"{higher}/{lower}" if comparable else "–"
    return (f"| {name} | {meaning} | {value} | {tried} | {row['right']} | {row['true pruned']} | "
            f"{row['true ambiguous']} | {row['false kept']} | {row['false ambiguous']} | {evidence} "
            f"| {row['seconds'] / base['seconds']:.2f} |")


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", help="a command built by this script before")
    parser.add_argument("--every", type=int, default=EVERY, help="take every so many cells")
    options = parser.parse_args()
    folder = ROOT / "build" / "ablation"
    cells = folder / "cells"
    cells.mkdir(parents=True, exist_ok=True)
    program = options.isotherm or build(folder, instrument)
    known = Results(folder / "prepared")
    kinds = [(graph, variant, kind) for graph in SMALL for variant in variants.VARIANTS
             for kind in ("clean", *TYPES)][::options.every]
    tasks = {"-".join(kind): functools.partial(prepare, Command(program), pathlib.Path(options.data),
                                               *kind, cells) for kind in kinds}
    run_all(tasks, known, options.jobs)
    files = [row["file"] for row in map(known.get, tasks) if row["file"]]
    runs = {"base": ({}, [])}
    runs |= {f"{constant.name}={value:g}": ({constant.name: value}, [])
             for constant in CONSTANTS for value in constant.tried}
    runs |= {f"kStarts={k}": ({"kStarts": k}, []) for k in range(len(STARTS))}
    runs |= {f"kMoves={k}": ({"kMoves": k}, []) for k in range(len(MOVES))}
    runs |= {name: ({}, flags) for name, flags in FLAGS.items()}
    results = Results(folder / "runs")
    if not options.page_only:
        run_all({name: functools.partial(measure, Changed(program, environment), flags, files)
                 for name, (environment, flags) in runs.items()}, results, options.jobs)
    rows = {name: results.get(name) for name in runs}
    rows = {name: row for name, row in rows.items() if row and "cells" in row}
    target = ROOT / "docs" / "results"
    columns = ["run", *(key for key in rows["base"] if key != "evidence")]
    write_csv(target / "data" / "ablation.csv", columns,
              [{key: ({"run": name} | row)[key] for key in columns} for name, row in rows.items()])
    (target / "ablation.md").write_text(page(rows["base"], rows, len(files)), encoding="utf-8")
    print(f"ablation: wrote {target / 'ablation.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
