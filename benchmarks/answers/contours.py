"""Contours beside matplotlib on the same TIN, and tools of rasters on one of the same surface.

The same lines must come of the TIN: as many, as long. On a raster of as many cells as the TIN has
points the lines are others, of the same shape. gdal_contour reads and writes files.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median
from ..peers.programs import find_present, run_program

__all__ = ["MATPLOTLIB", "TASK", "run"]

SECTION = "answers"
SIZE = 10_000.0
"""Side of the square, metres."""

LEVELS = 72
TASK = f"contours: {LEVELS} levels"
MATPLOTLIB = "matplotlib"
CONTOURPY, GDAL = "contourpy, on a raster", "gdal_contour, on a raster"
MODULES = {OURS: "tinsmith", MATPLOTLIB: "matplotlib", CONTOURPY: "contourpy"}
NOTES = {
    CONTOURPY: "of as many cells; other lines of the same surface",
    GDAL: "the same raster, from a GeoTIFF to a FlatGeobuf file",
}
RELATIVE = 1e-9
ON_A_RASTER = 0.2
"""Lines through scattered points wind more than those through a raster: by less than this share."""


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure 72 contours of ``n_points`` points on hills, joined lines included.

    An AssertionError says that a peer has other lines.
    """
    rng = np.random.default_rng(1)
    xy = rng.random((n_points, 2)) * SIZE
    tin = ts.triangulate(np.column_stack([xy, hills(*xy.T)]))
    z = tin.points[:, 2]
    levels = np.linspace(z.min(), z.max(), LEVELS + 2)[1:-1]
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as folder:
        tools = {
            OURS: lambda: lambda: _ours(tin, levels),
            MATPLOTLIB: lambda: _matplotlib(tin, levels),
            CONTOURPY: lambda: _contourpy(n_points, levels),
            GDAL: lambda: _gdal_contour(n_points, levels, Path(folder)),
        }
        present = [*outcome.present(MODULES), *find_present({GDAL: "gdal_contour"}, outcome)]
        calls = {name: tools[name]() for name in present}
        answers, runs = alternate(calls, repeats)
        if GDAL in answers:
            answers[GDAL] = _read_lines(answers[GDAL])
    for name, lines in answers.items():
        _require_same(answers[OURS], lines, is_raster=name in NOTES)
        seconds = find_median(runs[name])
        note = NOTES.get(name, "") or f"{len(tin.triangles):,} triangles, {len(lines):,} lines"
        outcome.results.append(
            Result(SECTION, TASK, name, n_points, seconds, tuple(runs[name]), note)
        )
    return outcome


def hills(x: Float64Array, y: Float64Array) -> Float64Array:
    """Return the elevations of rolling ground, metres."""
    broad = 60 * np.sin(x / 900) * np.cos(y / 1100) + 30 * np.sin(x / 310 + y / 270)
    elevations: Float64Array = 300 + broad + 8 * np.sin(x / 70) * np.sin(y / 90)
    return elevations


def _ours(tin: TIN, levels: Float64Array) -> list[Float64Array]:
    found = ts.contours(tin, levels=levels)
    return np.split(found.coordinates[:, :2], found.offsets[0][1:-1])


def _matplotlib(tin: TIN, levels: Float64Array) -> Callable[[], list[Float64Array]]:
    """Return the call of what tricontour calls for each level; its preparation is not timed."""
    from matplotlib import _tri
    from matplotlib.tri import Triangulation

    prepared = Triangulation(tin.points[:, 0], tin.points[:, 1], tin.triangles)
    generator: Any = _tri.TriContourGenerator(
        prepared.get_cpp_triangulation(), np.ascontiguousarray(tin.points[:, 2])
    )
    generator.create_contour(float(levels[0]))
    return lambda: [line for level in levels for line in generator.create_contour(level)[0]]


def _contourpy(n_points: int, levels: Float64Array) -> Callable[[], list[Float64Array]]:
    from contourpy import contour_generator

    x, y = _places(n_points)
    generator: Any = contour_generator(x, y, hills(x, y), name="serial")
    return lambda: [line for level in levels for line in generator.lines(level)]


def _places(n_points: int) -> tuple[Float64Array, Float64Array]:
    axis = np.linspace(0, SIZE, round(n_points**0.5))
    x, y = np.meshgrid(axis, axis)
    return x, y


def _gdal_contour(n_points: int, levels: Float64Array, folder: Path) -> Callable[[], Path]:
    x, y = _places(n_points)
    spacing = float(x[0, 1] - x[0, 0])
    half = spacing / 2
    bounds = ts.Bounds(-half, -half, SIZE + half, SIZE + half)
    grid = ts.Grid(bounds, shape=x.shape, spacing=spacing)
    ts.write(ts.Raster({"elevation": hills(x, y)[::-1]}, grid, crs="EPSG:32616"), folder / "z.tif")
    command = ["gdal_contour", "-q", "-f", "FlatGeobuf", "-fl", *map(repr, levels.tolist())]

    def call() -> Path:
        made = folder / "contours.fgb"
        made.unlink(missing_ok=True)
        run_program([*command, folder / "z.tif", made])
        return made

    return call


def _read_lines(path: Path) -> list[Float64Array]:
    import pyogrio.raw
    import shapely

    geometries = shapely.from_wkb(pyogrio.raw.read(path)[2])
    return [shapely.get_coordinates(line) for line in shapely.get_parts(geometries)]


def _require_same(ours: list[Float64Array], theirs: list[Float64Array], *, is_raster: bool) -> None:
    total, other = (sum(_length(line) for line in lines) for lines in (ours, theirs))
    np.testing.assert_allclose(other, total, rtol=ON_A_RASTER if is_raster else RELATIVE)
    if not is_raster:
        assert sorted(map(len, ours)) == sorted(map(len, theirs)), "other lines"


def _length(line: Float64Array) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())
