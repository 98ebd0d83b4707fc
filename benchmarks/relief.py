"""Slope and hillshade of a DEM at its own cells, and at cells between them.

``python -m benchmarks.relief`` prints the least of some runs, in seconds, for a DEM of ``--side``
rows and columns (default 1000), and what fraction of it filling the cells with elevations takes.
"""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

import numpy as np

import tinsmith as ts

from .report.tables import TEXT, Table, add_option

if TYPE_CHECKING:
    from collections.abc import Callable

RUNS = 5


def main() -> None:
    """Read the command line, time and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=1000, help="rows and columns of the DEM")
    add_option(parser)
    given = parser.parse_args()
    side = given.side
    y, x = (axis.ravel().astype(float) for axis in np.mgrid[0:side, 0:side])
    z = 40 * np.sin(x / 17) * np.cos(y / 23) + 15 * np.sin(x / 5 + y / 7)
    tin = ts.triangulate(np.column_stack([x, y, z]))
    table = Table({"cells": TEXT, "value": TEXT, "seconds": "{:.3f}", "times elevation": "{:.1f}"})
    for where, shift in (("own cells", 0.5), ("between", 0.37)):
        grid = ts.Grid(ts.Bounds(-shift, -shift, side - shift, side - shift), (side, side), 1.0)
        whole = measure(lambda grid=grid: ts.rasterize(tin, grid=grid))
        table.show(where, "elevation", whole, None)
        for smooth in (False, True):
            require_slopes_of_vertices(tin, smooth)
            for value in ("slope", "hillshade"):
                found = measure(
                    lambda grid=grid, value=value, smooth=smooth: ts.rasterize(
                        tin, grid=grid, value=value, smooth=smooth
                    )
                )
                how = "smooth" if smooth else "of triangles"
                table.show(where, f"{value} {how}", found, found / whole)
    table.write(given.json)


def require_slopes_of_vertices(tin: ts.TIN, smooth: bool) -> None:
    """Require that a few cells at vertices have the vertices' slopes."""
    grid = ts.Grid(ts.Bounds(9.5, 9.5, 13.5, 13.5), (4, 4), 1.0)
    found = ts.rasterize(tin, grid=grid, value="slope", smooth=smooth).bands["slope"]
    at = tin.closest_vertex([[x, y] for y in (13, 12, 11, 10) for x in (10, 11, 12, 13)])
    np.testing.assert_allclose(found.ravel(), ts.slope(tin, per="vertex")[at], atol=1e-9)


def measure(call: Callable[[], object]) -> float:
    """Return the least time of some runs."""
    seconds = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - begin)
    return min(seconds)


if __name__ == "__main__":
    main()
