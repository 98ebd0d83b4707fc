"""Lidar tiles as a flight delivers them: strips of scan lines, ground below trees and houses."""

from __future__ import annotations

import math
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

__all__ = ["make_ground", "make_lidar_tiles", "make_text"]

_SEED = 20_261
_CORNER = (500_000.0, 4_000_000.0)
_DENSITY = 4.0
"""Points a square metre, of all returns."""
_LINE = 0.7
"""Metres between scan lines."""
_CHUNK = 2_000_000
_CLASS = "classification"
_GROUND, _HIGH_VEGETATION, _BUILDING = 2, 5, 6


def make_lidar_tiles(folder: Path, count: int, tiles: int, *, workers: int = 2) -> list[Path]:
    """Write about so many points to square LAZ tiles, row by row from the south-west.

    Points are in the order of scan lines, in centimetres; 45 percent are ground, of class 2.
    """
    folder.mkdir(parents=True, exist_ok=True)
    side = math.ceil(math.sqrt(tiles))
    share = count // tiles
    width = math.sqrt(share / _DENSITY)
    places = [(k % side, k // side) for k in range(tiles)]
    jobs = [
        (folder / f"tile_{column:02d}_{row:02d}.laz", column * width, row * width, width, share)
        for column, row in places
    ]
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(_write_tile, jobs))


def _write_tile(job: tuple[Path, float, float, float, int]) -> Path:
    import laspy

    path, west, south, width, count = job
    if path.exists():
        return path
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales = np.array([0.01, 0.01, 0.01])
    header.offsets = np.array([*_CORNER, 0.0])
    header.add_crs(_find_crs())
    rng = np.random.default_rng([_SEED, round(west), round(south)])
    beside = path.with_suffix(".part")
    with laspy.open(beside, "w", header=header, do_compress=True) as writer:
        done = 0
        while done < count:
            number = min(_CHUNK, count - done)
            low, high = (south + width * share / count for share in (done, done + number))
            writer.write_points(_fly(rng, header, west, width, low, high, number))
            done += number
    beside.rename(path)
    return path


def _fly(
    rng: np.random.Generator,
    header: object,
    west: float,
    width: float,
    low: float,
    high: float,
    number: int,
) -> object:
    """Return points of the scan lines from south to north between two northings."""
    import laspy

    lines = max(1, round((high - low) / _LINE))
    along = np.sort(rng.integers(0, lines, number))
    across = rng.random(number)
    forward = along % 2 == 0
    order = np.lexsort((np.where(forward, across, -across), along))
    x = west + width * across[order]
    y = low + (along + rng.random(number)) * ((high - low) / lines)
    ground = 120.0 + 15.0 * np.sin(x / 370.0) + 9.0 * np.cos(y / 190.0) + 0.002 * x
    kind = rng.random(number)
    wooded = np.sin(x / 90.0) + np.cos(y / 70.0) > 0
    built = (x % 60.0 < 14.0) & (y % 45.0 < 11.0) & ~wooded
    classes = np.where(built, _BUILDING, np.where(wooded & (kind > 0.2), _HIGH_VEGETATION, _GROUND))
    above = np.select([classes == _BUILDING, classes == _HIGH_VEGETATION], [7.0, 18.0 * kind], 0.0)
    z = ground + above + rng.normal(0.0, 0.02, number)
    points = laspy.ScaleAwarePointRecord.zeros(number, header=header)
    points.x, points.y, points.z = x + _CORNER[0], y + _CORNER[1], z
    points.classification = classes.astype(np.uint8)
    points.return_number = np.ones(number, np.uint8)
    points.number_of_returns = np.where(classes == _HIGH_VEGETATION, 2, 1).astype(np.uint8)
    points.intensity = (kind * 60_000).astype(np.uint16)
    points.gps_time = np.sort(rng.random(number)) + low
    return points


def _find_crs() -> object:
    import pyproj

    return pyproj.CRS("EPSG:32616")


def make_text(tiles: list[Path], path: Path) -> Path:
    """Write the points of tiles to one file of delimited text, with their classes."""
    return _write_text(tiles, path, ground_only=False)


def make_ground(tiles: list[Path], path: Path) -> Path:
    """Write the ground points of tiles to one file of delimited text."""
    return _write_text(tiles, path, ground_only=True)


def _write_text(tiles: list[Path], path: Path, *, ground_only: bool) -> Path:
    import laspy
    import pyarrow as pa
    from pyarrow import csv

    if path.exists():
        return path
    beside = path.with_suffix(".part")
    names = ("easting", "northing", "elevation")
    plain = csv.WriteOptions(include_header=False)
    with beside.open("wb") as file:
        columns = (*names, *(() if ground_only else (_CLASS,)))
        file.write(f"{','.join(columns)}\n".encode())
        for tile in tiles:
            with laspy.open(tile) as reader:
                for points in reader.chunk_iterator(_CHUNK):
                    classes = np.asarray(points[_CLASS])
                    wanted = classes == _GROUND if ground_only else slice(None)
                    values = [np.round(np.asarray(points[one])[wanted], 2) for one in "xyz"]
                    values += [] if ground_only else [classes]
                    csv.write_csv(pa.table(dict(zip(columns, values, strict=True))), file, plain)
    beside.rename(path)
    return path
