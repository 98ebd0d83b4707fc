"""Delimiter and decimal mark of a table, told by the caller or found by looking."""

from __future__ import annotations

import re
from collections import Counter
from statistics import median_high
from typing import TYPE_CHECKING, NamedTuple

from ...base.errors import OptionError, ReadError
from .cells import BLANKS, is_grouped, is_number, is_number_like, may_group_or_divide, split_line
from .columns import find_role, names_coordinates
from .lines import COMMENT_PREFIXES, decode_head

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_NUMBERS_OF_HEADER = 2.5
"""What a header counts for: less than the three numbers of rows, it may have its own delimiter."""
_TOP_LINES = 100
_DELIMITERS = ("\t", ";", "|", ",", BLANKS)
_VISIBLE = (",", ";", "|")
_COMMA_WITH_OTHER = re.compile(r"[ \t]+,[ \t]*|,[ \t]+|,[ \t]*[|;]|[|;][ \t]*,")
_WIDE_BLANK = re.compile(r"[ \t]{2,}|\t")
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
    text = decode_head(head)
    if text is None:
        return False
    stripped = (line.strip() for line in text.split("\n")[:_TOP_LINES])
    sample = [line for line in stripped if line and not line.startswith(COMMENT_PREFIXES)]
    delimiter = find_delimiter(sample) if sample else None
    if delimiter is None:
        return False
    numbers = [_count_numbers(split_line(line, delimiter), delimiter) for line in sample]
    return 2 * sum(number >= 3 for number in numbers) >= len(numbers)


def parse_delimiter(word: str | None) -> str | None:
    """Return the delimiter that the caller names; None stays None."""
    if word is None:
        return None
    delimiter = _SPOKEN.get(word.strip().lower(), word) if word != BLANKS else word
    if len(delimiter) != 1 or delimiter.isalnum() or delimiter in '"\n\r.+-' or delimiter > "~":
        raise OptionError(
            "delimiter", word, f"one letter such as ',' or one of {', '.join(_SPOKEN)}"
        )
    return delimiter


def parse_decimal_mark(word: str | None) -> str | None:
    """Return the decimal mark that the caller names; None stays None."""
    if word not in (None, ".", ","):
        raise OptionError("decimal", word, "'.' or ','")
    return word


def _count_numbers(cells: Sequence[str], delimiter: str) -> int:
    """Count the cells that are numbers with either decimal mark, or stand in place of one."""
    marks = "." if delimiter == "," else ".,"
    return sum(
        bool(cell)
        and not _is_beside_delimiter(cell)
        and not (delimiter == "," and " " in cell)  # what groups 4 024 240 is no comma
        and any(is_number_like(cell, mark) for mark in marks)
        for cell in cells
    )


def _is_beside_delimiter(cell: str) -> bool:
    """Whether a cell begins or ends with what must be a delimiter: blanks stand beside it."""
    return cell.startswith(_VISIBLE) or cell.endswith(_VISIBLE)


def find_delimiter(sample: Sequence[str]) -> str | None:
    """Choose the delimiter that gives the most numbers and the most even rows.

    Tabs that give as many are taken rather than blanks, which part the words of a text too.
    Blanks are taken rather than commas where they part the header and, as evenly, numbers.
    """
    scores = {delimiter: _score_delimiter(sample, delimiter) for delimiter in _DELIMITERS}
    best = max(scores, key=scores.__getitem__)
    if best == BLANKS and scores["\t"][:2] == scores[BLANKS][:2]:
        best = "\t"
    if best == "," and _is_headed_by_blanks(sample):
        best = BLANKS
    return best if scores[best] > (0, 0.0, 0) else None


def split_header(line: str, delimiter: str, count: int) -> list[str] | None:
    """Split a header that another delimiter than that of the rows parts; None if it is none.

    It has the names of the coordinates, and as many as rows have cells, or nothing but known names.
    """
    for other in _DELIMITERS:
        names = split_line(line, other) if other != delimiter else []
        if names_coordinates(names) is not None and (
            len(names) == count or all(map(find_role, names))
        ):
            return names
    return None


def _is_headed_by_blanks(sample: Sequence[str]) -> bool:
    """Whether blanks part header and rows into the same columns, and commas do not.

    Below "x y z" there are three numbers in "1,5 ,5 2", not four; "1 ,5 ,5" may be either.
    """
    rows = [split_line(line, BLANKS) for line in sample]
    top = next((i for i, row in enumerate(rows[:_TOP_LINES]) if _is_header(row)), None)
    if top is None or "," in sample[top] or len(rows) == top + 1:
        return False
    known = names_coordinates(rows[top])
    is_described = known is not None and known.roles.get("description") == len(rows[top]) - 1
    count = len(rows[top]) - is_described
    bodies = [row[:count] for row in rows[top + 1 :] if is_described or len(row) == count]
    if len(bodies) < len(rows) - top - 1 or any(
        len(body) != count
        or not all(is_number(cell, ",") for cell in body if _is_beside_delimiter(cell))
        for body in bodies
    ):
        return False
    return any(
        any(cell.startswith(",") for cell in body)
        or len(split_line(" ".join(body).rstrip(","), ",")) != count
        for body in bodies
        if any("," in cell for cell in body)
    )


def _is_header(row: Sequence[str]) -> bool:
    return names_coordinates(row) is not None


def require_no_delimiter(mark: str, delimiter: str, cells: Sequence[Sequence[str]]) -> None:
    """Raise if the decimal mark that the caller names is the delimiter, and stands in no cell."""
    if mark == delimiter and not any(mark in cell for row in cells for cell in row):
        raise ReadError(
            f"its columns are separated by '{delimiter}', and no cell holds one, though the option "
            "`decimal` names it: write the table with another delimiter, or quote its numbers."
        )


def require_one_kind_of_comma(sample: Sequence[str]) -> None:
    """Raise if commas with others beside them separate columns, and single ones may group digits.

    Raises
    ------
    ReadError
        "1, 2, 3,456" may be three columns, with thousands in the last, or four; "1,|2,|3,456" too.
    """
    rows = [_COMMA_WITH_OTHER.split(line.strip(" \t,|;")) for line in sample]
    count = Counter(map(len, rows)).most_common(1)[0][0]
    cells = [cell for row in rows if len(row) == count >= 3 for cell in row]
    grouped = next((cell for cell in cells if "," in cell and is_grouped(cell, ".")), None)
    if grouped is not None:
        raise ReadError(
            f"its commas may separate columns or thousands ('{grouped}', without the blank or "
            "other letter that the other commas have beside them): `delimiter=','` takes each as a "
            "delimiter."
        )


def require_no_blank_groups(sample: Sequence[str], n_stated: int) -> None:
    """Raise if blanks separate columns, and single ones among wider ones may group digits.

    Parameters
    ----------
    sample : sequence of str
        Lines of the file.
    n_stated : int
        Columns that the caller names: as many as there are between blanks of any width leave
        nothing open.
    """
    rows = [row for row in sample if _count_numbers(split_line(row, BLANKS), BLANKS) >= 2]
    grouped = [
        next((cell for cell in _WIDE_BLANK.split(row.strip()) if _is_grouped_by_blanks(cell)), None)
        for row in rows
    ]
    is_stated = any(len(split_line(row, BLANKS)) <= n_stated for row in rows)
    if rows and all(grouped) and not is_stated:
        raise ReadError(
            f"its blanks may separate columns or thousands ('{grouped[0]}', beside wider blanks): "
            "write the table with another delimiter, or say with the option `columns` what all of "
            "them are."
        )


def _is_grouped_by_blanks(cell: str) -> bool:
    return " " in cell and (is_grouped(cell, ".") or is_grouped(cell, ","))


def _score_delimiter(sample: Sequence[str], delimiter: str) -> tuple[float, float, int]:
    """Return how many numbers a line has, the share of lines that are even, and their cells."""
    rows = [split_line(line, delimiter) for line in sample]
    found = median_high(_count_numbers(row, delimiter) for row in rows)
    is_headed = any(names_coordinates(row) is not None for row in rows[:_TOP_LINES])
    numbers = max(min(found, 3), _NUMBERS_OF_HEADER * is_headed)
    if numbers < 2 or max(map(len, rows)) < 3:
        return 0, 0.0, 0
    even = [row for row in rows if delimiter != BLANKS or not any(map(_is_beside_delimiter, row))]
    count, times = Counter(map(len, even)).most_common(1)[0] if even else (0, 0)
    return numbers, times / len(rows), count


# ------------------------------------------------------------------ decimal marks


class DecimalMark(NamedTuple):
    """The decimal mark of a table, and what was assumed to tell it."""

    mark: str
    note: str = ""


def find_decimal_mark(rows: Iterable[Sequence[str]], delimiter: str) -> DecimalMark | None:
    """Choose the decimal mark by the cells of some rows; None if no cell has one.

    Notes
    -----
    A cell such as 4000,12 proves the decimal comma, one such as 4000.12 the point; 752,700 proves
    nothing, nor does a comma that may belong to the delimiter: "5,<tab>1,234" may be "5" and
    "1,234". Where both are proved the mark of more cells is taken, and the others are bad cells.
    Between semicolons, which are delimiters because commas are decimal marks, the comma is taken.
    """
    rows = list(rows)
    cells = [cell for row in rows for cell in row]
    commas = [cell for cell in cells if _has_comma(cell, delimiter) and is_number(cell, ",")]
    points = [cell for cell in cells if "." in cell and is_number(cell, ".")]
    numbers = [cell for cell in cells if is_number(cell, ",")]
    may_delimit = delimiter == BLANKS or any(cell.endswith(",") for cell in numbers)
    sure_commas = sum(_proves_comma(c, row, may_delimit=may_delimit) for row in rows for c in row)
    sure_points = sum(not may_group_or_divide(cell.replace(".", ",")) for cell in points)
    if delimiter != ",":  # 1.109,850 and 1,109.850
        both = [cell for cell in cells if "," in cell and "." in cell]
        sure_commas += sum(is_grouped(cell, ",") for cell in both)
        sure_points += sum(is_grouped(cell, ".") for cell in both)
    if sure_commas or sure_points:
        return DecimalMark("," if sure_commas > sure_points else ".")
    if delimiter == "," or (points and not commas):
        return DecimalMark(".") if points else None
    if any(is_grouped(cell, ".") and cell.count(",") > 1 for cell in cells):
        return DecimalMark(".")
    if not commas:
        return None
    if delimiter == ";" and not any(map(_is_beside_delimiter, numbers)):
        return DecimalMark(
            ",",
            "The commas in its numbers are taken as decimal marks, as is usual between semicolons "
            f"('{commas[0]}').",
        )
    raise ReadError(
        f"its commas may be decimal marks or separate thousands ('{commas[0]}'): `decimal=','` "
        "or `decimal='.'` settles it."
    )


def has_idle_commas(rows: Iterable[Sequence[str]]) -> bool:
    """Whether numbers end with a comma, and none begins with one: "5," is 5 whatever it means."""
    ends = [(c[0], c[-1]) for row in rows for c in row if "," in c and is_number(c, ",")]
    return any(last == "," for _, last in ends) and not any(first == "," for first, _ in ends)


def _has_comma(cell: str, delimiter: str) -> bool:
    """Whether a cell has a comma that its delimiter, such as ", ", does not account for."""
    return "," in (cell.strip(",") if delimiter == BLANKS else cell.rstrip(","))


def _proves_comma(cell: str, row: Sequence[str], *, may_delimit: bool) -> bool:
    """Whether a cell of a row is a number whose comma neither groups digits nor delimits cells."""
    if not is_number(cell, ",") or may_group_or_divide(cell):
        return False
    may_delimit = may_delimit or all(other.startswith(",") for other in row[1:])
    return "," in (cell.strip(",") if may_delimit else cell)
