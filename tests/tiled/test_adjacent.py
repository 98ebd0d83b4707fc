"""Real lidar tiles that meet at a corner: no seams."""

from __future__ import annotations

import filecmp
from pathlib import Path

import numpy as np
import pytest
import rasterio
from support.many_files import Shuffled

import tinsmith as ts

LIDAR = Path(__file__).parent.parent / "data" / "adjacent"
CORNER = (770_550.0, 6_277_550.0)


@pytest.mark.filterwarnings("ignore:.* is a shapefile")
@pytest.mark.parametrize("tiles", [1, 7])
def test_cells_and_contours_are_those_of_all_points(tmp_path, tiles):
    tin = ts.triangulate(ts.read(LIDAR, classes=2))
    cloud = ts.tiles(LIDAR, classes=2)
    wanted = ts.rasterize(tin, spacing=0.25).bands["elevation"]
    way = {"tiles": tiles, "executor": Shuffled(tiles)}
    with rasterio.open(cloud.rasterize(tmp_path / "a.tif", spacing=0.25, **way)) as dataset:
        np.testing.assert_array_equal(dataset.read(1), wanted)
    made = cloud.contours(tmp_path / "a.shp", 0.1, **way)
    whole = ts.write(ts.contours(tin, 0.1), tmp_path / "whole.shp")
    assert filecmp.cmp(made, whole, shallow=False)


def test_files_one_by_one_have_seams():
    """What the test above would find: many cells along the sides of files are others."""
    tin = ts.triangulate(ts.read(LIDAR, classes=2))
    whole = ts.rasterize(tin, spacing=0.25)
    cells = np.full(whole.shape, np.nan)
    for path in LIDAR.glob("*.laz"):
        own = ts.triangulate(ts.read(path, classes=2))
        made = ts.rasterize(own, like=whole).bands["elevation"]
        cells = np.where(np.isnan(cells), made, cells)
    x = whole.grid.bounds.xmin + (np.arange(whole.shape[1]) + 0.5) * 0.25
    beside = np.abs(x - CORNER[0]) < 0.3
    is_other = cells[:, beside] != whole.bands["elevation"][:, beside]
    assert is_other.mean() > 0.2
