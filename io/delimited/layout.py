"""The layout of a table, found by looking at some of its lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from .cells import BLANKS, is_number, is_number_like, is_padded, split_line
from .columns import (
    Columns,
    find_unit_word,
    list_meanings,
    names_coordinates,
)
from .header import (
    TopLines,
    count_stated_columns,
    find_named_columns,
    join_brackets,
    join_numbers,
)
from .headerless import require_no_split_decimals
from .lines import COMMENT_PREFIXES
from .marks import (
    DecimalMark,
    find_decimal_mark,
    find_delimiter,
    has_idle_commas,
    parse_decimal_mark,
    parse_delimiter,
    require_no_blank_groups,
    require_no_delimiter,
    require_one_kind_of_comma,
    split_header,
)
from .page_breaks import PageBreaks, find_page_breaks

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import Int64Array
    from .format_comments import Heading
    from .lines import TextLines

_TOP_LINES = 100
_SPREAD_LINES = 200
_MOST_COLUMNS = 1_000
_MOST_ROWS = 0.9
_COUNT_DIGITS = 18
"""A number of points has no more."""
_SCAN_SUFFIXES = frozenset({".xyz", ".pts"})
_UNIT_WORDS = frozenset(
    {*("m", "metre", "metres", "meter", "meters", "ft", "feet", "foot", "usft", "mm", "cm", "deg")}
    | {*("degrees", "text", "unit", "units", "number", "string", "float", "int", "-", "")}
)


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """How to read the table of a text file."""

    delimiter: str
    """One letter; ``BLANKS`` for runs of spaces and tabs."""
    decimal: str
    """Decimal mark, "." or ","."""
    is_decimal_stated: bool
    """Whether the caller named the decimal mark."""
    count: int
    """Number of columns."""
    columns: Columns | None
    """What they mean, by the caller's word or the header; None if their content must tell."""
    rows: Int64Array
    """(n,), line numbers (from 0) of the rows."""
    has_text_tail: bool
    """Whether the last column is text that may itself hold the delimiter."""
    may_lack_tail: bool
    """Whether a row that is one cell short lacks this text: it is never a number."""
    text_columns: frozenset[int]
    """Columns to be kept as text."""
    mostly_text: frozenset[int]
    """Columns most of whose cells are no numbers."""
    padded: frozenset[int]
    """Columns with whole numbers that have leading zeros."""
    divided: frozenset[int]
    """Columns with a decimal mark or an exponent."""
    announced: int | None
    """Points that a line above the table tells of."""
    skipped: Mapping[str, int]
    """Lines that are no rows."""
    is_scan: bool = False
    """Whether the suffix says that rows begin with x, y, z."""
    notes: tuple[str, ...] = ()
    """What was assumed, in sentences."""
    heading: Heading | None = None
    """A line that speaks of coordinates and does not give the order of the columns."""
    left_out: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    """Lines (from 1) among the rows that are no rows: the header again, "END"."""
    has_semicolons: bool = False
    """Whether rows begin with a semicolon that is neither delimiter nor comment."""
    headers: tuple[str, ...] = ()
    """The header and the line of units as they stand above the table."""

    @property
    def is_announced(self) -> bool:
        """Whether a point count above the table says that rows begin with x, y, z."""
        return self.announced is not None

    @property
    def elevation_unit(self) -> str | None:
        """Word that the header uses for the unit of elevations, None if it names none."""
        return None if self.columns is None else self.columns.units.get("elevation")


@dataclass(frozen=True, slots=True)
class LayoutOptions:
    """What the caller says about the layout; None is found by looking."""

    columns: str | Sequence[str] | Mapping[str, str | int] | None = None
    delimiter: str | None = None
    decimal: str | None = None
    comment: str | None = None


@dataclass(slots=True)
class _Top:
    """What stands above the first row of the table."""

    header: list[str] | None = None
    units: list[str] = field(default_factory=list)
    headers: list[int] = field(default_factory=list)
    """Places of the header and the line of units among the lines."""
    n_lines: int = 0
    announced: int | None = None
    counts: Counter[str] = field(default_factory=Counter)


def find_layout(lines: TextLines, suffix: str, options: LayoutOptions) -> Layout:
    """Find how to read a table; what the caller does not know of it is found by looking.

    A ReadError is raised if no table is there, or its columns cannot be told, a FormatError if an
    option has a value that it cannot have.

    Some hundred lines are looked at: the first ones, and others spread over the file.

    1. Lines that are blank or start with a comment prefix are set aside.
    2. The delimiter is the one that gives the most numbers a line, and the same count of cells.
    3. The lines above the first row are titles, the header, a line of units, or a point count.
    4. Columns are found by the caller's word, else by the header; their content is judged when all
       of it has been read.
    """
    options = replace(
        options,
        delimiter=parse_delimiter(options.delimiter),
        decimal=parse_decimal_mark(options.decimal),
    )
    data, skipped = _select_data_lines(lines, options)
    sample = lines.decode_lines(_sample_lines(data))
    found = options.delimiter or (find_delimiter(sample) if sample else None)
    if not sample or (
        found is None and all(text.lstrip().startswith(COMMENT_PREFIXES) for text in sample)
    ):
        raise ReadError(f"{FILE} holds no points: only blank and comment lines.")
    if found is None:
        raise ReadError(
            f"{FILE} holds no table of points: no delimiter (comma, semicolon, tab, pipe, spaces) "
            f"gives three columns of numbers; its first line is '{sample[0][:60]}'."
        )
    data, skipped = _drop_fillers(lines, data, skipped, found, options)
    rows = lines.decode_lines(_sample_lines(data))
    cells = _split_rows(rows, found)
    if found == "," and options.delimiter is None:
        require_one_kind_of_comma(rows)
    if found == BLANKS:
        require_no_blank_groups(rows, count_stated_columns(options.columns))
    mark = _choose_decimal_mark(lines, data, cells, found, options)
    layout = _lay_out_table(lines, data, skipped, cells, (found, mark), options)
    return replace(layout, is_scan=suffix.lower() in _SCAN_SUFFIXES)


def _split_rows(rows: Sequence[str], delimiter: str) -> list[list[str]]:
    """Split some rows, and a header above them by its own delimiter where that is another."""
    cells = [split_line(text, delimiter) for text in rows]
    numbers = [sum(is_number(c, ".") or is_number(c, ",") for c in row) for row in cells]
    first = next((i for i, n in enumerate(numbers[:_TOP_LINES]) if n >= 2), 0)
    if delimiter == BLANKS:
        cells[:first] = map(join_brackets, cells[:first])
        body = [row for row, n in zip(cells, numbers, strict=True) if n >= 2]
        cells[:first] = [join_numbers(row, body) for row in cells[:first]]
    if any(names_coordinates(row) for row in cells[:first]):
        return cells
    counts = Counter(len(row) for row, n in zip(cells, numbers, strict=True) if n >= 2)
    for i in range(first):
        names = split_header(rows[i], delimiter, counts.most_common(1)[0][0])
        if names is not None:
            cells[i] = names
            break
    return cells


def _choose_decimal_mark(
    lines: TextLines,
    data: Int64Array,
    cells: list[list[str]],
    delimiter: str,
    options: LayoutOptions,
) -> DecimalMark:
    """Return the mark that the caller names, else that of the lines looked at, else of any."""
    if options.decimal is not None:
        require_no_delimiter(options.decimal, delimiter, cells)
        return DecimalMark(options.decimal)
    found = find_decimal_mark(cells, delimiter)
    if found is None and delimiter != ",":
        divided = lines.find_with_decimals(data)
        decimals = lines.decode_lines(_sample_lines(divided))
        found = find_decimal_mark([split_line(text, delimiter) for text in decimals], delimiter)
        if len(divided) == 0 and has_idle_commas(cells):
            found = DecimalMark(",")
    return found or DecimalMark(".")


def _lay_out_table(
    lines: TextLines,
    data: Int64Array,
    skipped: Counter[str],
    cells: list[list[str]],
    marks: tuple[str, DecimalMark],
    options: LayoutOptions,
) -> Layout:
    delimiter, (decimal, note) = marks
    count, has_text_tail = _count_columns(cells, delimiter, decimal, options)
    if count > _MOST_COLUMNS:
        raise ReadError(f"its rows have {count:,} columns; at most {_MOST_COLUMNS:,} are read.")
    top = _find_top(cells[:_TOP_LINES], count, decimal)
    rows, breaks = _select_rows(lines, data, top, delimiter, decimal)
    headers = [cells[k] for k in top.headers]
    below = [row for row in cells[top.n_lines :] if row not in headers]
    body = _select_even_rows(below, count, has_text_tail=has_text_tail)
    header = TopLines(lines, rows, top.header, tuple(top.units))
    columns, heading = find_named_columns(header, (delimiter, count), body, options.columns)
    if columns is None and options.decimal is None:
        require_no_split_decimals(body, delimiter)
    kinds = _Kinds.of(body, count, decimal)
    is_described = columns is not None and columns.roles.get("description") == count - 1
    return Layout(
        delimiter=delimiter,
        decimal=decimal,
        is_decimal_stated=options.decimal is not None,
        count=count,
        columns=columns,
        rows=rows,
        has_text_tail=has_text_tail or is_described or count - 1 in kinds.mostly_text,
        may_lack_tail=count - 1 not in kinds.has_numbers,
        text_columns=_find_text_columns(columns, kinds),
        mostly_text=kinds.mostly_text,
        padded=kinds.padded,
        divided=kinds.divided,
        announced=top.announced,
        has_semicolons=delimiter != ";" and bool(lines.starts_with(";")[rows - lines.first].any()),
        headers=tuple(_take_headers(lines, data, top)),
        skipped={what: many for what, many in (skipped + top.counts).items() if many},
        notes=((note,) if note else ()) + (() if columns is None else columns.notes) + breaks.notes,
        heading=heading,
        left_out=breaks.lines,
    )


def _select_rows(
    lines: TextLines, data: Int64Array, top: _Top, delimiter: str, decimal: str
) -> tuple[Int64Array, PageBreaks]:
    """Return the rows of the table, and the lines among them that are none."""
    rows = data[top.n_lines :]
    breaks = find_page_breaks(lines, rows, _take_headers(lines, data, top), delimiter, decimal)
    out = [line - 1 for found in breaks.lines.values() for line in found]
    rows = rows[~np.isin(rows, out)]
    if len(rows) == 0:
        raise ReadError("there is no row of numbers below the header.")
    if lines.is_last:
        require_announced(top.announced, len(rows))
    return rows, breaks


def _take_headers(lines: TextLines, data: Int64Array, top: _Top) -> list[str]:
    return [text.strip() for text in lines.decode_lines(data[top.headers].tolist())]


def require_announced(announced: int | None, n_rows: int) -> None:
    """Refuse a number of rows that is not the one which stands above the table."""
    if announced not in (None, n_rows):
        raise ReadError(
            f"the first line announces {counted(announced or 0, 'point')}, but "
            f"{counted(n_rows, 'row')} {'follows' if n_rows == 1 else 'follow'}: "
            "the file may be truncated."
        )


def continue_layout(lines: TextLines, head: Layout, *, comment: str | None) -> Layout:
    """Return how to read further lines of a table, whose head tells the layout.

    Parameters
    ----------
    lines : TextLines
    head : Layout
        Of the first lines of the file.
    comment : str, optional
        As of :func:`find_layout`.
    """
    options = LayoutOptions(delimiter=head.delimiter, decimal=head.decimal, comment=comment)
    data, skipped = _select_data_lines(lines, options)
    if not head.has_semicolons:
        data, skipped = _drop_fillers(
            lines, data, skipped, head.delimiter, options, may_be_data=False
        )
    breaks = find_page_breaks(lines, data, head.headers, head.delimiter, head.decimal)
    out = [line - 1 for found in breaks.lines.values() for line in found]
    return replace(
        head,
        rows=data[~np.isin(data, out)],
        skipped={what: many for what, many in skipped.items() if many},
        notes=breaks.notes,
        left_out=breaks.lines,
    )


def _select_even_rows(
    rows: Sequence[Sequence[str]], count: int, *, has_text_tail: bool
) -> list[Sequence[str]]:
    """Return the rows that have the right number of cells, a text at the end as one cell."""
    if not has_text_tail:
        return [row for row in rows if len(row) == count]
    return [
        [*row[: count - 1], " ".join(row[count - 1 :])] for row in rows if len(row) >= count - 1
    ]


# ------------------------------------------------------------------ lines


def _select_data_lines(lines: TextLines, options: LayoutOptions) -> tuple[Int64Array, Counter[str]]:
    """Set blank and comment lines aside; ``;`` is judged when the delimiter is known."""
    is_blank = lines.is_blank
    is_comment = np.zeros(len(lines), np.bool_)
    prefixes = COMMENT_PREFIXES if options.comment is None else (options.comment,)
    for prefix in prefixes:
        if prefix and not (options.comment is None and prefix == ";"):
            is_comment |= lines.starts_with(prefix)
    data = lines.number(~is_blank & ~is_comment)
    if len(data) == 0 and options.comment is None and lines.first == 0:
        is_comment[:] = False
        data = lines.number(~is_blank)
    counts = {"blank lines": int(is_blank.sum()), "comment lines": int(is_comment.sum())}
    return data, Counter(counts)


def _drop_fillers(
    lines: TextLines,
    data: Int64Array,
    skipped: Counter[str],
    delimiter: str,
    options: LayoutOptions,
    *,
    may_be_data: bool = True,
) -> tuple[Int64Array, Counter[str]]:
    """Set aside rows of nothing but delimiters, and comments that start with a semicolon."""
    if delimiter != BLANKS:
        starters = data[lines.starts_with(delimiter)[data - lines.first]]
        fillers = [i for i in starters if not lines.decode_line(i).strip(f"{delimiter} \t")]
        data = np.delete(data, np.searchsorted(data, np.array(fillers, np.int64)))
        skipped = skipped + Counter({"blank lines": len(fillers)})
    if options.comment is None and delimiter != ";":
        is_comment = lines.starts_with(";")[data - lines.first]
        if not (may_be_data and is_comment.all()):
            data = data[~is_comment]
            skipped = skipped + Counter({"comment lines": int(is_comment.sum())})
    return data, skipped


def _sample_lines(data: Int64Array) -> list[int]:
    top, rest = data[:_TOP_LINES], data[_TOP_LINES:]
    spread = rest[:: max(1, len(rest) // _SPREAD_LINES)]
    return [*top.tolist(), *spread.tolist()]


# ------------------------------------------------------------------ rows


def _count_columns(
    rows: Sequence[Sequence[str]], delimiter: str, decimal: str, options: LayoutOptions
) -> tuple[int, bool]:
    """Return the number of columns, and whether the last is text that may hold the delimiter."""
    body = [row for row in rows if sum(is_number(cell, decimal) for cell in row) >= 2] or rows
    counts = Counter(map(len, body))
    count = counts.most_common(1)[0][0]
    if delimiter != BLANKS and not any(row[-1] for row in body):  # delimiters at their ends
        return count, False
    n_named = _count_named_columns(rows, options)
    if n_named and (max(counts) >= n_named if delimiter == BLANKS else n_named <= count):
        return n_named, True
    if _MOST_ROWS * len(body) <= counts[count] and _is_headed(rows, count):
        return count, False
    tails = Counter(_find_text_tail(row, decimal) for row in body)
    tail = tails.most_common(1)[0][0]
    if tail is None or (delimiter != BLANKS and len(counts) == 1):
        return count, False
    return (tail + 1, True) if delimiter == BLANKS or tail + 1 <= count else (count, False)


def _is_headed(rows: Sequence[Sequence[str]], count: int) -> bool:
    """Whether a header names as many columns, and the coordinates among them."""
    top = (row for row in rows[:_TOP_LINES] if len(row) == count)
    return any(names_coordinates(row) is not None for row in top)


def _count_named_columns(rows: Sequence[Sequence[str]], options: LayoutOptions) -> int | None:
    """Return the number of columns if caller or header say that the last is a description."""
    if options.columns is not None and not isinstance(options.columns, Mapping):
        given = list_meanings(options.columns)
        return len(given) if given[-1:] == ["description"] else None
    for row in rows[:_TOP_LINES]:
        known = names_coordinates(row)
        if known is not None and known.roles.get("description") == len(row) - 1:
            return len(row)
    return None


def _find_text_tail(row: Sequence[str], decimal: str) -> int | None:
    """Return where, behind the coordinates, nothing but text follows."""
    texts = [not is_number_like(cell, decimal) for cell in row]
    first = next((i for i in range(3, len(row)) if texts[i]), None)
    return first if first is not None and texts[first] and not _resumes(texts, first) else None


def _resumes(texts: Sequence[bool], first: int) -> bool:
    """Whether the row ends in numbers behind a single word, so that the word is a column."""
    return len(texts) - first > 2 and not any(texts[first + 1 :])


def _find_top(rows: Sequence[Sequence[str]], count: int, decimal: str) -> _Top:
    """Walk down to the first row of the table."""
    top = _Top()
    is_known = False
    n_titles = _count_titles(rows, decimal)
    for place, row in enumerate(rows):
        kind = _classify_line(row, count, decimal, is_known)
        if place < n_titles and kind != "point count":
            kind = "title lines"
        if kind == "row":
            break
        if kind == "point count":
            top.announced = int(row[0])
        if kind == "header lines" and not is_known:
            is_known = names_coordinates(row) is not None
            top.header = list(row)
        elif kind == "header lines":
            top.units = list(row)
        if kind == "header lines":
            top.headers.append(top.n_lines)
        top.counts[kind] += 1
        top.n_lines += 1
    return top


def _count_titles(rows: Sequence[Sequence[str]], decimal: str) -> int:
    """Return how many lines stand above the first header, none of them with two numbers."""
    for place, row in enumerate(rows):
        if sum(is_number(cell, decimal) for cell in row) > 1:
            return 0
        if names_coordinates(row) is not None:
            return place
    return 0


def _classify_line(row: Sequence[str], count: int, decimal: str, is_header_known: bool) -> str:
    """Tell what a line above the first row is, or that it is the first row."""
    numbers = sum(is_number(cell, decimal) for cell in row)
    if is_header_known:
        is_units = all(
            cell.strip("()[]").lower() in _UNIT_WORDS or find_unit_word(f"({cell.strip('()[]')})")
            for cell in row
        )
        return "header lines" if is_units and numbers == 0 else "row"
    if names_coordinates(row) is not None:
        return "header lines"
    if len(row) == 1 and count > 1 and row[0].isdecimal() and len(row[0]) <= _COUNT_DIGITS:
        return "point count"
    if abs(len(row) - count) <= 1 and not any(
        is_number_like(cell, decimal) for cell in row if cell
    ):
        return "header lines" if len(row) > 1 else "title lines"
    if len(row) != count and numbers < 2 and not (row[0] and is_number_like(row[0], decimal)):
        return "title lines"
    return "row"


# ------------------------------------------------------------------ columns


@dataclass(frozen=True, slots=True)
class _Kinds:
    """Columns by what their cells look like in the rows looked at."""

    has_text: frozenset[int]
    has_numbers: frozenset[int]
    mostly_text: frozenset[int]
    padded: frozenset[int]
    divided: frozenset[int]

    @classmethod
    def of(cls, body: Sequence[Sequence[str]], count: int, decimal: str) -> _Kinds:
        """Look at every cell of some rows."""
        columns = [[row[i] for row in body] for i in range(count)]
        texts = [[c for c in cells if not is_number_like(c, decimal)] for cells in columns]
        marks = (decimal, "e", "E")

        def where(which: Callable[[int], bool]) -> frozenset[int]:
            return frozenset(filter(which, range(count)))

        def are_divided(i: int) -> bool:
            return any(m in c for c in columns[i] if is_number(c, decimal) for m in marks)

        return cls(
            has_text=where(lambda i: bool(texts[i])),
            has_numbers=where(lambda i: any(is_number(c, decimal) for c in columns[i])),
            mostly_text=where(lambda i: 2 * len(texts[i]) > len(body)),
            padded=where(lambda i: any(map(is_padded, columns[i]))),
            divided=where(are_divided),
        )


def _find_text_columns(columns: Columns | None, kinds: _Kinds) -> frozenset[int]:
    """Return description, point numbers with leading zeros, and other columns of text."""
    text = kinds.has_text | kinds.padded
    if columns is None:
        return text
    described = {columns.roles["description"]} if "description" in columns.roles else set()
    return (text | described) - set(columns.coordinates)
