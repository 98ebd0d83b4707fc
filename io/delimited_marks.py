"""Delimiter and decimal mark of a table, told by the caller or found by looking."""

from __future__ import annotations

from collections import Counter
from statistics import median_high
from typing import TYPE_CHECKING

from .delimited_cells import BLANKS, is_number, is_number_like, split_line
from .delimited_columns import columns_by_header
from .delimited_lines import COMMENT_PREFIXES, decoded
from .errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = ["as_decimal", "as_delimiter", "decimal_of", "delimiter_of", "looks_like_table"]

_TOP_LINES = 100
_DELIMITERS = ("\t", ";", "|", ",", BLANKS)
_SPOKEN = {
    "comma": ",",
    "semicolon": ";",
    "tab": "\t",
    "\\t": "\t",
    "pipe": "|",
    "space": BLANKS,
    "spaces": BLANKS,
    "whitespace": BLANKS,
}


def looks_like_table(head: bytes) -> bool:
    """Whether the first bytes of a file are delimited rows with three numbers or more."""
    text = decoded(head)
    if text is None:
        return False
    stripped = (line.strip() for line in text.split("\n")[:_TOP_LINES])
    sample = [line for line in stripped if line and not line.startswith(COMMENT_PREFIXES)]
    delimiter = delimiter_of(sample) if sample else None
    if delimiter is None:
        return False
    numbers = [_count_numbers(split_line(line, delimiter), delimiter) for line in sample]
    return 2 * sum(number >= 3 for number in numbers) >= len(numbers)


def as_delimiter(word: str | None) -> str | None:
    """Return the delimiter that the caller names; None stays None.

    Raises
    ------
    FormatError
        If it is neither one letter that may be a delimiter nor the name of one.
    """
    if word is None:
        return None
    delimiter = _SPOKEN.get(word.strip().lower(), word) if word != BLANKS else word
    if len(delimiter) != 1 or delimiter.isalnum() or delimiter in '"\n\r.+-' or delimiter > "~":
        raise FormatError(
            f"Invalid delimiter '{word}': one letter such as ',' or one of {', '.join(_SPOKEN)}.",
            known=tuple(_SPOKEN),
        )
    return delimiter


def as_decimal(word: str | None) -> str | None:
    """Return the decimal mark that the caller names; None stays None.

    Raises
    ------
    FormatError
        If it is neither "." nor ",".
    """
    if word not in (None, ".", ","):
        raise FormatError(
            f"Invalid decimal mark '{word}': '.' or ',' is allowed.", known=(".", ",")
        )
    return word


def _count_numbers(cells: Sequence[str], delimiter: str) -> int:
    """Count the cells that are numbers with either decimal mark, or stand in place of one."""
    marks = "." if delimiter == "," else ".,"
    return sum(bool(cell) and any(is_number_like(cell, mark) for mark in marks) for cell in cells)


def delimiter_of(sample: Sequence[str]) -> str | None:
    """Choose the delimiter that gives the most numbers and the most even rows."""
    scores = {delimiter: _delimiter_score(sample, delimiter) for delimiter in _DELIMITERS}
    best = max(scores, key=scores.__getitem__)
    return best if scores[best] > (0, 0.0, 0) else None


def _delimiter_score(sample: Sequence[str], delimiter: str) -> tuple[int, float, int]:
    rows = [split_line(line, delimiter) for line in sample]
    count, times = Counter(map(len, rows)).most_common(1)[0]
    numbers = max(
        median_high(_count_numbers(row, delimiter) for row in rows),
        max(3 * (columns_by_header(row, strict=False) is not None) for row in rows[:_TOP_LINES]),
    )
    if numbers < 2 or max(map(len, rows)) < 3:
        return 0, 0.0, 0
    return min(numbers, 3), times / len(rows), count


def decimal_of(rows: Iterable[Sequence[str]], delimiter: str) -> str:
    """Choose the decimal mark that more of the cells have."""
    if delimiter == ",":
        return "."
    cells = [cell for row in rows for cell in row]
    commas = sum("," in cell and is_number(cell, ",") for cell in cells)
    points = sum("." in cell and is_number(cell, ".") for cell in cells)
    return "," if commas > points else "."
