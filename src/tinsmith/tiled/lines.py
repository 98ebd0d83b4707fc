"""Lines of a surface in tiles: given in memory or in files, and cut where they meet, once.

A line is cut where it passes a point, too. So every file of points is looked at for those that lie
on lines, or so near that a line may be bent onto them. All else is done on one machine, and what
comes of it is a file in the folder of the run, which tasks read.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.atomic import replacing
from ..base.errors import CrsError, PointsError, ReadError, TinsmithError, WriteError
from ..base.notes import naming_file
from ..base.sentences import counted
from ..base.types import Bounds
from ..io import with_lines
from ..io.vector import require_near, split_layer
from ..tin import Survey
from ..tin.building import BuildOptions, gather_inputs
from ..tin.constraints import ConstraintTable, LineSet, as_sequence, in_rings
from ..tin.tiling import (
    Draping,
    NodedLines,
    NumberedPoints,
    Rings,
    choose_near,
    find_outline,
    find_rim,
    intersect,
    list_segments_near,
    node_base,
    node_laid,
    node_lines,
    require_local,
    widen,
)
from .chunks import ROWS_OF_A_FILE
from .reading import StoredPoints, load_points, name_rows, save_points
from .running import Fingerprint, Record, Run, hash_file
from .store import load_chunks

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..base.arrays import AnyArray, Float64Array
    from ..base.policies import CrossingPolicy, DuplicatePolicy
    from ..tin.building import BuildInputs
    from .draping import Drape
    from .running import Phase

KINDS = ("breaklines", "boundary", "holes")
"""Options that take lines."""

_NEAR, _NODED = "near", "lines"
_GIVEN = "lines.given.npz"
_MARGIN = 2.0**-30
"""Of coordinates: how far beside a box segments are looked for, far more than they are bent."""


# ------------------------------------------------------------------ what is given


@dataclass(frozen=True, eq=False, kw_only=True)
class GivenLines:
    """Lines that callers gave, in memory.

    Attributes
    ----------
    survey : Survey
        Without points: the lines of files, and CRS and unit of the points.
    values : mapping of str to list
        Further lines, as :func:`tinsmith.triangulate` takes them.
    files : tuple of Fingerprint
        Of the files of lines.
    boxes : tuple of (Path, Bounds)
        Where the lines of each file lie.
    """

    survey: Survey
    values: Mapping[str, Any] = field(default_factory=dict)
    files: tuple[Fingerprint, ...] = ()
    boxes: tuple[tuple[Path, Bounds], ...] = ()

    def read(self, sources: Mapping[str, Any], **how: Any) -> GivenLines:
        """Add lines of files, as :func:`tinsmith.with_lines` does; ``sources`` by option.

        Raises
        ------
        ReadError, CrsError, LinesError
            As :func:`tinsmith.with_lines`.
        """
        survey, files, boxes = self.survey, list(self.files), list(self.boxes)
        for name, several in sources.items():
            for source in several:
                path = split_layer(source)[0]
                found = [Fingerprint.take(path)] if path.is_file() else []  # else the reader tells
                one: dict[str, Any] = {name: [source]}
                before, survey = survey, with_lines(survey, **one, **how)
                for file in found:
                    file.require_same()
                files += found
                boxes.append((path, _find_bounds(before, survey)))
        return replace(self, survey=survey, files=tuple(files), boxes=tuple(boxes))

    def require_same(self) -> None:
        """Refuse files that were changed since they were read.

        Raises
        ------
        ReadError
        """
        for file in self.files:
            path = Path(file.path)
            if Fingerprint.take(path) != file:
                raise ReadError(
                    f"'{path}' was changed since its lines were read: read them again.", path=path
                )

    def gather(
        self, *, duplicates: DuplicatePolicy, crossing: CrossingPolicy
    ) -> BuildInputs | None:
        """Check all lines, and options of the build; None if there are none.

        Raises
        ------
        OptionError, LinesError, CrsError
            As :func:`tinsmith.triangulate`, or if tiles cannot have such lines.
        """
        lines = {name: self.values.get(name, ()) for name in KINDS}
        found = self.survey
        own = [*found.breaklines, *found.boundary, *found.holes, *found.extent]
        if not own and not any(as_sequence(values, name) for name, values in lines.items()):
            return None
        inputs = gather_inputs(
            self.survey,
            BuildOptions(duplicates=duplicates, crossing=crossing),
            **lines,
            erase=(),
            water=(),
            crs=None,
            elevation_unit=None,
        )
        require_local(inputs)
        return inputs


def _find_bounds(before: Survey, after: Survey) -> Bounds:
    """Return the bounds of the lines that a survey has gained."""
    rings: list[Any] = []
    for one in after.breaklines[len(before.breaklines) :]:
        rings.append(one.coords)  # type: ignore[union-attr]
    for name in ("boundary", "holes"):
        for ring in getattr(after, name)[len(getattr(before, name)) :]:
            rings += ring if isinstance(ring, list) else [ring]
    return Bounds.of(np.concatenate([ring[:, :2] for ring in rings]))


def as_files(value: Any) -> list[Any] | None:
    """Return the files that a value names: one, or several in a list; None if it holds lines."""
    several = list(value) if isinstance(value, list | tuple) else [value]
    is_file = [isinstance(one, str) or hasattr(one, "__fspath__") for one in several]
    return several if several and all(is_file) else None


def describe_lines(inputs: BuildInputs) -> dict[str, Any]:
    """Return plain values that differ for other lines, by the options that take them."""
    lines, found = inputs.lines, {}
    table = lines.table
    kinds = {
        "breaklines": table.is_kind("hard", "soft"),
        "boundary": table.is_kind("boundary"),
        "holes": table.is_kind("hole"),
    }
    for name, are_of_kind in kinds.items():
        chosen = lines.choose(are_of_kind)
        if len(chosen.kinds):
            told = [chosen.xy, chosen.elevations, chosen.offsets, chosen.priorities]
            digest = hashlib.blake2b(digest_size=8)
            for values in told:
                digest.update(np.ascontiguousarray(values).tobytes())
            digest.update(repr((chosen.kinds, [len(hole) for hole in inputs.holes])).encode())
            found[name] = f"{counted(len(chosen.kinds), 'line')} ({digest.hexdigest()})"
    return found | {"crossing": inputs.options.crossing}


# ------------------------------------------------------------- points that lie on lines


@dataclass(frozen=True)
class NearJob:
    """A file of points of which those are wanted that lie on lines.

    Attributes
    ----------
    folder : Path
        Of the run, which holds the lines.
    points : Path
        Folder of the points.
    number : int
        Of the file among all.
    """

    folder: Path
    points: Path
    number: int

    @property
    def key(self) -> str:
        """Name of the task."""
        return f"{self.number:06d}"


def find_near(job: NearJob) -> Record:
    """Find the points of a file at which lines may be cut.

    Raises
    ------
    WriteError
        If the folder cannot be written, which is no fault of the points.
    """
    started = perf_counter()
    run = Run(job.folder)
    (job.folder / _NEAR).mkdir(exist_ok=True)
    try:
        with np.load(job.folder / _GIVEN) as found:
            lines = _as_lines(found["xy"], found["offsets"])
        near = NumberedPoints.join([NumberedPoints.none(), *_list_near(job, lines)])
        name = f"{_NEAR}/{job.key}.npz"
        save_points(job.folder / name, near)
        record = Record(
            job.key,
            "done" if len(near.numbers) else "empty",
            seconds=perf_counter() - started,
            points=len(near.numbers),
            files={name: hash_file(job.folder / name)},
        )
    except WriteError:
        raise
    except TinsmithError as error:
        record = Record(job.key, "failed", str(error), perf_counter() - started)
    except MemoryError:
        record = Record(job.key, "failed", "There is no memory left to look for points on lines.")
    run.add(_NEAR, record)
    return record


def _as_lines(xy: Float64Array, offsets: AnyArray) -> LineSet:
    """Return lines of which only the places count."""
    count = len(offsets) - 1
    table = ConstraintTable.of_kind("hard", np.arange(count, dtype=np.int32), np.zeros(count))
    return LineSet(xy, np.zeros(len(xy)), offsets, table)


def _list_near(job: NearJob, lines: LineSet) -> Iterator[NumberedPoints]:
    index = job.points / f"{job.key}.chunks.npy"
    for chunk in load_chunks(index, job.points) if index.exists() else ():
        reach = _MARGIN * float(np.abs([*_list_limits(chunk.bounds)]).max())
        for part in chunk.list_parts():
            ends = list_segments_near(lines, widen(part, reach)).reshape(-1, 2)
            if len(ends):
                box = intersect(widen(Bounds.of(ends), reach), widen(part, reach))
                yield choose_near(chunk.read_boxes(np.array([_list_limits(box)])), lines)


def _list_limits(box: Bounds) -> tuple[float, float, float, float]:
    return box.xmin, box.ymin, box.xmax, box.ymax


# --------------------------------------------------------------------- cut lines


class StoredLines(NamedTuple):
    """Lines as tasks read them.

    Attributes
    ----------
    noded : NodedLines
    rim : (k, 3) float64 array
        The vertices on the boundary of the surface.
    bounds : Bounds
        Of the surface.
    """

    noded: NodedLines
    rim: Float64Array
    bounds: Bounds


def prepare_lines(
    given: GivenLines, inputs: BuildInputs, phase: Phase, drape: Drape
) -> StoredPoints:
    """Cut the lines, if no record says that it is done; return the points of the whole surface.

    Parameters
    ----------
    given : GivenLines
    inputs : BuildInputs
        Of these lines.
    phase : Phase
        In which points on lines are looked for.
    drape : Drape
        How those without elevations are draped, of which run and points.

    Raises
    ------
    CrsError, ReadError
        If the lines lie elsewhere than the points, or the points are in another CRS than their
        headers say.
    LinesError
        As :func:`tinsmith.triangulate`.
    PointsError
        If points coincide and may not.
    """
    run, points = drape.run, drape.points
    _require_fitting(points, given)
    record = run.read(_NODED).get("0")
    if record is None:
        record = _node(inputs, phase, drape)
        run.add(_NODED, record)
    (name,) = record.files
    told = record.values
    return replace(
        points,
        crs=points.crs if inputs.crs is None else inputs.crs,
        elevation_unit=inputs.elevation_unit or points.elevation_unit,
        notes=tuple(dict.fromkeys([*points.notes, *inputs.notes, *told["notes"]])),
        bounds=Bounds(*told["bounds"]),
        elevations=(told["elevations"][0], told["elevations"][1]),
        is_raster=points.is_raster and not told["has_inner_lines"],
        lines=run.folder / name,
    )


def _require_fitting(points: StoredPoints, given: GivenLines) -> None:
    """Refuse points in another CRS or unit than the lines were taken for, or far from them."""
    survey = given.survey
    known, expected = points.crs, survey.crs
    is_same = known is expected if known is None or expected is None else known.is_same(expected)
    if not is_same:
        labels = ["no CRS" if one is None else one.label for one in (known, expected)]
        raise CrsError(
            f"The points are in {labels[0]}, but their headers tell of {labels[1]}, for which the "
            "lines were taken: declare the CRS of the points (`crs`).",
            crs=known,
        )
    if points.elevation_unit != survey.elevation_unit:
        raise ReadError(
            f"The elevations of the points are in {points.elevation_unit or 'an unknown unit'}, "
            f"but their headers tell of {survey.elevation_unit or 'an unknown unit'}, for which "
            "the lines were taken: declare the unit (`elevation_unit`)."
        )
    for path, box in given.boxes:
        with naming_file(path):
            require_near(points.bounds, box)


def _node(inputs: BuildInputs, phase: Phase, drape: Drape) -> Record:
    """Cut lines where they meet and pass points, and write them with what they tell at once."""
    started = perf_counter()
    run, points = drape.run, drape.points
    skeleton, first_number = points.open().skeleton, points.files * ROWS_OF_A_FILE
    near = _find_near(run, points, phase, _list_paths(inputs, skeleton))
    try:
        if inputs.lines.is_draped.any():
            noded, notes = _node_draped(inputs, near, first_number, drape)
        else:
            noded, notes = node_lines(near, inputs, first_number=first_number), ()
    except PointsError as error:
        if error.rows:
            rows = name_rows(points.folder, list(error.rows))
            raise PointsError(f"Points lie at one place: {rows}.") from error
        raise
    outline = find_outline(skeleton, noded)
    name = _save_lines(run.folder, noded, outline.rim)
    z = np.append(noded.vertices.points[:, 2], points.elevations)
    return Record(
        "0",
        "done",
        seconds=perf_counter() - started,
        points=len(noded.vertices.numbers),
        values={
            "bounds": list(_list_limits(outline.bounds)),
            "area": str(outline.area),
            "is_clipped": outline.is_clipped,
            "has_inner_lines": outline.has_inner_lines,
            "elevations": [float(z.min()), float(z.max())],
            "notes": list(notes),
        },
        files={name: hash_file(run.folder / name)},
    )


def _list_paths(inputs: BuildInputs, skeleton: NumberedPoints) -> list[Float64Array]:
    """Return all lines, (k, 2) each, and the convex hull if lines are draped that may leave it."""
    lines = inputs.lines
    paths = np.split(lines.xy, lines.offsets[1:-1])
    draped, others = lines.choose(lines.is_draped), lines.choose(~lines.is_draped)
    if not draped.kinds:
        return paths
    vertices = np.column_stack([others.xy, others.elevations])
    together = np.concatenate([skeleton.points, vertices])
    rim = find_rim(NumberedPoints(together, np.arange(len(together))))[:, :2]
    if (in_rings(draped.xy, [rim]) > 0).all():
        return paths
    return [*paths, np.concatenate([rim, rim[:1]])]


def _find_near(
    run: Run, points: StoredPoints, phase: Phase, paths: list[Float64Array]
) -> NumberedPoints:
    """Return the points of all files that lie on lines, or may."""
    offsets = np.cumsum([0, *map(len, paths)])
    with replacing(run.folder / _GIVEN) as file:
        np.savez(file, xy=np.concatenate(paths), offsets=offsets)
    jobs = [NearJob(run.folder, points.folder, number) for number in range(points.files)]
    records = phase.run(run, _NEAR, find_near, jobs)
    found = [load_points(run.folder / name) for one in records.values() for name in one.files]
    return NumberedPoints.join([NumberedPoints.none(), *found])


def _node_draped(
    inputs: BuildInputs, near: NumberedPoints, first_number: int, drape: Drape
) -> tuple[NodedLines, tuple[str, ...]]:
    """Cut lines, those without elevations draped on the surface of everything else."""
    skeleton, base = drape.points.open().skeleton, None
    rim = skeleton
    if not inputs.lines.is_draped.all():
        noded = node_base(near, inputs, first_number=first_number)
        rim = NumberedPoints.join([skeleton, noded.skeleton])
        base = drape.run.folder / _save_lines(drape.run.folder, noded, find_rim(rim))
    laid = drape.lay(Draping.of(inputs, find_rim(rim)), base)
    return node_laid(near, skeleton, laid, first_number=first_number), laid.notes


def _save_lines(folder: Path, noded: NodedLines, rim: Float64Array) -> str:
    """Write cut lines to a file, and return its name, which tells what it holds."""
    arrays: dict[str, AnyArray] = {
        "points": noded.vertices.points,
        "numbers": noded.vertices.numbers,
        "segments": noded.segments,
        "are_rings": noded.are_rings,
        "rim": rim,
    }
    if noded.rings is not None:
        rings = noded.rings
        groups = [rings.boundary, rings.extent, *rings.holes]
        every = [ring for group in groups for ring in group]
        arrays["corners"] = np.concatenate(every)
        arrays["corner_counts"] = np.array([len(ring) for ring in every], np.int64)
        arrays["ring_counts"] = np.array([len(group) for group in groups], np.int64)
    digest = hashlib.blake2b(digest_size=8)
    for values in arrays.values():
        digest.update(np.ascontiguousarray(values).tobytes())
    name = f"lines.{digest.hexdigest()}.npz"
    with replacing(folder / name) as file:
        np.savez(file, **arrays)  # type: ignore[arg-type]
    return name


@lru_cache(maxsize=2)
def open_lines(path: Path) -> StoredLines:
    """Return cut lines; they are kept for the next task, as the name of the file tells them."""
    with np.load(path) as found:
        arrays = dict(found)
    rings = None
    if "corners" in arrays:
        every = np.split(arrays["corners"], np.cumsum(arrays["corner_counts"])[:-1])
        groups, start = [], 0
        for count in arrays["ring_counts"].tolist():
            groups.append(every[start : start + count])
            start += count
        rings = Rings(boundary=groups[0], extent=groups[1], holes=groups[2:])
    noded = NodedLines(
        vertices=NumberedPoints(arrays["points"], arrays["numbers"]),
        segments=arrays["segments"],
        are_rings=arrays["are_rings"],
        rings=rings,
    )
    return StoredLines(noded, arrays["rim"], Bounds.of(arrays["rim"]))
