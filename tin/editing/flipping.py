"""Flipped edges: the other diagonal of the two triangles at an edge, kept as a soft breakline."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from .. import _kernel
from ..constraints.breaklines import Breakline

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ..building.inputs import BuildInputs
    from ..building.version import Version

__all__ = ["FLIP", "are_uncut", "make_flipped_edge", "require_inner"]

FLIP = "flip"
"""Name of the soft breakline that keeps a flipped edge."""


def require_inner(beside: Sequence[int]) -> None:
    """Refuse an edge that has not two triangles, given what is beside it.

    Raises
    ------
    PointsError
        If it is none between two triangles.
    """
    if len(beside) != 2:
        raise PointsError("Only an edge between two triangles can be flipped.")


def make_flipped_edge(points: Float64Array) -> Breakline:
    """Return the edge that comes in the place of another one.

    Parameters
    ----------
    points : (4, 3) float64 array
        The ends of the edge, and the corners of the triangles left and right of it.

    Raises
    ------
    PointsError
        If the four are no convex quadrilateral.
    """
    quad = np.ascontiguousarray(points[[0, 2, 1, 3], :2])
    following = (np.ascontiguousarray(np.roll(quad, -k, axis=0)) for k in (1, 2))
    turns = _kernel.orientation(quad, *following)
    if not ((turns > 0).all() or (turns < 0).all()):
        raise PointsError("The two triangles at the edge are no convex quadrilateral.")
    return Breakline(points[2:], kind="soft", name=FLIP)


def are_uncut(version: Version, build_inputs: BuildInputs) -> bool:
    """Tell whether all lines are breaklines, and run through their given vertices and no others.

    Then a build fixes them as they are given, and a further one that meets none changes nothing.
    """
    given, lines = build_inputs.lines, version.lines
    if not all(kind in ("hard", "soft") for kind in given.kinds):
        return False
    if not np.array_equal(given.offsets, lines.offsets):
        return False
    return np.array_equal(given.xy, version.triangulation.points[lines.vertices, :2])
