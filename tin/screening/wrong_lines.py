"""Lines whose elevations do not fit the points around them: a boundary at 0, a kerb in feet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..constraints import label_line
from ..topology import find_offsets, find_owners
from .nodata import CUSTOMARY, is_beyond_range, is_customary
from .residuals import Residuals, fit_planes, measure_offsets
from .scales import find_rounding
from .slips import name_factor

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import LineKind
    from ..constraints import Lines
    from ..triangulation import Triangulation

_MOST_JUDGED = 20_000
"""Vertices of lines that are judged, where there are more those of one in so many."""
_MOST_OF_LINE = 0.75
"""Of the judged vertices of a line: so many are off to the same side where the line is wrong."""
_ROUGH = 5.0
"""Times the roughness of the points around a line may be off them."""
_ROUNDED = 20.0
"""Times the rounding of the elevations, likewise."""
_CLEAR = 3.0
"""A line is told of beyond so many times what it may be off,"""
_METRE = 1.0
"""and if it is a metre off, or a unit of what is measured in other ones."""
_NEAR = 0.01
"""A factor must explain all but so much of what a vertex is off."""
_FEWEST = 3
"""Points that a plane is fitted to."""
_NOUNS = {"hard": "breakline", "soft": "breakline"}


class WrongLine(NamedTuple):
    """A line, or some vertices of it, that the points around do not bear out."""

    name: str
    """Such as "boundary 0" or "breakline 2 'kerb'"."""
    n_vertices: int
    """Vertices that it has in the surface."""
    vertices: Int32Array
    """(k,), vertices judged to be wrong, ascending; of many a sample."""
    worst: int
    """The one of them that is most off."""
    offset: float
    """Median of how far they are above the points around."""
    limit: float
    """Median of what they may be off."""
    lowest: float
    highest: float
    """What the points around give where they are."""
    words: str
    """What is wrong with their elevations."""
    certainty: str


class _Judged(NamedTuple):
    """Vertices of lines, and what the points around give there; arrays of one length."""

    lines: Int64Array
    vertices: Int32Array
    z: Float64Array
    ground: Float64Array
    limits: Float64Array
    distances: Float64Array
    """To the nearest of the points."""

    def choose(self, chosen: Any) -> _Judged:
        return _Judged(*(values[chosen] for values in self))

    @property
    def offsets(self) -> Float64Array:
        """How far the vertices are above the points around."""
        return self.z - self.ground


def find_wrong_lines(
    surface: Triangulation,
    lines: Lines,
    is_point: BoolArray,
    has_row: BoolArray,
    known: Mapping[int, float],
    *,
    metre: float = 1.0,
) -> list[WrongLine]:
    """Find lines that lie above or below the surface that the points make without them.

    At each vertex of a line a plane is fitted to the points within two edges of it that are on no
    line. How far the line may be off it is told by how rough the points are, how far away the
    nearest is, and how steep the plane. A line is wrong if most of its vertices are off by more
    than three times as much, and by a metre, to the same side; some of its vertices are where they
    have an elevation that stands for none. Breaklines, holes and water, which may stand upright in
    the ground, are told with low certainty unless they do so by more than 45 degrees.

    Vertices are flagged, (n,), that are points which may bear witness (``is_point``), and that are
    points at all, on a line or not (``has_row``); ``known`` has the elevations of points at
    vertices of lines. ``metre`` is in the unit of elevations.
    """
    if len(lines) == 0 or not is_point.any():
        return []
    line_of = _number_lines(lines)
    owners = line_of[find_owners(lines.offsets)]
    keys = np.unique(owners * len(surface.points) + lines.vertices)
    owners, vertices = np.divmod(keys, len(surface.points))
    chosen = _choose_own(owners, vertices, has_row, known)
    owners, vertices = owners[chosen], vertices[chosen]
    counts = np.bincount(owners)
    # the vertices of lines that points are near enough to judge, line by line
    every = max(1, len(vertices) // _MOST_JUDGED)
    is_judged = np.arange(len(vertices)) % every == 0
    if every > 1:
        is_judged |= np.isin(surface.points[vertices, 2], CUSTOMARY)
    owners, vertices = owners[is_judged], vertices[is_judged].astype(np.int32)
    level, limits, distances = fit_ground(surface, vertices, is_point)
    at_point = np.flatnonzero(np.isin(vertices, np.fromiter(known, np.int64, len(known))))
    for i in at_point.tolist():
        level[i], limits[i], distances[i] = known[int(vertices[i])], 0.0, 0.0
    limits += _ROUNDED * find_rounding(surface.points[:, 2])
    judged = _Judged(owners, vertices, surface.points[vertices, 2], level, limits, distances)
    judged = judged.choose(np.isfinite(level) & np.isfinite(limits))
    ground = surface.points[is_point, 2]
    span = (float(ground.min()), float(ground.max()))
    chains = np.unique(line_of, return_index=True)[1]
    found = []
    for part in np.split(np.arange(len(judged.lines)), np.flatnonzero(np.diff(judged.lines)) + 1):
        own = judged.choose(part)
        line = int(own.lines[0]) if len(part) else 0
        kind, name = lines.kinds[chains[line]], label_line(lines, int(chains[line]))
        told = _find_wrong(own, kind, span, metre)
        if told is not None:
            wrong = own.choose(told.chosen)
            found.append(
                WrongLine(
                    name=name,
                    n_vertices=int(counts[line]),
                    vertices=wrong.vertices,
                    worst=int(wrong.vertices[np.argmax(np.abs(wrong.offsets))]),
                    offset=float(np.median(wrong.offsets)),
                    limit=float(np.median(wrong.limits)),
                    lowest=float(wrong.ground.min()),
                    highest=float(wrong.ground.max()),
                    words=told.words,
                    certainty=told.certainty,
                )
            )
    return found


def _number_lines(lines: Lines) -> Int64Array:
    """Return for each chain which line it is a part of."""
    kinds = np.array([_NOUNS.get(kind, kind) for kind in lines.kinds])
    pairs = np.stack([np.unique(kinds, return_inverse=True)[1], lines.sources], axis=1)
    numbers: Int64Array = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
    return numbers


def _choose_own(
    owners: Int64Array, vertices: Int64Array, has_row: BoolArray, known: Mapping[int, float]
) -> BoolArray:
    """Choose the vertices whose elevations are those of lines; of a line of points alone, all.

    A line bends at points that lie on it, which keep their own.
    """
    is_own = ~has_row[vertices] | np.isin(vertices, np.fromiter(known, np.int64, len(known)))
    has_own = np.bincount(owners, is_own) > 0
    chosen: BoolArray = is_own | ~has_own[owners]
    return chosen


def mark_rings(lines: Lines, count: int) -> BoolArray:
    """Mark which of so many vertices are on a boundary, a hole or water."""
    is_ring = np.array([kind not in ("hard", "soft") for kind in lines.kinds], np.bool_)
    marked = np.zeros(count, np.bool_)
    marked[lines.vertices[is_ring[find_owners(lines.offsets)]]] = True
    return marked


def name_lines_at(lines: Lines, vertices: Int32Array) -> list[str]:
    """Return for each of some vertices what the first line through it is called, "" for none."""
    if len(vertices) == 0 or len(lines) == 0:
        return [""] * len(vertices)
    order = np.argsort(lines.vertices, kind="stable")
    at = np.searchsorted(lines.vertices, vertices, sorter=order)
    first = order[np.minimum(at, len(order) - 1)]
    chains = find_owners(lines.offsets)[first]
    is_there = lines.vertices[first] == vertices
    return [
        label_line(lines, chain) if found else ""
        for chain, found in zip(chains.tolist(), is_there.tolist(), strict=True)
    ]


# ---------------------------------------------------------------- what the points give


def fit_ground(
    surface: Triangulation, vertices: Int32Array, is_point: BoolArray
) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Return elevations of the planes through the points around some vertices; NaN for none.

    And how far off them a line may be, and how far away the nearest point is.
    """
    xyz = surface.points
    offsets, around = Residuals.without_lines(surface).list_wide_neighbors(vertices)
    owners = find_owners(offsets)
    owners, around = owners[is_point[around]], around[is_point[around]]
    offsets = find_offsets(np.bincount(owners, minlength=len(vertices)))
    planes = fit_planes(xyz, vertices, offsets, around)
    left = measure_offsets(xyz, vertices, planes, owners, around)
    apart = xyz[around, :2] - xyz[vertices[owners], :2]
    rough, nearest = np.zeros(len(vertices)), np.full(len(vertices), np.inf)
    np.maximum.at(rough, owners, np.abs(left))
    np.minimum.at(nearest, owners, np.hypot(*apart.T))
    ground = np.where(np.diff(offsets) >= _FEWEST, planes[:, 0], np.nan)
    return ground, _ROUGH * rough + np.hypot(*planes[:, 1:].T) * nearest, nearest


# ---------------------------------------------------------------- what is wrong


class _Told(NamedTuple):
    chosen: BoolArray
    words: str
    certainty: str


def _find_wrong(
    own: _Judged, kind: LineKind, span: tuple[float, float], metre: float
) -> _Told | None:
    """Tell which vertices of a line are wrong, and why; None if none is."""
    sizes = np.abs(own.offsets)
    is_off = sizes > np.maximum(_CLEAR * own.limits, _METRE * metre)
    if not is_off.any():
        return None
    told = _find_code(own, is_off, span) or _find_factor(own, is_off)
    if told is not None:
        return told
    above = is_off & (own.offsets > 0)
    chosen = above if 2 * above.sum() > is_off.sum() else is_off & ~above
    if chosen.sum() < max(2, _MOST_OF_LINE * len(chosen)):
        return None
    is_upright = np.median(sizes[chosen]) > np.median(own.distances[chosen])
    side = f"{np.median(sizes[chosen]):.4g} {'above' if own.offsets[chosen][0] > 0 else 'below'}"
    certainty = "medium" if kind == "boundary" or is_upright else "low"
    return _Told(chosen, f"[lies|lie] some {side} what the points around give", certainty)


def _find_code(own: _Judged, is_off: BoolArray, span: tuple[float, float]) -> _Told | None:
    """Tell which vertices have an elevation that stands for none; the one that most have."""
    values, counts = np.unique(own.z[is_off], return_counts=True)
    for value in values[np.argsort(-counts, kind="stable")].tolist():
        if is_customary(value):
            chosen = is_off & (own.z == value)
            is_upright = (np.abs(own.offsets) > own.distances)[chosen].mean() > 0.5
            is_far = is_beyond_range(value, *span)
            certainty = "high" if is_far else "medium" if is_upright else "low"
            return _Told(
                chosen, f"[has|have] the elevation {value:g}, which may stand for none", certainty
            )
    return None


def _find_factor(own: _Judged, is_off: BoolArray) -> _Told | None:
    """Tell whether most vertices of a line are a factor of what they should be."""
    names = np.full(len(is_off), "", object)
    for i in np.flatnonzero(is_off).tolist():
        tolerance = max(_CLEAR * float(own.limits[i]), _NEAR * abs(float(own.offsets[i])))
        names[i] = name_factor(float(own.z[i]), float(own.ground[i]), tolerance) or ""
    words, counts = np.unique(names[names != ""].astype(str), return_counts=True)
    if len(words) == 0 or counts.max() < max(2, _MOST_OF_LINE * len(is_off)):
        return None
    told = str(words[np.argmax(counts)])
    return _Told(names == told, f"[is|are] {told} what the points around give", "high")
