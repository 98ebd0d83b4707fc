"""Linework: which edges of a TIN belong to lines, of what kind, and how they are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...tin.topology import edge_keys, edges_at
from . import palette

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int8Array, Int32Array, Int64Array
    from ...tin import TIN

_PURPOSE = "A preview"


class LineStyle(NamedTuple):
    """How a kind of lines is named and drawn; ``width`` is in design pixels."""

    title: str
    color: str
    width: float
    dashed: bool = False


LINE_STYLES = {
    "soft": LineStyle("Soft breaklines", palette.LINES["soft"], 1.8, dashed=True),
    "hard": LineStyle("Breaklines", palette.LINES["hard"], 1.7),
    "hole": LineStyle("Holes", palette.LINES["hole"], 2.0),
    "boundary": LineStyle("Boundary", palette.LINES["boundary"], 2.4),
    "water": LineStyle("Water", palette.LINES["water"], 2.6),
}
EDGE_KINDS = tuple(LINE_STYLES)
"""Kinds of lines; where several share an edge it is of the last in this list."""

_DASH_SHARE = 0.006
"""Length of a dash, and of the gap after it, as a share of the extent."""

_NEARER = -4.0
"""Depth steps by which lines are drawn in front of the edges they run along."""


class LineEdges(NamedTuple):
    """Edges of lines, each once, in the order of the lines."""

    pairs: Int32Array
    """(k, 2), vertices, in the direction of the line."""
    kinds: Int8Array
    """(k,), indices into ``EDGE_KINDS``."""

    def of(self, kind: str) -> Int32Array:
        """Return the edges of a kind, (k, 2)."""
        edges: Int32Array = self.pairs[self.kinds == EDGE_KINDS.index(kind)]
        return edges

    def by_kind(self) -> dict[str, Int32Array]:
        """Return the edges of each kind that there is."""
        return {EDGE_KINDS[rank]: self.of(EDGE_KINDS[rank]) for rank in np.unique(self.kinds)}


def find_line_edges(tin: TIN, *, guess: bool = True) -> LineEdges:
    """Return the edges of all lines of a TIN.

    Constrained edges of which no line is known, as in a TIN from a file, are taken for hard
    breaklines within the surface and for rings on its boundary if ``guess`` is True; else they are
    left out.
    """
    lines = tin.lines
    ranks = np.array([EDGE_KINDS.index(kind) for kind in lines.kinds], np.int8)
    known = LineEdges(lines.segments(), ranks[lines.segment_chains()])
    found = _find_constrained_edges(tin) if guess else LineEdges(known.pairs[:0], known.kinds[:0])
    pairs = np.concatenate([known.pairs, found.pairs])
    kinds = np.concatenate([known.kinds, found.kinds])
    is_guess = np.arange(len(pairs)) >= len(known.pairs)
    keys = edge_keys(pairs, len(tin.points))
    order = np.lexsort((np.arange(len(pairs)), -kinds, is_guess, keys))
    is_first = np.append(True, np.diff(keys[order]) != 0)[: len(order)]
    chosen = np.sort(order[is_first])
    return LineEdges(pairs[chosen], kinds[chosen])


def _find_constrained_edges(tin: TIN) -> LineEdges:
    pairs = edges_at(tin.triangles, tin.constrained)
    on_rim = tin.neighbors[tin.constrained] < 0
    ranks = EDGE_KINDS.index("hard"), EDGE_KINDS.index("boundary")
    return LineEdges(pairs, np.where(on_rim, ranks[1], ranks[0]).astype(np.int8))


def join_edges(pairs: AnyArray) -> tuple[Int64Array, Int64Array]:
    """Return polylines of edges, (k, 2), that follow one another: vertices, and how many of each.

    An edge that begins where the one before ends goes on with it.
    """
    begins = np.append(True, pairs[1:, 0] != pairs[:-1, 1])[: len(pairs)]
    starts = np.flatnonzero(begins)
    counts = np.diff(np.append(starts, len(pairs))) + 1
    vertices = np.insert(pairs[:, 1], starts, pairs[starts, 0])
    return vertices.astype(np.int64), counts.astype(np.int64)


# ----------------------------------------------------------------------- drawing


def add_lines(plotter: Any, tin: TIN, points: Float64Array, *, factor: float = 1.0) -> list[Any]:
    """Draw the lines of a TIN: hard ones dark, soft ones dashed, rings brown, water blue.

    ``points`` are its vertices as drawn, (n, 3); ``factor`` window pixels for one design pixel.
    Returns an actor for each kind there is.
    """
    pv = optional.load("pyvista", _PURPOSE)
    actors = []
    for kind, pairs in find_line_edges(tin).by_kind().items():
        style, ends = LINE_STYLES[kind], points[pairs]
        if style.dashed:
            extent = float(np.ptp(points[:, :2], axis=0).max())
            ends = cut_into_dashes(ends, pairs, _DASH_SHARE * extent)
        count = len(ends)
        cells = np.column_stack([np.full(count, 2), np.arange(2 * count).reshape(count, 2)])
        mesh = pv.PolyData(ends.reshape(-1, 3), lines=cells.ravel())
        actors.append(_draw(plotter, mesh, style.color, style.width * factor))
    return actors


def cut_into_dashes(ends: Float64Array, pairs: Int32Array, length: float) -> Float64Array:
    """Cut edges into dashes that run on from one edge to the next of the same line.

    ``ends`` are (k, 2, 3); ``pairs`` their vertices, (k, 2): an edge that begins where the one
    before ends goes on with it. A dash is as long as the gap after it. Returns the ends of dashes,
    (d, 2, 3).
    """
    spans = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    along = np.concatenate([[0.0], np.cumsum(spans)[:-1]])
    starts = np.append(True, pairs[1:, 0] != pairs[:-1, 1])
    along -= along[starts][np.cumsum(starts) - 1]
    first = np.floor(along / (2 * length)).astype(np.int64)
    counts = np.floor((along + spans) / (2 * length)).astype(np.int64) - first + 1
    edge = np.repeat(np.arange(len(ends)), counts)
    within = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)
    begin = 2 * length * (first[edge] + within) - along[edge]
    cut = np.stack([begin, begin + length], axis=1) / spans[edge, None]
    cut = np.clip(cut, 0.0, 1.0)
    kept = cut[:, 1] > cut[:, 0]
    edge, cut = edge[kept], cut[kept, :, None]
    made: Float64Array = ends[edge, :1] + cut * (ends[edge, 1:] - ends[edge, :1])
    return made


def _draw(plotter: Any, mesh: Any, color: str, width: float) -> Any:
    """Draw lines in front of the surface that they lie on."""
    actor = plotter.add_mesh(mesh, color=color, lighting=False, line_width=width, pickable=False)
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(_NEARER, _NEARER)
    return actor


def add_polylines(
    plotter: Any,
    points: Float64Array,
    offsets: AnyArray,
    chosen: Int64Array,
    *,
    color: str,
    width: float,
) -> Any:
    """Draw polylines over a surface.

    ``points`` are those of all polylines as drawn, (n, 3), line k being
    ``points[offsets[k]:offsets[k + 1]]``; ``chosen`` tells which to draw, ``width`` is in window
    pixels.
    """
    pv = optional.load("pyvista", _PURPOSE)

    starts, stops = np.asarray(offsets)[chosen], np.asarray(offsets)[chosen + 1]
    cells = [part for a, b in zip(starts, stops, strict=True) for part in (b - a, *range(a, b))]
    mesh = pv.PolyData(points, lines=np.array(cells, np.int64))
    return _draw(plotter, mesh, color, width)
