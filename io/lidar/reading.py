"""LAS, LAZ and COPC files, and folders of tiles, as points of a survey."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.crs import CRS, Unit
from ...base.errors import CrsError, OptionError, ReadError
from ...base.progress import Progress
from ...base.sentences import coordinate, counted, inflect
from ..isolated import choose_limits, start_early, stream_isolated
from ..registry import (
    Counts,
    NothingLeftError,
    PointChunk,
    StreamEnd,
    StreamHead,
    gathering,
    taking,
)
from ..reprojection import Placing, find_conversion_factor, place, settle_unit
from .crs import HeaderReference, find_reference
from .header import Header, parse_header
from .selection import N_CLASSES, Asked, Selection, Tally, count_points
from .signatures import SUFFIXES, is_virtual_cloud, list_named_files, list_tiles

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ..isolated import Answer
    from ..registry import Blocks

CHILD = f"{__package__}.las_child"
_SOME = 4_096
"""Points that are compared with the bounds of the header, spread over all."""


@taking(Asked)
def stream(path: Path, asked: Asked) -> Blocks:
    """Read a lidar file, or a folder of tiles as one survey.

    Of a folder all files ``.las`` and ``.laz`` in it are read, in the order of their names; a
    virtual point cloud (``.vpc``) stands for those that it names. Points are reprojected to
    ``crs``, which also declares the CRS of a file whose own is not understood.

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
    start_early(CHILD)
    tiles, head, selection, target = locate_tiles(path, asked)
    yield head
    tally = Tally(np.zeros(N_CLASSES, np.int64))
    seen = _Seen(tally, head.most_points or 0, Progress(asked.progress))
    notes: list[str] = []
    for tile in tiles:
        notes += yield from _stream_tile(tile, selection, target, head, seen)
    counts = count_points(seen.tally, selection)
    end = StreamEnd(_collect_notes(tiles, notes, counts), seen.tally.skipped, counts=counts)
    seen.require_points(path, end)
    return end


read = gathering(stream)


class Cloud(NamedTuple):
    """The files of points, which of these are taken, and in which CRS they are wanted."""

    tiles: list[Tile]
    head: StreamHead
    selection: Selection
    target: CRS | None


def locate_tiles(path: Path, asked: Asked) -> Cloud:
    """Read the headers of a file, or of those in a folder: where the points are, and how many."""
    selection, target = asked.select(), CRS.of(asked.crs)
    declared = Unit.of(asked.elevation_unit)
    headers = [parse_header(one) for one in _list_files(path)]
    _require_levels(headers, selection)
    tiles = [_locate(header, target, declared) for header in headers]
    _require_one_crs(tiles, target, path)
    units = _require_comparable_units(tiles, target, path)
    total = sum(header.count for header in headers)
    head = StreamHead(target or tiles[0].reference.crs, units[0], total)
    return Cloud(tiles, head, selection, target)


def _list_files(path: Path) -> list[Path]:
    if is_virtual_cloud(path):
        return list_named_files(path)
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
class Tile:
    """A file, with what its coordinates are measured in."""

    header: Header
    reference: HeaderReference
    unit: Unit | None


def _locate(header: Header, target: CRS | None, declared: Unit | None) -> Tile:
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
    return Tile(header, reference, unit)


def _require_one_crs(tiles: list[Tile], target: CRS | None, path: Path) -> None:
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
    tiles: list[Tile], target: CRS | None, path: Path
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


def _foresee_unit(tile: Tile, target: CRS | None) -> Unit | None:
    header = tile.header
    middle = header.middle[None, :]
    return place(middle, source=tile.reference.crs, target=target, unit=tile.unit).elevation_unit


def _name_crs(crs: CRS | None) -> str:
    return "none is named" if crs is None else crs.label


# ----------------------------------------------------------------------- the points


@dataclass(slots=True)
class _Seen:
    """What was seen of all files so far."""

    tally: Tally
    total: int
    """Points that the headers tell of."""
    progress: Progress
    taken: int = 0
    rows: int = 0

    def report_progress(self) -> None:
        """Tell the share of the points that were seen, taken or not."""
        if self.total:
            self.progress((self.taken + self.tally.left_out) / self.total)

    def require_points(self, path: Path, end: StreamEnd) -> None:
        """Refuse a selection that leaves nothing, and say what there is."""
        if self.taken:
            return
        tally = self.tally
        there = "" if end.counts is None else ", ".join(end.counts.list_notes()).rstrip(".")
        reasons = {
            "is withheld": tally.withheld,
            "is of another class": tally.of_other_classes,
            "is of another return": tally.of_other_returns,
            "lies outside the window": tally.outside,
        }
        said = [f"{count:,} for that it {why}" for why, count in reasons.items() if count]
        if not said:
            raise NothingLeftError(f"'{path}' holds no points.", path=path, end=end)
        raise NothingLeftError(
            f"'{path}': no point is left; left out were {', '.join(said)}."
            + (f" {there}." if there else ""),
            path=path,
            end=end,
        )


def _stream_tile(
    tile: Tile, selection: Selection, target: CRS | None, head: StreamHead, seen: _Seen
) -> Generator[StreamHead | PointChunk, None, list[str]]:
    """Yield the points of a file that are wanted, in the CRS and the unit that are wanted."""
    header = tile.header
    placing = Placing(tile.reference.crs, target, tile.unit)
    beyond, taken = _Beyond(header), seen.taken
    with stream_isolated(
        f"{CHILD}:read_points",
        {"path": str(header.path.absolute()), "wanted": selection.to_request()},
        path=header.path,
        limits=choose_limits(header.size),
    ) as parts:
        for part in parts:
            beyond.add_span(scale(part.arrays["span"], header))
            own = scale(part.arrays["xyz"], header)
            rows = _find_rows(part, header) + seen.rows
            seen.tally.add(part.value, part.arrays["classes"])
            if len(own) == 0:
                continue
            beyond.add(own)
            placed = placing.add(own)
            if seen.taken == 0 and (placed.crs, placed.elevation_unit) != head[:2]:
                head = StreamHead(placed.crs, placed.elevation_unit, head.most_points)
                yield head
            seen.taken += len(own)
            factor = find_conversion_factor(placed.elevation_unit, head.elevation_unit)
            if factor != 1.0:
                placed.points[:, 2] *= factor
            yield PointChunk(placed.points, rows, name_attributes(part))
            seen.report_progress()
    seen.rows += header.count
    if seen.taken == taken:
        beyond.require_none()
    notes = [*placing.finish(), *beyond.describe()]
    theirs, unit = placing.elevation_unit, head.elevation_unit
    if theirs is not None and unit is not None and theirs != unit:
        notes.append(
            f"The elevations of '{header.path.name}' were converted from {theirs} to {unit}."
        )
    return notes


def scale(xyz: AnyArray, header: Header) -> Float64Array:
    """Return coordinates of whole numbers as laspy does, one rounding after the other."""
    points = np.empty(xyz.shape)
    np.multiply(xyz, header.scales, out=points)
    points += header.offsets
    return points


def _find_rows(part: Answer, header: Header) -> Int64Array:
    """Return the place of each point of a chunk among those of its file."""
    start, end = part.arrays["range"].tolist()
    if end > header.count:
        raise ReadError(
            f"'{header.path}' is damaged: it holds more points than it says.", path=header.path
        )
    kept = part.arrays.get("kept")
    return np.arange(start, end) if kept is None else kept.astype(np.int64) + start


def name_attributes(part: Answer) -> dict[str, AnyArray]:
    """Return the attributes of a chunk by their names."""
    return {
        name.removeprefix("attribute "): values
        for name, values in part.arrays.items()
        if name.startswith("attribute ")
    }


class _Beyond:
    """Points beyond the bounds that the header gives, of some that are looked at."""

    def __init__(self, header: Header) -> None:
        self._header = header
        low, high = header.low, header.high
        self._is_bounded = bool(np.isfinite([low, high]).all() and (low != high).any())
        with np.errstate(over="ignore", invalid="ignore"):
            slack = (high - low) / 100 + np.abs(header.scales)
            self._low, self._high = low - slack, high + slack
        self._stride = max(1, header.count // _SOME)
        self._seen = self._looked_at = self._count = 0
        self._is_span_beyond = False

    def add_span(self, corners: Float64Array) -> None:
        """Look at the bounds of further points, taken or not, (2, 3)."""
        if self._is_bounded and ((corners < self._low) | (corners > self._high)).any():
            self._is_span_beyond = True

    def require_none(self) -> None:
        """Refuse a file of which no point is taken if it is another one than the header tells of.

        A damaged file would pass for one without a point that is wanted.
        """
        if self._is_span_beyond:
            path = self._header.path
            raise ReadError(
                f"'{path}' is damaged: no point in it is wanted, and there are points outside the "
                "bounds that its header gives.",
                path=path,
            )

    def add(self, points: Float64Array) -> None:
        """Look at some of further points."""
        some = points[-self._seen % self._stride :: self._stride]
        self._seen += len(points)
        self._looked_at += len(some)
        if self._is_bounded:
            self._count += int(((some < self._low) | (some > self._high)).any(axis=1).sum())

    def describe(self) -> list[str]:
        """Tell of the points beyond."""
        if self._count == 0:
            return []
        header = self._header
        box = [
            f"{name} {coordinate(a)} to {coordinate(b)}"
            for name, a, b in zip("xyz", header.low, header.high, strict=True)
        ]
        return [
            f"{self._count:,} of {counted(self._looked_at, 'point')} looked at "
            f"{inflect('[lies|lie]', self._count)} outside the bounds that "
            f"'{header.path.name}' gives ({', '.join(box)}): these, its scales or its offsets are "
            "wrong."
        ]


# ------------------------------------------------------------------------- the notes


def _collect_notes(tiles: list[Tile], placed: list[str], counts: Counts) -> list[str]:
    notes = [note for tile in tiles for note in tile.reference.notes]
    notes += placed
    notes += counts.list_notes()
    notes += [note for tile in tiles for note in describe_surplus(tile.header)]
    return list(dict.fromkeys(notes))


def describe_surplus(header: Header) -> list[str]:
    """Tell that a file has room for more points than it says it holds."""
    more = header.surplus // header.point_bytes
    if header.is_compressed or more == 0:
        return []
    return [
        f"'{header.path.name}' says it holds {counted(header.count, 'point')}, and has room for "
        f"{more:,} more behind them, which were not read."
    ]
