"""The surface with few vertices: the squares of the finest level of a pyramid as one mesh.

Vertices on the sides of squares are chosen by the elevations along these alone, so that squares
fit; where squares lie follows from all points and the options. So does the mesh.
"""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_number, require_count
from ...base.errors import PointsError
from ...io.mesh.ply import SurfaceBlocks
from ...terrain.simplification.pyramid import Mesh, Node, Quadtree
from ..assembling import find_writable, read_blocks, require_numbers
from ..tasks import TileProduct
from .squares import as_node, divide_job, divide_points, list_finest, settle_quadtree

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import BoolArray, Int64Array
    from ...base.types import Bounds
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

_JOINED = "joined"


class SimplifiedSurface(NamedTuple):
    """A surface of few vertices.

    Attributes
    ----------
    blocks : SurfaceBlocks
    error : float
        Largest vertical distance from the surface of all points, anywhere.
    """

    blocks: SurfaceBlocks
    error: float


def check_options(*, format: str, tolerance: float, node_points: int = 8_192) -> dict[str, Any]:  # noqa: A002
    """Return plain options, or refuse what is none."""
    within = as_number("tolerance", tolerance, "a vertical distance", above=0)
    require_count("node_points", node_points, least=16)
    return {
        "format": find_writable(format),
        "tolerance": float(within),
        "node_points": int(node_points),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the squares.

    Raises
    ------
    PointsError
        If all points lie on one line.
    """
    return {**options, "quadtree": settle_quadtree(points, options["node_points"])}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Simplify the finest squares in a square, each a file."""
    options = part.job.options
    tree, root = Quadtree(**options["quadtree"]), as_node(part.job.tile)
    local = part.triangulate(part.job.tile.box)
    names, told = [], []
    for node, mesh in list_finest(local.points, local.triangles, root, tree, options["tolerance"]):
        names.append(f"{node.key}.npz")
        with replacing(part.folder / names[-1]) as file:
            np.savez(file, points=mesh.points, triangles=mesh.triangles)
        told.append([*node, mesh.error])
    return (len(local.points) if told else 0), {"nodes": told}, names


class SquareJoiner:
    """Numbers the vertices of squares, row by row from the south-west, and writes the whole.

    It holds the vertices on sides of the row before.

    Parameters
    ----------
    folder : Path
    tree : Quadtree

    Attributes
    ----------
    paths : (Path, Path)
        Of the vertices, float64, and of the triangles, int32.
    counts : list of int
        Of both, so far.
    """

    def __init__(self, folder: Path, tree: Quadtree) -> None:
        self.paths = folder / "points", folder / "triangles"
        self._tree = tree
        self._files = [path.open("wb") for path in self.paths]
        self._on_sides: dict[tuple[float, float], int] = {}
        self._row = -1
        self.counts = [0, 0]

    def close(self) -> None:
        """End the files."""
        for file in self._files:
            file.close()

    def add(self, node: Node, mesh: Mesh) -> None:
        """Take the next square."""
        box = self._tree.find_box(node)
        if node.y != self._row:
            self._row = node.y
            kept = self._on_sides.items()
            self._on_sides = {place: number for place, number in kept if place[1] >= box.ymin}
        numbers = self._number(mesh, _are_on_sides(mesh, box))
        points, triangles = self._files
        is_new = numbers >= self.counts[0]
        points.write(mesh.points[is_new].astype("<f8").data)
        triangles.write(numbers[mesh.triangles].astype("<i4").data)
        self.counts[0] += int(np.count_nonzero(is_new))
        self.counts[1] += len(mesh.triangles)
        require_numbers(self.counts[0])

    def _number(self, mesh: Mesh, on_sides: BoolArray) -> Int64Array:
        """Return the numbers of the vertices of a square: those of squares before, or new ones."""
        rows = np.flatnonzero(on_sides).tolist()
        places = list(map(tuple, mesh.points[on_sides, :2].tolist()))
        numbers = np.full(len(mesh.points), -1, np.int64)
        numbers[rows] = [self._on_sides.get(place, -1) for place in places]
        is_new = numbers < 0
        numbers[is_new] = self.counts[0] + np.arange(np.count_nonzero(is_new))
        self._on_sides.update(zip(places, numbers[rows].tolist(), strict=True))
        return numbers


def _are_on_sides(mesh: Mesh, box: Bounds) -> BoolArray:
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    found: BoolArray = (x == box.xmin) | (x == box.xmax) | (y == box.ymin) | (y == box.ymax)
    return found


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> SimplifiedSurface:
    """Return the squares as one mesh.

    Raises
    ------
    PointsError
        If there is no triangle, or more vertices than a file can number.
    """
    squares: dict[Node, Path] = {}
    error = 0.0
    for record in records.values():
        for (level, x, y, own), name in zip(
            record.values.get("nodes", ()), record.files, strict=True
        ):
            squares[Node(level, x, y)] = folder / name
            error = max(error, own)
    if not squares:
        raise PointsError("The points have no surface.")
    work = folder / _JOINED
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    joiner = SquareJoiner(work, Quadtree(**options["quadtree"]))
    for node in sorted(squares, key=lambda one: (one.y, one.x)):
        with np.load(squares[node]) as found:
            joiner.add(node, Mesh(found["points"], found["triangles"]))
    joiner.close()
    vertices, triangles = (
        read_blocks(path, kind) for path, kind in zip(joiner.paths, ("<f8", "<i4"), strict=True)
    )
    n_points, n_triangles = joiner.counts
    blocks = SurfaceBlocks(
        n_points, n_triangles, vertices, triangles, points.crs, points.elevation_unit
    )
    return SimplifiedSurface(blocks, error)


PRODUCT = TileProduct(
    check_options,
    compute,
    join,
    settle_options=settle_options,
    divide_points=divide_points,
    divide_job=divide_job,
)
