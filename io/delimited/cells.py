"""Cells of one line, and what a number in one may look like."""

from __future__ import annotations

import csv
import re
from functools import lru_cache

BLANKS = " "
"""Stands for a delimiter of one or more spaces or tabs."""

_LONGEST_NUMBER = 1_000
"""Letters of a number: the exact decimals of a float64 have up to 767 digits."""

MINUS_SIGNS = "-\u2212\uff0d"
"""Signs of numbers below zero: the hyphen, the minus sign of typesetting, and that of Japanese."""
_PLAIN_MINUS = str.maketrans(MINUS_SIGNS, "-" * len(MINUS_SIGNS))

# No pattern may try a text in more than a few ways: cells come from files that nobody vouches for.
_NUMBER = {
    ".": re.compile(r"[-+\u2212\uff0d]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"),
    ",": re.compile(r"[-+\u2212\uff0d]?(?:[0-9]+(?:,[0-9]*)?|,[0-9]+)(?:[eE][-+]?[0-9]+)?"),
}
_DIGITS_IN_GROUPS = (
    r"[-+\u2212\uff0d]?[1-9][0-9]{0,2}([%s'\u2019 \u00a0\u202f])[0-9]{3}(?:\1[0-9]{3})*"
)
_GROUPED = {
    ".": re.compile(_DIGITS_IN_GROUPS % "," + r"(?:\.[0-9]*)?"),
    ",": re.compile(_DIGITS_IN_GROUPS % "." + r"(?:,[0-9]*)?"),
}
_GROUP_OR_DECIMALS = re.compile(r"[-+]?[1-9][0-9]{0,2},[0-9]{3}")
_MISSING = re.compile(r"[-+]?(?:nan|na|n/a|null|none|-|\*+)?", re.IGNORECASE)
_INFINITE = re.compile(r"[-+]?(?:inf|infinity)", re.IGNORECASE)


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
    return len(cell) <= _LONGEST_NUMBER and _NUMBER[decimal].fullmatch(cell) is not None


def is_missing(cell: str) -> bool:
    """Whether a cell is empty or a word for "no number"."""
    return len(cell) <= _LONGEST_NUMBER and _MISSING.fullmatch(cell) is not None


def is_infinite(cell: str) -> bool:
    """Whether a cell is a word for infinity."""
    return len(cell) <= _LONGEST_NUMBER and _INFINITE.fullmatch(cell) is not None


def is_number_like(cell: str, decimal: str) -> bool:
    """Whether a cell stands where a number should: one, nothing, or a word for "no number"."""
    return len(cell) <= _LONGEST_NUMBER and _is_number_like(cell, decimal)


# The same few hundred lines are looked at for one question after another.
@lru_cache(maxsize=1 << 13)
def _is_number_like(cell: str, decimal: str) -> bool:
    return (
        is_number(cell, decimal)
        or is_missing(cell)
        or is_infinite(cell)
        or is_grouped(cell, decimal)
    )


def is_grouped(cell: str, decimal: str) -> bool:
    """Whether a cell is a number with thousands separators: 4,024,240.10 or 4'024'240,10."""
    return len(cell) <= _LONGEST_NUMBER and _GROUPED[decimal].fullmatch(cell) is not None


def proves_groups(cell: str, decimal: str) -> bool:
    """Whether a grouped number cannot be read another way; 1,234 may be 1.234."""
    marks = [letter for letter in cell.lstrip(f"+{MINUS_SIGNS}") if not letter.isdecimal()]
    return is_grouped(cell, decimal) and (len(marks) > 1 or marks[0] not in ".,")


def may_group_or_divide(cell: str) -> bool:
    """Whether the comma of a cell may separate thousands as well as decimals: 1,234."""
    return _GROUP_OR_DECIMALS.fullmatch(cell) is not None


def is_padded(cell: str) -> bool:
    """Whether a cell is a whole number with leading zeros, as point numbers and codes have."""
    return len(cell) > 1 and cell[0] == "0" and cell.isdecimal()


def with_hyphen(cell: str) -> str:
    """Return the text of a number with a hyphen for another sign of minus."""
    return cell if cell.isascii() else cell.translate(_PLAIN_MINUS)


def parse_number(cell: str, decimal: str) -> float:
    """Return the nearest float64 of a cell, NaN if it is no number."""
    text = with_hyphen(cell.strip())
    return float(text.replace(decimal, ".")) if is_number(text, decimal) else float("nan")


def parse_grouped(cell: str, decimal: str) -> float:
    """Return the nearest float64 of a number with thousands separators, NaN if it is none."""
    text = with_hyphen(cell.strip())
    if not is_grouped(text, decimal):
        return float("nan")
    digits = "".join(letter for letter in text if letter.isdecimal() or letter in "+-" + decimal)
    return parse_number(digits, decimal)
