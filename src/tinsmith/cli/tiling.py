"""Products of more points than memory holds: their options, and when tiles are taken."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..base.sentences import counted
from .job import Job, surface_options
from .options import CONSOLE, READING, TRIANGULATING, WRITING, Group
from .output import Facts, Failure, note_written
from .parameters import number_option, under
from .paths import STANDARD

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..tiled.running import RunSettings, Status
    from ..tiled.tiled_points import Plan, TiledPoints
    from .outputs import Products
    from .parameters import Decorator

_BYTES_IN_MEMORY = 400
"""Of a point, while its TIN is built in memory as a whole."""

LINES_OF_TILES = ("breaklines", "soft_breaklines", "boundary", "holes")
"""Options of files of lines that surfaces in tiles can have."""

_LINES = [f"--{name.replace('_', '-')}" for name in LINES_OF_TILES]

_SMALL = 200 << 20
"""Bytes of files whose headers are not looked at: they fit into any memory."""


@dataclass(frozen=True)
class Tiling:
    """Whether and how a product is computed in tiles; None leaves it to the library."""

    tiles: int | None = None
    workers: int | None = None
    memory: float | None = None
    dask: str | None = None
    run: Path | None = None
    restart: bool | None = None
    in_place: bool | None = None
    plan: bool | None = None

    @property
    def given(self) -> dict[str, Any]:
        """Options that were given."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def run_options(self) -> dict[str, Any]:
        """Options of products of :class:`tinsmith.TiledPoints`."""
        others = ("plan", "in_place")
        return {name: value for name, value in self.given.items() if name not in others}


TILING = Group(
    "tiling",
    Tiling,
    under(
        "Tiles, for more points than memory holds",
        number_option(
            "--tiles",
            "N",
            "Compute in this many tiles at least, whatever memory there is; the result is the "
            "same.",
            type=click.IntRange(min=1),
        ),
        number_option(
            "--workers", "N", "Processes; default every core.", type=click.IntRange(min=1)
        ),
        number_option("--memory", "MB", "Memory of a worker; default its share of what is free."),
        click.option(
            "--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster that does the work."
        ),
        click.option(
            "--run",
            type=click.Path(path_type=Path),
            metavar="FOLDER",
            help="Folder of what is done so far; default the output's name with .run.",
        ),
        click.option(
            "--restart/--resume",
            default=None,
            help="Begin anew, or go on with a run that was interrupted (the default).",
        ),
        click.option(
            "--in-place",
            is_flag=True,
            default=None,
            help="Read COPC, rasters in tiles and GeoParquet with bounds where they are, again and "
            "again: next to no disk, mostly more time.",
        ),
        click.option(
            "--plan",
            is_flag=True,
            default=None,
            help="Tell what would be done, in how much memory; do nothing.",
        ),
    ),
)


def tiled_options() -> Decorator:
    """Return a decorator of commands on surfaces that can be computed in tiles."""
    return surface_options(READING, TRIANGULATING, TILING, WRITING, CONSOLE)


def choose_tiles(
    job: Job, *files: Path, whole: str = "", joins: bool = False, others: Sequence[Path] = ()
) -> TiledPoints | None:
    """Return the points of a file or folder, if they are to be taken in tiles; else None.

    That is where an option of tiles was given, or the headers tell of more points than there is
    memory for, which is noted. With --plan the command ends here, and tells what it would do.

    Parameters
    ----------
    job : Job
    *files : Path
    whole : str
        What else was asked for that needs all points at a time, if anything.
    joins : bool
        Whether the points of several files are one survey.
    others : sequence of Path
        Surfaces that need not be in tiles: see :func:`choose_other`.
    """
    tiling, how = job.tiling, job.building
    needs = {
        "points from standard input": STANDARD in files,
        "several surfaces": len(files) != 1 and not joins,
        "--remote": job.reading.remote,
        "--to-crs": job.reading.to_crs,
        "--snap": how.snap,
        **dict.fromkeys((flag for flag in how.shaping if flag not in _LINES), True),
        whole: bool(whole),
    }
    asked = next((what for what, is_there in needs.items() if is_there), None)
    if asked is not None:
        if tiling.given:
            raise Failure(
                f"Tiles cannot be computed with {asked}: all points are needed at a time."
            )
        return None
    if not tiling.given and not any(map(_may_be_large, (*files, *others))):
        return None
    from ..io.isolated import measure_free_memory

    cloud = take_points(job, *files)
    if not tiling.given:
        count, free = cloud.count_about, measure_free_memory()
        count += sum(one.count_about for other in others if (one := choose_other(job, other)))
        if count * _BYTES_IN_MEMORY <= free:
            return None
        job.console.note(
            [
                f"The surface of {counted(count, 'point')} needs about "
                f"{count * _BYTES_IN_MEMORY / 1e9:,.0f} GB of memory, and {free / 1e9:,.0f} GB "
                "are free: it was computed in tiles, with the same result."
            ]
        )
    cloud = _add_lines(cloud, job)
    if tiling.plan:
        _tell_plan(cloud, job, files[0])
        click.get_current_context().exit()
    return cloud


def take_points(job: Job, *files: Path) -> TiledPoints:
    """Return the points of files or folders, by their headers."""
    from ..tiled import tiles

    given = {name: value for name, value in job.reading.given.items() if name != "remote"}
    method: Any = {"duplicates": job.building.duplicates, "crossing": job.building.crossing}
    return tiles(files, in_place=bool(job.tiling.in_place), **method, **given)


def _add_lines(cloud: TiledPoints, job: Job) -> TiledPoints:
    """Add the lines of files, showing progress."""
    how = job.building
    files = {name: getattr(how, name) for name in LINES_OF_TILES if getattr(how, name)}
    if not files:
        return cloud
    with job.step("Reading lines"):
        return cloud.with_lines(**files, drape=how.drape, elevation_unit=how.lines_elevation_unit)


def choose_other(job: Job, file: Path) -> TiledPoints | None:
    """Return a further surface in tiles, if it is a folder or a large file; None to read it."""
    if file == STANDARD or not (file.is_dir() or _may_be_large(file)):
        return None
    return take_points(job, file)


def _may_be_large(file: Path) -> bool:
    try:
        parts = [*file.iterdir()] if file.is_dir() else [file]
        return sum(one.stat().st_size for one in parts) > _SMALL
    except OSError:
        return False  # the reader tells better


def _tell_plan(cloud: TiledPoints, job: Job, file: Path) -> None:
    """Tell what a run would do."""
    plan = cloud.plan(**job.tiling.run_options)
    facts = Facts(file)
    files = counted(len(cloud.files), "file")
    facts.add("Points", f"about {plan.count:,} in {files}", points=plan.count)
    add_plan(facts, plan)
    facts.note(dict.fromkeys(note for header in cloud.headers for note in header.notes))
    job.console.answer(facts)


def add_plan(facts: Facts, plan: Plan) -> None:
    """Add what a run would take."""
    text = f"about {plan.tiles:,}, up to {plan.tile_points:,} points each"
    facts.add("Tiles", text, tiles=plan.tiles, tile_points=plan.tile_points)
    text = f"{plan.workers}, {plan.memory / 1e6:,.0f} MB each"
    facts.add("Workers", text, workers=plan.workers, worker_bytes=plan.memory)
    text = f"up to {plan.disk / 1e6:,.0f} MB while it runs"
    facts.add("Disk", text, disk_bytes=plan.disk)
    if plan.in_place or plan.copied:
        _add_places(facts, plan)
    facts.add("Time", f"about {plan.seconds:,.0f} s", seconds=plan.seconds)


def _add_places(facts: Facts, plan: Plan) -> None:
    """Add how many files are read in place, and why others are not."""
    text = counted(plan.in_place, "file")
    others = [f'{count:,}, "{why}"' for why, count in plan.copied.items()]
    text = f"{text}; copied: {'; '.join(others)}" if others else text
    facts.add("In place", text, files_in_place=plan.in_place, files_copied=plan.copied)


@contextmanager
def compute_tiles(
    cloud: TiledPoints, product: str, planned: Products, job: Job, **asked: Any
) -> Iterator[Any]:
    """Yield a product of tiles, showing how far each step is."""
    from ..tiled.computing import computing

    output = next((path for path in planned.paths if path != STANDARD), None)
    if output is None:
        raise Failure("Tiles need an output file, beside which the run is kept: name it by -o.")
    with (
        showing_tiles(job) as settings,
        computing(cloud, product, output, settings, **asked) as made,
    ):
        yield made


@contextmanager
def showing_tiles(job: Job) -> Iterator[RunSettings]:
    """Yield how a run is carried out, showing how far each step is."""
    from ..tiled.running import RunSettings

    with showing_progress(job) as run_options:
        yield RunSettings.of(**run_options)


@contextmanager
def showing_progress(job: Job) -> Iterator[dict[str, Any]]:
    """Yield the same as options, checked by whom they are handed to."""
    shown = _Shown(job)
    with shown.stack:
        yield {**job.tiling.run_options, "progress": shown.take}


def write_surface(cloud: TiledPoints, job: Job, scales: Mapping[str, Any]) -> Path:
    """Write the surface of tiles as a folder or as one file; ``scales`` are of 3D Tiles."""
    from ..io import find_format
    from ..io.registry import list_writers
    from ..tiled.tiled_points import OPTIONS_OF_SCALES

    name = (job.writing.output_format or "").strip().lower()
    able = OPTIONS_OF_SCALES.get(name, set())
    if (
        len(job.outputs) != 1
        or job.outputs[0] == STANDARD
        or not job.writing.options.keys() <= able
    ):
        raise Failure(
            "The surface of tiles is written as one file (.ply) or one folder of files: name it by "
            "-o, and its format by --output-format."
        )
    (output,) = job.outputs
    if output.suffix and not output.is_dir() and not list_writers(output, None, "TIN"):
        raise Failure(
            f"The surface of tiles is written as one file (.ply) or as a folder of files, and "
            f"'{output}' is named like another file."
        )
    if not scales.keys() <= able:
        flag = next(iter(scales)).replace("_", "-")
        raise click.UsageError(f"--{flag} is for --output-format 3dtiles.")
    with showing_progress(job) as run_options:
        if able:
            cloud.write(output, format=name, **scales, **job.writing.options, **run_options)
        else:
            chosen: dict[str, Any] = {"format": find_format(name, "write").name} if name else {}
            cloud.build(output, **chosen, **run_options)
    note_written(output)
    return output


class _Shown:
    """The step that is shown, until the next begins."""

    def __init__(self, job: Job) -> None:
        self._job = job
        self._step = ""
        self._tell: Any = None
        self.stack = ExitStack()

    def take(self, status: Status) -> None:
        """Show how far a step is."""
        if status.step != self._step:
            self.stack.close()
            self._step = status.step
            text = f"{status.step}, {counted(status.total, 'task')}"
            self._tell = self.stack.enter_context(self._job.step(text))
        if status.total:
            self._tell(status.done / status.total)


def describe_lost(cloud: TiledPoints) -> list[str]:
    """Tell what of the points surfaces of tiles do not have."""
    from ..io import find_format

    formats = [find_format(header.format) for header in cloud.headers]
    has_attributes = any("attributes" in one.options("read") for one in formats)
    return ["Attributes of points are not kept in tiles."] if has_attributes else []


def describe_points(cloud: TiledPoints) -> str:
    """Write how many points there are, and in how many files."""
    count = "points" if cloud.count is None else counted(cloud.count, "point")
    return f"{count} in {counted(len(cloud.files), 'file')}, computed in tiles"
