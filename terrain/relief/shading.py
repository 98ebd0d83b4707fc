"""Hillshade: the surface in the light of a low sun."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...errors import OptionError
from ...tin.types import Bounds, Grid
from ...tin.validation.options import require_tin
from ..results import Raster
from ..results.gridded import cell_centers
from ..rounding import round_down
from ..slope import sum_normals

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN

__all__ = ["Light", "grid_over", "hillshade", "shade"]

_DARKEST, _BRIGHTEST = 1, 255
"""As gdaldem writes them; 0 is outside."""
_USUAL_SIDE = 1000
_MOST_CELLS = 2**31 - 1
_BLOCK_CELLS = 1 << 20


class Light(NamedTuple):
    """Where the light comes from, degrees.

    Attributes
    ----------
    azimuth : float
        Clockwise from north.
    altitude : float
        Above the horizon.
    """

    azimuth: float
    altitude: float


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
        2,147,483,647 cells.

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
    light = _as_light(azimuth, altitude)
    factor = _as_positive("exaggeration", exaggeration)
    cells = _as_grid(tin, spacing, grid)
    normals = sum_normals(tin, "vertex" if smooth else "triangle")
    unit = _with_length_one(normals * (factor, factor, 1.0))
    band = np.zeros(cells.shape, np.uint8)
    east, north = cell_centers(cells)
    height = max(1, _BLOCK_CELLS // cells.shape[1])
    for top in range(0, cells.shape[0], height):
        rows = slice(top, min(top + height, cells.shape[0]))
        band[rows] = _shade_block(tin, unit, light, east, north[rows], smooth=smooth)
    band.flags.writeable = False
    return Raster(
        {"hillshade": band},
        cells,
        crs=None if tin.crs is None else tin.crs.horizontal,
        nodata=0,
        name="hillshade",
    )


def shade(unit_normals: NDArray[np.float64], light: Light) -> NDArray[np.uint8]:
    """Return the light on planes, 1 to 255.

    Parameters
    ----------
    unit_normals : (k, 3) float64 array
        Upward, of length 1.
    light : Light
    """
    turn, rise = math.radians(light.azimuth), math.radians(light.altitude)
    towards = (math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise), math.sin(rise))
    cosine = np.clip(unit_normals @ np.array(towards), 0.0, 1.0)
    levels = _DARKEST + (_BRIGHTEST - _DARKEST) * np.nan_to_num(cosine)
    return np.asarray(np.rint(levels), np.uint8)


def _shade_block(
    tin: TIN,
    unit: NDArray[np.float64],
    light: Light,
    east: NDArray[np.float64],
    north: NDArray[np.float64],
    *,
    smooth: bool,
) -> NDArray[np.uint8]:
    """Return the light in the cells of some rows."""
    xy = np.stack([np.tile(east, len(north)), np.repeat(north, len(east))], axis=1)
    found = tin.locate(xy)
    is_inside = found >= 0
    triangle = found[is_inside]
    values = np.zeros(len(xy), np.uint8)
    if smooth:
        values[is_inside] = shade(_normals_at(tin, unit, triangle, xy[is_inside]), light)
    else:
        values[is_inside] = shade(unit, light)[triangle]
    return values.reshape(len(north), len(east))


def _normals_at(
    tin: TIN, unit: NDArray[np.float64], triangle: NDArray[np.int32], xy: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the normals of vertices, mixed by the place in the triangle."""
    corners = tin.triangles[triangle]
    a, b, c = (tin.points[corners[:, k], :2] for k in range(3))
    whole = _cross(b - a, c - a)
    shares = [_cross(c - b, xy - b), _cross(a - c, xy - c), _cross(b - a, xy - a)]
    mixed = sum((share / whole)[:, None] * unit[corners[:, k]] for k, share in enumerate(shares))
    return _with_length_one(np.asarray(mixed, np.float64))


def _cross(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _with_length_one(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(invalid="ignore"):
        return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True), np.float64)


# ------------------------------------------------------------------------------ options


def grid_over(bounds: Bounds, spacing: float) -> Grid:
    """Return the cells, at multiples of their side, that cover some bounds.

    Examples
    --------
    >>> grid_over(Bounds(0.5, 0.5, 3.5, 2.0), 1.0)
    Grid(bounds=Bounds(xmin=0.0, ymin=0.0, xmax=4.0, ymax=2.0), shape=(2, 4), spacing=1.0)
    """
    left, low = math.floor(bounds.xmin / spacing), math.floor(bounds.ymin / spacing)
    columns = max(1, math.ceil(bounds.xmax / spacing) - left)
    rows = max(1, math.ceil(bounds.ymax / spacing) - low)
    box = Bounds(left * spacing, low * spacing, (left + columns) * spacing, (low + rows) * spacing)
    return Grid(box, (rows, columns), spacing)


def _as_grid(tin: TIN, spacing: Any, grid: Any) -> Grid:
    require_tin(tin)
    if grid is not None and spacing is not None:
        raise OptionError("spacing", spacing, allowed="None where a grid is given")
    if grid is not None and not isinstance(grid, Grid):
        raise OptionError("grid", grid, allowed="a Grid")
    if grid is None:
        bounds = Bounds.of(tin.points)
        side = max(bounds.width, bounds.height)
        usual = round_down(side / _USUAL_SIDE)
        cell = usual if spacing is None else _as_positive("spacing", spacing)
        _require_few(bounds.width / cell + 1, bounds.height / cell + 1)
        grid = grid_over(bounds, cell)
    cells: Grid = grid
    _require_few(*cells.shape)
    return cells


def _require_few(columns: float, rows: float) -> None:
    if not columns * rows <= _MOST_CELLS:
        raise OptionError(
            "number of cells", float(columns * rows), allowed=f"{_MOST_CELLS:,} at most"
        )


def _as_light(azimuth: Any, altitude: Any) -> Light:
    light = Light(_as_finite(azimuth), _as_finite(altitude))
    if math.isnan(light.azimuth):
        raise OptionError("azimuth", azimuth, allowed="a finite number of degrees")
    if not 0.0 <= light.altitude <= 90.0:
        raise OptionError("altitude", altitude, allowed="a number of degrees from 0 to 90")
    return light


def _as_positive(option: str, value: Any) -> float:
    number = _as_finite(value)
    if not number > 0.0:
        raise OptionError(option, value, allowed="a finite number above 0")
    return number


def _as_finite(value: Any) -> float:
    """Return a number, NaN for what is none or not finite."""
    try:
        number = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan
    return number if math.isfinite(number) else math.nan
