"""A band of slope, aspect or light of a surface, at the centres of cells."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.errors import OptionError
from ...base.results import find_turn
from ...tin import predicates
from ...tin.validation import thread_count
from ..surface import compute_normals, normalise, sum_at_vertices
from .bands import SurfaceBand

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
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
        x, y, size = self._list_lattice(rows, columns)
        where, turn = (x, y, size), find_turn(self._grid)
        threads = thread_count(self._threads, len(x) * len(y))
        if self._is_smooth:
            unit = self._vertex_units
            normals = self._drawn.vectors_at_centers(*where, unit, threads, progress)
            cells = self._measure_units(normals.reshape(-1, 3)).reshape(normals.shape[:2])
            return np.asarray(turn.of(cells))
        drawn = self._drawn.triangles_at_centers(*where, self._triangle_values, threads, progress)
        cells, places, parts = drawn
        self._mend_shared(cells.reshape(-1), places, parts)
        return np.asarray(turn.of(cells))

    def _measure_units(self, units: Float64Array) -> Float64Array:
        """Return the values of normals between those of vertices, which have the exaggeration."""
        return self._measure._replace(exaggeration=1.0).of(units)

    def _measure_at(self, places: Float64Array) -> Float64Array:
        if self._is_smooth:
            return self._measure_units(self._interpolate_units(places))
        triangle = self._tin.locate(places).astype(np.int64)
        found = np.full(len(places), np.nan)
        inside = np.flatnonzero(triangle >= 0)
        triangle = triangle[inside]
        found[inside] = self._triangle_values[triangle]
        on_side = self._find_sides(places[inside], triangle)
        shared = on_side.any(axis=1)
        at, held, sides = inside[shared], triangle[shared], on_side[shared]
        is_vertex = sides.sum(axis=1) == 2
        corner = np.where(is_vertex, np.argmin(sides, axis=1), np.argmax(sides, axis=1))
        parts = held * _PARTS + corner + np.where(is_vertex, _FIRST_CORNER, 0)
        self._mend_shared(found, at, parts)
        return found

    def _find_sides(self, places: Float64Array, triangle: Int64Array) -> BoolArray:
        """Tell whether places lie on the sides of their triangles opposite each corner, exactly."""
        corners = self._tin.triangles[triangle].astype(np.int64)
        xy = predicates.columns(np.concatenate([self._tin.points[:, :2], places]))
        own = len(self._tin.points) + np.arange(len(places))
        signs = [
            predicates.orientation(xy, start, end, own)
            for start, end in (np.roll(corners, -k, axis=1)[:, 1:].T for k in range(3))
        ]
        found: BoolArray = np.column_stack(signs) == 0
        return found

    def _interpolate_units(self, places: Float64Array) -> Float64Array:
        """Return normals that change evenly between those of the vertices; NaN outside."""
        xyz = self._tin.points
        return np.column_stack(
            [
                self._tin.replace(points=np.column_stack([xyz[:, :2], unit])).interpolate(
                    places, threads=self._threads
                )
                for unit in self._vertex_units.T
            ]
        )

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
