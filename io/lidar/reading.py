"""LAS, LAZ and COPC files, and folders of tiles, as points of a survey."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base import optional
from ...base.crs import CRS, Unit
from ...base.errors import CrsError, OptionError, ReadError
from ...base.sentences import coordinate, counted, inflect
from ...tin import Bounds, Survey
from ..isolated import choose_limits, start_early, stream_isolated
from ..isolated.limits import measure_free_memory
from ..reprojection.placement import Placed, place, settle_unit
from .crs import Reference, find_reference
from .header import Header, parse_header
from .selection import (
    N_CLASSES,
    Selection,
    Tally,
    describe_classes,
    describe_marks,
    parse_selection,
)
from .signatures import SUFFIXES, list_tiles

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.progress import Tell

__all__ = ["read"]

_CHILD = f"{__package__}.las_child"
_BYTES_PER_POINT = 24
_MOST_POINTS = 2**31 - 1
"""The vertices of a TIN are numbered with 32 bits."""

_SOME = 4_096
"""Points that are compared with the bounds of the header."""

_SPARSE = 0.5
"""Share of the points below which those taken are copied, so that memory is given back."""


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    classes: int | str | Sequence[int] | None = None,
    returns: int | str | Sequence[int | str] | None = None,
    window: Bounds | Sequence[float] | None = None,
    resolution: float | None = None,
    every: int = 1,
    withheld: bool = False,
    attributes: str | Sequence[str] | None = None,
    progress: Tell | None = None,
) -> Survey:
    """Read a lidar file, or a folder of tiles as one survey.

    Of a folder all files ``.las`` and ``.laz`` in it are read, in the order of their names. Points
    are reprojected to ``crs``, which also declares the CRS of a file whose own is not understood.

    Parameters
    ----------
    classes : int or sequence of int, optional
        Classes to take, such as 2, the ground. Default all, as PDAL and LAStools do; a note says
        which there are.
    returns : int, str or sequence, optional
        Returns to take: "first", "last", "only" (the one of a pulse with no other), or numbers.
    window : Bounds or (4,) sequence of float, optional
        West, south, east, north, in the file's own CRS; its edges belong to it.
    resolution : float, optional
        Of a COPC file take the levels down to the first whose points are no further apart.
    every : int
        Take every so manyeth of the points that are left.
    withheld : bool
        Take points that are marked as withheld, that is deleted, as well.
    attributes : str or sequence of str, optional
        Attributes of the points to keep, by laspy's names; "all". Default classification,
        intensity, return_number and number_of_returns; an empty sequence keeps none.

    Returns
    -------
    Survey
        Points in the order of the file, those of a part of an octree level after level.
        ``skipped`` counts points that are withheld, of other classes and of other returns.

    Raises
    ------
    ReadError
        If a file is damaged or cut short, no point is left, or the CRS measures in degrees and no
        other is wanted.
    OptionError
        If an option has a value that it cannot have.
    CrsError
        If the CRS of the file is not known, tiles are in several and ``crs`` does not say which is
        wanted, or the points cannot be transformed.
    MissingExtraError
        If laspy is not installed.

    Notes
    -----
    Coordinates are whole numbers times a scale plus an offset, bit for bit those of laspy. The
    header is compared with the size of the file before memory is asked for; a child process
    decompresses. Memory holds the points once and a chunk of a million: 29 bytes a point with the
    attributes that are kept without asking, and some 100 MB.
    """
    optional.require("laspy", "Reading lidar")
    start_early(_CHILD)
    selection = parse_selection(classes, returns, window, resolution, every, withheld, attributes)
    headers = [parse_header(one) for one in _list_files(path)]
    _require_levels(headers, selection)
    target, declared = CRS.of(crs), Unit.of(elevation_unit)
    tiles = [_locate(header, target, declared) for header in headers]
    _require_one_crs(tiles, target, path)
    units = _require_comparable_units(tiles, target, path)
    gathered = _Gathered.reserve(headers, path, progress)
    placed = [_read_tile(tile, selection, target, gathered, units[0]) for tile in tiles]
    gathered.require_points(path, selection)
    return Survey(
        points=gathered.points,
        attributes=gathered.finish_attributes(),
        crs=placed[0].crs,
        elevation_unit=placed[0].elevation_unit,
        source=path.name,
        skipped=gathered.tally.skipped,
        notes=_collect_notes(tiles, placed, gathered.tally, selection),
    )


def _list_files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    files = list_tiles(path)
    if not files:
        raise ReadError(
            f"'{path}' is a folder without a lidar file ({', '.join(SUFFIXES)}).", path=path
        )
    return files


def _require_levels(headers: list[Header], selection: Selection) -> None:
    """Refuse a resolution of files that are no octree."""
    if selection.resolution is None:
        return
    for header in headers:
        if not header.is_copc:
            raise OptionError(
                "resolution",
                selection.resolution,
                f"none for '{header.path}', as only COPC files have levels; the option `every` "
                "thins others",
            )


# ------------------------------------------------------------------------ the place


@dataclass(frozen=True, slots=True)
class _Tile:
    """A file, with what its coordinates are measured in."""

    header: Header
    reference: Reference
    unit: Unit | None


def _locate(header: Header, target: CRS | None, declared: Unit | None) -> _Tile:
    try:
        reference = find_reference(header, is_declared=target is not None)
    except CrsError as error:
        text = str(error)
        text = text if str(header.path) in text else f"'{header.path}': {text}"
        raise CrsError(text, crs=error.crs) from error
    vertical = None if reference.crs is None else reference.crs.vertical_unit
    unit = settle_unit(declared, reference.unit or vertical)
    middle = header.middle[None, :]
    wanted = target or reference.crs
    if wanted is not None and wanted.is_geographic:  # refused before the points are read
        place(middle, source=reference.crs, target=target, unit=unit)
    return _Tile(header, reference, unit)


def _require_one_crs(tiles: list[_Tile], target: CRS | None, path: Path) -> None:
    """Refuse tiles in several CRSs, unless the caller says which is wanted."""
    first = tiles[0]
    for other in tiles[1:]:
        ours, theirs = first.reference.crs, other.reference.crs
        names = f"'{first.header.path.name}' and '{other.header.path.name}' in '{path}'"
        both = ours is not None and theirs is not None
        same = ours is theirs if ours is None or theirs is None else ours.is_same(theirs)
        if not same and not (both and target is not None):
            raise CrsError(
                f"{names} are not in one CRS: {_name_crs(ours)} and {_name_crs(theirs)}; read them "
                "one by one, or declare the CRS that is wanted if both name theirs.",
                crs=theirs,
            )


def _require_comparable_units(
    tiles: list[_Tile], target: CRS | None, path: Path
) -> list[Unit | None]:
    """Return the units of elevations after any reprojection; refuse known ones beside unknown."""
    units = [_foresee_unit(tile, target) for tile in tiles]
    first = tiles[0].header.path.name
    for tile, unit in zip(tiles, units, strict=True):
        if unit != units[0] and (unit is None or units[0] is None):
            raise ReadError(
                f"'{first}' and '{tile.header.path.name}' in '{path}' have elevations in different "
                f"units: {units[0] or 'unknown'} and {unit or 'unknown'}; read them one by one, or "
                "declare the unit (`elevation_unit`) if it is that of all.",
                path=path,
            )
    return units


def _foresee_unit(tile: _Tile, target: CRS | None) -> Unit | None:
    header = tile.header
    middle = header.middle[None, :]
    return place(middle, source=tile.reference.crs, target=target, unit=tile.unit).elevation_unit


def _name_crs(crs: CRS | None) -> str:
    return "none is named" if crs is None else crs.label


# ----------------------------------------------------------------------- the points


class _Gathered:
    """Points of one file after the other, in memory that is reserved once."""

    def __init__(self, capacity: int, progress: Tell | None) -> None:
        self._progress = progress
        self._points = np.empty((capacity, 3))  # the system gives memory to what is filled
        self._columns: dict[str, AnyArray] = {}
        self.count = 0
        self.tally = Tally(np.zeros(N_CLASSES, np.int64))

    @classmethod
    def reserve(cls, headers: list[Header], path: Path, progress: Tell | None = None) -> _Gathered:
        """Reserve room for all points, if there is memory for so many.

        Raises
        ------
        ReadError
            If there is not.
        """
        count = sum(header.count for header in headers)
        memory = measure_free_memory()
        if count > _MOST_POINTS or count * _BYTES_PER_POINT > memory:
            most = min(_MOST_POINTS, memory // _BYTES_PER_POINT)
            raise ReadError(
                f"'{path}' is said to have {count:,} points, and {most:,} are the most that can be "
                "read here: read a part of it (window), or tile after tile.",
                path=path,
            )
        return cls(count, progress)

    def append(self, arrays: dict[str, AnyArray], header: Header) -> None:
        """Add a chunk: coordinates are scaled as laspy does, one rounding after the other."""
        xyz = arrays["xyz"]
        start, end = self.count, self.count + len(xyz)
        if end > len(self._points):
            raise ReadError(
                f"'{header.path}' is damaged: it holds more points than it says.", path=header.path
            )
        target = self._points[start:end]
        np.multiply(xyz, header.scales, out=target)
        target += header.offsets
        for key, values in arrays.items():
            if key.startswith("attribute "):
                self._fill_column(key.removeprefix("attribute "), values, start)
        self.count = end

    def _fill_column(self, name: str, values: AnyArray, start: int) -> None:
        column = self._columns.get(name)
        if column is None or column.dtype != np.result_type(column, values):
            dtype = values.dtype if column is None else np.result_type(column, values)
            wider = np.zeros(len(self._points), dtype)
            if column is not None:
                wider[:start] = column[:start]
            column = self._columns[name] = wider
        column[start : start + len(values)] = values

    def replace(self, start: int, points: Float64Array) -> None:
        """Put other coordinates in the place of those from a row on."""
        if (
            points.base is not self._points
            or points.ctypes.data != self._points[start:].ctypes.data
        ):
            self._points[start : self.count] = points

    def report_progress(self) -> None:
        """Tell the share of the points that were seen, taken or not."""
        if self._progress is not None:
            self._progress((self.count + self.tally.left_out) / len(self._points))

    @property
    def points(self) -> Float64Array:
        """Coordinates of all points."""
        return self._shrink(self._points)

    def _shrink(self, values: AnyArray) -> AnyArray:
        part = values[: self.count]
        return part.copy() if self.count < _SPARSE * len(values) else part

    def finish_attributes(self) -> dict[str, AnyArray]:
        """Return the attributes of all points."""
        return {name: self._shrink(column) for name, column in self._columns.items()}

    def require_points(self, path: Path, selection: Selection) -> None:
        """Refuse a selection that leaves nothing, and say what there is."""
        if self.count:
            return
        tally = self.tally
        there = ", ".join(describe_classes(tally, selection)).rstrip(".")
        reasons = {
            "is withheld": tally.withheld,
            "is of another class": tally.of_other_classes,
            "is of another return": tally.of_other_returns,
            "lies outside the window": tally.outside,
        }
        said = [f"{count:,} for that it {why}" for why, count in reasons.items() if count]
        if not said:
            raise ReadError(f"'{path}' holds no points.", path=path)
        raise ReadError(
            f"'{path}': no point is left; left out were {', '.join(said)}."
            + (f" {there}." if there else ""),
            path=path,
        )


def _read_tile(
    tile: _Tile, selection: Selection, target: CRS | None, gathered: _Gathered, unit: Unit | None
) -> Placed:
    """Add the points of a file that are wanted, in the CRS and the unit that are wanted."""
    header, start = tile.header, gathered.count
    with stream_isolated(
        f"{_CHILD}:read_points",
        {"path": str(header.path.absolute()), "wanted": selection.to_request()},
        path=header.path,
        limits=choose_limits(header.size),
    ) as parts:
        for part in parts:
            gathered.tally.add(part.value, part.arrays["classes"])
            gathered.append(part.arrays, header)
            gathered.report_progress()
    own = gathered._points[start : gathered.count]
    odd = _describe_outside(own, header)
    placed = place(own, source=tile.reference.crs, target=target, unit=tile.unit)
    gathered.replace(start, placed.points)
    placed = placed._replace(notes=(*placed.notes, *odd))
    theirs = placed.elevation_unit
    if theirs is None or unit is None or theirs == unit:
        return placed
    own[:, 2] *= (theirs.metres or 1.0) / (unit.metres or 1.0)
    note = f"The elevations of '{header.path.name}' were converted from {theirs} to {unit}."
    return placed._replace(notes=(*placed.notes, note))


def _describe_outside(points: Float64Array, header: Header) -> list[str]:
    """Tell of points beyond the bounds that the header gives, looking at some of them."""
    some = points[:: max(1, len(points) // _SOME)]
    low, high = header.low, header.high
    if len(some) == 0 or not np.isfinite([low, high]).all() or not (low != high).any():
        return []
    with np.errstate(over="ignore"):
        slack = (high - low) / 100 + np.abs(header.scales)
        count = int(((some < low - slack) | (some > high + slack)).any(axis=1).sum())
    if count == 0:
        return []
    box = [
        f"{name} {coordinate(a)} to {coordinate(b)}"
        for name, a, b in zip("xyz", low, high, strict=True)
    ]
    return [
        f"{count:,} of {counted(len(some), 'point')} looked at {inflect('[lies|lie]', count)} "
        f"outside the bounds that '{header.path.name}' gives ({', '.join(box)}): these, "
        "its scales or its offsets are wrong."
    ]


# ------------------------------------------------------------------------- the notes


def _collect_notes(
    tiles: list[_Tile], placed: list[Placed], tally: Tally, selection: Selection
) -> list[str]:
    notes = [note for tile in tiles for note in tile.reference.notes]
    notes += [note for one in placed for note in one.notes]
    notes += describe_classes(tally, selection) + describe_marks(tally)
    notes += [note for tile in tiles for note in _describe_surplus(tile.header)]
    return list(dict.fromkeys(notes))


def _describe_surplus(header: Header) -> list[str]:
    """Tell that a file has room for more points than it says it holds."""
    more = header.surplus // header.point_bytes
    if header.is_compressed or more == 0:
        return []
    return [
        f"'{header.path.name}' says it holds {counted(header.count, 'point')}, and has room for "
        f"{more:,} more behind them, which were not read."
    ]
