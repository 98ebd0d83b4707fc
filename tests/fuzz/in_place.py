"""Campaign: products of files that are read in place, against those of the whole in memory."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
import rasterio
from support.lidar_files import CORNER
from support.many_files import Shuffled
from support.point_sets import points
from support.sources_in_place import write_groups, write_octree

import tinsmith as ts
from tinsmith.tiled import chunks, in_place

from .campaign import Campaign, Case

_LARGEST = 1e12


def generate(rng: np.random.Generator) -> Case:
    """A file of one kind, options of its reader, tiles, and how large blocks are."""
    kind = str(rng.choice(["octree", "raster", "groups"]))
    case: Case = {
        "kind": kind,
        "tiles": int(rng.integers(1, 7)),
        "duplicates": str(rng.choice(["mean", "first", "last", "lowest", "highest"])),
        "seed": int(rng.integers(0, 10**6)),
        "points_of_a_cell": int(rng.choice([1, 5, 40, 1_000])),
        "points_of_a_block": int(rng.choice([20, 60, 200, 16_000])),
        "held_points": int(rng.choice([0, 400, 10**6, 10**6])),
        "worth_reading": int(rng.choice([0, 10, 10**5])),
    }
    if kind == "octree":
        return case | {"count": int(rng.integers(40, 250)), "class": int(rng.choice([0, 2, 5]))}
    if kind == "groups":
        cloud = points(rng, int(rng.integers(3, 200)))
        return case | {"points": cloud, "group": int(rng.choice([1, 7, 50]))}
    shape = [int(rng.integers(2, 26)) for _ in range(2)]
    return case | {
        "shape": shape,
        "voids": float(rng.choice([0.0, 0.0, 0.02, 0.3])),
        "turn": float(rng.choice([0.0, 0.0, 0.3])),
        "is_south_up": bool(rng.random() < 0.3),
        "stride": int(rng.choice([1, 1, 2, 3])),
        "side": float(rng.choice([1.0, 0.1, 2.5, 30.0])),
    }


def examine(case: Case) -> str:
    """Write the file, and compare what is made of it in place and in memory."""
    with TemporaryDirectory() as folder, warnings.catch_warnings(), ExitStack() as stack:
        warnings.simplefilter("ignore", ts.LossWarning)
        stack.enter_context(patch.object(chunks, "_POINTS_OF_A_CELL", case["points_of_a_cell"]))
        for name in ("POINTS_OF_A_BLOCK", "HELD_POINTS", "WORTH_READING"):
            stack.enter_context(patch.object(in_place, f"_{name}", case[name.lower()]))
        stack.enter_context(patch.object(in_place, "_POINTS_OF_A_PART", case["points_of_a_block"]))
        found = _write(case, Path(folder))
        if found is None:
            return "left out"
        path, options = found
        try:
            tin = ts.triangulate(ts.read(path, **options), duplicates=case["duplicates"])
        except ts.TinsmithError:
            return "refused"
        copied, there = (
            ts.tiles(path, in_place=one, duplicates=case["duplicates"], **options)
            for one in (False, True)
        )
        is_there = "in place" if there.plan().in_place else "copied"
        if case["kind"] != "groups":
            assert is_there == "in place", there.plan().copied
        _compare_with_memory(case, tin, there, Path(folder))
        _compare_with_copies(case, tin, (copied, there), Path(folder))
        return f"{case['kind']}, {is_there}"


def _compare_with_memory(case: Case, tin: ts.TIN, cloud: ts.TiledPoints, folder: Path) -> None:
    """Require the cells and the triangles of the surface in memory."""
    spacing = max(tin.bounds.width, tin.bounds.height) / 9
    way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
    try:
        wanted = ts.rasterize(tin, spacing=spacing).bands["elevation"]
    except ts.TinsmithError as error:  # a surface thinner than a cell
        with pytest.raises(type(error)):
            cloud.rasterize(folder / "tiled.tif", spacing=spacing, **way)
    else:
        path = cloud.rasterize(folder / "tiled.tif", spacing=spacing, **way)
        with rasterio.open(path) as dataset:
            np.testing.assert_array_equal(dataset.read(1), wanted)
    proof = cloud.check(run=folder / "run", **way)
    assert (proof.triangles, proof.vertices) == (len(tin.triangles), len(tin.points))


def _compare_with_copies(
    case: Case, tin: ts.TIN, clouds: tuple[ts.TiledPoints, ...], folder: Path
) -> None:
    """Require the bytes, or the refusals, of products of copied points."""
    bounds, z = tin.bounds, tin.points[:, 2]
    level = float(z.min() + np.ptp(z) * 0.4)
    line = [[bounds.xmin, bounds.ymin], [bounds.xmax, bounds.ymax]]
    spacing = max(bounds.width, bounds.height) / 7
    products: dict[str, Callable[..., Path]] = {
        "contours.shp": lambda c, path, **way: c.contours(path, levels=[level], **way),
        "volume.csv": lambda c, path, **way: c.volume(path, base=level, **way),
        "profile.csv": lambda c, path, **way: c.profile(path, line, **way),
        "places.csv": lambda c, path, **way: c.interpolate(path, tin.points[:9, :2], **way),
        "counts.tif": lambda c, path, **way: c.rasterize_counts(path, spacing=spacing, **way),
        "one.ply": lambda c, path, **way: c.build(path, **way),
    }
    for name, make in products.items():
        found = []
        for number, cloud in enumerate(clouds):
            path = folder / f"{number}-{name}"
            way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"] + number)}
            try:
                found.append(make(cloud, path, **way).read_bytes())
            except ts.TinsmithError as error:
                found.append(type(error).__name__.encode())
        assert found[0] == found[1], name


def _write(case: Case, folder: Path) -> tuple[Path, dict[str, Any]] | None:
    if case["kind"] == "octree":
        options = {"classes": case["class"]} if case["class"] else {}
        return write_octree(folder / "a.copc.laz", case["count"], seed=case["seed"]), options
    if case["kind"] == "raster":
        options = {"stride": case["stride"]} if case["stride"] > 1 else {}
        return _write_raster(case, folder / "a.tif"), options
    cloud = np.array(case["points"], np.float64).reshape(-1, 3)
    extent = float(np.ptp(cloud[:, :2], axis=0).max())
    if not np.abs(cloud).max() <= _LARGEST or extent < 1e-9 * np.abs(cloud[:, :2]).max():
        return None
    cloud = cloud[np.argsort(cloud[:, 0], kind="stable")]
    return write_groups(folder / "a.parquet", cloud, group=case["group"], crs=None), {}


def _write_raster(case: Case, path: Path) -> Path:
    rng = np.random.default_rng(case["seed"])
    shape, side = case["shape"], case["side"]
    cells = np.round(rng.normal(300, 3, shape), 2)
    cells[rng.random(shape) < case["voids"]] = -9999.0
    cos, sin = np.cos(case["turn"]) * side, np.sin(case["turn"]) * side
    up = 1.0 if case["is_south_up"] else -1.0
    place = rasterio.Affine(cos, up * sin, CORNER[0], -sin, up * cos, CORNER[1])
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        dtype="float64",
        count=1,
        height=shape[0],
        width=shape[1],
        nodata=-9999.0,
        crs="EPSG:32616",
        transform=place,
        tiled=True,
        blockxsize=16,
        blockysize=16,
    ) as dataset:
        dataset.write(cells, 1)
    return path


CAMPAIGNS = (
    Campaign(
        "in place",
        "products of files that are read in place",
        generate,
        examine,
        seconds=900.0,
        weight=50,
    ),
)
