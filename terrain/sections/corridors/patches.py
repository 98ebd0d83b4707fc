"""Patches: bed and side slopes as one surface, with vertical faces at both ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.errors import LinesError
from ....base.sentences import coordinate
from ....tin import TIN, Breakline, triangulate
from ...earthwork.grading import measure_tolerance, outline_patch
from ..profiles import profile
from .templates import FACE

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from .axis import Axis
    from .layouts import Layout
    from .surfaces import CorridorSurface

_NEAR = 4.0
"""Of a face's width: shorter ends have none."""


class _Bed:
    """The bed of a corridor where :mod:`terrain.earthwork.grading` asks for a pad."""

    def __init__(self, surface: CorridorSurface) -> None:
        import shapely

        self.polygon = shapely.orient_polygons(surface.area)
        self._known = {(x, y): z for x, y, z in surface.tin.points.tolist()}
        rings = [shapely.get_coordinates(one) for one in shapely.get_rings(self.polygon)]
        pairs = np.concatenate([np.stack([one[:-1], one[1:]], axis=1) for one in rings])
        heights = [self._known[x, y] for x, y in pairs.reshape(-1, 2).tolist()]
        self._edges = np.dstack([pairs, np.reshape(heights, (-1, 2))])
        self._tree = shapely.STRtree(shapely.linestrings(pairs))

    def measure_heights(self, xy: Float64Array) -> Float64Array:
        """Return elevations at places on its edge, to which some are moved by rounding."""
        import shapely

        start, end = self._edges[self._tree.nearest(shapely.points(xy))].swapaxes(0, 1)
        way = end - start
        share = ((xy - start[:, :2]) * way[:, :2]).sum(axis=1) / (way[:, :2] ** 2).sum(axis=1)
        found = start[:, 2] + np.clip(share, 0.0, 1.0) * way[:, 2]
        known = [self._known.get((x, y), z) for (x, y), z in zip(xy.tolist(), found, strict=True)]
        return np.array(known)


def build_patch(ground: TIN, layout: Layout, road: Axis, tin: TIN, most: float) -> TIN:
    """Return the corridor as a surface of its own, in the unit that was agreed on.

    Raises LinesError if its outline is off the ground by more than ``most``.
    """
    bed: Any = _Bed(layout.bed)
    edges, rings, lines = outline_patch(ground, bed, layout.slopes)
    faces: list[Breakline] = []
    for line, way in _list_ends(layout, road):
        near = 64.0 * measure_tolerance(ground.points)
        rings = [_add_faces(ring, line, way, ground, tolerance=near, faces=faces) for ring in rings]
    hinges = [Breakline(edge, name="hinge", priority=1) for edge in edges]
    made = [*layout.bed.lines, *hinges, *lines, *faces]
    patch = triangulate(
        np.concatenate(rings),
        breaklines=made,
        boundary=rings,
        duplicates="last",
        crs=tin.crs,
        elevation_unit=road.agreed.elevation_unit,
    )
    _require_met(ground, patch, road, most)
    return patch


def _require_met(ground: TIN, patch: TIN, road: Axis, most: float) -> None:
    """Refuse a patch whose outline lies off the ground by more than some height.

    Raises LinesError.
    """
    outline = patch.points[np.unique(np.concatenate(patch.boundary))]
    apart = np.nan_to_num(np.abs(ground.interpolate(outline[:, :2]) - outline[:, 2]))
    worst = int(apart.argmax())
    if apart[worst] <= most:
        return
    x, y = outline[worst, :2].tolist()
    station = road.alignment.stations_of(outline[worst : worst + 1, :2])["station"]
    found = float(road.wrap(station)[0])
    where = "" if np.isnan(found) else f"At station {coordinate(found)} "
    raise LinesError(
        f"{where}{'the' if where else 'The'} corridor does not meet the ground at {coordinate(x)} "
        f"{coordinate(y)}: the axis has to turn less sharply there, or to end elsewhere."
    )


def _list_ends(layout: Layout, road: Axis) -> list[tuple[Any, Float64Array]]:
    """Return both ends as lines of shapely and the ways out; on one line they are one.

    An axis that closes has none.
    """
    import shapely

    if not layout.ends:
        return []
    tangents = road.alignment.tangents_at(np.array(road.span), mean=True)
    ways = [-tangents[0], tangents[1]]
    first, last = layout.ends
    apart = np.abs((last - first[:1]) @ ways[0]).max()
    if float(ways[0] @ ways[1]) > 0.0 and apart <= 0.1 * FACE:
        return [(shapely.multilinestrings([first, last]), ways[0])]
    return [(shapely.linestrings(end), way) for end, way in zip(layout.ends, ways, strict=True)]


def _add_faces(
    ring: Float64Array,
    line: Any,
    way: Float64Array,
    ground: TIN,
    *,
    tolerance: float,
    faces: list[Breakline],
) -> Float64Array:
    """Return a closed ring with a vertical face wherever it runs along an end of the corridor."""
    import shapely

    near = shapely.dwithin(line, shapely.points(ring[:, :2]), tolerance)
    on_end = near[:-1] & near[1:]
    if not on_end.any() or on_end.all():
        return ring
    shift = int(np.flatnonzero(~on_end)[0])
    corners = np.roll(ring[:-1], -shift, axis=0)
    on_end = np.roll(on_end, -shift)
    path: list[Float64Array] = []
    k = 0
    while k < len(corners):
        path.append(corners[k][None])
        stop = k
        while stop < len(corners) and on_end[stop]:
            stop += 1
        if stop > k:
            chain = np.vstack([corners[k:stop], corners[stop % len(corners)][None]])
            path.append(_lay_face(chain, way, ground, faces))
        k = max(stop, k + 1)
    closed = np.concatenate(path)
    return np.vstack([closed, closed[:1]])


def _lay_face(
    chain: Float64Array, way: Float64Array, ground: TIN, faces: list[Breakline]
) -> Float64Array:
    """Return the foot of a face between both ends of a chain, on the ground."""
    along = chain[-1, :2] - chain[0, :2]
    length = float(np.hypot(*along))
    if length <= _NEAR * FACE:
        return chain[1:-1]
    step = FACE * along / length
    start, stop = chain[0, :2] + FACE * way + step, chain[-1, :2] + FACE * way - step
    table = profile(ground, [chain[0, :2], start, stop, chain[-1, :2]])
    found = np.column_stack([table["x"], table["y"], table["elevation"]])
    faces.append(Breakline(chain, name="hinge"))
    return found[1:-1]
