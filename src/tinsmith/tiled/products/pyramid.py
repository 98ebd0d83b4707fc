"""A surface at several scales, as 3D Tiles: a task makes a square of it with all below.

Squares lie where the bounds of all points and their number put them, whatever the tiles are. A
task triangulates a square that fits in memory, cuts it into squares of the finest level, and joins
and simplifies these up to its own; then one level after the other is made of the one below.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_number, require_count
from ...base.crs import CRS, Unit
from ...base.errors import CrsError, PointsError, TinsmithError, WriteError, choice
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
from ..running import Record, Run, hash_file
from .squares import as_node, list_finest, settle_quadtree
from .squares import divide_job as divide_job
from .squares import divide_points as divide_points

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..reading import StoredPoints
    from ..running import Phase
    from ..tasks import Part

INDEX = "tileset.json"
HAS_LINES = False
"""Squares are those of points alone."""
"""What the folder holds, by which such a folder is known."""

FORMATS = ("3dtiles",)


def check_options(
    *,
    format: str = "3dtiles",  # noqa: A002 - as in write
    tolerance: float = 0.0,
    node_points: int = 8_192,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    choice("format", format, FORMATS)
    within = as_number("tolerance", tolerance, "an elevation", least=0)
    require_count("node_points", node_points, least=16)
    return {"format": format, "tolerance": float(within), "node_points": int(node_points)}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the squares and where they lie on the globe.

    Raises
    ------
    CrsError
        If the CRS is not known.
    PointsError
        If all points lie on one line.
    """
    crs, unit = points.crs, points.elevation_unit
    if crs is None:
        raise CrsError(
            "3D Tiles lie on the globe, and the CRS of the points is not known: declare it (`crs`)."
        )
    return {
        **options,
        "quadtree": settle_quadtree(points, options["node_points"]),
        "bounds": asdict(points.bounds),
        "elevations": list(points.elevations),
        "crs": str(crs),
        "elevation_unit": None if unit is None else unit.text,
    }


@dataclass(frozen=True)
class _Plan:
    """The squares of a run, and how each is made."""

    quadtree: Quadtree
    scene: Scene
    tolerance: float

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> _Plan:
        crs = CRS.of(options["crs"])
        if crs is None:
            raise CrsError("The CRS of the points is not known.")
        low, high = options["elevations"]
        scene = Scene(
            crs,
            Unit.of(options["elevation_unit"] or None),
            Bounds(**options["bounds"]),
            (float(low), float(high)),
        )
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


def _save_mesh(folder: Path, node: Node, mesh: Mesh) -> str:
    name = f"{node.key}.npz"
    with replacing(folder / name) as file:
        np.savez(file, **mesh._asdict())
    return name


def _load_mesh(path: Path) -> Mesh:
    with np.load(path) as found:
        return Mesh(found["points"], found["triangles"], float(found["error"]))


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Make a square and all squares in it."""
    plan, root = _Plan.of(part.job.options), as_node(part.job.tile)
    local = part.triangulate(part.job.tile.box)
    meshes = dict(list_finest(local, root, plan.quadtree, plan.tolerance))
    names, told = [], []
    while meshes:
        for node, mesh in meshes.items():
            name, entry = plan.save(part.folder, node, mesh)
            names.append(name)
            told.append(entry)
        if root in meshes:
            names.append(_save_mesh(part.folder, root, meshes[root]))
            break
        meshes = {
            parent: plan.simplify([meshes[one] for one in parent.children if one in meshes], parent)
            for parent in sorted({node.parent for node in meshes})
        }
    return (len(local.points) if told else 0), {"nodes": told}, names


# ------------------------------------------------------------------------- levels above them


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


def compute_node(job: NodeJob) -> Record:
    """Make a square of those below it; what is wrong becomes the record's sentence.

    Raises
    ------
    WriteError
        If the folder cannot be written, which is no fault of the square.
    """
    started = perf_counter()
    node, plan = job.node, _Plan.of(job.options)
    phase = _name_phase(node.level)
    folder = job.folder / phase
    folder.mkdir(exist_ok=True)
    try:
        mesh = plan.simplify([_load_mesh(job.folder / name) for name in job.children], node)
        name, told = plan.save(folder, node, mesh)
        names = [name, _save_mesh(folder, node, mesh)]
        record = Record(
            job.key,
            "done",
            seconds=perf_counter() - started,
            points=len(mesh.points),
            values={"nodes": [told]},
            files={f"{phase}/{one}": hash_file(folder / one) for one in names},
        )
    except WriteError:
        raise
    except MemoryError:
        return Record(job.key, "no memory", f"Square {job.key} needs more memory than there is.")
    except TinsmithError as error:
        record = Record(job.key, "failed", f"Square {job.key}: {error}", perf_counter() - started)
    Run(job.folder).add(phase, record)
    return record


def _name_phase(level: int) -> str:
    return f"level{level}"


def combine(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record], phase: Phase
) -> dict[str, Record]:
    """Make the levels above the squares of tasks, from the finest up to the root."""
    every = dict(records)
    meshes = {
        Node(*map(int, key.split("."))): name
        for key, record in records.items()
        for name in record.files
        if name.endswith(".npz")
    }
    if not meshes:
        raise PointsError("The points have no surface.")
    for level in range(max(node.level for node in meshes) - 1, -1, -1):
        parents = sorted({node.parent for node in meshes if node.level == level + 1})
        jobs = [
            NodeJob(
                run.folder,
                parent,
                tuple(meshes[one] for one in parent.children if one in meshes),
                options,
            )
            for parent in parents
        ]
        made = phase.run(run, _name_phase(level), compute_node, jobs)
        for key, record in made.items():
            every[f"{_name_phase(level)} {key}"] = record
            (name,) = (name for name in record.files if name.endswith(".npz"))
            meshes[Node(*map(int, key.split(".")))] = name
    return every


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
