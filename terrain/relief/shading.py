"""Hillshade: the surface in the light of a low sun."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._products import product
from ...errors import OptionError
from ...tin.validation.options import is_finite_number, require_tin
from ...tin.validation.threads import thread_count
from .. import _kernel
from ..drawing.rounding import round_down
from ..georeference import describe_unknown
from ..gridding.bands import SurfaceBand
from ..gridding.coverage import require_covered
from ..gridding.grids import as_grid
from ..results import Raster
from ..results.gridded import locate_centers
from .gradients import sum_normals
from .light import as_light, normalise, shade

if TYPE_CHECKING:
    from ...arrays import Float64Array, UInt8Array
    from ...tin import TIN, Grid
    from .light import Light

__all__ = ["hillshade"]

_USUAL_SIDE = 1000
_BLOCK_CELLS = 1 << 20


@product
def hillshade(
    tin: TIN,
    *,
    spacing: float | None = None,
    grid: Grid | None = None,
    azimuth: float = 315.0,
    altitude: float = 45.0,
    exaggeration: float = 1.0,
    smooth: bool = False,
) -> Raster:
    """Draw a surface in the light of a low sun, as a raster with a georeference.

    Parameters
    ----------
    tin : TIN
    spacing : float, CRS units, optional
        Side of a cell; default such that the longer side has about 1000. The grid begins at
        multiples of it.
    grid : Grid, optional
        The cells themselves, instead of ``spacing``.
    azimuth : float, degrees
        Where the light comes from, clockwise from north; default north-west.
    altitude : float, degrees
        Of the light above the horizon, 0 to 90.
    exaggeration : float
        Factor on elevations, above 0.
    smooth : bool
        Turn the normal evenly from vertex to vertex, so that no edges are seen; default the
        triangles as they are.

    Returns
    -------
    Raster
        Band ``hillshade``: 1 (no light) to 255 (light from straight above the ground), the cosine
        of the angle between light and normal at the centre of each cell, as gdaldem writes it; 0
        where there is no surface.

    Raises
    ------
    OptionError
        If a number is out of range, spacing and grid are both given, or there would be more than
        2^31 cells.
    PointsError
        If no cell would have a value: the cells are not where the surface is.

    Notes
    -----
    Of the true surface, as :func:`tinsmith.slope`: both units are taken into account. A cell whose
    centre lies on an edge has the light of the triangle with the smaller number.

    Examples
    --------
    >>> import tinsmith as ts
    >>> level = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 4, 5], [0, 4, 5]])
    >>> ts.hillshade(level, spacing=2.0).bands["hillshade"]
    array([[181, 181],
           [181, 181]], dtype=uint8)
    """
    require_tin(tin)
    light, factor = as_light(azimuth, altitude), _as_positive("exaggeration", exaggeration)
    if spacing is not None and grid is not None:
        raise OptionError("spacing", spacing, allowed="None where a grid is given")
    if not isinstance(smooth, bool | np.bool_):
        raise OptionError("smooth", smooth, allowed="True or False")
    side = _choose_spacing(tin) if spacing is None and grid is None else spacing
    cells, _ = as_grid(tin, spacing=side, grid=grid, in_memory=True)
    require_covered(tin, cells)
    upward = sum_normals(tin, "vertex" if smooth else "triangle") * (factor, factor, 1.0)
    band, height = np.zeros(cells.shape, np.uint8), max(1, _BLOCK_CELLS // cells.shape[1])
    flat = None if smooth else _as_flat_band(tin, cells, shade(upward, light))
    parts = _grid_normals(tin, normalise(upward)) if smooth else ()
    for top in range(0, cells.shape[0], height):
        rows = slice(top, min(top + height, cells.shape[0]))
        if flat is None:
            band[rows] = _shade_smoothly(parts, light, cells, rows)
        else:
            band[rows] = np.nan_to_num(flat[rows, :])
    band.flags.writeable = False
    return Raster(
        {"hillshade": band},
        cells,
        crs=None if tin.crs is None else tin.crs.horizontal,
        nodata=0,
        name="hillshade",
        notes=describe_unknown(tin.crs, tin.elevation_unit),
    )


def _choose_spacing(tin: TIN) -> float:
    return round_down(max(tin.bounds.width, tin.bounds.height) / _USUAL_SIDE)


def _as_flat_band(tin: TIN, cells: Grid, shades: UInt8Array) -> SurfaceBand:
    """Return the light of the triangle at each cell's centre, NaN outside."""
    values = shades.astype(np.float64)
    return SurfaceBand(tin, cells, values, method="linear", is_mean=False, threads=None)


def _grid_normals(tin: TIN, unit: Float64Array) -> tuple[_kernel.GriddedSurface, ...]:
    """Return surfaces of the three parts of the normals, for elevations those of vertices."""
    surface = tin.triangulation
    xy = surface.points[:, :2]
    return tuple(
        _kernel.GriddedSurface(np.column_stack([xy, part]), surface.triangles) for part in unit.T
    )


def _shade_smoothly(
    parts: tuple[_kernel.GriddedSurface, ...], light: Light, cells: Grid, rows: slice
) -> UInt8Array:
    """Return the light in the cells of some rows, normals turned evenly between vertices."""
    x, y = locate_centers(cells, rows, slice(0, cells.shape[1]))
    threads = thread_count(None, len(x) * len(y))
    found = [part.values_at_centers(x, y, cells.spacing, None, threads, None) for part in parts]
    normals = np.stack(found, axis=-1)
    is_inside = ~np.isnan(normals[..., 2])
    values = np.zeros(normals.shape[:2], np.uint8)
    values[is_inside] = shade(normals[is_inside], light)
    return values


def _as_positive(option: str, value: Any) -> float:
    if not (is_finite_number(value) and value > 0.0):
        raise OptionError(option, value, allowed="a finite number above 0")
    return float(value)
