"""Repeats the paper's experiments; see benchmarks/reproduce.sh."""

import os
import sys

from cells import Graphs
from drawings import draw_lap_line, draw_overview
from experiment import ROOT, argument_parser
from figures import Figures
from methods import Measure
from page import Page
from plan import FULL, QUICK, all_tasks
from runs import Command, Results, run_all
from text import page_text


def arguments():
    parser = argument_parser(__doc__)
    parser.add_argument("--quick", action="store_true",
                        help="one seed, three noise levels, six kernel widths")
    return parser.parse_args()


def main():
    options = arguments()
    if not (options.data / "paper").is_dir():
        sys.exit(f"reproduce: no folder {options.data / 'paper'}")
    extent = QUICK if options.quick else FULL
    build = ROOT / "build" / "reproduce"
    command = Command(os.environ["ISOTHERM"])
    graphs = Graphs(command, options.data, build / "graphs")
    # Results of the two extents differ in widths and candidates, so they are kept apart.
    results = Results(build / ("quick" if options.quick else "full"))
    if not options.page_only:
        run_all(all_tasks(graphs, Measure(command), extent), results, options.jobs)

    figures = Figures(command, graphs, ROOT / "docs" / "images" / "paper")
    figures.maps()
    figures.kitti_maps()
    draw_overview(figures)
    draw_lap_line(figures)
    figures.embedding()
    figures.decay()
    for style in extent.styles:
        figures.noise_levels(results, extent, style)
    target = ROOT / "docs" / "results" / "paper.md"
    target.write_text(page_text(Page(results, extent), extent, options.quick), encoding="utf-8")
    print(f"reproduce: wrote {target.relative_to(ROOT)}", file=sys.stderr)


if __name__ == "__main__":
    main()
