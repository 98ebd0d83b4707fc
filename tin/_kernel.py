"""The only module that imports the compiled core: its arrays, types and errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..base.errors import PointsError
from ..base.interrupts import hold_interrupts

with hold_interrupts():
    from . import _core

if TYPE_CHECKING:
    from ..base.arrays import Float64Array, Int32Array
    from ..base.progress import Tell

EXACT_RANGE: tuple[float, float] = (_core.SMALLEST_COORDINATE, _core.LARGEST_COORDINATE)
"""Smallest (but 0) and largest magnitude of a coordinate for which the predicates are exact."""

LARGEST_ELEVATION: float = _core.LARGEST_ELEVATION
"""Largest magnitude of an elevation: products sum and subtract some of them in doubles."""

MOST_POINTS: int = _core.MOST_POINTS
"""So many points 32-bit indices can number, and their edges."""

Locator = _core.Locator
Trace = _core.Trace
NaturalNeighbors = _core.NaturalNeighbors
NaturalWeights = _core.NaturalWeights
NearestBoundary = _core.NearestBoundary
nearest_vertices = _core.nearest_vertices
SmoothPatches = _core.SmoothPatches
Mesh = _core.Mesh
EditedMesh = _core.EditedMesh
refine = _core.refine
regions = _core.regions
simplify = _core.simplify
orientation = _core.orientation
in_circle = _core.in_circle
compare_distances = _core.compare_distances
snap = _core.snap
count_work = _core.count_work
clean = _core.clean
join_triangles = _core.join_triangles
boundary_walks = _core.boundary_walks
turns_of_triangles = _core.turns_of_triangles
are_in_exact_range = _core.are_in_exact_range
contacts = _core.contacts
crossings = _core.crossings
touches = _core.touches
intersections = _core.intersections
vertices_at = _core.vertices_at
places_in_rings = _core.points_in_polygons
LeaveOneOut = _core.LeaveOneOut
measure_neighbors = _core.measure_neighbors
find_long_edges = _core.find_long_edges
find_peaks_and_pits = _core.find_peaks_and_pits
find_in_box = _core.find_in_box
extract = _core.extract
find_seen = _core.find_seen
are_in_triangles = _core.are_in_triangles
BoxTriangles = _core.BoxTriangles
Method = _core.Method
Growth = _core.Growth

VECTOR_PATHS: tuple[str, ...] = tuple(_core.vector_paths())
"""Vector instructions that this processor has, slowest first; the growth uses the last."""


def grow(
    points: Float64Array,
    *,
    method: Method = Method.AUTOMATIC,
    threads: int = 1,
    path: str = VECTOR_PATHS[-1],
    progress: Tell | None = None,
) -> Growth:
    r"""Grow the Delaunay triangulation of (n, 3) float64 points, n >= 1; z is not looked at.

    Every method, number of threads and vector path gives the same arrays. ``Method.AUTOMATIC``
    writes the triangles of a raster as they are; other points ``GROWTH_OR_INSERTION`` grows, and
    inserts where they are so uneven that growing would be slow. ``progress`` is told the share of
    the vertices that growth has taken up, or of the rows of a raster.

    The search for a third point, most of the work::

              . c .          1. The cells around vertex v are gathered once: coordinates relative
           .   / \   .           to v, side by side.
          .   /   \   .      2. For each open edge v-w all of them are compared at once, by the
           . /     \ .          cotangent of the angle under which they see it; what the error
            v-------w           bound leaves open is decided exactly.
                             3. If the winner c's circle stays within the cells, c is proven;
                                else the search goes on over the whole index, within the circle.

    Raises
    ------
    PointsError
        If fewer than three places are distinct, or all are collinear.
    """
    growth = _core.grow(points, method, threads, path, progress)
    if len(growth.triangles) == 0:
        raise PointsError(_explain_no_triangle(len(points), growth.distinct_count))
    return growth


def sweep(points: Float64Array, *, threads: int = 1, path: str = VECTOR_PATHS[-1]) -> _core.Sweep:
    """Grow the same triangulation as :func:`grow`, its vertices numbered in the sweep.

    There neighbours lie side by side, whatever order the points are in: what goes over triangles
    and looks at their corners is faster by that.

    Raises
    ------
    PointsError
        As :func:`grow`.
    """
    swept = _core.sweep(points, threads, path)
    if len(swept.triangles) == 0:
        raise PointsError(_explain_no_triangle(len(points), swept.distinct_count))
    return swept


def triangulate_mesh(
    points: Float64Array, *, threads: int, progress: Tell | None = None
) -> tuple[Mesh, Int32Array | None]:
    """Triangulate (n, 3) points as :func:`grow` does, for a mesh that will be changed.

    Returns the mesh, whose vertices are numbered by kept rows, and ``kept_row`` as of ``Growth``.
    Raises PointsError if there is no triangle.
    """
    made = _core.triangulate_mesh(points, threads, progress)
    if made.mesh is None:
        raise PointsError(_explain_no_triangle(len(points), made.distinct_count))
    return made.mesh, made.kept_row


def _explain_no_triangle(n_rows: int, n_distinct: int) -> str:
    need = "a TIN needs at least three points that are not collinear"
    if n_distinct < 3:
        places = "one place" if n_distinct == 1 else "two places"
        return f"All {n_rows} points lie at {places}: {need}."
    return f"All {n_rows} points are collinear in the plane: {need}."
