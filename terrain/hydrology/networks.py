"""Networks: from each strip of a surface, and each vertex, to the next one down."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.progress import Progress
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import double_areas, join_components
from .descent import BOUNDARY, MOVING, Walker, make_drops
from .falls import find_falls
from .strips import Strips, cut_strips, leave_strips, settle
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ...tin import TIN
    from .descent import Drops
    from .falls import Falls
    from .filling import Filling


class Network(NamedTuple):
    """Nodes: the strips, then the vertices, then where water ends."""

    walker: Walker
    surface: _kernel.FallingSurface
    """Of the compiled core."""
    strips: Strips
    grounds: Int32Array
    """(n,), the smallest vertex that each is connected to along level edges. Water that ends on
    level ground ends at that node of the last ones.
    """
    nexts: Int32Array
    """(s + 2 * n + 1,), the node below; ends are below themselves, the last being the outside."""
    uppers: Int32Array
    """(s + n,), the upper end of the channel that water takes to a vertex, ``NOWHERE`` where it
    takes none.
    """
    areas: Float64Array
    """(m,), of the triangles."""

    @property
    def first_vertex(self) -> int:
        """The node of vertex 0."""
        return len(self.strips.starts)

    @property
    def first_end(self) -> int:
        """The node of the ground of vertex 0."""
        return self.first_vertex + len(self.grounds)

    def measure_strips(self) -> Float64Array:
        """Return the areas of the strips."""
        return self.surface.measure_strips(*self.strips, self.areas)

    def find_level_nodes(self, level: Int64Array) -> Int64Array:
        """Return the nodes to which water of level triangles goes."""
        corners, filling = self.walker.falls.triangles[level].astype(np.int64), self.walker.filling
        if filling is None:
            return self.first_end + self.grounds[corners[:, 0]].astype(np.int64)
        return self.first_vertex + filling.choose_way(*corners.T)

    def find_leaving(self) -> Int64Array:
        """Return the nodes of vertices at which water leaves the surface, and the outside."""
        vertices = np.flatnonzero(self.walker.is_boundary)
        walker = Walker(self.walker.falls, self.walker.filling, vertices)
        leaves = walker.find_exits(vertices).leaves
        return np.append(self.first_vertex + vertices[leaves], len(self.nexts) - 1)


def build_network(
    tin: TIN, filling: Filling | None = None, progress: Tell | None = None
) -> Network:
    """Find the way of all water of a surface, or of a filled one.

    Raises PointsError if fall lines cross too many triangles, or elevations are too large to decide
    exactly.
    """
    done = Progress(progress)
    walker = Walker(find_falls(tin), filling)
    done(0.3)
    surface = _read_falls(walker.falls, filling)
    strips = cut_strips(surface)
    done(0.6)
    z = tin.points[:, 2]
    level = tin.edges[z[tin.edges[:, 0]] == z[tin.edges[:, 1]]].astype(np.int64)
    grounds = join_components(len(z), level[:, 0], level[:, 1]).astype(np.int32)
    workers = thread_count(None, len(z))
    nexts, uppers = surface.link_strips(*strips, grounds, workers)
    areas = np.abs(double_areas(tin.points, tin.triangles)) / 2
    found = Network(walker, surface, strips, grounds, nexts, uppers, areas)
    done(0.8)
    _link_vertices(found)
    _break_circles(found)
    return found


def build_vertex_network(walker: Walker) -> Network:
    """Find the way of the water from vertices alone: a network without strips."""
    falls = walker.falls
    count = len(falls.points)
    found = Network(
        walker,
        _read_falls(falls, walker.filling),
        Strips(np.zeros(len(falls.triangles) + 1, np.int64), np.zeros(0)),
        np.arange(count, dtype=np.int32),
        np.arange(2 * count + 1, dtype=np.int32),
        np.full(count, NOWHERE, np.int32),
        np.zeros(len(falls.triangles)),
    )
    _link_vertices(found)
    return found


def _read_falls(falls: Falls, filling: Filling | None) -> _kernel.FallingSurface:
    water = None
    if filling is not None:
        water = _kernel.Filling(
            filling.levels, filling.ponds, filling.nexts, filling.steps, filling.ranks
        )
    return _kernel.FallingSurface(*falls, water)


def _link_vertices(found: Network) -> None:
    """Set what is below vertices; where doubles do not decide that, fractions do."""
    nexts, uppers, undecided = found.surface.link_vertices(
        found.walker.is_boundary,
        found.first_vertex,
        found.grounds,
        thread_count(None, len(found.grounds)),
    )
    found.nexts[found.first_vertex : found.first_end] = nexts
    found.uppers[found.first_vertex :] = uppers
    if len(undecided) == 0:
        return
    start = make_drops(len(undecided))
    start.vertices[:] = undecided
    walker = Walker(found.walker.falls, found.walker.filling, start.vertices)
    drops, left = settle(walker, start)
    nodes = found.first_vertex + start.vertices
    _link(found, nodes, drops)
    along = left != NOWHERE
    found.uppers[nodes[along]] = left[along]


def _link(found: Network, nodes: Int64Array, drops: Drops) -> None:
    """Set what is below nodes whose water comes to a vertex, to a channel or to an end."""
    falls = found.walker.falls
    start, end = falls.ends(drops.triangles, drops.edges)
    at_vertex = np.where(drops.vertices != NOWHERE, drops.vertices, drops.targets)
    goes = (drops.ends == MOVING) & (at_vertex != NOWHERE)
    found.nexts[nodes[goes]] = found.first_vertex + at_vertex[goes]
    along = goes & (drops.targets != NOWHERE)
    found.uppers[nodes[along]] = np.where(start == drops.targets, end, start)[along]
    ended = drops.ends != MOVING
    ground = found.grounds[np.where(drops.vertices != NOWHERE, drops.vertices, start)]
    node = np.where(drops.ends == BOUNDARY, len(found.nexts) - 1, found.first_end + ground)
    found.nexts[nodes[ended]] = node[ended]


def _break_circles(found: Network) -> None:
    """Follow the drops of strips to a vertex where rounding lets strips run in a circle."""
    nodes = np.flatnonzero(_kernel.find_ends(found.nexts) < found.first_end)
    strips = nodes[nodes < found.first_vertex]
    if len(strips):
        left = leave_strips(found.walker, found.surface, found.strips, strips)
        on = np.flatnonzero(
            (left.vertices == NOWHERE) & (left.targets == NOWHERE) & (left.ends == MOVING)
        )
        drops, _ = settle(found.walker, left.choose(on))
        _link(found, strips[on], drops)


def find_ends(nexts: Int32Array) -> Int32Array:
    """Return the node at which the water of each ends."""
    return _kernel.find_ends(nexts)


def accumulate(found: Network) -> Float64Array:
    """Return the area whose water passes each node, its own included."""
    total = np.zeros(len(found.nexts))
    total[: found.first_vertex] = found.measure_strips()
    level = np.flatnonzero(found.walker.falls.is_level)
    np.add.at(total, found.find_level_nodes(level), found.areas[level])
    _kernel.accumulate(found.nexts, total)
    return total
