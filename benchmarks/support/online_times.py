"""How long calls take as the map grows, beside one solution of the map."""

import functools
import pathlib
import statistics
import tempfile

from support.online_peers import prefixes
from support.runs import read_csv
from support.streams import prepare

GRAPHS = [("ringCity", 250), ("sphere2500", 250)]  # and poses from point to point


def measure(command, data, graph, step):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        stream = prepare(command, data, work, graph, "random", 0.3)
        command.run("follow", stream.graph, "--times", work / "t.csv")
        calls = [(int(row["poses"]), float(row["cpu_ms"])) for row in read_csv(work / "t.csv")]
        points = []
        for k, lines in enumerate(prefixes(stream, step), start=1):
            (work / "part.g2o").write_text("".join(lines), encoding="utf-8")
            usage = command.run("optimize", work / "part.g2o", "--kernel", "dcs")
            times = sorted(ms for poses, ms in calls if (k - 1) * step < poses <= k * step)
            if times:
                points.append({"poses": k * step, "mean": statistics.mean(times),
                               "p99": times[int(0.99 * len(times))], "worst": times[-1],
                               "solve": 1e3 * (usage.ru_utime + usage.ru_stime)})
    return {"graph": graph, "points": points}


def tasks(command, data):
    return {f"times {graph}": functools.partial(measure, command, data, graph, step)
            for graph, step in GRAPHS}


def draw(rows, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, len(rows), figsize=(4.0 * len(rows), 3.2), squeeze=False,
                                constrained_layout=True)
    for axis, row in zip(axes[0], rows, strict=True):
        poses = [point["poses"] for point in row["points"]]
        for key, colour, label in (("solve", "#000000", "solving the map so far"),
                                   ("worst", "#D55E00", "worst call"), ("p99", "#E69F00", "99 % of calls"),
                                   ("mean", "#0072B2", "mean of calls")):
            axis.plot(poses, [point[key] for point in row["points"]], color=colour, label=label)
        axis.set_yscale("log")
        axis.set_title(row["graph"])
        axis.set_xlabel("poses")
        axis.set_ylabel("CPU ms")
    axes[0, 0].legend(fontsize=7)
    with matplotlib.rc_context({"svg.hashsalt": "isotherm", "svg.fonttype": "none"}):
        figure.savefig(path, metadata={"Date": None})
    text = path.read_text(encoding="utf-8")
    path.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n", encoding="utf-8")


def section(rows, folder):
    if not rows:
        return []
    draw(rows, folder.parent / "images" / "online-times.svg")
    lines = ["## As the map grows", "",
             "CPU time of calls beside that of `isotherm optimize --kernel dcs` on what has come so far, with",
             "30 % random false loops.", "", "![times of calls](../images/online-times.svg)", "",
             "| graph | poses | mean ms | 99 % | worst | solving the map |", "|---|---|---|---|---|---|"]
    for row in rows:
        for point in row["points"]:
            lines.append(f"| {row['graph']} | {point['poses']} | {point['mean']:.2f} | {point['p99']:.1f} |"
                         f" {point['worst']:.0f} | {point['solve']:.0f} |")
    return lines + [""]
