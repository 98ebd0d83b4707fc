"""The overlay of a surface and another one, or a plane, in triangles, a part at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from ..surface import Surface, double_areas, fan_out
from .meshes import classify_signs, divide_at_zero

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array, Int8Array, Int32Array, Int64Array
    from ..surface import Pieces
    from .planes import Plane

_CHUNK = 1 << 16
"""Triangles of the first surface that are overlaid at a time."""


class Cells(NamedTuple):
    """Triangles that lie in one triangle of the first surface, and in one of the other.

    None of them has differences of both signs.
    """

    points: Float64Array
    """(n, 3): in the third column the other surface less the first."""
    triangles: Int32Array
    """(m, 3)."""
    first: Int64Array
    """(m,), the triangle of the first surface."""
    other: Int64Array | None
    """(m,), that of the other one; None if it is a plane."""

    def measure_areas(self) -> Float64Array:
        """Return the areas of the triangles: none of what rounding has turned over."""
        return np.maximum(double_areas(self.points, self.triangles), 0.0) / 2.0

    def classify(self) -> Int8Array:
        """Return +1 for triangles that are filled, -1 for those cut, 0 where surfaces agree."""
        return classify_signs(self.points, self.triangles)


class Overlay:
    """A first surface in groups of pieces, and another one or a plane."""

    def __init__(self, pieces: Pieces, other: Surface | None, plane: Plane | None) -> None:
        self._pieces, self._other, self._plane = pieces, other, plane
        self._order = np.lexsort((_find_west(pieces.surface), pieces.groups))
        self._groups = pieces.groups[self._order]
        self._boxes = None if other is None else _find_boxes(other)

    def list_cells(self, group: int) -> Iterator[Cells]:
        """Yield the cells of a group, west to east."""
        own = self._order[slice(*np.searchsorted(self._groups, [group, group + 1]))]
        for start in range(0, len(own), _CHUNK):
            chosen = own[start : start + _CHUNK]
            made = self._cut_plane(chosen) if self._other is None else self._cut_other(chosen)
            if made is not None:
                points, triangles, parents = divide_at_zero(made.points, made.triangles)
                beyond = None if made.other is None else made.other[parents]
                yield Cells(points, triangles, made.first[parents], beyond)

    def _find_sources(self, chosen: Int64Array) -> Int64Array:
        sources = self._pieces.sources
        return chosen if sources is None else sources[chosen]

    def _cut_plane(self, chosen: Int64Array) -> Cells:
        assert self._plane is not None
        surface = _take(self._pieces.surface, chosen)
        heights = self._plane.heights_above(surface.points)
        points = np.column_stack([surface.points[:, :2], heights])
        return Cells(points, surface.triangles, self._find_sources(chosen), None)

    def _cut_other(self, chosen: Int64Array) -> Cells | None:
        assert self._other is not None
        assert self._boxes is not None
        first = _take(self._pieces.surface, chosen)
        low, high = first.points[:, :2].min(axis=0), first.points[:, :2].max(axis=0)
        near = np.flatnonzero(((self._boxes[0] <= high) & (self._boxes[1] >= low)).all(axis=1))
        if not len(near):
            return None
        other = _take(self._other, near)
        made = _kernel.overlay(first.points, first.triangles, other.points, other.triangles)
        triangles, cells = fan_out(made.offsets, made.corners)
        ours, theirs = made.triangles[cells].T
        return Cells(made.vertices, triangles, self._find_sources(chosen)[ours], near[theirs])


def _find_west(surface: Surface) -> Float64Array:
    west: Float64Array = surface.points[surface.triangles, 0].min(axis=1)
    return west


def _find_boxes(surface: Surface) -> tuple[Float64Array, Float64Array]:
    corners = surface.points[surface.triangles, :2]
    return corners.min(axis=1), corners.max(axis=1)


def _take(surface: Surface, chosen: Int64Array) -> Surface:
    """Return some of the triangles, with the points that they have."""
    used, corners = np.unique(surface.triangles[chosen], return_inverse=True)
    return Surface(surface.points[used], corners.reshape(-1, 3).astype(np.int32))
