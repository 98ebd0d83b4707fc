"""A surface at several scales, as 3D Tiles: a task makes a square of it with all below.

Squares lie where the bounds of all points and their number put them, whatever the tiles are. A
task triangulates a square that fits in memory, cuts it into squares of the finest level, and joins
and simplifies these up to its own; then one level after the other is made of the one below.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing
from ...base.checks import as_number, require_count
from ...base.errors import CrsError, PointsError
from ...base.notes import warn
from ...base.types import Bounds
from ...io.mesh.tiles_3d import Content, Scene, encode_content, format_tileset
from ...terrain.simplification.pyramid import (
    Mesh,
    Node,
    Quadtree,
    find_tolerance,
    join_nodes,
)
from ...terrain.simplification.pyramid import simplify as simplify_node
from ..tasks import TileProduct, add_units, do_task, find_reference
from .squares import (
    NodeJob,
    as_node,
    divide_job,
    divide_points,
    find_meshes,
    list_finest,
    make_levels,
    raise_levels,
    save_mesh,
    settle_quadtree,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from ..reading import StoredPoints
    from ..running import Phase, Record, Run
    from ..tasks import Part

INDEX = "tileset.json"
"""What the folder holds, by which such a folder is known."""


def check_options(*, tolerance: float = 0.0, node_points: int = 8_192) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    within = as_number("tolerance", tolerance, "an elevation", least=0)
    require_count("node_points", node_points, least=16)
    return {"tolerance": float(within), "node_points": int(node_points)}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the squares and where they lie on the globe.

    Raises
    ------
    CrsError
        If the CRS is not known.
    PointsError
        If all points lie on one line.
    """
    if points.crs is None:
        raise CrsError(
            "3D Tiles lie on the globe, and the CRS of the points is not known: declare it (`crs`)."
        )
    return {
        **add_units(points, options),
        "quadtree": settle_quadtree(points, options["node_points"]),
        "bounds": asdict(points.bounds),
        "elevations": list(points.elevations),
    }


@dataclass(frozen=True)
class _Plan:
    """The squares of a run, and how each is made."""

    quadtree: Quadtree
    scene: Scene
    tolerance: float

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> _Plan:
        crs, unit = find_reference(options)
        if crs is None:
            raise CrsError("The CRS of the points is not known.")
        low, high = options["elevations"]
        scene = Scene(crs, unit, Bounds(**options["bounds"]), (float(low), float(high)))
        return cls(Quadtree(**options["quadtree"]), scene, options["tolerance"])

    def simplify(self, children: Sequence[Mesh], node: Node) -> Mesh:
        """Return the mesh of a node that is not of the finest level."""
        along, up = self.scene.metres
        tree = self.quadtree
        within = find_tolerance(tree.levels - node.level, tree.side * along / up, self.tolerance)
        return simplify_node(join_nodes(children), tree.find_box(node), within)

    def save(self, folder: Path, node: Node, mesh: Mesh) -> tuple[str, list[Any]]:
        """Write the content of a node; return its name, and what is told of it."""
        parts, content = encode_content(
            mesh.points,
            mesh.triangles,
            mesh.error,
            self.scene,
            side=self.quadtree.find_side(node.level),
        )
        name = f"{node.key}.glb"
        with replacing(folder / name) as file:
            for part in parts:
                file.write(part)
        return name, [*node, *content, len(mesh.points), len(mesh.triangles)]


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Make a square and all squares in it."""
    plan, root = _Plan.of(part.job.options), as_node(part.job.tile)
    local = part.triangulate(part.job.tile.box)
    finest = list_finest(local.points, local.triangles, root, plan.quadtree, plan.tolerance)
    names, told = [], []
    for node, mesh in raise_levels(dict(finest), root.level, plan.simplify):
        name, entry = plan.save(part.folder, node, mesh)
        names.append(name)
        told.append(entry)
        if node == root:
            names.append(save_mesh(part.folder, root, mesh))
    return (len(local.points) if told else 0), {"nodes": told}, names


def compute_node(job: NodeJob) -> Record:
    """Make a square of those below it, see :func:`tinsmith.tiled.tasks.do_task`."""

    def compute_square() -> tuple[int, dict[str, Any], list[str]]:
        plan, folder = _Plan.of(job.options), job.folder / job.phase
        mesh = plan.simplify(job.load(), job.node)
        name, told = plan.save(folder, job.node, mesh)
        return len(mesh.points), {"nodes": [told]}, [name, save_mesh(folder, job.node, mesh)]

    return do_task(job.folder, job.phase, job.key, compute_square)


def combine(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record], phase: Phase
) -> dict[str, Record]:
    """Make the levels above the squares of tasks, from the finest up to the root."""
    meshes = find_meshes(records.values())
    if not meshes:
        raise PointsError("The points have no surface.")
    return {**records, **make_levels(run, phase, meshes, compute_node, options)}


# ------------------------------------------------------------------------- the folder


@dataclass(frozen=True)
class Pyramid:
    """All squares, in the folder of the run.

    Attributes
    ----------
    scene : Scene
    contents : mapping of Node to Content
    files : mapping of Node to Path
    notes : tuple of str
    index : str
        File by which a folder of them is known.
    """

    scene: Scene
    contents: Mapping[Node, Content]
    files: Mapping[Node, Path]
    notes: tuple[str, ...]
    index: str = INDEX

    def write(self, folder: Path) -> None:
        """Write the contents, and the file that names them."""
        uris = {}
        for node in sorted(self.contents):
            uris[node] = f"{node.level}/{node.x}/{node.y}.glb"
            target = folder / uris[node]
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.files[node], target)
        for note in self.scene.notes:
            warn(note)
        notes = [*self.notes, *self.scene.notes]
        tileset = format_tileset(self.scene, self.contents, uris, notes)
        with replacing(folder / INDEX, binary=False) as file:
            json.dump(tileset, file, indent=1)
            file.write("\n")


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Pyramid:
    """Return all squares with their files."""
    contents, files = {}, {}
    for record in records.values():
        for level, x, y, low, high, error, *_ in record.values.get("nodes", ()):
            node = Node(level, x, y)
            contents[node] = Content(low, high, error)
            (name,) = (one for one in record.files if one.endswith(f"/{node.key}.glb"))
            files[node] = folder / name
    return Pyramid(_Plan.of(options).scene, contents, files, points.notes)


PRODUCT = TileProduct(
    check_options,
    compute,
    join,
    index=INDEX,
    has_lines=False,
    settle_options=settle_options,
    combine=combine,
    divide_points=divide_points,
    divide_job=divide_job,
)
