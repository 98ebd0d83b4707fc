"""Report: what became of every input row."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Merge", "Report"]


class Merge(NamedTuple):
    """Input rows that became one vertex.

    Attributes
    ----------
    vertex : int
        The vertex that stands for them.
    rows : tuple of int
        Their row numbers in the caller's input, ascending.
    heights : tuple of float
        Their elevations, in the order of ``rows``.
    shifts : tuple of float
        How far each was moved in the plane, CRS units; 0 for an exact duplicate.
    height : float
        Elevation that the vertex received.
    """

    vertex: int
    rows: tuple[int, ...]
    heights: tuple[float, ...]
    shifts: tuple[float, ...]
    height: float


def _no_rows() -> NDArray[np.int32]:
    return np.empty(0, np.int32)


def _no_numbers() -> NDArray[np.float64]:
    return np.empty(0)


@dataclass(frozen=True, eq=False, kw_only=True)
class Report:
    """What the triangulation did with the input, row by row.

    Merges are ragged: rows ``merged_rows[merged_offsets[i]:merged_offsets[i + 1]]`` became
    vertex ``merged_vertices[i]``. :meth:`merges` walks them one by one.

    Attributes
    ----------
    n_rows, n_vertices, n_triangles : int
        Input rows, vertices and triangles of the TIN.
    duplicates : str
        Policy that chose the elevation of merged rows.
    snap : float
        Distance within which points were merged, CRS units.
    merged_vertices : (g,) int32 array
    merged_offsets : (g + 1,) int32 array
    merged_rows : (k,) int32 array
    merged_heights, merged_shifts : (k,) float64 arrays
        Elevation and displacement in the plane of every merged row.
    vertex_heights : (g,) float64 array
        Elevations that the merged vertices received.
    skipped : mapping of str to int
        What the reader left out and how often.
    notes : sequence of str
        What the reader assumed, a sentence each.
    """

    n_rows: int
    n_vertices: int
    n_triangles: int
    duplicates: str = "mean"
    snap: float = 0.0
    merged_vertices: NDArray[np.int32] = field(default_factory=_no_rows)
    merged_offsets: NDArray[np.int32] = field(default_factory=lambda: np.zeros(1, np.int32))
    merged_rows: NDArray[np.int32] = field(default_factory=_no_rows)
    merged_heights: NDArray[np.float64] = field(default_factory=_no_numbers)
    merged_shifts: NDArray[np.float64] = field(default_factory=_no_numbers)
    vertex_heights: NDArray[np.float64] = field(default_factory=_no_numbers)
    skipped: Mapping[str, int] = field(default_factory=dict)
    notes: Sequence[str] = ()

    def merges(self) -> Iterator[Merge]:
        """Walk the merges, one vertex at a time."""
        for i, vertex in enumerate(self.merged_vertices):
            span = slice(self.merged_offsets[i], self.merged_offsets[i + 1])
            yield Merge(
                int(vertex),
                tuple(self.merged_rows[span].tolist()),
                tuple(self.merged_heights[span].tolist()),
                tuple(self.merged_shifts[span].tolist()),
                float(self.vertex_heights[i]),
            )

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain Python values, ready for JSON."""
        return {
            "rows": self.n_rows,
            "vertices": self.n_vertices,
            "triangles": self.n_triangles,
            "duplicates": self.duplicates,
            "snap": self.snap,
            "merges": [merge._asdict() for merge in self.merges()],
            "skipped": dict(self.skipped),
            "notes": list(self.notes),
        }

    def __repr__(self) -> str:
        merged = len(self.merged_rows) - len(self.merged_vertices)
        return (
            f"<Report: {self.n_rows} rows, {self.n_vertices} vertices, "
            f"{self.n_triangles} triangles, {merged} row{'s' * (merged != 1)} merged away>"
        )
