"""Fewest points within a tolerance: a raster terrain beside pydelatin, and a million points.

``python -m benchmarks.simplification`` prints the table of docs/simplify.md: vertices, triangles,
the largest error at all cells and the least processor time of some runs, the programs in turn on
one core. ``--blocks SIDE`` times a raster that is simplified in blocks, ``--points N`` N random
points of a terrain with noise. ``--write FILE`` writes a tiled GeoTIFF, with ``--side``,
for ``tinsmith simplify``.
"""

from __future__ import annotations

import argparse
import resource
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

import tinsmith as ts
from tinsmith.base.policies import SimplificationHold

from .measure import is_installed
from .report.tables import TEXT, Table, add_option

if TYPE_CHECKING:
    from collections.abc import Callable

    from tinsmith.base.arrays import Float32Array, Float64Array

TOLERANCES = (10.0, 3.0, 1.0, 0.3, 0.1)
USUAL_TOLERANCE = 3.0
RUNS = 5
TILE = 512
CRS = "EPSG:32616"


def make_heights(side: int, seed: int = 1) -> Float32Array:
    """Return a square raster whose roughness falls with the frequency, 300 high."""
    rng = np.random.default_rng(seed)
    squares = np.fft.fftfreq(side) ** 2
    power = squares[:, None] + squares[None, :]
    power[0, 0] = 1.0
    waves = (rng.normal(size=power.shape) + 1j * rng.normal(size=power.shape)) * power**-1.1
    waves[0, 0] = 0.0
    z = np.fft.ifft2(waves).real
    return (300.0 * (z - z.min()) / np.ptp(z)).astype(np.float32)


def as_points(heights: Float32Array) -> Float64Array:
    """Return the cells of a raster as points, one unit apart."""
    y, x = np.indices(heights.shape)
    return np.column_stack([x.ravel(), y.ravel(), heights.ravel()]).astype(float)


COLUMNS = {
    "tolerance": "{:g}",
    "program": TEXT,
    "vertices": "{:,}",
    "triangles": "{:,}",
    "largest error": "{:.4f}",
    "seconds": "{:.3f}",
}


def measure_error(tin: ts.TIN, points: Float64Array) -> float:
    """Return the largest difference of elevations at points."""
    return float(np.abs(tin.interpolate(points[:, :2]) - points[:, 2]).max())


def as_raster(heights: Float32Array) -> ts.Raster:
    """Return a raster whose rows go south from 0, cells one unit apart, with centres at 0, 1, 2."""
    rows, columns = heights.shape
    bounds = ts.Bounds(-0.5, 0.5 - rows, columns - 0.5, 0.5)
    return ts.Raster({"elevation": heights}, ts.Grid(bounds, heights.shape, 1.0))


def compare(side: int) -> Table:
    """Show vertices, triangles, errors and processor seconds of both programs."""
    heights = make_heights(side)
    points = as_points(heights) * [1, -1, 1]
    raster = as_raster(heights)
    table = Table(COLUMNS)

    def show(tolerance: float, program: str, tin: ts.TIN, seconds: float) -> None:
        counts = len(tin.points), len(tin.triangles)
        table.show(tolerance, program, *counts, measure_error(tin, points), seconds)

    for tolerance in TOLERANCES:
        programs: dict[str, Callable[[], Any]] = {
            "tinsmith": partial(ts.simplify, raster, tolerance=tolerance, threads=1)
        }
        if is_installed("pydelatin"):
            from pydelatin import Delatin  # type: ignore[import-not-found]

            programs["pydelatin"] = partial(Delatin, heights, max_error=tolerance)
        made, seconds = time_in_turn(programs)
        for program, found in made.items():
            tin = found if program == "tinsmith" else as_tin(found, side)
            show(tolerance, program, tin, seconds[program])
    surface = ts.triangulate(points, threads=1)
    begin = time.process_time()
    simple = ts.simplify(surface, tolerance=USUAL_TOLERANCE, threads=1)
    show(USUAL_TOLERANCE, "TIN", simple, time.process_time() - begin)
    return table


def time_in_turn(
    programs: dict[str, Callable[[], Any]],
) -> tuple[dict[str, Any], dict[str, float]]:
    """Run programs in turn; return what each made, and the least of its processor times."""
    made: dict[str, Any] = {}
    seconds = dict.fromkeys(programs, np.inf)
    for _ in range(RUNS):
        for name, program in programs.items():
            begin = time.process_time()
            made[name] = program()
            seconds[name] = min(seconds[name], time.process_time() - begin)
    return made, seconds


def as_tin(made: Any, side: int) -> ts.TIN:
    """Return what pydelatin made as a TIN; its rows go up."""
    corners = made.vertices.reshape(-1, 3).astype(float)
    corners[:, 1] -= side - 1
    return ts.TIN.from_triangles(corners, made.triangles.reshape(-1, 3))


def time_blocks(side: int) -> None:
    """Print what a raster takes that is too large for one piece, read as it is asked for."""
    tile = make_heights(1000)

    class Tiles:
        """The tile again and again, mirrored, so that it goes on."""

        shape, dtype = (side, side), np.dtype(np.float32)

        def __getitem__(self, key: Any) -> Any:
            rows, columns = (np.arange(part.start, part.stop) for part in key)
            return tile[np.ix_(*(np.abs((part + 999) % 1998 - 999) for part in (rows, columns)))]

    grid = ts.Grid(ts.Bounds(0.0, 0.0, float(side), float(side)), (side, side), 1.0)
    raster = ts.Raster({"elevation": Tiles()}, grid)  # type: ignore[dict-item]
    begin, wall = time.process_time(), time.perf_counter()
    simple = ts.simplify(raster, tolerance=USUAL_TOLERANCE)
    told = simple.report.simplification
    print(
        f"{side:,} x {side:,} cells to {len(simple.points):,} vertices, largest error "
        f"{told.largest_error:.4f}: {time.process_time() - begin:.1f} s of processors, "
        f"{time.perf_counter() - wall:.1f} s, {measure_peak_memory() / 2**20:,.0f} MiB at the peak"
    )


def write_raster(path: Path, side: int) -> None:
    """Write a GeoTIFF of the tile again and again, mirrored, on long waves."""
    import rasterio

    tile, rng = make_heights(1000), np.random.default_rng(3)
    east, north, phase = rng.uniform([[0.5], [0.5], [0.0]], [[6.0], [6.0], [6.28]], (3, 12))
    columns = np.arange(side)
    profile = {"driver": "GTiff", "width": side, "height": side, "count": 1, "dtype": "float32"}
    tiling = {"tiled": True, "blockxsize": TILE, "blockysize": TILE, "BIGTIFF": "IF_SAFER"}
    transform = rasterio.transform.from_origin(5e5, 4.1e6, 1.0, 1.0)
    with rasterio.open(path, "w", **profile, **tiling, transform=transform, crs=CRS) as file:
        for first in range(0, side, TILE):
            rows = np.arange(first, min(first + TILE, side))
            z = tile[np.ix_(*(np.abs((part + 999) % 1998 - 999) for part in (rows, columns)))]
            for a, b, start in zip(east, north, phase, strict=True):
                along = np.sin(a * 2 * np.pi * columns / side + start)
                z += (20 * np.cos(b * 2 * np.pi * rows / side)[:, None] * along).astype("f4")
            file.write(z, 1, window=((first, rows[-1] + 1), (0, side)))


def measure_peak_memory() -> int:
    """Return the most memory that the process had, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def time_points(count: int) -> None:
    """Print how long it takes to leave about a hundredth of random points, by each ``hold``."""
    rng = np.random.default_rng(1)
    x, y = rng.uniform(0, 10 * np.sqrt(count), (2, count))
    z = 50 * np.sin(x / 700) * np.cos(y / 900) + 8 * np.sin(x / 90 + y / 130)
    surface = ts.triangulate(np.column_stack([x, y, z + rng.normal(0, 0.05, count)]), threads=1)
    for hold in get_args(SimplificationHold):
        begin = time.process_time()
        simple = ts.simplify(surface, tolerance=1.0, hold=hold, threads=1)
        seconds = time.process_time() - begin
        share = 100 * len(simple.points) / count
        kept = f"{len(simple.points):,} ({share:.1f} %)"
        print(f"{count:,} points to {kept}, held by {hold}: {seconds:.2f} s")


def main() -> None:
    """Read the command line and print what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=1000, help="cells of a side")
    parser.add_argument("--blocks", type=int, help="time a raster with such a side instead")
    parser.add_argument("--points", type=int, help="time so many random points instead")
    parser.add_argument("--write", type=Path, metavar="FILE", help="write a GeoTIFF instead")
    add_option(parser)
    given = parser.parse_args()
    if given.write:
        write_raster(given.write, given.side)
    elif given.blocks:
        time_blocks(given.blocks)
    elif given.points:
        time_points(given.points)
    else:
        compare(given.side).write(given.json)


if __name__ == "__main__":
    main()
