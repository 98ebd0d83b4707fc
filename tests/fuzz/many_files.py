"""Campaign: products of points in several files, in tiles, against those of the whole in memory."""

from __future__ import annotations

import filecmp
import warnings
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from support.many_files import Shuffled
from support.point_sets import points
from support.product_parts import require_same_features

import tinsmith as ts
from tinsmith.tiled.computing import computing
from tinsmith.tiled.running.run_options import RunSettings

from .campaign import Campaign, Case

_MOST_POINTS = 200
_LARGEST = 1e12
"""Of a coordinate: text is written with digits that hold it, and rasters have cells."""


def generate(rng: np.random.Generator) -> Case:
    """Points dealt out to files at random or by easting, lines, and the tiles of each product."""
    cloud = points(rng, int(rng.integers(3, _MOST_POINTS)))
    lines = _generate_lines(rng, np.asarray(cloud)) if rng.random() < 0.5 else {}
    return {
        "points": cloud,
        "files": int(rng.integers(1, 5)),
        "is_sorted": bool(rng.random() < 0.5),
        "tiles": int(rng.integers(1, 20)),
        "duplicates": str(rng.choice(["mean", "first", "last", "lowest", "highest"])),
        "seed": int(rng.integers(0, 10**6)),
        "lines": lines,
    }


def _generate_lines(rng: np.random.Generator, cloud: np.ndarray) -> dict[str, list[Any]]:
    """Lines from point to point, or beside them, and a rectangle as boundary, hole, both or none.

    Elevations are whole numbers, so that those of lines and points at one place differ.
    """
    low, high = cloud[:, :2].min(axis=0), cloud[:, :2].max(axis=0)

    def lift(xy: np.ndarray) -> list[list[float]]:
        return np.column_stack([xy, rng.integers(-9, 9, len(xy))]).tolist()

    found: dict[str, list[Any]] = {"breaklines": [], "boundary": [], "holes": []}
    for _ in range(int(rng.integers(0, 4))):
        xy = cloud[rng.integers(0, len(cloud), int(rng.integers(2, 5))), :2]
        if rng.random() < 0.5:
            xy = low + (high - low) * rng.random((len(xy), 2))
        found["breaklines"].append(lift(xy))
    for name in ("boundary", "holes"):
        if rng.random() < 0.4:
            (west, east), (south, north) = np.sort(rng.random((2, 2)) * 1.2 - 0.1, axis=1)
            corners = np.array([[west, south], [east, south], [east, north], [west, north]])
            found[name].append(lift(low + (high - low) * corners))
    likely = float(rng.choice([0.0, 0.5, 1.0]))  # to be draped: without elevations
    for name, lines in found.items():
        found[name] = [
            [row[:2] for row in line] if rng.random() < likely else line for line in lines
        ]
    return {name: lines for name, lines in found.items() if lines}


def examine(case: Case) -> str:
    """Write a raster, contours, volumes and a profile of tiles."""
    cloud = np.array(case["points"], np.float64).reshape(-1, 3)
    extent = float(np.ptp(cloud[:, :2], axis=0).max())
    if not np.abs(cloud).max() <= _LARGEST or extent < 1e-9 * np.abs(cloud[:, :2]).max():
        return "left out"
    order = np.argsort(cloud[:, 0], kind="stable") if case["is_sorted"] else np.arange(len(cloud))
    parts = np.array_split(cloud[order], min(case["files"], len(cloud)))
    try:
        tin = ts.triangulate(np.concatenate(parts), duplicates=case["duplicates"], **case["lines"])
    except (ts.PointsError, ts.LinesError):
        return "refused"
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        files = [
            ts.write(ts.Survey(points=part), Path(folder, f"part{k}.ply"))
            for k, part in enumerate(parts)
        ]
        cloud_of_files = ts.tiles(files, duplicates=case["duplicates"], **case["lines"])
        return _compare(case, tin, cloud_of_files, Path(folder))


def _compare(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> str:
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    level = float(low + (high - low) * 0.4)
    bounds = tin.bounds
    line = [[bounds.xmin, bounds.ymin], [bounds.xmax, bounds.ymax]]
    spacing = max(bounds.width, bounds.height) / 7
    products = {
        "contours": ((), {"levels": [level]}, ts.contours, ".shp"),
        "volume": ((), {"base": level}, ts.volume, ".csv"),
        "profile": ((line,), {}, ts.profile, ".csv"),
        "slope_statistics": ((), {"unit": "percent"}, ts.slope_statistics, ".csv"),
        "rasterize": ((), {"spacing": spacing}, ts.rasterize, ".tif"),
    }
    found = []
    for name, (given, options, make, suffix) in products.items():
        try:
            whole = make(tin, *given, **options)
        except ts.TinsmithError:
            found.append("refused")
            continue
        if name == "contours" and not len(whole):
            continue
        wanted = ts.write(replace(whole, notes=()), folder / f"whole{suffix}")
        way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
        path = getattr(cloud, name)(folder / f"tiled{suffix}", *given, **options, **way)
        if name == "rasterize":
            _require_same_cells(path, whole)
        else:
            assert filecmp.cmp(path, wanted, shallow=False), name
        found.append(name)
    _compare_places(case, tin, cloud, folder)
    _compare_draped(case, tin, cloud, folder)
    made = _compare_surfaces(case, tin, cloud, folder) + _compare_files(case, tin, cloud, folder)
    made += _compare_point_rasters(case, tin, cloud, folder)
    return f"{len(found) - found.count('refused') + 2 + made} products"


def _compare_files(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> int:
    """Require the file of the whole surface, where it has no lines."""
    if cloud.lines is not None:
        return 0
    wanted = ts.write(tin, folder / "whole.ply")
    way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
    assert filecmp.cmp(cloud.build(folder / "tiled.ply", **way), wanted, shallow=False)
    tolerance = float(np.ptp(tin.points[:, 2])) / 5 or 1.0
    options = {"tolerance": tolerance, "node_points": 16}
    try:
        simple = cloud.simplify(folder / "simple.ply", **options, executor=Shuffled())
    except ts.ReadError as error:
        if "nearer to each other than coordinates are rounded" in str(error):
            return 1
        if "it is so narrow there" in str(error) and _is_narrow(tin.points):
            return 1
        raise
    again = cloud.simplify(folder / "again.ply", **options, **way)
    assert filecmp.cmp(simple, again, shallow=False)
    return 2


def _is_narrow(points: np.ndarray) -> bool:
    """Tell whether all points lie within 16 roundings of the largest coordinate, across a line."""
    xy = points[:, :2] - points[0, :2]
    across = np.linalg.svd(xy - xy.mean(axis=0), full_matrices=False)[2][1]
    return bool(np.ptp(xy @ across) <= 16 * np.spacing(np.abs(points[:, :2]).max()))


def _compare_surfaces(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> int:
    """Require the volumes to another surface, that shares vertices, in memory and in a file."""
    points = tin.points + np.where(np.arange(len(tin.points)) % 2, 0.0, 1.0)[:, None]
    try:
        other = ts.triangulate(points)
        whole = ts.volume(tin, other)
    except ts.TinsmithError:
        return 0
    wanted = ts.write(replace(whole, notes=()), folder / "whole.csv")
    file = ts.write(ts.Survey(points=points), folder / "other.ply")
    for one in (other, ts.tiles(file)):
        way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
        path = cloud.volume(folder / "tiled.csv", one, **way)
        assert filecmp.cmp(path, wanted, shallow=False)
    return 1


def _compare_point_rasters(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> int:
    """Require counts, and heights of all points above the surface; many lie on sides of cells."""
    points, bounds = np.array(case["points"], np.float64).reshape(-1, 3), tin.bounds
    extent = max(np.ptp(points[:, :2], axis=0).max(), bounds.width, bounds.height)
    spacing = float(2.0 ** np.ceil(np.log2(extent / 8)))
    plain = replace(cloud, lines=None)
    made = 0
    for value, surface, whole in (
        ("count", plain, lambda: ts.rasterize_counts(points, spacing=spacing)),
        ("height", cloud, lambda: ts.rasterize_heights(tin, points, spacing=spacing)),
    ):
        try:
            raster = whole()
        except ts.TinsmithError:
            continue
        wanted = ts.write(replace(raster, notes=()), folder / "whole.tif")
        how = RunSettings.of(tiles=case["tiles"], executor=Shuffled(case["seed"]))
        asked = {"value": value, "spacing": spacing}
        asked |= {"other": plain} if value == "height" else {}
        with computing(surface, "point_rasters", folder / "tiled.tif", how, **asked) as found:
            path = ts.write(replace(found, notes=()), folder / "tiled.tif")
        assert filecmp.cmp(path, wanted, shallow=False), value
        made += 1
    return made


def _compare_places(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> None:
    """Require the elevations at vertices, on edges and beside the surface."""
    xy = tin.points[:, :2]
    places = np.concatenate([xy, 0.5 * xy[:-1] + 0.5 * xy[1:], xy[:5] + np.ptp(xy, axis=0)])
    way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
    path = cloud.interpolate(folder / "places.csv", places, **way)
    found = [float(row.split(",")[2] or "nan") for row in path.read_text().splitlines()[1:]]
    np.testing.assert_array_equal(found, tin.interpolate(places))


def _compare_draped(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> None:
    """Require the points along lines through vertices, along the boundary and off the surface."""
    xy, rim = tin.points[:, :2], tin.points[tin.boundary[0], :2]
    far = xy.max(axis=0) + 2.0 * np.ptp(xy, axis=0)
    lines = [[xy[0], xy[-1], far], [rim[0], rim[1], rim[2]], [far, far + np.ptp(xy, axis=0)]]
    line = np.array(lines[case["seed"] % 3])
    how = RunSettings.of(tiles=case["tiles"], executor=Shuffled(case["seed"]))
    asked = {"features": line, "outside": "nan"}
    with computing(cloud, "drape", folder / "lines.gpkg", how, **asked) as made:
        require_same_features(made, ts.drape(tin, line, outside="nan"))


def _require_same_cells(path: Path, whole: ts.Raster) -> None:
    import rasterio

    with rasterio.open(path) as dataset:
        np.testing.assert_array_equal(dataset.read(1), whole.bands["elevation"])


CAMPAIGNS = (Campaign("many files", "products of files in tiles", generate, examine),)
