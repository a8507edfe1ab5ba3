#!/usr/bin/env python3
"""What pruning methods make of false loops that agree with each other.

A detector that takes one place for another does so for a while: each false loop measures what the
one before it does, or what would follow from that round the turns of both ways (two floors alike),
with an error of its own. On simulated cities as many false loops as true ones, in runs of eight
along both ends. Writes docs/results/false-runs.md and docs/results/data/false_runs.csv. Every cell
is kept in build/false_runs, so that an interrupted run goes on where it stopped.
"""

import functools
import itertools
import math
import pathlib
import random
import sys
import tempfile

from reproduce import planar
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
TELLS = ["the same", "what follows"]


def false_run(draw, way, like, tells):
    """Loops at successive poses that tell nearly the same transform, with errors as stated, or
    what follows from the first one's by the `way` from it at both ends."""
    first = draw.randrange(len(way) - RUN - SHORTEST)
    second = draw.randrange(first + SHORTEST, len(way) - RUN)
    information = like.values[3:]
    sigma = [1.0 / math.sqrt(information[k]) for k in (0, 3, 5)]
    mistaken = [draw.gauss(0.0, 0.5), draw.gauss(0.0, 0.5), 0.0]
    run = []
    for k in range(RUN):
        told = mistaken
        if tells == "what follows":
            there, back = (planar.between(way[end], way[end + k]) for end in (first, second))
            *told, heading = planar.compose(planar.between(there, mistaken), back)
            told.append(math.remainder(heading, 2.0 * math.pi))
        run.append(variants.Edge(like.tag, (first + k, second + k),
                                 [draw.gauss(m, s) for m, s in zip(told, sigma)] + information))
    return run


def write_cell(command, work, poses, loops, seed, tells):
    """A graph and its labels; how many loops are true."""
    command.run("simulate", "city", "--poses", poses, "--loops", loops, "--seed", seed, "-o",
                work / "clean.g2o")
    graph = variants.read(work / "clean.g2o")
    true = [edge for edge in graph.edges if not edge.is_odometry]
    way = [[0.0, 0.0, 0.0]]
    for edge in graph.edges:
        if edge.is_odometry:
            way.append(planar.compose(way[-1], edge.values[:3]))
    draw = random.Random(f"{poses} {loops} {seed}")
    while len(graph.edges) < poses - 1 + 2 * len(true):
        graph.edges += false_run(draw, way, true[0], tells)
    variants.write(graph, work / "v.g2o")
    write_csv(work / "labels.csv", ["edge", "from", "to", "label"], [
        {"edge": number, "from": edge.ends[0], "to": edge.ends[1],
         "label": "correct" if number < poses - 1 + len(true) else "incorrect"}
        for number, edge in enumerate(graph.edges) if not edge.is_odometry])
    return len(true)


def measure(command, poses, loops, seed, tells, method):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        true = write_cell(command, work, poses, loops, seed, tells)
        command.run("prune", work / "v.g2o", "--method", method, "--verdicts", work / "p.csv")
        labels = {row["edge"]: row["label"] for row in read_csv(work / "labels.csv")}
        said = [(labels[row["edge"]], row["verdict"]) for row in read_csv(work / "p.csv")]
    return {"poses": poses, "loops": loops, "seed": seed, "tells": tells, "method": method,
            "true": true, "false": len(labels) - true} | {
                f"{name} {verdict}": said.count((label, verdict))
                for name, label in (("true", "correct"), ("false", "incorrect")) for verdict in SAID}


def page(rows):
    lines = ["# False loops that agree with each other", "",
             "Made by `benchmarks/false_runs.py`; every cell is in "
             "[data/false_runs.csv](data/false_runs.csv).",
             f"Simulated cities of {' and '.join(map(str, POSES))} poses, {len(SEEDS)} seeds each, "
             "with as many false loops as true",
             f"ones in runs of {RUN}. Each run tells the same transform all along, or what follows "
             "from its first one round the", "turns of both ways, but for errors as the file states "
             "them.", "",
             "| true loops | runs tell | method | true | pruned | ambiguous | false | kept "
             "| ambiguous |",
             "|---|---|---|---|---|---|---|---|---|"]
    for loops, tells, method in itertools.product(LOOPS, TELLS, METHODS):
        cells = [row for row in rows
                 if (row["loops"], row["tells"], row["method"]) == (loops, tells, method)]
        total = lambda key: sum(row[key] for row in cells)
        lines.append(f"| {loops} | {tells} | {method} | {total('true')} | {total('true prune')} "
                     f"| {total('true ambiguous')} | {total('false')} | {total('false keep')} "
                     f"| {total('false ambiguous')} |")
    lines += ["", "Consensus knows that false loops may follow false ones: that they agree proves nothing. "
              "What it keeps", "are runs whose first loop fits by chance, at scales that it learns. GNC "
              "holds to the file's scales, which", "are right here; where they are not see "
              "[Do no harm](harm.md)."]
    return "\n".join(lines) + "\n"


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", default=ROOT / "build" / "release" / "apps" / "isotherm")
    options = parser.parse_args()
    command = Command(options.isotherm)
    results = Results(ROOT / "build" / "false_runs")
    tasks = {"-".join(map(str, cell)): functools.partial(measure, command, *cell)
             for cell in itertools.product(POSES, LOOPS, SEEDS, TELLS, METHODS)}
    if not options.page_only:
        run_all(tasks, results, options.jobs)
    rows = [row for row in map(results.get, tasks) if row and "poses" in row]
    target = ROOT / "docs" / "results"
    write_csv(target / "data" / "false_runs.csv", list(rows[0]), rows)
    (target / "false-runs.md").write_text(page(rows), encoding="utf-8")
    print(f"false_runs: wrote {target / 'false-runs.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
