"""The console: summaries for people on stderr, results on stdout."""

from __future__ import annotations

import json
import math
import os
import sys
from dataclasses import dataclass
from io import TextIOWrapper
from typing import TYPE_CHECKING, Any

import click

from .failures import Failure
from .steps import Steps

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["Console", "Field", "accept_any_text", "plain"]

Field = tuple[str, str]
"""A label and what it says; further lines stand under the first."""

_LABEL_WIDTH = 11


@dataclass(frozen=True)
class Console:
    """How a command speaks.

    Attributes
    ----------
    quiet : bool
        Leave out summary and progress; errors and results are still written.
    as_json : bool
        Write the result as JSON on stdout instead of for people.
    """

    quiet: bool = False
    as_json: bool = False

    def steps(self) -> Steps:
        """Return the context in which long work shows its progress."""
        return Steps(quiet=self.quiet)

    def summarise(self, fields: Iterable[Field]) -> None:
        """Write a summary to stderr."""
        if not self.quiet:
            click.echo(_lines(fields), err=True)

    def answer(self, fields: Iterable[Field], facts: Mapping[str, Any]) -> None:
        """Write the result to stdout: fields for people, or facts as JSON."""
        self.emit(plain(facts) if self.as_json else _lines(fields))

    def emit(self, text: str) -> None:
        """Write to stdout, to the last byte.

        Raises
        ------
        Failure
            If it cannot be written, for example to a full disk.
        """
        try:
            click.echo(text)
            sys.stdout.flush()
        except BrokenPipeError:
            raise
        except OSError as error:
            _drop_stdout()
            raise Failure(f"Cannot write to standard output: {error.strerror}.") from error


def _drop_stdout() -> None:
    """Send what is still buffered nowhere, or Python fails once more when it exits."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())


def _lines(fields: Iterable[Field]) -> str:
    indent = "\n" + " " * (_LABEL_WIDTH + 1)
    return "\n".join(
        click.style(f"{label:<{_LABEL_WIDTH}}", bold=True) + " " + text.replace("\n", indent)
        for label, text in fields
    )


def accept_any_text() -> None:
    """Let stdout and stderr escape letters that the terminal's encoding does not have."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def plain(facts: Mapping[str, Any]) -> str:
    """Return facts as strict JSON: a number that is not finite becomes null."""
    return json.dumps(_finite(facts), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
