"""Adjacent lidar tiles: what differs from the surface of all points, along the tiles and anywhere.

``python -m benchmarks.seams FOLDER --spacing 1 --classes 2`` triangulates the points of all lidar
files of a folder at once, and compares with its raster and contours: those of many files in tiles
(``tinsmith.tiles``), whose cells and bytes must be the same; and the rasters that are had file by
file, each with the points of the others within some distance around it, as is usual.

Files that are adjacent and public: ``inst/extdata/bcts`` of lasR (GPL-3), ``test/data`` of
las-digital-models (IGN, LiDAR HD, Etalab Open Licence 2.0). None of them is part of this project.
"""

from __future__ import annotations

import argparse
import filecmp
import time
import warnings
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import rasterio

import tinsmith as ts

from .report.tables import TEXT, Table, add_option

COLUMNS = {
    "how": TEXT,
    "cells": "{:,}",
    "other cells": "{:,}",
    "largest difference": "{:.3f}",
    "contours": TEXT,
    "seconds": "{:.1f}",
}
BUFFERS = (0.0, 10.0, 30.0)
TILES = (1, 4, 16, 64)


def rasterize_by_file(
    surveys: Sequence[ts.Survey], whole: ts.Raster, buffer: float
) -> tuple[np.ndarray, float]:
    """Return the cells that each file has in its bounds, with points around it, and seconds.

    Cells between the bounds of files are those of the first file that has them.
    """
    begin = time.perf_counter()
    everything = np.concatenate([one.points for one in surveys])
    cells, between = np.full((2, *whole.shape), np.nan)
    box, spacing = whole.grid.bounds, whole.grid.spacing
    for survey in surveys:
        low, high = survey.points[:, :2].min(axis=0), survey.points[:, :2].max(axis=0)
        xy = everything[:, :2]
        near = everything[((xy >= low - buffer) & (xy <= high + buffer)).all(axis=1)]
        made = ts.rasterize(ts.triangulate(near, crs=whole.crs), like=whole).bands["elevation"]
        x = box.xmin + (np.arange(whole.shape[1]) + 0.5) * spacing
        y = box.ymax - (np.arange(whole.shape[0]) + 0.5) * spacing
        own = ((y >= low[1]) & (y <= high[1]))[:, None] & ((x >= low[0]) & (x <= high[0]))
        cells = np.where(own & np.isnan(cells), made, cells)
        between = np.where(np.isnan(between), made, between)
    cells = np.where(np.isnan(cells), between, cells)
    return cells, time.perf_counter() - begin


def compare(cells: np.ndarray, wanted: np.ndarray) -> tuple[int, float]:
    """Return how many cells differ, and the largest difference of those that both have."""
    differs = ~((cells == wanted) | (np.isnan(cells) & np.isnan(wanted)))
    both = differs & np.isfinite(cells) & np.isfinite(wanted)
    return int(differs.sum()), float(np.abs(cells - wanted)[both].max(initial=0.0))


def main(arguments: Sequence[str] | None = None) -> None:
    """Compare and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("lidar", type=Path)
    parser.add_argument("--spacing", type=float, default=1.0)
    parser.add_argument("--interval", type=float, default=1.0)
    parser.add_argument("--classes", type=int)
    add_option(parser)
    given = parser.parse_args(arguments)
    warnings.simplefilter("ignore", ts.LossWarning)
    table = Table(COLUMNS)
    begin = time.perf_counter()
    tin = ts.triangulate(ts.read(given.lidar, classes=given.classes))
    whole = ts.rasterize(tin, spacing=given.spacing)
    wanted = whole.bands["elevation"]
    table.show("in memory", wanted.size, 0, 0.0, "", time.perf_counter() - begin)
    with TemporaryDirectory() as folder, ThreadPoolExecutor(2) as threads:
        contours = ts.write(ts.contours(tin, given.interval), Path(folder, "whole.shp"))
        cloud = ts.tiles(given.lidar, classes=given.classes)
        for tiles in TILES:
            begin = time.perf_counter()
            made = Path(folder, "tiles.tif")
            cloud.rasterize(made, spacing=given.spacing, tiles=tiles, executor=threads)
            seconds = time.perf_counter() - begin
            with rasterio.open(made) as dataset:
                differences = compare(dataset.read(1), wanted)
            lines = Path(folder, "tiles.shp")
            cloud.contours(lines, given.interval, tiles=tiles, executor=threads)
            is_same = filecmp.cmp(lines, contours, shallow=False)
            said = "same bytes" if is_same else "other bytes"
            table.show(f"{tiles} tiles", wanted.size, *differences, said, seconds)
            if differences[0] or not is_same:
                raise SystemExit("tiles are not the whole")
    surveys = [
        ts.read(path, classes=given.classes)
        for path in sorted(given.lidar.iterdir())
        if path.suffix.lower() in (".las", ".laz")
    ]
    for buffer in BUFFERS:
        cells, seconds = rasterize_by_file(surveys, whole, buffer)
        label = f"file by file, {buffer:g} around"
        table.show(label, wanted.size, *compare(cells, wanted), "", seconds)
    table.write(given.json)


if __name__ == "__main__":
    main()
