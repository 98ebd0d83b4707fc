"""Heights of points above a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_tin
from ...base.georeference import agree, describe_unknown
from ...base.products import product
from ...base.results import Table
from ...base.sentences import counted
from ...tin import Survey
from ...tin.validation import as_points

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...base.policies import Extrapolation, InterpolationMethod
    from ...tin import TIN

_SHOWN = 5


@product
def height_above(
    tin: TIN,
    cloud: Survey | ArrayLike,
    *,
    method: InterpolationMethod = "linear",
    extrapolate: Extrapolation | None = None,
    threads: int | None = None,
) -> Table:
    """Measure how high points lie above a surface.

    Parameters
    ----------
    tin : TIN
        The ground.
    cloud : Survey or (n, 3) array
        Points in the TIN's CRS. Elevations of a survey in another unit than the TIN's are
        converted; those of an array are in the TIN's.
    method : {"linear", "nearest", "laplace", "natural", "c1"}
    extrapolate : {"nearest"}, optional
    threads : int, optional
        As :meth:`tinsmith.TIN.interpolate`.

    Returns
    -------
    Table
        Columns ``easting``, ``northing``, ``elevation``, ``ground`` and ``height_above_ground``,
        vertically in the unit of the TIN's elevations; the last two NaN for points outside the
        surface. ``notes`` says how many these are and which come first, and what was converted or
        assumed.

    Raises
    ------
    CrsError
        If the cloud is a survey of another CRS than the TIN's, or one of the two is not known; if
        it cannot be told whether elevations are in one unit.
    OptionError
        As :meth:`tinsmith.TIN.interpolate`.
    PointsError
        If points are not finite, or have another shape.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 5], [0, 4, 9]], [[0, 1, 2]])
    >>> above = height_above(tin, [[1, 1, 10], [5, 5, 10]])
    >>> above["height_above_ground"]
    array([ 6., nan])
    >>> above.notes[-1]
    '1 of 2 points lies outside the surface (rows 1): it has no height above ground.'
    """
    require_tin(tin)
    points, notes = place_points(cloud, tin)
    ground = tin.interpolate(points[:, :2], method=method, extrapolate=extrapolate, threads=threads)
    x, y, z = points.T
    vertical = dict.fromkeys(("elevation", "ground", "height_above_ground"), tin.elevation_unit)
    across = None if tin.crs is None else tin.crs.horizontal_unit
    return Table(
        {
            "easting": x,
            "northing": y,
            "elevation": z,
            "ground": ground,
            "height_above_ground": z - ground,
        },
        units={"easting": across, "northing": across, **vertical},
        name="height above ground",
        notes=[*notes, *_describe_outside(ground)],
    )


def place_points(cloud: Any, tin: TIN) -> tuple[Float64Array, tuple[str, ...]]:
    """Return the points in the TIN's unit, and what was done or assumed."""
    if not isinstance(cloud, Survey):
        return as_points(cloud), describe_unknown(tin.crs, tin.elevation_unit)
    found = agree((tin, cloud), ("the surface", "the points"))
    points = as_points(cloud.points)
    factor = found.factors[1] / found.factors[0]
    if factor != 1.0:
        points[:, 2] *= factor
    return points, found.notes


def _describe_outside(ground: Float64Array) -> list[str]:
    rows = np.flatnonzero(np.isnan(ground))
    if len(rows) == 0:
        return []
    first = ", ".join(map(str, rows[:_SHOWN].tolist())) + (", ..." if len(rows) > _SHOWN else "")
    verb, they = ("lies", "it has") if len(rows) == 1 else ("lie", "they have")
    return [
        f"{len(rows):,} of {counted(len(ground), 'point')} {verb} outside the surface "
        f"(rows {first}): {they} no height above ground."
    ]
