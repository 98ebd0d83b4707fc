"""Many short lines that cross each other: the surface in tiles beside the surface in memory.

``python -m benchmarks.crossing_lines --points 1e6 --lines 1e4`` draws both at random in a square,
and lists the processor time of one thread for either. The proof of the tiles counts as many
triangles, vertices and edges as memory has.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

import tinsmith as ts

from .report.tables import TEXT, Table, add_option

COLUMNS = {
    "what": TEXT,
    "points": "{:,}",
    "lines": "{:,}",
    "triangles": "{:,}",
    "seconds": "{:.1f}",
}
_LENGTH = 2.0
"""Of a line, in mean distances between the middles of lines: each crosses some three others."""


def draw(points: int, lines: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """Draw points and lines in a square of one kilometre."""
    rng = np.random.default_rng(1)
    xyz = rng.random((points, 3)) * [1000.0, 1000.0, 50.0]
    middles, angles = rng.random((lines, 2)) * 1000.0, rng.random(lines) * np.pi
    away = _LENGTH / 2 * 1000.0 / np.sqrt(lines) * np.column_stack([np.cos(angles), np.sin(angles)])
    ends = np.stack([middles - away, middles + away], axis=1)
    heights = rng.random((lines, 2, 1)) * 50.0
    return xyz, list(np.concatenate([ends, heights], axis=2))


def measure(points: int, lines: int, tiles: int) -> Table:
    """Build the surface in memory and in tiles."""
    xyz, breaklines = draw(points, lines)
    table = Table(COLUMNS)
    started = process_time()
    tin = ts.triangulate(xyz, breaklines=breaklines, threads=1)
    table.show("memory", points, lines, len(tin.triangles), process_time() - started)
    with TemporaryDirectory() as folder, ThreadPoolExecutor(1) as executor:
        file = ts.write(ts.Survey(points=xyz), Path(folder, "points.ply"))
        for count, own in ((0, []), (lines, breaklines)):
            started = process_time()
            way: Any = {"tiles": tiles, "executor": executor, "workers": 1}
            cloud = ts.tiles(file, breaklines=own)
            proof = cloud.check(run=Path(folder, "run"), **way)
            seconds = process_time() - started
            table.show(f"{tiles} tiles", points, count, proof.triangles, seconds)
    assert (proof.triangles, proof.vertices) == (len(tin.triangles), len(tin.points))
    return table


def main() -> None:
    """Measure what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=lambda text: int(float(text)), default=200_000)
    parser.add_argument("--lines", type=lambda text: int(float(text)), default=3_000)
    parser.add_argument("--tiles", type=int, default=4)
    add_option(parser)
    given = parser.parse_args()
    measure(given.points, given.lines, given.tiles).write(given.json)


if __name__ == "__main__":
    main()
