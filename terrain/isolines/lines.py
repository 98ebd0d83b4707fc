"""Contour lines: where the surface has an elevation, as joined polylines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.checks import as_length, require_tin
from ...base.georeference import describe_unknown, find_plane_units
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Features
from ...base.types import seal
from .. import _kernel
from ..surface import measure_lengths, take_without_slivers
from .levels import LevelOptions, Levels
from .smoothing import smooth_lines

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.crs import CRS, Unit
    from ...tin import TIN


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
