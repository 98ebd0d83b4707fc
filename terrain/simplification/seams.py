"""Where the blocks of a raster meet, and where its surface ends.

Each block is simplified by itself. On the seam of two blocks the vertices are chosen before, so
that both have the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...tin.meshing import are_straight, find_rounding
from ..surface import find_border, trace_cycles
from .elevations import Heights

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...tin.meshing import Goal
    from .elevations import Block, Elevations


class Frame(NamedTuple):
    """The boundary of the surface of a raster, and the cells that must be vertices."""

    rings: list[Int64Array]
    """(k,) each, cells along the boundary, the surface on their left."""
    required: Int64Array
    """(r,), corners of boundaries and vertices on seams, ascending."""
    rounding: float
    """By how much elevations may differ because they are rounded."""


def trace_block(valid: BoolArray) -> list[Int64Array]:
    """Return the rings around the cells of a block that have elevations, as cells of the block."""
    if not valid.all():
        return list(trace_cycles(*find_border(valid)))
    rows, columns = valid.shape
    south, east = np.arange(columns - 1), np.arange(rows - 1, 0, -1)
    last = (rows - 1) * columns
    parts = [
        last + south,
        (east + 1) * columns - 1,
        south[::-1] + 1,
        east[::-1] * columns - columns,
    ]
    return [np.concatenate(parts)]


def find_frame(elevations: Elevations, blocks: Sequence[Block], goal: Goal) -> Frame:
    """Read a raster once: find its boundary, and choose the vertices on seams.

    Cells on seams are within the goal's tolerance of the line between the vertices. Raises
    PointsError if the raster has no surface.
    """
    rings, corners, heights, rounding = [], [], [], 0.0
    for block in blocks:
        z = elevations.read(block)
        found = trace_block(np.isfinite(z))
        if not found:
            continue
        rings += [block.to_raster(ring, elevations.shape[1]) for ring in found]
        corners += _find_corners(elevations, rings[-len(found) :])
        heights += [z.ravel()[ring] for ring in found]
        extremes = np.array([np.fmin.reduce(z, axis=None), np.fmax.reduce(z, axis=None)])
        rounding = max(rounding, find_rounding(extremes))
    if not rings:
        raise PointsError(
            "No three cells side by side have an elevation, so the raster has no surface."
        )
    required = np.unique(np.concatenate(corners))
    if len(blocks) == 1:
        return Frame(rings, required, rounding)
    on_rings = Heights(np.concatenate(rings), np.concatenate(heights))
    return _join(elevations, Frame(rings, required, rounding), on_rings, goal)


def _join(elevations: Elevations, parts: Frame, heights: Heights, goal: Goal) -> Frame:
    """Return the boundary of all blocks together, with the vertices on their seams."""
    start = np.concatenate(parts.rings)
    end = np.concatenate([np.roll(ring, -1) for ring in parts.rings])
    pairs = np.column_stack([np.minimum(start, end), np.maximum(start, end)])
    _, place, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    is_seam = count[place.ravel()] > 1  # another block has the edge in the other direction
    edges = np.sort(np.column_stack([start, end])[is_seam], axis=1)
    limit = goal.limits(parts.rounding)[0]
    chosen = [
        chain[choose_vertices(heights.of(chain), limit)]
        for chain in _list_chains(edges, parts.required, elevations.shape[1])
    ]
    border = list(trace_cycles(start[~is_seam], end[~is_seam]))
    more = _find_corners(elevations, border)
    required = np.unique(np.concatenate([parts.required, *chosen, *more]))
    return Frame(border, required, parts.rounding)


def _find_corners(elevations: Elevations, rings: list[Int64Array]) -> list[Int64Array]:
    """Return the corners of rings, and cells that they pass twice."""
    found = [ring[~are_straight(elevations.points(ring, np.zeros(len(ring))))] for ring in rings]
    cells, visits = np.unique(np.concatenate(rings), return_counts=True)
    return [*found, cells[visits > 1]]


def _list_chains(edges: Int64Array, required: Int64Array, width: int) -> Iterator[Int64Array]:
    """Yield the cells along seams, from one that is required to the next."""
    for step in (1, width):
        cells = np.unique(edges[edges[:, 1] - edges[:, 0] == step, 0])
        cells = cells[np.argsort(cells % width, kind="stable")] if step > 1 else cells
        is_first = np.append(True, cells[1:] != cells[:-1] + step) | np.isin(cells, required)
        for run in np.split(cells, np.flatnonzero(is_first)[1:]):
            yield np.append(run, run[-1:] + step)


def choose_vertices(z: Float64Array, limit: float) -> Int64Array:
    """Return the places between the ends of a profile that keep all within a limit.

    By halving at the farthest (D. H. Douglas, T. K. Peucker, "Algorithms for the reduction of the
    number of points required to represent a digitized line or its caricature", 1973), in elevation.

    Examples
    --------
    >>> choose_vertices(np.array([0.0, 0.1, 2.0, 1.0, 0.0]), 0.5)
    array([1, 2])
    """

    def measure(start: int, end: int) -> Float64Array:
        line = z[start] + (z[end] - z[start]) / (end - start) * np.arange(1, end - start)
        return np.asarray(np.abs(z[start + 1 : end] - line), np.float64)

    return halve_at_farthest(len(z), measure, limit)


def halve_at_farthest(
    count: int, measure: Callable[[int, int], Float64Array], limit: float
) -> Int64Array:
    """Return the places between the ends of a line that keep the others within a limit of it.

    ``measure`` returns how far those between two places are from the straight line between these.
    """
    chosen: list[int] = []
    waiting = [(0, count - 1)]
    while waiting:
        start, end = waiting.pop()
        if end - start < 2:
            continue
        error = measure(start, end)
        worst = int(error.argmax())
        if error[worst] > limit:
            middle = start + 1 + worst
            chosen.append(middle)
            waiting += [(start, middle), (middle, end)]
    return np.array(sorted(chosen), np.int64)
