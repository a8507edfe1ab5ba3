#!/usr/bin/env python3
"""What consensus makes of corrupted graphs, and whether its probabilities are true.

Every small graph in every variant of support/variants.py, with half of all loops false, of two
types. Writes docs/results/corrupted.md and docs/results/data/corrupted.csv: precision and recall,
how often loops of a stated probability were true, and the log evidence of our answers against that
of other methods' and of the labels. Every cell is kept in build/corrupted, so that an interrupted
run goes on where it stopped.
"""

import functools
import math
import pathlib
import random
import sys
import tempfile

from harm import FEW, SMALL, path_of
from support import variants
from support.experiment import ROOT, argument_parser
from support.runs import Command, Results, read_csv, run_all, write_csv

TYPES = ["random-grouped", "local-grouped"]
RIVALS = ["gnc", "rrr", "chi2"]
COMPARED = ["as it is", "heading 0.2 mrad a step"]  # with rivals
BINS = [1e-8, 1e-4, 1e-2, 0.1, 0.5, 0.9, 0.99, 0.9999, 1 - 1e-8]  # of probabilities
SETTLED = "consensus, settled"
NATS = 1.0  # by which evidence is higher; less is how far poses and scales have settled
COLUMNS = ["graph", "variant", "type", "true kept", "true pruned", "true ambiguous", "false kept",
           "false pruned", "false ambiguous", "bins", "evidence"]


def measure(command, data, graph, variant, kind, dominance):
    clean = variants.VARIANTS[variant](variants.read(path_of(graph, data)),
                                       random.Random(f"{graph} 1"))
    row = {"graph": graph, "variant": variant, "type": kind}
    if all(edge.is_odometry for edge in clean.edges):
        return row
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        variants.write(clean, work / "v.g2o")
        command.run("corrupt", work / "v.g2o", "-o", work / "c.g2o", "--labels", work / "l.csv",
                    "--type", kind, "--fraction", 0.5, "--seed", 1)
        answer = command.json(work, "prune", work / "c.g2o", "--verdicts", work / "v.csv")
        row |= counted(read_csv(work / "v.csv"), read_csv(work / "l.csv"))
        row["evidence"] = {"consensus": answer["consensus"]["log_evidence"]}
        if dominance:
            row["evidence"] |= evidence_of_answers(command, work)
    return row


def counted(verdicts, labels):
    labels = {label["edge"]: label["label"] for label in labels}
    counts = {f"{true} {said}": 0 for true in ("true", "false")
              for said in ("kept", "pruned", "ambiguous")}
    bins = [[0, 0, 0.0] for _ in range(len(BINS) + 1)]  # loops, of these true, and as stated
    for verdict in verdicts:
        if labels[verdict["edge"]] == "ignore":  # false, but what it says is true
            continue
        true = labels[verdict["edge"]] == "correct"
        said = {"keep": "kept", "prune": "pruned"}.get(verdict["verdict"], "ambiguous")
        counts[f"{'true' if true else 'false'} {said}"] += 1
        share = float(verdict["probability"] or "nan")
        if not math.isnan(share):
            own = bins[sum(share >= edge for edge in BINS)]
            own[0] += 1
            own[1] += true
            own[2] += share
    return counts | {"bins": bins}


def evidence_of_answers(command, work):
    """Of what each keeps, explained as well as one can."""

    def settled(option, file):
        return command.json(work, "eval", "evidence", work / "c.g2o", option,
                            work / file)["log_evidence"]

    evidence = {SETTLED: settled("--verdicts", "v.csv"), "labels": settled("--labels", "l.csv")}
    for method in RIVALS:
        command.run("prune", work / "c.g2o", "--method", method, "--verdicts", work / "r.csv")
        evidence[method] = settled("--verdicts", "r.csv")
    return evidence


def true_loops(row):
    return sum(row[f"true {said}"] for said in ("kept", "pruned", "ambiguous"))


def precision_recall(row):
    """Of what is not pruned."""
    true = row["true kept"] + row["true ambiguous"]
    left = true + row["false kept"] + row["false ambiguous"]
    return true / left if left else 1.0, true / max(true + row["true pruned"], 1)


def page(rows):
    few = [row for row in rows if true_loops(row) < FEW]
    many = [row for row in rows if true_loops(row) >= FEW]
    worst = [min(precision_recall(row)) for row in many]
    lines = ["# Half of all loops false", "",
             "Made by `benchmarks/corrupted.py`; every cell is in",
             "[data/corrupted.csv](data/corrupted.csv). Graphs of [Do no harm](harm.md) in its",
             "variants, seed 1, with as many false loops as true ones, in groups.", "",
             "## Precision and recall of what is not pruned", "",
             f"Cells with at least {FEW} true loops. Where fewer than {FEW} are found true none is pruned: in",
             f"the other {len(few)} cells {sum(row['true pruned'] for row in few)} of "
             f"{sum(map(true_loops, few))} true loops are pruned, and of as many false ones",
             f"{sum(row['false pruned'] for row in few)}; "
             f"{sum(row['false kept'] for row in few)} are kept.", "",
             "| type | cells | both ≥ .98 | both ≥ .90 | true loops pruned | false loops kept | "
             "false ambiguous |", "|---|---|---|---|---|---|---|"]
    for kind in TYPES:
        mine = [(row, low) for row, low in zip(many, worst) if row["type"] == kind]
        lines.append(f"| {kind} | {len(mine)} | {sum(low >= 0.98 for _, low in mine)} | "
                     f"{sum(low >= 0.9 for _, low in mine)} | "
                     + " | ".join(str(sum(row[key] for row, _ in mine)) for key in
                                  ("true pruned", "false kept", "false ambiguous")) + " |")
    lines += ["", "Cells below .90:", ""]
    lines += [f"- {row['graph']}, {row['variant']}, {row['type']}: of "
              f"{true_loops(row)} true loops {row['true pruned']} pruned; of "
              f"{sum(row[k] for k in COLUMNS[6:9])} false ones {row['false kept']} kept and "
              f"{row['false ambiguous']} ambiguous"
              for row, low in zip(many, worst) if low < 0.9]
    return "\n".join(lines + calibration(rows) + dominance(rows)) + "\n"


def calibration(rows):
    lines = ["", "## Stated probability against share true", "",
             "*odds* are those of the share true against those of the mean that was stated, where some are",
             "true and some false.", "",
             "| probability | loops | stated, mean | true | share | odds |", "|---|---|---|---|---|---|"]
    names = [f"below {BINS[0]:g}", *(f"{a:.10g} to {b:.10g}" for a, b in zip(BINS, BINS[1:])),
             f"from {BINS[-1]:.10g}"]
    for k, name in enumerate(names):
        loops, true, stated = (sum(row["bins"][k][part] for row in rows) for part in range(3))
        if not loops:
            continue
        odds = f"{true / (loops - true) * (loops - stated) / stated:.2g}" if 0 < true < loops else ""
        lines.append(f"| {name} | {loops} | {stated / loops:.3g} | {true} | {true / loops:.6f} | {odds} |")
    return lines


def dominance(rows):
    compared = [row for row in rows if len(row["evidence"]) > 1]
    if not compared:
        return []
    names = [*RIVALS, "labels"]

    def ours(row):
        return max(row["evidence"][name] for name in ("consensus", SETTLED))

    def better(name, own):
        return [row for row in compared if row["evidence"][name] > own(row) + NATS]

    told = sum(len(better(name, lambda row: row["evidence"]["consensus"])) for name in names)
    cells = {name: better(name, ours) for name in names}
    lines = ["", "## Evidence", "",
             f"Of {len(compared)} cells, how often the log evidence of an answer is higher than that",
             f"of consensus by more than {NATS:g}. Of every answer it is what `isotherm eval evidence`",
             "finds of the loops that it keeps, of consensus what `prune` tells where that is more.",
             f"What `prune` tells alone is less than another answer's in {told} of "
             f"{len(names) * len(compared)}: of", "many loops it stops sooner.",
             "", "| answer | cells |", "|---|---|"]
    lines += [f"| {name} | {len(of_name)} |" for name, of_name in cells.items()]
    lines += [""] + [f"- {name}: {row['graph']}, {row['variant']}, {row['type']}, by "
                     f"{row['evidence'][name] - ours(row):.1f}"
                     for name, of_name in cells.items() for row in of_name]
    return lines


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", default=ROOT / "build" / "release" / "apps" / "isotherm")
    parser.add_argument("--no-dominance", action="store_true", help="leave other methods out")
    parser.add_argument("--time-limit", type=int, default=600, help="seconds a run")
    options = parser.parse_args()
    command = Command(options.isotherm, options.time_limit)
    results = Results(ROOT / "build" / "corrupted")
    tasks = {f"{graph}-{variant}-{kind}": functools.partial(
        measure, command, pathlib.Path(options.data), graph, variant, kind,
        variant in COMPARED and not options.no_dominance)
        for graph in SMALL for variant in variants.VARIANTS for kind in TYPES}
    if not options.page_only:
        run_all(tasks, results, options.jobs)
    rows = [row for row in map(results.get, tasks) if row and "bins" in row]
    target = ROOT / "docs" / "results"
    write_csv(target / "data" / "corrupted.csv", COLUMNS, rows)
    (target / "corrupted.md").write_text(page(rows), encoding="utf-8")
    print(f"corrupted: wrote {target / 'corrupted.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
