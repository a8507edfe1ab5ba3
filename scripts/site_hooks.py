"""What the site adds to the pages of docs/ (see mkdocs.yml): reference pages, formulas as MathML,
and links out of docs/, which are checked and then left out."""

import html
import re
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.structure.files import File

ROOT = Path(__file__).parents[1]
PYTHON = {
    "slam": "isotherm._core.slam",
    "spectral": "isotherm._core.spectral",
    "geometry": "isotherm._core.geometry",
    "network": "isotherm._core.network",
    "convert": "isotherm.convert",
    "plot": "isotherm.plot",
}
LAYERS = ("slam", "network", "geometry", "spectral", "base")


def python_page(name, module):
    return f"# isotherm.{name}\n\n::: {module}\n"


def in_markdown(line):
    """A line of a header's documentation, its tags as paragraphs."""
    text = html.escape(line, quote=False).replace("*", r"\*").replace("[", r"\[")
    text = re.sub(r"^@throws ", "\n*Throws* ", text)
    return re.sub(r"^@param (\w+)", r"\n`\1`:", text)


def header_page(path):
    """A header as prose, where it has documentation, and code."""
    prose, code, parts = [], [], []

    def flush():
        text = "\n".join(code).strip("\n")
        if prose:
            parts.append("\n".join(prose))
        if text:
            parts.append(f"```cpp\n{text}\n```")
        prose.clear()
        code.clear()

    body = path.read_text().split("#pragma once", 1)[1]
    for line in body.splitlines():
        if line.startswith("#include"):
            continue
        comment = re.match(r"\s*///(?!<) ?(.*)", line)
        top = comment and not line.startswith(" ")
        if top and code:
            flush()
        if top:
            prose.append(in_markdown(comment[1]))
        else:
            code.append(line)
    flush()
    return "\n\n".join(parts)


def layer_page(layer):
    base = ROOT / layer / "include"
    parts = [f"# isotherm::{layer}\n\nThe public headers of the layer, as they are."]
    for path in sorted(base.rglob("*.hpp")):
        name = path.relative_to(base).as_posix()
        if name.count("/") > 1:
            # All begin alike, and the table of contents has room for little.
            below = name.removeprefix(f"isotherm/{layer}/")
            parts.append(f"## {below}\n\n`#include <{name}>`\n\n{header_page(path)}")
    return "\n\n".join(parts)


def on_files(files, config):
    for name, module in PYTHON.items():
        page = python_page(name, module)
        files.append(File.generated(config, f"reference/python/{name}.md", content=page))
    for layer in LAYERS:
        page = layer_page(layer)
        files.append(File.generated(config, f"reference/cpp/{layer}.md", content=page))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links to what the site does not have lead to files of the project: they must be there."""
    here = (Path(config["docs_dir"]) / page.file.src_uri).parent

    def unlinked(found):
        target = (here / found[2]).resolve()
        if target.is_relative_to(Path(config["docs_dir"]).resolve()) and target.is_file():
            return found[0]
        if not target.exists():
            return found[0]  # for MkDocs to complain about
        return found[1]

    if page.file.src_uri.startswith("reference/"):
        return markdown
    return re.sub(r"(?<!!)\[([^\]]*)\]\((\.{0,2}[^):#\s]+)(?:#[^)]*)?\)", unlinked, markdown)


def on_page_content(content, page, config, files):
    def inline(found):
        return convert(html.unescape(found[1]))

    def block(found):
        return convert(html.unescape(found[1]), display="block")

    content = re.sub(r'<span class="arithmatex">\\\((.*?)\\\)</span>', inline, content, flags=re.DOTALL)
    return re.sub(r'<div class="arithmatex">\\\[(.*?)\\\]</div>', block, content, flags=re.DOTALL)
