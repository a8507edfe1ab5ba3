"""Packages that need not be installed."""

from importlib import import_module
from typing import Any


def needed(module: str, function: str) -> Any:
    """The module, or an ImportError that says what to install for `function`."""
    package = module.partition(".")[0]
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(f"{function}() needs {package}: pip install 'isotherm[{package}]'") from error
