"""Failures as sentences: whatever goes wrong, the user reads one line and no traceback.

Exit codes: 1 the data cannot do it, 2 wrong usage (such as a value of an option that the library
refuses), 128 + n ended by signal n (130 is Ctrl-C). With
``--json`` the sentence is on stdout too, as an object.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import warnings
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

import click

from ..command import find_flag, find_given_flag, name_flags
from .events import has_flag, send_event, wants_events
from .streams import Terminated, escape_unprintable, silence, write_error

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from ...base.errors import OptionError

DEBUG = "TINSMITH_DEBUG"
"""Environment variable that, when set, lets every traceback through."""

_WRITTEN = "tinsmith.written"
_ANSWERED = "tinsmith.answered"


class Failure(click.ClickException):
    """A sentence on stderr and exit code 1."""

    label = "Error: "
    translated = ""
    """The sentence with flags in place of the library's names of options."""

    def format_message(self) -> str:
        """Return the sentence, on one line."""
        return escape_unprintable(self.translated or self.message)

    def show(self, file: IO[Any] | None = None) -> None:
        """Write the sentence to stderr, or to ``file``."""
        label = click.style(self.label, fg="red", bold=True) if self.label else ""
        text = f"{label}{self.format_message()}"
        if file is None:
            write_error(text)
        else:
            click.echo(text, file=file)


class Interruption(Failure):
    """A signal ended the program; the exit code is 128 + its number, as shells count."""

    label = ""

    def __init__(self, message: str, number: int) -> None:
        super().__init__(message)
        setattr(self, "exit_code", 128 + number)  # noqa: B010 - click has it as a constant


def note_written(path: Path) -> None:
    """Remember that a file is complete, for the case that the user interrupts what follows."""
    click.get_current_context().find_root().meta.setdefault(_WRITTEN, []).append(str(path))


def note_answer() -> None:
    """Remember that the result is on stdout, so that no second object follows it."""
    context = click.get_current_context(silent=True)
    if context is not None:
        context.find_root().meta[_ANSWERED] = True


def show_failure(error: click.ClickException, arguments: Sequence[str]) -> int:
    """Tell a failure on stderr, and on stdout if JSON is wanted there; return the exit code."""
    try:
        if has_flag("--events", arguments):
            send_event("error", text=error.format_message(), exit_code=error.exit_code)
        else:
            error.show()
    except OSError:
        silence(sys.stderr)
    if has_flag("--json", arguments) and not getattr(error, "is_answered", False):
        record = {"error": error.format_message(), "exit_code": error.exit_code}
        try:
            click.echo(json.dumps(record, indent=2))
            if sys.stdout is not None:
                sys.stdout.flush()
        except OSError:
            silence(sys.stdout)
    return error.exit_code


@contextmanager
def translate_failures(
    ctx: click.Context, find_owner: Callable[[], str] = lambda: "tinsmith"
) -> Iterator[None]:
    """Turn exceptions into :class:`Failure`, and warnings into one line each.

    ``find_owner`` tells whose fault an exception is that nobody expected.
    """
    if os.environ.get(DEBUG):
        yield
        return
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            yield
        except click.ClickException as error:
            raise _translate(error, ctx) from error.__cause__
        except (click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except (KeyboardInterrupt, Terminated) as ended:
            written = ctx.find_root().meta.get(_WRITTEN, [])
            outcome = f"already written: {', '.join(written)}" if written else "nothing was written"
            number = getattr(ended, "number", signal.SIGINT)
            failure = Interruption(f"Interrupted; {outcome}.", number)
            raise _translate(failure, ctx) from None
        except Exception as error:
            raise _translate(_make_failure(error, find_owner()), ctx) from error


def _translate(error: click.ClickException, ctx: click.Context) -> click.ClickException:
    """Return the error in the words of this command, and whether the result is on stdout."""
    if isinstance(error, Failure):
        error.translated = name_flags(error.message)
    error.is_answered = _ANSWERED in ctx.find_root().meta  # type: ignore[attr-defined]
    return error


def _make_failure(error: Exception, owner: str) -> click.ClickException:
    from ...base.errors import OptionError, TinsmithError, UnknownOptionError
    from ...base.optional import describe_missing

    if isinstance(error, ImportError):
        error = describe_missing(error) or error
    if isinstance(error, OptionError):
        return refuse_option(error)
    if isinstance(error, UnknownOptionError):
        return Failure(error.describe(find_flag))
    if isinstance(error, TinsmithError):
        return Failure(str(error))
    if isinstance(error, MemoryError):
        return Failure("There is not enough memory for so many points.")
    if isinstance(error, OSError) and error.strerror:
        where = f" '{error.filename}'" if error.filename else ""
        return Failure(f"The system refuses{where}: {error.strerror}.")
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return Failure(
        f"A bug in {owner}: {what} (set {DEBUG}=1 to see the traceback, and please report it)."
    )


def refuse_option(error: OptionError, **renamed: str) -> click.ClickException:
    """Return wrong usage, if the value was given on the command line, else a failure.

    ``renamed`` has parameters of the command for options that the library calls by another name.
    """
    found = find_given_flag(renamed.get(error.option, error.option))
    if found is None:
        return Failure(str(error))
    context, flag = found
    return click.UsageError(name_flags(error.describe(flag)), ctx=context)


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    report_warning(name_flags(" ".join(str(message).split())))


def report_warning(text: str) -> None:
    """Write a warning to stderr."""
    if wants_events():
        send_event("warning", text=text)
        return
    label = click.style("Warning: ", fg="yellow", bold=True)
    write_error(f"{label}{escape_unprintable(text)}")
