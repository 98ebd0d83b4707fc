"""Report: what became of every input row."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.lazy import make_html_repr
from ..base.records import require, require_finite, require_indices, require_offsets
from ..base.sentences import counted
from ..base.types import Frozen, RowSources

if TYPE_CHECKING:
    from ..base.arrays import Float64Array, Int8Array, Int32Array, Int64Array
    from ..base.policies import DuplicatePolicy, SimplificationHold, SimplificationSide

LEFT_OUT = (
    "erased",
    "in water",
    "outside the boundary",
    "in a hole",
    "trimmed",
    "removed by an edit",
    "masked",
    "simplified away",
    "looks like a blunder",
)
"""Why a row of points has no vertex; ``Report.left_out_why`` holds places in this list."""
_OF_SEVERAL = {"looks like a blunder": "look like blunders"}
"""Reasons of one row that read otherwise of several."""

UNMENDED_WHY = (
    "lines or the boundary meet there under a small angle",
    "only far shorter edges would help",
    "a line or the boundary in the way has no room for a further vertex",
)
"""Why a triangle stays as it is; ``Unmended.why`` holds places in this list."""


def word_reason(why: str, count: int) -> str:
    """Return a reason of ``LEFT_OUT`` as it reads behind the number of rows.

    Examples
    --------
    >>> word_reason("looks like a blunder", 5), word_reason("in water", 5)
    ('look like blunders', 'in water')
    """
    return why if count == 1 else _OF_SEVERAL.get(why, why)


class Merge(NamedTuple):
    """Input rows that became one vertex.

    Attributes
    ----------
    vertex : int
        The vertex that stands for them.
    rows : tuple of int
        Their row numbers in the caller's input, ascending.
    elevations : tuple of float
        Their elevations, in the order of ``rows``.
    shifts : tuple of float
        How far each was moved in the plane, CRS units; 0 for an exact duplicate.
    elevation : float
        Elevation that the vertex received.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7]])
    >>> next(tin.report.merges())
    Merge(vertex=0, rows=(0, 3), elevations=(5.0, 7.0), shifts=(0.0, 0.0), elevation=6.0)
    """

    vertex: int
    rows: tuple[int, ...]
    elevations: tuple[float, ...]
    shifts: tuple[float, ...]
    elevation: float

    def to_dict(self) -> dict[str, Any]:
        """Return plain Python values, ready for JSON.

        Examples
        --------
        >>> Merge(0, (0, 3), (5.0, 7.0), (0.0, 0.0), 6.0).to_dict()["rows"]
        (0, 3)
        """
        return self._asdict()


class Edit(NamedTuple):
    """One edit, as it can be written to a file and done again.

    Attributes
    ----------
    operation : str
        The name of a method of a TIN.
    arguments : dict
        Its arguments by name.
    notes : tuple of str
        Lines that it crosses, with both elevations.
    """

    operation: str
    arguments: dict[str, Any]
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return plain Python values, ready for JSON; :func:`.apply_edits` takes them back."""
        arguments = {name: _as_plain(value) for name, value in self.arguments.items()}
        notes = {"notes": list(self.notes)} if self.notes else {}
        return {"op": self.operation, **arguments, **notes}


def _as_plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _as_plain(one) for name, one in value.items()}
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


class Crossings(NamedTuple):
    """Places where lines cross between their vertices, and the elevations of both there.

    Attributes
    ----------
    vertices : (c,) int32 array
        The vertex made there, -1 if it is no part of the surface.
    xy : (c, 2) float64 array
    lines : (c, 2) int32 array
        Numbers of the two lines, as ``Report.line_labels`` lists them.
    elevations : (c, 2) float64 array
        Their own elevations at the place.
    vertex_elevations : (c,) float64 array
        What the vertex received.
    """

    vertices: Int32Array
    xy: Float64Array
    lines: Int32Array
    elevations: Float64Array
    vertex_elevations: Float64Array

    @classmethod
    def none(cls) -> Crossings:
        """Return no crossings."""
        none, empty = np.empty(0, np.int32), np.empty((0, 2))
        return cls(none, empty, none.reshape(0, 2), empty, np.empty(0))


class Overruled(NamedTuple):
    """Elevations that another one at the same vertex overruled.

    Attributes
    ----------
    vertices : (k,) int32 array
        -1 if it is no part of the surface.
    lines : (k,) int32 array
        Whose elevation it was, as ``Report.line_labels`` lists them; -1 for the points there.
    elevations : (k,) float64 array
        The elevation that was overruled.
    vertex_elevations : (k,) float64 array
    """

    vertices: Int32Array
    lines: Int32Array
    elevations: Float64Array
    vertex_elevations: Float64Array

    @classmethod
    def none(cls) -> Overruled:
        """Return none."""
        return cls(np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0), np.empty(0))


class Unmended(NamedTuple):
    """Triangles of a refined mesh with too small an angle, too large, or with too long an edge.

    Attributes
    ----------
    triangles : (k,) int32 array
        Their numbers, ascending; of the mesh as refined, before any edits.
    why : (k,) int8 array
        Indices into ``UNMENDED_WHY``.
    angles : (k,) float64 array
        Smallest angle of each in the plane, degrees.
    """

    triangles: Int32Array
    why: Int8Array
    angles: Float64Array

    @classmethod
    def none(cls) -> Unmended:
        """Return none."""
        return cls(np.empty(0, np.int32), np.empty(0, np.int8), np.empty(0))

    def sentences(self) -> tuple[str, ...]:
        """Tell for each reason how many there are, and the least angle of them."""
        return tuple(
            f"{counted(group['count'], 'triangle')} with angles from "
            f"{group['least_angle']:.3g} degrees on could not be mended: {group['why']}."
            for group in self.to_list()
        )

    def to_list(self) -> list[dict[str, Any]]:
        """Return for each reason count, least angle and numbers, as plain values."""
        return [
            {
                "why": UNMENDED_WHY[code],
                "count": int((self.why == code).sum()),
                "least_angle": float(self.angles[self.why == code].min()),
                "triangles": self.triangles[self.why == code].tolist(),
            }
            for code in np.unique(self.why).tolist()
        ]


class Simplification(NamedTuple):
    """What :func:`tinsmith.simplify` left out, and how far that is from the surface now.

    Attributes
    ----------
    points : int
        Vertices of the surface that was given.
    vertices : int
        Those that are left.
    required : int
        Of these, vertices of lines, corners of the boundary, and those that were to be kept.
    needless : int
        Vertices that were inserted first and found needless later.
    tolerance : float or None
        As it was asked for, in the unit of elevations; None where a number of points was.
    largest_error, rms_error : float
        Difference of elevation between the points given and the surface that is left: the largest,
        and the root of the mean square over all points.
    hold : {"points", "surface"} or None
        Where the difference is within the tolerance: at the points, or anywhere between the two
        surfaces. None where a number of points was asked for.
    surface_error : float or None
        The largest difference between the two surfaces anywhere; None where it was not measured.
    forced_edges : int
        Edges of the given triangles that are no edges of the Delaunay triangulation, kept as soft
        breaklines so that the surfaces do not differ there.
    side : {"both", "above", "below"}
        Where the surface that is left may lie: on both sides of the points, or nowhere below them,
        or nowhere above them.
    """

    points: int
    vertices: int
    required: int
    needless: int
    tolerance: float | None
    largest_error: float
    rms_error: float
    hold: SimplificationHold | None = None
    surface_error: float | None = None
    forced_edges: int = 0
    side: SimplificationSide = "both"

    def sentence(self) -> str:
        """Tell it in one sentence."""
        share = 100.0 * self.vertices / self.points
        kept = ""
        if self.forced_edges:
            edges = counted(self.forced_edges, "edge")
            kept = f" {edges} of the given triangles, not Delaunay, stayed as soft breaklines."
        kept = f"{self._describe_side()}.{kept}"
        return (
            f"Simplified from {counted(self.points, 'point')} to {self.vertices:,} "
            f"({share:.3g} %): largest error {self.largest_error:.4g}, "
            f"RMS error {self.rms_error:.4g} at the points; {self.describe_surface()}{kept}"
        )

    def _describe_side(self) -> str:
        """Tell on which side it lies, if it lies on one."""
        if self.side == "both":
            return ""
        other = "below" if self.side == "above" else "above"
        what = "the surface given" if self.hold == "surface" else "a point"
        return f"; nowhere {other} {what}"

    def describe_surface(self) -> str:
        """Tell how far the surfaces are apart between the points.

        Examples
        --------
        >>> found = Simplification(9, 4, 4, 0, 0.1, 0.05, 0.01, "surface", 0.06)
        >>> found.describe_surface()
        'anywhere the surfaces differ by at most 0.06'
        >>> found._replace(hold="points", surface_error=None).describe_surface()
        'between them the surfaces may differ by more'
        """
        if self.surface_error is None:
            return "between them the surfaces may differ by more"
        return f"anywhere the surfaces differ by at most {self.surface_error:.4g}"

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, ready for JSON."""
        return self._asdict()


EXPECTED_SKIPS = "header lines"
"""What every file may have, and nobody needs to be told of."""


def describe_skipped(skipped: Mapping[str, int]) -> tuple[str, ...]:
    """Say what a reader left out, in one sentence or none.

    Examples
    --------
    >>> describe_skipped({"header lines": 1, "rows without an elevation": 2})
    ('Left out by the reader: 2 rows without an elevation.',)
    """
    left = [
        counted(number, re.sub(r"\b(cell|row|line|point)s\b", r"\1", what, count=1), what)
        for what, number in skipped.items()
        if what != EXPECTED_SKIPS
    ]
    return (f"Left out by the reader: {', '.join(left)}.",) if left else ()


def measure_spread(elevations: Float64Array, starts: Int32Array | Int64Array) -> Float64Array:
    """Return by how much elevations of a place differ, (k,): those from each start on.

    Examples
    --------
    >>> measure_spread(np.array([5.0, 7.0, 6.0]), np.array([0, 2]))
    array([2., 0.])
    """
    with np.errstate(over="ignore"):  # between the largest floats
        highest = np.maximum.reduceat(elevations, starts)
        spread: Float64Array = highest - np.minimum.reduceat(elevations, starts)
    return spread


def describe_differing(
    places: int, most: float, duplicates: DuplicatePolicy | None
) -> tuple[str, ...]:
    """Say at how many places points differ in elevation, in one sentence or none.

    Examples
    --------
    >>> describe_differing(1, 2.0, "mean")
    ("Points at 1 place differ in elevation, by up to 2: ...'mean'.",)
    """
    if places == 0:
        return ()
    return (
        f"Points at {counted(places, 'place')} differ in elevation, by up to "
        f"{most:.6g}: the surface has there the one of the policy '{duplicates}'.",
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class Report(Frozen):
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
    merged_elevations, merged_shifts : (k,) float64 arrays
        Elevation and displacement in the plane of every merged row.
    vertex_elevations : (g,) float64 array
        Elevations that the merged vertices received.
    left_out_rows : (k,) int32 array
        Rows without a vertex, ascending. Rows are called by their place in ``TIN.vertex_of``:
        those given come first, those inserted by edits follow, and removed ones stay in the list.
    left_out_why : (k,) int8 array
        Why, as indices into ``LEFT_OUT``.
    n_lines : int
        Breaklines, rings and water polygons that were given.
    line_labels : tuple of str
        What lines are called; a draped line that was cut has several parts.
    crossings : Crossings
    overruled : Overruled
    from_raster : bool
        Whether the points given are the cells of a raster.
    skipped : mapping of str to int
        What the reader left out and how often.
    notes : sequence of str
        What the reader assumed, a sentence each.
    edits : sequence of Edit
        What was done to the TIN since.
    unmended : Unmended
        Triangles that refinement had to leave. None after an edit, which numbers triangles anew.
    simplification : Simplification or None
        What :func:`tinsmith.simplify` left out. None after an edit.
    row_sources : RowSources or None
        File and line of each row that was given, where they were read from text.
    source : str
        Name of the file that the points or triangles come from; empty if there is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7]])
    >>> tin.report.n_rows, tin.report.n_vertices, tin.report.n_triangles
    (4, 3, 1)
    """

    n_rows: int
    n_vertices: int
    n_triangles: int
    duplicates: DuplicatePolicy = "mean"
    snap: float = 0.0
    merged_vertices: Int32Array = field(default_factory=lambda: np.empty(0, np.int32))
    merged_offsets: Int32Array = field(default_factory=lambda: np.zeros(1, np.int32))
    merged_rows: Int32Array = field(default_factory=lambda: np.empty(0, np.int32))
    merged_elevations: Float64Array = field(default_factory=lambda: np.empty(0))
    merged_shifts: Float64Array = field(default_factory=lambda: np.empty(0))
    vertex_elevations: Float64Array = field(default_factory=lambda: np.empty(0))
    left_out_rows: Int32Array = field(default_factory=lambda: np.empty(0, np.int32))
    left_out_why: Int8Array = field(default_factory=lambda: np.empty(0, np.int8))
    n_lines: int = 0
    line_labels: tuple[str, ...] = ()
    crossings: Crossings = field(default_factory=Crossings.none)
    overruled: Overruled = field(default_factory=Overruled.none)
    from_raster: bool = False
    skipped: Mapping[str, int] = field(default_factory=dict)
    notes: Sequence[str] = ()
    edits: Sequence[Edit] = ()
    unmended: Unmended = field(default_factory=Unmended.none)
    simplification: Simplification | None = None
    row_sources: RowSources | None = None
    source: str = ""

    def _require_sound(self, n_rows: int, n_vertices: int, n_triangles: int) -> None:
        """Refuse a stored report of other than so many rows, vertices and triangles."""
        counts = (self.n_rows, self.n_vertices, self.n_triangles)
        require(counts == (n_rows, n_vertices, n_triangles), "counts of the report")
        require(self.snap >= 0, "snap")
        groups, rows = len(self.merged_vertices), len(self.merged_rows)
        require_indices(self.merged_vertices, n_vertices, "merged vertices", least=-1)
        require_indices(self.merged_rows, n_rows, "merged rows")
        require_offsets(self.merged_offsets, groups, rows, "merged rows")
        for array, count in (
            (self.merged_elevations, rows),
            (self.merged_shifts, rows),
            (self.vertex_elevations, groups),
        ):
            require_finite(array, (count,), "merged elevations")
        require_indices(self.left_out_rows, n_rows, "rows left out")
        require_indices(self.left_out_why, len(LEFT_OUT), "rows left out")
        require(len(self.left_out_why) == len(self.left_out_rows), "rows left out")
        for account, axes in ((self.crossings, (2,)), (self.overruled, ())):
            require_indices(account.vertices, n_vertices, "crossings", least=-1)
            shape = (len(account.vertices), *axes)
            labels = len(self.line_labels)
            require(account.lines.shape == shape, "crossings")
            require_indices(account.lines.ravel(), labels, "crossings", least=-1)
            require_finite(account.elevations, shape, "crossings")
            require_finite(account.vertex_elevations, shape[:1], "crossings")
        require_finite(self.crossings.xy, (len(self.crossings.vertices), 2), "crossings")
        count = len(self.unmended.triangles)
        require_indices(self.unmended.triangles, 2**31 - 1, "triangles that are not mended")
        require_indices(self.unmended.why, len(UNMENDED_WHY), "triangles that are not mended")
        require(len(self.unmended.why) == count, "triangles that are not mended")
        require_finite(self.unmended.angles, (count,), "triangles that are not mended")

    def sentences(self) -> tuple[str, ...]:
        """Return what who uses the surface should know of its making.

        Notes, what the reader left out, and points at one place with different elevations.

        Examples
        --------
        >>> import tinsmith as ts
        >>> points = [[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7]]
        >>> ts.triangulate(points).report.sentences()
        ("Points at 1 place differ in elevation, by up to 2: ...'mean'.",)
        """
        return (*self.notes, *describe_skipped(self.skipped), *self._describe_merges())

    def _describe_merges(self) -> tuple[str, ...]:
        if len(self.merged_rows) == 0:
            return ()
        spread = measure_spread(self.merged_elevations, self.merged_offsets[:-1])
        differing = int(np.count_nonzero(spread))
        return describe_differing(differing, float(spread.max()), self.duplicates)

    def with_reason(self, rows: Int64Array, why: str) -> Report:
        """Return the report with another reason for some of the rows that were left out.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 3, 8]])
        >>> tin.remove([3])
        >>> tin.report.with_reason(np.array([3]), "looks like a blunder").to_dict()["left_out"]
        {'looks like a blunder': [3]}
        """
        codes = self.left_out_why.copy()
        codes[np.isin(self.left_out_rows, rows)] = LEFT_OUT.index(why)
        return replace(self, left_out_why=codes)

    def merges(self) -> Iterator[Merge]:
        """Walk the merges, one vertex at a time.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7]])
        >>> [merge.rows for merge in tin.report.merges()]
        [(0, 3)]
        """
        for i, vertex in enumerate(self.merged_vertices):
            span = slice(self.merged_offsets[i], self.merged_offsets[i + 1])
            yield Merge(
                int(vertex),
                tuple(self.merged_rows[span].tolist()),
                tuple(self.merged_elevations[span].tolist()),
                tuple(self.merged_shifts[span].tolist()),
                float(self.vertex_elevations[i]),
            )

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain Python values, ready for JSON.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7]])
        >>> tin.report.to_dict()["rows"]
        4
        """
        return {
            "rows": self.n_rows,
            "vertices": self.n_vertices,
            "triangles": self.n_triangles,
            "duplicates": self.duplicates,
            "snap": self.snap,
            "merges": [merge.to_dict() for merge in self.merges()],
            "left_out": {
                reason: self.left_out_rows[self.left_out_why == code].tolist()
                for code, reason in enumerate(LEFT_OUT)
                if (self.left_out_why == code).any()
            },
            "lines": self.n_lines,
            "crossings": [
                {
                    "vertex": vertex,
                    "place": place,
                    "lines": [self.line_labels[line] for line in lines],
                    "elevations": elevations,
                    "elevation": elevation,
                }
                for vertex, place, lines, elevations, elevation in zip(
                    *(array.tolist() for array in self.crossings), strict=True
                )
            ],
            "overruled": self._list_overruled(),
            "from_raster": self.from_raster,
            "skipped": dict(self.skipped),
            "notes": list(self.notes),
            "edits": [edit.to_dict() for edit in self.edits],
            "unmended": self.unmended.to_list(),
            **self._describe_simplification(),
        }

    def _describe_simplification(self) -> dict[str, Any]:
        found = self.simplification
        return {} if found is None else {"simplification": found.to_dict()}

    def _list_overruled(self) -> list[dict[str, Any]]:
        return [
            {
                "vertex": vertex,
                "of": "points" if line < 0 else self.line_labels[line],
                "elevation": elevation,
                "taken": vertex_elevation,
            }
            for vertex, line, elevation, vertex_elevation in zip(
                *(array.tolist() for array in self.overruled), strict=True
            )
        ]

    def __repr__(self) -> str:
        merged = len(self.merged_rows) - len(self.merged_vertices)
        return (
            f"<Report: {counted(self.n_rows, 'row')}, "
            f"{counted(self.n_vertices, 'vertex', 'vertices')}, "
            f"{counted(self.n_triangles, 'triangle')}, {counted(merged, 'row')} merged away>"
        )

    def _repr_html_(self) -> str:
        return make_html_repr(self)
