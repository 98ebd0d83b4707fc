"""A product of many files: what is not done yet is done, and what was done is joined."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .. import __version__
from ..base.atomic import make_folder, replacing, require_writable
from ..base.errors import ReadError, WriteError
from ..base.types import Bounds
from ..terrain.ground_filter import ATTRIBUTES
from .division import Tile, divide
from .given import Given
from .lines import describe_lines, prepare_lines
from .products.ground import name_files
from .reading import StoredPoints, read_inputs
from .runs import Fingerprint, Run
from .store import count_by_cells
from .tasks import PHASE, TileJob, compute_tile, divide_job

if TYPE_CHECKING:
    from pathlib import Path

    from .cloud import TiledPoints
    from .how import How
    from .products.ground import GroundTiles

__all__ = ["computing", "labelling"]

_LATTICE = 1024
"""Rows and columns of the cells in which points are counted before tiles are cut."""
_SUFFIX = ".run"
_POINTS = "points"
_TILES = "tiles.json"


@contextmanager
def computing(
    cloud: TiledPoints, product: str, output: Path, how: How, **asked: Any
) -> Iterator[Any]:
    """Read what is not read yet, compute what no record says is done, and yield the product.

    Parameters
    ----------
    cloud : TiledPoints
    product : str
        Module of :mod:`tinsmith.tiled.products`.
    output : Path
        Where the product is to be written; the folder of the run lies beside it.
    how : How
    **asked
        Options of the product.

    Yields
    ------
    Features, Raster or Table
        Whose blocks may lie in the folder of the run, which is removed at the end.
    """
    if output != how.run:
        require_writable(output)
    module = import_module(f"{__package__}.products.{product}")
    options = module.check_options(**asked)
    given = cloud.lines
    inputs = None
    if given is not None:
        inputs = given.gather(duplicates=cloud.duplicates, crossing=cloud.crossing)
    manifest = options
    line_files: Sequence[Fingerprint] = ()
    if given is not None and inputs is not None:
        given.require_same()
        manifest, line_files = {**options, **describe_lines(inputs)}, given.files
    sources = [Fingerprint.take(file) for file in cloud.files]
    run = Run(how.run or output.with_name(output.name + _SUFFIX))
    points_run = Run(cloud.store or run.folder / _POINTS)
    with (
        run.opened(
            _describe(cloud, product, manifest, [*sources, *line_files]), restart=how.restart
        ),
        points_run.opened(_describe(cloud, _POINTS, {}, sources), restart=how.restart),
    ):
        with how.started() as start:
            points = read_inputs(
                points_run,
                sources,
                start("Reading"),
                options=cloud.options,
                where=cloud.where,
                candidates=cloud.candidates,
            )
            points = replace(points, is_raster=cloud.is_raster)
            tiles = _find_tiles(run, points, how)
            if given is not None and inputs is not None:
                points = prepare_lines(run, points, given, inputs, start("Looking for lines"))
            settled = module.settle_options(points, _store(options, run))
            job = TileJob(
                run.folder,
                points_run.folder,
                tiles[0],
                product,
                settled,
                cloud.duplicates,
                points.lines,
            )
            jobs = [replace(job, tile=tile) for tile in tiles]
            step = start("Triangulating")
            records = step.run(run, PHASE, compute_tile, jobs, divide=divide_job)
            if hasattr(module, "list_file_jobs"):
                file_jobs = module.list_file_jobs(run, points_run, cloud.options, settled, records)
                records = start("Writing").run(run, module.FILES, module.write_file, file_jobs)
        arrays = {name: value for name, value in options.items() if isinstance(value, Given)}
        yield module.join(points, {**settled, **arrays}, records, run.folder)
    if not how.keep:
        run.remove()


@contextmanager
def labelling(cloud: TiledPoints, folder: Path, how: How, **asked: Any) -> Iterator[GroundTiles]:
    """Find the ground among points, and yield the files that have its classes.

    Parameters
    ----------
    cloud : TiledPoints
    folder : Path
        Is made if need be.
    how : How
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
    inputs = {file.resolve(): file for file in cloud.files}
    for name in name_files(list(cloud.files)):
        if (folder / name).resolve() in inputs:
            raise WriteError(
                f"Cannot write '{folder / name}': it is read. Name another folder.", path=folder
            )
    make_folder(folder)
    wanted = [*dict.fromkeys([*cloud.options.get("attributes", ()), *ATTRIBUTES])]
    chosen = replace(
        cloud,
        candidates=asked["returns"],
        options={**cloud.options, "attributes": wanted},
    )
    with computing(
        chosen, "ground", folder / f"{folder.absolute().name}.vpc", how, **asked
    ) as made:
        yield made


def _describe(
    cloud: TiledPoints, product: str, options: Mapping[str, Any], sources: Sequence[Fingerprint]
) -> dict[str, Any]:
    """Return what a run computes, and from what."""
    reading = {"duplicates": cloud.duplicates, "where": dict(cloud.where), **cloud.options}
    if cloud.candidates is not None:
        reading["candidates"] = cloud.candidates
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


def _find_tiles(run: Run, points: StoredPoints, how: How) -> list[Tile]:
    """Return the tiles of a run: those with which it was begun, else new ones."""
    path = run.folder / _TILES
    if not path.exists():
        counts = count_by_cells(points.open().chunks, points.bounds, _LATTICE)
        found = divide(counts, points.bounds, most=how.tile_points, fewest_tiles=how.tiles)
        with replacing(path, binary=False) as file:
            json.dump([[one.key, list(asdict(one.box).values()), one.count] for one in found], file)
    entries = json.loads(path.read_text(encoding="utf-8"))
    return [Tile(key, Bounds(*box), count) for key, box, count in entries]
