"""Transition curves: how curvature, or the ordinate, grows from one end to the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import Float64Array

Law = Literal["clothoid", "bloss", "cosine", "sinusoid", "biquadratic"]
"""Transitions whose curvature is known at each share of their length."""

Ordinate = Literal["cubic parabola", "sine half-wave"]
"""Transitions whose ordinate is known at each share of their tangent."""

LAWS = get_args(Law)
ORDINATES = get_args(Ordinate)


class Curvature(NamedTuple):
    """Of a law: the share of the change of curvature at a share of the length, and its integral."""

    share: Callable[[Float64Array], Float64Array]
    integral: Callable[[Float64Array], Float64Array]
    """From 0 to the share of the length; 1/2 at 1."""


def _ramp(u: Float64Array) -> Float64Array:
    """Schramm's two parabolas, which meet in the middle."""
    return np.where(u <= 0.5, 2.0 * u * u, 1.0 - 2.0 * (1.0 - u) ** 2)


def _integrate_ramp(u: Float64Array) -> Float64Array:
    return np.where(u <= 0.5, 2.0 / 3.0 * u**3, u - 0.5 + 2.0 / 3.0 * (1.0 - u) ** 3)


CURVATURES: dict[str, Curvature] = {
    "clothoid": Curvature(lambda u: u, lambda u: 0.5 * u * u),
    "bloss": Curvature(lambda u: u * u * (3.0 - 2.0 * u), lambda u: u**3 - 0.5 * u**4),
    "cosine": Curvature(
        lambda u: 0.5 - 0.5 * np.cos(np.pi * u),
        lambda u: 0.5 * u - np.sin(np.pi * u) / (2.0 * np.pi),
    ),
    "sinusoid": Curvature(
        lambda u: u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi),
        lambda u: 0.5 * u * u - np.sin(np.pi * u) ** 2 / (2.0 * np.pi**2),
    ),
    "biquadratic": Curvature(_ramp, _integrate_ramp),
}
"""Every law is the same read from its other end, so that a reversed one needs no entry."""


class Shape(NamedTuple):
    """Ordinate of a transition over a tangent of length 1 whose curvature would become 1.

    Each takes shares of the tangent; ordinate, slope and its rate.
    """

    ordinate: Callable[[Float64Array], Float64Array]
    slope: Callable[[Float64Array], Float64Array]
    rate: Callable[[Float64Array], Float64Array]


SHAPES: dict[str, Shape] = {
    "cubic parabola": Shape(lambda v: v**3 / 6.0, lambda v: v * v / 2.0, lambda v: v),
    "sine half-wave": Shape(
        lambda v: v * v / 4.0 - (1.0 - np.cos(np.pi * v)) / (2.0 * np.pi**2),
        lambda v: v / 2.0 - np.sin(np.pi * v) / (2.0 * np.pi),
        lambda v: 0.5 - 0.5 * np.cos(np.pi * v),
    ),
}
