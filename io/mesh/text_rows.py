"""Rows of words and numbers in text meshes, with the lines of the file that they stand in."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from ...errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...arrays import AnyArray, Float64Array, Int64Array

__all__ = [
    "describe_row_fault",
    "parse_floats",
    "parse_integer_columns",
    "parse_integers",
    "split_rows",
]

_SHOWN_LETTERS = 60
_MOST_DIGITS = 18
"""Digits of a number that 64 bits hold whatever they are."""


def split_rows(content: bytes, *, comment: str = "#") -> tuple[list[str], list[int]]:
    """Cut a text into rows, and tell the line of each, from 1 on.

    Parameters
    ----------
    content : bytes
    comment : str
        What begins a comment, which lasts to the end of its line.

    Returns
    -------
    rows : list of str
        Those that are not empty, without comments and the spaces about them.
    lines : list of int
    """
    text = content.decode("utf-8", errors="replace").removeprefix("\ufeff")
    every = text.split("\n")
    if comment in text:
        every = [line.partition(comment)[0] for line in every]
    every = [line.strip() for line in every]
    lines = [number for number, line in enumerate(every, start=1) if line]
    return (every if len(lines) == len(every) else [line for line in every if line]), lines


def parse_floats(
    rows: Sequence[str], lines: Sequence[int], path: Path, *, columns: slice, what: str
) -> Float64Array:
    """Return the numbers in some columns of rows.

    Parameters
    ----------
    rows : sequence of str
    lines : sequence of int
        The line of each row.
    path : Path
    columns : slice
        With a start and a stop.
    what : str
        What a row must hold, for a sentence: "a vertex needs x, y and z".

    Raises
    ------
    ReadError
        If a row is too short, or a word is no number.
    """
    plain = _parse_plain_rows(rows, columns, np.float64)
    if plain is not None and np.isfinite(plain).all():
        return plain
    picked = _pick_words(rows, lines, path, columns=columns, what=what)
    try:
        return np.array(picked, np.float64).reshape(-1, columns.stop - columns.start)
    except ValueError:
        for row, line in zip(picked, lines, strict=True):
            _require_numbers(row, line, path)
        raise


def _parse_plain_rows(
    rows: Sequence[str], columns: slice, dtype: type[np.generic]
) -> AnyArray | None:
    """Return the numbers in some columns at once; None where a row is not plain."""
    if not rows:
        return None
    wanted = range(columns.start, columns.stop)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # of numbers that are not whole
            return np.loadtxt(rows, dtype, comments=None, usecols=wanted, ndmin=2)
    except (ValueError, OverflowError, Warning):
        return None


def _pick_words(
    rows: Sequence[str], lines: Sequence[int], path: Path, *, columns: slice, what: str
) -> list[list[str]]:
    """Return the words in some columns; refuse a row that has fewer."""
    picked = [row.split()[columns] for row in rows]
    for row, words, line in zip(rows, picked, lines, strict=True):
        if len(words) < columns.stop - columns.start:
            raise describe_row_fault(row.split(), line, what, path)
    return picked


def _require_numbers(row: Sequence[str], line: int, path: Path) -> None:
    try:
        np.array(row, np.float64)
    except ValueError:
        raise describe_row_fault(row, line, "a coordinate is no number", path) from None


def parse_integer_columns(
    rows: Sequence[str], lines: Sequence[int], path: Path, *, columns: slice, what: str
) -> Int64Array:
    """Return the whole numbers in some columns of rows, as :func:`parse_floats`."""
    plain = _parse_plain_rows(rows, columns, np.int64)
    if plain is not None:
        return plain
    picked = _pick_words(rows, lines, path, columns=columns, what=what)
    numbers = [parse_integers(row, line, path) for row, line in zip(picked, lines, strict=True)]
    return np.array(numbers, np.int64).reshape(-1, columns.stop - columns.start)


def parse_integers(
    words: Sequence[str], line: int, path: Path, *, what: str = "a number must be whole"
) -> list[int]:
    """Return whole numbers; refuse words that are none, or that no file is large enough for."""
    for word in words:
        digits = word.lstrip("+-")
        if not (digits.isascii() and digits.isdecimal() and len(digits) <= _MOST_DIGITS):
            raise describe_row_fault(words, line, what, path)
    try:
        return [int(word) for word in words]
    except ValueError:
        raise describe_row_fault(words, line, what, path) from None


def describe_row_fault(row: Sequence[str], line: int, what: str, path: Path) -> ReadError:
    """Return the error of a row, with its line and its first words."""
    shown = " ".join(row[:12])[:_SHOWN_LETTERS]
    return ReadError(f"'{path}', line {line}: {what} ('{shown}').", path=path, lines=[line])
