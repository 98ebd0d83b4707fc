"""Rasters of scattered points beside gdal_grid and whitebox, which interpolate linearly too.

A peer triangulates as part of the call, so we do. gdal_grid reads points from a file and writes
cells to one, not compressed and without overviews: a row of ours does the same, and one writes a
file as it is usually written.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from ..measure import OURS, Outcome, Result, alternate, find_median
from ..peers.programs import find_present, run_program

__all__ = ["FILES", "GDAL", "label_task", "run"]

SECTION = "answers"
SIZE = 1000.0
"""Side of the square of points, metres."""

CELLS_PER_POINT = 16
ROUNDING = 1e-6
LEAST_SHARE = 0.95
"""Of the cells that must lie inside for a peer as for us."""

FILES, GDAL, WHITEBOX = "tinsmith, files", "gdal_grid, files", "whitebox"
PACKED = "tinsmith, compressed files"
MODULES = {
    OURS: "tinsmith",
    FILES: "rasterio",
    PACKED: "rasterio",
    WHITEBOX: "whitebox_workflows",
}
NOTES = {
    FILES: "from a CSV file to a GeoTIFF as gdal_grid writes it, on one thread",
    PACKED: "from a CSV file to a GeoTIFF, deflated by all cores, with overviews, and read back",
    GDAL: "from a CSV file to a GeoTIFF, on one thread",
    WHITEBOX: "points and cells in memory, on all cores",
}

Call = Callable[[], Any]


def label_task(n_points: int) -> str:
    """Name the task on so many points."""
    return f"raster: from points to {_count_rows(n_points) ** 2:,} cells"


def _count_rows(n_points: int) -> int:
    return int(np.sqrt(CELLS_PER_POINT * n_points))


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure ``n_points`` uniform points to 16 times as many cells, triangulation included.

    Raises
    ------
    AssertionError
        If a peer has other elevations.
    """
    rng = np.random.default_rng(1)
    points = rng.random((n_points, 3)) * [SIZE, SIZE, 50.0]
    side = _count_rows(n_points)
    grid = ts.Grid(ts.Bounds(0.0, 0.0, SIZE, SIZE), shape=(side, side), spacing=SIZE / side)
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        np.savetxt(
            folder / "points.csv", points, "%.17g", delimiter=",", header="x,y,z", comments=""
        )
        makers = {
            OURS: lambda: _ours(points, grid),
            FILES: lambda: _ours_in_files(grid, folder, compression="none", overviews="none"),
            PACKED: lambda: _ours_in_files(grid, folder),
            GDAL: lambda: _gdal_grid(grid, folder),
            WHITEBOX: lambda: _whitebox(points, grid, folder),
        }
        present = [*outcome.present(MODULES), *find_present({GDAL: "gdal_grid"}, outcome)]
        calls = {tool: makers[tool]() for tool in makers if tool in present}
        answers, runs = alternate(calls, repeats)
        cells = {tool: _read_cells(tool, answer, folder) for tool, answer in answers.items()}
    for tool in calls:
        _require_same(tool, cells[OURS], cells[tool])
        seconds = tuple(runs[tool])
        outcome.results.append(
            Result(
                SECTION,
                label_task(n_points),
                tool,
                n_points,
                find_median(runs[tool]),
                seconds,
                NOTES.get(tool, ""),
            )
        )
    return outcome


def _ours(points: Float64Array, grid: ts.Grid) -> Call:
    return lambda: ts.rasterize(ts.triangulate(points, threads=1), grid=grid, threads=1)


def _ours_in_files(grid: ts.Grid, folder: Path, **options: Any) -> Call:
    path = folder / ("packed.tif" if not options else "ours.tif")

    def call() -> Path:
        tin = ts.triangulate(ts.read(folder / "points.csv"), threads=1)
        return Path(ts.write(ts.rasterize(tin, grid=grid, threads=1, lazy=True), path, **options))

    return call


def _gdal_grid(grid: ts.Grid, folder: Path) -> Call:
    (folder / "points.vrt").write_text(
        "<OGRVRTDataSource><OGRVRTLayer name='points'>"
        f"<SrcDataSource>{folder / 'points.csv'}</SrcDataSource>"
        "<GeometryType>wkbPoint25D</GeometryType>"
        "<GeometryField encoding='PointFromColumns' x='x' y='y' z='z'/>"
        "</OGRVRTLayer></OGRVRTDataSource>",
        encoding="utf-8",
    )
    rows, columns = grid.shape
    command = ["gdal_grid", "-q", "-a", "linear:radius=0:nodata=nan"]
    command += ["-txe", grid.bounds.xmin, grid.bounds.xmax]
    command += ["-tye", grid.bounds.ymax, grid.bounds.ymin]
    command += ["-outsize", columns, rows, "-ot", "Float64", "-l", "points"]
    command += ["--config", "GDAL_NUM_THREADS", "1"]
    command += [folder / "points.vrt", folder / "gdal.tif"]

    def call() -> Path:
        run_program(command)
        return folder / "gdal.tif"

    return call


def _whitebox(points: Float64Array, grid: ts.Grid, folder: Path) -> Call:
    import whitebox_workflows

    environment: Any = whitebox_workflows.WbEnvironment()
    environment.verbose = False
    _write_points(points, folder / "points.shp")
    vector = environment.read_vector(str(folder / "points.shp"))
    empty = ts.Raster({"elevation": np.zeros(grid.shape)}, grid, crs="EPSG:32616")
    ts.write(empty, folder / "grid.tif")
    base = environment.read_raster(str(folder / "grid.tif"))

    def call() -> Any:
        return environment, environment.raster.tin_interpolation(
            points=vector, field_name="z", base_raster=base
        )

    return call


def _write_points(points: Float64Array, path: Path) -> None:
    import pyogrio.raw
    import shapely

    pyogrio.raw.write(
        path,
        shapely.to_wkb(shapely.points(points[:, :2])),
        [points[:, 2]],
        ["z"],
        geometry_type="Point",
        crs="EPSG:32616",
    )


def _read_cells(tool: str, answer: Any, folder: Path) -> Float64Array:
    """Return elevations, NaN where a tool has none."""
    if tool == OURS:
        return np.asarray(answer.bands["elevation"])
    if tool == WHITEBOX:
        environment, raster = answer
        answer = folder / "whitebox.tif"
        environment.write_raster(raster, str(answer))
    import rasterio

    with rasterio.open(answer) as file:
        return np.asarray(file.read(1, masked=True).filled(np.nan), np.float64)


def _require_same(tool: str, wanted: Float64Array, found: Float64Array) -> None:
    both = np.isfinite(found) & np.isfinite(wanted)
    assert both.mean() >= LEAST_SHARE, f"{tool} has other cells inside"
    np.testing.assert_allclose(found[both], wanted[both], rtol=0, atol=ROUNDING)
