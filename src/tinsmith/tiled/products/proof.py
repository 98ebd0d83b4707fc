"""The proof of a surface in tiles: its triangles fill the hull, or the boundary, once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...tin.tiling import TilesProof, TileTriangles, check_tiles, find_outline, reduce_to_hull
from ..lines import open_lines
from ..reading import open_store
from ..tasks import TileProduct, load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def check_options() -> dict[str, Any]:
    """Return no options."""
    return {}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Write the triangles that a tile owns, their vertices with the numbers of the whole."""
    local = part.triangulate(part.job.tile.box, ordered=False)
    owned = local.triangles[local.owned]
    if not len(owned):
        return 0, {}, []
    used, corners = np.unique(owned, return_inverse=True)
    names = save_arrays(
        part,
        points=local.points[used],
        numbers=local.numbers[used],
        triangles=corners.reshape(-1, 3).astype(np.int32),
    )
    return len(used), {}, names


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> TilesProof:
    """Prove the triangles of all tiles.

    Raises
    ------
    CheckError
        At the first fault.
    """
    del options
    skeleton = open_store(points.folder).skeleton
    if points.lines is None:
        return check_tiles(_load(records, folder), hull=reduce_to_hull(skeleton).points)
    outline = find_outline(skeleton, open_lines(points.lines).noded)
    hull = None if outline.is_clipped else outline.rim
    return check_tiles(_load(records, folder), hull=hull, area=outline.area)


def _load(records: Mapping[str, Record], folder: Path) -> Iterator[TileTriangles]:
    for record in records.values():
        if record.files:
            yield TileTriangles(tile=record.key, **load_arrays(folder, record))


PRODUCT = TileProduct(check_options, compute, join)
