"""Lines and polygons are cut where they cross the antimeridian: RFC 7946, section 3.1.9.

Where they cross it is found on the straight way in their own CRS, on which elevations are linear.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from ....base import optional
from ....base.errors import WriteError
from ....base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import AnyArray, Float64Array, Int64Array, ObjectArray
    from ....base.results import Kind

DEGREE_DECIMALS = 9  # a tenth of a millimetre on the ground
HALF_TURN, TURN = 180.0, 360.0
_CLOSE = 1.5 * 10.0**-DEGREE_DECIMALS
_MOST_STEPS = 60
"""Of the search of a crossing, which takes about five."""

Between: TypeAlias = "Callable[[Int64Array, Int64Array, Float64Array], Float64Array]"
"""Return longitude, latitude and elevation at shares of the way from some coordinates to others."""


class Pieces(NamedTuple):
    """Features of which none crosses the antimeridian."""

    xyz: Float64Array
    """(n, 3), longitude, latitude, elevation; those of a feature that was cut go on beyond 180."""
    levels: tuple[AnyArray, ...]
    """As :class:`Features` has them."""
    spans: Float64Array
    """(k, 2), westernmost and easternmost longitude of each point, line or ring."""
    cut: dict[int, ObjectArray]
    """The lines or polygons of shapely that a feature, by its number, was cut into."""


def cut_at_antimeridian(
    kind: Kind,
    levels: tuple[AnyArray, ...],
    xyz: Float64Array,
    between: Between,
    *,
    is_geographic: bool,
) -> Pieces:
    """Cut lines and polygons that cross the antimeridian.

    Parameters
    ----------
    kind : {"points", "lines", "polygons"}
    levels : tuple of int arrays
        As :class:`Features` has them.
    xyz : (n, 3) float64 array
        Longitude, latitude, elevation; NaN for one that is not known.
    between : Between
    is_geographic : bool
        Whether their CRS is: a step of more than 180 degrees is then refused.

    Raises
    ------
    WriteError
        If a ring holds a pole, or longitudes do not tell which way a step goes.
    """
    if kind == "points" or len(xyz) == 0 or np.ptp(xyz[:, 0]) <= HALF_TURN:
        return Pieces(xyz, levels, _find_spans(xyz[:, 0], levels), {})
    turned, middles = _unwrap(xyz, kind, levels[0], between, is_geographic=is_geographic)
    rows, crossings = _find_crossings(turned, middles, levels[0], between)
    turned = np.insert(turned, rows + 1, crossings, axis=0)
    levels = (levels[0] + np.searchsorted(rows, levels[0]), *levels[1:])
    spans = _find_spans(turned[:, 0], levels)
    sides = _find_side(spans[:, 1])
    is_cut = spans[:, 0] < TURN * sides - HALF_TURN
    parts = np.flatnonzero(is_cut)
    for offsets in levels[1:]:
        parts = np.unique(np.searchsorted(offsets, parts, side="right") - 1)
    cut_feature = _cut_lines if kind == "lines" else _cut_polygons
    cut = {row: cut_feature(turned, levels, row) for row in np.unique(parts).tolist()}
    turned[:, 0] -= TURN * np.repeat(np.where(is_cut, 0.0, sides), np.diff(levels[0]))
    turned[:, 0] = np.round(turned[:, 0], DEGREE_DECIMALS)
    pieces = np.concatenate([np.empty(0, object), *cut.values()])
    of_pieces = optional.load("shapely").bounds(pieces).reshape(-1, 4)[:, [0, 2]]
    of_others = _find_spans(turned[:, 0], levels)[~is_cut]
    return Pieces(turned, levels, np.concatenate([of_others, of_pieces]), cut)


def find_west_and_east(spans: Float64Array) -> tuple[float, float]:
    """Return the sides of a box around spans of longitudes: west > east across the antimeridian.

    Parameters
    ----------
    spans : (k, 2) float64 array
        Westernmost and easternmost longitude of each.

    Examples
    --------
    >>> find_west_and_east(np.array([[177.0, 180.0], [-180.0, -178.0]]))
    (177.0, -178.0)
    """
    west, east = spans[np.argsort(spans[:, 0], kind="stable")].T
    reached = np.maximum.accumulate(east)
    gaps = west[1:] - reached[:-1]
    widest = int(np.argmax(gaps)) if len(gaps) else 0
    around = TURN - (float(reached[-1]) - float(west[0]))
    if len(gaps) and gaps[widest] > max(around, 0.0) and (gaps[widest] > HALF_TURN or around <= 0):
        return float(west[widest + 1]), float(reached[widest])
    return float(west[0]), float(reached[-1])


def _find_spans(longitudes: Float64Array, levels: Sequence[AnyArray]) -> Float64Array:
    if not levels or len(longitudes) == 0:
        return np.column_stack([longitudes, longitudes])
    starts = levels[0][:-1]
    return np.column_stack(
        [np.minimum.reduceat(longitudes, starts), np.maximum.reduceat(longitudes, starts)]
    )


def _find_side(easternmost: Float64Array) -> Float64Array:
    """Return how often the antimeridian was crossed to the east."""
    return np.asarray(np.ceil((easternmost - HALF_TURN) / TURN))


def _shorten(steps: Float64Array) -> Float64Array:
    return np.asarray((steps + HALF_TURN) % TURN - HALF_TURN)


def _unwrap(
    xyz: Float64Array, kind: Kind, offsets: AnyArray, between: Between, *, is_geographic: bool
) -> tuple[Float64Array, Float64Array]:
    """Let longitudes of lines and rings go on beyond 180; return those halfway to the next too."""
    rows = np.delete(np.arange(len(xyz) - 1), offsets[1:-1] - 1)
    here, there = xyz[rows, 0], xyz[rows + 1, 0]
    middle = between(rows, rows + 1, np.full(len(rows), 0.5))[:, 0]
    half = _shorten(middle - here)
    steps = half + _shorten(there - middle)
    turns = np.zeros(len(xyz), np.int64)
    turns[rows + 1] = np.rint((steps - (there - here)) / TURN)
    turns = np.cumsum(turns)
    turns -= np.repeat(turns[offsets[:-1]], np.diff(offsets))
    wrong = rows[np.abs(steps) > HALF_TURN] if is_geographic else rows[:0]
    if kind == "polygons" and not len(wrong):
        wrong = offsets[1:][turns[offsets[1:] - 1] != 0] - 1
    if len(wrong):
        number = int(np.searchsorted(offsets, wrong[0], side="right")) - 1
        raise WriteError(
            f"Cannot write {FILE}: {'line' if kind == 'lines' else 'ring'} {number} crosses the "
            "antimeridian or holds a pole, and its longitudes do not tell where to cut it: let "
            "them go on beyond 180, or keep the coordinates of the CRS with `projected=True`."
        )
    turned, middles = xyz.copy(), np.zeros(len(xyz))
    turned[:, 0] += TURN * turns
    middles[rows] = turned[rows, 0] + half
    return turned, middles


def _find_crossings(
    xyz: Float64Array, middles: Float64Array, offsets: AnyArray, between: Between
) -> tuple[Int64Array, Float64Array]:
    """Return behind which coordinates the antimeridian is crossed, and where.

    Each way is gone from west to east, so that the two triangles of an edge have the same place.
    """
    ends = np.stack([xyz[:-1, 0], xyz[1:, 0]])
    limits = TURN * np.floor((ends.min(axis=0) + HALF_TURN) / TURN) + HALF_TURN
    is_crossed = limits < ends.max(axis=0)
    is_crossed[offsets[1:-1] - 1] = False
    rows = np.flatnonzero(is_crossed)
    is_east = xyz[rows, 0] < xyz[rows + 1, 0]
    west, east = np.where(is_east, rows, rows + 1), np.where(is_east, rows + 1, rows)
    limit, middle = limits[rows], middles[rows]
    # Secants that keep the crossing between both ends, the method of Illinois; a way of more than
    # 180 degrees is halved before.
    is_late = middle < limit
    a, b = np.where(is_late, 0.5, 0.0), np.where(is_late, 1.0, 0.5)
    of_a = np.where(is_late, middle, xyz[west, 0]) - limit
    of_b = np.where(is_late, xyz[east, 0], middle) - limit
    found = np.empty((len(rows), 3))
    for _ in range(_MOST_STEPS if len(rows) else 0):
        share = (a * of_b - b * of_a) / (of_b - of_a)
        found = between(west, east, share)
        of_share = found[:, 0] % TURN - HALF_TURN
        if (np.abs(of_share) <= _CLOSE).all():
            break
        is_same = np.sign(of_share) == np.sign(of_b)
        a, of_a = np.where(is_same, a, b), np.where(is_same, of_a / 2.0, of_b)
        b, of_b = share, of_share
    found[:, 0] = limit
    return rows, found


# ------------------------------------------------------------------------------ cutting


def _cut_lines(xyz: Float64Array, levels: tuple[AnyArray, ...], row: int) -> ObjectArray:
    shapely = optional.load("shapely")
    first, last = (row, row + 1) if len(levels) == 1 else levels[1][row : row + 2].tolist()
    return np.array(
        [
            shapely.LineString(_move_home(piece))
            for number in range(first, last)
            for piece in _split_line(xyz[slice(*levels[0][number : number + 2])])
        ],
        object,
    )


def _split_line(xyz: Float64Array) -> list[Float64Array]:
    """Return the parts of a line between crossings, which are vertices of it already."""
    sides = np.floor(((xyz[:-1, 0] + xyz[1:, 0]) / 2 + HALF_TURN) / TURN)
    ends = (xyz[:, 0] + HALF_TURN) % TURN == 0
    along = np.flatnonzero(ends[:-1] & ends[1:] & (np.diff(xyz[:, 0]) == 0))
    for k in along.tolist():  # along the antimeridian: on the side on which it came
        sides[k] = sides[k - 1] if k else sides[k]
    splits = np.flatnonzero(np.diff(sides)) + 1
    return [xyz[a : b + 1] for a, b in zip([0, *splits], [*splits, len(xyz) - 1], strict=True)]


def _cut_polygons(xyz: Float64Array, levels: tuple[AnyArray, ...], row: int) -> ObjectArray:
    shapely = optional.load("shapely")
    first, last = (row, row + 1) if len(levels) == 2 else levels[2][row : row + 2].tolist()
    pieces: list[object] = []
    for number in range(first, last):
        rings = [
            xyz[slice(*levels[0][ring : ring + 2])]
            for ring in range(*levels[1][number : number + 2])
        ]
        pieces += _cut_polygon(rings)
    turned: ObjectArray = shapely.orient_polygons(np.array(pieces, object))
    return turned


def _cut_polygon(rings: list[Float64Array]) -> list[object]:
    shapely = optional.load("shapely")
    outer, *holes = rings
    low = outer[:, 0].min()
    # Holes are in the turn of their polygon.
    turns = [TURN * np.ceil((low - hole[:, 0].min()) / TURN) for hole in holes]
    holes = [hole + np.array([turn, 0, 0]) for hole, turn in zip(holes, turns, strict=True)]
    on_limit = np.flatnonzero((outer[:-1, 0] + HALF_TURN) % TURN == 0)
    if not holes and len(on_limit) == 2:  # one cut: nothing can go wrong
        i, j = on_limit.tolist()
        pieces = [
            outer[[*range(i, j + 1), i]],
            outer[[*range(j, len(outer) - 1), *range(i + 1), j]],
        ]
        return [shapely.Polygon(_move_home(piece)) for piece in pieces if len(piece) > 3]
    whole = shapely.Polygon(outer, holes)
    found = []
    for side in range(int(_find_side(low)), int(_find_side(outer[:, 0].max())) + 1):
        west = TURN * side - HALF_TURN
        part = shapely.intersection(whole, shapely.box(west, -90.0, west + TURN, 90.0))
        found += [one for one in shapely.get_parts(part) if one.geom_type == "Polygon"]
    return [shapely.transform(one, _move_home, include_z=True) for one in found]


def _move_home(xyz: Float64Array) -> Float64Array:
    """Return a piece between -180 and 180."""
    side = _find_side(xyz[:, 0].max())
    moved = xyz.copy()
    moved[:, 0] = np.round(moved[:, 0] - TURN * side, DEGREE_DECIMALS)
    return moved
