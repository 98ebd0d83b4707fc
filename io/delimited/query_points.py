"""Query points in a text file with a header: two columns of coordinates, and others."""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from io import StringIO
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import CrsError, OptionError, ReadError
from ...base.sentences import FILE, counted
from ...tin.screening import AreaOfUse
from ..door import names_its_file
from .axes import describe_turn, is_northing, require_one_hemisphere
from .columns import describe_doubts
from .coordinate_columns import find_plane_pair
from .names import parse_name

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array, ObjectArray
    from ...base.crs import CRS

_DELIMITERS = {",": "commas", ";": "semicolons", "\t": "tabs"}
_SHOWN = 5


@dataclass(frozen=True, kw_only=True, eq=False)
class QueryPoints:
    """A table with points at which something is asked."""

    columns: dict[str, ObjectArray]
    """Each (n,), the text of every cell, as it stands in the file."""
    xy: Float64Array
    """(n, 2)."""
    is_degrees: bool
    """Whether the columns of coordinates are called longitude and latitude."""
    notes: tuple[str, ...]
    """What was assumed."""

    def require_lengths(self, crs: CRS | None) -> None:
        """Refuse, by a CrsError, longitudes and latitudes, but where the CRS has them."""
        if self.is_degrees and not (crs is not None and crs.is_geographic):
            raise CrsError(
                f"Points of {FILE} are longitudes and latitudes by their header, and lengths are "
                "needed: transform them first.",
                crs=crs,
            )


class TextTable(NamedTuple):
    """The cells of a text file, as they stand there, and the lines of its rows."""

    header: list[str]
    rows: list[list[str]]
    lines: list[int]


@names_its_file
def read_query_points(
    path: Path,
    *,
    columns: tuple[str, str] | None = None,
    delimiter: str | None = None,
    crs: CRS | None = None,
) -> QueryPoints:
    """Read points from a text file whose first line names the columns.

    Parameters
    ----------
    path : Path
    columns : (str, str), optional
        Names of the columns of easting (longitude) and northing (latitude); default those that
        are called so.
    crs : CRS, optional
        Of the points: where it calls its northing X, a column X is taken as the northing.
    delimiter : str, optional
        What separates columns; default that of comma, semicolon and tab which the header has.

    Returns
    -------
    QueryPoints

    Raises
    ------
    ReadError
        If the file cannot be read, its header leaves the delimiter or the coordinates open, rows
        have more or fewer cells, or coordinates are no finite numbers.
    OptionError
        If there is no column of a name given, or the delimiter is no single character.
    """
    table = read_text_table(path, delimiter)
    chosen, notes = _find_coordinates(table.header, columns)
    xy = np.column_stack([_parse_numbers(table, column) for column in chosen])
    cells = np.array(table.rows, object).reshape(len(table.rows), len(table.header))
    names = [table.header[column] for column in chosen]
    found = QueryPoints(
        columns={name: cells[:, k] for k, name in enumerate(table.header)},
        xy=xy,
        is_degrees=any(parse_name(name).kind == "angle" for name in names),
        notes=notes,
    )
    return found if columns is not None else _settle_header(found, names, crs)


def _settle_header(points: QueryPoints, names: Sequence[str], crs: CRS | None) -> QueryPoints:
    """Look at what names alone leave open: hemispheres, and an X that points north."""
    if points.is_degrees:
        require_one_hemisphere(points.columns)
    if crs is None or not is_northing(names[0], points.xy, crs, AreaOfUse.of(crs, None)):
        return points
    turned = points.xy[:, ::-1].copy()
    return replace(points, xy=turned, notes=(f"{describe_turn(crs, names[0], names[1])}.",))


def read_text_table(path: Path, delimiter: str | None) -> TextTable:
    """Return the cells of a text file whose first line names the columns. Raises ReadError."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            text = file.read()
    except OSError as error:
        raise ReadError(f"Cannot read {FILE}: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise ReadError(f"Cannot read {FILE}: it is no text in UTF-8.") from error
    if not text.strip():
        raise ReadError(f"{FILE} is empty: a line with the names of columns is needed.")
    mark = _find_delimiter(text.partition("\n")[0], delimiter)
    reader = csv.reader(StringIO(text, newline=""), delimiter=mark, strict=True)
    try:
        found = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise ReadError(f"{FILE}, line {reader.line_num}: {error}.") from error
    header = [name.strip() for name in found[0][1]]
    for one in header:
        if not one or header.count(one) > 1:
            what = f"'{one}' twice" if one else "a column without a name"
            raise ReadError(f"The header of {FILE} has {what}: names must differ.")
    rows, numbers = [row for _, row in found[1:]], [number for number, _ in found[1:]]
    uneven = [n for n, row in zip(numbers, rows, strict=True) if len(row) != len(header)]
    if uneven:
        raise ReadError(
            f"{FILE} has {counted(len(uneven), 'row')} with more or fewer cells than the "
            f"{len(header)} of the header (first: line {uneven[0]}).",
            lines=uneven[:_SHOWN],
        )
    return TextTable(header, rows, numbers)


def _find_delimiter(header: str, given: str | None) -> str:
    if given is not None:
        if len(given) != 1 or given in '"\r\n':
            raise OptionError("delimiter", given, "a single character")
        return given
    found = [mark for mark in _DELIMITERS if mark in header]
    if len(found) == 1:
        return found[0]
    what = " and ".join(_DELIMITERS[mark] for mark in found) or "no delimiter"
    raise ReadError(f"The header of {FILE} has {what}: name what separates its columns.")


def _find_coordinates(
    header: Sequence[str], named: tuple[str, str] | None
) -> tuple[tuple[int, int], tuple[str, ...]]:
    """Return the columns of easting and northing, and what was assumed."""
    if named is not None:
        for name in named:
            if name not in header:
                raise OptionError("column", name, header)
        return (header.index(named[0]), header.index(named[1])), ()
    pair = find_plane_pair(header)
    if pair is None:
        names = "; ".join(filter(None, (", ".join(header), describe_doubts(header))))
        raise ReadError(
            f"Which columns of {FILE} are easting and northing is open: name them; it has {names}.",
        )
    east, north = pair
    note = f"By the header {header[east]} is the easting and {header[north]} the northing."
    return (east, north), (note,)


def _parse_numbers(table: TextTable, column: int) -> Float64Array:
    values = np.array([_parse_number(row[column]) for row in table.rows], np.float64)
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        lines = [table.lines[row] for row in wrong[:_SHOWN]]
        cell = table.rows[wrong[0]][column]
        raise ReadError(
            f"{FILE} has {counted(len(wrong), 'row')} whose {table.header[column]} is no finite "
            f"number (first: line {lines[0]}, '{cell}').",
            lines=lines,
        )
    return values


def _parse_number(text: str) -> float:
    try:
        return float(text) if "_" not in text else float("nan")
    except ValueError:
        return float("nan")
