"""The ground: each tile labels its points, then each file is written again with its classes."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_flag, as_length
from ...base.errors import ReadError, TinsmithError, WriteError
from ...base.notes import naming_file
from ...io.lidar import LabelledFile, NamedFile, write_labelled
from ...io.streaming import stream_points
from ...terrain.ground_filter import (
    Frame,
    Parameters,
    Units,
    are_noise,
    find_units,
    require_candidates,
)
from ...terrain.parts import GroundWindow, are_owned, choose_reach
from ..chunks import ROWS_OF_A_FILE
from ..labelled import GroundTiles, name_files
from ..running import Fingerprint, Record, Run, hash_file
from ..tasks import TileProduct

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import AnyArray, BoolArray, UInt8Array
    from ...io.registry import PointChunk
    from ..reading import StoredPoints
    from ..running import Phase
    from ..tasks import Part

FILES = "files"
"""Step in which files are written, and their folder."""

_UNCLASSIFIED, _GROUND = 1, 2
_CHOOSING = ("where", "duplicates", "candidates", "in_place")
"""Options of the points that are none of the reader."""


def check_options(
    *, reach: float | None = None, ground_only: bool = False, **parameters: Any
) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    checked = Parameters(**parameters)
    if reach is not None:
        as_length("reach", reach, unit="in metres")
    return {
        "parameters": checked.to_dict(),
        "reach": choose_reach(checked) if reach is None else float(reach),
        "ground_only": as_flag("ground_only", ground_only),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle units and cells, when the bounds of all points are known."""
    extent = points.extent
    require_candidates(points.count, extent.count)
    across, up, notes = find_units(points.crs, points.elevation_unit)
    corners = np.array([extent.low, extent.high])
    width, height, _ = Units(corners[0], across, up).to_metric(corners)[1].tolist()
    frame = Frame.of_all((width, height), options["parameters"]["cell"], extent.count)
    return {
        **options,
        "points": str(points.folder),
        "low": list(extent.low),
        "across": across,
        "up": up,
        "frame": asdict(frame),
        "notes": list(notes),
        "crs": None if points.crs is None else str(points.crs),
    }


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Label the points of a tile."""
    tile, options = part.job.tile, part.job.options
    units = Units(np.array(options["low"]), options["across"], options["up"])
    parameters = Parameters(**options["parameters"])
    window = GroundWindow.around(
        tile.box, Frame(**options["frame"]), units, parameters, options["reach"]
    )
    found = part.store.read_box(window.bounds)
    own = are_owned(found.points, tile.box)
    if not own.any():
        return 0, {}, []
    classes = window.classify(found.points)[own]
    numbers = found.numbers[own]
    names = [f"{tile.key}.numbers.npy", f"{tile.key}.classes.npy"]
    arrays: tuple[AnyArray, AnyArray] = (numbers, classes)
    for name, values in zip(names, arrays, strict=True):
        with replacing(part.folder / name) as file:
            np.save(file, values)
    inputs = np.unique(numbers // ROWS_OF_A_FILE).tolist()
    return len(numbers), {"inputs": inputs}, names


# ---------------------------------------------------------------------- the files


@dataclass(frozen=True)
class FileJob:
    """A file of points that is to be written with its classes.

    Attributes
    ----------
    folder : Path
        Of the run.
    number : int
        Of the file among all.
    source : Fingerprint
    name : str
        Of the file that is written.
    labels : list of (str, str)
        Files of the numbers and of the classes of the tiles that it meets.
    reading : mapping
        Options of the reader.
    where : mapping
        Values of attributes that points must have.
    ground_only : bool
    """

    folder: Path
    number: int
    source: Fingerprint
    name: str
    labels: list[tuple[str, str]]
    reading: Mapping[str, Any] = field(default_factory=dict)
    where: Mapping[str, Any] = field(default_factory=dict)
    ground_only: bool = False

    @property
    def key(self) -> str:
        """Name of the task."""
        return f"{self.number:06d}"


def combine(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record], phase: Phase
) -> dict[str, Record]:
    """Write all files, when all labels are known."""
    return phase.run(run, FILES, write_file, _list_file_jobs(run, options, records))


def _list_file_jobs(
    run: Run, options: Mapping[str, Any], records: Mapping[str, Record]
) -> list[FileJob]:
    manifest = Run(Path(options["points"])).manifest or {}
    inputs = [Fingerprint(**one) for one in manifest["inputs"]]
    reading = {name: value for name, value in manifest["options"].items() if name not in _CHOOSING}
    labels: dict[int, list[tuple[str, str]]] = {}
    for record in records.values():
        numbers, classes = sorted(record.files, reverse=True) if record.files else ("", "")
        for number in record.values.get("inputs", ()):
            labels.setdefault(number, []).append((numbers, classes))
    names = name_files([Path(one.path) for one in inputs])
    return [
        FileJob(
            run.folder,
            number,
            source,
            names[number],
            labels.get(number, []),
            reading,
            manifest["options"]["where"],
            options["ground_only"],
        )
        for number, source in enumerate(inputs)
    ]


def write_file(job: FileJob) -> Record:
    """Write a file with its classes; what is wrong becomes the record's sentence.

    Raises
    ------
    WriteError
        If the folder cannot be written.
    """
    started = perf_counter()
    run = Run(job.folder)
    (job.folder / FILES).mkdir(exist_ok=True)
    try:
        made = _write(job)
        files = {f"{FILES}/{job.name}": hash_file(job.folder / FILES / job.name)}
        record = Record(
            job.key,
            "done" if made.count else "empty",
            seconds=perf_counter() - started,
            points=made.count,
            values=asdict(made),
            files=files if made.count else {},
        )
    except WriteError as error:
        if isinstance(error.__cause__, OSError):
            raise
        record = Record(job.key, "failed", str(error), perf_counter() - started)
    except TinsmithError as error:
        record = Record(job.key, "failed", str(error), perf_counter() - started)
    except MemoryError:
        record = Record(job.key, "failed", f"There is no memory left to write '{job.name}'.")
    run.add(FILES, record)
    return record


def _write(job: FileJob) -> LabelledFile:
    source = Path(job.source.path)
    job.source.require_same()
    labels = _Labels(job)
    with (
        naming_file(source),
        stream_points(source, **{**job.reading, "attributes": "all"}) as stream,
    ):
        made = write_labelled(
            stream, source, job.folder / FILES / job.name, labels.find, stream.crs
        )
    job.source.require_same()
    return made


class _Labels:
    """Classes of the points of a file, from the tiles that it meets."""

    def __init__(self, job: FileJob) -> None:
        self._job = job
        self._parts = [
            tuple(np.load(job.folder / name, mmap_mode="r") for name in names)
            for names in job.labels
        ]

    def find(self, chunk: PointChunk) -> tuple[UInt8Array, BoolArray | None]:
        """Return the classes of a chunk, and which points of it are written."""
        classes = np.full(len(chunk), _UNCLASSIFIED, np.uint8)
        is_noise = are_noise(chunk.attributes, len(chunk))
        classes[is_noise] = chunk.attributes["classification"][is_noise]
        first = self._job.number * ROWS_OF_A_FILE
        rows = chunk.rows + first
        for numbers, labels in self._parts:
            start, stop = np.searchsorted(numbers, [rows[0], rows[-1] + 1])
            places = np.searchsorted(rows, numbers[start:stop])
            classes[places] = labels[start:stop]
        return classes, self._choose(chunk, classes)

    def _choose(self, chunk: PointChunk, classes: UInt8Array) -> BoolArray | None:
        job = self._job
        if not job.where and not job.ground_only:
            return None
        chosen = np.ones(len(chunk), np.bool_)
        for name, values in job.where.items():
            chosen &= np.isin(chunk.attributes[name], np.asarray(values))
        if job.ground_only:
            chosen &= classes == _GROUND
        return chosen


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> GroundTiles:
    """Return the files that were written.

    Raises
    ------
    ReadError
        If no point is left.
    """
    counts: Counter[int] = Counter()
    files = []
    for record in records.values():
        made = LabelledFile(**record.values)
        counts.update({int(number): count for number, count in made.classes.items()})
        files += [
            NamedFile(folder / name, made.count, made.low, made.high) for name in record.files
        ]
    if not files:
        raise ReadError("No point is ground.")
    reach = (
        f"The ground of a tile was found with the points up to {options['reach']:g} m around it: "
        "labels may differ from those of all points at once where buildings reach further."
    )
    notes = (*points.notes, *options["notes"], reach)
    return GroundTiles(tuple(files), dict(sorted(counts.items())), points.crs, notes)


PRODUCT = TileProduct(
    check_options,
    compute,
    join,
    settle_options=settle_options,
    combine=combine,
    is_of_surface=False,
)
