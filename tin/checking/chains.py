"""Levels 1 and 3 of a check: the chains of lines are sound, and all of their segments are edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from ...base.policies import LineKind
from ..topology import edge_keys, edges_at

if TYPE_CHECKING:
    from ..surface import TIN
    from .findings import Findings


def check_chains(tin: TIN, found: Findings) -> None:
    """Check the arrays of the lines; the triangles do not depend on them."""
    lines = tin.lines
    for name in ("vertices", "offsets", "sources"):
        array = np.asarray(getattr(lines, name))
        if array.dtype.kind not in "iu" or array.ndim != 1:
            found.fail("chains", f"lines.{name} is a {array.dtype} array of shape {array.shape}.")
            return
    count = len(lines.offsets) - 1
    if not count == len(lines.kinds) == len(lines.sources) == len(lines.names):
        found.fail(
            "chains",
            f"Lines have {count} chains by their offsets, but {len(lines.kinds)} kinds, "
            f"{len(lines.sources)} sources and {len(lines.names)} names.",
        )
        return
    _check_labels(tin, found)
    _check_ranges(tin, found)
    if count and found.lack("chains"):
        found.counts["chains"] = count


def _check_labels(tin: TIN, found: Findings) -> None:
    lines = tin.lines
    allowed = get_args(LineKind)
    found.report(
        "chains",
        np.array([kind not in allowed for kind in lines.kinds], np.bool_),
        "chain",
        f"[is|are] of a kind that is none of {', '.join(allowed)}",
    )
    found.report("chains", lines.sources < 0, "chain", "[has|have] a source below 0")


def _check_ranges(tin: TIN, found: Findings) -> None:
    """Check that chains cover the vertices, in range, and that every segment leads on."""
    vertices, offsets, n = tin.lines.vertices, tin.lines.offsets.astype(np.int64), len(tin.points)
    if offsets[0] != 0 or offsets[-1] != len(vertices):
        found.fail(
            "chains",
            f"Offsets of chains run from {offsets[0]} to {offsets[-1]}: "
            f"0 to {len(vertices)} is needed.",
        )
        return
    is_short = np.diff(offsets) < 2
    found.report("chains", is_short, "chain", "[has|have] fewer than two vertices")
    is_wrong = (vertices < 0) | (vertices >= n)
    found.report("chains", is_wrong, "entry", f"of chains [is|are] outside 0 to {n - 1}")
    if not (is_short.any() or is_wrong.any()):
        start, end = tin.lines.segments().T
        what = "of chains [stays at its|stay at their] vertex"
        found.report("chains", start == end, "segment", what)


def check_segments(tin: TIN, found: Findings) -> None:
    """Check that segments are constrained edges, and constrained inner edges segments."""
    triangle, corner = np.nonzero(tin.constrained)
    edges = edge_keys(edges_at(tin.triangles, tin.constrained), len(tin.points))
    segments = edge_keys(tin.lines.segments(), len(tin.points))
    chain = tin.lines.segment_chains()
    found.report(
        "lines",
        np.unique(chain[~np.isin(segments, edges)]),
        "chain",
        "[has|have] segments that are no constrained edges of the surface",
    )
    is_once = tin.neighbors[triangle, corner] > triangle
    tell = found.report if len(tin.lines) else found.note
    tell(
        "lines",
        triangle[is_once][~np.isin(edges[is_once], segments)],
        "constrained edge",
        "inside the surface [belongs|belong] to no line that is known",
        first="triangle",
    )
