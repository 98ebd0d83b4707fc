"""The rows of a table become arrays: checked for shape, parsed by pandas, checked for numbers."""

from __future__ import annotations

import csv
from io import BytesIO, StringIO
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .delimited_cells import BLANKS, as_number, split_line
from .delimited_columns import COORDINATES
from .errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    import pandas as pd
    from numpy.typing import NDArray

    from .delimited_layout import Layout
    from .delimited_lines import TextLines

__all__ = ["Table", "read_table"]

_SHOWN = 5
_CHUNK_ROWS = 100_000
_QUOTE, _SPACE, _TAB, _LINE_FEED = b'" \t\n'
_REWRITTEN_DELIMITER = "\t"


class Table(NamedTuple):
    """Coordinates, (n, 3) float64, and the other columns by name."""

    points: NDArray[np.float64]
    attributes: dict[str, NDArray[Any]]


def read_table(lines: TextLines, layout: Layout, path: Path) -> Table:
    """Read every row.

    Parameters
    ----------
    lines : TextLines
    layout : Layout
    path : Path
        For sentences.

    Raises
    ------
    ReadError
        If a row has too few or too many cells, an open quote, or a coordinate that is no finite
        number; with the line numbers in the file.

    Notes
    -----
    Rows whose quotes and delimiters are regular go to pandas as they are; others are rewritten
    one by one, by the rules of Python's csv module, on the way. Every number is the float64
    nearest to its text.
    """
    data = lines.joined(layout.rows)
    delimiter = layout.delimiter
    if not _is_regular(data, layout):
        data = _rewritten(lines, layout, path)
        delimiter = _REWRITTEN_DELIMITER
    frame = _parsed(data, delimiter, layout)
    if len(frame) != len(layout.rows):
        raise ReadError(
            f"'{path}' has {len(layout.rows)} rows, but the parser made {len(frame)} of them: "
            "check its quotes.",
            path=path,
        )
    points = np.empty((len(frame), 3))
    for k, column in enumerate(layout.columns.coordinates):
        points[:, k] = _numbers(frame[column], layout.decimal)
    _require_finite(points, lines, layout, path)
    return Table(points, _attributes(frame, layout))


def _parsed(data: bytes, delimiter: str, layout: Layout) -> pd.DataFrame:
    import pandas as pd

    numbers = [i for i in range(layout.count) if i not in layout.text_columns]
    # From pandas 3.1 on every number is parsed exactly, and asking for it is deprecated.
    is_exact = tuple(int(part) for part in pd.__version__.split(".")[:2]) >= (3, 1)
    options: dict[str, Any] = {} if is_exact else {"float_precision": "round_trip"}
    options |= {
        "sep": r"\s+" if delimiter == BLANKS else delimiter,
        "header": None,
        "names": list(range(layout.count)),
        "index_col": False,
        "dtype": dict.fromkeys(sorted(layout.text_columns), object),
        "decimal": layout.decimal,
        "skipinitialspace": True,
        "skip_blank_lines": False,
        "keep_default_na": False,
        "na_values": {i: [""] for i in numbers},
        "encoding": "utf-8",
        "engine": "c",
        "low_memory": False,
    }
    frame: pd.DataFrame = pd.read_csv(BytesIO(data), **options)
    return frame


# ------------------------------------------------------------------ shape


def _is_regular(data: bytes, layout: Layout) -> bool:
    """Whether every row has the right number of cells by a count that pandas agrees with."""
    codes = np.frombuffer(data, np.uint8)
    ends = np.append(np.flatnonzero(codes == _LINE_FEED), len(codes))
    starts = np.append(0, ends[:-1] + 1)
    if layout.delimiter == BLANKS:
        return b'"' not in data and _has_even_words(codes, starts, ends, layout.count)
    places = np.flatnonzero(codes == ord(layout.delimiter))
    if b'"' in data:
        quotes = np.flatnonzero(codes == _QUOTE)
        if not _are_plain(quotes, codes, ord(layout.delimiter), ends):
            return False
        places = _outside(places, quotes)
    return _has_even(places, starts, ends, layout.count - 1)


def _has_even(
    places: NDArray[np.int64], starts: NDArray[np.int64], ends: NDArray[np.int64], count: int
) -> bool:
    """Whether exactly ``count`` of the places (ascending) lie in every line."""
    if len(places) != count * len(starts):
        return False
    by_line = places.reshape(-1, count)
    return bool((by_line[:, 0] >= starts).all() and (by_line[:, -1] < ends).all())


def _has_even_words(
    codes: NDArray[np.uint8], starts: NDArray[np.int64], ends: NDArray[np.int64], count: int
) -> bool:
    is_gap = (codes == _SPACE) | (codes == _TAB) | (codes == _LINE_FEED)
    is_word_start = ~is_gap
    is_word_start[1:] &= is_gap[:-1]
    return _has_even(np.flatnonzero(is_word_start), starts, ends, count)


def _are_plain(
    quotes: NDArray[np.int64], codes: NDArray[np.uint8], delimiter: int, ends: NDArray[np.int64]
) -> bool:
    """Whether no quote stands where only care can read it.

    Quotes are plain if they are closed on their line, open at the start of a cell, and close at
    the end of one or are doubled.
    """
    if len(quotes) % 2:
        return False
    opening, closing = quotes[0::2], quotes[1::2]
    if (np.searchsorted(ends, opening) != np.searchsorted(ends, closing)).any():
        return False
    before, behind = opening - 1, closing + 1
    beside = codes[np.concatenate([before[before >= 0], behind[behind < len(codes)]])]
    return bool(np.isin(beside, [delimiter, _QUOTE, _LINE_FEED]).all())


def _outside(places: NDArray[np.int64], quotes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the places (ascending) that do not lie between an opening and its closing quote."""
    first = np.searchsorted(places, quotes[0::2])
    counts = np.searchsorted(places, quotes[1::2]) - first
    running = np.cumsum(counts)
    total = int(running[-1])
    return np.delete(places, np.repeat(first - running + counts, counts) + np.arange(total))


def _rewritten(lines: TextLines, layout: Layout, path: Path) -> bytes:
    """Write the rows anew with plain quotes.

    Raises
    ------
    ReadError
        If a row has too few or too many cells, or an open quote.
    """
    text = StringIO(newline="")
    writer = csv.writer(text, delimiter=_REWRITTEN_DELIMITER, lineterminator="\n")
    wrong: list[tuple[int, int]] = []
    for line, cells in _rows(lines, layout, path):
        if len(cells) == layout.count:
            writer.writerow(cells)
        else:
            wrong.append((line, len(cells)))
    if wrong:
        raise _wrong_counts(wrong, lines, layout, path)
    return text.getvalue().encode()


def _rows(lines: TextLines, layout: Layout, path: Path) -> Iterator[tuple[int, list[str]]]:
    """Walk the rows: line number (from 0) and cells, a tail of text as one cell."""
    delimiter = layout.delimiter
    reader = csv.reader(_texts(lines, layout), delimiter=delimiter, skipinitialspace=True)
    last = -1 if lines.is_whole else len(lines) - 1
    for number, line in enumerate(layout.rows.tolist(), 1):
        try:
            cells = next(reader)
        except csv.Error as error:
            raise ReadError(
                f"'{path}', line {line + 1}: {error}.", path=path, lines=[line + 1]
            ) from error
        if reader.line_num != number:
            raise ReadError(
                f"'{path}', line {line + 1}: a quote opens a cell and is not closed on the line; "
                'a quote at the start of a cell must be doubled ("").',
                path=path,
                lines=[line + 1],
            )
        yield line, _with_tail(cells, layout.count, line == last) if layout.has_text_tail else cells


def _texts(lines: TextLines, layout: Layout) -> Iterator[str]:
    """Walk the texts of the rows, and an empty one that a quote left open would swallow."""
    for start in range(0, len(layout.rows), _CHUNK_ROWS):
        text = lines.joined(layout.rows[start : start + _CHUNK_ROWS]).decode()
        if layout.delimiter == BLANKS:
            yield from (line.strip(" ") for line in text.replace("\t", " ").split("\n"))
        else:
            yield from text.split("\n")
    yield ""


def _with_tail(cells: list[str], count: int, is_cut: bool) -> list[str]:
    """Join the words of a description; a row that is whole may have none."""
    if len(cells) == count - 1 and not is_cut:
        return [*cells, ""]
    return [*cells[: count - 1], " ".join(cells[count - 1 :])] if len(cells) > count else cells


def _wrong_counts(
    wrong: Sequence[tuple[int, int]], lines: TextLines, layout: Layout, path: Path
) -> ReadError:
    shown = ", ".join(f"line {line + 1} has {count}" for line, count in wrong[:_SHOWN])
    is_cut = wrong[-1][0] == len(lines) - 1 and not lines.is_whole
    hint = "; the last line has no end, so the file may be truncated" if is_cut else ""
    return ReadError(
        f"'{path}': {len(wrong)} of {len(layout.rows)} rows do not have {layout.count} columns "
        f"({shown}{', ...' if len(wrong) > _SHOWN else ''}){hint}.",
        path=path,
        lines=[line + 1 for line, _ in wrong[:_SHOWN]],
    )


# ------------------------------------------------------------------ numbers


def _numbers(column: pd.Series[Any], decimal: str) -> NDArray[np.float64]:
    """Return a column as floats, NaN for what is none."""
    if column.dtype.kind in "fiu":
        return column.to_numpy(np.float64)
    if column.dtype.kind == "b":
        return np.full(len(column), np.nan)
    cells = column.fillna("").astype(str)
    return np.fromiter((as_number(cell, decimal) for cell in cells), np.float64, len(cells))


def _require_finite(
    points: NDArray[np.float64], lines: TextLines, layout: Layout, path: Path
) -> None:
    is_bad = ~np.isfinite(points)
    bad_rows = np.flatnonzero(is_bad.any(axis=1))
    if len(bad_rows) == 0:
        return
    shown = ", ".join(
        _fault(lines, layout, int(row), int(np.argmax(is_bad[row]))) for row in bad_rows[:_SHOWN]
    )
    mark = "point" if layout.decimal == "." else "comma"
    raise ReadError(
        f"'{path}': {len(bad_rows)} of {len(points)} rows have a coordinate that is not a finite "
        f"number with decimal {mark} ({shown}{', ...' if len(bad_rows) > _SHOWN else ''}).",
        path=path,
        lines=(layout.rows[bad_rows[:_SHOWN]] + 1).tolist(),
    )


def _fault(lines: TextLines, layout: Layout, row: int, k: int) -> str:
    """Say which cell of a row is at fault, and what is in it."""
    line = int(layout.rows[row])
    column = layout.columns.coordinates[k]
    cell = split_line(lines.text(line), layout.delimiter)[column]
    value = f"is '{cell[:40]}'" if cell else "is empty"
    return f"line {line + 1}: {COORDINATES[k]} in {layout.columns.label(column)} {value}"


# ------------------------------------------------------------------ attributes


def _attributes(frame: pd.DataFrame, layout: Layout) -> dict[str, NDArray[Any]]:
    """Return the columns that are no coordinates, by role or name; empty unnamed ones are left."""
    roles = {column: role for role, column in layout.columns.roles.items()}
    attributes: dict[str, NDArray[Any]] = {}
    for column, name in enumerate(layout.columns.names):
        if roles.get(column) in COORDINATES:
            continue
        values = _values(frame[column])
        if name == f"column {column + 1}" and _is_empty(values):
            continue
        attributes[roles.get(column, name)] = values
    return attributes


def _values(column: pd.Series[Any]) -> NDArray[Any]:
    """Return numbers as they are, anything else as text, an empty cell as an empty text."""
    if column.dtype.kind in "fiub":
        return column.to_numpy()
    return column.fillna("").to_numpy(dtype=object)


def _is_empty(values: NDArray[Any]) -> bool:
    return bool((values == "").all() if values.dtype == object else np.isnan(values).all())
