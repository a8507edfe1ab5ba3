"""Finds and removes the edges that do not belong in a geometric graph.

The modules follow the layers of the C++ library: `spectral` for graphs, `geometry` for points
and curves, `network` for sensor networks, `slam` for pose graphs.
"""

from isotherm import geometry, network, slam, spectral
from isotherm._core import version
from isotherm.errors import (
    Cancelled,
    Error,
    FileError,
    InvalidArgument,
    NumericalError,
    ParseError,
)
from isotherm.progress import tqdm_progress

__version__ = version()

__all__ = [
    "Cancelled",
    "Error",
    "FileError",
    "InvalidArgument",
    "NumericalError",
    "ParseError",
    "__version__",
    "geometry",
    "network",
    "slam",
    "spectral",
    "tqdm_progress",
]
