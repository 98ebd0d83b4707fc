"""Elevations as tiles of colours, for maps in browsers: MapLibre, Mapbox, deck.gl, Leaflet.

The tiles of Web Mercator are PNG of 512 pixels; red, green and blue of a pixel are one number, of
steps above a base. Archives of them are MBTiles 1.3, an SQLite file, and PMTiles 3, of which a
browser reads what it needs from any server of files.
"""

from __future__ import annotations

import math
import sqlite3
from contextlib import closing
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.atomic import folder_beside, replacing_path
from ...base.checks import require_count
from ...base.crs import CRS, Unit, assume_elevation_unit
from ...base.errors import CrsError, FormatError, OptionError, WriteError, choice
from ...base.notes import warn
from ...base.policies import TileEncoding, TileGaps
from ...base.results import Raster
from ...base.sentences import FILE, height
from .cell_types import require_north_up
from .geotiff import write as write_geotiff

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array
    from ...base.progress import Tell

_SIDE = 512
_MERCATOR, _DEGREES = "EPSG:3857", "OGC:CRS84"
_HALF_WORLD = math.pi * 6_378_137.0
_FINEST = 24
_BETWEEN = 99
"""Points on the sides of the raster that are followed to longitude and latitude."""

_ROUNDING = 1e-6
"""Of a zoom: pixels as large as cells are fine enough."""


class _Code(NamedTuple):
    """What the number of a pixel means."""

    base: float
    """Elevation of 0, metres."""
    step: float


_CODES = {"terrarium": _Code(-32_768.0, 1 / 256), "mapbox": _Code(-10_000.0, 0.1)}
_LARGEST = 2**24 - 1
_SCHEMA = """
PRAGMA application_id = 0x4d504258;
CREATE TABLE metadata (name text, value text);
CREATE TABLE tiles
    (zoom_level integer, tile_column integer, tile_row integer, tile_data blob);
CREATE UNIQUE INDEX tile_index ON tiles (zoom_level, tile_column, tile_row);
"""


def write(
    raster: Raster,
    path: Path,
    *,
    band: str | None = None,
    tile_encoding: TileEncoding = "terrarium",
    gaps: TileGaps = "lowest",
    min_zoom: int | None = None,
    max_zoom: int | None = None,
    progress: Tell | None = None,
) -> None:
    """Write the elevations of a raster as tiles, in an archive of MBTiles or PMTiles by its suffix.

    Parameters
    ----------
    band : str, optional
        Needed if there are several.
    tile_encoding : {"terrarium", "mapbox"}
        How pixels mean elevations: in steps of 1/256 m, or of 0.1 m as terrain-RGB of Mapbox.
    gaps : {"lowest", "transparent"}
        What pixels without data show: the lowest elevation, or nothing, which MapLibre takes for
        an elevation of 10 or 33 km below the sea.
    min_zoom : int, optional
        Zoom of the coarsest tiles; default one at which about one tile holds the raster.
    max_zoom : int, optional
        Zoom of the finest tiles, at most 24; default the first whose pixels are no larger than the
        cells.

    Raises
    ------
    CrsError
        If the CRS is not known.
    FormatError
        If the band holds no elevations, or rows do not run from north to south and columns to the
        east.
    MissingExtraError
        If pmtiles is not installed, and the archive is to be one.
    OptionError
        If there is no such band, or several and none is named, or a zoom is none.
    WriteError
        If an elevation is none that pixels can have, no cell has data, or the raster crosses the
        antimeridian or holds a pole.

    Warns
    -----
    LossWarning
        Which zooms there are, what elevations are rounded to, and what gaps show.

    Notes
    -----
    Elevations become metres, and keep their datum. Those of the finest tiles are interpolated
    between the centres of four cells; a pixel of a coarser tile is the mean of four. Tiles without
    data are left out. Memory does not grow with the raster.
    """
    require_north_up(raster, "an archive of tiles")
    code = _CODES[choice("tile_encoding", tile_encoding, TileEncoding)]
    choice("gaps", gaps, TileGaps)
    is_pmtiles = path.suffix.lower() == ".pmtiles"
    if is_pmtiles:
        optional.require("pmtiles", f"Writing {FILE}")
    crs, band, metres, notes = _choose_band(raster, band)
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    with replacing_path(path) as new, folder_beside(path) as folder:
        cells, tiles = Path(folder, "cells.tif"), Path(folder, "tiles.mbtiles")
        one = Raster({band: raster.bands[band]}, raster.grid, crs=raster.crs, nodata=raster.nodata)
        write_geotiff(one, cells, overviews="none", compression="none")
        with rasterio.open(cells) as source, closing(sqlite3.connect(tiles)) as archive:
            pyramid = _Pyramid(source, crs, metres, (min_zoom, max_zoom))
            lowest = pyramid.require_range(code)
            fill = None if gaps == "transparent" else lowest
            archive.executescript(_SCHEMA)
            for done, (z, x, y), values in pyramid.iterate():
                row = (z, x, 2**z - 1 - y, _encode(values, code, fill))
                archive.execute("INSERT INTO tiles VALUES (?, ?, ?, ?)", row)
                if progress is not None:
                    progress(done)
            notes += pyramid.describe(code, fill)
            about = pyramid.list_metadata() | {
                "name": raster.name or band,
                "description": " ".join([*notes, *raster.notes]),
                "crs": str(raster.crs),
                "encoding": tile_encoding,
            }
            archive.executemany("INSERT INTO metadata VALUES (?, ?)", sorted(about.items()))
            archive.commit()
        if is_pmtiles:
            _pack_pmtiles(tiles, new)
        else:
            tiles.replace(new)
    for note in notes:
        warn(f"{FILE}: {note}")


def _choose_band(raster: Raster, band: str | None) -> tuple[CRS, str, float, list[str]]:
    """Return the CRS, the name of a band, how many metres its unit has, and what is assumed."""
    names = list(raster.bands)
    name = names[0] if band is None and len(names) == 1 else band
    if name is None or name not in names:
        raise OptionError("band", band, f"one of {', '.join(names)}, as a tile holds one")
    if raster.crs is None:
        raise CrsError(
            f"Cannot write {FILE}: the CRS of this raster is not known, and tiles are in Web "
            "Mercator: declare it."
        )
    unit = raster.units.get(name)
    if isinstance(unit, str):
        try:
            unit = Unit.of(unit)
        except OptionError:
            unit = Unit(str(unit), str(unit), None)
    if name not in raster.units or (unit is not None and unit.metres is None):
        raise FormatError(
            f"Cannot write {FILE}: tiles hold elevations, and the unit of the band '{name}' is no "
            "length."
        )
    assumed = assume_elevation_unit(raster.crs, unit)
    metres, notes = (assumed and assumed.metres) or 1.0, []
    if unit is None and assumed is not None:
        text = "The unit of elevations is not known, and taken to be that which is usual in"
        notes.append(f"{text} {raster.crs.label}, the {assumed.name}.")
    if assumed is not None and metres != 1.0:
        notes.append(f"Elevations were converted from {assumed.name} to metre.")
    return raster.crs, name, metres, notes


def _encode(values: Float64Array, code: _Code, fill: float | None) -> bytes:
    """Return a picture of elevations, NaN where they are not known."""
    from PIL.Image import fromarray  # comes with what draws pictures

    is_known = np.isfinite(values)
    known = np.where(is_known, values, code.base if fill is None else fill)
    numbers = np.rint((known - code.base) / code.step).astype(np.int64)
    colors = [numbers >> 16, numbers >> 8 & 255, numbers & 255]
    if fill is None and not is_known.all():
        colors.append(255 * is_known.astype(np.int64))
    content = BytesIO()
    fromarray(np.stack(colors, axis=2).astype(np.uint8)).save(content, "PNG")
    return content.getvalue()


def _pack_pmtiles(tiles: Path, new: Path) -> None:
    """Write an archive of MBTiles as one of PMTiles, tiles in the order of their curve."""
    pmtiles, writer = optional.load("pmtiles.tile"), optional.load("pmtiles.writer")
    with closing(sqlite3.connect(tiles)) as archive, new.open("wb") as file:
        packed = writer.Writer(file)
        found = archive.execute("SELECT zoom_level, tile_column, tile_row, rowid FROM tiles")
        rows = {pmtiles.zxy_to_tileid(z, x, 2**z - 1 - y): row for z, x, y, row in found}
        for number, row in sorted(rows.items()):
            found = archive.execute("SELECT tile_data FROM tiles WHERE rowid = ?", (row,))
            packed.write_tile(number, found.fetchone()[0])
        about = dict(archive.execute("SELECT name, value FROM metadata"))
        sides = ("min_lon_e7", "min_lat_e7", "max_lon_e7", "max_lat_e7")
        bounds = (round(float(one) * 1e7) for one in about["bounds"].split(","))
        longitude, latitude, zoom = map(float, about["center"].split(","))
        header = dict(zip(sides, bounds, strict=True)) | {
            "tile_type": pmtiles.TileType.PNG,
            "tile_compression": pmtiles.Compression.NONE,
            "center_lon_e7": round(longitude * 1e7),
            "center_lat_e7": round(latitude * 1e7),
            "center_zoom": int(zoom),
        }
        packed.finalize(header, about)


class _Pyramid:
    """The tiles of a raster at all zooms.

    Parameters
    ----------
    source : rasterio.DatasetReader
        Of one band.
    crs : CRS
    metres : float
        In a unit of its elevations.
    zooms : (int or None, int or None)
        The coarsest and the finest, as :func:`write` takes them.
    """

    def __init__(
        self, source: Any, crs: CRS, metres: float, zooms: tuple[int | None, int | None]
    ) -> None:
        min_zoom, max_zoom = zooms
        self._source, self._metres = source, metres
        self._has_gaps, self._done = False, 0.0
        pyproj = optional.load("pyproj")
        make, here = pyproj.Transformer.from_crs, crs.horizontal.to_pyproj()
        self._from_mercator = make(_MERCATOR, here, always_xy=True)
        self._to_mercator = make(here, _MERCATOR, always_xy=True)
        degrees = make(here, _DEGREES, always_xy=True)
        box = degrees.transform_bounds(*source.bounds, densify_pts=_BETWEEN)
        if not np.isfinite(box).all() or box[0] > box[2]:
            raise WriteError(
                f"Cannot write {FILE}: the raster crosses the antimeridian or holds a pole."
            )
        limit = math.degrees(math.atan(math.sinh(math.pi)))
        west, south, east, north = box[0], max(box[1], -limit), box[2], min(box[3], limit)
        self._to_degrees = make(_MERCATOR, _DEGREES, always_xy=True)
        xs, ys = self._to_degrees.transform([west, east], [south, north], direction="INVERSE")
        self._box = xs[0], ys[0], xs[1], ys[1]
        width = max(xs[1] - xs[0], ys[1] - ys[0])
        if min(xs[1] - xs[0], ys[1] - ys[0]) <= 0:
            raise WriteError(
                f"Cannot write {FILE}: Web Mercator ends at 85.05 degrees of latitude."
            )
        finest = math.ceil(math.log2(2 * _HALF_WORLD / _SIDE / self._measure_cell()) - _ROUNDING)
        finest = min(max(finest, 0), _FINEST)
        self._last = finest if max_zoom is None else max_zoom
        require_count("max_zoom", self._last, least=0, most=_FINEST)
        self._finest = max(self._last, finest)
        coarsest = math.floor(math.log2(2 * _HALF_WORLD / width))
        self._first = min(max(coarsest, 0), self._last) if min_zoom is None else min_zoom
        require_count("min_zoom", self._first, least=0, most=self._last)

    def _measure_cell(self) -> float:
        """Return the shorter side of a cell in the middle, in Web Mercator."""
        box, (across, up) = self._source.bounds, self._source.res
        x, y = (box.left + box.right) / 2, (box.bottom + box.top) / 2
        places = [x, x + across, x], [y, y, y + up]
        (x, *xs), (y, *ys) = self._to_mercator.transform(*places)
        return min(math.dist((x, y), one) for one in zip(xs, ys, strict=True))

    def require_range(self, code: _Code) -> float:
        """Return the lowest elevation, metres, if pixels can have all."""
        low, high = math.inf, -math.inf
        for _, window in self._source.block_windows(1):
            values = (
                self._source.read(1, window=window, masked=True).astype(np.float64).filled(np.nan)
            )
            known = values[np.isfinite(values)]
            low, high = min(low, known.min(initial=low)), max(high, known.max(initial=high))
        low, high = float(low) * self._metres, float(high) * self._metres
        if low > high:
            raise WriteError(f"Cannot write {FILE}: no cell has data.")
        most = code.base + _LARGEST * code.step
        if not code.base <= low <= high <= most:
            raise WriteError(
                f"Cannot write {FILE}: elevations from {height(low)} to {height(high)} m, and "
                f"pixels have those from {height(code.base)} to {height(most)} m."
            )
        return low

    def iterate(self) -> Iterator[tuple[float, tuple[int, int, int], Float64Array]]:
        """Yield the fraction done, zoom, column and row of each tile with data, and its values."""
        west, south, east, north = self._box
        count = 2**self._first
        size = 2 * _HALF_WORLD / count
        columns = [min(int((x + _HALF_WORLD) / size), count - 1) for x in (west, east)]
        rows = [min(int((_HALF_WORLD - y) / size), count - 1) for y in (north, south)]
        places = [
            (self._first, x, y)
            for y in range(rows[0], rows[1] + 1)
            for x in range(columns[0], columns[1] + 1)
        ]
        for first in places:
            for done, place, values in self._iterate(first, 1.0 / len(places)):
                if place[0] <= self._last:
                    yield done, place, values

    def _iterate(
        self, place: tuple[int, int, int], share: float
    ) -> Iterator[tuple[float, tuple[int, int, int], Float64Array]]:
        """Yield the tiles within one, and it itself at the end; tell how much is done by then."""
        z, x, y = place
        size = 2 * _HALF_WORLD / 2**z
        left, top = x * size - _HALF_WORLD, _HALF_WORLD - y * size
        west, south, east, north = self._box
        if left >= east or left + size <= west or top <= south or top - size >= north:
            self._done += share
            return
        if z == self._finest:
            values = self._sample(left, top, size)
            self._done += share
        else:
            values = np.full((2 * _SIDE, 2 * _SIDE), np.nan)
            for dy, dx in ((0, 0), (0, 1), (1, 0), (1, 1)):
                below = (z + 1, 2 * x + dx, 2 * y + dy)
                for done, one, found in self._iterate(below, share / 4):
                    yield done, one, found
                    if one == below:
                        values[dy * _SIDE : (dy + 1) * _SIDE, dx * _SIDE : (dx + 1) * _SIDE] = found
            values = _halve(values)
        is_known = np.isfinite(values)
        self._has_gaps = self._has_gaps or not is_known.all()
        if is_known.any():
            yield self._done, place, values

    def _sample(self, left: float, top: float, size: float) -> Float64Array:
        """Return the values of a tile where the cells that hold its pixels have some."""
        ways = (np.arange(_SIDE) + 0.5) * (size / _SIDE)
        x, y = self._from_mercator.transform(*np.meshgrid(left + ways, top - ways))
        box, (across, up), shape = self._source.bounds, self._source.res, self._source.shape
        at = np.stack([(box.top - y) / up, (x - box.left) / across]) - 0.5
        cells = np.array(shape)[:, None, None]
        inside = ((at >= -0.5) & (at < cells - 0.5)).all(axis=0)
        found = np.full((_SIDE, _SIDE), np.nan)
        if not inside.any():
            return found
        at = at[:, inside]
        first = np.maximum(np.floor(at.min(axis=1)).astype(int), 0)
        last = np.minimum(np.floor(at.max(axis=1)).astype(int) + 2, shape)
        window = tuple(zip(first.tolist(), last.tolist(), strict=True))
        values = self._source.read(1, window=window, masked=True).astype(np.float64).filled(np.nan)
        most = last - first - 1
        at -= first[:, None]
        nearest = np.minimum(np.rint(at).astype(int), most[:, None])
        low = np.floor(at).astype(int)
        sums, weights = np.zeros(at.shape[1]), np.zeros(at.shape[1])
        for corner in ((0, 0), (0, 1), (1, 0), (1, 1)):
            cell = low + np.array(corner)[:, None]
            weight = (1.0 - np.abs(at - cell)).prod(axis=0)
            one = values[tuple(np.clip(cell, 0, most[:, None]))]
            is_known = np.isfinite(one)
            sums += np.where(is_known, one, 0.0) * weight
            weights += is_known * weight
        has_data = np.isfinite(values[tuple(nearest)])
        found[inside] = np.where(has_data, sums / np.where(has_data, weights, 1.0), np.nan)
        return found * self._metres

    def describe(self, code: _Code, fill: float | None) -> list[str]:
        """Return what is told of the tiles."""
        step = f"1/{round(1 / code.step)}" if code.step < 0.1 else f"{code.step:g}"
        notes = [
            f"Tiles of {_SIDE} pixels from zoom {self._first} to {self._last}; elevations are "
            f"rounded to {step} m, half of which they are off at most."
        ]
        if self._has_gaps:
            shown = "transparent" if fill is None else f"at the lowest elevation, {height(fill)} m"
            notes.append(f"Pixels without data are {shown}.")
        return notes

    def list_metadata(self) -> dict[str, str]:
        """Return what MBTiles tells of tiles."""
        pixel = 2 * _HALF_WORLD / 2**self._last / _SIDE
        low, high = np.array(self._box).reshape(2, 2) / pixel
        sides = np.stack([np.floor(low), np.ceil(high)], axis=1) * pixel  # as GDAL wants them
        (west, east), (south, north) = self._to_degrees.transform(
            *sides.clip(-_HALF_WORLD, _HALF_WORLD)
        )
        middle = f"{(west + east) / 2:.9f},{(south + north) / 2:.9f},{self._first}"
        return {
            "format": "png",
            "type": "baselayer",
            "minzoom": str(self._first),
            "maxzoom": str(self._last),
            "bounds": ",".join(f"{one:.9f}" for one in (west, south, east, north)),
            "center": middle,
            "tilesize": str(_SIDE),
        }


def _halve(values: Float64Array) -> Float64Array:
    """Return the mean of each four values, of those that are known."""
    quarters = values.reshape(len(values) // 2, 2, -1, 2)
    is_known = np.isfinite(quarters)
    counts = is_known.sum(axis=(1, 3))
    sums = np.where(is_known, quarters, 0.0).sum(axis=(1, 3))
    return np.asarray(np.where(counts > 0, sums / np.maximum(counts, 1), np.nan))
