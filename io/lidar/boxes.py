"""What the headers of lidar say of its points, and the points of a box of an octree (COPC)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base import optional
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE
from ...tin import Bounds
from ..isolated import choose_limits, start_early, stream_isolated
from ..registry import PointChunk, SourceHeader, join_chunks, make_source_header, taking
from ..reprojection import Placing, are_small_degrees, find_bounds
from .reading import CHILD, Cloud, describe_surplus, locate_tiles, name_attributes, scale
from .selection import Asked

if TYPE_CHECKING:
    from pathlib import Path


@taking(Asked)
def describe(path: Path, asked: Asked) -> SourceHeader:
    """Tell what the headers of a file, or of the tiles of a folder, say of its points."""
    optional.require("laspy", "Reading lidar")
    cloud = locate_tiles(path, asked)
    tiles, head = cloud.tiles, cloud.head
    notes = [note for tile in tiles for note in tile.reference.notes]
    notes += [note for tile in tiles for note in describe_surplus(tile.header)]
    return make_source_header(
        path,
        "las",
        count=head.most_points,
        bounds=_find_bounds(cloud),
        crs=head.crs,
        elevation_unit=head.elevation_unit,
        obstacle=_find_obstacle(cloud)
        or ("is thinned by the option `every`, all over" if cloud.selection.every > 1 else ""),
        records=" and ".join(dict.fromkeys(one.header.records_format for one in tiles)),
        notes=tuple(dict.fromkeys(notes)),
    )


def _find_bounds(cloud: Cloud) -> Bounds | None:
    """Return the bounds that the headers give, in the CRS that is wanted."""
    found = [
        find_bounds(one.header.low[:2], one.header.high[:2], one.reference.crs, cloud.target)
        for one in cloud.tiles
    ]
    known = [box for box in found if box is not None]
    if not known or len(known) < len(found):
        return None
    sides = np.array([[box.xmin, box.ymin, box.xmax, box.ymax] for box in known])
    return Bounds(*sides[:, :2].min(axis=0).tolist(), *sides[:, 2:].max(axis=0).tolist())


def _find_obstacle(cloud: Cloud) -> str:
    """Return why points cannot be read by box; empty if they can."""
    tiles, _, selection, target = cloud
    if len(tiles) > 1 or not tiles[0].header.is_copc:
        return "has no octree (COPC)"
    source, header = tiles[0].reference.crs, tiles[0].header
    corners = np.array([header.low, header.high])
    if target is not None and source is None and are_small_degrees(corners, target):
        return "may be in degrees"
    if target is not None and source is not None and not source.is_same(target):
        return "would be reprojected"
    if selection.window is not None or selection.resolution is not None:
        return "is read by the options `window` or `resolution` already"
    return ""


@taking(Asked)
def read_box(path: Path, bounds: Bounds, asked: Asked) -> PointChunk:
    """Read the points of an octree that lie in a box, in the order of the file.

    Parameters
    ----------
    bounds : Bounds
        In the CRS of the file; the edges belong to it.

    Raises
    ------
    ReadError
        If the file has no octree that holds all of its points, or the points lie elsewhere than it
        says.
    OptionError
        If the option ``every`` counts points over the whole file.
    """
    optional.require("laspy", "Reading lidar")
    start_early(CHILD)
    cloud = locate_tiles(path, asked)
    if obstacle := _find_obstacle(cloud):
        raise ReadError(f"{FILE} {obstacle}: its points cannot be read by box.")
    tile, selection, target = cloud.tiles[0], cloud.selection, cloud.target
    if selection.every > 1:
        raise OptionError("every", selection.every, "1, where points are read by box")
    header = tile.header
    placing = Placing(tile.reference.crs or target, target, tile.unit)
    box = [bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax]
    chunks = []
    with stream_isolated(
        f"{CHILD}:read_nodes",
        {"path": str(header.path.absolute()), "wanted": selection.to_request(), "box": box},
        path=header.path,
        limits=choose_limits(header.size),
    ) as parts:
        for part in parts:
            placed = placing.add(scale(part.arrays["xyz"], header))
            chunks.append(PointChunk(placed.points, part.arrays["rows"], name_attributes(part)))
    return join_chunks(chunks)
