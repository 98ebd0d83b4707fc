"""The elevation of a surface at any place, by each method."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..validation import thread_count

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Float64Array
    from ...base.policies import InterpolationMethod
    from .triangulation import Triangulation

_WEIGHTS = {
    "natural": _kernel.NaturalWeights.SIBSON,
    "laplace": _kernel.NaturalWeights.LAPLACE,
}


class Interpolator:
    """What interpolation needs of a surface, made when first asked for; it is never changed.

    ``find_barriers`` gives the edges that are breaks of slope, (m, 3) flags of the edge opposite
    each corner. Any number of threads may ask it at a time.
    """

    def __init__(self, surface: Triangulation, find_barriers: Callable[[], BoolArray]) -> None:
        self._surface = surface
        self._find_barriers = find_barriers

    def interpolate(
        self,
        xy: Float64Array,
        method: InterpolationMethod,
        *,
        extrapolate: bool,
        threads: int | None,
    ) -> Float64Array:
        """Return the elevation at each place of a (k, 2) array, NaN outside and for NaN.

        With ``extrapolate`` a place outside has the elevation of the nearest place of the surface.
        """
        n_threads = thread_count(threads, len(xy))
        elevations = self._interpolate_inside(xy, method, n_threads)
        if extrapolate:
            outside = np.flatnonzero(np.isnan(elevations) & ~np.isnan(xy).any(axis=1))
            if len(outside):
                elevations[outside] = self._extrapolate_outside(xy[outside], method)
        return elevations

    def _interpolate_inside(
        self, xy: Float64Array, method: InterpolationMethod, threads: int
    ) -> Float64Array:
        if method == "linear":
            return self._surface.locator.interpolate(xy, threads)
        if method == "nearest":
            is_inside = self._surface.locator.locate(xy) >= 0
            found = np.full(len(xy), np.nan)
            found[is_inside] = self._take_nearest(np.ascontiguousarray(xy[is_inside]), threads)
            return found
        if method == "c1":
            return self._patches.interpolate(xy, threads)
        return self._neighbors.interpolate(xy, _WEIGHTS[method], threads)

    def _extrapolate_outside(self, xy: Float64Array, method: InterpolationMethod) -> Float64Array:
        if method == "nearest":
            return self._take_nearest(xy, 1)
        edges, shares = self._boundary.find(xy)
        if method == "c1":
            return self._patches.on_edges(edges, shares)
        corners = self._surface.triangles.ravel()
        first = 3 * (edges // 3)
        start = self._elevations[corners[first + (edges + 1) % 3]]
        end = self._elevations[corners[first + (edges + 2) % 3]]
        # interpolate from the nearer end, so that both ends are met exactly
        half_rise = 0.5 * end - 0.5 * start
        early = start + 2.0 * (shares * half_rise)
        late = end - 2.0 * ((1.0 - shares) * half_rise)
        between: Float64Array = np.where(shares > 0.5, late, early)
        return between

    def _take_nearest(self, xy: Float64Array, threads: int) -> Float64Array:
        nearest = self._surface.nearest.find(xy, threads=threads, from_west=True)
        return self._elevations[nearest]

    @property
    def _elevations(self) -> Float64Array:
        return self._surface.points[:, 2]

    @cached_property
    def _barriers(self) -> BoolArray:
        return self._find_barriers()

    @cached_property
    def _neighbors(self) -> _kernel.NaturalNeighbors:
        return _kernel.NaturalNeighbors(self._surface.locator, self._barriers)

    @cached_property
    def _patches(self) -> _kernel.SmoothPatches:
        threads = thread_count(None, len(self._surface.points))
        return _kernel.SmoothPatches(self._surface.locator, self._barriers, threads)

    @cached_property
    def _boundary(self) -> _kernel.NearestBoundary:
        return _kernel.NearestBoundary(self._surface.locator)
