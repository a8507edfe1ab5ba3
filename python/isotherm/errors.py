"""What goes wrong, as exceptions."""


class Error(Exception):
    """Base of what this package raises on purpose."""


class InvalidArgument(Error, ValueError):
    """An argument or option is outside its range."""

    option: str = ""
    """Name of the argument or option."""


class ParseError(Error, ValueError):
    """Input that cannot be understood. Lines and columns count from 1; 0: the whole of it."""

    path: str = ""
    line: int = 0
    column: int = 0
    token: str = ""
    """What stands there."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""

    path: str = ""


class NumericalError(Error, ArithmeticError):
    """A computation that cannot give a usable value."""

    stage: str = ""
    """Name of the computation."""


class Cancelled(Error):
    """A progress function returned False."""
