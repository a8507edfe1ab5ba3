"""evo reads the TUM and KITTI trajectories we write, and finds in them the
absolute trajectory error that `isotherm eval ate` finds, to 1e-9.

usage: evo_read.py ISOTHERM
"""

import os
import subprocess
import sys
import tempfile

from isotherm_run import SKIP, data_or_skip, run_json

try:
    from evo.core import metrics
    from evo.tools import file_interface
except ImportError:
    print("evo is not installed; see scripts/python-env.sh")
    sys.exit(SKIP)

TOLERANCE = 1e-9
READERS = {
    "tum": file_interface.read_tum_trajectory_file,
    "kitti": file_interface.read_kitti_poses_file,
}


def main():
    command = sys.argv[1]
    sources = {
        "estimate": data_or_skip("paper/kitti/KITTI_00_ORB.txt"),
        "truth": data_or_skip("paper/kitti/poses_00.txt"),
    }
    with tempfile.TemporaryDirectory() as folder:
        for kind, read in READERS.items():
            paths = {}
            for name, source in sources.items():
                paths[name] = os.path.join(folder, f"{name}.{kind}")
                # Stamps only in one of the two would not match: both as plain poses.
                plain = os.path.join(folder, f"{name}.plain.kitti")
                subprocess.run([command, "convert", source, "-o", plain, "-q"], check=True)
                subprocess.run([command, "convert", plain, "-o", paths[name], "-q"], check=True)
            for align in ("none", "se"):
                arguments = ["eval", "ate", paths["estimate"], paths["truth"], "--align", align]
                ours = run_json(command, arguments)
                truth, estimate = read(paths["truth"]), read(paths["estimate"])
                if align == "se":
                    estimate.align(truth)
                metric = metrics.APE(metrics.PoseRelation.translation_part)
                metric.process_data((truth, estimate))
                theirs = metric.get_all_statistics()
                for key in ("mean", "rmse", "median", "max"):
                    if not abs(ours[key] - theirs[key]) <= TOLERANCE:
                        sys.exit(f"{kind}, align {align}, {key}: {ours[key]}, evo {theirs[key]}")
                print(f"{kind}, align {align}: rmse {ours['rmse']:.9f} m, as evo finds")


if __name__ == "__main__":
    main()
