r"""Lines without elevations on a surface that is never in memory as a whole.

Where such lines run, the triangles that they meet tell all: where edges are crossed, and how high.
Each task gives those of its tile. Together with the convex hull they are completed to a surface,
on which lines are draped as on the whole::

    +-----------------+       triangles of the whole along a line, and others that fill the hull:
    |  `.   __.--'/\  |       no edge of a triangle of the whole is crossed by one, for all of
    |   _'.'--__-/--\\.|       them are segments of the triangulation that completes them
    |.-'         `.   |
    +-----------------+
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.sentences import counted
from .. import _kernel
from ..building import find_ring_groups
from ..constraints import (
    Clip,
    LineSet,
    Polylines,
    Pslg,
    build_mesh,
    cut_at_boundary,
    drape,
)
from ..topology import boundary_rings, directed_edges, find_offsets
from ..triangulation import Triangulation
from .lines import gather_lines, let_meet, node_lines
from .rings import Rings
from .skeleton import reduce_to_hull
from .sources import NumberedPoints

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..building import BuildInputs
    from ..constraints import CutLines
    from .lines import MeetingLines, NodedLines


class KnownTriangles(NamedTuple):
    """Some triangles of the whole surface: ``points`` (n, 3), ``triangles`` (m, 3)."""

    points: Float64Array
    triangles: Int32Array


class LaidLines(NamedTuple):
    """Lines of which all have elevations now.

    Attributes
    ----------
    inputs : BuildInputs
        With the lines as they lie on the surface, and behind them the edges of the boundary of the
        points that draped lines pass, if any.
    notes : tuple of str
    """

    inputs: BuildInputs
    notes: tuple[str, ...] = ()

    @property
    def has_own_boundary(self) -> bool:
        """Whether there are edges of the boundary of the points."""
        return bool((self.inputs.lines.sources < 0).any())

    def drop_own_boundary(self) -> LaidLines:
        """Return the same lines without the boundary of the points."""
        lines = self.inputs.lines
        return self._replace(inputs=replace(self.inputs, lines=lines.choose(lines.sources >= 0)))


def find_rim(points: NumberedPoints) -> Float64Array:
    """Return the vertices on the convex hull, counter-clockwise, (k, 3); elevations may be others.

    Raises
    ------
    PointsError
        If all places are on one line.
    """
    hull = reduce_to_hull(points).points
    growth = _kernel.grow(np.ascontiguousarray(hull), threads=1)
    ring: Float64Array = hull[boundary_rings(growth.triangles, growth.neighbors)[0]]
    return ring


@dataclass(frozen=True, eq=False)
class Draping:
    """Lines to be draped.

    Attributes
    ----------
    inputs : BuildInputs
    rim : (k, 3) float64 array
        As of :func:`find_rim`, of the points and of all lines with elevations.
    cut : CutLines
    """

    inputs: BuildInputs
    rim: Float64Array
    cut: CutLines

    @classmethod
    def of(cls, inputs: BuildInputs, rim: Float64Array) -> Draping:
        """Cut the lines of inputs that have no elevations at the hull."""
        lines = inputs.lines
        return cls(inputs, rim, cut_at_boundary(rim, lines.choose(lines.is_draped), threads=1))

    def list_asked(self) -> Float64Array:
        """Return segments, (k, 2, 2), of which all triangles that they meet are needed.

        These are the lines, and the edges of the hull that share a place with one.
        """
        segments: Float64Array = self.cut.points[self.cut.inner.segments()]
        corners, is_met = self.cut.boundary.corners, self.cut.boundary.is_met
        edges = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
        return np.concatenate([segments, edges[is_met]])

    def lay(self, known: Sequence[KnownTriangles]) -> tuple[LaidLines, Float64Array]:
        """Drape the lines, and return places whose triangles are not known, (k, 2).

        If there is such a place, the lines may lie otherwise.
        """
        lines = self.inputs.lines
        surface, is_known = complete(known, self.rim)
        laid = drape(surface, lines.choose(lines.is_draped), threads=1)
        boundary = laid.cut.boundary.lines
        together = LineSet.join([lines.choose(~lines.is_draped), laid.lines, boundary])
        notes: tuple[str, ...] = ()
        if laid.cut.n_cut:
            notes = (
                f"Of {counted(laid.cut.n_cut, 'draped line')} the parts outside the surface "
                "of the points were left out.",
            )
        places = np.unique(np.concatenate([laid.lines.xy, boundary.xy]), axis=0)
        return (
            LaidLines(replace(self.inputs, lines=together), notes),
            places[~_are_in_known(surface, is_known, places)],
        )


def node_base(near: NumberedPoints, inputs: BuildInputs, *, first_number: int) -> NodedLines:
    """Cut the lines that have elevations, on whose surface the others are draped.

    It fills the convex hull, whatever rings there are; parameters are those of :func:`.node_lines`.
    """
    lines = inputs.lines
    made = let_meet(near, replace(inputs, lines=lines.choose(~lines.is_draped)))
    is_ring = np.zeros(np.count_nonzero(~lines.is_draped), np.bool_)
    return gather_lines(made, is_ring, None, first_number=first_number)


def node_laid(
    near: NumberedPoints, skeleton: NumberedPoints, laid: LaidLines, *, first_number: int
) -> NodedLines:
    """Cut lines where they meet, of which some were draped.

    Parameters
    ----------
    near, first_number
        As of :func:`.node_lines`; also the points near the convex hull, if a draped line leaves it.
    skeleton : NumberedPoints
        Some of the points, with all vertices of their convex hull among them.
    laid : LaidLines

    Raises
    ------
    OptionError, LinesError
        As :func:`.node_lines`; also if a hole cuts nothing away, or nothing is left.

    Notes
    -----
    Which part of the hull is the surface, the lines alone tell, as in :mod:`.outline`. Where draped
    rings leave the points they are open, so the boundary of that part takes their place.
    """
    made = let_meet(near, laid.inputs)
    pslg, hull = _triangulate_lines(made, skeleton, laid)
    is_plain = not (laid.inputs.boundary or laid.inputs.extent or laid.inputs.holes)
    if is_plain and pslg.loses_vertices_at_own_boundary(hull):
        return node_lines(near, laid.drop_own_boundary().inputs, first_number=first_number)
    rings: Rings | None = None
    if not pslg.clip.is_none:
        left, _ = pslg.surface(hull)
        found = () if left is hull else boundary_rings(left.triangles, left.neighbors)
        rings = Rings(boundary=[left.points[ring, :2] for ring in found]) if found else None
    is_ring = laid.inputs.lines.table.is_kind("boundary", "hole")
    return gather_lines(made, is_ring, rings, first_number=first_number)


def _triangulate_lines(
    made: MeetingLines, skeleton: NumberedPoints, laid: LaidLines
) -> tuple[Pslg, Triangulation]:
    """Triangulate lines, the points near them and the hull: no ring has another side elsewhere."""
    inputs, lines = laid.inputs, laid.inputs.lines
    every = np.concatenate([made.points, reduce_to_hull(skeleton).points])
    _, first = np.unique(every[:, :2], axis=0, return_index=True)
    others = np.sort(first[first >= len(made.points)])
    points = np.concatenate([made.points, every[others]])
    hull = Triangulation(points, *build_mesh(points, made.polylines, threads=1).arrays(1))
    clip = Clip(
        boundary=inputs.boundary,
        extent=inputs.extent,
        holes=inputs.holes,
        has_own_boundary=laid.has_own_boundary,
    )
    pslg = Pslg(
        points=points,
        polylines=made.polylines,
        constraints=lines.table,
        groups=find_ring_groups(inputs, lines),
        clip=clip,
        vertex_of=np.empty(0, np.int32),
    )
    return pslg, hull


def complete(known: Sequence[KnownTriangles], rim: Float64Array) -> tuple[Triangulation, BoolArray]:
    """Complete triangles of the whole to a surface that fills the convex hull.

    Parameters
    ----------
    known : sequence of KnownTriangles
        Some may be the same.
    rim : (k, 3) float64 array
        As of :func:`find_rim`.

    Returns
    -------
    surface : Triangulation
    is_known : (m,) bool array
        Whether each triangle of it is one of the whole.
    """
    counts = find_offsets([len(one.points) for one in known])
    every = np.concatenate([*(one.points for one in known), rim])
    _, first, inverse = np.unique(every[:, :2], axis=0, return_index=True, return_inverse=True)
    number: Int32Array = inverse.reshape(-1).astype(np.int32)
    points = np.ascontiguousarray(every[first])
    corners = [number[begin + one.triangles] for begin, one in zip(counts[:-1], known, strict=True)]
    triangles = np.concatenate([np.empty((0, 3), np.int32), *corners])
    edges = np.unique(np.sort(np.stack(directed_edges(triangles), axis=-1).reshape(-1, 2)), axis=0)
    chains = Polylines.whole(edges.astype(np.int32).ravel(), np.arange(len(edges) + 1) * 2)
    mesh = build_mesh(points, chains, threads=1)
    surface = Triangulation(points, *mesh.arrays(1))
    return surface, _are_among(surface.triangles, triangles)


def _are_among(triangles: Int32Array, others: Int32Array) -> BoolArray:
    together = np.sort(np.concatenate([others, triangles]), axis=1)
    number = np.unique(together, axis=0, return_inverse=True)[1].ravel()
    return np.isin(number[len(others) :], number[: len(others)])


def _are_in_known(surface: Triangulation, is_known: BoolArray, places: Float64Array) -> BoolArray:
    """Tell which places lie in no triangle but known ones, with its sides, or off the surface."""
    locator = _kernel.Locator(surface.points, surface.triangles, surface.neighbors)
    at: Int64Array = locator.locate(np.ascontiguousarray(places)).astype(np.int64)
    is_fine: BoolArray = (at < 0) | is_known[at]
    beside = np.append(is_known, True)[surface.neighbors[at]]
    for corner in range(3):
        start, end = (
            surface.points[surface.triangles[at, (corner + step) % 3], :2] for step in (1, 2)
        )
        turns = _kernel.orientation(*map(np.ascontiguousarray, (start, end, places)))
        is_fine &= (at < 0) | (turns != 0) | beside[:, corner]
    return is_fine
