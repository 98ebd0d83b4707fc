"""Curvatures of a surface with given derivatives, by the formulas of Minár et al. (2020)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.policies import CurvatureKind


class Derivatives(NamedTuple):
    """First and second derivatives of the elevation, to the east (x) and the north (y)."""

    x: Float64Array
    y: Float64Array
    xx: Float64Array
    xy: Float64Array
    yy: Float64Array


def measure_curvatures(kind: CurvatureKind, derivatives: Derivatives) -> Float64Array:
    """Return curvatures, as of :func:`tinsmith.curvature`; NaN where there is no direction."""
    return _FORMULAS[kind](derivatives)


# In the direction (x, y) / hypot(x, y) of the gradient and in its secant hypot(1, x, y), rather
# than in powers of x and y: these overflow where it is steep.


def _compute_profile(d: Derivatives) -> Float64Array:
    x, y = _find_direction(d)
    secant = _measure_secant(d)
    return -(d.xx * x**2 + 2 * d.xy * x * y + d.yy * y**2) / secant / secant / secant


def _compute_plan(d: Derivatives) -> Float64Array:
    with np.errstate(invalid="ignore", divide="ignore"):  # NaN where it is level
        return -_sum_across(d) / np.hypot(d.x, d.y)


def _compute_tangential(d: Derivatives) -> Float64Array:
    return -_sum_across(d) / _measure_secant(d)


def _compute_mean(d: Derivatives) -> Float64Array:
    secant = _measure_secant(d)
    x, y, up = d.x / secant, d.y / secant, 1 / secant
    bend = (up**2 + y**2) * d.xx - 2 * x * y * d.xy + (up**2 + x**2) * d.yy
    return -bend / (2 * secant)


def _compute_gaussian(d: Derivatives) -> Float64Array:
    secant = _measure_secant(d)
    xx, xy, yy = (side / secant / secant for side in (d.xx, d.xy, d.yy))
    return xx * yy - xy**2


def _find_direction(d: Derivatives) -> tuple[Float64Array, Float64Array]:
    """Return the unit vector of the gradient; NaN where it is 0."""
    with np.errstate(invalid="ignore"):
        return d.x / np.hypot(d.x, d.y), d.y / np.hypot(d.x, d.y)


def _measure_secant(d: Derivatives) -> Float64Array:
    return np.hypot(1.0, np.hypot(d.x, d.y))


def _sum_across(d: Derivatives) -> Float64Array:
    x, y = _find_direction(d)
    return np.asarray(d.xx * y**2 - 2 * d.xy * x * y + d.yy * x**2)


_FORMULAS = {
    "profile": _compute_profile,
    "plan": _compute_plan,
    "tangential": _compute_tangential,
    "mean": _compute_mean,
    "gaussian": _compute_gaussian,
}
