"""Viewsheds and lines of sight beside gdal_viewshed, on a raster whose centers are the vertices.

gdal_viewshed takes elevations between centers another way, so 95 of 100 vertices must be seen
alike. It reads a GeoTIFF and writes one. Lines of sight must find what the viewshed found. Memory
is by how much the process grows above what it held before the first run, where the system tells.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import BoolArray, Float64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median
from ..peers.programs import find_present, run_program

__all__ = ["GDAL", "VIEWSHED", "run"]

SECTION = "answers"
VIEWSHED = "viewshed: vertices seen from 30 m above the middle"
MOST_LINES = 1_000
EYE_HEIGHT = 30.0
LEAST_SHARE = 0.95
"""Of the vertices that must be seen by a peer as by us."""

GDAL = "gdal_viewshed, files"
Seen = BoolArray


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure a viewshed over about ``n_points`` vertices, and lines of sight to some.

    Raises
    ------
    AssertionError
        If a peer sees other vertices.
    """
    side = int(np.sqrt(n_points))
    tin, raster = _make_hills(side)
    eye = np.full(2, side // 2 + 0.5)  # the center of a cell, as GDAL has it
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        calls: dict[str, Callable[[], Any]] = {
            OURS: lambda: ts.visible_vertices(tin, eye, eye_height=EYE_HEIGHT)
        }
        if find_present({GDAL: "gdal_viewshed"}, outcome):
            ts.write(raster, folder / "dem.tif", compression="none", overviews="none")
            calls[GDAL] = lambda: _gdal_viewshed(eye, folder)
        growth = _measure_growth(calls[OURS])
        answers, runs = alternate(calls, repeats)
        seen = answers[OURS]
        notes = {OURS: growth, GDAL: "from a GeoTIFF to a GeoTIFF"}
        for tool, times in runs.items():
            if tool != OURS:
                _require_alike(seen, _read_seen(folder))
            seconds = find_median(times)
            outcome.results.append(
                Result(SECTION, VIEWSHED, tool, side**2, seconds, tuple(times), notes[tool])
            )
    outcome.add(_measure_lines(tin, eye, seen, repeats))
    return outcome


def _make_hills(side: int) -> tuple[TIN, ts.Raster]:
    """Return a raster of hills and the TIN of its centers, row by row from the north."""
    grid = ts.Grid(ts.Bounds(0.0, 0.0, side, side), shape=(side, side), spacing=1.0)
    x, y = np.meshgrid(np.arange(side) + 0.5, side - 0.5 - np.arange(side))
    z = 20 * np.sin(x / 130) * np.cos(y / 70) + 4 * np.sin(x / 17) * np.sin(y / 13)
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    return ts.triangulate(points), ts.Raster({"elevation": z}, grid, crs="EPSG:32616")


def _gdal_viewshed(eye: Float64Array, folder: Path) -> None:
    command = ["gdal_viewshed", "-q", "-cc", "0", "-oz", EYE_HEIGHT, "-ox", eye[0], "-oy", eye[1]]
    run_program([*command, folder / "dem.tif", folder / "seen.tif"])


def _read_seen(folder: Path) -> Seen:
    import rasterio

    with rasterio.open(folder / "seen.tif") as file:
        found: Seen = file.read(1).ravel() > 0
    return found


def _require_alike(ours: Seen, theirs: Seen) -> None:
    share = float((ours == theirs).mean())
    assert share >= LEAST_SHARE, f"{GDAL} sees only {share:.1%} of the vertices as we do"


def _measure_lines(tin: TIN, eye: Float64Array, seen: Seen, repeats: int) -> Outcome:
    rng = np.random.default_rng(1)
    apart = np.flatnonzero((tin.points[:, :2] != eye).any(axis=1))
    count = min(MOST_LINES, len(apart))
    asked = rng.choice(apart, count, replace=False)
    targets = tin.points[asked, :2]
    task = f"lines of sight: to {count:,} vertices"
    call = {OURS: lambda: ts.line_of_sight(tin, eye, targets, eye_height=EYE_HEIGHT)}
    answers, runs = alternate(call, repeats)
    differing = int((answers[OURS].columns["visible"] != seen[asked]).sum())
    assert differing == 0, f"{differing} lines of sight differ from the viewshed"
    times = tuple(runs[OURS])
    result = Result(SECTION, task, OURS, len(tin.points), find_median(runs[OURS]), times)
    return Outcome([result])


def _measure_growth(call: Callable[[], Any]) -> str:
    """Return by how much memory grows at most while something is called."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
        before = _read_status("VmRSS")
    except OSError:
        call()
        return ""
    call()
    return f"{max(_read_status('VmHWM') - before, 0) / 1024:,.0f} MiB of memory"


def _read_status(name: str) -> int:
    """Return a figure of this process in KiB."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(name))
