"""Points in wrong places: beyond the CRS's area of use, or far from all others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.sentences import counted
from .area_of_use import AreaOfUse
from .slips import FACTORS

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...base.crs import CRS
    from .suspects import Rows, Suspect

_CENTRE = (5.0, 95.0)
"""Percentiles between which the site is taken to lie, whatever single points do."""
_WHOLE = 0.9
_FAR, _VERY_FAR = 1.0, 5.0
"""Beyond the site by so many of its diagonals a point is far, or very far, from all others."""
_NEAR = 0.5
"""Within so many of its diagonals a point lies among the others."""
_SITE = 4
"""So many points together are a site of their own."""
_MOST_FAR = 2_000
_SOME = 20_000
"""So many points tell where most of them lie."""


class _Box(NamedTuple):
    """Where most of the points lie."""

    low: Float64Array
    high: Float64Array

    @classmethod
    def of(cls, xy: Float64Array) -> _Box:
        some = xy[:: max(1, len(xy) // _SOME)]
        low, high = np.percentile(some, _CENTRE, axis=0)
        pad = (high - low) * (1 / _WHOLE - 1) / 2
        return cls(low - pad, high + pad)

    @property
    def diagonal(self) -> float:
        return float(np.hypot(*(self.high - self.low)))

    def find_beyond(self, xy: Float64Array, diagonals: float) -> Int64Array:
        """Return which places are further from the box than so many diagonals of it."""
        pad = diagonals * self.diagonal
        low, high = (np.array([f(axis) for axis in xy.T]) for f in (np.min, np.max))
        if np.hypot(*np.maximum(self.low - low, high - self.high).clip(0.0)) <= pad:
            return np.empty(0, np.int64)
        return np.flatnonzero(self.measure_distances(xy) > diagonals)

    def measure_distances(self, xy: Float64Array) -> Float64Array:
        """Return how far places are beyond the box, in diagonals of it."""
        beyond = np.maximum(np.maximum(self.low - xy, xy - self.high), 0.0)
        distances: Float64Array = np.hypot(*beyond.T) / self.diagonal
        return distances


def find_places(rows: Rows, crs: CRS | None) -> tuple[list[Suspect], list[str]]:
    """Find points outside the CRS's area of use, or far from all others; notes on them.

    A far point that would lie among the others with its axes swapped, or with a coordinate
    multiplied, is told as such.
    """
    notes: list[str] = []
    if len(rows) == 0:
        return [], notes
    found = _find_outside(rows, crs, notes)
    box = _Box.of(rows.xyz[:, :2])
    if not 0.0 < box.diagonal < np.inf:
        return list(found.values()), notes
    far = box.find_beyond(rows.xyz[:, :2], _FAR)
    if len(far) > _MOST_FAR:
        notes.append(f"{counted(len(far), 'point')} far from the others: taken for other sites.")
        return list(found.values()), notes
    for i in far.tolist():
        told = _explain(rows, i, box)
        if told is not None:
            found[i] = rows.suspect(i, *told, "high")
            continue
        apart = np.hypot(*(rows.xyz[far, :2] - rows.xyz[i, :2]).T)
        if i not in found and (apart < box.diagonal).sum() < _SITE:  # else a site of their own
            distance = float(box.measure_distances(rows.xyz[i : i + 1, :2])[0])
            sentence = f"It lies {distance:.3g} times the extent of the site away from it."
            certainty = "high" if distance > _VERY_FAR else "medium"
            found[i] = rows.suspect(i, "isolated", sentence, certainty)
    return list(found.values()), notes


def _find_outside(rows: Rows, crs: CRS | None, notes: list[str]) -> dict[int, Suspect]:
    area = AreaOfUse.of(crs, crs)
    if area is None or area.is_local(rows.xyz[:, :2]):
        return {}
    outside = area.find_outside(rows.xyz[:, :2])
    if 2 * len(outside) > len(rows):
        notes.append(
            f"{counted(len(outside), 'point')} of {len(rows):,} outside the area of use of "
            f"{area.label}: the CRS may be another one."
        )
        return {}
    sentence = f"It lies outside the area of use of {area.label}."
    return {i: rows.suspect(i, "outside", sentence, "high") for i in outside.tolist()}


def _explain(rows: Rows, i: int, box: _Box) -> tuple[str, str] | None:
    """Return reason and sentence if a slip of the pen has brought a point where it is."""
    x, y = rows.xyz[i, :2].tolist()
    if box.measure_distances(np.array([[y, x]]))[0] < _NEAR:
        return "swapped", "With easting and northing exchanged it lies among the others."
    for factor, words in FACTORS.items():
        for name, place in (
            ("easting is", (x / factor, y)),
            ("northing is", (x, y / factor)),
            ("coordinates are", (x / factor, y / factor)),
        ):
            if box.measure_distances(np.array([place]))[0] < _NEAR:
                return "factor", f"Its {name} {words} what would lie among the others."
    return None
