"""The seam of two surfaces, what is cut at it, and the areas that surfaces cover."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.progress import Progress
from ....tin import Breakline
from ....tin.constraints import in_rings
from ....tin.topology import edge_keys
from ....tin.triangulation import mark_illegal_edges

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ....base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ....base.progress import Tell
    from ....tin import TIN

_SHARE = 1e-12
"""Of an area: by so much less it may fill its hull, by rounding."""

_ROUNDINGS = 64.0
"""Of the largest coordinate: places so near to each other are one."""

_BATCH = 256
"""Segments that are cut between two words of how far it is."""


def find_area(tin: TIN) -> Any:
    """Return what a surface covers as a geometry of shapely."""
    return build_area(tin.points, tin.boundary)


def build_area(points: Float64Array, rings: Sequence[AnyArray]) -> Any:
    """Return the area within rings of vertices, which may touch themselves and one another."""
    import shapely

    outlines = [np.ascontiguousarray(points[ring, :2]) for ring in rings]
    lines = [shapely.linearrings(outline) for outline in outlines]
    vertices = np.concatenate(rings)
    if len(np.unique(vertices)) == len(vertices):
        return shapely.build_area(shapely.geometrycollections(lines))
    noded = shapely.get_parts(shapely.union_all(lines))
    faces = shapely.get_parts(shapely.polygonize(noded))
    places = shapely.get_coordinates(shapely.point_on_surface(faces))
    return shapely.coverage_union_all(faces[in_rings(places, outlines) > 0])


def fills_hull(area: Any) -> bool:
    """Tell whether an area is convex but for rounding."""
    import shapely

    return bool(shapely.convex_hull(area).area - area.area <= _SHARE * area.area)


def arrange_rings(
    area: Any, elevations: Mapping[tuple[float, float], float]
) -> dict[str, list[Any]]:
    """Return boundary and holes of an area, in which islands stay, for a triangulation.

    ``elevations`` are those of its vertices, by their places.
    """
    import shapely

    parts = shapely.get_parts(area)
    outer = shapely.get_exterior_ring(parts)
    around = shapely.STRtree(shapely.polygons(outer))
    found = around.query(shapely.point_on_surface(parts), predicate="within")[0]
    is_island = np.bincount(found, minlength=len(parts)) > 1
    inner = [ring for part in parts for ring in part.interiors] + list(outer[is_island])
    rings = [[_lift(ring, elevations) for ring in group] for group in (outer[~is_island], inner)]
    return {"boundary": rings[0], "holes": [rings[1]] if rings[1] else []}


def _lift(ring: Any, elevations: Mapping[tuple[float, float], float]) -> Float64Array:
    return np.array([[x, y, elevations[x, y]] for x, y in ring.coords])


def measure_tolerance(*points: Float64Array) -> float:
    """Return the distance within which places are one."""
    largest = max(float(np.abs(one[:, :2]).max()) for one in points)
    return _ROUNDINGS * float(np.spacing(largest))


def find_first_near(xy: Float64Array, tolerance: float) -> Int64Array:
    """Return for each place the first one that is the same within a tolerance."""
    import shapely

    points = shapely.points(xy)
    pairs = shapely.STRtree(points).query(points, predicate="dwithin", distance=tolerance)
    first = np.arange(len(xy))
    while True:
        least = first.copy()
        np.minimum.at(least, pairs[0], first[pairs[1]])
        if (least == first).all():
            return first
        first = least


def find_sides(triangles: Int32Array, n_vertices: int) -> Int64Array:
    """Return the keys of the edges opposite each corner, (m, 3)."""
    corners = triangles[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)
    return edge_keys(corners, n_vertices).reshape(-1, 3)


class Seam:
    """The closed rings of a patch's boundary, (k, 3) each, to which places are added.

    ``points`` are the patch's vertices, (n, 3), in the unit of the other surface. ``area`` is what
    the patch covers, a polygon of shapely or several; ``rounding`` the area that the roundings of
    the boundary can take away or add.
    """

    def __init__(self, patch: TIN, points: Float64Array, tolerance: float) -> None:
        import shapely

        self._patch, self._points, self._tolerance = patch, points, tolerance
        self._numbers = [np.append(ring, ring[0]) for ring in patch.boundary]
        self.rings = [points[ring] for ring in self._numbers]
        self._pairs = np.concatenate([np.stack([r[:-1], r[1:]], 1) for r in self._numbers])
        self._ends = points[self._pairs]
        self._tree = shapely.STRtree(shapely.linestrings(self._ends[:, :, :2]))
        self.area = build_area(points, patch.boundary)
        shapely.prepare(self.area)
        self.rounding = tolerance * float(self.area.length)
        self._cuts: dict[int, list[tuple[float, Float64Array]]] = {}

    def touches(self, area: Any) -> bool:
        """Tell whether it meets the outline of an area but for rounding."""
        import shapely

        lines = shapely.multilinestrings([shapely.linestrings(ring[:, :2]) for ring in self.rings])
        return bool(shapely.dwithin(shapely.boundary(area), lines, self._tolerance))

    def lie_near(self, area: Any, places: Float64Array) -> BoolArray:
        """Tell which places are in an area but for rounding."""
        import shapely

        shapely.prepare(area)
        is_near: BoolArray = shapely.dwithin(area, shapely.points(places[:, :2]), self._tolerance)
        return is_near

    def find_near(self, xy: Float64Array) -> Int64Array:
        """Return which places lie on the seam but for rounding."""
        import shapely

        places = shapely.points(xy)
        found = self._tree.query(places, predicate="dwithin", distance=self._tolerance)
        return np.unique(found[0])

    def find_crossing(self, ends: Float64Array) -> Int64Array:
        """Return which segments, (k, 2, 2), cross or touch the seam."""
        import shapely

        every = np.concatenate(self.rings)[:, :2]
        low, high = every.min(axis=0) - self._tolerance, every.max(axis=0) + self._tolerance
        near = np.flatnonzero(((ends.max(axis=1) >= low) & (ends.min(axis=1) <= high)).all(axis=1))
        segments = shapely.linestrings(ends[near])
        return np.unique(near[self._tree.query(segments, predicate="intersects")[0]])

    def cut(
        self, ends: Float64Array, is_kept: BoolArray, progress: Tell | None = None
    ) -> list[list[Float64Array]]:
        """Return the parts of segments, (k, 2, 3), outside; their new ends are on the seam."""
        import shapely

        outside = shapely.difference(shapely.linestrings(ends[:, :, :2]), self.area)
        done = Progress(progress)
        found = []
        for left, own, stays in zip(outside, ends, is_kept.tolist(), strict=True):
            there = [part for part in shapely.get_parts(left) if not part.is_empty]
            parts = [shapely.get_coordinates(part)[[0, -1]] for part in there]
            fixed = own[stays]
            off = [part for part in parts if self._is_off(part)]
            ways = [np.array([self._place(xy, fixed) for xy in part]) for part in off]
            found.append([way for way in ways if (way[0, :2] != way[1, :2]).any()])
            if len(found) % _BATCH == 0:
                done(len(found) / len(ends))
        return found

    def _is_off(self, part: Float64Array) -> bool:
        """Whether a part is longer than rounding, and does not run along the seam."""
        is_long = float(np.hypot(*(part[1] - part[0]))) > self._tolerance
        return is_long and not len(self.find_near(part.mean(axis=0)[None]))

    def _place(self, xy: Float64Array, fixed: Float64Array) -> Float64Array:
        """Return the vertex that stays at a place, or else the place on the seam."""
        for vertex in fixed:
            if (vertex[:2] == xy).all():
                return np.asarray(vertex)
        import shapely

        number = int(self._tree.nearest(shapely.Point(xy)))
        a, b = self._ends[number]
        taken = [a, b, *(place for _, place in self._cuts.get(number, ()))]
        for vertex in taken:
            if float(np.hypot(*(vertex[:2] - xy))) <= self._tolerance:
                return np.asarray(vertex)
        share = float((xy - a[:2]) @ (b - a)[:2] / ((b - a)[:2] @ (b - a)[:2]))
        place = np.append(xy, a[2] + share * (b[2] - a[2]))
        self._cuts.setdefault(number, []).append((share, place))
        return place

    def insert_cuts(self) -> None:
        """Put the places at which something is cut into the rings."""
        first = 0
        rings = []
        for ring in self.rings:
            path = [ring[:1]]
            for number in range(first, first + len(ring) - 1):
                between = sorted(self._cuts.get(number, ()), key=lambda one: one[0])
                path += [place[None] for _, place in between]
                path.append(self._ends[number][1:])
            first += len(ring) - 1
            rings.append(np.concatenate(path))
        self.rings = rings

    def list_lines(self) -> Iterator[Breakline]:
        """Yield the lines of the patch, and edges without which its triangles would change."""
        n = len(self._points)
        rim = set(edge_keys(self._pairs, n).tolist())
        lines = self._patch.lines
        for chain, kind, name in zip(lines.chains(), lines.kinds, lines.names, strict=True):
            keys = edge_keys(np.stack([chain[:-1], chain[1:]], axis=1), n).tolist()
            off = [i for i, key in enumerate(keys) if key not in rim]
            shape: Any = "soft" if kind == "soft" else "hard"
            runs = np.split(np.array(off, int), np.flatnonzero(np.diff(off) > 1) + 1)
            for run in filter(len, runs):
                path = self._points[chain[int(run[0]) : int(run[-1]) + 2]]
                yield Breakline(path, kind=shape, name=name)
        own = edge_keys(lines.segments().reshape(-1, 2), n).tolist()
        for key in sorted(self._find_fixed() - rim - set(own)):
            yield Breakline(self._points[list(divmod(key, n))], kind="soft", name="joint")

    def _find_fixed(self) -> set[int]:
        """Return constrained edges, those of triangles at the seam, and those not Delaunay."""
        mesh: Any = self._patch.triangulation
        keys = find_sides(mesh.triangles, len(self._points))
        cut = edge_keys(self._pairs[sorted(self._cuts)].reshape(-1, 2), len(self._points))
        wanted = np.asarray(mesh.constrained | np.isin(keys, cut).any(axis=1, keepdims=True))
        wanted |= mark_illegal_edges(mesh)
        return set(keys[wanted].tolist())
