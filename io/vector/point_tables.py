"""Text tables of points, whose rows are the vertices of one line in their order."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from ..delimited import parse_name, read_query_points
from ..isolated import open_ordinary_file, require_local
from ..registry import find_format, list_claims
from .layers import Layer

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.crs import CRS
    from .parts import Wanted

_GEOMETRIES = re.compile(r"\b(wkt|geom|geometry|the_geom|linestring|polygon)", re.IGNORECASE)
_HEAD = 4096
_OF_LINES = re.compile(r"(poly)?(line|gon|ring|part|string|feature|axis)[ _]?(id|no|nr|number)?")
"""Names of columns that tell which of several lines a vertex belongs to."""
_FEWEST = {"lines": (2, "line"), "polygons": (3, "polygon")}


def is_point_table(path: Path) -> bool:
    """Whether a file is a text table by its suffix, and has no geometries in its first rows."""
    delimited = find_format("delimited")
    if delimited not in list_claims([delimited], path) or not path.is_file():
        return False
    with path.open("rb") as stream:
        return _GEOMETRIES.search(stream.read(_HEAD).decode("latin-1")) is None


class _Vertices(NamedTuple):
    """Those of a line, and what is known of them."""

    coordinates: Float64Array
    """(n, 2) or (n, 3)."""
    crs: CRS | None
    notes: Sequence[str]
    elevation_unit: str = ""


def read_point_table(path: Path, wanted: Wanted, *, drape: bool, kind: str = "lines") -> Layer:
    """Read the points of a table as one line or polygon.

    Parameters
    ----------
    path : Path
    wanted : Wanted
        Points are in its CRS, unless they are longitudes and latitudes by the header.
    drape : bool
        Leave elevations aside, and do not ask for any.
    kind : {"lines", "polygons"}
        A polygon is closed if its last point is not its first.

    Raises
    ------
    ReadError
        If the table cannot be read, or has rows that are no points.
    CrsError
        If points without elevations are longitudes and latitudes, and the CRS is not.
    """
    require_local(path)
    with open_ordinary_file(path) as local:
        vertices = _read_vertices(local, wanted, drape=drape)
    count, (fewest, word) = len(vertices.coordinates), _FEWEST[kind]
    if count < fewest:
        raise ReadError(f"{FILE} has {counted(count, 'point')}: a {word} has {fewest} or more.")
    order = (
        f"'{path.name}' is a table: its {count:,} points are one {word} in the order of its rows."
    )
    shape = getattr(optional.load("shapely"), kind.replace("lines", "linestrings"))
    return Layer(
        path,
        numbers=np.array([1]),
        geometries=np.array([shape(vertices.coordinates)], object),
        columns={},
        crs=vertices.crs,
        notes=(*vertices.notes, order),
        elevation_unit=vertices.elevation_unit,
    )


def _read_vertices(path: Path, wanted: Wanted, *, drape: bool) -> _Vertices:
    """Read a table with or without elevations, without a header where there are elevations."""
    try:
        found = read_query_points(path, crs=wanted.crs)
    except ReadError:  # a survey without a header, that another reader knows
        return _read_survey(path, wanted)
    for name, values in found.columns.items():
        count = len(set(values.tolist()))
        if _OF_LINES.fullmatch(name.strip().lower()) and 1 < count < len(values):
            raise ReadError(
                f"{FILE} has a column '{name}' with {count} values, which may tell as many lines: "
                "a table is one line; write several to a vector file."
            )
    if not drape and any(parse_name(name).role == "elevation" for name in found.columns):
        return _read_survey(path, wanted)
    found.require_lengths(wanted.crs)
    return _Vertices(found.xy, wanted.crs, found.notes)


def _read_survey(path: Path, wanted: Wanted) -> _Vertices:
    unit = wanted.elevation_unit
    survey = find_format("delimited").load("read")(path, crs=wanted.crs, elevation_unit=unit)
    left_out = [line for lines in survey.skipped_lines.values() for line in lines]
    if left_out:
        raise ReadError(
            f"{FILE} has {counted(len(left_out), 'row')} without an elevation or with other gaps "
            f"(first: line {min(left_out)}): a line needs each of its points."
        )
    own = survey.elevation_unit
    return _Vertices(survey.points, survey.crs, survey.notes, "" if own is None else str(own))
