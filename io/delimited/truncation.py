"""A last line without an end, whose last number may have been cut off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from .cells import is_number, split_line
from .table import Fault, Table

if TYPE_CHECKING:
    from .columns import Columns
    from .layout import Layout
    from .lines import TextLines

__all__ = ["leave_out_cut_row"]

_LOOKED_AT = 200
"""Rows above the last one whose decimals are counted."""

_FEWEST = 3
"""Rows that show how many decimals a file has."""


def leave_out_cut_row(
    table: Table, lines: TextLines, layout: Layout, columns: Columns, *, skip_bad: bool
) -> tuple[Table, list[str]]:
    """Leave out a last row whose last number lacks decimals that all others have.

    Parameters
    ----------
    table : Table
    lines : TextLines
    layout : Layout
    columns : Columns
    skip_bad : bool
        Whether bad rows are left out.

    Returns
    -------
    table : Table
    notes : list of str
        Tell where others have several numbers of decimals, so that nothing is certain.

    Raises
    ------
    ReadError
        If there is such a row, and bad rows are not to be left out.
    """
    last = len(lines) - 1
    if lines.is_whole or len(table.rows) <= _FEWEST or table.rows[-1] != last:
        return table, []
    cells = split_line(lines.decode_line(last), layout.delimiter)
    column = len(cells) - 1
    own = _count_decimals(cells, column, layout.decimal)
    if column not in columns.coordinates or own is None:
        return table, []
    above = table.rows[-1 - _LOOKED_AT : -1].tolist()
    texts = (split_line(text, layout.delimiter) for text in lines.decode_lines(above))
    counts = {_count_decimals(row, column, layout.decimal) for row in texts} - {None}
    fewest = min((count for count in counts if count is not None), default=0)
    if own >= fewest:
        return table, []
    what = f"its last number '{cells[column][:40]}' has {counted(own, 'decimal')}"
    if len(counts) > 1:
        return table, [
            f"Line {last + 1}, the last, has no end, and {what}, fewer than all above: if the file "
            "was cut off, the number is not whole."
        ]
    if not skip_bad:
        raise ReadError(
            f"{FILE}, line {last + 1}: {what}, those above have {fewest}, and the line has no "
            "end: the file may be truncated; the option `skip_bad` leaves the row out.",
            lines=[last + 1],
        )
    return _drop_last(table, Fault(last, "number", f"{what} and may be cut off")), []


def _count_decimals(cells: list[str], column: int, decimal: str) -> int | None:
    """Return how many decimals a cell has; None if it is no plain number."""
    cell = cells[column] if column < len(cells) else ""
    if not is_number(cell, decimal) or "e" in cell.lower():
        return None
    return len(cell.partition(decimal)[2])


def _drop_last(table: Table, fault: Fault) -> Table:
    return table._replace(
        points=table.points[:-1],
        attributes={name: values[:-1] for name, values in table.attributes.items()},
        rows=table.rows[:-1],
        faults=tuple(sorted((*table.faults, fault))),
    )
