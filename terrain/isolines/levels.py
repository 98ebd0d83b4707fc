"""Levels: the elevations at which contours are drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_floats, as_number, require_count
from ...base.errors import OptionError
from ...base.sentences import counted, height, shown
from ...base.types import seal

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array
    from ...tin import TIN

MOST_LEVELS = 100_000
"""More are refused: an interval with so many was given in another unit, or by a slip."""

MOST_CROSSINGS = 2**31 - 1
"""Of triangles by levels, or parts of triangles in bands: the kernel has 32 bits for them."""


@dataclass(frozen=True, eq=False)
class Levels:
    """Elevations in ascending order."""

    values: Float64Array
    """(k,)."""
    is_index: BoolArray
    """(k,), whether contours there are index contours."""
    notes: tuple[str, ...] = ()
    """What is to be told of them."""


@dataclass(frozen=True)
class LevelOptions:
    """What callers say of levels, checked: an interval and its base, or explicit levels.

    Raises OptionError if a value is none, or both or neither of interval and levels are given.
    """

    interval: Any
    levels: Any
    base: Any
    index: Any = None

    def __post_init__(self) -> None:
        if (self.interval is None) == (self.levels is None):
            given = "neither" if self.interval is None else "both"
            raise OptionError("interval and levels", given, allowed="one of the two")
        if self.interval is not None:
            as_number("interval", self.interval, above=0)
        as_number("base", self.base)
        require_count("index", self.index, or_none=True)

    def for_lines(self, tin: TIN) -> Levels:
        """Return the levels above the lowest and up to the highest elevation of a TIN."""
        return self.for_lines_between(*elevation_range(tin))

    def for_lines_between(self, lowest: float, highest: float) -> Levels:
        """Return the levels above an elevation and up to another."""
        if self.interval is None:
            return self._take_explicit(lowest, highest)
        numbers, values = self._at_interval(lowest, highest)
        is_within = (values > lowest) & (values <= highest)
        notes = () if is_within.any() else (self._describe_none(lowest, highest),)
        return Levels(seal(values[is_within]), self._find_index(numbers[is_within]), notes)

    def for_bands(self, tin: TIN) -> Levels:
        """Return the levels that bound the bands of a TIN, the explicit ones as they are."""
        return self.for_bands_between(*elevation_range(tin))

    def for_bands_between(self, lowest: float, highest: float) -> Levels:
        """Return the levels that bound the bands between two elevations."""
        if self.interval is None:
            return self._take_explicit(lowest, highest)
        _, values = self._at_interval(lowest, highest)
        first = np.searchsorted(values, lowest, side="right") - 1
        last = np.searchsorted(values, highest, side="right")
        bounds = values[first : last + 1]
        return Levels(seal(bounds), np.zeros(len(bounds), np.bool_))

    def refuse_count(self, count: int, what: str) -> OptionError:
        """Return the refusal of levels of which so many of something would come."""
        most = f"that there are at most {MOST_CROSSINGS:,} {what}, and here there would be"
        if self.interval is None:
            allowed = f"so small {most} {count:,}"
            count = len(as_levels(self.levels))
            return OptionError("levels", count, allowed=allowed, what="number of levels")
        return OptionError("interval", self.interval, allowed=f"so large {most} {count:,}")

    def _at_interval(self, lowest: float, highest: float) -> tuple[AnyArray, Float64Array]:
        """Return levels around and between two elevations, and their numbers from the base on.

        They are decimal numbers, each rounded once: 3 x 0.1 is 0.3, as a vertex has it.
        """
        step, base = Fraction(str(self.interval)), Fraction(str(self.base))
        first = math.ceil((Fraction(lowest) - base) / step)
        last = math.floor((Fraction(highest) - base) / step)
        if last - first >= MOST_LEVELS:
            allowed = (
                f"so large that there are at most {MOST_LEVELS:,} levels, "
                f"and here there would be {last - first + 1:,}"
            )
            raise OptionError("interval", self.interval, allowed=allowed)
        numbers = np.arange(-2, last - first + 3, dtype=object) + first
        values = np.array([_round(base + k * step) for k in numbers], np.float64)
        if (np.diff(values) <= 0).any():
            allowed = "so large that elevations here can differ by it"
            raise OptionError("interval", self.interval, allowed=allowed)
        return numbers, values

    def _take_explicit(self, lowest: float, highest: float) -> Levels:
        values = as_levels(self.levels)
        outside = int(((values <= lowest) | (values > highest)).sum())
        notes: tuple[str, ...] = ()
        if outside:
            notes = (
                f"{outside:,} of {counted(len(values), 'level')} lie outside the elevations of "
                f"the surface, above {height(lowest)} up to {height(highest)}, and have no line.",
            )
        return Levels(values, self._find_index(np.arange(len(values))), notes)

    def _find_index(self, numbers: AnyArray) -> BoolArray:
        if self.index is None:
            return np.zeros(len(numbers), np.bool_)
        return np.array(numbers % int(self.index) == 0, np.bool_)

    def _describe_none(self, lowest: float, highest: float) -> str:
        return (
            f"No level at the interval {shown(self.interval)} from base {shown(self.base)} lies "
            f"within the elevations of the surface, above {height(lowest)} up to "
            f"{height(highest)}: "
            "there is no line."
        )


def _round(level: Fraction) -> float:
    try:
        return float(level)
    except OverflowError:
        return math.copysign(math.inf, level)


def elevation_range(tin: TIN) -> tuple[float, float]:
    """Return the lowest and the highest elevation of the vertices that triangles have."""
    z = tin.points[:, 2]
    ends = int(z.argmin()), int(z.argmax())
    if all((tin.triangles == end).any() for end in ends):
        return float(z[ends[0]]), float(z[ends[1]])
    z = z[np.unique(tin.triangles)]
    return (float(z.min()), float(z.max())) if len(z) else (0.0, 0.0)


def as_levels(given: Any) -> Float64Array:
    """Return explicit levels in ascending order, each once.

    Raises OptionError if they are not one or more finite numbers, or too many.
    """
    values = as_floats(given)
    if values is None:
        raise OptionError("levels", given, allowed="numbers")
    if values.ndim > 1 or values.size == 0:
        raise OptionError("levels", given, allowed="a list of one or more numbers")
    values = np.unique(values)
    if not np.isfinite(values).all():
        bad = float(values[~np.isfinite(values)][0])
        raise OptionError("levels", bad, allowed="finite")
    if len(values) > MOST_LEVELS:
        allowed = f"at most {MOST_LEVELS:,}"
        raise OptionError("levels", len(values), allowed=allowed, what="number of levels")
    return seal(values)
