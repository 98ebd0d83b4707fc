"""Height residuals: how far each vertex is above the surface that the others make without it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..topology import edges_at
from ..validation.threads import thread_count

if TYPE_CHECKING:
    from ...arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..triangulation import Triangulation

__all__ = ["Residuals", "fit_plane"]

_TERMS = 3
"""Of a plane: fewer neighbours than these and one more say nothing about a point."""


@dataclass(frozen=True, slots=True, eq=False)
class Residuals:
    """What measures residuals of a surface, whose elevations may be corrected meanwhile."""

    surface: Triangulation
    xyz: Float64Array
    """(n, 3), its points; elevations of blunders are replaced by those of the others' surface."""
    on_line: BoolArray
    """(n,), whether edges of lines or of a boundary meet in the vertex."""
    chords: Int32Array
    """(n, 2), the vertices before and behind it where exactly two such edges meet, else -1."""
    _without: _kernel.LeaveOneOut = field(init=False)

    def __post_init__(self) -> None:
        surface = self.surface
        without = _kernel.LeaveOneOut(self.xyz, surface.triangles, surface.neighbors)
        object.__setattr__(self, "_without", without)

    @classmethod
    def of(cls, surface: Triangulation) -> Residuals:
        """Prepare a surface."""
        count = len(surface.points)
        chords = np.full((count, 2), -1, np.int32)
        if not surface.constrained.any():
            return cls(surface, surface.points.copy(), np.zeros(count, np.bool_), chords)
        pairs = np.unique(np.sort(edges_at(surface.triangles, surface.constrained), axis=1), axis=0)
        start, end = np.concatenate([pairs, pairs[:, ::-1]]).T
        degree = np.bincount(start, minlength=count)
        order = np.argsort(start, kind="stable")
        inner = degree[start[order]] == 2
        chords[degree == 2] = end[order][inner].reshape(-1, 2)
        return cls(surface, surface.points.copy(), degree > 0, chords)

    def measure(self, vertices: Int32Array) -> Float64Array:
        """Return the residuals of some vertices, as :meth:`measure_with_moments`."""
        return self.measure_with_moments(vertices)[0]

    def measure_with_moments(self, vertices: Int32Array) -> tuple[Float64Array, Float64Array]:
        """Return residuals of some vertices, and from how far they are measured; NaN for none.

        The moment is the mean square of the distances to the points that the elevation is
        interpolated between, by their weights: on curved ground residuals are in proportion to it.

        Notes
        -----
        Within the surface, and on straight parts of its boundary, it is the elevation less that of
        the constrained Delaunay triangulation without the vertex. A vertex of a line is compared
        with the chord between the vertices before and behind it, for a line is surveyed where the
        ground breaks; where lines end or meet nothing is told. Other vertices of the boundary are
        compared with the plane that fits the vertices within two edges of them best.
        """
        found = self._interpolate(vertices)
        at_corner = np.isnan(found[:, 0]) & ~self.on_line[vertices]
        if at_corner.any():
            found[at_corner] = self._extrapolate(vertices[at_corner])
        return self.xyz[vertices, 2] - found[:, 0], found[:, 1]

    def _interpolate(self, vertices: Int32Array) -> Float64Array:
        found = np.full((len(vertices), 2), np.nan)
        on_line = self.on_line[vertices]
        has_chord = self.chords[vertices, 0] >= 0
        found[has_chord] = self._interpolate_chords(vertices[has_chord])
        free = np.ascontiguousarray(vertices[~on_line])
        found[~on_line] = self._without.interpolate(free, thread_count(None, len(free)))
        return found

    def _interpolate_chords(self, vertices: Int32Array) -> Float64Array:
        before, behind = (self.xyz[self.chords[vertices, k]] for k in range(2))
        place = self.xyz[vertices]
        to_before = np.hypot(*(place - before)[:, :2].T)
        to_behind = np.hypot(*(place - behind)[:, :2].T)
        share = to_before / (to_before + to_behind)
        expected = (1 - share) * before[:, 2] + share * behind[:, 2]
        return np.column_stack([expected, to_before * to_behind])

    def _extrapolate(self, vertices: Int32Array) -> Float64Array:
        """Return elevations of planes through the vertices within two edges of some."""
        found = np.full((len(vertices), 2), np.nan)
        for i, vertex in enumerate(vertices.tolist()):
            ring = self.list_neighbors(vertices[i : i + 1])[1]
            around = np.setdiff1d(np.append(ring, self.list_neighbors(ring)[1]), [vertex])
            if len(around) > _TERMS:
                apart = self.xyz[around, :2] - self.xyz[vertex, :2]
                expected, _ = fit_plane(self.xyz[around], self.xyz[vertex])
                found[i] = expected, (apart**2).sum(axis=1).max()
        return found

    def list_neighbors(self, vertices: Int32Array) -> tuple[Int64Array, Int32Array]:
        """Return the vertices joined to some by edges, as offsets and vertices."""
        return self._without.list_neighbors(np.ascontiguousarray(vertices))


def fit_plane(points: Float64Array, place: Float64Array) -> tuple[float, Float64Array]:
    """Return the elevation at a place of the plane that fits points best.

    The second array are the elevations of the points, (k,), above the plane.
    """
    xy = points[:, :2] - place[:2]
    size = np.abs(xy).max()
    level = float(np.median(points[:, 2]))
    terms = np.column_stack([np.ones(len(xy)), xy / size])
    found = np.linalg.lstsq(terms, points[:, 2] - level, rcond=1e-6)[0]
    return level + float(found[0]), points[:, 2] - level - terms @ found
