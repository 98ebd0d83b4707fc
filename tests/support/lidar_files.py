"""Lidar files made byte by byte or by laspy, with what the reader of this package must find."""

from __future__ import annotations

import io
import struct
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["CORNER", "make_cloud", "write_copc"]

CORNER = np.array([752_640.0, 4_024_180.0, 300.0])


def make_cloud(n: int = 500, *, seed: int = 1, point_format: int = 6, version: str = "1.4") -> Any:
    """Return a cloud of laspy: classes 1, 2, 5 and 7, up to three returns, some withheld."""
    import laspy

    rng = np.random.default_rng(seed)
    header = laspy.LasHeader(version=version, point_format=point_format)
    header.scales, header.offsets = np.array([0.001, 0.001, 0.01]), CORNER
    cloud = laspy.LasData(header)
    cloud.xyz = CORNER + rng.random((n, 3)) * (200, 100, 30)
    cloud.classification = rng.choice([1, 2, 2, 5, 7], n).astype(np.uint8)
    cloud.number_of_returns = rng.integers(1, 4, n).astype(np.uint8)
    cloud.return_number = np.minimum(rng.integers(1, 4, n), cloud.number_of_returns).astype(
        np.uint8
    )
    cloud.intensity = rng.integers(0, 60_000, n).astype(np.uint16)
    cloud.withheld = (rng.random(n) < 0.05).astype(np.uint8)
    if "gps_time" in cloud.point_format.dimension_names:
        cloud.gps_time = rng.random(n)
    return cloud


def write_copc(path: Path, cloud: Any, *, wkt: str = "") -> Path:
    """Write a cloud of format 6 as COPC of three levels: a root, its children, theirs.

    Level 0 has every sixteenth point, level 1 every fourth of the others, level 2 the rest.
    """
    import lazrs

    records = cloud.points.array
    middle, half = CORNER + 100.0, 100.0
    level = np.full(len(records), 2)
    level[::4], level[::16] = 1, 0
    xyz = np.stack([cloud.x, cloud.y, cloud.z], axis=1)
    chunks, keys = [], []
    for depth in range(3):
        cells = ((xyz - (middle - half)) // (2 * half / 2**depth)).astype(int).clip(0, 2**depth - 1)
        for cell in np.unique(cells[level == depth], axis=0):
            chosen = (level == depth) & (cells == cell).all(axis=1)
            chunks.append(records[chosen])
            keys.append((depth, *cell.tolist()))
    laszip = lazrs.LazVlr.new_for_compression(6, 0, True)
    info = struct.pack("<5dQQ2d88x", *middle, half, 32.0, 0, 0, 0.0, 1.0)
    return _assemble(path, cloud, chunks, keys, bytes(laszip.record_data()), info, wkt, laszip)


def _assemble(
    path: Path, cloud: Any, chunks: Any, keys: Any, laszip: bytes, info: bytes, wkt: str, vlr: Any
) -> Path:
    import lazrs

    def record(user: str, number: int, content: bytes) -> bytes:
        return struct.pack("<H16sHH32s", 0, user.encode(), number, len(content), b"") + content

    text = wkt.encode() + b"\0"
    vlrs = [("copc", 1, info), ("laszip encoded", 22204, laszip), ("LASF_Projection", 2112, text)]
    offset = 375 + sum(54 + len(content) for _, _, content in vlrs)
    body = io.BytesIO(b"\0" * offset)
    body.seek(offset)
    compressor = lazrs.LasZipCompressor(body, vlr)
    for one in chunks:
        compressor.compress_many(np.frombuffer(one.tobytes(), np.uint8))
        compressor.finish_current_chunk()
    compressor.done()
    end = len(body.getvalue())
    body.seek(offset)
    table = [one for one in lazrs.read_chunk_table(body, vlr) if one[0]]
    entries, place = b"", offset + 8
    for key, (count, size) in zip(keys, table, strict=True):
        entries += struct.pack("<4iQii", *key, place, size, count)
        place += size
    info = info[:40] + struct.pack("<QQ", end + 60, len(entries)) + info[56:]
    vlrs[0] = ("copc", 1, info)
    header = _pack_header(cloud, offset, len(vlrs), end)
    content = body.getvalue()[offset:]
    extended = struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(entries), b"") + entries
    path.write_bytes(header + b"".join(record(*one) for one in vlrs) + content + extended)
    return path


def _pack_header(cloud: Any, offset: int, n_records: int, end: int) -> bytes:
    header, count = cloud.header, len(cloud.points)
    low, high = cloud.xyz.min(axis=0), cloud.xyz.max(axis=0)
    box = [number for pair in zip(high, low, strict=True) for number in pair]
    start = struct.pack("<4sHH16sBB32s32sHHHII", b"LASF", 0, 16, b"", 1, 4, b"", b"", 1, 2026, 375,
                        offset, n_records)  # fmt: skip
    start += struct.pack(
        "<BHI20s12d", 6 | 128, 30, count, b"", *header.scales, *header.offsets, *box
    )
    return start + struct.pack("<QQIQ15Q", 0, end, 1, count, *[0] * 15)
