"""Flowing water in the plane: its polygons, and a centreline where none is given."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError, OptionError, PointsError
from ....base.georeference import require_same_crs
from ....base.sentences import coordinate, counted
from ....tin.building import find_crs
from ....tin.constraints import gather_rings_of_regions
from .centrelines import make_centreline

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ....base.arrays import Float64Array
    from ....base.crs import CRS
    from .centrelines import Centreline

_SHARE = 1e-9
"""Of an area: less of it may lie beyond a surface by rounding."""
_PIECES = 3.0
"""Of the mean width of water: its outline is divided so finely for its medial axis."""
_MOST_PIECES = 20_000
_TRIMMED = 1.0
"""Of the mean width: at its ends the medial axis runs into a corner, and is cut off so far."""


class Waters(NamedTuple):
    """Polygons of water on a surface."""

    shape: Any
    """Of shapely, as far as the surface reaches."""
    whole: Any
    """The polygons as they were given, also beyond the surface."""
    notes: tuple[str, ...]

    @property
    def shore(self) -> Any:
        """The rings as they were given."""
        import shapely

        return shapely.boundary(self.whole)

    @property
    def width(self) -> float:
        """That of a rectangle of the same area and length of the outer shores."""
        import shapely

        outer = shapely.get_exterior_ring(shapely.get_parts(self.shape))
        half = 0.5 * float(shapely.length(outer).sum())
        root = np.sqrt(max(half**2 - 4.0 * self.shape.area, 0.0))
        return float(2.0 * self.shape.area / (half + root))


def read_water(given: Any, crs: CRS | None, area: Any) -> Waters:
    """Return polygons of water, as far as they lie on what a surface covers.

    Raises LinesError, CrsError, OptionError; PointsError if they lie beside the surface.
    """
    import shapely

    is_plain = not hasattr(given, "crs")
    notes = require_same_crs(find_crs(given), crs, "the water", is_plain=is_plain)
    notes += tuple(getattr(given, "notes", ()))
    regions = gather_rings_of_regions(_as_several(given), "water")
    if not regions:
        raise OptionError("water", 0, "1 or more", what="number of water polygons")
    parts = []
    for rings in regions:
        outer, *inner = (ring[:, :2] for ring in rings)
        polygon = shapely.Polygon(outer, inner)
        if not polygon.is_valid or not polygon.area > 0:
            raise LinesError(f"Invalid water: {shapely.is_valid_reason(polygon)}.")
        parts.append(polygon)
    whole = shapely.union_all(parts)
    found = shapely.intersection(whole, area)
    faces = [one for one in shapely.get_parts(found) if one.geom_type == "Polygon"]
    kept = [one for one in faces if one.area > _SHARE * whole.area]
    if not kept:
        x, y = shapely.get_coordinates(whole)[0].tolist()
        raise PointsError(f"The water, at {coordinate(x)} {coordinate(y)}, lies off the surface.")
    beyond = 1.0 - sum(one.area for one in kept) / whole.area
    if beyond > _SHARE:
        notes += (f"{100 * beyond:.3g} % of the water lies beyond the surface, and is left out.",)
    else:
        kept = list(shapely.get_parts(whole))
    return Waters(shapely.multipolygons(kept), whole, notes)


def find_ends(waters: Waters, along: Centreline) -> Float64Array:
    """Return the edges of outer rings, as given, at which the stream goes on, (k, 2, 2).

    The centreline crosses them, or would if it went on straight behind its ends.
    """
    import shapely

    outer = shapely.get_exterior_ring(shapely.get_parts(waters.whole))
    pairs = np.concatenate([_split(shapely.get_coordinates(ring)) for ring in outer])
    tree = shapely.STRtree(shapely.linestrings(pairs))
    found = set(tree.query(along.line, predicate="intersects").tolist())
    reach = float(np.hypot(*np.ptp(pairs.reshape(-1, 2), axis=0)))
    for station in (-reach, along.length + reach):
        end = float(np.clip(station, 0.0, along.length))
        ray = shapely.linestrings(along.places_at(np.array([end, station])))
        hits = tree.query(ray, predicate="intersects")
        start = shapely.points(along.places_at(np.array([end]))[0])
        apart = shapely.distance(shapely.intersection(tree.geometries[hits], ray), start)
        found.update(hits[apart == apart.min(initial=np.inf)].tolist())
    return pairs[sorted(found)]


def _as_several(given: Any) -> Any:
    """Return polygons; one ring or geometry that is given alone as a sequence of one."""
    if hasattr(given, "__geo_interface__") or isinstance(given, dict):
        return [given]
    try:
        is_ring = np.asarray(given, float).ndim == 2
    except (TypeError, ValueError):
        return given
    return [given] if is_ring else given


# ---------------------------------------------------------------- a centreline of polygons


def derive_centreline(waters: Waters, crs: CRS | None) -> Centreline:
    """Return the longest path of the medial axis of one polygon, straight at its ends.

    The medial axis is taken from the Voronoi cells of places along the outline. Raises OptionError
    if there are several polygons, or a polygon has none.
    """
    import shapely

    parts = shapely.get_parts(waters.shape)
    if len(parts) > 1:
        polygons = counted(len(parts), "part")
        raise OptionError("centreline", None, f"a line where the water has {polygons}, as here")
    width = waters.width
    step = max(width / _PIECES, float(parts[0].boundary.length) / _MOST_PIECES)
    outline = shapely.segmentize(shapely.boundary(parts[0]), step)
    places = shapely.multipoints(np.unique(shapely.get_coordinates(outline), axis=0))
    edges = shapely.get_parts(shapely.voronoi_polygons(places, only_edges=True))
    pairs = np.concatenate([_split(shapely.get_coordinates(edge)) for edge in edges])
    water = parts[0]
    shapely.prepare(water)
    pairs = pairs[shapely.contains_properly(water, shapely.linestrings(pairs))]
    path = _find_longest_path(pairs)
    line = shapely.simplify(shapely.linestrings(path), 0.05 * width) if len(path) > 1 else None
    if line is None or line.length < 3.0 * width:
        raise OptionError(
            "centreline", None, "a line where the water is not much longer than wide, as here"
        )
    cut = _TRIMMED * width
    inner = shapely.get_coordinates(_cut(line, cut, float(line.length) - cut))
    points = _prolong(_prolong(inner, water)[::-1], water)[::-1]
    note = (
        f"The centreline is the longest path of the medial axis of the water, {line.length:.6g} "
        "long."
    )
    return make_centreline(np.ascontiguousarray(points), crs, (note,))


def _split(path: Float64Array) -> Float64Array:
    return np.stack([path[:-1], path[1:]], axis=1)


def _cut(line: Any, start: float, end: float) -> Any:
    import shapely
    from shapely.ops import substring

    return shapely.remove_repeated_points(substring(line, start, end), 0.0)


def _prolong(points: Float64Array, water: Any) -> Float64Array:
    """Return a line that goes on straight behind its last vertex, as far as the water does."""
    import shapely

    way = points[-1] - points[-2]
    far = points[-1] + way / np.hypot(*way) * np.sqrt(water.area)
    inside = shapely.intersection(shapely.linestrings([points[-1], far]), water)
    first = min(shapely.get_parts(inside), key=lambda one: one.distance(shapely.points(points[-1])))
    end = shapely.get_coordinates(first)[-1]
    return points if (end == points[-1]).all() else np.vstack([points, end])


def _find_longest_path(pairs: Float64Array) -> Float64Array:
    """Return the vertices of the longest of the shortest paths from one end of a graph."""
    places, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    ends = number.reshape(-1, 2)
    lengths = np.hypot(*(pairs[:, 1] - pairs[:, 0]).T)
    graph: dict[int, list[tuple[int, float]]] = {}
    for (a, b), length in zip(ends.tolist(), lengths.tolist(), strict=True):
        graph.setdefault(a, []).append((b, length))
        graph.setdefault(b, []).append((a, length))
    if not graph:
        return np.empty((0, 2))
    start = next(iter(graph))
    for _ in range(2):
        before = _walk(graph, start)
        farthest = max(before, key=lambda one: before[one][0])
        first, start = start, farthest
    path = [start]
    while path[-1] != first:
        path.append(before[path[-1]][1])
    return places[path]


def _walk(graph: Mapping[int, list[tuple[int, float]]], start: int) -> dict[int, tuple[float, int]]:
    """Return of each vertex that is reached how far it is, and the one before it (Dijkstra)."""
    found: dict[int, tuple[float, int]] = {}
    queue = [(0.0, start, start)]
    while queue:
        far, vertex, before = heapq.heappop(queue)
        if vertex in found:
            continue
        found[vertex] = far, before
        for other, length in graph[vertex]:
            if other not in found:
                heapq.heappush(queue, (far + length, other, vertex))
    return found
