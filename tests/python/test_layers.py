"""What the functions give, against what is known of it otherwise."""

import numpy as np
import pytest
from isotherm import geometry, network, slam, spectral


def dense_laplacian(graph):
    matrix = np.zeros((len(graph), len(graph)))
    for (a, b), weight in zip(graph.edges, graph.weights, strict=True):
        matrix[[a, b], [b, a]] -= weight
        matrix[[a, b], [a, b]] += weight
    return matrix


@pytest.fixture(scope="module")
def small():
    points = np.random.default_rng(3).uniform(size=(40, 2))
    return geometry.nearest_neighbour_graph(points, 5)


def test_eigenpairs_are_those_of_numpy(small):
    found = spectral.eigenpairs(small, count=6)
    values = np.linalg.eigvalsh(dense_laplacian(small))[:6]
    assert np.allclose(found.values, values, atol=1e-10)
    assert found.converged and found.null_count == 1
    assert np.allclose(dense_laplacian(small) @ found.vectors, found.vectors * found.values, atol=1e-9)


def test_an_embedding_by_commute_time_is_isometric(small):
    found = spectral.embed(small, dimensions=39)
    rows = found.coordinates
    inverse = np.linalg.pinv(dense_laplacian(small))
    a, b = small.edges.T
    resistance = inverse[a, a] + inverse[b, b] - 2 * inverse[a, b]
    assert np.allclose(((rows[a] - rows[b]) ** 2).sum(axis=1), resistance)
    assert np.allclose(spectral.effective_resistances(small).values, resistance)
    assert np.allclose(spectral.effective_resistances(small, small.edges).values, resistance)
    assert found.components == 1 and found.eigen.converged


def test_heat_distances_are_those_of_the_exponential(small):
    pairs = np.array([[0, 1], [3, 17], [5, 5]])
    scales = [10.0, 1.0, 0.1]
    found = spectral.heat_distances(small, pairs, scales, tolerance=1e-8)
    values, vectors = np.linalg.eigh(dense_laplacian(small))
    for column, scale in enumerate(scales):
        heat = vectors @ np.diag(np.exp(-scale * values)) @ vectors.T
        a, b = pairs.T
        expected = heat[a, a] + heat[b, b] - 2 * heat[a, b]
        assert np.allclose(found.values[:, column], expected, atol=1e-8)
        assert np.all(found.lower[:, column] <= expected + 1e-12)
        assert np.all(expected <= found.upper[:, column] + 1e-12)
    assert found.converged


def test_components_are_counted_from_their_first_vertex():
    graph = spectral.Graph([[4, 1], [0, 3]], vertex_count=6)
    assert spectral.connected_components(graph).tolist() == [0, 1, 2, 0, 1, 3]


def test_scales_of_a_graph_descend(small):
    scales = spectral.automatic_scales(small)
    assert scales.shape == (7,)
    assert np.all(np.diff(scales) < 0)


def test_neighbours_are_those_of_all_distances():
    points = np.random.default_rng(6).normal(size=(60, 3))
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    nearest = np.argsort(distances, axis=1)[:, :4]
    expected = {tuple(sorted((k, int(n)))) for k in range(60) for n in nearest[k]}
    graph = geometry.nearest_neighbour_graph(points, 4)
    assert {tuple(edge) for edge in graph.edges.tolist()} == expected
    near = geometry.radius_graph(points, 0.8)
    assert len(near.edges) == np.count_nonzero(distances <= 0.8) // 2


def test_an_alignment_undoes_a_motion():
    rng = np.random.default_rng(7)
    points = rng.normal(size=(20, 3))
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    moved = points @ rotation.T + [1.0, 2.0, 3.0]
    found = geometry.align_points(points, moved)
    assert np.allclose(found.rotation, rotation)
    assert np.allclose(found.translation, [1, 2, 3])
    assert np.allclose(found.apply(points), moved)
    assert found.residual < 1e-20


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_curve_is_like_itself(dimension):
    angles = np.linspace(0, 4, 80)
    curve = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)[:, :dimension] * 20
    first, second = geometry.lap_lines(curve, [30, 40])
    rms, samples = first.disparity(second)
    assert rms < 1e-3 and samples > 5
    assert first.offsets.shape == (first.behind + 1 + first.ahead, dimension - 1)
    assert np.isclose(np.linalg.norm(first.direction), 1)
    assert first.reversed().behind == first.ahead


def test_edges_across_a_gap_are_judged_false():
    rng = np.random.default_rng(11)
    left = rng.uniform(size=(150, 2))
    points = np.concatenate([left, left + [10.0, 0.0]])
    near = geometry.nearest_neighbour_graph(points, 6)
    false = np.stack([rng.integers(0, 150, 8), rng.integers(150, 300, 8)], axis=1)
    graph = spectral.Graph(np.concatenate([near.edges, false]))
    verdicts = spectral.judge_edges(graph).verdicts
    assert verdicts.pruned[-8:].sum() >= 6
    assert verdicts.pruned[:-8].mean() < 0.05


def test_verdicts_agree_with_themselves(city):
    graph, labels, _ = city
    result = slam.prune(graph)
    verdicts = result.verdicts
    counts = verdicts.counts
    assert sum(counts.values()) == len(verdicts) == len(labels)
    assert counts["prune"] == verdicts.pruned.sum() == verdicts.verdict.count("prune")
    assert counts["keep"] == verdicts.kept.sum()
    assert counts["ambiguous"] == verdicts.ambiguous.sum()
    assert np.array_equal(graph.ids[graph.edges[verdicts.edge]], verdicts.ends)
    assert np.array_equal(verdicts.edge, graph.roles()[1])
    assert result.pruned(keep_ambiguous=True).edge_count == graph.edge_count - counts["prune"]
    assert result.graph is graph


@pytest.mark.parametrize("world", ["city", "sphere"])
def test_false_loops_are_found(request, world):
    graph, labels, truth = request.getfixturevalue(world)
    result = slam.prune(graph)
    metrics = slam.evaluate_loops(result.verdicts, labels)
    assert metrics.precision > 0.95 and metrics.recall > 0.95
    solved = slam.optimize(result.pruned())
    assert solved.converged and solved.status == "converged"
    ruined = slam.optimize(graph)
    error = slam.absolute_trajectory_error(solved.poses, truth).rmse
    assert error < 0.5 < slam.absolute_trajectory_error(ruined.poses, truth).rmse


def test_chi_squared_is_that_of_the_residuals(city):
    graph, _, _ = city
    solved = slam.optimize(graph)
    poses, edges, measured = solved.poses, graph.edges, graph.measurements

    def between(a, b):
        c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
        d = b[:, :2] - a[:, :2]
        return np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0], b[:, 2] - a[:, 2]], axis=1)

    error = between(measured, between(poses[edges[:, 0]], poses[edges[:, 1]]))
    angle = (error[:, 2] + np.pi) % (2 * np.pi) - np.pi
    half = angle / 2
    factor = half / np.tan(half)  # of the logarithm's translation
    residual = np.stack(
        [factor * error[:, 0] + half * error[:, 1], factor * error[:, 1] - half * error[:, 0], angle], axis=1
    )
    chi2 = np.einsum("ki,kij,kj->k", residual, graph.information, residual)
    assert np.allclose(solved.chi2, chi2, rtol=1e-6, atol=1e-9)
    assert np.isclose(solved.final_cost, chi2.sum())


def test_the_paper_is_a_set_of_keywords(city):
    keywords = slam.datta2016()
    assert keywords["method"] == "heat"
    assert set(keywords) - {"method"} == set(slam.prune_methods()["heat"])
    as_in_the_paper = slam.prune(city[0], **keywords)
    plain = slam.prune(city[0], "heat")
    assert as_in_the_paper.method == "heat"
    assert not np.array_equal(as_in_the_paper.verdicts.score, plain.verdicts.score)
    changed = slam.prune(city[0], **keywords | {"konst": [3.0]})
    assert changed.verdicts.counts["prune"] <= as_in_the_paper.verdicts.counts["prune"]


def test_trusted_edges_are_not_judged(city):
    graph, labels, _ = city
    trusted = np.concatenate([graph.roles()[0], labels.edge[:5]])
    verdicts = slam.prune(graph, trusted=trusted).verdicts
    assert len(verdicts) == graph.edge_count - len(trusted)
    assert not set(verdicts.edge.tolist()) & set(trusted.tolist())
    with pytest.raises(ValueError, match="names an edge that the graph does not have"):
        slam.prune(graph, trusted=[10**6])


def test_labels_go_by_the_truth(city):
    graph, labels, truth = city
    again = slam.label(graph, truth)
    wrong = [label == "incorrect" for label in labels.label]
    assert np.mean([(label == "incorrect") == w for label, w in zip(again.label, wrong, strict=True)]) > 0.95
    unknown = np.full_like(truth, np.nan)
    assert set(slam.label(graph, unknown).label) == {"ignore"}


def test_errors_of_trajectories(city):
    truth = city[2]
    shifted = truth + [3.0, 4.0, 0.0]
    assert slam.absolute_trajectory_error(shifted, truth, "none").rmse == pytest.approx(5)
    assert slam.absolute_trajectory_error(shifted, truth, "se").rmse == pytest.approx(0, abs=1e-9)
    assert slam.relative_pose_error(shifted, truth, delta=3).translation.max == pytest.approx(0, abs=1e-9)
    half = truth.copy()
    half[::2] = np.nan
    assert slam.absolute_trajectory_error(shifted, half, "none").pairs == len(truth) // 2


@pytest.mark.parametrize("format", ["tum", "kitti", "euroc", "planar"])
def test_trajectories_come_back_from_files(tmp_path, city, sphere, format):
    poses = city[2] if format == "planar" else sphere[2]
    times = np.arange(len(poses)) * 0.5
    slam.write_trajectory(tmp_path / "poses.txt", poses, times, format=format)
    again, stamps = slam.read_trajectory(tmp_path / "poses.txt")
    assert np.allclose(again[:, :2], poses[:, :2], atol=1e-6)
    assert stamps is None if format == "kitti" else np.allclose(stamps, times)


def test_ground_truth_by_time(tmp_path, city):
    graph, _, truth = city
    slam.write_trajectory(tmp_path / "truth.txt", truth[::2], np.arange(0, len(truth), 2.0), format="planar")
    (tmp_path / "times.txt").write_text("".join(f"{k}\n" for k in range(len(truth))))
    known = slam.read_ground_truth(graph, tmp_path / "truth.txt", tmp_path / "times.txt")
    assert np.allclose(known[::2], truth[::2])


def test_a_graph_is_densified(city):
    graph = slam.simulate_city(poses=100, loops=30, seed=1)[0]
    dense = slam.densify(graph, copies=1)
    assert graph.edge_count < dense.edge_count <= graph.edge_count + 60


def test_a_summary_counts(city):
    graph = city[0]
    summary = graph.summary()
    assert summary["vertices"] == len(graph) == 400
    assert summary["odometry"] + summary["candidates"] == graph.edge_count
    assert isinstance(graph.doubts(), list)


def test_swapped_ends_are_doubted(city):
    graph = city[0]
    odometry, loops = graph.roles()
    ends = graph.edges.copy()
    ends[odometry] = ends[odometry][:, ::-1]
    swapped = slam.PoseGraph(ends, graph.measurements, graph.information)
    assert "swapped ends" in {kind for kind, _ in swapped.doubts()}


def test_several_files_are_one_graph(tmp_path, city):
    graph = city[0]
    graph.write(tmp_path / "one.g2o")
    both = slam.read_pose_graph([tmp_path / "one.g2o", tmp_path / "one.g2o"])
    assert both.edge_count == graph.edge_count
    with pytest.raises(ValueError):
        slam.read_pose_graph([])


def test_nodes_are_found(sensors):
    sensed, truth, origins = sensors
    found = network.localize(sensed)
    places = found.positions
    placed = ~np.isnan(places).any(axis=1)
    assert placed.mean() > 0.8 and found.status == "converged" and found.anchored
    assert np.median(np.linalg.norm(places - truth, axis=1)[placed]) < 0.05
    assert [state == "anchor" for state in found.states] == [k in sensed.anchors for k in range(80)]
    assert found.covariances.shape == (80, 2, 2)
    assert np.all(found.covariances[sensed.anchors] == 0)
    false = origins == 2
    assert found.verdicts.pruned[false].mean() > 0.8 > found.verdicts.pruned[~false].mean()
    assert found.network is sensed


def test_a_network_from_arrays():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.4, 0.6]])
    edges = np.array([[a, b] for a in range(5) for b in range(a)])
    lengths = np.linalg.norm(square[edges[:, 0]] - square[edges[:, 1]], axis=1)
    made = network.Network(edges, lengths, np.full(10, 0.01), names=["a", "b", "c", "d", "e"])
    assert np.allclose(made.variances, 1e-4)
    anchored = made.with_anchors(["a", "b", "c", "d"], square[:4])
    assert anchored.anchors.tolist() == [0, 1, 2, 3] and len(made.anchors) == 0
    found = network.localize(anchored)
    assert np.allclose(found.positions, square, atol=1e-6)
    with pytest.raises(ValueError):
        network.Network([[0, 9]], [1.0], names=["a"])
    with pytest.raises(ValueError, match="sigmas"):
        network.Network([[0, 1]], [1.0], [-1.0])


def test_what_things_look_like(city, cloud, sensors):
    assert repr(city[0]) == "PoseGraph(2D, 400 poses, 609 edges)"
    assert repr(cloud).startswith("Graph(300 vertices, ")
    assert repr(sensors[0]).startswith("Network(80 nodes, ")
    assert repr(slam.prune(city[0], "chi2").verdicts).startswith("Verdicts(210, ")
