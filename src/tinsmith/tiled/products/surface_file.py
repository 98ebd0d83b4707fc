"""The surface itself in one file: the bytes that the one in memory is written with."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.errors import PointsError
from ...io.mesh.ply import SurfaceBlocks
from ...terrain.parts import are_owned
from ..assembling import (
    MOST_AT_A_TIME,
    Sweep,
    find_writable,
    merge_triangles,
    place_points,
    write_turned,
)
from ..numbering import NUMBER, number_vertices
from ..reading import open_store
from ..tasks import TileProduct, save_arrays
from .surface import save_rows

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

_ROWS, _USED, _POINTS, _NUMBERS = ".own.rows", ".used.rows", ".own.points", ".numbers"
_TURNED = ".turned"
_JOINED = "joined"


def check_options(*, format: str) -> dict[str, Any]:  # noqa: A002 - as in write
    """Return plain options, or refuse a format that needs all of the surface at a time."""
    return {"format": find_writable(format)}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Write the triangles that a tile owns, and the vertices in it."""
    job = part.job
    local = part.triangulate(job.tile.box, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    used, corners = np.unique(local.triangles[local.owned], return_inverse=True)
    triangles = corners.reshape(-1, 3).astype(np.int32)
    own = are_owned(local.points, job.tile.box)
    names = save_arrays(part, triangles=triangles)
    names += save_rows(part, {_ROWS: local.numbers[own], _USED: local.numbers[used]})
    names.append(f"{job.key}{_POINTS}")
    with replacing(part.folder / names[-1]) as file:
        file.write(local.points[own].astype("<f8").data)
    return len(local.points), {"triangles": len(triangles)}, names


def join(
    points: StoredPoints,
    options: Mapping[str, Any],  # noqa: ARG001
    records: Mapping[str, Record],
    folder: Path,
) -> SurfaceBlocks:
    """Give vertices and triangles of all tiles their places in the whole.

    Raises
    ------
    PointsError
        If there is no triangle, or more vertices than a file can number.
    """
    keys = [key for key, record in records.items() if record.files]
    if not keys:
        raise PointsError("The points have no surface.")
    work = folder / _JOINED
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    stems = {key: folder / next(iter(records[key].files)) for key in keys}
    asked = [stems[key].with_name(f"{key}{one}") for one in (_ROWS, _USED) for key in keys]
    made = [work / f"{path.name}{_NUMBERS}" for path in asked]
    chunks = open_store(points.folder).chunks
    firsts = np.concatenate([chunk.firsts for chunk in chunks])
    count = number_vertices(asked[: len(keys)], asked, made, firsts)
    own = [stems[key].with_name(f"{key}{_POINTS}") for key in keys]
    vertices = place_points(work, count, zip(made, own, strict=False))
    sweep = Sweep(vertices, work)
    turned, n_triangles = [], 0
    for key, numbers in zip(keys, made[len(keys) :], strict=True):
        with np.load(stems[key].with_name(f"{key}.npz")) as found:
            triangles = found["triangles"]
        if len(triangles):
            turned.append(work / f"{key}{_TURNED}")
            write_turned(turned[-1], np.fromfile(numbers, NUMBER)[triangles], sweep)
            n_triangles += len(triangles)
    triangles = merge_triangles(turned, sweep)
    return SurfaceBlocks(
        count, n_triangles, _cut(vertices), triangles, points.crs, points.elevation_unit
    )


def _cut(vertices: Float64Array) -> Iterator[Float64Array]:
    for start in range(0, len(vertices), MOST_AT_A_TIME):
        yield vertices[start : start + MOST_AT_A_TIME]


PRODUCT = TileProduct(check_options, compute, join)
