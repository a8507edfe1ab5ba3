"""Runs every method on every labelled graph; see benchmarks/peers.sh."""

import os
import pathlib
import sys

from experiment import ROOT, argument_parser
from graphs import Graphs
from methods import measure, methods
from published import read_published, shortfalls
from runs import Command, Results, run_all

TIME_LIMIT = 600  # seconds a run


def shown(value, digits):
    return "–" if value is None else f"{value:.{digits}f}"


def row(name, result, figures):
    cells = [name, *(shown(result.get(key), 3) for key in ("precision", "recall", "f1"))]
    cells += [shown(result.get("fp"), 0), shown(result["mean"], 2), shown(result["rmse"], 2)]
    cells += [shown(result["seconds"], 2), shown(result["megabytes"], 0), figures or "–"]
    return "| " + " | ".join(cells) + " |\n"


def tables(results, graphs, published):
    """(the tables, a row a figure that is not reproduced, runs that are missing)."""
    text, short, missing = "", "", []
    for graph in graphs:
        text += (f"\n### {graph.name}\n\n| method | P | R | F | true pruned | first-pose m | "
                 "aligned m | user s | MB | peer |\n" + "|---" * 10 + "|\n")
        for method in methods(graph.name):
            result = results.get(f"{graph.name}/{method}")
            if result is None or "failed" in result:
                missing.append(f"{graph.name}, {method}"
                               + ("" if result is None else f" ({result['failed']})"))
                continue
            figures = published.get((graph.name, method))
            text += row(method, result, figures)
            for words in shortfalls(result, figures) if figures else []:
                short += f"| {graph.name} | {method} | {words} |\n"
    return text, short, missing


def main():
    options = argument_parser(__doc__).parse_args()
    if not options.data.is_dir():
        sys.exit(f"peers: no folder {options.data}")
    build = ROOT / "build" / "peers"
    command = Command(os.environ["ISOTHERM"], TIME_LIMIT)
    graphs = list(Graphs(command, options.data, build / "graphs").all())
    results = Results(build / "results")
    if not options.page_only:
        tasks = {f"{graph.name}/{name}": lambda g=graph, f=flags: measure(command, g, f)
                 for graph in graphs for name, flags in methods(graph.name).items()}
        run_all(tasks, results, options.jobs)

    text, short, missing = tables(results, graphs, read_published())
    template = pathlib.Path(__file__).with_name("page.md").read_text(encoding="utf-8")
    page = template.replace("{shortfalls}", short or "| – | – | – |\n").replace("{tables}", text)
    if missing:
        page += "\nNot measured: " + "; ".join(missing) + ".\n"
    target = ROOT / "docs" / "results" / "peers.md"
    target.write_text(page, encoding="utf-8")
    print(f"peers: wrote {target.relative_to(ROOT)}", file=sys.stderr)


if __name__ == "__main__":
    main()
