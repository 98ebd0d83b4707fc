"""Tasks that are squares of a quadtree: where these lie follows from all points, not from tiles."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.errors import PointsError
from ...terrain.simplification.pyramid import Mesh, Node, Quadtree, make_finest
from ..division import Tile
from ..tasks import TileJob

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.types import Bounds
    from ..reading import StoredPoints
    from ..running import Phase, Record, Run


def settle_quadtree(points: StoredPoints, node_points: int) -> dict[str, Any]:
    """Return the squares over all points as plain values.

    Raises
    ------
    PointsError
        If all points lie on one line.
    """
    if not (points.bounds.width > 0 and points.bounds.height > 0):
        raise PointsError("All points lie on one line: there is no surface.")
    return asdict(Quadtree.over(points.bounds, points.count, node_points))


def divide_points(
    options: Mapping[str, Any],
    counts: Int64Array,
    bounds: Bounds,
    *,
    most: int,
    fewest_tiles: int,
) -> list[Tile]:
    """Return squares that have few enough points, or are of the finest level."""
    tree = Quadtree(**options["quadtree"])
    sums = np.zeros((len(counts) + 1, len(counts) + 1), np.int64)
    sums[1:, 1:] = counts.cumsum(axis=0).cumsum(axis=1)
    tiles = [_make_tile(Node(0, 0, 0), tree, sums, bounds)]
    while True:
        large = [
            tile
            for tile in tiles
            if (tile.count > most or len(tiles) < fewest_tiles)
            and as_node(tile).level < tree.levels
        ]
        if not large:
            return tiles
        largest = max(large, key=lambda tile: tile.count)
        tiles.remove(largest)
        parts = [_make_tile(child, tree, sums, bounds) for child in as_node(largest).children]
        tiles += [part for part in parts if _meet(part.box, bounds)]


def _make_tile(node: Node, tree: Quadtree, sums: Int64Array, bounds: Bounds) -> Tile:
    """Return a square as a tile, with the points in it as far as the lattice of counts tells."""
    box, side = tree.find_box(node), len(sums) - 1
    ends = []
    for low, high, first, extent in (
        (box.ymin, box.ymax, bounds.ymin, bounds.height),
        (box.xmin, box.xmax, bounds.xmin, bounds.width),
    ):
        share = (np.array([low, high]) - first) / extent
        ends.append(np.clip(np.rint(share * side), 0, side).astype(int).tolist())
    (south, north), (west, east) = ends
    count = sums[north, east] - sums[south, east] - sums[north, west] + sums[south, west]
    return Tile(node.key, box, int(count))


def _meet(box: Bounds, other: Bounds) -> bool:
    """Tell whether two closed boxes have a place in common."""
    across = box.xmin <= other.xmax and other.xmin <= box.xmax
    return across and box.ymin <= other.ymax and other.ymin <= box.ymax


def as_node(tile: Tile) -> Node:
    """Return the square that a tile is."""
    return Node(*map(int, tile.key.split(".")))


def divide_job(job: TileJob) -> list[TileJob]:
    """Return the quarters of a square that was too large, none if it is of the finest level."""
    node, tree = as_node(job.tile), Quadtree(**job.options["quadtree"])
    if node.level == tree.levels:
        return []
    return [
        TileJob(
            job.folder,
            job.points,
            Tile(child.key, tree.find_box(child), job.tile.count // 4),
            job.product,
            job.options,
            job.duplicates,
        )
        for child in node.children
    ]


def list_finest(
    points: Float64Array, triangles: Int32Array, root: Node, tree: Quadtree, tolerance: float
) -> Iterator[tuple[Node, Mesh]]:
    """Yield the finest squares in a square, with the surface in them within a tolerance."""
    corners = points[triangles, :2]
    (west, south), (east, north) = corners.min(axis=1).T, corners.max(axis=1).T
    waiting = [(root, np.arange(len(triangles)))]
    while waiting:
        node, rows = waiting.pop()
        box = tree.find_box(node)
        is_met = (west[rows] <= box.xmax) & (east[rows] >= box.xmin)
        is_met &= (south[rows] <= box.ymax) & (north[rows] >= box.ymin)
        rows = rows[is_met]
        if not len(rows):
            continue
        if node.level < tree.levels:
            waiting += [(child, rows) for child in reversed(node.children)]
            continue
        mesh = make_finest(points, triangles[rows], box, tolerance)
        if mesh is not None:
            yield node, mesh


def raise_levels(
    meshes: dict[Node, Mesh], last: int, simplify: Callable[[Sequence[Mesh], Node], Mesh]
) -> Iterator[tuple[Node, Mesh]]:
    """Yield squares, and those made of them up to a level, each of the four below it."""
    while meshes:
        yield from meshes.items()
        if next(iter(meshes)).level == last:
            return
        meshes = {
            parent: simplify([meshes[one] for one in parent.children if one in meshes], parent)
            for parent in sorted({node.parent for node in meshes})
        }


def save_mesh(folder: Path, node: Node, mesh: Mesh) -> str:
    """Write the mesh of a square to a file, and return its name."""
    name = f"{node.key}.npz"
    with replacing(folder / name) as file:
        np.savez(file, **mesh._asdict())
    return name


def load_mesh(path: Path) -> Mesh:
    """Read what :func:`save_mesh` wrote."""
    with np.load(path) as found:
        return Mesh(found["points"], found["triangles"], float(found["error"]))


@dataclass(frozen=True)
class NodeJob:
    """A square that is to be made of those below it.

    Attributes
    ----------
    folder : Path
        Of the run.
    node : Node
    children : tuple of str
        Files of their meshes, in the folder.
    options : mapping
    """

    folder: Path
    node: Node
    children: tuple[str, ...]
    options: Mapping[str, Any]

    @property
    def key(self) -> str:
        """Name of the task."""
        return self.node.key

    @property
    def phase(self) -> str:
        """Step of the run: a level."""
        return f"level{self.node.level}"

    def load(self) -> list[Mesh]:
        """Return the meshes of the children."""
        return [load_mesh(self.folder / name) for name in self.children]


def find_meshes(records: Iterable[Record]) -> dict[Node, str]:
    """Return the files of :func:`save_mesh` among those of tasks."""
    return {
        Node(*map(int, Path(name).stem.split("."))): name
        for record in records
        for name in record.files
        if name.endswith(".npz")
    }


def make_levels(
    run: Run,
    phase: Phase,
    meshes: dict[Node, str],
    compute: Callable[[NodeJob], Record],
    options: Mapping[str, Any],
    *,
    last: int = 0,
) -> dict[str, Record]:
    """Make the levels above squares, up to one; ``meshes`` get the files of those made."""
    every = {}
    for level in range(max(node.level for node in meshes) - 1, last - 1, -1):
        parents = {node.parent for node in meshes if node.level == level + 1} - meshes.keys()
        jobs = [
            NodeJob(
                run.folder,
                parent,
                tuple(meshes[one] for one in parent.children if one in meshes),
                options,
            )
            for parent in sorted(parents)
        ]
        if not jobs:
            continue
        made = phase.run(run, jobs[0].phase, compute, jobs)
        every.update({f"{jobs[0].phase} {key}": record for key, record in made.items()})
        meshes.update(find_meshes(made.values()))
    return every
