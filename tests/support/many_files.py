"""Many files: executors that run tasks in any order, and a folder of lidar tiles."""

from __future__ import annotations

import random
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import ClassVar

import numpy as np

import tinsmith as ts
from tinsmith.base.notes import warn
from tinsmith.tiled.running.executors import Processes


class Shuffled(Executor):
    """Runs tasks here, in an order at random: each when the next but some is asked for."""

    def __init__(self, seed=0, most=10**9):
        self._random = random.Random(seed)
        self._waiting = []
        self.most = most

    def submit(self, function, /, *given, **named):
        """Run one of the tasks that wait, if it is not the last that may be run."""
        future = Future()
        self._waiting.append((future, function, given, named))
        self._random.shuffle(self._waiting)
        self._run(self._waiting.pop())
        return future

    def _run(self, task):
        future, function, given, named = task
        self.most -= 1
        if self.most < 0:
            raise KeyboardInterrupt
        try:
            future.set_result(function(*given, **named))
        except BaseException as error:
            future.set_exception(error)


class KeptProcesses(Processes):
    """Processes that wait for the tasks of further runs: starting them takes longer than tasks.

    They know relative paths by the folder in which they were started.
    """

    waiting: ClassVar[dict] = {}

    def start(self):
        """Return the pool, that of an earlier run if there is one."""
        self._pool = self._pool or self.waiting.pop((self.workers, Path.cwd()), None)
        return super().start()

    def close(self):
        """Keep the processes."""
        if self._pool is not None:
            self.waiting[self.workers, Path.cwd()] = self._pool
            self._pool = None

    @classmethod
    def end(cls):
        """End the processes that wait."""
        for pool in cls.waiting.values():
            pool.shutdown()
        cls.waiting.clear()


def lose(tin, box):
    """Warn of what a tile loses, as a writer does; return how many triangles there are."""
    warn(f"'{len(tin.triangles)}.ply' does not hold {len(tin.points)} numbers.")
    return len(tin.triangles)


def write_lidar(folder):
    """Write tiles that overlap, with points at one place and of two classes; return the folder."""
    rng = np.random.default_rng(3)
    count = 6_000
    xy = rng.random((count, 2)) * [300, 200] + [500_000, 4_000_000]
    z = 300 + 20 * np.sin(xy[:, 0] / 50) + rng.normal(0, 0.1, count)
    points = np.round(np.column_stack([xy, z]), 1)
    classes = np.where(rng.random(count) < 0.7, 2, 5)
    strip = np.minimum((points[:, 0] - 500_000) // 90, 2)
    strip[rng.random(count) < 0.05] = 0
    for number in range(3):
        chosen = strip == number
        survey = ts.Survey(
            points=points[chosen],
            attributes={"classification": classes[chosen].astype(np.uint8)},
            crs="EPSG:32616",
        )
        ts.write(survey, folder / f"tile{number}.laz")
    return folder
