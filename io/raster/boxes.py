"""What the header of a raster says of its points, and the points of a box."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE
from ..registry import (
    PointChunk,
    SourceHeader,
    find_inside,
    join_chunks,
    make_source_header,
    taking,
)
from ..reprojection import Placing, find_bounds, place
from .header import read_header, stream_strips
from .reading import Cells, Choice, Plan, cut_bounds, find_middle, plan_cells, read_strips

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import Bounds

_WIDEST_BLOCK = 4_096
"""Cells side by side that are decompressed together, of a raster that is read by windows."""


@taking(Choice)
def describe(path: Path, choice: Choice) -> SourceHeader:
    """Tell what the header of a raster says of its points: the cells that the options choose."""
    plan = plan_cells(read_header(path), choice)
    placed = place(
        find_middle(plan.dataset), source=plan.source, target=plan.target, unit=plan.unit
    )
    cells = plan.cells
    columns, rows = cells.columns, cells.find_rows(cells.row, cells.row + cells.height)
    x, y = plan.dataset.transform.apply(columns[[0, -1, 0, -1]] + 0.5, rows[[0, 0, -1, -1]] + 0.5)
    low, high = np.array([x.min(), y.min()]), np.array([x.max(), y.max()])
    return make_source_header(
        path,
        "raster",
        count=cells.count,
        bounds=find_bounds(low, high, plan.source, plan.target),
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        obstacle=_find_obstacle(plan),
        notes=tuple(plan.said),
    )


def _find_obstacle(plan: Plan) -> str:
    """Return why the cells of a box are not read, or only with all others beside it."""
    if not plan.stays:
        return "would be reprojected"
    width = min(plan.dataset.block_width, plan.dataset.width)
    if width > _WIDEST_BLOCK:
        return f"holds its cells in strips of {width:,}, and not in tiles (as a COG does)"
    return ""


@taking(Choice)
def read_box(path: Path, bounds: Bounds, choice: Choice) -> PointChunk:
    """Read the points of a raster whose cell centres lie in a box, row by row.

    Parameters
    ----------
    bounds : Bounds
        In the CRS of the raster; the edges belong to it.

    Raises
    ------
    ReadError
        If the points would be reprojected.
    """
    header = read_header(path)
    plan = plan_cells(header, choice)
    if not plan.stays:
        raise ReadError(f"{FILE} would be reprojected: its points cannot be read by box.")
    placing = Placing(plan.source, plan.target, plan.unit)
    cells = _cut(plan, bounds)
    chunks = []
    if cells is not None:
        for strip in read_strips(plan, cells, partial(stream_strips, header)):
            inside = find_inside(strip.points, bounds)
            points = placing.add(strip.points[inside]).points
            chunks.append(PointChunk(points, strip.cells[inside], {}))
    return join_chunks(chunks)


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
