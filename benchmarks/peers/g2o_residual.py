"""A planar optimisation with g2o's residual instead of Isotherm's, to tell whether the
residual explains a difference.

g2o takes the translation of T_measured^-1 T_from^-1 T_to as it stands, Isotherm the full
logarithm, where a rotation that does not fit bends the translation too. Gauss-Newton from
the file's vertices, DCS (published weight) or Cauchy on every edge but the odometry.

usage: g2o_residual.py graph.g2o[.gz] dcs|cauchy WIDTH ITERATIONS estimate.g2o verdicts.csv
"""

import gzip
import sys

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

INFORMATION = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def read(path):
    """(ids, poses, ends, measurements, information matrices) of a planar g2o file."""
    vertices, edges = {}, []
    with (gzip.open if path.endswith(".gz") else open)(path, "rt", encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words and words[0] == "VERTEX_SE2":
                vertices[int(words[1])] = [float(word) for word in words[2:5]]
            elif words and words[0] == "EDGE_SE2":
                edges.append([float(word) for word in words[1:12]])
    ids = sorted(vertices)
    place = {vertex: k for k, vertex in enumerate(ids)}
    edges = np.array(edges)
    ends = np.array([[place[int(a)], place[int(b)]] for a, b in edges[:, :2]])
    information = np.zeros((len(edges), 3, 3))
    for k, (i, j) in enumerate(INFORMATION):
        information[:, i, j] = information[:, j, i] = edges[:, 5 + k]
    return ids, np.array([vertices[v] for v in ids]), ends, edges[:, 2:5], information


def odometry(ends):
    """The first edge of every pair of neighbours, as a mask."""
    near = np.abs(ends[:, 0] - ends[:, 1]) == 1
    first = np.unique(np.where(near, ends.min(axis=1), -1), return_index=True)[1]
    mask = np.zeros(len(ends), bool)
    mask[first] = True
    return mask & near


def turned(angle):
    """Rotation matrices, transposed."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([c, s], -1), np.stack([-s, c], -1)], -2)


def wrapped(angle):
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def linearised(poses, ends, measured):
    """Residuals and their derivatives by either end."""
    a, b = poses[ends[:, 0]], poses[ends[:, 1]]
    to_measured, to_from = turned(measured[:, 2]), turned(a[:, 2])
    local = np.einsum("kij,kj->ki", to_from, b[:, :2] - a[:, :2])
    residual = np.empty((len(ends), 3))
    residual[:, :2] = np.einsum("kij,kj->ki", to_measured, local - measured[:, :2])
    residual[:, 2] = wrapped(b[:, 2] - a[:, 2] - measured[:, 2])
    by_from, by_to = np.zeros((2, len(ends), 3, 3))
    by_to[:, :2, :2] = to_measured @ to_from
    by_from[:, :2, :2] = -by_to[:, :2, :2]
    by_from[:, :2, 2] = np.einsum("kij,kj->ki", to_measured,
                                  np.stack([local[:, 1], -local[:, 0]], -1))
    by_from[:, 2, 2], by_to[:, 2, 2] = -1.0, 1.0
    return residual, (by_from, by_to)


def step(residual, derivatives, information, ends, count):
    """The Gauss-Newton step; the first pose is held."""
    gradient = np.zeros((count, 3))
    rows, columns, values = [], [], []
    for i in (0, 1):
        weighted = np.swapaxes(derivatives[i], 1, 2) @ information
        np.add.at(gradient, ends[:, i], np.einsum("kij,kj->ki", weighted, residual))
        for j in (0, 1):
            block = weighted @ derivatives[j]
            row = 3 * ends[:, i, None, None] + np.arange(3)[None, :, None]
            column = 3 * ends[:, j, None, None] + np.arange(3)[None, None, :]
            rows.append(np.broadcast_to(row, block.shape).ravel())
            columns.append(np.broadcast_to(column, block.shape).ravel())
            values.append(block.ravel())
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    hessian = sparse.csc_matrix(entries, shape=(3 * count, 3 * count))[3:, 3:].tocsc()
    solution = spsolve(hessian, -gradient.ravel()[3:], permc_spec="MMD_AT_PLUS_A")
    return np.concatenate([np.zeros(3), solution]).reshape(-1, 3)


def main():
    path, kernel, width, iterations, estimate, verdicts = sys.argv[1:]
    width = float(width)
    weight = {"cauchy": lambda x: 1.0 / (1.0 + x / width**2),
              "dcs": lambda x: np.minimum(1.0, 2.0 * width / (width + x)) ** 2}[kernel]
    threshold = {"cauchy": width**2, "dcs": 3.0 * width}[kernel]
    ids, poses, ends, measured, information = read(path)
    trusted = odometry(ends)
    for _ in range(int(iterations)):
        residual, derivatives = linearised(poses, ends, measured)
        chi2 = np.einsum("ki,kij,kj->k", residual, information, residual)
        scale = np.where(trusted, 1.0, weight(chi2))
        poses = poses + step(residual, derivatives, scale[:, None, None] * information, ends,
                             len(poses))
    residual = linearised(poses, ends, measured)[0]
    chi2 = np.einsum("ki,kij,kj->k", residual, information, residual)
    with open(estimate, "w", encoding="utf-8") as file:
        for vertex, (x, y, theta) in zip(ids, poses):
            file.write(f"VERTEX_SE2 {vertex} {x:.17g} {y:.17g} {wrapped(theta):.17g}\n")
    with open(verdicts, "w", encoding="utf-8") as file:
        file.write("edge,from,to,verdict,score,threshold,stage\n")
        for k in np.flatnonzero(~trusted):
            word = "prune" if chi2[k] > threshold else "keep"
            file.write(f"{k},{ids[ends[k, 0]]},{ids[ends[k, 1]]},{word},{chi2[k]:.17g},"
                       f"{threshold:.17g},{kernel}\n")


if __name__ == "__main__":
    main()
