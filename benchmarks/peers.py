"""Runs every method on every labelled graph and prints one table row a run.

usage: peers.py ISOTHERM DATA [NAME...]

A NAME keeps the graphs whose name contains it. Seconds are user CPU time and
megabytes the peak of `isotherm prune`; trajectory errors are those of the
method's own optimum (kernels), or of least squares on the pruned graph.
"""

import json
import os
import subprocess
import sys
import tempfile

TIME_LIMIT = 600  # seconds a run
METHODS = [
    ("none", []),
    ("chi2", []),
    ("heat", []),
    ("consensus", []),
    ("sc", []),
    ("dcs", ["--kernel-width", "1"]),
    ("dcs", ["--kernel-width", "5"]),
    ("dcs", ["--kernel-width", "19"]),
    ("cauchy", ["--kernel-width", "1"]),
    ("gnc", ["--kernel-width", "11.34"]),  # the 0.99 quantile, as GTSAM has it
    ("rrr", []),
    ("rrr", ["--rrr-cluster-gap", "10"]),
    ("pcm", []),
]
OWN_OPTIMUM = ("sc", "dcs", "cauchy")


def run(line):
    """(exit code, user seconds, peak megabytes) of a command."""
    process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    _, status, usage = os.wait4(process.pid, 0)
    message = process.stderr.read().decode()
    code = os.waitstatus_to_exitcode(status)
    if code not in (0, 4):
        print(f"{' '.join(line)}: {message}", file=sys.stderr)
    return code, usage.ru_utime, usage.ru_maxrss / 1024


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Bench:
    def __init__(self, command, data, folder):
        self.command, self.data, self.folder = command, data, folder

    def path(self, *names):
        return os.path.join(self.data, *names)

    def made(self, name):
        return os.path.join(self.folder, name)

    def isotherm(self, *arguments):
        line = ["timeout", str(TIME_LIMIT), self.command, *arguments, "--quiet"]
        return run(line)

    def graphs(self):
        """(name, graph, labels, arguments that give the truth)."""
        yield from self.bicocca()
        yield self.bovisa()
        yield from self.injected()

    def bicocca(self):
        folder = self.path("paper", "b25b")
        truth = os.path.join(folder, "Bicocca_2009-02-25b-GT-extended.csv")
        stamps = ["--timestamps", os.path.join(folder, "B25b_timestamps.txt")]
        for alpha in ("0.100", "0.300", "0.600"):
            graph = os.path.join(folder, f"B25b_{alpha}.g2o")
            labels = self.made(f"b25b_{alpha}.csv")
            self.isotherm("label", graph, "--ground-truth", truth, *stamps, "-o", labels)
            yield f"B25b_{alpha}", graph, labels, [truth, *stamps, "--max-gap", "0.25"]

    def bovisa(self):
        """Ground-truth row k belongs to vertex (k + 1) * 11393 / 1140."""
        folder = self.path("posegraph2d", "bovisa04")
        graph = os.path.join(folder, "Bovisa04_odometry_bow_tr.g2o")
        truth, stamps = self.made("bovisa_truth.csv"), self.made("bovisa_stamps.txt")
        with open(os.path.join(folder, "Bovisa04_GT_GPS.g2o"), encoding="utf-8") as file:
            poses = [line.split()[2:5] for line in file if line.startswith("VERTEX_SE2")]
        with open(truth, "w", encoding="utf-8") as file:
            file.write("time,x,y,theta\n")
            for k, pose in enumerate(poses):
                file.write(",".join([repr((k + 1) * 11393 / 1140), *pose]) + "\n")
        with open(stamps, "w", encoding="utf-8") as file:
            file.writelines(f"{vertex}\n" for vertex in range(11393))
        labels = self.made("bovisa.csv")
        by_time = ["--timestamps", stamps]
        self.isotherm("label", graph, "--ground-truth", truth, *by_time, "-o", labels,
                      "--max-translation-error", "5")
        return "Bovisa04", graph, labels, [truth, *by_time, "--max-gap", "0.5"]

    def injected(self):
        truths = {
            "intel": self.optimum(self.path("posegraph2d", "intel", "intel.g2o")),
            "ringCity": self.path("posegraph2d", "ringCity", "groundTruth", "ringCity.g2o"),
            "sphere2500": self.optimum(self.path("posegraph3d", "sphere2500", "sphere2500.g2o")),
        }
        for file in sorted(os.listdir(self.path("outliers"))):
            if not file.endswith(".g2o.gz"):
                continue
            name = file[: -len(".g2o.gz")]
            labels = self.path("outliers", name + ".labels.csv")
            yield name, self.path("outliers", file), labels, [truths[name.split("_")[0]]]

    def optimum(self, graph):
        output = self.made(os.path.basename(graph))
        self.isotherm("optimize", graph, "-o", output)
        return output

    def measure(self, name, graph, labels, truth, method, flags):
        pruned, verdicts, result = self.made("p.g2o"), self.made("v.csv"), self.made("r.json")
        quality, seconds, megabytes = {}, 0.0, 0.0
        if method != "none":
            code, seconds, megabytes = self.isotherm(
                "prune", graph, "--method", method, *flags, "-o", pruned, "--verdicts", verdicts)
            if code not in (0, 4):
                return None
            self.isotherm("eval", "loops", verdicts, labels, "--json", result)
            quality = read_json(result)
        optimum = self.made("o.g2o")
        if method in OWN_OPTIMUM:
            self.isotherm("optimize", graph, "--kernel", method, *flags, "-o", optimum)
        else:
            self.isotherm("optimize", graph if method == "none" else pruned, "-o", optimum)
        errors = {}
        for align in ("first", "se"):
            self.isotherm("eval", "ate", optimum, *truth, "--align", align, "--json", result)
            errors[align] = read_json(result)
        return {"graph": name, "method": " ".join([method, *(f.lstrip("-") for f in flags)]),
                "precision": quality.get("precision"), "recall": quality.get("recall"),
                "f1": quality.get("f1"), "first": errors["first"]["mean"],
                "rmse": errors["se"]["rmse"], "seconds": seconds, "megabytes": megabytes}


def row(result):
    def shown(key, digits):
        value = result[key]
        return "–" if value is None else f"{value:.{digits}f}"

    cells = [result["graph"], result["method"]]
    cells += [shown(key, 3) for key in ("precision", "recall", "f1")]
    cells += [shown(key, 2) for key in ("first", "rmse", "seconds")] + [shown("megabytes", 0)]
    return "| " + " | ".join(cells) + " |"


def main():
    command, data, wanted = sys.argv[1], sys.argv[2], sys.argv[3:]
    print("| graph | method | P | R | F | ATE first-pose | RMSE aligned | user s | MB |")
    print("|---|---|---|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(command, data, folder)
        for name, graph, labels, truth in bench.graphs():
            if wanted and not any(part in name for part in wanted):
                continue
            for method, flags in METHODS:
                result = bench.measure(name, graph, labels, truth, method, flags)
                if result is not None:
                    print(row(result), flush=True)


if __name__ == "__main__":
    main()
