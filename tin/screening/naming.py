"""Names of rows of points: by point number, file and line, as people find them again."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

from ...base.types import RowSources

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...base.arrays import AnyArray
    from ..surface import TIN

NameRows: TypeAlias = Callable[["Sequence[int]"], str]
"""Names rows for a sentence."""


def write_number(value: Any) -> str:
    """Return a point number as text; an empty one for none.

    Examples
    --------
    >>> write_number(12), write_number(" 7A "), write_number(float("nan")), write_number(None)
    ('12', '7A', '', '')
    """
    is_none = value is None or (isinstance(value, float) and value != value)
    is_whole = isinstance(value, float) and not is_none and value.is_integer()
    return "" if is_none else str(int(value) if is_whole else value).strip()


def find_number(columns: Mapping[str, AnyArray], row: int) -> str:
    """Return the point number of a row as text, an empty one if it has none."""
    numbers = columns.get("number")
    if numbers is None or not 0 <= row < len(numbers):
        return ""
    return write_number(numbers[row])


def make_namer(tin: TIN) -> NameRows:
    """Return what names rows of a TIN: "point 14 (line 15 of 'a.csv')".

    By its point number, if it has one, and by the line of the file that it was read from, if that
    is known; else by its row, counted from 0.
    """
    columns, sources = tin.row_attributes, tin.report.row_sources

    def name(rows: Sequence[int]) -> str:
        return ", ".join(_name_row(int(row), columns, sources) for row in rows)

    return name


def _name_row(row: int, columns: Mapping[str, AnyArray], sources: RowSources | None) -> str:
    number = find_number(columns, row)
    file, line = ("", 0) if sources is None else sources.find(row)
    place = f"line {line} of '{file}'" if line else ""
    if number:
        return f"point {number}" + (f" ({place})" if place else "")
    return place or f"row {row}"
