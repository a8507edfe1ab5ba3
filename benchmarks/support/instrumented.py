"""A copy of the sources in which constants are read from the environment when the program starts."""

import dataclasses
import filecmp
import re
import shutil
import subprocess

from support.experiment import ROOT
from support.runs import Command

PREFIX = "ISOTHERM_"


@dataclasses.dataclass(frozen=True)
class Constant:
    name: str
    value: str
    meaning: str
    tried: tuple  # a number a run


def read_from_environment(path, constants):
    """Changes the header that defines them all."""
    text = path.read_text("utf-8")
    for constant in constants:
        pattern = rf"(inline )?constexpr ([\w:]+) {constant.name} = ([^;]+);"
        code = (r"\1const \2 " + constant.name + r" = [] { const char* text = std::getenv(""" +
                f'"{PREFIX}{constant.name}"' +
                r"""); return text ? static_cast<\2>(std::strtod(text, nullptr)) : """ +
                r"static_cast<\2>(\3); }();")
        text, count = re.subn(pattern, code, text)
        if count != 1:
            raise RuntimeError(f"{path.name} has no {constant.name}")
    path.write_text(text.replace("#pragma once\n", "#pragma once\n#include <cstdlib>\n", 1), "utf-8")


def replace(path, pairs):
    text = path.read_text("utf-8")
    for before, after in pairs:
        if before not in text:
            raise RuntimeError(f"{path.name} does not hold {before!r}")
        text = text.replace(before, after)
    path.write_text(text, "utf-8")


def copy(source, target, files):
    for name in files:
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / name, target / name)


def build(folder, instrument):
    """The command, of a copy of the sources in `folder` that `instrument` has changed.

    What is as it was the last time keeps its date, so that it is not compiled again.
    """
    tree, fresh = folder / "tree", folder / "fresh"
    shutil.rmtree(fresh, ignore_errors=True)
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True,
                            check=True).stdout.split("\0")
    files = [name for name in listed if name]
    copy(ROOT, fresh, files)
    instrument(fresh)
    copy(fresh, tree, [name for name in files if not (tree / name).exists() or
                       not filecmp.cmp(fresh / name, tree / name, shallow=False)])
    subprocess.run([tree / "scripts/build.sh", "release"], check=True)
    return tree / "build/release/apps/isotherm"


class Changed(Command):
    """The command with other constants."""

    def __init__(self, path, environment):
        super().__init__("env", 600)
        self.words = [f"{PREFIX}{key}={value}" for key, value in environment.items()] + [str(path)]

    def run(self, *arguments):
        return super().run(*self.words, *arguments)
