"""Areas of cross sections between two surfaces, volumes between sections, and mass haul."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import as_number
from ...base.errors import LinesError
from ...base.georeference import find_axes
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Table
from ...base.sentences import coordinate, counted, inflect
from ..earthwork import volume
from ..surface import find_common_reference
from .axes import as_axis
from .crosswise import as_reaches, cross_sections, place_sections

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int64Array
    from ...tin import TIN
    from .axes import Axis

_SHOWN = 5


@product
def section_volumes(
    ground: TIN,
    design: TIN,
    centreline: Any,
    *,
    interval: float | None = None,
    stations: ArrayLike | None = None,
    width: float | None = None,
    left: float | None = None,
    right: float | None = None,
    start: float = 0.0,
    shrink_factor: float = 1.0,
    swell_factor: float = 1.0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Table:
    """Measure cut and fill along an axis: areas of sections, volumes between them, mass haul.

    Parameters
    ----------
    ground, design : TIN
        The surface as it is, and as it is to be.
    centreline : Alignment, (k, 2) array, Breakline, Features or geometry
        One line, CRS units.
    interval, stations, width, left, right, start
        Where sections are, and how far they reach, as of :func:`tinsmith.cross_sections`.
    shrink_factor : float
        Volume of compacted fill that a volume of cut makes: 0.9 where a tenth is lost.
    swell_factor : float
        Loose volume to haul of a volume of cut, such as 1.25. It does not count in the mass.
    threads : int, optional
        Default every core, where it pays. The result is the same.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0. What it raises ends the call.

    Returns
    -------
    Table
        A row for each section: ``section``, ``station`` (and ``written_station`` with station
        equations); ``cut_area`` and ``fill_area`` of the section; from the section before to this
        one ``cut_volume`` and ``fill_volume``, between both surfaces as they are,
        ``cut_end_area`` and ``fill_end_area``, by the mean of both areas, ``cut_prismoidal`` and
        ``fill_prismoidal``, by Simpson's rule with the section half-way; ``cut_total`` and
        ``fill_total`` from the first section on; ``mass``, the ordinate of mass haul: ``cut_total``
        times ``shrink_factor`` less ``fill_total``; ``loose``, ``cut_total`` times
        ``swell_factor``. Areas and volumes are in the CRS's unit squared and cubed.

    Raises
    ------
    OptionError
        As :func:`tinsmith.cross_sections`, or if a factor is no number above 0.
    LinesError
        If there is not one line, or it meets no surface.
    CrsError
        As :func:`tinsmith.volume`.

    Notes
    -----
    Areas are exact for the surfaces, which are straight from break to break of a section; they
    count where both are. ``cut_volume`` and ``fill_volume`` are those of :func:`tinsmith.volume` in
    the strip that a section sweeps from one station to the next, along chords within 0.001 CRS
    units of a curve: they are what is to be moved, while the other two are what contracts measure.
    Where sections of a sharp bend cross each other there is no such strip: it is NaN, and totals
    count the mean of both areas there.

    Examples
    --------
    >>> import tinsmith as ts
    >>> def square(*z):
    ...     return ts.triangulate([[x, y, h] for (x, y), h in zip(corners, z, strict=True)])
    >>> corners = [(0, 0), (8, 0), (8, 8), (0, 8)]
    >>> table = ts.section_volumes(
    ...     square(5, 5, 5, 5), square(4, 6, 6, 4), [[0, 4], [8, 4]], interval=4, width=2
    ... )
    >>> table["cut_area"], table["fill_area"]
    (array([2., 0., 0.]), array([0., 0., 2.]))
    >>> table["cut_volume"], table["mass"]
    (array([0., 4., 0.]), array([0., 4., 0.]))
    """
    done = Progress(progress)
    factors = [
        as_number(name, value, above=0)
        for name, value in (("shrink_factor", shrink_factor), ("swell_factor", swell_factor))
    ]
    reference, _, _ = find_common_reference(ground, design, "Volumes")
    axis = as_axis(centreline, reference.crs, start, "centreline")
    if len(axis.ends) > 1:
        raise LinesError(f"There are {counted(len(axis.ends), 'centreline')}, and one is needed.")
    places = place_sections(axis, interval, stations)
    reaches = as_reaches(width, left, right)
    at = places.stations
    if len(at) < 2:
        raise LinesError("There is one section only, and volumes lie between two.")
    surfaces = {"ground": ground, "design": design}
    how: dict[str, Any] = {"left": reaches[0], "right": reaches[1], "start": start}
    measured = cross_sections(surfaces, centreline, stations=at, **how)
    done(0.2)
    areas = measure_section_areas(measured, len(at), "difference_design") * reference.up
    half_way = (at[1:] + at[:-1]) / 2.0
    middle = cross_sections(surfaces, centreline, stations=half_way, **how)
    between = measure_section_areas(middle, len(half_way), "difference_design") * reference.up
    done(0.4)
    strips = _sweep(axis, at, reaches)
    exact = _measure_strips((ground, design), strips, threads, done)
    steps = np.diff(at)[:, None]
    end_area = (areas[1:] + areas[:-1]) / 2.0 * steps
    prismoidal = (areas[1:] + 4.0 * between + areas[:-1]) / 6.0 * steps
    totals = np.cumsum(np.where(np.isnan(exact), end_area, exact), axis=0)
    columns: dict[str, Any] = {"section": np.arange(len(at)), "station": at}
    columns |= axis.write_stations(at)
    columns |= _name("area", areas)
    for word, values in (
        ("volume", exact),
        ("end_area", end_area),
        ("prismoidal", prismoidal),
        ("total", totals),
    ):
        columns |= _name(word, np.concatenate([np.zeros((1, 2)), values]))
    columns["mass"] = columns["cut_total"] * factors[0] - columns["fill_total"]
    columns["loose"] = columns["cut_total"] * factors[1]
    done.end()
    return Table(
        columns,
        units=_list_units(columns, reference),
        name="section volumes",
        notes=[
            *reference.notes,
            *measured.notes,
            *_describe_crossings(exact, at),
            *_describe_balance(columns["mass"], at),
        ],
    )


def _name(word: str, values: Float64Array) -> dict[str, Float64Array]:
    return {f"cut_{word}": values[:, 0], f"fill_{word}": values[:, 1]}


def _list_units(columns: dict[str, Any], reference: Any) -> dict[str, Any]:
    length = None if reference.crs is None else reference.crs.horizontal_unit
    units: dict[str, Any] = {name: length for name in columns if name.endswith("station")}
    units |= dict.fromkeys(("cut_area", "fill_area"), reference.units.area)
    volumes = [name for name in columns if name not in units and name != "section"]
    return units | dict.fromkeys(volumes, reference.units.volume)


# ---------------------------------------------------------------- areas


def measure_section_areas(table: Table, count: int, difference: str) -> Float64Array:
    """Return cut and fill of each section, (count, 2), offsets times elevations.

    ``difference`` is the column of how far the other surface is above the first.
    """
    section: Int64Array = table["section"]
    offset, above = table["offset"], table[difference]
    is_step = (np.diff(section) == 0) & np.isfinite(above[1:]) & np.isfinite(above[:-1])
    run, owner = np.diff(offset)[is_step], section[:-1][is_step]
    first, last = above[:-1][is_step], above[1:][is_step]
    areas = np.empty((count, 2))
    for k, sign in enumerate((-1.0, 1.0)):
        one, other = np.maximum(sign * first, 0.0), np.maximum(sign * last, 0.0)
        size = np.abs(first) + np.abs(last)
        # Where the sign changes a triangle is left, whose side is the share of its height.
        is_crossed = np.sign(first) * np.sign(last) < 0.0
        share = np.where(is_crossed, (one + other) / np.where(size > 0.0, size, 1.0), 1.0)
        areas[:, k] = np.bincount(owner, (one + other) / 2.0 * run * share, minlength=count)
    return areas


# ---------------------------------------------------------------- between sections


def _sweep(axis: Axis, at: Float64Array, reaches: tuple[float, float]) -> list[Float64Array]:
    """Return the ring of the strip between every two sections, (k, 2) each."""
    breaks = axis.find_breaks(0)
    is_inner = (breaks > at[0] + axis.rounding) & (breaks < at[-1] - axis.rounding)
    every = np.union1d(at, breaks[is_inner])
    middles, tangents = axis.measure(np.zeros(len(every), np.int64), every)
    side = (1.0, -1.0) if find_axes(axis.crs).are_mirrored else (-1.0, 1.0)
    to_left = tangents[:, ::-1] * side
    edges = middles + reaches[0] * to_left, middles - reaches[1] * to_left
    ends = np.searchsorted(every, at)
    return [
        np.concatenate([edges[0][begin : end + 1], edges[1][begin : end + 1][::-1]])
        for begin, end in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)
    ]


def _measure_strips(
    surfaces: tuple[TIN, TIN], rings: list[Float64Array], threads: int | None, done: Progress
) -> Float64Array:
    """Return cut and fill within each ring, (k, 2); NaN where it crosses itself."""
    shapely = optional.load("shapely")
    is_sound = [bool(shapely.Polygon(ring).is_valid) for ring in rings]
    found = np.full((len(rings), 2), np.nan)
    sound = [ring for ring, one in zip(rings, is_sound, strict=True) if one]
    if sound:
        table = volume(*surfaces, regions=sound, threads=threads, progress=done.stage(0.4, 1.0))
        found[is_sound] = np.column_stack([table["cut"], table["fill"]])
    return found


def _describe_crossings(exact: Float64Array, at: Float64Array) -> list[str]:
    crossed = np.flatnonzero(np.isnan(exact[:, 0]))
    if not len(crossed):
        return []
    first, last = (coordinate(at[crossed[0] + k]) for k in range(2))
    many = f"{len(crossed)} of {len(exact)} strips [crosses itself|cross themselves]"
    many = inflect(many, len(crossed))
    return [
        f"{many} in a bend (first: from station {first} to {last}): totals count the mean of both "
        "areas there."
    ]


def _describe_balance(mass: Float64Array, at: Float64Array) -> list[str]:
    places = find_balanced(mass, at)
    if not len(places):
        return []
    shown = ", ".join(f"{one:.3f}" for one in places[:_SHOWN].tolist())
    more = ", ..." if len(places) > _SHOWN else ""
    return [f"Mass is balanced at the stations {shown}{more}, straight between sections."]


def find_balanced(mass: Float64Array, at: Float64Array) -> Float64Array:
    """Return the stations where cut and fill from the first one on balance.

    Parameters
    ----------
    mass : (n,) float64 array
        Ordinates of mass haul.
    at : (n,) float64 array
        Stations.
    """
    known = np.flatnonzero(mass != 0.0)
    is_crossed = np.sign(mass[known[1:]]) != np.sign(mass[known[:-1]])
    before, after = known[:-1][is_crossed], known[1:][is_crossed]
    first = np.where(after == before + 1, before, before + 1)  # a section where it is 0
    drop = mass[first] - mass[first + 1]
    share = np.where(mass[first] == 0.0, 0.0, mass[first] / np.where(drop == 0.0, 1.0, drop))
    found: Float64Array = at[first] + share * (at[first + 1] - at[first])
    return found
