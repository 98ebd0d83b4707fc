"""Points, lines or polygons of a vector file with their columns, in the CRS of a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import as_path
from ...base.crs import CRS
from ...base.errors import ReadError
from ...base.notes import naming_file
from ...base.results import Features
from ...base.sentences import FILE, counted, inflect
from ..reprojection import checking_crs
from .features import read_features
from .geojson import join_at_antimeridian
from .parts import Wanted, crs_notes, move_to_crs
from .point_tables import is_point_table, read_point_table

if TYPE_CHECKING:
    import os

    from ...base.arrays import ObjectArray
    from ...base.crs import CrsLike
    from .layers import Layer

_KIND_OF = {
    0: "points",
    1: "lines",
    2: "lines",
    3: "polygons",
    4: "points",
    5: "lines",
    6: "polygons",
}
"""By shapely's numbers of types."""


def read_geometries(
    path: str | os.PathLike[str],
    *,
    crs: CrsLike | None = None,
    layer: str | None = None,
    check_crs: bool = True,
    table: str | None = None,
) -> Features:
    """Read points, lines or polygons of one kind; elevations are left aside.

    Parameters
    ----------
    path : path-like
    crs : CRS, str, int or pyproj.CRS, optional
        CRS wanted; default the file's own.
    layer : str, optional
        Needed if several layers have geometry.
    check_crs : bool
        Refuse coordinates that contradict their CRS; False takes them as they are, with a note.
    table : {"lines", "polygons"}, optional
        What the rows of a text table of points make; without it such tables are refused.

    Returns
    -------
    Features
        With the file's columns, by their names in lower case; points of one feature are several.
        ``notes`` tell what was left out or assumed.

    Raises
    ------
    MissingExtraError
        If pyogrio is not installed.
    ReadError
        If the file cannot be read, holds several kinds, or coordinates that are not finite.
    CrsError
        If they cannot be brought into the CRS.
    """
    file = as_path(path)
    with naming_file(file), checking_crs(check_crs):
        shapely = optional.load("shapely")
        wanted = Wanted(CRS.of(crs))
        if layer is None and is_point_table(file):
            read = read_point_table(file, wanted, drape=True, kind=_require_kind(table))
        else:
            read = join_at_antimeridian(read_features(file, layer=layer), wanted.crs)
        shapes = shapely.orient_polygons(shapely.force_2d(read.geometries))
        kind = _find_kind(shapes, read)
        columns = read.columns
        if kind == "points":
            shapes, rows = shapely.get_parts(shapes, return_index=True)
            columns = {name: column[rows] for name, column in columns.items()}
        _, coordinates, levels = shapely.to_ragged_array(shapes)
        wrong = ~np.isfinite(coordinates).all(axis=1)
        if wrong.any():
            row = int(np.argmax(wrong))
            are = inflect(
                f"{counted(int(wrong.sum()), 'coordinate')} that [is|are]", int(wrong.sum())
            )
            raise ReadError(
                f"{FILE} has {are} not finite (first: "
                f"{tuple(coordinates[row].tolist())}): every coordinate must be a finite number."
            )
        notes = [*read.notes, *crs_notes(read, wanted)]
        return Features(
            kind=kind,
            coordinates=move_to_crs(coordinates, read, wanted.crs, notes=notes),
            offsets=tuple(levels),
            columns=columns,
            crs=read.crs if wanted.crs is None else wanted.crs,
            notes=notes,
        )


def _require_kind(table: str | None) -> str:
    if table is None:
        raise ReadError(
            f"{FILE} is a table of points, which may be places or vertices of a line: a vector file"
            " says which; `tinsmith interpolate` takes a table of places."
        )
    return table


def _find_kind(shapes: ObjectArray, read: Layer) -> Any:
    shapely = optional.load("shapely")
    types = shapely.get_type_id(shapes).tolist()
    kinds = [_KIND_OF.get(one, "collections") for one in types]
    other = next((row for row, kind in enumerate(kinds) if kind != kinds[0]), None)
    if "collections" in kinds or other is not None:
        row = kinds.index("collections") if "collections" in kinds else other
        raise ReadError(
            f"{read.label(row or 0)} is one of {kinds[row or 0]}, and the first one of {kinds[0]}: "
            "a layer of points, of lines or of polygons is needed."
        )
    return kinds[0]
