"""A band of slope, aspect or light of a surface, at the centres of cells."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.errors import OptionError
from ...base.results import locate_centers
from ...tin.validation import thread_count
from ..surface import compute_normals, normalise, sum_at_vertices
from .bands import SurfaceBand

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ...tin import TIN, Grid
    from ..surface import PlaneMeasure

DESCRIBED_MEANS = "Slopes are those of the triangles, averaged over the part of a cell."

_PARTS, _FIRST_CORNER = 8, 4
"""Of a triangle: the edges opposite its corners, and from the second on the corners."""


def choose_smooth(tin: TIN, smooth: Any, *, is_mean: bool = False) -> tuple[bool, str]:
    """Return whether normals change evenly between vertices, and a sentence that tells it.

    ``smooth`` is what was asked for; None for the default: of cells of a raster, among which there
    are no breaklines, unless the means of cells are taken, which are those of triangles.
    """
    if is_mean and smooth is not None and as_flag("smooth", smooth):
        raise OptionError("smooth", smooth, "False for means, which are those of triangles")
    is_terrain = tin.report.from_raster and not (tin.constrained & (tin.neighbors >= 0)).any()
    chosen = is_terrain and not is_mean if smooth is None else as_flag("smooth", smooth)
    if is_mean:
        return False, DESCRIBED_MEANS
    return chosen, describe_smooth(is_smooth=chosen, is_default=smooth is None)


def describe_smooth(*, is_smooth: bool, is_default: bool = False) -> str:
    """Return a sentence that tells whether normals change evenly between vertices."""
    if is_smooth:
        why = ", as the points are the cells of a raster" if is_default else ""
        return f"Slopes change evenly between those of the vertices (smooth{why})."
    return (
        "Slopes are those of the triangles; a cell whose centre is on an edge has the mean "
        "gradient of both sides, one on a vertex that of the vertex."
    )


class ReliefBand(SurfaceBand):
    """Cells that tell how the surface lies at their centres; blocks as of :class:`SurfaceBand`.

    In a triangle it is the triangle's plane, on an edge that of the mean gradient of both sides, at
    a vertex that of the sum of the normals around it. With ``is_smooth`` the normals at the
    vertices, of length 1, change evenly over each triangle.
    """

    def __init__(
        self,
        tin: TIN,
        grid: Grid,
        measure: PlaneMeasure,
        *,
        is_smooth: bool,
        is_mean: bool = False,
        threads: int | None = None,
    ) -> None:
        super().__init__(tin, grid, None, method="linear", is_mean=is_mean, threads=threads)
        self._measure = measure
        self._is_smooth = is_smooth
        self._values = self._triangle_values if is_mean else None

    def _scan_centers(self, rows: slice, columns: slice, progress: Tell | None) -> Float64Array:
        x, y = locate_centers(self._grid, rows, columns)
        where = (x, y, self._grid.spacing)
        threads = thread_count(self._threads, len(x) * len(y))
        if self._is_smooth:
            unit = self._vertex_units
            normals = self._drawn.vectors_at_centers(*where, unit, threads, progress)
            measure = self._measure._replace(exaggeration=1.0)  # which the normals have
            return measure.of(normals.reshape(-1, 3)).reshape(normals.shape[:2])
        drawn = self._drawn.triangles_at_centers(*where, self._triangle_values, threads, progress)
        cells, places, parts = drawn
        self._mend_shared(cells.reshape(-1), places, parts)
        return np.asarray(cells)

    def _mend_shared(self, cells: Float64Array, places: Int64Array, parts: Int64Array) -> None:
        """Write the values of centres on edges and vertices."""
        triangle, part = np.divmod(parts, _PARTS)
        at = np.flatnonzero(part >= _FIRST_CORNER)
        if len(at):
            vertex = self._tin.triangles[triangle[at], part[at] - _FIRST_CORNER]
            cells[places[at]] = self._measure.of(self._vertex_normals[vertex])
        at = np.flatnonzero(part < _FIRST_CORNER)
        beyond = self._tin.neighbors[triangle[at], part[at]]
        at, beyond = at[beyond >= 0], beyond[beyond >= 0]
        if len(at):
            cells[places[at]] = self._measure.of(self._average(triangle[at], beyond))

    def _average(self, triangles: Int64Array, others: Int32Array) -> Float64Array:
        """Return normals of the mean gradients of two triangles each."""
        one, other = (self._normals[rows] for rows in (triangles, others))
        with np.errstate(over="ignore"):  # of walls, which have 90 degrees
            gradients = 0.5 * (one[:, :2] / one[:, 2:]) + 0.5 * (other[:, :2] / other[:, 2:])
        return np.column_stack([gradients, np.ones(len(gradients))])

    @cached_property
    def _triangle_values(self) -> Float64Array:
        return self._measure.of(self._normals)

    @cached_property
    def _normals(self) -> Float64Array:
        return compute_normals(self._tin)

    @cached_property
    def _vertex_normals(self) -> Float64Array:
        return sum_at_vertices(self._tin, self._normals)

    @cached_property
    def _vertex_units(self) -> Float64Array:
        factor = self._measure.exaggeration
        return normalise(self._vertex_normals * (factor, factor, 1.0))
