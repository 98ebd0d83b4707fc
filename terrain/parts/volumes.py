"""Cut and fill, tile by tile, in exact sums.

A triangle is measured by the tile that owns it. A sum is kept as doubles that add up to it exactly,
whatever the tiles, and rounded once when all of them are in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.types import Bounds
from .. import _kernel
from ..earthwork import as_table, describe_overlaps, subtract
from ..surface import Pieces, Surface, cut_pieces
from .surfaces import are_owned_triangles

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import BoolArray, Float64Array
    from ...base.results import Table
    from ...tin.tiling import LocalTriangulation
    from ..earthwork import Plane
    from ..surface import Reference


class VolumeOptions(NamedTuple):
    """What is measured: the arguments of :func:`tinsmith.volume`, settled."""

    reference: Reference
    """Units, and the factor from elevations to the unit of eastings."""
    plane: Plane | None = None
    """The base; None to measure to another surface."""
    names: tuple[str, ...] = ("all",)
    """Of the regions; ``["all"]`` for none."""
    regions: Pieces | None = None
    """Triangles of the regions, with the number of each one's."""
    scales: tuple[float, float] = (1.0, 1.0)
    """Factors of the elevations of the surface and of the other one to a common unit."""


class VolumePart(NamedTuple):
    """Exact sums of groups, each as doubles that add up to it."""

    terms: Float64Array
    """(g, 8, t), of the columns of ``_kernel.SUMS`` but the last two."""
    extremes: Float64Array
    """(g, 2), the last two."""
    areas: Float64Array
    other_areas: Float64Array
    """Both (g, t), of the surface, and of the other one; of regions, if there are any, the part of
    these."""


def find_reach(part: LocalTriangulation, box: Bounds) -> Bounds:
    """Return the box of which a part of the other surface is needed.

    That of the tile, and of the triangles that the tile owns, which may reach far out of it.
    """
    owned = part.points[part.triangles[are_owned_triangles(part, box)], :2]
    low = np.fmin(owned.min(axis=(0, 1), initial=np.inf), (box.xmin, box.ymin))
    high = np.fmax(owned.max(axis=(0, 1), initial=-np.inf), (box.xmax, box.ymax))
    return Bounds(*low.tolist(), *high.tolist())


def compute_part(
    part: LocalTriangulation,
    box: Bounds,
    options: VolumeOptions,
    other: LocalTriangulation | Surface | None = None,
) -> VolumePart:
    """Return the sums over the triangles that a tile owns.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet the box.
    box : Bounds
        Of the tile; of those that tile the plane each triangle is owned by one.
    options : VolumeOptions
    other : LocalTriangulation or Surface, optional
        All triangles of the other surface that meet :func:`find_reach`.
    """
    groups = len(options.names)
    up = options.reference.up
    surface = _take(part, are_owned_triangles(part, box), options.scales[0])
    pieces = _cut(surface, options.regions)
    own = (pieces.surface.points, pieces.surface.triangles)
    areas = _kernel.terms_of_areas(*own, pieces.groups, groups)
    if other is None:
        assert options.plane is not None
        heights = options.plane.heights_above(pieces.surface.points)
        sums = _kernel.terms_of_heights(*own, heights, pieces.groups, groups, up)
        return VolumePart(sums.terms, sums.extremes, areas, np.zeros_like(areas))
    second = _take(other, np.ones(len(other.triangles), np.bool_), options.scales[1])
    sums = _kernel.terms_between(
        *own, pieces.groups, groups, second.points, second.triangles, up, is_other_apart=True
    )
    second = _take(other, are_owned_triangles(other, box), options.scales[1])
    return VolumePart(sums.terms, sums.extremes, areas, _measure_other(second, options))


def _take(part: LocalTriangulation | Surface, which: BoolArray, scale: float) -> Surface:
    points = part.points if scale == 1.0 else part.points * (1.0, 1.0, scale)
    return Surface(
        np.ascontiguousarray(points), np.ascontiguousarray(part.triangles[which], np.int32)
    )


def _cut(surface: Surface, regions: Pieces | None) -> Pieces:
    if regions is None:
        return Pieces(surface, np.zeros(len(surface.triangles), np.int32))
    return cut_pieces(surface, regions)


def _measure_other(second: Surface, options: VolumeOptions) -> Float64Array:
    """Return the area of the other surface, in regions if there are any."""
    groups, regions = len(options.names), options.regions
    if regions is None:
        whole = np.zeros(len(second.triangles), np.int32)
        return _kernel.terms_of_areas(second.points, second.triangles, whole, groups)
    return _kernel.terms_between(
        regions.surface.points,
        regions.surface.triangles,
        regions.groups,
        groups,
        second.points,
        second.triangles,
        options.reference.up,
        is_other_apart=True,
    ).terms[:, 0]


def merge(one: VolumePart, other: VolumePart) -> VolumePart:
    """Return the sums of two parts together, in as few doubles as those of one."""
    return VolumePart(
        _merge_terms(one.terms, other.terms),
        np.column_stack(
            [
                np.minimum(one.extremes[:, 0], other.extremes[:, 0]),
                np.maximum(one.extremes[:, 1], other.extremes[:, 1]),
            ]
        ),
        _merge_terms(one.areas, other.areas),
        _merge_terms(one.other_areas, other.other_areas),
    )


def _merge_terms(one: Float64Array, other: Float64Array) -> Float64Array:
    both = np.concatenate([one, other], axis=-1)
    rows = np.ascontiguousarray(both.reshape(-1, both.shape[-1]))
    return _kernel.merge_terms(rows).reshape(one.shape)


def join(parts: Iterable[VolumePart], options: VolumeOptions) -> Table:
    """Return the table of the whole surface, of the parts of all tiles in any order."""
    found: VolumePart | None = None
    for part in parts:
        found = part if found is None else merge(found, part)
    assert found is not None
    sums = np.column_stack([_round(found.terms), found.extremes])
    notes: list[str] = []
    alone: dict[str, Float64Array] = {}
    if options.plane is not None:
        sums[:, 7] *= options.plane.steepness(options.reference.up)
    else:
        alone["area_alone"] = subtract(_round(found.areas), sums[:, 0])
    if options.regions is not None:
        notes = describe_overlaps(options.regions, list(options.names))
    if options.regions is not None or options.plane is None:
        others = _measure_regions(options) if options.plane else _round(found.other_areas)
        alone["base_area_alone"] = subtract(others, sums[:, 0])
    return as_table(list(options.names), sums, alone, options.reference, notes)


def _round(terms: Float64Array) -> Float64Array:
    rows = np.ascontiguousarray(terms.reshape(-1, terms.shape[-1]))
    return _kernel.sum_rows(rows).reshape(terms.shape[:-1])


def _measure_regions(options: VolumeOptions) -> Float64Array:
    assert options.regions is not None
    surface = options.regions.surface
    return _kernel.sum_areas(
        surface.points, surface.triangles, options.regions.groups, len(options.names)
    )
