"""Edges, lines and rings of a surface, and their text as GeoJSON features."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base import optional
from ....base.errors import FormatError
from ....terrain.drawing.linework import EDGE_KINDS, find_line_edges
from ....tin.topology import edge_keys, edges_at

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, ObjectArray
    from ....tin import TIN

__all__ = [
    "find_edge_kinds",
    "format_edge_properties",
    "format_lines",
    "gather_edge_flags",
    "group_rings",
    "list_line_vertices",
    "measure_signed_area",
    "require_lines",
]

_LINE = (
    '{"type":"Feature","properties":{"id":%d,"kind":%s,"name":%s,"source":%s},'
    '"geometry":{"type":"LineString","coordinates":[%s]}}'
)


def format_edge_properties(tin: TIN, flags: BoolArray) -> ObjectArray:
    """Return the properties of each edge, as JSON, opposite each corner, (m, 3), flags likewise."""
    kinds = find_edge_kinds(tin, flags)
    texts = ['"constrained":false,"kind":null', '"constrained":true,"kind":null']
    texts += [f'"constrained":true,"kind":"{kind}"' for kind in EDGE_KINDS]
    words: ObjectArray = np.array(texts, object)[np.where(kinds >= 0, kinds + 2, flags)]
    return words


def find_edge_kinds(tin: TIN, flags: BoolArray) -> Int8Array:
    """Return the kind of each edge, an index into ``EDGE_KINDS``; -1 where none is known: (m, 3).

    The flags, (m, 3) likewise, tell which edges are constrained.
    """
    kinds = np.full(flags.shape, -1, np.int8)
    if len(tin.lines):
        kinds[flags] = _look_kinds_up(tin, edges_at(tin.triangles, flags))
    return kinds


def _look_kinds_up(tin: TIN, pairs: Int32Array) -> Int8Array:
    """Return the kind of each edge, an index into ``EDGE_KINDS``; -1 where no line is known."""
    known = find_line_edges(tin, guess=False)
    keys = edge_keys(known.pairs, len(tin.points))
    order = np.argsort(keys)
    wanted = edge_keys(pairs, len(tin.points))
    slot = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    found = order[slot]
    return np.where(keys[found] == wanted, known.kinds[found], -1).astype(np.int8)


def require_lines(tin: TIN) -> None:
    """Refuse a TIN that has no lines.

    Raises
    ------
    FormatError
    """
    if not (len(tin.lines) or tin.constrained.any()):
        raise FormatError(
            "This TIN has no lines: breaklines, boundary, holes and water are given when it is "
            "built.",
            known=("triangles", "points", "edges", "hull"),
        )


def list_line_vertices(tin: TIN) -> list[Int32Array]:
    """Return the chains of a TIN; where none are known, its constrained edges one by one."""
    return list(tin.lines.chains()) if len(tin.lines) else list(find_line_edges(tin).pairs)


def format_lines(tin: TIN, positions: ObjectArray) -> Iterator[str]:
    """Give a feature for each line, given the positions of the vertices as JSON."""
    lines = tin.lines
    for number, vertices in enumerate(list_line_vertices(tin)):
        properties: tuple[Any, ...] = ("null", '""', "null")
        if len(lines):
            kind, name = json.dumps(lines.kinds[number]), json.dumps(lines.names[number])
            properties = (kind, name, int(lines.sources[number]))
        yield _LINE % (number, *properties, ",".join(positions[vertices]))


def gather_edge_flags(tin: TIN) -> BoolArray:
    """Return the flags of the edges, each edge flagged if either of its triangles says so."""
    flags = tin.constrained.copy()
    triangle, corner = np.nonzero(tin.constrained & (tin.neighbors >= 0))
    other = tin.neighbors[triangle, corner]
    row, back = np.nonzero(tin.neighbors[other] == triangle[:, None])
    flags[other[row], back] = True
    return flags


def group_rings(tin: TIN) -> list[list[Int32Array]]:
    """Group the boundary rings: an outer ring followed by its holes."""
    Polygon = optional.load("shapely").Polygon
    outer = [ring for ring in tin.rings if measure_signed_area(tin.points[ring]) > 0]
    holes = [ring for ring in tin.rings if measure_signed_area(tin.points[ring]) <= 0]
    outer.sort(key=lambda ring: measure_signed_area(tin.points[ring]))
    groups = [[ring] for ring in outer]
    shapes = [Polygon(tin.points[ring, :2]) for ring in outer] if holes else []
    for hole in holes:
        shape = Polygon(tin.points[hole, :2])
        home = next((i for i, around in enumerate(shapes) if around.covers(shape)), -1)
        groups[home].append(hole)
    return groups[::-1]


def measure_signed_area(ring: Float64Array) -> float:
    """Area in the plane, positive counter-clockwise."""
    x, y = (ring[:, :2] - ring[0, :2]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y)) / 2
