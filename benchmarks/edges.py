"""Every method of `isotherm edges` at its defaults, on the plain graphs of docs/results/graphs.md.

usage: edges.py ISOTHERM DATA [--small] [SEED...]

Prints precision, recall and area under the curve of the default method beside Jaccard's index, the
detour around an edge and edge betweenness at the threshold that labels choose; for every method F
at its default and at its own best threshold; and how many edges of clean versions each prunes.
Every false edge counts, also between vertices that happen to be near. Method rank is told the
positions, where the table of methods names it. Detours are counted up to MOST steps, betweenness
over PIVOTS sources. Seeds are 1, 2 and 3 unless others are named. --small prints, of the default
method on graphs of the same kinds with 46 to 1,000 vertices, precision, recall, area under the
curve, edges pruned of clean versions and seconds of wall-clock time. Needs numpy, scipy and
networkx.
"""

import collections
import os
import sys
import tempfile

import networkx
import numpy as np
from scipy.spatial import cKDTree

from graphs import (Bench, add_false_edges, area_under_curve, minnesota, precision_and_recall,
                    random_geometric, swiss_roll, write_positions)

METHODS = ("heat", "heat-multiscale", "affinity", "resistance", "jaccard", "common-neighbours",
           "rank")
SLOW = {"heat-multiscale", "affinity", "resistance"}  # left out above MANY edges
MANY = 30_000
FAR = 20.0  # along the sheet, between the ends of a short circuit
PIVOTS = 100
MOST = 12


def torus(count, rng, neighbours=8):
    angles = []
    while len(angles) < count:
        around, across, chance = rng.random(3)
        if chance <= (3 + np.cos(2 * np.pi * across)) / 4:  # evenly over the surface
            angles.append((2 * np.pi * around, 2 * np.pi * across))
    u, v = np.array(angles).T
    ring = 3 + np.cos(v)
    points = np.c_[ring * np.cos(u), ring * np.sin(u), np.sin(v)]
    distances, near = cKDTree(points).query(points, neighbours + 1)
    pairs = np.c_[np.repeat(np.arange(count), neighbours), near[:, 1:].ravel()]
    return np.unique(np.sort(pairs, axis=1), axis=0), points, distances[:, -1]


def crambin(data, names, cutoff):
    path = os.path.join(data, "geomgraph", "protein_contacts", "1crn.pdb")
    with open(path, encoding="utf-8") as file:
        atoms = [line for line in file if line.startswith("ATOM")]
    points = np.array([[float(line[k:k + 8]) for k in (30, 38, 46)] for line in atoms
                       if names is None or line[12:16].strip() in names])
    edges = cKDTree(points).query_pairs(cutoff, output_type="ndarray")
    return edges, points, np.full(len(points), cutoff)


def shorted_roll(count, shorts, rng):
    """A Swiss roll, and edges from points to the nearest one of another layer."""
    edges, sheet, _ = swiss_roll(count, rng)
    angle = np.sqrt(np.maximum(0.0, invert_arc(sheet[:, 0])))
    points = np.c_[angle * np.cos(angle), sheet[:, 1], angle * np.sin(angle)]
    found = set()
    while len(found) < shorts:
        start = rng.integers(count)
        distance = np.linalg.norm(points - points[start], axis=1)
        distance[np.linalg.norm(sheet - sheet[start], axis=1) <= FAR] = np.inf
        found.add(tuple(sorted((int(start), int(np.argmin(distance))))))
    false = np.array(sorted(found), dtype=int).reshape(-1, 2)
    labels = np.r_[np.zeros(len(edges), int), np.ones(len(false), int)]
    order = rng.permutation(len(labels))
    return np.r_[edges, false][order], labels[order], points


def grid(side):
    vertex = np.arange(side * side).reshape(side, side)
    edges = np.r_[np.c_[vertex[:, :-1].ravel(), vertex[:, 1:].ravel()],
                  np.c_[vertex[:-1].ravel(), vertex[1:].ravel()]]
    return edges, np.c_[np.indices((side, side)).reshape(2, -1).T].astype(float), np.ones(side**2)


def invert_arc(along):
    """The squared angle at a length along the spiral, by interpolation."""
    angle = np.linspace(0.0, 5 * np.pi, 200_001)
    length = 0.5 * (angle * np.sqrt(1 + angle**2) + np.arcsinh(angle))
    return np.interp(along, length, angle) ** 2


def graphs(data, seed, clean):
    """Name, (edges, labels, positions) of every graph."""
    def shared(make, share):
        rng = np.random.default_rng(seed)
        graph = make(rng)
        return *add_false_edges(graph, 0.0 if clean else share, rng), graph[1]
    yield "torus", shared(lambda rng: torus(2000, rng), 0.1)
    for count, shorts in ((2000, 80), (10000, 400)):
        rolled = shorted_roll(count, 0 if clean else shorts, np.random.default_rng(seed))
        yield f"Swiss roll, {count:,}", rolled
    yield "Minnesota roads", shared(lambda rng: minnesota(data), 0.05)
    yield "crambin, C-alpha", shared(lambda rng: crambin(data, ("CA",), 8.0), 0.1)
    yield "crambin, all atoms", shared(lambda rng: crambin(data, None, 5.0), 0.1)
    yield "random geometric, 20 %", shared(lambda rng: random_geometric(2000, rng), 0.2)
    yield "random geometric, 50 %", shared(lambda rng: random_geometric(2000, rng), 0.5)
    yield "grid of 20 x 20, 5 % false", shared(lambda rng: grid(20), 0.05)


def random_geometric_in_space(count, rng, degree=15):
    points = rng.random((count, 3))
    radius = (3 * degree / (4 * np.pi * count)) ** (1 / 3)
    edges = cKDTree(points).query_pairs(radius, output_type="ndarray")
    return edges, points, np.full(count, radius)


def small_graphs(data, seed, clean):
    """Name and (edges, labels) of every small graph."""
    def shared(make, share):
        rng = np.random.default_rng(seed)
        return add_false_edges(make(rng), 0.0 if clean else share, rng)
    yield "crambin, C-alpha", shared(lambda rng: crambin(data, ("CA",), 8.0), 0.1)
    yield "crambin, all atoms", shared(lambda rng: crambin(data, None, 5.0), 0.1)
    for count in (150, 400, 1000):
        yield f"torus, {count:,}", shared(lambda rng, n=count: torus(n, rng), 0.1)
        for share in (0.2, 0.5):
            yield (f"random geometric, {count:,}, {100 * share:.0f} %",
                   shared(lambda rng, n=count: random_geometric(n, rng), share))
        yield (f"in space, {count:,}, 20 %",
               shared(lambda rng, n=count: random_geometric_in_space(n, rng), 0.2))
        rng = np.random.default_rng(seed)
        yield f"Swiss roll, {count:,}", shorted_roll(count, 0 if clean else count // 25, rng)[:2]


def print_small(bench, data, seeds):
    rows = collections.defaultdict(list)
    for seed in seeds:
        for (name, (edges, labels)), (_, (whole, _)) in zip(small_graphs(data, seed, False),
                                                            small_graphs(data, seed, True)):
            labels = np.minimum(labels, 1)
            verdict, scores, seconds, _ = bench.judge(edges, "heat")
            scores = np.where(np.isfinite(scores), scores, scores[np.isfinite(scores)].min())
            pruned = (bench.judge(whole, "heat")[0] == "prune").mean()
            rows[name].append((*precision_and_recall(verdict, labels),
                               area_under_curve(scores, labels), 100 * pruned, seconds))
    print("| graph | P | R | AUC | clean | s |\n|---|---|---|---|---|---|")
    for name, found in rows.items():
        precision, recall, area, pruned, seconds = np.mean(found, axis=0)
        print(f"| {name} | {precision:.3f} | {recall:.3f} | {area:.4f} | {pruned:.2f} % "
              f"| {seconds:.2f} |")


def best_threshold(scores, false):
    """(F, precision, recall) at the threshold of the highest F."""
    order = np.argsort(-scores, kind="stable")
    right = np.cumsum(false[order])
    pruned = np.arange(1, len(scores) + 1)
    last = np.r_[np.diff(scores[order]) != 0, True]
    f = np.where(last, 2 * right / (pruned + false.sum()), 0.0)
    k = int(np.argmax(f))
    return f[k], right[k] / pruned[k], right[k] / false.sum()


def detours(edges):
    """Fewest steps between the ends of each edge without it, searched for from both."""
    neighbours = collections.defaultdict(set)
    for a, b in edges:
        neighbours[a].add(b)
        neighbours[b].add(a)

    def count(*ends):
        seen, rims = [{v} for v in ends], [{v} for v in ends]
        for steps in range(1, MOST + 1):
            side = int(len(rims[1]) < len(rims[0]))
            rims[side] = {w for v in rims[side] for w in neighbours[v]
                          if w not in seen[side] and {v, w} != set(ends)}
            if rims[side] & seen[1 - side]:
                return steps
            if not rims[side]:
                return 0  # a bridge: nothing else joins the two
            seen[side] |= rims[side]
        return MOST + 1

    return np.array([count(a, b) for a, b in edges], dtype=float)


def betweenness(edges):
    graph = networkx.Graph(map(tuple, edges))
    pivots = min(PIVOTS, graph.number_of_nodes())
    found = networkx.edge_betweenness_centrality(graph, k=pivots, seed=1)
    return np.array([found.get((a, b), found.get((b, a))) for a, b in map(tuple, edges)])


class Table:
    def __init__(self, bench, data, seeds):
        self.bench, self.data, self.seeds = bench, data, seeds

    def rows(self):
        found = collections.defaultdict(lambda: collections.defaultdict(list))
        for seed in self.seeds:
            for name, (edges, _, points) in graphs(self.data, seed, True):
                for method in self.methods(name, edges):
                    verdict = self.judge(edges, method, points)[0]
                    found[name][f"clean {method}"].append((verdict == "prune").mean())
            for name, (edges, labels, points) in graphs(self.data, seed, False):
                self.measure(edges, np.minimum(labels, 1), points, found[name],
                             self.methods(name, edges))
                print(f"seed {seed}: {name}", file=sys.stderr, flush=True)
        return found

    @staticmethod
    def methods(name, edges):
        known = name.startswith(("Swiss", "Minnesota", "grid"))  # whose positions are told
        return [method for method in METHODS if (method != "rank" or known) and
                (method not in SLOW or len(edges) < MANY)]

    def judge(self, edges, method, points):
        told = method == "rank"
        flags = ["--positions", write_positions(points, self.bench.folder)] if told else []
        return self.bench.judge(edges, method, flags)

    def measure(self, edges, labels, points, row, methods):
        false = labels == 1
        for method in methods:
            verdict, scores, *_ = self.judge(edges, method, points)
            scores = np.where(np.isfinite(scores), scores, scores[np.isfinite(scores)].min())
            precision, recall = precision_and_recall(verdict, labels)
            f = 2 * precision * recall / max(1e-9, precision + recall)
            row[method].append((precision, recall, area_under_curve(scores, labels), f,
                                *best_threshold(scores, false)))
        for name, scores in (("detour", detours(edges)), ("betweenness", betweenness(edges))):
            row[name].append((0, 0, area_under_curve(scores, labels), 0,
                              *best_threshold(scores, false)))


def print_default(found):
    print("| graph | heat P | R | AUC | Jaccard P | R | AUC | detour P | R | AUC "
          "| betweenness P | R | AUC |")
    print("|---" * 13 + "|")
    for name, row in found.items():
        heat = np.mean(row["heat"], axis=0)
        cells = [f"{heat[0]:.3f}", f"{heat[1]:.3f}", f"{heat[2]:.4f}"]
        for other in ("jaccard", "detour", "betweenness"):
            means = np.mean(row[other], axis=0)
            cells += [f"{means[5]:.3f}", f"{means[6]:.3f}", f"{means[2]:.4f}"]
        print(f"| {name} | " + " | ".join(cells) + " |")


def print_methods(found, title, cell):
    print(f"\n| {title} | " + " | ".join(METHODS) + " |")
    print("|---" * (len(METHODS) + 1) + "|")
    for name, row in found.items():
        print(f"| {name} | " + " | ".join(cell(row, method) for method in METHODS) + " |")


def default_of_best(row, method):
    if method not in row:
        return "-"
    means = np.mean(row[method], axis=0)
    return f"{means[3]:.3f} of {means[4]:.3f}"


def share_of_clean(row, method):
    share = row.get(f"clean {method}")
    return "-" if share is None else f"{100 * np.mean(share):.2f} %"


def main():
    command, data = sys.argv[1:3]
    small = "--small" in sys.argv[3:]
    seeds = [int(seed) for seed in sys.argv[3:] if seed != "--small"] or [1, 2, 3]
    with tempfile.TemporaryDirectory() as folder:
        if small:
            print_small(Bench(command, folder), data, seeds)
            return
        found = Table(Bench(command, folder), data, seeds).rows()
    print_default(found)
    print_methods(found, "graph", default_of_best)
    print_methods(found, "clean graph", share_of_clean)


if __name__ == "__main__":
    main()
