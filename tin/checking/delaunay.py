"""Level 3 of a check: every edge is Delaunay that is not constrained, or every one at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..predicates import blocks, columns, in_circle
from ..triangulation import gather_quadrilaterals, is_against_rule

if TYPE_CHECKING:
    from ..surface import TIN
    from .findings import Findings


def check_delaunay(tin: TIN, found: Findings, *, conforming: bool = False) -> None:
    """Check every inner edge against the triangle across; constrained ones if it is conforming."""
    xy = columns(tin.points)
    wrong, against_rule = [], []
    n_ties = 0
    for block in blocks(len(tin.triangles)):
        triangle, *quad = gather_quadrilaterals(tin.triangulation, block, conforming)
        side = in_circle(xy, *quad)
        tied = np.flatnonzero(side == 0)
        n_ties += len(tied)
        wrong.append(triangle[side > 0])
        is_against = is_against_rule(xy, *(corner[tied] for corner in quad))
        against_rule.append(triangle[tied[is_against]])
    found.report(
        "delaunay",
        np.concatenate(wrong),
        "edge",
        "[is|are] not Delaunay: the far corner lies in the circle of a triangle at [it|them]",
        first="triangle",
    )
    found.note(
        "tie",
        np.concatenate(against_rule),
        "edge",
        "[joins|join] four cocircular points the other way than tinsmith would, which is Delaunay "
        "too",
        first="triangle",
    )
    found.counts["ties"] = n_ties
    found.counts["ties_against_rule"] = sum(len(triangles) for triangles in against_rule)
