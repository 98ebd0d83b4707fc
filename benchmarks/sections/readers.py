"""Reading files beside the peers: the same numbers, from the same file, in turn."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float32Array, Float64Array
from tinsmith.tin import TIN

from ..datasets.points import make_points
from ..measure import OURS, Outcome, Result, alternate, find_median, is_installed
from ..peers.exchange import (
    read_cloud_with_laspy,
    read_triangles,
    write_cloud_with_laspy,
    write_triangles_with_pyogrio,
)
from ..peers.landxml import read_with_etree
from ..peers.meshes import MESH_PEERS

__all__ = ["SECTION", "run"]

SECTION = "readers"
CRS = "EPSG:32616"
SURVEY, RASTER, MESH = "survey, PNEZD CSV", "raster, GeoTIFF float32", "surface, binary PLY"
LANDXML = "surface, LandXML"
LIDAR, LAYER = "lidar, LAZ", "triangles, FlatGeobuf"
OUR_NOTES = {
    SURVEY: "finds the layout, checks every row",
    RASTER: "points at the cell centres, masks honoured",
    MESH: "checks the triangles, finds their neighbours",
    LANDXML: "checks the triangles, finds their neighbours",
    LIDAR: "in a child process; four attributes",
    LAYER: "in a child process; joins corners, checks the triangles",
}


class Reader(NamedTuple):
    """A peer: what must be installed, how it reads, what must be known about it."""

    module: str
    read: Callable[[Path], Any]
    note: str = ""


def run(n: int, *, repeats: int = 3) -> Outcome:
    """Measure the reading of a survey, a raster and meshes of ``n`` rows, cells and points.

    An AssertionError says that a reader's numbers differ from ours.
    """
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for task in _TASKS:
            print(f"readers: {task.__name__[1:]}, {n:,}", file=sys.stderr, flush=True)
            task(Trial(folder, n, repeats, outcome))
    return outcome


class Trial(NamedTuple):
    """A folder of files of about ``n`` rows, cells or points, and what becomes of reading them."""

    folder: Path
    n: int
    repeats: int
    outcome: Outcome

    def measure(
        self,
        task: str,
        path: Path,
        count: int,
        peers: dict[str, Reader],
        require: Callable[[Any, Any, str], None],
        **options: Any,
    ) -> None:
        """Time tinsmith and the peers on one file; ``require(ours, theirs, tool)`` compares.

        ``options`` are those of ``ts.read``.
        """
        present = self.outcome.present({tool: peer.module for tool, peer in peers.items()})
        calls: dict[str, Callable[[], Any]] = {OURS: lambda: ts.read(path, **options)}
        calls |= {tool: _prepare_reading(peers[tool], path) for tool in present}
        for call in calls.values():
            call()  # imports, file cache
        answers, runs = alternate(calls, self.repeats)
        for tool in calls:
            if tool in present:
                require(answers[OURS], answers[tool], tool)
            note = peers[tool].note if tool in peers else OUR_NOTES[task]
            seconds, times = find_median(runs[tool]), tuple(runs[tool])
            self.outcome.results.append(Result(SECTION, task, tool, count, seconds, times, note))


def _prepare_reading(peer: Reader, path: Path) -> Callable[[], Any]:
    return lambda: peer.read(path)


# ------------------------------------------------------------------------ survey


def _measure_survey(trial: Trial) -> None:
    points = np.round(make_points("uniform", trial.n), 3)
    path = trial.folder / "survey.csv"
    _write_pnezd(points, path)
    peers = {
        "pandas.read_csv": Reader(
            "pandas", _read_with_pandas, "last digit may be off; all five columns"
        ),
        "numpy.loadtxt": Reader("numpy", _read_with_numpy, "the three coordinates only"),
    }

    def require(ours: Any, theirs: Any, tool: str) -> None:
        np.testing.assert_array_equal(ours.points, points)
        tolerance = 1e-15 if tool == "pandas.read_csv" else 0.0
        np.testing.assert_allclose(_swap_axes(ours.points), theirs, rtol=tolerance, atol=0)

    trial.measure(SURVEY, path, trial.n, peers, require, columns="PNEZD")


def _write_pnezd(points: Float64Array, path: Path) -> None:
    codes = ("GS", "EP", "TOE", "TOP", "CL")
    with path.open("w", encoding="ascii") as file:
        file.writelines(
            f"{row},{northing:.3f},{easting:.3f},{elevation:.3f},{codes[row % 5]}\n"
            for row, (easting, northing, elevation) in enumerate(points.tolist(), start=1)
        )


def _swap_axes(points: Float64Array) -> Float64Array:
    return points[:, [1, 0, 2]]


def _read_with_pandas(path: Path) -> Float64Array:
    import pandas as pd

    return np.asarray(pd.read_csv(path, header=None).iloc[:, 1:4], np.float64)


def _read_with_numpy(path: Path) -> Float64Array:
    return np.loadtxt(path, delimiter=",", usecols=(1, 2, 3))


# ------------------------------------------------------------------------ raster


def _measure_raster(trial: Trial) -> None:
    if not is_installed("rasterio"):
        trial.outcome.skipped.append("GeoTIFF: skipped, rasterio is not installed.")
        return
    points = make_points("raster", trial.n)
    heights = points[:, 2].astype(np.float32)
    path = trial.folder / "heights.tif"
    _write_geotiff(points, heights, path)
    peers = {
        "rasterio": Reader("rasterio", _read_with_rasterio, "the band alone, no points, no mask")
    }

    def require(ours: Any, theirs: Any, _: str) -> None:
        np.testing.assert_array_equal(ours.points, np.column_stack([points[:, :2], heights]))
        np.testing.assert_array_equal(ours.points[:, 2], theirs.ravel())

    trial.measure(RASTER, path, len(points), peers, require)


def _write_geotiff(points: Float64Array, heights: Float32Array, path: Path) -> None:
    import rasterio

    columns = int(np.count_nonzero(points[:, 1] == points[0, 1]))
    west, north = points[0, :2] + [-15.0, 15.0]
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        width=columns,
        height=len(points) // columns,
        count=1,
        dtype="float32",
        crs=CRS,
        transform=rasterio.Affine(30.0, 0.0, west, 0.0, -30.0, north),
        nodata=-9999.0,
    ) as file:
        file.write(heights.reshape(-1, columns), 1)


def _read_with_rasterio(path: Path) -> Float32Array:
    import rasterio

    with rasterio.open(path) as file:
        return np.asarray(file.read(1))


# -------------------------------------------------------------------------- mesh


def _measure_mesh(trial: Trial) -> None:
    tin = ts.triangulate(make_points("uniform", trial.n), crs=CRS)
    path = ts.write(tin, trial.folder / "surface.ply")
    peers = {
        tool: Reader(peer.module, peer.read, "coordinates become float32" * bool(peer.read_step))
        for tool, peer in MESH_PEERS.items()
    }

    def require(ours: TIN, theirs: tuple[Float64Array, Any], tool: str) -> None:
        np.testing.assert_array_equal(ours.points, tin.points)
        np.testing.assert_array_equal(ours.neighbors, tin.neighbors)
        step = MESH_PEERS[tool].read_step
        np.testing.assert_allclose(theirs[0], ours.points, rtol=0, atol=step)
        np.testing.assert_array_equal(theirs[1], ours.triangles)

    trial.measure(MESH, path, trial.n, peers, require)


def _measure_landxml(trial: Trial) -> None:
    tin = ts.triangulate(make_points("uniform", trial.n), crs=CRS, elevation_unit="m")
    path = ts.write(tin, trial.folder / "surface.xml")
    peers = {"xml.etree": Reader("xml", read_with_etree, "the numbers only")}

    def require(ours: TIN, theirs: tuple[Float64Array, Any], _: str) -> None:
        np.testing.assert_array_equal(ours.points, tin.points)
        np.testing.assert_array_equal(theirs[0], ours.points)
        np.testing.assert_array_equal(theirs[1], ours.triangles)

    trial.measure(LANDXML, path, trial.n, peers, require)


# -------------------------------------------------------------------------- lidar, layers


def _measure_lidar(trial: Trial) -> None:
    if not is_installed("laspy"):
        trial.outcome.skipped.append("LAZ: skipped, laspy is not installed.")
        return
    points = np.round(make_points("uniform", trial.n), 3)
    path = trial.folder / "cloud.laz"
    write_cloud_with_laspy(points, path)
    peers = {"laspy": Reader("laspy", read_cloud_with_laspy, "every attribute")}

    def require(ours: Any, theirs: Float64Array, _: str) -> None:
        np.testing.assert_array_equal(ours.points, theirs)
        np.testing.assert_allclose(ours.points, points, rtol=0, atol=1e-6)

    trial.measure(LIDAR, path, trial.n, peers, require)


def _measure_layer(trial: Trial) -> None:
    if not is_installed("pyogrio"):
        trial.outcome.skipped.append("FlatGeobuf: skipped, pyogrio is not installed.")
        return
    tin = ts.triangulate(make_points("uniform", trial.n // 2), crs=CRS)
    path = trial.folder / "triangles.fgb"
    write_triangles_with_pyogrio(tin, path)
    peers = {"pyogrio, shapely": Reader("pyogrio", read_triangles, "corners alone")}

    def require(ours: TIN, theirs: Float64Array, _: str) -> None:
        assert len(ours.triangles) == len(tin.triangles)
        np.testing.assert_array_equal(
            np.sort(ours.points[ours.triangles], axis=1), np.sort(theirs, axis=1)
        )

    trial.measure(LAYER, path, len(tin.triangles), peers, require)


_TASKS = (
    _measure_survey,
    _measure_raster,
    _measure_mesh,
    _measure_landxml,
    _measure_lidar,
    _measure_layer,
)
