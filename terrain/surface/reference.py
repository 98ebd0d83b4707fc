"""In which units areas and volumes come, and the surfaces and pieces that they are measured of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import require_tin
from ...base.crs import require_projected
from ...base.errors import PointsError
from ...base.georeference import Reference, agree
from ...tin import topology
from ...tin.predicates import columns, orientation
from .. import _kernel

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int32Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...base.georeference import Referenced
    from ...tin import TIN

_NEEDS_LENGTHS = (
    " cannot be measured in degrees, and the TIN is in {crs}: build it in a projected CRS, such as "
    "UTM."
)


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles of a surface, or pieces of them."""

    points: Float64Array
    """(n, 3)."""
    triangles: Int32Array
    """(m, 3), counter-clockwise."""

    def find_border(self) -> Int64Array:
        """Return the edges with one triangle, (k, 2)."""
        start, end = topology.directed_edges(self.triangles)
        edges = np.stack([start.ravel(), end.ravel()], axis=1).astype(np.int64)
        keys = topology.edge_keys(edges, len(self.points))
        _, first, counts = np.unique(keys, return_index=True, return_counts=True)
        border: Int64Array = edges[first[counts == 1]]
        return border


def find_reference(tin: TIN, purpose: str) -> Reference:
    """Read the units of a TIN.

    Raises CrsError if coordinates are angles.
    """
    require_tin(tin)
    return make_reference(tin.crs, tin.elevation_unit, purpose)


def make_reference(crs: CRS | None, unit: Unit | None, purpose: str) -> Reference:
    """Return the units of a CRS and of elevations; errors as of :func:`find_reference`."""
    require_projected(crs, purpose + _NEEDS_LENGTHS)
    return Reference.of(crs, unit)


def find_common_reference(tin: TIN, other: TIN, purpose: str) -> tuple[Reference, Surface, Surface]:
    """Read the units of two TINs, and return both surfaces in them.

    Raises CrsError if coordinates are angles, or as :func:`tinsmith.base.georeference.agree` says.
    """
    for one in (tin, other):
        require_tin(one)
    reference = agree_on_reference(tin, other, purpose)
    first, second = (
        Surface(_scale_up(one.triangulation.points, factor), one.triangulation.triangles)
        for one, factor in zip((tin, other), reference.factors, strict=True)
    )
    return reference, first, second


def agree_on_reference(one: Referenced, other: Referenced, purpose: str) -> Reference:
    """Return the units of two surfaces, and the factors from the elevations of each to them.

    Errors as of :func:`find_common_reference`.
    """
    for each in (one, other):
        require_projected(each.crs, purpose + _NEEDS_LENGTHS)
    return agree((one, other), ("the first surface", "the other surface"))


def _scale_up(points: Float64Array, factor: float) -> Float64Array:
    if factor == 1.0:
        return points
    return np.ascontiguousarray(points * (1.0, 1.0, factor))


def require_finite(values: Float64Array) -> None:
    """Refuse sums that double precision cannot hold."""
    if np.isnan(values).any():
        raise PointsError(
            "Coordinates or elevations are too large for volumes in double precision: their "
            "products must stay below 1e308."
        )


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """The parts of a surface's triangles in some groups."""

    surface: Surface
    groups: Int32Array
    """(m,)."""
    sources: Int64Array | None = None
    """(m,), the triangles that they are pieces of; None if each is whole."""


def fan_out(offsets: Int64Array, corners: Int32Array) -> tuple[Int32Array, Int64Array]:
    """Cut convex cells into triangles from their first corners.

    Returns the triangles, (m, 3), and the cell of each, (m,).
    """
    counts = np.diff(offsets) - 2
    cells = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(cells)) - np.repeat(np.cumsum(counts) - counts, counts)
    apex = offsets[cells]
    second = apex + within + 1
    return np.stack([corners[apex], corners[second], corners[second + 1]], axis=1), cells


def turns(points: Float64Array, triangles: Int32Array) -> AnyArray:
    """Return +1 for counter-clockwise triangles, -1 for clockwise, 0 for none; exactly."""
    xy = columns(points)
    return orientation(xy, *(triangles[:, k] for k in range(3)))


def cut_pieces(surface: Surface, regions: Pieces) -> Pieces:
    """Cut a surface along the edges of regions; what is in none of them is left out.

    The regions' triangles have the elevation 0.
    """
    made = _kernel.overlay(
        surface.points, surface.triangles, regions.surface.points, regions.surface.triangles
    )
    points = made.vertices.copy()
    points[:, 2] = 0.0 - points[:, 2]  # 0 above the surface is minus its elevation
    own = made.origins[:, 0] >= 0
    points[own, 2] = surface.points[made.origins[own, 0], 2]
    triangles, cells = fan_out(made.offsets, made.corners)
    # Rounding turns over what is thinner than coordinates can tell, which has no area to speak of.
    sound = turns(points, triangles) > 0
    sources, within = made.triangles[cells[sound]].T
    surface_of = Surface(points, np.ascontiguousarray(triangles[sound]))
    return Pieces(surface_of, regions.groups[within], sources.astype(np.int64))
