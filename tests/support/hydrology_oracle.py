"""Hydrology the plain way: fractions along paths, priority flood by a heap."""

from __future__ import annotations

import heapq
from fractions import Fraction
from itertools import pairwise, zip_longest
from typing import Any, NamedTuple

import numpy as np
import shapely

import tinsmith as ts


def as_fractions(point: Any) -> tuple[Fraction, ...]:
    return tuple(Fraction(value) for value in np.asarray(point).tolist())


def find_gradient(corners: Any) -> tuple[Fraction, Fraction]:
    """Return the rise of a triangle for a unit of easting and of northing."""
    a, b, c = (as_fractions(corner) for corner in corners)
    u, v = ([end - start for start, end in zip(a, other, strict=True)] for other in (b, c))
    area = u[0] * v[1] - u[1] * v[0]
    return (u[2] * v[1] - u[1] * v[2]) / area, (u[0] * v[2] - u[2] * v[0]) / area


def flood(points: np.ndarray, edges: np.ndarray, boundary: set[int]) -> np.ndarray:
    """Return the level to which each vertex fills (priority flood; Barnes, Lehman, Mulla 2014)."""
    around: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    level = np.full(len(points), np.inf)
    heap = [(float(points[v, 2]), v) for v in boundary]
    for z, v in heap:
        level[v] = z
    heapq.heapify(heap)
    while heap:
        z, v = heapq.heappop(heap)
        for w in around[v]:
            if np.isinf(level[w]):
                level[w] = max(z, float(points[w, 2]))
                heapq.heappush(heap, (float(level[w]), w))
    return level


def flood_raster(z: np.ndarray) -> np.ndarray:
    """Return the filled raster, which drains over its edge; cells touch at corners, too."""
    rows, columns = z.shape
    level = np.full(z.shape, np.inf)
    heap = []
    for r in range(rows):
        for c in range(columns):
            if r in (0, rows - 1) or c in (0, columns - 1):
                level[r, c] = z[r, c]
                heap.append((float(z[r, c]), r, c))
    heapq.heapify(heap)
    while heap:
        here, r, c = heapq.heappop(heap)
        for dr in (-1, 0, 1):
            for dc in (-1, 0, 1):
                i, j = r + dr, c + dc
                if 0 <= i < rows and 0 <= j < columns and np.isinf(level[i, j]):
                    level[i, j] = max(here, z[i, j])
                    heapq.heappush(heap, (float(level[i, j]), i, j))
    return level


def require_descent(tin: Any, line: np.ndarray, slack: float) -> None:
    """Refuse a path that rises, or does not run along gradients or edges.

    Parameters
    ----------
    tin : TIN
    line : (n, 3) array
    slack : float
        What rounding may move a place by.
    """
    assert (np.diff(line[:, 2]) <= 0).all(), "a path rises"
    vertices = {tuple(point[:2]): number for number, point in enumerate(tin.points.tolist())}
    for start, end in pairwise(line):
        a, b = vertices.get(tuple(start[:2])), vertices.get(tuple(end[:2]))
        if a is not None and b is not None and tin.is_edge(a, b):
            continue
        step = end[:2] - start[:2]
        middle = (start[:2] + end[:2]) / 2
        triangle = int(tin.locate([middle])[0])
        if triangle < 0:  # a hair outside: it must run along the boundary
            rim = np.flatnonzero((tin.neighbors < 0).any(axis=1)).tolist()
            is_sound = any(lies_on_edge(tin, t, start, end, slack) for t in rim)
        else:
            near = [t for t in (triangle, *tin.neighbors[triangle].tolist()) if t >= 0]
            is_sound = any(fits(tin.points[tin.triangles[t]], step, slack) for t in near)
            is_sound = is_sound or lies_on_edge(tin, triangle, start, end, slack)
        assert is_sound, f"{start} to {end}: not steepest"


def fits(corners: np.ndarray, step: np.ndarray, slack: float) -> bool:
    """Whether a step follows the gradient of a triangle downwards."""
    gradient = np.array([float(value) for value in find_gradient(corners)])
    steepness = np.hypot(*gradient)
    if steepness == 0.0:
        return False
    down = -gradient / steepness
    across = step[0] * down[1] - step[1] * down[0]
    return bool(abs(across) <= slack and step @ down >= -slack)


def lies_on_edge(tin: Any, triangle: int, start: np.ndarray, end: np.ndarray, slack: float) -> bool:
    """Whether a step runs along an edge of a triangle, which is then a channel."""
    corners = tin.points[tin.triangles[triangle]]
    for k in range(3):
        p, q = corners[(k + 1) % 3, :2], corners[(k + 2) % 3, :2]
        along = (q - p) / np.hypot(*(q - p))
        off = [abs((x[0] - p[0]) * along[1] - (x[1] - p[1]) * along[0]) for x in (start, end)]
        if max(off) <= slack:
            return True
    return False


def require_catchments(tin: Any, shares: np.ndarray) -> None:
    """Refuse catchments that do not tile the surface, or that flow paths leave.

    Parameters
    ----------
    tin : TIN
    shares : (k, 2) array
        Of the bounds: places from which paths start, if they are well inside a catchment.
    """
    found = ts.catchments(tin)
    shapes, areas = found.to_shapely(), found.columns["area"]
    assert shapely.is_valid(shapes).all(), "a catchment is not valid"
    assert np.isclose(areas.sum(), tin.area, rtol=1e-9), "catchments do not make up the surface"
    size = np.hypot(*np.ptp(tin.points[:, :2], axis=0))
    assert np.allclose(shapely.area(shapes), areas, rtol=1e-6, atol=1e-9 * size * size), "areas"
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    xy = low + shares * (high - low)
    xy = xy[tin.locate(xy) >= 0]
    if len(xy) == 0:
        return
    paths = ts.flow_path(tin, xy)
    ends = paths.coordinates[paths.offsets[0][1:] - 1]
    for start, how, end in zip(paths.columns["start"], paths.columns["end"], ends, strict=True):
        place = shapely.Point(xy[start])
        inside = np.flatnonzero(shapely.contains(shapes, place))
        assert len(inside) <= 1, f"{xy[start]}: in several catchments"
        if len(inside) == 0 or shapes[inside[0]].boundary.distance(place) < 1e-6 * size:
            continue
        pit, kind = (found.columns[name][inside[0]] for name in ("pit", "end"))
        assert (kind == "boundary") == (how == "boundary"), f"{xy[start]}: {kind}, path: {how}"
        assert pit < 0 or tin.points[pit, 2] == end[2], f"{xy[start]}: not to vertex {pit}"
        alone = np.count_nonzero(tin.points[:, 2] == end[2]) == 1
        assert pit < 0 or not alone or (tin.points[pit] == end).all(), f"{xy[start]}: not {pit}"


# ------------------------------------------------------------------ full depressions


def find_boundary(tin: Any) -> set[int]:
    return {vertex for ring in tin.boundary for vertex in ring.tolist()}


def list_neighbors(tin: Any) -> dict[int, list[int]]:
    around: dict[int, list[int]] = {int(v): [] for v in np.unique(tin.triangles)}
    for a, b in tin.edges.tolist():
        around[a].append(b)
        around[b].append(a)
    return around


def part_ponds(tin: Any, level: np.ndarray) -> dict[int, int]:
    """Return the smallest vertex of the pond that each vertex under water is in."""
    around, pond = list_neighbors(tin), {}
    for first in np.flatnonzero(level > tin.points[:, 2]).tolist():
        stack = [] if first in pond or np.isinf(level[first]) else [first]
        while stack:
            vertex = stack.pop()
            if vertex not in pond:
                pond[vertex] = first
                stack += [w for w in around[vertex] if level[w] > tin.points[w, 2]]
    return pond


def route_on_level(tin: Any, level: np.ndarray) -> tuple[dict[Any, int], dict[int, int]]:
    """Return the steps from dry vertices and ponds to where water descends, and where ponds spill.

    Ponds stand under the key ("pond", their smallest vertex).
    """
    around, pond, rim = list_neighbors(tin), part_ponds(tin, level), find_boundary(tin)
    name = {v: ("pond", pond[v]) if v in pond else v for v in around}
    ways: dict[Any, dict[Any, tuple[Any, ...]]] = {node: {} for node in name.values()}
    for v, others in around.items():
        for w in others:
            if level[v] == level[w] and name[v] != name[w]:
                key = (tin.points[w, 2], *tin.points[w, :2].tolist(), w)
                ways[name[v]][name[w]] = min(key, ways[name[v]].get(name[w], key))
    steps = {
        v: 0
        for v in around
        if v not in pond and (v in rim or any(level[w] < level[v] for w in around[v]))
    }
    queue = list(steps)
    for node in queue:  # grows on the way
        for other in ways[node]:
            if other not in steps:
                steps[other] = steps[node] + 1
                queue.append(other)
    spills = {}
    for first in set(pond.values()):
        node = ("pond", first)
        near = [(key, w) for w, key in ways[node].items() if steps[w] == steps[node] - 1]
        spills[first] = min(near)[1]
    return steps, spills


def require_full_routes(tin: Any, starts: np.ndarray, slack: float) -> None:
    """Refuse paths over full depressions that differ from a priority flood and a plain search."""
    level = flood(tin.points, tin.edges, find_boundary(tin))
    steps, spills = route_on_level(tin, level)
    known = _Known(tin, level, part_ponds(tin, level), steps, spills, slack)
    found = ts.flow_path(tin, starts, fill_depressions=True)
    lines = [found.coordinates[a:b] for a, b in pairwise(found.offsets[0].tolist())]
    vertices = {tuple(point[:2]): number for number, point in enumerate(tin.points.tolist())}
    table = zip(*found.columns.values(), strict=True)
    rows = [dict(zip(found.columns, row, strict=True)) for row in table]
    require_joined(tin, rows, lines, slack)
    for row, line in zip(rows, lines, strict=True):
        places = [vertices.get(tuple(xyz[:2])) for xyz in line.tolist()]
        {"descent": _require_dry, "flat": _require_level, "pond": _require_pond}[row["kind"]](
            known, row, line, places
        )


class _Known(NamedTuple):
    tin: Any
    level: np.ndarray
    pond: dict[int, int]
    steps: dict[Any, int]
    spills: dict[int, int]
    slack: float


def require_joined(tin: Any, rows: list[dict[str, Any]], lines: list[Any], slack: float) -> None:
    """Refuse parts that do not join, and paths that end before the boundary."""
    rings = [tin.points[[*ring, ring[0]], :2] for ring in tin.boundary]
    boundary = shapely.MultiLineString([shapely.LineString(ring) for ring in rings])
    for row, follower in zip_longest(range(len(rows)), range(1, len(rows))):
        if rows[row]["end"] == "boundary":
            assert follower is None or rows[follower]["part"] == 0
            near = shapely.distance(boundary, shapely.Point(lines[row][-1, :2]))
            assert near <= slack, f"{lines[row][-1]}: not at the boundary"
        else:
            assert follower is not None
            assert rows[follower]["start"] == rows[row]["start"], "a path ends on its way"
            assert (lines[follower][0] == lines[row][-1]).all(), "parts do not join"
            assert rows[row]["end"] == rows[follower]["kind"]


def _require_dry(known: _Known, row: dict[str, Any], line: np.ndarray, places: list[Any]) -> None:
    require_descent(known.tin, line, known.slack)
    assert line[0, 2] > line[-1, 2], "no descent"
    wet = [v for v in places if v in known.pond]
    assert not wet, f"{wet}: under water"


def _require_level(known: _Known, row: dict[str, Any], line: np.ndarray, places: list[Any]) -> None:
    assert row["pit"] == -1
    assert (line[:, 2] == line[0, 2]).all()
    assert all(v is not None and v not in known.pond for v in places[1:])
    counts = [known.steps[v] for v in places if v is not None]
    assert (np.diff(counts) == -1).all(), f"{places}: not the shortest"


def _require_pond(known: _Known, row: dict[str, Any], line: np.ndarray, places: list[Any]) -> None:
    first = known.pond[row["pit"]]
    pool = [v for v in known.pond if known.pond[v] == first]
    z = known.tin.points[:, 2]
    assert z[row["pit"]] == z[pool].min()
    assert (line[:, 2] == known.level[first]).all(), "not on the water"
    spill = known.spills[first]
    assert places[-1] == spill, f"{places[-1]}: spills at {spill}"
    assert all(v is None or known.pond.get(v) == first for v in places[1:-1])


def require_full_catchments(tin: Any, shares: np.ndarray) -> None:
    """Refuse catchments over full depressions that do not tile the surface, or that paths leave."""
    found = ts.catchments(tin, fill_depressions=True)
    shapes, areas = found.to_shapely(), found.columns["area"]
    assert shapely.is_valid(shapes).all(), "a catchment is not valid"
    assert np.isclose(areas.sum(), tin.area, rtol=1e-9), "catchments do not make up the surface"
    size = np.hypot(*np.ptp(tin.points[:, :2], axis=0))
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    xy = low + shares * (high - low)
    xy = xy[tin.locate(xy) >= 0]
    if len(xy) == 0:
        return
    paths = ts.flow_path(tin, xy, fill_depressions=True)
    last = paths.columns["end"] == "boundary"
    ends = paths.coordinates[paths.offsets[0][1:] - 1][last]
    vertices = {tuple(point[:2]): number for number, point in enumerate(tin.points.tolist())}
    for start, end in zip(paths.columns["start"][last], ends, strict=True):
        place = shapely.Point(xy[start])
        inside = np.flatnonzero(shapely.contains(shapes, place))
        assert len(inside) <= 1, f"{xy[start]}: in several catchments"
        if len(inside) == 0 or shapes[inside[0]].boundary.distance(place) < 1e-6 * size:
            continue
        vertex, other = found.columns["vertex"][inside[0]], vertices.get(tuple(end[:2]), -1)
        assert vertex == other, f"{xy[start]}: leaves at {other}, not {vertex}"
