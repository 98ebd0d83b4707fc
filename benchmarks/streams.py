"""Points in chunks beside the file read at once: rows a second, and the memory of the process.

``python -m benchmarks.streams FILE`` times a file of points, each way in a process of its own, and
compares the sums of all coordinates. ``--make ROWS`` writes it first, as survey text with numbers.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.io.streaming import stream_points

CRS = "EPSG:32616"
ROWS_AT_A_TIME = 1_000_000


def make_text(path: Path, rows: int) -> None:
    """Write survey text of points with numbers, three decimals each."""
    rng = np.random.default_rng(1)
    with path.open("w") as file:
        file.write("number,easting,northing,elevation\n")
        for start in range(0, rows, ROWS_AT_A_TIME):
            count = min(ROWS_AT_A_TIME, rows - start)
            points = rng.random((count, 3)) * (5000, 5000, 80) + (500_000, 4_024_180, 300)
            table = np.column_stack([np.arange(start + 1, start + count + 1), points])
            np.savetxt(file, table, fmt="%d,%.3f,%.3f,%.3f")


def measure(way: str, path: Path, chunk_points: int) -> dict[str, Any]:
    """Read a file and return rows, seconds, megabytes and the sum of the coordinates."""
    start, used = time.perf_counter(), time.process_time()
    count, total = 0, np.zeros(3)
    if way == "read":
        points = ts.read_points(path, crs=CRS).points
        count, total = len(points), points.sum(axis=0)
    else:
        with stream_points(path, crs=CRS, chunk_points=chunk_points) as stream:
            for chunk in stream:
                count += len(chunk)
                total += chunk.points.sum(axis=0)
    return {
        "rows": count,
        "seconds": time.perf_counter() - start,
        "processor": time.process_time() - used,
        "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "total": total.tolist(),
    }


def main() -> None:
    """Print a line for each way, and compare what they read."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--make", type=int, metavar="ROWS")
    parser.add_argument("--chunk-points", type=int, default=1_000_000)
    parser.add_argument("--ways", nargs="+", default=["stream", "read"])
    parser.add_argument("--one", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        print(json.dumps(measure(given.one, given.file, given.chunk_points)))
        return
    if given.make:
        make_text(given.file, given.make)
    found = {way: _measure_apart(way, given) for way in given.ways}
    for way, one in found.items():
        speeds = (one["rows"] / one[what] / 1e6 for what in ("seconds", "processor"))
        wall, processor = speeds
        print(
            f"{way:7} {one['rows']:>12,} rows  {wall:.2f} M/s ({processor:.2f} M/s of processor "
            f"time)  {one['megabytes']:,.0f} MB"
        )
    totals = [np.array(one["total"]) for one in found.values()]
    assert all(np.allclose(totals[0], other, rtol=1e-12) for other in totals)


def _measure_apart(way: str, given: argparse.Namespace) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.streams", str(given.file), "--one", way]
    command += ["--chunk-points", str(given.chunk_points)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


if __name__ == "__main__":
    main()
