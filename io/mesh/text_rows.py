"""Text meshes (OBJ, OFF, 2DM): rows of words and numbers with their lines, and rows in batches.

Comments at the top keep the CRS, ``# crs: EPSG:32616``, and the unit of elevations where it is
known, ``# elevation unit: US survey foot``.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE
from .common import format_crs, format_unit

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import IO

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.progress import Tell
    from ...tin import TIN

_BATCH = 65_536
"""Rows that are formatted at once."""

_SHOWN_LETTERS = 60
_NAMES = (b"crs", b"elevation unit")
_RECORD = re.compile(rb"^# (crs|elevation unit): (.*?)\s*$", re.M)
_HEAD = re.compile(rb"(?:[ \t\r]*(?:#[^\n]*|\w*OFF[^\n]*)?(?:\n|\Z))*")
"""Comments, empty lines and the keyword of OFF, before the first row."""

_MOST_DIGITS = 18
"""Digits of a number that 64 bits hold whatever they are."""


@dataclass(frozen=True, slots=True)
class TextRows:
    """Rows of a text file, and the line of each, from 1 on."""

    texts: list[str] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.texts)

    def cut(self, start: int, stop: int | None = None) -> TextRows:
        """Return the rows from one to before another."""
        return TextRows(self.texts[start:stop], self.lines[start:stop])

    def pick(self, numbers: Iterable[int]) -> TextRows:
        """Return some rows by their numbers, of which one may come several times."""
        kept = list(numbers)
        return TextRows([self.texts[k] for k in kept], [self.lines[k] for k in kept])

    def parse_plain(self, columns: slice, dtype: type[np.generic]) -> AnyArray | None:
        """Return the numbers in some columns at once; None where a row is not plain."""
        if not self.texts:
            return None
        wanted = range(columns.start, columns.stop)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # of numbers that are not whole
                return np.loadtxt(self.texts, dtype, comments=None, usecols=wanted, ndmin=2)
        except (ValueError, OverflowError, Warning):
            return None

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
        plain = self.parse_plain(columns, np.float64)
        if plain is not None and np.isfinite(plain).all():
            return plain
        picked = self._pick_words(columns, what)
        try:
            return np.array(picked, np.float64).reshape(-1, columns.stop - columns.start)
        except ValueError:
            for words, line in zip(picked, self.lines, strict=True):
                try:
                    np.array(words, np.float64)
                except ValueError:
                    raise _describe_fault(words, line, "a coordinate is no number") from None
            raise

    def parse_integers(self, columns: slice, what: str) -> Int64Array:
        """Return the whole numbers in some columns, as :meth:`parse_floats`."""
        plain = self.parse_plain(columns, np.int64)
        if plain is not None:
            return plain
        picked = zip(self._pick_words(columns, what), self.lines, strict=True)
        numbers = [parse_integers(words, line) for words, line in picked]
        return np.array(numbers, np.int64).reshape(-1, columns.stop - columns.start)

    def _pick_words(self, columns: slice, what: str) -> list[list[str]]:
        picked = [text.split()[columns] for text in self.texts]
        for row, words in enumerate(picked):
            if len(words) < columns.stop - columns.start:
                raise self.describe_fault(row, what)
        return picked

    def describe_fault(self, row: int, what: str) -> ReadError:
        """Return the error of a row."""
        return _describe_fault(self.texts[row].split(), self.lines[row], what)

    def select(self, keyword: str) -> TextRows:
        """Return the rows that begin with a word."""
        starts = (f"{keyword} ", f"{keyword}\t")
        return self.pick(k for k, text in enumerate(self.texts) if text.startswith(starts))

    def sort_by_keyword(self) -> dict[str, TextRows]:
        """Return the rows that begin with each word."""
        sorted_rows: dict[str, TextRows] = {}
        start = 0
        for word, run in groupby([text.split(None, 1)[0] for text in self.texts]):
            part = sorted_rows.setdefault(word, TextRows())
            end = start + sum(1 for _ in run)
            part.texts.extend(self.texts[start:end])
            part.lines.extend(self.lines[start:end])
            start = end
        return sorted_rows


def split_rows(content: bytes) -> TextRows:
    """Cut a text into rows that are not empty, without comments and the spaces about them."""
    text = content.decode("utf-8", errors="replace").removeprefix("\ufeff")
    every = text.split("\n")
    if "#" in text:
        every = [line.partition("#")[0] for line in every]
    every = [line.strip() for line in every]
    if "\\" in text:  # which continues a line of OBJ
        for k in range(len(every) - 2, -1, -1):
            if every[k].endswith("\\"):
                every[k] = f"{every[k][:-1]} {every[k + 1]}"
                every[k + 1] = ""
    lines = [number for number, line in enumerate(every, start=1) if line]
    texts = every if len(lines) == len(every) else [line for line in every if line]
    return TextRows(texts, lines)


def parse_integers(
    words: Sequence[str], line: int, *, what: str = "a number must be whole"
) -> list[int]:
    """Return whole numbers; refuse words that are none, or that no file is large enough for."""
    for word in words:
        digits = word.lstrip("+-")
        if not (digits.isascii() and digits.isdecimal() and len(digits) <= _MOST_DIGITS):
            raise _describe_fault(words, line, what)
    try:
        return [int(word) for word in words]
    except ValueError:
        raise _describe_fault(words, line, what) from None


def _describe_fault(row: Sequence[str], line: int, what: str) -> ReadError:
    shown = " ".join(row[:12])[:_SHOWN_LETTERS]
    return ReadError(f"{FILE}, line {line}: {what} ('{shown}').", lines=[line])


def find_reference(content: bytes) -> tuple[str | None, str | None]:
    """Return CRS and unit of elevations as the comments at the top tell them."""
    head = _HEAD.match(content)
    found = dict(reversed(_RECORD.findall(head[0] if head else b"")))  # the first counts
    crs, unit = (found.get(name, b"").decode("utf-8", "replace") for name in _NAMES)
    return crs or None, unit or None


def write_reference(file: IO[str], tin: TIN) -> None:
    """Write the CRS and the unit of elevations as comments, those that are known."""
    if tin.crs is not None:
        file.write(f"# crs: {format_crs(tin.crs)}\n")
    if unit := format_unit(tin):
        file.write(f"# elevation unit: {unit}\n")


def format_rows(form: str, rows: AnyArray) -> Iterable[tuple[int, str]]:
    """Yield rows of numbers as text, with the count of each batch."""
    for start in range(0, len(rows), _BATCH):
        part = rows[start : start + _BATCH]
        yield len(part), (form * len(part)) % tuple(part.ravel().tolist())


def write_batches(
    file: IO[str], tin: TIN, batches: Iterable[tuple[int, str]], progress: Tell | None
) -> None:
    """Write the rows of all vertices and triangles, which come with their count."""
    total = len(tin.points) + len(tin.triangles)
    done = 0
    for count, batch in batches:
        file.write(batch)
        done += count
        if progress is not None:
            progress(done / total)
