"""What the header of a raster says of its points, and the points of a box."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE
from ..registry import PointChunk, SourceHeader, join_chunks, make_source_header
from ..reprojection import Placing, find_bounds, place
from .dem import (
    Cells,
    Plan,
    cut_bounds,
    find_middle,
    make_choice,
    plan_cells,
    read_strips,
)
from .header import read_header, stream_strips

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.crs import CrsLike, UnitLike
    from ...tin import Bounds


def describe(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> SourceHeader:
    """Tell what the header of a raster says of its points.

    Parameters
    ----------
    path : Path
    crs, elevation_unit, **options
        As of the reader. The count is that of the cells that they choose.
    """
    target = CRS.of(crs)
    plan = plan_cells(read_header(path), make_choice(options), target, Unit.of(elevation_unit))
    placed = place(find_middle(plan.dataset), source=plan.source, target=target, unit=plan.unit)
    columns, rows = (
        plan.cells.columns,
        plan.cells.find_rows(plan.cells.row, plan.cells.row + plan.cells.height),
    )
    x, y = plan.dataset.transform.apply(columns[[0, -1, 0, -1]] + 0.5, rows[[0, 0, -1, -1]] + 0.5)
    low, high = np.array([x.min(), y.min()]), np.array([x.max(), y.max()])
    return make_source_header(
        path,
        "raster",
        count=plan.cells.count,
        bounds=find_bounds(low, high, plan.source, target),
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        has_boxes=_stays(plan, target),
        notes=tuple(plan.said),
    )


def _stays(plan: Plan, target: CRS | None) -> bool:
    """Whether the points are not reprojected."""
    return target is None or (plan.source is not None and plan.source.is_same(target))


def read_box(
    path: Path,
    bounds: Bounds,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> PointChunk:
    """Read the points of a raster whose cell centres lie in a box, row by row.

    Parameters
    ----------
    path : Path
    bounds : Bounds
        In the CRS of the raster; the edges belong to it.
    crs, elevation_unit, **options
        As of the reader.

    Raises
    ------
    ReadError
        If the points would be reprojected.
    """
    header, target = read_header(path), CRS.of(crs)
    plan = plan_cells(header, make_choice(options), target, Unit.of(elevation_unit))
    if not _stays(plan, target):
        raise ReadError(f"{FILE} would be reprojected: its points cannot be read by box.")
    placing = Placing(plan.source, target, plan.unit)
    cells = _cut(plan, bounds)
    chunks = []
    if cells is not None:
        for strip in read_strips(plan, cells, partial(stream_strips, header)):
            x, y = strip.points[:, 0], strip.points[:, 1]
            inside = (x >= bounds.xmin) & (x <= bounds.xmax)
            inside &= (y >= bounds.ymin) & (y <= bounds.ymax)
            points = placing.add(strip.points[inside]).points
            chunks.append(PointChunk(points, strip.cells[inside], {}))
    empty = PointChunk(np.empty((0, 3)), np.empty(0, np.int64), {})
    return join_chunks(chunks) if chunks else empty


def _cut(plan: Plan, bounds: Bounds) -> Cells | None:
    """Return those of the cells to read that may lie in a box; None if there are none."""
    try:
        column, row, width, height = cut_bounds(plan.dataset, bounds)
    except OptionError:
        return None
    cells, stride = plan.cells, plan.cells.stride
    column, width = _cut_axis((column, width), (cells.column, cells.width), stride)
    row, height = _cut_axis((row, height), (cells.row, cells.height), stride)
    if width <= 0 or height <= 0:
        return None
    return Cells(column, row, width, height, stride, cells.bounds)


def _cut_axis(part: tuple[int, int], whole: tuple[int, int], stride: int) -> tuple[int, int]:
    """Return the part of a row of cells, one cell wider, that begins with one that is wanted."""
    start = max(part[0] - 1, whole[0])
    end = min(part[0] + part[1] + 1, whole[0] + whole[1])
    start += (whole[0] - start) % stride
    return start, end - start
