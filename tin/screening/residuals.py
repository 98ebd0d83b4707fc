"""Height residuals: how far each vertex is above the surface that the others make without it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..topology import NO_NEIGHBOR, edge_keys, edges_at, find_offsets, find_owners
from ..validation import thread_count

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..triangulation import Triangulation

_TERMS = 3
"""Of a plane: fewer neighbours than these and one more say nothing about a point."""
_MOST_LEVERAGE = 16.0
"""A plane tells elevations within so much, which is the square of four standard deviations."""
_MOST_PASSED = 64
"""Neighbours of a vertex over which others are near: all points around a far one are not."""


@dataclass(frozen=True, slots=True, eq=False)
class Residuals:
    """What measures residuals of a surface, whose elevations may be corrected meanwhile."""

    surface: Triangulation
    xyz: Float64Array
    """(n, 3), its points; elevations of blunders are replaced by those of the others' surface."""
    on_line: BoolArray
    """(n,), whether edges of lines within the surface meet in the vertex."""
    chords: Int32Array
    """(n, 2), the vertices before and behind it where exactly two such edges meet, else -1."""
    _without: _kernel.LeaveOneOut = field(init=False)
    _is_hub: BoolArray = field(init=False)

    def __post_init__(self) -> None:
        surface = self.surface
        without = _kernel.LeaveOneOut(self.xyz, surface.triangles, surface.neighbors)
        object.__setattr__(self, "_without", without)
        degree = np.bincount(surface.triangles.ravel(), minlength=len(self.xyz))
        object.__setattr__(self, "_is_hub", degree > _MOST_PASSED)

    @classmethod
    def of(cls, surface: Triangulation) -> Residuals:
        """Prepare a surface."""
        count = len(surface.points)
        chords = np.full((count, 2), -1, np.int32)
        is_inner = surface.constrained & (surface.neighbors != NO_NEIGHBOR)
        if not is_inner.any():
            return cls(surface, surface.points.copy(), np.zeros(count, np.bool_), chords)
        keys = np.unique(edge_keys(edges_at(surface.triangles, is_inner), count))
        first, second = np.divmod(keys, count)
        start, end = np.concatenate([first, second]), np.concatenate([second, first])
        degree = np.bincount(start, minlength=count)
        order = np.argsort(start, kind="stable")
        inner = degree[start[order]] == 2
        chords[degree == 2] = end[order][inner].reshape(-1, 2)
        return cls(surface, surface.points.copy(), degree > 0, chords)

    @classmethod
    def without_lines(cls, surface: Triangulation) -> Residuals:
        """Prepare a surface whose lines are not looked at."""
        count = len(surface.points)
        chords = np.broadcast_to(np.int32(-1), (count, 2))
        return cls(surface, surface.points, np.zeros(count, np.bool_), chords)

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
        ground breaks; beside the chord the ground goes on as the plane that fits the neighbours
        best falls. Where lines end or meet nothing is told. Other vertices of the boundary are
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
        along = behind - before
        with np.errstate(divide="ignore", invalid="ignore"):
            share = ((place - before) * along)[:, :2].sum(axis=1) / (along[:, :2] ** 2).sum(axis=1)
        share = np.clip(np.nan_to_num(share), 0.0, 1.0)
        foot = before + share[:, None] * along
        expected = foot[:, 2]
        beside = place[:, :2] - foot[:, :2]
        bends = np.flatnonzero(beside.any(axis=1))
        if len(bends):
            planes = fit_planes(self.xyz, vertices[bends], *self.list_neighbors(vertices[bends]))
            expected[bends] += (planes[:, 1:] * beside[bends]).sum(axis=1)
        to_ends = (np.hypot(*(place - end)[:, :2].T) for end in (before, behind))
        return np.column_stack([expected, np.multiply(*to_ends)])

    def _extrapolate(self, vertices: Int32Array) -> Float64Array:
        """Return elevations of planes through the vertices within two edges of some."""
        found = np.full((len(vertices), 2), np.nan)
        offsets, around = self.list_wide_neighbors(vertices)
        has_enough = np.diff(offsets) > _TERMS
        planes = fit_planes(self.xyz, vertices, offsets, around)
        owners = find_owners(offsets)
        apart = self.xyz[around, :2] - self.xyz[vertices[owners], :2]
        most = np.zeros(len(vertices))
        np.maximum.at(most, owners, (apart**2).sum(axis=1))
        found[has_enough, 0], found[has_enough, 1] = planes[has_enough, 0], most[has_enough]
        return found

    def measure_roughness(self, vertices: Int32Array) -> Float64Array:
        """Return how far at most the vertices within two edges of some are off their plane.

        As much as curved ground beside it may be off where the plane is extrapolated.
        """
        offsets, around = self.list_wide_neighbors(vertices)
        planes, owners = fit_planes(self.xyz, vertices, offsets, around), find_owners(offsets)
        left = measure_offsets(self.xyz, vertices, planes, owners, around)
        most = np.zeros(len(vertices))
        np.maximum.at(most, owners, np.abs(left))
        return most

    def list_wide_neighbors(self, vertices: Int32Array) -> tuple[Int64Array, Int32Array]:
        """Return the vertices within two edges of some, as offsets and vertices.

        A vertex of more than 64 neighbours is one of them, but they are not reached over it: the
        pairs stay in proportion to the vertices.
        """
        offsets, near = self.list_neighbors(vertices)
        owner = find_owners(offsets)
        goes_on = ~self._is_hub[near]
        wide, around = self.list_neighbors(near[goes_on])
        owner = np.concatenate([owner, owner[goes_on][find_owners(wide)]])
        reach = np.concatenate([near, around])
        owner, reach = np.divmod(np.unique(owner * len(self.xyz) + reach), len(self.xyz))
        elsewhere = reach != vertices[owner]
        owner, reach = owner[elsewhere], reach[elsewhere].astype(np.int32)
        return find_offsets(np.bincount(owner, minlength=len(vertices))), reach

    def list_neighbors(self, vertices: Int32Array) -> tuple[Int64Array, Int32Array]:
        """Return the vertices joined to some by edges, as offsets and vertices."""
        return self._without.list_neighbors(np.ascontiguousarray(vertices))


def fit_planes(
    xyz: Float64Array, vertices: Int32Array, offsets: Int64Array, around: Int32Array
) -> Float64Array:
    """Fit a plane to the points around each of some vertices, by least squares.

    The points around vertex ``vertices[i]`` are ``around[offsets[i]:offsets[i + 1]]``. Returns the
    elevation of each plane at the vertex, and its slopes to the east and north, (k, 3). NaN where
    there is no point, or the vertex lies so far beside them all that they do not tell the plane.
    """
    count, owners = len(vertices), find_owners(offsets)
    sizes = np.diff(offsets).astype(np.float64)

    def average(values: Float64Array) -> Float64Array:
        sums = np.bincount(owners, values, minlength=count)
        means: Float64Array = sums / np.where(sizes > 0, sizes, np.nan)
        return means

    apart = (xyz[around] - xyz[vertices[owners]]).T
    middle = np.array([average(axis) for axis in apart])
    x, y, z = apart - middle[:, owners]
    scale = np.sqrt(np.fmax(average(x * x) + average(y * y), np.finfo(float).tiny))
    x, y = x / scale[owners], y / scale[owners]
    xx, xy, yy, xz, yz = (average(one) for one in (x * x, x * y, y * y, x * z, y * z))
    slopes, leverage = _solve((xx, xy, yy), (xz, yz), middle[:2] / scale)
    slopes = np.where(leverage <= _MOST_LEVERAGE, slopes / scale, np.nan)
    level = xyz[vertices, 2] + middle[2] - slopes[0] * middle[0] - slopes[1] * middle[1]
    return np.column_stack([level, *slopes])


def measure_offsets(
    xyz: Float64Array,
    vertices: Int32Array,
    planes: Float64Array,
    owners: Int64Array,
    around: Int32Array,
) -> Float64Array:
    """Return how far points around some vertices, ``owners``, are above the planes at these."""
    apart = xyz[around, :2] - xyz[vertices[owners], :2]
    offsets: Float64Array = (
        xyz[around, 2] - planes[owners, 0] - (planes[owners, 1:] * apart).sum(axis=1)
    )
    return offsets


def _solve(
    squares: tuple[Float64Array, Float64Array, Float64Array],
    sides: tuple[Float64Array, Float64Array],
    middle: Float64Array,
) -> tuple[Float64Array, Float64Array]:
    """Return the slopes that solve pairs of equations, (2, k), and how far away middles are.

    ``squares`` are the means of x x, x y and y y, ``sides`` those of x z and y z. The leverage is
    the squared distance of a middle in standard deviations of the points along their axes;
    infinite where they lie on a line, and NaN where there is no point.
    """
    xx, xy, yy = squares
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    cosine, sine = np.cos(angle), np.sin(angle)

    def turn(x: Float64Array, y: Float64Array) -> Float64Array:
        return np.array([x * cosine + y * sine, y * cosine - x * sine])

    along = xx * cosine**2 + 2 * xy * cosine * sine + yy * sine**2
    across = xx * sine**2 - 2 * xy * cosine * sine + yy * cosine**2
    widths = np.maximum(np.array([along, across]), np.finfo(float).eps * along)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v = turn(*sides) / widths
        leverage: Float64Array = (turn(*middle) ** 2 / widths).sum(axis=0)
    return np.array([u * cosine - v * sine, u * sine + v * cosine]), leverage
