"""What the experiments share: their arguments, and labelled graphs."""

import argparse
import dataclasses
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass(frozen=True)
class LabelledGraph:
    name: str
    graph: pathlib.Path
    labels: pathlib.Path
    truth: tuple  # arguments of `eval ate` after the estimate


def argument_parser(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--data", type=pathlib.Path,
                        default=os.environ.get("ISOTHERM_DATA", ROOT / ".." / "shared" / "data"))
    parser.add_argument("--jobs", type=int, default=2, help="programs to run at once")
    parser.add_argument("--page-only", action="store_true",
                        help="write the page of what is there, and measure nothing")
    return parser


def bicocca_truth(data):
    """Arguments that give the ground truth of Bicocca's 25b session."""
    folder = data / "paper" / "b25b"
    return (folder / "Bicocca_2009-02-25b-GT-extended.csv", "--timestamps",
            folder / "B25b_timestamps.txt")
