"""Levels 1 and 3 of a check: the chains of lines are sound, and all of their segments are edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from ...base.policies import LineKind
from ..topology import edge_keys, edges_at

if TYPE_CHECKING:
    from ..surface import TIN
    from .findings import Findings


def has_sound_chains(found: Findings) -> bool:
    """Tell whether :func:`check_chains` found nothing."""
    return all(problem.kind != "chains" for problem in found.problems)


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
    if count and has_sound_chains(found):
        found.counts["chains"] = count


def _check_labels(tin: TIN, found: Findings) -> None:
    lines = tin.lines
    allowed = get_args(LineKind)
    found.report(
        "chains",
        [i for i, kind in enumerate(lines.kinds) if kind not in allowed],
        "{count} [chain is|chains are] of a kind that is none of "
        f"{', '.join(allowed)} (first: [chain|chains] {{first}}).",
    )
    found.report(
        "chains",
        np.flatnonzero(lines.sources < 0),
        "{count} [chain has|chains have] a source below 0 (first: [chain|chains] {first}).",
    )


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
    found.report(
        "chains",
        np.flatnonzero(is_short),
        "{count} [chain has|chains have] fewer than two vertices (first: [chain|chains] {first}).",
    )
    is_wrong = (vertices < 0) | (vertices >= n)
    found.report(
        "chains",
        np.flatnonzero(is_wrong),
        f"{{count}} [entry of chains is|entries of chains are] outside 0 to {n - 1} "
        "(first: [entry|entries] {first}).",
    )
    if not (is_short.any() or is_wrong.any()):
        start, end = tin.lines.segments().T
        found.report(
            "chains",
            np.flatnonzero(start == end),
            "{count} [segment of chains stays at its|segments of chains stay at their] vertex "
            "(first: [segment|segments] {first}).",
        )


def check_segments(tin: TIN, found: Findings) -> None:
    """Check that segments are constrained edges, and constrained inner edges segments."""
    triangle, corner = np.nonzero(tin.constrained)
    edges = edge_keys(edges_at(tin.triangles, tin.constrained), len(tin.points))
    segments = edge_keys(tin.lines.segments(), len(tin.points))
    chain = tin.lines.segment_chains()
    found.report(
        "lines",
        np.unique(chain[~np.isin(segments, edges)]),
        "{count} [chain has|chains have] segments that are no constrained edges of the surface "
        "(first: [chain|chains] {first}).",
    )
    is_once = tin.neighbors[triangle, corner] > triangle
    tell = found.report if len(tin.lines) else found.note
    tell(
        "lines",
        triangle[is_once][~np.isin(edges[is_once], segments)],
        "{count} [constrained edge|constrained edges] inside the surface [belongs|belong] to no "
        "line "
        "that is known (first: [triangle|triangles] {first}).",
    )
