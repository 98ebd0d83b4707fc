"""Points in many files, as one surface that is computed tile by tile."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from .. import __version__
from ..base.atomic import as_path, replacing, require_writable
from ..base.checks import is_finite_number
from ..base.crs import CRS, Unit, shorten_crs
from ..base.errors import OptionError, choice
from ..base.policies import DuplicatePolicy
from ..base.sentences import counted
from ..base.types import Bounds
from ..io.reading import list_files
from ..io.registry.lookup import find_format
from ..io.streaming import SourceHeader, describe_source
from ..io.writing import write as write_file
from .chunks import BYTES_ON_DISK
from .division import Tile, divide
from .how import How, Way, estimate_memory
from .reading import StoredPoints, read_inputs
from .runs import Fingerprint, Run
from .store import count_by_cells
from .tasks import PHASE, TileJob, compute_tile, divide_job

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from ..base.crs import CrsLike, UnitLike

__all__ = ["Plan", "TiledPoints", "tiles"]

_LATTICE = 1024
"""Rows and columns of the cells in which points are counted before tiles are cut."""
_SUFFIX = ".run"
_BYTES_OF_A_POINT = 30
"""Of text."""
_POINTS_PER_SECOND = 500_000.0
"""That a worker reads, triangulates and writes, about."""
_POINTS = "points"
_CLASSES = "classification"
_TILES = "tiles.json"


@dataclass(frozen=True)
class Plan:
    """What a run would do.

    Attributes
    ----------
    count : int
        Points, about: those of all classes, before any choice.
    tiles : int
        About.
    tile_points : int
        Points of a tile, at most.
    workers : int
    memory : int
        Bytes of a worker.
    disk : int
        Bytes in the folder of the run, at most.
    seconds : float
        About, on a usual processor.
    """

    count: int
    tiles: int
    tile_points: int
    workers: int
    memory: int
    disk: int
    seconds: float


def tiles(
    paths: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    *,
    where: Mapping[str, float | Sequence[float]] | None = None,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    duplicates: DuplicatePolicy = "mean",
    store: str | os.PathLike[str] | None = None,
    **options: Any,
) -> TiledPoints:
    """Take points in files as one surface, of which only tiles are in memory.

    Parameters
    ----------
    paths : path-like or sequence of path-like
        Files, or a folder of files of points of one format. Only headers are read.
    where : mapping of str to number or sequence, optional
        Values of attributes that points must have: ``{"classification": 2}``.
    crs, elevation_unit, **options
        As of :func:`tinsmith.read`, for every file.
    duplicates : {"mean", "first", "last", "lowest", "highest", "error"}
        As of :func:`tinsmith.triangulate`.
    store : path-like, optional
        Folder in which the points are kept for further products. Default they are read again for
        each.

    Returns
    -------
    TiledPoints

    Raises
    ------
    ReadError
        If a file is missing or damaged, as far as its header tells.
    CrsError
        If files are in several coordinate reference systems, and ``crs`` does not say which is
        wanted.
    OptionError
        If an option has a value that it cannot have.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> points = np.random.default_rng(1).random((500, 3)) * 100
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(ts.Survey(points=points), Path(folder, "points.csv"))
    ...     made = ts.tiles(path).rasterize(Path(folder, "dtm.tif"), spacing=5.0, workers=1)
    ...     made.name
    'dtm.tif'
    """
    choice("duplicates", duplicates, DuplicatePolicy)
    files = _list_files(paths, options.get("format"))
    wanted = {name: _as_values(name, values) for name, values in (where or {}).items()}
    read = {name: value for name, value in options.items() if value is not None}
    if crs is not None:
        read["crs"] = str(CRS.of(crs))
    if elevation_unit is not None:
        read["elevation_unit"] = Unit.of(elevation_unit).text
    headers = tuple(describe_source(file, **read) for file in files)
    return TiledPoints(
        headers=headers,
        where=wanted,
        duplicates=duplicates,
        store=None if store is None else as_path(store, "store"),
        options=read | _choose_attributes(headers, wanted, read),
    )


def _choose_attributes(
    headers: Sequence[SourceHeader], where: Mapping[str, list[float]], read: Mapping[str, Any]
) -> dict[str, Any]:
    """Return options of readers by which only those attributes are read that are looked at."""
    known = {name for one in headers for name in find_format(one.format).options("read")}
    chosen: dict[str, Any] = {}
    if "attributes" in known:
        chosen["attributes"] = list(where)
    if "classes" in known and _CLASSES in where and "classes" not in read:
        chosen["classes"] = [int(value) for value in where[_CLASSES]]
    return chosen


@dataclass(frozen=True, repr=False)
class TiledPoints:
    """Points in files, as one surface; what is computed of it does not depend on tiles.

    Attributes
    ----------
    headers : tuple of SourceHeader
        What each file says of itself.
    where : mapping of str to list of float
        Values of attributes that points must have.
    duplicates : str
        What becomes of points at one place.
    store : Path or None
        Folder in which points are kept.
    options : mapping
        Of the reader.
    """

    headers: tuple[SourceHeader, ...]
    where: Mapping[str, list[float]] = field(default_factory=dict)
    duplicates: DuplicatePolicy = "mean"
    store: Path | None = None
    options: Mapping[str, Any] = field(default_factory=dict)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files, in the order in which their points are numbered."""
        return tuple(header.path for header in self.headers)

    @property
    def count(self) -> int | None:
        """Points that the headers name, before any choice; None where one does not tell."""
        counts = [header.count for header in self.headers]
        return None if None in counts else sum(count for count in counts if count is not None)

    @property
    def count_about(self) -> int:
        """Points, as the headers name them, or by the size of files that do not tell."""
        return sum(
            header.size // _BYTES_OF_A_POINT if header.count is None else header.count
            for header in self.headers
        )

    def plan(self, **way: Unpack[Way]) -> Plan:
        """Tell what a run would do, by the headers alone.

        Parameters
        ----------
        **way
            See :class:`Way`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.tiles("sample_data/site_survey.csv").plan(workers=1).tiles
        1
        """
        how = How.of(**way)
        count = self.count_about
        return Plan(
            count=count,
            tiles=max(how.tiles, -(-count // how.tile_points)),
            tile_points=how.tile_points,
            workers=how.workers,
            memory=estimate_memory(min(count, how.tile_points)),
            disk=count * BYTES_ON_DISK,
            seconds=count / _POINTS_PER_SECOND / how.workers,
        )

    def __repr__(self) -> str:
        count = "an unknown number of points" if self.count is None else f"{self.count:,} points"
        crs = shorten_crs(self.headers[0].crs)
        return f"<TiledPoints: {count} in {counted(len(self.headers), 'file')}, crs {crs}>"

    def rasterize(
        self,
        path: str | os.PathLike[str],
        *,
        spacing: float | None = None,
        like: Any = None,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        value: str = "elevation",
        **way: Unpack[Way],
    ) -> Path:
        """Write a raster, as :func:`tinsmith.rasterize` makes it of the whole surface.

        Parameters
        ----------
        path : path-like
        spacing, like, value
            As of :func:`tinsmith.rasterize`.
        format : str, optional
            Name of a format of rasters, to choose it whatever the suffix.
        write : mapping, optional
            Options of the writer.
        **way
            How the run is carried out, see :class:`Way`.

        Returns
        -------
        Path
            The file written: the same bytes for any tiles, workers and interruptions.

        Raises
        ------
        ReadError
            If a file cannot be read, or a tile not be computed; what is done is kept.
        WriteError
            If the output or the folder of the run cannot be written.
        """
        output = as_path(path)
        asked = {"spacing": spacing, "like": like, "value": value}
        with self.computing("raster", output, How.of(**way), **asked) as made:
            return write_file(made, output, format=format, **(write or {}))

    # ----------------------------------------------------------------- the steps of a run

    @contextmanager
    def computing(self, product: str, output: Path, how: How, **asked: Any) -> Iterator[Any]:
        """Read what is not read yet, compute what no record says is done, and yield the product.

        Parameters
        ----------
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
        require_writable(output)
        module = import_module(f"{__package__}.products.{product}")
        options = module.check_options(**asked)
        sources = [Fingerprint.take(file) for file in self.files]
        run = Run(how.run or output.with_name(output.name + _SUFFIX))
        points_run = Run(self.store or run.folder / _POINTS)
        with (
            run.opened(self._describe(product, options, sources), restart=how.restart),
            points_run.opened(self._describe(_POINTS, {}, sources), restart=how.restart),
        ):
            with how.started() as start:
                points = read_inputs(
                    points_run, sources, start("Reading"), options=self.options, where=self.where
                )
                settled = module.settle_options(points, options)
                jobs = [
                    TileJob(run.folder, points_run.folder, tile, product, settled, self.duplicates)
                    for tile in _find_tiles(run, points, how)
                ]
                step = start("Triangulating")
                records = step.run(run, PHASE, compute_tile, jobs, divide=divide_job)
            yield module.join(points, settled, records, run.folder)
        if not how.keep:
            run.remove()

    def _describe(
        self, product: str, options: Mapping[str, Any], sources: Sequence[Fingerprint]
    ) -> dict[str, Any]:
        """Return what a run computes, and from what."""
        reading = {"duplicates": self.duplicates, "where": dict(self.where), **self.options}
        return {
            "version": __version__,
            "product": product,
            "options": {**reading, **options},
            "inputs": [asdict(one) for one in sources],
        }


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


def _list_files(paths: Any, name: str | None) -> list[Path]:
    """Return all files, those of a folder in the order of their names."""
    given = list(paths) if isinstance(paths, list | tuple) else [paths]
    if not given:
        raise OptionError("paths", paths, "the name of a file or folder, or a list of at least one")
    files = []
    for one in given:
        path = as_path(one, "paths")
        files += list_files(path, name)
    return files


def _as_values(name: str, values: Any) -> list[float]:
    found = list(values) if isinstance(values, list | tuple) else [values]
    if not found or not all(map(is_finite_number, found)):
        raise OptionError("where", {name: values}, "a number, or several, for each attribute")
    return [float(value) for value in found]
