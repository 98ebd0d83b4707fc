"""Options of a run, and from them the size of a tile: by whom, in how much memory, anew or not."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypedDict

from ...base.atomic import as_path
from ...base.checks import as_flag, as_number, require_count
from ...base.errors import OptionError
from ...io.isolated import measure_free_memory
from ...tin.validation import available_cores
from .executors import Processes, connect_to_dask
from .workers import Phase, Status

_BYTES_OF_A_WORKER = 250 << 20
"""What Python and the libraries take in each process."""
_BYTES_PER_POINT = 500
"""Memory that a point of a tile takes while the tile is triangulated, at most."""
_MOST_TILE_POINTS = 1_000_000
"""Larger tiles save nothing: their rims are a small part already."""
_FEWEST_TILE_POINTS = 10_000
_SHARE = 0.8
"""Of the free memory that all workers may take."""
_MEGABYTE = 1 << 20


class RunOptions(TypedDict, total=False):
    """Options of a run, which every product of tiles has.

    Attributes
    ----------
    executor : concurrent.futures.Executor
        Runs the tasks, such as that of a Dask client:
        ``client.get_executor(pure=False, retries=3)``. Default processes of this machine.
    dask : str
        Address of the scheduler of a Dask cluster, whose workers see the same files.
    workers : int
        Processes of this machine. Default every core.
    memory : float
        Megabytes that a worker may take. Default what is free, shared by the workers; a gigabyte
        is enough for the fastest tiles.
    tiles : int
        Fewest tiles. The result does not depend on it.
    run : path-like
        Folder of the run. Default the output's name with ``.run``.
    restart : bool
        Begin anew where a run was begun before. Default go on with it.
    keep : bool
        Keep the folder of the run when the output is written.
    progress : callable
        Called with a :class:`Status` as each task ends.
    """

    executor: Executor | None
    dask: str | None
    workers: int | None
    memory: float | None
    tiles: int
    run: str | os.PathLike[str] | None
    restart: bool
    keep: bool
    progress: Callable[[Status], None] | None


@dataclass(frozen=True)
class RunSettings:
    """The same, checked.

    Attributes
    ----------
    executor, dask, tiles, run, restart, keep, progress
        As of :class:`RunOptions`.
    workers : int
    tile_points : int
        Points of a tile, at most.
    """

    executor: Executor | None
    dask: str | None
    workers: int
    tile_points: int
    tiles: int
    run: Path | None
    restart: bool
    keep: bool
    progress: Callable[[Status], None] | None

    @classmethod
    def of(
        cls,
        *,
        executor: Executor | None = None,
        dask: str | None = None,
        workers: int | None = None,
        memory: float | None = None,
        tiles: int = 1,
        run: str | os.PathLike[str] | None = None,
        restart: bool = False,
        keep: bool = False,
        progress: Callable[[Status], None] | None = None,
    ) -> RunSettings:
        """Check what a caller gave; a :class:`RunOptions`.

        Raises
        ------
        OptionError
        """
        if executor is not None and not isinstance(executor, Executor):
            raise OptionError("executor", executor, "a concurrent.futures.Executor", or_none=True)
        if dask is not None and not isinstance(dask, str):
            raise OptionError("dask", dask, "the address of a scheduler", or_none=True)
        if executor is not None and dask is not None:
            raise OptionError("dask", dask, "None where an executor is given")
        require_count("workers", workers, or_none=True)
        require_count("tiles", tiles)
        if progress is not None and not callable(progress):
            raise OptionError("progress", progress, "a function of a Status", or_none=True)
        count = workers or available_cores()
        return cls(
            executor=executor,
            dask=dask,
            workers=count,
            tile_points=choose_tile_points(memory, count),
            tiles=tiles,
            run=None if run is None else as_path(run, "run"),
            restart=as_flag("restart", restart),
            keep=as_flag("keep", keep),
            progress=progress,
        )

    @contextmanager
    def started(self) -> Iterator[Callable[[str], Phase]]:
        """Yield a function that returns a step of a run by its name, with workers for it."""
        own = self.executor
        if own is not None:
            yield lambda step: Phase(step, own, self.workers, self.progress)
        elif self.dask is not None:
            with connect_to_dask(self.dask) as executor:
                yield lambda step: Phase(step, executor, self.workers, self.progress)
        else:
            processes = Processes(self.workers)
            try:
                yield lambda step: Phase(step, processes, self.workers, self.progress)
            finally:
                processes.close()


def estimate_memory(count: int) -> int:
    """Return the bytes that a worker takes for a tile of some points."""
    return _BYTES_OF_A_WORKER + count * _BYTES_PER_POINT


def choose_tile_points(memory: float | None, workers: int) -> int:
    """Return how many points a tile may have.

    Parameters
    ----------
    memory : float or None
        Megabytes of a worker; None for its share of what is free.
    workers : int

    Raises
    ------
    OptionError
        If the memory is too little for any tile.
    """
    least = estimate_memory(_FEWEST_TILE_POINTS) // _MEGABYTE + 1
    if memory is None:
        given = measure_free_memory() * _SHARE / workers
    else:
        given = as_number("memory", memory, "megabytes", least=least, or_none=True) * _MEGABYTE
    count = int((given - _BYTES_OF_A_WORKER) // _BYTES_PER_POINT)
    return max(_FEWEST_TILE_POINTS, min(count, _MOST_TILE_POINTS))
