"""Which cells are measured by which methods: the whole experiment as one list."""

import dataclasses

from cells import STYLES, TYPES
from methods import HEAT, PRUNING

KITTI = {"00": 402, "06": 88}  # Table I: sequence and number of outliers
BICOCCA_LOOPS = 446
PRINTED_COUNTS = (44, 223, 312)  # Table II: 10, 50 and 70 % of the loops


@dataclasses.dataclass(frozen=True)
class Extent:
    seeds: tuple
    levels: tuple  # outliers in tenths of the loops of Bicocca
    widths: tuple  # of the kernels alone
    finishing_widths: tuple  # of DCS after pruning
    styles: tuple
    candidates: int  # recognised places taken a query

    def counts(self):
        """Outliers on Bicocca a level; the printed ones round down."""
        return tuple(BICOCCA_LOOPS * level // 10 for level in self.levels)


FEW_WIDTHS = (1, 2, 5, 10, 15, 19)
QUICK = Extent(seeds=(1,), levels=(1, 5, 7), widths=FEW_WIDTHS, finishing_widths=FEW_WIDTHS,
               styles=("paper",), candidates=2)
FULL = Extent(seeds=(1, 2, 3), levels=(1, 2, 3, 4, 5, 6, 7), widths=tuple(range(1, 21)),
              finishing_widths=FEW_WIDTHS, styles=STYLES, candidates=10)

# Methods of Table II, in its order; each is a function of a cell.
KERNELS = ("dcs", "cauchy")
COMBINED = {
    "heat (Lap-line) + DCS": (*HEAT, "--init", "lap-line"),
    "heat (χ²) + DCS": HEAT,
    "consensus": ("--method", "consensus"),
}
FINISHED_BY_CAUCHY = {"heat (χ²) + Cauchy": HEAT, "consensus + Cauchy": ("--method", "consensus")}


def kitti_tasks(graphs, measure, extent):
    tasks = {}
    for sequence, count in KITTI.items():
        for style in extent.styles:
            for kind in TYPES:
                for seed in extent.seeds:
                    cell = lambda s=sequence, st=style, k=kind, c=count, n=seed: \
                        graphs.kitti_cell(s, st, k, c, n)
                    key = f"table1/{sequence}/{style}/{kind}/{seed}"
                    for method in PRUNING:
                        tasks[f"{key}/{method}"] = \
                            lambda cell=cell, m=method: measure.pruning(cell(), m)
                    tasks[f"{key}/konst"] = lambda cell=cell: measure.heat_by_konst(cell())
                    tasks[f"{key}/readings"] = lambda cell=cell: measure.heat_by_reading(cell())
    return tasks


def place_tasks(graphs, measure, extent):
    tasks = {}
    for sequence in KITTI:
        for seed in extent.seeds:
            cell = lambda s=sequence, n=seed: graphs.place_cell(s, extent.candidates, n)
            for method in PRUNING:
                tasks[f"places/{sequence}/{extent.candidates}/{seed}/{method}"] = \
                    lambda cell=cell, m=method: measure.pruning(cell(), m)
    return tasks


def bicocca_cells(graphs, extent):
    """Key of a cell to a function that makes it."""
    cells = {}
    for kind in TYPES:
        for count in (44, 178):
            cells[f"file/{kind}/{count}/1"] = \
                lambda k=kind, c=count: graphs.bicocca_file(k, c)
        for style in extent.styles:
            for count in extent.counts():
                for seed in extent.seeds:
                    cells[f"{style}/{kind}/{count}/{seed}"] = \
                        lambda st=style, k=kind, c=count, n=seed: graphs.bicocca_cell(st, k, c, n)
    return cells


def bicocca_tasks(graphs, measure, extent):
    tasks = {}
    cells = bicocca_cells(graphs, extent)
    for key, cell in cells.items():
        for kernel in KERNELS:
            tasks[f"table2/{key}/{kernel}"] = lambda cell=cell, k=kernel: \
                measure.kernel(cell(), k, extent.widths)
        tasks[f"table2/{key}/reference"] = lambda cell=cell: measure.reference(cell())
    for name, flags in COMBINED.items():
        for key, cell in cells.items():
            tasks[f"table2/{key}/{name}"] = lambda cell=cell, f=flags: \
                measure.pruned_then_kernel(cell(), f, "dcs", extent.finishing_widths)
    for name, flags in FINISHED_BY_CAUCHY.items():
        for key, cell in cells.items():
            tasks[f"table2/{key}/{name}"] = lambda cell=cell, f=flags: \
                measure.pruned_then_default(cell(), f, "cauchy")
    return tasks


def all_tasks(graphs, measure, extent):
    """Key of a result to the function that measures it; independent of each other."""
    return {**kitti_tasks(graphs, measure, extent), **place_tasks(graphs, measure, extent),
            **bicocca_tasks(graphs, measure, extent)}
