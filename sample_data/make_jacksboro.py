"""Make jacksboro.tif: the elevation grid that matplotlib ships, as a GeoTIFF in UTM zone 16 N.

Run ``python sample_data/make_jacksboro.py [FILE]``; needs matplotlib (for its sample data) and
rasterio. The result depends on nothing else, so running it again gives the same file.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import rasterio
from matplotlib.cbook import get_sample_data
from rasterio.crs import CRS
from rasterio.transform import Affine, from_origin
from rasterio.warp import transform

if TYPE_CHECKING:
    from numpy.typing import NDArray

HERE = Path(__file__).parent
SOURCE_CRS = CRS.from_epsg(4326)
TARGET_CRS = CRS.from_epsg(32616)
SPACING = 75.0
"""Metres; the source's cells are 74.6 m (east) by 92.5 m (north)."""
NODATA = -9999.0
TAGS = {
    "TIFFTAG_IMAGEDESCRIPTION": "Elevation around Jacksboro, Tennessee, metres above sea level",
    "SOURCE": "NASA Shuttle Radar Topography Mission (SRTM), 3 arc-seconds, "
    "as jacksboro_fault_dem.npz in matplotlib's sample data",
    "LICENCE": "Public domain (NASA/USGS)",
    "PROCESSING": "Warped from EPSG:4326 to EPSG:32616, bilinear, 75 m cells, rounded to 0.1 m",
}


class Raster(NamedTuple):
    """Elevations, row 0 north, and the transform from (column, row) to (x, y)."""

    elevation: NDArray[np.float32]
    transform: Affine


def read_source() -> Raster:
    """Return matplotlib's grid with its true place on the globe.

    Notes
    -----
    The limits in the file are outer edges of the cells: width / dx is the number of columns, and
    only so do cell centres fall on SRTM's lattice of whole 3 arc-seconds. Its ``ymin``, 36.733,
    is greater than its ``ymax``, 36.446. The latter is the northern edge; the former lies as far
    north of it as the southern edge lies south, a slip of sign. With the southern edge at
    36.160 the highest cell falls on the summit of Cross Mountain (36.1983 N, 84.2306 W, 1,077 m)
    and Jacksboro (36.330 N, 84.184 W) in its valley; with 36.733 the grid would not hold
    Jacksboro at all.
    """
    with get_sample_data("jacksboro_fault_dem.npz") as data:
        elevation = data["elevation"].astype(np.float32)
        west, north = float(data["xmin"]), float(data["ymax"])
        return Raster(elevation, from_origin(west, north, float(data["dx"]), float(data["dy"])))


def warp(source: Raster) -> Raster:
    """Return the grid in square UTM cells whose edges are whole multiples of the spacing.

    Every cell's centre is projected exactly; GDAL's warper would interpolate positions between
    projected ones and let cells slip by up to an eighth of their size.
    """
    west, south, east, north = full_rectangle(source)
    west, north = np.ceil(west / SPACING) * SPACING, np.floor(north / SPACING) * SPACING
    x = np.arange(west + SPACING / 2, east, SPACING)
    y = np.arange(north - SPACING / 2, south, -SPACING)
    lon, lat = transform(TARGET_CRS, SOURCE_CRS, *(part.ravel() for part in np.meshgrid(x, y)))
    place = source.transform
    row = (np.array(lat) - place.f) / place.e - 0.5
    column = (np.array(lon) - place.c) / place.a - 0.5
    elevation = bilinear(source.elevation, row, column).reshape(len(y), len(x))
    return Raster(np.round(elevation, 1), from_origin(west, north, SPACING, SPACING))


def full_rectangle(source: Raster) -> tuple[float, float, float, float]:
    """Return the UTM rectangle inside the source's outermost cell centres: no cell stays empty.

    Meridian convergence turns the source by 1.6 degrees; the four edges are projected, and the
    rectangle touches each from within.
    """
    rows, columns = source.elevation.shape
    place = source.transform
    lon = place.c + place.a * (np.arange(columns) + 0.5)
    lat = place.f + place.e * (np.arange(rows) + 0.5)
    west, _ = transform(SOURCE_CRS, TARGET_CRS, np.full(rows, lon[0]), lat)
    east, _ = transform(SOURCE_CRS, TARGET_CRS, np.full(rows, lon[-1]), lat)
    _, north = transform(SOURCE_CRS, TARGET_CRS, lon, np.full(columns, lat[0]))
    _, south = transform(SOURCE_CRS, TARGET_CRS, lon, np.full(columns, lat[-1]))
    return max(west), max(south), min(east), min(north)


def bilinear(
    values: NDArray[np.float32], row: NDArray[np.float64], column: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Interpolate between the four cell centres around each place."""
    last_row, last_column = values.shape[0] - 1, values.shape[1] - 1
    top = np.clip(np.floor(row), 0, last_row - 1).astype(int)
    left = np.clip(np.floor(column), 0, last_column - 1).astype(int)
    down, right = row - top, column - left
    upper = values[top, left] * (1 - right) + values[top, left + 1] * right
    lower = values[top + 1, left] * (1 - right) + values[top + 1, left + 1] * right
    return (upper * (1 - down) + lower * down).astype(np.float32)


def write(raster: Raster, path: Path) -> None:
    """Write a compressed single-band GeoTIFF."""
    rows, columns = raster.elevation.shape
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        width=columns,
        height=rows,
        count=1,
        dtype="float32",
        crs=TARGET_CRS,
        transform=raster.transform,
        nodata=NODATA,
        compress="deflate",
        predictor=3,
        zlevel=9,
    ) as file:
        file.write(raster.elevation, 1)
        file.update_tags(**TAGS)
        file.set_band_description(1, "elevation")
        file.units = ("metre",)


def main(path: Path = HERE / "jacksboro.tif") -> None:
    """Make the file."""
    write(warp(read_source()), path)
    print(f"{path}: {path.stat().st_size:,} bytes")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
