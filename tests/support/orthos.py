"""Pictures in four colours, whose place can be seen: red and green in the north."""

from __future__ import annotations

import warnings

import numpy as np

WEST, NORTH, SIDE = 742_000.0, 4_030_300.0, 300.0
"""A square of 300 m; :func:`make_square` is the surface on it."""

QUARTERS = {(0, 0): (255, 0, 0), (0, 1): (0, 255, 0), (1, 0): (0, 0, 255), (1, 1): (255, 255, 0)}
"""Colours by row and column of the quarter, rows from the north."""


def make_square(crs="EPSG:32616", *, n=400, height=8.0):
    """Return a hilly TIN on the square, its corners included."""
    import tinsmith as ts

    xy = np.random.default_rng(5).random((n, 2)) * SIDE
    xy = np.vstack([xy, [[0, 0], [SIDE, 0], [0, SIDE], [SIDE, SIDE]]])
    z = 300 + height * np.sin(xy[:, 0] / 40) * np.cos(xy[:, 1] / 55)
    points = np.round(np.column_stack([xy + np.array([WEST, NORTH - SIDE]), z]), 3)
    return ts.triangulate(points, crs=crs, elevation_unit="m")


def paint_quarters(pixels, *, top=255, dtype=np.uint8):
    """Return red, green and blue, (3, pixels, pixels)."""
    colors = np.zeros((3, pixels, pixels), dtype)
    half = pixels // 2
    for (row, column), color in QUARTERS.items():
        place = (slice(row * half, (row + 1) * half), slice(column * half, (column + 1) * half))
        for band in range(3):
            colors[band][place] = color[band] / 255 * top
    return colors


def write_raster(path, bands, *, crs="EPSG:32616", transform=None, **profile):
    """Write bands over the square, or where a transform places them; return the path."""
    import rasterio

    if transform is None:
        pixel = SIDE / bands.shape[2]
        transform = rasterio.Affine(pixel, 0.0, WEST, 0.0, -pixel, NORTH)
    mask, palette = profile.pop("mask", None), profile.pop("palette", None)
    given = {"driver": "GTiff", "dtype": bands.dtype, "crs": crs, "transform": transform, **profile}
    shape = {"count": len(bands), "height": bands.shape[1], "width": bands.shape[2]}
    with warnings.catch_warnings(), rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(path, "w", **shape, **given) as target:
            target.write(bands)
            if palette is not None:
                target.write_colormap(1, palette)
            if mask is not None:
                target.write_mask(mask)
    return path


def list_places(step=30.0, margin=10.0):
    """Return eastings and northings well inside the quarters, and the colours there."""
    along = np.arange(margin, SIDE - margin + 1, step)
    along = along[np.abs(along - SIDE / 2) > margin - 1]
    places = np.array([(x, y) for x in along for y in along])
    colors = [QUARTERS[(int(y > SIDE / 2), int(x > SIDE / 2))] for x, y in places]
    return np.column_stack([WEST + places[:, 0], NORTH - places[:, 1]]), np.array(colors)


def write_grey(tin, path):
    """Write a picture of one grey over the bounds of a TIN."""
    import rasterio

    transform = rasterio.Affine(50, 0, tin.bounds.xmin, 0, -50, tin.bounds.ymax)
    grey = np.full((3, 9, 9), 128, np.uint8)
    write_raster(path, grey, crs=str(tin.crs), transform=transform, photometric="RGB")
