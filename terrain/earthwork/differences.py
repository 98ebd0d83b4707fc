"""The difference of two surfaces as a surface, and its statistics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_percentages
from ...base.notes import join_notes
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Features, Table
from .. import _kernel
from ..surface import Reference, Surface
from . import zones as parts
from .planes import level_surface
from .regional import find_regional_zones, subtract_in_regions
from .subtraction import subtract
from .uncertainty import add_errors, ask, find_detection
from .volumes import measure

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...tin import TIN
    from .detection import Detection
    from .error_models import ErrorModel
    from .regional import Regional

_SHARES = {"p05": 5.0, "p25": 25.0, "median": 50.0, "p75": 75.0, "p95": 95.0}

_NMAD = 1.4826
"""What makes the median of absolute deviations a standard deviation of normal ones."""

_FINEST_SHARE = 1e-12
"""Of the largest deviation: the median of all is found as precisely."""

_FAN_OUT = 32
"""Elevations compared with the share wanted at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class Difference:
    """The difference of two surfaces, made by :func:`tinsmith.difference`.

    Attributes
    ----------
    tin : TIN
        Its elevation is that of the other surface less that of the first: above 0 where there is
        fill, below where there is cut. Its edges are those of both TINs and the zero line.
    volumes : Table
        As :func:`tinsmith.volume` gives it, of the same overlay: one row, or one for each region.
    notes : tuple of str
        What was assumed or converted.

    Notes
    -----
    With regions, all of it is of what lies in any of them, once; but ``zones`` and ``volumes`` are
    region by region: what lies in several regions is in each of them.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
    >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> found = ts.difference(flat, ramp)
    >>> found.cut, found.fill, found.statistics["mean"]
    (2.0, 18.0, array([1.]))
    >>> found.zero_line.columns["length"]
    array([4.])
    """

    tin: TIN
    volumes: Table
    notes: tuple[str, ...]
    _reference: Reference
    _sums: dict[str, float]
    _regions: tuple[Regional, ...] = ()
    _detection: Detection | None = None

    def with_notes(self, notes: Sequence[str]) -> Difference:
        """Return the same with further notes in front of its own, those of its parts too.

        Examples
        --------
        >>> import tinsmith as ts
        >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
        >>> ts.difference(flat, flat).with_notes(["One row was left out."]).zones.notes
        ('One row was left out.', ...)
        """
        joined = join_notes(notes, self.notes)
        if joined == self.notes:
            return self
        reference = replace(self._reference, notes=joined)
        return replace(
            self,
            tin=self.tin.with_notes(joined),
            volumes=self.volumes.with_notes(notes),
            notes=joined,
            _reference=reference,
        )

    @property
    def cut(self) -> float:
        """Volume between the surfaces where the other one is below, CRS units cubed."""
        return self._sums["cut"] * self._reference.up

    @property
    def fill(self) -> float:
        """Volume between the surfaces where the other one is above, CRS units cubed."""
        return self._sums["fill"] * self._reference.up

    @cached_property
    def unchanged(self) -> BoolArray:
        """Which triangles of ``tin`` count as unchanged, (m,) bool.

        Those where the surfaces agree, or differ by no more than the level of detection.
        """
        classes = parts.classify(self.tin.triangulation, self._detection)
        return np.asarray(classes == 0)

    @cached_property
    def zero_line(self) -> Features:
        """The lines between parts that are cut, filled and unchanged, what is higher on the left.

        They are closed, or end at the boundary or where three parts meet. Where the surfaces
        agree on an area its border is a line, such as that of a design that meets the ground. With
        a level of detection lines run where the difference is as large, up or down.
        """
        return parts.trace_zero_line(self.tin.triangulation, self._reference, self._detection)

    @cached_property
    def zones(self) -> Features:
        """The connected parts that are cut, filled or unchanged as polygons.

        Columns ``kind`` ("cut", "fill", "unchanged"), ``area``, ``volume``, ``lowest``,
        ``highest``; before them ``region``, at whose border polygons are cut, if there are any.
        With a level of detection what differs by no more is "unchanged"; its ``volume`` is then
        that of cut and fill together.
        """
        if self._regions:
            return find_regional_zones(self._regions, self._reference, self._detection)
        return parts.find_zones(self.tin.triangulation, self._reference, self._detection)

    @cached_property
    def statistics(self) -> Table:
        """Mean, root mean square and others of the difference, weighted by area: one row.

        ``mean``, ``rms``, ``standard_deviation``, ``mean_absolute``, ``lowest``, ``highest``,
        percentiles ``p05``, ``p25``, ``median``, ``p75``, ``p95``, ``nmad`` (1.4826 times the
        median of the absolute deviations from the median, a standard deviation that outliers leave
        as it is; Höhle and Höhle 2009, doi:10.1016/j.isprsjprs.2009.02.003), and the ``area``.
        """
        columns = _list_moments(self._sums)
        columns |= dict(zip(_SHARES, self.percentiles(list(_SHARES.values())), strict=True))
        surface = Surface(self.tin.points, self.tin.triangles)
        columns["nmad"] = _NMAD * find_median_deviation(surface, float(columns["median"]))
        units: dict[str, Any] = dict.fromkeys(columns, self._reference.elevation_unit)
        units["area"] = self._reference.units.area
        return Table(
            {name: np.array([value]) for name, value in columns.items()},
            units=units,
            name="difference",
            notes=self.notes,
        )

    def percentiles(self, shares: Sequence[float]) -> Float64Array:
        """Return the differences at and under which given shares of the area lie.

        Parameters
        ----------
        shares : sequence of float
            From 0 to 100.

        Returns
        -------
        (k,) float64 array, unit of elevations

        Examples
        --------
        >>> import tinsmith as ts
        >>> flat = ts.triangulate([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
        >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 8], [4, 4, 8], [0, 4, 0]])
        >>> ts.difference(flat, ramp).percentiles([10, 50])
        array([0.8, 4. ])
        """
        wanted = as_percentages("percentiles", shares)
        return percentiles(Surface(self.tin.points, self.tin.triangles), wanted.tolist())

    def __repr__(self) -> str:
        return f"<Difference: {self.tin!r}>"


def _list_moments(sums: dict[str, float]) -> dict[str, float]:
    area = sums["area"]
    mean, square = (sums["fill"] - sums["cut"]) / area, sums["squares"] / area
    return {
        "area": area,
        "mean": mean,
        "rms": float(np.sqrt(square)),
        "standard_deviation": float(np.sqrt(max(square - mean * mean, 0.0))),
        "mean_absolute": (sums["fill"] + sums["cut"]) / area,
        "lowest": sums["lowest"],
        "highest": sums["highest"],
    }


@product
def difference(
    tin: TIN,
    other: TIN | None = None,
    *,
    base: float | ArrayLike | None = None,
    regions: Any = None,
    standard_error: float | str | ErrorModel | None = None,
    other_standard_error: float | str | ErrorModel | None = None,
    level_of_detection: float | None = None,
    confidence: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Difference:
    """Subtract a surface from another one, exactly where both are.

    Parameters
    ----------
    tin : TIN
        For example the ground as it is, or was.
    other : TIN, optional
        The surface that it is subtracted from.
    base : float or (3, 3) array, optional
        In place of another TIN a level or a plane, as of :func:`tinsmith.volume`.
    regions : polygons, optional
        Subtract only in them, as of :func:`tinsmith.volume`: zones and volumes are then region by
        region.
    standard_error, other_standard_error : float, str or ErrorModel, optional
        Of the elevations of both surfaces, as of :func:`tinsmith.volume`: the volumes have standard
        errors then.
    level_of_detection : float, optional
        Difference, in the unit of elevations, up to which a surface counts as unchanged, in zones
        and zero line. Default none: whatever is not exactly 0 is cut or filled.
    confidence : float, optional
        In place of ``level_of_detection``: it is computed from the standard errors, as of
        :func:`tinsmith.volume`.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages, and more finely while
        the volumes are summed up. What it raises ends the call.

    Returns
    -------
    Difference
        A TIN of the difference with its zero line, cut and fill as polygons, volumes, statistics.

    Raises
    ------
    OptionError, CrsError, LinesError
        As :func:`tinsmith.volume`.
    PointsError
        If the surfaces do not overlap, or only in what is thinner than coordinates can tell; if
        the regions hold nothing of them.

    Notes
    -----
    Vertices are those of both TINs and the places where their edges cross, rounded once: a cell
    that is thinner than the rounding is merged with the next. Triangles along the boundary that are
    as thin, as between the points of a slanted line, are left out of the TIN. Two TINs of n
    vertices each have an overlay of some 8 n vertices; memory goes with it, about 2 kB for each of
    the n. Volumes and statistics are those of the surfaces as they are; the TIN is refused if its
    volumes differ from theirs.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
    >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 2], [4, 4, 2], [0, 4, 0]])
    >>> found = ts.difference(flat, ramp)
    >>> found.statistics["highest"], sorted(found.zones.columns["kind"])
    (array([1.]), ['cut', 'fill'])
    >>> east = [[3, 0], [4, 0], [4, 4], [3, 4]]
    >>> ts.difference(flat, ramp, regions={"east": east}).zones.columns["volume"]
    array([3.])
    """
    done = Progress(progress)
    asked = ask(
        standard_error, other_standard_error, level_of_detection, confidence, is_plane=other is None
    )
    measured = measure(
        tin, other, base, regions, None, Progress(done.stage(0.0, 0.4)), "Differences"
    )
    tins = (tin, other)
    detection = find_detection(measured, asked, tins)
    table = add_errors(measured, asked, tins, detection, Progress(done.stage(0.4, 0.5)))
    reference = replace(measured.reference, notes=tuple(table.notes))
    against = level_surface(tin, base) if other is None else other
    first = measured.first
    second = measured.other or Surface(against.points, against.triangles)
    done(0.5)
    holds = _make_holder(tin, against)
    parts_of: tuple[Regional, ...] = ()
    if measured.parts is None:
        sums = dict(zip(_kernel.SUMS, measured.sums[0].tolist(), strict=True))
        surface = subtract(first, second, sums, holds, reference, detection)
    else:
        surface, sums, parts_of = subtract_in_regions(first, second, measured, holds, detection)
    done.end()
    return Difference(surface, table, reference.notes, reference, sums, parts_of, detection)


def subtract_skirt(ground: TIN, skirt: TIN, share: float) -> TIN:
    """Return a surface around a pad less the ground, as the TIN of :func:`difference`.

    Where the surface has walls that are thinner than coordinates can tell, volumes may be off by a
    share of the area times the largest difference: for what is proven in another way.
    """
    measured = measure(ground, skirt, None, None, None, Progress(None), "Differences")
    second = measured.other or Surface(skirt.points, skirt.triangles)
    sums = dict(zip(_kernel.SUMS, measured.sums[0].tolist(), strict=True))
    holds = _make_holder(ground, skirt)
    return subtract(measured.first, second, sums, holds, measured.reference, share=share)


def _make_holder(tin: TIN, other: TIN) -> Callable[[Any], Any]:
    """Return a function that tells whether both surfaces hold places."""
    return lambda xy: (tin.locate(xy) >= 0) & (other.locate(xy) >= 0)


def percentiles(surface: Surface, shares: Sequence[float]) -> Float64Array:
    """Return the elevations under which given shares of the area lie.

    Parameters
    ----------
    surface : Surface
    shares : sequence of float
        From 0 to 100.

    Notes
    -----
    Between the elevations of two vertices next to each other the area below is a quadratic
    function of the elevation: those are found by the areas below vertices, then it is solved.
    """
    values = np.unique(surface.points[surface.triangles.ravel(), 2])
    wanted = _measure_below(surface, np.array([np.inf]))[0] * np.asarray(shares) / 100.0
    low, high = _enclose(surface, values, wanted)
    pairs = zip(values[low].tolist(), values[high].tolist(), wanted.tolist(), strict=True)
    return np.array([_solve_between(surface, *one) for one in pairs])


def _enclose(
    surface: Surface, values: Float64Array, wanted: Float64Array
) -> tuple[Int64Array, Int64Array]:
    """Find the two of ascending elevations between which areas wanted are reached."""
    low = np.zeros(len(wanted), np.int64)
    high = np.full(len(wanted), len(values) - 1)
    while (high - low > 1).any():
        steps = [
            np.linspace(a, b, _FAN_OUT + 2).astype(np.int64) for a, b in zip(low, high, strict=True)
        ]
        trial = np.unique(np.concatenate([low, high, *steps]))
        below = _measure_below(surface, np.nextafter(values[trial], np.inf))
        for k, area in enumerate(wanted):
            inner = trial[(trial > low[k]) & (trial < high[k])]
            reached = below[np.searchsorted(trial, inner)] >= area
            low[k] = inner[~reached].max(initial=low[k])
            high[k] = inner[reached].min(initial=high[k])
    return low, high


def _measure_below(surface: Surface, levels: Float64Array) -> Float64Array:
    finite = np.minimum(levels, np.finfo(float).max)
    return _kernel.stage_sums(surface.points, surface.triangles, finite, 1.0)[:, 0]


def _solve_between(surface: Surface, low: float, high: float, area: float) -> float:
    """Solve for the elevation between two between which there is no vertex."""
    after = float(np.nextafter(low, np.inf))
    if after >= high:
        return high if _measure_below(surface, np.array([after]))[0] < area else low
    middle = low + 0.5 * (high - low)
    at_low, at_middle, at_high = _measure_below(surface, np.array([after, middle, high])).tolist()
    if at_low >= area:
        return low
    if at_high <= area:
        return high
    # at_low + t (b + c t), t from 0 to 1
    b = 4.0 * (at_middle - at_low) - (at_high - at_low)
    c = 2.0 * (at_high - at_low) - 4.0 * (at_middle - at_low)
    rest = area - at_low
    t = 2.0 * rest / (b + np.sqrt(max(b * b + 4.0 * c * rest, 0.0)))
    return float(low + min(max(t, 0.0), 1.0) * (high - low))


def find_median_deviation(surface: Surface, middle: float) -> float:
    """Return the absolute deviation from an elevation that half of the area does not exceed."""
    values = surface.points[surface.triangles.ravel(), 2]
    half = 0.5 * float(_measure_below(surface, np.array([np.inf]))[0])
    low, high = 0.0, float(np.abs(values - middle).max())
    if high == 0.0 or _measure_within(surface, middle, np.zeros(1))[0] >= half:
        return 0.0
    least = _FINEST_SHARE * high
    while high - low > least:
        trial = np.linspace(low, high, _FAN_OUT + 2)
        reached = np.flatnonzero(_measure_within(surface, middle, trial[1:-1]) >= half)
        first = int(reached[0]) + 1 if len(reached) else _FAN_OUT + 1
        if (trial[first - 1], trial[first]) == (low, high):
            break
        low, high = float(trial[first - 1]), float(trial[first])
    return high


def _measure_within(surface: Surface, middle: float, away: Float64Array) -> Float64Array:
    """Return the areas that are no further away from an elevation."""
    ends = np.concatenate([np.nextafter(middle + away, np.inf), middle - away])
    levels, at = np.unique(ends, return_inverse=True)
    below = _measure_below(surface, levels)[at]
    return below[: len(away)] - below[len(away) :]
