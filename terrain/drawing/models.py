"""Lift: a TIN becomes a 3D mesh, near enough to its origin for single precision."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

import numpy as np

from ...base import optional
from ...base.checks import as_floats, as_number, require_tin
from ...base.crs import scale_elevations
from ...base.errors import OptionError
from ...base.products import product
from ..surface import compute_normals, measure_aspects, measure_slopes

if TYPE_CHECKING:
    import pyvista
    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...tin import TIN


@product
def lift(
    tin: TIN, *, origin: ArrayLike | None = None, exaggeration: float = 1.0
) -> pyvista.PolyData:
    """Turn a TIN into a mesh for 3D work, shifted by an origin that is recorded.

    Graphics cards compute in single precision, which is wrong by decimetres at the size of map
    coordinates. The origin is therefore subtracted in double precision first:
    ``points = (tin.points - origin) * (1, 1, elevation_scale * exaggeration)``, where
    ``elevation_scale`` converts elevations to the unit of eastings and northings.

    Parameters
    ----------
    tin : TIN
        In a projected CRS.
    origin : (3,) array, CRS units, optional
        Easting, northing and elevation that become (0, 0, 0); default :func:`choose_origin`.
    exaggeration : float, optional
        Factor on heights above the origin, above 0; default 1, true to scale.

    Returns
    -------
    pyvista.PolyData
        Double-precision points and triangles in the TIN's order. Point data ``elevation`` (true
        elevation, in the TIN's own unit); cell data ``slope`` and ``aspect`` of the true surface
        (degrees, aspect NaN where level); field data ``origin``, ``exaggeration``,
        ``elevation_scale``, ``crs`` and ``elevation_unit`` ("" if unknown).

    Raises
    ------
    MissingExtraError
        If pyvista is not installed.
    CrsError
        If coordinates are longitude and latitude.
    OptionError
        If the origin is not three finite numbers, or the exaggeration is not above 0.

    Examples
    --------
    >>> from tinsmith import triangulate
    >>> tin = triangulate([[500_000, 4e6, 81], [500_040, 4e6, 83], [500_000, 4_000_030, 85]])
    >>> mesh = lift(tin, origin=(500_000, 4_000_000, 80), exaggeration=2)
    >>> mesh.points.tolist()
    [[0.0, 0.0, 2.0], [40.0, 0.0, 6.0], [0.0, 30.0, 10.0]]
    >>> mesh.field_data["origin"].tolist()
    [500000.0, 4000000.0, 80.0]
    """
    pv = optional.load("pyvista", "Lifting a TIN into 3D")
    require_tin(tin)
    shift = choose_origin(tin) if origin is None else _parse_origin(origin)
    factor = as_number("exaggeration", exaggeration, above=0)
    scale = scale_elevations(tin.crs, tin.elevation_unit)
    mesh: pyvista.PolyData = pv.PolyData.from_regular_faces(
        (tin.points - shift) * (1.0, 1.0, scale * factor), np.array(tin.triangles)
    )
    mesh.point_data["elevation"] = tin.points[:, 2].copy()
    normals = compute_normals(tin)
    mesh.cell_data["slope"] = measure_slopes(normals, "degrees")
    mesh.cell_data["aspect"] = measure_aspects(normals)
    mesh.field_data["origin"] = shift
    mesh.field_data["exaggeration"] = [factor]
    mesh.field_data["elevation_scale"] = [scale]
    mesh.field_data["crs"] = ["" if tin.crs is None else str(tin.crs)]
    unit = tin.elevation_unit
    mesh.field_data["elevation_unit"] = ["" if unit is None else unit.name]
    mesh.set_active_scalars("elevation")
    return mesh


def choose_origin(tin: TIN) -> Float64Array:
    """Return the middle of a TIN, rounded to a tenth of its extent or finer: (3,), CRS units.

    Its numbers are multiples of a power of ten: short to write down, and no point is further away
    than the extent.
    """
    low, high = tin.points.min(axis=0), tin.points.max(axis=0)
    extents = (max(high[0] - low[0], high[1] - low[1]), high[2] - low[2])
    steps = [_round_down_to_power(extent) for extent in (extents[0], extents[0], extents[1])]
    origin: Float64Array = np.round((low + high) / 2 / steps) * steps
    return origin


def _round_down_to_power(extent: float) -> float:
    return 10.0 ** math.floor(math.log10(extent)) if extent > sys.float_info.min else 1.0


def _parse_origin(origin: ArrayLike) -> Float64Array:
    shift = as_floats(origin)
    if shift is None or shift.shape != (3,) or not np.isfinite(shift).all():
        raise OptionError("origin", origin, "three finite numbers: easting, northing, elevation")
    return shift
