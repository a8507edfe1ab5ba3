"""Planar poses and g2o files, as far as preparing graphs needs them."""

import dataclasses

import numpy as np


def compose(a, b):
    """The pose b, given in the frame of a, in the frame a is given in."""
    c, s = np.cos(a[2]), np.sin(a[2])
    return np.array([a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]])


def inverse(a):
    c, s = np.cos(a[2]), np.sin(a[2])
    return np.array([-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2]])


def between(a, b):
    """The pose b in the frame of a."""
    return compose(inverse(a), b)


@dataclasses.dataclass
class Edge:
    start: int
    end: int
    pose: np.ndarray
    information: tuple  # upper triangle by rows

    def is_odometry(self):
        return abs(self.start - self.end) == 1


def read_edges(path):
    """The EDGE_SE2 lines of a g2o file."""
    edges = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            fields = line.split()
            if fields and fields[0] == "EDGE_SE2":
                numbers = [float(field) for field in fields[3:]]
                edges.append(Edge(int(fields[1]), int(fields[2]), np.array(numbers[:3]),
                                  tuple(numbers[3:])))
    return edges


def write_graph(path, edges, poses=()):
    with open(path, "w", encoding="utf-8") as file:
        for vertex, pose in enumerate(poses):
            file.write(f"VERTEX_SE2 {vertex} {numbers(pose)}\n")
        for edge in edges:
            file.write(f"EDGE_SE2 {edge.start} {edge.end} {numbers(edge.pose)} "
                       f"{numbers(edge.information)}\n")


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


def wrap(angle):
    return (angle + np.pi) % (2.0 * np.pi) - np.pi
