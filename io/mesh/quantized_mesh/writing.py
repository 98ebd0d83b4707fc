"""Write a TIN as a pyramid of quantized-mesh tiles, a folder that a web server gives to Cesium.

``layer.json`` stands in the folder, tiles in ``level/column/row.terrain`` (EPSG:4326, rows from the
south). The finest level holds the triangles of the TIN, cut along the edges of the tiles; coarser
ones hold fewer of its vertices. Tiles of one level have the same vertices on the edge between them,
and heights on one grid, so that they fit without a crack.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from ....base.atomic import replacing_folder
from ....base.checks import as_flag, require_count
from ....base.errors import CrsError, WriteError
from ....base.notes import warn
from ....base.sentences import FILE
from ....tin import TIN
from ..common import require_tin
from ..globe import describe_heights, has_heights, place_on_globe
from .grid_tiles import FROM_CORNER, LevelTiles, Places, choose_height_step
from .layer import (
    MOST_LEVEL,
    choose_finest,
    choose_first,
    count_edge_levels,
    describe_layer,
    describe_many,
    describe_small,
    encode_file,
    find_file,
    find_tolerance,
    list_bare,
    list_missing,
    measure_area,
    write_bare,
)
from .levels import simplify

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Int64Array
    from ....base.progress import Tell
    from .tile import TileName


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
        The finest level, 0 to 23; default the one at which half of the edges have 1,000 steps.
    gzipped : bool
        Compress each tile: a server must then send ``Content-Encoding: gzip``.

    Raises
    ------
    CrsError
        If the CRS of the TIN is not known, or puts points outside the Earth.
    OptionError
        If there is no such level.
    WriteError
        Also if the folder is of something else, the surface crosses the antimeridian, or its finest
        level has too many tiles, as a point far from the others makes.

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
    require_count("max_level", max_level, least=0, most=MOST_LEVEL, or_none=True)
    placed = _place(tin)
    low, high = placed.points.min(axis=0), placed.points.max(axis=0)
    from_corner = placed.points + FROM_CORNER
    finest = max_level
    if finest is None:
        finest = choose_finest(count_edge_levels(*placed.points[placed.edges].transpose(1, 0, 2)))
    area = measure_area(placed.points, placed.triangles)
    if refusal := describe_many(finest, area, len(placed.triangles)):
        raise WriteError(refusal)
    first = choose_first(low, high, finest)
    available: list[list[TileName]] = []
    with replacing_folder(path, marker="layer.json") as folder:
        for level in range(first):
            available.append(list_bare(low, high, level))
            write_bare(folder, available[-1], is_gzipped=is_gzipped)
        for level, triangles in zip(
            range(first, finest + 1), _iterate_meshes(placed, first, finest), strict=True
        ):
            tiles = LevelTiles(Places(from_corner, triangles), level)
            if not tiles.names:
                raise WriteError(describe_small(level))
            step = choose_height_step(tiles.ranges)
            for k, name in enumerate(tiles.names):
                content = encode_file(tiles.gather(k).round(step), name, is_gzipped=is_gzipped)
                find_file(folder, name).write_bytes(content)
            bare = list_missing(level, tiles.names)
            write_bare(folder, bare, is_gzipped=is_gzipped)
            available.append([*tiles.names, *bare])
            if progress is not None:
                progress((level + 1) / (finest + 1))
        layer = describe_layer(low, high, available)
        (folder / "layer.json").write_text(json.dumps(layer, indent=1) + "\n", encoding="utf-8")


def _place(tin: TIN) -> TIN:
    """Return the surface in longitude, latitude and metres above the ellipsoid."""
    if tin.crs is None:
        raise CrsError(
            f"Cannot write {FILE}: the CRS of the TIN is not known, and tiles lie on the globe."
        )
    if not has_heights(tin.crs):
        warn(describe_heights(tin.crs))
    used, corners = np.unique(tin.triangles, return_inverse=True)
    points = place_on_globe(tin.points[used], tin.crs, tin.elevation_unit)
    if np.ptp(points[:, 0]) > 180.0:
        raise WriteError(f"Cannot write {FILE}: the surface crosses the antimeridian.")
    places = Places.of(points, corners.reshape(-1, 3))
    return TIN.from_triangles(*places)


def _iterate_meshes(placed: TIN, first: int, finest: int) -> Iterator[Int64Array]:
    yield from simplify(placed, [find_tolerance(level) for level in range(first, finest)])
    yield placed.triangles.astype(np.int64)
