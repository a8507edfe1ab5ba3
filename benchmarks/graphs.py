"""Adds false edges to plain geometric graphs and measures how `isotherm edges` finds them.

usage: graphs.py ISOTHERM DATA [--quick]
       graphs.py --write-minnesota SHARE DATA FOLDER

Prints the tables of docs/results/graphs.md. DATA has geomgraph/; --quick leaves out
the graphs with 20,000 and more vertices. The second way only writes one of the graphs,
with its positions. Needs numpy and scipy.

A false edge joins two vertices drawn uniformly, that no true edge joins. It is labelled
`ignore` where its ends are closer than twice the radius: as far as two true edges
reach. For a nearest-neighbour graph the radius of a vertex is the distance of its last
neighbour, and the sum of both ends' radii counts. Distances on the Swiss roll are
those along the sheet.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy.io
import scipy.sparse
from scipy.spatial import cKDTree
from scipy.stats import rankdata

BASELINES = ("jaccard", "common-neighbours", "resistance")
MOST_FOR_RESISTANCE = 50_000  # edges; random edges fill the factor


def swiss_roll(count, rng, neighbours=7):
    """(edges, position on the sheet, radius a vertex) of points on a rolled-up sheet."""
    angle = 1.5 * np.pi * (1 + 2 * rng.random(count))
    height = 21 * rng.random(count)
    points = np.c_[angle * np.cos(angle), height, angle * np.sin(angle)]
    along = 0.5 * (angle * np.sqrt(1 + angle**2) + np.arcsinh(angle))
    distances, near = cKDTree(points).query(points, neighbours + 1)
    pairs = np.c_[np.repeat(np.arange(count), neighbours), near[:, 1:].ravel()]
    edges = np.unique(np.sort(pairs, axis=1), axis=0)
    return edges, np.c_[along, height], distances[:, -1]


def random_geometric(count, rng, degree=15):
    """The same for points in the unit square, joined within a radius."""
    points = rng.random((count, 2))
    radius = np.sqrt(degree / (np.pi * count))
    edges = cKDTree(points).query_pairs(radius, output_type="ndarray")
    return edges, points, np.full(count, radius)


def minnesota(data):
    """Roads; the radius is the length of the longest one, in degrees."""
    path = os.path.join(data, "geomgraph", "minnesota_road", "minnesota.mat")
    content = scipy.io.loadmat(path)
    upper = scipy.sparse.triu(content["A"], 1).tocoo()
    edges = np.c_[upper.row, upper.col].astype(int)
    points = content["xy"].astype(float)
    longest = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).max()
    return edges, points, np.full(len(points), longest)


def protein(data, cutoff=6.0):
    """N, CA and C atoms of 1crn, in contact within so many Angstrom."""
    path = os.path.join(data, "geomgraph", "protein_contacts", "1crn.pdb")
    with open(path, encoding="utf-8") as file:
        atoms = [line for line in file if line.startswith("ATOM")]
    points = np.array([
        [float(line[30:38]), float(line[38:46]), float(line[46:54])]
        for line in atoms if line[12:16].strip() in ("N", "CA", "C")
    ])
    edges = cKDTree(points).query_pairs(cutoff, output_type="ndarray")
    return edges, points, np.full(len(points), cutoff)


def add_false_edges(graph, share, rng):
    """(edges in random order, labels): 0 true, 1 false, 2 to be ignored."""
    edges, points, radius = graph
    known = set(map(tuple, np.sort(edges, axis=1)))
    false = []
    while len(false) < round(share * len(edges)):
        pair = tuple(sorted(rng.choice(len(points), 2)))
        if pair[0] != pair[1] and pair not in known:
            known.add(pair)
            false.append(pair)
    false = np.array(false, dtype=int).reshape(-1, 2)
    length = np.linalg.norm(points[false[:, 0]] - points[false[:, 1]], axis=1)
    near = length < radius[false[:, 0]] + radius[false[:, 1]]
    labels = np.r_[np.zeros(len(edges), int), np.where(near, 2, 1)]
    order = rng.permutation(len(labels))
    return np.r_[edges, false][order], labels[order]


def write_positions(points, folder):
    path = os.path.join(folder, "positions.csv")
    np.savetxt(path, np.c_[np.arange(len(points)), points], delimiter=",",
               fmt=["%d"] + ["%.17g"] * points.shape[1])
    return path


def write_minnesota(share, data, folder):
    graph = minnesota(data)
    edges, _ = add_false_edges(graph, share, np.random.default_rng(1))
    np.savetxt(os.path.join(folder, "minnesota.csv"), edges, fmt="%d", delimiter=",")
    write_positions(graph[1], folder)


def share_alone(edges, labels):
    """Share of the false edges whose ends have two more edges each, dead ends left out.

    The others form a chain with true edges, of which nothing says which one is false.
    """
    left = np.ones(len(edges), dtype=bool)
    while True:
        degree = np.bincount(edges[left].ravel(), minlength=edges.max() + 1)
        dead = left & (degree[edges].min(axis=1) < 2)
        if not dead.any():
            return (degree[edges[labels == 1]].min(axis=1) > 2).mean()
        left &= ~dead


def print_shares_alone(data, shares=(0.01, 0.05), repeats=5):
    for share in shares:
        alone = []
        for seed in range(1, repeats + 1):
            rng = np.random.default_rng(seed)
            alone.append(share_alone(*add_false_edges(minnesota(data), share, rng)))
        print(f"{100 * share:g} % shortcuts: {100 * np.mean(alone):.1f} % form no chain with roads")


def area_under_curve(scores, labels):
    judged = labels < 2
    ranks = rankdata(scores[judged])
    false = labels[judged] == 1
    count = false.sum()
    if count == 0:
        return float("nan")
    wins = ranks[false].sum() - count * (count + 1) / 2
    return wins / (count * (len(false) - count))


def precision_and_recall(verdict, labels, near_ones=False):
    """Share of false edges among the pruned ones, and of pruned ones among the false; those to be
    ignored count as false ones, or not at all."""
    judged = (labels < 2) | near_ones
    pruned, false = judged & (verdict == "prune"), judged & (labels > 0)
    right = (pruned & false).sum()
    return right / max(1, pruned.sum()), right / max(1, false.sum())


class Bench:
    def __init__(self, command, folder):
        self.command, self.folder = command, folder

    def judge(self, edges, method, flags=()):
        """(verdicts, scores, seconds, megabytes) of one run."""
        graph, verdicts = (os.path.join(self.folder, name) for name in ("in.csv", "out.csv"))
        np.savetxt(graph, edges, fmt="%d", delimiter=",")
        start = time.monotonic()
        process = subprocess.Popen([self.command, "edges", graph, "--verdicts", verdicts,
                                    "--method", method, "-q", *flags])
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - start
        if status != 0:
            sys.exit(f"{method} failed")
        with open(verdicts, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        verdict = np.array([row["verdict"] for row in rows])
        score = np.array([float(row["score"]) for row in rows])
        return verdict, score, seconds, usage.ru_maxrss / 1024

    def measure(self, graph, share, rng, method):
        """(true and false edges, precision, recall, share of true edges pruned, seconds,
        areas) of one graph. Only the method "rank" is told the positions."""
        edges, labels = add_false_edges(graph, share, rng)
        flags = ["--positions", write_positions(graph[1], self.folder)] if method == "rank" else []
        verdict, score, seconds, _ = self.judge(edges, method, flags)
        true, false = labels == 0, labels == 1
        areas = [area_under_curve(score, labels)]
        for baseline in BASELINES:
            known = share > 0 and (baseline != "resistance" or len(labels) < MOST_FOR_RESISTANCE)
            other = self.judge(edges, baseline)[1] if known else None
            areas.append(area_under_curve(other, labels) if known else float("nan"))
        return [true.sum(), false.sum(), *precision_and_recall(verdict, labels),
                (verdict[true] == "prune").mean(), seconds, *areas]

    def print_with_near_ones(self, data, shares=(0.01, 0.05), repeats=5):
        """Precision and recall on roads of known positions, no shortcut being ignored."""
        for share in shares:
            found = []
            for seed in range(1, repeats + 1):
                graph, rng = minnesota(data), np.random.default_rng(seed)
                edges, labels = add_false_edges(graph, share, rng)
                positions = write_positions(graph[1], self.folder)
                verdict = self.judge(edges, "rank", ["--positions", positions])[0]
                found.append(precision_and_recall(verdict, labels, near_ones=True))
            precision, recall = np.mean(found, axis=0)
            print(f"{100 * share:g} % shortcuts, positions known, short ones too: "
                  f"precision {precision:.4f}, recall {recall:.4f}")

    def row(self, name, make, share, repeats=1, method="heat"):
        """One line of the main table: means over graphs of different seeds."""
        results = []
        for seed in range(1, repeats + 1):
            rng = np.random.default_rng(seed)
            results.append(self.measure(make(rng), share, rng, method))
        true, false, precision, recall, lost, seconds, *areas = np.mean(results, axis=0)
        cells = [name, f"{100 * share:g} %", f"{true:.0f}", f"{false:.0f}"]
        cells += [f"{precision:.4f}", f"{recall:.4f}"] if share > 0 else ["-", "-"]
        cells += [f"{100 * lost:.2f} %", f"{seconds:.1f}"]
        cells += ["-" if np.isnan(area) else f"{area:.5f}" for area in areas]
        print("| " + " | ".join(cells) + " |", flush=True)

    def large(self):
        """Time and memory of 100,000 points with 1,000,000 edges, a tenth of them false."""
        rng = np.random.default_rng(1)
        graph = random_geometric(100_000, rng, degree=18.2)
        edges, labels = add_false_edges(graph, 0.1, rng)
        edges, labels = edges[:1_000_000], labels[:1_000_000]
        verdict, _, seconds, megabytes = self.judge(edges, "heat")
        precision, recall = precision_and_recall(verdict, labels)
        print(f"\n{len(edges)} edges: {seconds:.0f} s, {megabytes:.0f} MB, "
              f"precision {precision:.4f}, recall {recall:.4f}")


def main():
    if sys.argv[1] == "--write-minnesota":
        write_minnesota(float(sys.argv[2]), *sys.argv[3:5])
        return
    command, data = sys.argv[1:3]
    quick = "--quick" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(command, folder)
        print("| graph | false | true edges | false edges | precision | recall | true pruned "
              "| s | AUC | Jaccard | common neighbours | resistance |")
        print("|---|---|---|---|---|---|---|---|---|---|---|---|")
        for share in (0.0, 0.01, 0.05):
            bench.row("Minnesota roads", lambda rng: minnesota(data), share, 5)
        for share in (0.0, 0.01, 0.05):
            bench.row("Minnesota roads, positions known", lambda rng: minnesota(data), share, 5,
                      "rank")
        for share in (0.0, 0.1):
            bench.row("1crn contacts, 6 A", lambda rng: protein(data), share, 5)
        for count, repeats in ((2000, 6),) if quick else ((2000, 6), (20000, 1)):
            for name, make in (("Swiss roll", swiss_roll), ("random geometric", random_geometric)):
                for share in (0.0, 0.05, 0.2, 0.5, 1.0):
                    bench.row(f"{name}, {count:,}", lambda rng, make=make: make(count, rng), share,
                              repeats)
        print()
        print_shares_alone(data)
        bench.print_with_near_ones(data)
        if not quick:
            bench.large()


if __name__ == "__main__":
    main()
