"""Plain twins of the kernels of slope and curvature: the same sums in the same order."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np

TERMS = 5
LEAST_PIVOT = 1e-10


def list_neighbors(points, triangles):
    """Return the vertices joined to each by an edge, in the order of their coordinates."""
    found = [set() for _ in points]
    for corners in triangles.tolist():
        for start, end in pairwise([*corners, corners[0]]):
            found[start].add(end)
            found[end].add(start)
    rows = points.tolist()
    return [sorted(some, key=lambda w: rows[w][:2]) for some in found]


def within_two_edges(vertex, neighbors):
    """Return the neighbours of a vertex, and then the new ones of each."""
    ring = list(neighbors[vertex])
    for near in neighbors[vertex]:
        ring += [w for w in neighbors[near] if w != vertex and w not in ring]
    return ring


def fit_quadratics(points, triangles, east=1.0, north=1.0, up=1.0):
    """Fit the quadratic surface around each vertex; (5, n) derivatives."""
    neighbors = list_neighbors(points, triangles)
    east, north = (np.broadcast_to(factor, len(points)).tolist() for factor in (east, north))
    rows = points.tolist()
    solved = [
        fit_one(
            rows[v],
            [rows[w] for w in within_two_edges(v, neighbors)],
            (east[v], north[v], up),
        )
        for v in range(len(points))
    ]
    return np.array(solved).T


def fit_one(center, others, factors):
    steps = [[(a - b) * f for a, b, f in zip(row, center, factors, strict=True)] for row in others]
    reach = max([max(abs(x), abs(y)) for x, y, _ in steps], default=0.0)
    scale = 2.0 ** -(math.frexp(reach)[1] - 1) if reach > 0 else 1.0
    matrix = [[0.0] * TERMS for _ in range(TERMS)]
    right = [0.0] * TERMS
    for east, north, z in steps:
        x, y = east * scale, north * scale
        terms = (x, y, x * x / 2, x * y, y * y / 2)
        for i in range(TERMS):
            right[i] += terms[i] * z
            for j in range(i + 1):
                matrix[i][j] += terms[i] * terms[j]
    solved = solve(matrix, right)
    return [value * (scale if k < 2 else scale * scale) for k, value in enumerate(solved)]


def solve(matrix, right):
    """Cholesky's decomposition without roots; NaN where a pivot is none."""
    inverse = [math.nan] * TERMS
    for j in range(TERMS):
        pivot, part = matrix[j][j], [0.0] * j
        least = LEAST_PIVOT * pivot
        for k in range(j):
            part[k] = matrix[j][k]
            for l in range(k):  # noqa: E741 - as in the books
                part[k] -= part[l] * matrix[k][l]
            matrix[j][k] = part[k] * inverse[k]
            pivot -= matrix[j][k] * part[k]
        inverse[j] = 1.0 / pivot if pivot > least else math.nan
    for j in range(TERMS):
        for k in range(j):
            right[j] -= matrix[j][k] * right[k]
    right = [value * inverse[j] for j, value in enumerate(right)]
    for j in reversed(range(TERMS)):
        for i in range(j + 1, TERMS):
            right[j] -= matrix[i][j] * right[i]
    return right


def compute_normals(points, triangles):
    """Return upward normals, and the numbers of triangles too thin for doubles."""
    turned = [turn_to_first(points, corners) for corners in triangles.tolist()]
    first, second, third = (points[list(corners)] for corners in zip(*turned, strict=True))
    (ux, uy, uz), (vx, vy, vz) = (second - first).T, (third - first).T
    normals = np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], axis=1)
    sizes = np.maximum(np.abs(ux), np.abs(uy)) * np.maximum(np.abs(vx), np.abs(vy))
    return normals, np.flatnonzero(~(normals[:, 2] > 2.0**-20 * sizes))


def turn_to_first(points, corners):
    """Return the corners of a triangle from the lexicographically first on."""
    first = min(range(3), key=lambda k: points[corners[k], :2].tolist())
    return corners[first:] + corners[:first]


def sum_at_vertices(triangles, normals, count):
    """Return the sums of the normals of the triangles at each vertex, the larger ones first."""
    found = [[[], [], []] for _ in range(count)]
    for corners, normal in zip(triangles.tolist(), normals.tolist(), strict=True):
        for vertex in corners:
            for axis in range(3):
                found[vertex][axis].append(normal[axis])
    return np.array([[add_by_size(values) for values in axes] for axes in found])


def add_by_size(values):
    total = 0.0
    for value in sorted(values, key=lambda value: (-abs(value), -value)):
        total += value
    return total


def shade(normals, towards):
    """Return the light on planes from 1 to 255, one after the other."""
    return [shade_one(normal, towards) for normal in normals.tolist()]


def shade_one(normal, towards):
    largest = max(map(abs, normal))
    if not 0 < largest < math.inf:
        return 1
    unit = [part / largest for part in normal]
    length = math.sqrt(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2])
    toward = unit[0] * towards[0] + unit[1] * towards[1] + unit[2] * towards[2]
    return round(1 + 254 * min(max(toward / length, 0.0), 1.0))


class GradientAt:
    """The gradient of a surface at any place, in fractions: of a triangle, or of several around.

    On an edge it is the mean of the gradients of both sides, at a vertex that of the sum of the
    normals of its triangles; None where there is no surface.
    """

    def __init__(self, points, triangles):
        self.points = [tuple(map(Fraction, row)) for row in points.tolist()]
        self.triangles = triangles.tolist()
        self.vertex_at = {row[:2]: v for v, row in enumerate(self.points)}
        self.normals = [self._find_normal(corners) for corners in self.triangles]
        corners = points[triangles, :2]
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)

    def _find_normal(self, corners):
        a, b, c = (self.points[v] for v in corners)
        u, v = ([end - start for start, end in zip(a, other, strict=True)] for other in (b, c))
        turns = ((1, 2), (2, 0), (0, 1))
        return [u[i] * v[j] - u[j] * v[i] for i, j in turns]

    def __call__(self, x, y):
        place = Fraction(float(x)), Fraction(float(y))
        near = ((self.low <= (x, y)) & ((x, y) <= self.high)).all(axis=1)
        holding = [t for t in np.flatnonzero(near).tolist() if self._holds(t, place)]
        if not holding:
            return None
        vertex = self.vertex_at.get(place)
        if vertex is not None:
            around = [n for n, t in zip(self.normals, self.triangles, strict=True) if vertex in t]
            east, north, up = (sum(axis) for axis in zip(*around, strict=True))
            return -east / up, -north / up
        found = [[-n[0] / n[2], -n[1] / n[2]] for n in (self.normals[t] for t in holding)]
        return tuple(sum(axis) / len(found) for axis in zip(*found, strict=True))

    def _holds(self, t, place):
        corners = [self.points[v][:2] for v in self.triangles[t]]
        return all(
            (b[0] - a[0]) * (place[1] - a[1]) >= (b[1] - a[1]) * (place[0] - a[0])
            for a, b in pairwise([*corners, corners[0]])
        )

    def slope(self, x, y):
        """Return the slope in degrees, NaN where there is no surface."""
        found = self(x, y)
        return (
            math.nan if found is None else math.degrees(math.atan(math.hypot(*map(float, found))))
        )

    def aspect(self, x, y):
        """Return the aspect in degrees, NaN where there is none."""
        found = self(x, y)
        if found is None or not any(found):
            return math.nan
        return math.degrees(math.atan2(-float(found[0]), -float(found[1]))) % 360.0
