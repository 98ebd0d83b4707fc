"""Networks: from each strip of a surface, and each vertex, to the next one down."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..._progress import Progress
from ..relief.dissolving import join_components
from .descent import BOUNDARY, MOVING, Walker, make_drops
from .falls import find_falls
from .strips import cut_strips, enter_strips, find_bases, leave_strips, settle
from .vertices import NOWHERE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..._progress import Tell
    from ...tin import TIN
    from .descent import Drops
    from .filling import Filling
    from .strips import Bases, Strips

__all__ = ["Network", "accumulate", "build_network", "find_ends"]


class Network(NamedTuple):
    """Nodes: the strips, then the vertices, then where water ends.

    Attributes
    ----------
    walker : Walker
    bases : Bases
    strips : Strips
    grounds : (n,) int64 array
        The smallest vertex that each is connected to along level edges. Water that ends on level
        ground ends at that node of the last ones.
    nexts : (s + 2 * n + 1,) int64 array
        The node below; ends are below themselves, the last of all being the outside.
    uppers : (s + n,) int64 array
        The upper end of the channel that water takes to a vertex, ``NOWHERE`` where it takes none.
    areas : (m,) float64 array
        Of the triangles.
    """

    walker: Walker
    bases: Bases
    strips: Strips
    grounds: NDArray[np.int64]
    nexts: NDArray[np.int64]
    uppers: NDArray[np.int64]
    areas: NDArray[np.float64]

    @property
    def first_vertex(self) -> int:
        """The node of vertex 0."""
        return len(self.strips.triangles)

    @property
    def first_end(self) -> int:
        """The node of the ground of vertex 0."""
        return self.first_vertex + len(self.grounds)

    def find_level_nodes(self, level: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the nodes to which water of level triangles goes."""
        corners, filling = self.walker.falls.triangles[level].astype(np.int64), self.walker.filling
        if filling is None:
            return self.first_end + self.grounds[corners[:, 0]]
        return self.first_vertex + filling.choose_way(*corners.T)

    def find_leaving(self) -> NDArray[np.int64]:
        """Return the nodes of vertices at which water leaves the surface, and the outside."""
        vertices = np.flatnonzero(self.walker.is_boundary)
        leaves = self.walker.find_exits(vertices).leaves
        return np.append(self.first_vertex + vertices[leaves], len(self.nexts) - 1)


def build_network(
    tin: TIN, filling: Filling | None = None, progress: Tell | None = None
) -> Network:
    """Find the way of all water of a surface, or of a filled one.

    Raises
    ------
    PointsError
        If fall lines cross too many triangles, or elevations are too large to decide exactly.
    """
    done = Progress(progress)
    walker = Walker(find_falls(tin), filling)
    done(0.2)
    falls = walker.falls
    bases = find_bases(falls)
    strips = cut_strips(falls, bases)
    done(0.4)
    grounds = _connect_level_ground(tin)
    u, v = (falls.points[falls.triangles[:, k], :2] for k in (1, 2))
    origin = falls.points[falls.triangles[:, 0], :2]
    u, v = u - origin, v - origin
    areas = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    count, vertices = len(strips.triangles), len(grounds)
    nexts, uppers = np.arange(count + 2 * vertices + 1), np.full(count + vertices, NOWHERE)
    found = Network(walker, bases, strips, grounds, nexts, uppers, areas)
    _link_vertices(found)
    done(0.6)
    left = leave_strips(walker, bases, strips)
    _link(found, np.arange(count), left)
    on = np.flatnonzero(_runs_on(left))
    nexts[on] = enter_strips(bases, strips, left.choose(on))
    _break_circles(found, left)
    return found


def _connect_level_ground(tin: TIN) -> NDArray[np.int64]:
    edges = tin.edges.astype(np.int64)
    level = edges[tin.points[edges[:, 0], 2] == tin.points[edges[:, 1], 2]]
    return join_components(len(tin.points), level[:, 0], level[:, 1])


def _runs_on(drops: Drops) -> NDArray[np.bool_]:
    """Tell which drops are about to enter a triangle."""
    on: NDArray[np.bool_] = (
        (drops.vertices == NOWHERE) & (drops.targets == NOWHERE) & (drops.ends == MOVING)
    )
    return on


def _link_vertices(found: Network) -> None:
    count = len(found.grounds)
    start = make_drops(count)
    start.vertices[:] = np.arange(count)
    drops, uppers = settle(found.walker, start)
    nodes = found.first_vertex + np.arange(count)
    _link(found, nodes, drops)
    along = uppers != NOWHERE
    found.uppers[nodes[along]] = uppers[along]


def _link(found: Network, nodes: NDArray[np.int64], drops: Drops) -> None:
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


def _break_circles(found: Network, left: Drops) -> None:
    """Follow the drops of strips to a vertex where rounding lets strips run in a circle."""
    strips = np.flatnonzero(find_ends(found.nexts) < found.first_end)
    if len(strips):
        strips = strips[strips < found.first_vertex]
        on = strips[_runs_on(left.choose(strips))]
        drops, _ = settle(found.walker, left.choose(on))
        _link(found, on, drops)


def find_ends(nexts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the node at which the water of each ends."""
    ends = nexts
    for _ in range(len(nexts).bit_length()):
        ends = ends[ends]
    return ends


def accumulate(found: Network) -> NDArray[np.float64]:
    """Return the area whose water passes each node, its own included.

    Nodes that no water comes to are taken away, then those that this leaves so, and so on.
    """
    strips = found.strips
    total = np.zeros(len(found.nexts))
    total[: len(strips.triangles)] = strips.parts * found.areas[strips.triangles]
    level = np.flatnonzero(found.walker.falls.is_level)
    np.add.at(total, found.find_level_nodes(level), found.areas[level])
    moving = np.flatnonzero(found.nexts != np.arange(len(found.nexts)))
    waits = np.bincount(found.nexts[moving], minlength=len(total))
    ready = moving[waits[moving] == 0]
    while len(ready):
        below = found.nexts[ready]
        np.add.at(total, below, total[ready])
        np.subtract.at(waits, below, 1)
        below = np.unique(below)
        ready = below[(waits[below] == 0) & (found.nexts[below] != below)]
    return total
