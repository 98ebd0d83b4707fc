"""What the lines alone tell of a whole surface: where it ends, and whether lines run in it.

Which side of a ring is inside does not depend on the points within it. So the segments, if they are
triangulated with the convex hull of everything and cut, have the boundary of the whole surface.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.types import Bounds
from ..constraints import require_cut, require_triangles
from ..topology import directed_edges
from .exact_sum import ExactSum, add_doubled_areas
from .local_triangulation import triangulate_box
from .skeleton import reduce_to_hull
from .sources import NumberedPoints

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from .circles import Discs
    from .local_triangulation import LocalTriangulation
    from .sources import SegmentSource

_PLANE = Bounds(-np.inf, -np.inf, np.inf, np.inf)


class Outline(NamedTuple):
    """Where a surface with lines ends.

    Attributes
    ----------
    rim : (k, 3) float64 array
        The vertices on the boundary of the surface, in no order.
    bounds : Bounds
    area : Fraction
        Exact, CRS units squared.
    is_clipped : bool
        Whether rings cut the surface, which else fills its convex hull.
    has_inner_lines : bool
        Whether a segment has the surface on both sides.
    """

    rim: Float64Array
    bounds: Bounds
    area: Fraction
    is_clipped: bool
    has_inner_lines: bool


class _Few:
    """Points that are all known from the start: a :class:`.PointSource`."""

    def __init__(self, skeleton: NumberedPoints) -> None:
        self.skeleton = skeleton

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Return all points: the box is the plane."""
        del box
        return self.skeleton

    def read_some(self, discs: Discs) -> NumberedPoints:
        """Return no further points."""
        del discs
        return NumberedPoints.none()

    def read_discs(self, discs: Discs) -> NumberedPoints:
        """Return no further points."""
        return self.read_some(discs)


def find_outline(points: NumberedPoints, lines: SegmentSource) -> Outline:
    """Find where a surface ends.

    Parameters
    ----------
    points : NumberedPoints
        Some of the points, with all vertices of their convex hull among them.
    lines : SegmentSource

    Raises
    ------
    LinesError
        If a hole cuts nothing away, or nothing is left.
    PointsError
        If all places are on one line.
    """
    local = triangulate_box(_Few(reduce_to_hull(points)), _PLANE, lines=lines, ordered=False)
    require_cut(local.cutting)
    require_triangles(len(local.triangles) > 0)
    triangle, corner = np.nonzero(local.neighbors < 0)
    ends = [local.triangles[triangle, (corner + step) % 3] for step in (1, 2)]
    rim = local.points[np.unique(ends)]
    return Outline(
        rim=rim,
        bounds=Bounds.of(rim),
        area=_sum_areas(local),
        is_clipped=lines.rings is not None,
        has_inner_lines=bool((local.constrained & (local.neighbors >= 0)).any()),
    )


def _sum_areas(local: LocalTriangulation) -> Fraction:
    total = ExactSum()
    start, end = (part.ravel() for part in directed_edges(local.triangles))
    add_doubled_areas(total, local.points, start, end)
    return total.value / 2
