"""A product of many files: what is not done yet is done, and what was done is joined."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import __version__
from ..base.atomic import make_folder, replacing, require_writable, require_writable_folder
from ..base.errors import OptionError, ReadError, WriteError
from ..base.types import Bounds
from ..terrain.ground_filter import ATTRIBUTES
from .division import Tile, divide
from .draping import Drape
from .given import Given
from .labelled import name_files
from .lines import describe_lines, prepare_lines
from .reading import StoredPoints, read_inputs
from .running import Fingerprint, Run
from .store import count_by_cells
from .tasks import PHASE, TileJob, compute_tile, find_product
from .voids import add_void_rings

if TYPE_CHECKING:
    from pathlib import Path

    from ..tin.building import BuildInputs
    from .labelled import GroundTiles
    from .lines import GivenLines
    from .running import Phase, RunSettings
    from .tiled_points import TiledPoints

_FEWEST_CELLS, _MOST_CELLS = 64, 1024
"""Rows and columns of the cells in which points are counted before tiles are cut."""
_CELLS_OF_A_POINT = 16
_SUFFIX = ".run"
_POINTS = "points"
_OTHERS = "others"
"""Folder of the points of another surface."""
_TILES = "tiles.json"


@contextmanager
def computing(
    cloud: TiledPoints, product: str, output: Path, settings: RunSettings, **asked: Any
) -> Iterator[Any]:
    """Read what is not read yet, compute what no record says is done, and yield the product.

    Parameters
    ----------
    cloud : TiledPoints
    product : str
        Module of :mod:`tinsmith.tiled.products`.
    output : Path
        Where the product is to be written; the folder of the run lies beside it.
    settings : RunSettings
    **asked
        Options of the product.

    Yields
    ------
    Features, Raster, Table, or what a product writes a folder of
        Whose blocks may lie in the folder of the run, which is removed at the end.
    """
    chosen = find_product(product)
    if chosen.index:
        require_writable_folder(output, marker=chosen.index)
    elif output != settings.run:
        require_writable(output)
    options = chosen.check_options(**asked)
    lines = None if cloud.lines is None else _Lines.of(cloud.lines, cloud)
    sources = _look_at(cloud)
    run = Run(settings.run or output.with_name(output.name + _SUFFIX))
    clouds = {_POINTS: cloud}
    if hasattr(asked.get("other"), "headers"):
        clouds[_OTHERS] = asked["other"]
        _require_own_store(cloud, asked["other"])
    with ExitStack() as stack:
        told, line_files = ({}, ()) if lines is None else (lines.told, lines.given.files)
        manifest = _describe(cloud, product, {**options, **told}, [*sources, *line_files])
        if _OTHERS in clouds:
            other = clouds[_OTHERS]
            manifest[_OTHERS] = _describe(other, _POINTS, {}, _look_at(other))
        stack.enter_context(run.opened(manifest, restart=settings.restart))
        with run.refused(), settings.started() as start:
            stored = [
                stack.enter_context(_reading(one, run.folder / name, start("Reading"), settings))
                for name, one in clouds.items()
            ]
            points = stored[0]
            _require_no_voids(stored[1:], "the other surface")
            if points.lattice is not None:
                if not chosen.has_lines:
                    _require_no_voids([points], "this product")
                lines = _Lines.of(add_void_rings(points, cloud.lines), cloud)
            if lines is not None:
                points = lines.prepare(points, run, settings, start)
            settled = chosen.settle_options(points, _store(options, run), *stored[1:])
            tiles = _find_tiles(run, stored[0], settings, partial(chosen.divide_points, settled))
            job = TileJob(
                run.folder,
                points.folder,
                tiles[0],
                product,
                settled,
                cloud.duplicates,
                points.lines,
            )
            jobs = [replace(job, tile=tile) for tile in tiles]
            step = start("Triangulating")
            done = step.run(run, PHASE, compute_tile, jobs, divide=chosen.divide_job)
            records = chosen.combine(run, settled, done, start("Joining"))
            points = points.tell_differing(records, cloud.duplicates)
        arrays = {name: value for name, value in options.items() if isinstance(value, Given)}
        with run.refused():
            made = chosen.join(points, {**settled, **arrays}, records, run.folder)
        run.clear_beside(output)
        yield made
    if not settings.keep:
        run.remove()


@contextmanager
def labelling(
    cloud: TiledPoints, folder: Path, settings: RunSettings, **asked: Any
) -> Iterator[GroundTiles]:
    """Find the ground among points, and yield the files that have its classes.

    Parameters
    ----------
    cloud : TiledPoints
    folder : Path
        Is made if need be.
    settings : RunSettings
    **asked
        Options of :mod:`tinsmith.tiled.products.ground`.

    Yields
    ------
    GroundTiles
        Whose files lie in the folder of the run until they are moved.
    """
    for header in cloud.headers:
        if header.format != "las":
            raise ReadError(
                f"'{header.path}' is no lidar file (LAS, LAZ): the ground of many files is written "
                "as classes of such.",
                path=header.path,
            )
    if cloud.lines is not None:
        raise OptionError("lines", cloud.lines, "none where points are classified")
    inputs = {file.resolve() for file in cloud.files}
    for name in name_files(list(cloud.files)):
        if (folder / name).resolve() in inputs:
            raise WriteError(
                f"Cannot write '{folder / name}': it is read. Name another folder.", path=folder
            )
    is_new = not folder.exists()
    make_folder(folder)
    wanted = [*dict.fromkeys([*cloud.options.get("attributes", ()), *ATTRIBUTES])]
    chosen = replace(
        cloud,
        candidates=asked["returns"],
        options={**cloud.options, "attributes": wanted},
    )
    path = folder / f"{folder.absolute().name}.vpc"
    try:
        with computing(chosen, "ground", path, settings, **asked) as made:
            yield made
    finally:
        if is_new:
            with suppress(OSError):  # files are in it
                folder.rmdir()


def _require_own_store(cloud: TiledPoints, other: TiledPoints) -> None:
    """Refuse one folder for the points of two surfaces, or of one and those above it."""
    if other.store is None or cloud.store is None:
        return
    if other.store.resolve() == cloud.store.resolve():
        raise OptionError(
            "store", str(other.store), "a folder of its own for each of both: it holds one's points"
        )


def _require_no_voids(stored: Sequence[StoredPoints], where: str) -> None:
    """Refuse rasters whose surface ends at voids where none can."""
    if any(one.lattice is not None for one in stored):
        raise ReadError(
            "The raster has cells without data, at which its surface ends, which is not available "
            f"in tiles for {where}."
        )


class _Lines(NamedTuple):
    """The lines of a surface, checked, and what the manifest tells of them."""

    given: GivenLines
    inputs: BuildInputs | None
    told: Mapping[str, Any]

    @classmethod
    def of(cls, given: GivenLines, cloud: TiledPoints) -> _Lines:
        inputs = given.gather(duplicates=cloud.duplicates, crossing=cloud.crossing)
        if inputs is None:
            return cls(replace(given, files=()), None, {})
        given.require_same()
        return cls(given, inputs, describe_lines(inputs))

    def prepare(
        self, points: StoredPoints, run: Run, settings: RunSettings, start: Callable[[str], Phase]
    ) -> StoredPoints:
        """Return points with the lines, cut where they meet, and with elevations."""
        if self.inputs is None:
            return points
        find_tiles = partial(_find_tiles, points=points, settings=settings, cut=divide)
        drape = Drape(run=run, points=points, phase=start("Draping lines"), find_tiles=find_tiles)
        return prepare_lines(self.given, self.inputs, start("Looking for lines"), drape)


def _look_at(cloud: TiledPoints) -> list[Fingerprint]:
    return [Fingerprint.take(file) for file in cloud.files]


@contextmanager
def _reading(
    cloud: TiledPoints, folder: Path, phase: Phase, settings: RunSettings
) -> Iterator[StoredPoints]:
    """Read the points of files that are not read yet, and yield them; their folder is held."""
    sources = _look_at(cloud)
    run = Run(cloud.store or folder)
    with run.opened(_describe(cloud, _POINTS, {}, sources), restart=settings.restart):
        points = read_inputs(
            run,
            sources,
            phase,
            cloud.places,
            options=cloud.options,
            where=cloud.where,
            candidates=cloud.candidates,
        )
        yield replace(points, is_raster=cloud.is_raster)


def _describe(
    cloud: TiledPoints, product: str, options: Mapping[str, Any], sources: Sequence[Fingerprint]
) -> dict[str, Any]:
    """Return what a run computes, and from what."""
    reading = {"duplicates": cloud.duplicates, "where": dict(cloud.where), **cloud.options}
    if cloud.candidates is not None:
        reading["candidates"] = cloud.candidates
    if cloud.in_place:
        reading["in_place"] = True
    return {
        "version": __version__,
        "product": product,
        "options": {**reading, **_describe_given(options)},
        "inputs": [asdict(one) for one in sources],
    }


def _describe_given(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options as plain values."""
    return {
        name: value.describe() if isinstance(value, Given) else value
        for name, value in options.items()
    }


def _store(options: Mapping[str, Any], run: Run) -> dict[str, Any]:
    """Write arrays among options into folders of the run, named as these; return plain values."""
    for name, value in options.items():
        if isinstance(value, Given):
            value.store(run.folder / name)
    return _describe_given(options)


def _find_tiles(
    run: Run, points: StoredPoints, settings: RunSettings, cut: Callable[..., list[Tile]]
) -> list[Tile]:
    """Return the tiles of a run: those with which it was begun, else new ones."""
    path = run.folder / _TILES
    if not path.exists():
        side = _FEWEST_CELLS
        while side < _MOST_CELLS and side**2 < _CELLS_OF_A_POINT * max(
            points.count, settings.tiles
        ):
            side *= 2
        counts = count_by_cells(points.open().chunks, points.bounds, side)
        found = cut(counts, points.bounds, most=settings.tile_points, fewest_tiles=settings.tiles)
        with replacing(path, binary=False) as file:
            json.dump([[one.key, list(asdict(one.box).values()), one.count] for one in found], file)
    entries = json.loads(path.read_text(encoding="utf-8"))
    return [Tile(key, Bounds(*box), count) for key, box, count in entries]
