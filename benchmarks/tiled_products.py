"""Products of a folder of lidar tiles, in memory and in tiles, and whether the files are equal.

``python -m benchmarks.tiled_products FOLDER --points 1e7 --tiles 16`` writes two LAZ files into the
folder once, then makes each product of their ground by the command, first in memory and then in
tiles on every core, each in processes of its own. Memory is that of all processes at its peak.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

import tinsmith as ts

from .datasets.lidar_tiles import make_lidar_tiles
from .many_files import PeakMemory
from .report.tables import TEXT, Table, add_option

COLUMNS = {
    "product": TEXT,
    "in memory, s": "{:.1f}",
    "GB": "{:.1f}",
    "in tiles, s": "{:.1f}",
    "GB, all processes": "{:.1f}",
    "files": TEXT,
}
_PLACES = 10_000


class Product(NamedTuple):
    """A command, its words, and the ending of the file that it writes.

    ``{axis}`` and ``{places}`` stand for files that are made beforehand.
    """

    command: str
    words: str
    suffix: str


PRODUCTS = {
    "raster of 1 m": Product("raster", "--spacing 1", ".tif"),
    "hillshade of 1 m": Product("raster", "--spacing 1 --value hillshade", ".tif"),
    "means of 10 m": Product("raster", "--spacing 10 --at mean", ".tif"),
    "contours of 1 m": Product("contours", "--interval 1", ".gpkg"),
    "polygons between contours of 5 m": Product("contours", "--interval 5 --bands", ".gpkg"),
    "volume to a level": Product("volume", "--base 120", ".csv"),
    "profile": Product("profile", "--line {axis}", ".csv"),
    "10,000 elevations": Product("interpolate", "--at {places}", ".csv"),
}


def measure(source: Path, product: Product, output: Path, *more: str) -> tuple[float, float]:
    """Make a product by the command; return seconds and the peak of memory in GB."""
    words = [word.format_map(_list_inputs(source)) for word in product.words.split()]
    command = [sys.executable, "-m", "tinsmith", product.command, str(source), *words]
    begin = time.perf_counter()
    process = subprocess.Popen([*command, "--classes", "2", "-o", str(output), "-q", *more])
    with PeakMemory(process.pid) as peak:
        code = process.wait()
    if code:
        raise SystemExit(f"{' '.join(command)} ended with {code}")
    return time.perf_counter() - begin, peak.megabytes / 1e3


def _list_inputs(source: Path) -> dict[str, Path]:
    return {"axis": source.with_name("axis.gpkg"), "places": source.with_name("places.csv")}


def write_inputs(source: Path, bounds: ts.Bounds, crs: ts.CRS | None) -> None:
    """Write a line across the surface, and places in it, beside the folder of tiles."""
    files = _list_inputs(source)
    shares = np.array([[0.05, 0.1], [0.4, 0.7], [0.95, 0.8]])
    corner, size = [bounds.xmin, bounds.ymin], [bounds.width, bounds.height]
    ts.write(ts.Features.of_lines(corner + shares * size, [0, 3], crs=crs), files["axis"])
    places = corner + np.random.default_rng(1).random((_PLACES, 2)) * size
    np.savetxt(files["places"], places, "%.3f", ",", header="x,y", comments="")


def compare(whole: Path, tiled: Path) -> str:
    """Tell whether two files are equal, or all values in them: notes on gaps are memory's alone."""
    if whole.read_bytes() == tiled.read_bytes():
        return "equal"
    return "all but notes equal" if _list_values(whole) == _list_values(tiled) else "different"


def _list_values(path: Path) -> list[bytes]:
    """Return what a raster, or a layer, holds besides notes."""
    if path.suffix == ".tif":
        import rasterio

        with rasterio.open(path) as raster:
            return [raster.read().tobytes(), repr(raster.profile).encode()]
    import pyogrio

    found: list[bytes] = []
    for layer, _ in pyogrio.list_layers(path):
        _, _, geometries, columns = pyogrio.raw.read(path, layer)
        found += [*geometries, *(repr(column.tolist()).encode() for column in columns)]
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--points", type=lambda text: int(float(text)), default=10**7)
    parser.add_argument("--tiles", type=int, default=16)
    parser.add_argument("--workers", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--only", nargs="+", choices=list(PRODUCTS), metavar="PRODUCT")
    add_option(parser)
    given = parser.parse_args()
    source = given.folder / f"lidar-{given.points:.0e}-2"
    make_lidar_tiles(source, given.points, 2, workers=given.workers)
    cloud = ts.tiles(source)
    if cloud.bounds is None:
        raise SystemExit(f"The headers in '{source}' tell no bounds.")
    write_inputs(source, cloud.bounds, cloud.crs)
    for name in ("whole", "tiled"):
        (given.folder / name).mkdir(exist_ok=True)
    table = Table(COLUMNS)
    for name in given.only or PRODUCTS:
        product = PRODUCTS[name]
        whole, tiled = (given.folder / one / f"made{product.suffix}" for one in ("whole", "tiled"))
        alone = measure(source, product, whole)
        in_tiles = ("--tiles", str(given.tiles), "--workers", str(given.workers), "--restart")
        parts = measure(source, product, tiled, *in_tiles)
        table.show(name, *alone, *parts, compare(whole, tiled))
    table.write(given.json)


if __name__ == "__main__":
    main()
