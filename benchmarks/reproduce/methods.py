"""The methods that are compared, and how each is measured on a cell."""

import math
import pathlib

from cells import work_folder

HEAT = ("--method", "heat", "--preset", "datta2016")
KONST = (0, 1, 2, 3, 4)  # the paper's range
FIGURE5 = ("--scales", "100,70,10,5,1,0.1,0.001")
LAP_LINE = ("--init", "lap-line")
# Scales, largest loop weight and initialisation: what the paper leaves room in.
READINGS = {
    ("by the graph", "0.1", "χ²"): (),
    ("by the graph", "1", "χ²"): ("--loop-weight", 1),
    ("by the graph", "0.01", "χ²"): ("--loop-weight", 0.01),
    ("Figure 5's", "0.1", "χ²"): FIGURE5,
    ("Figure 5's", "1", "χ²"): (*FIGURE5, "--loop-weight", 1),
    ("by the graph", "0.1", "Lap-line"): LAP_LINE,
    ("by the graph", "1", "Lap-line"): (*LAP_LINE, "--loop-weight", 1),
    ("by the graph", "0.1", "none"): ("--init", "uniform"),
}
PRUNING = {
    "SC": ("--method", "sc"),
    "RRR": ("--method", "rrr", "--initialization", "odometry", "--no-rrr-split"),  # the paper's
    "heat (paper)": HEAT,
    "consensus": ("--method", "consensus"),
}


class Measure:
    def __init__(self, command):
        self.command = command

    def pruning(self, cell, method):
        """Precision, recall and trajectory errors of a method that prunes."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            result = self.pruned(cell, PRUNING[method], work)
            if method == "SC":  # optimises as it prunes
                result |= self.optimum(cell, cell.graph, ("--kernel", "sc"), work)
            else:
                result |= self.optimum(cell, work / "pruned.g2o", (), work)
            return result

    def heat_by_konst(self, cell):
        """F of the paper's method for every konst, all scales alike."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            return {str(konst): self.pruned(cell, (*HEAT, "--konst", konst), work)["f1"]
                    for konst in KONST}

    def heat_by_reading(self, cell):
        """F of the paper's method for every reading of what the paper says."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            return {" ".join(reading): self.pruned(cell, (*HEAT, *flags), work)["f1"]
                    for reading, flags in READINGS.items()}

    def kernel(self, cell, kernel, widths):
        """Trajectory errors of a robust kernel on the graph as it is, a width."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            return self.sweep(cell, cell.graph, kernel, widths, work)

    def pruned_then_kernel(self, cell, flags, kernel, widths):
        """Pruning, and then least squares ("0") and a robust kernel of every width."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            result = self.pruned(cell, flags, work)
            graph = work / "pruned.g2o"
            result["widths"] = {"0": self.optimum(cell, graph, (), work),
                                **self.sweep(cell, graph, kernel, widths, work)["widths"]}
            return result

    def pruned_then_default(self, cell, flags, kernel):
        """Trajectory errors after pruning, and a robust kernel at its own width."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            self.prune(cell, flags, work)
            return self.optimum(cell, work / "pruned.g2o", ("--kernel", kernel), work)

    def reference(self, cell):
        """Trajectory errors of odometry, of all loops, and of the correct ones."""
        with work_folder() as folder:
            work = pathlib.Path(folder)
            result = {"all": self.optimum(cell, cell.graph, (), work)}
            self.command.run("optimize", cell.graph, "--initialization", "odometry",
                             "--max-iterations", 0, "-o", work / "odometry.g2o")
            result["odometry"] = self.errors(cell, work / "odometry.g2o", work)
            return result

    def prune(self, cell, flags, work):
        return self.command.run("prune", cell.graph, *flags, "-o", work / "pruned.g2o",
                                "--verdicts", work / "verdicts.csv")

    def pruned(self, cell, flags, work):
        usage = self.prune(cell, flags, work)
        quality = self.command.json(work, "eval", "loops", work / "verdicts.csv", cell.labels)
        return {"seconds": usage.ru_utime,
                **{key: quality[key] for key in ("precision", "recall", "f1")}}

    def sweep(self, cell, graph, kernel, widths, work):
        return {"widths": {
            str(width): self.optimum(cell, graph, ("--kernel", kernel, "--kernel-width", width),
                                     work) for width in widths}}

    def optimum(self, cell, graph, flags, work):
        output = work / "optimum.g2o"
        self.command.run("optimize", graph, *flags, "-o", output)
        return self.errors(cell, output, work)

    def errors(self, cell, estimate, work):
        """The paper's ATE (first pose aligned, mean) and the aligned RMSE, metres."""
        def error(align):
            return self.command.json(work, "eval", "ate", estimate, *cell.truth,
                                     "--align", align)
        return {"ate": error("first")["mean"], "rmse": error("se")["rmse"]}


def mean(values):
    """The mean of what is defined; nan if nothing is."""
    known = [value for value in values if value is not None and not math.isnan(value)]
    return sum(known) / len(known) if known else math.nan


def as_measured(result):
    return result


def without_kernel(result):
    return result["widths"]["0"]


def with_best_width(result, key="ate"):
    """At the width with the lowest ATE: the paper's rule, which uses the truth."""
    return min((errors for width, errors in result["widths"].items() if width != "0"),
               key=lambda errors: errors[key])


# What Table II compares: method, and how its errors are picked.
BICOCCA_COLUMNS = {
    "odometry": ("reference", lambda result: result["odometry"]),
    "all loops": ("reference", lambda result: result["all"]),
    "DCS": ("dcs", with_best_width),
    "Cauchy": ("cauchy", with_best_width),
    "heat (Lap-line) + DCS": ("heat (Lap-line) + DCS", with_best_width),
    "heat (χ²) + DCS": ("heat (χ²) + DCS", with_best_width),
    "heat (χ²) + Cauchy": ("heat (χ²) + Cauchy", as_measured),
    "consensus": ("consensus", without_kernel),
    "consensus + DCS": ("consensus", with_best_width),
    "consensus + Cauchy": ("consensus + Cauchy", as_measured),
}
CONSENSUS = [name for name in BICOCCA_COLUMNS if name.startswith("consensus")]
NOT_THE_PAPERS = "heat (χ²) + Cauchy"


def bicocca_error(results, extent, style, kind, count, column, key):
    """The mean error of a column of Table II over the seeds; nan where not measured."""
    method, pick = BICOCCA_COLUMNS[column]
    return mean([pick(result)[key]
                 for result in bicocca_results(results, extent, style, kind, count, method)])


def bicocca_results(results, extent, style, kind, count, method):
    seeds = (1,) if style == "file" else extent.seeds
    found = [results.get(f"table2/{style}/{kind}/{count}/{seed}/{method}") for seed in seeds]
    return [result for result in found if result is not None]
