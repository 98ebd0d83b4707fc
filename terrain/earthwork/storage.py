"""Stage and storage: how much lies under each level of a pond."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_floats, as_number
from ...base.crs import CRS
from ...base.errors import OptionError, PointsError
from ...base.georeference import require_same_crs
from ...base.products import product
from ...base.results import Features, Table
from .. import _kernel
from ..surface import Surface, cut_pieces, find_reference, require_finite
from .regions import as_regions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...tin import TIN

_MOST_LEVELS = 100_000
_USUAL_LEVELS = 20
"""So many levels a table has at most, if nothing else is asked for."""


@product
def stage_storage(
    tin: TIN,
    *,
    levels: ArrayLike | None = None,
    interval: float | None = None,
    region: Any = None,
) -> Table:
    """Tabulate area and volume of the water that stands in a surface at each level.

    Parameters
    ----------
    tin : TIN
    levels : sequence of float, optional
        In the unit of elevations.
    interval : float, optional
        Or multiples of this, from the lowest place to the highest; default one of 1, 2 or 5 times
        a power of ten, for at most 20 levels.
    region : polygon, optional
        Only inside: of a survey with several hollows take one, for water is counted wherever the
        surface is under the level.

    Returns
    -------
    Table
        ``level``; ``depth`` above the lowest place; ``area`` of the water; ``wetted_area``, of the
        ground under it, in space; ``volume``; ``is_contained``, whether the level stays below the
        boundary of the surface, or of the region, all around: else water would run out of what was
        surveyed, and the row holds only what is inside.

    Raises
    ------
    OptionError
        If both levels and interval are given, a level is not finite, or there are more than
        100,000.
    CrsError
        If coordinates are degrees.

    Notes
    -----
    Every row is the closed form of the piecewise linear surface, exact but for roundings: volumes
    between rows are not those of a straight line, but of another call with that level.

    Examples
    --------
    >>> import tinsmith as ts
    >>> pond = ts.triangulate([[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3], [3, 3, 0]])
    >>> table = ts.stage_storage(pond, levels=[1, 2, 3])
    >>> table["area"], table["volume"].round(3)
    (array([ 4., 16., 36.]), array([ 1.333, 10.667, 36.   ]))
    """
    reference = find_reference(tin, "Volumes")
    notes = reference.notes
    surface = Surface(tin.triangulation.points, tin.triangulation.triangles)
    if region is not None:
        surface, said = _cut_out(surface, region, tin.crs)
        notes += said
    elevations = surface.points[surface.triangles.ravel(), 2]
    lowest, highest = float(elevations.min()), float(elevations.max())
    wanted = _as_levels(levels, interval, lowest, highest)
    order = np.argsort(wanted, kind="stable")
    sums = np.empty((len(wanted), 3))
    sums[order] = _kernel.stage_sums(surface.points, surface.triangles, wanted[order], reference.up)
    require_finite(sums)
    columns = {
        "level": wanted,
        "depth": np.maximum(wanted - lowest, 0.0),
        "area": sums[:, 0],
        "wetted_area": sums[:, 1],
        "volume": sums[:, 2] * reference.up,
        "is_contained": wanted <= surface.points[surface.find_border(), 2].min(),
    }
    units = dict.fromkeys(("level", "depth"), reference.elevation_unit)
    square, cube = reference.units.area, reference.units.volume
    return Table(
        columns,
        units=units | {"area": square, "wetted_area": square, "volume": cube},
        name="stage and storage",
        notes=notes,
    )


def _cut_out(surface: Surface, region: Any, crs: CRS | None) -> tuple[Surface, tuple[str, ...]]:
    """Return the part of a surface in a region, and what was assumed of it."""
    theirs = CRS.of(getattr(region, "crs", None))
    notes = require_same_crs(theirs, crs, "the region", is_plain=not hasattr(region, "crs"))
    notes += tuple(region.notes) if isinstance(region, Features) else ()
    pieces = cut_pieces(surface, as_regions({"region": region}, crs)[1]).surface
    if len(pieces.triangles) == 0:
        raise PointsError("The region lies outside the surface: it holds nothing.")
    return pieces, notes


def _as_levels(levels: Any, interval: Any, lowest: float, highest: float) -> Float64Array:
    if levels is not None:
        if interval is not None:
            raise OptionError("interval", interval, allowed="None where levels are given")
        return _as_given_levels(levels)
    if interval is None:
        interval = _choose_interval(highest - lowest)
    step = as_number("interval", interval, above=0)
    first, last = math.ceil(lowest / step), math.ceil(highest / step)
    if last - first >= _MOST_LEVELS:
        allowed = f"larger: there would be {last - first + 1:,} levels, at most {_MOST_LEVELS:,}"
        raise OptionError("interval", interval, allowed=allowed)
    return np.arange(first, last + 1, dtype=np.float64) * step


def _as_given_levels(levels: Sequence[float]) -> Float64Array:
    given = as_floats(levels)
    if given is None:
        raise OptionError("levels", type(levels).__name__, allowed="numbers")
    array = np.atleast_1d(given)
    if array.ndim != 1 or not 0 < len(array) <= _MOST_LEVELS:
        allowed = f"from 1 to {_MOST_LEVELS:,}"
        raise OptionError("levels", array.size, allowed=allowed, what="number of levels")
    if not np.isfinite(array).all():
        bad = float(array[~np.isfinite(array)][0])
        raise OptionError("levels", bad, allowed="finite")
    return array


def _choose_interval(relief: float) -> float:
    if relief <= 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(relief / _USUAL_LEVELS))
    return next(
        (step * power for step in (1, 2, 5) if step * power * _USUAL_LEVELS >= relief), 10 * power
    )
