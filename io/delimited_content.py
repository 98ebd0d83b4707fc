"""The columns of a table without a header, told by what is in them."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from .delimited_cells import is_number_like
from .delimited_columns import Columns, numbered
from .errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["columns_by_content", "require_no_split_decimals"]


def columns_by_content(
    body: Sequence[Sequence[str]], count: int, decimal: str, *, is_scan: bool
) -> Columns:
    """Tell the columns by what is in them: PNEZD, PNEZ, or XYZ and more (always for a scan)."""
    is_text = [
        2 * sum(not is_number_like(row[i], decimal) for row in body) > len(body)
        for i in range(count)
    ]
    if count < 3 or sum(not text for text in is_text) < 3:
        raise ReadError(
            f"its {count} columns do not hold three of numbers: easting, northing and elevation "
            "are needed."
        )
    tail = next((i for i in range(3, count) if is_text[i]), None)
    may_be_numbered = count >= 4 and not any(is_text[1:4]) and not is_scan
    if may_be_numbered and _is_numbered(body, is_text, tail, decimal):
        roles = {"number": 0, "northing": 1, "easting": 2, "elevation": 3}
    elif not any(is_text[:3]):
        roles = {"easting": 0, "northing": 1, "elevation": 2}
    else:
        raise ReadError(
            "it has no header, and its columns are not those of a known layout: say with the "
            'option columns what they are, for example "PNEZD".'
        )
    description = next((i for i in range(max(roles.values()) + 1, count) if is_text[i]), None)
    if description is not None:
        roles["description"] = description
    names = {column: role for role, column in roles.items() if role in ("number", "description")}
    return Columns(numbered([names.get(i, "") for i in range(count)], count), roles)


def _is_numbered(
    body: Sequence[Sequence[str]], is_text: Sequence[bool], tail: int | None, decimal: str
) -> bool:
    """Whether the first column is point numbers: names, or whole numbers that ascend."""
    if is_text[0]:
        return True
    first = [row[0] for row in body]
    if not all(cell.isdecimal() for cell in first):
        return False
    numbers = [int(cell) for cell in first]
    if any(a >= b for a, b in pairwise(numbers)):
        return False
    if tail == 4 or any(decimal in cell for row in body for cell in row[1:4]):
        return True
    raise ReadError(
        "it has no header, and its first column may be point numbers or eastings: say with the "
        'option columns what they are, for example "PNEZ" or "XYZ".'
    )


def require_no_split_decimals(body: Sequence[Sequence[str]], delimiter: str) -> None:
    """Refuse rows that may be decimal commas split at a comma: 4,25,7,50 for 4.25 and 7.50."""
    if delimiter != "," or not body:
        return
    start = len(body[0]) - 6
    if start not in (0, 1) or not all(
        cell.lstrip("+-").isdecimal() for row in body for cell in row
    ):
        return
    widths = [{len(row[start + i]) for row in body} for i in (1, 3, 5)]
    if all(len(width) == 1 for width in widths) and widths[0] == widths[1] == widths[2]:
        raise ReadError(
            "its commas may be delimiters or decimal marks: say with the option columns what the "
            "columns are, or write the table with another delimiter."
        )
