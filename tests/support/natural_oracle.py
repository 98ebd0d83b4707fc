"""Natural neighbour weights by their definition: Voronoi cells clipped in rational numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

from support.oracles import Place

Polygon = list[Place]


def sibson_weights(sites: Sequence[Place], p: Place) -> list[Fraction]:
    """The share of p's cell that each site's cell gives up; p lies within the hull of the sites."""
    cell = _cell(p, sites)
    areas = [_area(_nearer(cell, site, sites)) for site in sites]
    return [Fraction(area) / sum(areas) for area in areas]


def laplace_weights(sites: Sequence[Place], p: Place) -> list[Fraction]:
    """The length of the side that p's cell shares with each site's over the distance."""
    cell = _cell(p, sites)
    ratios = [_shared_side(cell, p, site) for site in sites]
    return [Fraction(ratio) / sum(ratios) for ratio in ratios]


def _cell(p: Place, sites: Sequence[Place]) -> Polygon:
    far = 10**400  # beyond every corner of a cell, of whatever sites that doubles can hold
    return _nearer([(-far, -far), (far, -far), (far, far), (-far, far)], p, sites)


def _nearer(polygon: Polygon, p: Place, sites: Sequence[Place]) -> Polygon:
    """The part of a polygon that is nearer to p than to any of the sites."""
    for site in sites:
        if site != p:
            polygon = _clip(polygon, _excess(p, site))
    return polygon


def _excess(p: Place, site: Place) -> Callable[[Place], Fraction]:
    """How much nearer to the site than to p, in squares: linear in the place."""
    dx, dy = site[0] - p[0], site[1] - p[1]
    level = Fraction(site[0] ** 2 + site[1] ** 2 - p[0] ** 2 - p[1] ** 2, 2)
    return lambda at: dx * at[0] + dy * at[1] - level


def _clip(polygon: Polygon, excess: Callable[[Place], Fraction]) -> Polygon:
    kept = []
    for a, b in pairwise([*polygon, *polygon[:1]]):
        here, there = excess(a), excess(b)
        if here <= 0:
            kept.append(a)
        if (here < 0 < there) or (there < 0 < here):
            t = here / (here - there)
            kept.append((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
    return kept


def _area(polygon: Polygon) -> Fraction:
    sides = pairwise([*polygon, *polygon[:1]])
    return Fraction(sum(a[0] * b[1] - a[1] * b[0] for a, b in sides))


def _shared_side(cell: Polygon, p: Place, site: Place) -> Fraction:
    excess = _excess(p, site)
    dx, dy = site[0] - p[0], site[1] - p[1]
    length = Fraction(0)
    for a, b in pairwise([*cell, *cell[:1]]):
        if excess(a) == 0 == excess(b):
            length += Fraction(abs(dx * (b[1] - a[1]) - dy * (b[0] - a[0])))
    return length / (dx * dx + dy * dy)
