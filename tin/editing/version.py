"""Version: all that a TIN is between two edits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from ...base.types import Frozen
from ..building.attributes import find_first_rows
from .interpolation.interpolator import Interpolator

if TYPE_CHECKING:
    from ...base.arrays import Int32Array, Int64Array
    from ..constraints.breaklines import Lines
    from ..report import Report
    from ..triangulation import Triangulation

__all__ = ["Version"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Version(Frozen):
    """An immutable state of a TIN; ``vertex_of`` has a vertex for each input row, -1 for none."""

    triangulation: Triangulation
    vertex_of: Int32Array
    lines: Lines
    report: Report

    @cached_property
    def interpolator(self) -> Interpolator:
        """What interpolation needs; any number of threads may ask it at a time."""
        return Interpolator(self.triangulation, self.lines)

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
