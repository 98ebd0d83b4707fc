"""Smoothing and simplification of contours that never touch and stay within a tolerance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import OptionError
from .. import _kernel

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ...tin import TIN
    from .._kernel import ContourLines

MOST_POINTS = (2**31 - 1) // 16
"""Of all lines together: the kernel numbers in 31 bits what rounds of cutting corners make."""

_ROUNDS = 3
"""So often corners are cut: what is left turns by a few degrees in each vertex."""


def smooth_lines(
    tin: TIN,
    lines: ContourLines,
    levels: Float64Array,
    *,
    smooth: float,
    simplify: float,
) -> ContourLines:
    """Round the corners of a TIN's contours, then drop points of them.

    ``smooth`` and ``simplify`` are how far the surface may be from the level along a line, for each
    of the two; 0 is neither. Raises OptionError if there are more than :data:`MOST_POINTS` points.

    Notes
    -----
    Corners are cut as by Chaikin [1]_, points are dropped as by Visvalingam and Whyatt [2]_. Each
    step moves a line over triangles that hold no vertex of any line in their closed area, by
    exact predicates; so it meets none. Its new segments are walked through the TIN: at every edge
    that they cross the elevation is within the tolerance, whatever the rounding.

    References
    ----------
    .. [1] G. M. Chaikin, An algorithm for high-speed curve generation, Computer Graphics and Image
       Processing 3 (1974), doi:10.1016/0146-664X(74)90028-8.
    .. [2] M. Visvalingam and J. D. Whyatt, Line generalisation by repeated elimination of points,
       The Cartographic Journal 30 (1993), doi:10.1179/000870493786962263.
    """
    _require_few(lines, smooth=smooth, simplify=simplify)
    places = _find_places(tin, lines)
    return _kernel.smooth_contours(
        tin.points, tin.triangles, tin.neighbors, levels, lines, places, smooth, _ROUNDS, simplify
    )


def _require_few(lines: ContourLines, **tolerances: float) -> None:
    count = len(lines.coordinates)
    if count > MOST_POINTS:
        name, value = next(item for item in tolerances.items() if item[1] > 0)
        allowed = f"left out where contours have more than {MOST_POINTS:,} points: here {count:,}"
        raise OptionError(name, value, allowed=allowed)


def _find_places(tin: TIN, lines: ContourLines) -> Int32Array:
    """Return a triangle for each point but those repeated."""
    xy = np.ascontiguousarray(lines.coordinates[:, :2])
    places = np.array(tin.locate(xy))
    # An end may lie a rounding outside; its segment lies in one triangle.
    starts, ends = lines.offsets[:-1], lines.offsets[1:] - 1
    for end, inner in ((starts, starts + 1), (ends, ends - 1)):
        lost = places[end] < 0
        places[end[lost]] = tin.locate(0.5 * (xy[end[lost]] + xy[inner[lost]]))
    is_repeated = np.zeros(len(xy), np.bool_)
    is_repeated[ends[lines.is_closed]] = True
    return places[~is_repeated]
