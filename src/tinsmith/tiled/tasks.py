"""The second step of a run: each tile is triangulated, and what was asked for is taken from it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.atomic import replacing
from ..base.crs import CRS, Unit
from ..base.errors import MissingExtraError, ReadError, TinsmithError, WriteError
from ..terrain.parts import are_owned, are_owned_triangles
from ..tin.tiling import LocalTriangulation, find_differing, intersect, triangulate_box, widen
from .division import Tile, divide, quarter
from .lines import open_lines
from .reading import name_rows, open_store
from .running import FINAL, Record, Run, hash_file

if TYPE_CHECKING:
    from pathlib import Path

    from ..base.arrays import AnyArray, Float64Array, Int64Array
    from ..base.policies import DuplicatePolicy
    from ..base.types import Bounds
    from .lines import StoredLines
    from .reading import StoredPoints
    from .running import Phase
    from .store import PointStore

PHASE = "tiles"
_FEWEST_TO_DIVIDE = 1_000
HALO = 10.0
"""Mean distances between points that are read around a box at once: more does not settle more
triangles (their circles leave any margin where points are sparse), less leads to more questions."""


@dataclass(frozen=True)
class TileJob:
    """A tile of which a product is to be computed.

    Attributes
    ----------
    folder : Path
        Of the run.
    points : Path
        Folder of the points.
    tile : Tile
    product : str
        Module in ``tinsmith.tiled.products``.
    options : mapping
        Plain values.
    duplicates : str
        What becomes of points at one place.
    lines : Path or None
        File of the lines of the surface.
    is_told : bool
        Whether places at which points differ in elevation are counted, for a note.
    """

    folder: Path
    points: Path
    tile: Tile
    product: str
    options: Mapping[str, Any] = field(default_factory=dict)
    duplicates: DuplicatePolicy = "mean"
    lines: Path | None = None
    is_told: bool = True

    @property
    def key(self) -> str:
        """Name of the task."""
        return self.tile.key


class Part(NamedTuple):
    """A tile with the points of the run, of which triangles are asked."""

    job: TileJob
    store: PointStore
    differing: dict[Bounds, Float64Array]
    """Places at which points differ in elevation, and by how much, of boxes that were looked at."""

    @property
    def folder(self) -> Path:
        """Where files of the tile are written."""
        return self.job.folder / PHASE

    @property
    def lines(self) -> StoredLines | None:
        """The lines of the surface, if it has any."""
        return None if self.job.lines is None else open_lines(self.job.lines)

    def triangulate(
        self, box: Bounds, *, rings: int = 0, ordered: bool = True
    ) -> LocalTriangulation:
        """Return all triangles of the whole surface that meet a closed box, and rings of others."""
        lines, around = self.lines, widen(box, self._halo)
        local = triangulate_box(
            self.store,
            box,
            around=around,
            lines=None if lines is None else lines.noded,
            duplicates=self.job.duplicates,
            rings=rings,
            ordered=ordered,
        )
        self.differing[around] = local.differing
        return local

    @property
    def may_have_surface(self) -> bool:
        """Whether the tile meets the bounds that lines leave of the surface."""
        if self.lines is None:
            return True
        box, bounds = self.job.tile.box, self.lines.bounds
        is_across = box.xmin <= bounds.xmax and box.xmax >= bounds.xmin
        return is_across and box.ymin <= bounds.ymax and box.ymax >= bounds.ymin

    @property
    def _halo(self) -> float:
        tile, bounds = self.job.tile, self.store.bounds
        width = min(tile.box.xmax, bounds.xmax) - max(tile.box.xmin, bounds.xmin)
        height = min(tile.box.ymax, bounds.ymax) - max(tile.box.ymin, bounds.ymin)
        area = max(width, 0.0) * max(height, 0.0)
        return HALO * math.sqrt(area / max(tile.count, 1))


def measure_differing(
    store: PointStore, box: Bounds, looked_at: Mapping[Bounds, Float64Array]
) -> list[float]:
    """Return at how many places in a tile points differ in elevation, and by how much at most.

    Parameters
    ----------
    store : PointStore
    box : Bounds
        Of the tile.
    looked_at : mapping of Bounds to (k, 3) float64 array
        What triangulations have found of such places in boxes, see
        :class:`tinsmith.tin.tiling.LocalTriangulation`. Points are read where none of these holds
        all of the tile.
    """
    inside = intersect(box, store.bounds)
    found = next((one for around, one in looked_at.items() if _holds(around, inside)), None)
    if found is None:
        found = find_differing(store.read_box(inside).points)
    is_own = are_owned(found, box)
    return [int(is_own.sum()), float(found[is_own, 2].max(initial=0.0))]


def _holds(outer: Bounds, inner: Bounds) -> bool:
    is_wide = outer.xmin <= inner.xmin and outer.xmax >= inner.xmax
    return is_wide and outer.ymin <= inner.ymin and outer.ymax >= inner.ymax


def save_arrays(part: Part, **arrays: AnyArray) -> list[str]:
    """Write arrays of a tile to one file, and return its name."""
    name = f"{part.job.key}.npz"
    with replacing(part.folder / name) as file:
        np.savez(file, **arrays)  # type: ignore[arg-type]
    return [name]


def load_arrays(folder: Path, record: Record) -> dict[str, AnyArray]:
    """Return what :func:`save_arrays` wrote of a tile."""
    (name,) = record.files
    with np.load(folder / name) as found:
        return dict(found)


def measure_elevations(local: LocalTriangulation, box: Bounds) -> dict[str, Any]:
    """Return the lowest and the highest elevation of the triangles that a tile owns."""
    z = local.points[local.triangles[are_owned_triangles(local, box)], 2]
    return {"elevations": [float(z.min()), float(z.max())]} if z.size else {}


def join_elevations(records: Mapping[str, Record]) -> tuple[float, float]:
    """Return those of the surface, of the records of all tiles."""
    found = [one.values["elevations"] for one in records.values() if "elevations" in one.values]
    return min(low for low, _ in found), max(high for _, high in found)


Made = tuple[int, Mapping[str, Any], list[str]]
"""What a task made: points, plain values, and the names of files in the folder of its step."""


def add_units(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options with the CRS and the unit of elevations of all points, as plain values."""
    crs, unit = points.crs, points.elevation_unit
    return {
        **options,
        "crs": None if crs is None else str(crs),
        "elevation_unit": None if unit is None else unit.text,
    }


def find_reference(options: Mapping[str, Any]) -> tuple[CRS | None, Unit | None]:
    """Return the CRS and the unit of elevations that :func:`add_units` wrote into options."""
    return CRS.of(options["crs"]), Unit.of(options["elevation_unit"] or None)


def keep_records(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record], phase: Phase
) -> Mapping[str, Record]:
    """Return the records of all tiles: of a product without further steps."""
    del run, options, phase
    return records


def divide_job(job: TileJob) -> list[TileJob]:
    """Return the quarters of a tile that was too large, none if it has few points."""
    if job.tile.count < _FEWEST_TO_DIVIDE:
        return []
    bounds = open_store(job.points).bounds
    return [replace(job, tile=tile) for tile in quarter(job.tile, bounds)]


def divide_plane(
    options: Mapping[str, Any],
    counts: Int64Array,
    bounds: Bounds,
    *,
    most: int,
    fewest_tiles: int,
) -> list[Tile]:
    """Return tiles of about equally many points, whatever the options are."""
    del options
    return divide(counts, bounds, most=most, fewest_tiles=fewest_tiles)


@dataclass(frozen=True)
class TileProduct:
    """How a product is computed in tiles; each module of products has one, ``PRODUCT``.

    Attributes
    ----------
    check_options : callable
        Returns plain options of what a caller asked for, or refuses what is none.
    compute : callable
        Computes a :class:`Part`, and returns points, plain values, and the names of files.
    join : callable
        Returns the product, of all points, the options, the records of all tiles, and the folder.
    settle_options : callable
        Returns options that depend on all points, too; those of another cloud follow.
    combine : callable
        Does further steps with the records of all tiles, and returns all records.
    divide_points : callable
        Returns the tiles, by the options and where points lie.
    divide_job : callable
        Returns the parts of a tile that was too large.
    index : str
        Of one that writes a folder: the file in it by which such a folder is known.
    has_lines : bool
        Whether the surface may have lines, as that of a raster with voids has.
    has_all_tiles : bool
        Whether tiles that the surface does not reach have something, too.
    is_of_surface : bool
        Whether it is computed from triangles.
    """

    check_options: Callable[..., Mapping[str, Any]]
    compute: Callable[[Part], Made]
    join: Callable[[StoredPoints, Mapping[str, Any], Mapping[str, Record], Path], Any]
    settle_options: Callable[..., Mapping[str, Any]] = add_units
    combine: Callable[
        [Run, Mapping[str, Any], Mapping[str, Record], Phase], Mapping[str, Record]
    ] = keep_records
    divide_points: Callable[..., list[Tile]] = divide_plane
    divide_job: Callable[[TileJob], list[TileJob]] = divide_job
    index: str = ""
    has_lines: bool = True
    has_all_tiles: bool = False
    is_of_surface: bool = True


def find_product(name: str) -> TileProduct:
    """Return a product by the name of its module."""
    found: TileProduct = import_module(f"{__package__}.products.{name}").PRODUCT
    return found


def do_task(
    folder: Path,
    phase: str,
    key: str,
    compute: Callable[[], Made],
    explain: Callable[[TinsmithError], str] = str,
) -> Record:
    """Do a task, and write its record; what is wrong becomes the record's sentence.

    Parameters
    ----------
    folder : Path
        Of the run.
    phase : str
        Step, and folder of its files.
    key : str
        Name of the task.
    compute : callable
    explain : callable
        Returns the sentence of an error.

    Raises
    ------
    WriteError
        If the folder cannot be written, which is no fault of the task.
    """
    started = perf_counter()
    what = "Tile" if phase == PHASE else "Square"
    (folder / phase).mkdir(exist_ok=True)
    try:
        points, values, names = compute()
        record = Record(
            key,
            "done" if points else "empty",
            seconds=perf_counter() - started,
            points=points,
            values=values,
            files={f"{phase}/{name}": hash_file(folder / phase / name) for name in names},
        )
    except WriteError:
        raise
    except MemoryError:
        return Record(key, "no memory", f"{what} {key} needs more memory than there is.")
    except TinsmithError as error:
        sentence = f"{what} {key}: {explain(error)}"
        is_final = not isinstance(error, ReadError | MissingExtraError)
        seconds, values = perf_counter() - started, {FINAL: True} if is_final else {}
        record = Record(key, "failed", sentence, seconds, values=values)
    Run(folder).add(phase, record)
    return record


def compute_tile(job: TileJob) -> Record:
    """Compute what is asked of a tile, see :func:`do_task`."""

    def explain(error: TinsmithError) -> str:
        rows = getattr(error, "rows", ())
        return f"points lie at one place: {name_rows(job.points, rows)}." if rows else str(error)

    return do_task(job.folder, PHASE, job.key, lambda: _compute_tile(job), explain)


def _compute_tile(job: TileJob) -> Made:
    product = find_product(job.product)
    part = Part(job, open_store(job.points), {})
    is_wanted = part.may_have_surface or product.has_all_tiles
    points, values, names = product.compute(part) if is_wanted else (0, {}, [])
    told = {}
    if job.is_told and product.is_of_surface:
        told["differing"] = measure_differing(part.store, job.tile.box, part.differing)
    return points, {**values, **told}, names
