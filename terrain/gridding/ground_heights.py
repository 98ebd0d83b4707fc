"""Heights of points above a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._sentences import counted
from ...crs import shorten_crs
from ...errors import CrsError
from ...tin import Survey
from ...tin.validation.options import require_tin
from ...tin.validation.points import as_points
from ..results import Table

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...crs import CRS
    from ...policies import Extrapolation, InterpolationMethod
    from ...tin import TIN

__all__ = ["height_above"]

_SHOWN = 5


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
        If the cloud has another CRS than the TIN.
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
    >>> above.notes
    ('1 of 2 points lies outside the surface (rows 1): it has no height above ground.',)
    """
    require_tin(tin)
    notes: list[str] = []
    points = _points_of(cloud, tin, notes)
    ground = tin.interpolate(points[:, :2], method, extrapolate=extrapolate, threads=threads)
    notes += _describe_outside(ground)
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
        notes=notes,
    )


def _points_of(cloud: Any, tin: TIN, notes: list[str]) -> NDArray[np.float64]:
    """Return the points in the TIN's CRS and unit, and note what was done or assumed."""
    if not isinstance(cloud, Survey):
        return as_points(cloud)
    points = as_points(cloud.points)
    if not _may_be_same(cloud.crs, tin.crs):
        raise CrsError(
            f"The CRS of the points is {shorten_crs(cloud.crs)}, that of the TIN "
            f"{shorten_crs(tin.crs)}: they must be the same.",
            crs=cloud.crs,
        )
    own, ground = cloud.elevation_unit, tin.elevation_unit
    if own is None or ground is None:
        if own is not ground:
            known = own or ground
            notes.append(f"One unit of elevations is not known: both are taken to be {known}.")
        return points
    if own == ground:
        return points
    if own.metres is None or ground.metres is None:
        raise CrsError(f"Elevations in {own} and in {ground} cannot be compared.")
    notes.append(f"Elevations of the points were converted from {own} to {ground}.")
    points[:, 2] *= own.metres / ground.metres
    return points


def _may_be_same(one: CRS | None, other: CRS | None) -> bool:
    """Tell whether nothing that is known of two CRSs differs: one may lack a vertical axis."""
    if one is None or other is None:
        return True
    if one.vertical_unit is not None and other.vertical_unit is not None:
        return one.is_same(other)
    return one.horizontal.is_same(other.horizontal)


def _describe_outside(ground: NDArray[np.float64]) -> list[str]:
    rows = np.flatnonzero(np.isnan(ground))
    if len(rows) == 0:
        return []
    first = ", ".join(map(str, rows[:_SHOWN].tolist())) + (", ..." if len(rows) > _SHOWN else "")
    verb, they = ("lies", "it has") if len(rows) == 1 else ("lie", "they have")
    return [
        f"{len(rows):,} of {counted(len(ground), 'point')} {verb} outside the surface "
        f"(rows {first}): {they} no height above ground."
    ]
