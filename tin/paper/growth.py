"""The paper's two algorithms of growth, exactly as written: for reference and comparison.

"Research on Algorithm of the Point Set in the Plane Based on Delaunay Triangulation" grows a
network of triangles: from a first triangle, each edge is extended to a third point. The *original*
algorithm takes the point that sees the edge under the largest angle; the *improved* one ("removing
circle") the point closest to the edge in the circle whose diameter the edge is. Steps, numbered as
there:

1. Take a triangle p1 p2 p3 of the network and an edge p1p2 of it.
2. If two triangles use the edge already, take the next one.
3. Search the point set M: leave out points 1) collinear with the edge, 2) on the side of p3,
   3) to which an edge from p1 or p2 is used twice. The improved algorithm looks in the circle.
4. Keep the point of the largest angle; the improved algorithm: the one closest to the edge.
5. Enter the triangle p1 p2 P into the list N.
6. Count the use of its edges, and delete from M the points all of whose edges are used twice.

Where the paper is silent or contradicts itself, this is what is done:

- *First triangle*: the westernmost point (of several the southernmost), its nearest neighbour, and
  the point left of them of the largest angle; if none is left of them, right of them.
- *Order of edges*: triangles in the order of their growth, each triangle's edges in turn.
- *Angle*: step 4 keeps "lower" degrees, condition 4 "as large as possible". The largest is kept.
- *Ties*: step 4 replaces the last-found point only by a better one, so the first in the list stays.
- *Circle*: points on it are in it. Within it the distances to the edge and to its line agree.
- *Distance*: read as deciding among the points in the circle, or only among those of an equal
  angle, as section 5 has it, see :func:`improved`.
- *Empty circle*: read in two ways, see :func:`improved`.
- *Overlap*: no step asks whether a new triangle covers an old one, so none does here.
- *Duplicates*: rows at one place count as one point, the first of them.

The signs of determinants and the comparisons of angles are exact, so that what goes wrong is the
paper's, not the arithmetic's; circles on edges and distances to them are in doubles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import as_flag, require_count
from ...base.errors import PointsError, choice
from ...base.policies import DistanceRule, EmptyCircleRule
from ...base.sentences import counted
from ..predicates import columns
from ..validation import as_points
from .lists import Edge, Lists, Triangle, sides
from .rules import (
    Rule,
    closest_in_circle,
    closest_in_circle_or_widest_angle,
    widest_angle,
    widest_angle_then_closest,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int32Array
    from ..predicates import Columns

EmptyCircle = EmptyCircleRule
Distance = DistanceRule

_RULES: dict[EmptyCircle, Rule] = {
    "angle": closest_in_circle_or_widest_angle,
    "open": closest_in_circle,
}


@dataclass(frozen=True, eq=False, kw_only=True)
class Network:
    """What one of the paper's algorithms made of points: maybe no triangulation at all.

    Attributes
    ----------
    points : (n, 3) float64 array
        Easting, northing, elevation of the distinct places, CRS units.
    triangles : (m, 3) int32 array
        In the order of growth, each counter-clockwise.
    unextended : (k, 2) int32 array
        Edges used by one triangle only, although points lie beyond them.
    is_stopped : bool
        Whether the growth stopped at the number of triangles allowed, with edges left untried.
    searches : int
        Searches for a third point.
    candidates : int
        Points looked at in all searches, the ends of the edge not counted.
    tests : int
        Comparisons of a point with a circle: the one on the edge, or that of the best so far.
    """

    points: Float64Array
    triangles: Int32Array
    unextended: Int32Array
    is_stopped: bool
    searches: int
    candidates: int
    tests: int

    @property
    def candidates_without_removal(self) -> int:
        """Points that the same searches would have looked at, had none been deleted."""
        return self.searches * (len(self.points) - 2)

    def __repr__(self) -> str:
        return (
            f"<Network: {len(self.points):,} points, {counted(len(self.triangles), 'triangle')}, "
            f"{counted(len(self.unextended), 'edge')} not extended>"
        )


def original(
    points: ArrayLike, *, removal: bool = True, most_triangles: int | None = None
) -> Network:
    """Triangulate by the paper's original algorithm: the largest angle wins.

    Parameters
    ----------
    points : (n, 3) array
        Easting, northing, elevation, CRS units.
    removal : bool
        Delete points from the search once all their edges are used twice (step 6).
    most_triangles : int, optional
        Stop once there are so many triangles; default never. Even so the growth ends: an edge is
        used at most twice, so there are at most n (n - 1) / 3 triangles.

    Returns
    -------
    Network
        With no four points on a circle this is the Delaunay triangulation; with ties triangles
        may overlap.

    Raises
    ------
    PointsError
        If a coordinate is not finite or outside the exact range, or if there are no three points
        that are not collinear.

    Notes
    -----
    Every search looks at every point left: time grows with the square of their number.

    Examples
    --------
    >>> original([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    <Network: 5 points, 4 triangles, 0 edges not extended>
    """
    return _grow(as_points(points), widest_angle, removal=removal, most=most_triangles)


def improved(
    points: ArrayLike,
    *,
    empty: EmptyCircle = "angle",
    distance: Distance = "circle",
    removal: bool = True,
    most_triangles: int | None = None,
) -> Network:
    """Triangulate by the paper's improved algorithm: the closest point in the circle wins.

    Or, in another reading, the closest of the points that see the edge under equal angles.

    Parameters
    ----------
    points : (n, 3) array
        Easting, northing, elevation, CRS units.
    empty : {"angle", "open"}
        An edge whose circle is empty is extended by the largest angle, or is left open. The paper
        adds the circle "during the Third in the original algorithm", which leaves the Fourth in
        force: "angle". Its own account of the improvement knows no other point than those
        searched "on the circle": "open".
    distance : {"circle", "ties"}
        Distance decides among all points in the circle; or "under the condition of an equal
        angle", as section 5 gives its reason, it only breaks the ties of the original algorithm,
        which are exact here: there is no circle then.
    removal : bool
        Delete points from the search once all their edges are used twice (step 6).
    most_triangles : int, optional
        As for :func:`original`. Overlaps breed overlaps: of 2,000 random points become 10,000 to
        150,000 triangles.

    Returns
    -------
    Network
        In general not Delaunay, with overlaps; with ``empty="open"`` most of the plane is left out.
        With ``distance="ties"`` as :func:`original` with no four points on a circle, so Delaunay.

    Raises
    ------
    PointsError
        As :func:`original`.
    OptionError
        If ``empty`` or ``distance`` is none of the allowed.

    Examples
    --------
    >>> improved([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    <Network: 5 points, 4 triangles, 0 edges not extended>
    """
    choice("empty", empty, EmptyCircle)
    choice("distance", distance, Distance)
    rule = _RULES[empty] if distance == "circle" else widest_angle_then_closest
    return _grow(as_points(points), rule, removal=removal, most=most_triangles)


def _grow(rows: Float64Array, rule: Rule, *, removal: bool, most: int | None) -> Network:
    require_count("most_triangles", most, or_none=True)
    # the first row at every place, in the order given
    _, first = np.unique(rows[:, :2], axis=0, return_index=True)
    points = rows[np.sort(first)]
    lists = Lists(columns(points), removal=as_flag("removal", removal))
    lists.enter(_find_first_triangle(lists.xy, len(rows)))
    is_stopped = False
    for p1, p2 in _walk_edges_to_extend(lists):
        is_stopped = most is not None and len(lists.triangles) >= most
        if is_stopped:
            break
        # third to sixth step, for an edge of a triangle
        point, tests = rule(lists.xy, p2, p1, lists.qualified(p1, p2))
        lists.tests += tests
        if point is not None:
            lists.enter((p2, p1, point))
    return Network(
        points=points,
        triangles=np.array(lists.triangles, np.int32),
        unextended=_find_unextended(lists),
        is_stopped=is_stopped,
        searches=lists.searches,
        candidates=lists.candidates,
        tests=lists.tests,
    )


def _walk_edges_to_extend(lists: Lists) -> Iterator[Edge]:
    """First and second step: yield edges used once, of triangles that grow in number meanwhile."""
    for a, b, c in lists.triangles:
        for p1, p2 in ((a, b), (b, c), (c, a)):
            if not lists.is_used_up(p1, p2):
                yield p1, p2


def _find_first_triangle(xy: Columns, n_rows: int) -> Triangle:
    if len(xy[0]) >= 2:
        p1 = int(np.lexsort((xy[1], xy[0]))[0])
        distance = np.hypot(xy[0] - xy[0][p1], xy[1] - xy[1][p1])
        distance[p1] = np.inf
        p2 = int(np.argmin(distance))
        everywhere = np.arange(len(xy[0]))
        for a, b in ((p1, p2), (p2, p1)):
            point = widest_angle(xy, a, b, everywhere[sides(xy, a, b, everywhere) > 0]).point
            if point is not None:
                return a, b, point
    raise PointsError(
        f"All {n_rows} points lie at fewer than three places or on one line: the first triangle "
        "needs three points that are not collinear."
    )


def _find_unextended(lists: Lists) -> Int32Array:
    """Return the edges used once that are not on the hull."""
    everywhere = np.arange(len(lists.xy[0]))
    inner: list[Edge] = [
        (p, q)
        for p, q in lists.open_edges()
        if len({-1, 1} & set(sides(lists.xy, p, q, everywhere).tolist())) == 2
    ]
    return np.array(inner, np.int32).reshape(-1, 2)
