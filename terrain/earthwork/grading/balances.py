"""Balance a pad: the elevation at which what is cut makes what is filled."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.checks import as_number
from ....base.errors import LinesError, PointsError
from ....base.notes import join_notes
from ....base.products import product
from ....base.progress import Progress
from ....base.results import Table
from ....base.sentences import height
from ...surface import find_reference
from ..volumes import volume
from .fixed import Site, hold, measure_held, read_fixed
from .grades import require_slopes
from .pads import make_pad, read_polygon
from .pasting import join_surfaces
from .patches import make_patch, require_on_ground
from .seams import find_area
from .slopes import take_near

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from ....base.georeference import Reference
    from ....tin import TIN
    from .fixed import Fixed
    from .pads import Pad

_ENOUGH = 1e-9
"""Of what is moved: less is in balance."""
_NEAR = 1e-7
"""In units of elevations: trials are no nearer to each other."""
_NEAR_LOST = 1e-4
"""The same where the ground ends before slopes that start higher, or lower, do."""
_MOST_TRIALS = 60
_MARGIN = 0.5
"""Of the extent of pad, slopes and regions: so much farther reaches the ground of a trial."""
_LEAST_MOVING = 0.1
"""Of the area of a pad: so much of it moves at least where regions and their slopes are fixed."""
_SUMS = ("cut", "fill", "cut_area", "fill_area")
_JUMP = 1e-4
"""Of what is moved: more that remains is a jump, where slopes begin to reach another part."""


@dataclass(frozen=True, eq=False, repr=False)
class BalancedPad:
    """A pad in balance, made by :func:`tinsmith.balance`.

    Attributes
    ----------
    tin : TIN
        The graded ground, as :func:`tinsmith.grade` makes it.
    table : Table
        One row: ``elevation`` of the pad, of one that is not level at its centroid; ``cut``,
        ``fill`` and their areas; ``fill_from_cut``, what the cut makes; ``balance``, what of that
        is left, with the surplus; ``sensitivity``, by how much the balance falls for each unit of
        elevations that the pad is raised; ``haul``, the loose volume of the cut.
    notes : tuple of str
        What was assumed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> hill = ts.triangulate([[0, 0, 0], [60, 0, 6], [60, 60, 6], [0, 60, 0]])
    >>> pad = [[25, 25], [35, 25], [35, 35], [25, 35]]
    >>> found = ts.balance(hill, pad, cut_slope=2, fill_slope=2)
    >>> round(found.elevation, 6), found
    (3.0, <BalancedPad: elevation 3, ...>)
    """

    tin: TIN
    table: Table
    notes: tuple[str, ...] = ()

    @property
    def elevation(self) -> float:
        """Elevation of the pad, in the unit of the ground's; at the centroid if it is inclined."""
        return float(self.table["elevation"][0])

    def with_notes(self, notes: Sequence[str]) -> BalancedPad:
        """Return the same with further notes in front of its own, those of its table too.

        Examples
        --------
        >>> import tinsmith as ts
        >>> hill = ts.triangulate([[0, 0, 0], [60, 0, 6], [60, 60, 6], [0, 60, 0]])
        >>> pad = [[25, 25], [35, 25], [35, 35], [25, 35]]
        >>> found = ts.balance(hill, pad, cut_slope=2, fill_slope=2)
        >>> found.with_notes(["One row was left out."]).table.notes[0]
        'One row was left out.'
        """
        joined = join_notes(notes, self.notes)
        return replace(self, table=self.table.with_notes(notes), notes=joined)

    def __repr__(self) -> str:
        return f"<BalancedPad: elevation {self.elevation:.6g}, {self.tin!r}>"


class Trial(NamedTuple):
    """A pad at some elevation."""

    surface: TIN
    """Pad and slopes; with fixed regions the graded ground."""
    volumes: Mapping[str, float]
    """``cut``, ``fill``, ``cut_area`` and ``fill_area``."""
    balance: float
    slope: float
    """By how much the balance falls for each unit that the pad is raised."""
    notes: tuple[str, ...]

    @property
    def moved(self) -> float:
        """What is cut and filled together."""
        return self.volumes["cut"] + self.volumes["fill"]


class _Trials(NamedTuple):
    """What does not change from trial to trial."""

    tin: TIN
    site: Site
    shrink: float
    surplus: float
    fixed: list[Fixed]

    def attempt(self, pad: Pad, *, is_whole: bool = False) -> Trial:
        """Measure a pad and its slopes; with fixed regions in the whole ground if that is asked."""
        tin, (ratios, reference, area) = self.tin, self.site
        patch = make_patch(tin, pad, ratios, reference.up, area, Progress(None))
        if self.fixed:
            return self._hold(patch, pad) if is_whole else self._hold_near(patch, pad)
        table = volume(tin, patch)
        sums = {name: float(table[name][0]) for name in _SUMS}
        areas = self.shrink * sums["cut_area"] + sums["fill_area"]
        areas += float(table["unchanged_area"][0])  # of which any rise makes fill
        return self._make_trial(patch, sums, areas, tuple(table.notes))

    def _hold_near(self, patch: TIN, pad: Pad) -> Trial:
        """Measure it with the fixed regions, of the ground alone that is near to all of them.

        Slopes that do not end there are measured in the whole ground.
        """
        import shapely

        shapes = [find_area(patch), *(one.polygon for one in self.fixed)]
        low, high = np.reshape(shapely.total_bounds(shapes), (2, 2))
        margin = _MARGIN * float((high - low).max())
        near = take_near(self.tin, low - margin, high + margin)
        if len(near.triangles) < len(self.tin.triangles):
            site = self.site._replace(area=find_area(near))
            try:
                return self._replace(tin=near, site=site)._hold(patch, pad)
            except (PointsError, LinesError):
                pass
        return self._hold(patch, pad)

    def _hold(self, patch: TIN, pad: Pad) -> Trial:
        """Measure it with the fixed regions: only where nothing of them is does the pad rise."""
        tin, (_, reference, area) = self.tin, self.site
        graded = join_surfaces(tin, patch, reference, area, "daylight")
        held = hold(graded, patch, pad.polygon, self.fixed, self.site)
        works = find_area(patch)
        sums, moving = measure_held(tin, held, works, reference.up)
        areas = self.shrink * moving["cut_area"] + moving["fill_area"] + moving["unchanged_area"]
        return self._make_trial(held.surface, sums, areas, (*reference.notes, *held.notes))

    def _make_trial(
        self, surface: TIN, sums: Mapping[str, float], areas: float, notes: tuple[str, ...]
    ) -> Trial:
        rest = sums["cut"] * self.shrink + self.surplus - sums["fill"]
        return Trial(surface, sums, rest, areas * self.site.reference.up, notes)


@product
def balance(
    tin: TIN,
    pad: ArrayLike | Any,
    *,
    cut_slope: float,
    fill_slope: float,
    gradient: tuple[float, float] | None = None,
    shrink_factor: float = 1.0,
    swell_factor: float = 1.0,
    surplus: float = 0.0,
    fixed: Any = None,
    progress: Callable[[float], None] | None = None,
) -> BalancedPad:
    """Find the elevation at which a pad's cut makes its fill, and grade it into the ground.

    Parameters
    ----------
    tin : TIN
        The ground.
    pad : (k, 2) or (k, 3) array, or polygon
        Ring of the pad's edge, as of :func:`tinsmith.grade`; its elevations do not count.
    cut_slope, fill_slope : float
        Side slopes, horizontal over vertical, as of :func:`tinsmith.grade`.
    gradient : tuple of two floats, optional
        Rise of the pad to the east and to the north, vertical over horizontal, as of
        :func:`tinsmith.grade`: its elevation is sought at the centroid. Default level.
    shrink_factor : float, optional
        Volume of compacted fill that a volume of cut makes: 0.9 where a tenth is lost. Default 1.
    swell_factor : float, optional
        Loose volume to haul of a volume of cut, such as 1.25. It does not count in the balance.
        Default 1.
    surplus : float, optional
        Volume of fill that comes from elsewhere, as from parts of the site whose elevations are
        fixed, in CRS units cubed; negative if it is needed there. Default 0.
    fixed : polygons, optional
        Regions that stay as they are, or have levels of their own, as of :func:`tinsmith.grade`.
        What is cut and filled for them and their slopes counts. Default none.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0. What it raises ends the call.

    Returns
    -------
    BalancedPad
        The graded TIN, and a table of elevation, volumes and sensitivity.

    Raises
    ------
    OptionError, LinesError, CrsError
        As :func:`tinsmith.grade`; if a factor is no number above 0.
    PointsError
        If the pad lies off the ground, or the ground ends before slopes meet it at every elevation
        that could balance; if none does, since the balance jumps where slopes begin to reach
        another part of the ground. With fixed regions as :func:`tinsmith.grade`.

    Notes
    -----
    If pad and slopes are raised, the cut falls by its area, and the fill grows by its own: so the
    balance falls, and its derivative is known exactly. Newton's method in a bracket takes some five
    trials, each of which makes and measures the slopes anew, until the balance is 1e-9 of what is
    moved, or trials are 1e-7 of a unit apart.

    Examples
    --------
    >>> import tinsmith as ts
    >>> hill = ts.triangulate([[0, 0, 0], [60, 0, 6], [60, 60, 6], [0, 60, 0]])
    >>> pad = [[25, 25], [35, 25], [35, 35], [25, 35]]
    >>> found = ts.balance(hill, pad, cut_slope=2, fill_slope=2, shrink_factor=0.8)
    >>> found.elevation < 3.0, abs(float(found.table["balance"][0])) < 1e-6
    (True, True)
    """
    done = Progress(progress)
    reference = find_reference(tin, "Slopes")
    slopes = require_slopes(cut_slope, fill_slope)
    shrink = as_number("shrink_factor", shrink_factor, "a factor", above=0)
    swell = as_number("swell_factor", swell_factor, "a factor", above=0)
    extra = as_number("surplus", surplus)
    polygon, _ = read_polygon(pad)
    start = make_pad(polygon, 0.0, gradient, reference.up, *slopes)
    area = find_area(tin)
    require_on_ground(area, polygon)
    start = start._replace(level=_find_mean(tin, start))

    regions, told = read_fixed(fixed, tin, area)
    trials = _Trials(tin, Site(slopes, reference, area), shrink, extra, regions)

    def attempt(level: float) -> Trial:
        return trials.attempt(start._replace(level=level))

    trying = Progress(done.stage(0.0, 0.7))
    least = float(polygon.area) * reference.up * (_LEAST_MOVING if regions else 1.0)
    level, found = _find_root(attempt, start.level, least, trying)
    if regions:
        found = trials.attempt(start._replace(level=level), is_whole=True)
    found = found._replace(notes=(*found.notes, *told))
    graded = found.surface
    if not regions:
        graded = join_surfaces(tin, graded, reference, area, "daylight")
    table = _make_table(level, found, (shrink, swell), reference)
    done.end()
    return BalancedPad(graded, table, tuple(table.notes))


def _find_mean(tin: TIN, pad: Pad) -> float:
    """Return the mean elevation of the ground at the edge of a pad, above its plane at level 0."""
    import shapely

    places = shapely.get_coordinates(shapely.segmentize(pad.polygon, pad.polygon.length / 64))
    return float(np.nanmean(tin.interpolate(places) - pad.measure_heights(places)))


def _find_root(
    attempt: Callable[[float], Trial], level: float, area: float, done: Progress
) -> tuple[float, Trial]:
    """Return the elevation at which a balance that falls is 0, and the trial there.

    ``area`` of the pad is some of the least by which it falls. Raises PointsError if there is none.
    """
    low, high = -np.inf, np.inf  # balances above and below 0, or what the ground does not allow
    found, at = attempt(level), level
    best, lost = (at, found), None
    for number in range(_MOST_TRIALS):
        done(1.0 - 0.5**number)
        if abs(found.balance) <= _ENOUGH * found.moved:
            break
        low, high = (at, high) if found.balance > 0 else (low, at)
        most = float(np.sqrt(area))
        step = found.balance / max(found.slope, 0.5 * area)
        level = at + min(max(step, -most), most)
        if not low < level < high:
            level = 0.5 * (low + high)
        tried = None
        while tried is None and abs(level - at) > (_NEAR if lost is None else _NEAR_LOST):
            try:
                tried = attempt(level)
            except PointsError as error:  # the ground ends before the slopes do: not so far
                lost = error
                low, high = (low, level) if level > at else (level, high)
                level = 0.5 * (level + at)
        if tried is None:
            break
        found, at = tried, level
        if abs(found.balance) < abs(best[1].balance):
            best = (at, found)
    return _accept(*best, lost)


def _accept(level: float, found: Trial, lost: PointsError | None) -> tuple[float, Trial]:
    """Return the best trial, if it is in balance but for what trials are apart."""
    rest = abs(found.balance)
    if rest <= max(_JUMP * found.moved, 2.0 * _NEAR * found.slope):
        return level, found
    if lost is not None:
        raise PointsError(f"No elevation that the ground allows is in balance: {lost}") from lost
    raise PointsError(
        f"No elevation is in balance: at {height(level)} {rest:.6g} cubic units remain, where the "
        "slopes begin to reach another part of the ground."
    )


def _make_table(
    level: float, found: Trial, factors: tuple[float, float], reference: Reference
) -> Table:
    shrink, swell = factors
    volumes, units = found.volumes, reference.units
    cut = volumes["cut"]
    columns = {"elevation": level}
    columns |= {name: volumes[name] for name in _SUMS}
    columns |= {"fill_from_cut": cut * shrink, "balance": found.balance}
    columns |= {"sensitivity": found.slope, "haul": cut * swell}
    volume_unit, unit = units.volume, reference.elevation_unit
    per = f"{volume_unit}/{unit.symbol}" if volume_unit and unit is not None else None
    table_units: dict[str, Any] = dict.fromkeys(("cut", "fill", "fill_from_cut"), volume_unit)
    table_units |= dict.fromkeys(("balance", "haul"), volume_unit)
    table_units |= dict.fromkeys(("cut_area", "fill_area"), units.area)
    table_units |= {"elevation": unit, "sensitivity": per}
    return Table(
        {name: np.array([value]) for name, value in columns.items()},
        units=table_units,
        name="balance",
        notes=list(found.notes),
    )
