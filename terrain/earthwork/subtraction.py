"""One surface less another one, as a TIN that is sound after rounding."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ...base.errors import PointsError
from ...base.sentences import coordinate
from ...tin import topology
from .. import _kernel
from ..surface import (
    Surface,
    double_areas,
    fan_out,
    leave_out_slivers,
    measure_rounding,
    require_finite,
)
from . import zones as parts
from .meshes import as_mesh, cut_at_zero, mend, part_places, rebuild

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from ...base.arrays import Float64Array, Int32Array
    from ...tin import TIN
    from ..surface import Reference
    from .detection import Detection

    _Mesh = tuple[Float64Array, Int32Array]

_SHARE_OF_VOLUME = 1e-7
"""Of the area times the largest difference: so much the volumes of the TIN may be off."""
_ROUNDINGS = 4.0
"""Or what so many roundings of every coordinate change: surfaces that agree differ by no more."""

_MOST_VERTICES = (2**31 - 1) // 4
"""Of an overlay: the kernel numbers them in 32 bits."""

_TOO_THIN = "The surfaces overlap only in what is thinner than coordinates can tell."


def subtract(
    first: Surface,
    second: Surface,
    sums: Mapping[str, float],
    holds: Callable[[Any], Any],
    reference: Reference,
    detection: Detection | None = None,
    *,
    share: float = 0.0,
) -> TIN:
    """Return the second surface less the first as a TIN, where both are.

    ``sums`` are those of the kernel of the same surfaces, which the volumes of the TIN must be;
    ``holds`` tells whether both surfaces hold places, (k, 2). The TIN is cut where the difference
    is 0, and as large as the level of ``detection``. Where no TIN has these volumes, the nearest
    counts if it is off by no more than a ``share`` of the area times the largest difference.

    Raises PointsError if they do not overlap, or only in what is thinner than coordinates can tell.
    """
    if len(first.triangles) == 0 or len(second.triangles) == 0:
        raise PointsError(_TOO_THIN)
    trimmed = _trim(first, second)
    made = _overlay(*trimmed)
    if len(made.triangles) == 0:
        _refuse_empty(first, second)
    require_finite(made.vertices)
    if not sums["area"] > 0.0:
        raise PointsError(_TOO_THIN)
    triangles, cells = fan_out(made.offsets, made.corners)
    slack = _measure_rounding(*trimmed, made.vertices, triangles, made.triangles[cells])
    given = _cut(made.vertices, triangles, detection)
    found = _make_sound(*given, holds, detection)
    return _choose_surface(found, reference, sums, slack, share=share)


def overlay_heights(first: Surface, second: Surface) -> _Mesh:
    """Return the triangles of the overlay, with the second surface less the first, for sums.

    They are cut where that is 0, and as they are rounded: some are turned over by it.

    Raises PointsError if the overlay has too many vertices.
    """
    made = _overlay(first, second)
    triangles, _ = fan_out(made.offsets, made.corners)
    return cut_at_zero(made.vertices, triangles)


def _cut(points: Float64Array, triangles: Int32Array, detection: Detection | None) -> _Mesh:
    """Cut a difference where it is 0, and as large as the level of detection."""
    points, triangles = cut_at_zero(points, triangles)
    if detection is None:
        return points, triangles
    divided = detection.divide(points, triangles)
    made = slice(len(points), None)
    detection.remember(divided.points[made, :2], divided.levels[made])
    return divided.points, divided.triangles


def _choose_surface(
    candidates: Iterator[_Mesh],
    reference: Reference,
    sums: Mapping[str, float],
    slack: float,
    *,
    share: float,
) -> TIN:
    """Return the first mesh whose volumes are those of the surfaces, else the nearest in a share.

    Raises PointsError if there is none: rounding has moved a wall, or left nothing.
    """
    least, nearest = np.inf, None
    most = sums["area"] * max(sums["highest"], -sums["lowest"])
    for mesh in candidates:
        surface = as_mesh(*mesh, crs=reference.crs, elevation_unit=reference.elevation_unit)
        found = _sum_classes(surface)
        apart = max(abs(found[name] - sums[name]) for name in ("cut", "fill"))
        if apart <= _SHARE_OF_VOLUME * most + _ROUNDINGS * slack:
            return surface
        if apart < least:
            least, nearest = apart, surface
    if nearest is not None and least <= share * most:
        return nearest
    if np.isfinite(least):
        raise PointsError(
            "The surfaces have walls that are thinner than coordinates can tell: the volume of "
            f"their difference as a TIN would be off by {least:.3g}. Round the points of both to "
            "a unit that they are surveyed in, such as a millimetre."
        )
    raise PointsError(
        "What both surfaces cover is thinner than coordinates can tell: round the points of both "
        "to a unit that they are surveyed in, such as a millimetre."
    )


def _trim(*surfaces: Surface) -> tuple[Surface, Surface]:
    """Return two surfaces without the triangles that lie along a boundary by rounding only.

    Their planes have any slope: what is interpolated in them at a rounded place is wrong by much
    more than they have area.
    """
    rounding = max(measure_rounding(surface.points) for surface in surfaces)
    first, second = (_trim_one(surface, rounding) for surface in surfaces)
    return first, second


def _trim_one(surface: Surface, rounding: float) -> Surface:
    points, triangles = surface.points, surface.triangles
    neighbors = topology.neighbors_of(triangles, len(points))
    return Surface(points, leave_out_slivers(points, triangles, neighbors, rounding)[0])


def _refuse_empty(first: Surface, second: Surface) -> NoReturn:
    """Refuse surfaces that do not overlap, or only in triangles that were left out."""
    if len(_overlay(first, second).triangles):
        raise PointsError(_TOO_THIN)
    raise PointsError(
        f"The surfaces do not overlap: one covers {_describe_extent(first)}, the other "
        f"{_describe_extent(second)}."
    )


def _overlay(first: Surface, second: Surface) -> _kernel.OverlayMesh:
    try:
        return _kernel.overlay(
            first.points, first.triangles, second.points, second.triangles, is_other_apart=True
        )
    except OverflowError:
        raise PointsError(
            f"The overlay of both surfaces has more than {_MOST_VERTICES:,} vertices: subtract "
            "parts of them."
        ) from None


def _measure_rounding(
    first: Surface,
    second: Surface,
    vertices: Float64Array,
    triangles: Int32Array,
    pairs: Int32Array,
) -> float:
    """Return how much a volume changes if the surfaces move by a rounding of their coordinates.

    That is the rounding times the rise over run of both, summed over the area of their overlay.
    """
    areas = np.abs(double_areas(vertices, triangles))
    total = 0.0
    for k, surface in enumerate((first, second)):
        whole = np.abs(double_areas(surface.points, surface.triangles))[pairs[:, k]]
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            shares = np.fmin(areas / whole, 1.0)  # of a triangle thinner than its rounding, all
            total += float((shares * _measure_rises(surface)[pairs[:, k]]).sum())
    moved = float(np.spacing(np.abs(vertices[:, :2]).max())) * total
    return moved if np.isfinite(moved) else 0.0


def _measure_rises(surface: Surface) -> Float64Array:
    """Return the rise over run of each triangle times its area, in the units that it has."""
    corners = surface.points[surface.triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    (ux, uy, uz), (vx, vy, vz) = u.T, v.T
    with np.errstate(invalid="ignore", over="ignore"):
        rises: Float64Array = 0.5 * np.hypot(uy * vz - uz * vy, uz * vx - ux * vz)
    return rises


def _sum_classes(surface: TIN) -> dict[str, float]:
    """Return cut and fill in the triangles that count as cut and as filled."""
    mesh = surface.triangulation
    heights = np.ascontiguousarray(mesh.points[:, 2])
    groups = parts.classify(mesh).astype(np.int32) + np.int32(1)
    sums = _kernel.sum_heights(mesh.points, mesh.triangles, heights, groups, 3, 1.0)
    column = _kernel.SUMS.index
    return {"cut": float(sums[0, column("cut")]), "fill": float(sums[2, column("fill")])}


def _make_sound(
    points: Float64Array,
    triangles: Int32Array,
    holds: Callable[[Any], Any],
    detection: Detection | None,
) -> Iterator[_Mesh]:
    """Yield the overlay mended, with walls a rounding wider, and triangulated anew.

    Where a new vertex moved the zero line, or one of the level of detection, it is cut once more.
    """
    for placed in (points, part_places(points, triangles)):
        mended = mend(placed, triangles)
        if mended is not None:
            yield mended
    for found in rebuild(points, triangles, holds):
        yield mend(*_cut(*found, detection)) or found


def _describe_extent(surface: Surface) -> str:
    used = surface.points[surface.triangles.ravel(), :2]
    (west, south), (east, north) = used.min(axis=0), used.max(axis=0)
    return (
        f"{coordinate(west)} to {coordinate(east)} east, {coordinate(south)} to "
        f"{coordinate(north)} north"
    )
