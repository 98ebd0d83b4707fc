"""Simplify: the TIN of few of a TIN's vertices, with the others within a tolerance of it.

Which vertices are left is decided by the core; here those are found that must be, and the TIN of
what is left is built and measured against every vertex.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import is_finite_number, is_whole_number, require_tin
from ...base.errors import LinesError, OptionError, PointsError, choice
from ...base.policies import SimplificationHold, SimplificationSide
from ...base.progress import Progress
from .. import _kernel, topology
from ..building import Version
from ..constraints import find_lines_in
from ..editing import account_for_fewer_vertices
from ..report import Simplification
from ..surface import TIN
from ..triangulation import Triangulation
from ..validation import as_vertex_array, thread_count
from .flips import count_flips, describe_flips
from .surface_difference import SurfaceMeter
from .surface_pslg import gather_pslg, list_rings

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ..constraints import Lines

_ROUNDING_BITS = 46
"""Elevations that differ in digits beyond these count as equal: 1e-11 m at 1000 m."""
_MOST_ROUNDINGS = 2.0 ** (_ROUNDING_BITS + 2)
"""So many roundings no difference of two elevations reaches."""


class Goal(NamedTuple):
    """What is asked for: a tolerance, in the unit of elevations, or a number of vertices.

    ``hold`` tells where the tolerance is held; None for the default, and with a number. ``side`` is
    where the surface may lie.
    """

    tolerance: float | None
    points: int | None
    hold: SimplificationHold | None = None
    side: SimplificationSide = "both"

    @classmethod
    def of(cls, tolerance: Any, points: Any, hold: Any = None, side: Any = "both") -> Goal:
        """Return what is asked for."""
        choice("side", side, SimplificationSide)
        if hold is not None:
            choice("hold", hold, SimplificationHold)
        if (tolerance is None) == (points is None):
            given = "both" if points is not None else "neither"
            allowed = "given, or points; the one or the other, not both"
            raise OptionError("tolerance", f"({given})" if points is None else tolerance, allowed)
        if points is not None:
            if not is_whole_number(points) or points < 3:
                raise OptionError("points", points, "a whole number from 3 on")
            if hold is not None:
                raise OptionError("hold", hold, "None where a number of points is given")
            if side != "both":
                raise OptionError("side", side, "'both' where a number of points is given")
            return cls(None, int(points))
        if not (is_finite_number(tolerance) and tolerance >= 0):
            raise OptionError("tolerance", tolerance, "an elevation >= 0 in the unit of elevations")
        return cls(float(tolerance), None, hold, side)

    def require_count(self, n_required: int, n_points: int) -> None:
        """Refuse a number of vertices that cannot be."""
        if self.points is not None and not n_required <= self.points <= n_points:
            raise OptionError(
                "points",
                self.points,
                f"from {n_required:,}, for so many lie on lines, at corners of the boundary or are "
                f"to be kept, to {n_points:,}, for there are no more",
            )

    def limits(self, rounding: float) -> tuple[float, int]:
        """Return tolerance and most vertices as the core takes them."""
        if self.points is not None:
            return -1.0, self.points
        return self.limit(rounding), _kernel.MOST_POINTS

    def weigh(self, rounding: float) -> tuple[float, float]:
        """Return factors of what points are above and below the surface.

        On the side where none may be, a rounding counts as the limit.
        """
        factor = self.limit(rounding) / rounding if rounding else 1.0
        return (
            factor if self.side == "above" else 1.0,
            factor if self.side == "below" else 1.0,
        )

    def judge(self, heights: Float64Array, rounding: float) -> Float64Array:
        """Return what heights of points above a surface count, below it they are negative."""
        above, below = self.weigh(rounding)
        judged: Float64Array = np.where(heights > 0.0, above * heights, -below * heights)
        return judged

    def limit(self, rounding: float) -> float:
        """Return the largest difference that is within the tolerance, as doubles compute it.

        One that is equal to the tolerance is within it, whichever way it is rounded.
        """
        if self.tolerance is None:
            return np.inf
        most = np.inf if self.side == "both" else _MOST_ROUNDINGS * rounding
        return min(self.tolerance, most) + rounding

    def drop_rounding(self, error: float) -> float:
        """Return an error as it is told: one beyond the tolerance by rounding is equal to it."""
        return error if self.tolerance is None else min(error, self.tolerance)


class Errors(NamedTuple):
    """How far points are from a surface, in elevation."""

    far: Int64Array
    """(k,), rows of the points to be added: those beyond the tolerance."""
    largest: float
    rms: float
    surface: float | None = None
    """The largest difference anywhere between the two surfaces, if it was measured."""
    is_done: bool = True
    """Whether nothing is to be added."""


def find_rounding(z: Float64Array) -> float:
    """Return by how much elevations may differ because of their rounding."""
    return float(np.abs(z).max()) * 2.0**-_ROUNDING_BITS


def simplify_tin(
    tin: TIN, goal: Goal, keep: ArrayLike, threads: int | None, *, progress: Tell | None = None
) -> TIN:
    """Return the TIN of few vertices; :func:`tinsmith.simplify` tells what is promised."""
    done = Progress(progress)
    require_tin(tin)
    # which vertices stay: those of lines, corners of the boundary, and those given
    is_required = np.zeros(len(tin.points), np.bool_)
    is_required[as_vertex_array(keep, len(tin.points)).ravel()] = True
    is_required[tin.lines.vertices] = True
    is_inner = tin.constrained & (tin.neighbors > topology.NO_NEIGHBOR)
    is_required[topology.edges_at(tin.triangles, is_inner)] = True
    visits = np.zeros(len(tin.points), np.int64)
    for ring in tin.rings:
        np.add.at(visits, ring, 1)
        is_required[ring[~are_straight(tin.points[ring])]] = True
    is_required[visits > 1] = True
    goal.require_count(int(is_required.sum()), len(tin.points))
    skeleton = _Part(tin, np.flatnonzero(is_required), thread_count(threads, len(tin.points)))
    done(0.05)
    rows, needless = _find_rows(tin, skeleton, goal)
    done(0.75)
    rounding = find_rounding(tin.points[:, 2])

    def judge(heights: Float64Array) -> Float64Array:
        return goal.judge(heights, rounding)

    meter = SurfaceMeter(tin, judge) if _find_hold(tin, goal) == "surface" else None
    part, errors = insert_until_near(
        goal,
        rounding,
        rows,
        build=lambda rows: _Part(tin, rows, skeleton.threads, meter, judge),
        measure=lambda part, limit: part.measure(limit),
        progress=done,
    )
    found = Simplification(
        points=len(tin.points),
        vertices=len(part.rows),
        required=int(is_required.sum()),
        needless=needless,
        tolerance=goal.tolerance,
        largest_error=errors.largest,
        rms_error=errors.rms,
        hold=None if goal.tolerance is None else "points" if meter is None else "surface",
        surface_error=errors.surface,
        forced_edges=0 if meter is None else len(meter.forced),
        side=goal.side,
    )
    simple: TIN = part.make_tin(found)
    return simple


def _find_hold(tin: TIN, goal: Goal) -> str:
    """Return where the difference is held, or measured: between points where edges are fixed.

    There a surface is more than its points: breaklines, and given triangles that are not Delaunay.
    """
    if goal.hold is not None:
        return goal.hold
    has_lines = bool((tin.constrained & (tin.neighbors > topology.NO_NEIGHBOR)).any())
    return "surface" if has_lines or count_flips(tin) else "points"


def insert_until_near(
    goal: Goal,
    rounding: float,
    rows: Int64Array,
    *,
    build: Callable[[Int64Array], Any],
    measure: Callable[[Any, float], Errors],
    progress: Tell,
) -> tuple[Any, Errors]:
    """Build the surface of some rows; add those that are beyond the tolerance, until none is.

    The core has left none but where it rounds otherwise than the surface that is built, and between
    the points, where it does not measure.
    """
    limit = goal.limit(rounding)
    while True:
        built = build(rows)
        progress(0.9)
        errors = measure(built, limit)
        if len(errors.far) == 0 and errors.is_done:
            surface = None if errors.surface is None else goal.drop_rounding(errors.surface)
            return built, errors._replace(
                largest=goal.drop_rounding(errors.largest), surface=surface
            )
        rows = np.union1d(rows, errors.far)


# ------------------------------------------------------------------ what must be left


def are_straight(ring: Float64Array) -> BoolArray:
    """Tell which corners of a ring lie on the line between the two beside them."""
    xy = np.ascontiguousarray(ring[:, :2])
    before, after = np.roll(xy, 1, axis=0), np.roll(xy, -1, axis=0)
    return np.asarray(_kernel.orientation(before, xy, after) == 0)


def _find_rows(tin: TIN, skeleton: _Part, goal: Goal) -> tuple[Int64Array, int]:
    """Return the vertices that the core leaves, and how many it removed again."""
    surface = skeleton.surface
    is_used = topology.mark_corners(tin.triangles, len(tin.points))
    is_used[skeleton.rows] = True
    used = np.flatnonzero(is_used)
    tolerance, most = goal.limits(find_rounding(tin.points[:, 2]))
    points = np.ascontiguousarray(tin.points[used])
    locator = _kernel.Locator(surface.points, surface.triangles, surface.neighbors)
    rows, needless = _kernel.simplify(
        points,
        np.searchsorted(used, skeleton.rows).astype(np.int32),
        locator.locate(np.ascontiguousarray(points[:, :2])),
        surface.points,
        surface.triangles,
        surface.neighbors,
        surface.constrained | (surface.neighbors == topology.NO_NEIGHBOR),
        tolerance,
        most,
        goal.points is None,
        *goal.weigh(find_rounding(tin.points[:, 2])),
    )
    return used[rows], needless


# ------------------------------------------------------------------------- the result


class _Part:
    """The surface of a TIN built of some of its vertices, with its lines and its boundary."""

    def __init__(
        self,
        tin: TIN,
        rows: Int64Array,
        threads: int,
        meter: SurfaceMeter | None = None,
        judge: Callable[[Float64Array], Float64Array] = np.abs,
    ) -> None:
        self.tin, self.rows, self.threads, self._meter = tin, rows, threads, meter
        self._judge = judge
        self._number_of = np.full(len(tin.points) + 1, -1, np.int32)  # and of no vertex
        self._number_of[rows] = np.arange(len(rows), dtype=np.int32)
        points = np.ascontiguousarray(tin.points[rows])
        rings = [self._follow_ring(ring) for ring in list_rings(tin)]
        self._pslg = gather_pslg(
            tin,
            points,
            self._follow,
            rings,
            names_boundary=False,
            more_edges=None if meter is None else meter.forced,
        )
        self.surface, self._order = self._build(points)

    def _follow(self, chain: list[int]) -> list[int]:
        numbers = self._number_of[chain]
        followed: list[int] = numbers[numbers >= 0].tolist()
        return followed

    def _follow_ring(self, ring: list[int]) -> list[int]:
        followed = self._follow(ring[:-1])
        return [*followed, followed[0]]

    def _build(self, points: Float64Array) -> tuple[Triangulation, Int32Array]:
        mesh, kept_row = _kernel.triangulate_mesh(points, threads=self.threads)
        if kept_row is not None:
            raise _describe_overlap()
        passed, blocked = mesh.force(self._pslg.polylines.segments())
        if len(passed) or len(blocked):
            raise _describe_overlap()
        try:
            hull = Triangulation(points, *mesh.arrays(self.threads))
            surface, order = self._pslg.surface(hull)
        except LinesError:
            raise _describe_overlap() from None
        if len(surface.points) != len(points):
            raise _describe_overlap()
        return surface, order

    def measure(self, limit: float) -> Errors:
        """Measure all vertices of the TIN that its triangles use."""
        tin = self.tin
        used = np.flatnonzero(topology.mark_corners(tin.triangles, len(tin.points)))
        heights = tin.points[used, 2] - self._make().interpolate(tin.points[used, :2])
        error = np.abs(heights)
        is_far = ~(self._judge(heights) <= limit)
        near = error[~is_far] if is_far.any() else error
        errors = Errors(used[is_far], float(near.max()), float(np.sqrt(np.mean(near**2))))
        return errors if self._meter is None else self._measure_between(self._meter, errors, limit)

    def _measure_between(self, meter: SurfaceMeter, errors: Errors, limit: float) -> Errors:
        """Add what is beyond the tolerance where edges of the two surfaces cross."""
        surface, n_forced = self.surface, len(meter.forced)
        across = np.arange(len(surface.triangles), dtype=np.int32)[:, None]
        edge = np.nonzero(surface.neighbors > across)  # each inside once
        ends = self.rows[np.stack(topology.ends(surface.triangles, *edge), axis=1)]
        # which vertices of the TIN are left; and at the end that none is to be added
        is_left = self._number_of >= 0
        is_left[-1] = True
        beyond = meter.measure(ends, is_left, limit)
        return errors._replace(
            far=np.union1d(errors.far, beyond.rows),
            surface=max(errors.largest, beyond.largest),
            is_done=len(meter.forced) == n_forced,
        )

    def _make(self) -> TIN:
        return TIN.from_triangles(self.surface.points, self.surface.triangles)

    def make_tin(self, found: Simplification) -> TIN:
        """Return the TIN with its lines, and with an account of all rows."""
        tin, surface = self.tin, self.surface
        vertex_of = self._number_of[tin.vertex_of]
        version = Version(
            triangulation=replace(surface, constrained=self._find_constrained()),
            vertex_of=vertex_of,
            report=self._report(found, vertex_of),
            lines=self._find_lines(),
        )
        return tin._with_version(version)

    def _find_lines(self) -> Lines:
        pslg = self._pslg
        return find_lines_in(
            pslg.polylines, pslg.constraints, self._order, self.surface, is_whole=False
        )

    def _find_constrained(self) -> BoolArray:
        """Return the flags of edges; those of the boundary as they were."""
        tin, surface = self.tin, self.surface
        is_flagged = np.zeros(len(tin.points), np.bool_)
        is_outer = tin.neighbors == topology.NO_NEIGHBOR
        is_flagged[topology.edges_at(tin.triangles, is_outer & tin.constrained)] = True
        edge = np.nonzero(surface.neighbors == topology.NO_NEIGHBOR)
        start, end = topology.ends(surface.triangles, *edge)
        constrained = surface.constrained.copy()
        constrained[edge] = is_flagged[self.rows[start]] & is_flagged[self.rows[end]]
        return constrained

    def _report(self, found: Simplification, vertex_of: Int32Array) -> Any:
        report = self.tin.report
        return account_for_fewer_vertices(
            report,
            self.surface,
            self._number_of,
            vertex_of,
            "simplified away",
            notes=(*report.notes, found.sentence(), *describe_flips(self.tin)),
            simplification=found,
        )


def _describe_overlap() -> PointsError:
    return PointsError(
        "The TIN cannot be simplified: parts of its boundary or of its lines overlap, or lie "
        "nearer to each other than coordinates are rounded."
    )


def simplify_convex(
    tin: TIN, required: Int64Array, barred: BoolArray, tolerance: float
) -> tuple[Int64Array, Int32Array, float]:
    """Return few vertices of a TIN that is convex but for rounding, and their triangulation.

    The ``required`` ones stay, ascending, and so do corners of the boundary. Those that are
    ``barred``, (n,), on the boundary, are not to be among them: the required ones hold them within
    the tolerance, in which all vertices are held, and what lies between them as far as vertices
    can. Returns the rows of vertices, ascending, their Delaunay triangulation by their places among
    the rows, (m, 3), and the largest vertical difference of the two surfaces anywhere.
    """
    corners = [ring[~are_straight(tin.points[ring])] for ring in tin.rings]
    required = np.unique(np.concatenate([required, *corners]))
    points, rounding = np.ascontiguousarray(tin.points), find_rounding(tin.points[:, 2])
    first = _kernel.grow(points[required], threads=1)
    base = np.ascontiguousarray(points[required])
    locator = _kernel.Locator(base, first.triangles, first.neighbors)
    found, _ = _kernel.simplify(
        points,
        required.astype(np.int32),
        locator.locate(np.ascontiguousarray(points[:, :2])),
        base,
        first.triangles,
        first.neighbors,
        first.neighbors == topology.NO_NEIGHBOR,
        tolerance + rounding,
        _kernel.MOST_POINTS,
        True,
    )
    meter, is_barred = SurfaceMeter(tin), np.append(barred, True)
    rows: Int64Array = np.sort(found).astype(np.int64)
    while True:
        made = _kernel.grow(np.ascontiguousarray(points[rows]), threads=1)
        rough = TIN.from_triangles(points[rows], made.triangles)
        error = np.abs(rough.interpolate(points[:, :2]) - points[:, 2])
        edges = rows[topology.edges(made.triangles, made.neighbors)]
        is_left = is_barred.copy()
        is_left[rows] = True
        beyond = meter.measure(edges, is_left, tolerance + rounding)
        far = np.flatnonzero(~(error <= tolerance + rounding))
        more = np.union1d(far, beyond.rows)
        if not len(more):
            return rows, made.triangles, max(float(error.max()), beyond.largest) + rounding
        rows = np.union1d(rows, more)
