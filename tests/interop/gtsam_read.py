"""GTSAM reads the g2o files we write: the same poses, measurements and noise
models as from the original files.

usage: gtsam_read.py ISOTHERM
"""

import os
import subprocess
import sys
import tempfile

from isotherm_run import SKIP, data_or_skip

try:
    import gtsam
    import numpy as np
except ImportError:
    print("gtsam is not installed; see scripts/python-env.sh")
    sys.exit(SKIP)

FILES = (
    ("posegraph2d/intel/intel.g2o", False),
    ("paper/kitti/kitti_06.g2o", False),
    ("posegraph3d/sphere2500/sphere2500.g2o", True),
    ("posegraph3d/parking-garage/parking-garage.g2o", True),
)
# Quaternions printed with few digits are normalised by both, in another order
# of operations.
POSE_TOLERANCE = 1e-12
# GTSAM keeps the square root of the information.
NOISE_TOLERANCE = 1e-9


def matrices(graph, spatial):
    """(keys, measured pose, information) of every between factor."""
    found = []
    for k in range(graph.size()):
        factor = graph.at(k)
        if spatial and not isinstance(factor, gtsam.BetweenFactorPose3):
            continue
        if not spatial and not isinstance(factor, gtsam.BetweenFactorPose2):
            continue
        root = factor.noiseModel().R()
        found.append((tuple(factor.keys()), factor.measured().matrix(), root.T @ root))
    return found


def compare(name, original, ours, spatial):
    graph_a, values_a = gtsam.readG2o(original, spatial)
    graph_b, values_b = gtsam.readG2o(ours, spatial)
    if list(values_a.keys()) != list(values_b.keys()):
        sys.exit(f"{name}: other vertices")
    at = "atPose3" if spatial else "atPose2"
    for key in values_a.keys():
        a = getattr(values_a, at)(key).matrix()
        b = getattr(values_b, at)(key).matrix()
        if not np.abs(a - b).max() <= POSE_TOLERANCE:
            sys.exit(f"{name}: pose {key} differs by {np.abs(a - b).max()}")
    edges_a = matrices(graph_a, spatial)
    edges_b = matrices(graph_b, spatial)
    if len(edges_a) != len(edges_b) or not edges_a:
        sys.exit(f"{name}: {len(edges_a)} edges, and {len(edges_b)} in ours")
    for (keys_a, pose_a, info_a), (keys_b, pose_b, info_b) in zip(edges_a, edges_b):
        if keys_a != keys_b:
            sys.exit(f"{name}: edge {keys_a} became {keys_b}")
        if not np.abs(pose_a - pose_b).max() <= POSE_TOLERANCE:
            sys.exit(f"{name}: measurement of {keys_a} differs")
        if not np.abs(info_a - info_b).max() <= NOISE_TOLERANCE * np.abs(info_a).max():
            sys.exit(f"{name}: information of {keys_a} differs")
    print(f"{name}: {len(list(values_a.keys()))} poses and {len(edges_a)} factors agree")


def main():
    command = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for name, spatial in FILES:
            original = data_or_skip(name)
            ours = os.path.join(folder, "ours.g2o")
            subprocess.run([command, "convert", original, "-o", ours, "-q"], check=True)
            compare(name, original, ours, spatial)


if __name__ == "__main__":
    main()
