"""The package decides as the command does, to the last byte of the verdict files."""

import pytest
from conftest import SHIPPED, real_data
from isotherm import geometry, network, slam, spectral

METHODS = list(slam.prune_methods())
GRAPHS = {
    "intel": "posegraph2d/intel/intel.g2o",
    "mit": "posegraph2d/MIT/MIT.g2o",
    "csail": "posegraph2d/CSAIL/CSAIL.g2o",
    "ring": "posegraph2d/ring/originalDataset/ring.g2o",
    "ringCity": "posegraph2d/ringCity/originalDataset/ringCity.g2o",
    "bovisa04": "posegraph2d/bovisa04/Bovisa04_odometry_bow_tr.g2o",
    "city10000": "posegraph2d/city10000/city10000.g2o",
    "sphere2500": "posegraph3d/sphere2500/sphere2500.g2o",
    "parking-garage": "posegraph3d/parking-garage/parking-garage.g2o",
    "smallGrid3D": "posegraph3d/smallGrid3D/smallGrid3D.g2o",
    "tinyGrid3D": "posegraph3d/tinyGrid3D/tinyGrid3D.g2o",
    "torus3D": "posegraph3d/torus3D/torus3D.g2o.gz",
}


def assert_same_verdicts(run_command, folder, graph, method):
    """`graph` is a file."""
    by_command, by_package = folder / "command.csv", folder / "package.csv"
    arguments = ["--method", method] if method else []
    run_command("prune", graph, "--verdicts", by_command, "-q", *arguments)
    read = slam.read_pose_graph(graph)
    result = slam.prune(read, method) if method else slam.prune(read)
    result.verdicts.write(by_package)
    assert by_package.read_bytes() == by_command.read_bytes()
    return result


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("world", ["city", "sphere"])
def test_prune_simulated(run_command, tmp_path, request, world, method):
    graph = tmp_path / "graph.g2o"
    request.getfixturevalue(world)[0].write(graph)
    result = assert_same_verdicts(run_command, tmp_path, graph, method)
    run_command("prune", graph, "--method", method, "-q", "-o", tmp_path / "command.g2o")
    result.pruned().write(tmp_path / "package.g2o")
    assert (tmp_path / "package.g2o").read_bytes() == (tmp_path / "command.g2o").read_bytes()


@pytest.mark.parametrize("name", GRAPHS)
def test_prune_real(run_command, tmp_path, name):
    graph = real_data(GRAPHS[name])
    if graph is None:
        pytest.skip(f"no {GRAPHS[name]}; set ISOTHERM_DATA to the data folder")
    assert_same_verdicts(run_command, tmp_path, graph, None)


def test_prune_names_of_vertices(run_command, tmp_path):
    lettered = tmp_path / "lettered.g2o"
    base = ord("a") << 56
    lines = [f"EDGE_SE2 {base + k} {base + k + 1} 1 0 0 1 0 0 1 0 1" for k in range(9)]
    lines += [f"EDGE_SE2 {base + 1} {base + 7} 6 0 0 1 0 0 1 0 1"]
    lettered.write_text("\n".join(lines) + "\n")
    assert_same_verdicts(run_command, tmp_path, lettered, "chi2")
    assert "a1,a7" in (tmp_path / "package.csv").read_text()


def test_optimize(run_command, tmp_path, city):
    city[0].write(tmp_path / "graph.g2o")
    run_command("optimize", tmp_path / "graph.g2o", "--kernel", "sc", "-q", "-o", tmp_path / "command.g2o")
    slam.optimize(slam.read_pose_graph(tmp_path / "graph.g2o"), kernel="sc").graph.write(tmp_path / "package.g2o")
    assert (tmp_path / "package.g2o").read_bytes() == (tmp_path / "command.g2o").read_bytes()


@pytest.mark.parametrize("world", ["city", "ring", "sphere", "grid3d"])
def test_simulate(run_command, tmp_path, world):
    command, package = tmp_path / "command.g2o", tmp_path / "package.g2o"
    run_command("simulate", world, "--poses", 200, "--loops", 50, "--seed", 7, "-q", "-o", command)
    getattr(slam, f"simulate_{world}")(poses=200, loops=50, seed=7)[0].write(package)
    assert package.read_bytes() == command.read_bytes()


def test_corrupt_and_labels(run_command, tmp_path):
    clean, truth = slam.simulate_city(poses=200, loops=80, seed=7)
    clean.write(tmp_path / "clean.g2o")
    clean.with_poses(truth).write(tmp_path / "truth.g2o")
    run_command(
        "corrupt", tmp_path / "clean.g2o", "--ground-truth", tmp_path / "truth.g2o", "--count", 40,
        "--seed", 9, "-q", "-o", tmp_path / "command.g2o", "--labels", tmp_path / "command.csv",
    )  # fmt: skip
    graph, labels = slam.corrupt(clean, truth, count=40, seed=9)
    graph.write(tmp_path / "package.g2o")
    labels.write(tmp_path / "package.csv")
    assert (tmp_path / "package.g2o").read_bytes() == (tmp_path / "command.g2o").read_bytes()
    assert (tmp_path / "package.csv").read_bytes() == (tmp_path / "command.csv").read_bytes()


@pytest.mark.parametrize("method", ["heat", "heat-multiscale", "affinity", "resistance", "jaccard", "common-neighbours"])
def test_edges(run_command, tmp_path, cloud, method):
    spectral.write_edge_csv(tmp_path / "graph.csv", cloud)
    run_command(
        "edges", tmp_path / "graph.csv", "--method", method, "-q",
        "-o", tmp_path / "command-kept.csv", "--verdicts", tmp_path / "command.csv",
    )  # fmt: skip
    judged = spectral.judge_edges(spectral.read_graph(tmp_path / "graph.csv"), method=method)
    judged.verdicts.write(tmp_path / "package.csv")
    spectral.write_edge_csv(tmp_path / "package-kept.csv", judged.kept())
    for name in ["", "-kept"]:
        package = (tmp_path / f"package{name}.csv").read_bytes()
        assert package == (tmp_path / f"command{name}.csv").read_bytes()


def test_edges_of_points(run_command, tmp_path, cloud):
    rows = "".join(f"{float(x)!r},{float(y)!r}\n" for x, y in cloud.points)
    (tmp_path / "points.csv").write_text(rows)
    run_command(
        "edges", tmp_path / "points.csv", "--neighbours", 6, "--method", "rank", "-q",
        "--verdicts", tmp_path / "command.csv",
    )  # fmt: skip
    points, _ = geometry.read_points(tmp_path / "points.csv")
    graph = geometry.nearest_neighbour_graph(points, 6)
    spectral.judge_edges(graph, method="rank").verdicts.write(tmp_path / "package.csv")
    assert (tmp_path / "package.csv").read_bytes() == (tmp_path / "command.csv").read_bytes()


def test_localize(run_command, tmp_path, sensors):
    network.write_ranges(tmp_path / "ranges.csv", sensors[0])
    positions = sensors[0].positions[sensors[0].anchors]
    rows = [f"{name},{float(x)!r},{float(y)!r}\n" for name, (x, y) in enumerate(positions)]
    (tmp_path / "anchors.csv").write_text("node,x,y\n" + "".join(rows))
    run_command(
        "localize", tmp_path / "ranges.csv", "--anchors", tmp_path / "anchors.csv", "-q",
        "-o", tmp_path / "command-places.csv", "--verdicts", tmp_path / "command.csv",
    )  # fmt: skip
    read = network.read_ranges(tmp_path / "ranges.csv")
    found = network.localize(read.with_anchors(*network.read_positions(tmp_path / "anchors.csv")))
    found.verdicts.write(tmp_path / "package.csv")
    found.write(tmp_path / "package-places.csv")
    for name in ["", "-places"]:
        package = (tmp_path / f"package{name}.csv").read_bytes()
        assert package == (tmp_path / f"command{name}.csv").read_bytes()


def test_verdicts_and_labels_come_back_from_files(tmp_path, city):
    graph, labels, _ = city
    verdicts = slam.prune(graph, "chi2").verdicts
    verdicts.write(tmp_path / "verdicts.csv")
    labels.write(tmp_path / "labels.csv")
    found = slam.evaluate_loops(slam.read_verdicts(tmp_path / "verdicts.csv"), slam.read_labels(tmp_path / "labels.csv"))
    direct = slam.evaluate_loops(verdicts, labels)
    assert (found.tp, found.fp, found.fn, found.tn) == (direct.tp, direct.fp, direct.fn, direct.tn)


def test_there_are_twelve_real_graphs():
    assert len(GRAPHS) == 12
    assert SHIPPED.is_dir()
