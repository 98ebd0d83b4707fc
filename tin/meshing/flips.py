"""Edges of given triangles that are not Delaunay: what is built of their vertices has others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.sentences import counted
from ..triangulation import mark_illegal_edges

if TYPE_CHECKING:
    from ..surface import TIN


def count_flips(tin: TIN) -> int:
    """Count the edges that a build of the vertices and lines of a TIN cannot keep."""
    _, origin = tin._settle()
    if origin.inputs is not None:
        return 0
    return int(mark_illegal_edges(tin.triangulation).sum())


def describe_flips(tin: TIN) -> tuple[str, ...]:
    """Say how many edges a build of the vertices and lines of a TIN cannot keep, if any.

    A TIN that was built here has none; one of existing triangles, as those of a file, may have.
    """
    count = count_flips(tin)
    if count == 0:
        return ()
    are, them = ("is", "it") if count == 1 else ("are", "them")
    return (
        f"{counted(count, 'edge')} of the given triangles {are} not in the Delaunay triangulation: "
        f"triangles around {them} were made anew, so that the surface between the vertices is "
        "another one there.",
    )
