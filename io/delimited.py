"""Delimited text: survey points as CSV, TXT, XYZ; in any customary layout."""

from __future__ import annotations

import csv
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from ..crs import CRS, Unit
from ..tin import TIN, Survey
from .atomic import replacing
from .crs import is_geographic, transform_points
from .delimited_layout import find_layout
from .delimited_lines import read_lines
from .delimited_table import read_table
from .errors import CrsError, WriteError
from .placing import place, settle_unit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from ..crs import CrsLike, UnitLike
    from .delimited_layout import Layout

__all__ = ["read", "write"]

_WGS84 = "EPSG:4326"
_CHUNK_ROWS = 100_000
_SUFFIX_DELIMITERS = {".tsv": "\t", ".xyz": " ", ".pts": " "}
_BARE_SUFFIXES = frozenset({".xyz", ".pts"})
_AREA_MARGIN_DEGREES = 2.0


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    columns: str | Sequence[str] | Mapping[str, str | int] | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    comment: str | None = None,
    encoding: str | None = None,
    source_crs: CrsLike | None = None,
) -> Survey:
    """Read survey points.

    Parameters
    ----------
    path : Path
    crs : CRS, str, int or pyproj.CRS, optional
        CRS of the coordinates. Where the file has longitude and latitude (WGS 84), or
        ``source_crs`` is another, points are reprojected to it.
    z_unit : Unit or str, optional
        Unit of the elevations, if the header does not give it.
    columns : str, sequence of str, or mapping of str to str or int, optional
        What the columns are; default by header, else by content. Letters in their order
        (``"PNEZD"``: P point number, N northing, E easting, Z elevation, D description, X
        easting, Y northing, - other), names in their order (``["id", "easting", ...]``, or one
        text with commas), or a mapping from role to name in the header or number from 1
        (``{"easting": "X_LOCAL", "northing": 3, "elevation": 4}``).
    delimiter : str, optional
        One letter, or "comma", "semicolon", "tab", "pipe", "space" (runs of spaces and tabs).
    decimal : {".", ","}, optional
    comment : str, optional
        What comment lines start with; default by looking (``# // ; ! %``), "" for none.
    encoding : str, optional
        Default by looking: UTF-8, UTF-16, else Windows-1252.
    source_crs : CRS, str, int or pyproj.CRS, optional
        CRS in which the file's coordinates are, if not ``crs``.

    Returns
    -------
    Survey
        Other columns are ``attributes``: ``"number"``, ``"description"``, others by name.
        ``skipped`` counts lines that are no rows; ``notes`` says what was assumed.

    Raises
    ------
    ReadError
        If there is no table, its columns cannot be told, a row has too few or too many cells,
        a coordinate is no finite number, or the coordinates would be in degrees.
    FormatError
        If an option has a value that it cannot have.
    CrsError
        If a CRS is unknown, or the points do not fit it.
    OptionError
        If ``z_unit`` is unknown, or another than the header gives.

    Notes
    -----
    Without a header and without ``columns``: first whole ascending numbers (or names), then
    three columns of numbers, are taken as number, northing, easting, elevation (PNEZD); else
    the first three columns as easting, northing, elevation (XYZ). Content cannot tell northing
    from easting; if ``crs`` is given and only the exchanged coordinates lie where it applies,
    they are exchanged. In either case ``notes`` says so.

    A number is the float64 nearest to its text. One million rows take about half a second
    on one core, two seconds where quotes stand inside cells or descriptions hold blanks.
    """
    lines = read_lines(path, encoding=encoding)
    layout = find_layout(
        lines, path, columns=columns, delimiter=delimiter, decimal=decimal, comment=comment
    )
    table = read_table(lines, layout, path)
    target = CRS.of(crs)
    source = _source(layout, CRS.of(source_crs), target)
    points, notes = _understood(table.points, layout, source or target)
    unit = settle_unit(Unit.of(z_unit), Unit.of(getattr(layout, "elevation_unit", None)), path)
    placed = place(points, source=source, target=target, path=path, unit=unit)
    return Survey(
        points=placed.points,
        attributes=table.attributes,
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        source=path.name,
        skipped=layout.skipped,
        notes=[*notes, *placed.notes],
    )


def _source(layout: Layout, source_crs: CRS | None, crs: CRS | None) -> CRS | None:
    """Return the CRS of the coordinates in the file, None if it is the one declared."""
    if source_crs is None and layout.columns.is_degrees and not is_geographic(crs):
        return CRS.of(_WGS84)
    return source_crs


# ------------------------------------------------------------------ northing or easting first


def _understood(
    points: NDArray[np.float64], layout: Layout, crs: CRS | None
) -> tuple[NDArray[np.float64], list[str]]:
    """Return points whose easting and northing are the right way round, and what was assumed."""
    if layout.columns.is_degrees:
        return points, []
    if not layout.is_assumed:
        return points, []
    columns = layout.columns
    reason = ""
    if crs is not None and _only_swapped_fits(points, crs):
        points, columns = points[:, [1, 0, 2]], columns.swapped()
        reason = ", because only then they lie where the CRS applies"
    return points, [f"No header: the columns are taken as {columns.layout}{reason}."]


def _only_swapped_fits(points: NDArray[np.float64], crs: CRS) -> bool:
    middle = np.median(points, axis=0)
    return not _lies_in_area(middle, crs) and _lies_in_area(middle[[1, 0, 2]], crs)


def _lies_in_area(point: NDArray[np.float64], crs: CRS) -> bool:
    """Whether a point lies in the area of use of a CRS, or that area is not known."""
    area = crs.area_of_use
    if area is None:
        return True
    try:
        longitude, latitude, _ = transform_points(point[None, :], crs, _WGS84)[0]
    except CrsError:
        return False
    margin = _AREA_MARGIN_DEGREES
    span = (area.east - area.west) % 360.0 or 360.0
    is_between = (longitude - area.west + margin) % 360.0 <= span + 2 * margin
    return bool(is_between and area.south - margin <= latitude <= area.north + margin)


# ------------------------------------------------------------------ writing


def write(
    obj: TIN | Survey,
    path: Path,
    *,
    columns: str | None = None,
    delimiter: str | None = None,
    header: bool | None = None,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write points; of a TIN its vertices.

    Parameters
    ----------
    obj : TIN or Survey
    path : Path
    columns : {"PNEZD", "PENZD", "ENZ", "NEZ", ...}, optional
        Letters as in :func:`read`. Default PNEZD for a survey with numbers and descriptions;
        otherwise easting, northing, elevation and all attributes (``.xyz`` and ``.pts``: the
        coordinates alone).
    delimiter : str, optional
        One letter; default by suffix: ``.tsv`` tab, ``.xyz`` and ``.pts`` space, else comma.
    header : bool, optional
        Whether names stand in the first line; default not for ``.xyz`` and ``.pts``.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    WriteError
        If the file cannot be written, an attribute is missing, or the survey has lines, which
        a list of points would lose.

    Notes
    -----
    Every number is written so that it reads back as the same float64.
    """
    is_bare = path.suffix.lower() in _BARE_SUFFIXES
    table = _columns_to_write(obj, columns, is_bare, path)
    separator = delimiter or _SUFFIX_DELIMITERS.get(path.suffix.lower(), ",")
    if len(separator) != 1 or separator in '"\n\r.' or separator.isalnum():
        raise WriteError(f"Cannot write '{path}': '{delimiter}' is no delimiter.", path=path)
    names = [] if (is_bare if header is None else not header) else [list(table)]
    with replacing(path, binary=False) as file:
        writer = csv.writer(file, delimiter=separator, lineterminator="\n")
        writer.writerows(chain(names, _rows(list(table.values()), progress)))


def _columns_to_write(
    obj: TIN | Survey, letters: str | None, is_bare: bool, path: Path
) -> dict[str, NDArray[Any]]:
    attributes = dict(obj.attributes) if isinstance(obj, Survey) else {}
    if isinstance(obj, Survey):
        _require_no_lines(obj, path)
    coordinates = dict(zip(("easting", "northing", "elevation"), obj.points.T, strict=True))
    if letters is None and {"number", "description"} <= attributes.keys() and not is_bare:
        others = {name: attributes[name] for name in attributes}
        number, description = others.pop("number"), others.pop("description")
        order = ("northing", "easting", "elevation")
        surveyed = {name: coordinates[name] for name in order}
        return {"number": number, **surveyed, "description": description, **others}
    if letters is None:
        return coordinates if is_bare else {**coordinates, **attributes}
    return _by_letters(letters, {**attributes, **coordinates}, path)


def _by_letters(
    letters: str, available: dict[str, NDArray[Any]], path: Path
) -> dict[str, NDArray[Any]]:
    roles = {"P": "number", "N": "northing", "Y": "northing", "E": "easting", "X": "easting"}
    roles |= {"Z": "elevation", "H": "elevation", "D": "description"}
    chosen: dict[str, NDArray[Any]] = {}
    for letter in letters.upper():
        role = roles.get(letter)
        if role is None or role not in available or role in chosen:
            wrong = "twice" if role in chosen else "not there" if role else "unknown"
            raise WriteError(
                f"Cannot write '{path}': column {letter} of '{letters}' is {wrong}; the letters "
                f"are {', '.join(roles)}.",
                path=path,
            )
        chosen[role] = available[role]
    return chosen


def _require_no_lines(survey: Survey, path: Path) -> None:
    if survey.has_lines:
        raise WriteError(
            f"Cannot write '{path}': the survey holds breaklines, boundaries, holes or water, "
            "which a list of points would lose.",
            path=path,
        )


def _rows(
    columns: Sequence[NDArray[Any]], progress: Callable[[float], None] | None
) -> Iterator[tuple[Any, ...]]:
    """Walk the rows as Python values; a float's text is the shortest that reads back the same."""
    count = len(columns[0])
    for start in range(0, count, _CHUNK_ROWS):
        stop = min(start + _CHUNK_ROWS, count)
        yield from zip(*(column[start:stop].tolist() for column in columns), strict=True)
        if progress is not None:
            progress(stop / count)
