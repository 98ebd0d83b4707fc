"""The console: summaries for people on stderr, results on stdout."""

from __future__ import annotations

import json
import math
import shutil
import sys
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import click

from ..command import name_flags
from .events import send_event
from .failures import Failure, note_answer
from .progress import Steps
from .streams import escape_unprintable, silence, write_error

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from pathlib import Path

    from .facts import Facts

Row = tuple[str, str]
"""A label and what it says; further lines stand under the first."""

_LABEL_WIDTH = 11
_LAST = ("Written", "Time")
"""Labels of rows that stand behind all notes."""


@dataclass(frozen=True)
class Console:
    """How a command speaks."""

    quiet: bool = False
    """Leave out summary and progress; errors and results are still written."""
    as_json: bool = False
    """Write the result as JSON on stdout instead of for people."""
    events: bool = False
    """Write summary and progress as events, for programs."""
    notes: list[str] = field(default_factory=list, compare=False)
    """What is known of all that was read, which summary and record tell."""
    _reported: set[str] = field(default_factory=set, compare=False)
    """Those that a summary told."""

    def note(self, notes: Iterable[str]) -> None:
        """Take note of what whoever uses the answer should know."""
        self.notes[:] = dict.fromkeys([*self.notes, *notes])

    def steps(self) -> Steps:
        """Return the context in which long work shows its progress."""
        return Steps(quiet=self.quiet, events=self.events)

    @contextmanager
    def step(self, text: str) -> Iterator[Callable[[float], None]]:
        """Show one piece of long work; yields a function that takes the fraction done."""
        with self.steps() as steps, steps.step(text) as progress:
            yield progress

    def summarise(self, rows: Iterable[Row]) -> None:
        """Write a summary to stderr, with the notes."""
        if self.quiet:
            return
        rows = self._add_notes(rows)
        if not self.events:
            write_error(_format_rows(rows))
            return
        for label, text in rows:
            send_event("summary", label=label, text=name_flags(text))

    def answer(self, facts: Facts) -> None:
        """Write the result to stdout: lines for people, or a record as JSON; with the notes."""
        if self.as_json:
            self.emit_record(facts.values)
        else:
            self.emit(_format_rows(self._add_notes(facts.lines)))

    def emit_record(self, record: Mapping[str, Any]) -> None:
        """Write a record to stdout as JSON, with the notes among its own."""
        own = list(record.get("notes", ()))
        lacking = [note for note in self.notes if note not in own]
        self.emit(format_json({**record, "notes": own + lacking}))

    def _add_notes(self, rows: Iterable[Row]) -> list[Row]:
        """Return rows with the notes that they lack and nobody told yet, before the last ones."""
        shown = list(rows)
        self._reported.update(text for label, text in shown if label == "Note")
        lacking = [("Note", note) for note in self.notes if note not in self._reported]
        self._reported.update(self.notes)
        labels = [label for label, _ in shown]
        end = next((i for i, label in enumerate(labels) if label in _LAST), len(shown))
        return [*shown[:end], *lacking, *shown[end:]]

    def emit(self, text: str) -> None:
        """Write to stdout, to the last byte; fails where it cannot, such as on a full disk."""
        with _writing():
            note_answer()
            click.echo(text)
            sys.stdout.flush()


def emit_text(text: str) -> None:
    """Write to stdout, to the last byte, what is no result; fails as :meth:`Console.emit`."""
    with _writing():
        click.echo(text)
        sys.stdout.flush()


def emit_file(path: Path) -> None:
    """Copy a file to stdout, to the last byte; fails as :meth:`Console.emit`."""
    with _writing(), path.open("rb") as file:
        shutil.copyfileobj(file, sys.stdout.buffer)
        sys.stdout.buffer.flush()


@contextmanager
def _writing() -> Iterator[None]:
    """Let a block write to stdout, to the last byte."""
    if sys.stdout is None:
        raise Failure("Cannot write to standard output: it is closed.")
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        silence(sys.stdout)
        raise Failure(f"Cannot write to standard output: {error.strerror}.") from error


def _format_rows(rows: Iterable[Row]) -> str:
    indent = "\n" + " " * (_LABEL_WIDTH + 1)
    return "\n".join(
        click.style(f"{label:<{_LABEL_WIDTH}}", bold=True)
        + " "
        + indent.join(map(escape_unprintable, name_flags(text).split("\n")))
        for label, text in rows
    )


def format_json(record: Mapping[str, Any]) -> str:
    """Return a record as strict JSON: a number that is not finite becomes null."""
    return json.dumps(_replace_infinite(record), indent=2, allow_nan=False)


def _replace_infinite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _replace_infinite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_replace_infinite(item) for item in value]
    if hasattr(value, "item"):  # a number of numpy
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
