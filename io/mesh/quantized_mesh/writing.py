"""Write a TIN as a pyramid of quantized-mesh tiles, a folder that a web server gives to Cesium.

``layer.json`` stands in the folder, tiles in ``level/column/row.terrain`` (EPSG:4326, rows from the
south). The finest level holds the triangles of the TIN, cut along the edges of the tiles; coarser
ones hold fewer of its vertices. Tiles of one level have the same vertices on the edge between them,
and heights on one grid, so that they fit without a crack.
"""

from __future__ import annotations

import gzip
import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.atomic import replacing_folder
from ....base.checks import as_flag, require_count
from ....base.errors import CrsError, WriteError
from ....base.notes import warn
from ....base.sentences import FILE
from ....tin import TIN
from ..common import require_tin
from ..globe import describe_heights, has_heights, place_on_globe
from .levels import GridMesh, cut_along_grid, simplify
from .tile import STEPS, Tile, TileName, encode_tile, to_cartesian

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array
    from ....base.progress import Tell

_MOST_LEVEL = 23
"""A step of its tiles is 0.07 mm."""

_STEPS_IN_AN_EDGE = 1000
"""Steps of the grid in the median edge of the TIN, on the finest level: rounding turns an edge by a
thousandth at most, and a tile holds about 2,000 triangles."""

_SHARE_OF_A_TILE = 0.25
"""Of the coarsest level that shows the surface: how much of a tile's width that must be."""

_COARSEST_ERROR = 77_067.34
"""Metres: error that Cesium expects of level 0, and half of it of each further one."""

_SHARE_OF_ERROR = 0.25
"""Of that error, what simplification may take."""

_FINEST_HEIGHT_STEP = 2.0**-10
"""Metres: about a millimetre; a power of two, so that float32 holds the heights of a header."""

_CORNER = np.array([180.0, 90.0])
"""What makes longitude and latitude count from the south-west corner of all tiles."""


def write(
    surface: TIN,
    path: Path,
    *,
    max_level: int | None = None,
    gzipped: bool = False,
    progress: Tell | None = None,
) -> None:
    """Write a TIN as a folder of quantized-mesh 1.0 tiles with normals and ``layer.json``.

    A folder that holds such tiles is replaced, another one must be empty.

    Parameters
    ----------
    max_level : int, optional
        The finest level, 0 to 23; default the one at which the median edge has 1,000 steps.
    gzipped : bool
        Compress each tile: a server must then send ``Content-Encoding: gzip``.

    Raises
    ------
    CrsError
        If the CRS of the TIN is not known, or puts points outside the Earth.
    OptionError
        If there is no such level.
    WriteError
        Also if the folder is of something else, or the surface crosses the antimeridian.

    Warns
    -----
    LossWarning
        If the CRS has no vertical part: the elevations, in metres, are taken to be above the
        ellipsoid, from which those above the sea differ by up to 110 m.

    Notes
    -----
    Levels coarser than the one at which the surface is a quarter of a tile wide show the bare
    ellipsoid, since Cesium asks for all of them. Simplification differs at the vertices by less
    than a quarter of the error that Cesium expects of a level. Lines are lost.
    """
    tin = require_tin(surface, format_name="quantized-mesh")
    is_gzipped = as_flag("gzipped", gzipped)
    require_count("max_level", max_level, least=0, most=_MOST_LEVEL, or_none=True)
    placed = _place(tin)
    finest = _choose_finest(placed) if max_level is None else int(max_level)
    extent = float(np.ptp(placed.points[:, :2], axis=0).max())
    first = min(int(max(np.ceil(np.log2(180.0 * _SHARE_OF_A_TILE / extent)), 0)), finest)
    available: list[list[TileName]] = []
    with replacing_folder(path, marker="layer.json") as folder:
        for level in range(first):
            width = 180.0 / 2**level
            low = (placed.points[:, :2].min(axis=0) + _CORNER) // width
            high = (placed.points[:, :2].max(axis=0) + _CORNER) // width
            low = np.minimum(low, (2 ** (level + 1) - 1, 2**level - 1)).astype(int)
            high = np.minimum(high, (2 ** (level + 1) - 1, 2**level - 1)).astype(int)
            if level == 0:
                low[0], high[0] = 0, 1
            names = [
                TileName(level, x, y)
                for x in range(low[0], high[0] + 1)
                for y in range(low[1], high[1] + 1)
            ]
            _write_tiles(folder, ((name, _make_bare_tile(name)) for name in names), is_gzipped)
            available.append(names)
        for level, triangles in zip(
            range(first, finest + 1), _iterate_meshes(placed, first, finest), strict=True
        ):
            tiles = dict(_cut_into_tiles(placed, triangles, level))
            if level == 0:  # Cesium needs both
                both = [TileName(0, x, 0) for x in (0, 1)]
                tiles = {name: tiles.get(name) or _make_bare_tile(name) for name in both}
            _write_tiles(folder, tiles.items(), is_gzipped)
            available.append(list(tiles))
            if progress is not None:
                progress((level + 1) / (finest + 1))
        layer = _describe_layer(placed, available)
        (folder / "layer.json").write_text(json.dumps(layer, indent=1) + "\n", encoding="utf-8")


# ----------------------------------------------------------------------- where it lies


def _place(tin: TIN) -> TIN:
    """Return the surface in longitude, latitude and metres above the ellipsoid."""
    if tin.crs is None:
        raise CrsError(
            f"Cannot write {FILE}: the CRS of the TIN is not known, and tiles lie on the globe."
        )
    used = np.unique(tin.triangles)
    number = np.zeros(len(tin.points), np.int64)
    number[used] = np.arange(len(used))
    if not has_heights(tin.crs):
        warn(describe_heights(tin.crs))
    places = place_on_globe(tin.points[used], tin.crs, tin.elevation_unit)
    if np.ptp(places[:, 0]) > 180.0:
        raise WriteError(f"Cannot write {FILE}: the surface crosses the antimeridian.")
    return TIN.from_triangles(places, number[tin.triangles])


def _choose_finest(placed: TIN) -> int:
    """Return the level at which the median edge has enough steps."""
    a, b = placed.points[placed.edges, :2].transpose(1, 0, 2)
    edge = float(np.median(np.abs(b - a).max(axis=1)))
    step = 180.0 / STEPS
    level = np.ceil(np.log2(max(step * _STEPS_IN_AN_EDGE / edge, 1.0)))
    return int(min(level, _MOST_LEVEL))


# ----------------------------------------------------------------------- levels and tiles


def _iterate_meshes(placed: TIN, first: int, finest: int) -> Iterator[Int64Array]:
    tolerances = [_SHARE_OF_ERROR * _COARSEST_ERROR / 2**level for level in range(first, finest)]
    yield from simplify(placed, tolerances)
    yield placed.triangles.astype(np.int64)


def _cut_into_tiles(
    placed: TIN, triangles: Int64Array, level: int
) -> Iterator[tuple[TileName, Tile]]:
    scale = STEPS * 2**level / 180.0
    steps = np.rint((placed.points[:, :2] + _CORNER) * scale).astype(np.int64)
    mesh = GridMesh(steps, placed.points[:, 2], triangles)
    mesh = cut_along_grid(mesh, STEPS)
    if len(mesh.triangles) == 0:
        raise WriteError(
            f"Cannot write {FILE}: on level {level} no triangle is as large as a step of a tile; "
            "choose a finer one."
        )
    plane = mesh.steps / scale - _CORNER
    points = to_cartesian(np.column_stack([plane, mesh.heights]))
    a, b, c = (points[mesh.triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    corners = mesh.triangles.ravel()
    sums = np.column_stack(
        [np.bincount(corners, np.repeat(axis, 3), len(points)) for axis in faces.T]
    )
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    normals = np.asarray(np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > 0))
    tiles = mesh.steps[mesh.triangles].min(axis=1) // STEPS
    order = np.lexsort((tiles[:, 1], tiles[:, 0]))
    starts = np.flatnonzero(np.diff(tiles[order], axis=0, prepend=-1).any(axis=1))
    groups = np.split(order, starts[1:])
    heights = mesh.heights[mesh.triangles]
    low = np.array([heights[rows].min() for rows in groups])
    high = np.array([heights[rows].max() for rows in groups])
    least = max(_FINEST_HEIGHT_STEP, float(np.abs([low, high]).max()) / 2**22)
    step = float(2.0 ** np.ceil(np.log2(least)))
    while (np.rint(high / step) - np.rint(low / step) > STEPS).any():
        step *= 2
    for rows in groups:
        x, y = tiles[rows[0]].tolist()
        yield TileName(level, x, y), _gather_tile(mesh, normals, rows, (x, y), step)


def _gather_tile(
    mesh: GridMesh,
    normals: Float64Array,
    rows: Int64Array,
    place: tuple[int, int],
    step: float,
) -> Tile:
    used, number = np.unique(mesh.triangles[rows], return_inverse=True)
    heights = np.rint(mesh.heights[used] / step).astype(np.int64)
    lowest = int(heights.min())
    plane = mesh.steps[used] - np.array(place) * STEPS
    return Tile(
        np.column_stack([plane, heights - lowest]),
        number.reshape(-1, 3),
        lowest * step,
        (lowest + STEPS) * step,
        normals[used],
    )


def _make_bare_tile(name: TileName) -> Tile:
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


def _write_tiles(folder: Path, tiles: Any, is_gzipped: bool) -> None:
    for name, tile in tiles:
        content = encode_tile(tile, name)
        place = folder / str(name.level) / str(name.x)
        place.mkdir(parents=True, exist_ok=True)
        if is_gzipped:
            content = gzip.compress(content, mtime=0)
        (place / f"{name.y}.terrain").write_bytes(content)


class _Range(NamedTuple):
    """Rows of a column of tiles."""

    x: int
    low: int
    high: int


def _describe_layer(placed: TIN, available: list[list[TileName]]) -> Mapping[str, Any]:
    low, high = placed.points[:, :2].min(axis=0), placed.points[:, :2].max(axis=0)
    return {
        "tilejson": "2.1.0",
        "name": "terrain",
        "version": "1.0.0",
        "format": "quantized-mesh-1.0",
        "scheme": "tms",
        "projection": "EPSG:4326",
        "tiles": ["{z}/{x}/{y}.terrain"],
        "extensions": ["octvertexnormals"],
        "bounds": [*low.tolist(), *high.tolist()],
        "minzoom": 0,
        "maxzoom": len(available) - 1,
        "available": [_list_ranges(names) for names in available],
    }


def _list_ranges(names: list[TileName]) -> list[dict[str, int]]:
    """Return rectangles of tiles: runs within a column, joined where columns have the same."""
    columns: dict[int, list[int]] = {}
    for name in names:
        columns.setdefault(name.x, []).append(name.y)
    runs = [run for x in sorted(columns) for run in _find_runs(x, sorted(columns[x]))]
    made: list[dict[str, int]] = []
    for run in runs:
        same = next(
            (one for one in made if one["endX"] == run.x - 1
             and (one["startY"], one["endY"]) == (run.low, run.high)),
            None,
        )  # fmt: skip
        if same is None:
            made.append({"startX": run.x, "startY": run.low, "endX": run.x, "endY": run.high})
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
