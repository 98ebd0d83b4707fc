"""How long many files take on clusters: measured tasks, put on more cores than there are here.

``python -m benchmarks.clusters FOLDER --points 4e6`` makes LAZ tiles in the folder, computes their
raster once, and takes from its records how long each task of each step took, and from its progress
how long the steps between took that one process does alone. ``--tasks 1e5`` empty tasks tell what
handing out one costs, to processes of this machine and to a Dask cluster on it. Then runs over
10^9 and 10^12 points are simulated: tasks in the order in which they are handed out go to the core
that is free first, no sooner than one process can hand them out (list scheduling); steps follow
each other. Disks and networks are taken to be as fast for many cores as for those of this machine.
"""

from __future__ import annotations

import argparse
import heapq
import json
import os
import shutil
import time
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.tiled.running.executors import Processes, connect_to_dask, run_tasks

from .datasets.lidar_tiles import make_lidar_tiles
from .report.tables import TEXT, Table, add_option

if TYPE_CHECKING:
    from collections.abc import Iterator

COLUMNS = {
    "points": "{:.0e}",
    "cores": "{:,}",
    "tasks": "{:,}",
    "reading s": "{:,.0f}",
    "planning s": "{:,.0f}",
    "triangulating s": "{:,.0f}",
    "joining s": "{:,.0f}",
    "together s": "{:,.0f}",
    "M points/s": "{:,.1f}",
    "limit": TEXT,
}
POINTS = (10**9, 10**12)
CORES = (16, 100, 1_000, 10_000)
POINTS_OF_A_TASK = 1_000_000
"""Of a tile at most, and of a file here."""
MANY_FILES, POINTS_OF_A_SMALL_FILE = 300, 5_000
"""Of the run that tells what a file costs while tiles are planned."""
_REPEATS = 3
_SEED = 1


class Measured(NamedTuple):
    """What a run took.

    Attributes
    ----------
    files : int
    points, found : int
        Points in the files, and of those the ones that were wanted.
    reading, tiles : (k,) float64 arrays
        Seconds of a task for each point: of the file, of the tile.
    planning, joining : float
        Seconds of one process.
    seconds : float
        Of the whole run.
    workers : int
    """

    files: int
    points: int
    found: int
    reading: np.ndarray
    tiles: np.ndarray
    planning: float
    joining: float
    seconds: float
    workers: int


def measure(lidar: Path, output: Path, workers: int) -> Measured:
    """Compute a raster of 1 m of ground points, and take apart what it took."""
    told: dict[str, list[float]] = {}

    def tell(status: ts.tiled.Status) -> None:
        told.setdefault(status.step, []).append(time.perf_counter())

    cloud = ts.tiles(lidar, classes=2)
    begin = time.perf_counter()
    way: dict[str, Any] = {"workers": workers, "restart": True, "keep": True, "progress": tell}
    cloud.rasterize(output, spacing=1.0, format="cog", **way)
    end = time.perf_counter()
    run = output.with_name(f"{output.name}.run")
    reading, tiles = (_read_records(run / name) for name in ("points/inputs", "tiles"))
    found = sum(one["points"] for one in reading)
    count = cloud.count or found
    made = Measured(
        len(reading),
        count,
        found,
        np.array([one["seconds"] for one in reading]) / (count / len(reading)),
        np.array([one["seconds"] for one in tiles]) / (found / len(tiles)),
        told["Triangulating"][0] - told["Reading"][-1],
        end - told["Triangulating"][-1],
        end - begin,
        workers,
    )
    shutil.rmtree(run)
    return made


class Alone(NamedTuple):
    """Seconds of what one process does alone, without those of every run, however small.

    Attributes
    ----------
    planning : float
        For each file.
    joining : float
        For each point that is wanted.
    """

    planning: float
    joining: float

    @classmethod
    def of(cls, small: Measured, large: Measured, many: Measured) -> Alone:
        """Compare a run with one of more points, and with one of more files."""
        return cls(
            max(0.0, many.planning - small.planning) / (many.files - small.files),
            max(0.0, large.joining - small.joining) / (large.found - small.found),
        )


def measure_least(lidar: Path, output: Path, workers: int) -> Measured:
    """Measure a run several times; what one process does alone is the least of them.

    Its seconds are those of the fastest run.
    """
    runs = [measure(lidar, output, workers) for _ in range(_REPEATS)]
    return min(runs, key=lambda one: one.seconds)._replace(
        planning=min(one.planning for one in runs), joining=min(one.joining for one in runs)
    )


def _read_records(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.json")]


def measure_handing_out(executor: Any, tasks: int, workers: int) -> float:
    """Return the seconds that one process takes to hand out a task and to take its result."""
    done: list[tuple[int, int]] = []

    def take(job: int, result: int) -> None:
        done.append((job, result))

    def give_up(job: int, sentence: str) -> None:
        raise SystemExit(f"task {job}: {sentence}")

    asked: dict[str, Any] = {"workers": workers, "take": take, "give_up": give_up}
    run_tasks(executor, abs, range(workers), **asked)  # starts the workers
    begin = time.perf_counter()
    run_tasks(executor, abs, range(tasks), **asked)
    seconds = time.perf_counter() - begin
    assert len(done) == tasks + workers
    return seconds / tasks


@contextmanager
def dask(workers: int) -> Iterator[Any]:
    """Yield the executor of a Dask cluster of processes of this machine."""
    import distributed

    with (
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as cluster,
        connect_to_dask(cluster.scheduler_address) as executor,
    ):
        yield executor


def schedule(seconds: Sequence[float], cores: int, handing_out: float) -> float:
    """Return when the last of some tasks ends, each begun on the core that is free first.

    Parameters
    ----------
    seconds : sequence of float
        Of the tasks, in the order in which they are handed out.
    cores : int
    handing_out : float
        Seconds after which the next task can be handed out.
    """
    free = [0.0] * min(cores, len(seconds))
    last = 0.0
    for number, duration in enumerate(seconds):
        end = max(free[0], number * handing_out) + duration
        heapq.heapreplace(free, end)
        last = max(last, end)
    return last


def simulate(
    measured: Measured, alone: Alone, count: int, cores: int, handing_out: float
) -> tuple[int, list[float]]:
    """Return how many tasks there are, and the seconds of the four steps."""
    rng = np.random.default_rng(_SEED)
    found = round(count * measured.found / measured.points)

    def draw(seconds: np.ndarray, points: int) -> list[float]:
        tasks = -(-points // POINTS_OF_A_TASK)
        drawn: list[float] = (rng.choice(seconds, tasks) * (points / tasks)).tolist()
        return drawn

    reading, tiles = draw(measured.reading, count), draw(measured.tiles, found)
    return len(reading) + len(tiles), [
        schedule(reading, cores, handing_out),
        alone.planning * len(reading),
        schedule(tiles, cores, handing_out),
        alone.joining * found,
    ]


def name_limit(steps: Sequence[float], tasks: int, handing_out: float) -> str:
    """Return what takes most of the time."""
    reading, planning, tiles, joining = steps
    handed = tasks * handing_out
    shares = {
        "handing out tasks": handed if handed > 0.9 * (reading + tiles) else 0.0,
        "cores": reading + tiles,
        "planning, by one process": planning,
        "joining, by one process": joining,
    }
    return max(shares, key=lambda name: shares[name])


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, simulate and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    whole: Callable[[str], int] = lambda text: int(float(text))  # noqa: E731 - as 1e6
    parser.add_argument("folder", type=Path)
    parser.add_argument("--points", type=whole, default=4_000_000)
    parser.add_argument("--files", type=int, default=8)
    parser.add_argument("--workers", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--tasks", type=whole, default=100_000)
    add_option(parser)
    given = parser.parse_args(arguments)
    runs = []
    for points, files in (
        (given.points // 4, given.files),
        (given.points, given.files),
        (MANY_FILES * POINTS_OF_A_SMALL_FILE, MANY_FILES),
    ):
        lidar = given.folder / f"lidar-{points:.0e}-{files}"
        make_lidar_tiles(lidar, points, files, workers=given.workers)
        runs.append(measure_least(lidar, given.folder / "dtm.tif", given.workers))
    measured, alone = runs[1], Alone.of(*runs)
    steps = simulate(measured, alone, measured.points, measured.workers, 0.0)[1]
    print(
        f"{measured.points:,} points, {measured.workers} workers: {measured.seconds:.1f} s, "
        f"simulated {sum(steps):.1f} s. A task takes {1e6 * measured.reading.mean():.2f} s for a "
        f"million points to read, {1e6 * measured.tiles.mean():.2f} s for a million to "
        f"triangulate; one process {1e3 * alone.planning:.2f} ms to plan for a file and "
        f"{1e6 * alone.joining:.3f} s to join a million."
    )
    processes = Processes(given.workers)
    local = measure_handing_out(processes, given.tasks, given.workers)
    processes.close()
    with dask(given.workers) as executor:
        remote = measure_handing_out(executor, given.tasks, given.workers)
    print(
        f"{given.tasks:,} empty tasks: {1e3 * local:.2f} ms each by processes, "
        f"{1e3 * remote:.2f} ms by Dask."
    )
    table = Table(COLUMNS)
    for count in POINTS:
        for cores in CORES:
            handing_out = local if cores <= CORES[0] else remote
            tasks, steps = simulate(measured, alone, count, cores, handing_out)
            total = sum(steps)
            limit = name_limit(steps, tasks, handing_out)
            table.show(count, cores, tasks, *steps, total, count / total / 1e6, limit)
    table.write(given.json)


if __name__ == "__main__":
    main()
