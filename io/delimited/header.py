"""What the caller, the header above a table, or a line near it, says of the columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from ...base.errors import ReadError
from ...base.sentences import counted
from .cells import BLANKS, is_number_like, split_line
from .columns import (
    Columns,
    describe_doubts,
    find_columns_by_header,
    find_columns_by_word,
    find_role,
    list_meanings,
    list_names,
    names_coordinates,
)
from .format_comments import find_heading
from .lines import COMMENT_PREFIXES
from .marks import split_header
from .names import is_label, is_phrase, parse_name, read_words

if TYPE_CHECKING:
    from ...base.arrays import Int64Array
    from .format_comments import Heading
    from .lines import TextLines

GivenColumns: TypeAlias = "str | Sequence[str] | Mapping[str, str | int]"
"""What the caller says that the columns are."""

_SHOWN_NAMES = 100


class TopLines(NamedTuple):
    """A text file, the lines of its table, and what stands above them."""

    lines: TextLines
    rows: Int64Array
    header: list[str] | None
    units: tuple[str, ...]


def find_named_columns(
    top: TopLines,
    shape: tuple[str, int],
    body: Sequence[Sequence[str]],
    stated: GivenColumns | None,
) -> tuple[Columns | None, Heading | None]:
    """Return what the caller, a header or a line near the table says of the columns.

    Parameters
    ----------
    top : TopLines
    shape : (str, int)
        Delimiter, and number of columns.
    body : sequence of sequence of str
        Cells of some rows.
    stated : str, sequence of str or mapping, optional
        What the caller says.

    Returns
    -------
    columns : Columns or None
        None if nobody says it.
    heading : Heading or None
        A line that speaks of coordinates, and does not say which columns they are.
    """
    delimiter, count = shape
    first_row = int(top.rows[0])
    header = top.header or _find_header_in_comment(top.lines, first_row, delimiter, count)
    header = None if header is None else _drop_label(header)
    heading = None
    if stated is None and (header is None or names_coordinates(header) is None):
        heading = find_heading(top.lines, top.rows, count)
    if heading is not None and heading.names:
        found = _find_columns_by_name(list(heading.names), heading.units, count, None)
        return replace(found, notes=(heading.note, *found.notes)), None
    named = _fit_header(header, count, body, stated)
    if named or stated is not None:
        return _find_columns_by_name(named, top.units, count, stated), None
    return None, heading


def _drop_label(header: list[str]) -> list[str]:
    """Return a header without what stands before its first name: "Columns: N", "E", "Z"."""
    if not header:
        return header
    if len(header) > 1 and header[0] and is_label(header[0]):
        return header[1:]
    label, _, name = header[0].replace("=", ":").rpartition(":")
    stands_alone = bool(name.strip()) and not read_words(label).roles and "(" not in label
    return [name.strip(), *header[1:]] if stands_alone else header


def _find_header_in_comment(
    lines: TextLines, first_row: int, delimiter: str, count: int
) -> list[str] | None:
    """Return the names in the comment line right above the table, if it is a header."""
    if first_row == 0:
        return None
    above = lines.decode_line(first_row - 1).strip()
    found: list[list[str]] = []
    for prefix in ("", *COMMENT_PREFIXES):
        if above.startswith(prefix):
            names = _drop_label(split_line(above.removeprefix(prefix), delimiter))
            is_sign = delimiter == BLANKS and names[:1] == ["#"]  # and no column "#"
            if len(names) == count and not is_sign and names_coordinates(names) is not None:
                found.append(names)
            is_bare = bool(prefix) or not above.startswith(COMMENT_PREFIXES)
            other = split_header(above.removeprefix(prefix), delimiter, count) if is_bare else None
            if other is not None and len(_drop_label(other)) == count:
                found.append(_drop_label(other))
    plain = (names for names in found if not describe_doubts(names))
    return next(plain, found[0] if found else None)


def _fit_header(
    header: list[str] | None, count: int, body: Sequence[Sequence[str]], stated: GivenColumns | None
) -> list[str]:
    """Return one name a column; a delimiter at the end of rows or header makes no column."""
    if header is None or len(header) == count:
        return header or []
    if len(header) == count - 1 and header[-1] and not any(row[-1] for row in body):
        return [*header, ""]
    if len(header) == count + 1 and not header[-1]:
        return header[:-1]
    n_stated = count_stated_columns(stated)
    is_known = names_coordinates(header) is not None
    if n_stated and (n_stated >= count or not is_known):
        return []
    raise ReadError(
        f"the header names {counted(len(header), 'column')} ({list_names(header)}), but rows have "
        f"{count}: "
        "say with the option `columns` what all of them are, and check delimiter and decimal mark."
    )


def _find_columns_by_name(
    header: list[str], units: Sequence[str], count: int, stated: GivenColumns | None
) -> Columns:
    """Find the columns by the caller's word, else by the header."""
    if stated is not None:
        return find_columns_by_word(stated, header, count, units)
    columns = find_columns_by_header(header, units)
    if columns is None:
        found = [f"{find_role(name)} '{name}'" for name in header[:_SHOWN_NAMES] if find_role(name)]
        doubts = describe_doubts(header)
        if doubts:
            raise ReadError(f"the header ({list_names(header)}) leaves its meaning open: {doubts}.")
        raise ReadError(
            f"the header ({list_names(header)}) does not name easting, northing and elevation "
            f"(known: {', '.join(found) or 'none of it'}): say with the option `columns` which "
            "columns they are."
        )
    return columns


def join_brackets(header: Sequence[str]) -> list[str]:
    """Join brackets, where blanks split them off, to the names before them: "Z (US survey ft)"."""
    joined: list[str] = []
    depth = 0
    for cell in header:
        is_behind_name = bool(joined) and not joined[-1].startswith(("(", "["))
        if depth > 0 or (is_behind_name and cell.startswith(("(", "["))):
            joined[-1] = f"{joined[-1]} {cell}"
            depth += cell.count("(") + cell.count("[") - cell.count(")") - cell.count("]")
        else:
            joined.append(cell)
    return joined


def join_numbers(header: Sequence[str], body: Sequence[Sequence[str]]) -> list[str]:
    """Join two words for the number of a point, where blanks split them: "Point No."."""
    are_numbers = [parse_name(name).role == "number" for name in header]
    at = next((i for i in range(len(header) - 1) if all(are_numbers[i : i + 2])), None)
    if at is None or not body:
        return list(header)
    joined = [*header[:at], f"{header[at]} {header[at + 1]}", *header[at + 2 :]]
    lengths = {len(row) for row in body}
    fitting = [names for names in (joined, list(header)) if _fits(names, body)]
    if len(fitting) < 2 or lengths == {len(joined)}:
        return (fitting or [list(header)])[0]
    if lengths == {len(header)} and not is_phrase(joined[at]):
        return list(header)
    raise ReadError(
        f"the header ({list_names(header)}) leaves open whether '{joined[at]}' is one column or "
        "two: say with the option `columns` what all of them are."
    )


def _fits(header: Sequence[str], body: Sequence[Sequence[str]]) -> bool:
    """Whether all rows have numbers where the header names coordinates."""
    columns = names_coordinates(header)
    return columns is not None and all(
        at < len(row) and (is_number_like(row[at], ".") or is_number_like(row[at], ","))
        for row in body
        for at in columns.coordinates
    )


def count_stated_columns(stated: GivenColumns | None) -> int:
    """Return how many columns the caller names, 0 if not in their order."""
    return 0 if stated is None or isinstance(stated, Mapping) else len(list_meanings(stated))
