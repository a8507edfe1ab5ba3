"""Runs the isotherm command; shared by the comparisons with other programs."""

import json
import os
import subprocess
import sys
import tempfile

SKIP = 77  # what CTest takes as "skipped"


def data_root():
    default = os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared", "data")
    return os.environ.get("ISOTHERM_DATA", default)


def data_or_skip(name):
    path = os.path.join(data_root(), name)
    if not os.path.exists(path):
        print(f"no {path}; set ISOTHERM_DATA to the data folder")
        sys.exit(SKIP)
    return path


def run_json(command, arguments, codes=(0,)):
    """Runs `command arguments --json FILE` and gives back the JSON."""
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "result.json")
        line = [command, *arguments, "--quiet", "--json", result]
        done = subprocess.run(line, stdout=subprocess.DEVNULL)
        if done.returncode not in codes:
            sys.exit(f"{' '.join(line)} returned {done.returncode}")
        with open(result, encoding="utf-8") as file:
            return json.load(file)
