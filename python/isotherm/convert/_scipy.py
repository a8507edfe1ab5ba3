"""Graphs as sparse matrices of weights."""

from typing import Any

import numpy as np

from isotherm.convert._needed import needed
from isotherm.spectral import Graph


def _in_order(matrix: Any, sparse: Any) -> Any:
    """The matrix in compressed rows without repeats, zeros and disorder: itself if it is so."""
    rows = sparse.csr_array(matrix)
    if rows.has_canonical_format and np.all(rows.data != 0):
        return rows
    rows = rows.copy()
    rows.sum_duplicates()
    rows.eliminate_zeros()
    return rows


def from_scipy(matrix: Any, *, points: Any = None) -> Graph:
    """The graph of a symmetric sparse matrix of weights.

    Entry (i, j) is the weight of the edge {i, j}; the diagonal is left out. The arrays of a
    csr_array of int32 and float64 are read where they are.

    Args:
        matrix: a sparse matrix or array of SciPy, n x n.
        points: where the vertices are, n x d, if that is known.
    """
    sparse = needed("scipy.sparse", "from_scipy")
    if matrix.shape[0] != matrix.shape[1]:
        raise ValueError(f"matrix: expected as many rows as columns, got {matrix.shape}")
    rows = _in_order(matrix, sparse)
    return Graph.from_csr(rows.indptr, rows.indices, rows.data, points=points)


def to_scipy(graph: Graph) -> Any:
    """The symmetric matrix of a graph's weights, a csr_array; parallel edges are added up."""
    sparse = needed("scipy.sparse", "to_scipy")
    proper = graph.edges[:, 0] != graph.edges[:, 1]
    first, second = graph.edges[proper].T
    weights = graph.weights[proper]
    ends = np.concatenate([first, second]), np.concatenate([second, first])
    shape = (len(graph), len(graph))
    return sparse.coo_array((np.concatenate([weights, weights]), ends), shape=shape).tocsr()
