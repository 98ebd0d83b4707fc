"""Rasters of points: each tile has the cells that its own points are in, which are joined."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import OptionError, choice
from ...base.georeference import agree
from ...base.policies import PointRasterValue
from ...base.results import Raster
from ...terrain.gridding import (
    add_cells,
    count_points,
    describe_points_outside,
    find_highest,
    make_empty,
    measure_heights,
    require_points,
)
from ...terrain.parts import as_surface
from ..cells import (
    Blocks,
    check_cells,
    find_storage,
    make_grid,
    name_block,
    save_block,
    settle_cells,
)
from ..reading import open_store
from ..tasks import TileProduct

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import Float64Array
    from ...base.types import Bounds, Grid
    from ...terrain.gridding import CellBlock
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part
    from ..tiled_points import TiledPoints

_MOST_POINTS = 1_000_000
"""That are taken at a time: there may be many more above the ground than in it."""


class _Referenced(NamedTuple):
    crs: CRS | None
    elevation_unit: Unit | None


def check_options(
    *,
    value: PointRasterValue,
    spacing: float | None = None,
    like: Any = None,
    other: TiledPoints | None = None,
    bounds: Bounds | None = None,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none; ``other`` are the points above a surface."""
    choice("value", value, PointRasterValue)
    if value == "height" and not hasattr(other, "headers"):
        raise OptionError("above", other, "points in files, as tinsmith.tiles takes them")
    if other is not None and other.lines is not None:
        raise OptionError("above", other, "points without lines")
    return {**check_cells(spacing, like, bounds), "value": value}


def settle_options(
    points: StoredPoints, options: Mapping[str, Any], other: StoredPoints | None = None
) -> dict[str, Any]:
    """Settle the cells, when the bounds of all points are known, and units."""
    found = {**options, **settle_cells(points, options)}
    if other is None:
        return found
    agreed = agree((points, other), ("the surface", "the points"))
    return {
        **found,
        "factor": agreed.factors[1] / agreed.factors[0],
        "above": str(other.folder),
        "notes": [
            *(f"The points above: {note}" for note in other.notes),
            *agreed.notes,
            *found["notes"],
        ],
    }


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Count the points of a tile, or find how high the highest in each cell is."""
    options = part.job.options
    grid = make_grid(options["grid"])
    if options["value"] == "count":
        found = _Cells(grid, is_count=True)
        for some in part.store.read_parts(part.job.tile.box, _MOST_POINTS):
            found.add(count_points(grid, some.points), len(some.points))
    else:
        found = _find_heights(part, grid)
    if not found.count:
        return 0, {}, []
    told: dict[str, Any] = {"outside": found.outside, "count": found.count}
    joined = found.join()
    if joined is None:
        return found.count, told, []
    return found.count, told | save_block(part, *joined), [name_block(part)]


class _Cells:
    """The cells of the points of a tile, as far as they were read."""

    def __init__(self, grid: Grid, *, is_count: bool) -> None:
        self._grid = grid
        self._is_count = is_count
        self._blocks: list[CellBlock] = []
        self.count = 0
        self.outside = 0

    def add(self, block: CellBlock | None, count: int, outside: int = 0) -> None:
        self._blocks += [] if block is None else [block]
        self.count += count
        self.outside += outside

    def join(self) -> tuple[slice, slice, Any] | None:
        if not self._blocks:
            return None
        rows, columns = (
            slice(min(one.start for one in parts), max(one.stop for one in parts))
            for parts in zip(*((one.rows, one.columns) for one in self._blocks), strict=True)
        )
        shape = rows.stop - rows.start, columns.stop - columns.start
        values = make_empty(shape, is_count=self._is_count)
        for one in self._blocks:
            target = values[_shift(one.rows, rows.start), _shift(one.columns, columns.start)]
            add_cells(target, one.values)
        return rows, columns, values


def _shift(part: slice, start: int) -> slice:
    return slice(part.start - start, part.stop - start)


def _find_heights(part: Part, grid: Grid) -> _Cells:
    options, box = part.job.options, part.job.tile.box
    found = _Cells(grid, is_count=False)
    tin = None
    for some in open_store(Path(options["above"])).read_parts(box, _MOST_POINTS):
        if tin is None:
            local = part.triangulate(box)
            tin = as_surface(local) if len(local.triangles) else None
        points = some.points
        if options["factor"] != 1.0:
            points[:, 2] *= options["factor"]
        xy = np.ascontiguousarray(points[:, :2])
        ground = np.full(len(xy), np.nan) if tin is None else tin.interpolate(xy, threads=1)
        heights: Float64Array = measure_heights(points, ground)
        outside = int(np.count_nonzero(np.isnan(heights)))
        found.add(find_highest(grid, points, heights), len(points), outside)
    return found


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Raster:
    """Return the raster, whose cells are read from the files of tiles as they are asked for.

    Raises
    ------
    PointsError
        If no cell has a value.
    """
    grid, value = make_grid(options["grid"]), options["value"]
    require_points(any(one.files for one in records.values()), grid)
    blocks: Any = Blocks(folder, records, grid, np.uint32(0) if value == "count" else math.nan)
    told = [one.values for one in records.values() if "count" in one.values]
    outside, count = (sum(one[name] for one in told) for name in ("outside", "count"))
    stored = {"stored_as": None, "notes": []} if value == "count" else find_storage(options)
    return Raster(
        {value: blocks},
        grid,
        crs=None if points.crs is None else points.crs.horizontal,
        stored_as=stored["stored_as"],
        units={} if value == "count" else {value: points.elevation_unit},
        name=value,
        notes=[
            *points.notes,
            *options["notes"],
            *stored["notes"],
            *describe_points_outside(outside, count),
        ],
    )


PRODUCT = TileProduct(
    check_options, compute, join, settle_options=settle_options, has_all_tiles=True
)
