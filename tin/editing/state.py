"""State: what a session knows of the TIN after some edits."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from ..building.assembly import Built, assemble
from ..triangulation import Triangulation

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ..constraints.breaklines import Lines
    from ..report import Report
    from .changes import NumberedInputs

__all__ = ["LineVertices", "State", "build_state"]


class LineVertices(NamedTuple):
    """Vertices of lines as they were merged with the rows, and the TIN's vertex of each or -1."""

    xy: Float64Array
    vertices: Int32Array


class State(NamedTuple):
    """A TIN, and how it hangs together with its inputs.

    Attributes
    ----------
    triangulation : Triangulation
    vertex_of_row : (n,) int32 array
        The vertex of each row by its lasting number, -1 for none.
    lines : Lines
    report : Report
        Rows by their lasting numbers.
    snapped : LineVertices or None
        None where lines were not moved: their vertices are at their own places.
    """

    triangulation: Triangulation
    vertex_of_row: Int32Array
    lines: Lines
    report: Report
    snapped: LineVertices | None

    def vertices_at(self, xy: Float64Array) -> Int32Array:
        """Return the vertex at each place, -1 for none."""
        own = np.ascontiguousarray(self.triangulation.points[:, :2])
        return _kernel.vertices_at(own, np.ascontiguousarray(xy))

    def line_vertices(self, inputs: NumberedInputs) -> Int32Array:
        """Return the vertex of each given vertex of the lines, -1 for none."""
        given = inputs.build_inputs.lines.xy
        if not len(given) or inputs.build_inputs.options.snap == 0.0:
            return self.vertices_at(given) if len(given) else np.empty(0, np.int32)
        snapped = self.snapped or build_state(inputs).snapped
        if snapped is None or not len(snapped.xy):
            return np.full(len(given), -1, np.int32)
        xy, first = np.unique(snapped.xy, axis=0, return_index=True)
        found = _kernel.vertices_at(np.ascontiguousarray(xy), np.ascontiguousarray(given))
        return np.where(found < 0, np.int32(-1), snapped.vertices[first[found]])


def build_state(inputs: NumberedInputs) -> State:
    """Build the TIN of some inputs.

    Raises
    ------
    PointsError, LinesError
        As :func:`tinsmith.triangulate`.
    """
    return _make_state(assemble(inputs.build_inputs), inputs)


def _make_state(built: Built, inputs: NumberedInputs) -> State:
    vertex_of_row = np.full(inputs.n_rows, -1, np.int32)
    vertex_of_row[inputs.rows] = built.vertex_of
    is_snapped = inputs.build_inputs.options.snap > 0
    return State(
        Triangulation(**built.surface._asdict()),
        vertex_of_row,
        built.lines,
        built.report.with_rows(inputs.rows, inputs.n_rows),
        LineVertices(built.line_xy, built.line_vertices) if is_snapped else None,
    )
