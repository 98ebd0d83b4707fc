"""Fewest points within a tolerance: a raster terrain beside pydelatin, and a million points.

``python -m benchmarks.simplification`` prints the table of docs/simplify.md: vertices, triangles,
the largest error at all cells and processor time, each program in the same run on one core.
``--points N`` times N random points of a terrain with noise.
"""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import tinsmith as ts

from .measure import is_installed

if TYPE_CHECKING:
    from numpy.typing import NDArray

TOLERANCES = (3.0, 1.0)


def make_heights(side: int, seed: int = 1) -> NDArray[np.float32]:
    """Return a square raster whose roughness falls with the frequency, 300 high."""
    rng = np.random.default_rng(seed)
    squares = np.fft.fftfreq(side) ** 2
    power = squares[:, None] + squares[None, :]
    power[0, 0] = 1.0
    waves = (rng.normal(size=power.shape) + 1j * rng.normal(size=power.shape)) * power**-1.1
    waves[0, 0] = 0.0
    z = np.fft.ifft2(waves).real
    return (300.0 * (z - z.min()) / np.ptp(z)).astype(np.float32)


def as_points(heights: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the cells of a raster as points, one unit apart."""
    y, x = np.indices(heights.shape)
    return np.column_stack([x.ravel(), y.ravel(), heights.ravel()]).astype(float)


def print_row(program: str, tolerance: float, tin: ts.TIN, points: Any, seconds: str) -> None:
    """Print a line of the table; the error is measured here, at every point."""
    error = np.abs(tin.interpolate(points[:, :2]) - points[:, 2]).max()
    counts = f"{len(tin.points):,} | {len(tin.triangles):,}"
    print(f"| {tolerance:g} | {program} | {counts} | {error:.4f} | {seconds} |")


def compare(side: int) -> None:
    """Print vertices, triangles, errors and processor seconds of both programs."""
    heights = make_heights(side)
    points = as_points(heights)
    begin = time.process_time()
    surface = ts.triangulate(points, threads=1)
    before = time.process_time() - begin
    print(f"{side} x {side} cells; triangulating all of them takes {before:.2f} s")
    print("| tolerance | program | vertices | triangles | largest error | seconds |")
    print("|---|---|---|---|---|---|")
    for tolerance in TOLERANCES:
        begin = time.process_time()
        simple = ts.simplify(surface, tolerance=tolerance, threads=1)
        print_row("tinsmith", tolerance, simple, points, f"{time.process_time() - begin:.2f}")
        if is_installed("pydelatin"):
            from pydelatin import Delatin  # type: ignore[import-not-found]

            begin = time.process_time()
            made = Delatin(heights, max_error=tolerance)
            seconds = time.process_time() - begin
            corners = made.vertices.reshape(-1, 3).astype(float)
            corners[:, 1] = side - 1 - corners[:, 1]  # its rows go up
            found = ts.TIN.from_triangles(corners, made.triangles.reshape(-1, 3))
            print_row("pydelatin", tolerance, found, points, f"{seconds:.2f}")


def time_points(count: int) -> None:
    """Print how long it takes to leave about a hundredth of random points."""
    rng = np.random.default_rng(1)
    x, y = rng.uniform(0, 10 * np.sqrt(count), (2, count))
    z = 50 * np.sin(x / 700) * np.cos(y / 900) + 8 * np.sin(x / 90 + y / 130)
    surface = ts.triangulate(np.column_stack([x, y, z + rng.normal(0, 0.05, count)]), threads=1)
    begin = time.process_time()
    simple = ts.simplify(surface, tolerance=1.0, threads=1)
    seconds = time.process_time() - begin
    share = 100 * len(simple.points) / count
    print(f"{count:,} points to {len(simple.points):,} ({share:.1f} %): {seconds:.2f} s")


def main() -> None:
    """Read the command line and print what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=1000, help="cells of a side")
    parser.add_argument("--points", type=int, help="time so many random points instead")
    given = parser.parse_args()
    if given.points:
        time_points(given.points)
    else:
        compare(given.side)


if __name__ == "__main__":
    main()
