#!/usr/bin/env python3
"""How many true loops each method prunes from clean graphs, however they are presented.

Every graph in every variant of support/variants.py; variants that draw at random with three
seeds. Writes docs/results/harm.md and docs/results/data/harm.csv. Every cell is kept in
build/harm, so that an interrupted run goes on where it stopped. What consensus was before it went
by evidence only an older version can measure: its rows are taken from the present harm.csv.
"""

import functools
import pathlib
import random
import sys
import tempfile

from support import variants
from support.experiment import ROOT, argument_parser
from support.runs import Command, Results, read_csv, run_all, write_csv

METHODS = ["consensus", "gnc", "rrr"]
EARLIER = "earlier consensus"
SMALL = ["MIT", "CSAIL", "intel", "ring", "ringCity", "kitti_00", "kitti_02", "kitti_06",
         "kitti_07", "kitti_09", "B25b_0.600", "tinyGrid3D", "smallGrid3D"]
LARGE = ["parking-garage", "sphere2500", "torus3D", "sphere_a", "ais2klinik", "city10000",
         "cubicle"]
FEW = 5  # loops below which none can be proven


def path_of(graph, data):
    if graph.startswith("kitti_"):
        return data / "paper" / "kitti" / f"{graph}.g2o"
    if graph.startswith("B25b_"):
        return data / "paper" / "b25b" / f"{graph}.g2o"
    if graph.startswith("ring"):
        return data / "posegraph2d" / graph / "originalDataset" / f"{graph}.g2o"
    folder = "posegraph2d" if (data / "posegraph2d" / graph).exists() else "posegraph3d"
    suffix = ".g2o.gz" if graph in ("torus3D", "sphere_a") else ".g2o"
    return data / folder / graph / f"{graph}{suffix}"


def measure(command, data, graph, variant, seed, method):
    changed = variants.VARIANTS[variant](variants.read(path_of(graph, data)),
                                         random.Random(f"{graph} {seed}"))
    loops = sum(not edge.is_odometry for edge in changed.edges)
    row = {"graph": graph, "variant": variant, "seed": seed, "method": method, "loops": loops}
    if not loops:
        return row | {"pruned": 0, "ambiguous": 0}
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        variants.write(changed, work / "v.g2o")
        answer = command.json(work, "prune", work / "v.g2o", "--method", method)
    return row | {key: answer[key] for key in ("pruned", "ambiguous")}


def harmed(row):
    return row["pruned"] > (0 if row["loops"] < FEW else max(1, 0.005 * row["loops"]))


def unsure(row):
    return row["loops"] >= FEW and row["ambiguous"] > 0.05 * row["loops"]


def misses(rows):
    """Cells of consensus in which more is pruned or ambiguous than should be, as lines."""
    missed = [row for row in rows if row["method"] == METHODS[0] and (harmed(row) or unsure(row))]
    if not missed:
        return []
    return ["", "Consensus prunes too many in these cells, or leaves more than 5 % ambiguous:", ""] + [
        f"- {row['graph']}, {row['variant']}, seed {row['seed']}: of {row['loops']} loops"
        f" {row['pruned']} pruned, {row['ambiguous']} ambiguous" for row in missed]


def page(rows, unfinished, quick):
    lines = ["# Do no harm: clean graphs, however they are presented", "",
             f"Made by `benchmarks/harm.py{' --quick' if quick else ''}`; every cell is in "
             "[data/harm.csv](data/harm.csv). All",
             "loops are true. A graph is harmed that loses more than one of them and more than",
             f"0.5 %, or any where there are fewer than {FEW}. Each method is counted on what was",
             "measured of it.", ""]
    if any(row["method"] == EARLIER for row in rows):
        lines[-1:] = ["The earlier consensus, a search by gates, is of a version before consensus went by",
                      "evidence, and is not measured again.", ""]
    shown = [METHODS[0], EARLIER, *METHODS[1:]]
    methods = [m for m in shown if any(row["method"] == m for row in rows)]
    lines += ["| variant | " + " | ".join(f"harmed by {m} | loops pruned" for m in methods) + " |",
              "|---" * (1 + 2 * len(methods)) + "|"]
    for variant in variants.VARIANTS:
        cells = [row for row in rows if row["variant"] == variant]
        line = f"| {variant} |"
        for method in methods:
            mine = [row for row in cells if row["method"] == method]
            line += f" {sum(map(harmed, mine))} of {len(mine)} |"
            line += f" {sum(row['pruned'] for row in mine)} of {sum(row['loops'] for row in mine)} |"
        lines.append(line)
    lines += misses(rows)
    if unfinished:
        lines += ["", f"{unfinished} runs did not end in the time allowed and are left out."]
    return "\n".join(lines) + "\n"


def rows_of_others(path, methods, graphs):
    """What was measured before of methods and graphs that are not measured now."""
    if not path.exists():
        return []
    return [row | {key: int(row[key]) for key in ("seed", "loops", "pruned", "ambiguous")}
            for row in read_csv(path)
            if row["method"] not in methods or row["graph"] not in graphs]


def main():
    parser = argument_parser(__doc__)
    parser.add_argument("--isotherm", default=ROOT / "build" / "release" / "apps" / "isotherm")
    parser.add_argument("--quick", action="store_true", help="small graphs, one seed")
    parser.add_argument("--graphs", nargs="+", default=SMALL + LARGE, choices=SMALL + LARGE,
                        help="measure these alone; of the others what is there stays")
    parser.add_argument("--methods", nargs="+", default=METHODS, choices=METHODS)
    parser.add_argument("--time-limit", type=int, default=600, help="seconds a run")
    options = parser.parse_args()
    command = Command(options.isotherm, options.time_limit)
    results = Results(ROOT / "build" / "harm")
    tasks = {}
    graphs = [graph for graph in options.graphs if graph in SMALL or not options.quick]
    for graph in graphs:
        for variant in variants.VARIANTS:
            drawn = variant in variants.RANDOM and not options.quick
            for seed in range(1, 4 if drawn else 2):
                for method in options.methods:
                    tasks[f"{graph}-{variant}-{seed}-{method}"] = functools.partial(
                        measure, command, pathlib.Path(options.data), graph, variant, seed, method)
    if not options.page_only:
        run_all(tasks, results, options.jobs)
    found = [row for row in map(results.get, tasks) if row]
    target = ROOT / "docs" / "results"
    measured = [row for row in found if "graph" in row]
    rows = measured + rows_of_others(target / "data" / "harm.csv", options.methods, graphs)
    (target / "data").mkdir(parents=True, exist_ok=True)
    write_csv(target / "data" / "harm.csv",
              ["graph", "variant", "seed", "method", "loops", "pruned", "ambiguous"], rows)
    (target / "harm.md").write_text(page(rows, len(found) - len(measured), options.quick),
                                    encoding="utf-8")
    print(f"harm: wrote {target / 'harm.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
