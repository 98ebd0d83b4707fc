"""Counts of a TIN, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.sentences import counted

if TYPE_CHECKING:
    from ...tin import TIN


def count_constrained_edges(tin: TIN) -> int:
    """Count the constrained edges, each once."""
    on_rim = tin.constrained & (tin.neighbors < 0)
    return int((tin.constrained.sum() + on_rim.sum()) // 2)


def describe_counts(tin: TIN) -> str:
    """Count vertices and triangles, and constrained edges if there are any, in words."""
    fixed = count_constrained_edges(tin)
    lines = f", {counted(fixed, 'constrained edge')}" if fixed else ""
    return f"{mesh_counts(tin)}{lines}"


def mesh_counts(tin: TIN) -> str:
    """Count vertices and triangles, in words."""
    vertices = counted(len(tin.points), "vertex", "vertices")
    return f"{vertices}, {counted(len(tin.triangles), 'triangle')}"
