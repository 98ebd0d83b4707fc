"""Templates: the parts of a cross section to either side of the axis, and its side slopes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ....base.checks import as_number
from ....base.errors import OptionError

FACE = 0.001
"""CRS units: how far apart both edges of a vertical face lie."""

_STATION = "station"
_COLUMNS = ("side", "name", "width", "slope", "rise", "ratio", "use")
_SIDES = {"left": ("left",), "right": ("right",), "both": ("left", "right")}
_USES = ("turns", "ditch", "cut", "fill")
STEEPEST = 1.0
"""Slope of a part: a larger number is a percentage that was not divided by 100."""
STEEPNESS = "a rise over width from -1 to 1, such as 0.025 for 2.5 %"


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a cross section: a lane, a shoulder, the face of a kerb, a side of a ditch.

    Attributes
    ----------
    name : str
        Of the breakline at its outer edge.
    width : float
        In the plane, CRS units; 0 of a vertical face.
    slope : float
        Rise outwards over width, from -1 to 1: -0.025 falls by 2.5 % away from the axis. What is
        steeper has a rise.
    rise : float
        By how much it rises outwards besides, in the unit of elevations, negative if it falls.
    turns : bool
        Whether superelevation replaces its slope.

    Raises
    ------
    OptionError
        If one is no such number, or the name is empty.

    Notes
    -----
    A TIN has one elevation at each place: the edges of a vertical face are drawn 0.001 CRS units
    apart, by which what lies farther outwards is moved.

    Examples
    --------
    >>> import tinsmith as ts
    >>> lane, kerb = ts.Part("lane", 3.5, -0.025, turns=True), ts.Part("kerb", 0, rise=0.12)
    >>> lane.rise, kerb.reach
    (0.0, 0.001)
    """

    name: str
    width: float
    slope: float = 0.0
    rise: float = 0.0
    turns: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise OptionError("name", self.name, "the name of a breakline")
        width = as_number("width", self.width)
        if width < 0.0:
            raise OptionError("width", width, "0 or more")
        object.__setattr__(self, "width", width)
        object.__setattr__(self, "rise", as_number("rise", self.rise))
        object.__setattr__(self, "slope", as_number("slope", self.slope))
        if abs(self.slope) > STEEPEST:
            raise OptionError("slope", self.slope, STEEPNESS)

    @property
    def reach(self) -> float:
        """Width as it is drawn, CRS units: of a vertical face 0.001."""
        return max(self.width, FACE) if self.rise else self.width


@dataclass(frozen=True, slots=True)
class Side:
    """A side of a template, from the axis outwards.

    Attributes
    ----------
    parts : sequence of Part
        The first begins at the axis. The side slope begins behind the last.
    cut_slope, fill_slope : float
        Of the side slopes, horizontal over vertical, as of :func:`tinsmith.grade`.
    ditch : sequence of Part
        Between the last part and the side slope of a cut.

    Raises
    ------
    OptionError
        If a slope is no number above 0, two parts have one name, or a part of the ditch falls more
        steeply than the side slope of a fill.

    Examples
    --------
    >>> import tinsmith as ts
    >>> side = ts.Side([ts.Part("lane", 3.5, -0.025)], cut_slope=1.5, fill_slope=2)
    >>> side.width
    3.5
    """

    parts: Sequence[Part]
    cut_slope: float = field(kw_only=True)
    fill_slope: float = field(kw_only=True)
    ditch: Sequence[Part] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        for name in ("parts", "ditch"):
            parts = tuple(getattr(self, name))
            if not all(isinstance(one, Part) for one in parts):
                raise OptionError(name, getattr(self, name), "parts, such as Part('lane', 3.5)")
            object.__setattr__(self, name, parts)
        names = [one.name for one in (*self.parts, *self.ditch)]
        if len(set(names)) < len(names):
            raise OptionError("names of parts", names, "a name of its own for each of a side")
        unit = "(horizontal over vertical: 2 is 2:1)"
        for name in ("cut_slope", "fill_slope"):
            value = as_number(name, getattr(self, name), "a ratio", above=0, unit=unit)
            object.__setattr__(self, name, value)
        for part in self.ditch:
            if part.turns:
                raise OptionError("turns", True, f"False of '{part.name}', a part of a ditch")

    @property
    def width(self) -> float:
        """From the axis to the side slope, CRS units."""
        return math.fsum(one.reach for one in self.parts)


@dataclass(frozen=True, slots=True)
class Template:
    """A cross section that is carried along an axis.

    Attributes
    ----------
    left, right : Side
        Default of the right one: as the left one.

    Raises
    ------
    OptionError
        If a side is none, or neither has a width.

    Examples
    --------
    >>> import tinsmith as ts
    >>> lane = ts.Part("lane", 3.5, -0.025, turns=True)
    >>> road = ts.Template(ts.Side([lane], cut_slope=1.5, fill_slope=2))
    >>> road.right.parts[0].name
    'lane'
    """

    left: Side
    right: Side = None  # type: ignore[assignment]  # as the left one

    def __post_init__(self) -> None:
        if self.right is None:
            object.__setattr__(self, "right", self.left)
        for name in ("left", "right"):
            if not isinstance(getattr(self, name), Side):
                raise OptionError(name, getattr(self, name), "a Side")
        if not self.left.width + self.right.width > 0.0:
            raise OptionError("width", 0.0, "above 0 on one side of the axis at least")

    @classmethod
    def from_table(cls, rows: Iterable[Mapping[str, Any]]) -> Template:
        """Return the template of the rows of a table.

        Parameters
        ----------
        rows : iterable of mappings
            Each with ``side`` ("left", "right", "both"), ``name``, ``width``, ``slope`` and
            ``rise`` of a part, from the axis outwards, as text or numbers; what is missing is 0.
            ``use`` is "turns" of a part whose slope superelevation replaces, "ditch" of one of the
            ditch; "cut" and "fill" mark the side slopes, whose ``ratio`` is horizontal over
            vertical.

        Returns
        -------
        Template

        Raises
        ------
        OptionError
            If a column is none of these, a value none of its kind, or a side lacks its slopes.

        Examples
        --------
        >>> import tinsmith as ts
        >>> lane = {"side": "both", "name": "lane", "width": "3.5", "slope": "-0.025"}
        >>> slopes = [{"side": "both", "use": use, "ratio": 2} for use in ("cut", "fill")]
        >>> ts.Template.from_table([lane, *slopes]).left.cut_slope
        2.0
        """
        parts: dict[str, dict[str, list[Any]]] = {
            side: {"": [], **{use: [] for use in _USES}} for side in _SIDES
        }
        for row in rows:
            named = {str(key).strip(): value for key, value in row.items()}
            if not _is_filled(named.get(_STATION)):
                named.pop(_STATION, None)
            _add_row(parts, named)
        return cls(*(_make_side(side, parts[side]) for side in ("left", "right")))

    @classmethod
    def by_station(cls, rows: Iterable[Mapping[str, Any]]) -> dict[float, Template]:
        """Return the templates of the rows of a table by their stations.

        Parameters
        ----------
        rows : iterable of mappings
            As of :meth:`from_table`, with a ``station`` besides; rows without one belong to the
            templates of all stations.

        Returns
        -------
        dict of float to Template
            By stations in ascending order, CRS units; empty if no row has one.

        Raises
        ------
        OptionError
            If a station is no number, or as :meth:`from_table`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> lanes = [{"station": at, "side": "both", "name": "lane", "width": at} for at in (3, 5)]
        >>> slopes = [{"side": "both", "use": use, "ratio": 2} for use in ("cut", "fill")]
        >>> found = ts.Template.by_station([*lanes, *slopes])
        >>> {station: one.left.width for station, one in found.items()}
        {3.0: 3.0, 5.0: 5.0}
        """
        plain = [{str(key).strip(): value for key, value in row.items()} for row in rows]
        at = [row.pop(_STATION, None) for row in plain]
        given = [_read_number(_STATION, one) if _is_filled(one) else None for one in at]
        pairs = list(zip(given, plain, strict=True))
        return {
            station: cls.from_table(row for own, row in pairs if own in (None, station))
            for station in sorted({one for one in given if one is not None})
        }


def _add_row(parts: dict[str, dict[str, list[Any]]], row: dict[str, Any]) -> None:
    unknown = [key for key in row if key not in _COLUMNS]
    if unknown:
        raise OptionError("column of a template", unknown[0], "one of " + ", ".join(_COLUMNS))
    side, use = (str(row.get(key) or "").strip().lower() for key in ("side", "use"))
    if side not in _SIDES:
        raise OptionError("side", row.get("side"), "left, right or both")
    if use and use not in _USES:
        raise OptionError("use", row.get("use"), "turns, ditch, cut, fill or nothing")
    wanted = ("ratio",) if use in ("cut", "fill") else ("width", "slope", "rise")
    filled = [key for key in ("width", "slope", "rise", "ratio") if _is_filled(row.get(key))]
    lost = [key for key in filled if key not in wanted]
    if lost:
        raise OptionError(lost[0], row[lost[0]], f"empty in a row of {use or 'a part'}")
    numbers = {key: _read_number(key, row[key]) for key in filled}
    for one in _SIDES[side]:
        if wanted == ("ratio",):
            parts[one][use].append(numbers.get("ratio"))
            continue
        name = str(row.get("name") or "").strip()
        part = Part(name, **{"width": 0.0, **numbers}, turns=use == "turns")
        parts[one]["ditch" if use == "ditch" else ""].append(part)


def _is_filled(value: Any) -> bool:
    return value is not None and str(value).strip() != ""


def _read_number(key: str, value: Any) -> float:
    try:
        return as_number(key, float(value))
    except (TypeError, ValueError):
        raise OptionError(key, value, "a number") from None


def _make_side(side: str, found: dict[str, list[Any]]) -> Side:
    ratios = {}
    for use in ("cut", "fill"):
        if len(found[use]) != 1 or found[use][0] is None:
            allowed = f"one row for the {side} side, with its ratio"
            raise OptionError(f"{use} slope", found[use] or None, allowed)
        ratios[f"{use}_slope"] = found[use][0]
    return Side(found[""], ditch=found["ditch"], **ratios)
