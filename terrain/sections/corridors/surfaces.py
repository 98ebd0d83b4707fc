"""The surfaces between the lines of a corridor, of its bed or of its side slopes."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError
from ....base.sentences import coordinate
from ....tin import TIN, Breakline, triangulate
from ...earthwork.grading import arrange_rings, find_first_near
from .rays import NEAR

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from .axis import Axis
    from .designs import SideLines
    from .rays import Rays


_LEVEL = 1e-6
"""Elevations that differ by less are the same."""

_SPREAD = 2.0
"""Length of what leads to a lowered end, by how much it is lowered."""


class Rows(NamedTuple):
    """Where lines cross the rays: columns of a side, from its first line outwards."""

    names: dict[int, list[str]]
    """Of the lines of both sides; without one a line is no breakline."""
    side_lines: dict[int, SideLines]
    """Offsets and elevations at all rays, by the side."""


class Fold(NamedTuple):
    """Edges along which a surface was cut off at what is nearer to other stations."""

    stations: Float64Array
    """(n, 2), of the rays that end there."""
    places: Float64Array
    """(n, 2, 2)."""
    steps: Float64Array
    """(n,), by how much both stretches differ there at most, in the unit of elevations."""


class CorridorSurface(NamedTuple):
    """A surface, and what it is made of."""

    tin: TIN
    area: Any
    """What it covers, of shapely."""
    lines: list[Breakline]
    """Its breaklines, soft ones along its rays among them."""
    outer: list[Float64Array]
    """Its outermost lines, (2, 3) each."""
    fold: Fold


def build_surface(
    rays: Rays,
    rows: Rows,
    is_own: Callable[[Float64Array], BoolArray],
    road: Axis,
    *,
    bed: CorridorSurface | None = None,
) -> CorridorSurface | None:
    """Return the surface of lines, or None where it covers nothing.

    A bed lies on both sides of its first line, the axis, side slopes beyond the edge of a ``bed``,
    which they meet. ``is_own`` tells which places belong to it. Raises LinesError if it cannot be
    closed.
    """
    import shapely

    mesh = _Vertices(rays, rows, np.empty((0, 3)) if bed is None else bed.tin.points)
    outline = mesh.list_outer(rays)
    if road.lap is None:
        outline += mesh.list_ends(rays)
    if bed is not None:
        outline += mesh.list_inner(rays)
    outline += mesh.folds
    pairs = np.unique(np.sort(np.array(outline, np.int64).reshape(-1, 2), axis=1), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    if not len(pairs):
        return None
    points = mesh.points
    lines = shapely.linestrings(points[pairs][:, :, :2])
    faces = shapely.get_parts(shapely.polygonize(lines))
    if not len(faces):
        return None
    places = shapely.get_coordinates(shapely.point_on_surface(faces))
    faces = faces[is_own(places)]
    if not len(faces):
        return None
    area = _unite(faces)
    if area is None:
        first = shapely.STRtree(lines).query(lines, predicate="crosses")[0]
        crossed = lines[first[0]] if len(first) else lines[0]
        raise _explain_open(rays, road, shapely.get_coordinates(crossed)[0])
    lost = mesh.find_lost(rays, area)
    if len(lost):
        raise _explain_open(rays, road, lost[0])
    heights = {(x, y): z for x, y, z in points.tolist()}
    breaks = mesh.list_breaklines(rays, rows)
    rings: dict[str, Any] = arrange_rings(area, heights)
    tin = triangulate(points[mesh.used], breaklines=breaks, **rings)
    outer = [points[list(pair)] for pair in mesh.list_outer(rays)]
    return CorridorSurface(tin, area, breaks, outer, mesh.find_fold(rays))


def _unite(faces: Any) -> Any:
    """Return faces as one area, None if they lie over each other."""
    import shapely

    try:
        area = shapely.coverage_union_all(faces)
    except shapely.GEOSException:
        return None
    return area if area.is_valid else None


class _Vertices:
    """The vertices at which lines cross rays, those that are near to each other as one."""

    def __init__(self, rays: Rays, rows: Rows, bed: Float64Array) -> None:
        xyz, owner, column, is_cut = _place_vertices(rays, rows)
        number = find_first_near(xyz[:, :2], NEAR)
        lowest = xyz[:, 2].copy()
        np.minimum.at(lowest, number, xyz[:, 2])
        highest = xyz[:, 2].copy()
        np.maximum.at(highest, number, xyz[:, 2])
        self.points: Float64Array = np.column_stack([xyz[:, :2], lowest])
        self.used = np.unique(number)
        self._steps = highest - lowest
        self._join(bed)
        self._lasts = {side: rows.side_lines[side].offsets.shape[1] - 1 for side in (-1, 1)}
        self._grid = np.full((len(rays.sides), max(self._lasts.values()) + 1), -1)
        self._grid[owner[~is_cut], column[~is_cut]] = number[~is_cut]
        self._cut = np.full(len(rays.sides), -1)
        self._cut[owner[is_cut]] = number[is_cut]
        self._inner = np.full(len(rays.sides), -1)
        self._fold_rays = self._find_folds(rays)
        ends = [(self._find_last(a), self._find_last(b)) for a, b in self._fold_rays.tolist()]
        self._fold_ends: list[tuple[int, int]] = ends
        self.folds = [(a, b) for a, b in ends if a != b]
        self._add_inner(rays, rows)

    def _join(self, bed: Float64Array) -> None:
        """Move vertices onto those of a bed that are there but for rounding."""
        import shapely

        tree = shapely.STRtree(shapely.points(bed[:, :2]))
        places = shapely.points(self.points[:, :2])
        own, other = tree.query_nearest(places, max_distance=NEAR, all_matches=False)
        steps = np.abs(bed[other, 2] - self.points[own, 2])
        self._steps[own] = np.maximum(self._steps[own], steps)
        self.points[own] = bed[other]

    def _add_inner(self, rays: Rays, rows: Rows) -> None:
        """Put vertices on rays with a lowered end, from which on their elevations change."""
        added: list[list[float]] = []
        for ray, side in enumerate(rays.sides.tolist()):
            row = self._list_row(ray)
            if len(row) < 2 or self._steps[row[-1]] <= _LEVEL:
                continue
            offsets = rows.side_lines[side].offsets[ray]
            before = offsets[offsets < rays.limits[ray] - 0.5 * NEAR][-1]
            longest = 0.5 * (rays.limits[ray] - before)
            at = rays.limits[ray] - min(_SPREAD * self._steps[row[-1]], longest)
            if longest > 10.0 * NEAR and rays.limits[ray] - at > 10.0 * NEAR:
                height = np.interp(at, offsets, rows.side_lines[side].rises[ray])
                self._inner[ray] = len(self.points) + len(added)
                added.append([*(rays.origins[ray] + at * rays.ways[ray]), height])
        if added:
            self.used = np.append(self.used, len(self.points) + np.arange(len(added)))
            self._steps = np.append(self._steps, np.zeros(len(added)))
            self.points = np.concatenate([self.points, np.array(added)])

    def _list_line(self, rays: Rays, side: int, line: int) -> list[tuple[int, int]]:
        """Return the edges of a line."""
        first, second = rays.pairs[rays.sides[rays.pairs[:, 0]] == side].T
        a, b = self._grid[first, line], self._grid[second, line]
        kept = (a >= 0) & (b >= 0) & (a != b)
        return list(zip(a[kept].tolist(), b[kept].tolist(), strict=True))

    def list_outer(self, rays: Rays) -> list[tuple[int, int]]:
        """Return the edges of the last lines."""
        return [edge for s in (-1, 1) for edge in self._list_line(rays, s, self._lasts[s])]

    def list_inner(self, rays: Rays) -> list[tuple[int, int]]:
        """Return the edges of the first lines."""
        return [edge for s in (-1, 1) for edge in self._list_line(rays, s, 0)]

    def _list_row(self, ray: int) -> list[int]:
        """Return the vertices of a ray."""
        row = [one for one in self._grid[ray].tolist() if one >= 0]
        cut = int(self._cut[ray])
        row = [*row, cut] if cut >= 0 else row
        inner = int(self._inner[ray])
        row = [*row[:-1], inner, row[-1]] if inner >= 0 else row
        return [one for k, one in enumerate(row) if k == 0 or row[k - 1] != one]

    def list_ends(self, rays: Rays) -> list[tuple[int, int]]:
        """Return the edges of the first and the last ray of both sides."""
        found = []
        for side in (-1, 1):
            own = np.flatnonzero(rays.sides == side)
            for ray in (int(own[0]), int(own[-1])):
                row = self._list_row(ray)
                found += list(itertools.pairwise(row))
        return found

    def _find_folds(self, rays: Rays) -> Int64Array:
        """Return the rays that follow each other and between whose ends the surface is cut off."""
        first, second = rays.pairs.T
        lasts = np.array([self._find_last(ray) for ray in range(len(rays.sides))])
        outer = np.array([self._lasts[side] for side in rays.sides.tolist()])
        is_whole = self._grid[np.arange(len(outer)), outer] >= 0
        either = ~(is_whole[first] & is_whole[second])
        a, b = lasts[first], lasts[second]
        found: Int64Array = rays.pairs[either & (a >= 0) & (b >= 0)]
        return found

    def _find_last(self, ray: int) -> int:
        row = self._list_row(ray)
        return row[-1] if row else -1

    def list_breaklines(self, rays: Rays, rows: Rows) -> list[Breakline]:
        """Return the named lines, and soft ones along rays and folds."""
        import shapely

        found = []
        for side, names in rows.names.items():
            for line, name in enumerate(names):
                edges = self._list_line(rays, side, line) if name else []
                for chain in _chain(edges):
                    found.append(Breakline(self.points[chain], name=name))
        soft = [*self.folds, *self._list_inner_edges(rays)]
        for ray in range(len(rays.sides)):
            row = self._list_row(ray)
            soft += list(itertools.pairwise(row))
        pairs = np.unique(np.sort(np.array(soft, np.int64).reshape(-1, 2), axis=1), axis=0)
        merged = shapely.line_merge(shapely.multilinestrings(list(self.points[pairs])))
        for part in shapely.get_parts(merged):
            path = shapely.get_coordinates(part, include_z=True)
            found.append(Breakline(path, kind="soft", name="section"))
        return found

    def find_lost(self, rays: Rays, area: Any) -> Float64Array:
        """Return middles of rays that an area lacks."""
        import shapely

        rows = [self._list_row(ray) for ray in range(len(rays.sides))]
        ends = np.array([[row[0], row[-1]] for row in rows if len(row) > 1], np.int64)
        middles = self.points[ends.reshape(-1, 2), :2].mean(axis=1)
        shapely.prepare(area)
        is_near = shapely.dwithin(area, shapely.points(middles), 10.0 * NEAR)
        return np.asarray(middles[~is_near])

    def _list_inner_edges(self, rays: Rays) -> list[tuple[int, int]]:
        """Return the edges between vertices from which on elevations change."""
        first, second = rays.pairs.T
        a, b = self._inner[first], self._inner[second]
        kept = (a >= 0) & (b >= 0)
        return list(zip(a[kept].tolist(), b[kept].tolist(), strict=True))

    def find_fold(self, rays: Rays) -> Fold:
        """Return where rays were cut, and where their elevations change for it."""
        own = np.flatnonzero(self._inner >= 0)
        pairs = np.concatenate([self._fold_rays, np.column_stack([own, own])])
        lowered = [(int(self._inner[ray]), self._find_last(ray)) for ray in own.tolist()]
        vertices = np.array([*self._fold_ends, *lowered], np.int64).reshape(-1, 2)
        steps = self._steps[vertices].max(axis=1, initial=0.0)
        return Fold(rays.stations[pairs], self.points[vertices, :2], steps)


def _explain_open(rays: Rays, road: Axis, place: Float64Array) -> LinesError:
    """Return the refusal of a surface that has no outline near a place."""
    middles = rays.origins + 0.5 * rays.limits[:, None] * rays.ways
    near = int(np.hypot(*(middles - place).T).argmin())
    return LinesError(
        f"At station {coordinate(road.wrap(rays.stations)[near])} the corridor cannot be closed "
        "where it meets that of other stations: the axis has to turn less sharply there."
    )


def _place_vertices(
    rays: Rays, rows: Rows
) -> tuple[Float64Array, Int64Array, Int64Array, BoolArray]:
    """Return vertices, their rays and columns, and which are ends of rays that are cut.

    Those come behind all others.
    """
    places, owners, columns = [], [], []
    cuts, cut_owners = [], []
    for side in (-1, 1):
        own = np.flatnonzero(rays.sides == side)
        offsets, heights = (part[own] for part in rows.side_lines[side])
        limits = rays.limits[own]
        row, column = np.nonzero(offsets <= limits[:, None] + 0.5 * NEAR)
        at = offsets[row, column]
        xy = rays.origins[own[row]] + at[:, None] * rays.ways[own[row]]
        places.append(np.column_stack([xy, heights[row, column]]))
        owners.append(own[row])
        columns.append(column)
        is_cut = (limits < offsets[:, -1] - 0.5 * NEAR) & (limits > offsets[:, 0] + 0.5 * NEAR)
        for k in np.flatnonzero(is_cut).tolist():
            height = np.interp(limits[k], offsets[k], heights[k])
            cuts.append([*rays.ends[own[k]], height])
            cut_owners.append(own[k])
        # A ray that ends at a line has its end there.
        at_end = np.abs(at - limits[row]) <= 0.5 * NEAR
        places[-1][at_end, :2] = rays.ends[own[row[at_end]]]
    xyz = np.concatenate([*places, np.array(cuts, np.float64).reshape(-1, 3)])
    count = sum(len(one) for one in owners)
    owner = np.concatenate([*owners, np.array(cut_owners, np.int64)])
    column = np.concatenate([*columns, np.full(len(cuts), 0, np.int64)])
    is_cut = np.arange(len(xyz)) >= count
    return xyz, owner, column, is_cut


def _chain(edges: list[tuple[int, int]]) -> list[list[int]]:
    """Return edges, in order, as chains."""
    chains: list[list[int]] = []
    for a, b in edges:
        if chains and chains[-1][-1] == a:
            chains[-1].append(b)
        else:
            chains.append([a, b])
    return chains
