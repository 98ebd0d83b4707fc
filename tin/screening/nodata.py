"""Elevations that look as if they stood for "no data": -9999, 0, 1e30 far from all others."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import OptionError
from ...base.sentences import counted, height, inflect
from .slips import BEYOND, find_multiplied

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.arrays import Float64Array

CUSTOMARY = (
    *(-9999.0, -99999.0, -999999.0, -999.0, -9999.9, -999.9, -99.0, -99.9, -32768.0, -32767.0),
    *(-3.4028234663852886e38, -3.402823e38, -3.4e38, -1e38, -1e30, -1e20, -1.7976931348623157e308),
    *(0.0, 9999.0, 99999.0, 999999.0, 32767.0, 1e10, 1e20, 1e30, 1e38, 3.4e38),
    *(1.70141e38, 1.70141183460469e38, 3.4028234663852886e38, 1.7976931348623157e308),
)
"""What programs write where they have no elevation: Surfer 1.70141e38, GDAL -9999, Esri -3.4e38."""

_CUSTOMARY_SET = frozenset(CUSTOMARY)

_MOST = 3
_REPEATS = 3
_FAR = 10.0
_SOME = 1_000


def parse_nodata(nodata: float | Sequence[float] | None) -> Float64Array:
    """Return the elevations that a caller names as no data, (k,) array."""
    try:
        return np.atleast_1d(np.asarray([] if nodata is None else nodata, np.float64)).ravel()
    except (TypeError, ValueError, OverflowError) as error:
        raise OptionError("nodata", nodata, "a number, or several") from error


@dataclass(frozen=True, slots=True)
class SuspectElevation:
    """An elevation that may stand for no data, and how many points have it."""

    value: float
    count: int
    lowest: float
    highest: float


def find_suspect_elevations(z: Float64Array) -> list[SuspectElevation]:
    """Find at most three elevations that may stand for "no data", the outermost first.

    From the outside inwards the lowest or highest value is suspected if a gap parts it from all
    others: one that programs write for no data by a gap wider than the range of the others, any
    value that three points or more share by ten times this range, and any beyond the earth's. Of
    several such marks none counts among the others of another. Zero among elevations around the
    sea lies in no gap, and is left alone. Elevations are finite; ``lowest`` and ``highest`` of a
    result are of the others.

    Examples
    --------
    >>> find_suspect_elevations(np.array([318.2, -9999.0, 320.5, 331.0, -9999.0]))
    [SuspectElevation(value=-9999.0, count=2, lowest=318.2, highest=331.0)]
    """
    found: list[SuspectElevation] = []
    rest = z
    ground = _leave_out_marks(z) if len(z) else z
    while len(found) < _MOST and len(rest):
        # lowest and highest value, the one of larger size first
        low, high = float(rest.min()), float(rest.max())
        ends = (high, low) if abs(high) > abs(low) else (low, high)
        suspect = next(filter(None, (_find_suspect(rest, ground, end) for end in ends)), None)
        if suspect is None:
            break
        found.append(suspect)
        rest = rest[rest != suspect.value]
    # What lies beyond the last of them is the range of the true ones.
    return [replace(one, lowest=float(rest.min()), highest=float(rest.max())) for one in found]


def _leave_out_marks(z: Float64Array) -> Float64Array:
    """Return the elevations but for those that programs write for none and that lie far from all.

    Two such marks would hide each other.
    """
    lowest, highest = float(z.min()), float(z.max())
    known = [value for value in CUSTOMARY if lowest <= value <= highest and (z == value).any()]
    others = z[~np.isin(z, known)] if known else z
    if len(others) == 0:
        return z
    span = float(others.min()), float(others.max())
    marks = [value for value in known if is_beyond_range(value, *span)]
    return z[~np.isin(z, marks)] if marks else z


def is_customary(value: float) -> bool:
    """Tell whether programs write an elevation where they have none, such as -9999 and 0.

    Examples
    --------
    >>> is_customary(-9999.0), is_customary(318.2)
    (True, False)
    """
    return value in _CUSTOMARY_SET


def _find_suspect(z: Float64Array, ground: Float64Array, value: float) -> SuspectElevation | None:
    """Return the lowest or highest value if it may stand for no data."""
    is_known = value in _CUSTOMARY_SET
    # Fewer others make gap and range look no less suspicious: most values are cleared by some.
    for step in (max(1, len(z) // _SOME), 1):
        others = z[::step]
        others = others[others != value]
        count = len(z[::step]) - len(others)
        if not len(others):
            continue
        some = ground[::step]
        is_far = is_known and is_beyond_range(value, float(some.min()), float(some.max()))
        if not is_far and not _is_far_from(value, others, count if step == 1 else len(z)):
            return None
    if len(others) == 0:
        return None
    count = len(z) - len(others)
    if 2 * count > len(z) and (value == 0.0 or value not in _CUSTOMARY_SET):
        return None
    return SuspectElevation(value, count, float(others.min()), float(others.max()))


def is_beyond_range(value: float, low: float, high: float) -> bool:
    """Tell whether a gap wider than their range parts a value from others.

    Examples
    --------
    >>> is_beyond_range(0.0, 318.2, 331.0), is_beyond_range(0.0, 5.0, 331.0)
    (True, False)
    """
    return _find_half_gap(value, low, high) > high / 2 - low / 2


def _find_half_gap(value: float, low: float, high: float) -> float:
    """Return half of how far a value is beyond others; the halves cannot overflow."""
    return low / 2 - value / 2 if value < low else value / 2 - high / 2


def _is_far_from(value: float, others: Float64Array, count: int) -> bool:
    low, high = float(others.min()), float(others.max())
    size = max(abs(low), abs(high))
    half_gap, half_range = _find_half_gap(value, low, high), high / 2 - low / 2
    is_known = value in _CUSTOMARY_SET and half_gap > half_range
    is_shared = count >= _REPEATS and half_gap > _FAR * max(half_range, size / 1000)
    is_beyond = abs(value) > BEYOND >= 2.0 * float(np.median(np.abs(others) / 2.0))
    return is_known or is_shared or is_beyond


def describe_suspects(suspects: Iterable[SuspectElevation], what: str = "point") -> list[str]:
    """Return a sentence for each, which names the option that leaves such points out."""
    return [
        f"{one.count:,} {what}{' has' if one.count == 1 else 's have'} the elevation "
        f"{one.value:g}, far from the others ({height(one.lowest)} to "
        f"{height(one.highest)}): if it stands for "
        f"no data, `nodata={one.value:g}` leaves {'it' if one.count == 1 else 'them'} out."
        for one in suspects
    ]


def describe_elevations(z: Float64Array, what: str = "point") -> list[str]:
    """Say which finite elevations may stand for no data, or that all of them may.

    And which are in another unit than most.

    Examples
    --------
    >>> describe_elevations(np.zeros(4))
    ['All 4 points have the elevation 0: check that it stands not for no data.']
    """
    if len(z) >= _REPEATS and is_customary(float(z[0])) and bool((z == z[0]).all()):
        return [
            f"All {len(z):,} {what}s have the elevation {height(z[0])}: check that it "
            "stands not for no "
            "data."
        ]
    told = []
    multiplied = find_multiplied(z)
    if multiplied is not None:
        count = int(multiplied.is_wrong.sum())
        told.append(
            f"{counted(count, what)} {inflect('[has an elevation|have elevations]', count)} "
            f"{multiplied.words} those of the others ({height(multiplied.lowest)} to "
            f"{height(multiplied.highest)}): check {inflect('[its|their]', count)} unit."
        )
        z = z[~multiplied.is_wrong]
    return [*told, *describe_suspects(find_suspect_elevations(z), what)]
