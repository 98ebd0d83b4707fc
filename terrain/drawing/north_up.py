"""North up: what is drawn, with coordinates to the east and north whatever the axes of its CRS."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ...base.crs import CRS
from ...base.georeference import Axes, DrawnCRS, find_axes
from ...base.results import Features, Raster, find_turn
from ...base.types import Grid
from ...tin import Bounds, Survey
from ...tin.surface import Surface

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN

T = TypeVar("T")


def draw_north_up(shown: T) -> T:
    """Return a surface, survey, features or raster with eastings and northings, for a drawing.

    What has them already, and anything else, is returned as it is.
    """
    crs = getattr(shown, "crs", None)
    if not isinstance(crs, CRS):
        return shown
    axes = find_axes(crs)
    if axes.are_usual:
        return shown
    made: Any = shown
    if isinstance(shown, Surface):
        made = _turn_surface(shown, axes, DrawnCRS(crs, axes))
    elif isinstance(shown, Survey):
        made = _turn_survey(shown, axes, DrawnCRS(crs, axes))
    elif isinstance(shown, Features):
        made = _turn_features(shown, axes, DrawnCRS(crs, axes))
    elif isinstance(shown, Raster):
        made = _turn_raster(shown, axes, DrawnCRS(crs, axes))
    return made  # type: ignore[no-any-return]


def _turn_surface(tin: Surface, axes: Axes, crs: DrawnCRS) -> TIN:
    points = axes.turn(tin.points)
    if not axes.are_mirrored:
        return tin.replace(points=points, crs=crs)
    made = type(tin.to_tin()).from_triangles(
        points,
        tin.triangles,
        constrained=tin.constrained,
        crs=crs,
        elevation_unit=tin.elevation_unit,
    )
    kept = {name: getattr(tin, name) for name in ("vertex_of", "report", "lines", "row_attributes")}
    return made.replace(**kept).with_source(tin.source)


def _turn_survey(survey: Survey, axes: Axes, crs: DrawnCRS) -> Survey:
    """Return the points alone: what is drawn of a survey."""
    return replace(
        survey,
        points=axes.turn(survey.points),
        crs=crs,
        breaklines=(),
        boundary=(),
        holes=(),
        erase=(),
        water=(),
        extent=(),
    )


def _turn_features(features: Features, axes: Axes, crs: DrawnCRS) -> Features:
    columns = dict(features.columns)
    if "rotation" in columns:
        columns["rotation"] = _turn_texts(columns["rotation"], axes)
    return replace(features, coordinates=axes.turn(features.coordinates), columns=columns, crs=crs)


def _turn_texts(rotation: Any, axes: Axes) -> Float64Array:
    """Return the rotation of texts, degrees counter-clockwise, such that they stay upright."""
    angle = np.radians(np.asarray(rotation, np.float64))
    x, y = axes.turn(np.column_stack([np.cos(angle), np.sin(angle)])).T
    upright: Float64Array = turn_upright(np.degrees(np.arctan2(y, x)))
    return upright


def turn_upright(rotation: Any) -> Any:
    """Return the direction of texts that are read upright, above -90 up to 90 degrees.

    Examples
    --------
    >>> float(turn_upright(135.0)), float(turn_upright(-90.0))
    (-45.0, 90.0)
    """
    return rotation - 180.0 * np.ceil((rotation - 90.0) / 180.0) + 0.0


def _turn_raster(raster: Raster, axes: Axes, crs: DrawnCRS) -> Raster:
    """Return the same cells, row 0 the northernmost, column 0 the westernmost.

    Rows of a rotated raster stay rows.
    """
    if not raster.grid.is_aligned:
        return _turn_rotated(raster, axes, crs)
    raster = turn_rows(raster)
    is_exchanged = axes.first in ("north", "south")
    across, up = axes.labels
    bands = {}
    for name, band in raster.bands.items():
        cells = np.asarray(band[:, :])[::-1]  # now both indices grow with the coordinates
        cells = cells if is_exchanged else cells.T  # by east or west, then by north or south
        cells = cells[:: int(across.sign), :: int(up.sign)]
        bands[name] = np.ascontiguousarray(cells.T[::-1])
    box = raster.grid.bounds
    corners = axes.turn([(box.xmin, box.ymin), (box.xmax, box.ymax)])
    shape = next(iter(bands.values())).shape
    spacing = raster.grid.spacing
    if isinstance(spacing, tuple) and is_exchanged:
        spacing = spacing[::-1]
    return replace(raster, bands=bands, grid=Grid(Bounds.of(corners), shape, spacing), crs=crs)


def _turn_rotated(raster: Raster, axes: Axes, crs: DrawnCRS) -> Raster:
    affine = raster.grid.transform
    (a, d), (b, e), (c, f) = axes.turn(
        [(affine.a, affine.d), (affine.b, affine.e), (affine.c, affine.f)]
    ).tolist()
    grid = Grid.of_transform((a, b, c, d, e, f), raster.grid.shape)
    return replace(raster, grid=grid, crs=crs)


def turn_rows(raster: Raster) -> Raster:
    """Return a raster aligned with its axes with rows from north to south, columns to the east."""
    grid, turn = raster.grid, find_turn(raster.grid)
    if grid.is_north_up or not grid.is_aligned:
        return raster
    bands = {name: turn.of(np.asarray(band[:, :])) for name, band in raster.bands.items()}
    return replace(raster, bands=bands, grid=Grid(grid.bounds, grid.shape, grid.spacing))
