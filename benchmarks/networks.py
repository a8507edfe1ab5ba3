#!/usr/bin/env python3
"""Compares `isotherm localize` with plain least squares and classical MDS-MAP on
simulated networks, runs it on real ranges, and writes docs/results/networks.md.

usage: scripts/build.sh release
       $(scripts/python-env.sh) benchmarks/networks.py [--sizes N ...] [--budget SECONDS] [DATA]

Every cell is kept in build/networks.json as soon as it is measured; a run that is stopped goes on
where it was. --sizes takes networks of these numbers of nodes only, 0 the real ranges; --budget
stops measuring after so many seconds and writes what there is. DATA is the folder of data sets
(default $ISOTHERM_DATA or ../shared/data).
"""
import argparse
import csv
import gzip
import itertools
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.sparse.linalg import LinearOperator, eigsh

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMAND = os.environ.get("ISOTHERM", str(ROOT / "build/release/apps/isotherm"))
STORE = ROOT / "build/networks.json"
PAGE = ROOT / "docs/results/networks.md"

DEGREES = (12, 20)
NOISES = (0.01, 0.05, 0.10)
FAULTS = [("none", 0.0)] + list(itertools.product(("false", "biased"), (0.1, 0.2, 0.3)))
# The cells that matter most are measured first, after those whose estimates the others use.
BY_INTEREST = sorted(FAULTS, key=lambda fault: (0.0, 0.2, 0.1, 0.3).index(fault[1]))
SEEDS = {100: (1, 2, 3), 1000: (1, 2, 3), 10000: (1,)}


def run(*arguments):
    subprocess.run([COMMAND, *map(str, arguments), "-q"], check=True, capture_output=True)


def read_rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def read_positions(path):
    rows = [row for row in read_rows(path) if row.get("status", "anchor") in ("anchor", "localised")]
    axes = [axis for axis in "xyz" if rows and axis in rows[0]]
    return {row["node"]: np.array([float(row[axis]) for axis in axes]) for row in rows}


def rmsd(estimate, truth, nodes):
    errors = [estimate[v] - truth[v] for v in nodes]
    return math.sqrt(np.mean([error @ error for error in errors])) if errors else math.nan


def align(points, targets, scale=False):
    """The isometry (similarity) of least squares from points onto targets, as a function."""
    a, b = points.mean(0), targets.mean(0)
    u, s, vt = np.linalg.svd((targets - b).T @ (points - a))
    factor = s.sum() / ((points - a) ** 2).sum() if scale else 1.0
    return lambda x: factor * (x - a) @ (u @ vt).T + b


class Baselines:
    """Classical MDS-MAP, and plain least squares of all ranges from where that ends."""

    def __init__(self, folder, anchors):
        rows = read_rows(folder / "ranges.csv")
        self.names = sorted({row[end] for row in rows for end in ("from", "to")} | set(anchors),
                            key=int)
        place = {name: k for k, name in enumerate(self.names)}
        self.ends = np.array([[place[row["from"]], place[row["to"]]] for row in rows])
        self.ranges = np.array([float(row["range"]) for row in rows])
        self.sigmas = np.array([float(row["sigma"]) for row in rows])
        self.fixed = np.array([place[v] for v in anchors])
        self.anchors = np.array(list(anchors.values()))

    def mds_map(self):
        """Shortest paths, classical scaling, and the best similarity onto the anchors: the
        largest part, and its positions."""
        shape = (len(self.names),) * 2
        graph = coo_matrix((self.ranges, self.ends.T), shape).tocsr()
        _, labels = connected_components(graph, directed=False)
        inside = np.flatnonzero(labels == np.bincount(labels).argmax())
        squared = dijkstra(graph[inside][:, inside], directed=False)
        np.square(squared, out=squared)
        means = squared.mean(0)

        def centred(x):  # the inner products, -1/2 J D J, without another matrix of n^2 numbers
            x = x.ravel()
            return -0.5 * (squared @ x - means * x.sum() - means @ x + means.mean() * x.sum())

        n = len(inside)
        products = LinearOperator((n, n), matvec=centred, dtype=float)
        values, vectors = eigsh(products, k=2, which="LA", v0=np.linspace(-1.0, 2.0, n))
        points = vectors * np.sqrt(np.maximum(values, 0.0))
        known = np.isin(self.fixed, inside)
        if known.sum() < 3:
            return inside[:0], points[:0]
        move = align(points[np.searchsorted(inside, self.fixed[known])], self.anchors[known], True)
        return inside, move(points)

    def least_squares(self, inside, points):
        """All ranges of the part, by a trust region with sparse steps (lsmr)."""
        place = np.full(len(self.names), -1)
        place[inside] = np.arange(len(inside))
        use = (place[self.ends] >= 0).all(1)
        a, b = place[self.ends[use]].T
        ranges, sigmas = self.ranges[use], self.sigmas[use]
        known = np.isin(self.fixed, inside)
        start = points.copy()
        start[place[self.fixed[known]]] = self.anchors[known]
        free = np.setdiff1d(np.arange(len(inside)), place[self.fixed[known]])
        column = np.full(len(inside), -1)
        column[free] = np.arange(len(free))

        def arms(x):
            positions = start.copy()
            positions[free] = x.reshape(-1, 2)
            arm = positions[a] - positions[b]
            return arm, np.maximum(np.linalg.norm(arm, axis=1), 1e-12)

        def residuals(x):
            return (arms(x)[1] - ranges) / sigmas

        def jacobian(x):
            arm, length = arms(x)
            slope = arm / (length * sigmas)[:, None]
            rows = np.arange(len(ranges))
            entries = [(sign * slope[moves, axis], rows[moves], 2 * column[end[moves]] + axis)
                       for sign, end in ((1.0, a), (-1.0, b)) for moves in [column[end] >= 0]
                       for axis in (0, 1)]
            values, i, j = (np.concatenate(part) for part in zip(*entries))
            return coo_matrix((values, (i, j)), (len(ranges), 2 * len(free))).tocsr()

        found = least_squares(residuals, start[free].ravel(), jac=jacobian, tr_solver="lsmr",
                              max_nfev=100)
        result = start
        result[free] = found.x.reshape(-1, 2)
        return result

    def named(self, inside, points):
        return {self.names[v]: point for v, point in zip(inside, points)}


def localize(folder, name, *options):
    output = folder / f"{name}.csv"
    start = time.perf_counter()
    done = subprocess.run([COMMAND, "localize", folder / "ranges.csv", "--anchors",
                           folder / "anchors.csv", "-o", output, "--json", folder / "result.json",
                           "--verdicts", folder / f"{name}.verdicts", "-q", *map(str, options)],
                          capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise RuntimeError(done.stderr)
    result = json.loads((folder / "result.json").read_text())
    result["wall"] = time.perf_counter() - start
    return read_positions(output), result


def keep_true_ranges(folder):
    """Rewrites ranges.csv with the correct ranges only."""
    labels = [row["label"] for row in read_rows(folder / "labels.csv")]
    lines = (folder / "ranges.csv").read_text().splitlines()
    kept = [line for line, label in zip(lines[1:], labels) if label == "correct"]
    (folder / "ranges.csv").write_text("\n".join([lines[0], *kept]) + "\n")


def simulate(folder, nodes, degree, noise, kind, share, seed):
    fault = [] if kind == "none" else [f"--{kind}-fraction", share]
    run("simulate", "network", "--nodes", nodes, "--degree", degree, "--noise", noise, "--seed",
        seed, *fault, "-o", folder / "ranges.csv", "--anchor-file", folder / "anchors.csv",
        "--ground-truth", folder / "truth.csv", "--labels", folder / "labels.csv")


class CleanEstimates:
    """Positions found in networks without wrong ranges, kept in build/networks/. False ranges are
    added to such a network and leave its own as they are, so that these are also the positions
    from its true ranges alone."""

    def __init__(self, nodes, degree, noise, seed):
        self.network = (nodes, degree, noise, "none", 0.0, seed)
        self.path = STORE.parent / "networks" / f"{nodes}-{degree}-{noise}-{seed}.csv"

    def keep(self, estimate):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(estimate, self.path)

    def get(self, folder):
        if not self.path.exists():
            simulate(folder, *self.network)
            localize(folder, "best")
            self.keep(folder / "best.csv")
        return read_positions(self.path)


def measure(nodes, degree, noise, kind, share, seed):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        simulate(folder, nodes, degree, noise, kind, share, seed)
        truth, anchors = read_positions(folder / "truth.csv"), read_positions(folder / "anchors.csv")
        ours, result = localize(folder, "ours")
        cell = {"seconds": result["seconds"], "localised": result["nodes"]["localised"]}
        clean = CleanEstimates(nodes, degree, noise, seed)
        if kind == "none":
            clean.keep(folder / "ours.csv")
        else:
            loops = subprocess.run([COMMAND, "eval", "loops", folder / "ours.verdicts",
                                    folder / "labels.csv", "--json", "-"],
                                   check=True, capture_output=True, text=True)
            metrics = json.loads(loops.stdout)
            cell.update(precision=metrics["precision"], recall=metrics["recall"])
        free = [v for v in ours if v not in anchors]
        cell["rmsd"] = rmsd(ours, truth, free)
        radius = math.sqrt(degree / (math.pi * nodes))
        cell["far"] = sum(bool(np.linalg.norm(ours[v] - truth[v]) > 0.5 * radius) for v in free)
        if kind != "none":
            if kind == "false":
                best = clean.get(folder)
            else:
                keep_true_ranges(folder)
                best, _ = localize(folder, "best")
            others = [v for v in best if v not in anchors]
            cell["true_only"] = rmsd(best, truth, others)
            cell["true_only_localised"] = len(others)
            both = [v for v in free if v in best]
            cell["common"] = rmsd(ours, truth, both)
            cell["true_only_common"] = rmsd(best, truth, both)
        return cell


def measure_baselines(nodes, degree, noise, kind, share, seed):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        simulate(folder, nodes, degree, noise, kind, share, seed)
        truth, anchors = read_positions(folder / "truth.csv"), read_positions(folder / "anchors.csv")
        baselines = Baselines(folder, anchors)
        inside, scaled = baselines.mds_map()
        fitted = baselines.least_squares(inside, scaled)
        error = lambda points: rmsd(baselines.named(inside, points), truth,
                                    [baselines.names[v] for v in inside
                                     if baselines.names[v] not in anchors])
        return {"mds_map": error(scaled), "least_squares": error(fitted)}


class Store:
    def __init__(self):
        self.cells = json.loads(STORE.read_text()) if STORE.exists() else {}

    def get(self, key, make):
        if key not in self.cells:
            self.cells[key] = make()
            STORE.parent.mkdir(exist_ok=True)
            STORE.write_text(json.dumps(self.cells, indent=1))
        return self.cells[key]


def key_of(*parts):
    return "/".join(map(str, parts))


def baselines_key(*cell):
    return key_of("baselines", *cell)


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def figure(value, digits=4):
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}f}"


def median_of(values):
    """Of the values that are numbers; NaN if none is."""
    numbers = [value for value in values if not math.isnan(value)]
    return float(np.median(numbers)) if numbers else math.nan


def simulated_section(store, nodes):
    """The table of one network size: medians over the seeds that were measured."""
    rows, measured = [], []
    for degree, noise, (kind, share) in itertools.product(DEGREES, NOISES, FAULTS):
        cells = [store.cells.get(key_of(nodes, degree, noise, kind, share, seed))
                 for seed in SEEDS[nodes]]
        cells = [cell for cell in cells if cell]
        if not cells:
            continue
        baselines = [store.cells.get(baselines_key(nodes, degree, noise, kind, share, seed), {})
                     for seed in SEEDS[nodes]]
        measured.append((degree, noise, kind, share))
        median = lambda field: median_of([c[field] for c in cells if field in c])
        baseline = lambda field: median_of([c[field] for c in baselines if field in c])
        ratio = median_of([c["common"] / c["true_only_common"] for c in cells if "common" in c])
        wrong = "–" if kind == "none" else f"{share:.0%} {kind}"
        rows.append([degree, f"{noise:.0%}", wrong, figure(median("rmsd")),
                     figure(baseline("least_squares")),
                     figure(baseline("mds_map")), figure(median("true_only")), figure(ratio, 2),
                     f"{median('localised'):.0f}", figure(median("true_only_localised"), 0),
                     f"{median('far'):.0f}", figure(median("precision"), 3),
                     figure(median("recall"), 3), figure(median("seconds"), 1)])
    if not rows:
        return ""
    header = ["degree", "noise", "wrong ranges", "ours", "least squares", "MDS-MAP",
              "ours, true ranges only", "ratio", "localised", "with true ranges only", "far off",
              "precision", "recall", "s"]
    counts = [sum(key_of(nodes, *cell, seed) in store.cells for seed in SEEDS[nodes])
              for cell in measured]
    note = f", medians of {min(counts)}" + (f" to {max(counts)}" if max(counts) > min(counts) else "")
    note = "" if max(counts) == 1 else note + " networks"
    return f"### {nodes} nodes{note}\n\n{table(header, rows)}\n"


def exceptions_section(store):
    """Every network whose ratio is above 1.5, or with localised nodes far off."""
    rows, networks = [], 0
    for key, cell in store.cells.items():
        if key.count("/") != 5:
            continue
        networks += 1
        ratio = cell.get("common", math.nan) / cell.get("true_only_common", math.nan)
        if not (ratio > 1.5 or cell["far"] > 0):
            continue
        nodes, degree, noise, kind, share, seed = key.split("/")
        faults = "–" if kind == "none" else f"{float(share):.0%} {kind}"
        rows.append([nodes, degree, f"{float(noise):.0%}", faults, seed, figure(cell["rmsd"]),
                     figure(ratio, 2), cell["localised"], cell["far"]])
    header = ["nodes", "degree", "noise", "wrong ranges", "seed", "ours", "ratio", "localised",
              "far off"]
    return (f"### Beyond the target\n\nOf {networks} networks, {len(rows)} have a ratio above 1.5 "
            f"or localised nodes far off:\n\n{table(header, rows)}\n\n{BEYOND}")


def write_csv(path, header, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


def solve(folder, ranges, anchors, truth, *options):
    """RMSD of the nodes with a position, and how many of all there are."""
    write_csv(folder / "ranges.csv", ["from", "to", "range", "sigma"][:len(ranges[0])], ranges)
    axes = ["x", "y", "z"][:len(next(iter(truth.values())))]
    write_csv(folder / "truth.csv", ["node", *axes], [[v, *p] for v, p in truth.items()])
    options = list(options)
    if anchors:
        write_csv(folder / "anchors.csv", ["node", *axes], [[v, *p] for v, p in anchors.items()])
        options += ["--anchors", folder / "anchors.csv"]
    done = subprocess.run([COMMAND, "localize", folder / "ranges.csv", *map(str, options), "-o",
                           folder / "out.csv", "--json", folder / "result.json", "-q"],
                          capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise RuntimeError(done.stderr)
    found = read_positions(folder / "out.csv")
    nodes = [v for v in found if v not in anchors and v in truth]
    if not anchors and nodes:
        move = align(np.array([found[v] for v in nodes]), np.array([truth[v] for v in nodes]))
        found = {v: move(p) for v, p in found.items()}
    result = json.loads((folder / "result.json").read_text())
    errors = [float(np.linalg.norm(found[v] - truth[v])) for v in nodes]
    return {"rmsd": rmsd(found, truth, nodes), "nodes": len(nodes), "max": max(errors, default=math.nan),
            "pruned": result["pruned"], "ranges": result["candidates"]}


def snlpy(data, file, trial, noise):
    """10 anchors and 50 sensors with ranges below 0.3 of the side of the square."""
    anchors, sensors = (np.load(data / f"snl/snlpy_10A50S/{file}{kind}_list.npy")[:, :, trial]
                        for kind in ("anchors", "sensors"))
    points = np.vstack([anchors, sensors])
    random = np.random.default_rng(100 * file + trial)
    ranges = []
    for a, b in itertools.combinations(range(60), 2):
        distance = np.linalg.norm(points[a] - points[b])
        if distance <= 0.3:
            measured = abs(distance * (1 + noise * random.standard_normal()))
            ranges.append([a, b, measured] + ([noise * distance] if noise else []))
    truth = {str(k): p for k, p in enumerate(points)}
    known = {str(k): points[k] for k in range(10)}
    with tempfile.TemporaryDirectory() as name:
        return solve(pathlib.Path(name), ranges, known, truth)


def labyrinth(data, method):
    """Four UWB anchors from the robot's 233 ranges, its true positions being known."""
    lines = [line.split() for line in open(data / "snl/labyrinth_uwb/Indoor_UWB_Input.txt")]
    poses = [line.split() for line in open(data / "snl/labyrinth_uwb/Indoor_UWB_GT.txt")]
    times = np.array([float(row[1]) for row in poses if row[0] == "point2"])
    places = np.array([[float(row[2]), float(row[3])] for row in poses if row[0] == "point2"])
    ranges, known, truth = [], {}, {}
    for row in lines:
        if row[0] != "range2":
            continue
        pose = int(np.argmin(np.abs(times - float(row[1]))))
        ranges.append([f"P{pose}", f"L{row[6]}", row[2], math.sqrt(float(row[3]))])
        known[f"P{pose}"] = places[pose]
        truth[f"L{row[6]}"] = np.array([float(row[4]), float(row[5])])
    with tempfile.TemporaryDirectory() as name:
        return solve(pathlib.Path(name), ranges, known, truth | known, "--method", method)


def plaza(data, method):
    """Four beacons from the ranges of a robot whose true positions are known."""
    truth, known, ranges = {}, {}, []
    for line in open(data / "snl/plaza1/plaza1.pyfg"):
        row = line.split()
        if row[0] == "VERTEX_SE2":
            truth[row[2]] = np.array([float(row[3]), float(row[4])])
        elif row[0] == "VERTEX_XY":
            truth[row[1]] = np.array([float(row[2]), float(row[3])])
        elif row[0] == "EDGE_RANGE":
            ranges.append([row[2], row[3], row[4], math.sqrt(float(row[5]))])
    for row in ranges:
        known[row[0]] = truth[row[0]]
    with tempfile.TemporaryDirectory() as name:
        return solve(pathlib.Path(name), ranges, known, truth, "--method", method)


def acshi(data, *options):
    """Eight nodes from time-of-flight measurements; positions and errors in feet."""
    places = {}
    readme = (data / "snl/acshi_uwb8/README").read_text()
    for line in readme.splitlines():
        words = line.replace(",", " ").replace(":", " ").replace("(", " ").replace(")", " ").split()
        if len(words) >= 3 and words[0].isdigit():
            try:
                places[words[0]] = np.array([float(words[1]), float(words[2])])
            except ValueError:
                continue
    offset, feet = 154.9, 1 / 0.3048
    ranges = []
    with gzip.open(data / "snl/acshi_uwb8/dataset4.txt.gz", "rt") as file:
        for line in file:
            row = line.split()
            distance = (299.7 * float(row[0]) - offset) * feet
            if distance > 0:
                ranges.append([row[1], row[2], distance])
    with tempfile.TemporaryDirectory() as name:
        return solve(pathlib.Path(name), ranges, {}, places, *options)


def mdjeep(data, file):
    """Exact and interval distances in space, no coordinates known: what was placed, and
    how well the kept ranges fit."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        done = subprocess.run([COMMAND, "localize", data / "snl/mdjeep_sensorSet1" / file, "-o",
                               folder / "out.csv", "--json", folder / "result.json", "-q"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 4):
            raise RuntimeError(done.stderr)
        result = json.loads((folder / "result.json").read_text())
        found = read_positions(folder / "out.csv")
        errors = []
        for line in open(data / "snl/mdjeep_sensorSet1" / file):
            row = line.split()
            if len(row) >= 4 and row[0] in found and row[1] in found:
                length = np.linalg.norm(found[row[0]] - found[row[1]])
                errors.append(max(0.0, float(row[2]) - length, length - float(row[3])))
        return {"nodes": sum(result["nodes"].values()), "localised": len(found),
                "ranges": result["candidates"], "pruned": result["pruned"],
                "violation": max(errors, default=math.nan)}


# How the repeated ranges are used.
ACSHI = {"robust": [], "least-squares": ["--method", "least-squares", "--no-merge-repeats"],
         "robust, every range": ["--no-merge-repeats"],
         "least squares of medians": ["--method", "least-squares"]}


def measure_real(store, data):
    for noise, file, trial in itertools.product((0, 0.05), range(4), range(20)):
        store.get(key_of("snlpy", noise, file, trial), lambda: snlpy(data, file, trial, noise))
    for method in ("robust", "least-squares"):
        store.get(key_of("labyrinth", method), lambda: labyrinth(data, method))
        store.get(key_of("plaza", method), lambda: plaza(data, method))
    for name, options in ACSHI.items():
        store.get(key_of("acshi", name), lambda: acshi(data, *options))
    for file in ("sensor056.nmr", "sensor073.nmr", "sensor103.nmr", "sensor148.nmr"):
        store.get(key_of("mdjeep", file), lambda: mdjeep(data, file))


def real_section(store):
    cells = store.cells
    rows = []
    for noise in (0, 0.05):
        trials = [cells[k] for k in cells if k.startswith(f"snlpy/{noise}/")]
        if trials:
            pooled = math.sqrt(sum(c["rmsd"] ** 2 * c["nodes"] for c in trials if c["nodes"])
                               / sum(c["nodes"] for c in trials))
            rows.append([f"snlpy 10A50S, {len(trials)} trials, noise {noise:.0%}", "side 1",
                         f"{sum(c['nodes'] for c in trials)} of {50 * len(trials)}",
                         f"{np.median([c['rmsd'] for c in trials if c['nodes']]):.2e}",
                         f"{pooled:.2e}", "–"])
    names = {"labyrinth": ("labyrinth UWB: 4 anchors", "m"), "plaza": ("plaza1: 4 beacons", "m"),
             "acshi": ("acshi UWB: 7 nodes with truth", "feet")}
    for name, (title, unit) in names.items():
        ours, plain = cells.get(f"{name}/robust"), cells.get(f"{name}/least-squares")
        if ours and plain:
            rows.append([title, unit, ours["nodes"], f"{ours['pruned']} of {ours['ranges']} pruned",
                         figure(ours["rmsd"], 3), figure(plain["rmsd"], 3)])
    for name in list(ACSHI)[2:]:
        cell = cells.get(f"acshi/{name}")
        if cell:
            rows.append([f"the same, {name}", "feet", cell["nodes"],
                         f"{cell['pruned']} of {cell['ranges']} pruned",
                         figure(cell["rmsd"], 3), "–"])
    header = ["data", "unit", "nodes", "median of trials / ranges", "RMSD", "least squares"]
    text = table(header, rows)
    rows = [[k.split("/")[1], c["nodes"], c["localised"], c["ranges"], c["pruned"],
             f"{c['violation']:.1e}"] for k, c in cells.items() if k.startswith("mdjeep/")]
    header = ["file", "nodes", "localised", "ranges", "pruned", "largest violated bound"]
    return text + "\n\n" + table(header, rows)


INTRODUCTION = """# Sensor networks

Written by `benchmarks/networks.py`:

    scripts/build.sh release
    $(scripts/python-env.sh) benchmarks/networks.py

measured piece by piece (`--sizes`, `--budget`) in builds of the preset `release`, on two cores
that had other work to do: seconds are wall-clock and say little. RMSD counts the nodes that
a method places, anchors left out, in sides of the unit square. Sizes, rows and cells that are
missing were not measured. Networks of 100 nodes are of the present build. Most others are of one that tried no
fold of a part that is tied to an anchor; those with nodes far off were measured anew since, but that of 10,000
nodes with 10 % of noise and biased ranges, and of 46 others one or two nodes changed. *Least squares* and *MDS-MAP* of 10,000 nodes were measured before.

## Simulated networks

10 anchors. *MDS-MAP* is shortest paths, classical scaling and a similarity onto the anchors;
*least squares* fits all ranges from where that ends; both place all nodes that are connected.
*Ours, true ranges only* is `isotherm localize` given only the correct ranges of the same network
(false ranges leave those that it has without them as they are: one estimate serves for all their
shares); *ratio* compares it with ours on the nodes that both localise. Precision and recall are
those of the verdicts on ranges. *Localised* leaves out nodes that, or whose surroundings, fit
nearly as well elsewhere; *far off* are those of the localised that are more than half a
radius from the truth. A ratio says nothing of nodes that only one of the two localises. With
biased ranges the true ones alone can localise fewer nodes: where a fifth of the ranges is
missing, absence proves less, while a range that is too long is still a range.

"""

BEYOND = """With a fifth of the ranges biased, or more, and 12 ranges a node, what is left of correct ones
does not fix every part of a network of 1,000 nodes: noise bends what lies between parts that hang on
few ranges until it fits, and a part may be shifted or turned. In networks of 100 nodes it is mostly
single nodes at the border, whose few ranges agree in a wrong place. Precision falls a little where
ranges can be too long, most with 10 % of noise: an excess below the noise is taken for one now and then.

A ratio far from 1 is mostly of a part that only one of the two estimates has in its mirror image.
"""

CONSTANTS = """### Constants

What the localiser decides by is in `network/src/localize/constants.hpp`, 23 constants with their unit and
where they come from; [what each is worth](localization-ablation.md).
"""

REAL = """## Real ranges

snlpy has positions only: ranges are made below a radius of 0.3, exact or with the noise
given. For labyrinth and plaza1 the robot's true positions are the anchors and the
static radios are found, each from all of its ranges; odometry is not used. acshi has no
anchors: all eight nodes are found together from 28 pairs measured a thousand times each,
and errors are after the best isometry, in feet. Its repeats scatter by 0.1 feet and are
wrong by 1 foot together: with their medians, which is the default, both methods do
better than least squares on every range (`--no-merge-repeats`), and taking 28 independent
errors of a foot for outliers only harms.

The files of MDjeep imitate sensor networks in space without anchors: the shortest
distances are exact to the digits written, all others intervals 0.1 wide. An interval counts
as a range in its middle with the deviation of a uniform law. sensor056 has 6.8 ranges a node: nothing
is localised. That is less than there is to be had. The 55 nodes with at least four ranges have one
place by the generic criterion (the rank of a stress matrix is 55 - 4; counted apart from the
script).

"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", nargs="?", type=pathlib.Path,
                        default=os.environ.get("ISOTHERM_DATA", ROOT / "../shared/data"))
    parser.add_argument("--sizes", type=int, nargs="+", default=[0, 100, 1000, 10000])
    parser.add_argument("--budget", type=float, default=math.inf)
    arguments = parser.parse_args()
    store, start = Store(), time.monotonic()
    if 0 in arguments.sizes:
        measure_real(store, pathlib.Path(arguments.data))
    for nodes in (size for size in arguments.sizes if size in SEEDS):
        for seed, (kind, share), degree, noise in itertools.product(SEEDS[nodes], BY_INTEREST,
                                                                    DEGREES, NOISES):
            if time.monotonic() - start > arguments.budget:
                break
            cell = (nodes, degree, noise, kind, share, seed)
            store.get(key_of(*cell), lambda: measure(*cell))
            store.get(baselines_key(*cell), lambda: measure_baselines(*cell))
    sections = [simulated_section(store, nodes) for nodes in (100, 1000, 10000)]
    sections.append(exceptions_section(store))
    PAGE.write_text(INTRODUCTION + "\n".join([*filter(None, sections), CONSTANTS]) + "\n" + REAL
                    + real_section(store) + "\n")


if __name__ == "__main__":
    main()
