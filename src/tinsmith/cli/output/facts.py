"""What a command found: one list of facts, rendered as lines for people and as a record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .counts import describe_counts, mesh_counts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from ...base.results import Units
    from ...terrain import Features
    from ...tin import TIN
    from .console import Row


class Facts:
    """Facts in their order, each with a line for people, values for programs, or both.

    ``files`` are what was read: ``input`` of the record, or ``inputs`` if there are several.
    """

    def __init__(self, *files: Path, **values: Any) -> None:
        names = [str(file) for file in files]
        self._rows: list[Row | Callable[[], Iterable[Row]]] = []
        self._notes: list[str] = []
        self._values: dict[str, Any] = {}
        if names:
            self.record(**{"input": names[0]} if len(names) == 1 else {"inputs": names})
        self.record(**values)

    def add(self, label: str, text: str, **values: Any) -> None:
        """Add a line with its label, and the values that it tells."""
        self._rows.append((label, text))
        self.record(**values)

    def add_tin(self, label: str, tin: TIN, **values: Any) -> None:
        """Add the counts of a TIN that was made, and what is recorded of it."""

        def describe() -> dict[str, Any]:
            from .summaries import describe_tin

            return describe_tin(tin)

        self.add(label, mesh_counts(tin), **{"tin": describe} | values)

    def add_surface(self, tin: TIN) -> None:
        """Add the counts of the surface that a product is of."""
        self.add("Surface", mesh_counts(tin))

    def extend(self, rows: Iterable[Row] | Callable[[], Iterable[Row]], **values: Any) -> None:
        """Add lines, or what makes them if they are wanted, and the values that they tell."""
        self._rows += [rows] if callable(rows) else rows
        self.record(**values)

    def record(self, **values: Any) -> None:
        """Add values without a line; a function is called only if the record is wanted."""
        self._values |= values

    def note(self, notes: Iterable[str]) -> None:
        """Add notes, which stand behind all lines, and in the record."""
        self._notes += notes

    @property
    def lines(self) -> list[Row]:
        """All lines, the notes last."""
        groups = (one() if callable(one) else [one] for one in self._rows)
        return [row for group in groups for row in group] + [("Note", one) for one in self._notes]

    @property
    def values(self) -> dict[str, Any]:
        """The record."""
        found = {name: one() if callable(one) else one for name, one in self._values.items()}
        return found | {"notes": [*found.get("notes", ()), *self._notes]}


def list_rows(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return columns as a record for each row."""
    values = [column.tolist() for column in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*values, strict=True)]


def name_units(units: Units, names: Iterable[str] | None = None) -> dict[str, str]:
    """Return the names of units, by column: of all columns that have one, or of those named."""
    from ...base.results import unit_text

    return {name: unit_text(units, name) for name in (units if names is None else names)}


def name_unit(units: Units, column: str) -> str:
    """Return the symbol of a column's unit for a sentence; "" for none, and if it is not known."""
    return "" if units.get(column, "") is None else name_units(units, [column])[column]


def describe_features(file: Path, tin: TIN, found: Features) -> Facts:
    """Return what there is to tell of features of a TIN: a record each, without geometry."""
    facts = Facts(file, found=lambda: list_rows(found.columns), units=name_units(found.units))
    facts.add("TIN", describe_counts(tin))
    facts.note(found.notes)
    return facts
