"""HTML representations of results: features, rasters, tables."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.georeference import find_axes
from ....base.results import unit_text
from ....base.sentences import counted, write_spacing
from ..north_up import draw_north_up, turn_rows
from .drawings import Canvas, draw_cells
from .frame import (
    SIZE,
    describe_bounds,
    name_crs,
    name_unit,
    name_units,
    write_html,
    write_range,
    write_table,
)
from .survey import list_notes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import AnyArray, Float64Array, UInt8Array
    from ....base.results import Features, Raster, Table, Units

_MOST_ROWS = 8
_MOST_COLUMNS = 12
_MOST_WRITTEN = 1e12


def make_features_html(features: Features) -> str:
    """Return HTML: counts, columns, CRS, and a map of the geometries."""
    picture = _draw_features(features) if len(features.coordinates) else None
    title = f"Features: {features.name}" if features.name else "Features"
    rows = _describe_features(features)
    return write_html(title, rows, picture=picture, alt=f"Map of the {features.kind}, north up")


def _describe_features(features: Features) -> Iterator[tuple[str, str]]:
    points = counted(len(features.coordinates), "vertex", "vertices")
    yield "Geometries", f"{len(features):,} {features.geometry_type}, {points}"
    if features.columns:
        yield "Columns", _name_columns(features.columns, features.units)
    yield "CRS", name_crs(features.crs)
    if features.has_elevations:
        yield "Units", name_units(features.crs, features.elevation_unit)
    else:
        yield "Units", name_unit(features.crs)
    yield from describe_bounds(features.coordinates, features.crs)
    yield from list_notes(features.notes)


def _name_columns(columns: Any, units: Units) -> str:
    return ", ".join(_with_unit(name, units) for name in columns)


def _with_unit(name: str, units: Units) -> str:
    unit = unit_text(units, name)
    return f"{name} ({unit})" if unit else name


def _draw_features(features: Features) -> UInt8Array:
    xy = find_axes(features.crs).turn(features.coordinates[:, :2])
    canvas = Canvas.around(xy, features.crs)
    if features.kind == "points":
        canvas.draw_points(xy, None)
        return canvas.pixels
    is_within = np.ones(max(len(xy) - 1, 0), np.bool_)
    ends = features.offsets[0][1:-1] - 1
    is_within[ends[(ends >= 0) & (ends < len(is_within))]] = False
    canvas.draw_segments(xy[:-1][is_within], xy[1:][is_within])
    return canvas.pixels


# ----------------------------------------------------------------------------------- raster


def make_raster_html(raster: Raster) -> str:
    """Return HTML: cells, bands, CRS, range, and a picture of the first band.

    A band that is computed as it is written is not computed for it.
    """
    name, band = next(iter(raster.bands.items()))
    sample = None
    if isinstance(band, np.ndarray):
        turned = turn_rows(draw_north_up(replace(raster, bands={name: band}, units={})))
        sample = _sample(turned.bands[name], raster.nodata)
    title = f"Raster: {raster.name}" if raster.name else "Raster"
    picture = None if sample is None else draw_cells(sample)
    rows = _describe_raster(raster, name)
    way = "north up" if raster.grid.is_aligned else "rows and columns as they are stored"
    return write_html(title, rows, picture=picture, alt=f"Picture of {name}, {way}")


def _sample(band: AnyArray, nodata: float) -> Float64Array:
    """Return every n-th row and column, so that they fit; NaN where there is nothing."""
    step = max(1, -(-band.shape[0] // SIZE[1]), -(-band.shape[1] // SIZE[0]))
    values = np.asarray(band[::step, ::step], np.float64)
    return np.where(values == nodata, np.nan, values)


def _describe_raster(raster: Raster, shown: str) -> Iterator[tuple[str, str]]:
    rows, columns = raster.shape
    spacing = write_spacing(raster.grid.spacing)
    yield "Cells", f"{counted(rows, 'row')} by {counted(columns, 'column')} of {spacing}"
    yield "Bands", _name_columns(raster.bands, raster.units)
    band = raster.bands[shown]
    if isinstance(band, np.ndarray):
        values = np.asarray(band, np.float64)
        known = values[np.isfinite(values) & (values != raster.nodata)]
        if len(known):
            yield shown, write_range(known)
        yield "Without value", counted(values.size - len(known), "cell")
    else:
        yield shown, "computed as it is written"
    yield "CRS", name_crs(raster.crs)
    bounds = raster.grid.bounds
    corners = np.array([[bounds.xmin, bounds.ymin], [bounds.xmax, bounds.ymax]])
    yield from describe_bounds(corners, raster.crs)
    yield from list_notes(raster.notes)


# ------------------------------------------------------------------------------------ table


def make_table_html(table: Table) -> str:
    """Return HTML: the first rows, with units in the header."""
    names = list(table.columns)[:_MOST_COLUMNS]
    count = min(len(table), _MOST_ROWS)
    cells = [[_write_value(table[name][row]) for name in names] for row in range(count)]
    header = [_with_unit(name, table.units) for name in names]
    title = f"Table: {table.name}" if table.name else "Table"
    rows = [*_count_rest(table), *list_notes(table.notes)]
    return write_html(title, rows, below=write_table(header, cells))


def _count_rest(table: Table) -> Iterator[tuple[str, str]]:
    yield "Rows", counted(len(table), "row")
    rest = len(table.columns) - _MOST_COLUMNS
    if rest > 0:
        yield "Columns", f"{len(table.columns)}, of which {_MOST_COLUMNS} are shown"


def _write_value(value: Any) -> str:
    if not isinstance(value, float | np.floating):
        return str(value)
    number = float(value)
    if math.isnan(number):
        return ""
    return f"{number:,.3f}" if abs(number) < _MOST_WRITTEN else f"{number:g}"
