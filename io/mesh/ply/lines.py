"""Lines of a TIN in a PLY file: edges, and in the header what they are.

The element ``edge`` has the constrained edges, first those of the lines, one line after the other,
then those of no line. The header line ``comment edges: constrained`` says so, and for each line one
such as ``comment line: hard 0 12 "kerb"`` tells its kind, source, number of edges and name. QGIS
takes edges for what they are; properties of faces would be data sets there, and unknown elements
are refused.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE
from ....tin import topology
from ....tin.constraints import Lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import Int32Array, Int64Array
    from ....tin import TIN
    from .body import Table
    from .header import LineComment

ENDS = ("vertex1", "vertex2")
"""Properties of an edge, as other programs call them."""


def take_edges(tin: TIN) -> Int32Array:
    """Return the edges of all lines in order, then the constrained ones of no line, (k, 2)."""
    segments = tin.lines.segments()
    flagged = topology.edges_at(tin.triangles, tin.constrained)
    edges = np.unique(np.sort(flagged, axis=1), axis=0)
    n = len(tin.points)
    keys = topology.edge_keys(edges, n)
    others = edges[~np.isin(keys, topology.edge_keys(segments, n))]
    return np.concatenate([segments, others]).astype(np.int32)


def format_line_comments(tin: TIN) -> list[str]:
    """Return the lines of the header that tell what the edges are."""
    lines = tin.lines
    counts = np.diff(lines.offsets) - 1
    rows = zip(lines.kinds, lines.sources.tolist(), counts.tolist(), lines.names, strict=True)
    stated = [
        f"comment line: {kind} {source} {n} {json.dumps(name)}" for kind, source, n, name in rows
    ]
    return ["comment edges: constrained", *stated]


def require_edges(table: Table, n_vertices: int) -> Int64Array:
    """Return the edges of a file of ours as (k, 2) vertex numbers."""
    columns = [table.columns.get(name) for name in ENDS]
    if columns[0] is None or columns[1] is None:
        raise ReadError(f"{FILE} has edges without vertex1 and vertex2.")
    ends = np.stack([np.asarray(column, np.float64) for column in columns], axis=1)
    wrong = ~((ends >= 0) & (ends < n_vertices) & (ends == np.floor(ends))).all(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ReadError(f"edge {row} does not join two of the vertices.")
    return ends.astype(np.int64)


def read_lines(stated: Sequence[LineComment], edges: Int64Array) -> Lines:
    """Return the lines that the header tells of, as chains of vertices."""
    counts = np.array([one.n_edges for one in stated], np.int64)
    if counts.sum() > len(edges) or (counts < 1).any():
        raise ReadError(f"its lines have {counts.sum()} edges, and there are {len(edges)}.")
    starts = np.cumsum(counts) - counts
    own = edges[: counts.sum()]
    follows = np.ones(len(own), np.bool_)
    follows[1:] = own[1:, 0] == own[:-1, 1]
    follows[starts] = True
    if not follows.all():
        row = int(np.argmin(follows))
        raise ReadError(f"edge {row} does not go on where its line is.")
    vertices = np.insert(own[:, 1], starts, own[starts, 0])
    return Lines(
        vertices=vertices.astype(np.int32),
        offsets=topology.find_offsets(counts + 1).astype(np.int32),
        kinds=tuple(one.kind for one in stated),
        sources=np.array([one.source for one in stated], np.int32),
        names=tuple(one.name for one in stated),
    )
