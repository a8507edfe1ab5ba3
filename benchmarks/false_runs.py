#!/usr/bin/env python3
"""What pruning methods make of false loops that agree with each other.

A detector that takes one place for another does so for a while: each false loop measures what the
one before it does, with an error of its own. On simulated cities as many false loops as true ones,
in runs of eight along both ends. Writes docs/results/false-runs.md and
docs/results/data/false_runs.csv. Every cell is kept in build/false_runs, so that an interrupted run
goes on where it stopped.
"""

import functools
import math
import pathlib
import random
import sys
import tempfile

from support import variants
from support.experiment import ROOT, argument_parser
from support.runs import Command, Results, read_csv, run_all, write_csv

METHODS = ["consensus", "gnc", "rrr", "pcm"]
LOOPS = [30, 100, 300]
POSES = [400, 900]
SEEDS = range(1, 5)
RUN = 8  # false loops in a row
SHORTEST = 30  # poses between the ends of a false loop, at least
SAID = ["keep", "prune", "ambiguous"]


def false_run(draw, poses, like):
    """Loops that tell nearly the same transform, with errors as stated, at successive poses."""
    first = draw.randrange(poses - RUN - SHORTEST)
    second = draw.randrange(first + SHORTEST, poses - RUN)
    information = like.values[3:]
    sigma = [1.0 / math.sqrt(information[k]) for k in (0, 3, 5)]
    mistaken = [draw.gauss(0.0, 0.5), draw.gauss(0.0, 0.5), 0.0]
    return [variants.Edge(like.tag, (first + k, second + k),
                          [draw.gauss(m, s) for m, s in zip(mistaken, sigma)] + information)
            for k in range(RUN)]


def write_cell(command, work, poses, loops, seed):
    """A graph and its labels; how many loops are true."""
    command.run("simulate", "city", "--poses", poses, "--loops", loops, "--seed", seed, "-o",
                work / "clean.g2o")
    graph = variants.read(work / "clean.g2o")
    true = [edge for edge in graph.edges if not edge.is_odometry]
    draw = random.Random(f"{poses} {loops} {seed}")
    while len(graph.edges) < poses - 1 + 2 * len(true):
        graph.edges += false_run(draw, poses, true[0])
    variants.write(graph, work / "v.g2o")
    write_csv(work / "labels.csv", ["edge", "from", "to", "label"], [
        {"edge": number, "from": edge.ends[0], "to": edge.ends[1],
         "label": "correct" if number < poses - 1 + len(true) else "incorrect"}
        for number, edge in enumerate(graph.edges) if not edge.is_odometry])
    return len(true)


def measure(command, poses, loops, seed, method):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        true = write_cell(command, work, poses, loops, seed)
        command.run("prune", work / "v.g2o", "--method", method, "--verdicts", work / "p.csv")
        labels = {row["edge"]: row["label"] for row in read_csv(work / "labels.csv")}
        said = [(labels[row["edge"]], row["verdict"]) for row in read_csv(work / "p.csv")]
    return {"poses": poses, "loops": loops, "seed": seed, "method": method, "true": true,
            "false": len(labels) - true} | {
                f"{name} {verdict}": said.count((label, verdict))
                for name, label in (("true", "correct"), ("false", "incorrect")) for verdict in SAID}


def page(rows):
    lines = ["# False loops that agree with each other", "",
             "Made by `benchmarks/false_runs.py`; every cell is in "
             "[data/false_runs.csv](data/false_runs.csv).",
             f"Simulated cities of {' and '.join(map(str, POSES))} poses, {len(SEEDS)} seeds each, "
             "with as many false loops as true", f"ones: runs of {RUN} that tell the same transform "
             "but for errors as the file states them.", "",
             "| true loops | method | true | pruned | ambiguous | false | kept | ambiguous |",
             "|---|---|---|---|---|---|---|---|"]
    for loops in LOOPS:
        for method in METHODS:
            cells = [row for row in rows if (row["loops"], row["method"]) == (loops, method)]
            total = lambda key: sum(row[key] for row in cells)
            lines.append(f"| {loops} | {method} | {total('true')} | {total('true prune')} "
                         f"| {total('true ambiguous')} | {total('false')} | {total('false keep')} "
                         f"| {total('false ambiguous')} |")
    lines += ["", "Consensus counts a run that agrees as so many coincidences, and where true loops "
              "are few and far", "between it may outvote them at scales that it learns. GNC holds to "
              "the file's scales, which are", "right here; where they are not see "
              "[Do no harm](harm.md)."]
    return "\n".join(lines) + "\n"


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", default=ROOT / "build" / "release" / "apps" / "isotherm")
    options = parser.parse_args()
    command = Command(options.isotherm)
    results = Results(ROOT / "build" / "false_runs")
    tasks = {f"{poses}-{loops}-{seed}-{method}":
             functools.partial(measure, command, poses, loops, seed, method)
             for poses in POSES for loops in LOOPS for seed in SEEDS for method in METHODS}
    if not options.page_only:
        run_all(tasks, results, options.jobs)
    rows = [row for row in map(results.get, tasks) if row and "poses" in row]
    target = ROOT / "docs" / "results"
    write_csv(target / "data" / "false_runs.csv", list(rows[0]), rows)
    (target / "false-runs.md").write_text(page(rows), encoding="utf-8")
    print(f"false_runs: wrote {target / 'false-runs.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
