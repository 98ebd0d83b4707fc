"""Delimited text: survey points as CSV, TXT, XYZ; in any customary layout."""

from __future__ import annotations

import csv
from itertools import chain
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError, WriteError
from ...base.progress import Progress
from ...base.sentences import FILE, counted
from ...base.types import RowSources
from ...tin import TIN, Survey
from ...tin.screening.area_of_use import AreaOfUse
from ...tin.screening.nodata import parse_nodata
from ..registry.losses import keep_on_one_line
from ..reprojection import is_geographic, place, settle_unit
from .axes import require_no_geocentric, require_one_hemisphere, settle_axes
from .columns import find_unit_word
from .content import find_columns_by_content
from .findings import (
    describe_faults,
    describe_left_out,
    find_commented_points,
    find_odd_elevations,
    find_repeated_numbers,
    find_rounded_coordinates,
    find_split_thousands,
    find_summary_rows,
    find_unit_words,
    require_ground,
    require_in_area,
    require_one_header,
    require_unit_of_crs,
)
from .headings import find_axes_line, find_unit_line
from .layout import find_layout
from .lines import COMMENT_PREFIXES, read_lines
from .table import (
    describe_columns,
    describe_faults_of_rows,
    read_cells,
    read_table,
    require_one_mark,
)
from .truncation import leave_out_cut_row

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.progress import Tell
    from .columns import Columns
    from .layout import Layout
    from .lines import TextLines
    from .table import Cells, Fault, Table

__all__ = ["read", "write"]

_WGS84 = "EPSG:4326"
_CHUNK_ROWS = 100_000
_SUFFIX_DELIMITERS = {".tsv": "\t", ".xyz": " ", ".pts": " "}
_BARE_SUFFIXES = frozenset({".xyz", ".pts"})


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    columns: str | Sequence[str] | Mapping[str, str | int] | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    comment: str | None = None,
    encoding: str | None = None,
    source_crs: CrsLike | None = None,
    nodata: float | Sequence[float] | None = None,
    skip_bad: bool = False,
    progress: Tell | None = None,
) -> Survey:
    """Read survey points.

    Longitude and latitude (WGS 84) are reprojected to ``crs``. An ``encoding`` that is not given is
    UTF-8 or UTF-16, else Windows-1252.

    Parameters
    ----------
    columns : str, sequence of str, or mapping of str to str or int, optional
        What the columns are; default by header, else by content. Letters in their order
        (``"PNEZD"``: P point number, N northing, E easting, Z elevation, D description, X
        easting, Y northing, - other), names in their order (``["id", "easting", ...]``, or one
        text with commas), or a mapping from role to name in the header or number from 1
        (``{"easting": "X_LOCAL", "northing": 3, "elevation": 4}``; on the command line
        ``easting=X_LOCAL,northing=3,elevation=4``).
    delimiter : str, optional
        One letter, or "comma", "semicolon", "tab", "pipe", "space" (runs of spaces and tabs).
    decimal : {".", ","}, optional
        Decimal mark of the numbers; found by looking if it is not given.
    comment : str, optional
        What comment lines start with; default by looking (``# // ; ! %``), "" for none.
    skip_bad : bool, optional
        Whether rows with too few or too many cells, or a coordinate that is no number, are left
        out, instead of the file being refused.

    Returns
    -------
    Survey
        Other columns are ``attributes``: ``"number"``, ``"description"``, others by name. Points
        without an elevation are left out. ``skipped`` counts what is left out, ``skipped_lines``
        names the lines; ``notes`` says what was assumed, and what is odd.

    Raises
    ------
    ReadError
        If there is no table, its columns cannot be told or may be told in two ways, a row is bad
        (with ``skip_bad`` more than half of them), no point has an elevation, or the coordinates
        would be in degrees.
    CrsError
        If a CRS is unknown, or the points lie in its area of use only with coordinates exchanged;
        if the header gives eastings and northings another unit than the CRS has.
    OptionError
        If an option has a value that it cannot have; if ``elevation_unit`` is unknown, or another
        than the header gives.

    Notes
    -----
    Without a header and without ``columns`` all customary layouts are judged together, by what
    the columns hold and by the area of use of the CRS; docs/survey-text.md has the rules. Where
    two are plausible the file is refused with the two named, else ``notes`` says which was taken
    and why. The area of use is looked at however the columns are found.

    A number is the float64 nearest to its text. One million rows take about half a second
    on one core, two seconds where quotes stand inside cells or descriptions hold blanks.
    """
    left_out = parse_nodata(nodata)
    declared, done = CRS.of(source_crs), Progress(progress)
    lines = read_lines(path, encoding=encoding)
    layout = find_layout(
        lines, path, columns=columns, delimiter=delimiter, decimal=decimal, comment=comment
    )
    cells = read_cells(lines, layout, progress=done.stage(0.1, 0.9))
    if cells.faults and not skip_bad:
        raise describe_faults_of_rows(cells.faults, len(layout.rows), lines, layout)
    target = CRS.of(crs)
    source = _find_source_crs(layout, declared, target)
    area = AreaOfUse.of(source, target)
    meaning, notes = _find_columns(cells, layout, area, left_out)
    noted_units = require_unit_of_crs(meaning, source or target, is_stated=columns is not None)
    require_one_mark(cells, meaning, layout)
    table = read_table(cells, layout, meaning, lines)
    table, noted_cut = leave_out_cut_row(table, lines, layout, meaning, skip_bad=skip_bad)
    _require_few_faults(table.faults, lines, layout, skip_bad=skip_bad)
    require_one_header(table.faults, lines, layout.delimiter, meaning)
    accounted = _account_for_rows(table, left_out)
    unit, noted_unit = _find_unit(layout, lines, Unit.of(elevation_unit))
    where = _Reference(source, target, area)
    accounted = _settle_places(
        accounted, lines, layout, meaning, where, is_stated=columns is not None
    )
    is_free = columns is not None or where.area is None  # a plan of its own may lie anywhere
    on_ground = require_ground(accounted.points[:, 2], unit, is_free=is_free)
    notes = [
        *layout.notes,
        *notes,
        *noted_units,
        *noted_cut,
        *noted_unit,
        *on_ground,
        *accounted.notes,
    ]
    placed = place(accounted.points, source=source, target=target, unit=unit, looks_at_area=False)
    left_out_lines = {**layout.left_out, **accounted.lines}
    return Survey(
        points=placed.points,
        attributes=accounted.attributes,
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        source=path.name,
        skipped={**layout.skipped, **{what: len(at) for what, at in left_out_lines.items()}},
        skipped_lines=left_out_lines,
        notes=[*notes, *placed.notes],
        row_sources=RowSources.of_file(path.name, accounted.rows + 1),
    )


def _find_odd(
    accounted: _Accounted, lines: TextLines, layout: Layout, columns: Columns, *, in_degrees: bool
) -> list[str]:
    numbers, names = (accounted.attributes.get(role) for role in ("number", "description"))
    return [
        *find_odd_elevations(accounted.points, in_degrees=in_degrees),
        *find_repeated_numbers(numbers, accounted.rows),
        *find_rounded_coordinates(lines, accounted.rows, layout.delimiter, columns),
        *find_summary_rows(accounted.points, accounted.rows, (numbers, names)),
        *find_commented_points(lines, layout.rows, layout, columns),
        *(() if layout.columns is None else _find_split(accounted, layout, columns)),
    ]


def _find_split(accounted: _Accounted, layout: Layout, columns: Columns) -> list[str]:
    unnamed = {f"column {i + 1}" for i in range(max(columns.coordinates) + 1, layout.count)}
    beyond = {name: values for name, values in accounted.attributes.items() if name in unnamed}
    return find_split_thousands(accounted.points, beyond, layout.delimiter)


class _Reference(NamedTuple):
    """The CRS of coordinates, that which they go to, and their areas of use."""

    source: CRS | None
    target: CRS | None
    area: AreaOfUse | None


def _settle_places(
    accounted: _Accounted,
    lines: TextLines,
    layout: Layout,
    columns: Columns,
    where: _Reference,
    *,
    is_stated: bool,
) -> _Accounted:
    """Refuse places that no header can mean, take X for the northing where the CRS does; note."""
    is_headed = layout.columns is not None and not is_stated
    notes = list(accounted.notes)
    points = accounted.points
    if is_headed:
        if columns.is_degrees:
            require_one_hemisphere(accounted.attributes)
        require_no_geocentric(points, columns)
        crs, line = where.source or where.target, find_axes_line(lines, layout.rows)
        points, columns, turned = settle_axes(points, columns, crs, where.area, line)
        notes += turned
    accounted = accounted._replace(points=points)
    notes += require_in_area(points, accounted.rows, columns, where.area, is_headed=is_headed)
    notes += _find_odd(accounted, lines, layout, columns, in_degrees=is_geographic(where.source))
    return accounted._replace(notes=notes)


def _find_unit(
    layout: Layout, lines: TextLines, declared: Unit | None
) -> tuple[Unit | None, list[str]]:
    """Return the unit of elevations by the header, a line near the table or the caller."""
    named = _find_known_unit(layout.elevation_unit)
    line = find_unit_line(lines, layout.rows)
    if line is None or not line.unit:
        return settle_unit(declared, named), [line.note] if line else []
    own = _find_known_unit(line.unit)
    if named not in (None, own) or declared not in (None, own):
        raise ReadError(
            f"{line.label} tells {line.unit} as the unit of the elevations, and the "
            f"{'header' if named else 'option `elevation_unit`'} another: make them agree.",
        )
    return own, [line.note]


def _find_known_unit(word: str | None) -> Unit | None:
    """Return a unit of length; a word that is none tells none."""
    try:
        return Unit.of(word)
    except OptionError:
        return None


def _find_source_crs(layout: Layout, source_crs: CRS | None, crs: CRS | None) -> CRS | None:
    """Return the CRS of the coordinates in the file, None if it is the one declared."""
    in_degrees = layout.columns is not None and layout.columns.is_degrees
    return (
        CRS.of(_WGS84)
        if source_crs is None and in_degrees and not is_geographic(crs)
        else source_crs
    )


def _find_columns(
    cells: Cells,
    layout: Layout,
    area: AreaOfUse | None,
    nodata: Float64Array,
) -> tuple[Columns, list[str]]:
    """Return what the columns mean, by word or header, else by what is in them."""
    if layout.columns is not None:
        return layout.columns, []
    try:
        columns = [one.without(nodata) for one in describe_columns(cells, layout)]
        found, note = find_columns_by_content(
            columns,
            area,
            is_scan=layout.is_scan,
            is_announced=layout.is_announced,
            heading=layout.heading.label if layout.heading else "",
        )
    except ReadError as error:
        raise ReadError(str(error)) from None
    return found, [note]


# ------------------------------------------------------------------ rows that are left out


def _require_few_faults(
    faults: Sequence[Fault], lines: TextLines, layout: Layout, *, skip_bad: bool
) -> None:
    """Refuse bad rows that are not to be skipped, or are most of the rows."""
    if faults and (not skip_bad or 2 * len(faults) > len(layout.rows)):
        raise describe_faults_of_rows(faults, len(layout.rows), lines, layout)


class _Accounted(NamedTuple):
    """The points that are left, and the lines of those that are not."""

    points: Float64Array
    rows: Int64Array
    attributes: dict[str, AnyArray]
    lines: dict[str, tuple[int, ...]]
    notes: list[str]


def _account_for_rows(table: Table, nodata: Float64Array) -> _Accounted:
    """Leave out points without an elevation, and say what became of every row."""
    z = table.points[:, 2]
    is_flat = np.isnan(z)
    is_nodata = np.isin(z, nodata) if len(nodata) else np.zeros(len(z), np.bool_)
    if (is_flat | is_nodata).all():
        raise ReadError(f"of {counted(len(z), 'row')}, none has an elevation.")
    lines: dict[str, tuple[int, ...]] = {}
    notes = find_unit_words(table.attributes)
    if table.n_grouped:
        grouped = counted(table.n_grouped, "coordinate")
        notes.append(f"Thousands separators were taken out of {grouped}.")
    if table.faults:
        lines["bad rows"] = tuple(fault.line + 1 for fault in table.faults)
        notes.append(describe_faults(table.faults))
    flat = ("points without elevation", "without an elevation", is_flat)
    for what, why, is_out in (flat, ("nodata points", "with a nodata elevation", is_nodata)):
        if is_out.any():
            lines[what] = tuple((table.rows[is_out] + 1).tolist())
            notes.append(describe_left_out(why, lines[what]))
    if not lines or not (is_flat | is_nodata).any():
        return _Accounted(table.points, table.rows, table.attributes, lines, notes)
    kept = ~(is_flat | is_nodata)
    attributes = {name: values[kept] for name, values in table.attributes.items()}
    return _Accounted(table.points[kept], table.rows[kept], attributes, lines, notes)


# ------------------------------------------------------------------ writing


def write(
    obj: TIN | Survey,
    path: Path,
    *,
    columns: str | None = None,
    delimiter: str | None = None,
    header: bool | None = None,
    progress: Tell | None = None,
) -> None:
    """Write points; of a TIN its vertices.

    Parameters
    ----------
    columns : {"PNEZD", "PENZD", "ENZ", "NEZ", ...}, optional
        Letters as in :func:`read`. Default PNEZD for a survey with numbers and descriptions;
        otherwise easting, northing, elevation and all attributes (``.xyz`` and ``.pts``: the
        coordinates alone).
    delimiter : str, optional
        One letter; default by suffix: ``.tsv`` tab, ``.xyz`` and ``.pts`` space, else comma.
    header : bool, optional
        Whether names stand in the first line; default not for ``.xyz`` and ``.pts``.

    Raises
    ------
    WriteError
        If the file cannot be written, an attribute is missing, or the survey has lines, which
        a list of points would lose.

    Warns
    -----
    LossWarning
        If line breaks within texts become blanks.

    Notes
    -----
    Every number is written so that it reads back as the same float64. The header names the unit of
    elevations, ``elevation (ft)``, if it is known.
    """
    is_bare = path.suffix.lower() in _BARE_SUFFIXES
    table = _choose_written_columns(obj, columns, is_bare)
    separator = delimiter or _SUFFIX_DELIMITERS.get(path.suffix.lower(), ",")
    if len(separator) != 1 or separator in '"\n\r.' or separator.isalnum():
        raise WriteError(f"Cannot write '{path}': '{delimiter}' is no delimiter.", path=path)
    names = (
        [] if (is_bare if header is None else not header) else [_name_written_columns(table, obj)]
    )
    values = list(keep_on_one_line(table).values())
    with replacing(path, binary=False) as file:
        writer = csv.writer(
            file, delimiter=separator, lineterminator="\n", quoting=_choose_quoting(values[0])
        )
        writer.writerows(chain(names, _iterate_rows(values, progress)))


def _choose_quoting(first: AnyArray) -> Literal[0, 2]:
    """Return the quoting by which no row begins as a comment does."""
    texts = first.tolist() if first.dtype.kind in "OU" else []
    has_marks = any(str(text).lstrip().startswith(COMMENT_PREFIXES) for text in texts)
    return csv.QUOTE_NONNUMERIC if has_marks else csv.QUOTE_MINIMAL


def _name_written_columns(table: Mapping[str, AnyArray], obj: TIN | Survey) -> list[str]:
    """Return the names of the columns, that of elevations with their unit if readers know it."""
    unit = obj.elevation_unit
    named = None if unit is None else f"elevation ({unit.symbol})"
    is_read = named is not None and find_unit_word(named) is not None
    return [str(named) if name == "elevation" and is_read else name for name in table]


def _choose_written_columns(
    obj: TIN | Survey, letters: str | None, is_bare: bool
) -> dict[str, AnyArray]:
    attributes = dict(obj.attributes) if isinstance(obj, Survey) else {}
    coordinates = dict(zip(("easting", "northing", "elevation"), obj.points.T, strict=True))
    if letters is None and {"number", "description"} <= attributes.keys() and not is_bare:
        others = {name: attributes[name] for name in attributes}
        number, description = others.pop("number"), others.pop("description")
        order = ("northing", "easting", "elevation")
        surveyed = {name: coordinates[name] for name in order}
        return {"number": number, **surveyed, "description": description, **others}
    if letters is None:
        return coordinates if is_bare else {**coordinates, **attributes}
    return _choose_by_letters(letters, {**attributes, **coordinates})


def _choose_by_letters(letters: str, available: dict[str, AnyArray]) -> dict[str, AnyArray]:
    roles = {"P": "number", "N": "northing", "Y": "northing", "E": "easting", "X": "easting"}
    roles |= {"Z": "elevation", "H": "elevation", "D": "description"}
    chosen: dict[str, AnyArray] = {}
    for letter in letters.upper():
        role = roles.get(letter)
        if role is None or role not in available or role in chosen:
            wrong = "twice" if role in chosen else "not there" if role else "unknown"
            raise WriteError(
                f"Cannot write {FILE}: column {letter} of '{letters}' is {wrong}; the letters "
                f"are {', '.join(roles)}.",
            )
        chosen[role] = available[role]
    return chosen


def _iterate_rows(columns: Sequence[AnyArray], progress: Tell | None) -> Iterator[tuple[Any, ...]]:
    """Walk the rows as Python values; a float's text is the shortest that reads back the same."""
    count = len(columns[0])
    for start in range(0, count, _CHUNK_ROWS):
        stop = min(start + _CHUNK_ROWS, count)
        yield from zip(*(column[start:stop].tolist() for column in columns), strict=True)
        if progress is not None:
            progress(stop / count)
