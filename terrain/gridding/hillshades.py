"""Hillshade: the surface in the light of a low sun."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_number, require_tin
from ...base.errors import OptionError
from ...base.georeference import describe_unknown
from ...base.products import product
from ...base.results import Raster
from ..drawing import round_down
from ..surface import PlaneMeasure, as_light
from .bands import require_covered
from .grids import as_grid
from .relief_bands import ReliefBand, choose_smooth

if TYPE_CHECKING:
    from ...tin import TIN, Grid

_USUAL_SIDE = 1000
_BLOCK_CELLS = 1 << 20


@product
def hillshade(
    tin: TIN,
    *,
    spacing: float | None = None,
    like: Any = None,
    grid: Grid | None = None,
    azimuth: float = 315.0,
    altitude: float = 45.0,
    exaggeration: float = 1.0,
    smooth: bool | None = None,
) -> Raster:
    """Draw a surface in the light of a low sun, as a raster with a georeference.

    Parameters
    ----------
    tin : TIN
    spacing : float, CRS units, optional
        Side of a cell; default such that the longer side has about 1000. The grid begins at
        multiples of it.
    like : Raster, path-like, file object, or data set of rasterio or xarray, optional
        Take the cells of another raster, as :func:`tinsmith.rasterize`.
    grid : Grid, optional
        The cells themselves, instead of ``spacing``.
    azimuth : float, degrees
        Where the light comes from, clockwise from north; default north-west.
    altitude : float, degrees
        Of the light above the horizon, 0 to 90.
    exaggeration : float
        Factor on elevations, above 0.
    smooth : bool, optional
        Turn the normal evenly from vertex to vertex, so that no edges are seen, or take the
        triangles as they are. Default True where the points are the cells of a raster without
        breaklines, else False; ``notes`` tell which was taken.

    Returns
    -------
    Raster
        Band ``hillshade``: 1 (no light) to 255 (light from straight above the ground), the cosine
        of the angle between light and normal at the centre of each cell, as gdaldem writes it; 0
        where there is no surface.

    Raises
    ------
    OptionError
        If a number is out of range, more than one of spacing, like and grid is given, or there
        would be more than 2^31 cells.
    PointsError
        If no cell would have a value: the cells are not where the surface is.

    Notes
    -----
    Of the true surface, as :func:`tinsmith.slope`: both units are taken into account. A cell whose
    centre lies on an edge has the light of the mean gradient of both sides, one whose centre is a
    vertex that of the sum of the normals around it, both decided exactly.

    Examples
    --------
    >>> import tinsmith as ts
    >>> level = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 4, 5], [0, 4, 5]])
    >>> ts.hillshade(level, spacing=2.0).bands["hillshade"]
    array([[181, 181],
           [181, 181]], dtype=uint8)
    """
    require_tin(tin)
    light, factor = as_light(azimuth, altitude), as_number("exaggeration", exaggeration, above=0)
    if spacing is not None and (grid is not None or like is not None):
        raise OptionError("spacing", spacing, allowed="None where a grid is given")
    is_smooth, note = choose_smooth(tin, smooth)
    if spacing is None and grid is None and like is None:
        spacing = round_down(max(tin.bounds.width, tin.bounds.height) / _USUAL_SIDE)
    cells, noted = as_grid(tin, spacing=spacing, like=like, grid=grid, in_memory=True)
    require_covered(tin, cells)
    lights = ReliefBand(tin, cells, PlaneMeasure("hillshade", light, factor), is_smooth=is_smooth)
    band, height = np.zeros(cells.shape, np.uint8), max(1, _BLOCK_CELLS // cells.shape[1])
    for top in range(0, cells.shape[0], height):
        rows = slice(top, min(top + height, cells.shape[0]))
        band[rows] = np.nan_to_num(lights[rows, :])
    band.flags.writeable = False
    return Raster(
        {"hillshade": band},
        cells,
        crs=None if tin.crs is None else tin.crs.horizontal,
        nodata=0,
        name="hillshade",
        notes=[*describe_unknown(tin.crs, tin.elevation_unit), *noted, note],
    )
