"""Points in many files, as one surface that is computed tile by tile."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from ..base.atomic import as_path, replacing_folder
from ..base.checks import as_flag, is_finite_number
from ..base.crs import CRS, Unit, shorten_crs
from ..base.errors import OptionError, choice
from ..base.policies import (
    CrossingPolicy,
    DuplicatePolicy,
    GridOperator,
    GroundReturns,
    OutsidePolicy,
    RasterSample,
    RasterValue,
    SlopeUnit,
)
from ..base.sentences import counted
from ..io import find_format
from ..io.reading import list_files
from ..io.registry import SourceHeader, find_writer, list_writers
from ..io.streaming import describe_source, stream_points
from ..io.writing import write as write_file
from ..terrain.gridding import describe_extent
from ..terrain.relief import PERCENTILES
from ..tin import Survey
from ..tin.validation import as_xy
from .assembling import WRITERS, find_writable
from .chunks import BYTES_ON_DISK
from .computing import computing, labelling
from .in_place import BYTES_HELD, find_obstacle
from .lines import KINDS, GivenLines, as_files
from .reading import join_bounds
from .running import RunOptions, RunSettings, estimate_memory

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ..base.crs import CrsLike, UnitLike
    from ..base.types import Bounds, GeometriesLike
    from ..tin import TIN, Breakline
    from ..tin.tiling import TilesProof

_BYTES_OF_A_POINT = 30
"""Of text."""
_POINTS_PER_SECOND = 500_000.0
"""That a worker reads, triangulates and writes, about."""
_CLASSES = "classification"
SCALES = {"3dtiles": "pyramid", "quantized-mesh": "globe_tiles"}
"""Products of squares at several scales, by format."""
OPTIONS_OF_SCALES = {
    "3dtiles": {"tolerance", "node_points"},
    "quantized-mesh": {"max_level", "gzipped"},
}
_NOT_OF_TILES = {
    "erase": "points are left out by their attributes only (`where`)",
    "water": "points within it go, and lines around it change, which no tile can tell",
    "max_edge": "what it drops from the rim inwards no tile can tell",
    "walls": "the points of all tiles tell which side of a wall is the lower one",
    "snap": "points move one after the other, all over the surface",
    "conforming": "vertices come one after the other, all over the surface",
}
"""Options of triangulation, and why tiles have them not."""


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
    in_place : int
        Files that are read in place.
    copied : dict of str to int
        Why others are not, where that was asked for, and how many these are.
    """

    count: int
    tiles: int
    tile_points: int
    workers: int
    memory: int
    disk: int
    seconds: float
    in_place: int = 0
    copied: Mapping[str, int] = field(default_factory=dict)


def tiles(
    paths: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    *,
    where: Mapping[str, float | Sequence[float]] | None = None,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    duplicates: DuplicatePolicy = "mean",
    breaklines: Sequence[Breakline | ArrayLike] | GeometriesLike = (),
    boundary: Sequence[Any] | GeometriesLike = (),
    holes: Sequence[Any] | GeometriesLike = (),
    crossing: CrossingPolicy = "split",
    store: str | os.PathLike[str] | None = None,
    in_place: bool = False,
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
    breaklines, boundary, holes : sequence of arrays, geometries, or paths of files
        As of :func:`tinsmith.triangulate`; or one or several files, as of
        :meth:`TiledPoints.with_lines`.
    crossing : {"split", "error"}
        As of :func:`tinsmith.triangulate`.
    store : path-like, optional
        Folder in which the points are kept for further products. Default they are read again for
        each.
    in_place : bool
        Read points again and again where they are, in files that have an index in space: COPC,
        rasters in tiles, GeoParquet with bounds. Needs next to no disk, and mostly more time; the
        result is the same. Other files are copied, as all are by default; ``plan`` tells which.

    Returns
    -------
    TiledPoints

    Raises
    ------
    ReadError
        If a file is missing or damaged, as far as its header tells.
    CrsError
        If files are in several coordinate reference systems, and ``crs`` does not say which is
        wanted; if lines are in another one.
    LinesError
        If a line is none, or tiles cannot have it.
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
    choice("crossing", crossing, CrossingPolicy)
    for name, why in _NOT_OF_TILES.items():
        if options.get(name):
            raise OptionError(name, options[name], f"left out for a surface in tiles: {why}")
    files = _list_files(paths, options.get("format"))
    if not isinstance(where, Mapping | None):
        raise OptionError("where", where, "a mapping of attributes to values")
    wanted = {name: _as_values(name, values) for name, values in (where or {}).items()}
    read = {name: value for name, value in options.items() if value is not None}
    if crs is not None:
        read["crs"] = str(CRS.of(crs))
    if elevation_unit is not None:
        read["elevation_unit"] = Unit.of(elevation_unit).text
    headers = tuple(describe_source(file, **read) for file in files)
    cloud = TiledPoints(
        headers=headers,
        where=wanted,
        duplicates=duplicates,
        crossing=crossing,
        store=None if store is None else as_path(store, "store"),
        in_place=as_flag("in_place", in_place),
        options=read | _choose_attributes(headers, wanted, read),
    )
    return cloud._take_lines(breaklines=breaklines, boundary=boundary, holes=holes)


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
    candidates : {"last", "all"} or None
        Returns of a pulse, where only points are taken that may be ground.
    crossing : str
        What becomes of lines that cross.
    lines : GivenLines or None
        Lines that are edges of the surface, and rings that cut it.
    in_place : bool
        Whether files that have an index in space are read where they are.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
    >>> with TemporaryDirectory() as folder:
    ...     ts.tiles(ts.write(survey, Path(folder, "points.csv")))
    <TiledPoints: an unknown number of points in 1 file, crs unknown; about 1 tile, 262 MB a worker>
    """

    headers: tuple[SourceHeader, ...]
    where: Mapping[str, list[float]] = field(default_factory=dict)
    duplicates: DuplicatePolicy = "mean"
    store: Path | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    candidates: GroundReturns | None = None
    crossing: CrossingPolicy = "split"
    lines: GivenLines | None = None
    in_place: bool = False

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
    def crs(self) -> CRS | None:
        """CRS of the points, as the first header names it, or as it was declared."""
        return self.headers[0].crs or CRS.of(self.options.get("crs"))

    @property
    def bounds(self) -> Bounds | None:
        """Bounds of the points, as the headers name them.

        None where one does not tell, or points are chosen by their attributes.
        """
        boxes = [header.bounds for header in self.headers if header.bounds is not None]
        if len(boxes) < len(self.headers) or self.where or "classes" in self.options:
            return None
        return join_bounds(boxes)

    @property
    def is_raster(self) -> bool:
        """Whether the points are the cells of one raster."""
        formats = [find_format(header.format) for header in self.headers]
        return len(formats) == 1 and formats[0].read_cells is not None

    @property
    def count_about(self) -> int:
        """Points, as the headers name them, or by the size of files that do not tell."""
        return sum(map(_count_about, self.headers))

    @property
    def obstacles(self) -> tuple[str, ...]:
        """Of each file why it is not read in place, empty where it is."""
        if not self.in_place:
            return ("is copied, as all are by default",) * len(self.headers)
        return tuple(map(find_obstacle, self.headers))

    @property
    def places(self) -> list[tuple[Bounds, int] | None]:
        """Of each file that is read in place its bounds and points, as its header tells."""
        return [
            None if why or one.bounds is None or one.count is None else (one.bounds, one.count)
            for one, why in zip(self.headers, self.obstacles, strict=True)
        ]

    def with_lines(
        self,
        *,
        breaklines: Sequence[str | os.PathLike[str]] = (),
        soft_breaklines: Sequence[str | os.PathLike[str]] = (),
        boundary: Sequence[str | os.PathLike[str]] = (),
        holes: Sequence[str | os.PathLike[str]] = (),
        drape: bool = False,
        elevation_unit: UnitLike | None = None,
    ) -> TiledPoints:
        """Add the lines of vector files, in the CRS of the points.

        They are read here, and kept in the folder of each run; a file that has changed since is
        refused.

        Parameters
        ----------
        breaklines, soft_breaklines, boundary, holes, drape, elevation_unit
            As of :func:`tinsmith.with_lines`.

        Returns
        -------
        TiledPoints

        Raises
        ------
        MissingExtraError, ReadError, CrsError, LinesError
            As :func:`tinsmith.with_lines`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> line = ts.Features.of_lines([[0.0, 0.0, 5.0], [4.0, 3.0, 7.0]], [0, 2])
        >>> with TemporaryDirectory() as folder:
        ...     kerb = ts.write(line, Path(folder, "kerb.gpkg"))
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.with_lines(breaklines=[kerb])
        <TiledPoints: an unknown number of points in 1 file, crs unknown; ...; with lines>
        """
        given = {
            "breaklines": breaklines,
            "soft_breaklines": soft_breaklines,
            "boundary": boundary,
            "holes": holes,
        }
        for name, several in given.items():
            if several and (isinstance(several, str) or as_files(several) is None):
                raise OptionError(name, several, "a list of files")
        how = {"drape": as_flag("drape", drape), "elevation_unit": elevation_unit}
        lines = self._start_lines().read(given, **how)
        return self._check_lines(lines)

    def _take_lines(self, **given: Any) -> TiledPoints:
        """Add lines that callers gave, some of them as names of files."""
        if all(isinstance(given[name], list | tuple) and not given[name] for name in KINDS):
            return self
        files = {name: as_files(given[name]) or [] for name in KINDS}
        values = {name: given[name] for name in KINDS if not files[name]}
        lines = self._start_lines().read(files)
        return self._check_lines(replace(lines, values=values))

    def _start_lines(self) -> GivenLines:
        """Return the lines so far: none, but CRS and unit of the points, in which lines are."""
        if self.lines is not None:
            return self.lines
        first = self.headers[0]
        crs, unit = first.crs, first.elevation_unit
        if find_format(first.format).describe is None:
            with stream_points(first.path, **self.options) as stream:
                crs, unit = stream.crs, stream.elevation_unit
        survey = Survey(points=np.empty((0, 3)), crs=crs, elevation_unit=unit)
        return GivenLines(survey=survey)

    def _check_lines(self, lines: GivenLines) -> TiledPoints:
        """Return the points with checked lines, if there are any."""
        inputs = lines.gather(duplicates=self.duplicates, crossing=self.crossing)
        return self if inputs is None else replace(self, lines=lines)

    def plan(self, **options: Unpack[RunOptions]) -> Plan:
        """Tell what a run would do, by the headers alone.

        Parameters
        ----------
        **options
            See :class:`RunOptions`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.plan(workers=1).tiles
        1
        """
        settings = RunSettings.of(**options)
        count, obstacles = self.count_about, self.obstacles
        copied = [header for header, why in zip(self.headers, obstacles, strict=True) if why]
        in_place = len(self.headers) - len(copied)
        return Plan(
            count=count,
            tiles=max(settings.tiles, -(-count // settings.tile_points)),
            tile_points=settings.tile_points,
            workers=settings.workers,
            memory=estimate_memory(min(count, settings.tile_points))
            + (BYTES_HELD if in_place else 0),
            disk=sum(map(_count_about, copied)) * BYTES_ON_DISK,
            seconds=count / _POINTS_PER_SECOND / settings.workers,
            in_place=in_place,
            copied=dict(Counter(filter(None, obstacles))) if self.in_place else {},
        )

    def __repr__(self) -> str:
        count = "an unknown number of points" if self.count is None else f"{self.count:,} points"
        files, crs = counted(len(self.headers), "file"), shorten_crs(self.crs)
        place = "" if self.bounds is None else f", {describe_extent(self.bounds)}"
        with_lines = "" if self.lines is None else "; with lines"
        plan = self.plan()
        run = f"about {counted(plan.tiles, 'tile')}, {plan.memory / 1e6:,.0f} MB a worker"
        return f"<TiledPoints: {count} in {files}{place}, crs {crs}; {run}{with_lines}>"

    def rasterize(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        spacing: float | None = None,
        like: Any = None,
        value: RasterValue = "elevation",
        azimuth: float = 315.0,
        altitude: float = 45.0,
        smooth: bool | None = None,
        operator: GridOperator | None = None,
        compute_edges: bool = False,
        at: RasterSample = "center",
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write a raster, as :func:`tinsmith.rasterize` makes it of the whole surface.

        Parameters
        ----------
        path : path-like
        format : str, optional
            Name of a format, to choose it whatever the suffix.
        write : mapping, optional
            Options of the writer.
        spacing, like, value, azimuth, altitude, smooth, operator, compute_edges, at
            As of :func:`tinsmith.rasterize`.
        **options
            How the run is carried out, see :class:`RunOptions`.

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

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.rasterize(Path(folder, "dtm.tif"), spacing=1.0, workers=1).name
        'dtm.tif'
        """
        light = {"azimuth": azimuth, "altitude": altitude, "smooth": smooth, "at": at}
        cells = {"operator": operator, "compute_edges": compute_edges, "bounds": self.bounds}
        asked = {"spacing": spacing, "like": like, "value": value, **cells, **light}
        return self._write("raster", asked, path, (format, write), options)

    def rasterize_counts(
        self,
        path: str | os.PathLike[str],
        *,
        spacing: float | None = None,
        like: Any = None,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write how many points lie in each cell, as :func:`tinsmith.rasterize_counts` of all.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        spacing, like
            As of :func:`tinsmith.rasterize_counts`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        OptionError
            If the points have lines, or an option has a value that it cannot have.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.rasterize_counts(Path(folder, "counts.tif"), spacing=1.0, workers=1).name
        'counts.tif'
        """
        if self.lines is not None:
            raise OptionError("lines", self.lines, "none where points are counted")
        asked = {"value": "count", "spacing": spacing, "like": like, "bounds": self.bounds}
        return self._write("counts", asked, path, (format, write), options)

    def rasterize_heights(
        self,
        path: str | os.PathLike[str],
        above: TiledPoints,
        *,
        spacing: float | None = None,
        like: Any = None,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write how high the highest point of each cell is above this surface.

        It is the canopy height model of :func:`tinsmith.rasterize_heights` of the whole.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        above : TiledPoints
            Points whose heights are measured; may be those of the same files, such as
            ``tinsmith.tiles("lidar/")`` above ``tinsmith.tiles("lidar/", classes=2)``.
        spacing, like
            As of :func:`tinsmith.rasterize_heights`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        CrsError
            If the points are in another CRS than the surface.
        OptionError
            If an option has a value that it cannot have.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> tree = ts.Survey(points=[[1, 1, 15]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     above = ts.tiles(ts.write(tree, Path(folder, "tree.csv")))
        ...     path = Path(folder, "heights.tif")
        ...     cloud.rasterize_heights(path, above, spacing=1.0, workers=1).name
        'heights.tif'
        """
        cells = {"spacing": spacing, "like": like, "bounds": self.bounds}
        asked = {"value": "height", "other": above, **cells}
        return self._write("point_rasters", asked, path, (format, write), options)

    def contours(
        self,
        path: str | os.PathLike[str],
        interval: float | None = None,
        *,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        levels: ArrayLike | None = None,
        base: float = 0.0,
        index: int | None = 5,
        bands: bool = False,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write contours, as :func:`tinsmith.contours` traces them on the whole surface.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        interval, levels, base, index
            As of :func:`tinsmith.contours`.
        bands : bool
            Write the polygons between levels, as :func:`tinsmith.contour_bands`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.contours(Path(folder, "lines.csv"), 1.0, workers=1).name
        'lines.csv'
        """
        asked: dict[str, Any] = {"interval": interval, "levels": levels, "base": base}
        if as_flag("bands", bands):
            return self._write("bands", asked, path, (format, write), options)
        return self._write("contours", {**asked, "index": index}, path, (format, write), options)

    def volume(
        self,
        path: str | os.PathLike[str],
        other: TIN | TiledPoints | None = None,
        *,
        base: Any = None,
        regions: Any = None,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write cut and fill to another surface or a base, as :func:`tinsmith.volume` of the whole.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        other : TIN or TiledPoints, optional
            Another surface, in memory or in files.
        base, regions
            As of :func:`tinsmith.volume`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.volume(Path(folder, "volume.json"), base=5.0, workers=1).name
        'volume.json'
        """
        asked = {"base": base, "other": other, "regions": regions, "crs": self.crs}
        return self._write("volume", asked, path, (format, write), options)

    def profile(
        self,
        path: str | os.PathLike[str],
        line: Any,
        *,
        interval: float | None = None,
        start: float = 0.0,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write the profile along lines, as :func:`tinsmith.profile` of the whole surface.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        line, interval, start
            As of :func:`tinsmith.profile`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.profile(Path(folder, "profile.csv"), [[0, 1], [2, 1]], workers=1).name
        'profile.csv'
        """
        asked = {"line": line, "interval": interval, "start": start}
        return self._write("profile", asked, path, (format, write), options)

    def slope_statistics(
        self,
        path: str | os.PathLike[str],
        *,
        unit: SlopeUnit = "degrees",
        percentiles: ArrayLike = PERCENTILES,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write the mean slope and its like, as :func:`tinsmith.slope_statistics`.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        unit, percentiles
            As of :func:`tinsmith.slope_statistics`.

        Returns
        -------
        Path
            That table.

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.slope_statistics(Path(folder, "slopes.csv"), workers=1).name
        'slopes.csv'
        """
        asked = {"unit": unit, "percentiles": percentiles}
        return self._write("slopes", asked, path, (format, write), options)

    def drape(
        self,
        path: str | os.PathLike[str],
        features: Any,
        *,
        outside: OutsidePolicy = "error",
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write points, lines or polygons laid on the surface, as :func:`tinsmith.drape` does.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        features, outside
            As of :func:`tinsmith.drape`.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.drape(Path(folder, "line.geojson"), [[0, 1], [2, 1]], workers=1).name
        'line.geojson'
        """
        asked = {"features": features, "outside": outside}
        return self._write("drape", asked, path, (format, write), options)

    def interpolate(
        self,
        path: str | os.PathLike[str],
        places: Any,
        *,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write the elevations at places, as :meth:`tinsmith.TIN.interpolate` of the whole surface.

        Parameters
        ----------
        path, format, write, **options
            As of :meth:`rasterize`.
        places : (k, 2) array, CRS units
            Or a table, data frame or geometries of points. A tile reads those that lie in it.

        Returns
        -------
        Path
            A table of ``easting``, ``northing`` and ``elevation``, which is missing outside the
            surface.

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        CrsError
            If the places say that they are in another CRS.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     path = cloud.interpolate(Path(folder, "places.csv"), [[2, 0], [9, 9]], workers=1)
        ...     print(path.read_text())
        easting,northing,elevation
        2.0,0.0,5.5
        9.0,9.0,
        <BLANKLINE>
        """
        output = as_path(path)
        with computing(self, "places", output, RunSettings.of(**options), places=places) as made:
            east, north = as_xy(places).T
            unit = None if self.crs is None else self.crs.horizontal_unit
            table = replace(
                made,
                columns={"easting": east, "northing": north, **made.columns},
                units={"easting": unit, "northing": unit, **made.units},
            )
            return write_file(table, output, format=format, **(write or {}))

    def build(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,  # noqa: A002 - as in write
        write: Mapping[str, Any] | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write the surface that :func:`tinsmith.triangulate` makes as one file, or a file a tile.

        One file, named with the suffix of a mesh (``surface.ply``), has the bytes of that of the
        surface in memory, of points without attributes.

        Of a folder each triangle is in one file. Vertices have the numbers that they have in
        memory: of PLY and TIN files they are the attribute ``vertex``; of GeoParquet and
        FlatGeobuf, whose triangles are polygons, the columns ``a``, ``b`` and ``c`` of the corners.
        ``surface.json`` lists the files with their bounds, counts and hashes, and names CRS and
        units.

        Parameters
        ----------
        path : path-like
            A file; or a new or empty folder, or one that this wrote, which is replaced.
        format : {"ply", "tin", "geoparquet", "flatgeobuf"}, optional
            Of a folder, default PLY; one file is PLY.
        write : mapping, optional
            Options of the writer.
        **options
            As of :meth:`rasterize`. Which triangles of a folder share a file depends on it; the
            triangles, and the numbers of vertices, do not.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        OptionError
            If the format cannot hold the numbers of vertices; of one file if it needs all of the
            surface at a time, or the surface has lines.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     made = cloud.build(Path(folder, "surface"), workers=1)
        ...     sorted(file.name for file in made.iterdir())
        ['0.ply', 'surface.json']
        """
        output = as_path(path)
        if output.is_dir() or not list_writers(output, None, "TIN"):
            asked = {"format": format or "ply", "write": write}
            return self._write_folder("surface", asked, output, options)
        if self.lines is not None:
            raise OptionError("lines", self.lines, "none for a surface in one file: write a folder")
        if write:
            raise OptionError("write", write, "left out for one file: its writer has no options")
        return self._write_blocks("surface_file", output, {"format": format}, options)

    def simplify(
        self,
        path: str | os.PathLike[str],
        tolerance: float,
        *,
        format: str | None = None,  # noqa: A002 - as in write
        node_points: int = 8_192,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write a surface of few vertices that is within a tolerance of all points.

        It is made square by square, unlike that of :func:`tinsmith.simplify`: no triangle reaches
        over a side of a square, and what is kept on sides is chosen by the elevations along these
        alone, so that squares fit. It has some more vertices for this.

        Parameters
        ----------
        path : path-like
            A file of triangles.
        tolerance : float
            Largest vertical distance of a point from the new surface, in the unit of elevations.
        format : {"ply"}, optional
            Default by the suffix.
        node_points : int
            Points of a square, about.
        **options
            As of :meth:`rasterize`; the file has the same bytes for any of it.

        Returns
        -------
        Path

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        OptionError
            If an option has a value that it cannot have, or the surface has lines.
        FormatError
            If the suffix is of no format of triangles.

        Notes
        -----
        Vertices are those of the surface, and places on sides of squares where these cut its edges,
        rounded. Sides lie on multiples of powers of two.

        Examples
        --------
        >>> import numpy as np
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> points = np.random.default_rng(1).random((500, 3)) * [100, 100, 1]
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(ts.Survey(points=points), Path(folder, "points.csv")))
        ...     made = cloud.simplify(Path(folder, "simple.ply"), 2.0, workers=1)
        ...     len(ts.read(made).points)
        16
        """
        output = as_path(path)
        if self.lines is not None:
            raise OptionError("lines", self.lines, "none where a surface is simplified in tiles")
        name = find_writable(format or find_writer(output, None, ("TIN",)).name)
        asked = {"format": name, "tolerance": tolerance, "node_points": node_points}
        with computing(self, "simplified", output, RunSettings.of(**options), **asked) as made:
            WRITERS[name](made.blocks, output)
        return output

    def write(
        self,
        path: str | os.PathLike[str],
        *,
        format: str = "3dtiles",  # noqa: A002 - as in write
        tolerance: float | None = None,
        node_points: int | None = None,
        max_level: int | None = None,
        gzipped: bool | None = None,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write the surface at several scales for globes: 3D Tiles 1.1, or quantized-mesh tiles.

        The finest squares are the surface, cut along their sides; each other one is simplified
        from the four below it. What is on a side of two squares of a level is the same in both:
        there are no cracks within a level.

        The geometric error of a square of 3D Tiles is measured: its largest vertical distance from
        the surface anywhere, and by how much the globe is curved under its longest edge.

        Of quantized-mesh tiles ``layer.json`` and the finest level have the bytes of those of the
        surface in memory (:func:`tinsmith.write`). Coarser tiles have other vertices than there:
        each holds those of the four below it within an eighth of the error that Cesium expects of
        the level.

        Parameters
        ----------
        path : path-like
            A new or empty folder, or one that this wrote, which is replaced.
        format : {"3dtiles", "quantized-mesh"}
        tolerance : float, optional
            Of 3D Tiles: within which vertices of the surface are left out on the finest level
            already, in the unit of elevations. Default none are.
        node_points : int, optional
            Of 3D Tiles: points of a square of the finest level, about. Default 8192.
        max_level, gzipped : optional
            Of quantized-mesh tiles: as of their writer.
        **options
            As of :meth:`rasterize`; the files have the same bytes for any of it.

        Returns
        -------
        Path

        Raises
        ------
        CrsError
            If the CRS is not known.
        ReadError, WriteError
            As :meth:`rasterize`.
        OptionError
            If an option has a value that it cannot have, or is of the other format.

        Warns
        -----
        LossWarning
            If elevations are not known above the ellipsoid, see ``notes`` in ``tileset.json``.

        Notes
        -----
        Positions of 3D Tiles are float32 from the middle of each content, in steps of about 2^-22
        of its width.

        References
        ----------
        Open Geospatial Consortium, 3D Tiles Specification 1.1, OGC 22-025r4 (2023);
        https://github.com/CesiumGS/quantized-mesh

        Examples
        --------
        >>> import warnings
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder, warnings.catch_warnings():
        ...     warnings.simplefilter("ignore", ts.LossWarning)
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")), crs="EPSG:32616")
        ...     made = cloud.write(Path(folder, "terrain"), workers=1)
        ...     sorted(file.name for file in made.iterdir())
        ['0', 'tileset.json']
        """
        product = SCALES[choice("format", format, tuple(SCALES))]
        if self.lines is not None:
            raise OptionError("lines", self.lines, "none for squares at several scales")
        given = {
            "tolerance": tolerance,
            "node_points": node_points,
            "max_level": max_level,
            "gzipped": gzipped,
        }
        asked = {name: value for name, value in given.items() if value is not None}
        for name in asked.keys() - OPTIONS_OF_SCALES[format]:
            raise OptionError(name, asked[name], f"left out for {format}", or_none=True)
        return self._write_folder(product, asked, path, options)

    def map(
        self,
        function: Callable[[TIN, Bounds], Any],
        *,
        run: str | os.PathLike[str],
        **options: Any,
    ) -> list[Any]:
        """Call a function for each tile, with all triangles of the whole that meet it.

        Parameters
        ----------
        function : callable
            Of a module that workers can import; takes a TIN and the tile's box, whose sides at the
            rim are infinite. A triangle that meets several tiles is in the TIN of each. What it
            returns must be picklable.
        run : path-like
            Folder of the run.
        **options
            How the run is carried out, see :class:`RunOptions`.

        Returns
        -------
        list
            What it returned, in the order of the tiles; nothing for tiles without triangles.

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`.
        OptionError
            If workers cannot import the function.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> from tinsmith.tiled.products.mapped import measure_area
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     (made,) = cloud.map(measure_area, run=Path(folder, "run"), workers=1)
        ...     made
        6.0
        """
        folder = as_path(run, "run")
        settings = RunSettings.of(**{**options, "run": folder})
        with computing(self, "mapped", folder, settings, function=function) as made:
            found: list[Any] = made
        return found

    def check(self, *, run: str | os.PathLike[str], **options: Any) -> TilesProof:
        """Prove from outside that the triangles of all tiles are one surface.

        Every inner edge has two triangles, across tiles too, which see it in opposite directions;
        the areas of all triangles add up to that of the convex hull, or of what boundary and holes
        leave of it, exactly.

        Parameters
        ----------
        run : path-like
            Folder of the run.
        **options
            How the run is carried out, see :class:`RunOptions`.

        Returns
        -------
        TilesProof
            What was counted.

        Raises
        ------
        CheckError
            At the first fault, with the tile and the edge.
        ReadError, WriteError
            As :meth:`rasterize`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> with TemporaryDirectory() as folder:
        ...     cloud = ts.tiles(ts.write(survey, Path(folder, "points.csv")))
        ...     cloud.check(run=Path(folder, "run"), workers=1).triangles
        2
        """
        folder = as_path(run, "run")
        with computing(self, "proof", folder, RunSettings.of(**{**options, "run": folder})) as made:
            found: TilesProof = made
        return found

    def ground(
        self,
        folder: str | os.PathLike[str],
        *,
        building: float = 40.0,
        cell: float = 1.0,
        terrain_slope: float = 0.12,
        iteration_angle: float = 20.0,
        iteration_distance: float = 1.4,
        edge_length: float = 5.0,
        tolerance: float = 0.3,
        horizontal_tolerance: float = 1.0,
        noise_depth: float = 1.0,
        returns: GroundReturns = "last",
        reach: float | None = None,
        ground_only: bool = False,
        **options: Unpack[RunOptions],
    ) -> Path:
        """Write every lidar file again with the classes that :func:`tinsmith.ground` tells.

        Parameters
        ----------
        folder : path-like
            Is made if need be. Files have the names of the inputs, and replace others of these
            names; an input is never replaced.
        building, cell, terrain_slope, iteration_angle, iteration_distance : float
            As of :func:`tinsmith.ground`.
        edge_length, tolerance, horizontal_tolerance, noise_depth, returns
            As of :func:`tinsmith.ground`.
        reach : float, optional
            How far around a tile points are looked at, metres. Default three times ``building``.
        ground_only : bool
            Write ground points alone.
        **options
            How the run is carried out, see :class:`RunOptions`.

        Returns
        -------
        Path
            The virtual point cloud (``.vpc``) in the folder, which names all files; the folder
            where the CRS is not known.

        Raises
        ------
        ReadError, WriteError
            As :meth:`rasterize`. If the inputs are no lidar files, or their points were converted.
        OptionError
            If a parameter has a value that it cannot have.

        Notes
        -----
        All files have the same bytes for any workers and interruptions. Other tiles may change a
        label where the filter reaches further than ``reach``: docs/many-files.md tells how many.

        Examples
        --------
        >>> import numpy as np
        >>> import tinsmith as ts
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> points = np.random.default_rng(1).random((500, 3)) * [100, 100, 1]
        >>> with TemporaryDirectory() as folder:
        ...     path = ts.write(ts.Survey(points=points), Path(folder, "points.laz"))
        ...     made = ts.tiles(path).ground(Path(folder, "ground"), workers=1)
        ...     [one.name for one in made.iterdir()]
        ['points.laz']
        """
        output = as_path(folder, "folder")
        parameters = {
            "building": building,
            "cell": cell,
            "terrain_slope": terrain_slope,
            "iteration_angle": iteration_angle,
            "iteration_distance": iteration_distance,
            "edge_length": edge_length,
            "tolerance": tolerance,
            "horizontal_tolerance": horizontal_tolerance,
            "noise_depth": noise_depth,
            "returns": returns,
        }
        asked = {"reach": reach, "ground_only": ground_only, **parameters}
        with labelling(self, output, RunSettings.of(**options), **asked) as made:
            return made.move(output)

    def _write(
        self,
        product: str,
        asked: Mapping[str, Any],
        path: str | os.PathLike[str],
        writing: tuple[str | None, Mapping[str, Any] | None],
        run_options: RunOptions,
    ) -> Path:
        output = as_path(path)
        name, options = writing
        with computing(self, product, output, RunSettings.of(**run_options), **asked) as made:
            return write_file(made, output, format=name, **(options or {}))

    def _write_blocks(
        self, product: str, output: Path, asked: Mapping[str, Any], options: RunOptions
    ) -> Path:
        """Write one file, in the format that is asked for or else by its suffix."""
        name = asked["format"] or list_writers(output, None, "TIN")[0].name
        writer = WRITERS[find_writable(name)]
        with computing(
            self, product, output, RunSettings.of(**options), **{**asked, "format": name}
        ) as made:
            writer(made, output)
        return output

    def _write_folder(
        self,
        product: str,
        asked: Mapping[str, Any],
        path: str | os.PathLike[str],
        options: RunOptions,
    ) -> Path:
        output = as_path(path)
        with (
            computing(self, product, output, RunSettings.of(**options), **asked) as made,
            replacing_folder(output, marker=made.index) as folder,
        ):
            made.write(folder)
        return output


def _count_about(header: SourceHeader) -> int:
    return header.size // _BYTES_OF_A_POINT if header.count is None else header.count


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
