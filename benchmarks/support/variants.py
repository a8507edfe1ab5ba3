"""The same pose graph presented otherwise: what is true in it stays true.

A variant is a function of the records of a g2o file and a random number generator. Edges
between successive ids are odometry; all others are loops.
"""

import dataclasses
import gzip
import math


@dataclasses.dataclass
class Edge:
    tag: str
    ends: tuple  # from, to
    values: list  # transform, then the upper triangle of the information

    @property
    def is_odometry(self):
        return abs(self.ends[0] - self.ends[1]) == 1

    @property
    def size(self):
        """Of the transform: x, y, angle, or translation and quaternion."""
        return 3 if self.tag == "EDGE_SE2" else 7


@dataclasses.dataclass
class Graph:
    vertices: dict  # id: line after the id; may be empty
    vertex_tag: str
    edges: list

    @property
    def names(self):
        return sorted(set(self.vertices).union(*(e.ends for e in self.edges)))


def read(path):
    opener = gzip.open if str(path).endswith(".gz") else open
    graph = Graph({}, "", [])
    with opener(path, "rt", encoding="utf-8") as file:
        for words in map(str.split, file):
            if not words:
                continue
            if words[0].startswith("VERTEX_SE"):
                graph.vertex_tag = words[0]
                graph.vertices[int(words[1])] = words[2:]
            elif words[0].startswith("EDGE_SE"):
                ends = int(words[1]), int(words[2])
                graph.edges.append(Edge(words[0], ends, [float(w) for w in words[3:]]))
    return graph


def write(graph, path):
    with open(path, "w", encoding="utf-8") as file:
        for name, words in sorted(graph.vertices.items()):
            print(graph.vertex_tag, name, *words, file=file)
        for edge in graph.edges:
            print(edge.tag, *edge.ends, *map(repr, edge.values), file=file)


def kept(graph, names):
    """The part of a graph between some vertices."""
    return Graph({n: v for n, v in graph.vertices.items() if n in names}, graph.vertex_tag,
                 [e for e in graph.edges if e.ends[0] in names and e.ends[1] in names])


def changed(graph, change):
    """`change(edge)` gives the values of each edge."""
    return dataclasses.replace(
        graph, edges=[dataclasses.replace(e, values=change(e)) for e in graph.edges])


def scaled(odometry, loops):
    """Information times these factors."""

    def variant(graph, _):
        def change(edge):
            factor = odometry if edge.is_odometry else loops
            return edge.values[:edge.size] + [factor * v for v in edge.values[edge.size:]]

        return changed(graph, change)

    return variant


def cropped(share):
    """A stretch of the trajectory."""

    def variant(graph, random):
        names = graph.names
        count = int(share * len(names))
        first = random.randrange(len(names) - count + 1)
        return kept(graph, set(names[first:first + count]))

    return variant


def thinned(share):
    """Some of the loops."""

    def variant(graph, random):
        return dataclasses.replace(
            graph, edges=[e for e in graph.edges if e.is_odometry or random.random() < share])

    return variant


def backwards(graph, _):
    """The last vertex first."""
    names = graph.names
    turned = dict(zip(names, reversed(names)))
    return Graph({turned[n]: v for n, v in graph.vertices.items()}, graph.vertex_tag,
                 [dataclasses.replace(e, ends=(turned[e.ends[0]], turned[e.ends[1]]))
                  for e in graph.edges])


def stretched(factor):
    """Wheels of another size than thought: translations of odometry times `factor`."""

    def variant(graph, _):
        def change(edge):
            if not edge.is_odometry:
                return edge.values
            head = 2 if edge.size == 3 else 3
            return [factor * v for v in edge.values[:head]] + edge.values[head:]

        return changed(graph, change)

    return variant


def turning(bias):
    """A gyroscope that drifts: `bias` radians more heading a step of odometry."""

    def variant(graph, _):
        def change(edge):
            if not edge.is_odometry:
                return edge.values
            sign = edge.ends[1] - edge.ends[0]
            values = list(edge.values)
            if edge.size == 3:
                values[2] += sign * bias
                return values
            s, c = math.sin(sign * bias / 2), math.cos(sign * bias / 2)
            x, y, z, w = values[3:7]
            values[3:7] = [x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s]
            return values

        return changed(graph, change)

    return variant


VARIANTS = {
    "as it is": lambda graph, _: graph,
    "all information x 100": scaled(100, 100),
    "all information x 0.01": scaled(0.01, 0.01),
    "information of odometry x 100": scaled(100, 1),
    "information of odometry x 0.01": scaled(0.01, 1),
    "information of loops x 100": scaled(1, 100),
    "information of loops x 0.01": scaled(1, 0.01),
    "a third of the poses": cropped(1 / 3),
    "two thirds of the poses": cropped(2 / 3),
    "half of the loops": thinned(0.5),
    "a tenth of the loops": thinned(0.1),
    "backwards": backwards,
    "odometry 1 % too long": stretched(1.01),
    "odometry 3 % too long": stretched(1.03),
    "heading 0.1 mrad a step": turning(1e-4),
    "heading 0.2 mrad a step": turning(2e-4),
    "heading 1 mrad a step": turning(1e-3),
}
RANDOM = {name for name in VARIANTS if " of the " in name}
