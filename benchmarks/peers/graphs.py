"""The labelled graphs of the comparison, and what counts as truth for each."""

import pathlib

from experiment import LabelledGraph, bicocca_truth


class Graphs:
    def __init__(self, command, data, folder):
        self.command, self.data, self.folder = command, data, pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def all(self):
        yield from self.bicocca()
        yield self.bovisa()
        yield from self.injected()

    def labelled(self, name, graph, truth, *options):
        labels = self.folder / f"{name}.labels.csv"
        self.command.run("label", graph, "--ground-truth", *truth, "-o", labels, *options)
        return labels

    def bicocca(self):
        truth = bicocca_truth(self.data)
        for alpha in ("0.100", "0.300", "0.600"):
            name = f"B25b_{alpha}"
            graph = self.data / "paper" / "b25b" / f"{name}.g2o"
            yield LabelledGraph(name, graph, self.labelled(name, graph, truth),
                        (*truth, "--max-gap", "0.25"))

    def bovisa(self):
        """Ground-truth row k belongs to vertex (k + 1) * 11393 / 1140."""
        folder = self.data / "posegraph2d" / "bovisa04"
        graph = folder / "Bovisa04_odometry_bow_tr.g2o"
        positions, stamps = self.folder / "bovisa_truth.csv", self.folder / "bovisa_stamps.txt"
        lines = (folder / "Bovisa04_GT_GPS.g2o").read_text(encoding="utf-8").splitlines()
        poses = [line.split()[2:5] for line in lines if line.startswith("VERTEX_SE2")]
        with open(positions, "w", encoding="utf-8") as file:
            file.write("time,x,y,theta\n")
            for k, pose in enumerate(poses):
                file.write(",".join([repr((k + 1) * 11393 / 1140), *pose]) + "\n")
        stamps.write_text("".join(f"{vertex}\n" for vertex in range(11393)), encoding="utf-8")
        truth = (positions, "--timestamps", stamps)
        # Labelled by translation alone, as for the peers' figures: 105 wrong of 197.
        labels = self.labelled("Bovisa04", graph, truth, "--max-translation-error", "5",
                               "--max-rotation-error", "3.15")
        return LabelledGraph("Bovisa04", graph, labels,
                             (*truth, "--max-gap", "0.5", "--partial"))

    def injected(self):
        planar, spatial = self.data / "posegraph2d", self.data / "posegraph3d"
        truths = {
            "intel": self.optimum(planar / "intel" / "intel.g2o"),
            "ringCity": planar / "ringCity" / "groundTruth" / "ringCity.g2o",
            "sphere2500": self.optimum(spatial / "sphere2500" / "sphere2500.g2o"),
        }
        for graph in sorted((self.data / "outliers").glob("*.g2o.gz")):
            name = graph.name.removesuffix(".g2o.gz")
            yield LabelledGraph(name, graph, graph.with_name(f"{name}.labels.csv"),
                        (truths[name.split("_")[0]],))

    def optimum(self, graph):
        output = self.folder / graph.name
        self.command.run("optimize", graph, "-o", output)
        return output
