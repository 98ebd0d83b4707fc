"""Rasters: each tile has the cells whose centres lie in it."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_length
from ...base.errors import OptionError, PointsError
from ...base.georeference import describe_unknown
from ...base.results import Raster
from ...base.results.gridded import locate_centers
from ...base.types import Bounds, Grid
from ...terrain._kernel import GriddedSurface
from ...terrain.gridding.grids import as_cells, cover, describe_extent

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.policies import InterpolationMethod, RasterSample, RasterValue
    from ..reading import StoredPoints
    from ..runs import Record
    from ..tasks import Part

__all__ = ["check_options", "compute", "join", "settle_options"]


def check_options(
    *,
    spacing: float | None = None,
    like: Any = None,
    value: RasterValue = "elevation",
    method: InterpolationMethod = "linear",
    at: RasterSample = "center",
    **light: Any,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none, or needs all points at a time."""
    del light
    if (spacing is None) == (like is None):
        raise OptionError("grid", [spacing, like], "one of spacing and like")
    if spacing is not None:
        as_length("spacing", spacing)
    for name, wanted, local in (
        ("method", method, "linear"),
        ("at", at, "center"),
        ("value", value, "elevation"),
    ):
        if wanted != local:
            raise OptionError(name, wanted, f"{local} where a raster is computed in tiles")
    cells = None if like is None else asdict(as_cells(like).grid)
    return {"spacing": spacing, "value": value, "like": cells}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the cells, when the bounds of all points are known."""
    if options["like"] is not None:
        return {**options, "grid": options["like"]}
    return {**options, "grid": asdict(cover(points.bounds, options["spacing"]))}


def _as_grid(values: Mapping[str, Any]) -> Grid:
    return Grid(Bounds(**values["bounds"]), tuple(values["shape"]), values["spacing"])


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Compute the cells of a tile."""
    tile, options = part.job.tile, part.job.options
    grid = _as_grid(options["grid"])
    x, y = locate_centers(grid)
    west, east = np.searchsorted(x, [tile.box.xmin, tile.box.xmax], "left").tolist()
    up = y[::-1]
    south, north = np.searchsorted(up, [tile.box.ymin, tile.box.ymax], "left").tolist()
    top, bottom = len(y) - north, len(y) - south
    if west >= east or top >= bottom:
        return 0, {}, []
    box = Bounds(x[west], y[bottom - 1], x[east - 1], y[top])
    local = part.triangulate(box)
    if not len(local.triangles):
        return 0, {}, []
    drawn = GriddedSurface(local.points, local.triangles)
    block = drawn.values_at_centers(x[west:east], y[top:bottom], grid.spacing, None, 1, None)
    name = f"{tile.key}.npy"
    with replacing(part.folder / name) as file:
        np.save(file, block)
    covered = int(np.isfinite(block).sum())
    values = {"rows": [top, bottom], "columns": [west, east], "covered": covered}
    return len(local.points), values, [name]


class _Blocks:
    """A band whose cells lie in the files of tiles."""

    dtype = np.dtype(np.float64)

    def __init__(self, folder: Path, records: Mapping[str, Record], grid: Grid) -> None:
        self.shape = grid.shape
        self._blocks = [
            (record.values["rows"], record.values["columns"], folder / name)
            for record in records.values()
            for name in record.files
        ]

    def __getitem__(self, key: tuple[slice, slice]) -> Float64Array:
        rows, columns = key
        found = np.full((rows.stop - rows.start, columns.stop - columns.start), np.nan)
        for (top, bottom), (west, east), path in self._blocks:
            r0, r1 = max(top, rows.start), min(bottom, rows.stop)
            c0, c1 = max(west, columns.start), min(east, columns.stop)
            if r0 < r1 and c0 < c1:
                block = np.load(path, mmap_mode="r")
                found[
                    r0 - rows.start : r1 - rows.start, c0 - columns.start : c1 - columns.start
                ] = block[r0 - top : r1 - top, c0 - west : c1 - west]
        return found


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Raster:
    """Return the raster, whose cells are read from the files of tiles as they are asked for."""
    grid = _as_grid(options["grid"])
    blocks: Any = _Blocks(folder, records, grid)
    value = options["value"]
    if not any(record.values.get("covered") for record in records.values()):
        raise PointsError(
            f"No centre of a cell lies on the surface: the cells are {grid.spacing:g} wide and "
            f"cover {describe_extent(grid.bounds)}, the points {describe_extent(points.bounds)}."
        )
    return Raster(
        {value: blocks},
        grid,
        crs=points.crs,
        units={value: points.elevation_unit},
        name=value,
        notes=[*points.notes, *describe_unknown(points.crs, points.elevation_unit)],
    )
