"""Rasters of a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.checks import as_flag, require_count, require_tin
from ...base.errors import OptionError, choice
from ...base.georeference import describe_unknown, find_plane_units
from ...base.policies import GridOperator, InterpolationMethod, RasterSample, RasterValue
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Raster
from ..surface import PlaneMeasure, as_light
from .bands import SurfaceBand, require_covered
from .grids import as_grid, settle_storage
from .operators import GridMeasure, OperatorBand, make_measure, require_aligned
from .relief_bands import ReliefBand, choose_smooth

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.crs import CRS, Unit
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
    operator: GridOperator | None = None,
    compute_edges: bool = False,
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
    like : Raster, path-like, file object, or data set of rasterio or xarray, optional
        Take the cells of another raster, or of a raster file (a local one): its geotransform,
        rows and columns. They may be rectangles, rotated or sheared, and rows may run from south to
        north.
    grid : Grid, optional
        Take these cells. One of the three is needed.
    method : {"linear", "nearest", "laplace", "natural", "c1"}
        As :meth:`tinsmith.TIN.interpolate`; slope, aspect and hillshade without an operator follow
        ``smooth``.
    value : {"elevation", "slope", "aspect", "hillshade", "profile-curvature", "plan-curvature", \
"tangential-curvature", "mean-curvature", "gaussian-curvature", "tri", "tpi", "roughness"}
        Slope and aspect in degrees as :func:`tinsmith.slope` and :func:`tinsmith.aspect`, hillshade
        from 1 (no light) to 255 as :func:`tinsmith.hillshade`. The others are of each cell and its
        eight neighbours: curvatures with the signs and units of :func:`tinsmith.curvature`; terrain
        ruggedness index, topographic position index and roughness as gdaldem has them, in the unit
        of elevations.
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
    operator : {"horn", "zevenbergen-thorne", "riley", "wilson"}, optional
        Compute slope, aspect or hillshade of the elevations of each cell and its eight neighbours,
        as gdaldem does, by Horn (1981) or Zevenbergen and Thorne (1987), in place of the slopes of
        the surface. Curvatures are by Zevenbergen and Thorne, ruggedness is by Riley et al. (1999,
        the default) or Wilson et al. (2007).
    compute_edges : bool
        Values of cells and their neighbours also where neighbours have no elevation, and at the rim
        of the grid, as gdaldem's ``-compute_edges``. Default: none there.
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
        surface does not cover, or for which neighbours are missing. ``notes`` tell what is not
        known or was assumed, and how values were found.

    Raises
    ------
    OptionError
        If not exactly one of ``spacing``, ``like`` and ``grid`` is given, cells have no area, are
        too small for the coordinates or too many (2^31, lazily 10^11), a mean is asked for that is
        not exact, an operator of cells that are rotated or sheared, or another option is none.
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
    ``ymax - (r + 0.5) * spacing``, or where the geotransform of the grid has column ``c + 0.5``
    and row ``r + 0.5``. Values there equal those of :meth:`tinsmith.TIN.interpolate` to
    the last bit; an elevation on an edge is that of the triangle with the smaller number, as for
    :meth:`tinsmith.TIN.locate`. Slope, aspect and hillshade on an edge are those of the mean
    gradient of both sides, at a vertex those of ``tinsmith.slope(tin, per="vertex")``: cells of a
    DEM have the slopes of its vertices. Whether a centre lies on an edge or a vertex is decided
    exactly, and the order of points and triangles changes nothing. Means are integrals over the
    triangles' parts of a cell, clipped exactly but for rounding; a cell that the surface touches in
    points or lines only has none. Those of rotated cells are computed among columns and rows, where
    the vertices are rounded once. Elevations are in the unit of the TIN's.

    With an operator, ``method`` and ``at`` tell which elevations of cells it is applied to.
    Gradients [1]_ [2]_ and curvatures take both units into account; degrees count as their length
    on the ellipsoid in each row of cells. Cells that are not square have their width and height, as
    of gdaldem, and rows from south to north the values of those from north to south; cells that are
    rotated or sheared have no neighbours to the east and north, and only ruggedness, position and
    roughness are computed of them. Curvatures [2]_ are those of the polynomial through nine
    elevations by the formulas of :func:`tinsmith.curvature`: the profile and plan curvatures that
    Zevenbergen and Thorne print, and ArcGIS has, are second derivatives along and across the slope,
    which differ by factors of the slope. Ruggedness is that of [3]_ or [4]_. A raster read as
    points has its own elevations at its own cells (``like``): values are those of gdaldem.

    References
    ----------
    .. [1] B. K. P. Horn, Hill shading and the reflectance map, Proceedings of the IEEE 69 (1981),
       doi:10.1109/PROC.1981.11918.
    .. [2] L. W. Zevenbergen, C. R. Thorne, Quantitative analysis of land surface topography, Earth
       Surface Processes and Landforms 12 (1987), doi:10.1002/esp.3290120107.
    .. [3] S. J. Riley, S. D. DeGloria, R. Elliot, A terrain ruggedness index that quantifies
       topographic heterogeneity, Intermountain Journal of Sciences 5 (1999).
    .. [4] M. F. J. Wilson et al., Multiscale terrain analysis of multibeam bathymetry data for
       habitat mapping on the continental slope, Marine Geodesy 30 (2007),
       doi:10.1080/01490410701295962.

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
    >>> corners = [[0, 0, 0], [8, 0, 8], [0, 8, 0], [8, 8, 8]]
    >>> plane = TIN.from_triangles(corners, [[0, 1, 3], [0, 3, 2]])
    >>> rasterize(plane, spacing=2, value="slope", operator="horn").bands["slope"][1].round(6)
    array([nan, 45., 45., nan])
    """
    require_tin(tin)
    done = Progress(progress)
    choice("method", method, InterpolationMethod)
    choice("value", value, RasterValue)
    choice("at", at, RasterSample)
    require_count("threads", threads, or_none=True)
    is_lazy, light = as_flag("lazy", lazy), as_light(azimuth, altitude)
    of_cells = make_measure(
        value, operator, compute_edges, light=light, crs=tin.crs, elevation_unit=tin.elevation_unit
    )
    require_sample(method, value, at, smooth, of_cells)
    cells, notes = as_grid(tin, spacing=spacing, like=like, grid=grid, in_memory=not is_lazy)
    require_aligned(of_cells, cells)
    is_mean = at == "mean"
    require_covered(tin, cells, is_mean=is_mean)
    noted: tuple[str, ...] = ()
    band: SurfaceBand | OperatorBand
    if value == "elevation" or of_cells is not None:
        band = SurfaceBand(tin, cells, None, method=method, is_mean=is_mean, threads=threads)
        if of_cells is not None:
            band, noted = OperatorBand(band, cells, of_cells), (of_cells.describe(),)
            band.require_any()
    else:
        is_smooth, how = choose_smooth(tin, smooth, is_mean=is_mean)
        plane: Any = value
        measure, noted = PlaneMeasure(plane, light), (how,)
        band = ReliefBand(
            tin, cells, measure, is_smooth=is_smooth, is_mean=is_mean, threads=threads
        )
    held: Any = band if is_lazy else band.compute(done)
    stored_as, told = settle_storage(like)
    raster = Raster(
        {value: held},
        cells,
        crs=tin.crs if tin.crs is None or value == "elevation" else tin.crs.horizontal,
        stored_as=stored_as,
        units=list_units(value, tin.crs, tin.elevation_unit),
        name=value,
        notes=[*describe_unknown(tin.crs, tin.elevation_unit), *notes, *told, *noted],
    )
    done.end()
    return raster


def require_sample(
    method: str, value: RasterValue, at: str, smooth: Any, of_cells: GridMeasure | None
) -> None:
    """Refuse what is of other values, or of the surface in place of its cells."""
    is_of_elevations = value == "elevation" or of_cells is not None
    if not is_of_elevations and method != "linear":
        raise OptionError("method", method, f"linear for {value}, which triangles have")
    if is_of_elevations and smooth is not None:
        what = "elevations, which have a method" if of_cells is None else "values of cells"
        raise OptionError("smooth", smooth, f"None for {what}")
    is_direction = value == "aspect" and of_cells is None
    if at == "mean" and (method != "linear" or is_direction):
        what = "aspect, as directions have no mean" if is_direction else f"method {method}"
        raise OptionError("at", at, f"center for {what}")


def list_units(
    value: RasterValue, crs: CRS | None, elevation_unit: Unit | None
) -> dict[str, Unit | str | None]:
    """Return the unit of the band of a value."""
    if value in ("elevation", "tri", "tpi", "roughness"):
        return {value: elevation_unit}
    if value.endswith("-curvature"):
        length = find_plane_units(crs).length
        squared = "²" if value == "gaussian-curvature" else ""
        return {value: None if length is None else f"1/{length.symbol}{squared}"}
    return {value: _UNITS[value]} if value in _UNITS else {}
