"""A band of a raster whose cells are computed as they are asked for, and whether it has any."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import PointsError
from ...base.results import locate_centers
from ...tin.validation import thread_count
from .. import _kernel
from .grids import as_parts, describe_extent, locate_edges

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.policies import InterpolationMethod
    from ...base.progress import Progress, Tell
    from ...tin import TIN, Grid

_STRIP = 1 << 22
"""Cells whose centres are listed in one go, about: a bound on memory."""

_ALL = (slice(None), slice(None))

_SAMPLE = 1000
"""Triangles that are looked at first."""

_BLOCK_CELLS = 1 << 22


class SurfaceBand:
    """Cells over a surface: ``band[rows, columns]`` computes a block of them.

    The surface is as it is now; later edits do not count. ``values`` are of triangles, (m,), None
    for elevations, which ``method`` interpolates; with ``is_mean`` they are those of cells, and not
    those at their centres.
    """

    dtype = np.dtype(np.float64)

    def __init__(
        self,
        tin: TIN,
        grid: Grid,
        values: Float64Array | None,
        *,
        method: InterpolationMethod,
        is_mean: bool,
        threads: int | None,
    ) -> None:
        self._tin = tin.snapshot()
        self._grid = grid
        self._values = values
        self._method = method
        self._is_mean = is_mean
        self._threads = threads

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._grid.shape

    def __getitem__(self, key: tuple[slice, slice]) -> Float64Array:
        """Compute a block; slices have no step."""
        return self._compute(*as_parts(key, self.shape), None)

    def compute(self, progress: Progress) -> Float64Array:
        """Compute all cells, and tell how far it is."""
        return self._compute(*as_parts(_ALL, self.shape), progress.stage(0.1, 1.0))

    def _compute(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        if rows.stop <= rows.start or columns.stop <= columns.start:
            return np.empty((max(0, rows.stop - rows.start), max(0, columns.stop - columns.start)))
        if self._method == "linear":
            return self._scan(rows, columns, progress)
        block = np.empty((rows.stop - rows.start, columns.stop - columns.start))
        for strip in _list_strips(rows, columns):
            block[strip.start - rows.start : strip.stop - rows.start] = self._ask(strip, columns)
            if progress is not None:
                progress((strip.stop - rows.start) / len(block))
        return block

    def _scan(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        if self._is_mean:
            return self._scan_means(rows, columns, progress)
        return self._scan_centers(rows, columns, progress)

    def _scan_centers(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        x, y = locate_centers(self._grid, rows, columns)
        threads = thread_count(self._threads, len(x) * len(y))
        return self._drawn.values_at_centers(
            x, y, self._grid.spacing, self._values, threads, progress
        )

    def _scan_means(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        """Compute whole tiles of the raster, so that all blocks of it have the same bits."""
        tiles = [_widen(part, side) for part, side in zip((rows, columns), self.shape, strict=True)]
        x, y = locate_centers(self._grid, *tiles)
        x_edges, y_edges = locate_edges(self._grid, *tiles)
        found = self._drawn.means_of_cells(
            x,
            y,
            self._grid.spacing,
            x_edges,
            y_edges,
            self._values,
            thread_count(self._threads, len(x) * len(y)),
            progress,
        )
        down, across = (
            slice(part.start - tile.start, part.stop - tile.start)
            for part, tile in zip((rows, columns), tiles, strict=True)
        )
        return found[down, across]

    @cached_property
    def _drawn(self) -> _kernel.GriddedSurface:
        surface = self._tin.triangulation
        return _kernel.GriddedSurface(surface.points, surface.triangles)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_drawn"}

    def _ask(self, rows: slice, columns: slice) -> Float64Array:
        x, y = locate_centers(self._grid, rows, columns)
        xy = np.empty((len(y), len(x), 2))
        xy[..., 0], xy[..., 1] = x, y[:, None]
        places = xy.reshape(-1, 2)
        found = self._tin.interpolate(places, method=self._method, threads=self._threads)
        return found.reshape(len(y), len(x))


def _widen(part: slice, side: int) -> slice:
    """Return the rows, or columns, of all tiles that some rows lie in."""
    tile = _kernel.TILE_SIDE
    return slice(part.start // tile * tile, min(side, -(-part.stop // tile) * tile))


def _list_strips(rows: slice, columns: slice) -> Iterator[slice]:
    height = max(1, _STRIP // (columns.stop - columns.start))
    for top in range(rows.start, rows.stop, height):
        yield slice(top, min(top + height, rows.stop))


def require_covered(tin: TIN, grid: Grid, *, is_mean: bool = False) -> None:
    """Refuse, by a PointsError, a raster no cell of which would have a value.

    With ``is_mean`` a cell has a value if any part of it is covered, else if its centre is.
    """
    if _sample_covers(tin, grid, is_mean):
        return
    level = np.zeros(len(tin.triangles))
    band = SurfaceBand(tin, grid, level, method="linear", is_mean=is_mean, threads=None)
    rows, columns = grid.shape
    height = max(1, _BLOCK_CELLS // columns)
    for top in range(0, rows, height):
        block = band[slice(top, min(top + height, rows)), slice(0, columns)]
        if np.isfinite(block).any():
            return
    what = "part of a cell" if is_mean else "centre of a cell"
    raise PointsError(
        f"No {what} lies on the surface: the cells are {grid.spacing:g} wide and cover "
        f"{describe_extent(grid.bounds)}, the surface {describe_extent(tin.bounds)}."
    )


def _sample_covers(tin: TIN, grid: Grid, is_mean: bool) -> bool:
    """Whether the cells at the middle of some triangles hold a part of the surface."""
    chosen = tin.triangles[:: max(1, len(tin.triangles) // _SAMPLE)]
    xy = tin.points[chosen, :2].mean(axis=1)
    bounds, (rows, columns) = grid.bounds, grid.shape
    from_corner = np.column_stack([xy[:, 0] - bounds.xmin, bounds.ymax - xy[:, 1]])
    at = np.floor(from_corner / grid.spacing)  # column and row
    at = at[((at >= 0) & (at < (columns, rows))).all(axis=1)]
    if is_mean or len(at) == 0:
        return len(at) > 0
    x = bounds.xmin + (at[:, 0] + 0.5) * grid.spacing
    y = bounds.ymax - (at[:, 1] + 0.5) * grid.spacing
    return bool((tin.locate(np.column_stack([x, y])) >= 0).any())
