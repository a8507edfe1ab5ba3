"""Writes docs/results/paper.md from the results."""

import math

from cells import TYPES
from methods import (BICOCCA_COLUMNS, CONSENSUS, NOT_THE_PAPERS, PRUNING, READINGS,
                     bicocca_error, bicocca_results, mean, with_best_width)
from plan import COMBINED, KITTI, PRINTED_COUNTS
from printed import TABLE1, TABLE2

STYLE_NAMES = {"paper": "the paper's style", "vertigo": "Vertigo's style",
               "file": "the paper's own files"}

TIE = 1.02  # errors within two per cent are equal
ROUNDING = 0.005  # of the printed figures


def shown(value, digits=2):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    return f"{value:.{digits}f}"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


class Page:
    def __init__(self, results, extent):
        self.results, self.extent = results, extent

    def mean_over_seeds(self, prefix, suffix, pick):
        """The mean of `pick(result)` over the seeds; nan where none is there."""
        values = []
        for seed in self.extent.seeds:
            result = self.results.get(f"{prefix}/{seed}/{suffix}")
            if result is not None:
                values.append(pick(result))
        return mean(values)

    # Table I

    def table1(self, style):
        columns = ("SC", "RRR", "heat (paper)")
        header = ["KITTI", "outliers", "type", "method", "P", "R", "F", "ATE", "RMSE",
                  "printed P", "printed R", "printed F", "printed ATE"]
        rows = []
        for sequence, count in KITTI.items():
            for kind in TYPES:
                printed = TABLE1[sequence, kind]
                for method in PRUNING:
                    row = [sequence, str(count), kind, method]
                    for key in ("precision", "recall", "f1", "ate", "rmse"):
                        row.append(shown(self.pruning(style, sequence, kind, method, key),
                                         3 if key in ("precision", "recall", "f1") else 2))
                    if method in columns:
                        row += [shown(figure[columns.index(method)]) for figure in printed]
                    else:
                        row += ["", "", "", ""]
                    rows.append(row)
        return table(header, rows)

    def pruning(self, style, sequence, kind, method, key):
        return self.mean_over_seeds(f"table1/{sequence}/{style}/{kind}", method,
                                    lambda result: result[key])

    def konst_table(self, style):
        """F of the paper's method a konst, which shows what hindsight is worth."""
        rows = []
        for sequence in KITTI:
            for kind in TYPES:
                prefix = f"table1/{sequence}/{style}/{kind}"
                values = [self.mean_over_seeds(prefix, "konst", lambda r, k=konst: r[str(k)])
                          for konst in range(5)]
                rows.append([sequence, kind, *(shown(value, 3) for value in values),
                             shown(TABLE1[sequence, kind][2][2])])
        return table(["KITTI", "type", *(f"konst {k}" for k in range(5)), "printed F"], rows)

    def readings_table(self):
        """Cells of Table I that reach the printed F, and the mean F, a reading and a style."""
        rows = []
        for reading in READINGS:
            row = list(reading)
            for style in self.extent.styles:
                found = [(self.reading(style, *cell, " ".join(reading)), TABLE1[cell][2][2])
                         for cell in ((s, kind) for s in KITTI for kind in TYPES)]
                reached = sum(value >= printed - ROUNDING for value, printed in found)
                row += [f"{reached} of {len(found)}", shown(mean([f for f, _ in found]), 3)]
            rows.append(row)
        header = ["scales", "loop weight", "initialisation"]
        for style in self.extent.styles:
            header += [f"{STYLE_NAMES[style]}: cells", "mean F"]
        return table(header, rows)

    def reading(self, style, sequence, kind, name):
        return self.mean_over_seeds(f"table1/{sequence}/{style}/{kind}", "readings",
                                    lambda result: result[name])

    def places_table(self):
        rows = []
        for sequence in KITTI:
            for method in PRUNING:
                prefix = f"places/{sequence}/{self.extent.candidates}"
                row = [sequence, method]
                for key in ("precision", "recall", "f1", "ate", "rmse", "seconds"):
                    row.append(shown(self.mean_over_seeds(prefix, method, lambda r, k=key: r[k]),
                                     3 if key in ("precision", "recall", "f1") else 2))
                rows.append(row)
        return table(["KITTI", "method", "P", "R", "F", "ATE", "RMSE", "CPU s"], rows)

    # Table II

    def table2(self, style, counts, key):
        """One row a cell: errors of every method, for the aligned RMSE the best marked."""
        printed = key == "ate" and style != "file"
        header = ["outliers", "type", *BICOCCA_COLUMNS]
        if printed:
            header += ["printed: DCS", "printed: theirs + DCS", "printed: Cauchy"]
        rows = []
        for count in counts:
            for kind in TYPES:
                values = self.bicocca_errors(style, kind, count, key)
                lowest = min(values)
                row = [str(count), kind]
                for value in values:
                    tied = key == "rmse" and value <= TIE * lowest
                    row.append(f"**{shown(value)}**" if tied else shown(value))
                if printed:
                    row += [shown(value) for value in TABLE2[count, kind]]
                rows.append(row)
        return table(header, rows)

    def bicocca_errors(self, style, kind, count, key):
        return [bicocca_error(self.results, self.extent, style, kind, count, column, key)
                for column in BICOCCA_COLUMNS]

    def verdict_table(self, style, counts):
        """Precision and recall on Bicocca, whose real loops are labelled by ground truth."""
        rows = []
        for count in counts:
            for kind in TYPES:
                row = [str(count), kind]
                for method in COMBINED:
                    row += [shown(self.verdicts(style, kind, count, method, key), 3)
                            for key in ("precision", "recall")]
                rows.append(row)
        header = ["outliers", "type"]
        for method in COMBINED:
            header += [f"{method.removesuffix(' + DCS')} P", "R"]
        return table(header, rows)

    def verdicts(self, style, kind, count, method, key):
        return mean([result[key] for result in bicocca_results(
            self.results, self.extent, style, kind, count, method)])

    # What the tables say

    def table1_wins(self, style):
        """Cells of Table I, cells where the F of consensus is at least the printed one,
        where it is at least 0.99, and where the F of the heat row is."""
        cells = [(sequence, kind) for sequence in KITTI for kind in TYPES]
        ours = {cell: self.pruning(style, *cell, "consensus", "f1") for cell in cells}
        heat = {cell: self.pruning(style, *cell, "heat (paper)", "f1") for cell in cells}
        printed = {cell: TABLE1[cell][2][2] for cell in cells}
        return (len(cells), sum(ours[cell] >= printed[cell] for cell in cells),
                sum(ours[cell] >= 0.99 for cell in cells),
                sum(heat[cell] >= printed[cell] - ROUNDING for cell in cells))

    def table2_wins(self, style, counts):
        """Cells of Table II, and cells where consensus, alone or with a kernel, is the best
        by aligned RMSE or tied with it: of the paper's methods, and of all."""
        names = list(BICOCCA_COLUMNS)
        wins = wins_of_all = cells = 0
        for count in counts:
            for kind in TYPES:
                errors = dict(zip(names, self.bicocca_errors(style, kind, count, "rmse")))
                ours = min(errors[name] for name in CONSENSUS)
                lowest = min(error for name, error in errors.items() if name != NOT_THE_PAPERS)
                cells += 1
                wins += ours <= TIE * lowest
                wins_of_all += ours <= TIE * min(lowest, errors[NOT_THE_PAPERS])
        return cells, wins, wins_of_all

    def table2_range(self, column, key="rmse"):
        """Least and largest aligned RMSE (or other error) of a column over Table II."""
        errors = [bicocca_error(self.results, self.extent, *cell, column, key)
                  for cell in self.table2_cells()]
        return min(errors), max(errors)

    def hindsight_range(self, method):
        """The same at the width with the lowest RMSE."""
        errors = [mean([with_best_width(result, "rmse")["rmse"] for result in bicocca_results(
            self.results, self.extent, *cell, method)]) for cell in self.table2_cells()]
        return min(errors), max(errors)

    def table2_cells(self):
        return [(style, kind, count) for style, counts in self.table2_parts()
                for count in counts for kind in TYPES]

    def table2_parts(self):
        """Styles of Table II, and the numbers of outliers in each."""
        return [("file", (44, 178)),
                *((style, self.printed_counts()) for style in self.extent.styles)]

    def printed_counts(self):
        return [count for count in PRINTED_COUNTS if count in self.extent.counts()]
