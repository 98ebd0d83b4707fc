"""Esri TIN folders: the binary ``.adf`` files that ArcGIS keeps a TIN in.

All numbers are big-endian. ``tnxy.adf`` and ``tnz.adf`` hold the nodes, ``tnod.adf`` three nodes,
from 1 on, for each triangle. ``tmsk.adf`` holds a bit for each triangle, 1 where it is masked:
outside the surface, or in a hole. ``tedg.adf`` holds, for each edge of each triangle, the edge of
the triangle beside it, or minus the row of ``teval.adf`` where the edge is enforced: the two edges,
and 2 for a soft, 4 for a hard one. Triangles that reach one of the four superpoints, far outside,
are masked. ``prj.adf`` holds the CRS.

References
----------
The layout is that which MDAL and the Virtual Terrain Project found out; Esri has not published it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from ...tin.topology import NO_NEIGHBOR
from .common import Mesh, mesh_reader, read_content
from .linework import Chain, add_lines, chain_edges

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.policies import LineKind
    from ...tin import TIN

_FILES = {
    "tnxy.adf": (">f8", 2),
    "tnz.adf": (">f4", 1),
    "tnod.adf": (">i4", 3),
    "tedg.adf": (">i4", 3),
    "teval.adf": (">i4", 4),
}
_SUPERPOINT = -3.4e38
"""Elevations below are no data: the least float32, that superpoints have."""

_EDGE_KINDS: dict[int, LineKind] = {2: "soft", 4: "hard"}
_NO_CRS = ("{B286C06B-0879-11D2-AACA-00C04FA33C20}", "UNKNOWN")
"""What ``prj.adf`` holds where the CRS is not known: the class of ArcGIS for that."""


class _Tables(NamedTuple):
    places: Float64Array
    elevations: Float64Array
    corners: Int64Array
    beside: Int64Array
    enforced: Int64Array


@mesh_reader
def read(path: Path) -> Mesh:
    """Read an Esri TIN by its folder, or any of the files in it.

    The CRS defaults to that of ``prj.adf``; the unit of the elevations the files do not tell.
    Masked triangles, and the nodes that only they have, are left out. Enforced edges become hard
    and soft lines; one along the boundary of the surface becomes a line of the boundary.
    """
    folder = path if path.is_dir() else path.parent
    found = {name: _read_numbers(folder / name, *how) for name, how in _FILES.items()
             if name != "teval.adf" or (folder / name).is_file()}  # fmt: skip
    enforced = found.get("teval.adf", np.empty((0, 4), np.int64))
    tables = _Tables(
        found["tnxy.adf"],
        found["tnz.adf"].ravel(),
        found["tnod.adf"],
        found["tedg.adf"],
        enforced,
    )
    _require_sound(tables)
    triangles = tables.corners - 1
    wanted = ~_read_mask(folder, len(triangles))
    used = np.zeros(len(tables.places), np.bool_)
    used[triangles[wanted]] = True
    if (used & (tables.elevations < _SUPERPOINT)).any():
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: a triangle that is not masked reaches a "
            "superpoint, which has no elevation."
        )
    number = np.cumsum(used) - 1
    points = np.column_stack([tables.places, tables.elevations])[used]
    if not wanted.any():
        raise ReadError(f"{FILE} is an Esri TIN whose triangles are all masked.")
    corners = number[triangles[wanted]].ravel()

    def add(tin: TIN) -> TIN:
        chains = _gather_chains(tables, triangles, np.where(used, number, -1), tin)
        return add_lines(tin, chains, "enforced edge")

    return Mesh(
        points,
        corners,
        np.arange(0, len(corners) + 1, 3),
        crs=_read_crs(folder),
        add_lines=add,
    )


def _read_numbers(path: Path, dtype: str, width: int) -> AnyArray:
    content = read_content(path)
    row = width * np.dtype(dtype).itemsize
    if len(content) % row:
        raise ReadError(
            f"'{path}' is damaged: its {len(content)} bytes are no whole number of rows of {row}.",
            path=path,
        )
    numbers = np.frombuffer(content, dtype).reshape(-1, width)
    with np.errstate(invalid="ignore"):  # what is not finite is refused later
        return numbers.astype(np.float64 if dtype[1] == "f" else np.int64)


def _require_sound(tables: _Tables) -> None:
    n_nodes, n_triangles = len(tables.places), len(tables.corners)
    if len(tables.elevations) != n_nodes:
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: tnxy.adf has {counted(n_nodes, 'node')}, and "
            f"tnz.adf {counted(len(tables.elevations), 'elevation')}."
        )
    if len(tables.beside) != n_triangles:
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: tnod.adf has {counted(n_triangles, 'triangle')}, "
            f"and tedg.adf {len(tables.beside)}."
        )
    wrong = (tables.corners < 1) | (tables.corners > n_nodes)
    if wrong.any():
        row = int(np.argmax(wrong.any(axis=1)))
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: triangle {row + 1} of tnod.adf has the nodes "
            f"{tables.corners[row].tolist()}, and there are the nodes 1 to {n_nodes}."
        )


def _read_mask(folder: Path, n_triangles: int) -> BoolArray:
    """Return which triangles are masked.

    The last number of ``tmsx.adf`` is the length of the mask in 16-bit words; it ends the file
    ``tmsk.adf``: the number of 32-bit words, one that is not used, the number of bits, and the
    words, each from its lowest bit on. Triangles behind the last bit are not masked.
    """
    index, content = read_content(folder / "tmsx.adf"), read_content(folder / "tmsk.adf")
    length = 2 * int.from_bytes(index[-4:], "big")
    if len(index) < 4 or not 12 <= length <= len(content):
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: tmsx.adf promises {length} bytes of mask, and "
            f"tmsk.adf has {len(content)}."
        )
    mask = content[len(content) - length :]
    n_bits = int.from_bytes(mask[8:12], "big")
    words = np.frombuffer(mask[12 : len(mask) - len(mask) % 4], ">u4").astype("<u4")
    bits = np.unpackbits(words.view(np.uint8), bitorder="little")
    n_words = int.from_bytes(mask[:4], "big")
    if n_words != len(words) or n_words != -(-n_bits // 32):
        raise ReadError(
            f"{FILE} is a damaged Esri TIN: tmsk.adf promises {n_bits} bits in {n_words} "
            f"words, and has {len(words)}."
        )
    masked = np.zeros(n_triangles, np.bool_)
    known = min(n_bits, n_triangles)
    masked[:known] = bits[:known]
    return masked


def _read_crs(folder: Path) -> str | None:
    """Return the WKT in ``prj.adf``, if there is one."""
    path = folder / "prj.adf"
    if not path.is_file():
        return None
    lines = read_content(path).decode("utf-8", errors="replace").strip("\0 \r\n").splitlines()
    text = lines[0].strip() if lines else ""
    return None if not text or text.upper().startswith(_NO_CRS) else text


def _gather_chains(
    tables: _Tables, triangles: Int64Array, number: Int64Array, tin: TIN
) -> list[Chain]:
    """Return the enforced edges of the surface, chained by their kind.

    Edge ``k`` of a triangle runs from its corner ``k - 1`` to corner ``k``.
    """
    rows = -tables.beside.ravel()
    slots = np.flatnonzero((rows > 0) & (rows <= len(tables.enforced)))
    codes = tables.enforced[rows[slots] - 1, 2]
    edges = np.stack([np.roll(triangles, 1, axis=1).ravel(), triangles.ravel()], axis=1)[slots]
    edges, codes = number[edges], codes[(number[edges] >= 0).all(axis=1)]
    edges = edges[(edges >= 0).all(axis=1)]
    at_boundary = (tin.edge_triangles(edges[:, 0], edges[:, 1]) == NO_NEIGHBOR).sum(axis=1) == 1
    chains = [
        Chain(chain, "boundary") for chain in chain_edges(edges[at_boundary], len(tin.points))
    ]
    for code, kind in _EDGE_KINDS.items():
        own = edges[~at_boundary & (codes == code)]
        chains += [Chain(chain, kind) for chain in chain_edges(own, len(tin.points))]
    return chains
