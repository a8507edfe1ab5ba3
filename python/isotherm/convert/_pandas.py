"""Graphs from tables of pandas; results have to_dataframe()."""

from typing import Any

import numpy as np

from isotherm.spectral import Graph


def from_dataframe(
    frame: Any, source: str = "from", target: str = "to", weight: str | None = "weight"
) -> tuple[Graph, Any]:
    """The weighted graph of a table with one row an edge, and its nodes in ascending order.

    Args:
        frame: a DataFrame.
        source: the column that names one end of an edge.
        target: the column that names the other.
        weight: the column of weights; 1 each where there is none of that name.
    """
    ends = frame[[source, target]].to_numpy()
    nodes, places = np.unique(ends, return_inverse=True)
    weights = frame[weight].to_numpy() if weight in frame.columns else None
    return Graph(places.reshape(-1, 2), weights, vertex_count=len(nodes)), nodes
