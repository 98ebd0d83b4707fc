"""Level 1 of a check: arrays, neighbours, edges and flags fit together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import topology
from ..predicates import EXACT_RANGE, LARGEST_ELEVATION, blocks
from ..report import LEFT_OUT

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array
    from ..surface import TIN
    from .findings import Findings

_NEXT, _AFTER_NEXT = (1, 2, 0), (2, 0, 1)
NO_VERTEX = -1


def check_arrays(tin: TIN, found: Findings) -> bool:
    """Check shapes, types and ranges, without which nothing else can be looked at."""
    n_triangles = len(tin.triangles) if np.ndim(tin.triangles) else 0
    wanted = (
        ("points", "f", (None, 3)),
        ("triangles", "iu", (n_triangles, 3)),
        ("neighbors", "iu", (n_triangles, 3)),
        ("constrained", "b", (n_triangles, 3)),
        ("vertex_of", "iu", (None,)),
    )
    for name, kinds, shape in wanted:
        array = np.asarray(getattr(tin, name))
        if array.dtype.kind not in kinds or not _fits(array.shape, shape):
            found.fail("shape", f"{name} is a {array.dtype} array of shape {array.shape}.")
    if n_triangles == 0:
        found.fail("shape", "There is no triangle: a TIN needs at least one.")
    if found.problems:
        return False
    found.counts.update(
        rows=len(tin.vertex_of), vertices=len(tin.points), triangles=len(tin.triangles)
    )
    _check_coordinates(tin.points, found)
    _check_ranges(tin, found)
    return not found.problems


def _fits(shape: tuple[int, ...], wanted: tuple[int | None, ...]) -> bool:
    return len(shape) == len(wanted) and all(
        size is None or size == given for given, size in zip(shape, wanted, strict=True)
    )


def _check_coordinates(points: Float64Array, found: Findings) -> None:
    is_lost = ~np.isfinite(points).all(axis=1)
    found.report("coordinates", is_lost, "vertex", "[has|have] a coordinate that is not finite")
    smallest, largest = EXACT_RANGE
    size = np.abs(points[:, :2])
    found.report(
        "coordinates",
        (((size > largest) & np.isfinite(size)) | ((size < smallest) & (size > 0))).any(axis=1),
        "vertex",
        "[lies|lie] outside the range of exact arithmetic, magnitudes "
        f"{smallest:.0e} to {largest:.0e}",
    )
    height = np.abs(points[:, 2])
    found.report(
        "coordinates",
        (height > LARGEST_ELEVATION) & np.isfinite(height),
        "vertex",
        f"[has|have] an elevation of a magnitude above {LARGEST_ELEVATION:.0e}",
    )


def _check_ranges(tin: TIN, found: Findings) -> None:
    n_vertices, n_triangles = len(tin.points), len(tin.triangles)
    vertex_of = np.where(_check_left_out(tin, found), 0, tin.vertex_of)[:, None]
    ranges = (
        ("triangles", "triangle", tin.triangles, 0, n_vertices),
        ("neighbors", "triangle", tin.neighbors, topology.NO_NEIGHBOR, n_triangles),
        ("vertex_of", "row", vertex_of, 0, n_vertices),
    )
    for name, things, array, lowest, end in ranges:
        wrong = ((array < lowest) | (array >= end)).any(axis=1)
        what = f"[has|have] an entry of {name} outside {lowest} to {end - 1}"
        found.report("index", wrong, things, what)


def _check_left_out(tin: TIN, found: Findings) -> BoolArray:
    """Check the report's rows without a vertex; tell which they are."""
    rows, why = np.asarray(tin.report.left_out_rows), np.asarray(tin.report.left_out_why)
    is_left_out = np.zeros(len(tin.vertex_of), np.bool_)
    if rows.dtype.kind not in "iu" or why.dtype.kind not in "iu" or rows.shape != (len(why),):
        found.fail(
            "left_out",
            f"The report has {rows.shape} rows of type {rows.dtype} that were left out, "
            f"and {why.shape} reasons of type {why.dtype}.",
        )
        return is_left_out
    is_known = (rows >= 0) & (rows < len(is_left_out)) & (why >= 0) & (why < len(LEFT_OUT))
    is_known[1:] &= rows[1:] > rows[:-1]
    found.report(
        "left_out",
        ~is_known,
        "entry",
        "of the report about rows that were left out [has|have] no such row, no such reason or "
        "[is|are] out of order",
    )
    is_left_out[rows[is_known]] = True
    found.report(
        "left_out",
        is_left_out & (tin.vertex_of != NO_VERTEX),
        "row",
        "[was|were] left out by the report, but [has|have] a vertex",
    )
    return is_left_out


def check_connections(tin: TIN, found: Findings) -> bool:
    """Check neighbours, edges and flags; return whether the neighbours can be relied on."""
    a, b, c = tin.triangles.T
    is_flat = (a == b) | (b == c) | (c == a)
    found.report("corners", is_flat, "triangle", "[uses|use] a vertex twice")
    # find triangles with a neighbour that is not one in return, and with flags that differ
    count = len(tin.triangles)
    lonely, unequal = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    for block in blocks(count):
        own = np.arange(block.start, block.stop, dtype=np.int32)  # as neighbors: nothing is cast
        for corner in range(3):
            across = tin.neighbors[block, corner]
            is_met, is_flagged = _look_back(tin, own, across, corner)
            is_inner = across != topology.NO_NEIGHBOR
            lonely[block] |= is_inner & ~is_met
            unequal[block] |= is_inner & is_met & (is_flagged != tin.constrained[block, corner])
    found.report(
        "neighbors",
        lonely,
        "triangle",
        "[has|have] a neighbour that does not have them across the same edge, walked the other way",
    )
    if not found.problems:
        _count_edges(tin, found)
    is_reliable = not found.problems
    what = "[has|have] an edge that is constrained on one side only"
    found.report("constrained", unequal, "triangle", what)
    is_unused = ~topology.mark_corners(tin.triangles, len(tin.points))
    found.report("unused", is_unused, "vertex", "[belongs|belong] to no triangle")
    return is_reliable


def _look_back(
    tin: TIN, own: Int32Array, across: Int32Array, corner: int
) -> tuple[BoolArray, BoolArray]:
    """Look back over the edge opposite ``corner``: tell if it is met, and if flagged, there."""
    start = tin.triangles[own, _NEXT[corner]]
    end = tin.triangles[own, _AFTER_NEXT[corner]]
    triangles, neighbors = tin.triangles[across], tin.neighbors[across]
    flags = tin.constrained[across]
    is_met, is_flagged = np.zeros(len(own), np.bool_), np.zeros(len(own), np.bool_)
    for twin in range(3):
        here = (
            (triangles[:, _NEXT[twin]] == end)
            & (triangles[:, _AFTER_NEXT[twin]] == start)
            & (neighbors[:, twin] == own)
        )
        is_met |= here
        is_flagged |= here & flags[:, twin]
    return is_met, is_flagged


def _count_edges(tin: TIN, found: Findings) -> None:
    """Count edges; two pairs of triangles at one edge show as an edge that comes twice."""
    first = np.arange(len(tin.triangles))[:, None]
    is_boundary = tin.neighbors == topology.NO_NEIGHBOR
    edges = topology.edges_at(tin.triangles, is_boundary | (tin.neighbors > first))
    keys = topology.edge_keys(edges, len(tin.points))
    keys.sort()
    found.counts["edges"] = len(keys)
    found.counts["boundary_edges"] = int(np.count_nonzero(is_boundary))
    inner = np.count_nonzero(tin.constrained & ~is_boundary)
    found.counts["constrained_edges"] = int(
        inner // 2 + np.count_nonzero(tin.constrained & is_boundary)
    )
    found.report(
        "edge",
        np.unique(keys[1:][keys[1:] == keys[:-1]] // len(tin.points)),
        "vertex",
        "belong to more triangles than two",
        before="Edges at ",
    )
