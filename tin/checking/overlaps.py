"""What triangles of other programs may be wrong in although they fit together.

Triangles that are counter-clockwise and agree about their edges cover a place as often as their
boundary winds about it (see :mod:`.check`). So the boundary alone tells whether they overlap, and
a boundary that is one convex ring needs no further look.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.sentences import inflect
from ..predicates import Columns, columns, is_last, orientation
from ..topology import NO_NEIGHBOR, mark_corners
from .boundary_sweep import Boundary, find_fault
from .shape import find_boundary

if TYPE_CHECKING:
    from ..surface import TIN

_MOST_EDGES = 20_000
"""Edges of a boundary that are looked at here, in half a second; a check looks at any number."""


class Overlap(NamedTuple):
    """Whether triangles overlap."""

    is_found: bool
    sentence: str = ""
    """What is to be told: where they do, or that it was not looked at."""


def find_overlap(tin: TIN) -> Overlap:
    """Look for triangles of a TIN that overlap, as :meth:`TIN.from_triangles` may make it.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> points = [[0, 0, 1], [4, 0, 1], [0, 4, 1], [1, 1, 5], [5, 1, 5], [1, 5, 5]]
    >>> find_overlap(TIN.from_triangles(points, [[0, 1, 2], [3, 4, 5]])).sentence
    'Triangles overlap (westernmost place: near vertex 3).'
    """
    boundary = find_boundary(tin)
    if _is_convex(columns(tin.points), boundary):
        return Overlap(is_found=False)
    if len(boundary.start) > _MOST_EDGES:
        return Overlap(
            is_found=False,
            sentence=f"The boundary has {len(boundary.start):,} edges: whether triangles overlap "
            "was not looked at; a check tells.",
        )
    fault = find_fault(boundary)
    if fault is None:
        return Overlap(is_found=False)
    where = f"westernmost place: near vertex {fault.vertex}"
    return Overlap(is_found=True, sentence=f"Triangles overlap ({where}).")


def describe_oddities(tin: TIN) -> list[str]:
    """Tell in sentences of vertices of no triangle, and edges constrained on one side only.

    Beside overlaps that is all that :func:`check` at level 2 may find in a TIN made of existing
    triangles but a boundary that is concave or in several rings, as surfaces may have.
    """
    told = []
    is_used = mark_corners(tin.triangles, len(tin.points))
    n_unused = len(is_used) - int(np.count_nonzero(is_used))
    if n_unused:
        sentence = (
            f"[vertex belongs|vertices belong] to no triangle (first: vertex {np.argmin(is_used)})."
        )
        told.append(f"{n_unused:,} {inflect(sentence, n_unused)}")
    triangle, corner = np.nonzero(tin.constrained & (tin.neighbors != NO_NEIGHBOR))
    across = tin.neighbors[triangle, corner]
    back = np.argmax(tin.neighbors[across] == triangle[:, None], axis=1)
    count = int(np.count_nonzero(~tin.constrained[across, back]))
    if count:
        edges = inflect("[edge is|edges are] constrained on one side only.", count)
        told.append(f"{count:,} {edges}")
    return told


def _is_convex(xy: Columns, boundary: Boundary) -> bool:
    """Whether the boundary is one ring that never turns right and goes round once."""
    order = np.argsort(boundary.start)
    start = boundary.start[order]
    if (start[1:] == start[:-1]).any():  # rings touch
        return False
    following = order[np.searchsorted(start, boundary.end)]
    turns = orientation(xy, boundary.start, boundary.end, boundary.end[following])
    is_extreme = is_last(xy, boundary.end, boundary.start) & is_last(
        xy, boundary.end, boundary.end[following]
    )
    return bool((turns >= 0).all() and np.count_nonzero(is_extreme) == 1)
