"""Uses an installed package: prune, embed, localise, and the command."""

import subprocess
import sys
import tempfile
from pathlib import Path

import isotherm
from isotherm import geometry, network, slam, spectral


def prune() -> None:
    clean, truth = slam.simulate_sphere(poses=500, loops=200, seed=1)
    graph, labels = slam.corrupt(clean, truth, count=100, seed=1)
    result = slam.prune(graph)
    metrics = slam.evaluate_loops(result.verdicts, labels)
    assert metrics.f1 > 0.95, metrics.f1
    error = slam.absolute_trajectory_error(slam.optimize(result.pruned()).poses, truth).rmse
    print(f"prune: F1 {metrics.f1:.3f}, map {error:.3f} m from the truth")
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs, file = (Path(folder, name) for name in ("ours.csv", "theirs.csv", "graph.g2o"))
        graph.write(file)
        slam.prune(slam.read_pose_graph(file)).verdicts.write(ours)
        command = Path(sys.executable).parent / "isotherm"
        subprocess.run([command, "prune", file, "--verdicts", theirs, "-q"], check=True)
        assert ours.read_bytes() == theirs.read_bytes()
    assert "<html" in result.report()


def embed() -> None:
    grid = [(float(x), float(y)) for x in range(20) for y in range(20)]
    graph = geometry.radius_graph(grid, 1.1)
    found = spectral.embed(graph, dimensions=3)
    assert found.eigen.converged and found.coordinates.shape == (400, 3)
    print("embed:", found.eigen.values)


def localise() -> None:
    sensors, truth, _ = network.simulate_network(nodes=100, degree=16, seed=1)
    found = network.localize(sensors)
    errors = abs(found.positions - truth).max(axis=1)
    placed = errors == errors
    assert placed.mean() > 0.8 and sorted(errors[placed])[len(errors[placed]) // 2] < 0.05
    print(f"localise: {placed.sum()} of {len(placed)} nodes")


prune()
embed()
localise()
print("isotherm", isotherm.__version__, "in", Path(isotherm.__file__).parent)
