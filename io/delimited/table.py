"""The rows of a table become arrays: checked for shape, parsed, checked for numbers.

A row that is wrong is a fault with its line; whether faults are refused or left out is for the
caller to say.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from io import StringIO
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import ReadError
from ...base.progress import Progress
from ...base.sentences import FILE, counted, inflect
from .cell_bounds import find_cell_bounds
from .cells import (
    BLANKS,
    is_grouped,
    is_missing,
    is_number,
    parse_grouped,
    parse_number,
    proves_groups,
    split_line,
)
from .columns import COORDINATES, find_unit_word
from .parsing import Column, parse_column

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.progress import Tell
    from .cell_bounds import CellBounds
    from .columns import Columns
    from .layout import Layout
    from .lines import TextLines

_SHOWN = 5
_QUOTED_ROWS = 2_000
_REWRITTEN_DELIMITER = "\t"
_GROUP_DIGITS = 3
_LOOKED_AT = 200
"""Rows above the last one whose decimals are counted."""

_FEWEST = 3
"""Rows that show how many decimals a file has."""
_REWRITTEN = 0.7
"""Of the work as it is told, what is done once all rows are written anew."""


class Fault(NamedTuple):
    """What is wrong with a row: its line (from 0), the kind of fault, and what is there."""

    line: int
    kind: str
    what: str


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """The rows of a table that have the right number of cells, and those that have not."""

    columns: tuple[AnyArray, ...]
    """Each (n,), as :func:`.parsing.parse_column` returns them."""
    rows: Int64Array
    """(n,), line number (from 0) of each row."""
    faults: tuple[Fault, ...] = ()


class Table(NamedTuple):
    """Coordinates, other columns by name, lines, and the rows that are left out.

    Elevations are NaN where the row has none.
    """

    points: Float64Array
    attributes: dict[str, AnyArray]
    rows: Int64Array
    faults: tuple[Fault, ...]
    n_grouped: int


def read_cells(lines: TextLines, layout: Layout, *, progress: Tell | None = None) -> Cells:
    """Read the cells of every row.

    Parameters
    ----------
    lines : TextLines
    layout : Layout
    progress : callable, optional
        Called with the fraction done, by blocks of rows that are rewritten, and by columns.

    Notes
    -----
    Rows whose quotes and delimiters are regular are parsed as they are; others are rewritten
    one by one, by the rules of Python's csv module, on the way. Every number is the float64
    nearest to its text.
    """
    done = Progress(progress)
    data = lines.join(layout.rows)
    if layout.delimiter != layout.decimal:
        bounds = find_cell_bounds(data, layout.delimiter, layout.count)
        if bounds is not None:
            return Cells(_parse_columns(bounds, layout, done.stage(0.3, 1.0)), layout.rows)
    data, rows, faults = _rewrite_rows(lines, layout, done.stage(0.0, _REWRITTEN))
    if len(rows) == 0:
        raise describe_faults_of_rows(faults, len(layout.rows), lines, layout)
    bounds = find_cell_bounds(data, _REWRITTEN_DELIMITER, layout.count)
    if bounds is None or len(bounds) != len(rows):
        raise ReadError(
            f"{FILE} has {counted(len(rows), 'row')}, but the parser makes others of them: "
            "check its quotes.",
        )
    columns = _parse_columns(bounds, layout, done.stage(_REWRITTEN, 1.0))
    return Cells(columns, rows, tuple(faults))


def _parse_columns(
    bounds: CellBounds, layout: Layout, progress: Tell | None
) -> tuple[AnyArray, ...]:
    done, columns = Progress(progress), []
    for i in range(layout.count):
        is_text = i in layout.text_columns
        columns.append(parse_column(bounds, i, decimal=layout.decimal, is_text=is_text))
        done((i + 1) / layout.count)
    return tuple(columns)


def describe_faults_of_rows(
    faults: Sequence[Fault], n_rows: int, lines: TextLines, layout: Layout
) -> ReadError:
    """Return the error that counts the rows at fault, and shows the first of the first kind."""
    kind = "quote" if any(fault.kind == "quote" for fault in faults) else faults[0].kind
    wrong = [fault for fault in faults if fault.kind == kind]
    numbers = [fault.line + 1 for fault in wrong[:_SHOWN]]
    if kind == "quote":
        sentence = f"{FILE}, line {numbers[0]}: {wrong[0].what}."
        return ReadError(sentence, lines=numbers)
    join = " " if kind == "columns" else ": "
    shown = ", ".join(f"line {one.line + 1}{join}{one.what}" for one in wrong[:_SHOWN])
    mark = "point" if layout.decimal == "." else "comma"
    fails = {
        "columns": f"[does|do] not have {layout.count} columns",
        "number": f"[has|have] a coordinate that is not a finite number with decimal {mark}",
    }[kind]
    is_cut = kind == "columns" and wrong[-1].line == lines.last and not lines.is_whole
    hint = "; the last line has no end, so the file may be truncated" if is_cut else ""
    return ReadError(
        f"{len(wrong)} of {counted(n_rows, 'row')} {inflect(fails, len(wrong))} "
        f"({shown}{', ...' if len(wrong) > _SHOWN else ''}){hint}; the option `skip_bad` leaves "
        "such rows out.",
        lines=numbers,
    )


# ------------------------------------------------------------------ shape


def _rewrite_rows(
    lines: TextLines, layout: Layout, progress: Tell | None
) -> tuple[bytes, Int64Array, list[Fault]]:
    """Write the rows anew with plain quotes; leave those out that have not the right cells."""
    text = StringIO(newline="")
    writer = csv.writer(text, delimiter=_REWRITTEN_DELIMITER, lineterminator="\n")
    kept: list[int] = []
    faults: list[Fault] = []
    last = -1 if lines.is_whole else lines.last
    for line, raw, cells in _iterate_cells(lines, layout, Progress(progress)):
        if isinstance(cells, str):
            faults.append(Fault(line, "quote", cells))
            continue
        if layout.has_text_tail:
            cells = _join_tail(cells, raw, layout, line == last)
        if len(cells) == layout.count:
            writer.writerow(cells)
            kept.append(line)
        else:
            faults.append(Fault(line, "columns", f"has {len(cells)}"))
    return text.getvalue().removesuffix("\n").encode(), np.array(kept, np.int64), faults


def _iterate_cells(
    lines: TextLines, layout: Layout, done: Progress
) -> Iterator[tuple[int, str, list[str] | str]]:
    """Walk the rows: line number (from 0), its text, and its cells or what is wrong with them."""
    for start in range(0, len(layout.rows), _QUOTED_ROWS):
        rows = layout.rows[start : start + _QUOTED_ROWS]
        text = lines.join(rows).decode()
        if layout.delimiter == BLANKS:
            texts = [line.strip(" ") for line in text.replace("\t", " ").split("\n")]
        else:
            texts = text.split("\n")
        split = _split_by_csv(texts, layout.delimiter)
        yield from zip(rows.tolist(), texts, split, strict=True)
        done((start + len(rows)) / len(layout.rows))


def _split_by_csv(texts: Sequence[str], delimiter: str) -> Iterator[list[str] | str]:
    """Split texts by the rules of CSV; begin anew behind one that is at fault."""
    done = 0
    while done < len(texts):
        # An empty text at the end is what a quote left open would swallow.
        reader = csv.reader(chain(texts[done:], [""]), delimiter=delimiter, skipinitialspace=True)
        for number in range(1, len(texts) - done + 1):
            try:
                cells = next(reader)
            except csv.Error as error:
                yield str(error)
                break
            if reader.line_num != number:
                yield (
                    "a quote opens a cell and is not closed on the line; a quote at the start of "
                    'a cell must be doubled ("")'
                )
                break
            yield cells
        done += number


def _join_tail(cells: list[str], raw: str, layout: Layout, is_cut: bool) -> list[str]:
    """Join the cells of a text that holds the delimiter; a row that is whole may have none."""
    count = layout.count
    if len(cells) == count - 1 and not is_cut and layout.may_lack_tail:
        return [*cells, ""]
    if len(cells) <= count or _may_be_split_numbers(cells[count - 2 :], layout):
        return cells
    if layout.delimiter == BLANKS:
        return [*cells[: count - 1], " ".join(cells[count - 1 :])]
    if '"' in raw:
        return [*cells[: count - 1], layout.delimiter.join(cells[count - 1 :])]
    return [*cells[: count - 1], raw.split(layout.delimiter, count - 1)[-1].strip()]


def _may_be_split_numbers(cells: Sequence[str], layout: Layout) -> bool:
    """Whether a text that seems to hold the delimiter may be numbers that do: 1,032.5 or 2,50.

    ``cells`` begin with the one before the text.
    """
    before, first, second = [cell.strip() for cell in (*cells, "", "")][:3]
    mark = layout.decimal
    first, _, rest = first.partition(" ")  # 083 m
    if not is_number(first, mark) or (rest and find_unit_word(f"({rest})") is None):
        return False
    is_group = len(first.partition(mark)[0]) == _GROUP_DIGITS and before.lstrip("+-").isdecimal()
    return is_group or layout.delimiter != BLANKS or is_number(second, mark)


# ------------------------------------------------------------------ numbers


class _Numbers(NamedTuple):
    """A column as floats, NaN for what is none; where cells are empty; how many were grouped."""

    values: Float64Array
    is_missing: BoolArray
    n_grouped: int = 0


def _parse_numbers(column: AnyArray, layout: Layout, *, has_groups: bool) -> _Numbers:
    """Read the numbers of a column, those with thousands separators where these are proved."""
    if column.dtype.kind in "fi":
        values = column.astype(np.float64)
        return _Numbers(values, np.isnan(values))
    if column.dtype.kind == "b":
        return _Numbers(np.full(len(column), np.nan), np.zeros(len(column), np.bool_))
    cells = _strip_texts(column)
    decimal = layout.decimal
    values = np.fromiter((parse_number(cell, decimal) for cell in cells), np.float64, len(cells))
    odd = np.flatnonzero(np.isnan(values)).tolist()
    missing = np.zeros(len(cells), np.bool_)
    missing[[i for i in odd if is_missing(cells[i])]] = True
    grouped = [i for i in odd if has_groups and is_grouped(cells[i], decimal)]
    values[grouped] = [parse_grouped(cells[i], decimal) for i in grouped]
    return _Numbers(values, missing, len(grouped))


def _strip_texts(column: AnyArray) -> list[str]:
    return [cell.strip() for cell in column.tolist()]


def _has_groups(cells: Cells, columns: Iterable[int], layout: Layout) -> bool:
    """Whether separators of thousands are proved: by the caller, the decimal mark, or a cell.

    1,234 alone may be 1.234; beside 12.5 or 4,024,240 it is a thousand and more.
    """
    if layout.is_decimal_stated or layout.divided.intersection(columns):
        return True  # as the head of a file tells of all that follows
    mark = layout.decimal
    return any(
        proves_groups(cell, mark) or (mark in cell and is_number(cell, mark))
        for i in columns
        if cells.columns[i].dtype.kind not in "fib"
        for cell in _strip_texts(cells.columns[i])
    )


def describe_columns(cells: Cells, layout: Layout) -> list[Column]:
    """Describe what is in each column, to tell what it means."""
    numeric = [i for i in range(layout.count) if i not in layout.mostly_text]
    has_groups = _has_groups(cells, numeric, layout)
    return [
        _describe_column(cells.columns[i], i, layout, has_groups=has_groups)
        for i in range(layout.count)
    ]


def _describe_column(column: AnyArray, i: int, layout: Layout, *, has_groups: bool) -> Column:
    if i in layout.mostly_text:
        distinct = len(set(column.tolist())) / len(column)
        text = next((cell for cell in column.tolist() if isinstance(cell, str) and cell), "")
        nothing = np.full(len(column), np.nan)
        return Column(nothing, is_text=True, distinct_share=distinct, text=text)
    numbers = _parse_numbers(column, layout, has_groups=has_groups)
    values = numbers.values
    is_there = ~np.isnan(values)
    known = values if is_there.all() else values[is_there]
    is_whole = i not in layout.divided and len(known) > 0 and _are_counts(known)
    return Column(
        values,
        is_whole=is_whole,
        is_padded=i in layout.padded,
        text_share=float((~is_there & ~numbers.is_missing).mean()),
        distinct_share=_measure_distinct_share(known) if is_whole else 1.0,
    )


def _are_counts(values: Float64Array) -> bool:
    with np.errstate(invalid="ignore"):
        return bool((values >= 0).all() and (np.floor(values) == values).all())


def _measure_distinct_share(values: Float64Array) -> float:
    if len(values) < 2 or (np.diff(values) > 0).all():
        return 1.0
    return len(np.unique(values)) / len(values)


# ------------------------------------------------------------------ the table


def require_one_mark(
    cells: Cells, columns: Columns, layout: Layout, *, is_continued: bool = False
) -> None:
    """Refuse 512,350 beside 512.700: a decimal mark or a group, as no other coordinate tells.

    ``is_continued`` tells that the head of the file has numbers with the decimal mark, too, where
    the layout says so.
    """
    mark = layout.decimal
    texts = {
        i: _strip_texts(cells.columns[i])
        for i in columns.coordinates
        if cells.columns[i].dtype.kind not in "fib" and not layout.is_decimal_stated
    }
    grouped = {i: [c for c in column if is_grouped(c, mark)] for i, column in texts.items()}
    if any(mark in c or proves_groups(c, mark) for found in grouped.values() for c in found):
        return
    for i, column in texts.items():
        divided = next((c for c in column if mark in c and is_number(c, mark)), None)
        if divided is None and is_continued and i in layout.divided:
            divided = f"0{mark}0"
        if grouped[i] and divided is not None:
            line = int(cells.rows[column.index(grouped[i][0])]) + 1
            raise ReadError(
                f"{FILE}, line {line}: '{grouped[i][0]}' beside '{divided}' in "
                f"{columns.label(i)} may have a decimal mark or separate thousands: write all "
                f"numbers in one way, or `decimal='{mark}'` takes the other mark as that of "
                "thousands.",
                lines=[line],
            )


def read_table(
    cells: Cells,
    layout: Layout,
    columns: Columns,
    lines: TextLines,
    *,
    keeps_empty: bool = False,
) -> Table:
    """Take the coordinates and the attributes of rows; rows with bad numbers become faults.

    ``keeps_empty`` keeps columns without a name that are empty here, and may not be elsewhere.
    """
    has_groups = _has_groups(cells, columns.coordinates, layout)
    numbers = [
        _parse_numbers(cells.columns[column], layout, has_groups=has_groups)
        for column in columns.coordinates
    ]
    points = np.column_stack([one.values for one in numbers])
    is_bad = ~np.isfinite(points)
    is_bad[:, 2] &= ~numbers[2].is_missing
    bad = np.flatnonzero(is_bad.any(axis=1))
    faults = [
        Fault(int(cells.rows[row]), "number", _describe_fault(lines, layout, columns, line, k))
        for row, line, k in zip(
            bad, cells.rows[bad].tolist(), is_bad[bad].argmax(axis=1).tolist(), strict=True
        )
    ]
    good = np.delete(np.arange(len(points)), bad) if len(bad) else slice(None)
    attributes = _collect_attributes(cells, columns, keeps_empty=keeps_empty)
    return Table(
        points[good],
        {name: values[good] for name, values in attributes.items()},
        cells.rows[good],
        tuple(sorted((*cells.faults, *faults))),
        sum(one.n_grouped for one in numbers),
    )


def _describe_fault(lines: TextLines, layout: Layout, columns: Columns, line: int, k: int) -> str:
    """Say which cell of a row is at fault, and what is in it."""
    column = columns.coordinates[k]
    cells = split_line(lines.decode_line(line), layout.delimiter)
    cell = cells[column] if column < len(cells) else ""
    value = f"is '{cell[:40]}'" if cell else "is empty"
    return f"{COORDINATES[k]} in {columns.label(column)} {value}"


# ------------------------------------------------------------------ attributes


def _collect_attributes(
    cells: Cells, columns: Columns, *, keeps_empty: bool
) -> dict[str, AnyArray]:
    """Return the columns that are no coordinates, by role or name; empty unnamed ones are left."""
    roles = {column: role for role, column in columns.roles.items()}
    attributes: dict[str, AnyArray] = {}
    for column, name in enumerate(columns.names):
        if roles.get(column) in COORDINATES:
            continue
        values = cells.columns[column]
        if not keeps_empty and name == f"column {column + 1}" and _is_empty(values):
            continue
        attributes[roles.get(column, name)] = values
    return attributes


def _is_empty(values: AnyArray) -> bool:
    return bool((values == "").all() if values.dtype == object else np.isnan(values).all())


# ------------------------------------------------------------------ a last line without an end


def leave_out_cut_row(
    table: Table, lines: TextLines, layout: Layout, columns: Columns, *, skip_bad: bool
) -> tuple[Table, list[str]]:
    """Leave out a last row whose last number lacks decimals that all others have.

    Parameters
    ----------
    table : Table
    lines : TextLines
    layout : Layout
    columns : Columns
    skip_bad : bool
        Whether bad rows are left out.

    Returns
    -------
    table : Table
    notes : list of str
        Tell where others have several numbers of decimals, so that nothing is certain.
    """
    last = lines.last
    if lines.is_whole or len(table.rows) <= _FEWEST or table.rows[-1] != last:
        return table, []
    cells = split_line(lines.decode_line(last), layout.delimiter)
    column = len(cells) - 1
    own = _count_decimals(cells, column, layout.decimal)
    if column not in columns.coordinates or own is None:
        return table, []
    above = table.rows[-1 - _LOOKED_AT : -1].tolist()
    texts = (split_line(text, layout.delimiter) for text in lines.decode_lines(above))
    counts = {_count_decimals(row, column, layout.decimal) for row in texts} - {None}
    fewest = min((count for count in counts if count is not None), default=0)
    if own >= fewest:
        return table, []
    what = f"its last number '{cells[column][:40]}' has {counted(own, 'decimal')}"
    if len(counts) > 1:
        return table, [
            f"Line {last + 1}, the last, has no end, and {what}, fewer than all above: if the file "
            "was cut off, the number is not whole."
        ]
    if not skip_bad:
        raise ReadError(
            f"{FILE}, line {last + 1}: {what}, those above have {fewest}, and the line has no "
            "end: the file may be truncated; the option `skip_bad` leaves the row out.",
            lines=[last + 1],
        )
    return table._replace(
        points=table.points[:-1],
        attributes={name: values[:-1] for name, values in table.attributes.items()},
        rows=table.rows[:-1],
        faults=tuple(sorted((*table.faults, Fault(last, "number", f"{what} and may be cut off")))),
    ), []


def _count_decimals(cells: list[str], column: int, decimal: str) -> int | None:
    """Return how many decimals a cell has; None if it is no plain number."""
    cell = cells[column] if column < len(cells) else ""
    if not is_number(cell, decimal) or "e" in cell.lower():
        return None
    return len(cell.partition(decimal)[2])
