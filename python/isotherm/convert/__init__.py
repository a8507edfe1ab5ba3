"""From and to what other packages have. Each function needs the package that it names."""

from isotherm.convert._evo import from_evo, to_evo
from isotherm.convert._gtsam import GtsamGraph, from_gtsam, to_gtsam
from isotherm.convert._networkx import from_networkx, to_networkx
from isotherm.convert._pandas import from_dataframe
from isotherm.convert._scipy import from_scipy, to_scipy

__all__ = [
    "GtsamGraph",
    "from_dataframe",
    "from_evo",
    "from_gtsam",
    "from_networkx",
    "from_scipy",
    "to_evo",
    "to_gtsam",
    "to_networkx",
    "to_scipy",
]
