"""What the tests of the Python package have in common."""

import os
import subprocess
from pathlib import Path

import pytest
from isotherm import geometry, network, slam

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "tests/data"


def real_data(name):
    """A file of the real data, or None where there is none."""
    root = Path(os.environ.get("ISOTHERM_DATA", ROOT.parent / "shared/data"))
    path = root / name
    return path if path.exists() else None


@pytest.fixture(scope="session")
def run_command():
    """Runs the command with arguments; gives back what it wrote to standard output."""
    command = os.environ.get("ISOTHERM_COMMAND")
    if not command:
        pytest.skip("ISOTHERM_COMMAND names no command")

    def run(*arguments, code=0):
        done = subprocess.run([command, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == code, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def city():
    """A city of 400 poses with 150 true loops and 60 false ones: graph, labels and truth."""
    clean, truth = slam.simulate_city(poses=400, loops=150, seed=3)
    graph, labels = slam.corrupt(clean, truth, count=60, seed=3)
    return graph, labels, truth


@pytest.fixture(scope="session")
def sphere():
    """The same on a sphere, in space."""
    clean, truth = slam.simulate_sphere(poses=300, loops=120, seed=3)
    graph, labels = slam.corrupt(clean, truth, count=40, seed=3)
    return graph, labels, truth


@pytest.fixture(scope="session")
def cloud():
    """Points of a plane at random, joined to their neighbours."""
    import numpy

    points = numpy.random.default_rng(5).uniform(size=(300, 2))
    return geometry.nearest_neighbour_graph(points, 6)


@pytest.fixture(scope="session")
def sensors():
    """A network of 80 nodes with false ranges: network, true positions, origins."""
    return network.simulate_network(nodes=80, degree=16, false_fraction=0.1, seed=2)
