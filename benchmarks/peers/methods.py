"""The methods of the comparison, and how each is measured."""

import pathlib
import tempfile

REAL = ("B25b_0.100", "B25b_0.300", "B25b_0.600", "Bovisa04")


def kernel(name, width):
    return ("--method", name, "--kernel-width", str(width))


def quantile(graph):
    """The 0.99 quantile of a loop's chi-squared, GTSAM's width of GNC."""
    return 16.81 if graph.startswith("sphere") else 11.34


def methods(graph):
    """Name to flags of `prune`; None: every loop is kept."""
    table = {
        "all loops": None,
        "chi2 gate": ("--method", "chi2"),
        "heat": ("--method", "heat"),
        "consensus": ("--method", "consensus"),
        "SC": ("--method", "sc"),
        "DCS w1": kernel("dcs", 1), "DCS w5": kernel("dcs", 5), "DCS w19": kernel("dcs", 19),
        "Cauchy w1": kernel("cauchy", 1),
        "GNC 0.99": kernel("gnc", quantile(graph)),
        "RRR": ("--method", "rrr"),
        "RRR gap 10": ("--method", "rrr", "--rrr-cluster-gap", "10"),
        "PCM": ("--method", "pcm"),
    }
    if graph in REAL:  # the widths with which the peers' programs did best there
        table |= {"DCS w2": kernel("dcs", 2), "DCS w13": kernel("dcs", 13),
                  "Cauchy w2": kernel("cauchy", 2), "Cauchy w3": kernel("cauchy", 3),
                  "Cauchy w4": kernel("cauchy", 4)}
    if graph.startswith("sphere"):  # a branch among thousands of loops takes milliseconds
        table["PCM"] += ("--pcm-clique-budget", "1000")
    return table


def measure(command, graph, flags):
    """Quality of pruning, and errors of the method's own optimum (SC, DCS, Cauchy), or of
    least squares on what it keeps."""
    with tempfile.TemporaryDirectory(prefix="isotherm-peers-") as folder:
        work = pathlib.Path(folder)
        pruned, verdicts, optimum = work / "p.g2o", work / "v.csv", work / "o.g2o"
        result = {"seconds": 0.0, "megabytes": 0.0}
        if flags is not None:
            usage = command.run("prune", graph.graph, *flags, "-o", pruned, "--verdicts", verdicts)
            result = {"seconds": usage.ru_utime, "megabytes": usage.ru_maxrss / 1024}
            quality = command.json(work, "eval", "loops", verdicts, graph.labels)
            result |= {key: quality[key] for key in ("precision", "recall", "f1", "fp")}
        if flags is not None and flags[1] in ("sc", "dcs", "cauchy"):
            command.run("optimize", graph.graph, "--kernel", *flags[1:], "-o", optimum)
        else:
            command.run("optimize", graph.graph if flags is None else pruned, "-o", optimum)
        for align, statistic in (("first", "mean"), ("se", "rmse")):
            errors = command.json(work, "eval", "ate", optimum, *graph.truth, "--align", align)
            result[statistic] = errors[statistic]
        return result
