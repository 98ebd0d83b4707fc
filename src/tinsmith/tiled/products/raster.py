"""Rasters: each tile has the cells whose centres lie in it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, PointsError, choice
from ...base.georeference import describe_unknown
from ...base.policies import GridOperator, RasterSample, RasterValue
from ...base.results import Raster
from ...base.sentences import write_spacing
from ...terrain.gridding import (
    DESCRIBED_MEANS,
    GridMeasure,
    describe_extent,
    describe_no_value,
    describe_smooth,
    list_units,
    make_measure,
    require_aligned,
    require_sample,
)
from ...terrain.parts import (
    RasterOptions,
    compute_block,
    count_rings,
    find_cells,
    find_reach,
)
from ...terrain.surface import as_light
from ..cells import (
    Blocks,
    check_cells,
    find_storage,
    make_grid,
    name_block,
    save_block,
    settle_cells,
)
from ..tasks import TileProduct, add_units

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.types import Bounds
    from ..reading import StoredPoints
    from ..running import Record
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
    operator: GridOperator | None = None,
    compute_edges: bool = False,
    bounds: Bounds | None = None,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none, or needs all points at a time.

    ``bounds`` are those that headers name: too many cells are refused before anything is read.
    """
    cells = check_cells(spacing, like, bounds)
    choice("value", value, RasterValue)
    if method != "linear":
        raise OptionError("method", method, "linear where a raster is computed in tiles")
    choice("at", at, RasterSample)
    of_cells = make_measure(value, operator, compute_edges, light=as_light(azimuth, altitude))
    require_sample(method, value, at, smooth, of_cells)
    if cells["like"]:
        require_aligned(of_cells, make_grid(cells["like"]))
    if smooth is not None:
        as_flag("smooth", smooth)
    if smooth and at == "mean":
        raise OptionError("smooth", smooth, "False for means, which are those of triangles")
    return {
        **cells,
        "value": value,
        "azimuth": azimuth,
        "altitude": altitude,
        "smooth": smooth,
        "operator": operator,
        "compute_edges": compute_edges,
        "at": at,
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the cells, when the bounds of all points are known."""
    cells = settle_cells(points, options)
    smooth = points.is_raster if options["smooth"] is None else options["smooth"]
    return {
        **add_units(points, options),
        **cells,
        "smooth": smooth and options["value"] != "elevation" and options["at"] == "center",
    }


def _make_measure(options: Mapping[str, Any]) -> GridMeasure | None:
    return make_measure(
        options["value"],
        options["operator"],
        options["compute_edges"],
        light=as_light(options["azimuth"], options["altitude"]),
        crs=CRS.of(options["crs"]),
        elevation_unit=Unit.of(options["elevation_unit"]),
    )


def _make_options(options: Mapping[str, Any]) -> RasterOptions:
    return RasterOptions(
        grid=make_grid(options["grid"]),
        value=options["value"],
        is_smooth=options["smooth"],
        of_cells=_make_measure(options),
        at=options["at"],
        light=as_light(options["azimuth"], options["altitude"]),
        crs=CRS.of(options["crs"]),
        elevation_unit=Unit.of(options["elevation_unit"]),
    )


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Compute the cells of a tile."""
    options = _make_options(part.job.options)
    box = part.job.tile.box
    rows, columns = find_cells(options.grid, box)
    if rows.start == rows.stop:
        return 0, {}, []
    reach, rings = find_reach(options, rows, columns, box), count_rings(options)
    local = part.triangulate(reach, rings=rings, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    values = compute_block(local, rows, columns, options, box).values
    found = save_block(part, rows, columns, values)
    if not np.isfinite(values).any() and options.value == "aspect":  # of a level surface
        slopes = options._replace(value="slope")
        values = compute_block(local, rows, columns, slopes, box).values
    found["covered"] = int(np.isfinite(values).sum())
    return len(local.points), found, [name_block(part)]


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
    of_cells = _make_measure(options)
    if not any(record.values.get("covered") for record in records.values()):
        if of_cells is not None:
            raise PointsError(describe_no_value(of_cells, grid))
        raise PointsError(
            f"No {what} lies on the surface: the cells are {write_spacing(grid.spacing)} wide and "
            f"cover {describe_extent(grid.bounds)}, the points {describe_extent(points.bounds)}."
        )
    blocks: Any = Blocks(folder, records, grid, math.nan)
    stored = find_storage(options)
    crs, is_elevation = points.crs, value == "elevation"
    return Raster(
        {value: blocks},
        grid,
        crs=crs if crs is None or is_elevation else crs.horizontal,
        stored_as=stored["stored_as"],
        units=list_units(value, crs, points.elevation_unit),
        name=value,
        notes=[
            *points.notes,
            *describe_unknown(crs, points.elevation_unit),
            *options["notes"],
            *stored["notes"],
            *([] if is_elevation else [_describe_slopes(options, of_cells)]),
        ],
    )


def _describe_slopes(options: Mapping[str, Any], of_cells: GridMeasure | None) -> str:
    if of_cells is not None:
        return of_cells.describe()
    if options["at"] == "mean":
        return DESCRIBED_MEANS
    return describe_smooth(is_smooth=options["smooth"])


PRODUCT = TileProduct(check_options, compute, join, settle_options=settle_options)
