"""Graphs with known labels and truth: one a cell of the tables."""

import pathlib
import tempfile
import threading

import kitti
import planar
from experiment import LabelledGraph, bicocca_truth

COPIES = 4  # of a loop to either side; the paper does not say how many it made
TYPES = ("local", "local-grouped", "random", "random-grouped", "all-random")
STYLES = ("paper", "vertigo")


class Graphs:
    """Makes graphs below `folder` as they are asked for."""

    def __init__(self, command, data, folder):
        self.command, self.data = command, data
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lock = threading.RLock()

    def made(self, name, make):
        """The file `name`, made by `make(path)` unless it is there."""
        path = self.folder / name
        with self.lock:
            if not path.exists():
                part = self.folder / ("part-" + name)
                make(part)
                part.replace(path)
        return path

    # KITTI

    def kitti_truth(self, sequence):
        return self.made(f"truth_{sequence}.g2o", lambda path: planar.write_graph(
            path, [], kitti.true_poses(self.data, sequence)))

    def kitti_clean(self, sequence):
        """The densified graph at its optimum."""
        sparse = self.data / "paper" / "kitti" / f"kitti_{sequence}.g2o"
        dense = self.made(f"dense_{sequence}.g2o", lambda path: self.command.run(
            "densify", sparse, "-o", path, "--copies", COPIES))
        return self.made(f"clean_{sequence}.g2o",
                         lambda path: self.command.run("optimize", dense, "-o", path))

    def kitti_cell(self, sequence, style, kind, count, seed):
        key = f"kitti{sequence}-{style}-{kind}-{count}-{seed}"
        clean = self.kitti_clean(sequence)
        labels = self.folder / (key + ".csv")

        def corrupt(path):
            self.command.run("corrupt", clean, "-o", path, "--labels", labels, "--style", style,
                             "--type", kind, "--count", count, "--seed", seed)

        graph = self.made(key + ".g2o", corrupt)
        return LabelledGraph(key, graph, labels, (self.kitti_truth(sequence),))

    def place_cell(self, sequence, candidates, seed):
        key = f"places{sequence}-{candidates}-{seed}"
        graph = self.made(key + ".g2o", lambda path: planar.write_graph(
            path, kitti.recognised_places(self.data, sequence, candidates, seed)))
        truth = self.kitti_truth(sequence)
        labels = self.made(key + ".csv", lambda path: self.command.run(
            "label", graph, "--ground-truth", truth, "-o", path))
        return LabelledGraph(key, graph, labels, (truth,))

    # Bicocca

    def bicocca(self, key, graph):
        truth = bicocca_truth(self.data)
        labels = self.made(key + ".csv", lambda path: self.command.run(
            "label", graph, "--ground-truth", *truth, "-o", path))
        return LabelledGraph(key, graph, labels, (*truth, "--max-gap", "0.25"))

    def bicocca_cell(self, style, kind, count, seed):
        key = f"b25b-{style}-{kind}-{count}-{seed}"
        clean = self.data / "paper" / "b25b" / "B25b_0.000.g2o"
        graph = self.made(key + ".g2o", lambda path: self.command.run(
            "corrupt", clean, "-o", path, "--style", style, "--type", kind, "--count", count,
            "--seed", seed))
        return self.bicocca(key, graph)

    def bicocca_file(self, kind, count):
        """One of the paper's own noise files."""
        name = {"local": "local", "local-grouped": "localGrouped", "random": "random",
                "random-grouped": "randomGrouped", "all-random": "allRandom"}[kind]
        graph = (self.data / "paper" / "b25b_noise5" /
                 f"B25b_0.000-lc-{count}-type-{name}-n-1.g2o")
        return self.bicocca(f"b25b-file-{kind}-{count}-1", graph)


def work_folder():
    return tempfile.TemporaryDirectory(prefix="isotherm-reproduce-")
