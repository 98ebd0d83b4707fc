"""Which levels a pyramid has, tiles without a surface, and the file that names all."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.sentences import counted
from .grid_tiles import FROM_CORNER
from .tile import STEPS, Tile, TileName, encode_tile

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array

MOST_LEVEL = 23
"""A step of its tiles is 0.07 mm."""

_STEPS_IN_AN_EDGE = 1000
"""Steps of the grid in half of the edges of the TIN, or more, on the finest level: rounding turns
such an edge by a thousandth at most, and a tile holds about 2,000 triangles."""

_SHARE_OF_A_TILE = 0.25
"""Of the coarsest level that shows the surface: how much of a tile's width that must be."""

_COARSEST_ERROR = 77_067.34
"""Metres: error that Cesium expects of level 0, and half of it of each further one."""

_MANY_TILES = 10_000
"""Up to which a level may have more tiles than there are triangles."""

_SHARE_OF_ERROR = 0.25
"""Of that error, what simplification may take."""


def count_edge_levels(starts: Float64Array, ends: Float64Array) -> Int64Array:
    """Return how many edges have enough steps from each level on, (24,).

    Parameters
    ----------
    starts, ends : (k, 2 or more) float64 array
        Degrees.
    """
    widths = np.abs(ends[:, :2] - starts[:, :2]).max(axis=1, initial=0.0)
    least = 180.0 / STEPS * _STEPS_IN_AN_EDGE / 2.0 ** np.arange(MOST_LEVEL - 1, -1, -1)
    levels = MOST_LEVEL - np.searchsorted(least, widths, "right")
    return np.bincount(levels, minlength=MOST_LEVEL + 1)


def choose_finest(counts: Int64Array) -> int:
    """Return the level at which half of the edges have enough steps, by the counts of all.

    Examples
    --------
    >>> choose_finest(np.array([0, 1, 1, 2]))
    2
    """
    return int(np.flatnonzero(2 * np.cumsum(counts) >= counts.sum())[0])


def choose_first(low: Float64Array, high: Float64Array, finest: int) -> int:
    """Return the coarsest level that shows a surface between two corners, degrees."""
    extent = float((high - low)[:2].max())
    return min(int(max(np.ceil(np.log2(180.0 * _SHARE_OF_A_TILE / extent)), 0)), finest)


def find_tolerance(level: int) -> float:
    """Return within what the surface may differ on a level, metres."""
    return _SHARE_OF_ERROR * _COARSEST_ERROR * 2.0**-level


def describe_small(level: int) -> str:
    """Return the refusal of a level without a triangle."""
    return (
        f"Quantized-mesh tiles cannot be written: on level {level} no triangle is as large as a "
        "step of a tile; choose a finer one."
    )


def measure_area(points: Float64Array, triangles: AnyArray) -> float:
    """Return the area of triangles in square degrees."""
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    return float(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def describe_many(level: int, area: float, count: int) -> str:
    """Return the refusal of a level that has more tiles than there are triangles, or nothing.

    ``area`` is that of the surface in square degrees, and ``count`` its number of triangles.
    """
    tiles = area / (180.0 / 2**level) ** 2
    if tiles <= max(count, _MANY_TILES):
        return ""
    return (
        f"Quantized-mesh tiles cannot be written: level {level} would have {tiles:,.0f} tiles or "
        f"more, and the surface has {counted(count, 'triangle')}: leave out points far from the "
        "others, or choose a coarser finest level (`max_level`)."
    )


def list_bare(low: Float64Array, high: Float64Array, level: int) -> list[TileName]:
    """Return the tiles over a surface between two corners, degrees."""
    width = 180.0 / 2**level
    last = np.array((2 ** (level + 1) - 1, 2**level - 1))
    corners = ((np.stack([low, high]) + FROM_CORNER)[:, :2] // width).astype(int)
    (west, south), (east, north) = np.minimum(corners, last).tolist()
    found = [TileName(level, x, y) for x in range(west, east + 1) for y in range(south, north + 1)]
    return [*found, *list_missing(level, found)]


def list_missing(level: int, names: Sequence[TileName]) -> list[TileName]:
    """Return the tiles that a level needs besides some: Cesium needs both of level 0."""
    return [one for one in (TileName(0, 0, 0), TileName(0, 1, 0)) if not level and one not in names]


def make_bare_tile(name: TileName) -> Tile:
    """Return a tile of the bare ellipsoid, dense enough to be round."""
    count = max(64 >> name.level, 8)
    line = np.rint(np.linspace(0, STEPS, count + 1)).astype(np.int64)
    v, u = np.meshgrid(line, line, indexing="ij")
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    lower = np.stack([corner, corner + 1, corner + count + 2], axis=1)
    upper = np.stack([corner, corner + count + 2, corner + count + 1], axis=1)
    tile = Tile(
        np.column_stack([u.ravel(), v.ravel(), np.zeros(u.size, np.int64)]),
        np.concatenate([lower, upper]),
        0.0,
        0.0,
    )
    west, south, _, _ = name.bounds
    places = np.radians(tile.place(west, south, name.width))
    flat = np.cos(places[:, 1])
    normals = np.column_stack(
        [flat * np.cos(places[:, 0]), flat * np.sin(places[:, 0]), np.sin(places[:, 1])]
    )
    return Tile(tile.steps, tile.triangles, 0.0, 0.0, normals)


# ----------------------------------------------------------------------- files


def encode_file(tile: Tile, name: TileName, *, is_gzipped: bool) -> bytes:
    """Return the bytes of the file of a tile."""
    content = encode_tile(tile, name)
    return gzip.compress(content, mtime=0) if is_gzipped else content


def find_file(folder: Path, name: TileName) -> Path:
    """Return the file of a tile, in a folder that is made if need be."""
    place = folder / str(name.level) / str(name.x)
    place.mkdir(parents=True, exist_ok=True)
    return place / f"{name.y}.terrain"


def write_bare(folder: Path, names: Iterable[TileName], *, is_gzipped: bool) -> None:
    """Write tiles of the bare ellipsoid."""
    for name in names:
        content = encode_file(make_bare_tile(name), name, is_gzipped=is_gzipped)
        find_file(folder, name).write_bytes(content)


class _Range(NamedTuple):
    """Rows of a column of tiles."""

    x: int
    low: int
    high: int


def describe_layer(
    low: Float64Array, high: Float64Array, available: Sequence[Sequence[TileName]]
) -> Mapping[str, Any]:
    """Return the text of ``layer.json`` as plain values.

    Parameters
    ----------
    low, high : (3,) float64 array
        Longitude and latitude between which the surface lies, degrees.
    available : sequence of sequence of TileName
        The tiles of each level.
    """
    return {
        "tilejson": "2.1.0",
        "name": "terrain",
        "version": "1.0.0",
        "format": "quantized-mesh-1.0",
        "scheme": "tms",
        "projection": "EPSG:4326",
        "tiles": ["{z}/{x}/{y}.terrain"],
        "extensions": ["octvertexnormals"],
        "bounds": [*low[:2].tolist(), *high[:2].tolist()],
        "minzoom": 0,
        "maxzoom": len(available) - 1,
        "available": [_list_ranges(names) for names in available],
    }


def _list_ranges(names: Sequence[TileName]) -> list[dict[str, int]]:
    """Return rectangles of tiles: runs within a column, joined where columns have the same."""
    columns: dict[int, list[int]] = {}
    for name in names:
        columns.setdefault(name.x, []).append(name.y)
    runs = [run for x in sorted(columns) for run in _find_runs(x, sorted(columns[x]))]
    made: list[dict[str, int]] = []
    open_runs: dict[tuple[int, int], dict[str, int]] = {}
    for run in runs:
        same = open_runs.get((run.low, run.high))
        if same is None or same["endX"] != run.x - 1:
            same = {"startX": run.x, "startY": run.low, "endX": run.x, "endY": run.high}
            made.append(same)
            open_runs[run.low, run.high] = same
        else:
            same["endX"] = run.x
    return made


def _find_runs(x: int, rows: list[int]) -> list[_Range]:
    runs = [_Range(x, rows[0], rows[0])]
    for row in rows[1:]:
        if row == runs[-1].high + 1:
            runs[-1] = runs[-1]._replace(high=row)
        else:
            runs.append(_Range(x, row, row))
    return runs
