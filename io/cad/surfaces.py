"""A TIN of triangles that a drawing holds, with the lines that run along its edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, cast, get_args

import numpy as np

from ...base.policies import LineKind
from ...base.sentences import counted
from ...tin import TIN
from ...tin.constraints import Lines
from ...tin.topology import directed_edges, edge_keys, find_offsets, mark_corners
from ..mesh import add_notes, join_places, make_tin

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.policies import FacePolicy
    from ..mesh import FileReference

_KINDS = get_args(LineKind)
_SAME_PLACE = 1e-6
"""CAD programs write the vertices of surfaces and those of lines with other last digits: at a
millionth of a metre or foot they are the same."""


class Line(NamedTuple):
    """A line or ring of a drawing."""

    coordinates: Float64Array
    """(k, 2) or (k, 3), easting, northing, elevation."""
    kind: str = "hard"
    """A LineKind, "erase", "island" of a hole, or "constrained" for edges that are no line."""
    name: str = ""
    source: int | None = None
    """Of a line of a TIN its number as ``Lines.sources`` has it; default it is counted."""
    polygon: str | None = None
    """What the rings of one polygon share; None for a ring alone."""
    priority: int = 0
    place: str = ""
    """What sentences call a ring; default its kind."""


class Mesh(NamedTuple):
    """Points and triangles, and what is told of them."""

    points: Float64Array
    """(n, 3)."""
    triangles: Int64Array
    """(m, 3)."""
    constrained: BoolArray | None
    """(m, 3)."""
    notes: list[str]


def merge_equal_points(mesh: Mesh) -> Mesh:
    """Make points of the same three coordinates one, and leave out those of no triangle.

    Of equal points the first stays; the order stays too.
    """
    places, numbers = join_places(mesh.points)
    triangles = numbers[mesh.triangles]
    is_used = mark_corners(triangles, len(places))
    notes = list(mesh.notes)
    n_equal = len(mesh.points) - len(places)
    n_unused = len(places) - int(is_used.sum())
    if n_equal:
        have = "point has" if n_equal == 1 else "points have"
        notes.append(f"{n_equal:,} {have} the coordinates of another one, and became one with it.")
    if n_unused:
        notes.append(f"{counted(n_unused, 'point')} of no visible triangle left out.")
    number = np.cumsum(is_used) - 1
    return Mesh(places[is_used], number[triangles], mesh.constrained, notes)


def make_tin_with_lines(
    mesh: Mesh, lines: Sequence[Line], *, reference: FileReference, faces: FacePolicy
) -> TIN:
    """Make a TIN as every mesh does; lines that run along its edges become its lines."""
    tin = make_tin(
        mesh.points,
        mesh.triangles,
        constrained=mesh.constrained,
        reference=reference,
        notes=mesh.notes,
        faces=faces,
    )
    if not lines:
        return tin
    edges = np.stack(directed_edges(tin.triangles), axis=-1)
    keys = edge_keys(edges, len(tin.points))
    known = np.unique(keys)
    vertex_at = _Vertices(tin)
    chains: list[Int64Array] = []
    owners: list[int] = []
    n_partly = 0
    for number, line in enumerate(lines):
        found = _fill_in(tin, vertex_at.find(line.coordinates), known)
        is_edge = _find_edges(found, known, len(tin.points))
        steps = np.diff(np.concatenate([[0], is_edge.astype(np.int8), [0]]))
        starts, ends = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
        runs = [found[a : b + 1] for a, b in zip(starts.tolist(), ends.tolist(), strict=True)]
        chains += runs
        owners += [number] * len(runs)
        n_partly += sum(map(len, runs)) - len(runs) < len(found) - 1
    noted = []
    if n_partly:
        runs_not = "does not run" if n_partly == 1 else "do not run"
        noted.append(
            f"{counted(n_partly, 'line')} of {len(lines):,} {runs_not} along edges of the "
            "triangles all the way: what does not is left out."
        )
    if chains:
        tin = _with_chains(tin, lines, chains, owners, keys)
    return add_notes(tin, noted) if noted else tin


def _with_chains(
    tin: TIN,
    lines: Sequence[Line],
    chains: Sequence[Int64Array],
    owners: Sequence[int],
    keys: Int64Array,
) -> TIN:
    segments = np.concatenate([np.stack([one[:-1], one[1:]], axis=1) for one in chains])
    flags = tin.constrained | np.isin(keys, edge_keys(segments, len(tin.points)))
    # Count lines within breaklines, boundary rings, holes and water, as a TIN does.
    counts: dict[str, int] = {}
    sources = []
    for line in lines:
        kind = "breakline" if line.kind in ("hard", "soft") else line.kind
        count = counts.get(kind, 0)
        sources.append(count if line.source is None else line.source)
        counts[kind] = count + 1
    kept = [(k, chain) for k, chain in zip(owners, chains, strict=True) if lines[k].kind in _KINDS]
    held = Lines(
        vertices=np.concatenate([[], *(chain for _, chain in kept)]).astype(np.int32),
        offsets=find_offsets(len(chain) for _, chain in kept).astype(np.int32),
        kinds=tuple(cast("LineKind", lines[k].kind) for k, _ in kept),
        sources=np.array([sources[k] for k, _ in kept], np.int32),
        names=tuple(lines[k].name for k, _ in kept),
    )
    return tin.replace(constrained=flags, lines=held)


class _Vertices:
    """Vertices by their place in the plane."""

    def __init__(self, tin: TIN) -> None:
        self._tin = tin
        self._order = np.lexsort((tin.points[:, 1], tin.points[:, 0]))
        sorted_xy = tin.points[self._order, :2] + 0.0
        self._keys = sorted_xy[:, 0] + 1j * sorted_xy[:, 1]

    def find(self, coordinates: Float64Array) -> Int64Array:
        """Return the vertex at each place, -1 where there is none."""
        wanted = (coordinates[:, 0] + 0.0) + 1j * (coordinates[:, 1] + 0.0)
        at = np.searchsorted(self._keys, wanted)
        at = np.minimum(at, len(self._keys) - 1)
        found = np.where(self._keys[at] == wanted, self._order[at], -1)
        is_open = found < 0
        if is_open.any():
            found[is_open] = self._find_near(coordinates[is_open, :2])
        return found

    def _find_near(self, xy: Float64Array) -> Int64Array:
        found = np.full(len(xy), -1, np.int64)
        bounds = self._tin.bounds
        low = np.array([bounds.xmin, bounds.ymin]) - _SAME_PLACE
        high = np.array([bounds.xmax, bounds.ymax]) + _SAME_PLACE
        is_near = ((xy >= low) & (xy <= high)).all(axis=1)  # others may be no coordinates at all
        if is_near.any():
            nearest = self._tin.closest_vertex(xy[is_near]).astype(np.int64)
            apart = np.abs(self._tin.points[nearest, :2] - xy[is_near]).max(axis=1)
            found[is_near] = np.where(apart <= _SAME_PLACE, nearest, -1)
        return found


def _fill_in(tin: TIN, vertices: Int64Array, known: Int64Array) -> Int64Array:
    """Return the vertices of a line with those between that lie on its segments.

    Programs put the vertices of a surface where a breakline meets other edges.
    """
    is_edge = _find_edges(vertices, known, len(tin.points))
    pairs = zip(vertices[:-1].tolist(), vertices[1:].tolist(), is_edge.tolist(), strict=True)
    filled = vertices[:1].tolist()
    for a, b, is_there in pairs:
        if not is_there and a >= 0 and b >= 0 and a != b:
            filled += _walk_along(tin, a, b)
        filled.append(b)
    return np.array(filled, np.int64)


def _walk_along(tin: TIN, a: int, b: int) -> list[int]:
    """Return the vertices between two others along edges on the line between; none if it fails."""
    start = tin.points[a, :2]
    way = tin.points[b, :2] - start
    length = float(np.hypot(*way))
    ahead = way / length
    passed: list[int] = []
    here, reached = a, 0.0
    while here != b:
        near = tin.vertex_neighbors(here)
        apart = tin.points[near, :2] - start
        along, aside = apart @ ahead, apart @ np.array([-ahead[1], ahead[0]])
        is_on = (np.abs(aside) <= _SAME_PLACE) & (along > reached) & (along <= length)
        if not is_on.any():
            return []
        step = int(np.argmin(np.where(is_on, along, np.inf)))
        here, reached = int(near[step]), float(along[step])
        passed.append(here)
    return passed[:-1]


def _find_edges(vertices: Int64Array, known: Int64Array, n_points: int) -> BoolArray:
    """Return which segments between vertices, -1 for none, are edges."""
    pairs = np.stack([vertices[:-1], vertices[1:]], axis=1)
    is_edge = (pairs >= 0).all(axis=1) & (pairs[:, 0] != pairs[:, 1])
    keys = edge_keys(np.where(is_edge[:, None], pairs, 0), n_points)
    at = np.minimum(np.searchsorted(known, keys), len(known) - 1)
    found: BoolArray = is_edge & (known[at] == keys)
    return found
