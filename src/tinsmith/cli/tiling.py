"""Products of more points than memory holds: tiles, their workers, and when they are taken."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..base.sentences import counted, inflect
from .options import gather_options
from .output.failures import Failure
from .parameters import number_option, under
from .paths import STANDARD

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..tiled.cloud import TiledPoints
    from ..tiled.workers import Status
    from .job import Job, Products
    from .output.facts import Facts

__all__ = [
    "Tiling",
    "choose_tiles",
    "compute_tiles",
    "describe_plan",
    "describe_points",
    "tiling_options",
]

_BYTES_IN_MEMORY = 400
"""Of a point, while its TIN is built in memory as a whole."""


@dataclass(frozen=True)
class Tiling:
    """Whether and how a product is computed in tiles."""

    tiles: int | None = None
    workers: int | None = None
    memory: float | None = None
    dask: str | None = None
    run: Path | None = None
    restart: bool | None = None
    plan: bool = False

    @property
    def is_asked(self) -> bool:
        """Whether any of the options was given."""
        return any(value not in (None, False) for value in vars(self).values()) or (
            self.restart is False
        )

    @property
    def way(self) -> dict[str, Any]:
        """Options of products of :class:`tinsmith.TiledPoints`."""
        names = ("tiles", "workers", "memory", "dask", "run", "restart")
        given = {name: getattr(self, name) for name in names}
        return {name: value for name, value in given.items() if value is not None}


tiling_options = gather_options(
    "tiling",
    Tiling,
    *under(
        "Tiles, for more points than memory holds",
        number_option(
            "--tiles",
            "N",
            "Compute in this many tiles at least, whatever memory there is. The result is the "
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
            "--plan", is_flag=True, help="Tell what would be done, in how much memory; do nothing."
        ),
    ),
)


def choose_tiles(file: Path, job: Job, tiling: Tiling) -> TiledPoints | None:
    """Return the points of a file or folder, if they are to be taken in tiles; else None.

    That is where an option of tiles was given, or the headers tell of more points than the TIN of
    which there is memory for, which is noted.

    Raises
    ------
    Failure
        If tiles were asked for, and something else that needs all points at a time.
    """
    if file == STANDARD:
        _refuse(tiling, "points from standard input: name a file")
        return None
    reading, how = job.reading, job.how
    if not tiling.is_asked and not _may_be_large(file):
        return None
    from ..io.isolated.limits import measure_free_memory
    from ..tiled import tiles

    given = {name: value for name, value in reading.given.items() if name != "remote"}
    reasons = {
        "--remote": reading.remote,
        "--to-crs": reading.to_crs,
        "--snap": how.snap,
        **dict.fromkeys(how.shaping, True),
    }
    asked = next((flag for flag, value in reasons.items() if value), None)
    if asked is not None:
        _refuse(tiling, f"{asked}, which looks at all points at a time")
        return None
    duplicates: Any = how.duplicates
    cloud = tiles(file, duplicates=duplicates, **given)
    if tiling.is_asked:
        return cloud
    count, free = cloud.count_about, measure_free_memory()
    if count * _BYTES_IN_MEMORY <= free:
        return None
    needed = inflect(f"{counted(count, 'point')} [needs|need] about", count)
    job.console.note(
        [
            f"{needed} {count * _BYTES_IN_MEMORY / 1e9:,.0f} GB in memory, and {free / 1e9:,.0f} "
            "GB are free: the surface was computed in tiles, with the same result."
        ]
    )
    return cloud


def _refuse(tiling: Tiling, what: str) -> None:
    if tiling.is_asked:
        raise Failure(f"Tiles cannot be computed with {what}.")


def _may_be_large(file: Path) -> bool:
    """Whether files have so many bytes that it pays to look at their headers."""
    try:
        parts = [*file.iterdir()] if file.is_dir() else [file]
        return sum(one.stat().st_size for one in parts) > _SMALL
    except OSError:
        return False  # the reader tells better


_SMALL = 200 << 20


@contextmanager
def compute_tiles(
    cloud: TiledPoints, product: str, planned: Products, job: Job, tiling: Tiling, **asked: Any
) -> Iterator[Any]:
    """Yield a product of tiles, showing how far each step is.

    Raises
    ------
    Failure
        If there is no output beside which the run can be kept.
    """
    from ..tiled.computing import computing
    from ..tiled.how import How

    output = next((path for path in planned.paths if path != STANDARD), None)
    if output is None:
        raise Failure("Tiles need an output file, beside which the run is kept: name it by -o.")
    shown = _Shown(job)
    how = How.of(**tiling.way, progress=shown.take)
    with shown.stack, computing(cloud, product, output, how, **asked) as made:
        shown.stack.close()
        yield made


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
            text = f"{status.step} {counted(status.total, 'tile' if status.total else 'part')}"
            self._tell = self.stack.enter_context(self._job.console.step(text))
        if status.total:
            self._tell(status.done / status.total)


def describe_points(cloud: TiledPoints) -> str:
    """Write how many points there are, and in how many files."""
    count = "points" if cloud.count is None else counted(cloud.count, "point")
    return f"{count} in {counted(len(cloud.files), 'file')}, computed in tiles"


def describe_plan(cloud: TiledPoints, tiling: Tiling, facts: Facts) -> None:
    """Add what a run would do."""
    plan = cloud.plan(**tiling.way)
    facts.add("Points", f"{plan.count:,} in {counted(len(cloud.files), 'file')}", points=plan.count)
    facts.add(
        "Tiles",
        f"about {plan.tiles:,}, up to {plan.tile_points:,} points each",
        tiles=plan.tiles,
        tile_points=plan.tile_points,
    )
    facts.add(
        "Workers",
        f"{plan.workers}, {plan.memory / 1e6:,.0f} MB each",
        workers=plan.workers,
        worker_bytes=plan.memory,
    )
    facts.add("Disk", f"{plan.disk / 1e6:,.0f} MB while it runs", disk_bytes=plan.disk)
    facts.add("Time", f"about {plan.seconds:,.0f} s", seconds=plan.seconds)
