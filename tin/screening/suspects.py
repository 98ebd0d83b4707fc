"""What is found wrong with rows of points, with its reason and how certain it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ..report import Report
    from ..surface import TIN

CERTAINTIES = ("high", "medium", "low")
REASONS = (
    "outside",
    "swapped",
    "factor",
    "isolated",
    "code",
    "spike",
    "pit",
    "line",
    "void",
    "place",
    "number",
    "crossing",
)
"""Reasons, in the order in which one is named of a row that has several."""

DROPPED = ("outside", "swapped", "factor", "isolated", "code", "spike", "pit")
"""Reasons for which a point may be left out; other ones leave open which point is wrong."""


class Suspect(NamedTuple):
    """One row that is suspicious, or a place without a row where lines cross."""

    row: int
    """Of the points, counted from 0; -1 for none."""
    place: tuple[float, ...]
    """Easting, northing, elevation."""
    reason: str
    """One of ``REASONS``."""
    explanation: str
    """A sentence."""
    certainty: str
    """One of ``CERTAINTIES``."""
    residual: float = np.nan
    scale: float = np.nan
    """Both NaN where no height is told."""
    line: str = ""
    """What the line is called, if it is about one."""


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """The rows of points of a TIN that have a vertex, each with its own elevation."""

    numbers: Int64Array
    """(k,), the rows, ascending."""
    vertices: Int32Array
    """(k,)."""
    xyz: Float64Array
    """(k, 3)."""

    @classmethod
    def of(cls, tin: TIN) -> Rows:
        """Gather the rows of a TIN."""
        vertex_of, report = tin.vertex_of, tin.report
        numbers = np.flatnonzero(vertex_of >= 0)
        xyz = tin.points[vertex_of[numbers]]
        # rows that a line overruled, whose vertex has its elevation, get back their own
        overruled = list_overruled_points(report)
        if overruled:
            at = np.flatnonzero(np.isin(vertex_of[numbers], list(overruled)))
            xyz[at, 2] = [overruled[vertex] for vertex in vertex_of[numbers[at]].tolist()]
        own = np.isin(report.merged_rows, numbers)
        at = np.searchsorted(numbers, report.merged_rows[own])
        xyz[at, 2] = report.merged_elevations[own]
        return cls(numbers, vertex_of[numbers], xyz)

    def suspect(self, i: int, reason: str, explanation: str, certainty: str) -> Suspect:
        """Return the row at a place among these as suspicious."""
        place = tuple(self.xyz[i].tolist())
        return Suspect(int(self.numbers[i]), place, reason, explanation, certainty)

    def __len__(self) -> int:
        return len(self.numbers)


def list_overruled_points(report: Report) -> dict[int, float]:
    """Return the vertices where a line has overruled points, and the elevation of these."""
    overruled = report.overruled
    of_points = (overruled.lines < 0) & (overruled.vertices >= 0)
    vertices, elevations = overruled.vertices[of_points], overruled.elevations[of_points]
    return dict(zip(vertices.tolist(), elevations.tolist(), strict=True))
