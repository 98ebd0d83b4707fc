"""Curvature at vertices, from the quadratic surface that fits their neighbourhood."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import choice
from ...policies import CurvatureKind, SurfacePart
from ...tin.topology import gather
from ...tin.validation.options import require_tin
from ..units import find_scales

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ...tin import TIN

__all__ = ["curvature"]

_CHUNK = 1 << 15
_TERMS = 5
_LEAST_PIVOT = 1e-10
"""A pivot that elimination leaves of so small a share of the diagonal is none: the neighbours then
lie on a conic, and many quadratic surfaces fit."""


class _Derivatives(NamedTuple):
    """First and second derivatives of the elevation, to the east (x) and the north (y)."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    xx: NDArray[np.float64]
    xy: NDArray[np.float64]
    yy: NDArray[np.float64]


def curvature(
    tin: TIN, *, kind: CurvatureKind = "profile", per: SurfacePart = "vertex"
) -> NDArray[np.float64]:
    """Measure how a surface is curved at each vertex.

    Parameters
    ----------
    tin : TIN
    kind : {"profile", "plan", "tangential", "mean", "gaussian"}, optional
        Along the line of steepest descent, along the contour seen from above, along the contour in
        space, the mean of all directions, or the product of the largest and the smallest.
    per : {"vertex", "triangle"}, optional
        Of a triangle it is the mean of its corners.

    Returns
    -------
    (n,) or (m,) float64 array
        Per unit of eastings, above longitude and latitude per metre; ``"gaussian"`` per its square.
        Positive where the surface is convex (a ridge), negative where it is concave (a valley).
        NaN where the neighbours are too few or lie on a conic; profile, plan and tangential also
        where the surface is level.

    Raises
    ------
    OptionError
        For another kind, or another place.

    Notes
    -----
    A piecewise linear surface has no curvature but in its edges. So the quadratic surface through
    each vertex is taken that fits the vertices within two edges best (least squares of the
    differences in elevation, all of equal weight), as Evans and Zevenbergen and Thorne do on
    rasters: exact where the vertices lie on a quadratic surface, and smoothed across breaklines.
    Signs and formulas are those of [1]_. Linear in the vertices.

    References
    ----------
    .. [1] J. Minár, I. S. Evans, M. Jenčo, A comprehensive system of definitions of land surface
       (topographic) curvatures, Earth-Science Reviews 211 (2020),
       doi:10.1016/j.earscirev.2020.103414.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    >>> bowl = ts.triangulate(np.column_stack([x, y, 0.05 * ((x - 2) ** 2 + (y - 2) ** 2)]))
    >>> ts.curvature(bowl, kind="mean")[12].round(9)
    np.float64(-0.1)
    """
    require_tin(tin)
    choice("kind", kind, CurvatureKind)
    choice("per", per, SurfacePart)
    offsets, neighbors = _vertex_neighbors(tin)
    found = np.empty(len(tin.points))
    for start in range(0, len(found), _CHUNK):
        rows = np.arange(start, min(start + _CHUNK, len(found)))
        found[rows] = _FORMULAS[kind](_fit(tin, rows, offsets, neighbors))
    if per == "triangle":
        found = found[tin.triangles].mean(axis=1)
    return found


def _vertex_neighbors(tin: TIN) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the vertices joined to each by an edge, as offsets and numbers."""
    edges = tin.edges.astype(np.int64)
    start = np.concatenate([edges[:, 0], edges[:, 1]])
    end = np.concatenate([edges[:, 1], edges[:, 0]])
    counts = np.bincount(start, minlength=len(tin.points))
    return np.append(0, np.cumsum(counts)), end[np.argsort(start, kind="stable")]


def _fit(
    tin: TIN, rows: NDArray[np.int64], offsets: NDArray[np.int64], neighbors: NDArray[np.int64]
) -> _Derivatives:
    """Fit a quadratic surface through each of some vertices to those within two edges."""
    owner, other = _within_two_edges(rows, offsets, neighbors, len(tin.points))
    center = tin.points[rows]
    scales = find_scales(tin.crs, tin.elevation_unit, center[:, 1])
    factors = np.empty((len(rows), 3))
    for axis, factor in enumerate(scales):
        factors[:, axis] = factor
    steps = (tin.points[other] - center[owner]) * factors[owner]
    reach = np.zeros(len(rows))
    np.maximum.at(reach, owner, np.abs(steps[:, :2]).max(axis=1))
    reach[reach == 0.0] = 1.0
    x, y = (steps[:, axis] / reach[owner] for axis in (0, 1))
    terms = (x, y, x * x / 2, x * y, y * y / 2)
    solved = _least_squares(terms, steps[:, 2], owner, len(rows))
    by_size = solved / np.stack([reach, reach, reach**2, reach**2, reach**2])
    return _Derivatives(*by_size)


def _within_two_edges(
    rows: NDArray[np.int64], offsets: NDArray[np.int64], neighbors: NDArray[np.int64], n: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return pairs: place of a row, and each vertex within two edges of it, once."""
    slots, owner = gather(offsets, rows)
    near = neighbors[slots]
    further, via = gather(offsets, near)
    keys = np.concatenate([owner * n + near, owner[via] * n + neighbors[further]])
    keys.sort()  # many times as fast as the hashing of np.unique
    keys = keys[np.append(True, keys[1:] != keys[:-1])]
    owners, others = np.divmod(keys, n)
    is_other = others != rows[owners]
    return owners[is_other], others[is_other]


def _least_squares(
    terms: Sequence[NDArray[np.float64]],
    values: NDArray[np.float64],
    owner: NDArray[np.int64],
    count: int,
) -> NDArray[np.float64]:
    """Solve the normal equations of each owner, (5, count); NaN where they have no one solution."""
    matrix = np.empty((_TERMS, _TERMS, count))
    right = np.empty((_TERMS, count))
    for i in range(_TERMS):
        right[i] = np.bincount(owner, terms[i] * values, count)
        for j in range(i + 1):
            matrix[i, j] = np.bincount(owner, terms[i] * terms[j], count)
    return _solve(matrix, right)


def _solve(matrix: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solve symmetric systems by Cholesky's decomposition, of many at once."""
    least = _LEAST_PIVOT * np.stack([matrix[k, k] for k in range(_TERMS)])
    lower = np.zeros_like(matrix)
    with np.errstate(invalid="ignore", divide="ignore"):
        for j in range(_TERMS):
            pivot = matrix[j, j] - (lower[j, :j] ** 2).sum(axis=0)
            lower[j, j] = np.sqrt(np.where(pivot > least[j], pivot, np.nan))
            for i in range(j + 1, _TERMS):
                known = (lower[i, :j] * lower[j, :j]).sum(axis=0)
                lower[i, j] = (matrix[i, j] - known) / lower[j, j]
        solved = np.zeros_like(right)
        for j in range(_TERMS):
            solved[j] = (right[j] - (lower[j, :j] * solved[:j]).sum(axis=0)) / lower[j, j]
        for j in reversed(range(_TERMS)):
            known = (lower[j + 1 :, j] * solved[j + 1 :]).sum(axis=0)
            solved[j] = (solved[j] - known) / lower[j, j]
    return solved


# ------------------------------------------------------------------------------ formulas


def _profile(d: _Derivatives) -> NDArray[np.float64]:
    along = d.xx * d.x**2 + 2 * d.xy * d.x * d.y + d.yy * d.y**2
    return _ratio(-along, _steepness(d) * (1 + _steepness(d)) ** 1.5)


def _plan(d: _Derivatives) -> NDArray[np.float64]:
    return _ratio(-_across(d), _steepness(d) ** 1.5)


def _tangential(d: _Derivatives) -> NDArray[np.float64]:
    return _ratio(-_across(d), _steepness(d) * np.sqrt(1 + _steepness(d)))


def _mean(d: _Derivatives) -> NDArray[np.float64]:
    bend = (1 + d.y**2) * d.xx - 2 * d.x * d.y * d.xy + (1 + d.x**2) * d.yy
    return _ratio(-bend, 2 * (1 + _steepness(d)) ** 1.5)


def _gaussian(d: _Derivatives) -> NDArray[np.float64]:
    return _ratio(d.xx * d.yy - d.xy**2, (1 + _steepness(d)) ** 2)


def _steepness(d: _Derivatives) -> NDArray[np.float64]:
    return np.asarray(d.x**2 + d.y**2)


def _across(d: _Derivatives) -> NDArray[np.float64]:
    return np.asarray(d.xx * d.y**2 - 2 * d.xy * d.x * d.y + d.yy * d.x**2)


def _ratio(value: NDArray[np.float64], divisor: NDArray[np.float64]) -> NDArray[np.float64]:
    """Divide, and return NaN where the divisor is 0."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(divisor == 0.0, np.nan, value / divisor)


_FORMULAS = {
    "profile": _profile,
    "plan": _plan,
    "tangential": _tangential,
    "mean": _mean,
    "gaussian": _gaussian,
}
