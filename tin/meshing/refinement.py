"""Refine: a TIN becomes a mesh for finite elements, its triangles good and small enough.

Where to put points is decided by the core; here their elevations are found, and the TIN is built of
all points and of the segments as they were split.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.checks import is_finite_number, is_whole_number, require_positive, require_tin
from ...base.errors import OptionError, PointsError
from ...base.products import product
from ...base.progress import Progress
from ...base.sentences import counted
from .. import _kernel, topology
from ..building import Version
from ..constraints import find_lines_in
from ..report import Unmended
from ..surface import TIN
from ..triangulation import Triangulation
from ..validation import thread_count
from .flips import describe_flips
from .shape_quality import measure_smallest_angles
from .surface_pslg import gather_pslg, list_rings

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ..constraints import Pslg

_MOST_ATTEMPTS = 5
"""The last one but one splits no edge of the boundary where splitting some was not to be had."""

LARGEST_MIN_ANGLE = 33.0
"""Degrees; beyond about 34 refinement as good as never ends [1]_ in :func:`refine`."""

_FOUND = 0.6
"""Of the work as it is told, what is done once all points are found."""

MOST_VERTICES = 10_000_000
"""What a mesh may have unless the caller says otherwise: some five gigabytes of memory."""


@product
def refine(
    tin: TIN,
    *,
    min_angle: float = 25.0,
    max_area: float | None = None,
    max_edge: float | None = None,
    max_vertices: int = MOST_VERTICES,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Add points to a TIN until its triangles are good enough for finite elements.

    Delaunay refinement [1]_ [2]_ with off-centres [3]_: where a triangle has too small an angle, is
    too large or has too long an edge, a point is put that mends it; edges of the boundary and of
    lines are split where they are in the way. All vertices stay, and so do boundary and lines but
    for rounding. New points lie on the surface of the TIN: on boundary and lines at the elevation
    there, inside at the interpolated one. The result is a function of the TIN's surface, whatever
    its numbering.

    Parameters
    ----------
    tin : TIN
        With its lines, boundary and holes. One that is not Delaunay is made so,
        which ``report.notes`` tell.
    min_angle : float
        Least angle of a triangle, degrees in the plane, from 0 (any) to 33. It is reached for sure
        up to 20.7 degrees if no lines meet under less than 60; beyond, nearly always up to 30.
        Where lines or the boundary meet under a small angle, triangles between them stay below it:
        the one at the meeting, and those across, whose shortest edge joins the two.
    max_area : float, optional
        Largest area of a triangle in the plane, CRS units squared.
    max_edge : float, optional
        Longest edge in the plane, CRS units.
    max_vertices : int
        So many are allowed.
    threads : int, optional
        For the arrays of the mesh, once its points are found.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as points are found and their TIN is built.
        How many there will be is estimated. What it raises ends the call.

    Returns
    -------
    TIN
        Vertices of ``tin`` first, as they were; then those on boundary and lines and those inside.
        ``lines`` are those of ``tin`` with more vertices, and the boundary as ``boundary`` if there
        was none. ``report.unmended`` lists the triangles that miss what was asked for, and why;
        ``report.notes`` tells how many points came, and counts those triangles.

    Raises
    ------
    OptionError
        For a least angle above 33 degrees, or other limits that are not positive numbers.
    PointsError
        For a mesh of more than ``max_vertices``, or a TIN that overlaps itself.

    Notes
    -----
    About three microseconds a point. Edges are never made shorter than a 64th of the shortest one
    at the beginning, or of the size asked for, or than a thousand times the rounding of
    coordinates; where only this would help, a triangle stays as it is.

    References
    ----------
    .. [1] J. Ruppert, A Delaunay refinement algorithm for quality 2-dimensional mesh generation,
       Journal of Algorithms 18 (1995), doi:10.1006/jagm.1995.1021.
    .. [2] L. P. Chew, Guaranteed-quality mesh generation for curved surfaces, 9th Annual Symposium
       on Computational Geometry (1993), doi:10.1145/160985.161150.
    .. [3] A. Ungor, Off-centers: a new type of Steiner points for computing size-optimal
       quality-guaranteed Delaunay triangulations, LATIN 2004, doi:10.1007/978-3-540-24698-5_19.
    .. [4] G. L. Miller, S. E. Pav, N. J. Walkington, When and why Ruppert's algorithm works, 12th
       International Meshing Roundtable (2003): what is left at small angles.

    Examples
    --------
    >>> from tinsmith.tin import triangulate
    >>> tin = triangulate([[0, 0, 0], [100, 0, 0], [100, 10, 1], [0, 10, 1]])
    >>> refine(tin, max_area=10.0)
    <TIN: 104 vertices, 158 triangles, z 0 to 1, crs unknown>
    """
    require_tin(tin)
    done = Progress(progress)
    if not is_finite_number(min_angle) or not 0.0 <= min_angle <= LARGEST_MIN_ANGLE:
        raise OptionError(
            "min_angle",
            min_angle,
            f"from 0 to {LARGEST_MIN_ANGLE:g} degrees, for no mesh of larger angles can be "
            "promised",
        )
    require_positive("max_area", max_area, what="an area")
    require_positive("max_edge", max_edge)
    if not is_whole_number(max_vertices) or not 0 < max_vertices <= _kernel.MOST_POINTS:
        allowed = f"a whole number from 1 to {_kernel.MOST_POINTS:,}"
        raise OptionError("max_vertices", max_vertices, allowed)
    # refuse at once what cannot be: a vertex has two triangles, but for those on the boundary
    least = 0.0 if max_area is None else tin.triangulation.area / max_area / 2.0
    if max(least, len(tin.points)) > max_vertices:
        raise PointsError(_explain_too_many(max_vertices))
    goal = _Goal(
        math.radians(min_angle),
        math.inf if max_area is None else float(max_area),
        math.inf if max_edge is None else float(max_edge),
        max_vertices,
    )
    kept_whole = np.empty((0, 2), np.int32)
    for attempt in range(_MOST_ATTEMPTS):
        workers = thread_count(threads, len(tin.points))
        found = _find_points(tin, goal, kept_whole, workers, done.stage(0.0, _FOUND))
        done(_FOUND)
        workers = thread_count(threads, len(tin.points) + len(found.xy))
        refined = _build(tin, found, workers, done.stage(_FOUND, 1.0))
        if isinstance(refined, TIN):
            done.end()
            return refined
        in_the_way = refined if attempt < _MOST_ATTEMPTS - 2 else None
        kept_whole = _add_kept_whole(tin, kept_whole, in_the_way)
    raise PointsError(
        "The TIN cannot be refined: parts of its boundary or of its lines lie nearer to each other "
        "than coordinates are rounded, or overlap."
    )


# ----------------------------------------------------------------------- options


def _explain_too_many(max_vertices: int) -> str:
    return (
        f"The mesh would have more than {max_vertices:,} vertices: allow a larger `max_area` or "
        "`max_edge`, a smaller `min_angle`, or more by `max_vertices`."
    )


# ----------------------------------------------------------------------- elevations


class _Splits(NamedTuple):
    """Segments that were split, in order; a half can be split only later."""

    ends: Int32Array
    """(s, 2), vertices."""
    middle: Int32Array
    """(s,)."""
    middle_of: dict[tuple[int, int], int]
    """The same, by pairs of ends, the smaller one first."""

    @classmethod
    def of(cls, triples: Int32Array) -> _Splits:
        table = {_make_key(a, b): middle for a, b, middle in triples.tolist()}
        return cls(triples[:, :2], triples[:, 2], table)

    def segments_of(self, vertices: Int64Array) -> set[tuple[int, int]]:
        """Return the segments, as they were before any split, that vertices were put on."""
        segment_of: dict[int, tuple[int, int]] = {}
        for (a, b), middle in zip(self.ends.tolist(), self.middle.tolist(), strict=True):
            # An end that was put there itself was put on the same segment.
            whole = segment_of.get(a) or segment_of.get(b) or _make_key(a, b)
            segment_of[middle] = whole
        return {segment_of[v] for v in vertices.tolist() if v in segment_of}

    def along(self, chain: list[int]) -> list[int]:
        """Return a chain with all vertices that came between its own."""
        walked = [chain[0]]
        for end in chain[1:]:
            ahead = [end]
            while ahead:
                between = self.middle_of.get(_make_key(walked[-1], ahead[-1]))
                if between is None:
                    walked.append(ahead.pop())
                else:
                    ahead.append(between)
        return walked


def _make_key(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _lift(tin: TIN, xy: Float64Array, splits: _Splits) -> Float64Array:
    """Return the new points with elevations: on segments from their ends, else from the surface."""
    n = len(tin.points)
    is_on_segment = np.zeros(len(xy), np.bool_)
    is_on_segment[splits.middle - n] = True
    points = np.concatenate([tin.points, np.column_stack([xy, np.full(len(xy), np.nan)])])
    points[n:][~is_on_segment, 2] = _interpolate(tin, xy[~is_on_segment])
    z = points[:, 2].tolist()
    share = _measure_shares(points, splits).tolist()
    for (a, b), middle, part in zip(
        splits.ends.tolist(), splits.middle.tolist(), share, strict=True
    ):
        z[middle] = z[a] + part * (z[b] - z[a])
    points[:, 2] = z
    lifted: Float64Array = points[n:]
    return lifted


def _measure_shares(points: Float64Array, splits: _Splits) -> Float64Array:
    start, end = points[splits.ends[:, 0], :2], points[splits.ends[:, 1], :2]
    whole, part = end - start, points[splits.middle, :2] - start
    shares: Float64Array = (whole * part).sum(axis=1) / (whole * whole).sum(axis=1)
    return shares


def _interpolate(tin: TIN, xy: Float64Array) -> Float64Array:
    """Return elevations; beside the boundary by a rounding that of the nearest edge there."""
    z = tin.interpolate(xy)
    for row in np.flatnonzero(np.isnan(z)).tolist():
        point = xy[row]
        start, end = (tin.points[ends] for ends in _find_boundary_ends(tin))
        whole = end[:, :2] - start[:, :2]
        share = ((point - start[:, :2]) * whole).sum(axis=1) / (whole * whole).sum(axis=1)
        foot = start + np.clip(share, 0.0, 1.0)[:, None] * (end - start)
        z[row] = float(foot[np.hypot(*(foot[:, :2] - point).T).argmin(), 2])
    return z


def _find_boundary_ends(tin: TIN) -> tuple[Int64Array, Int64Array]:
    triangle, corner = np.nonzero(tin.neighbors == topology.NO_NEIGHBOR)
    return topology.ends(tin.triangles, triangle, corner)


# ------------------------------------------------------------------------- points


class _Goal(NamedTuple):
    """What triangles must be, as the core takes it; an angle in radians."""

    least_angle: float
    largest_area: float
    longest_edge: float
    most_vertices: int


class _Found(NamedTuple):
    """What the core found: new points, (k, 2), and where they split segments.

    ``left`` has a row for each triangle that misses the goal, (l, 4): its corners, and why.
    """

    xy: Float64Array
    splits: _Splits
    left: Int32Array
    n_triangles: int
    mesh: tuple[Int32Array, Int32Array, BoolArray] | None
    """Triangles, neighbours and fixed edges, unless the boundary must be looked at first."""


def _find_points(
    tin: TIN, goal: _Goal, kept_whole: Int32Array, threads: int, progress: Tell | None
) -> _Found:
    fixed = tin.constrained | (tin.neighbors == topology.NO_NEIGHBOR)
    found = _kernel.refine(
        tin.points, tin.triangles, tin.neighbors, fixed, kept_whole, *goal, threads, progress
    )
    if found.is_too_many:
        raise PointsError(_explain_too_many(goal.most_vertices))
    mesh = (found.triangles, found.neighbors, found.constrained) if found.has_surface else None
    splits = _Splits.of(found.splits)
    return _Found(found.points, splits, found.misses, found.triangle_count, mesh)


# ------------------------------------------------------------------------- result


def _build(
    tin: TIN, found: _Found, threads: int, progress: Tell | None
) -> TIN | set[tuple[int, int]]:
    """Make the TIN of all points, with the boundary and the lines as they were split.

    It is the one that the points and lines have when they are triangulated.
    """
    done = Progress(progress)
    points = np.concatenate([tin.points, _lift(tin, found.xy, found.splits)])
    done(0.2)
    along = found.splits.along
    rings = [along(ring) for ring in list_rings(tin)]
    pslg = gather_pslg(tin, points, along, rings, names_boundary=True)
    if found.mesh is not None:
        surface = Triangulation(points, *found.mesh)
        number_of = np.arange(len(points), dtype=np.int32)
    else:
        made = _triangulate(pslg, found, threads, done.stage(0.2, 0.9))
        if isinstance(made, set):
            return made
        surface, number_of = made
    done(0.9)
    unmended = _find_unmended(surface.points, surface.triangles, found.left)
    added = (
        f"Refinement added {counted(len(found.xy), 'point')}, "
        f"{len(found.splits.middle):,} of them on the boundary and on lines."
    )
    version = Version(
        triangulation=surface,
        vertex_of=tin.vertex_of,
        report=replace(
            tin.report,
            n_vertices=len(surface.points),
            n_triangles=len(surface.triangles),
            notes=(*tin.report.notes, added, *describe_flips(tin), *unmended.sentences()),
            unmended=unmended,
        ),
        lines=find_lines_in(pslg.polylines, pslg.constraints, number_of, surface, is_whole=False),
    )
    return tin._with_version(version)


def _triangulate(
    pslg: Pslg, found: _Found, threads: int, progress: Tell | None
) -> tuple[Triangulation, Int32Array] | set[tuple[int, int]]:
    """Triangulate all points, with the segments as they were split.

    The core sees the surface only. Vertices on the boundary are rounded, and beyond it, across a
    gap as narrow as that, there can be another part of the boundary: then it returns the segments
    of the TIN that are in the way of each other when they are split.
    """
    done, points = Progress(progress), pslg.points
    mesh, kept_row = _kernel.triangulate_mesh(
        points, threads=threads, progress=done.stage(0.0, 0.6)
    )
    if kept_row is not None:
        return found.splits.segments_of(np.flatnonzero(kept_row != np.arange(len(points))))
    in_the_way = _force(mesh, pslg, found.splits)
    if in_the_way is not None:
        return in_the_way
    done(0.7)
    surface, number_of = pslg.surface(Triangulation(points, *mesh.arrays(threads)))
    if len(surface.points) != len(points) or len(surface.triangles) != found.n_triangles:
        return set()
    return surface, number_of


def _force(mesh: _kernel.Mesh, pslg: Pslg, splits: _Splits) -> set[tuple[int, int]] | None:
    """Fix all segments of lines; return the segments in the way of that, None if there are none."""
    segments = pslg.polylines.segments()
    passed, blocked = mesh.force(segments)
    if not (len(passed) or len(blocked)):
        return None
    crossed = mesh.crossed(np.ascontiguousarray(segments[blocked]), only_fixed=True).reshape(-1, 3)
    through = passed.reshape(-1, 2)
    ends = np.concatenate([segments[blocked], crossed[:, 1:], segments[through[:, 0]]])
    return splits.segments_of(np.concatenate([ends.ravel(), through[:, 1]]))


def _add_kept_whole(
    tin: TIN, kept_whole: Int32Array, in_the_way: set[tuple[int, int]] | None
) -> Int32Array:
    """Add the segments in the way; or the whole boundary, if no further ones are known."""
    news = (in_the_way or set()) - set(map(tuple, kept_whole.tolist()))
    if news:
        return np.concatenate([kept_whole, np.array(sorted(news), np.int32)])
    return np.sort(np.stack(_find_boundary_ends(tin), axis=1), axis=1).astype(np.int32)


def _find_unmended(points: Float64Array, triangles: Int32Array, left: Int32Array) -> Unmended:
    """Find the triangles that the core left, whatever the order of their corners.

    ``left`` has the corners of each, and why, (k, 4).
    """
    if len(left) == 0:
        return Unmended.none()
    why_of = {tuple(sorted(row[:3])): row[3] for row in left.tolist()}
    is_near = np.zeros(int(triangles.max()) + 1, np.bool_)
    is_near[left[:, :3]] = True
    near = np.flatnonzero(is_near[triangles].all(axis=1))
    why = [why_of.get(tuple(row), -1) for row in np.sort(triangles[near], axis=1).tolist()]
    codes = np.array(why, np.int8)
    found = near[codes >= 0]
    angles = measure_smallest_angles(points[triangles[found], :2])
    return Unmended(found.astype(np.int32), codes[codes >= 0], angles)
