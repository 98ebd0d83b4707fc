"""The order of the shots along lines: doubted where numbers are repeated, or lines jump."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import LinesError
from ...base.sentences import coordinate, counted

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...tin import Survey
    from .detection import Reading
    from .figures import Figure

_MANY_TIMES = 10.0
"""So many times as long as the others of its line a segment is a jump."""

_FEWEST = 4
"""Segments of a line of which one can be said to be long."""


def require_one_order(survey: Survey, by_number: Reading, by_row: Reading) -> None:
    """Refuse lines whose order of shots is open: of repeated numbers, or with jumps.

    Raises
    ------
    LinesError
        Unless the order of numbers and that of rows make the same lines: if numbers are repeated,
        such as those of two crews, or a line jumps in one of the orders alone. In any case if the
        shots of a code without a mark are groups far apart.
    """
    _require_single_numbers(survey, by_number, by_row)
    _require_no_jump(survey.points, by_number, by_row)


def _require_single_numbers(survey: Survey, by_number: Reading, by_row: Reading) -> None:
    numbers = survey.attributes.get("number")
    shots = sorted({row for one in by_number.figures for row in one.rows})
    if numbers is None or not shots:
        return
    _, first, count = np.unique(numbers[shots], return_index=True, return_counts=True)
    if (count == 1).all() or _list_keys(by_number) == _list_keys(by_row):
        return
    number = numbers[shots][first[np.argmax(count > 1)]]
    raise LinesError(
        f"{counted(int((count > 1).sum()), 'number')} of shots along lines "
        f"{'is' if (count > 1).sum() == 1 else 'are'} repeated (first: {number}), and lines in the "
        "order of numbers are others than in that of rows: the option `shot_order` says which is "
        "right, number or row; files of their own are read one by one."
    )


def _list_keys(reading: Reading) -> set[tuple[object, ...]]:
    return {one.key for one in reading.figures}


def _require_no_jump(points: Float64Array, by_number: Reading, by_row: Reading) -> None:
    other = {(one.name, frozenset(one.rows)): one for one in by_row.figures}
    for figure in by_number.figures:
        twin = other.get((figure.name, frozenset(figure.rows)), figure)
        here, there = (find_jump(points, one) for one in (figure, twin))
        if (here is None) != (there is None):
            jumps, smooth = ("numbers", "rows") if there is None else ("rows", "numbers")
            raise LinesError(
                f"The line {figure.name} jumps in the order of {jumps} and not in that of "
                f"{smooth}: the option `shot_order` says which is right, number or row."
            )
        if here is not None and not figure.marks and _are_groups(points, figure):
            length = coordinate(float(_measure(points, figure).max()))
            raise LinesError(
                f"The {len(figure.rows)} shots of the code {figure.name} have no mark to begin or "
                f"end a line, and lie in groups {length} apart: a code table says that they are "
                "points, marks make lines of them, or the option `shot_order` says that they are "
                "one line."
            )


def find_jump(points: Float64Array, figure: Figure) -> tuple[int, int] | None:
    """Return the rows between which a line jumps, on its longest segment; None if it does not."""
    lengths = _measure(points, figure)
    if not _find_long(lengths).any():
        return None
    longest = int(np.argmax(lengths))
    return figure.rows[longest], figure.rows[longest + 1]


def _find_long(lengths: Float64Array) -> BoolArray:
    """Return which segments of a line are many times as long as most others."""
    real = lengths[lengths > 0]
    if len(real) < _FEWEST:
        return np.zeros(len(lengths), np.bool_)
    usual = float(np.median(np.sort(real)[:-1]))
    return np.asarray(lengths > _MANY_TIMES * usual)


def _are_groups(points: Float64Array, figure: Figure) -> bool:
    """Whether the long segments of a line that jumps are many times as long as all others."""
    lengths = _measure(points, figure)
    is_long = _find_long(lengths)
    return bool(lengths[is_long].min() > _MANY_TIMES * lengths[~is_long].max())


def _measure(points: Float64Array, figure: Figure) -> Float64Array:
    """Return the lengths between shots along a line, in the plane."""
    steps = np.diff(points[figure.rows, :2], axis=0)
    return np.asarray(np.hypot(*steps.T))
