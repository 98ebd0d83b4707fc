"""Contour lines: where the surface has an elevation, as joined polylines, smooth if asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_length, require_tin
from ...base.errors import OptionError
from ...base.georeference import describe_unknown, find_plane_units
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Features
from ...base.types import seal
from .. import _kernel
from ..surface import measure_lengths, take_without_slivers
from .levels import LevelOptions, Levels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int32Array
    from ...base.crs import CRS, Unit
    from ...tin import TIN
    from .._kernel import ContourLines

MOST_POINTS = (2**31 - 1) // 16
"""Of all lines together: the kernel numbers in 31 bits what rounds of cutting corners make."""

_ROUNDS = 3
"""So often corners are cut: what is left turns by a few degrees in each vertex."""


@product
def contours(
    tin: TIN,
    interval: float | None = None,
    *,
    levels: ArrayLike | None = None,
    base: float = 0.0,
    index: int | None = 5,
    smooth: float | None = None,
    simplify: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Features:
    """Trace the contour lines of a TIN.

    Parameters
    ----------
    tin : TIN
    interval : float, optional
        Between levels, in the unit of elevations.
    levels : (k,) array, optional
        Explicit levels instead of an interval.
    base : float, optional
        One of the levels, from which the others are counted; may lie outside the surface.
    index : int or None, optional
        Every so many contours one is an index contour: levels that are multiples of ``index``
        intervals from ``base``; of explicit levels the first and every ``index``-th after it.
    smooth : float, optional
        Round the corners, as far as the surface along the lines stays within this much of the
        level, in the unit of elevations.
    simplify : float, optional
        Drop points, likewise; after smoothing, if both are given.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages: levels chosen, lines
        traced, lines smoothed. What it raises ends the call.

    Returns
    -------
    Features
        Lines (x, y, elevation) with the columns elevation, is_index, is_closed and length. The
        higher side is on the left of each. By level, then by the first point.

    Raises
    ------
    OptionError
        If the interval is not above 0, a level is not finite, there are more than 100,000 levels
        or 2**31 - 1 crossings of triangles, or an option is none.

    Notes
    -----
    Exact for the piecewise linear surface, up to rounding of each coordinate. A level is thought
    just below its value: a vertex at a level lies above it, and a line along a flat area runs where
    the surface begins to fall. Every line therefore is closed or ends at the boundary, and no two
    lines of one level share a segment. A summit or a ridge that only just reaches a level has no
    line. Time and memory are in proportion to the triangles and the points of the lines.

    Smoothed and simplified lines never touch or cross one another, but where exact lines meet in a
    vertex at their level, and never leave the tolerance: :func:`tinsmith.check_contours` proves it.
    They have no part in triangles along the boundary that are thinner than the rounding of their
    coordinates.

    Levels are computed as decimal numbers: three steps of 0.1 are 0.3, as a vertex has it.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> lines = ts.contours(tin, interval=1.5)
    >>> lines.columns["elevation"], lines.columns["length"]
    (array([1.5, 3. ]), array([4., 4.]))
    """
    require_tin(tin)
    done = Progress(progress)
    options = LevelOptions(interval, levels, base, index)
    chosen = options.for_lines(tin)
    tolerances = [
        0.0
        if value is None
        else as_length(name, value, unit="in the unit of elevations", or_none=True)
        for name, value in (("smooth", smooth), ("simplify", simplify))
    ]
    done(0.05)
    surface = take_without_slivers(tin) if any(tolerances) else tin
    lines = _trace(surface, chosen, options)
    done(0.4 if any(tolerances) else 0.9)
    if any(tolerances) and len(lines.level):
        lines = smooth_lines(
            surface, lines, chosen.values, smooth=tolerances[0], simplify=tolerances[1]
        )
    done(0.9)
    found = as_features(lines, chosen, tin.crs, tin.elevation_unit)
    done.end()
    return found


def _trace(tin: TIN, chosen: Levels, options: LevelOptions) -> _kernel.ContourLines:
    try:
        return _kernel.trace_contours(tin.points, tin.triangles, tin.neighbors, chosen.values)
    except OverflowError as error:
        raise options.refuse_count(int(str(error)), "crossings of triangles") from None


def as_features(
    lines: _kernel.ContourLines, chosen: Levels, crs: CRS | None, elevation_unit: Unit | None
) -> Features:
    """Return contours of some levels as features."""
    length = lines.length
    if crs is not None and crs.is_geographic:
        length = measure_lengths(crs, lines.coordinates, lines.offsets)
    columns: dict[str, Any] = {
        "elevation": chosen.values[lines.level],
        "is_index": chosen.is_index[lines.level],
        "is_closed": lines.is_closed,
        "length": length,
    }
    return Features.of_lines(
        seal(lines.coordinates),
        seal(lines.offsets),
        columns={name: seal(values) for name, values in columns.items()},
        units={"elevation": elevation_unit, "length": find_plane_units(crs).length},
        crs=crs,
        elevation_unit=elevation_unit,
        name="contours",
        notes=[*describe_unknown(crs, elevation_unit), *chosen.notes],
    )


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
