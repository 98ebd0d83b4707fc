"""What speaks against x, y, z in columns of numbers that nobody has named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from .parsing import Column

__all__ = ["are_angles_in_parts", "find_doubt", "have_no_elevations"]

_FEW_ROWS = 4
_SOME = 4_096
_SAME_STEP = 1e-6
_MOST_DIGITS = 6
_WRITTEN = 1e-4
"""Of the last decimal, how far a number may be from what is written with so many."""
_MOST_DEGREES, _MOST_MINUTES = 360.0, 60.0
_FEW_DEGREES = 3
_SHARE_OF_NUMBERS = 0.9


def find_doubt(columns: Sequence[Column]) -> str:
    """Say why the first three columns may not be x, y, z; "" if nothing speaks against it.

    Parameters
    ----------
    columns : sequence of Column
        At least three, the first three of numbers.
    """
    some = [_take_some(column) for column in columns[:4]]
    first, second, third = some[:3]
    if len(first) < _FEW_ROWS:
        return ""
    are_divided = [_count_digits(values) > 0 for values in some[:3]]
    is_scattered = _is_distinct(first) or _is_distinct(second)  # and no grid
    if _has_one_step(columns[0].values) and not _has_one_step(columns[1].values):
        step = columns[0].values[1] - columns[0].values[0]
        return (
            f"its first column grows by {step:.10g} from row to row, as numbers, distances and "
            "times do"
        )
    if is_scattered and are_divided[1:] == [True, True] and not are_divided[0]:
        return "its first column may be point numbers: all are whole, and the others have decimals"
    if are_divided == [True, True, False] and _is_monotone(columns[2].values):
        return "its third column may be point numbers: they are whole, and the others have decimals"
    if is_scattered and _count_digits(first) < _count_digits(second) == _count_digits(third):
        return "its first column has fewer decimals than the others, as no coordinate has"
    if len(some) == 4 and _is_monotone(columns[0].values) and _has_better_elevation(columns):
        return (
            "its first column grows from row to row, and its fourth is flatter than the third, so "
            "that easting and northing may be the second and third"
        )
    return ""


def have_no_elevations(columns: Sequence[Column]) -> bool:
    """Whether the last of coordinates may be numbers or codes: whole, and the others divided.

    A grid may have such elevations.
    """
    some = [_take_some(column) for column in columns]
    if len(some[0]) < _FEW_ROWS or columns[2].is_text:
        return False
    digits = [_count_digits(values) for values in some]
    is_scattered = _is_distinct(some[0]) and _is_distinct(some[1])
    return min(digits[:2]) > 0 and digits[2] == 0 and is_scattered


def are_angles_in_parts(columns: Sequence[Column]) -> bool:
    """Whether columns may be degrees, minutes and seconds, or degrees and minutes, twice."""
    for start in (0, 1):
        for size in (3, 2):
            parts = columns[start : start + 2 * size]
            is_whole = len(parts) == 2 * size and len(columns) > 2 * size + start - (size == 3)
            if is_whole and all(_is_angle(parts[k : k + size]) for k in (0, size)):
                return True
    return False


def _is_angle(columns: Sequence[Column]) -> bool:
    """Whether columns are whole degrees, whole minutes if seconds follow, and less than sixty."""
    if any(column.is_text for column in columns):
        return False
    degrees, *parts = (_take_some(column) for column in columns)
    if len(degrees) < 2 or any(len(one) == 0 for one in parts):
        return False
    are_degrees = _count_digits(degrees) == 0 and np.abs(degrees).max() <= _MOST_DEGREES
    are_near = len(np.unique(degrees)) <= _FEW_DEGREES
    are_parts = all(((one >= 0) & (one < _MOST_MINUTES)).all() for one in parts)
    are_whole = all(_count_digits(one) == 0 for one in parts[:-1])
    return bool(are_degrees and are_near and are_parts and are_whole and _count_digits(parts[-1]))


def _take_some(column: Column) -> Float64Array:
    values = column.values[:: max(1, len(column.values) // _SOME)]
    return values[np.isfinite(values)]


def _count_digits(values: Float64Array) -> int:
    """Return with how many decimals numbers are written."""
    for digits in range(_MOST_DIGITS):
        scaled = values * 10.0**digits
        with np.errstate(invalid="ignore", over="ignore"):
            if (np.abs(scaled - np.round(scaled)) < _WRITTEN).all():
                return digits
    return _MOST_DIGITS


def _is_distinct(values: Float64Array) -> bool:
    return len(np.unique(values)) >= _SHARE_OF_NUMBERS * len(values)


def _has_one_step(values: Float64Array) -> bool:
    steps = np.diff(values)
    if len(steps) < _FEW_ROWS - 1 or not np.isfinite(steps).all() or steps[0] == 0.0:
        return False
    rounding = 4.0 * np.finfo(np.float64).eps * np.abs(values).max()
    return bool((np.abs(steps - steps[0]) <= _SAME_STEP * abs(steps[0]) + rounding).all())


def _is_monotone(values: Float64Array) -> bool:
    steps = np.diff(values)
    return bool((steps > 0).all() or (steps < 0).all())


def _has_better_elevation(columns: Sequence[Column]) -> bool:
    """Whether the fourth column is a flatter surface over the two before than the third is."""
    if columns[3].is_text:
        return False
    table = np.column_stack([column.values for column in columns[:4]])
    table = table[np.isfinite(table).all(axis=1)]
    if len(table) < _FEW_ROWS or _count_digits(table[:, 3]) == 0:
        return False
    span = np.ptp(table, axis=0)
    return bool(span[3] * np.hypot(span[0], span[1]) < span[2] * np.hypot(span[1], span[2]))
