"""Rasters of a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.checks import as_flag, require_count, require_tin
from ...base.errors import OptionError, choice
from ...base.georeference import describe_unknown
from ...base.policies import InterpolationMethod, RasterSample, RasterValue
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Raster
from ..surface import PlaneMeasure, as_light
from .bands import SurfaceBand, require_covered
from .grids import as_grid
from .relief_bands import ReliefBand, choose_smooth

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.crs import Unit
    from ...tin import TIN, Grid

_UNITS = {"slope": "°", "aspect": "°"}


@product
def rasterize(
    tin: TIN,
    *,
    spacing: float | None = None,
    like: Any = None,
    grid: Grid | None = None,
    method: InterpolationMethod = "linear",
    value: RasterValue = "elevation",
    at: RasterSample = "center",
    azimuth: float = 315.0,
    altitude: float = 45.0,
    smooth: bool | None = None,
    lazy: bool = False,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Raster:
    """Turn a surface into a raster.

    Parameters
    ----------
    tin : TIN
    spacing : float, optional
        Side of a square cell, CRS units. The cells' edges lie at its multiples, and they cover the
        bounds of the TIN.
    like : Raster, str, os.PathLike, or data set of rasterio or xarray, optional
        Take the cells of another raster, or of a raster file (a plain local one; of
        :func:`tinsmith.rasterize` only).
    grid : Grid, optional
        Take these cells. One of the three is needed.
    method : {"linear", "nearest", "laplace", "natural", "c1"}
        As :meth:`tinsmith.TIN.interpolate`; other values than elevations follow ``smooth``.
    value : {"elevation", "slope", "aspect", "hillshade"}
        Slope and aspect in degrees as :func:`tinsmith.slope` and :func:`tinsmith.aspect`, hillshade
        from 1 (no light) to 255 as :func:`tinsmith.hillshade`.
    at : {"center", "mean"}
        The value at the centre of each cell, or the mean over the part of it that the surface
        covers.
    azimuth, altitude : float
        Where the light comes from for hillshade: degrees clockwise from north, and above the
        horizon.
    smooth : bool, optional
        For slope, aspect and hillshade: let the normals change evenly from vertex to vertex, or
        take those of the triangles. Default True where the points are the cells of a raster without
        breaklines, else False; ``notes`` tell which was taken.
    lazy : bool
        Compute cells as they are asked for, such as by :func:`tinsmith.write`, for a raster larger
        than memory.
    threads : int, optional
        Default: every core, where it pays. The result is the same for any number.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0: by tiles of cells, or for other methods
        than the linear one by strips of some 4 million cells. What it raises ends the call. A lazy
        raster is done at once.

    Returns
    -------
    Raster
        One band, named as the value; NaN in cells whose centre (whose whole, for means) the
        surface does not cover. ``notes`` tell what is not known or was assumed.

    Raises
    ------
    OptionError
        If not exactly one of ``spacing``, ``like`` and ``grid`` is given, cells are not square,
        too small for the coordinates or too many (2^31, lazily 10^11), a mean is asked for that is
        not exact, or another option is none.
    CrsError
        If the other raster has another CRS, or that of the TIN is not known.
    PointsError
        If no cell would have a value: the cells are not where the surface is.
    ReadError
        If the raster file cannot be read.
    MissingExtraError
        If a raster file is given and rasterio is not installed.

    Notes
    -----
    The centre of the cell in row r and column c lies at ``xmin + (c + 0.5) * spacing``,
    ``ymax - (r + 0.5) * spacing``. Values there equal those of :meth:`tinsmith.TIN.interpolate` to
    the last bit; an elevation on an edge is that of the triangle with the smaller number, as for
    :meth:`tinsmith.TIN.locate`. Slope, aspect and hillshade on an edge are those of the mean
    gradient of both sides, at a vertex those of ``tinsmith.slope(tin, per="vertex")``: cells of a
    DEM have the slopes of its vertices. Whether a centre lies on an edge or a vertex is decided
    exactly, and the order of points and triangles changes nothing. Means are integrals over the
    triangles' parts of a cell, clipped exactly but for rounding; a cell that the surface touches in
    points or lines only has none. Elevations are in the unit of the TIN's.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 5], [0, 4, 9]], [[0, 1, 2]])
    >>> raster = rasterize(tin, spacing=2)
    >>> raster.bands["elevation"]
    array([[ 8., nan],
           [ 4.,  6.]])
    >>> rasterize(tin, spacing=4, at="mean").bands["elevation"].round(6)
    array([[5.]])
    """
    require_tin(tin)
    done = Progress(progress)
    _require_options(method, value, at, smooth)
    require_count("threads", threads, or_none=True)
    is_lazy, light = as_flag("lazy", lazy), as_light(azimuth, altitude)
    cells, notes = as_grid(tin, spacing=spacing, like=like, grid=grid, in_memory=not is_lazy)
    is_mean = at == "mean"
    require_covered(tin, cells, is_mean=is_mean)
    noted: tuple[str, ...] = ()
    if value == "elevation":
        band = SurfaceBand(tin, cells, None, method=method, is_mean=is_mean, threads=threads)
    else:
        is_smooth, how = choose_smooth(tin, smooth, is_mean=is_mean)
        measure, noted = PlaneMeasure(value, light), (how,)
        band = ReliefBand(
            tin, cells, measure, is_smooth=is_smooth, is_mean=is_mean, threads=threads
        )
    held: Any = band if is_lazy else band.compute(done)
    raster = Raster(
        {value: held},
        cells,
        crs=tin.crs if tin.crs is None or value == "elevation" else tin.crs.horizontal,
        units=list_units(value, tin.elevation_unit),
        name=value,
        notes=[*describe_unknown(tin.crs, tin.elevation_unit), *notes, *noted],
    )
    done.end()
    return raster


def _require_options(method: str, value: str, at: str, smooth: Any) -> None:
    choice("method", method, InterpolationMethod)
    choice("value", value, RasterValue)
    choice("at", at, RasterSample)
    if value != "elevation" and method != "linear":
        raise OptionError("method", method, f"linear for {value}, which triangles have")
    if value == "elevation" and smooth is not None:
        raise OptionError("smooth", smooth, "None for elevations, which have a method")
    if at == "mean" and (method != "linear" or value == "aspect"):
        what = "aspect, as directions have no mean" if value == "aspect" else f"method {method}"
        raise OptionError("at", at, f"center for {what}")


def list_units(value: str, elevation_unit: Unit | None) -> dict[str, Unit | str | None]:
    """Return the unit of the band of a value."""
    if value == "elevation":
        return {value: elevation_unit}
    return {value: _UNITS[value]} if value in _UNITS else {}
