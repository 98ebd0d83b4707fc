"""Files that have an index in space: octrees, rasters in tiles, GeoParquet in groups of rows."""

from __future__ import annotations

import numpy as np

import tinsmith as ts

from .lidar_files import CORNER, write_copc

__all__ = ["SOURCES", "write_groups", "write_octree", "write_raster", "write_source"]

CRS = "EPSG:32616"


def write_octree(path, count=1_500, *, seed=4):
    """Write COPC of points of two classes on a lattice of 0.5, some at one place."""
    import laspy
    import pyproj

    rng = np.random.default_rng(seed)
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.array([0.01, 0.01, 0.01]), CORNER
    cloud = laspy.LasData(header)
    xy = np.floor(rng.random((count, 2)) * [400, 200]) / 2
    z = 20 + 8 * np.sin(xy[:, 0] / 30) + rng.normal(0, 0.1, count)
    cloud.xyz = np.column_stack([xy, z]) + CORNER
    cloud.classification = np.where(rng.random(count) < 0.7, 2, 5).astype(np.uint8)
    cloud.return_number = np.ones(count, np.uint8)
    cloud.number_of_returns = np.ones(count, np.uint8)
    return write_copc(path, cloud, wkt=pyproj.CRS(CRS).to_wkt("WKT1_GDAL"))


def write_raster(path, voids=()):
    """Write a GeoTIFF of 40 by 30 cells in tiles of 16, some of which have no elevation."""
    import rasterio

    row, column = np.mgrid[:30, :40]
    cells = 320 + 5 * np.sin(row / 4.0) * np.cos(column / 5.0) + 0.01 * (row * 7 % 11)
    for rows, columns in voids:
        cells[rows, columns] = -9999.0
    x, y = CORNER[:2].tolist()
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        dtype="float64",
        count=1,
        width=40,
        height=30,
        nodata=-9999.0,
        crs=CRS,
        transform=rasterio.Affine(3.0, 0.0, x, 0.0, -3.0, y + 90.0),
        tiled=True,
        blockxsize=16,
        blockysize=16,
    ) as dataset:
        dataset.write(cells, 1)
    return path


def write_groups(path, points=None, *, group=100, crs=CRS):
    """Write GeoParquet in groups of rows, with the bounds of each; points by easting if none."""
    import geopandas
    import shapely

    if points is None:
        rng = np.random.default_rng(7)
        points = np.round(rng.random((800, 3)) * [180, 90, 4], 1) + CORNER
        points = points[np.argsort(points[:, 0], kind="stable")]
    frame = geopandas.GeoDataFrame(geometry=shapely.points(points), crs=crs)
    frame.to_parquet(path, row_group_size=group, write_covering_bbox=True)
    return path


SOURCES = {
    "COPC": (write_octree, "a.copc.laz", {"classes": 2}),
    "GeoTIFF": (write_raster, "a.tif", {}),
    "GeoParquet": (write_groups, "a.parquet", {}),
}
"""Of each kind what writes it, its name, and options of its reader."""


def write_source(kind, folder):
    """Write a file of a kind; return its points, copied and in place."""
    write, name, options = SOURCES[kind]
    path = write(folder / name)
    return ts.tiles(path, **options), ts.tiles(path, in_place=True, **options)
