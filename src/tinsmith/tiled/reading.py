"""The first step of a run: every input is read once, into chunks of points on disk."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache, reduce
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.atomic import replacing
from ..base.crs import CRS, Unit
from ..base.errors import CrsError, ReadError, TinsmithError, WriteError
from ..base.notes import join_alike, join_notes
from ..base.sentences import counted
from ..base.types import Bounds
from ..io.registry import Counts, NothingLeftError
from ..io.streaming import stream_points
from ..terrain.ground_filter import Candidates
from ..tin.report import describe_differing, describe_skipped
from ..tin.tiling import NumberedPoints, find_skeleton
from .chunks import ROWS_OF_A_FILE, Chunk, split_numbers, write_chunk
from .in_place import Choice, Counting
from .running import Fingerprint, Record, Run, hash_file
from .store import PointStore, join_skeletons, load_chunks, save_chunks

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ..base.arrays import Float64Array
    from ..base.policies import DuplicatePolicy
    from ..io.registry import StreamEnd
    from ..io.streaming import PointStream
    from .running import Phase

CHUNK_POINTS = 1_000_000
"""Points that are held at a time while a file is read."""

_PHASE = "inputs"
_CHUNKS, _SKELETON = "chunks.npy", "skeleton.npz"


@dataclass(frozen=True)
class ReadJob:
    """A file that is to be read into chunks.

    Attributes
    ----------
    folder : Path
        Of the run of the points.
    choice : Choice
        The file, and which of its points are taken.
    in_place : (Bounds, int) or None
        Bounds and count of its points, of one that is read in place: it is only counted.
    """

    folder: Path
    choice: Choice
    in_place: tuple[Bounds, int] | None = None

    @property
    def key(self) -> str:
        """Name of the task."""
        return f"{self.choice.number:06d}"

    @property
    def source(self) -> Fingerprint:
        """The file."""
        return self.choice.source


def read_input(job: ReadJob) -> Record:
    """Read a file into chunks; what is wrong with it becomes the record's sentence.

    Raises
    ------
    WriteError
        If the folder cannot be written, which is no fault of the file.
    """
    started = perf_counter()
    run = Run(job.folder)
    try:
        record = _read(job, started)
    except WriteError:
        raise
    except NothingLeftError as error:
        record = _record_nothing(job, error.end, started)
    except TinsmithError as error:
        record = Record(job.key, "failed", str(error), perf_counter() - started)
    except MemoryError:
        record = Record(job.key, "failed", f"There is no memory left to read '{job.source.path}'.")
    run.add(_PHASE, record)
    return record


def _read(job: ReadJob, started: float) -> Record:
    path = Path(job.source.path)
    job.source.require_same()
    kept = _Kept(job)
    skeletons: list[NumberedPoints] = []
    low, high = math.inf, -math.inf
    extent = Extent()
    choice = job.choice
    candidates = None if choice.candidates is None else Candidates(choice.candidates)
    with stream_points(path, chunk_points=CHUNK_POINTS, **choice.options) as stream:
        left_out = 0
        for every in stream:
            found = choice.choose(every)
            left_out += len(every) - len(found)
            extent = extent.with_points(found.points)
            if candidates is not None:
                found = found.take(candidates.find(found.attributes, len(found)))
            if not len(found):
                continue
            some = choice.number_points(found)
            low, high = min(low, some.points[:, 2].min()), max(high, some.points[:, 2].max())
            kept.add(some)
            skeletons.append(find_skeleton(some))
        crs, unit = stream.crs, stream.elevation_unit
        told = _Told.of(stream.end)
        further = [] if candidates is None else [*candidates.notes]
        _require_tiles(stream, path)
    job.source.require_same()
    if left_out:
        further.append(_describe_left_out(left_out, path, choice.where))
    index, outline = f"{job.key}.chunks.npy", f"{job.key}.skeleton.npz"
    chunks, files = kept.save()
    if chunks:
        save_chunks(job.folder / index, chunks)
        save_points(job.folder / outline, NumberedPoints.join(skeletons))
        files = [index, outline, *files]
    return Record(
        job.key,
        "done" if chunks else "empty",
        seconds=perf_counter() - started,
        points=sum(chunk.count for chunk in chunks),
        values={
            "crs": None if crs is None else str(crs),
            "elevation_unit": None if unit is None else unit.text,
            "elevations": [float(low), float(high)] if chunks else [],
            "told": asdict(replace(told, further=further)),
            "extent": asdict(extent),
            "lattice": stream.lattice if stream.has_voids else None,
        },
        files={name: hash_file(job.folder / name) for name in files},
    )


class _Kept:
    """What is kept of a file as it is read: all of its points, or how many lie where."""

    def __init__(self, job: ReadJob) -> None:
        self._job = job
        self._chunks: list[Chunk] = []
        self._counting = None if job.in_place is None else Counting(*job.in_place)

    def add(self, some: NumberedPoints) -> None:
        """Keep some points, at least one."""
        if self._counting is not None:
            self._counting.add(some)
            return
        for part in split_numbers(some):
            number = len(self._chunks)
            self._chunks.append(
                write_chunk(self._job.folder, self._job.choice.number, number, *part)
            )

    def save(self) -> tuple[list[Chunk], list[str]]:
        """Return the chunks, and the names of what was written."""
        if self._counting is None:
            return self._chunks, [chunk.path.name for chunk in self._chunks]
        made = self._counting.save(self._job.folder, self._job.choice)
        return [*made], [path.name for one in made for path in one.paths]


def _record_nothing(job: ReadJob, end: StreamEnd, started: float) -> Record:
    """Return the record of a file none of whose points is wanted, as a tile of water alone."""
    values = {"told": asdict(_Told.of(end)), "extent": asdict(Extent())}
    job.source.require_same()
    return Record(job.key, "empty", seconds=perf_counter() - started, values=values)


@dataclass(frozen=True)
class _Told:
    """What is told of a file, before it is joined with what is told of others.

    Attributes
    ----------
    before, after : list of str
        Notes of the reader, before and behind those that are made of counts.
    counts : mapping or None
        Fields of :class:`Counts`.
    skipped : mapping of str to int
        What the reader left out.
    further : list of str
        Notes of what was done with the points.
    """

    before: list[str]
    counts: Mapping[str, Any] | None
    after: list[str]
    skipped: Mapping[str, int]
    further: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, end: StreamEnd) -> _Told:
        """Take apart what a reader tells."""
        notes, counts = list(end.notes), end.counts
        made = [] if counts is None else counts.list_notes()
        at = notes.index(made[0]) if made else len(notes)
        fields = None if counts is None else asdict(counts)
        return cls(notes[:at], fields, notes[at + len(made) :], dict(end.skipped))


def _require_tiles(stream: PointStream, path: Path) -> None:
    """Refuse points that are not those of a surface that tiles can compute."""
    if stream.has_voids and stream.lattice is None:
        raise ReadError(
            f"'{path}' has cells without data, at which its surface ends, in an order that tiles "
            "do not know: make a GeoTIFF of it.",
            path=path,
        )
    unit = stream.elevation_unit
    if unit is not None and not unit.text:
        raise ReadError(
            f"The elevations of '{path}' are in {unit}, a unit without a name by which tiles find "
            "it again: declare the unit (`elevation_unit`).",
            path=path,
        )


@dataclass(frozen=True)
class Extent:
    """How many points there are, and their bounds in space, before candidates are chosen.

    Attributes
    ----------
    count : int
    low, high : tuple of three float
    """

    count: int = 0
    low: tuple[float, ...] = (math.inf,) * 3
    high: tuple[float, ...] = (-math.inf,) * 3

    def with_points(self, points: Float64Array) -> Extent:
        """Return the extent with further points, (n, 3)."""
        if not len(points):
            return self
        columns = points.T
        low, high = ([float(find(one)) for one in columns] for find in (np.min, np.max))
        return self.join(Extent(len(points), tuple(low), tuple(high)))

    def join(self, other: Extent) -> Extent:
        """Return that of both."""
        return Extent(
            self.count + other.count,
            tuple(map(min, self.low, other.low)),
            tuple(map(max, self.high, other.high)),
        )


def _describe_left_out(count: int, path: Path, where: Mapping[str, Sequence[float]]) -> str:
    wanted = ", ".join(
        f"{name} {' or '.join(f'{value:g}' for value in values)}" for name, values in where.items()
    )
    return f"{counted(count, 'point')} of '{path.name}' without {wanted} were left out."


def save_points(path: Path, points: NumberedPoints) -> None:
    """Write points with their numbers to a file."""
    with replacing(path) as file:
        np.savez(file, points=points.points, numbers=points.numbers)


def load_points(path: Path) -> NumberedPoints:
    """Read what :func:`save_points` wrote."""
    with np.load(path) as found:
        return NumberedPoints(found["points"], found["numbers"])


# ---------------------------------------------------------------------- all inputs


@dataclass(frozen=True)
class StoredPoints:
    """All points of a run, on disk, and what is known of their surface.

    Attributes
    ----------
    folder : Path
    crs : CRS or None
    elevation_unit : Unit or None
    notes : tuple of str
        What the readers tell.
    count : int
    files : int
        That they are from.
    bounds : Bounds
        Of the surface: with lines those of what these leave.
    elevations : (float, float)
        The lowest and the highest; those of lines count, too.
    extent : Extent
        Of all points that were read, of which these may be those alone that can be ground.
    is_raster : bool
        Whether they are the cells of one raster, without lines among them.
    lines : Path or None
        File of the lines, cut where they meet.
    lattice : tuple of int or None
        Of one raster with voids: cells of a row of it, and the step from one that is taken to the
        next. Their numbers are those of the points.
    """

    folder: Path
    crs: CRS | None
    elevation_unit: Unit | None
    notes: tuple[str, ...]
    count: int
    files: int
    bounds: Bounds
    elevations: tuple[float, float]
    extent: Extent = Extent()
    is_raster: bool = False
    lines: Path | None = None
    lattice: tuple[int, int] | None = None

    def open(self) -> PointStore:
        """Return the source of points for tasks."""
        return open_store(self.folder)

    def tell_differing(
        self, records: Mapping[str, Record], duplicates: DuplicatePolicy
    ) -> StoredPoints:
        """Tell at how many places points differ in elevation, by the records of all tiles."""
        return replace(self, notes=(*self.notes, *tell_differing(records, "differing", duplicates)))


def tell_differing(
    records: Mapping[str, Record], name: str, duplicates: DuplicatePolicy
) -> tuple[str, ...]:
    """Return the note on what tiles counted under a name, by :func:`.tasks.measure_differing`."""
    found = [one.values[name] for one in records.values() if name in one.values]
    places, most = sum(int(one[0]) for one in found), max((one[1] for one in found), default=0)
    return describe_differing(places, most, duplicates)


def open_store(folder: Path) -> PointStore:
    """Return the points in a folder; what is known of its chunks is kept for the next task."""
    return _open_store(folder, (folder / _CHUNKS).stat().st_mtime_ns)


@lru_cache(maxsize=2)
def _open_store(folder: Path, changed: int) -> PointStore:
    """Open points; those that were read anew since, as of another run in the folder, anew."""
    del changed
    chunks = load_chunks(folder / _CHUNKS, folder)
    return PointStore(chunks, load_points(folder / _SKELETON))


def name_rows(folder: Path, numbers: Sequence[int]) -> str:
    """Write which rows of which files some points are, from their numbers among all."""
    inputs = (Run(folder).manifest or {})["inputs"]
    return ", ".join(
        f"row {number % ROWS_OF_A_FILE} of '{Path(inputs[number // ROWS_OF_A_FILE]['path']).name}'"
        for number in numbers
    )


def read_inputs(
    run: Run,
    sources: Sequence[Fingerprint],
    phase: Phase,
    places: Sequence[tuple[Bounds, int] | None],
    **asked: Any,
) -> StoredPoints:
    """Read every input that is not read yet, and join what is known of all.

    Parameters
    ----------
    run : Run
        Of the points.
    sources : sequence of Fingerprint
    phase : Phase
    places : sequence of (Bounds, int) or None
        Of each file what it is read in place by, as of :class:`ReadJob`.
    **asked
        Options and values of attributes, as of :class:`.in_place.Choice`.

    Raises
    ------
    ReadError
        If a file cannot be read, files do not fit together, or there are no points.
    CrsError
        If files are in several coordinate reference systems.
    """
    jobs = [
        ReadJob(run.folder, Choice(number, one, **asked), place)
        for number, (one, place) in enumerate(zip(sources, places, strict=True))
    ]
    records = phase.run(run, _PHASE, read_input, jobs)
    names = {job.key: Path(job.source.path).name for job in jobs}
    crs, unit = _require_one_crs(records, names), _require_one_unit(records, names)
    filled = [record for record in records.values() if record.points]
    if not filled:
        notes = " ".join(("There are no points in the inputs.", *_join_notes(records)))
        raise ReadError(notes)
    chunks = [
        chunk
        for record in filled
        for chunk in load_chunks(run.folder / f"{record.key}.chunks.npy", run.folder)
    ]
    bounds = join_bounds([chunk.bounds for chunk in chunks])
    lattice = _find_lattice(filled, names)
    outlines = [load_points(run.folder / f"{record.key}.skeleton.npz") for record in filled]
    save_chunks(run.folder / _CHUNKS, chunks)
    save_points(run.folder / _SKELETON, join_skeletons(outlines, bounds))
    return StoredPoints(
        run.folder,
        crs,
        unit,
        _join_notes(records),
        sum(chunk.count for chunk in chunks),
        len(jobs),
        bounds,
        (
            min(record.values["elevations"][0] for record in filled),
            max(record.values["elevations"][1] for record in filled),
        ),
        reduce(Extent.join, (Extent(**one.values["extent"]) for one in records.values())),
        lattice=lattice,
    )


def _find_lattice(filled: Sequence[Record], names: Mapping[str, str]) -> tuple[int, int] | None:
    """Return that of a raster with voids; refuse one among several files."""
    for record in filled:
        lattice = record.values["lattice"]
        if lattice is None:
            continue
        if len(filled) > 1:
            raise ReadError(
                f"'{names[record.key]}' has voids, around which there is no surface, and cannot be "
                "joined with others: make one raster of them first, such as a virtual one (VRT)."
            )
        return lattice[0], lattice[1]
    return None


def _join_notes(records: Mapping[str, Record]) -> tuple[str, ...]:
    """Return the notes of all files, with the counts of all together."""
    told = [_Told(**one.values["told"]) for one in records.values()]
    counts = [Counts(**one.counts) for one in told if one.counts is not None]
    skipped: Counter[str] = Counter()
    for one in told:
        skipped.update(one.skipped)
    return join_notes(
        [
            *_join_alike(one.before for one in told),
            *(reduce(Counts.add, counts).list_notes() if counts else ()),
            *_join_alike(one.after for one in told),
            *describe_skipped(skipped),
            *_join_alike(one.further for one in told),
        ]
    )


def _join_alike(files: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """Return the notes of all files; of those that differ in numbers only the first."""
    return join_alike(note for notes in files for note in dict.fromkeys(notes))


def join_bounds(boxes: Sequence[Bounds]) -> Bounds:
    """Return the bounds of all that lies in some bounds."""
    return Bounds(
        min(box.xmin for box in boxes),
        min(box.ymin for box in boxes),
        max(box.xmax for box in boxes),
        max(box.ymax for box in boxes),
    )


def _require_one_crs(records: Mapping[str, Record], names: Mapping[str, str]) -> CRS | None:
    """Refuse inputs in several CRSs, or some in none."""
    found = {key: CRS.of(one.values["crs"]) for key, one in records.items() if one.points}
    first_key = next(iter(found), "")
    first = found.get(first_key)
    for key, crs in found.items():
        same = crs is first if crs is None or first is None else crs.is_same(first)
        if not same:
            labels = ["no CRS" if one is None else one.label for one in (first, crs)]
            raise CrsError(
                f"'{names[first_key]}' and '{names[key]}' are not in one CRS: {labels[0]} and "
                f"{labels[1]}; say which is wanted (`crs`), or read them one by one.",
                crs=crs,
            )
    return first


def _require_one_unit(records: Mapping[str, Record], names: Mapping[str, str]) -> Unit | None:
    """Refuse elevations in several units, or some in an unknown one."""
    found = {
        key: Unit.of(one.values["elevation_unit"] or None)
        for key, one in records.items()
        if one.points
    }
    first_key = next(iter(found), "")
    first = found.get(first_key)
    for key, unit in found.items():
        if unit != first:
            raise ReadError(
                f"'{names[first_key]}' and '{names[key]}' have elevations in different units: "
                f"{first or 'unknown'} and {unit or 'unknown'}; read them one by one, or declare "
                "the unit (`elevation_unit`) if it is that of all."
            )
    return first
