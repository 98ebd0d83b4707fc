"""A surface at several scales, as quantized-mesh tiles.

Each tile of the plane brings the triangles that it owns to the globe, and counts how long their
edges are, which tells the finest level. Blocks of the squares of the globe are then cut into the
tiles of this level, just as those of the surface in memory, and into squares of the level above,
which are simplified and joined up to the coarsest. At last levels are put on their grids, each
block with the squares around it, so that neighbours have the same vertices and normals.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_flag, require_count
from ...base.crs import CRS
from ...base.errors import CrsError, PointsError
from ...base.notes import warn
from ...base.types import Bounds
from ...io.mesh import describe_heights, has_heights, place_on_globe
from ...io.mesh.quantized_mesh import (
    FROM_CORNER,
    MOST_LEVEL,
    GridTile,
    LevelTiles,
    Places,
    TileName,
    choose_finest,
    choose_first,
    choose_height_step,
    count_edge_levels,
    describe_layer,
    describe_many,
    describe_small,
    encode_file,
    find_file,
    find_tolerance,
    list_bare,
    list_missing,
    measure_area,
    write_bare,
)
from ...terrain.parts import are_owned
from ...terrain.simplification.pyramid import Mesh, Node, Quadtree, join_nodes, simplify
from ..tasks import TileProduct, add_units, do_task, find_reference, save_arrays
from .squares import (
    NodeJob,
    find_meshes,
    list_finest,
    load_mesh,
    make_levels,
    raise_levels,
    save_mesh,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ..reading import StoredPoints
    from ..running import Phase, Record, Run
    from ..tasks import Made, Part

INDEX = "layer.json"
"""What the folder holds, by which such a folder is known."""

_MOST_TRIANGLES = 1 << 19
"""Of a block that is cut at a time, about."""
_BESIDE = 1.0 + 2.0**-10
"""Widths of a tile around a block whose triangles are cut with it: what touches a neighbour of a
tile may have a vertex on its side, or a part in its normals."""
_GROUP = 3
"""Levels between a block of squares that are put on the grid at a time and these."""
_SQUARES_BESIDE = 2
_CUT, _GRID, _TILES = "cut", "grid", "encoded"
"""Steps after that of the tiles of the plane, and their folders."""
_SUFFIX = ".tiles"


def check_options(*, max_level: int | None = None, gzipped: bool = False) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    require_count("max_level", max_level, least=0, most=MOST_LEVEL, or_none=True)
    return {"max_level": max_level, "gzipped": as_flag("gzipped", gzipped)}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Add the units of all points.

    Raises
    ------
    CrsError
        If the CRS is not known.
    """
    if points.crs is None:
        raise CrsError(
            "Quantized-mesh tiles lie on the globe, and the CRS of the points is not known: "
            "declare it (`crs`)."
        )
    return add_units(points, options)


def compute(part: Part) -> Made:
    """Bring the triangles of a tile to the globe, and count the lengths of edges."""
    box, options = part.job.tile.box, part.job.options
    local = part.triangulate(box, ordered=False)
    owned = local.triangles[local.owned]
    if not len(local.triangles):
        return 0, {}, []
    crs, unit = find_reference(options)
    if crs is None:
        raise CrsError("The CRS of the points is not known.")
    places = place_on_globe(local.points, crs, unit)
    edges = local.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    x, y = local.points[edges, :2].transpose(2, 1, 0)
    is_turned = (x[1] < x[0]) | ((x[1] == x[0]) & (y[1] < y[0]))
    edges = np.where(is_turned[:, None], edges[:, ::-1], edges)
    edges = np.unique(edges[are_owned(local.points[edges[:, 0]], box)], axis=0)
    counts = count_edge_levels(*places[edges].transpose(1, 0, 2))
    told: dict[str, Any] = {"edges": counts.tolist()}
    if not len(owned):
        return len(local.points), told, []
    used, corners = np.unique(owned, return_inverse=True)
    places = places[used]
    low, high = places.min(axis=0), places.max(axis=0)
    told |= {"low": low.tolist(), "high": high.tolist(), "triangles": len(owned)}
    corners = corners.reshape(-1, 3).astype(np.int32)
    told["area"] = measure_area(places, corners)
    return len(local.points), told, save_arrays(part, points=places, triangles=corners)


# ------------------------------------------------------------------------- all squares


class _Levels(NamedTuple):
    """The levels of a pyramid, as plain values."""

    first: int
    finest: int

    @property
    def tree(self) -> Quadtree:
        """The squares that are simplified: those of the level above the finest, and all others."""
        level = max(self.finest - 1, 0)
        return Quadtree(180.0 / 2**level, 0, 0, level)

    def simplify(self, children: Sequence[Mesh], node: Node) -> Mesh:
        """Return the mesh of a square of those below it."""
        return simplify(join_nodes(children), self.tree.find_box(node), _share(node.level))


def _share(level: int) -> float:
    """Return what simplification of one level may add: twice that of the level below."""
    return find_tolerance(level) / 2


@dataclass(frozen=True)
class SquareJob:
    """Squares that are cut, put on the grid, or encoded in one task.

    Attributes
    ----------
    folder : Path
        Of the run.
    phase : str
        Step of the run.
    key : str
        Name of the task.
    node : Node
        Of which they are.
    files : tuple of str
        That are read, in the folder.
    levels : _Levels
    level : int
        Of the squares.
    writing : (float, bool)
        Step of heights, and whether tiles are compressed.
    """

    folder: Path
    phase: str
    key: str
    node: Node
    files: tuple[str, ...]
    levels: _Levels
    level: int
    writing: tuple[float, bool] = (0.0, False)


def combine(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record], phase: Phase
) -> dict[str, Record]:
    """Cut, simplify and encode all squares.

    Raises
    ------
    PointsError
        If there is no triangle, also on one of the levels, if the finest level has too many tiles,
        or the surface crosses the antimeridian.
    """
    filled = [record for record in records.values() if record.files]
    if not filled:
        raise PointsError("The points have no surface.")
    low, high = _join_corners(filled)
    if high[0] - low[0] > 180.0:
        raise PointsError(
            "Quantized-mesh tiles cannot cross the antimeridian, as the surface does."
        )
    finest = options["max_level"]
    if finest is None:
        edges = [one.values["edges"] for one in records.values() if "edges" in one.values]
        finest = choose_finest(np.sum(edges, axis=0))
    area, count = (sum(one.values[name] for one in filled) for name in ("area", "triangles"))
    if refusal := describe_many(finest, area, count):
        raise PointsError(refusal)
    levels = _Levels(choose_first(low, high, finest), finest)
    blocks = _list_blocks(run.folder, levels, filled)
    cut = phase.run(run, _CUT, cut_block, blocks, divide=_divide_block)
    every = {f"{_CUT} {key}": record for key, record in cut.items()}
    meshes = find_meshes(cut.values())
    grids = [(finest, f"{finest}.{key}", record) for key, record in cut.items()]
    if meshes:
        made = make_levels(run, phase, meshes, compute_node, levels._asdict(), last=levels.first)
        every |= made
        jobs = _list_groups(run.folder, levels, meshes)
        for key, record in phase.run(run, _GRID, put_on_grid, jobs).items():
            every[f"{_GRID} {key}"] = record
            grids.append((int(key.split(".")[0]), key, record))
    encoding = _list_encoding(run.folder, levels, grids, is_gzipped=options["gzipped"])
    found = phase.run(run, _TILES, encode_tiles, encoding)
    return {**records, **every, **{f"{_TILES} {key}": one for key, one in found.items()}}


def _join_corners(records: Iterable[Record]) -> tuple[Float64Array, Float64Array]:
    """Return the least and the greatest longitude, latitude and height of all tiles."""
    low, high = zip(*((one.values["low"], one.values["high"]) for one in records), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


class _TileBounds(NamedTuple):
    """The triangles of tiles of the plane, on the globe."""

    corners: Float64Array
    """(k, 4), degrees from the south-west corner of all squares."""
    counts: Float64Array
    names: list[str]

    @classmethod
    def of(cls, records: Sequence[Record], margin: float) -> _TileBounds:
        shift = FROM_CORNER[:2]
        corners = [
            [*(one.values["low"][:2] + shift - margin), *(one.values["high"][:2] + shift + margin)]
            for one in records
        ]
        counts = [one.values["triangles"] for one in records]
        names = [name for one in records for name in one.files]
        return cls(np.array(corners), np.array(counts, np.float64), names)

    def find(self, box: Bounds) -> list[str]:
        """Return the files of those that meet a box."""
        west, south, east, north = self.corners.T
        is_met = (west <= box.xmax) & (east >= box.xmin)
        is_met &= (south <= box.ymax) & (north >= box.ymin)
        return [self.names[k] for k in np.flatnonzero(is_met)]

    def estimate(self, box: Bounds) -> float:
        """Return about how many triangles lie in a box."""
        west, south, east, north = self.corners.T
        width = np.minimum(east, box.xmax) - np.maximum(west, box.xmin)
        height = np.minimum(north, box.ymax) - np.maximum(south, box.ymin)
        share = np.maximum(width, 0) * np.maximum(height, 0) / ((east - west) * (north - south))
        return float((self.counts * share).sum())


def _list_blocks(folder: Path, levels: _Levels, records: Sequence[Record]) -> list[SquareJob]:
    """Return squares that have few enough triangles, or are of the finest level of squares."""
    width, tree = 180.0 / 2**levels.finest, levels.tree
    bounds = _TileBounds.of(records, width * (_BESIDE - 1.0))
    waiting, found = [Node(0, 0, 0), Node(0, 1, 0)], []
    while waiting:
        node = waiting.pop()
        box = tree.find_box(node)
        if not bounds.find(box):
            continue
        if node.level < tree.levels and bounds.estimate(box) > _MOST_TRIANGLES:
            waiting += node.children
            continue
        beside = width * _BESIDE
        wide = Bounds(box.xmin - beside, box.ymin - beside, box.xmax + beside, box.ymax + beside)
        files = tuple(bounds.find(wide))
        found.append(SquareJob(folder, _CUT, node.key, node, files, levels, levels.finest))
    return sorted(found, key=lambda job: job.node)


def _divide_block(job: SquareJob) -> list[SquareJob]:
    """Return the quarters of a block that was too large, none of the finest level of squares."""
    if job.node.level == job.levels.tree.levels:
        return []
    return [replace(job, key=node.key, node=node) for node in job.node.children]


def _list_groups(folder: Path, levels: _Levels, meshes: Mapping[Node, str]) -> list[SquareJob]:
    """Return blocks of squares that are simplified, each with the squares around it."""
    found = []
    for level in range(levels.first, levels.finest):
        own = {(node.x >> _GROUP, node.y >> _GROUP) for node in meshes if node.level == level}
        for x, y in sorted(own):
            columns, rows = (
                range(
                    (place << _GROUP) - _SQUARES_BESIDE,
                    ((place + 1) << _GROUP) + _SQUARES_BESIDE,
                )
                for place in (x, y)
            )
            around = (Node(level, column, row) for column in columns for row in rows)
            files = tuple(meshes[node] for node in around if node in meshes)
            node = Node(level - _GROUP, x, y)
            key = f"{level}.{x}.{y}"
            found.append(SquareJob(folder, _GRID, key, node, files, levels, level))
    return found


def _list_encoding(
    folder: Path,
    levels: _Levels,
    grids: Sequence[tuple[int, str, Record]],
    *,
    is_gzipped: bool,
) -> list[SquareJob]:
    """Return a task for each file of tiles on a grid; heights of a level have one step."""
    found = []
    for level in range(levels.first, levels.finest + 1):
        own = [(key, one) for one_level, key, one in grids if one_level == level]
        ranges = [tile[2:] for _, one in own for tile in one.values.get("tiles", ())]
        if not ranges:
            raise PointsError(describe_small(level))
        writing = choose_height_step(np.array(ranges)), is_gzipped
        for key, one in own:
            files = tuple(name for name in one.files if name.endswith(_SUFFIX))
            if files:
                node = Node(level, 0, 0)
                found.append(SquareJob(folder, _TILES, key, node, files, levels, level, writing))
    return found


# ------------------------------------------------------------------------- tasks of squares


def cut_block(job: SquareJob) -> Record:
    """Cut a block into tiles of the finest level, and into squares that are simplified."""
    return do_task(job.folder, job.phase, job.key, lambda: _cut_block(job))


def _cut_block(job: SquareJob) -> Made:
    levels, node = job.levels, job.node
    places = _load_places(job)
    if not len(places.triangles):
        return 0, {}, []
    names, told = _save_tiles(job, LevelTiles(places, levels.finest))
    if levels.finest > levels.first:
        tree = levels.tree
        triangles = places.triangles.astype(np.int32)
        finest = list_finest(places.points, triangles, node, tree, _share(tree.levels))
        squares = raise_levels(dict(finest), max(node.level, levels.first), levels.simplify)
        names += [save_mesh(job.folder / job.phase, square, mesh) for square, mesh in squares]
    return len(places.points), told, names


def _load_places(job: SquareJob) -> Places:
    """Return the triangles that meet a block, or a tile beside it."""
    box, beside = job.levels.tree.find_box(job.node), 180.0 / 2**job.levels.finest * _BESIDE
    parts = []
    for name in job.files:
        with np.load(job.folder / name) as found:
            points, triangles = found["points"], found["triangles"].astype(np.int64)
        corners = (points[:, :2] + FROM_CORNER[:2])[triangles]
        low, high = corners.min(axis=1), corners.max(axis=1)
        is_near = (low[:, 0] <= box.xmax + beside) & (high[:, 0] >= box.xmin - beside)
        is_near &= (low[:, 1] <= box.ymax + beside) & (high[:, 1] >= box.ymin - beside)
        parts.append((points, triangles[is_near]))
    joined = _join_places(parts)
    return Places(joined.points + FROM_CORNER, joined.triangles)


def _join_places(parts: Sequence[tuple[Float64Array, Any]]) -> Places:
    firsts = np.cumsum([0, *(len(points) for points, _ in parts)])
    triangles = [
        part.astype(np.int64) + first for (_, part), first in zip(parts, firsts, strict=False)
    ]
    return Places.of(np.concatenate([points for points, _ in parts]), np.concatenate(triangles))


def compute_node(job: NodeJob) -> Record:
    """Make a square of those below it."""

    def compute_square() -> Made:
        mesh = _Levels(**job.options).simplify(job.load(), job.node)
        return len(mesh.points), {}, [save_mesh(job.folder / job.phase, job.node, mesh)]

    return do_task(job.folder, job.phase, job.key, compute_square)


def put_on_grid(job: SquareJob) -> Record:
    """Make tiles of squares that were simplified."""

    def compute_tiles() -> Made:
        meshes = [load_mesh(job.folder / name) for name in job.files]
        places = _join_places([(mesh.points, mesh.triangles) for mesh in meshes])
        names, told = _save_tiles(job, LevelTiles(places, job.level))
        return len(places.points), told, names

    return do_task(job.folder, job.phase, job.key, compute_tiles)


def _save_tiles(job: SquareJob, tiles: LevelTiles) -> tuple[list[str], dict[str, Any]]:
    """Write the tiles in a block to one file; return its name, and what is told of them."""
    shift = job.level - job.node.level
    home = job.node.x, job.node.y
    own = [k for k, one in enumerate(tiles.names) if (one.x >> shift, one.y >> shift) == home]
    if not own:
        return [], {}
    found = [tiles.gather(k) for k in own]
    names = [tiles.names[k] for k in own]
    name = f"{job.key}{_SUFFIX}"
    with replacing(job.folder / job.phase / name) as file:
        np.savez(
            file,
            names=np.array([[one.x, one.y] for one in names], np.int64),
            counts=np.array([[len(one.steps), len(one.triangles)] for one in found], np.int64),
            **{  # type: ignore[arg-type]
                kind: np.concatenate([getattr(one, kind) for one in found])
                for kind in GridTile._fields
            },
        )
    ranges = tiles.ranges[own].tolist()
    told = [[one.x, one.y, *limits] for one, limits in zip(names, ranges, strict=True)]
    return [name], {"tiles": told}


def _load_tiles(path: Path, level: int) -> Iterator[tuple[TileName, GridTile]]:
    with np.load(path) as found:
        arrays = dict(found)
    of_vertices, of_triangles = np.cumsum(arrays["counts"], axis=0)[:-1].T
    parts = [
        np.split(arrays[kind], of_triangles if kind == "triangles" else of_vertices)
        for kind in GridTile._fields
    ]
    for (x, y), *tile in zip(arrays["names"].tolist(), *parts, strict=True):
        yield TileName(level, x, y), GridTile(*tile)


def encode_tiles(job: SquareJob) -> Record:
    """Write the files of tiles."""

    def encode() -> Made:
        step, is_gzipped = job.writing
        names = []
        for name, tile in _load_tiles(job.folder / job.files[0], job.level):
            names.append(f"{name.level}.{name.x}.{name.y}.terrain")
            with replacing(job.folder / job.phase / names[-1]) as file:
                file.write(encode_file(tile.round(step), name, is_gzipped=is_gzipped))
        return len(names), {}, names

    return do_task(job.folder, job.phase, job.key, encode)


# ------------------------------------------------------------------------- the folder


@dataclass(frozen=True, eq=False)
class GlobeTiles:
    """All tiles, in the folder of the run.

    Attributes
    ----------
    crs : CRS
    corners : pair of (3,) float64 array
        Between which the surface lies: longitude, latitude and height.
    files : mapping of TileName to Path
    is_gzipped : bool
    index : str
        File by which a folder of them is known.
    """

    crs: CRS
    corners: tuple[Float64Array, Float64Array]
    files: Mapping[TileName, Path]
    is_gzipped: bool
    index: str = INDEX

    def write(self, folder: Path) -> None:
        """Write the tiles, those without a surface too, and the file that names them."""
        if not has_heights(self.crs):
            warn(describe_heights(self.crs))
        finest = max(name.level for name in self.files)
        available: list[list[TileName]] = [[] for _ in range(finest + 1)]
        for name, path in self.files.items():
            available[name.level].append(name)
            shutil.copyfile(path, find_file(folder, name))
        for level, names in enumerate(available):
            more = list_missing(level, names) if names else list_bare(*self.corners, level)
            write_bare(folder, more, is_gzipped=self.is_gzipped)
            names += more
        with replacing(folder / INDEX, binary=False) as file:
            file.write(json.dumps(describe_layer(*self.corners, available), indent=1) + "\n")


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> GlobeTiles:
    """Return all tiles with their files."""
    crs = points.crs
    if crs is None:
        raise CrsError("The CRS of the points is not known.")
    filled = [record for record in records.values() if "low" in record.values]
    files = {
        TileName(*map(int, name.rpartition("/")[2].split(".")[:3])): folder / name
        for record in records.values()
        for name in record.files
        if name.endswith(".terrain")
    }
    return GlobeTiles(crs, _join_corners(filled), files, options["gzipped"])


PRODUCT = TileProduct(
    check_options,
    compute,
    join,
    index=INDEX,
    has_lines=False,
    settle_options=settle_options,
    combine=combine,
)
