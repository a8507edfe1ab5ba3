"""Figures, and the pages that notebooks show."""

import html
import json
import re

import numpy as np
import pytest
from isotherm import network, slam, spectral

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
from isotherm import plot  # noqa: E402
from matplotlib import pyplot  # noqa: E402


@pytest.fixture(autouse=True)
def close():
    yield
    pyplot.close("all")


def drawn(axes):
    axes.figure.canvas.draw()
    return {text.get_text() for text in axes.get_legend().get_texts()}


@pytest.mark.parametrize("world", ["city", "sphere"])
def test_a_map_is_coloured_by_verdict(request, world):
    graph = request.getfixturevalue(world)[0]
    result = slam.prune(graph)
    counts = result.verdicts.counts
    labels = drawn(plot.pose_graph(graph, result.verdicts))
    for name in ("keep", "prune"):
        assert f"{name} ({counts[name]})" in labels
    assert plot.pose_graph(graph).get_legend() is None


@pytest.mark.parametrize("world", ["city", "sphere"])
def test_before_and_after(request, world):
    result = slam.prune(request.getfixturevalue(world)[0])
    figure = plot.before_and_after(result, slam.optimize(result.pruned()))
    assert [axes.get_title() for axes in figure.axes] == ["before", "after"]


def test_lines_join_the_ends_of_edges(city):
    graph = city[0]
    axes = plot.pose_graph(graph)
    odometry, _ = graph.roles()
    x, y = axes.lines[0].get_data()
    ends = graph.poses[graph.edges[odometry], :2]
    assert np.array_equal(np.stack([x, y], axis=1).reshape(-1, 3, 2)[:, :2], ends)


def test_scores_are_split_at_the_threshold(city):
    for method in ("chi2", "consensus"):
        verdicts = slam.prune(city[0], method).verdicts
        axes = plot.scores(verdicts)
        for container, shown in ((0, verdicts.kept), (2, verdicts.pruned)):
            heights = sum(patch.get_height() for patch in axes.containers[container].patches)
            assert heights == shown.sum(), method
        assert drawn(axes)


def test_reasons_count_every_edge(city):
    verdicts = slam.prune(city[0]).verdicts
    axes = plot.reasons(verdicts, most=100)
    widths = sum(patch.get_width() for container in axes.containers for patch in container.patches)
    assert widths == len(verdicts)


def test_a_spectrum(cloud):
    eigen = spectral.eigenpairs(cloud, count=8)
    axes = plot.spectrum(eigen)
    assert np.array_equal(axes.lines[0].get_ydata(), eigen.values[eigen.null_count :])


def test_graphs(cloud):
    assert len(plot.graph(cloud).lines) == 1
    assert drawn(plot.graph(spectral.judge_edges(cloud)))
    with pytest.raises(ValueError, match="points: expected"):
        plot.graph(spectral.Graph([[0, 1]]))
    plot.graph(spectral.Graph([[0, 1]]), points=[[0, 0, 0], [1, 1, 1]])


def test_networks(sensors):
    localized = network.localize(sensors[0])
    axes = plot.network(localized, truth=sensors[1])
    assert drawn(axes)


def test_nothing_is_drawn_of_nothing():
    empty = slam.PoseGraph([], np.zeros((0, 3)))
    result = slam.prune(empty)
    for axes in (plot.pose_graph(empty, result.verdicts), plot.scores(result.verdicts), plot.reasons(result.verdicts)):
        axes.figure.canvas.draw()


def test_given_axes_are_used(city):
    _, axes = pyplot.subplots()
    assert plot.pose_graph(city[0], ax=axes) is axes


def document_of(page):
    found = re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    return json.loads(found[1])


def test_a_report_is_the_page_of_the_command(city, tmp_path, run_command):
    city[0].write(tmp_path / "graph.g2o")
    result = slam.prune(slam.read_pose_graph(tmp_path / "graph.g2o"))
    run_command("prune", tmp_path / "graph.g2o", "-q", "--report", tmp_path / "page.html")
    ours, theirs = document_of(result.report()), document_of((tmp_path / "page.html").read_text())
    for member in ("title", "nodes", "layouts", "candidates", "rounds", "options", "kind"):
        assert ours[member] == theirs[member], member


@pytest.mark.parametrize("world", ["city", "sphere"])
def test_a_report_with_the_truth(request, world):
    graph, _, truth = request.getfixturevalue(world)
    document = document_of(slam.prune(graph).report(truth))
    assert "errors" in json.dumps(document["layouts"])
    with pytest.raises(ValueError, match="truth: expected"):
        slam.prune(graph, "chi2").report(truth[:5])


def test_reports_of_the_other_kinds(cloud, sensors):
    assert document_of(spectral.judge_edges(cloud).report())["kind"] == "graph"
    localized = network.localize(sensors[0])
    assert document_of(localized.report(sensors[1]))["kind"] == "network"


def test_a_notebook_shows_the_page_in_a_frame(city, cloud, sensors):
    for result in (slam.prune(city[0], "chi2"), spectral.judge_edges(cloud), network.localize(sensors[0])):
        shown = result._repr_html_()
        assert shown.startswith('<iframe sandbox="allow-scripts"')
        inner = shown.split('srcdoc="', 1)[1].rsplit('"></iframe>', 1)[0]
        assert '"' not in inner
        assert html.unescape(inner) == result.report()


def test_a_notebook_shows_little_of_much():
    graph, _ = slam.simulate_ring(poses=20001, loops=3)
    assert slam.prune(graph, "chi2")._repr_html_() == "<pre>Verdicts(3, 3 keep, 0 prune, 0 ambiguous)</pre>"
