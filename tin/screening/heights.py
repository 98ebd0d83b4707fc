"""Points that are too high or too low for the points around them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.progress import Progress
from ..topology import find_boundary_vertices, find_owners
from .residuals import Residuals, fit_planes, measure_offsets
from .scales import find_rounding, measure_scales

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ..triangulation import Triangulation

STRICT = 10.0
"""A residual is suspicious beyond so many times the scale around it."""
_CARE = 2.0
"""So many times more on lines and at the boundary, where less is known."""
_ROUGH = 5.0
"""On the boundary also beyond so many times what the points around are off their plane."""
_APART = 2.5
"""And if it is so many times as large as those of its neighbours once it is corrected."""
_STARTED = 0.3
"""Of the work as it is told, what is done before the first round; how many there are depends."""
_MOST_REMOVED = 20_000
"""More are measured against corrected elevations, and not against a surface without them."""


class Heights(NamedTuple):
    """Vertices that are too high or too low."""

    vertices: Int32Array
    """(k,)."""
    residuals: Float64Array
    """(k,), elevation above the surface without any of them."""
    scales: Float64Array
    """(k,), how large residuals are around each."""
    limits: Float64Array
    """(k,), beyond which a residual is suspicious: more on a line and on the boundary."""

    def choose(self, chosen: BoolArray) -> Heights:
        """Return some of them."""
        return Heights(
            self.vertices[chosen], self.residuals[chosen], self.scales[chosen], self.limits[chosen]
        )


class Judgement(NamedTuple):
    """What was found, and how large residuals are in the middle."""

    found: Heights
    scale: float
    """Median of the scales of all vertices."""


def find_heights(
    surface: Triangulation,
    judged: Int32Array,
    wrong: Int32Array,
    *,
    sample: int | None = None,
    without: Callable[[Int32Array], Float64Array] | None = None,
    progress: Tell | None = None,
) -> Judgement:
    """Find vertices that are too high or too low for those around them.

    1. Residuals of all vertices are measured against the surface without each, and their scales.
    2. Of those beyond their limit the ones that stand out most among their neighbours are
       corrected first: the elevation of the others' surface takes the place of their own.
    3. The residuals within two edges of them are measured anew. Where more than one is still of the
       same size, or more than one neighbour as far on the same side of the plane through all of
       them, the ground is like this, a step or a rough place: the correction is undone. Else it
       was a blunder.
    4. So on with those that stand out then, until none does.

    Vertices are ``judged``, (k,); those known to be ``wrong``, (m,), count for nothing. With a
    ``sample`` scales are measured from so many of the vertices, else from all of them. ``without``
    returns the elevations at some vertices of the surface without them, NaN for none: residuals of
    what is found are measured against it, by default against the corrected elevations around.
    Progress is told before the first round, and after each half of what is left.

    References
    ----------
    Rousseeuw, P. J. and Hubert, M. (2011). Robust statistics for outlier detection. WIREs Data
    Mining and Knowledge Discovery 1(1), 73-79. https://doi.org/10.1002/widm.2
    """
    done, left = Progress(progress), 1.0
    search = _Search.start(surface, judged, wrong, sample)
    done(_STARTED)
    while search.correct_most_striking():
        left *= 0.5
        done(1.0 - (1.0 - _STARTED) * left)
    # what was found, measured against the surface without any of it
    known, limits = search.known, search.limits
    none = np.empty(0, np.int32)
    vertices = np.sort(np.concatenate([none, *search.found])).astype(np.int32)
    z = known.surface.points[:, 2]
    residuals = z[vertices] - known.xyz[vertices, 2]
    free = ~known.on_line[vertices]
    if without is not None and 0 < free.sum() <= _MOST_REMOVED:
        exact = z[vertices[free]] - without(vertices[free])
        residuals[free] = np.where(np.isnan(exact), residuals[free], exact)
    stays = np.abs(residuals) > limits[vertices]
    vertices = vertices[stays]
    found = Heights(vertices, residuals[stays], search.scales[vertices], limits[vertices])
    return Judgement(found, float(np.nanmedian(search.scales)))


@dataclass(slots=True, eq=False)
class _Search:
    """What is known of the vertices so far; arrays of one value a vertex."""

    known: Residuals
    residuals: Float64Array  # NaN for those that are not, or no longer, judged
    scales: Float64Array
    limits: Float64Array
    found: list[Int32Array]

    @classmethod
    def start(
        cls, surface: Triangulation, judged: Int32Array, wrong: Int32Array, sample: int | None
    ) -> _Search:
        known = Residuals.of(surface)
        known.xyz[wrong, 2] -= np.nan_to_num(known.measure(wrong))
        count = len(known.xyz)
        chosen = judged
        if sample is not None and count > sample:
            spread = np.arange(0, count, count // sample, dtype=np.int32)
            chosen = np.union1d(judged, spread).astype(np.int32)
        residuals, moments, scales = (np.full(count, np.nan) for _ in range(3))
        residuals[chosen], moments[chosen] = known.measure_with_moments(chosen)
        least = find_rounding(surface.points[:, 2])
        for group in (chosen[~known.on_line[chosen]], chosen[known.on_line[chosen]]):
            scales[group] = measure_scales(
                known.xyz[group, :2], residuals[group], moments[group], least
            )
        limits = STRICT * scales
        care = _find_care(known, chosen)
        limits[care] *= _CARE
        rim = care[~known.on_line[care]]
        limits[rim] = np.fmax(limits[rim], _ROUGH * known.measure_roughness(rim))
        is_judged = np.zeros(count, np.bool_)
        is_judged[judged] = True
        is_judged[wrong] = False
        residuals[~is_judged] = np.nan
        return cls(known, residuals, scales, limits, [])

    def correct_most_striking(self) -> bool:
        """Correct those that stand out most among their neighbours; False if none stands out."""
        with np.errstate(invalid="ignore"):
            striking = np.flatnonzero(np.abs(self.residuals) > self.limits).astype(np.int32)
        if len(striking) == 0:
            return False
        around = _Reach.of(self.known, striking)
        rank = np.zeros(len(self.residuals))
        # the rank of each value, equal ones in their order
        values = np.abs(self.residuals[striking])
        ranks = np.empty(len(values), np.int64)
        ranks[np.argsort(values, kind="stable")] = np.arange(len(values))
        rank[striking] = 1 + ranks
        is_first = np.ones(len(striking), np.bool_)
        outdone = rank[around.vertices] > rank[striking][around.owners]
        is_first[around.owners[outdone]] = False
        self._correct(striking[is_first])
        return True

    def _correct(self, chosen: Int32Array) -> None:
        """Correct vertices further than two edges apart, and undo it where that is no help."""
        known = self.known
        own = known.xyz[chosen, 2].copy()
        residuals = self.residuals[chosen]
        known.xyz[chosen, 2] -= residuals
        reach = _Reach.of(known, chosen)
        is_wrong = np.abs(residuals) > _APART * reach.measure_most(known)
        offsets, near = known.list_neighbors(chosen)
        # how far neighbours lie off the plane through them, on the side of the vertex
        xyz, owners = self.known.xyz, find_owners(offsets)
        planes = fit_planes(xyz, chosen, offsets, near)
        left = measure_offsets(xyz, chosen, planes, owners, near)
        beyond = np.nan_to_num(np.where((own > planes[:, 0])[owners], left, -left))
        is_wrong &= np.abs(residuals) > _APART * _find_second(offsets, beyond)
        known.xyz[chosen[~is_wrong], 2] = own[~is_wrong]
        self.residuals[chosen] = np.nan
        self.found.append(chosen[is_wrong])
        again = np.unique(reach.vertices)
        again = again[~np.isnan(self.residuals[again])]
        self.residuals[again] = known.measure(again)


class _Reach(NamedTuple):
    """The vertices within two edges of each of some others, as pairs."""

    size: int
    """Of those others."""
    owners: Int64Array
    """(k,), their places, ascending."""
    vertices: Int32Array
    """(k,)."""

    @classmethod
    def of(cls, known: Residuals, chosen: Int32Array) -> _Reach:
        wide, around = known.list_wide_neighbors(chosen)
        return cls(len(chosen), find_owners(wide), around)

    def measure_most(self, known: Residuals) -> Float64Array:
        """Return the largest residual around each, when the one that has it is corrected, too.

        So a second blunder beside the first hides neither.
        """
        left = self._measure(known)
        # where the largest value of each part stands, of the parts that have one
        order = np.lexsort((np.abs(left), self.owners))
        last = np.cumsum(np.bincount(self.owners, minlength=self.size)) - 1
        helpers = self.vertices[order[np.unique(last[last >= 0])]]
        helpers = np.unique(helpers)
        own = known.xyz[helpers, 2].copy()
        known.xyz[helpers, 2] -= np.nan_to_num(known.measure(helpers))
        left = np.abs(self._measure(known))
        left[np.isin(self.vertices, helpers)] = 0.0
        known.xyz[helpers, 2] = own
        most = np.zeros(self.size)
        np.maximum.at(most, self.owners, left)
        return most

    def _measure(self, known: Residuals) -> Float64Array:
        unique, place = np.unique(self.vertices, return_inverse=True)
        left: Float64Array = np.nan_to_num(known.measure(unique))[place]
        return left


def _find_care(known: Residuals, vertices: Int32Array) -> Int32Array:
    """Return those of some vertices that are on lines or on the boundary."""
    surface = known.surface
    on_boundary = find_boundary_vertices(surface.triangles, surface.neighbors, len(known.xyz))
    return vertices[known.on_line[vertices] | on_boundary[vertices]]


def _find_second(offsets: Int64Array, values: Float64Array) -> Float64Array:
    """Return the second largest value of each part of a ragged array, 0 if there is none."""
    owner = find_owners(offsets)
    order = np.lexsort((-values, owner))
    second = np.append(values[order], 0.0)[np.minimum(offsets[:-1] + 1, len(values))]
    return np.where(np.diff(offsets) > 1, second, 0.0)
