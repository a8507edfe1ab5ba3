"""What goes wrong comes as exceptions that say where."""

import pathlib
import re

import isotherm
import pytest
from conftest import SHIPPED
from isotherm import network, slam, spectral


def bad_pose_graphs():
    """Name, line and column of each shipped file that is no pose graph, by its message."""
    rows = (SHIPPED / "bad/expected.tsv").read_text(errors="replace").splitlines()[1:]
    for row in rows:
        name, flags, code, message = row.split("\t", 3)
        place = re.match(r"isotherm: [^:]+:(\d+)(?::(\d+))?: ", message)
        refused = code == "3" and not flags and "unknown format" not in message
        if name.endswith(".g2o") and refused and place:
            yield name, int(place[1]), int(place[2] or 0)


CASES = list(bad_pose_graphs())


def test_there_are_bad_files():
    assert len(CASES) > 20


@pytest.mark.parametrize("name, line, column", CASES, ids=[case[0] for case in CASES])
def test_a_bad_file_is_told_with_its_place(name, line, column):
    path = SHIPPED / "bad" / name
    with pytest.raises(isotherm.ParseError) as raised:
        slam.read_pose_graph(path)
    assert (raised.value.path, raised.value.line, raised.value.column) == (str(path), line, column)
    assert str(path) in str(raised.value)


@pytest.mark.parametrize("read", [slam.read_pose_graph, spectral.read_graph, network.read_ranges, slam.read_trajectory])
def test_a_file_that_is_not_there(read):
    with pytest.raises(isotherm.FileError, match="No such file") as raised:
        read("/nowhere/at/all")
    assert raised.value.path == "/nowhere/at/all"
    assert isinstance(raised.value, OSError)


def test_a_file_that_cannot_be_written(city):
    with pytest.raises(isotherm.FileError):
        city[0].write("/nowhere/at/all.g2o")


@pytest.mark.parametrize("path", [3, None, [1.5], 2.0])
def test_what_is_no_path(path):
    with pytest.raises(TypeError):
        slam.read_pose_graph(path)


@pytest.mark.parametrize("kind", [str, pathlib.Path, lambda path: str(path).encode()])
def test_paths_of_any_kind(kind, city, tmp_path):
    path = tmp_path / "grüße.g2o"
    city[0].write(kind(path))
    assert len(slam.read_pose_graph(kind(path))) == len(city[0])


def test_repairs_are_errors_where_strict(tmp_path):
    path = tmp_path / "wrapped.g2o"
    path.write_text("EDGE_SE2 0 1 1 0 7 1 0 0 1 0 1\n")
    assert slam.read_pose_graph(path).report["repairs"]
    with pytest.raises(isotherm.ParseError):
        slam.read_pose_graph(path, strict=True)


def test_errors_have_the_bases_that_python_expects():
    assert issubclass(isotherm.InvalidArgument, ValueError)
    assert issubclass(isotherm.ParseError, ValueError)
    assert issubclass(isotherm.FileError, OSError)
    assert issubclass(isotherm.NumericalError, ArithmeticError)
    for error in [isotherm.InvalidArgument, isotherm.ParseError, isotherm.FileError, isotherm.Cancelled]:
        assert issubclass(error, isotherm.Error)


def test_labels_of_other_edges_are_told(city):
    graph, labels, _ = city
    other = slam.prune(slam.simulate_city(poses=50, loops=20)[0], "chi2").verdicts
    with pytest.raises(isotherm.InvalidArgument):
        slam.evaluate_loops(other, labels)
