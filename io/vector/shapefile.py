"""Shapefile: features with names of ten bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import FormatError, WriteError
from ...base.notes import warn
from ...base.results import Features
from ...base.sentences import FILE, counted
from ..mesh import require_tin
from ..registry import replacing_data_set
from .ogr import write_layer
from .surface_features import make_features, make_whole_surface
from .well_known_binary import encode_tin

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.policies import FeatureKind
    from .surface_features import Writable

_NAME_BYTES = 10
_TEXT_BYTES = 254
_MOST_COLUMNS = 255
_MOST_BYTES = 2**31 - 1
_LARGEST = 1e22
"""Numbers are written with 24 digits, 15 of them behind the point where they fit."""
_LARGEST_WHOLE = 10**18


def write(
    surface: Writable, path: Path, *, kind: FeatureKind | None = None, multipatch: bool = False
) -> None:
    """Write a kind of parts of a surface, or features, as a shapefile.

    They are PointZ, PolyLineZ or PolygonZ where there are elevations. Its parts are written beside
    it: ``.shx``, ``.dbf``, ``.cpg``, with a CRS ``.prj``.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    multipatch : bool
        Write all triangles of a TIN as one MultiPatch, the surface that ArcGIS knows, without
        slope, aspect and area: each is an outer ring. GDAL reads it as a TIN, QGIS as polygons.

    Raises
    ------
    MissingExtraError
        If pyogrio is not installed.
    FormatError
        If a MultiPatch is asked for of something else than the triangles of a TIN.
    WriteError
        If the file cannot be written, would be larger than 2 GiB, or a value has no room: texts of
        more than 254 bytes, numbers of 1e22 and more, elevations that are not known.

    Warns
    -----
    LossWarning
        For names that are cut to ten bytes, and units and notes, which have no place.

    Notes
    -----
    Coordinates are the same float64; numbers have 15 decimals at most. All parts take their places
    after all of them are written, the ``.shp`` last.
    """
    how: dict[str, Any] = {}
    if not multipatch:
        features = make_features(surface, kind)
    elif kind in (None, "triangles") and not isinstance(surface, Features):
        features = make_whole_surface(require_tin(surface, format_name="a MultiPatch"))
        tin = np.array([encode_tin(features.coordinates.reshape(-1, 4, 3))], object)
        how = {"geometries": tin, "geometry_type": "Unknown", "SHPT": "MULTIPATCH"}
    else:
        raise FormatError(
            f"Cannot write {FILE}: a MultiPatch holds the triangles of a TIN, no "
            f"{'features' if isinstance(surface, Features) else kind}."
        )
    size = features.coordinates.nbytes + 100 * len(features)
    if size > _MOST_BYTES:
        raise _describe_excess(f"{counted(len(features.coordinates), 'point')} take {size:,} bytes")
    if len(features.columns) > _MOST_COLUMNS:
        raise _describe_excess(f"{counted(len(features.columns), 'column')} are there")
    if np.isnan(features.coordinates).any():
        raise _describe_excess("some elevations are not known")
    for name, values in features.columns.items():
        _require_values(name, values)
    names = short_names(features.columns)
    _warn_of_losses(features, names)
    with replacing_data_set(path, "shapefile") as new:
        write_layer(
            features,
            new,
            path,
            driver="ESRI Shapefile",
            names=names,
            DBF_DATE_LAST_UPDATE="1970-01-01",
            **how,
        )


def short_names(names: Iterable[str]) -> list[str]:
    """Return names of at most ten bytes, no two the same with capitals aside.

    Examples
    --------
    >>> short_names(["elevation", "slope_mean_degrees", "slope_mean_percent"])
    ['elevation', 'slope_mean', 'slope_me_2']
    """
    taken: dict[str, None] = {}
    short = []
    for name in names:
        candidate, number = _cut(name, _NAME_BYTES), 1
        while candidate.casefold() in taken:
            number += 1
            end = f"_{number}"
            candidate = _cut(name, _NAME_BYTES - len(end)) + end
        taken[candidate.casefold()] = None
        short.append(candidate)
    return short


def _cut(name: str, most: int) -> str:
    """Cut a name to so many bytes, not within a letter."""
    return name.encode()[:most].decode(errors="ignore")


def _warn_of_losses(features: Features, names: list[str]) -> None:
    renamed = [
        f"'{name}' is '{short}'"
        for name, short in zip(features.columns, names, strict=True)
        if name != short
    ]
    lost = []
    if renamed:
        lost.append(f"names have ten bytes at most ({', '.join(renamed)})")
    is_in_crs = features.crs is not None and features.crs.vertical_unit is not None
    if features.units or (features.elevation_unit is not None and not is_in_crs):
        lost.append("units have no place")
    if features.notes:
        lost.append("notes have no place")
    if lost:
        warn(f"{FILE} is a shapefile: {', and '.join(lost)}.")


def _require_values(name: str, values: AnyArray) -> None:
    if values.dtype.kind in "OU":
        longest = max((len(value.encode()) for value in values if value is not None), default=0)
        if longest > _TEXT_BYTES:
            raise _describe_excess(f"column '{name}' has a text of {longest} bytes")
        return
    numbers = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    most = _LARGEST if values.dtype.kind == "f" else _LARGEST_WHOLE
    is_large = (numbers >= most) | (numbers <= -most) if values.dtype.kind != "b" else np.False_
    if np.isinf(values).any() if values.dtype.kind == "f" else False:
        raise _describe_excess(f"column '{name}' has a number that is not finite")
    if np.any(is_large):
        raise _describe_excess(f"column '{name}' has the number {numbers[is_large][0]}")


def _describe_excess(what: str) -> WriteError:
    return WriteError(
        f"Cannot write {FILE}: {what}, and a shapefile holds 2 GiB, 255 columns, texts of 254 "
        "bytes, numbers below 1e22 (whole ones 1e18) and elevations that are known; a GeoPackage "
        "(.gpkg) holds them."
    )
