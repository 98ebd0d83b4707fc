"""Curvature at vertices, from the quadratic surface that fits their neighbourhood."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import require_tin
from ...base.errors import PointsError, choice
from ...base.georeference import find_scales
from ...base.policies import CurvatureKind, SurfacePart
from ...base.products import product
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import Derivatives, measure_curvatures

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN

_CHUNK = 1 << 15
"""Vertices whose curvature is computed at a time, so that what is between stays in the cache."""


@product
def curvature(
    tin: TIN, *, kind: CurvatureKind = "profile", per: SurfacePart = "vertex"
) -> Float64Array:
    """Measure how a surface is curved at each vertex.

    Parameters
    ----------
    tin : TIN
    kind : {"profile", "plan", "tangential", "mean", "gaussian"}, optional
        Along the line of steepest descent, along the contour seen from above, along the contour in
        space, the mean of all directions, or the product of the largest and the smallest.
    per : {"vertex", "triangle"}, optional
        Of a triangle it is the mean of its corners.

    Returns
    -------
    (n,) or (m,) float64 array
        Per unit of eastings, above longitude and latitude per metre; ``"gaussian"`` per its square.
        Positive where the surface is convex (a ridge), negative where it is concave (a valley).
        NaN where the neighbours are too few or lie on a conic; profile, plan and tangential also
        where the surface is level.

    Raises
    ------
    OptionError
        For another kind, or another place.
    PointsError
        If curvatures overflow.

    Notes
    -----
    A piecewise linear surface has no curvature but in its edges. So the quadratic surface through
    each vertex is taken that fits the vertices within two edges best (least squares of the
    differences in elevation, all of equal weight), as Evans and Zevenbergen and Thorne do on
    rasters: exact where the vertices lie on a quadratic surface, and smoothed across breaklines.
    Signs and formulas are those of [1]_. Linear in the pairs of vertices within two edges. The
    result does not depend on the order of points or the number of threads.

    References
    ----------
    .. [1] J. Minár, I. S. Evans, M. Jenčo, A comprehensive system of definitions of land surface
       (topographic) curvatures, Earth-Science Reviews 211 (2020),
       doi:10.1016/j.earscirev.2020.103414.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    >>> bowl = ts.triangulate(np.column_stack([x, y, 0.05 * ((x - 2) ** 2 + (y - 2) ** 2)]))
    >>> ts.curvature(bowl, kind="mean")[12].round(9)
    np.float64(-0.1)
    """
    require_tin(tin)
    choice("kind", kind, CurvatureKind)
    choice("per", per, SurfacePart)
    points, triangles = tin.triangulation.points, tin.triangulation.triangles
    scales = find_scales(tin.crs, tin.elevation_unit, points[:, 1])
    east, north = (np.atleast_1d(np.asarray(side, np.float64)) for side in scales[:2])
    threads = thread_count(None, len(points))
    derivatives = _kernel.fit_quadratics(points, triangles, east, north, scales.up, threads)
    found = np.empty(derivatives.shape[1])
    for start in range(0, len(found), _CHUNK):
        rows = slice(start, start + _CHUNK)
        with np.errstate(over="ignore", invalid="ignore"):  # refused below
            found[rows] = measure_curvatures(kind, Derivatives(*derivatives[:, rows]))
    if np.isinf(derivatives).any() or np.isinf(found).any():
        raise PointsError(
            "Elevations are too large, or points too near to each other, for curvatures in double "
            "precision: they overflow."
        )
    if per == "triangle":
        found = found[tin.triangles].mean(axis=1)
    return found
