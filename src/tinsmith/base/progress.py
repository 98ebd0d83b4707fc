"""Progress: the fraction of a long call that is done, told to a function of the caller's."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from .errors import OptionError

Tell: TypeAlias = Callable[[float], None]
"""Takes a fraction from 0 to 1."""


class Progress:
    """The fractions of a call's stages as one that ascends, and ends with 1.0.

    Parameters
    ----------
    report : callable or None
        Called with each fraction that is larger than the last; None takes no notice. What it raises
        is passed on.

    Raises
    ------
    OptionError
        If it is neither.

    Examples
    --------
    >>> seen = []
    >>> progress = Progress(seen.append)
    >>> triangulating = progress.stage(0.2, 0.6)
    >>> triangulating(0.5)
    >>> progress(0.6)
    >>> progress.end()
    >>> seen
    [0.4, 0.6, 1.0]
    """

    def __init__(self, report: Tell | None) -> None:
        if report is not None and not callable(report):
            raise OptionError("progress", report, "a function of the fraction done", or_none=True)
        self._report = report
        self._reported = 0.0
        self._raised: BaseException | None = None

    def __call__(self, fraction: float) -> None:
        """Tell a fraction below 1, if it is larger than the last."""
        if self._report is not None and self._reported < fraction < 1.0:
            self._reported = fraction
            self._call(fraction)

    def end(self) -> None:
        """Tell that all is done."""
        self._call(1.0)

    def _call(self, fraction: float) -> None:
        if self._report is None:
            return
        try:
            self._report(fraction)
        except BaseException as error:
            self._raised = error
            raise

    @contextmanager
    def passing_on(self) -> Iterator[None]:
        """Raise what the function raised within the block, whatever others make of it there."""
        try:
            yield
        except BaseException as error:
            if self._raised in (None, error):
                raise
            raise self._raised from None

    def stage(self, start: float, end: float) -> Tell | None:
        """Return the function that a stage tells its own fraction; None if nobody listens."""
        if self._report is None:
            return None
        return lambda fraction: self(start + (end - start) * fraction)
