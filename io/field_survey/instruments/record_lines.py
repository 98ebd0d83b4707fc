"""Files of an instrument that have a record a line, and the numbers in them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE
from ...delimited import is_number

if TYPE_CHECKING:
    from ...delimited import TextLines
    from .records import Book

_STX = "\x02"


class _Reader(Protocol):
    """Takes the records of a format as they come."""

    book: Book

    def may_be_cut(self, line: str) -> bool:
        """Whether the last number of a record may go on."""

    def read_record(self, line: str, number: int) -> None:
        """Take one record, by its line from 1."""

    def finish(self) -> None:
        """Take what stood waiting for other records."""


def find_head(lines: TextLines) -> str:
    """Return the first line that is not blank, or an empty one; STX begins a download."""
    heads = (lines.decode_line(i).lstrip(_STX) for i in np.flatnonzero(~lines.is_blank).tolist())
    return next(filter(str.strip, heads), "")


def describe_head_fault(what: str) -> ReadError:
    """Return the error of a first line that is not as the format asks for."""
    return ReadError(f"{FILE}{what}", lines=[1])


def read_records(lines: TextLines, reader: _Reader) -> Book:
    """Let a reader take all records; a last one without an end that may be cut is left out."""
    for number in range(len(lines)):
        line = lines.decode_line(number)
        if number == len(lines) - 1 and not lines.is_whole and reader.may_be_cut(line):
            reader.book.leave_out("records without an end that may be cut", number + 1)
        else:
            reader.read_record(line, number + 1)
    reader.finish()
    return reader.book


def parse_coordinate(text: str, line: int) -> float:
    """Return a coordinate, NaN where there is none."""
    if text in ("", "?"):
        return math.nan
    value = float(text) if is_number(text, ".") else math.inf
    if math.isinf(value):
        raise ReadError(
            f"{FILE}, line {line}: '{text[:30]}' stands where a coordinate must be.",
            lines=[line],
        )
    return value
