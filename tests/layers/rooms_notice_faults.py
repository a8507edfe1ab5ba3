#!/usr/bin/env python3
"""Plants one fault at a time in a copy of the sources and expects check_rooms.py to name it.

usage: rooms_notice_faults.py ROOT
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FAULTS = {
    "a circle of rooms": ("spectral/src/graph/planted.cpp",
                          '#include "heat/heat_engine.hpp"\n', "against the order of spectral"),
    "a circle below a room": ("network/src/localize/problem/planted.hpp",
                              '#include "localize/firm/firmness.hpp"\n',
                              "against the order of network/localize"),
    "a room that nobody ordered": ("slam/src/prune/planted/planted.cpp",
                                   '#include "graph/gauge.hpp"\n#include "prune/pcm/max_clique.hpp"\n',
                                   "does not say where `planted` stands"),
    "angle brackets": ("slam/src/graph/planted.cpp",
                       "#include <isotherm/slam/graph/pose.hpp>\n", "not in quotes"),
    "a relative path": ("slam/src/graph/planted.cpp",
                        '#include "../io/graph_draft.hpp"\n', "by a relative path"),
    "an internal name without": ("slam/src/graph/planted.hpp",
                                 "namespace isotherm::slam {\nint planted();\n}\n",
                                 "without namespace detail"),
    "a bare name": ("slam/src/graph/planted.cpp", '#include "gauge.hpp"\n', "not by its full path"),
}


def complaints(check, root):
    done = subprocess.run([sys.executable, check, root], capture_output=True, text=True)
    return done.stderr if done.returncode else ""


def main():
    root = Path(sys.argv[1]).resolve()
    check = root / "tests/layers/check_rooms.py"
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch)
        for layer in ["base", "spectral", "geometry", "network", "slam", "apps", "docs"]:
            shutil.copytree(root / layer, copy / layer, ignore=shutil.ignore_patterns("results", "images"))
        failures = [] if not complaints(check, copy) else ["the sources as they are"]
        for fault, (name, text, expected) in FAULTS.items():
            path = copy / name
            new_folder = not path.parent.exists()
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
            if expected not in complaints(check, copy):
                failures.append(fault)
            shutil.rmtree(path.parent) if new_folder else path.unlink()
        for number in range(21):
            (copy / f"base/src/planted_{number}.cpp").touch()
        if "sources, of 20 at most" not in complaints(check, copy):
            failures.append("too many files")
    for failure in failures:
        print(f"went wrong: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
