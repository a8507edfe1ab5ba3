#!/usr/bin/env python3
"""Runs isotherm-mpi on several ranks and expects it to end as it should: with the right files, or
with one message, its exit code and nothing half-written.

usage: command_runs.py MPIEXEC COMMAND
"""

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MPIEXEC, COMMAND = sys.argv[1:3]
LONGEST = 120  # seconds a run may take before it counts as hanging
OK, FAILURE, USAGE, BAD_INPUT, NOT_CONVERGED = 0, 1, 2, 3, 4


def start(folder, ranks, *words):
    return subprocess.Popen([MPIEXEC, "-n", str(ranks), COMMAND, *map(str, words)], cwd=folder,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def run(folder, ranks, *words):
    process = start(folder, ranks, *words)
    out, err = process.communicate(timeout=LONGEST)
    return process.returncode, out, err


def write_pose_graph(path, poses, seed=1):
    chance = random.Random(seed)
    with open(path, "w") as file:
        file.write("from,to,weight\n")
        for pose in range(poses - 1):
            file.write(f"{pose},{pose + 1},1\n")
        for _ in range(poses // 10):
            pose = chance.randrange(poses)
            file.write(f"{pose},{(pose + chance.randrange(2, 200)) % poses},0.5\n")


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def files_in(folder):
    return sorted(path.name for path in Path(folder).iterdir())


def rows_do_not_depend_on_ranks(folder):
    write_pose_graph(folder / "graph.csv", 3000)
    texts = {}
    for ranks in (1, 2, 4):
        code, _, err = run(folder, ranks, "heat", "graph.csv", "--scales", "5,1", "-o", "heat.csv")
        expect(code == OK, err)
        expect(err.count("pairs, 2 scales") == 1, err)
        texts[ranks] = (folder / "heat.csv").read_text()
    rows = {ranks: [line.split(",") for line in text.splitlines()[1:]]
            for ranks, text in texts.items()}
    expect(len(rows[1]) > 6500 and len(rows[1]) % 2 == 0, "a row a pair and scale")
    for ranks in (2, 4):
        for one, other in zip(rows[1], rows[ranks]):
            expect(one[:3] == other[:3], f"{one} {other}")
            expect(float(one[4]) <= float(other[5]) and float(other[4]) <= float(one[5]), other)


def embeds_in_both_formats(folder):
    write_pose_graph(folder / "graph.csv", 1500)
    for name in ("a.csv", "b.npy"):
        code, _, err = run(folder, 2, "embed", "graph.csv", "-o", name, "--dimensions", 3)
        expect(code == OK, err)
    lines = (folder / "a.csv").read_text().splitlines()
    expect(lines[0] == "vertex,x0,x1,x2" and len(lines) == 1501, lines[0])
    expect([line.split(",")[0] for line in lines[1:]] == [str(v) for v in range(1500)], "order")
    data = (folder / "b.npy").read_bytes()
    expect(data.startswith(b"\x93NUMPY") and len(data) == 128 + 8 * 3 * 1500, len(data))


def edges_do_not_depend_on_ranks(folder):
    write_pose_graph(folder / "graph.csv", 400)
    (folder / "trusted.csv").write_text("".join(f"{pose + 1},{pose}\n" for pose in range(200)))
    texts = {}
    for ranks in (1, 4):
        code, _, err = run(folder, ranks, "edges", "graph.csv", "--trusted", "trusted.csv", "-o",
                           "kept.csv", "--verdicts", "verdicts.csv", "--scales", "50,5",
                           "--konst", 1)
        expect(code == OK and "heat-multiscale" in err, err)
        rows = [row.split(",") for row in (folder / "verdicts.csv").read_text().splitlines()]
        texts[ranks] = ((folder / "kept.csv").read_text(), [row[:4] + row[6:] for row in rows])
    expect(texts[1] == texts[4], "decisions")
    stages = {row[4] for row in texts[1][1][1:]}
    expect(stages == {"trusted", "t=50", "t=5"} or "bridge" in stages, stages)
    expect("prune" in {row[3] for row in texts[1][1]}, "should prune some")


def write_g2o(path, poses, seed=2):
    """A straight drive with loops of a few steps, as measured, and some that are far from it."""
    chance = random.Random(seed)
    information = "100 0 0 100 0 100"
    lines = [f"VERTEX_SE2 {pose} {pose} 0 0" for pose in range(poses)]
    lines += [f"EDGE_SE2 {pose} {pose + 1} 1 0 0 {information}" for pose in range(poses - 1)]
    for _ in range(poses // 10):
        start, step = chance.randrange(poses - 20), chance.randrange(5, 15)
        lines.append(f"EDGE_SE2 {start} {start + step} {step} 0 0 {information}")
    first_false = len(lines) - poses
    for _ in range(poses // 40):
        start = chance.randrange(poses // 3)
        lines.append(f"EDGE_SE2 {start} {start + poses // 2} 0 0 0 {information}")
    Path(path).write_text("\n".join(lines) + "\n")
    return first_false


def prunes_as_on_one_rank(folder):
    first_false = write_g2o(folder / "graph.g2o", 400)
    texts = {}
    for ranks in (1, 4):
        code, _, err = run(folder, ranks, "prune", "graph.g2o", "-o", "kept.g2o", "--verdicts",
                           "verdicts.csv", "--json", "result.json", "--scales", "50,5")
        expect(code == OK and err.count("heat: 50 loops, 40 kept, 10 pruned") == 1, err)
        rows = [row.split(",") for row in (folder / "verdicts.csv").read_text().splitlines()]
        texts[ranks] = ((folder / "kept.g2o").read_text(), [row[:4] for row in rows])
    expect(texts[1] == texts[4], "decisions")
    expect({row[3] for row in texts[1][1][1:] if int(row[0]) >= first_false} == {"prune"}, "false")
    code, _, err = run(folder, 2, "prune", "absent.g2o", "-o", "out.g2o")
    expect(code == BAD_INPUT and err.count("isotherm:") == 1, err)
    code, _, err = run(folder, 2, "prune", "graph.g2o", "--trusted", "graph.g2o")
    expect(code == BAD_INPUT and err.count("isotherm:") == 1, err)


def pairs_of_a_file(folder):
    write_pose_graph(folder / "graph.csv", 500)
    (folder / "pairs.csv").write_text("from,to\n3,400\n7,7\n")
    code, out, err = run(folder, 4, "heat", "graph.csv", "--pairs", "pairs.csv", "-o", "-",
                         "--scales", "1", "-q")
    expect(code == OK and out.splitlines()[2] == "7,7,1,0,0,0", out + err)
    (folder / "pairs.csv").write_text("from,to\n3,400\n7,700\n")
    code, out, err = run(folder, 4, "heat", "graph.csv", "--pairs", "pairs.csv", "-o", "-")
    expect(code == USAGE and "none that is numbered 700" in err, err)


def more_ranks_than_vertices(folder):
    (folder / "graph.csv").write_text("1,2\n2,3\n")
    for verb in ("heat", "embed"):
        code, _, err = run(folder, 4, verb, "graph.csv", "-o", "out.csv")
        expect(code == OK, err)


def bad_input_is_told_once(folder):
    write_pose_graph(folder / "graph.csv", 2000)
    lines = (folder / "graph.csv").read_text().splitlines()
    lines[1500] = "1,x,1"
    (folder / "graph.csv").write_text("\n".join(lines))
    code, _, err = run(folder, 4, "embed", "graph.csv", "-o", "out.csv")
    expect(code == BAD_INPUT, code)
    expect(err.count("graph.csv:1501:3: expected the second vertex") == 1, err)
    for words in (("embed", "absent.csv", "-o", "out.csv"),
                  ("embed", "graph.csv", "-o", "no/such/folder.csv")):
        code, _, err = run(folder, 2, *words)
        expect(code == BAD_INPUT and err.count("isotherm:") == 1, err)
    code, _, err = run(folder, 2, "embed", "graph.csv", "-o", "out.csv", "--dimensions", 0)
    expect(code == USAGE and err.count("isotherm:") == 1, err)
    expect(files_in(folder) == ["graph.csv"], files_in(folder))


def cut_off_binary_graph(folder):
    (folder / "graph.isograph").write_bytes(b"ISOGRAPH" + bytes([1] + 7 * [0] + [9] + 7 * [0] +
                                                              [9] + 7 * [0]) + bytes(50))
    code, _, err = run(folder, 4, "embed", "graph.isograph", "-o", "out.csv")
    expect(code == BAD_INPUT and "expected 248 bytes, found 82" in err, err)


def too_few_steps(folder):
    write_pose_graph(folder / "graph.csv", 300)
    code, _, err = run(folder, 2, "heat", "graph.csv", "-o", "out.csv", "--scales", "100",
                       "--max-steps", 3)
    expect(code == NOT_CONVERGED and "not converged" in err, err)


def ranks_of(process):
    """The processes that mpirun started."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children
            if "isotherm-mpi" in Path(f"/proc/{child}/cmdline").read_text()]


def ends_without_output(folder, stop):
    write_pose_graph(folder / "graph.csv", 20000)
    (folder / "out.csv").write_text("before\n")
    process = start(folder, 2, "heat", "graph.csv", "-o", "out.csv", "--scales", "1e4",
                    "--tolerance", "1e-9")
    time.sleep(3)
    expect(process.poll() is None, "should be running")
    expect(len(ranks_of(process)) == 2, "should have two ranks")
    stop(process)
    process.communicate(timeout=LONGEST)
    expect(process.returncode != OK, process.returncode)
    expect((folder / "out.csv").read_text() == "before\n", "the older file stays")
    expect(files_in(folder) == ["graph.csv", "out.csv"], files_in(folder))


def killed_rank(folder):
    ends_without_output(folder, lambda process: os.kill(ranks_of(process)[1], signal.SIGKILL))


def interrupted(folder):
    ends_without_output(folder, lambda process: process.send_signal(signal.SIGINT))


CASES = [rows_do_not_depend_on_ranks, embeds_in_both_formats,
         edges_do_not_depend_on_ranks, prunes_as_on_one_rank, pairs_of_a_file,
         more_ranks_than_vertices, bad_input_is_told_once, cut_off_binary_graph, too_few_steps,
         killed_rank, interrupted]


def main():
    failures = 0
    for case in CASES:
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            try:
                case(Path(folder))
                said = "ok"
            except (AssertionError, subprocess.TimeoutExpired) as problem:
                failures += 1
                said = f"FAILED: {problem}"
        print(f"{case.__name__}: {said} ({time.monotonic() - began:.1f} s)", flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
