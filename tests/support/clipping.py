"""The area of a cell that triangles cover, in fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np


def covered_area(triangles, cell):
    """Return the area that triangles, (m, 3, 2), share with a cell (west, south, east, north)."""
    west, south, east, north = (Fraction(float(side)) for side in cell)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    near = ((low <= (cell[2], cell[3])) & (high >= (cell[0], cell[1]))).all(axis=1)
    near[near] = ~are_beyond_an_edge(triangles[near], cell)
    total = Fraction(0)
    for corners in triangles[near].tolist():
        part = [tuple(map(Fraction, corner)) for corner in corners]
        for axis, sign, limit in ((0, 1, west), (0, -1, east), (1, 1, south), (1, -1, north)):
            part = cut(part, axis, sign, limit)
        total += measure(part)
    return total


def are_beyond_an_edge(triangles, cell):
    """Whether a cell lies clearly outside an edge of a triangle, many roundings from it."""
    places = np.array([[cell[x], cell[y]] for x in (0, 2) for y in (1, 3)])
    edges = np.roll(triangles, -1, axis=1) - triangles
    offsets = places[:, None, None] - triangles
    sides = edges[..., 0] * offsets[..., 1] - edges[..., 1] * offsets[..., 0]
    turns = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    clear = 1e-9 * max(np.abs(edges).max(initial=0.0), np.abs(offsets).max(initial=0.0)) ** 2
    return ((sides * np.sign(turns)[:, None] < -clear).all(axis=0)).any(axis=1)


def cut(polygon, axis, sign, limit):
    """Return the part of a convex polygon on one side of a line along the other axis."""
    kept = []
    for a, b in zip(polygon, [*polygon[1:], *polygon[:1]], strict=True):
        here, there = sign * (a[axis] - limit), sign * (b[axis] - limit)
        if here >= 0:
            kept.append(a)
        if (here > 0 > there) or (here < 0 < there):
            share = here / (here - there)
            kept.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return kept


def measure(polygon):
    """Return the area of a polygon."""
    pairs = zip(polygon, [*polygon[1:], *polygon[:1]], strict=True)
    return abs(sum((a[0] * b[1] - a[1] * b[0] for a, b in pairs), Fraction(0))) / 2
