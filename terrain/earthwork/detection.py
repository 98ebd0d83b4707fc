"""The level of detection: what differs less counts as unchanged."""

from __future__ import annotations

from statistics import NormalDist
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_number
from ...base.errors import OptionError
from .meshes import as_mesh, divide_at_zero, drop_unused

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array, Int8Array, Int32Array, Int64Array
    from ...tin import TIN
    from ..surface import Surface

_ROUNDINGS = 8.0
"""Of an elevation: surfaces that differ by so little more than the level differ by the level."""
_SHARE = 1e-12
"""Of a level: by so much less a triangle may be beyond it by rounding."""


class Detection:
    """Levels of detection over two surfaces: one, or those of errors that vary.

    ``errors`` are those of each surface, one of all of it or as the elevation of a surface, which
    are linear between vertices. The level is ``level`` times the root of the sum of their squares,
    or ``level`` itself without any; of an overlay it is linear between vertices. ``rounding`` is
    what elevations may differ by but for rounding.
    """

    def __init__(
        self, level: float, errors: Sequence[float | TIN] = (), rounding: float = 0.0
    ) -> None:
        self.level, self._errors, self._rounding = level, tuple(errors), rounding
        self._known: list[tuple[Any, Float64Array]] = []

    @property
    def is_even(self) -> bool:
        """Whether the level is the same everywhere."""
        return not self._errors

    def measure(self, xy: Float64Array) -> Float64Array:
        """Return the levels at places, (n, 2)."""
        if not self._errors:
            return np.full(len(xy), self.level + self._rounding)
        squares = np.zeros(len(xy))
        for one in self._errors:
            # Rounded, a place at an edge may lie outside.
            found = one if isinstance(one, float) else one.interpolate(xy, extrapolate="nearest")
            squares += np.square(found)
        levels = self.level * np.sqrt(squares) + self._rounding
        places = _join(xy)
        for known, own in self._known:
            at = np.minimum(np.searchsorted(known, places), len(known) - 1)
            levels = np.where(known[at] == places, own[at], levels)
        return levels

    def remember(self, xy: Float64Array, levels: Float64Array) -> None:
        """Take levels at places for granted: those where a cut was made, on edges."""
        if self._errors and len(xy):
            places = _join(xy)
            order = np.argsort(places, kind="stable")
            self._known.append((places[order], levels[order]))

    def divide(self, points: Float64Array, triangles: Int32Array) -> Divided:
        """Cut triangles of a difference where it is as large as the level, up or down."""
        parents = np.arange(len(triangles))
        levels = self.measure(points[:, :2])
        for sign in (1.0, -1.0):
            n = len(points)
            beyond = np.column_stack([points[:, :2], points[:, 2] - sign * levels, levels])
            cut, triangles, own = divide_at_zero(beyond, triangles)
            parents, levels = parents[own], cut[:, 3]
            made = np.column_stack([cut[n:, :2], sign * levels[n:]])
            points = np.concatenate([points, made])
        return Divided(points, triangles, parents, levels)


class Divided(NamedTuple):
    """A difference that is cut at the level of detection."""

    points: Float64Array
    """(n, 3)."""
    triangles: Int32Array
    """(m, 3)."""
    parents: Int64Array
    """(m,), the triangle that each is a part of."""
    levels: Float64Array
    """(n,), of detection at the points."""

    def classify(self) -> Int8Array:
        """Return +1 for triangles filled by more than the level, -1 for those cut, else 0."""
        return classify_beyond(self.points[:, 2], self.levels, self.triangles)


def classify_beyond(
    differences: Float64Array, levels: Float64Array, triangles: Int32Array
) -> Int8Array:
    """Return +1 for triangles filled by more than the levels of their corners, -1 for cut, else 0.

    Both are of vertices, (n,), and no triangle lies on both sides of a level.
    """
    total, most = differences[triangles].sum(axis=1), levels[triangles].sum(axis=1)
    is_changed = np.abs(total) > most * (1.0 + _SHARE)
    return np.where(is_changed, np.sign(total), 0.0).astype(np.int8)


def _join(xy: Float64Array) -> Any:
    """Return places as complex numbers, which are sorted by easting, then northing."""
    return xy[:, 0] + 1j * xy[:, 1]


def require_level(level: Any, confidence: Any) -> None:
    """Refuse what is no level of detection, or no confidence; and both."""
    if level is not None:
        what = "a difference"
        as_number("level_of_detection", level, what, above=0, unit="in the unit of elevations")
    if confidence is not None:
        as_number("confidence", confidence, "a probability", above=0, below=1)
    if level is not None and confidence is not None:
        raise OptionError(
            "confidence", confidence, "None where `level_of_detection` is given, or that None"
        )


def make_detection(
    confidence: float, surfaces: list[tuple[Surface, Float64Array, float]], rounding: float
) -> Detection:
    """Return the level beyond which a difference is real with some confidence.

    For each surface there are the standard errors of its vertices and that of its shift.
    """
    quantile = NormalDist().inv_cdf((1.0 + confidence) / 2.0)
    if all(_is_even(surface, errors) for surface, errors, _ in surfaces):
        squares = [errors.max() ** 2 + shift**2 for _, errors, shift in surfaces]
        return Detection(quantile * float(np.sqrt(sum(squares))), rounding=rounding)
    found: list[float | TIN] = []
    for surface, errors, shift in surfaces:
        found.append(float(shift))
        if _is_even(surface, errors):
            found.append(float(errors.max()))
        else:
            points = np.column_stack([surface.points[:, :2], errors])
            found.append(as_mesh(*drop_unused(points, surface.triangles)))
    return Detection(quantile, found, rounding)


def _is_even(surface: Surface, errors: Float64Array) -> bool:
    own = errors[surface.triangles]
    return bool((own == own.flat[0]).all())


def find_rounding(*surfaces: Surface) -> float:
    """Return by how much elevations of surfaces may differ by rounding."""
    largest = max(float(np.abs(one.points[one.triangles, 2]).max()) for one in surfaces)
    return _ROUNDINGS * float(np.spacing(largest))
