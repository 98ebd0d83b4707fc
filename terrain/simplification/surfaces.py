"""Simplify: few of the points of a surface, with all others within a tolerance of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.errors import OptionError
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Raster
from ...tin.meshing import Goal, simplify_tin

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.policies import SimplificationHold, SimplificationSide
    from ...tin import TIN


@product
def simplify(
    surface: TIN | Raster,
    *,
    tolerance: float | None = None,
    points: int | None = None,
    keep: ArrayLike = (),
    hold: SimplificationHold | None = None,
    side: SimplificationSide = "both",
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Leave out the points of a surface that the others tell well enough.

    Greedy insertion [1]_: from the corners of the boundary, the lines and the points to be kept,
    the point farthest from the surface so far is inserted, until none is beyond the tolerance. Then
    those are removed that later ones made needless, the least missed first [2]_, until each is
    needed. What is left is triangulated anew and measured at every point that was given; where
    rounding has left one beyond the tolerance, it is inserted too.

    Parameters
    ----------
    surface : TIN or Raster
        A TIN with its lines, boundary and holes; one that is not Delaunay is made so but for edges
        that ``hold="surface"`` needs, which ``report.notes`` tell. Of a raster the centres of cells
        that are corners of a square or half a square of cells with elevations, in its only band or
        the band "elevation"; a large one is read in blocks.
    tolerance : float, optional
        No vertex of ``surface`` will be farther than this from the result in elevation, in the
        unit of elevations; with ``hold="surface"`` no place at all. A difference equal to the
        tolerance is within it. Differences in the last digits of elevations, of 1e-14 of the
        largest, count as none.
    points : int, optional
        In its place: the number of vertices that the result has.
    keep : (k,) array of int, optional
        Further vertices of ``surface`` that stay; of a raster cells, row by row from the
        north-west.
    hold : {"points", "surface"}, optional
        Hold the tolerance at the points, or anywhere between the two surfaces: where their edges
        cross between the points, they may differ by more. Default "surface" for a TIN with
        breaklines or given triangles that are not Delaunay, which tells more than its points, else
        "points"; ``report.simplification`` and ``report.notes`` tell which. For a raster that is
        read in blocks it is "points" only.
    side : {"both", "above", "below"}
        Where the result may lie: on both sides of the points; "above", nowhere below a point, as a
        sea bed for navigation must not be deeper than it was measured; "below", nowhere above one.
        With ``hold="surface"`` the same holds between the points. For a TIN and a tolerance.
    threads : int, optional
        For blocks of a raster, and for triangulating what is left. The result is the same for any
        number.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, by stages and by blocks of a raster. What
        it raises ends the call.

    Returns
    -------
    TIN
        The constrained Delaunay triangulation of the vertices that are left, in their old order.
        Lines keep all their vertices; of the boundary those are left out that lie straight between
        others, so it stays where it is. ``vertex_of`` is -1 for rows that were left out, and
        ``report.simplification`` tells the largest error and the RMS error at all points. Of a
        raster the rows are the cells that are left.

    Raises
    ------
    OptionError
        If not one of ``tolerance`` and ``points`` is given, or more or fewer points are asked for
        than can be; if one side is asked for of a raster or with ``points``.
    PointsError
        If a vertex to be kept is none, the TIN overlaps itself, or a raster has no surface.

    Notes
    -----
    With a tolerance none of the vertices inside can be removed alone: without it, a point would be
    beyond the tolerance; of those that ``hold="surface"`` adds afterwards some may be. This is not
    the least number that there is, which is hard to find (NP-hard [3]_). With ``points`` none are
    removed after the insertion. The result is a function of the surface, not of the order of its
    vertices. Time grows with n log(m) for n points of which m are left: a second for a million
    points of a TIN, a tenth to a fifth for as many cells. Memory is 40 bytes a point, 25 a cell; a
    raster of more than 16.8 million cells is simplified in blocks of 2,048 by 2,048, along whose
    seams some vertices may be needless.

    References
    ----------
    .. [1] M. Garland, P. S. Heckbert, Fast polygonal approximation of terrains and height fields,
       Carnegie Mellon University, CMU-CS-95-181 (1995).
    .. [2] W. J. Schroeder, J. A. Zarge, W. E. Lorensen, Decimation of triangle meshes, SIGGRAPH
       (1992), doi:10.1145/133994.134010.
    .. [3] P. K. Agarwal, S. Suri, Surface approximation and geometric partitions, SIAM Journal on
       Computing 27 (1998), doi:10.1137/S0097539794269801.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = np.meshgrid(np.arange(50.0), np.arange(50.0))
    >>> tin = ts.triangulate(np.column_stack([x.ravel(), y.ravel(), np.hypot(x, y).ravel()]))
    >>> simple = ts.simplify(tin, tolerance=0.5)
    >>> len(simple.points) < 100, simple.report.simplification.largest_error <= 0.5
    (True, True)
    >>> ts.simplify(tin, points=60)
    <TIN: 60 vertices, ...>
    """
    done, goal = Progress(progress), Goal.of(tolerance, points, hold, side)
    if isinstance(surface, Raster):
        if side != "both":
            raise OptionError(
                "side", side, "'both' for a raster; triangulate it first: from_raster gives points"
            )
        from .rasters import simplify_raster

        simple = simplify_raster(surface, goal, keep, threads, progress=done.stage(0.0, 1.0))
    else:
        simple = simplify_tin(surface, goal, keep, threads, progress=done.stage(0.0, 1.0))
    done.end()
    return simple
