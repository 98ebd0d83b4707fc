"""Lines of sight the plain way: each against every edge and vertex, in fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import shapely

import tinsmith as ts


def turn(a: Any, b: Any, c: Any) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def find_first_block(points: np.ndarray, edges: np.ndarray, eye: Any, target: Any) -> Any:
    """Return the least share of the way at which an edge or a vertex is above the ray, or None."""
    e, t = ([Fraction(float(value)) for value in end] for end in (eye, target))
    exact = [[Fraction(value) for value in point] for point in points.tolist()]
    sides = [turn(e, t, point) for point in exact]
    found = []
    for vertex in np.unique(edges).tolist():
        if sides[vertex] == 0:
            found.append(measure(e, t, exact[vertex]))
    for a, b in edges.tolist():
        if sides[a] * sides[b] < 0:
            share = sides[a] / (sides[a] - sides[b])
            place = [p + share * (q - p) for p, q in zip(exact[a], exact[b], strict=True)]
            found.append(measure(e, t, place))
    return min((share for share, above in found if 0 < share < 1 and above > 0), default=None)


def measure(e: Any, t: Any, place: Any) -> tuple[Fraction, Fraction]:
    """Return the share of the way at which a place lies, and its height above the ray."""
    axis = 0 if e[0] != t[0] else 1
    share = (place[axis] - e[axis]) / (t[axis] - e[axis])
    return share, place[2] - (e[2] + share * (t[2] - e[2]))


def has_thin_triangles(tin: Any) -> bool:
    """Tell whether a rounded corner on the side of a triangle may lie beyond its other sides."""
    corners = tin.points[tin.triangles, :2]
    squares = ((corners - np.roll(corners, 1, axis=1)) ** 2).sum(axis=2).max(axis=1)
    return bool((tin.triangle_areas <= 1e-10 * squares).any())


def require_parts_as_lines(tin: Any, eye: Any, places: np.ndarray, heights: Any) -> int:
    """Hold the parts of a viewshed against a line of sight to each place, and return how many.

    Left out is what is as near to touching as doubles come, or to the border of a part.
    """
    how = dict(zip(("eye_height", "target_height"), heights, strict=True))
    seen = ts.viewshed(tin, eye, **how)
    shapes = seen.to_shapely()
    assert shapely.is_valid(shapes).all() or has_thin_triangles(tin)
    assert np.isclose(seen.columns["area"].sum(), tin.area)
    assert np.isclose(shapely.area(shapes).sum(), tin.area)
    places = places[(tin.locate(places) >= 0) & (places != eye).any(axis=1)]
    if len(places) == 0:
        return 0
    lines = ts.line_of_sight(tin, eye, places, **how).columns
    inside = np.stack([shapely.contains_xy(shape, places) for shape in shapes])
    borders = np.stack(
        [shapely.distance(shape.boundary, shapely.points(places)) for shape in shapes]
    )
    sure = (borders.min(axis=0) > 1e-6) & ~(np.abs(lines["clearance"]) < 1e-9)
    assert (inside[:, sure].sum(axis=0) == 1).all()
    is_visible = seen.columns["class"] == "visible"
    assert inside[is_visible].any(axis=0)[sure].tolist() == lines["visible"][sure].tolist()
    return int(sure.sum())
