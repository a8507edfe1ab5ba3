#!/usr/bin/env python3
"""Compares the spectral engine with SciPy and NumPy, all in one run, and writes
docs/results/spectral.md.

usage: scripts/build.sh bench && $(scripts/python-env.sh) benchmarks/spectral.py [DATA] [BEFORE]

DATA is the folder of data sets (default $ISOTHERM_DATA or ../shared/data). BEFORE is an
`isotherm` command of an earlier version: only the eigenpairs are measured then, beside its own,
and printed.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

ROOT = pathlib.Path(__file__).resolve().parent.parent
REPORT = ROOT / "build/bench/benchmarks/spectral_report"
PAGE = ROOT / "docs/results/spectral.md"
DATA = pathlib.Path(
    sys.argv[1] if len(sys.argv) > 1 else os.environ.get("ISOTHERM_DATA", ROOT / "../shared/data"))


def report(graph, *options):
    """Timings of the engine, its Laplacian and its heat distances."""
    with tempfile.TemporaryDirectory() as folder:
        prefix = os.path.join(folder, "dump")
        text = subprocess.run([REPORT, graph, "--dump", prefix, *options], check=True,
                              capture_output=True, text=True).stdout
        result = json.loads(text)
        edges = np.loadtxt(prefix + ".edges.csv", delimiter=",")
        heat = np.loadtxt(prefix + ".heat.csv", delimiter=",", ndmin=2)
    n = result["vertices"]
    rows, columns = edges[:, 0].astype(int), edges[:, 1].astype(int)
    weights = sparse.coo_matrix((edges[:, 2], (rows, columns)), (n, n))
    weights = (weights + weights.T).tocsc()
    weights.setdiag(0)
    laplacian = sparse.diags(np.asarray(weights.sum(0)).ravel()) - weights
    return result, laplacian.tocsc(), heat[:, :2].astype(int), heat[:, 2:]


def timed(run):
    start = time.perf_counter()
    value = run()
    return time.perf_counter() - start, value


def distances(values, vectors, pairs, scales):
    squared = (vectors[pairs[:, 0]] - vectors[pairs[:, 1]]) ** 2
    return np.array([squared @ np.exp(-t * values) for t in scales]).T


def eigsh(laplacian, count):
    norm = 2 * laplacian.diagonal().max()
    return linalg.eigsh(laplacian, k=count, sigma=-1e-6 * norm, which="LM")


def row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def by_scale(values):
    return ", ".join(f"{value:.1e}" for value in values)


def truncated_spectrum(lines, name, path, tolerance="1e-6"):
    result, laplacian, pairs, ours = report(path, "--tolerance", tolerance)
    scales = result["scales"]
    seconds, (values, vectors) = timed(lambda: eigsh(laplacian, 300))
    start = time.perf_counter()
    truncated = distances(values, vectors, pairs, scales)
    seconds += time.perf_counter() - start
    sample = pairs[:: max(1, len(pairs) // 5)][:5]
    rhs = np.zeros((laplacian.shape[0], len(sample)))
    for k, (i, j) in enumerate(sample):
        rhs[i, k], rhs[j, k] = 1.0, -1.0
    multiply, products = timed(lambda: [linalg.expm_multiply(-t * laplacian, rhs) for t in scales])
    multiply *= len(pairs) / len(sample)
    exact = np.array([[(rhs[:, k] * product[:, k]).sum() for product in products]
                      for k in range(len(sample))])
    chosen = {tuple(p): k for k, p in enumerate(map(tuple, pairs))}
    own = np.array([ours[chosen[tuple(p)]] for p in sample])
    heat = result["heat"]["seconds"]
    lines += [
        f"\n### {name}: {result['vertices']} vertices, {result['loops']} loops, tolerance {tolerance}\n",
        row("program", "seconds", "times ours", "largest error at each scale"),
        row("---", "---", "---", "---"),
        row("isotherm", f"{heat:.3f}", "1", f"certified: brackets at most "
            f"{result['heat']['widest_bracket']:.1e} wide"),
        row("SciPy eigsh, shift-invert, k = 300, truncated", f"{seconds:.2f}",
            f"**{seconds / heat:.0f}**", by_scale(np.abs(truncated - ours).max(0))),
        row(f"SciPy expm_multiply ({len(sample)} loops, scaled to all)", f"{multiply:.1f}",
            f"{multiply / heat:.0f}", "differs from ours by " + by_scale(np.abs(own - exact).max(0))),
    ]


def dense_oracle(lines, name, path):
    result, laplacian, pairs, ours = report(path, "--tolerance", "1e-8")
    seconds, (values, vectors) = timed(lambda: np.linalg.eigh(laplacian.toarray()))
    error = np.abs(distances(values, vectors, pairs, result["scales"]) - ours).max(0)
    heat = result["heat"]["seconds"]
    lines.append(row(name, result["vertices"], result["loops"], f"{heat:.3f}", f"{seconds:.2f}",
                     f"{seconds / heat:.0f}", by_scale(error)))


def embed(isotherm, laplacian, count):
    """What a command says about the eigenpairs it found; the best of three runs."""
    upper = sparse.triu(-laplacian, 1).tocoo()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "graph.csv")
        np.savetxt(path, np.c_[upper.row, upper.col, upper.data], delimiter=",",
                   fmt=["%d", "%d", "%.17g"])
        runs = [json.loads(subprocess.run(
            [isotherm, "embed", path, "-o", os.devnull, "--dimensions", str(count - 1), "-q",
             "--json", "-"], check=True, capture_output=True, text=True).stdout)
            for _ in range(3)]
    return min(runs, key=lambda run: run["seconds"])


def eigenpairs(path, count, before):
    result, laplacian, _, _ = report(path, "--eigenpairs", str(count), "--repeat", "2")
    eigen = result["eigen"]
    norm = 2 * laplacian.diagonal().max()
    lines = [
        row("program", "seconds", "largest residual / norm", "orthogonality", "inertia count"),
        row(*["---"] * 5),
        row("isotherm (Spectra)", f"{eigen['seconds']:.2f}", f"{eigen['largest_residual_over_norm']:.1e}",
            f"{eigen['orthogonality']:.1e}", f"{eigen['inertia_count']} below the last")]
    if before:
        old = embed(before, laplacian, count)
        lines.append(row("isotherm before", f"{old['seconds']:.2f}",
                         f"{old['largest_residual'] / norm:.1e}", f"{old['orthogonality']:.1e}",
                         "checked"))
    seconds, (values, vectors) = min(
        (timed(lambda: eigsh(laplacian, count)) for _ in range(2)), key=lambda pair: pair[0])
    residual = np.linalg.norm(laplacian @ vectors - vectors * values, axis=0).max()
    lines.append(row("SciPy eigsh", f"{seconds:.2f}", f"{residual / norm:.1e}",
                     f"{np.abs(vectors.T @ vectors - np.eye(count)).max():.1e}", "not checked"))
    return lines


def main():
    b25b = DATA / "paper/b25b/B25b_0.000.g2o"
    city = DATA / "posegraph2d/city10000/city10000.g2o"
    if len(sys.argv) > 2:
        print("\n".join(eigenpairs(city, 100, sys.argv[2])))
        return
    lines = [
        "# Spectral engine\n",
        "Written by `benchmarks/spectral.py`:\n",
        "    scripts/build.sh bench",
        "    $(scripts/python-env.sh) benchmarks/spectral.py\n",
        f"on {os.cpu_count()} shared cores (load average {os.getloadavg()[0]:.1f} at the start); "
        "wall-clock seconds, the best",
        f"of a few runs for ours. NumPy {np.__version__} and SciPy {scipy.__version__} on their "
        "default threads: under load these",
        "wait for each other and suffer more than a single program does. Graphs are induced",
        "(odometry 1, loops 1 / (1 + chi2 / dof)); scales are 100, 70, 10, 5, 1, 0.1, 0.001.",
        "Reading files is not counted for anyone. A truncated spectrum loses what lies above its",
        "last eigenvalue, which at small scales is nearly all of the distance.\n",
        "## Heat distances",
    ]
    truncated_spectrum(lines, "Bicocca B25b_0.000", b25b)
    truncated_spectrum(lines, "city10000", city)
    lines += ["\n### Against a dense eigendecomposition (NumPy eigh), tolerance 1e-8\n",
              row("graph", "vertices", "loops", "isotherm s", "dense s", "times ours",
                  "largest difference at each scale"),
              row(*["---"] * 7)]
    dense_oracle(lines, "intel", DATA / "posegraph2d/intel/intel.g2o")
    dense_oracle(lines, "kitti_06", DATA / "paper/kitti/kitti_06.g2o")

    lines += ["\n## Growth: simulated cities with a tenth as many loops as poses, tolerance 1e-4\n",
              row("poses", "loops", "heat, 7 scales s", "one thread s", "same bytes",
                  "all edge resistances s", "CHOLMOD analysis + factorisation s", "ratio",
                  "peak memory MB"), row(*["---"] * 9)]
    measured = []
    for poses in (10_000, 100_000, 1_000_000):
        result, *_ = report(f"city:{poses}:{poses // 10}", "--tolerance", "1e-4", "--repeat", "2")
        heat, resistance = result["heat"], result["resistance"]
        cholmod = resistance["cholmod_analyse_seconds"] + resistance["cholmod_factorise_seconds"]
        measured.append((poses, heat["processor_seconds"], resistance["processor_seconds"]))
        lines.append(row(poses, result["loops"], f"{heat['seconds']:.3f}",
                         f"{heat['seconds_one_thread']:.3f}",
                         "yes" if heat["same_bytes_for_any_thread_count"] else "NO",
                         f"{resistance['seconds']:.3f}",
                         f"{resistance['cholmod_analyse_seconds']:.3f} + "
                         f"{resistance['cholmod_factorise_seconds']:.3f}",
                         f"{resistance['seconds'] / cholmod:.1f}", result["peak_memory_mb"]))
    span = math.log(measured[-1][0] / measured[0][0])
    lines.append(
        f"\nFrom 10^4 to 10^6 poses processor time grows with exponent "
        f"{math.log(measured[-1][1] / measured[0][1]) / span:.2f} (heat distances) and "
        f"{math.log(measured[-1][2] / measured[0][2]) / span:.2f} (resistances).\n")

    result, *_ = report(city)
    resistance = result["resistance"]
    cholmod = resistance["cholmod_analyse_seconds"] + resistance["cholmod_factorise_seconds"]
    lines += [
        "## Effective resistances of city10000\n",
        f"All {result['edges']} edges in {resistance['seconds']:.3f} s, "
        f"{resistance['seconds'] / cholmod:.1f} times CHOLMOD's analysis and factorisation in the "
        f"same run;\nFoster's theorem holds to {abs(resistance['foster_relative_error']):.0e}.\n",
        "## 100 smallest eigenpairs of city10000\n",
        *eigenpairs(city, 100, None)]
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text("\n".join(lines) + "\n")
    print(PAGE.read_text())


if __name__ == "__main__":
    main()
