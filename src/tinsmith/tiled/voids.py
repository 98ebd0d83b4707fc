"""Where the surface of a raster ends at cells without data: rings that cut it, as lines do."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import ReadError
from ..terrain.surface import trace_rings
from ..tin import Survey
from ..tin.tiling import NumberedPoints, list_sides
from .chunks import ROWS_OF_A_FILE
from .lines import GivenLines

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..base.arrays import BoolArray, Float64Array, Int64Array
    from .reading import StoredPoints


def add_void_rings(points: StoredPoints, lines: GivenLines | None) -> GivenLines:
    """Return lines with the rings at which the surface of a raster ends.

    Parameters
    ----------
    points : StoredPoints
        Cells of one raster, with their ``lattice``.
    lines : GivenLines or None
        Further lines.

    Raises
    ------
    ReadError
        If nowhere three cells side by side have elevations.

    Notes
    -----
    Points are read twice: for which cells there are, and for those on rings. Of all cells up to
    four bytes each are held, and some 60 while rings are traced.
    """
    if lines is None:
        survey = Survey(
            points=np.empty((0, 3)), crs=points.crs, elevation_unit=points.elevation_unit
        )
        lines = GivenLines(survey=survey)
    return replace(lines, survey=replace(lines.survey, extent=_find_rings(points)))


def _find_rings(points: StoredPoints) -> list[Float64Array]:
    """Return the cells of each ring, (k, 3)."""
    is_valid, low = _mark_cells(points)
    rings = trace_rings(is_valid)
    if not rings:
        raise ReadError("Nowhere in the raster do three cells side by side have elevations.")
    on_rings = np.unique(np.concatenate(rings))
    cells = np.flatnonzero(is_valid)[on_rings]
    found = np.empty((len(cells), 3))
    for part, some in _list_cells(points):
        numbers = np.ravel_multi_index(tuple(part - low[:, None]), is_valid.shape)
        at = np.searchsorted(cells, numbers)
        is_there = np.append(cells, -1)[at] == numbers
        found[at[is_there]] = some.points[is_there]
    return [found[np.searchsorted(on_rings, ring)] for ring in rings]


def _mark_cells(points: StoredPoints) -> tuple[BoolArray, Int64Array]:
    """Tell which cells have elevations, within their bounds, whose first row and column follow."""
    is_valid = np.zeros((0, 0), np.bool_)
    for part, _ in _list_cells(points):
        more = np.maximum(part.max(axis=1) + 1 - is_valid.shape, 0)
        if more.any():  # doubled, so that few of many parts enlarge it
            more = np.where(more > 0, np.maximum(more, is_valid.shape), 0)
            is_valid = np.pad(is_valid, [(0, int(count)) for count in more])
        is_valid[tuple(part)] = True
    rows, columns = (np.flatnonzero(is_valid.any(axis=axis)) for axis in (1, 0))
    inside = is_valid[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return np.ascontiguousarray(inside), np.array([rows[0], columns[0]])


def _list_cells(points: StoredPoints) -> Iterator[tuple[Int64Array, NumberedPoints]]:
    """Yield row and column of the cells of parts of all, (2, k), and the points."""
    if points.lattice is None:
        raise AssertionError("points of no raster with voids")
    width, step = points.lattice
    for chunk in points.open().chunks:
        for box in chunk.list_parts():
            some = chunk.read_boxes(np.array([list_sides(box)]))
            yield np.stack(np.divmod(some.numbers % ROWS_OF_A_FILE, width)) // step, some
