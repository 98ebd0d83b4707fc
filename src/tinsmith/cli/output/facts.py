"""What a command found: one list of facts, rendered as lines for people and as a record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.results.columns import unit_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from ...base.results.columns import Units
    from .console import Row

__all__ = ["Facts", "list_rows", "name_units"]


class Facts:
    """Facts in their order, each with a line for people, values for programs, or both.

    Parameters
    ----------
    *files : path-like
        What was read: ``input`` of the record, or ``inputs`` if there are several.
    """

    def __init__(self, *files: Path) -> None:
        names = [str(file) for file in files]
        self.rows: list[Row] = []
        self.notes: list[str] = []
        self._values: dict[str, Any] = {"input": names[0]} if len(names) == 1 else {"inputs": names}

    def add(self, label: str, text: str, **values: Any) -> None:
        """Add a line with its label, and the values that it tells."""
        self.rows.append((label, text))
        self.record(**values)

    def extend(self, rows: Iterable[Row]) -> None:
        """Add lines whose values the record has already, or has not."""
        self.rows += rows

    def record(self, **values: Any) -> None:
        """Add values without a line; a function is called only if the record is wanted."""
        self._values |= values

    def note(self, notes: Iterable[str]) -> None:
        """Add notes, which stand behind all lines, and in the record."""
        self.notes += notes

    @property
    def lines(self) -> list[Row]:
        """All lines, the notes last."""
        return [*self.rows, *(("Note", note) for note in self.notes)]

    @property
    def values(self) -> dict[str, Any]:
        """The record."""
        found = {name: one() if callable(one) else one for name, one in self._values.items()}
        return found | {"notes": [*found.get("notes", ()), *self.notes]}


def list_rows(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return columns as a record for each row."""
    values = [column.tolist() for column in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*values, strict=True)]


def name_units(units: Units, names: Iterable[str] | None = None) -> dict[str, str]:
    """Return the names of units, by column: of all columns that have one, or of those named."""
    return {name: unit_text(units, name) for name in (units if names is None else names)}
