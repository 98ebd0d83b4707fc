"""Variants of the kernel with one result: vector instructions, methods, small inputs."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Int32Array
from tinsmith.tin import _kernel

from ..datasets.points import DATASETS, make_points
from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["SECTION", "TWO_THREADS", "run"]

SECTION = "variants"
TWO_THREADS = "two threads"
SMALL_SIZES = (100, 1_000)
SMALL_CALLS = 200
LARGEST_GROWN = 100_000
"""Above this growth alone takes too long on the data that the kernel hands to insertion."""
QUADRATIC = ("circle", "few circles", "rails")
"""Data on which growth alone takes time with the square of the points."""
LATTICES = ("raster", "decimal raster", "raster with gaps")
"""Data whose triangles are written without a search."""


def run(n: int, *, repeats: int = 5) -> Outcome:
    """Measure vector paths, threads, lattices (``n`` points), methods (100,000), small inputs."""
    outcome = Outcome()
    for name in ("uniform", "raster"):
        outcome.results += _measure_vector_paths(name, n, repeats)
    outcome.results += _measure_threads("uniform", n, repeats)
    for name in LATTICES:
        outcome.results += _measure_lattice(name, n, repeats)
    for name in DATASETS:
        outcome.results += _measure_methods(name, min(n, LARGEST_GROWN), repeats)
    for size in SMALL_SIZES:
        outcome.results += _measure_small(size)
    outcome.results += _import(repeats)
    return outcome


def _measure_vector_paths(name: str, n: int, repeats: int) -> Iterator[Result]:
    points = make_points(name, n)
    *slower, used = _kernel.VECTOR_PATHS
    grow = partial(_kernel.grow, points, method=_kernel.Method.GROWTH)
    variants = {OURS: grow} | {f"path {path}": partial(grow, path=path) for path in slower}
    note = {OURS: f"path {used}, the one it takes here"}
    return _measure_variants(f"{name}, vector instructions", len(points), variants, repeats, note)


def _measure_threads(name: str, n: int, repeats: int) -> Iterator[Result]:
    points = make_points(name, n)
    variants = {OURS: partial(_kernel.grow, points, threads=1)}
    variants |= {TWO_THREADS: partial(_kernel.grow, points, threads=2)}
    return _measure_variants(
        f"{name}, threads", len(points), variants, 3 * repeats, {OURS: "one thread"}
    )


def _measure_lattice(name: str, n: int, repeats: int) -> Iterator[Result]:
    """Measure whole calls, and the kernel beside its own growth."""
    points = make_points(name, n)
    grow = partial(_kernel.grow, points)
    variants: dict[str, Callable[[], Any]] = {
        OURS: partial(ts.triangulate, points, threads=1),
        TWO_THREADS: partial(ts.triangulate, points, threads=2),
        "kernel": grow,
        "growth": partial(grow, method=_kernel.Method.GROWTH),
        "growth, two threads": partial(grow, method=_kernel.Method.GROWTH, threads=2),
    }
    note = {OURS: "whole call, one thread", TWO_THREADS: "whole call"}
    return _measure_variants(f"{name}, lattice", len(points), variants, repeats, note)


def _measure_methods(name: str, n: int, repeats: int) -> Iterator[Result]:
    points = make_points(name, n)
    methods = {"insertion": _kernel.Method.INSERTION, "growth": _kernel.Method.GROWTH}
    if name in QUADRATIC:
        del methods["growth"]
    variants = {OURS: partial(_kernel.grow, points)}
    variants |= {x: partial(_kernel.grow, points, method=method) for x, method in methods.items()}
    return _measure_variants(
        f"{name}, methods", len(points), variants, repeats, {OURS: "as it chooses"}
    )


def _measure_small(size: int) -> Iterator[Result]:
    points = make_points("uniform", max(size, 200))[:size]
    variants: dict[str, Callable[[], Any]] = {
        OURS: partial(ts.triangulate, points),
        "kernel": partial(_kernel.grow, points),
    }
    return _measure_variants(
        f"uniform, {size:,} points", size, variants, SMALL_CALLS, {OURS: "whole call"}
    )


def _measure_variants(
    task: str,
    count: int,
    variants: dict[str, Callable[[], Any]],
    repeats: int,
    notes: dict[str, str],
) -> Iterator[Result]:
    answers, runs = alternate(variants, repeats)
    for way, answer in answers.items():
        _require_equal(answer, answers[OURS])
        yield Result(
            SECTION, task, way, count, find_median(runs[way]), tuple(runs[way]), notes.get(way, "")
        )


def _require_equal(found: Any, wanted: Any) -> None:
    for name in ("triangles", "neighbors"):
        array: Int32Array = getattr(found, name)
        assert np.array_equal(array, getattr(wanted, name)), name


def _import(repeats: int) -> Iterator[Result]:
    task = "import in a fresh process"
    for way, statement in ((OURS, "import tinsmith"), ("Python and numpy alone", "import numpy")):
        runs = [_measure_process(statement) for _ in range(repeats)]
        yield Result(SECTION, task, way, 1, find_median(runs), tuple(runs))


def _measure_process(statement: str) -> float:
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", statement], check=True)
    return time.perf_counter() - begin
