"""Cells of one line, and what a number in one may look like."""

from __future__ import annotations

import csv
import re

__all__ = [
    "BLANKS",
    "as_number",
    "is_number",
    "is_number_like",
    "split_line",
]

BLANKS = " "
"""Stands for a delimiter of one or more spaces or tabs."""

_NUMBER = {
    ".": re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"),
    ",": re.compile(r"[-+]?(?:[0-9]+,?[0-9]*|,[0-9]+)(?:[eE][-+]?[0-9]+)?"),
}
_NO_NUMBER = re.compile(r"[-+]?(?:nan|na|n/a|null|none|inf|infinity|-|\*+)?", re.IGNORECASE)


def split_line(line: str, delimiter: str) -> list[str]:
    """Split a line by the rules of CSV; quotes count where a cell starts with one."""
    if delimiter == BLANKS:
        line = line.replace("\t", " ").strip(" ")
    try:
        cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [""])
    except csv.Error:  # a cell too long for the module is no number either
        cells = line.split(delimiter)
    return [cell.strip() for cell in cells]


def is_number(cell: str, decimal: str) -> bool:
    """Whether a cell is a number with this decimal mark."""
    return _NUMBER[decimal].fullmatch(cell) is not None


def is_number_like(cell: str, decimal: str) -> bool:
    """Whether a cell stands where a number should: one, nothing, or a word for "no number"."""
    return is_number(cell, decimal) or _NO_NUMBER.fullmatch(cell) is not None


def as_number(cell: str, decimal: str) -> float:
    """Return the nearest float64 of a cell, NaN if it is no number."""
    text = cell.strip()
    return float(text.replace(decimal, ".")) if is_number(text, decimal) else float("nan")
