"""Voronoi: the dual of the Delaunay triangulation, one cell for each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import require_distance
from ...base.crs import require_lengths
from ...base.errors import LinesError, OptionError
from ...base.sentences import counted
from ...base.types import Bounds
from .. import _kernel
from ..constraints import as_ring
from ..topology import find_offsets
from ..validation import thread_count
from .cells import Rings, cells_in_box, measure_signed_areas

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import AnyArray, Float64Array, Int64Array, ObjectArray
    from ...base.crs import CRS

_PAD_SHARE = 0.1
"""How far the default boundary lies beyond the vertices, of the longer side of their bounds."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Voronoi:
    """A Voronoi diagram within a boundary: for each vertex the places nearest to it.

    Made by :func:`tinsmith.voronoi`. All arrays are read-only. ``len`` is the number of cells.

    Attributes
    ----------
    coords : (k, 2) float64 array, CRS units
        Corners of all cells, counter-clockwise, the first not repeated; no two in a row are equal.
    offsets : (n + 1,) int64 array
        The cell of vertex i is ``coords[offsets[i]:offsets[i + 1]]``.
    part_offsets : (p + 1,) int64 array
        As ``offsets``, but for each part: a concave boundary can cut a cell into several. Else the
        same as ``offsets``.
    boundary : (b, 2) float64 array, CRS units
        Corners of the ring that the cells are clipped to.
    crs : CRS or None
        That of the TIN.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8], [2, 2, 9]])
    >>> diagram = ts.voronoi(tin, pad=0)
    >>> diagram
    <Voronoi: 5 cells, 16 corners, area 16>
    >>> diagram.areas
    array([2., 2., 2., 2., 8.])
    """

    coords: Float64Array
    offsets: Int64Array
    part_offsets: Int64Array
    boundary: Float64Array
    crs: CRS | None = None

    def __post_init__(self) -> None:
        for array in (self.coords, self.offsets, self.part_offsets, self.boundary):
            array.flags.writeable = False

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @cached_property
    def areas(self) -> Float64Array:
        """Area of each cell, (n,) float64 array, CRS units squared; 0 outside the boundary.

        Raises CrsError where coordinates are longitude and latitude.
        """
        require_lengths(self.crs)
        parts = measure_signed_areas(Rings(self.coords, self.part_offsets))
        areas: Float64Array = np.zeros(len(self))
        np.add.at(areas, self.cell_of_part, parts)
        areas.flags.writeable = False
        return areas

    def to_shapely(self) -> ObjectArray:
        """Return the cells as shapely geometries.

        Returns
        -------
        (n,) object array
            A ``Polygon`` for each vertex; empty where the cell is, a ``MultiPolygon`` where a
            concave boundary cuts it.

        Notes
        -----
        The polygons are valid, but for cells of points that lie on one circle up to rounding:
        these can have sides as short as that rounding.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]])
        >>> ts.voronoi(tin, pad=0).to_shapely()[0].area
        4.0
        """
        shapely = optional.load("shapely")
        parts = _make_polygons(Rings(self.coords, self.part_offsets))
        whole = np.bincount(self.cell_of_part, minlength=len(self))
        cells = np.full(len(self), shapely.Polygon(), object)
        is_single = (whole == 1)[self.cell_of_part]
        cells[self.cell_of_part[is_single]] = parts[is_single]
        for cell in np.flatnonzero(whole > 1):
            cells[cell] = shapely.multipolygons(parts[self.cell_of_part == cell])
        return cells

    @cached_property
    def cell_of_part(self) -> Int64Array:
        """The cell that each part belongs to, (p,) int64 array."""
        filled = np.flatnonzero(np.diff(self.offsets))
        return filled[np.searchsorted(self.offsets[filled + 1], self.part_offsets[1:])]

    def __repr__(self) -> str:
        cells, corners = counted(len(self), "cell"), counted(len(self.coords), "corner")
        is_in_degrees = self.crs is not None and self.crs.is_geographic
        measured = "in degrees" if is_in_degrees else f"area {self.areas.sum():g}"
        return f"<Voronoi: {cells}, {corners}, {measured}>"


def divide_plane(
    points: Float64Array,
    *,
    boundary: Bounds | ArrayLike | None = None,
    pad: float | None = None,
) -> Voronoi:
    """Build the Voronoi diagram of the vertices of a TIN; see :func:`tinsmith.voronoi`."""
    if boundary is not None and pad is not None:
        raise OptionError("pad", pad, "None where a boundary is given: only bounds are padded")
    extent = Bounds.of(points)
    if boundary is None:
        if pad is None:
            pad = _PAD_SHARE * max(extent.width, extent.height)
        else:
            require_distance("pad", pad)
        box = Bounds(extent.xmin - pad, extent.ymin - pad, extent.xmax + pad, extent.ymax + pad)
        return _make_diagram(_grow_cells(points, box), _list_corners(box))
    shapely = optional.load("shapely")
    given = _list_corners(boundary) if isinstance(boundary, Bounds) else boundary
    ring = as_ring(given, "the boundary")[:, :2].copy()
    region = shapely.Polygon(ring)
    if not shapely.is_valid(region):
        raise LinesError(
            f"The boundary is no simple ring ({shapely.is_valid_reason(region)}): "
            "it must have an area and must not touch or cross itself."
        )
    ring = ring if region.exterior.is_ccw else ring[::-1].copy()
    other = Bounds.of(ring)
    box = Bounds(
        min(extent.xmin, other.xmin),
        min(extent.ymin, other.ymin),
        max(extent.xmax, other.xmax),
        max(extent.ymax, other.ymax),
    )
    cells = _grow_cells(points, box)
    if isinstance(boundary, Bounds) and box == boundary:
        return _make_diagram(cells, ring)
    return _clip(cells, ring)


def _make_diagram(cells: Rings, boundary: Float64Array) -> Voronoi:
    """Return a diagram whose cells are all of one part, or empty."""
    filled = np.append(True, np.diff(cells.offsets) > 0)
    return Voronoi(
        coords=cells.coords,
        offsets=cells.offsets,
        part_offsets=cells.offsets[filled],
        boundary=boundary,
    )


def _grow_cells(points: Float64Array, box: Bounds) -> Rings:
    """Return a cell for each vertex; of several at one place the first has it."""
    growth = _kernel.grow(points, threads=thread_count(None, len(points)))
    xy = np.ascontiguousarray(points[:, :2])
    if growth.kept_row is None:
        return cells_in_box(xy, growth, box)
    is_kept = growth.kept_row == np.arange(len(xy))
    cells = cells_in_box(np.ascontiguousarray(xy[is_kept]), growth, box)
    counts = np.zeros(len(xy), np.int64)
    counts[is_kept] = np.diff(cells.offsets)
    return Rings(cells.coords, find_offsets(counts))


# ---------------------------------------------------------------- the boundary


def _list_corners(box: Bounds) -> Float64Array:
    """Return the corners of a box, counter-clockwise."""
    return np.array(
        [
            [box.xmin, box.ymin],
            [box.xmax, box.ymin],
            [box.xmax, box.ymax],
            [box.xmin, box.ymax],
        ]
    )


def _clip(cells: Rings, ring: Float64Array) -> Voronoi:
    """Return the parts of cells inside a ring; cells that it does not cut stay as they are."""
    shapely = optional.load("shapely")
    region = shapely.Polygon(ring)
    shapely.prepare(region)
    near = _find_near(cells, Bounds.of(ring))
    shapes = _make_polygons(_keep_only(cells, near))
    inside = shapely.covers(region, shapes)
    parts, of = _find_parts_inside(region, shapes[~inside])
    shapes = np.concatenate([shapes[inside], parts])
    owner = np.concatenate([near[inside], near[~inside][of]])
    order = np.argsort(owner, kind="stable")
    rings = _get_rings(shapes[order])
    counts = np.bincount(owner, np.diff(rings.offsets)[np.argsort(order)], len(cells.offsets) - 1)
    return Voronoi(
        coords=rings.coords,
        offsets=find_offsets(counts.astype(np.int64)),
        part_offsets=rings.offsets,
        boundary=ring,
    )


def _find_near(cells: Rings, box: Bounds) -> Int64Array:
    """Return the cells whose bounds meet a box."""
    filled = np.flatnonzero(np.diff(cells.offsets))
    if len(filled) == 0:
        return filled
    low = np.minimum.reduceat(cells.coords, cells.offsets[filled])
    high = np.maximum.reduceat(cells.coords, cells.offsets[filled])
    meets = (low <= [box.xmax, box.ymax]) & (high >= [box.xmin, box.ymin])
    return filled[meets.all(axis=1)]


def _keep_only(rings: Rings, which: Int64Array) -> Rings:
    """Return some of the rings; the others are empty."""
    counts = np.diff(rings.offsets)
    taken = np.bincount(which, minlength=len(counts)) * counts
    return Rings(rings.coords[np.repeat(taken > 0, counts)], find_offsets(taken))


def _find_parts_inside(region: Any, shapes: AnyArray) -> tuple[AnyArray, Int64Array]:
    """Return the polygons in which shapes meet a region, and the shape that each is a part of."""
    shapely = optional.load("shapely")
    # Corners rounded to coordinates can make a cell of rounding width cross itself.
    broken = ~shapely.is_valid(shapes)
    shapes[broken] = shapely.make_valid(shapes[broken])
    parts, of = shapely.get_parts(shapely.intersection(shapes, region), return_index=True)
    parts, deeper = shapely.get_parts(parts, return_index=True)
    has_area = shapely.area(parts) > 0
    return parts[has_area], of[deeper][has_area]


def _make_polygons(rings: Rings) -> AnyArray:
    """Return the rings that are not empty as shapely polygons."""
    shapely = optional.load("shapely")
    counts = np.diff(rings.offsets)
    ring = np.repeat(np.arange(np.count_nonzero(counts)), counts[counts > 0])
    polygons: AnyArray = shapely.polygons(shapely.linearrings(rings.coords, indices=ring))
    return polygons


def _get_rings(polygons: AnyArray) -> Rings:
    """Return the outer rings of polygons, counter-clockwise, the first corner not repeated."""
    shapely = optional.load("shapely")
    coords, ring = shapely.get_coordinates(polygons, return_index=True)
    is_last = np.append(ring[1:] != ring[:-1], True)[: len(ring)]
    coords, ring = coords[~is_last], ring[~is_last]
    offsets = find_offsets(np.bincount(ring, minlength=len(polygons)))
    clockwise = (measure_signed_areas(Rings(coords, offsets)) < 0)[ring]
    number = np.arange(len(coords))
    turned = np.where(clockwise, offsets[ring] + offsets[ring + 1] - 1 - number, number)
    return Rings(coords[turned], offsets)
