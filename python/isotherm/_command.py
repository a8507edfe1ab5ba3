"""The command `isotherm`, as the package brings it along."""

import os
import sys
from pathlib import Path
from typing import NoReturn


def main() -> NoReturn:
    """Become the command."""
    program = Path(__file__).parent / "bin" / "isotherm"
    os.execv(program, ["isotherm", *sys.argv[1:]])
