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
    found.report(
        "coordinates",
        np.flatnonzero(~np.isfinite(points).all(axis=1)),
        "{count} [vertex has|vertices have] a coordinate that is not finite "
        "(first: [vertex|vertices] {first}).",
    )
    smallest, largest = EXACT_RANGE
    size = np.abs(points[:, :2])
    found.report(
        "coordinates",
        np.flatnonzero(
            (((size > largest) & np.isfinite(size)) | ((size < smallest) & (size > 0))).any(axis=1)
        ),
        "{count} [vertex lies|vertices lie] outside the range of exact arithmetic, magnitudes "
        f"{smallest:.0e} to {largest:.0e} (first: [vertex|vertices] {{first}}).",
    )
    height = np.abs(points[:, 2])
    found.report(
        "coordinates",
        np.flatnonzero((height > LARGEST_ELEVATION) & np.isfinite(height)),
        "{count} [vertex has|vertices have] an elevation of a magnitude above "
        f"{LARGEST_ELEVATION:.0e} (first: [vertex|vertices] {{first}}).",
    )


def _check_ranges(tin: TIN, found: Findings) -> None:
    n_vertices, n_triangles = len(tin.points), len(tin.triangles)
    is_left_out = _check_left_out(tin, found)
    ranges = (
        ("triangles", "[triangle|triangles]", tin.triangles, 0, n_vertices),
        ("neighbors", "[triangle|triangles]", tin.neighbors, topology.NO_NEIGHBOR, n_triangles),
        (
            "vertex_of",
            "[row|rows]",
            np.where(is_left_out, 0, tin.vertex_of)[:, None],
            0,
            n_vertices,
        ),
    )
    for name, things, array, lowest, end in ranges:
        wrong = ((array < lowest) | (array >= end)).any(axis=1)
        found.report(
            "index",
            np.flatnonzero(wrong),
            f"{{count}} {things} [has|have] an entry of {name} outside {lowest} to {end - 1} "
            f"(first: {things} {{first}}).",
        )


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
        np.flatnonzero(~is_known),
        "{count} [entry|entries] of the report about rows that were left out [has|have] no such "
        "row, no such reason or [is|are] out of order (first: [entry|entries] {first}).",
    )
    is_left_out[rows[is_known]] = True
    found.report(
        "left_out",
        np.flatnonzero(is_left_out & (tin.vertex_of != NO_VERTEX)),
        "{count} [row was|rows were] left out by the report, but [has|have] a vertex "
        "(first: [row|rows] {first}).",
    )
    return is_left_out


def check_connections(tin: TIN, found: Findings) -> bool:
    """Check neighbours, edges and flags; return whether the neighbours can be relied on."""
    a, b, c = tin.triangles.T
    found.report(
        "corners",
        np.flatnonzero((a == b) | (b == c) | (c == a)),
        "{count} [triangle uses|triangles use] a vertex twice "
        "(first: [triangle|triangles] {first}).",
    )
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
        np.flatnonzero(lonely),
        "{count} [triangle has|triangles have] a neighbour that does not have them across the "
        "same edge, "
        "walked the other way (first: [triangle|triangles] {first}).",
    )
    if not found.problems:
        _count_edges(tin, found)
    is_reliable = not found.problems
    found.report(
        "constrained",
        np.flatnonzero(unequal),
        "{count} [triangle has|triangles have] an edge that is constrained on one side only "
        "(first: [triangle|triangles] {first}).",
    )
    found.report(
        "unused",
        np.flatnonzero(~topology.mark_corners(tin.triangles, len(tin.points))),
        "{count} [vertex belongs|vertices belong] to no triangle "
        "(first: [vertex|vertices] {first}).",
    )
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
        "Edges at {count} [vertex|vertices] belong to more triangles than two "
        "(first: [vertex|vertices] {first}).",
    )
