"""Compare: the paper's algorithms beside the exact kernel, on the same points."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ...base.checks import require_count
from ...base.errors import PointsError
from ...base.sentences import counted
from .. import _kernel
from ..building import Survey
from ..construction import triangulate
from ..meshing import measure_smallest_angles
from ..validation import as_points
from .cover import cover
from .faults import find_overlapping, find_violating
from .growth import Network, improved, original

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..surface import TIN

MOST_POINTS = 2_500
"""Points compared at most, unless the caller allows more: the paper's algorithms are quadratic."""

ANGLE_BINS = (0, 10, 20, 30, 40, 50, 60)
"""Limits of the classes of minimum angles, degrees; equilateral triangles are in the last."""

_KERNEL_RUNS = 5

_MOST_TRIANGLES = 4
"""For each point; every full triangulation has fewer than two. What grows on is only overlap."""

_ALGORITHMS: dict[str, Callable[..., Network]] = {
    "original": original,
    "improved": improved,
    "improved (open)": partial(improved, empty="open"),
    "improved (ties)": partial(improved, distance="ties"),
}

Result = TypeVar("Result")


@dataclass(frozen=True, eq=False, kw_only=True)
class Outcome:
    """What one algorithm made of the points, what it cost, and what is wrong with it.

    Attributes
    ----------
    name : str
        ``"original"``, ``"improved"``, ``"improved (open)"``, ``"improved (ties)"`` or ``"exact"``.
    triangles : (m, 3) int32 array
        Counter-clockwise, numbers of ``Comparison.points``.
    unextended : (k, 2) int32 array
        Edges used by one triangle only, although points lie beyond them.
    is_stopped : bool
        Whether the growth was stopped at four triangles a point, twice those of a triangulation.
    seconds : float
        Time of one run; of the exact kernel the best of five.
    memory : int
        Bytes that Python and numpy had in use at most, beyond those before the run. Of the exact
        kernel this is what it hands over: its own working memory is not seen.
    candidates, candidates_without_removal : int, int or None
        Points looked at in all searches; and had no used-up point been deleted. The exact kernel
        has no such mode.
    tests : int
        Comparisons of a point with a circle.
    violating : (m,) bool array
        Whether a point lies strictly inside the circle of the triangle; exact.
    overlapping : (m,) bool array
        Whether the triangle shares area with another; exact.
    overlap, gap : float
        Areas of the places covered more than once, and of those in the hull not covered, CRS units
        squared.
    angles : (m,) float64 array
        Smallest angle of each triangle, degrees.

    Examples
    --------
    >>> import tinsmith as ts
    >>> found = ts.compare([[0, 0, 5], [4, 0, 6], [0, 3, 8], [1, 1, 7]])
    >>> found.outcomes[0].triangles.shape, found.outcomes[0].angle_counts.tolist()
    ((3, 3), [0, 2, 1, 0, 0, 0])
    """

    name: str
    triangles: Int32Array
    unextended: Int32Array
    is_stopped: bool
    seconds: float
    memory: int
    candidates: int
    candidates_without_removal: int | None
    tests: int
    violating: BoolArray
    overlapping: BoolArray
    overlap: float
    gap: float
    angles: Float64Array

    @property
    def angle_counts(self) -> Int64Array:
        """Triangles in each class of minimum angles, (6,) array; see ``ANGLE_BINS``."""
        # An equilateral triangle's angles may be rounded to a little more than 60 degrees.
        return np.histogram(np.minimum(self.angles, ANGLE_BINS[-1]), ANGLE_BINS)[0]

    def to_dict(self) -> dict[str, Any]:
        """Return everything but the triangles as plain values.

        Examples
        --------
        >>> import tinsmith as ts
        >>> found = ts.compare([[0, 0, 5], [4, 0, 6], [0, 3, 8], [1, 1, 7]])
        >>> found.outcomes[0].to_dict()["triangles"]
        3
        """
        count = len(self.triangles)
        without = self.candidates_without_removal
        return {
            "name": self.name,
            "triangles": count,
            "unextended": len(self.unextended),
            "is_stopped": self.is_stopped,
            "seconds": self.seconds,
            "memory": self.memory,
            "candidates_per_triangle": self.candidates / count,
            "candidates_per_triangle_without_removal": None if without is None else without / count,
            "tests": self.tests,
            "violating": int(self.violating.sum()),
            "overlapping": int(self.overlapping.sum()),
            "overlap": self.overlap,
            "gap": self.gap,
            "minimum_angle": {
                "smallest": float(self.angles.min()),
                "median": float(np.median(self.angles)),
                "mean": float(self.angles.mean()),
                "counts": self.angle_counts.tolist(),
            },
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Comparison:
    """The algorithms' outcomes on the same points.

    Attributes
    ----------
    points : (n, 3) float64 array
        The distinct places, in the order given.
    hull : (h,) int32 array
        Points on the boundary of the convex hull, counter-clockwise, those within its edges too.
    area : float
        Area of the hull, CRS units squared.
    outcomes : tuple of Outcome
        Original, improved in three readings, exact.

    Examples
    --------
    >>> import tinsmith as ts
    >>> found = ts.compare([[0, 0, 5], [4, 0, 6], [0, 3, 8], [1, 1, 7]])
    >>> found.expected, found.outcomes[0].name
    (3, 'original')
    """

    points: Float64Array
    hull: Int32Array
    area: float
    outcomes: tuple[Outcome, ...]

    @property
    def expected(self) -> int:
        """Triangles that every full triangulation of the points has: 2n - 2 - h."""
        return 2 * len(self.points) - 2 - len(self.hull)

    def to_dict(self) -> dict[str, Any]:
        """Return everything but points and triangles as plain values.

        Examples
        --------
        >>> import tinsmith as ts
        >>> found = ts.compare([[0, 0, 5], [4, 0, 6], [0, 3, 8], [1, 1, 7]])
        >>> found.to_dict()["points"]
        4
        """
        return {
            "points": len(self.points),
            "hull_points": len(self.hull),
            "area": self.area,
            "expected_triangles": self.expected,
            "angle_bins": list(ANGLE_BINS),
            "outcomes": [outcome.to_dict() for outcome in self.outcomes],
        }

    def __repr__(self) -> str:
        counts = ", ".join(f"{one.name} {len(one.triangles)}" for one in self.outcomes)
        due = counted(self.expected, "triangle")
        return f"<Comparison: {len(self.points):,} points, {due} due; {counts}>"


def compare(points: Survey | ArrayLike, *, limit: int = MOST_POINTS) -> Comparison:
    """Triangulate points by the paper's algorithms and by the exact kernel, and judge the results.

    Parameters
    ----------
    points : Survey or (n, 3) array
        Easting, northing, elevation, CRS units. Lines of a survey are not used.
    limit : int
        Rows that are compared at most.

    Returns
    -------
    Comparison

    Raises
    ------
    PointsError
        If there are more than ``limit`` points, if a coordinate is not finite or outside the exact
        range, or if there are no three points that are not collinear.
    OptionError
        If ``limit`` is no whole number above 0.

    Notes
    -----
    Time grows with the square of the number of points: 2,000 take about 10 to 25 seconds.

    See Also
    --------
    tinsmith.paper : the algorithms, and the choices where the paper is silent.

    Examples
    --------
    >>> found = compare([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    >>> [(one.name, len(one.triangles)) for one in found.outcomes]
    [('original', 4), ('improved', 4), ('improved (open)', 1), ('improved (ties)', 4), ('exact', 4)]
    """
    rows = as_points(points.points if isinstance(points, Survey) else points)
    require_count("limit", limit)
    if len(rows) > limit:
        raise PointsError(
            f"{len(rows):,} points are too many to compare, for the paper's algorithms take "
            f"quadratic time: at most {limit:,} are allowed."
        )
    tin = triangulate(rows)
    networks = [_evaluate(name, grow, rows, tin) for name, grow in _ALGORITHMS.items()]
    return Comparison(
        points=tin.points,
        hull=tin.hull,
        area=tin.area,
        outcomes=(*networks, _evaluate_exact(rows, tin)),
    )


def _evaluate(name: str, grow: Callable[..., Network], rows: Float64Array, tin: TIN) -> Outcome:
    run = partial(grow, rows, most_triangles=_MOST_TRIANGLES * len(tin.points))
    network, seconds = _time(run)
    return Outcome(
        name=name,
        triangles=network.triangles,
        unextended=network.unextended,
        is_stopped=network.is_stopped,
        seconds=seconds,
        memory=_measure_peak(run),
        candidates=network.candidates,
        candidates_without_removal=network.candidates_without_removal,
        tests=network.tests,
        **_find_faults(network.triangles, tin),
    )


def _evaluate_exact(rows: Float64Array, tin: TIN) -> Outcome:
    build = partial(triangulate, rows, threads=1)
    handed_over = (tin.points, tin.triangles, tin.neighbors, tin.constrained, tin.vertex_of)
    # The kernel compares every point that it looks at with the best circle so far.
    work = _kernel.count_work(rows)["candidates"]
    return Outcome(
        name="exact",
        triangles=tin.triangles,
        unextended=np.empty((0, 2), np.int32),
        is_stopped=False,
        seconds=min(_time(build)[1] for _ in range(_KERNEL_RUNS)),
        memory=sum(array.nbytes for array in handed_over),
        candidates=work,
        candidates_without_removal=None,
        tests=work,
        **_find_faults(tin.triangles, tin),
    )


def _find_faults(triangles: Int32Array, tin: TIN) -> dict[str, Any]:
    areas = cover(tin.points, triangles, tin.hull)
    return {
        "violating": find_violating(tin.points, triangles),
        "overlapping": find_overlapping(tin.points, triangles),
        "overlap": areas.overlap,
        "gap": areas.gap,
        "angles": measure_smallest_angles(tin.points[triangles, :2]),
    }


def _time(run: Callable[[], Result]) -> tuple[Result, float]:
    started = perf_counter()
    result = run()
    return result, perf_counter() - started


def _measure_peak(run: Callable[[], object]) -> int:
    """Return the bytes in use at most during a run, in a run of its own: tracing takes time."""
    was_tracing = tracemalloc.is_tracing()
    if not was_tracing:
        tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        tracemalloc.reset_peak()
        run()
        return tracemalloc.get_traced_memory()[1] - before
    finally:
        if not was_tracing:
            tracemalloc.stop()
