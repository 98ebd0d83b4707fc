"""Elevation rasters of any format that GDAL reads, as points at the pixel centres."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import require_count
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError
from ...base.progress import Progress
from ...base.sentences import FILE, coordinate, counted
from ...base.types import Affine, CellStorage
from ...terrain.surface import trace_rings
from ...tin import Bounds, Survey
from ...tin.screening import ElevationSummary, parse_nodata
from ..door import names_its_file
from ..isolated import measure_free_memory
from ..registry import PointChunk, StreamEnd, StreamHead, gather, taking
from ..reprojection import Placing, place, settle_unit, stays
from .header import Header, read_header, stream_strips
from .meaning import Meaning, find_meaning, settle_axes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from contextlib import AbstractContextManager
    from typing import TypeAlias

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.progress import Tell
    from ..isolated import Answer
    from ..registry import Blocks

    OpenStrips: TypeAlias = Callable[[dict[str, Any]], AbstractContextManager[Iterator[Answer]]]

_STRIP_CELLS = 4_000_000
"""Cells read at a time, so that memory holds little but the points."""

LARGEST_RASTER = 2**31 - 1
"""Cells that can be read at most: the vertices of a TIN are numbered with 32 bits."""

BYTES_PER_CELL = 48
"""Memory for a cell: its three coordinates, once in strips and once in one array."""

LEFT_OUT = "cells between samples"
_FEWEST_CELLS = 4
_READ = 0.8
"""Of the work as it is told, what is done once all strips are read."""

_COLOURS = ("red", "green", "blue", "palette", "cyan", "magenta", "yellow", "black")

_COORDINATES = "Bounds, or four finite numbers: west, south, east and north limit"
_CELLS_ARE = "; a part in cells (column, row, width, height) is the option `cells`"


@dataclass(frozen=True, slots=True)
class Choice:
    """What of a raster is taken and where it is wanted: the options of :func:`read`."""

    crs: CrsLike | None = None
    elevation_unit: UnitLike | None = None
    band: int | None = None
    window: Sequence[float] | Bounds | None = None
    cells: Sequence[int] | None = None
    stride: int | None = None
    most_cells: int | None = None
    nodata: float | Sequence[float] | None = None
    fill: bool = False
    progress: Tell | None = None


@dataclass(frozen=True, slots=True)
class Cells:
    """The cells to read: a window, every how many of its rows and columns, within which bounds."""

    column: int
    row: int
    width: int
    height: int
    stride: int
    bounds: Bounds | None = None

    @property
    def count(self) -> int:
        """How many there are."""
        return -(-self.width // self.stride) * -(-self.height // self.stride)

    @property
    def columns(self) -> Int64Array:
        """The columns wanted."""
        return np.arange(self.column, self.column + self.width, self.stride)

    def find_rows(self, start: int, stop: int) -> Int64Array:
        """Return the rows wanted among ``start`` to ``stop``."""
        first = start + (self.row - start) % self.stride
        return np.arange(first, stop, self.stride)


@taking(Choice)
def read(path: Path, choice: Choice) -> Survey:
    """Read a raster as points, one at the centre of every cell that has an elevation.

    The points are transformed to ``crs``, nothing is resampled. ``elevation_unit`` may also be that
    of the band or that of the vertical axis of its CRS, if they differ.

    Parameters
    ----------
    band : int, optional
        Band to read, from 1; default the first.
    window : Bounds or (4,) sequence of float, optional
        Part to read: west, south, east and north limit in the raster's own CRS, which hold the
        centres of the cells wanted.
    cells : (4,) sequence of int, optional
        Part to read in cells: column and row of the first (from 0), width and height. Not with
        ``window``.
    stride : int, optional
        Read every ``stride``-th row and column only; default all.
    most_cells : int, optional
        Read so many cells at most: every n-th row and column of a larger raster, with the smallest
        n for which they are no more, which ``notes`` tell. Not with ``stride``.
    fill : bool
        Let the surface span the voids. Otherwise it ends at the cells around them, along the
        rings of ``Survey.extent``.

    Returns
    -------
    Survey
        Rows of the raster from north to south, as stored. ``skipped["nodata cells"]`` counts
        cells that are nodata, masked, NaN or infinite, ``skipped["cells between samples"]`` those
        that ``most_cells`` left out.

    Raises
    ------
    ReadError
        If GDAL cannot read the file, it is a picture or has no georeference, its CRS is in
        degrees and no other is wanted, or no cell has an elevation.
    OptionError
        If band, window, cells or stride is not one that the raster has, nodata is no number, or
        ``elevation_unit`` is unknown, or another than the raster's own.
    CrsError
        If the points cannot be transformed.
    MissingExtraError
        If rasterio is not installed.

    Notes
    -----
    Scale and offset of the band are applied. The raster is read in strips; memory is 48 bytes
    for each valid cell at most, and a strip.
    """
    header = read_header(path)
    return make_survey(header, partial(stream_strips, header), choice)


def make_survey(dataset: Header, open_strips: OpenStrips, choice: Choice) -> Survey:
    """Make a survey of the cells of a raster, as :func:`read` does.

    ``open_strips`` takes what to read, and gives the strips that ``gdal_child.read_strips`` yields.
    """
    valid: list[BoolArray] = []
    survey = gather(_read_blocks(dataset, open_strips, choice, valid), dataset.path)
    whole = np.concatenate(valid)
    return survey if choice.fill or whole.all() else _add_void_rings(survey, whole)


@taking(Choice)
def stream(path: Path, choice: Choice) -> Blocks:
    """Read a raster as points strip by strip; the options are those of :func:`read`.

    Notes
    -----
    The surface ends at voids unless ``fill`` spans them, which the end of the stream tells; the
    points alone do not.
    """
    header = read_header(path)
    return _read_blocks(header, partial(stream_strips, header), choice, None)


class Plan(NamedTuple):
    """Which cells are read, and where they are."""

    dataset: Header
    band: int
    cells: Cells
    source: CRS | None
    unit: Unit | None
    target: CRS | None
    marks: Float64Array
    said: list[str]
    """What is to be told of it."""

    @property
    def stays(self) -> bool:
        """Whether the points are not reprojected."""
        return stays(self.source, self.target)


def plan_cells(dataset: Header, choice: Choice) -> Plan:
    """Choose the cells to read, as :func:`read` tells; refuse what the header shows."""
    target = CRS.of(choice.crs)
    number, dataset, said = choose_elevations(dataset, choice.band)
    dataset, source, noted = settle_axes(dataset, target)
    declared = Unit.of(choice.elevation_unit)
    unit, noted_unit = find_elevation_unit(dataset, number, source, declared)
    cells = _choose_cells(dataset, choice)
    said = [*said, *noted, *noted_unit, *_describe_window(dataset, choice)]
    marks = parse_nodata(choice.nodata)
    return Plan(dataset, number, cells, source, unit, target, marks, said)


def _read_blocks(
    dataset: Header, open_strips: OpenStrips, choice: Choice, kept: list[BoolArray] | None
) -> Blocks:
    """Yield the points of strips; which cells are valid is added to ``kept``, if it is a list."""
    plan = plan_cells(dataset, choice)
    cells = plan.cells
    left_out = 0 if choice.most_cells is None else cells.width * cells.height - cells.count
    if kept is not None:
        _require_few_cells(cells)
    place(find_middle(plan.dataset), source=plan.source, target=plan.target)
    placing = Placing(plan.source, plan.target, plan.unit)
    heights, voids = ElevationSummary("cell", keeps_all=kept is not None), _Voids()
    n_nodata = n_points = 0
    for strip in read_strips(plan, cells, open_strips, choice.progress):
        n_nodata += strip.n_nodata
        voids.add(strip.valid)
        if kept is not None:
            kept.append(strip.valid)
        if len(strip.points) == 0:
            continue
        _require_finite_centres(strip.points, plan.band)
        heights.add(strip.points[:, 2])
        placed = placing.add(strip.points)
        if n_points == 0:
            yield StreamHead(placed.crs, placed.elevation_unit)
        n_points += len(strip.points)
        yield PointChunk(placed.points, strip.cells, {})
    _require_points(plan, n_points, n_nodata)
    has_voids = not choice.fill and not voids.is_full
    noted = [*_describe_sample(cells, left_out), *heights.describe(), *placing.finish()]
    if has_voids and kept is None:
        voids.require_surface()
        noted.append(_VOIDS_STAY)
    counts = {"nodata cells": n_nodata, LEFT_OUT: left_out}
    skipped = {name: count for name, count in counts.items() if count}
    notes = [*plan.said, *noted]
    more = {"from_raster": True}
    lattice = (plan.dataset.width, cells.stride)
    return StreamEnd(notes, skipped, more, has_voids=has_voids, lattice=lattice)


def _require_points(plan: Plan, n_points: int, n_nodata: int) -> None:
    if n_points:
        return
    if n_nodata == 0:
        raise OptionError(
            "window", plan.cells.bounds, f"an area with a cell centre of {FILE}{_CELLS_ARE}"
        )
    raise ReadError(
        f"{FILE}: of {counted(n_nodata, 'cell')} of band {plan.band}, none has an elevation but "
        "nodata.",
    )


class _Voids:
    """Whether cells have gaps between them, and three side by side, row by row."""

    def __init__(self) -> None:
        self.is_full = True
        self._has_surface = False
        self._last: BoolArray | None = None

    def add(self, valid: BoolArray) -> None:
        """Add rows of cells."""
        self.is_full &= bool(valid.all())
        rows = valid if self._last is None else np.concatenate([self._last, valid])
        self._last = rows[-1:]
        if not self._has_surface and rows.shape[0] > 1:
            pairs = rows[:-1].astype(np.int8) + rows[1:]
            self._has_surface = bool((pairs[:, :-1] + pairs[:, 1:] >= _CORNERS).any())

    def require_surface(self) -> None:
        """Refuse cells between which there is no surface."""
        if not self._has_surface:
            raise _describe_no_surface()


_CORNERS = 3
"""Cells of a square of four that make a surface."""

_VOIDS_STAY = (
    "Voids of the raster stay: the surface ends at the cells around them; the option `fill` spans "
    "them."
)


def _describe_no_surface() -> ReadError:
    return ReadError(
        f"{FILE}: no three cells side by side have an elevation, so there is no "
        "surface between voids: the option `fill` spans them."
    )


@names_its_file
def read_georeference(
    path: Path,
) -> tuple[tuple[float, ...], tuple[int, int], str | None, CellStorage]:
    """Return where the cells of a raster lie and how they are kept, read in a child.

    Returns
    -------
    transform : (6,) tuple of float
        As rasterio has it.
    shape : (2,) tuple of int
        Rows and columns.
    crs : str or None
    stored_as : CellStorage
        Of the first band.

    Raises
    ------
    ReadError
        If GDAL cannot read the file, or it has no georeference.
    MissingExtraError
        If rasterio is not installed.
    """
    dataset = read_header(path)
    _require_position(dataset)
    stored = CellStorage(dataset.dtypes[0], dataset.nodata[0])
    return tuple(dataset.transform), (dataset.height, dataset.width), dataset.crs, stored


def _add_void_rings(survey: Survey, valid: BoolArray) -> Survey:
    """Return the survey with the rings at which its surface ends."""
    rings = trace_rings(valid)
    if not rings:
        raise _describe_no_surface()
    extent = [survey.points[ring] for ring in rings]
    return replace(survey, extent=extent, notes=[*survey.notes, _VOIDS_STAY])


def is_raster(path: Path) -> bool:
    """Whether GDAL takes a file for a raster.

    Raises
    ------
    MissingExtraError
        If rasterio is not installed.
    """
    try:
        read_header(path)
    except ReadError:
        return False
    return True


# ------------------------------------------------------------------ the dataset


_NOWHERE = Affine(1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
"""What GDAL tells of a raster without a georeference."""


def choose_elevations(dataset: Header, band: int | None) -> Meaning:
    """Return the band of elevations, the one asked for or the one that the file tells.

    Raises
    ------
    ReadError
        If it is none, or the raster has no place.
    OptionError
        If there is no such band.
    """
    found = find_meaning(dataset, band, choose_band(dataset, band))
    require_elevation_band(dataset, found.band, band is not None)
    return found


def choose_band(dataset: Header, band: int | None) -> int:
    """Return the number of the band that was asked for, the first by default."""
    if dataset.count == 0:
        parts = ", ".join(dataset.subdatasets[:5])
        raise ReadError(
            f"{FILE} holds no band of its own"
            + (f" but several rasters ({parts}): extract one of them first." if parts else "."),
        )
    number = 1 if band is None else band
    if not isinstance(number, Integral) or not 1 <= number <= dataset.count:
        known = (
            "1, the only band" if dataset.count == 1 else f"one of the bands 1 to {dataset.count}"
        )
        raise OptionError("band", band, f"{known} of {FILE}")
    return int(number)


def require_elevation_band(dataset: Header, band: int, is_stated: bool) -> None:
    """Refuse pictures, complex numbers and rasters whose place is unknown."""
    meaning = dataset.colours[band - 1]
    if meaning in _COLOURS and not is_stated:
        raise ReadError(
            f"{FILE} is a picture (band 1 is its {meaning}), not a raster of elevations: name "
            "the band if one holds them.",
        )
    if dataset.dtypes[band - 1].startswith("complex"):
        raise ReadError(f"{FILE}: band {band} holds complex numbers, no elevations.")
    _require_position(dataset)


def _require_position(dataset: Header) -> None:
    """Refuse a raster whose cells have no place, or one that is no area."""
    if dataset.transform == _NOWHERE:
        raise ReadError(
            f"{FILE} has no georeference, so the coordinates of its cells are unknown: add a "
            "world file or set the transform with a GIS.",
        )
    a, b, _, d, e, _ = dataset.transform
    if (
        not np.isfinite([*dataset.transform, *dataset.bounds, a * e - b * d]).all()
        or a * e == b * d
    ):
        raise ReadError(
            f"{FILE} has the georeference {tuple(dataset.transform)}, in which a cell has no "
            "size, or none that is finite.",
        )


def find_elevation_unit(
    dataset: Header, band: int, source: CRS | None, declared: Unit | None
) -> tuple[Unit | None, list[str]]:
    """Return the unit that band, vertical axis or caller give, and a note on one not understood."""
    word = str(dataset.units[band - 1] or "").strip()
    vertical = None if source is None else source.vertical_unit
    try:
        of_band = Unit.of(word or None)
    except OptionError:
        note = f"The unit of band {band}, '{word}', is no length: the elevations have none."
        return settle_unit(declared, vertical), [] if declared or vertical else [note]
    if of_band is None or vertical is None or of_band == vertical:
        return settle_unit(declared, of_band or vertical), []
    if declared in (of_band, vertical):
        return declared, []
    raise ReadError(
        f"{FILE} gives its elevations two units: {of_band.name} (of band {band}) and "
        f"{vertical.name} (of the vertical axis of its CRS); declare the one that is right.",
    )


def find_middle(dataset: Header) -> Float64Array:
    """Return the middle of a raster as a (1, 3) array."""
    x, y = dataset.transform.apply(dataset.width / 2, dataset.height / 2)
    return np.array([[x, y, 0.0]])


# ------------------------------------------------------------------ which cells


def _choose_cells(dataset: Header, choice: Choice) -> Cells:
    stride, bounds = choice.stride, None
    part = (0, 0, dataset.width, dataset.height)
    if choice.window is not None and choice.cells is not None:
        raise OptionError("cells", choice.cells, "None where a window is given")
    if choice.window is not None:
        bounds = _parse_window(choice.window)
        part = cut_bounds(dataset, bounds)
    elif choice.cells is not None:
        part = _cut_cells(dataset, choice.cells)
    if choice.most_cells is not None:
        return Cells(*part, _choose_stride(part[2], part[3], stride, choice.most_cells), bounds)
    smaller, stride = min(part[2:]), 1 if stride is None else stride
    if not isinstance(stride, Integral) or not (1 <= stride < smaller or stride == 1):
        raise OptionError(
            "stride",
            stride,
            f"a whole number from 1 to {max(1, smaller - 1)} for the {counted(part[2], 'column')} "
            f"and {counted(part[3], 'row')} to read",
        )
    return Cells(*part, int(stride), bounds)


def _choose_stride(width: int, height: int, stride: int | None, most_cells: int) -> int:
    """Return the smallest stride that leaves so many cells, and two rows and columns at least."""
    require_count("most_cells", most_cells, least=_FEWEST_CELLS)
    if stride is not None:
        raise OptionError("most_cells", most_cells, "None where a stride is given")
    found = max(1, math.isqrt(width * height // int(most_cells)))
    while -(-width // found) * -(-height // found) > most_cells:
        found += 1
    return max(1, min(found, min(width, height) - 1))


def _describe_sample(cells: Cells, left_out: int) -> list[str]:
    if left_out == 0:
        return []
    return [
        f"One row and column of {cells.stride} is read: {cells.count:,} of "
        f"{cells.width * cells.height:,} cells."
    ]


def _parse_window(window: Sequence[float] | Bounds) -> Bounds:
    """Return bounds in coordinates; what cannot be any may be cells, for which ``cells`` is."""
    if isinstance(window, Bounds):
        window = (window.xmin, window.ymin, window.xmax, window.ymax)
    limits = _list_numbers(window, Real)
    if limits is None or not all(map(math.isfinite, limits)):
        raise OptionError("window", window, _COORDINATES)
    bounds = Bounds(*map(float, limits))
    if bounds.width < 0 or bounds.height < 0:
        raise OptionError("window", limits, f"{_COORDINATES}, the lower ones first{_CELLS_ARE}")
    return bounds


def _list_numbers(given: object, kind: type) -> tuple[Any, ...] | None:
    """Return four numbers of a kind as a tuple, None if they are something else."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        return None
    numbers = tuple(given)
    are_numbers = all(isinstance(one, kind) and not isinstance(one, bool) for one in numbers)
    return numbers if len(numbers) == 4 and are_numbers else None


def _cut_cells(dataset: Header, cells: Sequence[int]) -> tuple[int, int, int, int]:
    size = f"the raster has {counted(dataset.width, 'column')} and {counted(dataset.height, 'row')}"
    numbers = _list_numbers(cells, Integral)
    if numbers is None:
        raise OptionError(
            "cells",
            cells,
            f"four whole numbers (first column, first row, width, height); {size}",
        )
    column, row, width, height = (int(one) for one in numbers)
    if not _has_cells(dataset, numbers):
        raise OptionError("cells", numbers, f"a part of {FILE}: {size}")
    return column, row, width, height


def _has_cells(dataset: Header, cells: tuple[Any, ...]) -> bool:
    column, row, width, height = cells
    fits_across = 0 <= column < column + width <= dataset.width
    return bool(fits_across and 0 <= row < row + height <= dataset.height)


def _describe_window(dataset: Header, choice: Choice) -> list[str]:
    """Say what a window is taken as that could be cells as well."""
    numbers = _list_numbers(choice.window, Integral)
    if numbers is None or not _has_cells(dataset, numbers):
        return []
    shown = ", ".join(map(str, numbers))
    return [
        f"The window {shown} is in coordinates (west, south, east, north); cells by column, row, "
        "width and height are the option `cells`."
    ]


def cut_bounds(dataset: Header, bounds: Bounds) -> tuple[int, int, int, int]:
    """Return the cells of the smallest upright window that covers the bounds."""
    x = np.array([bounds.xmin, bounds.xmin, bounds.xmax, bounds.xmax])
    y = np.array([bounds.ymin, bounds.ymax, bounds.ymin, bounds.ymax])
    columns, rows = dataset.transform.invert().apply(x, y)
    column, row = max(0, int(np.floor(columns.min()))), max(0, int(np.floor(rows.min())))
    right = min(dataset.width, int(np.ceil(columns.max())))
    bottom = min(dataset.height, int(np.ceil(rows.max())))
    if column >= right or row >= bottom:
        left, low, east, high = dataset.bounds
        raise OptionError(
            "window",
            (bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax),
            f"an area that meets {FILE}, which spans easting {coordinate(left)} to "
            f"{coordinate(east)} and northing {coordinate(low)} to {coordinate(high)}{_CELLS_ARE}",
        )
    return column, row, right - column, bottom - row


def _require_few_cells(cells: Cells) -> None:
    """Refuse more cells than can be read, before memory is asked for."""
    count = cells.count
    memory = measure_free_memory()
    most = min(LARGEST_RASTER, memory // BYTES_PER_CELL)
    if count > most:
        raise ReadError(
            f"{FILE}: {count:,} cells are to be read, and {most:,} are the most that "
            + ("a TIN" if most == LARGEST_RASTER else f"{memory / (1 << 30):.1f} GiB of memory")
            + " can hold: read a part of it (window) or every n-th row and column (stride).",
        )


# ------------------------------------------------------------------ points


class Strip(NamedTuple):
    """The points of some rows of cells."""

    points: Float64Array
    cells: Int64Array
    """Their cells, counted row by row from 0."""
    valid: BoolArray
    """(rows, columns), which cells they are."""
    n_nodata: int


def read_strips(
    plan: Plan, cells: Cells, open_strips: OpenStrips, progress: Tell | None = None
) -> Iterator[Strip]:
    """Yield the points of valid cells, strip by strip."""
    dataset = plan.dataset
    strips = _cut_into_strips(dataset, cells)
    window = {"band": plan.band, "column": cells.column, "width": cells.width}
    ends = [[int(rows[0]), int(rows[-1])] for rows in strips]
    done = Progress(progress)
    with open_strips({**window, "stride": cells.stride, "rows": ends}) as answers:
        for number, (rows, answer) in enumerate(zip(strips, answers, strict=False), start=1):
            yield _read_strip(plan, cells, rows, answer.arrays)
            done(_READ * number / len(strips))


def _cut_into_strips(dataset: Header, cells: Cells) -> list[Int64Array]:
    """Cut the rows wanted into strips."""
    height = _choose_strip_height(dataset, cells)
    end = cells.row + cells.height
    strips = [
        cells.find_rows(start, min(start + height, end)) for start in range(cells.row, end, height)
    ]
    return [rows for rows in strips if len(rows)]


def _choose_strip_height(dataset: Header, cells: Cells) -> int:
    """Return a number of rows that are whole blocks of the file, of some million cells."""
    block = max(1, dataset.block_height)
    return max(1, _STRIP_CELLS // (block * cells.width)) * block


def _read_strip(
    plan: Plan, cells: Cells, rows: Int64Array, arrays: Mapping[str, AnyArray]
) -> Strip:
    dataset, band, marks = plan.dataset, plan.band, plan.marks
    values, has_value = arrays["values"], arrays["valid"] != 0
    x, y = _compute_centres(dataset, cells.columns, rows)
    wanted = _find_within(cells.bounds, x, y)
    keep = has_value & wanted
    elevation = values[keep].astype(np.float64)
    scale, offset = dataset.scales[band - 1], dataset.offsets[band - 1]
    if (scale, offset) != (1.0, 0.0):
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused
            elevation = elevation * scale + offset
    points = np.stack([x[keep], y[keep], elevation], axis=1)
    if len(marks):
        is_value = ~np.isin(elevation, marks)
        points, keep[keep] = points[is_value], is_value
    numbers = (rows[:, None] * dataset.width + cells.columns)[keep]
    return Strip(points, numbers, keep, int(np.count_nonzero(wanted & ~keep)))


def _require_finite_centres(points: Float64Array, band: int) -> None:
    wrong = ~np.isfinite(points[:, 2])
    if wrong.any():
        count, first = int(wrong.sum()), points[int(np.argmax(wrong))].tolist()
        raise ReadError(
            f"{FILE}: {count} {'cell' if count == 1 else 'cells'} of band {band} would have an "
            f"elevation that is not finite (first at {coordinate(first[0])}, "
            f"{coordinate(first[1])}): its scale "
            "or offset is wrong.",
        )


def _compute_centres(
    dataset: Header, columns: Int64Array, rows: Int64Array
) -> tuple[Float64Array, Float64Array]:
    """Return easting and northing of the cell centres, (rows, columns) arrays."""
    x, y = dataset.transform.apply(columns[None, :] + 0.5, rows[:, None] + 0.5)
    return x, y


def _find_within(bounds: Bounds | None, x: Float64Array, y: Float64Array) -> BoolArray:
    if bounds is None:
        return np.ones(x.shape, np.bool_)
    inside: BoolArray = (x >= bounds.xmin) & (x <= bounds.xmax)
    return inside & (y >= bounds.ymin) & (y <= bounds.ymax)
