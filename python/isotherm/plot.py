"""Figures of results, drawn with matplotlib.

Each function draws into `ax`, or into new axes, and gives the axes back.
"""

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from isotherm.convert._needed import needed
from isotherm.network import Localized
from isotherm.slam import OptimizeResult, PoseGraph, PruneResult, Verdicts
from isotherm.spectral import Eigenpairs, Graph, JudgedEdges

# Told apart with any sight, and in print (Okabe and Ito 2008).
COLOURS = {"keep": "#0072b2", "prune": "#d55e00", "ambiguous": "#e69f00"}
_PATH = "#444444"
_VERDICTS = ("keep", "ambiguous", "prune")  # what matters most is drawn last


def _axes(ax: Any, dimension: int = 2) -> Any:
    if ax is not None:
        return ax
    pyplot = needed("matplotlib.pyplot", "plot")
    keywords = {"projection": "3d"} if dimension == 3 else {}
    return pyplot.figure(layout="constrained").add_subplot(**keywords)


def _segments(ax: Any, points: NDArray[np.float64], ends: NDArray[np.integer[Any]], **style: Any) -> None:
    """Straight lines between points, as one artist."""
    if len(ends) == 0:
        return
    gaps = np.full((len(ends), 1, points.shape[1]), np.nan)
    lines = np.concatenate([points[ends], gaps], axis=1).reshape(-1, points.shape[1])
    ax.plot(*lines.T, **style)


def _by_verdict(ax: Any, points: NDArray[np.float64], ends: NDArray[np.integer[Any]], verdicts: Verdicts) -> None:
    masks = {"keep": verdicts.kept, "prune": verdicts.pruned, "ambiguous": verdicts.ambiguous}
    for name in _VERDICTS:
        chosen = ends[masks[name]]
        label = f"{name} ({len(chosen)})"
        _segments(ax, points, chosen, color=COLOURS[name], linewidth=0.7, alpha=0.8, label=label)
    if len(verdicts) > 0:
        ax.legend(frameon=False)


def _equal(ax: Any, unit: str) -> None:
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(f"x [{unit}]" if unit else "x")
    ax.set_ylabel(f"y [{unit}]" if unit else "y")


def pose_graph(graph: PoseGraph, verdicts: Verdicts | None = None, *, poses: ArrayLike | None = None, ax: Any = None) -> Any:
    """The map of a pose graph: odometry, and its loops, coloured by verdict if there are some.

    Args:
        graph: what is drawn.
        verdicts: decisions on its loops.
        poses: where the vertices are; else the graph's own poses, or chained odometry.
    """
    if poses is None:
        poses = graph.odometry_poses() if graph.poses is None else graph.poses
    places = np.asarray(poses)[:, : graph.dimension]
    ax = _axes(ax, graph.dimension)
    odometry, candidates = graph.roles()
    _segments(ax, places, graph.edges[odometry], color=_PATH, linewidth=0.8)
    if verdicts is None:
        _segments(ax, places, graph.edges[candidates], color=COLOURS["keep"], linewidth=0.7, alpha=0.8)
    else:
        _by_verdict(ax, places, graph.edges[verdicts.edge], verdicts)
    _equal(ax, "m")
    return ax


def before_and_after(result: PruneResult, solved: OptimizeResult) -> Any:
    """The map with all loops at the poses that came in, and the pruned one as it was optimised."""
    pyplot = needed("matplotlib.pyplot", "plot")
    space = {"projection": "3d"} if result.graph.dimension == 3 else {}
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 5), layout="constrained", subplot_kw=space)
    pose_graph(result.graph, result.verdicts, ax=left)
    pose_graph(solved.graph, ax=right)
    left.set_title("before")
    right.set_title("after")
    return figure


def scores(verdicts: Verdicts, *, ax: Any = None) -> Any:
    """How far each score is from its threshold, in decades, by verdict.

    Where verdicts are probabilities, decades of the odds that an edge is false, 20 at most.
    """
    ax = _axes(ax)
    usable = np.isfinite(verdicts.score) & np.isfinite(verdicts.threshold)
    if np.isfinite(verdicts.probability).any():
        decades = np.clip((verdicts.score - verdicts.threshold) / np.log(10.0), -20.0, 20.0)
    else:
        usable &= (verdicts.score > 0) & (verdicts.threshold > 0)
        decades = np.zeros(len(verdicts))
        decades[usable] = np.log10(verdicts.score[usable] / verdicts.threshold[usable])
    masks = {"keep": verdicts.kept, "prune": verdicts.pruned, "ambiguous": verdicts.ambiguous}
    data = [decades[usable & masks[name]] for name in _VERDICTS]
    labels = [f"{name} ({len(part)})" for name, part in zip(_VERDICTS, data, strict=True)]
    colours = [COLOURS[name] for name in _VERDICTS]
    ax.hist(data, bins=40, stacked=True, color=colours, label=labels)
    ax.axvline(0.0, color=_PATH, linewidth=0.8)
    ax.set_xlabel("decades above the threshold")
    ax.set_ylabel("edges")
    ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
    return ax


def reasons(verdicts: Verdicts, *, most: int = 12, ax: Any = None) -> Any:
    """How many edges each scale, round or test decided on, the most frequent on top."""
    ax = _axes(ax)
    counts = Counter(zip(verdicts.stage, verdicts.verdict, strict=True))
    totals = Counter(verdicts.stage)
    stages = [stage for stage, _ in totals.most_common(most)][::-1]
    left = np.zeros(len(stages))
    for name in _VERDICTS:
        widths = np.array([counts[stage, name] for stage in stages], dtype=float)
        if widths.any():
            ax.barh(stages, widths, left=left, color=COLOURS[name], label=name)
        left += widths
    ax.set_xlabel("edges")
    if stages:
        ax.legend(frameon=False)
    return ax


def spectrum(eigen: Eigenpairs, *, ax: Any = None) -> Any:
    """Eigenvalues in ascending order; null ones are left out of the logarithmic axis."""
    ax = _axes(ax)
    values = eigen.values[eigen.null_count :]
    ax.semilogy(np.arange(eigen.null_count, len(eigen.values)) + 1, values, ".-", color=COLOURS["keep"])
    ax.set_xlabel("number")
    ax.set_ylabel("eigenvalue")
    return ax


def graph(judged: Graph | JudgedEdges, *, points: ArrayLike | None = None, ax: Any = None) -> Any:
    """A plain graph, its edges coloured by verdict if they were judged.

    Args:
        judged: what is drawn.
        points: where the vertices are, n x 2 or n x 3; else the graph's own points.
    """
    drawn = judged.graph if isinstance(judged, JudgedEdges) else judged
    places = drawn.points if points is None else np.asarray(points)
    if places is None or places.shape[1] not in (2, 3):
        raise ValueError("points: expected an array of shape (n, 2) or (n, 3)")
    ax = _axes(ax, places.shape[1])
    if isinstance(judged, JudgedEdges):
        _by_verdict(ax, places, drawn.edges, judged.verdicts)
    else:
        _segments(ax, places, drawn.edges, color=COLOURS["keep"], linewidth=0.7)
    _equal(ax, "")
    return ax


def network(localized: Localized, *, truth: ArrayLike | None = None, ax: Any = None) -> Any:
    """Where the nodes of a network are, with the ranges between them coloured by verdict.

    Args:
        localized: what is drawn.
        truth: the true positions, n x d, to which each node is joined.
    """
    places = np.asarray(localized.positions)
    ax = _axes(ax, places.shape[1])
    ends = localized.network.edges
    _by_verdict(ax, places, ends, localized.verdicts)
    states = np.array(localized.states)
    for state, marker in (("localised", "o"), ("anchor", "s")):
        chosen = places[states == state]
        ax.plot(*chosen.T, marker, color=_PATH, markersize=4, zorder=3)
    if truth is not None:
        both = np.concatenate([places, np.asarray(truth)])
        pairs = np.stack([np.arange(len(places)), np.arange(len(places)) + len(places)], axis=1)
        _segments(ax, both, pairs, color="black", linewidth=1.2)
    _equal(ax, "m")
    return ax
