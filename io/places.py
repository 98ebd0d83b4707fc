"""Places in the plane: rows of a table that need no elevation, or points of any other file."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from ..base.crs import CRS
from ..base.errors import ReadError
from ..base.results import Features
from ..base.sentences import FILE
from ..tin import Survey
from .delimited import parse_name, read_query_points
from .door import names_its_file
from .reading import read
from .registry import known_formats, list_claims
from .vector import read_geometries, split_layer

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ..base.arrays import AnyArray
    from ..base.crs import CrsLike


@names_its_file
def read_places(path: Path, *, crs: CrsLike | None = None) -> Features:
    """Read places in the plane, with their numbers and descriptions.

    Parameters
    ----------
    path : Path
        A text file whose first line names the columns, such as ``number,easting,northing``, a
        vector file, ``FILE:LAYER``, or any file of points that :func:`tinsmith.read` takes.
    crs : CRS, str, int or pyproj.CRS, optional
        Of a file that names none; points in another CRS are reprojected to it.

    Returns
    -------
    Features
        Points of two coordinates, and all columns of the file; those that are numbers and
        descriptions of points by their names are called ``number`` and ``description``.

    Raises
    ------
    ReadError
        If the file cannot be read, holds a TIN, or its header leaves the coordinates open.
    CrsError
        If coordinates are longitudes and latitudes, and the CRS is not.
    """
    file, layer = split_layer(path)
    wanted = CRS.of(crs)
    if _is_of(file, "vector"):
        return _require_points(read_geometries(file, crs=wanted, layer=layer))
    refused = None
    if _is_of(file, "delimited"):
        try:
            points = read_query_points(file, crs=wanted)
            points.require_lengths(wanted)
            columns = _name_columns(points.columns)
            return Features.of_points(points.xy, columns=columns, crs=wanted, notes=points.notes)
        except ReadError as error:  # of a survey without a header, that another reader knows
            refused = error
    try:
        found = read(file, crs=wanted)
    except ReadError:
        if refused is not None and not _begins_with_numbers(file):
            raise refused from None
        raise
    if not isinstance(found, Survey):
        raise ReadError(f"{FILE} holds a TIN: points are needed.")
    return Features.of_points(
        found.points[:, :2],
        columns=_name_columns(found.attributes),
        crs=found.crs,
        notes=found.notes,
    )


def _is_of(path: Path, folder: str) -> bool:
    """Whether the suffix of a file is that of a format of one of the folders of formats."""
    claims = list_claims(known_formats(), path)
    return any(f".{folder}." in str(one.read) for one in claims)


def _begins_with_numbers(path: Path) -> bool:
    """Whether the first line of a text has numbers, and no names of columns."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        return any(map(str.isdecimal, re.split(r"[,;.\s]+", file.readline())))


def _require_points(found: Features) -> Features:
    if found.kind != "points":
        raise ReadError(f"{FILE} holds {found.kind}: points are needed.")
    return replace(found, columns=_name_columns(found.columns))


def _name_columns(columns: Mapping[str, AnyArray]) -> dict[str, AnyArray]:
    """Return columns, with the first of numbers and of descriptions called so."""
    named = dict(columns)
    for role in ("number", "description"):
        found = next((name for name in named if parse_name(name).role == role), None)
        if found is not None and role not in named:
            named = {(role if name == found else name): one for name, one in named.items()}
    return named
