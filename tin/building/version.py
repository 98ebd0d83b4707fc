"""Version: all that a build gives, and all that a TIN is between two edits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ...base.records import require_fields, require_indices
from ...base.types import Frozen
from ..constraints.barriers import find_barriers
from ..constraints.breaklines import Lines
from ..report import Report
from ..triangulation import Triangulation
from ..triangulation.interpolator import Interpolator
from .attributes import find_first_rows

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array

__all__ = ["LineVertices", "Version"]


class LineVertices(NamedTuple):
    """Vertices of lines as they were merged with the rows, and the TIN's vertex of each or -1."""

    xy: Float64Array
    vertices: Int32Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Version(Frozen):
    """An immutable state of a TIN.

    Attributes
    ----------
    triangulation : Triangulation
    vertex_of : (n,) int32 array
        The vertex of each input row, those that edits removed included; -1 for none.
    lines : Lines
    report : Report
    snapped : LineVertices or None
        None where lines were not moved, or where it is not known any more.
    """

    triangulation: Triangulation
    vertex_of: Int32Array
    lines: Lines
    report: Report
    snapped: LineVertices | None = None

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
        return Interpolator(surface, lambda: find_barriers(surface, lines))

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
