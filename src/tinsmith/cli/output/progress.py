"""Steps: what is being done and how far it is, shown on a terminal once it takes long."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from threading import Timer
from typing import TYPE_CHECKING

from .events import send_event

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import TracebackType
    from typing import Self

    from rich.progress import Progress

PATIENCE = 0.5
"""Seconds before anything is shown, so that short work does not flicker."""


def _ignore(fraction: float) -> None:
    """Take no notice."""


_FINENESS = 0.01
"""Of the work of a step: progress of less is no event."""


class Steps:
    """A context in which steps follow each other; what they showed vanishes with it.

    Nothing is shown if it is ``quiet``; ``events`` are sent in place of drawings.
    """

    def __init__(self, *, quiet: bool = False, events: bool = False) -> None:
        self._sends = events and not quiet
        is_shown = _is_terminal() and not (quiet or events)
        self._bar = _make_progress_bar() if is_shown else None
        self._is_shown = False
        self._timer = Timer(PATIENCE, self._show)
        self._timer.daemon = True

    def __enter__(self) -> Self:
        if self._bar is not None:
            self._timer.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._timer.cancel()
            self._timer.join()
            if self._is_shown:
                self._bar.stop()

    def _show(self) -> None:
        if self._bar is not None:
            self._is_shown = True
            self._bar.start()

    @contextmanager
    def step(self, description: str) -> Iterator[Callable[[float], None]]:
        """Show a step while it lasts; yields a function that takes the fraction done."""
        bar = self._bar
        if bar is None:
            yield _send_step(description) if self._sends else _ignore
            return
        task = bar.add_task(description, total=None)
        try:
            yield lambda fraction: bar.update(task, total=1.0, completed=fraction)
        finally:
            bar.remove_task(task)


def _send_step(description: str) -> Callable[[float], None]:
    """Send that a step begins; return the function that sends how far it is."""
    sent = 0.0
    send_event("step", text=description, fraction=None)

    def send(fraction: float) -> None:
        nonlocal sent
        if fraction >= sent + _FINENESS or fraction >= 1.0 > sent:
            sent = fraction
            send_event("step", text=description, fraction=round(min(fraction, 1.0), 4))

    return send


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _make_progress_bar() -> Progress:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    return Progress(
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
