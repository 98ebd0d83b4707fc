"""The cells of a column become an array: numbers if all of them are, else truths, else texts.

Every number is the float64 nearest to its text. A decimal number of at most 15 digits is an integer
below 2^53 over a power of ten up to 10^15: both are floats, so that their quotient is rounded once
(Clinger, "How to read floating point numbers accurately", 1990). Whole columns are read so, a digit
of every cell at a time; what is longer or has an exponent is read by Python, one by one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .cells import is_infinite, is_number, with_hyphen

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int8Array, Int64Array
    from .cell_bounds import CellBounds

_BLOCK_ROWS = 1 << 15
"""Rows at a time, whose numbers stay in the cache of a core."""
_LONGEST = 24
"""Letters of a number that is read with others; longer ones are read one by one."""
_EXACT_DIGITS = 15
_INTEGER_BITS = 63
_POWERS = 10.0 ** np.arange(_EXACT_DIGITS + 1)
_QUOTE, _SPACE, _ZERO, _MINUS, _PLUS = b'" 0-+'
_TRUTHS = {
    **dict.fromkeys(("True", "TRUE", "true"), True),
    **dict.fromkeys(("False", "FALSE", "false"), False),
}


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """What is in a column."""

    values: Float64Array
    """(n,), NaN where a cell is no number."""
    is_text: bool = False
    """Whether most cells are no numbers."""
    is_whole: bool = False
    """Whether all numbers are whole, none below zero, and written without a decimal mark."""
    is_padded: bool = False
    """Whether numbers have leading zeros."""
    text_share: float = 0.0
    """Of the cells, those that are no numbers and not empty."""
    distinct_share: float = 1.0
    """Of the values, those that differ."""
    text: str = ""
    """The first cell of a column of text."""

    @property
    def counts_rows(self) -> bool:
        """Whether the values are whole and grow by one from row to row."""
        return self.is_whole and bool((np.diff(self.values) == 1.0).all())

    def without(self, nodata: Float64Array) -> Column:
        """Return the same column with NaN in the place of values that stand for no data."""
        if not np.isin(self.values, nodata).any():
            return self
        return replace(self, values=np.where(np.isin(self.values, nodata), np.nan, self.values))


class _Digits(NamedTuple):
    """Cells as integers and the number of their decimals; which are empty, and which are odd."""

    integers: Int64Array
    decimals: Int8Array
    is_negative: BoolArray
    has_point: BoolArray
    is_empty: BoolArray
    is_odd: BoolArray


def parse_column(
    bounds: CellBounds, column: int, *, decimal: str, is_text: bool = False
) -> AnyArray:
    """Read the cells of a column.

    Parameters
    ----------
    bounds : CellBounds
    column : int
    decimal : str
        Decimal mark, "." or ",".
    is_text : bool, optional
        Whether to keep texts, whatever they look like.

    Returns
    -------
    (n,) array
        int64 if every cell is a whole number that fits; float64 if every one is a number or empty
        (NaN); bool if every one is true or false; else texts (object), without the spaces before
        them.
    """
    if not is_text:
        numbers = _parse_numbers(bounds, column, decimal)
        if numbers is not None:
            return numbers
    texts = _take_texts(bounds, *_find_cells(bounds, column, slice(None)))
    if not is_text and all(text in _TRUTHS for text in texts):
        return np.array([_TRUTHS[text] for text in texts], np.bool_)
    values = np.empty(len(texts), object)
    values[:] = texts
    return values


def _find_cells(bounds: CellBounds, column: int, rows: slice) -> tuple[Int64Array, Int64Array]:
    """Return where cells begin behind their leading spaces, and where they end."""
    codes = np.frombuffer(bounds.data, np.uint8)
    starts, ends = bounds.before[rows, column] + 1, bounds.ends[rows, column]
    while True:
        is_space = (starts < ends) & (codes.take(starts, mode="clip") == _SPACE)
        if not is_space.any():
            return starts, ends
        starts += is_space


def _take_texts(bounds: CellBounds, starts: Int64Array, ends: Int64Array) -> list[str]:
    """Return cells as texts, without their quotes."""
    if len(starts) == 0:
        return []
    first = int(starts[0])
    data = bounds.data[first : int(ends[-1])]
    pairs = zip((starts - first).tolist(), (ends - first).tolist(), strict=True)
    if data.isascii():
        whole = data.decode("ascii")
        texts = [whole[start:end] for start, end in pairs]
    else:
        texts = [data[start:end].decode() for start, end in pairs]
    if b'"' not in data:
        return texts
    return [text[1:-1].replace('""', '"') if text[:1] == '"' else text for text in texts]


# ------------------------------------------------------------------ numbers


def _parse_numbers(bounds: CellBounds, column: int, decimal: str) -> AnyArray | None:
    """Return a column as numbers, None if a cell is none."""
    n = len(bounds)
    floats = np.empty(n)
    integers: Int64Array | None = np.empty(n, np.int64)
    for start in range(0, n, _BLOCK_ROWS):
        rows = slice(start, start + _BLOCK_ROWS)
        starts, ends = _find_cells(bounds, column, rows)
        digits = _read_digits(bounds.data, starts, ends, ord(decimal))
        floats[rows] = _divide(digits)
        whole = _take_whole(digits) if integers is not None else None
        odd = np.flatnonzero(digits.is_odd)
        for k, cell in zip(odd.tolist(), _take_texts(bounds, starts[odd], ends[odd]), strict=True):
            text = with_hyphen(cell.strip())
            number = _read_number(text, decimal)
            if number is None:
                return None
            floats[start + k] = float(text) if isinstance(number, int) else number  # keeps -0.0
            whole = _place_whole(whole, k, number)
        if whole is None:
            integers = None
        elif integers is not None:
            integers[rows] = whole
    return floats if integers is None else integers


def _divide(digits: _Digits) -> Float64Array:
    """Return the cells that are not odd as floats, NaN for empty ones."""
    values = digits.integers / _POWERS.take(digits.decimals, mode="clip")
    np.negative(values, out=values, where=digits.is_negative)
    values[digits.is_empty] = np.nan
    return values


def _take_whole(digits: _Digits) -> Int64Array | None:
    """Return the cells as integers if all that are not odd are whole, None otherwise."""
    if digits.is_empty.any() or (digits.has_point & ~digits.is_odd).any():
        return None
    return np.where(digits.is_negative, -digits.integers, digits.integers)


def _place_whole(whole: Int64Array | None, row: int, number: float) -> Int64Array | None:
    """Put one number among integers if it is one."""
    if whole is None or not isinstance(number, int):
        return None
    whole[row] = number
    return whole


def _read_number(text: str, decimal: str) -> float | None:
    """Return the int or the nearest float of a cell, NaN for an empty one, None for a text."""
    if not text:
        return float("nan")
    if not is_number(text, decimal):
        return float(text) if is_infinite(text) else None
    if text.lstrip("+-").isdecimal():
        number = int(text)
        return number if number.bit_length() <= _INTEGER_BITS else None
    return float(text.replace(decimal, "."))


def _read_digits(data: bytes, starts: Int64Array, ends: Int64Array, mark: int) -> _Digits:
    """Read cells as digits with one decimal mark and a sign; what is anything else is odd."""
    codes = np.frombuffer(data, np.uint8)
    n = len(starts)
    first = codes.take(starts, mode="clip")
    lengths = ends - starts
    is_empty = lengths == 0
    is_negative = (first == _MINUS) & ~is_empty
    is_signed = is_negative | ((first == _PLUS) & ~is_empty)
    integers = np.zeros(n, np.int64)
    n_digits, decimals = np.zeros(n, np.int8), np.zeros(n, np.int8)
    n_points = np.zeros(n, np.int8)
    longest = min(int(lengths.max(initial=0)), _LONGEST)
    for place in range(longest):
        at = starts + place
        digit = codes.take(at, mode="clip") - np.uint8(_ZERO)
        is_inside = at < ends
        is_digit = (digit <= 9) & is_inside
        n_points += (digit == np.uint8((mark - _ZERO) % 256)) & is_inside
        np.copyto(integers, integers * 10 + digit, where=is_digit)
        n_digits += is_digit
        decimals += is_digit & (n_points > 0)
    is_odd = (n_digits + n_points + is_signed != lengths) | (n_points > 1) | (n_digits == 0)
    is_odd |= n_digits > _EXACT_DIGITS
    return _Digits(integers, decimals, is_negative, n_points > 0, is_empty, is_odd & ~is_empty)
