"""Coregistration: the shift that brings one surface upon another, where the ground is the same."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length, require_tin
from ...base.errors import OptionError, PointsError
from ...base.georeference import agree, find_axes, require_same_crs
from ...base.notes import join_notes
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Table, locate_centers
from ...base.sentences import counted
from ...base.types import Bounds, Grid
from ...tin.constraints import gather_rings_of_regions, in_rings
from .bands import SurfaceBand
from .grids import cover, describe_extent, require_overlap

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from ...base.arrays import BoolArray, Float64Array
    from ...base.crs import CRS
    from ...base.georeference import Reference
    from ...tin import TIN

NMAD = 1.4826
"""What makes the median of absolute deviations a standard deviation of normal ones."""

_LARGEST = 1e100
"""Of elevations, by themselves and in cells: sums of the squares of larger ones overflow."""

_MOST_CELLS = 1_000_000
"""Of the default grid."""
_COARSER = (8, 4, 2, 1)
"""Cells of the first grids, of those of the last: so that shifts of many cells are found."""
_FEWEST = 100
"""Cells that tell a shift."""
_MOST_STEPS, _LAST_STEPS = 60, 10
_SMALLEST_STEP, _STILL, _LARGEST_REST = 1e-6, 1e-3, 0.01
"""Of a cell: what ends the steps; how far the last ones may lead after the most of them, or how far
all that would follow them."""
_BISQUARE = 4.685
"""Standard deviations from which on Tukey's weights are 0: 95 % efficient for normal ones."""
_FITS = 4
"""Rounds of weights in each step."""
_WORSE = 1.02
"""What the NMAD may be of the one before: of surfaces that lie upon each other already."""
_ROUNDING = 1e-9
"""Of a cell and of what the surfaces differ by: NMADs that differ by less are the same."""
_FLAT = 1e-9
"""Slope, of one direction: less is rounding."""
_ONE_SIDED = 0.02
"""Slopes of one direction, as a part of those of the other: less is that of triangles alone."""
_LEAST_LIKENESS = 0.25
"""Part of the slopes in each direction that both surfaces must have in common."""


class _Samples(NamedTuple):
    """Elevations and rises of both surfaces in cells that both have, as lengths."""

    apart: Float64Array
    """The surface less the reference, (k,)."""
    own: Float64Array
    """Slopes of the surface to the east and to the north, (k, 2)."""
    other: Float64Array
    """Those of the reference."""


@dataclass(frozen=True, eq=False, repr=False)
class Coregistration:
    """A surface brought upon another one, made by :func:`tinsmith.coregister`.

    Attributes
    ----------
    tin : TIN
        The surface, shifted; with the build options that it had.
    shift : (float, float, float)
        What was added to eastings and northings, in CRS units, and to elevations, in the unit of
        the surface's own.
    statistics : Table
        Two rows, ``before`` and ``after``, of the surface less the reference in the cells of stable
        ground: ``cells``, ``mean``, ``median``, ``nmad`` (1.4826 times the median of the absolute
        deviations from the median), ``standard_deviation``, ``rms``, in the unit of the reference's
        elevations.
    steps : int
        How many were taken.
    notes : tuple of str
        What was assumed or converted, and of how many cells the shift is.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    >>> ground = np.column_stack([x, y, 5 * np.sin(x / 6) + 4 * np.cos(y / 5)])
    >>> found = ts.coregister(ts.triangulate(ground + [0, 0, 2]), ts.triangulate(ground))
    >>> found.statistics["median"].round(6).tolist(), round(found.shift[2], 6)
    ([2.0, 0.0], -2.0)
    """

    tin: TIN
    shift: tuple[float, float, float]
    statistics: Table
    steps: int
    notes: tuple[str, ...]

    def with_notes(self, notes: Sequence[str]) -> Coregistration:
        """Return the same with further notes in front of its own, those of its parts too.

        Examples
        --------
        >>> import numpy as np
        >>> import tinsmith as ts
        >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
        >>> hills = ts.triangulate(np.column_stack([x, y, 5 * np.sin(x / 6) + 4 * np.cos(y / 5)]))
        >>> ts.coregister(hills, hills).with_notes(["Flown once."]).statistics.notes[0]
        'Flown once.'
        """
        joined = join_notes(notes, self.notes)
        if joined == self.notes:
            return self
        return replace(
            self,
            tin=self.tin.with_notes(joined),
            statistics=self.statistics.with_notes(notes),
            notes=joined,
        )

    def __repr__(self) -> str:
        east, north, up = self.shift
        return f"<Coregistration: {east:.4g} east, {north:.4g} north, {up:.4g} up>"


@product
def coregister(
    tin: TIN,
    reference: TIN,
    *,
    stable: Any = None,
    unstable: Any = None,
    spacing: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Coregistration:
    """Shift a surface horizontally and vertically upon another, after Nuth and Kääb.

    Parameters
    ----------
    tin : TIN
        The surface that is shifted.
    reference : TIN
        The one that stays, in the same CRS.
    stable : polygons, optional
        Where the ground is the same in both; default all of it. Polygons as of
        :func:`tinsmith.volume`.
    unstable : polygons, optional
        Where it is not: glaciers, slides, woods, water.
    spacing : float, CRS units, optional
        Side of the cells at whose centres the surfaces are compared; default the mean distance of
        the vertices of the coarser surface, and such that there are about a million cells at most.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, after each step. What it raises ends the
        call.

    Returns
    -------
    Coregistration
        The shift, the surface shifted by it, and statistics of the differences before and after.

    Raises
    ------
    CrsError
        If the CRSs differ, or are known of one only, or have no lengths; if it cannot be told
        whether elevations are in one unit.
    OptionError, LinesError
        If a spacing or polygon is none.
    PointsError
        If the surfaces do not overlap, or in fewer than 100 cells; if the ground is too flat or
        slopes one way only, or the slopes of both surfaces have so little in common, that they do
        not determine a shift; if the steps do not come to an end.

    Notes
    -----
    Where a surface is shifted by ``(x, y, z)``, its difference from the other one is
    ``dh = x g_x + y g_y - z`` with the slopes ``g`` of the ground to the east and the north;
    divided by the tangent of the slope it is ``a cos(b - aspect) + c`` of [1]_. (1) Both are
    sampled at the centres of cells that both have, and slopes are those of the cells at the sides,
    the mean of both surfaces. (2) x, y, z are fitted. (3) The surface is shifted by them, and so on
    until a step is below a millionth of a cell; first on cells of eight, four and two times the
    spacing. (4) The vertical shift is such that the median of the differences is 0.

    The paper fits ``dh / tan(slope)`` where slopes are not small, which gives the least weight
    where it is steep. Here ``dh`` is fitted with Tukey's weights, which are 0 from 4.685 NMAD [2]_
    on: flat ground needs no threshold, and what has changed has no weight. Rotation, tilt and scale
    are not found. Errors of neighbouring cells are alike, so that the number of cells does not tell
    how accurate a shift is.

    References
    ----------
    .. [1] C. Nuth, A. Kääb, Co-registration and bias corrections of satellite elevation data sets
       for quantifying glacier thickness change, The Cryosphere 5 (2011), doi:10.5194/tc-5-271-2011.
    .. [2] J. Höhle, M. Höhle, Accuracy assessment of digital elevation models by means of robust
       statistical methods, ISPRS Journal of Photogrammetry and Remote Sensing 64 (2009),
       doi:10.1016/j.isprsjprs.2009.02.003.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(40.0), np.arange(40.0)))
    >>> ground = np.column_stack([x, y, 5 * np.sin(x / 6) + 4 * np.cos(y / 5)])
    >>> moved = ts.triangulate(ground + [2.0, -1.0, 0.5])
    >>> found = ts.coregister(moved, ts.triangulate(ground))
    >>> np.round(found.shift, 6) + 0.0
    array([-2. ,  1. , -0.5])
    """
    require_tin(tin)
    require_tin(reference)
    done = Progress(progress)
    agreed = agree((reference, tin), ("the reference", "the surface"))
    pair = _Pair(tin, reference, agreed, _find_spacing(tin, reference, spacing))
    polygons = {"stable": stable, "unstable": unstable}
    masks, notes = _read_masks(polygons, tin.crs)
    before = pair.sample(np.zeros(3), pair.grid, masks).apart
    if len(before) < _FEWEST:
        raise PointsError(_describe_few(len(before), pair.grid.cell_size[0]))
    shift, steps = _find_shift(pair, masks, done)
    found = pair.sample(shift, pair.grid, masks)
    _require_likeness(found, tin.crs)
    shift[2] -= float(np.median(found.apart))
    after = found.apart - np.median(found.apart)
    rounding = _ROUNDING * (pair.grid.cell_size[0] + abs(float(np.median(before))))
    if not measure_nmad(after) <= _WORSE * measure_nmad(before) + rounding:
        raise PointsError(
            "No shift was found by which the surfaces differ less: the NMAD of their differences "
            f"was {measure_nmad(before):.4g} and would be {measure_nmad(after):.4g}, in the unit "
            "of the eastings."
        )
    own = shift / (1.0, 1.0, agreed.up * agreed.factors[1])
    said = (*agreed.notes, *notes, _describe_cells(len(after), pair.grid, polygons))
    moved = tin.transform(
        lambda points: points + own, crs=tin.crs, elevation_unit=tin.elevation_unit
    )
    table = _make_table((before, after), agreed, said)
    done.end()
    east, north, up = own.tolist()
    return Coregistration(moved, (east, north, up), table, steps, said)


class _Pair:
    """Two surfaces on the cells of a grid, in lengths of the unit of the eastings."""

    def __init__(self, tin: TIN, reference: TIN, agreed: Reference, spacing: float) -> None:
        require_overlap(tin.bounds, reference.bounds)
        self._tin = tin
        self._reference = reference
        self._factors = [factor * agreed.up for factor in agreed.factors]
        largest = max(float(np.abs(one.points[:, 2]).max()) for one in (tin, reference))
        if not largest * max(self._factors) < _LARGEST * min(spacing, 1.0):
            raise PointsError(
                f"Elevations are too large for differences and slopes in cells {spacing:g} wide in "
                "double precision: their squares overflow."
            )
        one, two = reference.bounds, tin.bounds
        self._shared = Bounds(
            max(one.xmin, two.xmin),
            max(one.ymin, two.ymin),
            min(one.xmax, two.xmax),
            min(one.ymax, two.ymax),
        )
        self.grid = cover(self._shared, spacing)

    def make_grid(self, times: int) -> Grid:
        """Return the grid of cells so many times as wide."""
        return cover(self._shared, self.grid.cell_size[0] * times)

    def sample(self, shift: Float64Array, grid: Grid, masks: _Masks) -> _Samples:
        """Return what both surfaces have in cells, one of them shifted."""
        box, (east, north, up) = grid.bounds, shift.tolist()
        back = Bounds(box.xmin - east, box.ymin - north, box.xmax - east, box.ymax - north)
        moved = Grid(back, shape=grid.shape, spacing=grid.cell_size[0])
        z = self._draw(self._reference, grid) * self._factors[0]
        own = self._draw(self._tin, moved) * self._factors[1] + up
        slopes = [_find_slopes(one, grid.cell_size[0]) for one in (own, z)]
        is_known = np.isfinite(own - z)
        for side in (*slopes[0], *slopes[1]):
            is_known &= np.isfinite(side)
        is_known &= masks.choose(grid)
        both = [np.column_stack([side[is_known] for side in one]) for one in slopes]
        return _Samples((own - z)[is_known], *both)

    def _draw(self, tin: TIN, grid: Grid) -> Float64Array:
        band = SurfaceBand(tin, grid, None, method="linear", is_mean=False, threads=None)
        return band[0 : grid.shape[0], 0 : grid.shape[1]]


def _find_slopes(z: Float64Array, spacing: float) -> tuple[Float64Array, Float64Array]:
    """Return rises to the east and the north between the cells at the sides; NaN at the rim."""
    east, north = np.full(z.shape, np.nan), np.full(z.shape, np.nan)
    east[:, 1:-1] = (z[:, 2:] - z[:, :-2]) / (2 * spacing)
    north[1:-1] = (z[:-2] - z[2:]) / (2 * spacing)
    return east, north


def _find_spacing(tin: TIN, reference: TIN, spacing: Any) -> float:
    if spacing is not None:
        return as_length("spacing", spacing)
    each = [math.sqrt(one.area / len(one.points)) for one in (tin, reference)]
    smallest = math.sqrt(min(tin.area, reference.area) / _MOST_CELLS)
    return max(*each, smallest)


# ---------------------------------------------------------------------------- polygons


class _Masks(NamedTuple):
    """Rings of polygons, one list for each: where the ground is stable, and where it is not."""

    stable: list[list[Float64Array]] | None
    unstable: list[list[Float64Array]] | None

    def choose(self, grid: Grid) -> BoolArray:
        """Return which cells are on stable ground."""
        chosen = np.ones(grid.shape, bool)
        for rings, is_stable in ((self.stable, True), (self.unstable, False)):
            if rings is not None:
                inside = _find_inside(grid, rings)
                chosen &= inside if is_stable else ~inside
        return chosen


def _find_inside(grid: Grid, polygons: list[list[Float64Array]]) -> BoolArray:
    rows, columns = grid.shape
    x, y = locate_centers(grid, slice(0, rows), slice(0, columns))
    places = np.column_stack([np.tile(x, rows), np.repeat(y, columns)])
    inside = np.zeros(len(places), bool)
    for rings in polygons:
        inside |= in_rings(places, rings) >= 0
    return inside.reshape(grid.shape)


def _read_masks(polygons: Mapping[str, Any], crs: CRS | None) -> tuple[_Masks, tuple[str, ...]]:
    found: dict[str, list[list[Float64Array]] | None] = {}
    notes: tuple[str, ...] = ()
    for name, given in polygons.items():
        found[name] = None
        if given is None:
            continue
        is_plain = not hasattr(given, "crs")
        theirs = getattr(given, "crs", None)
        notes += require_same_crs(theirs, crs, f"the {name} polygons", is_plain=is_plain)
        notes += tuple(getattr(given, "notes", ()))
        is_named = isinstance(given, dict) and "type" not in given
        some = list(given.values()) if is_named else given
        each = [some] if hasattr(some, "__geo_interface__") or isinstance(some, dict) else some
        found[name] = gather_rings_of_regions(each, f"{name} polygon")
        if not found[name]:
            raise OptionError(name, 0, allowed="1 or more", what=f"number of {name} polygons")
    return _Masks(**found), notes


# ------------------------------------------------------------------------------- steps


def _find_shift(pair: _Pair, masks: _Masks, done: Progress) -> tuple[Float64Array, int]:
    """Return the shift in lengths, and how many steps were taken."""
    shift, steps = np.zeros(3), 0
    for level, times in enumerate(_COARSER):
        grid = pair.grid if times == 1 else pair.make_grid(times)
        is_last, begun = times == 1, shift.copy()
        path = []
        for step in range(_MOST_STEPS):
            samples = pair.sample(shift, grid, masks)
            if len(samples.apart) < _FEWEST:
                if is_last:
                    raise PointsError(
                        "The ground does not determine a shift: the steps lead to one of "
                        f"{shift[0]:.3g} east and {shift[1]:.3g} north, by which the surfaces have "
                        f"{counted(len(samples.apart), 'cell')} of stable ground in common."
                    )
                shift = begun
                break
            rest = _fit(samples, is_last=is_last)
            if rest is None:
                break
            shift += rest
            steps += 1
            path.append(shift[:2].copy())
            done((level + step / _MOST_STEPS) / len(_COARSER))
            if math.hypot(*rest[:2].tolist()) <= _SMALLEST_STEP * pair.grid.cell_size[0]:
                break
        else:
            if is_last:
                _require_end(path, pair.grid.cell_size[0])
    return shift, steps


def _require_end(path: Sequence[Float64Array], spacing: float) -> None:
    """Refuse steps that go on: their rest is that of a geometric series."""
    ends = path[-1], path[-1 - _LAST_STEPS], path[-1 - 2 * _LAST_STEPS]
    last, before = (math.hypot(*(b - a).tolist()) for b, a in pairwise(ends))
    if last <= _STILL * spacing:
        return
    if last >= before or last * last / (before - last) > _LARGEST_REST * spacing:
        raise PointsError(
            f"The shift is not determined: the last {_LAST_STEPS} of {_MOST_STEPS} steps still "
            f"change it by {last:.3g}; polygons of stable ground, or another spacing, may help."
        )


def _fit(samples: _Samples, *, is_last: bool) -> Float64Array | None:
    """Return the shift that is left; None where slopes of coarse cells do not tell one."""
    slopes = (samples.own + samples.other) / 2
    low, high = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(slopes.T)), 0.0)).tolist()
    if not low > max(_FLAT, _ONE_SIDED * high):
        if not is_last:
            return None
        raise PointsError(
            "The ground does not determine a shift: it is flat, or slopes to one side alone "
            f"(slopes of {len(slopes):,} cells differ by {low:.2g} in one direction)."
        )
    known = np.column_stack([slopes, -np.ones(len(slopes))])
    rest = samples.apart - np.median(samples.apart)
    found = np.zeros(3)
    for _ in range(_FITS):
        weights = _weigh(rest)
        scaled = known * weights[:, None]
        normal, right = known.T @ scaled, scaled.T @ samples.apart
        try:
            found = np.asarray(np.linalg.solve(normal, right), np.float64)
        except np.linalg.LinAlgError:
            return None if not is_last else np.zeros(3)
        rest = samples.apart - known @ found
    return found


def _weigh(rest: Float64Array) -> Float64Array:
    """Return Tukey's weights of what is left of differences."""
    middle = np.median(rest)
    scale = measure_nmad(rest)
    if scale == 0.0:
        return np.where(rest == middle, 1.0, 0.0) if len(rest) else rest
    far = np.minimum(np.abs(rest - middle) / (_BISQUARE * scale), 1.0)
    weights: Float64Array = (1 - far**2) ** 2
    return weights


def measure_nmad(values: Float64Array) -> float:
    """Return 1.4826 times the median of the absolute deviations from the median."""
    return NMAD * float(np.median(np.abs(values - np.median(values))))


def _require_likeness(samples: _Samples, crs: CRS | None) -> None:
    """Refuse surfaces whose slopes have too little in common, in any direction.

    The slopes of both are those of the ground and of errors, which are not the same: only what both
    have in common tells a shift. In each direction it is the covariance of both as a part of their
    mean variance.
    """
    count = len(samples.apart)
    own, other = (one - one.mean(axis=0) for one in (samples.own, samples.other))
    weights = _weigh(samples.apart)[:, None]
    cross = (own * weights).T @ other / count
    each = ((own * weights).T @ own + (other * weights).T @ other) / (2 * count)
    values, vectors = np.linalg.eig(np.linalg.solve(each, (cross + cross.T) / 2))
    worst = int(np.argmin(values.real))
    if values[worst].real < _LEAST_LIKENESS:
        east, north = find_axes(crs).turn(vectors[:, worst].real)
        azimuth = math.degrees(math.atan2(float(east), float(north))) % 180.0
        raise PointsError(
            "The ground does not determine a shift: along the azimuth of "
            f"{azimuth:.0f}° the slopes of both surfaces have {max(values[worst].real, 0.0):.0%} "
            f"in common, and {_LEAST_LIKENESS:.0%} are needed; cells of another spacing, or "
            "polygons of stable ground with more relief, may tell more."
        )


# ------------------------------------------------------------------------------- words


def _describe_few(count: int, spacing: float) -> str:
    return (
        f"The surfaces have {counted(count, 'cell')} of stable ground in common, {spacing:g} wide, "
        f"and {_FEWEST} are needed to find a shift: a smaller spacing makes more."
    )


def _describe_cells(count: int, grid: Grid, polygons: Mapping[str, Any]) -> str:
    chosen = any(one is not None for one in polygons.values())
    where = "on stable ground" if chosen else "that both surfaces have"
    return (
        f"The shift is of {counted(count, 'cell')} {grid.cell_size[0]:g} wide {where}, "
        f"{describe_extent(grid.bounds)}."
    )


def _make_table(
    differences: tuple[Float64Array, Float64Array], agreed: Reference, notes: Sequence[str]
) -> Table:
    rows = [one / agreed.up for one in differences]
    measures: dict[str, Callable[[Float64Array], float]] = {
        "mean": lambda one: float(one.mean()),
        "median": lambda one: float(np.median(one)),
        "nmad": measure_nmad,
        "standard_deviation": lambda one: float(one.std()),
        "rms": lambda one: float(np.sqrt((one**2).mean())),
    }
    columns: dict[str, Any] = {
        "state": np.array(["before", "after"], object),
        "cells": np.array([len(one) for one in rows]),
        **{name: np.array([measure(one) for one in rows]) for name, measure in measures.items()},
    }
    units = dict.fromkeys(measures, agreed.elevation_unit)
    return Table(columns, units=units, name="coregistration", notes=notes)
