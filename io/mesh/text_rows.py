"""Rows of words and numbers in text meshes, with the lines of the file that they stand in."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from ...errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

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

_WHOLE = re.compile(rf"(?:[-+]?[0-9]{{1,{_MOST_DIGITS}}} )*")


def split_rows(content: bytes, *, comment: str = "#") -> tuple[list[list[str]], list[int]]:
    """Cut a text into rows of words, and tell the line of each, from 1 on.

    Parameters
    ----------
    content : bytes
    comment : str
        What begins a comment, which lasts to the end of its line.

    Returns
    -------
    rows : list of list of str
        Those that are not empty.
    lines : list of int
    """
    text = content.decode("utf-8", errors="replace").removeprefix("\ufeff")
    rows, lines = [], []
    for number, line in enumerate(text.split("\n"), start=1):
        words = line.partition(comment)[0].split()
        if words:
            rows.append(words)
            lines.append(number)
    return rows, lines


def parse_floats(
    rows: Sequence[Sequence[str]], lines: Sequence[int], path: Path, *, columns: slice, what: str
) -> NDArray[np.float64]:
    """Return the numbers in some columns of rows.

    Parameters
    ----------
    rows : sequence of sequence of str
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
    width = columns.stop - columns.start
    picked = [row[columns] for row in rows]
    for row, line in zip(picked, lines, strict=True):
        if len(row) < width:
            raise describe_row_fault(row, line, what, path)
    try:
        return np.array(picked, np.float64).reshape(-1, width)
    except ValueError:
        for row, line in zip(picked, lines, strict=True):
            _require_numbers(row, line, path)
        raise


def _require_numbers(row: Sequence[str], line: int, path: Path) -> None:
    try:
        np.array(row, np.float64)
    except ValueError:
        raise describe_row_fault(row, line, "a coordinate is no number", path) from None


def parse_integer_columns(
    rows: Sequence[Sequence[str]], lines: Sequence[int], path: Path, *, columns: slice, what: str
) -> NDArray[np.int64]:
    """Return the whole numbers in some columns of rows, as :func:`parse_floats`."""
    width = columns.stop - columns.start
    picked = [row[columns] for row in rows]
    words = [word for row in picked for word in row]
    if len(words) == width * len(rows) and _WHOLE.fullmatch(" ".join([*words, ""])):
        return np.array(words, np.int64).reshape(-1, width)
    for row, line in zip(picked, lines, strict=True):
        if len(row) < width:
            raise describe_row_fault(row, line, what, path)
    numbers = [parse_integers(row, line, path) for row, line in zip(picked, lines, strict=True)]
    return np.array(numbers, np.int64).reshape(-1, width)


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
