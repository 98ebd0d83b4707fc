"""A second opinion on simplified surfaces: every point is measured by brute force."""

from fractions import Fraction

import numpy as np

BLOCK = 200


def errors(points, surface):
    """Return how far (n, 3) points are from a TIN in elevation; NaN beyond it.

    Each point is looked for in all triangles, and the plane of one that holds it is solved for.
    """
    return np.concatenate(
        [_errors(points[row : row + BLOCK], surface) for row in range(0, len(points), BLOCK)]
    )


def _errors(points, surface):
    a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
    weights = np.stack([_areas(points, *ends) for ends in ((b, c), (c, a), (a, b))])
    size = weights.sum(axis=0)
    least = (weights / size).min(axis=0)
    holder = least.argmax(axis=1)
    rows = np.arange(len(points))
    share = weights[:, rows, holder] / size[rows, holder]
    z = share[0] * a[holder, 2] + share[1] * b[holder, 2] + share[2] * c[holder, 2]
    return np.where(least[rows, holder] < -1e-7, np.nan, np.abs(z - points[:, 2]))


def _areas(points, start, end):
    """Return twice the area of each point with each edge."""
    ux, uy = (end - start)[:, :2].T
    vx = points[:, 0, None] - start[:, 0]
    vy = points[:, 1, None] - start[:, 1]
    return ux * vy - uy * vx


def is_needed(surface, vertex, points, tolerance):
    """Whether some point is beyond the tolerance without a vertex, to the rounding."""
    without = surface.replace()
    without.remove(vertex)
    found = errors(points, without)
    return bool((found > tolerance * (1 - 1e-9)).any())


def largest_difference(tin, simple):
    """Return how far two surfaces are apart anywhere, by all crossings of their edges.

    It is largest at a vertex of one of them or where two edges cross: all pairs are looked at.
    """
    p, q = _list_ends(tin)
    a, b = _list_ends(simple)
    largest = errors(tin.points[np.unique(tin.triangles)], simple).max()
    for row in range(0, len(p), BLOCK):
        found = _measure_crossings(p[row : row + BLOCK, None], q[row : row + BLOCK, None], a, b)
        largest = max(largest, found.max(initial=0.0))
    return largest


def _list_ends(tin):
    """Return the ends of the edges, both (e, 3)."""
    return tin.points[tin.edges[:, 0]], tin.points[tin.edges[:, 1]]


def _measure_crossings(p, q, a, b):
    """Return the difference where edges p-q and a-b cross between their ends, else 0."""
    along, beside = (q - p)[..., :2], (b - a)[..., :2]
    turn = along[..., 0] * beside[..., 1] - along[..., 1] * beside[..., 0]
    step = (a - p)[..., :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (step[..., 0] * beside[..., 1] - step[..., 1] * beside[..., 0]) / turn
        t = (step[..., 0] * along[..., 1] - step[..., 1] * along[..., 0]) / turn
        z = p[..., 2] + s * (q - p)[..., 2]
        other = a[..., 2] + t * (b - a)[..., 2]
        inside = (s > 0) & (s < 1) & (t > 0) & (t < 1)
        return np.where(inside, np.abs(z - other), 0.0)


def largest_crossing(tin, simple, turn=0):
    """Return the largest difference where edges of two surfaces cross, in fractions.

    With ``turn`` 1 only where the first surface is above the other one, with -1 where it is below.
    """
    largest = Fraction(0)
    theirs = [_as_fractions(*ends) for ends in zip(*_list_ends(simple), strict=True)]
    low, high = (side(np.stack(_list_ends(simple))[..., :2], axis=0) for side in (np.min, np.max))
    for p, q in zip(*_list_ends(tin), strict=True):
        near = (low <= np.maximum(p, q)[:2]) & (high >= np.minimum(p, q)[:2])
        for k in np.flatnonzero(near.all(axis=1)).tolist():
            height = _measure_exactly(*_as_fractions(p, q), *theirs[k])
            largest = max(largest, height * int(turn) if turn else abs(height))
    return largest


def _as_fractions(*places):
    return tuple(tuple(map(Fraction, place.tolist())) for place in places)


def _measure_exactly(p, q, a, b):
    ux, uy, vx, vy = q[0] - p[0], q[1] - p[1], b[0] - a[0], b[1] - a[1]
    turn = ux * vy - uy * vx
    if turn == 0:
        return Fraction(0)
    s = ((a[0] - p[0]) * vy - (a[1] - p[1]) * vx) / turn
    t = ((a[0] - p[0]) * uy - (a[1] - p[1]) * ux) / turn
    if not (0 < s < 1 and 0 < t < 1):
        return Fraction(0)
    return p[2] + s * (q[2] - p[2]) - a[2] - t * (b[2] - a[2])
