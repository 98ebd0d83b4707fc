"""Proof of a surface in tiles from the outside, one tile in memory at a time.

If all triangles are counter-clockwise, each inner edge has two triangles that see it in opposite
directions, and what is left are the edges of a convex ring, then the triangles cover what the ring
encloses once and nothing else: the sum of the triangles, as a chain, has the boundary of that.
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import CheckError
from .. import _kernel
from ..topology import directed_edges
from .exact_sum import ExactSum, add_doubled_areas

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable

    from ...base.arrays import Float64Array, Int32Array, Int64Array


class TileTriangles(NamedTuple):
    """The triangles of a surface that a tile owns.

    Attributes
    ----------
    tile : hashable
        What it is called in sentences.
    points : (n, 3) float64 array
    numbers : (n,) int64 array
        Of the vertices in the whole surface.
    triangles : (m, 3) int32 array
        Places of their corners among the points, counter-clockwise.
    """

    tile: Hashable
    points: Float64Array
    numbers: Int64Array
    triangles: Int32Array


class TilesProof(NamedTuple):
    """What was counted of a surface without faults.

    Attributes
    ----------
    tiles, vertices, edges, triangles : int
    edges_between : int
        Those whose triangles two tiles own.
    boundary_edges, boundary_rings : int
    area : Fraction
        Exact, CRS units squared.
    """

    tiles: int
    vertices: int
    edges: int
    triangles: int
    edges_between: int
    boundary_edges: int
    boundary_rings: int
    area: Fraction


def check_tiles(
    tiles: Iterable[TileTriangles],
    *,
    hull: Float64Array | None = None,
    area: Fraction | None = None,
) -> TilesProof:
    """Prove that the triangles of tiles are one surface without gaps and overlaps.

    Parameters
    ----------
    tiles : iterable of TileTriangles
        Each is let go before the next one is asked for; the edges between tiles are kept until
        both sides are known.
    hull : (k, 2 or more) float64 array, optional
        The corners of the convex hull of all points: the surface must fill it. Default it may
        have a boundary and holes.
    area : Fraction, optional
        What the surface must have, exactly: that within its boundary and outside its holes.

    Raises
    ------
    CheckError
        At the first fault: the sentence names the tile and the triangle, edge or vertex.
    """
    proof = _Proof()
    for tile in tiles:
        proof.take_up(tile)
    return proof.finish(hull, area)


class _Side(NamedTuple):
    """A half-edge whose other side is not known yet."""

    tile: Hashable
    start: tuple[float, ...]
    end: tuple[float, ...]


class _Proof:
    """Counts, the exact area, and the edges that have one side so far."""

    def __init__(self) -> None:
        self._open: dict[tuple[int, int], _Side] = {}
        self._active: Counter[int] = Counter()
        self._doubled_area = ExactSum()
        self._counts: Counter[str] = Counter()

    def take_up(self, tile: TileTriangles) -> None:
        """Match the edges of a tile with each other, the others with those of other tiles."""
        _require_sound(tile)
        start, end = (part.ravel() for part in directed_edges(tile.triangles))
        is_open = _find_open(tile, start, end)
        add_doubled_areas(self._doubled_area, tile.points, start, end)
        border = np.unique(np.concatenate([start[is_open], end[is_open]]))
        inside = len(np.unique(tile.triangles)) - len(border)
        known = sum(self._active[number] > 0 for number in tile.numbers[border].tolist())
        self._counts["tiles"] += 1
        self._counts["triangles"] += len(tile.triangles)
        self._counts["vertices"] += inside + len(border) - known
        self._counts["edges"] += int(np.count_nonzero(~is_open)) // 2
        self._match(tile, start[is_open], end[is_open])

    def _match(self, tile: TileTriangles, start: Int64Array, end: Int64Array) -> None:
        names = tile.numbers[np.stack([start, end], axis=1)].tolist()
        places = zip(tile.points[start].tolist(), tile.points[end].tolist(), strict=True)
        for (a, b), (here, there) in zip(names, places, strict=True):
            side = _Side(tile.tile, tuple(here), tuple(there))
            other = self._open.pop((b, a), None)
            if other is None:
                self._keep_open((a, b), side)
                continue
            _require_same_places((a, b), side, other)
            self._active.subtract((a, b))
            self._counts["edges_between"] += 1
            self._counts["edges"] += 1
        self._active = +self._active  # without zeros

    def _keep_open(self, edge: tuple[int, int], side: _Side) -> None:
        if edge in self._open:
            raise CheckError(
                f"Tiles {self._open[edge].tile} and {side.tile} both have a triangle left of the "
                f"edge from vertex {edge[0]} to {edge[1]}."
            )
        self._open[edge] = side
        self._active.update(edge)

    def finish(self, hull: Float64Array | None, area: Fraction | None) -> TilesProof:
        """Check the boundary, Euler's number and the area; return the counts."""
        if not self._open:
            raise CheckError("The tiles have no triangles.")
        rings = _walk_rings(self._open)
        if hull is not None:
            _require_hull(self._open, rings, hull)
        counts = self._counts
        counts["boundary_edges"] = len(self._open)
        counts["edges"] += len(self._open)
        self._check_euler(len(rings), is_whole=hull is not None)
        found = self._check_area()
        if area is not None and found != area:
            raise CheckError(
                f"The surface has an area of {float(found):.17g}, and its boundary and holes leave "
                f"{float(area):.17g}."
            )
        return TilesProof(area=found, boundary_rings=len(rings), **dict(_NO_COUNTS | counts))

    def _check_euler(self, rings: int, *, is_whole: bool) -> None:
        """Check V - E + F + rings, which is 2 for each piece of a surface."""
        counts = self._counts
        touches = len(self._open) - len({start for start, _ in self._open})
        total = counts["vertices"] + touches - counts["edges"] + counts["triangles"] + rings
        if total < 2 or total % 2 or (is_whole and total != 2):
            raise CheckError(
                f"Vertices - edges + triangles + boundary rings is {total} over "
                f"{counts['tiles']} tiles: a surface in one piece has 2."
            )

    def _check_area(self) -> Fraction:
        """Compare the areas of all triangles with what the boundary encloses, exactly."""
        sides = list(self._open.values())
        points = np.array([*(side.start for side in sides), *(side.end for side in sides)])
        enclosed = ExactSum()
        at = np.arange(len(sides), dtype=np.int32)
        add_doubled_areas(enclosed, points, at, at + np.int32(len(sides)))
        inside = self._doubled_area.value
        if inside != enclosed.value:
            raise CheckError(
                f"The areas of the triangles add up to {float(inside / 2):.17g}, but the boundary "
                f"encloses {float(enclosed.value / 2):.17g}."
            )
        return inside / 2


_NO_COUNTS: dict[str, Any] = {
    "tiles": 0,
    "vertices": 0,
    "edges": 0,
    "triangles": 0,
    "edges_between": 0,
    "boundary_edges": 0,
}


def _require_sound(tile: TileTriangles) -> None:
    """Require vertices that differ, and triangles that are counter-clockwise, exactly."""
    numbers, count = np.unique(tile.numbers, return_counts=True)
    if (count > 1).any():
        raise CheckError(f"Tile {tile.tile} has vertex {numbers[count > 1][0]} twice.")
    corners = (np.ascontiguousarray(tile.points[tile.triangles[:, k], :2]) for k in range(3))
    wrong = np.flatnonzero(_kernel.orientation(*corners) <= 0)
    if len(wrong):
        a, b, c = tile.numbers[tile.triangles[wrong[0]]].tolist()
        raise CheckError(
            f"Tile {tile.tile} has a triangle that is not counter-clockwise: {a}, {b}, {c}."
        )


def _find_open(tile: TileTriangles, start: Int64Array, end: Int64Array) -> Any:
    """Tell which half-edges of a tile have no other side in it."""
    n = len(tile.points)
    keys = start * n + end
    ascending = np.sort(keys)
    twice = ascending[1:][ascending[1:] == ascending[:-1]]
    if len(twice):
        a, b = tile.numbers[list(divmod(int(twice[0]), n))].tolist()
        raise CheckError(
            f"Tile {tile.tile} has two triangles left of the edge from vertex {a} to {b}."
        )
    wanted = end * n + start
    at = np.minimum(np.searchsorted(ascending, wanted), max(len(ascending) - 1, 0))
    return ascending[at] != wanted


def _require_same_places(edge: tuple[int, int], side: _Side, other: _Side) -> None:
    for number, here, there in (
        (edge[0], side.start, other.end),
        (edge[1], side.end, other.start),
    ):
        if here != there:
            raise CheckError(
                f"Vertex {number} lies at {here} in tile {side.tile}, but at {there} in tile "
                f"{other.tile}."
            )


def _walk_rings(sides: dict[tuple[int, int], _Side]) -> list[list[tuple[int, int]]]:
    """Return the boundary edges ring by ring."""
    leaving: dict[int, list[int]] = {}
    balance: Counter[int] = Counter()
    for start, end in sides:
        leaving.setdefault(start, []).append(end)
        balance[start] += 1
        balance[end] -= 1
    for (start, end), side in sides.items():
        if balance[start] or balance[end]:
            raise CheckError(
                f"The edge from vertex {start} to {end} of tile {side.tile} has no triangle on "
                "its right, and does not belong to a boundary that closes."
            )
    rings = []
    places = {start: side.start for (start, _), side in sides.items()}
    for first in list(leaving):
        while leaving[first]:
            ring = [(first, leaving[first].pop())]
            while ring[-1][1] != first or not _closes(ring, leaving, places):
                ring.append(_find_next(ring[-1], leaving, places))
            rings.append(ring)
    return rings


def _closes(
    ring: list[tuple[int, int]],
    leaving: dict[int, list[int]],
    places: dict[int, tuple[float, ...]],
) -> bool:
    """Tell whether a ring that is back at its first vertex goes on with its first edge."""
    vertex = ring[0][0]
    ends = [ring[0][1], *leaving[vertex]]
    return _find_clockwise(ring[-1][0], vertex, ends, places) == ring[0][1]


def _find_next(
    edge: tuple[int, int],
    leaving: dict[int, list[int]],
    places: dict[int, tuple[float, ...]],
) -> tuple[int, int]:
    """Return the boundary edge behind one, and take it: where several leave, that of the same fan.

    The triangles at the edge lie on its left, so clockwise from it about its end.
    """
    start, vertex = edge
    end = _find_clockwise(start, vertex, leaving[vertex], places)
    leaving[vertex].remove(end)
    return vertex, end


def _find_clockwise(
    start: int, vertex: int, ends: list[int], places: dict[int, tuple[float, ...]]
) -> int:
    """Return the first of some vertices in clockwise turn about a vertex, from one on."""
    if len(ends) == 1:
        return ends[0]
    center = places[vertex]
    found = ends[0]
    for end in ends[1:]:
        halves = [_turn(places[start], center, places[one]) for one in (found, end)]
        is_sooner = halves[0] < halves[1]
        if halves[0] == halves[1]:
            is_sooner = _turn(center, places[found], places[end]) > 0
        found = end if is_sooner else found
    return found


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> int:
    rows = (np.array([one[:2]]) for one in (a, b, c))
    return int(_kernel.orientation(*rows)[0])


def _require_hull(
    sides: dict[tuple[int, int], _Side],
    rings: list[list[tuple[int, int]]],
    hull: Float64Array,
) -> None:
    """Require one ring that turns left or goes straight on, through all corners of the hull."""
    ring = [edge for one in rings for edge in one]
    places = np.array([sides[edge].start[:2] for edge in ring])
    before, after = np.roll(places, 1, axis=0), np.roll(places, -1, axis=0)
    turns = _kernel.orientation(*map(np.ascontiguousarray, (before, places, after)))
    is_first = _is_before(places, before) & _is_before(places, after)
    if (turns < 0).any() or np.count_nonzero(is_first) != 1:
        edge = ring[int(np.argmin(turns))]
        raise CheckError(
            f"The surface does not fill the convex hull: the edge from vertex {edge[0]} to "
            f"{edge[1]} of tile {sides[edge].tile} has no triangle on its right."
        )
    corners = set(map(tuple, places.tolist()))
    for x, y in np.asarray(hull, np.float64)[:, :2].tolist():
        if (x, y) not in corners:
            raise CheckError(f"No tile has the corner of the convex hull at ({x}, {y}).")


def _is_before(one: Float64Array, other: Float64Array) -> Any:
    """Tell which places lie before others, by easting, then northing."""
    is_level = one[:, 0] == other[:, 0]
    return (one[:, 0] < other[:, 0]) | (is_level & (one[:, 1] < other[:, 1]))
