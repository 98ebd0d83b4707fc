"""Rasters: each tile has the cells whose centres lie in it."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_flag, as_length
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, PointsError, choice
from ...base.georeference import describe_unknown, require_same_crs
from ...base.policies import RasterSample, RasterValue
from ...base.results import Raster
from ...base.types import Bounds, Grid
from ...terrain.gridding import (
    DESCRIBED_MEANS,
    as_cells,
    cover,
    describe_extent,
    describe_smooth,
    list_units,
    require_cells,
    require_overlap,
)
from ...terrain.parts.rasters import (
    RasterOptions,
    compute_block,
    count_rings,
    find_cells,
    find_reach,
)
from ...terrain.surface import as_light

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ..reading import StoredPoints
    from ..runs import Record
    from ..tasks import Part


def check_options(
    *,
    spacing: float | None = None,
    like: Any = None,
    value: RasterValue = "elevation",
    method: str = "linear",
    at: RasterSample = "center",
    azimuth: float = 315.0,
    altitude: float = 45.0,
    smooth: bool | None = None,
    bounds: Bounds | None = None,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none, or needs all points at a time.

    ``bounds`` are those that headers name: too many cells are refused before anything is read.
    """
    if (spacing is None) == (like is None):
        raise OptionError("grid", [spacing, like], "one of spacing and like")
    if spacing is not None:
        as_length("spacing", spacing)
    choice("value", value, RasterValue)
    if method != "linear":
        raise OptionError("method", method, "linear where a raster is computed in tiles")
    choice("at", at, RasterSample)
    if at == "mean" and value == "aspect":
        raise OptionError("at", at, "center for aspect, as directions have no mean")
    if smooth is not None:
        as_flag("smooth", smooth)
    if smooth is not None and value == "elevation":
        raise OptionError("smooth", smooth, "None for elevations, which have a method")
    if smooth and at == "mean":
        raise OptionError("smooth", smooth, "False for means, which are those of triangles")
    as_light(azimuth, altitude)
    cells = None if like is None else as_cells(like)
    like_crs = None if cells is None else cells.crs
    if cells is not None:
        require_cells(cells.grid, in_memory=False)
    elif bounds is not None and spacing is not None:
        require_cells(cover(bounds, spacing), in_memory=False)
    return {
        "spacing": spacing,
        "like": None if cells is None else asdict(cells.grid),
        "like_crs": None if like_crs is None else str(like_crs),
        "value": value,
        "azimuth": azimuth,
        "altitude": altitude,
        "smooth": smooth,
        "at": at,
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the cells, when the bounds of all points are known."""
    like = options["like"]
    cells = _make_grid(like) if like else cover(points.bounds, options["spacing"])
    require_cells(cells, in_memory=False)
    require_overlap(cells.bounds, points.bounds)
    smooth = points.is_raster if options["smooth"] is None else options["smooth"]
    crs, unit = points.crs, points.elevation_unit
    notes: tuple[str, ...] = ()
    if like:
        notes = require_same_crs(CRS.of(options["like_crs"]), crs, "the other raster")
    return {
        **options,
        "grid": asdict(cells),
        "notes": list(notes),
        "smooth": smooth and options["value"] != "elevation" and options["at"] == "center",
        "crs": None if crs is None else str(crs),
        "elevation_unit": None if unit is None else unit.text,
    }


def _make_grid(cells: Mapping[str, Any]) -> Grid:
    return Grid(Bounds(**cells["bounds"]), tuple(cells["shape"]), cells["spacing"])


def _make_options(options: Mapping[str, Any]) -> RasterOptions:
    return RasterOptions(
        grid=_make_grid(options["grid"]),
        value=options["value"],
        is_smooth=options["smooth"],
        at=options["at"],
        light=as_light(options["azimuth"], options["altitude"]),
        crs=CRS.of(options["crs"]),
        elevation_unit=Unit.of(options["elevation_unit"]),
    )


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Compute the cells of a tile."""
    tile, options = part.job.tile, _make_options(part.job.options)
    rows, columns = find_cells(options.grid, tile.box)
    if rows.start == rows.stop:
        return 0, {}, []
    reach, rings = find_reach(options, rows, columns), count_rings(options)
    local = part.triangulate(reach, rings=rings, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    values = compute_block(local, rows, columns, options).values
    name = f"{tile.key}.npy"
    with replacing(part.folder / name) as file:
        np.save(file, values)
    found = {
        "rows": [rows.start, rows.stop],
        "columns": [columns.start, columns.stop],
        "covered": int(np.isfinite(values).sum()),
    }
    return len(local.points), found, [name]


class _Blocks:
    """A band whose cells lie in the files of tiles."""

    dtype = np.dtype(np.float64)

    def __init__(self, folder: Path, records: Mapping[str, Record], grid: Grid) -> None:
        self.shape = grid.shape
        made = [(record.values, name) for record in records.values() for name in record.files]
        self._paths = [folder / name for _, name in made]
        ends = [[*values["rows"], *values["columns"]] for values, _ in made]
        self._ends = np.array(ends, np.int64).reshape(-1, 4)

    def __getitem__(self, key: tuple[slice, slice]) -> Float64Array:
        """Return a block; slices have no step."""
        rows, columns = key
        found = np.full((rows.stop - rows.start, columns.stop - columns.start), np.nan)
        starts, stops = self._ends[:, ::2], self._ends[:, 1::2]
        is_met = (starts < [rows.stop, columns.stop]) & (stops > [rows.start, columns.start])
        for k in np.flatnonzero(is_met.all(axis=1)).tolist():
            own_rows, own_columns = (slice(*ends) for ends in self._ends[k].reshape(2, 2).tolist())
            target = _find_common(rows, own_rows), _find_common(columns, own_columns)
            source = _find_common(own_rows, rows), _find_common(own_columns, columns)
            found[target] = np.load(self._paths[k], mmap_mode="r")[source]
        return found


def _find_common(part: slice, other: slice) -> slice:
    """Return what two ranges have in common, counted from the start of the first."""
    start, stop = max(part.start, other.start), min(part.stop, other.stop)
    return slice(start - part.start, max(start, stop) - part.start)


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Raster:
    """Return the raster, whose cells are read from the files of tiles as they are asked for.

    Raises
    ------
    PointsError
        If no cell has a value.
    """
    grid, value = _make_options(options).grid, options["value"]
    what = "part of a cell" if options["at"] == "mean" else "centre of a cell"
    if not any(record.values.get("covered") for record in records.values()):
        raise PointsError(
            f"No {what} lies on the surface: the cells are {grid.spacing:g} wide and "
            f"cover {describe_extent(grid.bounds)}, the points {describe_extent(points.bounds)}."
        )
    blocks: Any = _Blocks(folder, records, grid)
    crs, is_elevation = points.crs, value == "elevation"
    return Raster(
        {value: blocks},
        grid,
        crs=crs if crs is None or is_elevation else crs.horizontal,
        units=list_units(value, points.elevation_unit),
        name=value,
        notes=[
            *points.notes,
            *describe_unknown(crs, points.elevation_unit),
            *options["notes"],
            *([] if is_elevation else [_describe_slopes(options)]),
        ],
    )


def _describe_slopes(options: Mapping[str, Any]) -> str:
    if options["at"] == "mean":
        return DESCRIBED_MEANS
    return describe_smooth(is_smooth=options["smooth"])
