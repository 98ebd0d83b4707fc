"""How large residuals are around each point, whatever single ones are: robust and local."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array

NORMAL = 1.4826
"""Times the median absolute deviation is the standard deviation of a normal distribution."""

_BLOCK = 64
"""Residuals that tell one scale: their median absolute deviation is then good to some 15 %."""
_LEAST_SHARE = 0.25
"""Of the scale of all: where the ground is flatter than this, scales are no longer believed."""
_SOME = 20_000
_ROUNDING = 1e-9
_MOST_DECIMALS = 7


def measure_scales(
    xy: Float64Array,
    residuals: Float64Array,
    moments: Float64Array,
    least: float,
) -> Float64Array:
    """Return the robust scale of the residuals around each place.

    Points are taken in blocks of 64 that lie together. The scale of a block is 1.4826 times the
    median absolute deviation of its residuals from zero, which half of them may spoil without
    harm [1]_. Blocks are made twice, of strips in either direction, and the larger scale counts,
    so that it matters less where borders of blocks lie. A residual over a wider gap than is usual
    in its block has a larger scale, in proportion to how much wider it is.

    Residuals are NaN for those that say nothing; ``moments`` are the mean squares of the distances
    to the points that each was measured from; no scale is smaller than ``least``. All are (n,),
    scales in the unit of the residuals.

    References
    ----------
    .. [1] Hampel, F. R. (1974). The influence curve and its role in robust estimation. Journal of
       the American Statistical Association 69(346), 383-393.
       https://doi.org/10.1080/01621459.1974.10482962
    """
    sizes = np.abs(residuals)
    if np.isnan(sizes).all():
        return np.full(len(sizes), least)
    scales = np.full(len(sizes), max(least, _LEAST_SHARE * NORMAL * float(np.nanmedian(sizes))))
    for axis in (0, 1):
        order = _sort_by_strips(xy[:, axis], xy[:, 1 - axis])
        with np.errstate(invalid="ignore", divide="ignore"):
            wider = np.sqrt(moments[order] / _find_medians(moments[order]))
        own = NORMAL * _find_medians(sizes[order]) * np.fmax(wider, 1.0)
        scales[order] = np.fmax(scales[order], own)
    return scales


def _sort_by_strips(along: Float64Array, across: Float64Array) -> Int64Array:
    """Return the order of points in strips, forth and back, so that 64 of them lie together.

    That is ``np.lexsort((along, strip))``, strip after strip: in 0.4 of the time.
    """
    count = len(along)
    strips = max(1, round(float(np.sqrt(count / _BLOCK))))
    strip = np.empty(count, np.uint16)  # of 2^31 points there are 5,793
    strip[np.argsort(across)] = np.arange(count) * strips // max(count, 1)
    forth = np.where(strip % 2 == 0, along, -along)
    order = np.argsort(strip, kind="stable")
    for part in np.split(order, np.cumsum(np.bincount(strip, minlength=strips))[:-1]):
        part[:] = part[np.argsort(forth[part], kind="stable")]
    return order


def _find_medians(values: Float64Array) -> Float64Array:
    """Return for each value the median of the 64 that it is one of, without NaN; NaN of none.

    Values that are left over at the end belong to the last 64.
    """
    blocks = -(-len(values) // _BLOCK)
    padded = np.full(blocks * _BLOCK, np.nan)
    padded[: len(values)] = values
    table = padded.reshape(blocks, _BLOCK)
    if len(values) > _BLOCK:
        table[-1] = values[-_BLOCK:]
    ordered = np.sort(table, axis=1)  # NaN comes last
    counts = np.isfinite(ordered).sum(axis=1)
    lower, upper = (
        ordered[np.arange(blocks), np.maximum(at, 0)] for at in ((counts - 1) // 2, counts // 2)
    )
    medians = np.where(counts > 0, (lower + upper) / 2, np.nan)
    return np.repeat(medians, _BLOCK)[: len(values)]


def find_rounding(z: Float64Array) -> float:
    """Return the standard deviation of what elevations lost when they were rounded to decimals.

    Examples
    --------
    >>> find_rounding(np.array([318.2, 318.7, 319.4, 318.2])).__round__(6)
    0.028868
    """
    some = z[:: max(1, len(z) // _SOME)]
    finest = _ROUNDING * max(float(np.median(np.abs(some))), 1.0)
    for decimals in range(_MOST_DECIMALS):
        step = 10.0**-decimals
        if (np.abs(some - np.round(some, decimals)) <= finest).all():
            return float(max(step / np.sqrt(12.0), finest))
    return finest
