"""The proof that contours stay apart and near their level, by other means than they were made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.checks import require_tin
from ...base.errors import OptionError
from ...base.products import product
from ...base.results import Features
from ...tin.predicates import orientation
from ..surface import take_without_slivers

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array, ObjectArray
    from ...tin import TIN

_BLOCK = 1 << 16
"""So many segments are compared at a time."""


@dataclass(frozen=True)
class ContourCheck:
    """What was found of the lines of :func:`check_contours`.

    Attributes
    ----------
    contacts : int
        Pairs of segments that touch or cross where they should not.
    lines : tuple of (int, int)
        The first few pairs of lines that these belong to.
    shared_vertices : int
        Pairs of segments of one level that meet in a vertex of the TIN, as exact contours do.
    deviation : float
        Largest difference of the surface from the level along a line, in the unit of elevations.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> ts.check_contours(tin, ts.contours(tin, interval=1))
    ContourCheck(contacts=0, lines=(), shared_vertices=0, deviation=0.0)
    """

    contacts: int
    lines: tuple[tuple[int, int], ...]
    shared_vertices: int
    deviation: float

    @property
    def is_apart(self) -> bool:
        """Whether no two lines touch or cross, and none touches itself."""
        return self.contacts == 0


class _Segments(NamedTuple):
    """Segments of lines, one after the other, and the line of each."""

    start: Float64Array
    end: Float64Array
    line: Int64Array


@product
def check_contours(tin: TIN, lines: Features) -> ContourCheck:
    """Check that contours do not touch one another, and how far from their level they run.

    Parameters
    ----------
    tin : TIN
    lines : Features
        As :func:`tinsmith.contours` returns them.

    Returns
    -------
    ContourCheck

    Raises
    ------
    OptionError
        If the features are no lines with elevations.

    Notes
    -----
    It knows nothing of how the lines were made. Whether segments meet is decided by the robust
    predicates of GEOS; elevations are compared at every edge of the TIN that a segment crosses,
    between which they vary linearly; in triangles along the boundary that are thinner than the
    rounding of their coordinates nothing is compared. Near exact lines the deviation is rounding:
    that of a coordinate times the slope.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> found = ts.check_contours(tin, ts.contours(tin, interval=1))
    >>> found.is_apart, found.deviation
    (True, 0.0)
    """
    require_tin(tin)
    if not (isinstance(lines, Features) and lines.kind == "lines" and lines.has_elevations):
        raise OptionError("lines", lines, allowed="contours, as lines with elevations")
    segments = _list_segments(lines)
    contacts, shared, pairs = _find_contacts(tin, segments)
    largest = _find_largest_deviation(take_without_slivers(tin), segments)
    return ContourCheck(contacts, pairs, shared, largest)


def _list_segments(lines: Features) -> _Segments:
    offsets = lines.offsets[0]
    is_start = np.ones(len(lines.coordinates), np.bool_)
    is_start[offsets[1:] - 1] = False
    first = np.flatnonzero(is_start)
    line = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets) - 1)
    return _Segments(lines.coordinates[first], lines.coordinates[first + 1], line)


def _find_contacts(tin: TIN, segments: _Segments) -> tuple[int, int, tuple[tuple[int, int], ...]]:
    shapely = optional.load("shapely")
    shapes = _build_shapes(segments.start, segments.end)
    tree = shapely.STRtree(shapes)
    contacts, shared = 0, 0
    pairs: list[tuple[int, int]] = []
    vertices = set(map(tuple, tin.points[:, :2].tolist()))
    for first in range(0, len(shapes), _BLOCK):
        one, other = tree.query(shapes[first : first + _BLOCK], predicate="intersects")
        one = one + first
        one, other = one[one < other], other[one < other]
        is_joint = _are_joined(segments, one, other)
        one, other = one[~is_joint], other[~is_joint]
        for a, b in zip(one.tolist(), other.tolist(), strict=True):
            if _meet_in_vertex(segments, a, b, vertices):
                shared += 1
                continue
            contacts += 1
            pairs.append((int(segments.line[a]), int(segments.line[b])))
    return contacts, shared, tuple(dict.fromkeys(pairs))[:5]


def _build_shapes(start: Float64Array, end: Float64Array) -> ObjectArray:
    shapely = optional.load("shapely")
    shapes: ObjectArray = shapely.linestrings(np.stack([start[:, :2], end[:, :2]], axis=1))
    return shapes


def _are_joined(segments: _Segments, one: Int64Array, other: Int64Array) -> BoolArray:
    """Tell which pairs follow each other in a line and share that point alone."""
    start, end, line = segments
    follows = (end[one] == start[other]).all(axis=1)
    leads = (end[other] == start[one]).all(axis=1)
    before = np.where(follows[:, None], start[one], start[other])
    joint = np.where(follows[:, None], end[one], end[other])
    after = np.where(follows[:, None], end[other], end[one])
    corners = np.concatenate([before, joint, after])
    rows = np.arange(len(one))
    columns = np.ascontiguousarray(corners[:, 0]), np.ascontiguousarray(corners[:, 1])
    turns = orientation(columns, rows, rows + len(one), rows + 2 * len(one))
    is_back = (turns == 0) & (((joint - before) * (after - joint))[:, :2].sum(axis=1) <= 0)
    is_joint: BoolArray = (line[one] == line[other]) & (follows | leads) & ~is_back
    return is_joint


def _meet_in_vertex(segments: _Segments, a: int, b: int, vertices: set[tuple[float, ...]]) -> bool:
    """Whether two segments of one level share an end that is a vertex of the TIN."""
    ends = [{tuple(side[k].tolist()) for side in (segments.start, segments.end)} for k in (a, b)]
    return any(end[:2] in vertices for end in ends[0] & ends[1])


def _find_largest_deviation(tin: TIN, segments: _Segments) -> float:
    shapely = optional.load("shapely")
    places = np.concatenate([segments.start, segments.end])
    off = np.abs(tin.interpolate(places[:, :2]) - places[:, 2])
    largest = float(np.nanmax(off)) if np.isfinite(off).any() else 0.0
    p, q = (tin.points[tin.edges[:, k]] for k in (0, 1))
    tree = shapely.STRtree(_build_shapes(p, q))
    for first in range(0, len(segments.start), _BLOCK):
        block = slice(first, first + _BLOCK)
        start, end = segments.start[block], segments.end[block]
        which, edge = tree.query(_build_shapes(start, end), predicate="intersects")
        off = _measure_deviations(start[which], end[which], p[edge], q[edge])
        largest = max(largest, float(off.max(initial=0.0)))
    return largest


def _measure_deviations(
    start: Float64Array,
    end: Float64Array,
    p: Float64Array,
    q: Float64Array,
) -> Float64Array:
    """Return how far the elevation is from that of a segment where it crosses an edge p-q."""
    along, at_p, at_q = end - start, p - start, q - start
    right = along[:, 0] * at_p[:, 1] - along[:, 1] * at_p[:, 0]
    left = along[:, 0] * at_q[:, 1] - along[:, 1] * at_q[:, 0]
    total = right - left
    is_parallel = total == 0.0
    share = np.clip(right / np.where(is_parallel, 1.0, total), 0.0, 1.0)
    off: Float64Array = np.abs(p[:, 2] + share * (q[:, 2] - p[:, 2]) - start[:, 2])
    off[is_parallel] = 0.0  # along the edge: its ends are compared, or edges that meet it
    return off
