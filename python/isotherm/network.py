"""Sensor networks: find the nodes from ranges, and the ranges that are false."""

from isotherm._core.network import (
    Localized,
    Network,
    localize,
    read_positions,
    read_ranges,
    simulate_network,
    write_ranges,
)
from isotherm._core.spectral import Verdicts, read_verdicts

__all__ = [
    "Localized",
    "Network",
    "Verdicts",
    "localize",
    "read_positions",
    "read_ranges",
    "read_verdicts",
    "simulate_network",
    "write_ranges",
]
