"""Rows of words and numbers in text meshes, with the lines of the file that they stand in."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array, Int64Array

__all__ = ["TextRows", "describe_row_fault", "parse_integers", "split_rows"]

_SHOWN_LETTERS = 60
_MOST_DIGITS = 18
"""Digits of a number that 64 bits hold whatever they are."""


@dataclass(frozen=True, slots=True)
class TextRows:
    """Rows of a text file, and the line of each, from 1 on."""

    path: Path
    texts: list[str] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.texts)

    def cut(self, start: int, stop: int | None = None) -> TextRows:
        """Return the rows from one to before another."""
        return TextRows(self.path, self.texts[start:stop], self.lines[start:stop])

    def parse_floats(self, columns: slice, what: str) -> Float64Array:
        """Return the numbers in some columns, from a start to a stop.

        Parameters
        ----------
        what : str
            What a row must hold, for a sentence: "a vertex needs x, y and z".

        Raises
        ------
        ReadError
            If a row is too short, or a word is no number.
        """
        plain = _parse_plain_rows(self.texts, columns, np.float64)
        if plain is not None and np.isfinite(plain).all():
            return plain
        picked = self._pick_words(columns, what)
        try:
            return np.array(picked, np.float64).reshape(-1, columns.stop - columns.start)
        except ValueError:
            for words, line in zip(picked, self.lines, strict=True):
                _require_numbers(words, line, self.path)
            raise

    def parse_integers(self, columns: slice, what: str) -> Int64Array:
        """Return the whole numbers in some columns, as :meth:`parse_floats`."""
        plain = _parse_plain_rows(self.texts, columns, np.int64)
        if plain is not None:
            return plain
        picked = zip(self._pick_words(columns, what), self.lines, strict=True)
        numbers = [parse_integers(words, line, self.path) for words, line in picked]
        return np.array(numbers, np.int64).reshape(-1, columns.stop - columns.start)

    def _pick_words(self, columns: slice, what: str) -> list[list[str]]:
        """Return the words in some columns; refuse a row that has fewer."""
        picked = [text.split()[columns] for text in self.texts]
        for row, words in enumerate(picked):
            if len(words) < columns.stop - columns.start:
                raise self.describe_fault(row, what)
        return picked

    def describe_fault(self, row: int, what: str) -> ReadError:
        """Return the error of a row."""
        return describe_row_fault(self.texts[row].split(), self.lines[row], what, self.path)


def split_rows(content: bytes, path: Path, *, comment: str = "#") -> TextRows:
    """Cut a text into rows that are not empty, without comments and the spaces about them."""
    text = content.decode("utf-8", errors="replace").removeprefix("\ufeff")
    every = text.split("\n")
    if comment in text:
        every = [line.partition(comment)[0] for line in every]
    every = [line.strip() for line in every]
    lines = [number for number, line in enumerate(every, start=1) if line]
    texts = every if len(lines) == len(every) else [line for line in every if line]
    return TextRows(path, texts, lines)


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


def _require_numbers(row: Sequence[str], line: int, path: Path) -> None:
    try:
        np.array(row, np.float64)
    except ValueError:
        raise describe_row_fault(row, line, "a coordinate is no number", path) from None


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
