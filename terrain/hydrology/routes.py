"""Routes: drops followed down, and over a filled surface cut where they come to water."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import find_offsets
from .descent import MOVING
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int64Array
    from .descent import Drops, Walker
    from .filling import Filling

DESCENT, POND, FLAT_GROUND = range(3)
KINDS = np.array(["descent", "pond", "flat"], object)
"""Names of the parts of a route: down the surface, across water, over level ground."""


class Trace(NamedTuple):
    """Places on the ways of drops, one way after the other."""

    coordinates: Float64Array
    """(n, 3)."""
    owners: Int64Array
    """(n,), the drop of each."""
    vertices: Int64Array
    """(n,), ``NOWHERE`` for places on no vertex."""
    is_level: BoolArray
    """(n,), whether the way on from there runs over level ground that is filled."""
    ends: Int8Array
    """(k,), how each drop ended."""


class Parts(NamedTuple):
    """Lines that a route is cut into, in its order."""

    coordinates: Float64Array
    """(n, 3), on the filled surface."""
    offsets: Int64Array
    """(p + 1,)."""
    owners: Int64Array
    kinds: Int64Array
    ponds: Int64Array
    """Each (p,), the drop; ``DESCENT``, ``POND`` or ``FLAT_GROUND``; the depression, ``NOWHERE``
    for none.
    """


def trace_down(walker: Walker, start: Float64Array, drops: Drops) -> Trace:
    """Follow drops to their ends; a place that repeats the one before is left out."""
    numbers = np.arange(len(start))
    ends = drops.ends.copy()
    stays = (drops.vertices == NOWHERE) & (drops.triangles == NOWHERE)
    here = np.where(stays[:, None], start, walker.locate(drops))
    nowhere, never = np.full(len(start), NOWHERE), np.zeros(len(start), np.bool_)
    found = [(start, numbers, nowhere, never)]
    while True:
        found.append((here, numbers, drops.vertices, walker.runs_level(drops)))
        ends[numbers] = drops.ends
        moving = np.flatnonzero(drops.ends == MOVING)
        if len(moving) == 0:
            break
        numbers, drops = numbers[moving], walker.step(drops.choose(moving))
        here = walker.locate(drops)
    xyz, owners, vertices, is_level = (
        np.concatenate(arrays) for arrays in zip(*found, strict=True)
    )
    order = np.argsort(owners, kind="stable")
    xyz, owners = xyz[order], owners[order]
    moves = (np.diff(xyz[:, :2], axis=0) != 0).any(axis=1) | (np.diff(owners) != 0)
    last = np.append(moves, True)  # of those at one place
    return Trace(xyz[last], owners[last], vertices[order][last], is_level[order][last], ends)


def cut_parts(trace: Trace, filling: Filling) -> Parts:
    """Cut ways over a filled surface where they come to water or to level ground, and leave it."""
    levels, ponds = _find_water(trace, filling)
    xyz = trace.coordinates.copy()
    xyz[:, 2] = np.maximum(xyz[:, 2], levels)
    first = np.flatnonzero(trace.owners[1:] == trace.owners[:-1])
    pond = np.maximum(ponds[first], ponds[first + 1])
    kinds = np.where(trace.is_level[first], FLAT_GROUND, DESCENT)
    kinds[pond != NOWHERE] = POND
    enters = np.flatnonzero((pond != NOWHERE) & (xyz[first, 2] > xyz[first + 1, 2]))
    shores = _find_shores(trace.coordinates, first[enters], levels[first[enters] + 1])
    at_shore = (shores[:, :2] == xyz[first[enters], :2]).all(axis=1)
    xyz[first[enters[at_shore]], 2] = shores[at_shore, 2]
    enters, shores = enters[~at_shore], shores[~at_shore]
    begins, ends, owners = xyz[first], xyz[first + 1], trace.owners[first]
    begins = np.insert(begins, enters + 1, shores, axis=0)
    ends = np.insert(ends, enters, shores, axis=0)
    owners, pond = np.insert(owners, enters, owners[enters]), np.insert(pond, enters, NOWHERE)
    kinds = np.insert(kinds, enters, DESCENT)
    real = (begins[:, :2] != ends[:, :2]).any(axis=1)
    return _join_segments(begins[real], ends[real], owners[real], kinds[real], pond[real])


def _find_water(trace: Trace, filling: Filling) -> tuple[Float64Array, Int64Array]:
    """Return water level and pond of places: what comes under water stays there to a vertex."""
    count = len(trace.vertices)
    at_vertex = np.where(trace.vertices != NOWHERE, np.arange(count), count)
    after = np.minimum.accumulate(at_vertex[::-1])[::-1]
    same = after < count
    same[same] = trace.owners[after[same]] == trace.owners[same]
    vertices = np.where(same, trace.vertices[np.where(same, after, 0)], 0)
    levels = filling.levels[vertices]
    is_under = same & (filling.ponds[vertices] != NOWHERE) & (trace.coordinates[:, 2] < levels)
    return (
        np.where(is_under, levels, trace.coordinates[:, 2]),
        np.where(is_under, filling.ponds[vertices], NOWHERE),
    )


def _find_shores(places: Float64Array, rows: Int64Array, levels: Float64Array) -> Float64Array:
    """Return where the way from places to the next ones, on the bed of a pond, meets its water."""
    begin, end = places[rows], places[rows + 1]
    share = ((begin[:, 2] - levels) / (begin[:, 2] - end[:, 2]))[:, None]
    return np.column_stack([begin[:, :2] + share * (end[:, :2] - begin[:, :2]), levels])


def _join_segments(
    begins: Float64Array,
    ends: Float64Array,
    owners: Int64Array,
    kinds: Int64Array,
    ponds: Int64Array,
) -> Parts:
    """Join segments of one kind to lines."""
    keys = np.column_stack([owners, kinds, ponds])
    is_new = np.append(True, (np.diff(keys, axis=0) != 0).any(axis=1))[: len(keys)]
    first = np.flatnonzero(is_new)
    lengths = np.diff(np.append(first, len(keys))) + 1
    coordinates = np.insert(ends, first, begins[first], axis=0)
    return Parts(coordinates, find_offsets(lengths), owners[first], kinds[first], ponds[first])
