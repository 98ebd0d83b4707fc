"""Single lines and rings of features, as arrays in the CRS wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.crs import assume_elevation_unit
from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from ...tin.topology import find_offsets
from ..reprojection import find_conversion_factor, place
from .elevations import find_elevation_unit
from .geojson import join_at_antimeridian
from .layers import list_lines, take_apart

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.crs import CRS, Unit
    from .layers import Layer


class Part(NamedTuple):
    """A line or ring."""

    coords: Float64Array
    """(k, 2) or (k, 3)."""
    row: int
    """Of its feature."""
    is_closed: bool
    ring: int
    """0 for lines and outer rings, 1, 2, ... for the inner rings of a polygon."""


class Wanted(NamedTuple):
    """What lines are to be measured in, as the points are, and what the caller declares of them."""

    crs: CRS | None = None
    """Of the points."""
    target_unit: Unit | None = None
    """Of their elevations, if it is known."""
    elevation_unit: Unit | None = None
    """Of the elevations in the file, if its CRS does not tell."""


def split_into_parts(
    features: Layer, wanted: Wanted, *, drape: bool, notes: list[str] | None
) -> list[Part]:
    """Return the lines and rings of all features, in their order.

    Parameters
    ----------
    features : Layer
    wanted : Wanted
        Without a CRS lines stay in the file's own.
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
    shapely = optional.load("shapely")
    features = join_at_antimeridian(features, wanted.crs)
    shapes, of_shapes = take_apart(features)
    points = np.flatnonzero(shapely.get_type_id(shapes) == 0)
    if len(points):
        raise ReadError(
            f"{FILE} has {counted(len(points), 'point')} (first: feature "
            f"{features.numbers[of_shapes[points[0]]]}): lines or polygons are needed."
        )
    lines, rows, slots = list_lines(features)
    numbers = np.arange(len(slots)) - np.searchsorted(slots, slots)
    xyz = shapely.get_coordinates(lines, include_z=True)
    bounds = find_offsets(shapely.get_num_coordinates(lines))
    has_z = shapely.has_z(lines) & (not drape)
    _require_finite_vertices(xyz, np.repeat(has_z, np.diff(bounds)), bounds, rows, features)
    said = list(features.notes) + crs_notes(features, wanted)
    if has_z.any():
        xyz[:, 2] *= find_elevation_factor(features, wanted, notes=said)
    xyz[:, :2] = move_to_crs(xyz[:, :2], features, wanted.crs, notes=said)
    if notes is not None:
        notes.extend(said)
    return [
        Part(xyz[start:end, :width], row, is_closed, ring)
        for start, end, width, row, is_closed, ring in zip(
            bounds[:-1].tolist(),
            bounds[1:].tolist(),
            np.where(has_z, 3, 2).tolist(),
            rows.tolist(),
            shapely.is_closed(lines).tolist(),
            numbers.tolist(),
            strict=True,
        )
    ]


def _require_finite_vertices(
    xyz: Float64Array,
    has_z: BoolArray,
    bounds: Int64Array,
    rows: Int64Array,
    features: Layer,
) -> None:
    wrong = ~np.isfinite(xyz[:, :2]).all(axis=1) | (has_z & ~np.isfinite(xyz[:, 2]))
    if not wrong.any():
        return
    first = int(np.argmax(wrong))
    line = int(np.searchsorted(bounds, first, side="right")) - 1
    raise ReadError(
        f"{FILE} has {_describe_not_finite(int(wrong.sum()))} (first: vertex "
        f"{first - int(bounds[line])} of feature {features.numbers[rows[line]]}, "
        f"{xyz[first].tolist()}): every coordinate must be a finite number."
    )


# --------------------------------------------------------------------------- CRS


def move_to_crs(
    xy: Float64Array, features: Layer, crs: CRS | None, *, notes: list[str]
) -> Float64Array:
    """Reproject places of features in the plane.

    What is odd about where they lie is appended to ``notes``.

    Raises
    ------
    CrsError
        If they cannot be brought into the CRS.
    """
    level = np.column_stack([xy, np.zeros(len(xy))])
    source, target = _drop_vertical_axis(features.crs), _drop_vertical_axis(crs)
    placed = place(level, source=source, target=target)
    notes.extend(f"'{features.path.name}': {note}" for note in placed.noted)
    return placed.points[:, :2]


def _drop_vertical_axis(crs: CRS | None) -> CRS | None:
    """Return the horizontal part of a CRS, so that no vertical datum plays a part."""
    return None if crs is None else crs.horizontal


def crs_notes(features: Layer, wanted: Wanted) -> list[str]:
    """Tell which CRS is assumed where one of the two is not known."""
    source, crs, name = features.crs, wanted.crs, features.path.name
    if source is None:
        return [] if crs is None else [f"'{name}' names no CRS: taken to be in {crs.label}."]
    if crs is None:
        return [f"'{name}' is in {source.label}: taken to be the CRS of the points."]
    return []


# ------------------------------------------------------------------------- units


def find_elevation_factor(features: Layer, wanted: Wanted, *, notes: list[str]) -> float:
    """Return the factor from a file's elevations to those of the points; their datum stays.

    Parameters
    ----------
    features : Layer
    wanted : Wanted
    notes : list of str
        What had to be assumed or converted is appended to it.

    Raises
    ------
    OptionError
        If the unit declared is not the one that the file tells.
    ReadError
        If the unit of the points is known, that of the file is not, and its CRS is usual with
        another one.
    """
    source = features.crs or wanted.crs
    theirs = find_elevation_unit(features, wanted.elevation_unit)
    ours = wanted.target_unit or (None if wanted.crs is None else wanted.crs.vertical_unit)
    if theirs is None and features.crs is None:
        return 1.0
    from_unit = assume_elevation_unit(source, theirs)
    to_unit = assume_elevation_unit(wanted.crs, ours) or from_unit
    factor = find_conversion_factor(from_unit, to_unit)
    if factor != 1.0 and from_unit is not None and to_unit is not None:
        if theirs is None and ours is not None:
            raise ReadError(
                f"{FILE} does not tell the unit of its elevations: the points have theirs in "
                f"{ours.name}, and {from_unit.name} is usual in the CRS of the file; declare the "
                "unit of the lines' elevations."
            )
        # Say which elevations were converted, and what was assumed for it.
        units = (from_unit, to_unit)
        text = f"'{features.path.name}': elevations were converted from {units[0].name} to "
        text += f"{units[1].name}, the unit of the points"
        guessed = []
        if theirs is None:
            guessed.append(f"of the lines {units[0].name}")
        if ours is None:
            guessed.append(f"of the points {units[1].name}")
        reason = (
            f"; not told and taken as usual in the CRS: {', '.join(guessed)}" if guessed else ""
        )
        notes.append(f"{text}{reason}.")
    return factor


def _describe_not_finite(count: int) -> str:
    vertices = counted(count, "vertex", "vertices")
    return f"{vertices} that {'is' if count == 1 else 'are'} not finite"
