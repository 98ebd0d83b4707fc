"""Lidar tiles written again as octrees (COPC 1.0), as delivered by mapping agencies."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["write_octree"]

_NODE_POINTS = 50_000
"""Points of a node that has children, about as PDAL and untwine write them."""
_HEADER = 375
_RECORD = 54
_SEED = 20_262


def write_octree(source: Path, path: Path) -> Path:
    """Write the points of a LAZ file of point format 6 as COPC, unless that is there.

    Each node above the leaves keeps points of its cube at random, and hands the rest down.
    """
    import laspy

    if path.exists():
        return path
    cloud = laspy.read(source)
    xyz = np.asarray(cloud.xyz)
    low, high = xyz.min(axis=0), xyz.max(axis=0)
    half = float((high - low).max() / 2 * (1 + 2.0**-20))
    middle = (low + high) / 2
    nodes = _divide(xyz, middle - half, 2 * half)
    beside = path.with_suffix(".part")
    _assemble(beside, cloud, nodes, (low, high), (middle, half))
    beside.rename(path)
    return path


def _divide(xyz: Any, low: Any, side: float) -> list[tuple[tuple[int, ...], Any]]:
    """Return the keys of nodes, level and place, with the points of each."""
    rng = np.random.default_rng(_SEED)
    found = []
    waiting = [((0, 0, 0, 0), np.arange(len(xyz)))]
    while waiting:
        key, rows = waiting.pop()
        if len(rows) <= _NODE_POINTS:
            found.append((key, rows))
            continue
        is_kept = np.zeros(len(rows), np.bool_)
        is_kept[rng.choice(len(rows), _NODE_POINTS, replace=False)] = True
        found.append((key, rows[is_kept]))
        rest = rows[~is_kept]
        level = key[0] + 1
        width = side / 2**level
        places = np.floor((xyz[rest] - low) / width).astype(np.int64)
        places = np.clip(places - 2 * np.array(key[1:]), 0, 1)
        octants = places @ [1, 2, 4]
        for octant in np.unique(octants).tolist():
            child = [2 * key[1 + k] + (octant >> k & 1) for k in range(3)]
            waiting.append(((level, *child), rest[octants == octant]))
    return found


def _assemble(path: Path, cloud: Any, nodes: Any, box: Any, cube: Any) -> None:
    """Write header, records, compressed nodes and the hierarchy."""
    import lazrs

    records = cloud.points.array
    laszip = lazrs.LazVlr.new_for_compression(6, 0, True)
    text = cloud.header.parse_crs().to_wkt("WKT1_GDAL").encode() + b"\0"
    middle, half = cube
    info = struct.pack("<5dQQ2d88x", *middle, half, half / 64, 0, 0, 0.0, 1.0)
    contents = {
        ("copc", 1): info,
        ("laszip encoded", 22204): bytes(laszip.record_data()),
        ("LASF_Projection", 2112): text,
    }
    offset = _HEADER + sum(_RECORD + len(one) for one in contents.values())
    with path.open("w+b") as file:
        file.write(bytes(offset))
        compressor = lazrs.LasZipCompressor(file, laszip)
        for _, rows in nodes:
            compressor.compress_many(np.frombuffer(records[rows].tobytes(), np.uint8))
            compressor.finish_current_chunk()
        compressor.done()
        end = file.seek(0, 2)
        file.seek(offset)
        table = [one for one in lazrs.read_chunk_table(file, laszip) if one[0]]
        place, entries = offset + 8, b""
        for (key, _), (count, size) in zip(nodes, table, strict=True):
            entries += struct.pack("<4iQii", *key, place, size, count)
            place += size
        file.seek(end)
        extended = struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(entries), b"")
        file.write(extended + entries)
        info = info[:40] + struct.pack("<QQ", end + len(extended), len(entries)) + info[56:]
        contents[("copc", 1)] = info
        file.seek(0)
        file.write(_pack_header(cloud, offset, len(contents), end, box))
        for (user, number), content in contents.items():
            file.write(struct.pack("<H16sHH32s", 0, user.encode(), number, len(content), b""))
            file.write(content)


def _pack_header(cloud: Any, offset: int, n_records: int, end: int, box: Any) -> bytes:
    header, count = cloud.header, len(cloud.points)
    sides = [number for pair in zip(box[1], box[0], strict=True) for number in pair]
    start = struct.pack(
        "<4sHH16sBB32s32sHHHII",
        *(b"LASF", 0, 16, b"", 1, 4, b"", b"", 1, 2026, _HEADER, offset, n_records),
    )
    start += struct.pack(
        "<BHI20s12d", 6 | 128, 30, count, b"", *header.scales, *header.offsets, *sides
    )
    return start + struct.pack("<QQIQ15Q", 0, end, 1, count, *[0] * 15)
