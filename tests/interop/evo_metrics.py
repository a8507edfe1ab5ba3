"""ATE and RPE of KITTI 00 (ORB-SLAM against the truth) equal evo's to 1e-9.

usage: evo_metrics.py ISOTHERM
"""

import os
import sys
import tempfile

from isotherm_run import SKIP, data_or_skip, run_json

try:
    import numpy as np
    from evo.core import metrics
    from evo.core.trajectory import PoseTrajectory3D
    from evo.tools import file_interface
except ImportError:
    print("evo is not installed; see scripts/python-env.sh")
    sys.exit(SKIP)

TOLERANCE = 1e-9
TRANSLATION = metrics.PoseRelation.translation_part
ROTATION = metrics.PoseRelation.rotation_angle_rad


def evo_statistics(metric, truth, estimate):
    metric.process_data((truth, estimate))
    return metric.get_all_statistics()


def compare(what, ours, theirs):
    for key in ("mean", "rmse", "median", "max", "min", "std"):
        difference = abs(ours[key] - theirs[key])
        if not difference <= TOLERANCE:
            sys.exit(f"{what} {key}: {ours[key]!r}, evo {theirs[key]!r}")
    print(f"{what}: equal to evo's to {TOLERANCE}")


def main():
    command = sys.argv[1]
    estimate_path = data_or_skip("paper/kitti/KITTI_00_ORB.txt")
    truth_path = data_or_skip("paper/kitti/poses_00.txt")
    # The truth has a time in front of each pose, which evo does not read.
    with open(truth_path, encoding="utf-8") as file:
        rows = [" ".join(line.split()[-12:]) for line in file]
    with tempfile.TemporaryDirectory() as folder:
        truth_plain = os.path.join(folder, "truth.kitti")
        with open(truth_plain, "w", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")
        compare_kitti(command, estimate_path, truth_plain)
        compare_tum(command, estimate_path, truth_plain, folder)


def compare_kitti(command, estimate_path, truth_path):
    """Alignments that use positions only, straight from the KITTI files.

    Their rotation matrices are printed with few digits. evo takes them as they
    are, Isotherm takes the nearest rotation: the other metrics differ by 1e-5.
    """
    for align in ("none", "se"):
        truth = file_interface.read_kitti_poses_file(truth_path)
        estimate = file_interface.read_kitti_poses_file(estimate_path)
        if align == "se":
            estimate.align(truth)
        ours = run_json(command, ["eval", "ate", estimate_path, truth_path, "--align", align])
        theirs = evo_statistics(metrics.APE(TRANSLATION), truth, estimate)
        compare(f"KITTI: ATE, align {align}", ours, theirs)


def compare_tum(command, estimate_path, truth_path, folder):
    """Everything, on the same poses as quaternions."""
    files = []
    for path in (estimate_path, truth_path):
        poses = file_interface.read_kitti_poses_file(path)
        stamps = np.arange(poses.num_poses, dtype=float)
        stamped = PoseTrajectory3D(
            positions_xyz=poses.positions_xyz,
            orientations_quat_wxyz=poses.orientations_quat_wxyz,
            timestamps=stamps,
        )
        files.append(os.path.join(folder, os.path.basename(path) + ".tum"))
        file_interface.write_tum_trajectory_file(files[-1], stamped)

    def load():
        return (
            file_interface.read_tum_trajectory_file(files[1]),
            file_interface.read_tum_trajectory_file(files[0]),
        )

    for align in ("none", "first", "se"):
        truth, estimate = load()
        if align == "first":
            estimate.align_origin(truth)
        elif align == "se":
            estimate.align(truth)
        ours = run_json(command, ["eval", "ate", *files, "--align", align])
        theirs = evo_statistics(metrics.APE(TRANSLATION), truth, estimate)
        compare(f"ATE, align {align}", ours, theirs)

    for delta in (1, 10):
        for all_pairs in (False, True):
            truth, estimate = load()
            flags = ["--delta", str(delta)] + (["--all-pairs"] if all_pairs else [])
            ours = run_json(command, ["eval", "rpe", *files, *flags])
            what = f"RPE, delta {delta}{', all pairs' if all_pairs else ''}"
            options = {"delta": delta, "delta_unit": metrics.Unit.frames, "all_pairs": all_pairs}
            theirs = evo_statistics(metrics.RPE(TRANSLATION, **options), truth, estimate)
            compare(what, ours, theirs)
            theirs = evo_statistics(metrics.RPE(ROTATION, **options), truth, estimate)
            compare(what + ", rotation", ours["rotation"], theirs)


if __name__ == "__main__":
    main()
