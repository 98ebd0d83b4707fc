"""Slope and aspect: how steep the surface is, and which way it falls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.errors import choice
from ...base.policies import SlopeUnit, SurfacePart
from ...base.products import product
from ..surface import measure_aspects, measure_slopes, sum_normals

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN


@product
def slope(tin: TIN, *, unit: SlopeUnit = "degrees", per: SurfacePart = "triangle") -> Float64Array:
    """Measure the slope of each triangle, or at each vertex.

    Parameters
    ----------
    tin : TIN
    unit : {"degrees", "percent", "ratio"}, optional
        Angle with the horizontal plane, or rise over run, of 100 or of 1.
    per : {"triangle", "vertex"}, optional
        At a vertex it is that of the mean normal of its triangles, weighted by their areas in
        space; so the gradient is their mean weighted by their areas in the plane.

    Returns
    -------
    (m,) or (n,) float64 array
        In degrees 0 (level) to 90, in percent or as a ratio from 0 on; NaN at a vertex that no
        triangle has.

    Raises
    ------
    OptionError
        For another unit, or another place.

    Notes
    -----
    It is the slope of the true surface: elevations are converted from ``tin.elevation_unit`` to the
    unit of the CRS's eastings. If their unit is not known it is taken to be that of the eastings,
    metres above longitude and latitude. Degrees count as their length on the ellipsoid at the
    middle of each triangle, which holds for triangles of some kilometres.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> slope(tin).round(6), slope(tin, unit="percent", per="vertex").round(6)
    (array([45.]), array([100., 100., 100.]))
    """
    choice("unit", unit, SlopeUnit)
    return measure_slopes(sum_normals(tin, per), unit)


@product
def aspect(tin: TIN, *, per: SurfacePart = "triangle") -> Float64Array:
    """Find the direction in which each triangle, or the surface at each vertex, falls.

    Parameters
    ----------
    tin : TIN
    per : {"triangle", "vertex"}, optional
        As in :func:`slope`.

    Returns
    -------
    (m,) or (n,) float64 array, degrees
        Azimuth of the steepest descent, clockwise from grid north (of a geographic CRS
        true north), 0 up to but not including 360; NaN where it is level and falls nowhere.

    Raises
    ------
    OptionError
        For another place.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> aspect(tin)
    array([270.])
    """
    return measure_aspects(sum_normals(tin, per))
