"""Points and lines become the constrained Delaunay triangulation of their convex hull.

The main path: rows at one place become one vertex, lines are cut where they meet, the points are
triangulated, and the segments of the lines are forced into the triangulation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _kernel
from ..constraints import (
    ABOVE_ALL,
    BELOW_ALL,
    LineSet,
    Noded,
    Polylines,
    accept_noded,
    build_mesh,
    conform,
    force,
    node,
)
from ..report import Crossings, Overruled
from ..triangulation import Triangulation
from ..validation import require_three, thread_count
from .duplicates import merge_rows
from .water import leave_out_water

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from .options import BuildOptions


class ConstrainedTriangulation(NamedTuple):
    """The triangulated hull with its lines."""

    surface: Triangulation
    vertex_of: Int32Array
    """(n,), the vertex of each row of points, -1 for rows in water."""
    line_vertices: Int32Array
    """(k,), likewise of each given vertex of the lines."""
    polylines: Polylines
    """What is left of the lines, water excluded."""
    merges: dict[str, Any]
    """Fields of the report about merged rows."""
    crossings: Crossings
    """Where lines meet; vertices are numbered as ``number_of`` says."""
    overruled: Overruled
    """Likewise."""
    number_of: Int32Array
    """(v,), the vertex of the surface for each vertex before water took its share, -1 for none."""


class _Merged(NamedTuple):
    points: Float64Array
    vertex_of: Int32Array
    polylines: Polylines
    mesh: _kernel.Mesh
    merges: dict[str, Any]
    overruled: Overruled


class _WithLines(NamedTuple):
    """A mesh whose fixed edges are the segments of lines, on dry land."""

    mesh: _kernel.Mesh
    points: Float64Array
    """(v, 3), of the mesh's vertices; without gaps."""
    polylines: Polylines
    number_of: Int32Array
    crossings: Crossings
    overruled: Overruled


def triangulate_constrained(
    points: Float64Array,
    rows: Int64Array,
    lines: LineSet,
    options: BuildOptions,
    *,
    progress: Tell | None = None,
) -> ConstrainedTriangulation:
    """Triangulate rows of points, and lines; all lines have elevations.

    ``progress`` is told the fraction done of the triangulation of the points. Raises PointsError if
    there is no triangle, or rows coincide that must not; LinesError if lines cross that must not.
    """
    threads = thread_count(options.threads, len(points))
    xyz = points if len(rows) == len(points) else points[rows]
    merged = _merge(xyz, rows, lines, options, threads=threads, progress=progress)
    found = _force_lines(merged, lines, options, threads=threads)
    vertex_of, merges = found.number_of[merged.vertex_of], merged.merges
    del merged  # of as many bytes as the arrays to come
    mesh, points, polylines = found.mesh, found.points, found.polylines
    if options.conforming:
        if len(points) < len(found.number_of):  # numbers without gaps
            mesh = build_mesh(points, polylines, threads=threads)
        mesh, points, polylines = conform(
            mesh, points, polylines, lines.priorities, threads=threads
        )
    return ConstrainedTriangulation(
        Triangulation(points, *mesh.arrays(threads)),
        vertex_of[: len(xyz)],
        vertex_of[len(xyz) :],
        polylines,
        merges,
        found.crossings,
        found.overruled,
        found.number_of,
    )


def _force_lines(
    merged: _Merged, lines: LineSet, options: BuildOptions, *, threads: int
) -> _WithLines:
    """Cut lines where they meet, fix their segments in the mesh, and leave out what is in water."""
    mesh = merged.mesh
    noded = accept_noded(merged.polylines, lines.elevations)
    is_simple = options.snap == 0.0 and not (lines.priorities == ABOVE_ALL).any()
    is_forced = is_simple and _is_forced(mesh, noded.polylines)
    if not is_forced:
        noded = node(
            np.ascontiguousarray(merged.points[:, :2]),
            merged.polylines,
            lines.elevations,
            lines.priorities,
            snap=options.snap,
            crossing=options.crossing,
            threads=threads,
            names=lines.labels(),
        )
        if is_simple:  # edges were fixed in vain
            mesh.release_all()
        if len(noded.new_points):
            mesh.insert(np.ascontiguousarray(noded.new_points[:, :2]))
    points = merged.points
    if len(noded.new_points):
        points = np.concatenate([points, noded.new_points])
    overruled = _add_touches(points, noded, merged.overruled)
    polylines, wet, overruled = leave_out_water(
        points, noded.polylines, lines, overruled, threads=threads
    )
    if not is_forced:
        mesh.remove(np.flatnonzero(wet).astype(np.int32))
        force(mesh, polylines)
    number_of = np.arange(len(points), dtype=np.int32)
    if wet.any():
        number_of = np.where(wet, -1, np.cumsum(~wet) - 1).astype(np.int32)
        points, polylines = points[~wet], polylines.renumber(number_of)
    return _WithLines(mesh, points, polylines, number_of, noded.crossings, overruled)


def _is_forced(mesh: _kernel.Mesh, polylines: Polylines) -> bool:
    """Fix the segments of lines as they are given; tell whether nothing was in the way of any."""
    passed, blocked = mesh.force(polylines.segments())
    return not (len(passed) or len(blocked))


# ------------------------------------------------------------------------- rows


def _merge(
    xyz: Float64Array,
    rows_of: Int64Array,
    lines: LineSet,
    options: BuildOptions,
    *,
    threads: int,
    progress: Tell | None,
) -> _Merged:
    """Make one vertex of all rows at one place; a line's elevation counts more than a point's."""
    n = len(xyz)
    require_three(n + len(lines.xy))
    rows = np.concatenate([xyz, np.column_stack([lines.xy, np.nan_to_num(lines.elevations)])])
    place = _kernel.snap(rows, options.snap) if options.snap > 0 else None
    own = np.arange(len(rows), dtype=np.int32)
    kept = rows if place is None else rows[place == own]
    mesh, kept_row = _kernel.triangulate_mesh(kept, threads=threads, progress=progress)
    place = kept_row if place is None else place
    place = own if place is None else place
    is_kept = place == own
    vertex_of = (np.cumsum(is_kept, dtype=np.int32) - np.int32(1))[place]
    points = rows[is_kept]
    del rows, kept
    # vertices get the elevations of their points, before those of lines
    first = np.full(len(points), n, np.int32)
    np.minimum.at(first, vertex_of[:n], own[:n])
    merged = merge_rows(xyz, first[vertex_of[:n]], options.duplicates, rows_of)
    of_vertex = np.flatnonzero(first < n)
    of_vertex = of_vertex[np.argsort(first[of_vertex], kind="stable")].astype(np.int32)
    points[:, 2] = np.nan
    points[of_vertex, 2] = merged.points[:, 2]
    merges = dict(merged.account)
    if merges:
        merged_rows = merges["merged_rows"]
        moved = xyz[merged_rows, :2] - points[vertex_of[merged_rows], :2]
        merges["merged_vertices"] = of_vertex[merges["merged_vertices"]]
        merges["merged_shifts"] = np.hypot(*moved.T)
        merges["merged_rows"] = rows_of[merged_rows].astype(np.int32)
    overruled = _set_line_elevations(points, vertex_of, n, lines)
    polylines = Polylines.whole(vertex_of[n:], lines.offsets)
    return _Merged(points, vertex_of, polylines, mesh, merges, overruled)


def _set_line_elevations(
    points: Float64Array, vertex_of: Int32Array, n: int, lines: LineSet
) -> Overruled:
    """Give vertices on lines the elevation of the line that counts most there, its lowest."""
    vertices, line_of = vertex_of[n:], lines.line_of
    priority = lines.priorities[line_of]
    best = lines.find_best_rows(vertices)
    before = points[vertices[best], 2].copy()
    counts = (priority[best] > BELOW_ALL) | np.isnan(before)
    points[vertices[best[counts]], 2] = lines.elevations[best[counts]]
    elevation = points[vertices[best], 2]
    is_overruled = np.flatnonzero(~np.isnan(before) & (before != elevation))
    other = np.flatnonzero(lines.elevations != points[vertices, 2])
    return Overruled(
        np.concatenate([vertices[best[is_overruled]], vertices[other]]),
        np.concatenate([np.full(len(is_overruled), -1), line_of[other]]).astype(np.int32),
        np.concatenate([before[is_overruled], lines.elevations[other]]),
        np.concatenate([elevation[is_overruled], points[vertices[other], 2]]),
    )


def _add_touches(points: Float64Array, noded: Noded, overruled: Overruled) -> Overruled:
    """Add the elevations of lines that run through a vertex of others, where they differ."""
    touches = noded.touches
    elevation = points[touches.vertex, 2]
    rounding = 8 * np.spacing(np.maximum(np.abs(elevation), np.abs(touches.elevation)))
    other = np.abs(touches.elevation - elevation) > rounding
    return Overruled(
        np.append(overruled.vertices, touches.vertex[other]),
        np.append(overruled.lines, touches.line[other]).astype(np.int32),
        np.append(overruled.elevations, touches.elevation[other]),
        np.append(overruled.vertex_elevations, elevation[other]),
    )
