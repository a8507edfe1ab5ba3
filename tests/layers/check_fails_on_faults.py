#!/usr/bin/env python3
"""Plants one fault at a time in a copy of the sources and expects scripts/check.sh to fail by it.

usage: check_fails_on_faults.py ROOT
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

NEEDED = ["clang-format-14", "shellcheck", "git", "cmake"]
SKIPPED = 77

FAULTS = {
    "formatting": ("base/src/planted.cpp", "namespace isotherm{ }\n", "clang-format-violations"),
    "a script": ("scripts/planted.sh", "#!/bin/sh\ncd $1\n", "SC2164"),
    "a circle": ("spectral/src/graph/planted.cpp",
                 '#include "heat/heat_engine.hpp"\n', "against the order of spectral"),
    "an include": ("spectral/src/planted.cpp",
                   "#include <isotherm/slam/graph/pose.hpp>\n", "isotherm/slam/graph/pose.hpp"),
}


def git(copy, *arguments):
    subprocess.run(["git", "-C", copy, *arguments], check=True, capture_output=True)


def copy_sources(root, copy):
    for folder in ["base", "spectral", "geometry", "network", "slam", "apps", "python", "docs",
                   "tests", "scripts", ".ci"]:
        shutil.copytree(root / folder, copy / folder,
                        ignore=shutil.ignore_patterns("results", "images", "__pycache__"))
    shutil.copy(root / ".clang-format", copy)
    git(copy, "init", "--quiet")
    # Formatting is checked of what git knows: of one layer, which takes a moment only.
    git(copy, "add", "base", "scripts", ".ci")


def complaints(copy):
    done = subprocess.run([copy / "scripts/check.sh", "--quick"], capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode else ""


def went_wrong(copy):
    if complaints(copy):
        yield f"the sources as they are: {complaints(copy)}"
    for fault, (name, text, expected) in FAULTS.items():
        path = copy / name
        path.write_text(text)
        git(copy, "add", name)
        if expected not in complaints(copy):
            yield f"{fault}: {complaints(copy)}"
        git(copy, "rm", "--quiet", "--force", name)


def main():
    missing = [tool for tool in NEEDED if shutil.which(tool) is None]
    if missing:
        print("needs", *missing)
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch)
        copy_sources(Path(sys.argv[1]).resolve(), copy)
        failures = list(went_wrong(copy))
    for failure in failures:
        print(f"went wrong: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
