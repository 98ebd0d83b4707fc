"""A second opinion on simplified surfaces: every point is measured by brute force."""

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
