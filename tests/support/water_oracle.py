"""Water left out of lines and points one after the other, as its definition reads."""

from __future__ import annotations

import numpy as np

from tinsmith.tin import _kernel
from tinsmith.tin.constraints.clipping import in_rings
from tinsmith.tin.constraints.constraint_set import ABOVE_ALL
from tinsmith.tin.report import Overruled
from tinsmith.tin.topology import edge_keys


def leave_out_one_by_one(points, polylines, lines, overruled):
    """Put shores at the elevation of their water, in place, and leave out what is in it.

    Waters are taken one after the other: each is compared with every vertex and segment. Returns
    the polylines without the segments in water, but for those of boundaries and holes,
    which lie on it; (n,) flags of the vertices in water, which go; and what is overruled, with the
    elevations that the water overrules.
    """
    wet = np.zeros(len(points), np.bool_)
    if not (lines.priorities == ABOVE_ALL).any():
        return polylines, wet, overruled
    is_ring = lines.table.is_kind("boundary", "hole")
    given = polylines
    for line in np.flatnonzero(lines.priorities == ABOVE_ALL).tolist():
        shore = given.vertices[given.offsets[line] : given.offsets[line + 1]]
        inside = _find_inside(points[:, :2], points[shore, :2])
        segments, line_of = polylines.segments(), polylines.segment_lines()
        in_water = inside[segments].any(axis=1) | _are_chords_within(points[:, :2], segments, shore)
        stays = (line_of == line) | is_ring[line_of] | _runs_along(segments, shore, len(points))
        held = np.unique(segments[in_water & is_ring[line_of]])
        level = float(lines.elevations[lines.offsets[line]])
        overruled = _set_level(points, np.union1d(shore, held), level, overruled)
        polylines = polylines.keep(~in_water | stays)
        inside[held] = False
        wet |= inside
    is_dry = np.asarray(~wet[polylines.segments()].any(axis=1), np.bool_)
    return polylines.keep(is_dry), wet, overruled


def _set_level(points, vertices, level, overruled):
    wrong = vertices[points[vertices, 2] != level]
    before = points[wrong, 2]
    points[wrong, 2] = level
    return Overruled(
        np.append(overruled.vertices, wrong).astype(np.int32),
        np.append(overruled.lines, np.full(len(wrong), -1, np.int32)),
        np.append(overruled.elevations, before),
        np.append(overruled.vertex_elevations, np.full(len(wrong), level)),
    )


def _are_chords_within(xy, segments, shore):
    """Tell which segments go through water from shore to shore; noded, all others end in it.

    Their middles, rounded, may lie on the wrong side of a shore that is near.
    """
    is_shore = np.zeros(len(xy), np.bool_)
    is_shore[shore] = True
    is_chord = is_shore[segments].all(axis=1) & ~_runs_along(segments, shore, len(xy))
    ring = np.ascontiguousarray(xy[shore])
    for segment in np.flatnonzero(is_chord).tolist():
        start, end = xy[segments[segment]]
        is_chord[segment] = _is_ring_around(ring, start, end)
    return is_chord


def _is_ring_around(ring, start, end):
    """Tell if a segment that no edge of a closed ring crosses lies inside, exactly.

    Inside, a ray from the segment over its end crosses an odd number of edges: to the left of the
    line those with one end there and the segment's end not behind them::

                     left
        start ------- end -----|--->
                               |
    """
    on_left = _orient(start, end, ring) > 0
    crosses = np.flatnonzero(on_left[:-1] != on_left[1:])
    is_down = on_left[crosses]
    left, right = (ring[crosses + np.where(is_down, k, 1 - k)] for k in (0, 1))
    return bool(np.count_nonzero(_orient(left, right, end) <= 0) % 2)


def _orient(a, b, c):
    a, b, c = (np.ascontiguousarray(places) for places in np.broadcast_arrays(a, b, c))
    return _kernel.orientation(a, b, c)


def _runs_along(segments, chain, n_vertices: int):
    own = np.stack([chain[:-1], chain[1:]], axis=1)
    return np.isin(edge_keys(segments, n_vertices), edge_keys(own, n_vertices))


def _find_inside(xy, ring):
    """Tell which places lie strictly inside a ring whose first corner is repeated."""
    if len(ring) < 4:
        return np.zeros(len(xy), np.bool_)
    low, high = ring.min(axis=0), ring.max(axis=0)
    near = np.flatnonzero(((xy > low) & (xy < high)).all(axis=1))
    inside = np.zeros(len(xy), np.bool_)
    if len(near):
        inside[near] = in_rings(xy[near], [ring[:-1]]) > 0
    return inside
