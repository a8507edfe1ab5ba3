"""What the peers' own programs do on the same files (published.csv), and whether ours
reproduces it: F within 0.03 and aligned RMSE within ten per cent, or better."""

import pathlib
import re

from runs import read_csv

F_TOLERANCE = 0.03
RMSE_TOLERANCE = 1.10
ROUNDING = 0.02  # metres; figures are printed with two digits


def read_published():
    """(graph, method) to the figures as printed."""
    rows = read_csv(pathlib.Path(__file__).with_name("published.csv"))
    return {(row["graph"], row["method"]): row["figures"] for row in rows}


def published_f(figures):
    """The F of `figures`, directly or from P/R; None if they have none."""
    found = re.search(r"\bF (\.\d+|\d\.\d+)", figures)
    if found:
        return float(found[1])
    found = re.match(r"([\d.]+)/([\d.]+)", figures)
    if not found:
        return None
    precision, recall = float(found[1]), float(found[2])
    return 2.0 * precision * recall / (precision + recall)


def published_rmse(figures):
    found = re.search(r"([\d.]+) m\b", figures)
    return float(found[1]) if found else None


def shortfalls(result, figures):
    """In words, what is worse than `figures` by more than the tolerances."""
    found = []
    f1, rmse = published_f(figures), published_rmse(figures)
    if f1 is not None and result["f1"] < f1 - F_TOLERANCE:
        found.append(f"F {result['f1']:.3f} against {f1:.3f}")
    if rmse is not None and result["rmse"] > RMSE_TOLERANCE * rmse + ROUNDING:
        found.append(f"RMSE {result['rmse']:.2f} m against {rmse:.2f} m")
    return found
