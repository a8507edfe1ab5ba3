"""What goes in and comes out as arrays: shapes, types, strides, memory."""

import gc

import numpy as np
import pytest
from isotherm import InvalidArgument, geometry, network, slam, spectral

TRIANGLE = [[0, 1], [1, 2], [2, 0]]
STEPS = [[1.0, 0.0, 0.1], [1.0, 0.0, 0.1], [1.0, 0.0, 0.1]]


@pytest.mark.parametrize("dtype", ["int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"])
def test_integers_of_any_width_are_edges(dtype):
    graph = spectral.Graph(np.array(TRIANGLE, dtype=dtype))
    assert graph.edges.tolist() == TRIANGLE
    assert graph.edges.dtype == np.int32


@pytest.mark.parametrize("dtype", ["float32", "float64", "float16", "int32", "uint8"])
def test_numbers_of_any_kind_are_weights(dtype):
    graph = spectral.Graph(TRIANGLE, np.array([1, 2, 4], dtype=dtype))
    assert graph.weights.tolist() == [1.0, 2.0, 4.0]
    assert graph.weights.dtype == np.float64


@pytest.mark.parametrize("dtype", ["float64", "bool", "complex128", "object", "str"])
def test_what_is_no_integer_is_no_edge(dtype):
    with pytest.raises(TypeError, match="edges: expected integers, got an array of"):
        spectral.Graph(np.array(TRIANGLE).astype(dtype))


@pytest.mark.parametrize("dtype", ["bool", "complex128", "object", "str", "datetime64[s]"])
def test_what_is_no_number_is_no_weight(dtype):
    with pytest.raises(TypeError, match="weights: expected numbers, got an array of"):
        spectral.Graph(TRIANGLE, np.array([1, 2, 3]).astype(dtype))


@pytest.mark.parametrize("edges", [[0, 1], [[0, 1, 2]], [[[0, 1]]], 3])
def test_edges_have_two_columns(edges):
    with pytest.raises(ValueError, match=r"edges: expected an array of shape \(n, 2\), got"):
        spectral.Graph(edges)


@pytest.mark.parametrize("measured", [[[1.0, 2.0]], [[1.0] * 6], [[1.0] * 8]])
def test_poses_have_three_or_seven_columns(measured):
    with pytest.raises(ValueError, match="measurements: expected 3 columns .* or 7 .*, got"):
        slam.PoseGraph([[0, 1]], measured)


@pytest.mark.parametrize(
    "shape", [(3, 3), (2, 3, 3), (3, 6, 6), (3, 3, 2)], ids=["one matrix", "too few", "space", "oblong"]
)
def test_information_has_a_matrix_an_edge(shape):
    with pytest.raises(ValueError, match="information: expected"):
        slam.PoseGraph(TRIANGLE, STEPS, np.ones(shape))


def test_lengths_must_match():
    with pytest.raises(ValueError, match="weights: expected 3 rows, got 2"):
        spectral.Graph(TRIANGLE, [1.0, 2.0])
    with pytest.raises(ValueError, match="measurements: expected 3 rows, got 2"):
        slam.PoseGraph(TRIANGLE, STEPS[:2])
    with pytest.raises(ValueError, match="ranges: expected 3 rows, got 1"):
        network.Network(TRIANGLE, [1.0])
    with pytest.raises(ValueError, match="points: expected 3 rows, got 2"):
        spectral.Graph(TRIANGLE, points=[[0.0, 0.0], [1.0, 1.0]])


def test_numbers_that_do_not_fit_are_not_wrapped():
    with pytest.raises(ValueError, match="edges: a number does not fit into int32"):
        spectral.Graph([[0, 2**31]])
    with pytest.raises(ValueError, match="ids: a number does not fit into uint64"):
        slam.PoseGraph([[0, 1]], [[1, 0, 0]], ids=[-1, 4])


@pytest.mark.parametrize("edges", [[[-1, 0]], [[0, 7]]])
def test_ends_must_be_vertices(edges):
    with pytest.raises(InvalidArgument):
        spectral.Graph(edges, vertex_count=3)
    with pytest.raises(InvalidArgument):
        slam.PoseGraph(edges, [[1, 0, 0]], ids=[0, 1, 2])


@pytest.mark.parametrize("weight", [0.0, -1.0, float("nan"), float("inf")])
def test_weights_must_be_positive(weight):
    with pytest.raises(InvalidArgument, match="weight"):
        spectral.Graph([[0, 1]], [weight])


LAYOUTS = {
    "column-major": np.asfortranarray,
    "every other row": lambda a: np.repeat(a, 2, axis=0)[::2],
    "backwards": lambda a: a[::-1].copy()[::-1],
    "transposed": lambda a: a.T.copy().T,
    "a part": lambda a: np.pad(a, 1)[1:-1, 1:-1],
    "read-only": lambda a: np.frombuffer(a.tobytes(), dtype=a.dtype).reshape(a.shape),
    "other byte order": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "a list": lambda a: a.tolist(),
    "a subclass": lambda a: a.view(np.matrix),
}


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_any_layout_says_the_same(layout):
    rng = np.random.default_rng(1)
    edges = rng.integers(0, 20, size=(30, 2))
    measured = rng.normal(size=(30, 3))
    plain = slam.PoseGraph(edges, measured)
    other = slam.PoseGraph(layout(edges), layout(measured))
    assert np.array_equal(plain.edges, other.edges)
    assert np.array_equal(plain.measurements, other.measurements)


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_points_of_any_layout_have_the_same_neighbours(layout):
    points = np.random.default_rng(2).normal(size=(40, 3))
    plain = geometry.nearest_neighbour_graph(points, 4)
    other = geometry.nearest_neighbour_graph(layout(points), 4)
    assert np.array_equal(plain.edges, other.edges)
    assert np.array_equal(other.points, points)


def views(city, cloud, sensors):
    graph = city[0]
    pruned = slam.prune(graph, "chi2")
    solved = slam.optimize(graph)
    return {
        "ids": graph.ids,
        "poses": graph.poses,
        "edges": graph.edges,
        "measurements": graph.measurements,
        "information": graph.information,
        "weights": cloud.weights,
        "points": cloud.points,
        "scores": pruned.verdicts.score,
        "ends": pruned.verdicts.ends,
        "chi2": solved.chi2,
        "ranges": sensors[0].ranges,
        "positions": sensors[0].positions,
    }


def test_views_cannot_be_written(city, cloud, sensors):
    for name, array in views(city, cloud, sensors).items():
        assert not array.flags.writeable, name
        with pytest.raises(ValueError):
            array[:] = 0


def test_views_are_the_same_memory_each_time(city, cloud, sensors):
    for graph, names in [
        (city[0], ["ids", "poses", "edges", "measurements", "information"]),
        (slam.simulate_sphere(poses=60)[0], ["poses", "measurements", "information"]),
        (cloud, ["edges", "weights", "points", "ids"]),
        (sensors[0], ["edges", "ranges", "positions"]),
    ]:
        for name in names:
            assert np.shares_memory(getattr(graph, name), getattr(graph, name)), name


def test_views_keep_what_they_show_alive():
    edges = spectral.Graph(TRIANGLE, [1.0, 2.0, 3.0]).edges
    scores = slam.prune(slam.simulate_city(poses=60, loops=30)[0], "chi2").verdicts.score
    before = scores.copy()
    gc.collect()
    np.ones(10**6).sum()
    assert edges.tolist() == TRIANGLE
    assert np.array_equal(scores, before)


def test_what_is_given_is_not_kept():
    edges = np.array(TRIANGLE, dtype=np.int32)
    graph = spectral.Graph(edges)
    edges[:] = 0
    assert graph.edges.tolist() == TRIANGLE


@pytest.mark.parametrize("nothing", [[], np.zeros((0, 2), dtype=int), np.zeros((0, 2)), ()])
def test_nothing_is_a_graph(nothing):
    graph = spectral.Graph(nothing)
    assert len(graph) == 0
    assert graph.edges.shape == (0, 2)
    assert graph.weights.shape == (0,)


@pytest.mark.parametrize("columns", [3, 7])
def test_nothing_is_a_pose_graph(columns):
    graph = slam.PoseGraph([], np.zeros((0, columns)))
    degrees = 3 if columns == 3 else 6
    assert graph.dimension == (2 if columns == 3 else 3)
    assert graph.measurements.shape == (0, columns)
    assert graph.information.shape == (0, degrees, degrees)
    assert len(slam.prune(graph).verdicts) == 0
    assert slam.optimize(graph).poses.shape == (0, columns)


def test_nothing_is_a_cloud_and_a_network():
    assert len(geometry.nearest_neighbour_graph(np.zeros((0, 2)), 3)) == 0
    assert len(network.Network([], [])) == 0


def test_a_pose_graph_gives_back_what_made_it():
    rng = np.random.default_rng(8)
    poses = rng.normal(size=(6, 3))
    edges = [[k, k + 1] for k in range(5)] + [[0, 5]]
    measured = rng.normal(size=(6, 3))
    roots = rng.normal(size=(6, 3, 3))
    information = roots @ roots.transpose(0, 2, 1)
    information = (information + information.transpose(0, 2, 1)) / 2
    graph = slam.PoseGraph(edges, measured, information, poses=poses, ids=[2, 3, 5, 7, 11, 13], fixed=[1])
    assert np.array_equal(graph.poses, poses)
    assert np.array_equal(graph.measurements, measured)
    assert np.array_equal(graph.information, information)
    assert graph.ids.tolist() == [2, 3, 5, 7, 11, 13]
    assert graph.fixed.tolist() == [1]
    assert np.array_equal(graph.with_poses(poses + 1).poses, poses + 1)
    assert graph.with_poses(None).poses is None


def test_a_pose_graph_in_space_gives_back_what_made_it():
    rng = np.random.default_rng(9)
    rows = rng.normal(size=(5, 7))
    rows[:, 3:] /= np.linalg.norm(rows[:, 3:], axis=1, keepdims=True)
    graph = slam.PoseGraph([[k, k + 1] for k in range(4)], rows[:4], poses=rows)
    assert np.allclose(graph.poses, rows, atol=1e-15)
    assert np.allclose(graph.measurements, rows[:4], atol=1e-15)
    assert np.array_equal(graph.information, np.broadcast_to(np.eye(6), (4, 6, 6)))


def test_a_quaternion_has_unit_norm():
    with pytest.raises(ValueError, match="a quaternion .* is not of unit norm"):
        slam.PoseGraph([[0, 1]], [[0, 0, 0, 0, 0, 0, 2.0]])


@pytest.mark.parametrize("ids", [[1, 0, 2], [0, 0, 1]])
def test_ids_ascend(ids):
    with pytest.raises(InvalidArgument, match="must ascend"):
        slam.PoseGraph(TRIANGLE, STEPS, ids=ids)


def test_information_is_symmetric_and_finite():
    lopsided = np.tile(np.eye(3), (3, 1, 1))
    lopsided[1, 0, 2] = 5.0
    with pytest.raises(InvalidArgument, match="of edge 1 is not symmetric"):
        slam.PoseGraph(TRIANGLE, STEPS, lopsided)
    lopsided[1, 0, 2] = float("nan")
    with pytest.raises(InvalidArgument, match="of edge 1 is not finite"):
        slam.PoseGraph(TRIANGLE, STEPS, lopsided)


def test_a_matrix_in_rows_is_read_where_it_is():
    scipy = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(4)
    upper = scipy.random_array((50, 50), density=0.1, rng=rng).tocoo()
    upper = scipy.triu(upper, k=1)
    matrix = scipy.csr_array(upper + upper.T)
    matrix.sort_indices()
    graph = spectral.Graph.from_csr(matrix.indptr, matrix.indices, matrix.data)
    dense = np.zeros((50, 50))
    dense[graph.edges[:, 0], graph.edges[:, 1]] = graph.weights
    assert np.array_equal(dense + dense.T, matrix.toarray())
    wide = spectral.Graph.from_csr(matrix.indptr.astype(np.int64), matrix.indices, matrix.data)
    assert np.array_equal(wide.edges, graph.edges)


@pytest.mark.parametrize(
    "indptr, indices, data, match",
    [
        ([0, 1, 1], [1], [1.0], "not symmetric"),
        ([0, 1, 2], [1, 0], [1.0, 2.0], "not symmetric"),
        ([0, 0, 1], [0], [1.0], "not symmetric"),
        ([0, 1, 2], [5, 0], [1.0, 1.0], "outside"),
        ([0, 1, 2], [-1, 0], [1.0, 1.0], "outside"),
        ([0, 5, 2], [1, 0], [1.0, 1.0], "must ascend"),
        ([1, 1, 2], [1, 0], [1.0, 1.0], "must ascend"),
        ([], [], [], "must ascend"),
    ],
)
def test_a_matrix_must_be_sound(indptr, indices, data, match):
    with pytest.raises(InvalidArgument, match=match):
        spectral.Graph.from_csr(indptr, indices, data)


def test_a_laplacian_is_given_without_a_copy():
    data, indices, indptr = spectral.laplacian(spectral.Graph(TRIANGLE, [1.0, 2.0, 3.0]))
    scipy = pytest.importorskip("scipy.sparse")
    matrix = scipy.csr_array((data, indices, indptr), shape=(3, 3))
    assert np.shares_memory(matrix.data, data)
    assert matrix.toarray().tolist() == [[4, -1, -3], [-1, 3, -2], [-3, -2, 5]]
