"""The coordinates of a header, found as a group: columns that are named in one way, side by side.

Easting and northing must be named in one way (Easting, Northing; E, N; X, Y; longitude, latitude)
and of one system ("local"); the elevation is the one beside them. Where that leaves two readings
the header is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from .names import ColumnName, parse_name, shorten

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_FAMILIES = {"word": 0, "letter": 0, "axis": 1, "angle": 2}
"""Of several pairs those are preferred that say where they point, longitudes and latitudes last."""
_COORDINATES = {"easting", "northing", "elevation"}
_PLANE = {"easting", "northing"}


@dataclass(frozen=True, slots=True)
class Group:
    """Columns of one group, and what was assumed or is left open."""

    roles: dict[str, int]
    is_angle: bool = False
    notes: tuple[str, ...] = ()
    refusal: str = ""
    """Why another group may be meant as well; "" if none."""


@dataclass(frozen=True, slots=True)
class _Pair:
    """The columns of an easting and a northing, and of elevations beside them."""

    east: int
    north: int
    name: ColumnName
    own: tuple[int, ...] = ()

    @property
    def family(self) -> int:
        return _FAMILIES[self.name.kind]


def find_plane_pair(header: Sequence[str]) -> tuple[int, int] | None:
    """Return the columns of easting and northing; None unless a header names just one of each."""
    names = [parse_name(name) for name in header]
    pairs = _find_pairs(names)
    named = [name for name in names if name.role in _PLANE and not name.doubt]
    return (pairs[0].east, pairs[0].north) if len(pairs) == 1 and len(named) == 2 else None


def find_group(header: Sequence[str], *, with_doubtful: bool = False) -> Group | None:
    """Find the columns of a header; None if it does not name all coordinates.

    Parameters
    ----------
    header : sequence of str
    with_doubtful : bool, optional
        Whether columns are looked at whose names say something more.
    """
    names = [parse_name(name) for name in header]
    if not {name.role for name in names} >= _COORDINATES:
        return None
    if with_doubtful:
        names = [replace(name, doubt="") for name in names]
    pairs = _find_pairs(names)
    heights = [i for i, name in enumerate(names) if name.role == "elevation" and not name.doubt]
    if not pairs or not heights:
        return None
    pairs = [replace(pair, own=_find_own(pair, pairs, heights, names)) for pair in pairs]
    pair, refusal = _choose_pair(header, names, pairs, heights)
    own = pair.own if len(pairs) > 1 else ()
    z, unsure = _choose_elevation(header, names, pair, own or heights)
    roles = {"easting": pair.east, "northing": pair.north, "elevation": z}
    refusal = _find_repeated(header, names, roles) or refusal or unsure
    refusal = refusal or _find_lone(header, names, pair)
    roles |= _find_others(names, roles)
    notes = (*_note_pairs(header, pair, pairs), *_note_elevations(header, names, z, heights))
    return Group(roles, pair.name.kind == "angle", notes, refusal)


# ------------------------------------------------------------------ pairs


def _find_pairs(names: Sequence[ColumnName]) -> list[_Pair]:
    """Return eastings and northings that are named in one way, each column in one pair."""
    east, north = (
        [i for i, name in enumerate(names) if name.role == role and not name.doubt]
        for role in ("easting", "northing")
    )
    both = [(e, n) for e in east for n in north if _are_partners(names[e], names[n])]
    both.sort(key=lambda pair: abs(pair[0] - pair[1]))
    pairs: list[_Pair] = []
    for e, n in both:
        if not any(e == pair.east or n == pair.north for pair in pairs):
            pairs.append(_Pair(e, n, names[e]))
    return sorted(pairs, key=lambda pair: (pair.family, pair.east))


def _are_partners(east: ColumnName, north: ColumnName) -> bool:
    has_one_unit = not (east.unit and north.unit) or east.unit.casefold() == north.unit.casefold()
    return east.kind == north.kind and east.system == north.system and has_one_unit


def _find_own(
    pair: _Pair, pairs: Iterable[_Pair], heights: Iterable[int], names: Sequence[ColumnName]
) -> tuple[int, ...]:
    """Return the elevations beside a pair, and not behind another.

    That before the pair counts only where there are others, whose order leaves it open.
    """
    heights = [z for z in heights if _are_of_one_system(names[z], pair.name)]
    low, high = sorted((pair.east, pair.north))
    behind = [max(other.east, other.north) + 1 for other in pairs if other is not pair]
    low -= bool(behind)
    return tuple(
        z
        for z in heights
        if (low <= z <= high + 1 and z not in behind) or pair.name.kind == names[z].kind == "axis"
    )


def _choose_pair(
    header: Sequence[str],
    names: Sequence[ColumnName],
    pairs: Sequence[_Pair],
    heights: Sequence[int],
) -> tuple[_Pair, str]:
    """Return the pair to take, and why it may be another."""
    best = [pair for pair in pairs if pair.family == pairs[0].family]
    whole = [pair for pair in best if pair.own]
    if len(pairs) == 1:
        return pairs[0], ""
    is_sure = len(heights) == 1 and names[heights[0]].kind == "sure"
    is_one = len(whole) == 1 and (len(best) == 1 or not whole[0].name.system)
    if is_one or (len(best) == 1 and is_sure):
        return (whole or best)[0], ""
    pair = (whole or best)[0]
    shown = "; ".join(
        ", ".join(f"'{shorten(header[i])}'" for i in sorted((one.east, one.north, *one.own)))
        for one in pairs
    )
    return pair, (
        f"the header names several groups of coordinates ({shown}), and leaves open which is "
        "meant with which elevation: say with the option `columns`."
    )


def _note_pairs(header: Sequence[str], pair: _Pair, pairs: Sequence[_Pair]) -> list[str]:
    return [
        f"The header names two pairs of coordinates: '{shorten(header[pair.east])}' and "
        f"'{shorten(header[pair.north])}' are taken, '{shorten(header[other.east])}' and "
        f"'{shorten(header[other.north])}' are not."
        for other in pairs
        if other is not pair
    ][:1]


# ------------------------------------------------------------------ elevations


def _choose_elevation(
    header: Sequence[str], names: Sequence[ColumnName], pair: _Pair, heights: Sequence[int]
) -> tuple[int, str]:
    """Return the elevation of a pair, and why it may be another."""
    names_sure = [
        i
        for i in heights
        if names[i].kind == "sure" or (names[i].kind == "axis" and pair.own == (i,))
    ]
    left = names_sure or list(heights)
    if len(left) > 1:
        return left[0], _describe_several(header, "elevation", left)
    if not _are_of_one_system(names[left[0]], pair.name):
        return left[0], (
            f"the header gives the elevation ('{shorten(header[left[0]])}') another system than "
            f"the easting ('{shorten(header[pair.east])}'): say with the option `columns` what "
            "the columns are."
        )
    return left[0], ""


def _are_of_one_system(height: ColumnName, pair: ColumnName) -> bool:
    """Whether an elevation may belong to a pair; "ground elevation" names no system."""
    return height.system in ("", "ground", pair.system)


def _note_elevations(
    header: Sequence[str], names: Sequence[ColumnName], z: int, heights: Iterable[int]
) -> list[str]:
    others = [f"'{shorten(header[i])}'" for i in heights if names[i] != names[z]]
    if not others:
        return []
    return [
        f"The header's '{shorten(header[z])}' is taken as the elevation, not {', '.join(others)}."
    ]


# ------------------------------------------------------------------ the rest


def _find_repeated(
    header: Sequence[str], names: Sequence[ColumnName], roles: dict[str, int]
) -> str:
    """Refuse two columns of one name."""
    for role, column in roles.items():
        same = [one for one in names if not one.doubt and _key(one) == _key(names[column])]
        if len(same) > 1:
            return (
                f"the header has {len(same)} columns named '{shorten(header[column])}' for the "
                f"{role}: say with the option `columns` which is meant."
            )
    return ""


def _key(name: ColumnName) -> tuple[str, str, str]:
    return name.role, name.word, name.system


def _find_others(names: Sequence[ColumnName], roles: dict[str, int]) -> dict[str, int]:
    """Return number and description; an N that is no northing is a number."""
    found: dict[str, int] = {}
    for i, name in enumerate(names):
        is_first = name.role not in found or name.rank < names[found[name.role]].rank
        if name.role in ("number", "description") and not name.doubt and is_first:
            found[name.role] = i
    letters = [i for i, name in enumerate(names) if name.word == "n" and i != roles["northing"]]
    if letters and "number" not in found:
        found["number"] = letters[0]
    return found


def _find_lone(header: Sequence[str], names: Sequence[ColumnName], pair: _Pair) -> str:
    """Refuse a northing, or an easting, that stands alone beside another pair: N, E, Northing."""
    if pair.name.kind == "word":
        return ""
    for role, taken in (("easting", pair.east), ("northing", pair.north)):
        lone = [i for i, name in enumerate(names) if name.role == role and name.kind == "word"]
        lone = [i for i in lone if not names[i].doubt and not _has_partner(names, i)]
        if lone:
            return _describe_several(header, role, [taken, lone[0]])
    return ""


def _has_partner(names: Sequence[ColumnName], column: int) -> bool:
    one = names[column]
    return any(
        other.kind == "word" and other.role in {"easting", "northing"} - {one.role}
        for other in names
    )


def _describe_several(header: Sequence[str], role: str, columns: Iterable[int]) -> str:
    shown = ", ".join(f"'{shorten(header[i])}'" for i in columns)
    return (
        f"the header has several columns for the {role} ({shown}): say with the option `columns` "
        "which is meant."
    )
