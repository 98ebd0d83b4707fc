"""Which way coordinates count: an X that points north, a longitude that counts to the west."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError
from .columns import COORDINATES
from .names import find_languages, parse_name, shorten
from .vocabulary import read_languages

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import AnyArray, Float64Array
    from ...base.crs import CRS
    from ...tin.screening import AreaOfUse
    from .columns import Columns
    from .format_comments import AxesLine

_POSITIVE = frozenset({"n", "e", "north", "east"})
_NEGATIVE = frozenset({"s", "w", "o", "south", "west", "sud", "ouest", "oeste"})

_EARTH = (6_330_000.0, 6_400_000.0)
"""Metres from its centre to places on the earth."""
_FOOT = 0.3048
_HIGHEST = 30_000.0
"""Elevations are never so high, in feet; geocentric Z is, but near the equator."""


def settle_axes(
    points: Float64Array,
    columns: Columns,
    crs: CRS | None,
    area: AreaOfUse | None,
    line: AxesLine | None,
) -> tuple[Float64Array, Columns, list[str]]:
    """Take the header's X for the northing where a line near the table, or the CRS, does.

    Where only one reading lies in the area of use it is taken.

    Parameters
    ----------
    points : (n, 3) float64 array
        As they are in the file, with X as the easting.
    columns : Columns
        Found by the header.
    crs : CRS or None
        Of the coordinates in the file.
    area : AreaOfUse or None
        None says nothing.
    line : AxesLine or None
        What says of X and Y which way they point.

    Returns
    -------
    points : (n, 3) float64 array
    columns : Columns
    notes : list of str

    Raises
    ------
    ReadError
        If the header is in a language whose maps call the northing X, and nothing says so here.
    """
    east, north = (columns.names[columns.roles[role]] for role in COORDINATES[:2])
    if parse_name(east).kind != "axis":
        return points, columns, []
    if line is None and crs is not None and is_northing(east, points[:, :2], crs, area):
        why = describe_turn(crs, east, north)
    elif line is not None and line.is_turned:
        why = f"By {line.label} {_name_turn(east, north)}"
    elif line is None and (language := _find_language(columns)):
        if not _lies_turned(points[:, :2], area, language, columns):
            return points, columns, []
        why = f"Only so do the points lie in the area of use: {_name_turn(east, north)}"
    else:
        is_odd = line is None and columns.roles["northing"] < columns.roles["easting"]
        return points, columns, [_describe_order(east, north)] if is_odd else []
    note = f"{why}; `columns='{columns.word}'` takes them the other way round."
    return points[:, [1, 0, 2]], columns.permute((1, 0, 2)), [note]


def _find_language(columns: Columns) -> str:
    """Return the language of a header where X is the northing on maps; "" for others."""
    spoken = [one for one in map(find_languages, columns.names) if one]
    languages = frozenset.intersection(*spoken) if spoken else frozenset()
    are_all = bool(languages) and all(read_languages()[one]["x_is_north"] for one in languages)
    return min(languages) if are_all else ""


def _lies_turned(xy: Float64Array, area: AreaOfUse | None, language: str, columns: Columns) -> bool:
    """Whether only with X as the northing the points lie in the area of use."""
    lies = area is not None and area.covers_most(xy)
    lies_turned = area is not None and area.covers_most(xy[:, ::-1])
    if lies != lies_turned:
        return lies_turned
    turned = columns.permute((1, 0, 2)).word
    raise ReadError(
        f"its header is in {language}, where X is the northing on maps, and the area of "
        f"use of the CRS does not tell: `columns='{turned}'` takes X for it, "
        f"`columns='{columns.word}'` takes Y.",
    )


def _describe_order(east: str, north: str) -> str:
    return (
        f"By the header '{shorten(east)}' is the easting and '{shorten(north)}' the northing; "
        "where X points north it is the other way round."
    )


def is_northing(name: str, xy: Float64Array, crs: CRS, area: AreaOfUse | None) -> bool:
    """Whether a column called X is the northing, as its CRS says and the area of use allows."""
    if parse_name(name).kind != "axis" or not any(
        axis.abbrev.casefold() == "x" and axis.direction == "north"
        for axis in crs.to_pyproj().axis_info
    ):
        return False
    return area is None or not area.covers_most(xy) or area.covers_most(xy[:, ::-1])


def describe_turn(crs: CRS, east: str, north: str) -> str:
    """Say that the columns called X and Y are taken as northing and easting."""
    return f"{crs.label} calls its northing X, as the header does: {_name_turn(east, north)}"


def _name_turn(east: str, north: str) -> str:
    return f"'{shorten(east)}' is taken as the northing and '{shorten(north)}' as the easting"


def are_named_plainly(columns: Columns) -> bool:
    """Whether the names of easting and northing say beyond doubt which is which: not X and Y."""
    names = [parse_name(columns.names[columns.roles[role]]) for role in COORDINATES[:2]]
    return all(
        name.kind in ("word", "letter") and name.role == role
        for name, role in zip(names, COORDINATES, strict=False)
    )


def require_one_hemisphere(attributes: Mapping[str, AnyArray]) -> None:
    """Refuse degrees beside a column that turns their sign: N or S, E or W."""
    for name, values in attributes.items():
        letters = {str(one).strip(" .").casefold() for one in values.tolist()} - {""}
        is_named = parse_name(name).role == "hemisphere"
        is_hemisphere = bool(letters) and letters <= _POSITIVE | _NEGATIVE
        if (is_named or is_hemisphere) and not letters <= _POSITIVE:
            raise ReadError(
                f"the column '{shorten(name)}' may turn the sign of latitudes and "
                f"longitudes ({', '.join(sorted(letters)[:4])}): write those to the south and west "
                "as negative numbers, and leave the column out.",
            )


def require_no_geocentric(points: Float64Array, columns: Columns) -> None:
    """Refuse X, Y, Z that count from the centre of the earth."""
    names = (parse_name(columns.names[column]) for column in columns.coordinates)
    if len(points) == 0 or any(name.kind != "axis" for name in names):
        return
    with np.errstate(over="ignore"):
        radius = float(np.median(np.sqrt((points**2).sum(axis=1))))
    is_high = abs(float(np.median(points[:, 2]))) > _HIGHEST
    low, high = _EARTH
    if is_high and (low <= radius <= high or low <= _FOOT * radius <= high):
        raise ReadError(
            f"its X, Y and Z lie {radius:,.0f} from their origin, as geocentric "
            "coordinates do, which are no easting, northing and elevation: transform them first, "
            f"or `columns='{columns.word}'` takes them nonetheless.",
        )
