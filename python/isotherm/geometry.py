"""Points and curves: neighbour graphs, alignment, descriptors."""

from isotherm._core.geometry import (
    CurveDescriptor2,
    CurveDescriptor3,
    PointAlignment,
    align_points,
    lap_lines,
    nearest_neighbour_graph,
    radius_graph,
    read_points,
)

__all__ = [
    "CurveDescriptor2",
    "CurveDescriptor3",
    "PointAlignment",
    "align_points",
    "lap_lines",
    "nearest_neighbour_graph",
    "radius_graph",
    "read_points",
]
