"""The planar straight-line graph of a TIN, for building its surface of other vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..constraints import BOUNDARY, Clip, ConstraintTable, Polylines, Pslg

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array, Int64Array
    from ...base.policies import LineKind
    from ..surface import TIN


def list_rings(tin: TIN) -> list[list[int]]:
    """Return the rings of the boundary, each from a vertex back to it."""
    return [[*ring.tolist(), int(ring[0])] for ring in tin.rings]


def gather_pslg(
    tin: TIN,
    points: Float64Array,
    follow: Callable[[list[int]], list[int]],
    rings: list[list[int]],
    *,
    names_boundary: bool,
    more_edges: Int64Array | None = None,
) -> Pslg:
    """Return vertices, and the segments of a TIN's lines, of edges of no line, of its boundary.

    ``follow`` takes a chain of vertices of the TIN, and returns it as one of ``points``, (v, 3);
    ``rings`` are those of the boundary in the order of :func:`list_rings`, as such chains, which
    become lines with ``names_boundary`` if none is. ``more_edges``, (k, 2), of the TIN are segments
    of no line. The boundary of what is returned is there (``Clip.has_own_boundary``).
    """
    lines = [chain.tolist() for chain in tin.lines.chains()]
    more: list[list[int]] = [] if more_edges is None else more_edges.tolist()
    nameless = [*tin._current.find_edges_of_no_line().tolist(), *more]
    named = rings if names_boundary and "boundary" not in tin.lines.kinds else []
    chains = [follow(chain) for chain in lines + nameless] + named + rings
    return Pslg(
        points=points,
        polylines=Polylines.of_chains(chains),
        constraints=_gather_constraints(tin, len(nameless), len(named), len(rings)),
        groups=np.full(len(chains), BOUNDARY),
        clip=Clip(has_own_boundary=True),
        vertex_of=tin.vertex_of,
    )


def _gather_constraints(tin: TIN, n_nameless: int, n_named: int, n_rings: int) -> ConstraintTable:
    """Return what lines are: the TIN's own, edges of no line, rings as lines and as boundary."""
    lines = tin.lines
    n_breaklines = sum(kind in ("hard", "soft") for kind in lines.kinds)
    nameless = n_breaklines + np.arange(n_nameless)
    return ConstraintTable.join(
        [
            ConstraintTable(
                lines.kinds, lines.sources.astype(np.int32), np.zeros(len(lines)), lines.names
            ),
            _make_nameless("soft", nameless),
            _make_nameless("boundary", np.arange(n_named)),
            _make_nameless("boundary", np.full(n_rings, -1)),
        ]
    )


def _make_nameless(kind: LineKind, sources: Int64Array) -> ConstraintTable:
    return ConstraintTable.of_kind(kind, sources.astype(np.int32), np.zeros(len(sources)))
