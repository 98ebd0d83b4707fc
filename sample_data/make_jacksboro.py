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
from rasterio.warp import transform, transform_bounds

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
    rows, columns = source.elevation.shape
    limits = rasterio.transform.array_bounds(rows, columns, source.transform)
    west, south, east, north = transform_bounds(SOURCE_CRS, TARGET_CRS, *limits, densify_pts=101)
    west, north = np.floor(west / SPACING) * SPACING, np.ceil(north / SPACING) * SPACING
    x = np.arange(west + SPACING / 2, east, SPACING)
    y = np.arange(north - SPACING / 2, south, -SPACING)
    lon, lat = transform(TARGET_CRS, SOURCE_CRS, *(part.ravel() for part in np.meshgrid(x, y)))
    place = source.transform
    row = (np.array(lat) - place.f) / place.e - 0.5
    column = (np.array(lon) - place.c) / place.a - 0.5
    elevation = bilinear(source.elevation, row, column).reshape(len(y), len(x))
    return Raster(np.round(elevation, 1), from_origin(west, north, SPACING, SPACING))


def bilinear(
    values: NDArray[np.float32], row: NDArray[np.float64], column: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Interpolate between the four cell centres around each place; ``NODATA`` outside them."""
    last_row, last_column = values.shape[0] - 1, values.shape[1] - 1
    inside = (row >= 0) & (row <= last_row) & (column >= 0) & (column <= last_column)
    top = np.clip(np.floor(row), 0, last_row - 1).astype(int)
    left = np.clip(np.floor(column), 0, last_column - 1).astype(int)
    down, right = row - top, column - left
    upper = values[top, left] * (1 - right) + values[top, left + 1] * right
    lower = values[top + 1, left] * (1 - right) + values[top + 1, left + 1] * right
    return np.where(inside, upper * (1 - down) + lower * down, NODATA).astype(np.float32)


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
