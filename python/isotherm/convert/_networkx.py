"""Graphs of NetworkX."""

from typing import Any

from isotherm.convert._needed import needed
from isotherm.slam import PoseGraph
from isotherm.spectral import Graph


def from_networkx(graph: Any, weight: str = "weight") -> tuple[Graph, list[Any]]:
    """The weighted graph of an undirected graph of NetworkX, and its nodes in order.

    Args:
        graph: a Graph or MultiGraph of NetworkX.
        weight: the attribute of edges that is their weight; 1 where it is missing.
    """
    if graph.is_directed():
        raise ValueError("graph: is directed; to_undirected() makes it one that is not")
    nodes = list(graph)
    place = {node: k for k, node in enumerate(nodes)}
    edges, weights = [], []
    for first, second, value in graph.edges(data=weight, default=1.0):
        edges.append((place[first], place[second]))
        weights.append(value)
    return Graph(edges, weights, vertex_count=len(nodes)), nodes


def _from_weights(graph: Graph, networkx: Any) -> Any:
    ends = graph.ids[graph.edges].tolist()
    unique = {(min(edge), max(edge)) for edge in ends}
    made = networkx.Graph() if len(unique) == len(ends) else networkx.MultiGraph()
    made.add_nodes_from(graph.ids.tolist())
    for (first, second), weight in zip(ends, graph.weights.tolist(), strict=True):
        made.add_edge(first, second, weight=weight)
    return made


def _from_poses(graph: PoseGraph, networkx: Any) -> Any:
    made = networkx.MultiDiGraph()
    ids = graph.ids.tolist()
    made.add_nodes_from(ids)
    if graph.poses is not None:
        networkx.set_node_attributes(made, dict(zip(ids, graph.poses, strict=True)), "pose")
    columns = zip(graph.ids[graph.edges].tolist(), graph.measurements, graph.information, strict=True)
    for edge, ((first, second), measurement, information) in enumerate(columns):
        made.add_edge(first, second, edge=edge, measurement=measurement, information=information)
    return made


def to_networkx(graph: Graph | PoseGraph) -> Any:
    """A graph of NetworkX whose nodes are the ids.

    A weighted graph becomes a Graph (a MultiGraph where edges are parallel) with the attribute
    `weight`. A pose graph becomes a MultiDiGraph with the attributes `pose` of nodes, and
    `edge` (the position in the pose graph), `measurement` and `information` of edges.
    """
    networkx = needed("networkx", "to_networkx")
    return _from_poses(graph, networkx) if isinstance(graph, PoseGraph) else _from_weights(graph, networkx)
