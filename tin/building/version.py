"""Version: all that a build gives, and all that a TIN is between two edits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.records import require_fields, require_indices
from ...base.types import Frozen
from .. import topology
from ..constraints import Lines
from ..report import Report
from ..triangulation import Interpolator, Triangulation
from .attributes import find_first_rows

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array


class LineVertices(NamedTuple):
    """Vertices of lines as they were merged with the rows, and the TIN's vertex of each or -1."""

    xy: Float64Array
    vertices: Int32Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Version(Frozen):
    """An immutable state of a TIN."""

    triangulation: Triangulation
    vertex_of: Int32Array
    """(n,), the vertex of each input row, those that edits removed included; -1 for none."""
    lines: Lines
    report: Report
    snapped: LineVertices | None = None
    """None where lines were not moved, or where it is not known any more."""

    def _require_sound(self) -> None:
        """Refuse a stored version whose lines and report are not those of its triangles."""
        surface = self.triangulation
        require_fields(self, {one.__name__: one for one in (Lines, Report, Triangulation)})
        require_indices(self.vertex_of, len(surface.points), "vertices of the rows", least=-1)
        self.lines._require_sound(len(surface.points))
        self.report._require_sound(len(self.vertex_of), len(surface.points), len(surface.triangles))

    @cached_property
    def interpolator(self) -> Interpolator:
        """What interpolation needs; any number of threads may ask it at a time."""
        surface, lines = self.triangulation, self.lines
        return Interpolator(surface, lambda: _find_barriers(surface, lines))

    def find_edges_of_no_line(self, *, on_boundary: bool = False) -> Int32Array:
        """Return constrained edges that are no segment of a line, (k, 2) vertices, ascending."""
        surface, n = self.triangulation, len(self.triangulation.points)
        flagged = surface.constrained
        if not on_boundary:
            flagged = flagged & (surface.neighbors > topology.NO_NEIGHBOR)
        edges = np.unique(np.sort(topology.edges_at(surface.triangles, flagged), axis=1), axis=0)
        own = topology.edge_keys(self.lines.segments(), n)
        return edges[~np.isin(topology.edge_keys(edges, n), own)]

    @cached_property
    def first_rows(self) -> Int64Array:
        """The first row that each vertex stands for, -1 for none."""
        return find_first_rows(self.vertex_of, len(self.triangulation.points))

    @property
    def notes(self) -> tuple[str, ...] | None:
        """Notes on the surface; None until they are kept."""
        kept: tuple[str, ...] | None = self.__dict__.get("_notes")
        return kept

    def keep_notes(self, notes: tuple[str, ...]) -> None:
        """Keep what was found out about the surface, which takes a look at all of it."""
        self.__dict__["_notes"] = notes


def _find_barriers(surface: Triangulation, lines: Lines) -> BoolArray:
    """Tell which edges are breaks of slope, (m, 3) flags of the edge opposite each corner.

    All that are constrained are, but those of soft breaklines alone. Constrained edges of no
    line that is known count as hard. Natural neighbour and C1 interpolation do not look across.
    """
    if "soft" not in lines.kinds:
        return surface.constrained
    n_vertices = len(surface.points)
    keys = topology.edge_keys(lines.segments(), n_vertices)
    is_soft = np.array([kind == "soft" for kind in lines.kinds])[lines.segment_chains()]
    soft_only = np.setdiff1d(keys[is_soft], keys[~is_soft])
    start, end = topology.directed_edges(surface.triangles)
    own = topology.edge_keys(np.stack([start, end], axis=-1), n_vertices)
    return surface.constrained & ~np.isin(own, soft_only)
