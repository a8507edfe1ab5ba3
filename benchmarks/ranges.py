#!/usr/bin/env python3
"""Runs `isotherm localize` on robots that move among beacons, as they are and with ranges made
false or too long, from its own start and from the true one, and writes docs/results/ranges.md.

usage: scripts/build.sh release
       benchmarks/ranges.py [--only NAME ...] [--seeds N] [--page-only] [--data FOLDER]

Every cell is kept in build/ranges.json as soon as it is measured; a run that is stopped goes on
where it was. FOLDER is that of the data sets (default $ISOTHERM_DATA or ../shared/data).
"""
import argparse
import bisect
import csv
import json
import math
import os
import pathlib
import random
import re
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMAND = os.environ.get("ISOTHERM", str(ROOT / "build/release/apps/isotherm"))
STORE = pathlib.Path(os.environ.get("RANGES_STORE", ROOT / "build/ranges.json"))
PAGE = ROOT / "docs/results/ranges.md"
FRACTIONS = (0.1, 0.2, 0.3)
EXCESS = 0.1  # mean of that of ranges made too long, of the median range


# --- rigid alignment without other packages ---------------------------------------------------

def mean(points):
    return [sum(column) / len(points) for column in zip(*points)]


def rotation_2d(a, b):
    angle = math.atan2(sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(a, b)),
                       sum(p[0] * q[0] + p[1] * q[1] for p, q in zip(a, b)))
    c, s = math.cos(angle), math.sin(angle)
    return [[c, -s], [s, c]]


def rotation_3d(a, b):
    """Horn's quaternion: the eigenvector of the largest eigenvalue, by Jacobi's rotations."""
    s = [[sum(p[i] * q[j] for p, q in zip(a, b)) for j in range(3)] for i in range(3)]
    n = [[s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]],
         [0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]],
         [0, 0, -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1]],
         [0, 0, 0, -s[0][0] - s[1][1] + s[2][2]]]
    for i in range(4):
        for j in range(i):
            n[i][j] = n[j][i]
    v = [[float(i == j) for j in range(4)] for i in range(4)]
    for _ in range(60):
        for p in range(4):
            for q in range(p + 1, 4):
                if n[p][q] == 0.0:
                    continue
                t = 0.5 * math.atan2(2 * n[p][q], n[q][q] - n[p][p])
                c, sn = math.cos(t), math.sin(t)
                for k in range(4):
                    n[k][p], n[k][q] = c * n[k][p] - sn * n[k][q], sn * n[k][p] + c * n[k][q]
                for k in range(4):
                    n[p][k], n[q][k] = c * n[p][k] - sn * n[q][k], sn * n[p][k] + c * n[q][k]
                for k in range(4):
                    v[k][p], v[k][q] = c * v[k][p] - sn * v[k][q], sn * v[k][p] + c * v[k][q]
    best = max(range(4), key=lambda i: n[i][i])
    w, x, y, z = (v[i][best] for i in range(4))
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def errors(estimate, truth, beacons):
    """RMSE of poses and of beacons, once the poses are moved rigidly onto the true ones."""
    poses = [name for name in truth if name in estimate and name not in beacons]
    a, b = [estimate[n] for n in poses], [truth[n] for n in poses]
    ca, cb = mean(a), mean(b)
    centred = ([[x - c for x, c in zip(p, ca)] for p in a], [[x - c for x, c in zip(p, cb)] for p in b])
    turn = (rotation_2d if len(ca) == 2 else rotation_3d)(*centred)

    def moved(p):
        centred = [x - c for x, c in zip(p, ca)]
        return [sum(r * x for r, x in zip(row, centred)) + c for row, c in zip(turn, cb)]

    def rmse(names):
        found = [math.dist(moved(estimate[n]), truth[n]) for n in names if n in estimate]
        return math.sqrt(sum(e * e for e in found) / len(found)) if found else math.nan

    return rmse(poses), rmse([n for n in truth if n in beacons])


# --- data -------------------------------------------------------------------------------------

class PyFG:
    def __init__(self, path):
        self.lines = path.read_text().splitlines()
        self.truth, self.beacons, self.ranges = {}, set(), []
        for k, line in enumerate(self.lines):
            f = line.split()
            if f[0] in ("VERTEX_SE2", "VERTEX_SE3:QUAT"):
                self.truth[f[2]] = [float(x) for x in f[3:5 + (f[0] != "VERTEX_SE2")]]
            elif f[0] in ("VERTEX_XY", "VERTEX_XYZ"):
                self.truth[f[1]] = [float(x) for x in f[2:]]
                self.beacons.add(f[1])
            elif f[0] == "EDGE_RANGE":
                self.ranges.append(k)
        self.lengths = [float(self.lines[k].split()[4]) for k in self.ranges]
        self.true_lengths = [math.dist(*(self.truth[name] for name in self.lines[k].split()[2:4]))
                             for k in self.ranges]

    def with_length(self, k, length):
        f = self.lines[k].split()
        return " ".join([*f[:4], repr(length), *f[5:]])


class LibRSF:
    def __init__(self, path):
        self.lines = path.read_text().splitlines()
        true = [line.split() for line in
                path.with_name(path.name.replace("Input", "GT")).read_text().splitlines()]
        at = {float(f[1]): [float(f[2]), float(f[3])] for f in true}
        self.truth, self.beacons, self.ranges = {}, set(), []
        times = sorted(float(line.split()[1]) for line in self.lines if line.startswith("odom"))
        for k, t in enumerate(times):
            if t in at:
                self.truth[str(k)] = at[t]
        for k, line in enumerate(self.lines):
            if line.startswith("range2"):
                f = line.split()
                self.beacons.add("L" + f[6])
                self.truth["L" + f[6]] = [float(f[4]), float(f[5])]
                self.ranges.append(k)
        self.lengths = [float(self.lines[k].split()[2]) for k in self.ranges]

    def as_pyfg(self, path):
        """The same with the true positions as vertices, headings by how the robot moves."""
        rows = sorted(tuple(map(float, line.split()[1:])) for line in self.lines
                      if line.startswith("odom"))
        lines, heading = [], 0.0
        for k, row in enumerate(rows):
            back, on = (self.truth.get(str(i)) for i in (max(k - 2, 0), min(k + 2, len(rows) - 1)))
            if back and on and math.dist(back, on) > 0.05:
                heading = math.atan2(on[1] - back[1], on[0] - back[0])
                if row[1] + row[2] < 0.0:
                    heading = math.remainder(heading + math.pi, math.tau)
            x, y = self.truth.get(str(k)) or self.truth[str(k - 1)]
            lines.append(f"VERTEX_SE2 {row[0]!r} X{k} {x!r} {y!r} {heading!r}")
        for name in sorted(self.beacons):
            lines.append(f"VERTEX_XY {name} {self.truth[name][0]!r} {self.truth[name][1]!r}")
        for k in range(1, len(rows)):
            time, first, second, _, arm, *variance = rows[k]
            passed = time - rows[k - 1][0]
            length, turn = 0.5 * passed * (first + second), 0.5 * passed * (second - first) / arm
            x, y = length * math.cos(0.5 * turn), length * math.sin(0.5 * turn)
            xx = 0.25 * passed ** 2 * (variance[0] + variance[1])
            yy, tt = passed ** 2 * variance[2], 0.25 * passed ** 2 * (variance[0] + variance[1]) / arm ** 2
            lines.append(f"EDGE_SE2 {time!r} X{k - 1} X{k} {x!r} {y!r} {turn!r} {xx!r} 0 0 {yy!r} 0 {tt!r}")
        pose_at = {row[0]: k for k, row in enumerate(rows)}
        for k in self.ranges:
            f = self.lines[k].split()
            lines.append(f"EDGE_RANGE {f[1]} X{pose_at[float(f[1])]} L{f[6]} {f[2]} {f[3]}")
        path.write_text("\n".join(lines) + "\n")
        return PyFG(path)


def median(values):
    return sorted(values)[len(values) // 2]


def spoilt(data, fault, fraction, seed):
    """The lengths with a share of them false or too long, and which these are."""
    source = random.Random(f"{fault} {fraction} {seed}")
    lengths = list(data.lengths)
    chosen = set(source.sample(range(len(lengths)), round(fraction * len(lengths))))
    longest, typical = max(lengths), median(lengths)
    for k in sorted(chosen):
        if fault == "false":
            lengths[k] = source.uniform(0.0, longest)
        else:
            lengths[k] += source.expovariate(1.0 / (EXCESS * typical))
    return lengths, chosen


def write(data, path, lengths, without=()):
    lines = list(data.lines)
    for k, length in zip(data.ranges, lengths):
        lines[k] = data.with_length(k, length)
    drop = {data.ranges[k] for k in without}
    path.write_text("\n".join(line for k, line in enumerate(lines) if k not in drop) + "\n")


# --- runs -------------------------------------------------------------------------------------

def run(data, lengths, folder, *flags, without=()):
    source = folder / "ranges.pyfg"
    write(data, source, lengths, without)
    return run_file(data, source, folder, *flags)


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_file(data, source, folder, *flags):
    positions, verdicts, result = (folder / name for name in ("p.csv", "v.csv", "r.json"))
    start = processor_seconds()
    done = subprocess.run([COMMAND, "localize", source, "-o", positions, "--verdicts", verdicts,
                           "--json", result, "-q", *flags], capture_output=True, text=True)
    seconds = processor_seconds() - start
    if done.returncode not in (0, 4):
        raise RuntimeError(done.stderr)
    with open(positions, newline="") as file:
        axes = "xyz"[:len(next(iter(data.truth.values())))]
        estimate = {row["node"]: [float(row[a]) for a in axes] for row in csv.DictReader(file)
                    if row["x"] != "nan"}
    with open(verdicts, newline="") as file:
        pruned = {int(row["edge"]) for row in csv.DictReader(file) if row["verdict"] == "prune"}
    found = json.loads(result.read_text())
    trajectory, beacons = errors(estimate, data.truth, data.beacons)
    placed = sum(name in estimate for name in data.beacons)
    return {"trajectory": trajectory, "beacons": beacons, "placed": placed, "cost": found["cost"],
            "evidence": found["evidence"], "calibrated": found["calibrated"],
            "bias": found["share_too_long"], "seconds": seconds,
            "code": done.returncode}, pruned


def counts(data, lengths, chosen, pruned, fault, sigma):
    """Precision, recall, and recall of those too long by more than three deviations."""
    true = len(pruned & chosen)
    clear = {k for k in chosen
             if fault == "false" or lengths[k] - data.lengths[k] > 3.0 * sigma}
    return {"precision": true / len(pruned) if pruned else 1.0,
            "recall": len(pruned & clear) / len(clear) if clear else 1.0}


def pruned_by_who_knows(data, lengths, chosen, fault, fraction):
    """What is likelier wrong to somebody who knows all places, how the errors of the correct ranges
    are distributed, and how many are wrong and how: nobody can tell more."""
    known = sorted(data.lengths[k] - data.true_lengths[k]
                   for k in range(len(lengths)) if k not in chosen)
    width = median(sorted(map(abs, known))) * len(known) ** -0.2  # of a kernel around each
    excess = EXCESS * median(data.lengths)

    def normal(x):
        return math.exp(-0.5 * (x / width) ** 2) / (width * math.sqrt(math.tau))

    def correct(error, itself):
        near = known[bisect.bisect(known, error - 6.0 * width):
                     bisect.bisect(known, error + 6.0 * width)]
        return (sum(normal(error - e) for e in near) - itself * normal(0.0)) / (len(known) - itself)

    def wrong(error):
        if fault == "false":
            return 1.0 / max(data.lengths)
        shorter = known[bisect.bisect(known, error - 30.0 * excess):bisect.bisect(known, error)]
        return sum(math.exp((e - error) / excess) for e in shorter) / (excess * len(known))

    pruned = set()
    for k, length in enumerate(lengths):
        error = length - data.true_lengths[k]
        if (1.0 - fraction) * correct(error, k not in chosen) < fraction * wrong(error):
            pruned.add(k)
    return pruned


def sigma_of(data):
    return math.sqrt(float(data.lines[data.ranges[0]].split()[5]))


class Store:
    def __init__(self):
        self.cells = json.loads(STORE.read_text()) if STORE.exists() else {}

    def cell(self, key, measure):
        if key not in self.cells:
            self.cells[key] = measure()
            STORE.parent.mkdir(exist_ok=True)
            STORE.write_text(json.dumps(self.cells, indent=1))
            print(key, self.cells[key], flush=True)
        return self.cells[key]


def measure(store, name, data, seeds):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        store.cell(f"{name}/clean/automatic", lambda: run(data, data.lengths, folder)[0])
        store.cell(f"{name}/clean/file", lambda: run(data, data.lengths, folder, "--start", "file")[0])
        for fault in ("false", "long"):
            for fraction in FRACTIONS:
                for seed in range(seeds):
                    key = f"{name}/{fault} {fraction:.0%} {seed}"
                    lengths, chosen = spoilt(data, fault, fraction, seed)

                    def all_of_them():
                        result, pruned = run(data, lengths, folder)
                        known = pruned_by_who_knows(data, lengths, chosen, fault, fraction)
                        most = counts(data, lengths, chosen, known, fault, sigma_of(data))
                        return (result | counts(data, lengths, chosen, pruned, fault, sigma_of(data))
                                | {f"most {what}": share for what, share in most.items()})
                    store.cell(key, all_of_them)
                    store.cell(key + "/correct", lambda: run(data, data.lengths, folder,
                                                             without=chosen)[0])


def measure_log(store, data, path):
    """The log of the same drive as the radio gave it. Of its beacons, 5 is L3 and 6 is L2."""
    renamed = dict(data.truth)
    renamed["L5"], renamed["L6"] = renamed.pop("L3"), renamed.pop("L2")

    def of_log():
        with tempfile.TemporaryDirectory() as temporary:
            beside = argparse.Namespace(truth=renamed, beacons={"L0", "L1", "L5", "L6"})
            return run_file(beside, path.with_name("Plaza1_TD.txt"), pathlib.Path(temporary),
                            "--odometry", path)[0]
    store.cell("plaza1/log", of_log)


def number(cell, key, digits=3):
    value = cell.get(key) if cell else None
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}f}"


def start_rows(cells):
    rows = ["| data | start | trajectory | beacons | cost | seconds |", "|---|---|---|---|---|---|"]
    for name in DATA:
        for key, start in (("clean/automatic", "automatic"), ("clean/file", "true"),
                           ("log", "automatic, raw log")):
            cell = cells.get(f"{name}/{key}")
            if cell:
                note = "" if cell["code"] == 0 else " *"
                rows.append(f"| {name} | {start}{note} | {number(cell, 'trajectory')} | "
                            f"{number(cell, 'beacons')} | {number(cell, 'cost', 1)} | "
                            f"{number(cell, 'seconds', 0)} |")
    return rows


def fault_rows(cells):
    rows = ["| data | wrong ranges | P | R | P, places known | R, places known | trajectory | "
            "correct ones only | beacons | correct ones only | seconds |",
            "|---|---|---|---|---|---|---|---|---|---|---|"]
    for key, cell in cells.items():
        if "precision" not in cell:
            continue
        name, fault = key.split("/")
        correct = cells.get(key + "/correct")
        rows.append(f"| {name} | {fault.rsplit(' ', 1)[0]} | {number(cell, 'precision')} | "
                    f"{number(cell, 'recall')} | {number(cell, 'most precision')} | "
                    f"{number(cell, 'most recall')} | {number(cell, 'trajectory')} | "
                    f"{number(correct, 'trajectory')} | {number(cell, 'beacons')} | "
                    f"{number(correct, 'beacons')} | {number(cell, 'seconds', 0)} |")
    return rows


def write_page(cells):
    text = PAGE.read_text() if PAGE.exists() else "<!-- starts -->\n<!-- faults -->\n"
    for mark, rows in (("starts", start_rows(cells)), ("faults", fault_rows(cells))):
        table = f"<!-- {mark} -->\n" + "\n".join(rows) + f"\n<!-- end of {mark} -->"
        text = re.sub(f"<!-- {mark} -->(.*<!-- end of {mark} -->)?", lambda _: table, text, flags=re.S)
    PAGE.write_text(text)


DATA = {"plaza1": (PyFG, "snl/plaza1/plaza1.pyfg"),
        "single_drone": (PyFG, "snl/single_drone/single_drone.pyfg"),
        "labyrinth": (LibRSF, "snl/labyrinth_uwb/Indoor_UWB_Input.txt")}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", default=list(DATA))
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--page-only", action="store_true", help="write the page of what there is")
    parser.add_argument("--data", type=pathlib.Path,
                        default=os.environ.get("ISOTHERM_DATA", ROOT / ".." / "shared" / "data"))
    given = parser.parse_args()
    store = Store()
    for name in () if given.page_only else given.only:
        reader, path = DATA[name]
        with tempfile.TemporaryDirectory() as folder:
            data = reader(pathlib.Path(given.data) / path)
            if reader is LibRSF:
                data = data.as_pyfg(pathlib.Path(folder) / "ranges.pyfg")
            if name == "plaza1":
                measure_log(store, data, pathlib.Path(given.data) / path)
            measure(store, name, data, given.seeds)
    write_page(store.cells)


if __name__ == "__main__":
    main()
