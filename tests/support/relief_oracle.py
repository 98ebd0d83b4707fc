"""Plain twins of the kernels of slope and curvature: the same sums in the same order."""

from __future__ import annotations

import math
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
    first, second, third = (points[triangles[:, k]] for k in range(3))
    (ux, uy, uz), (vx, vy, vz) = (second - first).T, (third - first).T
    normals = np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], axis=1)
    sizes = np.maximum(np.abs(ux), np.abs(uy)) * np.maximum(np.abs(vx), np.abs(vy))
    return normals, np.flatnonzero(~(normals[:, 2] > 2.0**-20 * sizes))


def sum_at_vertices(triangles, normals, count):
    """Return the sums of the normals of the triangles at each vertex, in their order."""
    corners = triangles.ravel()
    sums = [np.bincount(corners, np.repeat(axis, 3), count) for axis in normals.T]
    return np.stack(sums, axis=1)


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
