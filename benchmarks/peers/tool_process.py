"""One tool in a process of its own, seen from outside: seconds, peak memory, answers."""

from __future__ import annotations

import json
import math
import select
import subprocess
import sys
from pathlib import Path
from typing import Any, Self

import numpy as np

from tinsmith.base.arrays import AnyArray

from ..compiled import build_harness
from ..datasets.tasks import write_task
from .triangulators import DELAUNAY32, DELAUNAY32_ALL_CORES, is_compiled, name_harness

__all__ = ["ToolFailedError", "ToolProcess", "make_task_command", "make_worker_command"]

ROOT = Path(__file__).parents[2]
START_SECONDS = 120.0
LEAST_TIMED_SECONDS = 0.02
"""Runs shorter than this are repeated within one timing."""


def make_worker_command(kind: str, name: str, path: Path) -> list[str]:
    """Return the command for a tool that Python can call, on a task of some kind in a file."""
    return [sys.executable, "-m", "benchmarks.peers.worker", kind, name, str(path)]


def make_task_command(kind: str, name: str, task: Any, folder: Path) -> list[str]:
    """Write a task of arrays, once for all tools; return the command for one of them."""
    arrays = folder / "task.npz"
    if not arrays.exists():
        write_task(task, arrays)
    return make_worker_command(kind, name, arrays)


class ToolFailedError(Exception):
    """The tool did not answer in time, or its process died."""


class ToolProcess:
    """A tool that holds one set of points; other tasks override ``command``.

    Parameters
    ----------
    name : str
        A compiled tool or a key of ``TOOLS``.
    task : (n, 3) float64 array
        Points; in subclasses what their tools work on.
    folder : Path
        For files that pass between the processes.
    limit : float
        Seconds that one run may take.
    """

    least_timed_seconds = LEAST_TIMED_SECONDS

    def __init__(self, name: str, task: Any, folder: Path, limit: float) -> None:
        self.seconds: list[float] = []
        self.growth: int | None = None
        self.output_bytes = 0
        self._is_compiled = is_compiled(name)
        self._folder = folder
        self._limit = limit
        self._count = 1
        command = self.command(name, task, folder)
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT
        )
        self._answer(START_SECONDS)

    def command(self, name: str, task: Any, folder: Path) -> list[str]:
        """Write the task for the tool, unless another one's process has; return what runs it."""
        if is_compiled(name):
            plane = folder / "points.bin"
            if not plane.exists():
                task[:, :2].tofile(plane)
            threads = {DELAUNAY32: ["1"], DELAUNAY32_ALL_CORES: ["0"]}.get(name, [])
            return [str(build_harness(name_harness(name, "points"))), str(plane), *threads]
        table = folder / "points.npy"
        if not table.exists():
            np.save(table, task)
        return make_worker_command("points", name, table)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()

    def run(self) -> float:
        """Triangulate once (tiny sets: often) and return the seconds that it took.

        Raises
        ------
        ToolFailedError
            If the limit is reached or the process dies.
        """
        if self.seconds:
            return self._timed()
        before = self._memory_before()
        first = self._timed()
        self.growth = self._growth_since(before)
        self._count = max(1, math.ceil(self.least_timed_seconds / max(first, 1e-6)))
        if self._count > 1:
            self.seconds.clear()  # cold caches
            return self._timed()
        return first

    def triangles(self) -> AnyArray:
        """Return the last answer: (m, 3) vertex numbers or (m, 3, 2) coordinates."""
        path = self._folder / ("answer.bin" if self._is_compiled else "answer.npy")
        self._ask(f"save {path}", START_SECONDS)
        made: AnyArray = np.fromfile(path) if self._is_compiled else np.load(path)
        path.unlink()
        return made.reshape(-1, 3, 2) if self._is_compiled else made

    def _timed(self) -> float:
        answer = self._ask(f"run {self._count}", self._limit)
        self.output_bytes = answer.get("output_bytes", 0)
        self.seconds.append(answer["seconds"])
        return self.seconds[-1]

    def _ask(self, command: str, limit: float) -> dict[str, Any]:
        assert self._process.stdin is not None
        self._process.stdin.write(command + "\n")
        self._process.stdin.flush()
        return self._answer(limit)

    def _answer(self, limit: float) -> dict[str, Any]:
        assert self._process.stdout is not None
        ready, _, _ = select.select([self._process.stdout], [], [], limit)
        if not ready:
            self._process.kill()  # it would slow the others down
            raise ToolFailedError(f"no answer within {limit:g} s")
        line = self._process.stdout.readline()
        if not line:
            raise ToolFailedError(f"its process ended (exit status {self._process.wait()})")
        answer: dict[str, Any] = json.loads(line)
        return answer

    # ------------------------------------------------------------------ memory

    def _memory_before(self) -> int | None:
        """Forget the peak so far; return the memory now."""
        try:
            Path(f"/proc/{self._process.pid}/clear_refs").write_text("5")
        except OSError:
            return None
        return self._status("VmRSS")

    def _growth_since(self, before: int | None) -> int | None:
        peak = self._status("VmHWM")
        return None if before is None or peak is None else peak - before

    def _status(self, name: str) -> int | None:
        """Return a figure of the process in bytes; None where the system does not tell."""
        try:
            lines = Path(f"/proc/{self._process.pid}/status").read_text().splitlines()
        except OSError:
            return None
        return next((int(x.split()[1]) * 1024 for x in lines if x.startswith(name)), None)
