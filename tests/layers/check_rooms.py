#!/usr/bin/env python3
"""Fails if the folders of a layer include each other in circles or against the order that
docs/architecture.md states, if a folder holds too many sources, if an include is written
in another style, or if a library's internal header has no namespace `detail`.

usage: check_rooms.py ROOT
"""

import re
import sys
from collections import Counter
from pathlib import Path

LAYERS = ["base", "spectral", "geometry", "network", "slam", "apps", "python"]
MOST_FILES = 20
# Layers whose headers another one includes by their path below the layer's folder.
BESIDE = {"python": "apps"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
# A row of the document's table of rooms: | `folder` | `first`, `second`, `header.hpp`, ... |
ROW = re.compile(r"^\| `([a-z_/]+)` \| ((?:`[a-z0-9_.]+`(?:, )?)+) \|$", re.MULTILINE)
# Internal names, or what a public class keeps to itself.
DETAIL = re.compile(r"^namespace (\w+::)*detail \{$|^(class|struct) \w+::\w+ \{$", re.MULTILINE)
THIRD_PARTIES = re.compile(r"^(Eigen|Spectra|CGAL|boost|CLI|nlohmann|fmt|nanobind|oneapi|tbb|fast_float)/")


def stated_orders(root):
    """Folder -> the rooms in it, the first of which includes none of the others."""
    text = (root / "docs/architecture.md").read_text()
    return {folder: re.findall(r"`([a-z0-9_.]+)`", rooms) for folder, rooms in ROW.findall(text)}


def sources(root, layer):
    """(file, its place in the layer) of every source; public and internal headers of a room
    are in one place."""
    bases = [root / layer] if layer == "apps" else [
        root / layer / "src", root / layer / "include" / "isotherm" / layer]
    for base in bases:
        for path in sorted(base.rglob("*.[ch]pp")):
            yield path, Path(path.relative_to(base))


def place_of(include, layer):
    """Where in the layer an included file is, or nothing if it is of another."""
    parts = Path(include).parts
    if parts[0] != "isotherm":
        return Path(include)
    return Path(*parts[2:]) if parts[1] == layer and len(parts) > 2 else None


def rank(place, depth, order):
    """The rank of a file among the rooms of the folder that is its ancestor at `depth`: a
    folder's own headers come first and its own sources last, unless it names them."""
    name = place.parts[depth]
    if name in order:
        return order.index(name)
    if depth + 1 < len(place.parts):
        return None
    return -1 if name.endswith(".hpp") else len(order)


def check_direction(layer, orders, place, included):
    """A complaint about one file of a layer including another, or nothing."""
    common = 0
    while (common < min(len(place.parts), len(included.parts)) - 1
           and place.parts[common] == included.parts[common]):
        common += 1
    folder = "/".join((layer,) + place.parts[:common])
    order = orders.get(folder, [])
    mine, other = rank(place, common, order), rank(included, common, order)
    if mine is None or other is None:
        missing = place if mine is None else included
        return f"docs/architecture.md does not say where `{missing.parts[common]}` stands in {folder}"
    return f"against the order of {folder}" if other > mine else None


def check_includes(root, layer, orders):
    for path, place in sources(root, layer):
        for quote, include in INCLUDE.findall(path.read_text()):
            ours = include.startswith("isotherm/") or (
                "/" in include and not THIRD_PARTIES.match(include) and quote == '"')
            if include.startswith("isotherm/") and quote == "<":
                yield f"{path} includes {include}: written <>, not in quotes"
            if quote == '"' and ("../" in include or include.startswith("./")):
                yield f"{path} includes {include}: by a relative path"
            if quote == '"' and not ours and not is_root_header(root, layer, include):
                yield f"{path} includes {include}: not by its full path"
            if layer in BESIDE and is_root_header(root, BESIDE[layer], include):
                continue
            included = place_of(include, layer) if quote == '"' else None
            complaint = included and check_direction(layer, orders, place, included)
            if complaint:
                yield f"{path} includes {include}: {complaint}"


def is_root_header(root, layer, include):
    folder = root / layer if layer == "apps" else root / layer / "src"
    return (folder / include).is_file()


def check_sizes(root):
    folders = [*LAYERS, "tests", "examples", "benchmarks"]
    count = Counter(path.parent for folder in folders for path in (root / folder).rglob("*.[ch]pp"))
    for folder, files in sorted(count.items()):
        if files > MOST_FILES:
            yield f"{folder}: {files} sources, of {MOST_FILES} at most"


def check_internals(root):
    for layer in LAYERS[:LAYERS.index("apps")]:
        for path in sorted((root / layer / "src").rglob("*.hpp")):
            if not DETAIL.search(path.read_text()):
                yield f"{path}: an internal header without namespace detail"


def main():
    root = Path(sys.argv[1]).resolve()
    orders = stated_orders(root)
    complaints = [*check_sizes(root), *check_internals(root)]
    for layer in LAYERS:
        complaints += check_includes(root, layer, orders)
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints or not orders else 0


if __name__ == "__main__":
    sys.exit(main())
