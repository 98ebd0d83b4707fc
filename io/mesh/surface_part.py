"""Which triangles of a mesh make a surface: those with area seen from above that do not overlap."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.errors import PointsError, choice
from ...base.policies import FacePolicy
from ...base.sentences import counted, inflect
from ...tin.checking import find_overlap
from ...tin.predicates import columns, orientation
from ...tin.topology import find_offsets
from ...tin.validation import as_points, as_triangles

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ...tin import TIN
    from ...tin.predicates import Columns

_ROUNDINGS = 2.0
"""How thick a triangle can seem that rounding turned over: each corner moves by half in x and y."""

_ROUNDED = ", without area or turned over by rounding"
_FEW = 0.01
"""The share of the area, or of the number, that is left out without being asked, and told."""

_BLOCK = 1 << 18
"""Triangles whose neighbours are looked for at a time."""


class SurfacePart(NamedTuple):
    """The triangles that make a surface, and what the others are."""

    kept: BoolArray
    """(m,)."""
    is_flat: BoolArray
    """(m,), those without area seen from above."""
    areas: Float64Array
    """(m,), in the plane."""
    heights: Float64Array
    """(m,), upon the longest edge of each, in the plane."""

    @property
    def n_left_out(self) -> int:
        """How many triangles are left out."""
        return int(np.count_nonzero(~self.kept))

    @property
    def is_nearly_all(self) -> bool:
        """Whether few are left out: of the area, and of the number those without area."""
        n_flat = int(np.count_nonzero(self.is_flat & ~self.kept))
        overlapping = float(self.areas[~self.kept].sum())
        return n_flat <= _FEW * len(self.kept) and overlapping <= _FEW * float(self.areas.sum())

    def keep_thick(self, thickness: float) -> SurfacePart:
        """Leave out only triangles that are no thicker."""
        return self._replace(kept=self.kept | (self.heights > thickness))

    def describe(self) -> str:
        """Tell what is left out, for the middle of a sentence."""
        n_flat = int(np.count_nonzero(self.is_flat & ~self.kept))
        overlapping = self.n_left_out - n_flat
        parts = []
        if n_flat:
            parts.append(f"{n_flat:,} without area seen from above")
        if overlapping:
            share = 100 * float(self.areas[~self.kept].sum() / self.areas.sum())
            what = inflect("that overlap[s|] others", overlapping)
            parts.append(f"{overlapping:,} {what}, {share:.3g} % of the area")
        count = counted(len(self.kept), "triangle")
        return f"{self.n_left_out:,} of {count} ({'; '.join(parts)})"

    def describe_left_out(self, why: str) -> list[str]:
        """Return a note of what is left out; none where nothing is."""
        return [f"Left out{why}: {self.describe()}."] if self.n_left_out else []


def make_surface(
    make: Callable[[BoolArray | slice], TIN],
    points: AnyArray,
    triangles: AnyArray,
    *,
    faces: FacePolicy = "most",
    rounding: float = 0.0,
) -> tuple[TIN, list[str]]:
    """Make a TIN of the triangles of a mesh, or of those that make a surface.

    Parameters
    ----------
    make : callable
        Makes the TIN of some of the triangles.
    points : (n, 3) array
    triangles : (m, 3) int array
    faces : {"most", "all", "surface"}
        What becomes of triangles that no TIN can have, without area seen from above or on the same
        side of an edge as another one: "all" refuses the mesh, and "most" leaves out what makes no
        surface where that is at most one percent, and else refuses it: of the area what overlaps
        others, of the number what has no area.
        "surface" leaves out all triangles that have no area or overlap larger ones.
    rounding : float
        Distance of neighbouring numbers that the coordinates of the file can have, where it is
        known that rounding alone can make such triangles: those as thin are left out and told.

    Returns
    -------
    TIN
    list of str
        Notes of what is left out, and of triangles that overlap and are not.
    """
    if choice("faces", faces, FacePolicy) == "surface":
        part = _find_part(points, triangles)
        return make(part.kept), part.describe_left_out(" to make a surface")
    try:
        tin = make(slice(None))
    except PointsError as error:
        try:
            part = _find_part(points, triangles)
        except PointsError:
            raise error from None
        is_few = faces == "most" and part.is_nearly_all and not _repeat_corners(triangles)
        return _leave_out(make, part, error, is_few=is_few, rounding=rounding)
    return tin, _describe_overlap(tin)


def _describe_overlap(tin: TIN) -> list[str]:
    """Tell whether triangles overlap without a common edge, and what "surface" would leave out."""
    overlap = find_overlap(tin)
    if not overlap.is_found:
        return [overlap.sentence] * bool(overlap.sentence)
    part = _find_part(tin.points, tin.triangles)
    if part.n_left_out:
        return [f"{overlap.sentence} `faces='surface'` leaves out {part.describe()}."]
    return [overlap.sentence.replace("overlap", "overlap or touch", 1)]


def _repeat_corners(triangles: AnyArray) -> bool:
    """Whether a triangle names a vertex twice, as in a damaged file."""
    corners = np.asarray(triangles)
    return bool((corners == np.roll(corners, 1, axis=1)).any())


def _leave_out(
    make: Callable[[BoolArray | slice], TIN],
    part: SurfacePart,
    error: PointsError,
    *,
    is_few: bool,
    rounding: float,
) -> tuple[TIN, list[str]]:
    """Make a TIN without what rounding alone made, or without a few; else offer "surface"."""
    thin = part.keep_thick(_ROUNDINGS * rounding)
    if rounding > 0 and thin.n_left_out and thin.kept.any():
        with suppress(PointsError):
            tin = make(thin.kept)
            return tin, [*thin.describe_left_out(_ROUNDED), *_describe_overlap(tin)]
    if not part.n_left_out or not part.kept.any():
        raise error
    if is_few:
        tin = make(part.kept)
        return tin, [*part.describe_left_out(" to make a surface"), *_describe_overlap(tin)]
    offer = f"To read the others, `faces='surface'` leaves out {part.describe()}."
    raise PointsError(f"{error} {offer}", rows=error.rows) from error


def _find_part(points: AnyArray, triangles: AnyArray) -> SurfacePart:
    xyz = as_points(points)
    return find_surface_part(xyz, as_triangles(triangles, len(xyz)))


def find_surface_part(points: Float64Array, triangles: Int32Array) -> SurfacePart:
    """Choose triangles that make a surface; of those that overlap the largest stay.

    Parameters
    ----------
    points : (n, 3) float64 array
        Finite.
    triangles : (m, 3) int array
        Of vertices that there are, in either direction.

    Notes
    -----
    Two triangles overlap if no edge of either has both on different sides, by exact signs. They are
    chosen in the order of their areas, of equal ones the higher first, so that of a closed solid
    the top stays: each that overlaps none of those chosen before is chosen.
    """
    xy = columns(points)
    corners = np.asarray(triangles, np.int64)
    turns = orientation(xy, *corners.T)
    corners = np.where(turns[:, None] < 0, corners[:, [0, 2, 1]], corners)
    kept: BoolArray = turns != 0
    places = points[corners, :2]
    order = np.lexsort((places[..., 1], places[..., 0]))
    a, b, c = np.take_along_axis(places, order[..., None], axis=1).transpose(1, 0, 2)
    u, v = b - a, c - a
    areas = np.asarray(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2)
    pairs = _find_overlaps(points, xy, corners, np.flatnonzero(kept))
    heights = points[corners, 2].mean(axis=1)
    order = np.lexsort((-heights, -areas))
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    first, second = np.sort(rank[pairs], axis=1).T
    by_second = np.lexsort((first, second))
    first, second = first[by_second], second[by_second]
    ranks, counts = np.unique(second, return_counts=True)
    offsets = find_offsets(counts.tolist()).tolist()
    left_out: set[int] = set()
    earlier = first.tolist()
    for k, at in enumerate(ranks.tolist()):
        if not left_out.issuperset(earlier[offsets[k] : offsets[k + 1]]):
            left_out.add(at)
    kept[[int(order[at]) for at in left_out]] = False
    places = points[corners, :2]
    longest = np.linalg.norm(places - np.roll(places, 1, axis=1), axis=2).max(axis=1)
    return SurfacePart(
        kept, turns == 0, areas, np.asarray(2 * areas / np.where(longest > 0, longest, 1.0))
    )


# -------------------------------------------------------------------------- overlaps


def _find_overlaps(
    points: Float64Array, xy: Columns, corners: Int64Array, wanted: Int64Array
) -> Int64Array:
    """Return the pairs of triangles that overlap, (k, 2), the lower number first."""
    shapely = optional.load("shapely")
    places = points[corners[wanted], :2]
    low, high = places.min(axis=1), places.max(axis=1)
    boxes = shapely.box(*low.T, *high.T)
    tree = shapely.STRtree(boxes)
    found = [np.empty((0, 2), np.int64)]
    for start in range(0, len(wanted), _BLOCK):
        first, second = tree.query(boxes[start : start + _BLOCK])
        pairs = np.stack([first + start, second], axis=1)
        pairs = wanted[pairs[pairs[:, 0] < pairs[:, 1]]]
        ours = corners[pairs[:, 0]]
        theirs = corners[pairs[:, 1]]
        overlap = np.ones(len(ours), np.bool_)
        for one, other in ((ours, theirs), (theirs, ours)):
            for k in range(3):
                open_ = np.flatnonzero(overlap)
                a, b = one[open_, k], one[open_, (k + 1) % 3]
                is_left = [orientation(xy, a, b, corner) > 0 for corner in other[open_].T]
                overlap[open_] = np.any(is_left, axis=0)
        found.append(pairs[overlap])
    return np.concatenate(found)
