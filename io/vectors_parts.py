"""Single lines and rings of features, as arrays in the CRS wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .crs import as_crs, crs_label, crs_text, elevation_unit
from .errors import ReadError
from .placing import placed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .vectors_features import Features

__all__ = ["Part", "parts_of"]

_POLYGON = 3


class Part(NamedTuple):
    """A line or ring.

    Attributes
    ----------
    coords : (k, 2) or (k, 3) float64 array
    row : int
        Of its feature.
    is_closed : bool
    ring : int
        0 for lines and outer rings, 1, 2, ... for the inner rings of a polygon.
    """

    coords: NDArray[np.float64]
    row: int
    is_closed: bool
    ring: int


class _Lines(NamedTuple):
    """Shapely lines and rings, the row of the feature of each, and its ring as in Part."""

    shapes: NDArray[np.object_]
    rows: NDArray[np.int64]
    rings: NDArray[np.int64]


def parts_of(
    features: Features, *, crs: str | None, drape: bool, notes: list[str] | None
) -> list[Part]:
    """Return the lines and rings of all features, in their order.

    Parameters
    ----------
    features : Features
    crs : str, optional
        CRS wanted; default the file's own.
    drape : bool
        Leave heights aside.
    notes : list of str, optional
        What had to be assumed is appended to it.

    Raises
    ------
    ReadError
        If there are points, coordinates that are not finite, or degrees would come out.
    CrsError
        If the lines cannot be brought into the CRS.
    """
    import shapely

    lines = _lines_of(features)
    xyz = shapely.get_coordinates(lines.shapes, include_z=True)
    bounds = np.concatenate([[0], np.cumsum(shapely.get_num_coordinates(lines.shapes))])
    has_z = shapely.has_z(lines.shapes) & (not drape)
    _require_finite(xyz, np.repeat(has_z, np.diff(bounds)), bounds, lines.rows, features)
    said = list(features.notes) + _crs_notes(features, crs, has_heights=bool(has_z.any()))
    if notes is not None:
        notes.extend(said)
    xyz[:, :2] = _moved(xyz[:, :2], features, crs)
    return [
        Part(xyz[start:end, :width], row, is_closed, ring)
        for start, end, width, row, is_closed, ring in zip(
            bounds[:-1].tolist(),
            bounds[1:].tolist(),
            np.where(has_z, 3, 2).tolist(),
            lines.rows.tolist(),
            shapely.is_closed(lines.shapes).tolist(),
            lines.rings.tolist(),
            strict=True,
        )
    ]


def _lines_of(features: Features) -> _Lines:
    """Take collections and polygons apart."""
    import shapely

    shapes, rows = features.geometries, np.arange(len(features.geometries))
    while (shapely.get_type_id(shapes) > _POLYGON).any():
        shapes, index = shapely.get_parts(shapes, return_index=True)
        rows = rows[index]
    there = ~shapely.is_empty(shapes)
    shapes, rows = shapes[there], rows[there]
    types = shapely.get_type_id(shapes)
    _require_lines(types, rows, features)
    is_polygon = types == _POLYGON
    rings, of_polygon = shapely.get_rings(shapes[is_polygon], return_index=True)
    slots = np.concatenate([np.flatnonzero(~is_polygon), np.flatnonzero(is_polygon)[of_polygon]])
    order = np.argsort(slots, kind="stable")
    slots = slots[order]
    numbers = np.arange(len(slots)) - np.searchsorted(slots, slots)
    return _Lines(np.concatenate([shapes[~is_polygon], rings])[order], rows[slots], numbers)


def _require_lines(types: NDArray[np.int32], rows: NDArray[np.int64], features: Features) -> None:
    points = np.flatnonzero(types == 0)
    if len(points):
        raise ReadError(
            f"'{features.path}' has {len(points)} points (first: feature "
            f"{features.numbers[rows[points[0]]]}): lines or polygons are needed.",
            path=features.path,
        )


def _require_finite(
    xyz: NDArray[np.float64],
    has_z: NDArray[np.bool_],
    bounds: NDArray[np.int64],
    rows: NDArray[np.int64],
    features: Features,
) -> None:
    wrong = ~np.isfinite(xyz[:, :2]).all(axis=1) | (has_z & ~np.isfinite(xyz[:, 2]))
    if not wrong.any():
        return
    first = int(np.argmax(wrong))
    line = int(np.searchsorted(bounds, first, side="right")) - 1
    raise ReadError(
        f"'{features.path}' has {int(wrong.sum())} vertices that are not finite (first: vertex "
        f"{first - int(bounds[line])} of feature {features.numbers[rows[line]]}, "
        f"{xyz[first].tolist()}): every coordinate must be a finite number.",
        path=features.path,
    )


# --------------------------------------------------------------------------- CRS


def _moved(xy: NDArray[np.float64], features: Features, crs: str | None) -> NDArray[np.float64]:
    """Reproject in the plane."""
    level = np.column_stack([xy, np.zeros(len(xy))])
    source, target = _flat(features.crs), _flat(crs)
    moved, _ = placed(level, source=source, target=target, path=features.path)
    return moved[:, :2]


def _flat(text: str | None) -> str | None:
    """Return the horizontal part of a CRS, so that no vertical datum plays a part."""
    if text is None:
        return None
    crs = as_crs(text)
    if crs.is_compound:
        crs = crs.sub_crs_list[0]
    return crs_text(crs.to_2d() if len(crs.axis_info) > 2 else crs)


def _crs_notes(features: Features, crs: str | None, *, has_heights: bool) -> list[str]:
    source, name = features.crs, features.path.name
    if source is None:
        return [] if crs is None else [f"'{name}' names no CRS: taken to be in {crs_label(crs)}."]
    if crs is None:
        return [f"'{name}' is in {crs_label(source)}: taken to be the CRS of the points."]
    theirs, ours = elevation_unit(source), elevation_unit(crs)
    if not has_heights or theirs.metres == ours.metres:
        return []
    return [
        f"'{name}': heights are taken as they are, though its CRS has them in {theirs.name} and "
        f"that of the points in {ours.name}."
    ]
