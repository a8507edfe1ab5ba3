"""Ready-made functions for the keyword `progress` of long calls."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, int, int], object]


class _Bars:
    """A bar for each stage, the last one open."""

    def __init__(self, options: dict[str, Any]) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError as error:
            raise ImportError("tqdm_progress() needs tqdm: pip install 'isotherm[tqdm]'") from error
        self._make: Any = tqdm
        self._options = options
        self._bar: Any = None
        self._stage: str | None = None

    def show(self, stage: str, done: int, total: int) -> None:
        if stage != self._stage:
            self.close()
            self._bar = self._make(total=total or None, desc=stage, **self._options)
            self._stage = stage
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


@contextmanager
def tqdm_progress(**options: Any) -> Iterator[Progress]:
    """Progress bars of tqdm, to be handed to a long call.

        with tqdm_progress() as progress:
            result = isotherm.slam.prune(graph, progress=progress)

    Args:
        options: keywords for tqdm, such as `leave=False`.
    """
    bars = _Bars(options)
    try:
        yield bars.show
    finally:
        bars.close()
