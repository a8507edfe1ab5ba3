"""The paper's figures, as PNG and SVG."""

import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import scipy.linalg

import planar
from cells import TYPES, work_folder
from experiment import bicocca_truth
from methods import PRUNING, bicocca_error
from runs import read_csv

# Okabe and Ito's palette, told apart by every kind of colour vision.
BLACK, GREY, BLUE, SKY, RED, ORANGE, GREEN, PURPLE = (
    "#000000", "#7f7f7f", "#0072B2", "#56B4E9", "#D55E00", "#E69F00", "#009E73", "#CC79A7")
SCALES = (100.0, 70.0, 10.0, 5.0, 1.0, 0.1, 0.001)  # of the paper's Figure 5


class Figures:
    def __init__(self, command, graphs, folder):
        self.command, self.graphs = command, graphs
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def save(self, figure, name, svg=True):
        figure.savefig(self.folder / f"{name}.png", dpi=110)
        if not svg:  # thousands of lines
            plt.close(figure)
            return
        with matplotlib.rc_context({"svg.hashsalt": "isotherm", "svg.fonttype": "none"}):
            figure.savefig(self.folder / f"{name}.svg", metadata={"Date": None})
        strip_line_ends(self.folder / f"{name}.svg")
        plt.close(figure)

    def maps(self):
        """Figure 1: Bicocca with false loops before pruning, by every method, and the truth."""
        cell = self.graphs.bicocca_file("random", 178)
        truth = self.bicocca_truth()
        figure, axes = plt.subplots(2, 4, figsize=(13, 6.5), sharex=True, sharey=True,
                                    constrained_layout=True)
        with work_folder() as folder:
            work = pathlib.Path(folder)
            dcs = ("--kernel", "dcs", "--kernel-width", 5)
            paper = ("--method", "heat", "--preset", "datta2016")
            panels = {
                "least squares on all loops": self.optimised(cell.graph, (), work),
                "DCS, width 5": self.optimised(cell.graph, dcs, work),
                "Cauchy, width 2": self.optimised(
                    cell.graph, ("--kernel", "cauchy", "--kernel-width", 2), work),
                "heat (paper)": self.pruned(cell.graph, paper, (), work),
                "heat (paper) + DCS": self.pruned(cell.graph, paper, dcs, work),
                "consensus": self.pruned(cell.graph, (), (), work),
            }
            before = self.odometry(cell.graph, work)
        before = aligned(before, truth)
        axes.flat[0].plot(*before.T, color=GREY, linewidth=0.9, label="odometry")
        draw_labelled(axes.flat[0], before, {(int(row["from"]), int(row["to"])): row["label"]
                                             for row in read_csv(cell.labels)}, alpha=0.5)
        axes.flat[0].legend(fontsize=7, loc="lower right")
        axes.flat[0].set_title("odometry and loops")
        for axis, (title, path) in zip(axes.flat[1:], panels.items()):
            axis.plot(*aligned(path, truth).T, color=SKY, linewidth=0.9)
            axis.set_title(title)
        axes.flat[7].plot(*truth[:, 1:3].T, color=GREEN, linewidth=0.9)
        axes.flat[7].set_title("ground truth")
        low, high = truth[:, 1:3].min(axis=0) - 30, truth[:, 1:3].max(axis=0) + 30
        for axis in axes.flat:
            axis.set_aspect("equal")
            axis.set_xlim(low[0], high[0])
            axis.set_ylim(low[1], high[1])
        for axis in axes[1]:
            axis.set_xlabel("x [m]")
        for axis in axes[:, 0]:
            axis.set_ylabel("y [m]")
        figure.suptitle("Bicocca with 178 random false loops, the paper's own file")
        self.save(figure, "figure1-maps")

    def kitti_maps(self):
        """The paper's own Figure 1: KITTI 00 before and after pruning, by SC, RRR and heat."""
        cell = self.graphs.kitti_cell("00", "paper", "random-grouped", 402, 1)
        truth = self.graphs.kitti_truth("00")
        labels = {(int(row["from"]), int(row["to"])): row["label"]
                  for row in read_csv(cell.labels)}
        with work_folder() as folder:
            work = pathlib.Path(folder)
            panels = {"(a) odometry and all loops": (self.odometry(cell.graph, work), labels)}
            panels["(b) ground truth"] = (read_positions(truth), {})
            for title, method, kernel in (
                    ("(c) SC, loops that it keeps", "SC", ("--kernel", "sc")),
                    ("(d) RRR, loops that it keeps", "RRR", ()),
                    ("(e) heat (paper), loops that it keeps", "heat (paper)", ())):
                panels[title] = self.kept(cell, PRUNING[method], kernel, labels, work)
            dcs = ("--kernel", "dcs", "--kernel-width", 5)
            panels["(f) heat (paper), then DCS"] = (
                self.pruned(cell.graph, PRUNING["heat (paper)"], dcs, work), {})
        figure, axes = plt.subplots(2, 3, figsize=(12, 8), sharex=True, sharey=True,
                                    constrained_layout=True)
        reference = panels["(b) ground truth"][0]
        rows = np.column_stack([np.arange(len(reference)), reference])
        for axis, (title, (path, shown)) in zip(axes.flat, panels.items()):
            path = aligned(path, rows)
            axis.plot(*path.T, color=GREY, linewidth=0.9)
            draw_labelled(axis, path, shown, alpha=0.4)
            axis.set_title(title, fontsize=10)
            axis.set_aspect("equal")
        low, high = reference.min(axis=0) - 60, reference.max(axis=0) + 60
        axes.flat[0].set_xlim(low[0], high[0])
        axes.flat[0].set_ylim(low[1], high[1])
        axes.flat[0].legend(fontsize=7, loc="lower right")
        for axis in axes[1]:
            axis.set_xlabel("x [m]")
        for axis in axes[:, 0]:
            axis.set_ylabel("y [m]")
        figure.suptitle("KITTI 00, every loop and its copies, with 402 false loops in groups")
        self.save(figure, "figure1-kitti", svg=False)

    def kept(self, cell, flags, kernel, labels, work):
        """The map after pruning, and the labels of the loops that are left."""
        self.command.run("prune", cell.graph, *flags, "-o", work / "pruned.g2o",
                         "--verdicts", work / "verdicts.csv")
        left = {(int(row["from"]), int(row["to"])) for row in read_csv(work / "verdicts.csv")
                if row["verdict"] != "prune"}
        graph = cell.graph if kernel else work / "pruned.g2o"  # SC weighs loops as it optimises
        return (self.optimised(graph, kernel, work),
                {pair: label for pair, label in labels.items() if pair in left})

    def bicocca_truth(self):
        """Rows of (vertex, x, y) where there is ground truth."""
        path, _, stamps = bicocca_truth(self.graphs.data)
        rows = np.genfromtxt(path, delimiter=",", invalid_raise=False)
        rows = rows[np.isfinite(rows[:, 0])]
        times = np.loadtxt(stamps)
        vertices = np.nonzero(nearest_gap(times, rows[:, 0]) < 0.25)[0]
        return np.column_stack([vertices, np.interp(times[vertices], rows[:, 0], rows[:, 1]),
                                np.interp(times[vertices], rows[:, 0], rows[:, 2])])

    def optimised(self, graph, flags, work):
        self.command.run("optimize", graph, *flags, "-o", work / "map.g2o")
        return read_positions(work / "map.g2o")

    def pruned(self, graph, flags, kernel, work):
        self.command.run("prune", graph, *flags, "-o", work / "pruned.g2o")
        return self.optimised(work / "pruned.g2o", kernel, work)

    def odometry(self, graph, work):
        return self.optimised(graph, ("--initialization", "odometry", "--max-iterations", 0), work)

    def embedding(self):
        """Figure 2: loops in the three-dimensional commute-time embedding."""
        cell = self.graphs.kitti_cell("06", "paper", "random", 20, 1)
        edges = planar.read_edges(cell.graph)
        labels = {(int(row["from"]), int(row["to"])): row["label"]
                  for row in read_csv(cell.labels)}
        figure = plt.figure(figsize=(11, 5), constrained_layout=True)
        panels = (("all loops of weight 1", dict.fromkeys(labels, 1.0)),
                  ("loops weighted by their agreement with odometry, 1 / (1 + χ²/3)",
                   self.chi2_weights(cell)))
        for k, (title, weights) in enumerate(panels):
            axis = figure.add_subplot(1, 2, k + 1, projection="3d")
            points = self.embedded(edges, weights)
            axis.plot(*points.T, color=GREY, linewidth=0.8, label="odometry")
            draw_labelled(axis, points, labels)
            for number, name in enumerate("xyz", start=1):
                getattr(axis, f"set_{name}label")(f"coordinate {number}")
            axis.legend(loc="upper left")
            axis.set_title(title, fontsize=10)
        figure.suptitle("KITTI 06 with 20 random false loops, commute-time embedding (no units)")
        self.save(figure, "figure2-embedding")

    def chi2_weights(self, cell):
        """The weights the paper starts from, a loop."""
        with work_folder() as folder:
            verdicts = pathlib.Path(folder) / "verdicts.csv"
            self.command.run("prune", cell.graph, "--method", "chi2", "--verdicts", verdicts)
            return {(int(row["from"]), int(row["to"])): 1.0 / (1.0 + float(row["score"]) / 3.0)
                    for row in read_csv(verdicts)}

    def embedded(self, edges, weights):
        with work_folder() as folder:
            work = pathlib.Path(folder)
            with open(work / "edges.csv", "w", encoding="utf-8") as file:
                file.write("from,to,weight\n")
                for edge in edges:
                    weight = weights.get((edge.start, edge.end), 1.0)
                    file.write(f"{edge.start},{edge.end},{weight!r}\n")
            self.command.run("embed", work / "edges.csv", "--dimensions", 3, "-o",
                             work / "coordinates.npy")
            return np.load(work / "coordinates.npy")

    def decay(self):
        """Figure 5: exp(-lambda t) over the spectrum of kitti_00, a curve a scale."""
        edges = planar.read_edges(self.graphs.data / "paper" / "kitti" / "kitti_00.g2o")
        size = 1 + max(max(edge.start, edge.end) for edge in edges)
        laplacian = np.zeros((size, size))
        for edge in edges:
            for a, b in ((edge.start, edge.end), (edge.end, edge.start)):
                laplacian[a, a] += 1.0
                laplacian[a, b] -= 1.0
        values = np.maximum(scipy.linalg.eigvalsh(laplacian, driver="evd"), 0.0)
        figure, axis = plt.subplots(figsize=(7, 4.5), constrained_layout=True)
        colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(SCALES)))
        for scale, colour in zip(SCALES, colours):
            axis.plot(np.arange(1, size + 1), np.exp(-values * scale), color=colour,
                      label=f"t = {scale:g}")
        axis.set_xlabel("eigenvalue, in ascending order")
        axis.set_ylabel("exp(−λt)")
        axis.legend()
        axis.set_title(f"KITTI 00: {size} eigenvalues of the Laplacian, unit weights")
        self.save(figure, "figure5-decay")

    def noise_levels(self, results, extent, style):
        """Figure 6: trajectory error against the number of false loops."""
        columns = {
            "DCS": (GREEN, "s", "-"), "Cauchy": (PURPLE, "^", "-"),
            "heat (Lap-line) + DCS": (RED, "D", "-"), "heat (χ²) + DCS": (ORANGE, "v", "-"),
            "consensus": (BLUE, "o", "--"), "consensus + DCS": (BLUE, "o", "-"),
            "consensus + Cauchy": (BLACK, "o", ":"),
        }
        figure, axes = plt.subplots(2, 5, figsize=(13, 6), sharex=True, sharey="row",
                                    constrained_layout=True)
        for column, kind in enumerate(TYPES):
            for row, key in enumerate(("ate", "rmse")):
                axis = axes[row, column]
                for name, (colour, marker, line) in columns.items():
                    axis.plot([10 * level for level in extent.levels],
                              [bicocca_error(results, extent, style, kind, count, name, key)
                               for count in extent.counts()],
                              color=colour, marker=marker, linestyle=line, label=name)
                axis.grid(alpha=0.3)
            axes[0, column].set_title(kind)
            axes[1, column].set_xlabel("false loops [% of loops]")
        axes[0, 0].set_ylabel("ATE, first pose aligned [m]")
        axes[1, 0].set_ylabel("aligned RMSE [m]")
        for axis in axes[:, 0]:
            axis.set_ylim(bottom=0.0)
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=7)
        self.save(figure, f"figure6-noise-{style}")


def strip_line_ends(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(line.rstrip() for line in lines) + "\n", encoding="utf-8")


def draw_labelled(axis, points, labels, alpha=1.0):
    """Every loop as a line between its ends, false ones below."""
    for label, colour, name in (("incorrect", RED, "false loop"), ("correct", BLUE,
                                                                   "correct loop")):
        pairs = [pair for pair, found in labels.items() if found == label]
        for k, pair in enumerate(pairs):
            axis.plot(*points[list(pair)].T, color=colour, linewidth=0.7, alpha=alpha,
                      label=name if k == 0 else None)


def nearest_gap(times, stamps):
    right = np.clip(np.searchsorted(stamps, times), 1, len(stamps) - 1)
    return np.minimum(np.abs(times - stamps[right - 1]), np.abs(times - stamps[right]))


def read_positions(path):
    with open(path, encoding="utf-8") as file:
        return np.array([[float(x) for x in line.split()[2:4]] for line in file
                         if line.startswith("VERTEX_SE2")])


def aligned(path, truth):
    """`path` after the rigid motion that fits it best to the truth (Umeyama, no scale)."""
    source, target = path[truth[:, 0].astype(int)], truth[:, 1:3]
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    u, _, v = np.linalg.svd(b.T @ a)
    rotation = u @ np.diag([1.0, np.linalg.det(u @ v)]) @ v
    return (path - source.mean(axis=0)) @ rotation.T + target.mean(axis=0)
