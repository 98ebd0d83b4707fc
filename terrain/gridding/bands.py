"""A band of a raster whose cells are computed as they are asked for, and whether it has any."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import PointsError
from ...base.results import find_turn, locate_all_centers, locate_centers
from ...base.sentences import write_spacing
from ...base.types import Grid
from ...tin.validation import thread_count
from .. import _kernel
from .grids import as_parts, describe_extent, locate_edges

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.policies import InterpolationMethod
    from ...base.progress import Progress, Tell
    from ...tin import TIN

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
        if self._is_mean or (self._method == "linear" and self._grid.is_aligned):
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
        turn, (x, y, size) = find_turn(self._grid), self._list_lattice(rows, columns)
        threads = thread_count(self._threads, len(x) * len(y))
        cells = self._drawn.values_at_centers(x, y, size, self._values, threads, progress)
        return np.asarray(turn.of(cells))

    def _list_lattice(
        self, rows: slice, columns: slice
    ) -> tuple[Float64Array, Float64Array, tuple[float, float]]:
        """Return centres of columns from the west and of rows from the north, and a cell's size."""
        turn = find_turn(self._grid)
        x, y = locate_centers(self._grid, rows, columns)
        return _order(x, turn.columns), _order(y, turn.rows), self._grid.cell_size

    def _scan_means(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        """Compute whole tiles of the raster, so that all blocks of it have the same bits.

        Rotated cells are upright squares among columns and rows, where the surface is drawn: a mean
        is the same in any coordinates of which theirs are an affine function.
        """
        grid, turn = self._mean_grid, find_turn(self._grid)
        asked = turn.of_parts((rows, columns), self.shape)
        tiles = tuple(_widen(part, side) for part, side in zip(asked, self.shape, strict=True))
        own = turn.of_parts((tiles[0], tiles[1]), self.shape)
        x, y = locate_centers(grid, *own)
        x_edges, y_edges = locate_edges(grid, *own)
        found = self._mean_surface.means_of_cells(
            _order(x, turn.columns),
            _order(y, turn.rows),
            grid.cell_size,
            _order(x_edges, turn.columns),
            _order(y_edges, turn.rows),
            self._values,
            thread_count(self._threads, len(x) * len(y)),
            progress,
        )
        down, across = (
            slice(part.start - tile.start, part.stop - tile.start)
            for part, tile in zip(asked, tiles, strict=True)
        )
        return np.asarray(turn.of(found[down, across]))

    @property
    def _mean_grid(self) -> Grid:
        """The cells whose means are computed: of a rotated grid those among columns and rows."""
        if self._grid.is_aligned:
            return self._grid
        upright = (float(find_turn(self._grid).columns), 0.0, 0.0, 0.0, -1.0, 0.0)
        return Grid.of_transform(upright, self.shape)

    @cached_property
    def _mean_surface(self) -> _kernel.GriddedSurface:
        if self._grid.is_aligned:
            return self._drawn
        surface = self._tin.triangulation
        column, row = self._grid.transform.locate(surface.points[:, 0], surface.points[:, 1])
        along = find_turn(self._grid).columns * column
        points = np.ascontiguousarray(np.column_stack([along, -row, surface.points[:, 2]]))
        return _kernel.GriddedSurface(points, surface.triangles)

    @cached_property
    def _drawn(self) -> _kernel.GriddedSurface:
        surface = self._tin.triangulation
        return _kernel.GriddedSurface(surface.points, surface.triangles)

    def __getstate__(self) -> dict[str, Any]:
        computed = ("_drawn", "_mean_surface")
        return {name: value for name, value in self.__dict__.items() if name not in computed}

    def _ask(self, rows: slice, columns: slice) -> Float64Array:
        x, y = locate_all_centers(self._grid, rows, columns)
        found = self._measure_at(np.stack([x, y], axis=-1).reshape(-1, 2))
        return found.reshape(x.shape)

    def _measure_at(self, places: Float64Array) -> Float64Array:
        """Return the value at each of (k, 2) places, NaN outside the surface."""
        if self._values is None:
            return self._tin.interpolate(places, method=self._method, threads=self._threads)
        triangle = self._tin.locate(places)
        return np.where(triangle >= 0, self._values[triangle], np.nan)


def _widen(part: slice, side: int) -> slice:
    """Return the rows, or columns, of all tiles that some rows lie in."""
    tile = _kernel.TILE_SIDE
    return slice(part.start // tile * tile, min(side, -(-part.stop // tile) * tile))


def _order(values: Float64Array, step: int) -> Float64Array:
    """Return coordinates in the other order, or as they are."""
    return values if step > 0 else np.ascontiguousarray(values[::-1])


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
        f"No {what} lies on the surface: the cells are {write_spacing(grid.spacing)} wide and "
        f"cover {describe_extent(grid.bounds)}, the surface {describe_extent(tin.bounds)}."
    )


def _sample_covers(tin: TIN, grid: Grid, is_mean: bool) -> bool:
    """Whether the cells at the middle of some triangles hold a part of the surface."""
    chosen = tin.triangles[:: max(1, len(tin.triangles) // _SAMPLE)]
    xy = tin.points[chosen, :2].mean(axis=1)
    rows, columns = grid.shape
    at = np.floor(np.column_stack(grid.transform.locate(*xy.T)))  # column and row
    at = at[((at >= 0) & (at < (columns, rows))).all(axis=1)]
    if is_mean or len(at) == 0:
        return len(at) > 0
    centers = np.column_stack(grid.transform.apply(*(at.T + 0.5)))
    return bool((tin.locate(centers) >= 0).any())
