#!/usr/bin/env python3
"""Runs isotherm-mpi on growing graphs and numbers of ranks beside one machine's engine, and
prints tables of time, memory, work and what ranks sent.

usage: distributed.py BUILD [--graph NAME ...] [--ranks N ...] [--task NAME ...]

BUILD is a build folder with isotherm-mpi and engine_report (preset mpi with
-DISOTHERM_BUILD_BENCHMARKS=ON). Work, messages and bytes are those that PETSc's log counts; they
do not depend on what else the machine does, as times do.
"""

import argparse
import json
import os
import random
import re
import subprocess
import tempfile
import time
from pathlib import Path

SCALES = ["10", "1"]
TOLERANCE = "1e-4"
PAIRS = 1000
FAR, FINE = "1000", "1e-9"  # heat that gets further than a rank's share of a small graph
DIMENSIONS = "5"
TASKS = ["embed", "lobpcg", "heat", "far"]
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMP_NUM_THREADS": "1"}


def poses(count):
    """A path with a tenth as many loops, most of them between poses of about the same time."""
    chance = random.Random(1)
    for pose in range(count - 1):
        yield pose, pose + 1
    for _ in range(count // 10):
        pose = chance.randrange(count)
        yield pose, (pose + chance.randrange(2, 2000)) % count


def mesh(width):
    for vertex in range(width * width):
        if (vertex + 1) % width:
            yield vertex, vertex + 1
        if vertex + width < width * width:
            yield vertex, vertex + width


def triangles(width):
    """A mesh of triangles: three edges a vertex."""
    for vertex in range(width * width):
        right = (vertex + 1) % width != 0
        if right:
            yield vertex, vertex + 1
        if vertex + width < width * width:
            yield vertex, vertex + width
            if right:
                yield vertex, vertex + width + 1


GRAPHS = {
    "poses 10^5": lambda: poses(10**5),
    "poses 10^6": lambda: poses(10**6),
    "mesh 300 x 300": lambda: mesh(300),
    "mesh 1000 x 1000": lambda: mesh(1000),
    "triangles 3163 x 3163": lambda: triangles(3163),
}


def write_rows(path, edges):
    with open(path, "w") as file:
        for start, end in edges:
            file.write(f"{start} {end}\n")


def write_inputs(folder, name, pair_count):
    graph, pairs = folder / "graph", folder / "pairs"
    write_rows(graph, GRAPHS[name]())
    chance, kept = random.Random(2), []
    for number, edge in enumerate(GRAPHS[name]()):
        if number < pair_count:
            kept.append(edge)
        elif chance.randrange(number + 1) < pair_count:
            kept[chance.randrange(pair_count)] = edge
    write_rows(pairs, kept)
    return graph, pairs


def logged(text):
    """Work and messages of the rank that has most; products with the matrix, and what all ranks
    together send for one."""
    def most(name):
        found = re.search(rf"^{name}:\s+(\S+)", text, re.MULTILINE)
        return float(found.group(1)) if found else 0.0
    # Name, count, ratio, time, ratio, flop, ratio, then messages of all ranks and their mean length.
    products = re.findall(r"^Mat(?:Mat)?Mult(?:Num)?\s+(\d+)(?:\s+\S+){5}\s+(\S+)\s+(\S+)", text,
                          re.MULTILINE)
    count = sum(int(row[0]) for row in products)
    sent = sum(float(row[1]) * float(row[2]) for row in products)
    return {"flop": most("Flops"), "messages": most(r"MPI Msg Count"), "products": count,
            "bytes": sent / max(1, count), "reductions": most("MPI Reductions")}


def on_one_machine(build, task, graph, pairs):
    words = {"embed": ["embed", DIMENSIONS], "lobpcg": ["embed", DIMENSIONS],
             "heat": ["heat", pairs, TOLERANCE, *SCALES],
             "far": ["heat", pairs, FINE, FAR]}[task]
    done = subprocess.run([build / "benchmarks/engine_report", graph, *words],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def on_ranks(build, ranks, task, graph, pairs):
    heat = ["--pairs", pairs, "--tolerance", TOLERANCE, "--scales"]
    verb, words = {
        "embed": ("embed", ["--dimensions", DIMENSIONS]),
        "lobpcg": ("embed", ["--dimensions", DIMENSIONS, "--eigen-solver", "lobpcg"]),
        "heat": ("heat", [*heat, ",".join(SCALES)]),
        "far": ("heat", ["--pairs", pairs, "--tolerance", FINE, "--scales", FAR]),
    }[task]
    log = graph.parent / "log"
    began = time.monotonic()
    done = subprocess.run(
        ["mpirun", "-n", str(ranks), build / "apps/isotherm-mpi", verb, graph, *words, "-q",
         "-o", "/dev/null", "--json", "-"],
        capture_output=True, text=True,
        env={**os.environ, **ENVIRONMENT, "PETSC_OPTIONS": f"-log_view :{log}"})
    if done.returncode not in (0, 4):
        raise RuntimeError(done.stderr)
    result = json.loads(done.stdout)
    return {"all": time.monotonic() - began, **result, **logged(log.read_text())}


def row_of(name, ranks, result):
    return (f"| {name} | {ranks} | {result['seconds']:.1f} | {result['all']:.1f} "
            f"| {result['graph']['peak_megabytes_of_a_rank']} | {100 * result['graph']['cut']:.3f} "
            f"| {result['flop']:.2e} | {result['messages']:.0f} "
            f"| {result['reductions']:.0f} | {result['products']} "
            f"| {result['bytes'] / ranks:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=lambda text: Path(text).resolve())
    parser.add_argument("--graph", nargs="+", choices=GRAPHS, default=list(GRAPHS)[:4])
    parser.add_argument("--ranks", nargs="+", type=int, default=[1, 2])
    parser.add_argument("--task", nargs="+", choices=TASKS, default=TASKS)
    parser.add_argument("--pairs", type=int, default=PAIRS)
    parser.add_argument("--no-serial", action="store_true")
    arguments = parser.parse_args()
    print(f"load average {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores", flush=True)
    for task in arguments.task:
        print(f"\n### {task}\n\n| graph | ranks | seconds | with reading | MB a rank, most "
              "| edges cut % | flop a rank | messages a rank | reductions | products | "
              "bytes a product and rank |\n"
              "|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
        for name in arguments.graph:
            with tempfile.TemporaryDirectory() as scratch:
                graph, pairs = write_inputs(Path(scratch), name, arguments.pairs)
                if not arguments.no_serial:
                    one = on_one_machine(arguments.build, task, graph, pairs)
                    print(f"| {name} | one machine's engine | {one['seconds']:.1f} "
                          f"| {one['all']:.1f} | {one['megabytes']} | | | | | | |", flush=True)
                for ranks in arguments.ranks:
                    print(row_of(name, ranks, on_ranks(arguments.build, ranks, task, graph, pairs)),
                          flush=True)


if __name__ == "__main__":
    main()
