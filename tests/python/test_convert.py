"""From and to what other packages have."""

import numpy as np
import pytest
from isotherm import InvalidArgument, convert, slam, spectral


def canonical(graph):
    edges = np.sort(graph.edges, axis=1)
    order = np.lexsort([graph.weights, edges[:, 1], edges[:, 0]])
    return edges[order].tolist(), graph.weights[order].tolist()


@pytest.fixture(scope="module")
def weighted():
    rng = np.random.default_rng(12)
    edges = np.unique(np.sort(rng.integers(0, 30, size=(80, 2)), axis=1), axis=0)
    edges = edges[edges[:, 0] != edges[:, 1]]
    return spectral.Graph(edges, rng.uniform(0.5, 2, len(edges)), vertex_count=31)


def test_extras_are_called_as_messages_say(monkeypatch):
    import sys
    import tomllib

    from conftest import ROOT
    from isotherm import plot

    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    graph = spectral.Graph([[0, 1]], points=[[0.0, 0.0], [1.0, 1.0]])
    calls = {
        "scipy.sparse": lambda: convert.to_scipy(graph),
        "networkx": lambda: convert.to_networkx(graph),
        "gtsam": lambda: convert.to_gtsam(slam.PoseGraph([[0, 1]], [[1, 0, 0]])),
        "evo.core.trajectory": lambda: convert.to_evo([[0, 0, 0]]),
        "matplotlib.pyplot": lambda: plot.graph(graph),
        "pandas": graph.to_dataframe,
    }
    for module, call in calls.items():
        package = module.partition(".")[0]
        monkeypatch.setitem(sys.modules, module, None)
        with pytest.raises(ImportError, match=rf"pip install 'isotherm\[{package}\]'"):
            call()
        assert package in extras


class TestScipy:
    sparse = pytest.importorskip("scipy.sparse")

    def test_there_and_back(self, weighted):
        matrix = convert.to_scipy(weighted)
        assert (abs(matrix - matrix.T)).max() == 0
        assert canonical(convert.from_scipy(matrix)) == canonical(weighted)

    @pytest.mark.parametrize("form", ["csr", "csc", "coo", "lil", "dok", "bsr"])
    def test_every_format(self, weighted, form):
        matrix = convert.to_scipy(weighted).asformat(form)
        assert canonical(convert.from_scipy(matrix)) == canonical(weighted)

    def test_repeats_zeros_and_disorder(self):
        rows, columns = [0, 0, 1, 1, 1, 2], [1, 1, 0, 2, 0, 1]
        values = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]
        matrix = self.sparse.coo_array((values, (rows, columns)), shape=(3, 3))
        graph = convert.from_scipy(matrix)
        assert canonical(graph) == ([[0, 1]], [3.0])

    def test_the_diagonal_is_left_out(self):
        assert convert.from_scipy(self.sparse.eye_array(4).tocsr()).edge_count == 0

    def test_a_matrix_that_is_not_symmetric(self):
        with pytest.raises(InvalidArgument, match="not symmetric"):
            convert.from_scipy(self.sparse.csr_array(np.array([[0, 1.0], [2.0, 0]])))
        with pytest.raises(ValueError, match="as many rows as columns"):
            convert.from_scipy(self.sparse.csr_array((2, 3)))

    def test_the_matrix_is_left_as_it_is(self, weighted):
        matrix = convert.to_scipy(weighted)
        matrix.sort_indices()
        arrays = [matrix.data.copy(), matrix.indices.copy(), matrix.indptr.copy()]
        for array in [matrix.data, matrix.indices, matrix.indptr]:
            array.flags.writeable = False
        convert.from_scipy(matrix)
        for array, before in zip([matrix.data, matrix.indices, matrix.indptr], arrays, strict=True):
            assert np.array_equal(array, before)

    def test_a_million_edges_without_a_copy_of_the_matrix(self):
        tracemalloc = pytest.importorskip("tracemalloc")
        side = 710  # of a grid, with 2 side (side - 1) edges
        numbers = np.arange(side * side).reshape(side, side)
        across = np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()])
        down = np.stack([numbers[:-1].ravel(), numbers[1:].ravel()])
        ends = np.concatenate([across, down], axis=1)
        both = np.concatenate([ends, ends[::-1]], axis=1).astype(np.int32)
        matrix = self.sparse.coo_array((np.ones(both.shape[1]), both)).tocsr()
        assert matrix.indices.dtype == matrix.indptr.dtype == np.int32
        assert matrix.has_canonical_format
        tracemalloc.start()  # of what NumPy allocates; the graph itself is C++
        graph = convert.from_scipy(matrix)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert graph.edge_count == ends.shape[1] > 10**6
        assert peak < matrix.data.nbytes / 4  # a mask a entry, no array


class TestNetworkx:
    networkx = pytest.importorskip("networkx")

    def test_there_and_back(self, weighted):
        made = convert.to_networkx(weighted)
        again, nodes = convert.from_networkx(made)
        assert nodes == list(range(31))
        assert canonical(again) == canonical(weighted)

    def test_nodes_of_any_kind(self):
        graph = self.networkx.Graph([("a", "b", {"weight": 2.0}), ("b", (1, 2))])
        made, nodes = convert.from_networkx(graph)
        assert nodes == ["a", "b", (1, 2)]
        assert canonical(made) == ([[0, 1], [1, 2]], [2.0, 1.0])

    def test_parallel_edges(self):
        double = spectral.Graph([[0, 1], [1, 0]], [1.0, 2.0])
        made = convert.to_networkx(double)
        assert made.is_multigraph()
        assert canonical(convert.from_networkx(made)[0]) == canonical(double)

    def test_a_directed_graph(self):
        with pytest.raises(ValueError, match="is directed"):
            convert.from_networkx(self.networkx.DiGraph([(0, 1)]))

    def test_nothing(self):
        assert len(convert.from_networkx(self.networkx.Graph())[0]) == 0

    def test_components_are_those_of_networkx(self, weighted):
        ours = spectral.connected_components(weighted)
        theirs = list(self.networkx.connected_components(convert.to_networkx(weighted)))
        assert len(theirs) == ours.max() + 1
        for nodes in theirs:
            assert len({ours[node] for node in nodes}) == 1

    def test_a_pose_graph(self, city):
        graph = city[0]
        made = convert.to_networkx(graph)
        assert made.number_of_edges() == graph.edge_count
        first, second, data = next(iter(made.edges(data=True)))
        assert np.array_equal(data["measurement"], graph.measurements[data["edge"]])
        assert np.array_equal(made.nodes[first]["pose"], graph.poses[0])


class TestGtsam:
    gtsam = pytest.importorskip("gtsam")

    @pytest.mark.parametrize("world", ["city", "sphere"])
    def test_there_and_back(self, request, world):
        graph = request.getfixturevalue(world)[0]
        again = convert.from_gtsam(*convert.to_gtsam(graph)).pose_graph
        assert np.array_equal(again.edges, graph.edges)
        assert np.array_equal(again.ids, graph.ids)
        assert np.allclose(again.measurements[:, :2], graph.measurements[:, :2], atol=1e-12)
        turned = (again.measurements[:, 3:] * graph.measurements[:, 3:]).sum(axis=1)
        assert np.allclose(abs(turned), 1 if world == "sphere" else 0)  # either sign
        assert np.allclose(again.information, graph.information, rtol=1e-9, atol=1e-9)
        assert np.allclose(again.poses[:, :3], graph.poses[:, :3], atol=1e-12)

    @pytest.mark.parametrize("world", ["city", "sphere"])
    def test_the_cost_is_that_of_gtsam(self, request, world):
        graph = request.getfixturevalue(world)[0]
        solved = slam.optimize(graph, max_iterations=3)
        factors, values = convert.to_gtsam(solved.graph)
        assert factors.error(values) == pytest.approx(solved.chi2.sum() / 2, rel=1e-6)

    @pytest.mark.parametrize("world", ["city", "sphere"])
    def test_pruned_in_three_lines(self, request, world):
        poisoned, labels, _ = request.getfixturevalue(world)
        factors, values = convert.to_gtsam(poisoned)
        noise = self.gtsam.noiseModel.Isotropic.Sigma(3 if world == "city" else 6, 1.0)
        kind = "Pose2" if world == "city" else "Pose3"
        pose = getattr(values, f"at{kind}")(0)
        factors.add(getattr(self.gtsam, f"PriorFactor{kind}")(0, pose, noise))

        graph = convert.from_gtsam(factors, values)
        result = slam.prune(graph.pose_graph)
        pruned = graph.keep(result)

        assert pruned.size() == factors.size() - np.count_nonzero(~result.verdicts.kept)
        assert type(pruned.at(pruned.size() - 1)).__name__ == f"PriorFactor{kind}"
        optimum = self.gtsam.LevenbergMarquardtOptimizer(
            pruned, graph.values(slam.optimize(result.pruned()).poses)
        ).optimize()
        assert pruned.error(optimum) < 10 * graph.pose_graph.edge_count

    def test_keys_with_letters(self):
        noise = self.gtsam.noiseModel.Diagonal.Sigmas(np.array([0.1, 0.2, 0.3]))
        factors = self.gtsam.NonlinearFactorGraph()
        key = self.gtsam.symbol
        for letter in "ab":
            for k in range(3):
                step = self.gtsam.Pose2(1, 0, 0)
                factors.add(self.gtsam.BetweenFactorPose2(key(letter, k), key(letter, k + 1), step, noise))
        factors.add(self.gtsam.BetweenFactorPose2(key("a", 3), key("b", 0), self.gtsam.Pose2(), noise))
        graph = convert.from_gtsam(factors).pose_graph
        odometry, candidates = graph.roles()
        assert odometry.tolist() == [0, 1, 2, 3, 4, 5] and candidates.tolist() == [6]
        assert graph.poses is None
        assert np.allclose(graph.information[0], np.diag([100, 25, 100 / 9]))

    def test_a_robust_noise_model_counts_as_what_it_is_around(self):
        inner = self.gtsam.noiseModel.Gaussian.Information(np.diag([1.0, 2, 3, 4, 5, 6]))
        huber = self.gtsam.noiseModel.mEstimator.Huber.Create(1.0)
        robust = self.gtsam.noiseModel.Robust.Create(huber, inner)
        factors = self.gtsam.NonlinearFactorGraph()
        factors.add(self.gtsam.BetweenFactorPose3(0, 1, self.gtsam.Pose3(), robust))
        information = convert.from_gtsam(factors).pose_graph.information[0]
        assert np.allclose(information, np.diag([4, 5, 6, 1, 2, 3]))

    def test_no_poses(self):
        with pytest.raises(ValueError, match="expected factors between poses"):
            convert.from_gtsam(self.gtsam.NonlinearFactorGraph())


class TestEvo:
    trajectory = pytest.importorskip("evo.core.trajectory")

    def test_there_and_back(self, sphere):
        poses, times = sphere[2], np.arange(300) * 0.1
        path = convert.to_evo(poses, times)
        again, stamps = convert.from_evo(path)
        assert np.allclose(again, poses) and np.array_equal(stamps, times)
        assert convert.from_evo(convert.to_evo(poses))[1] is None

    def test_the_error_is_that_of_evo(self, city):
        metrics = pytest.importorskip("evo.core.metrics")
        graph, _, truth = city
        estimate, reference = convert.to_evo(graph.poses), convert.to_evo(truth)
        estimate.align(reference)
        ape = metrics.APE(metrics.PoseRelation.translation_part)
        ape.process_data((reference, estimate))
        ours = slam.absolute_trajectory_error(graph.poses, truth, "se")
        assert ape.get_statistic(metrics.StatisticsType.rmse) == pytest.approx(ours.rmse, rel=1e-6)

    def test_evo_reads_what_is_written(self, tmp_path, sphere):
        file_interface = pytest.importorskip("evo.tools.file_interface")
        times = np.arange(300) * 0.1
        slam.write_trajectory(tmp_path / "poses.tum", sphere[2], times)
        read = file_interface.read_tum_trajectory_file(str(tmp_path / "poses.tum"))
        poses, stamps = convert.from_evo(read)
        assert np.allclose(poses[:, :3], sphere[2][:, :3], atol=1e-9) and np.allclose(stamps, times)

    def test_other_columns(self):
        with pytest.raises(ValueError, match="poses: expected an array"):
            convert.to_evo(np.zeros((3, 4)))


class TestPandas:
    pandas = pytest.importorskip("pandas")

    def test_results_are_tables(self, city, cloud, sensors):
        from isotherm import network

        graph, labels, _ = city
        result = slam.prune(graph, "chi2")
        localized = network.localize(sensors[0])
        tables = {
            "graph": (graph.to_dataframe(), graph.edge_count),
            "verdicts": (result.to_dataframe(), len(result.verdicts)),
            "labels": (labels.to_dataframe(), len(labels)),
            "cloud": (cloud.to_dataframe(), cloud.edge_count),
            "edges": (spectral.judge_edges(cloud, method="jaccard").to_dataframe(), cloud.edge_count),
            "embedding": (spectral.embed(cloud).to_dataframe(), len(cloud)),
            "ranges": (sensors[0].to_dataframe(), len(sensors[0].ranges)),
            "nodes": (localized.to_dataframe(), len(sensors[0])),
        }
        for name, (table, rows) in tables.items():
            assert isinstance(table, self.pandas.DataFrame), name
            assert len(table) == rows, name

    @pytest.mark.parametrize("method", ["chi2", "consensus"])
    def test_a_table_says_what_the_file_says(self, tmp_path, city, method):
        verdicts = slam.prune(city[0], method).verdicts
        assert np.isfinite(verdicts.probability).all() == (method == "consensus")
        verdicts.write(tmp_path / "verdicts.csv")
        written = self.pandas.read_csv(tmp_path / "verdicts.csv")
        self.pandas.testing.assert_frame_equal(
            written, verdicts.to_dataframe(), check_dtype=False, check_exact=True
        )

    def test_a_graph_from_a_table(self, weighted):
        graph, nodes = convert.from_dataframe(weighted.to_dataframe())
        assert nodes.tolist() == sorted(set(weighted.edges.ravel().tolist()))
        assert np.array_equal(nodes[graph.edges], weighted.edges)
        assert np.array_equal(graph.weights, weighted.weights)

    def test_nodes_with_names(self):
        table = self.pandas.DataFrame({"a": ["x", "y"], "b": ["y", "z"]})
        graph, nodes = convert.from_dataframe(table, "a", "b")
        assert nodes.tolist() == ["x", "y", "z"]
        assert graph.weights.tolist() == [1.0, 1.0]

    def test_a_missing_package_is_told(self, monkeypatch, city):
        import sys

        monkeypatch.setitem(sys.modules, "pandas", None)
        with pytest.raises(ImportError, match=r"to_dataframe\(\) needs pandas: pip install 'isotherm\[pandas\]'"):
            city[0].to_dataframe()
        monkeypatch.setitem(sys.modules, "networkx", None)
        with pytest.raises(ImportError, match=r"to_networkx\(\) needs networkx"):
            convert.to_networkx(city[0])
