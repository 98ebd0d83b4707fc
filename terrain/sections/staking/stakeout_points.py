"""Stakeout: design heights, cut and fill, stations and offsets at points that are set out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import require_type
from ....base.crs import Unit, assume_elevation_unit
from ....base.errors import OptionError
from ....base.georeference import agree, find_axes, require_same_crs
from ....base.products import product
from ....base.results import Features, Table
from ....base.sentences import counted, inflect
from ...surface import find_reference
from ..alignments import Alignment
from .factors import CombinedFactor
from .places import Stakes, place_along, take_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from ....base.arrays import Float64Array
    from ....base.crs import CRS, UnitLike
    from ....tin import TIN

_SHOWN = 20
_LETTERS = {
    "P": "point",
    "N": "northing",
    "E": "easting",
    "Z": "elevation",
    "D": "description",
    "G": "ground",
    "C": "cut",
    "F": "fill",
    "S": "station",
    "O": "offset",
    "R": "reason",
}
_HEIGHTS = ("elevation", "ground", "cut", "fill")
_OUTSIDE = "outside the design"
_NO_GROUND = "outside the ground"
_NO_STATION = "before the start or beyond the end of the alignment"


@product
def stakeout(
    design: TIN,
    points: Any = None,
    *,
    ground: TIN | None = None,
    alignment: Alignment | None = None,
    stations: ArrayLike | None = None,
    interval: float | None = None,
    offsets: ArrayLike = 0.0,
    layout: str | None = None,
    unit: UnitLike | None = None,
    factor: CombinedFactor | None = None,
) -> Table:
    """List points to set out: design elevations, cut and fill, stations and offsets.

    Parameters
    ----------
    design : TIN
        The surface as it is to be.
    points : Survey, Features or (n, 2) or (n, 3) array, optional
        Where to set out, CRS units. Numbers and descriptions are those of a survey, or columns of
        these names, else points are numbered from 1. Elevations of their own do not count.
    ground : TIN, optional
        The surface as it is, for cut and fill.
    alignment : Alignment, optional
        For stations and offsets, or to set out points along it.
    stations : (k,) array, optional
        Instead of ``points``: lengths along the alignment, CRS units.
    interval : float, optional
        Instead of ``stations``: at its multiples, and where elements meet, CRS units.
    offsets : float or (m,) array, optional
        At each station, to the right, negative to the left, CRS units.
    layout : str, optional
        Columns in their order by letters, such as "PNEZD" or "PENZD": P point, N northing, E
        easting, Z elevation, D description, G ground, C cut, F fill, S station, O offset, R reason.
        Default all that are known.
    unit : Unit or str, optional
        Of all lengths of the list; default those of the CRS and of the surface.
    factor : CombinedFactor, optional
        List coordinates on the ground instead of the grid. Stations and offsets are those of the
        grid all the same: bring the design and the alignment to the ground for others.

    Returns
    -------
    Table
        A row for each point, in their order: ``point`` (its number, a text), ``easting`` and
        ``northing`` (or how the axes of the CRS are called), ``elevation`` of the design; with a
        ground ``ground``, ``cut`` where it is above the design and ``fill`` where it is below, both
        0 or more; with an alignment ``station`` (``written_station`` with equations) and
        ``offset``; ``description``; ``reason``, why an elevation or a station is NaN, None where
        nothing is.

    Raises
    ------
    OptionError
        If there are neither points nor stations, or both; a station lies off the alignment; a
        letter of the layout is none, occurs twice, or is not known; the unit is none, or that of
        the CRS is not known.
    PointsError
        If there is no point, or one is not finite.
    CrsError
        If CRSs differ, or coordinates are angles.

    Notes
    -----
    Elevations are those of the triangles. No point is left out: one outside the design has no
    elevation, and is named in a note with the reason.

    Examples
    --------
    >>> import tinsmith as ts
    >>> def square(z):
    ...     return ts.triangulate([[0, 0, z], [8, 0, z], [8, 8, z], [0, 8, z]])
    >>> table = ts.stakeout(square(5.0), [[2.0, 3.0], [9.0, 3.0]], ground=square(6.5))
    >>> table["point"].tolist(), table["elevation"], table["cut"]
    (['1', '2'], array([ 5., nan]), array([1.5, nan]))
    >>> table["reason"].tolist()
    [None, 'outside the design; outside the ground']
    """
    reference = find_reference(design, "Stakeout")
    surfaces = [design] if ground is None else [design, ground]
    agreed = agree(surfaces, ("the design", "the ground")[: len(surfaces)])
    require_type("alignment", alignment, Alignment, or_none=True)
    require_type("factor", factor, CombinedFactor, or_none=True)
    notes = [*agreed.notes]
    if alignment is not None:
        notes += require_same_crs(alignment.crs, design.crs, "the alignment")
    stakes = _place(
        points,
        alignment,
        stations=stations,
        interval=interval,
        offsets=offsets,
        crs=design.crs,
    )
    names = [f"{axis}ing" for axis in (find_axes(design.crs).first, find_axes(design.crs).second)]
    coordinates = _choose_coordinates(stakes.xy, factor, design.crs)
    columns: dict[str, Any] = {"point": stakes.numbers}
    columns |= dict(zip(names, coordinates.T, strict=True))
    columns |= _measure_heights(stakes.xy, surfaces, agreed.factors)
    columns |= stakes.along
    if any(stakes.descriptions):
        columns["description"] = stakes.descriptions
    columns["reason"] = _find_reasons(columns)
    along = None if reference.crs is None else reference.crs.horizontal_unit
    texts = ("point", "description", "reason")
    height_unit = assume_elevation_unit(reference.crs, agreed.elevation_unit)
    units = {
        name: height_unit if name in _HEIGHTS else along for name in columns if name not in texts
    }
    if unit is not None:
        columns, units = _convert(columns, units, Unit.of(unit), design.crs)
    notes += [*stakes.notes, *_describe_missing(columns), *_describe_coordinates(factor)]
    name = "stakeout"
    if layout is not None:
        columns = _lay_out(columns, layout, names)
        name = f"stakeout {layout.upper()}"
    kept = {name: one for name, one in units.items() if name in columns}
    return Table(columns, units=kept, name=name, notes=notes)


def stake_points(table: Table, *, crs: Any = None) -> Features:
    """Return a list of points to set out as points, for drawings and layers.

    Parameters
    ----------
    table : Table
        As :func:`tinsmith.stakeout` returns it without a layout.
    crs : CRS, str, int or pyproj.CRS, optional
        Of its coordinates: of the design, or ``ground_crs`` of the factor.

    Returns
    -------
    Features
        Points at the elevations of the design, NaN where there is none, with the columns ``number``
        and ``description``, ``cut_fill`` ("C 0.350" or "F 1.200", None where it is not known), and
        the others of the table.

    Raises
    ------
    OptionError
        If it is no such table, or its lengths are in another unit than the CRS's.

    Examples
    --------
    >>> import tinsmith as ts
    >>> design = ts.triangulate([[0, 0, 5], [8, 0, 5], [8, 8, 5], [0, 8, 5]])
    >>> stakes = ts.stake_points(ts.stakeout(design, [[2.0, 3.0]]))
    >>> stakes.coordinates, stakes.columns["number"].tolist()
    (array([[2., 3., 5.]]), ['1'])
    """
    require_type("table", table, Table)
    names = list(table.columns)
    if names[:1] != ["point"] or names[3:4] != ["elevation"] or table.name != "stakeout":
        raise OptionError("table", table, "one of stakeout, without a layout")
    given = None if crs is None else Features.of_points(np.zeros((0, 2)), crs=crs).crs
    unit = table.units.get(names[1])
    if given is not None and unit is not None and unit != given.horizontal_unit:
        allowed = f"{given.horizontal_unit.name}, that of the CRS"
        raise OptionError("unit", str(unit), allowed)
    columns: dict[str, Any] = {"number": table["point"]}
    if "description" in table.columns:
        columns["description"] = table["description"]
    if "cut" in table.columns:
        columns["cut_fill"] = _write_cut_fill(table["cut"], table["fill"])
    columns |= {name: table[name] for name in names[4:] if name not in columns}
    height_unit = table.units.get("elevation")
    return Features.of_points(
        np.column_stack([table[name] for name in names[1:4]]),
        columns=columns,
        units={name: one for name, one in table.units.items() if name in columns},
        crs=given,
        elevation_unit=height_unit if isinstance(height_unit, Unit) else None,
        name="stakeout",
        notes=table.notes,
    )


# ---------------------------------------------------------------- where


def _place(
    points: Any,
    alignment: Alignment | None,
    *,
    stations: Any,
    interval: float | None,
    offsets: Any,
    crs: CRS | None,
) -> Stakes:
    ways = [points is not None, stations is not None, interval is not None]
    if sum(ways) != 1:
        given = [
            name for name, one in zip(("points", "stations", "interval"), ways, strict=True) if one
        ]
        raise OptionError("points", given, "one of points, stations and interval")
    if points is not None:
        return take_points(points, alignment, crs)
    if alignment is None:
        raise OptionError("alignment", None, "an Alignment, along which stations are")
    return place_along(alignment, stations, interval, offsets)


def _choose_coordinates(
    xy: Float64Array, factor: CombinedFactor | None, crs: CRS | None
) -> Float64Array:
    if factor is None:
        return xy
    places = Features.of_points(xy, crs=crs)
    return factor.to_ground(places).coordinates


# ---------------------------------------------------------------- what is listed


def _measure_heights(
    xy: Float64Array, surfaces: Sequence[TIN], factors: Sequence[float]
) -> dict[str, Float64Array]:
    found = [
        one.interpolate(xy) * factor
        for one, factor in zip(surfaces, factors[: len(surfaces)], strict=True)
    ]
    columns = {"elevation": found[0]}
    if len(found) > 1:
        above = found[1] - found[0]
        columns["ground"] = found[1]
        columns["cut"] = np.maximum(above, 0.0) + 0.0  # no -0
        columns["fill"] = np.maximum(-above, 0.0) + 0.0
    return columns


def _find_reasons(columns: dict[str, Any]) -> Any:
    """Return why numbers are missing, (n,) texts, None where none is."""
    reasons: list[list[str]] = [[] for _ in columns["point"]]
    words = {"elevation": _OUTSIDE, "ground": _NO_GROUND, "station": _NO_STATION}
    for name, word in words.items():
        for row in np.flatnonzero(np.isnan(columns.get(name, np.zeros(0)))).tolist():
            reasons[row].append(word)
    texts = np.empty(len(reasons), object)
    texts[:] = ["; ".join(one) or None for one in reasons]
    return texts


def _convert(
    columns: dict[str, Any], units: dict[str, Any], unit: Unit, crs: CRS | None
) -> tuple[dict[str, Any], dict[str, Any]]:
    made = dict(columns)
    for name, own in units.items():
        if own is None or own.metres is None:
            known = "known" if crs is None else "known as a length"
            allowed = f"None, where the unit of the CRS is not {known}"
            raise OptionError("unit", unit.name, allowed)
        made[name] = columns[name] * (1.0 if own == unit else own.metres / unit.metres)
    return made, dict.fromkeys(units, unit)


def _lay_out(columns: dict[str, Any], layout: str, axes: Sequence[str]) -> dict[str, Any]:
    """Return the columns of a layout, in its order."""
    letters = layout.upper() if isinstance(layout, str) else ""
    if not letters or set(letters) - set(_LETTERS) or len(set(letters)) < len(letters):
        allowed = f"letters of {''.join(_LETTERS)}, each once, such as 'PNEZD'"
        raise OptionError("layout", layout, allowed)
    named = _LETTERS | {"E": axes[0], "N": axes[1]}
    known = dict(columns)
    known.setdefault("description", np.array([""] * len(columns["point"]), object))
    missing = [one for one in letters if named[one] not in known]
    if missing:
        needed = "a ground" if missing[0] in "GCF" else "an alignment"
        allowed = f"one without '{missing[0]}', which needs {needed}"
        raise OptionError("layout", layout, allowed)
    made = {}
    for one in letters:
        made[named[one]] = known[named[one]]
        if one == "S" and "written_station" in known:
            made["written_station"] = known["written_station"]
    return made


def _write_cut_fill(cut: Float64Array, fill: Float64Array) -> Any:
    texts = np.empty(len(cut), object)
    texts[:] = [
        None if one != one else f"C {one:.3f}" if one > 0.0 else f"F {other:.3f}"
        for one, other in zip(cut.tolist(), fill.tolist(), strict=True)
    ]
    return texts


# ---------------------------------------------------------------- what is told


def _describe_missing(columns: dict[str, Any]) -> list[str]:
    notes = []
    reasons = columns["reason"]
    for reason in dict.fromkeys(one for one in reasons.tolist() if one is not None):
        lost = np.flatnonzero(reasons == reason)
        names = ", ".join(str(one) for one in columns["point"][lost[:_SHOWN]].tolist())
        more = ", ..." if len(lost) > _SHOWN else ""
        are = inflect(f"{len(lost)} of {counted(len(reasons), 'point')} [is|are]", len(lost))
        notes.append(f"{are} {reason}: {names}{more}.")
    return notes


def _describe_coordinates(factor: CombinedFactor | None) -> list[str]:
    if factor is None:
        return []
    return [
        f"Coordinates are on the ground, by the combined factor {factor.combined:.10g}; stations "
        "and offsets are lengths of the grid.",
        *factor.notes,
    ]
