"""Failures as sentences: whatever goes wrong, the user reads one line and no traceback.

Exit codes: 1 the data cannot do it, 2 wrong usage (click's own), 130 interrupted.
"""

from __future__ import annotations

import os
import warnings
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["Failure", "failures_as_sentences", "note_written"]

DEBUG = "TINSMITH_DEBUG"
"""Environment variable that, when set, lets every traceback through."""

_WRITTEN = "tinsmith.written"


class Failure(click.ClickException):
    """A sentence on stderr and exit code 1."""

    label = "Error: "

    def show(self, file: IO[Any] | None = None) -> None:
        """Write the sentence to stderr, or to ``file``."""
        label = click.style(self.label, fg="red", bold=True) if self.label else ""
        click.echo(f"{label}{self.format_message()}", file=file, err=file is None)


class Interruption(Failure):
    """The user pressed Ctrl-C; the exit code is 128 + SIGINT, as shells count."""

    exit_code = 130
    label = ""


def note_written(path: Path) -> None:
    """Remember that a file is complete, for the case that the user interrupts what follows."""
    click.get_current_context().find_root().meta.setdefault(_WRITTEN, []).append(str(path))


@contextmanager
def failures_as_sentences(ctx: click.Context) -> Iterator[None]:
    """Turn exceptions into :class:`Failure`, and warnings into one line each."""
    if os.environ.get(DEBUG):
        yield
        return
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            yield
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except KeyboardInterrupt:
            raise _interruption(ctx) from None
        except Exception as error:
            raise _failure(error) from error


def _interruption(ctx: click.Context) -> Interruption:
    written = ctx.find_root().meta.get(_WRITTEN, [])
    outcome = f"already written: {', '.join(written)}" if written else "nothing was written"
    return Interruption(f"Interrupted; {outcome}.")


def _failure(error: Exception) -> Failure:
    from ..tin import TinsmithError

    if isinstance(error, TinsmithError):
        return Failure(str(error))
    if isinstance(error, MemoryError):
        return Failure("There is not enough memory for so many points.")
    if isinstance(error, OSError) and error.strerror:
        where = f" '{error.filename}'" if error.filename else ""
        return Failure(f"The system refuses{where}: {error.strerror}.")
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return Failure(
        f"A bug in tinsmith: {what} (set {DEBUG}=1 to see the traceback, and please report it)."
    )


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    label = click.style("Warning: ", fg="yellow", bold=True)
    click.echo(f"{label}{' '.join(str(message).split())}", err=True)
