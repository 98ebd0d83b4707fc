"""Esri TIN folders that ArcGIS wrote, against the raster one was made of, and damaged ones."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from support.qgis_meshes import open_all_in_qgis

import tinsmith as ts

DATA = Path(__file__).parents[2] / "data" / "meshes"
PLAIN, HOLES = DATA / "esri_tin_dem", DATA / "esri_tin_holes"


def copy(tmp_path, source=PLAIN):
    return Path(shutil.copytree(source, tmp_path / "tin"))


def test_the_surface_is_that_of_the_raster():
    rasterio = pytest.importorskip("rasterio")
    tin = ts.read(PLAIN)
    with rasterio.open(DATA / "esri_tin_dem.tif") as raster:
        cells, place, nodata = raster.read(1), raster.transform, raster.nodata
    rows, columns = np.indices(cells.shape)
    xy = np.column_stack([place.c + place.a * (columns.ravel() + 0.5),
                          place.f + place.e * (rows.ravel() + 0.5)])  # fmt: skip
    z = tin.interpolate(xy).reshape(cells.shape)
    both = (cells != nodata) & np.isfinite(z)
    assert both.mean() > 0.97
    tolerance = np.ptp(cells[cells != nodata]) / 10  # that of ArcGIS's Raster to TIN
    assert np.abs(z - cells)[both].max() <= tolerance


def test_superpoints_and_masked_triangles_are_left_out():
    tin = ts.read(PLAIN)
    assert (len(tin.points), len(tin.triangles)) == (277, 528)
    assert tin.points[:, 2].min() == pytest.approx(85.7)
    assert tin.crs == "EPSG:4326"
    assert ts.check(tin, level=2).problems == ()


def test_holes_and_their_enforced_edges():
    tin = ts.read(HOLES)
    assert (len(tin.points), len(tin.triangles)) == (518, 773)
    assert len(tin.boundary) == 8
    on_boundary = tin.neighbors == -1
    assert tin.constrained[on_boundary].all()
    assert set(tin.lines.kinds) == {"boundary"}


@pytest.mark.parametrize("name", ["", "tnxy.adf", "tedg.adf", "tdenv9.adf"])
def test_the_folder_or_any_file_in_it(name):
    assert len(ts.read(PLAIN / name).triangles) == 528


@pytest.mark.slow
def test_qgis_sees_the_same(tmp_path):
    sources = (PLAIN, HOLES)
    found = open_all_in_qgis([source / "tnxy.adf" for source in sources], tmp_path)
    for source, seen in zip(sources, found, strict=True):
        tin = ts.read(source)
        assert (seen["vertices"], seen["faces"]) == (len(tin.points), len(tin.triangles))
        z = tin.points[:, 2]
        assert seen["groups"]["Altitude"] == [z.min(), z.max()]


def test_hard_and_soft_edges_within_are_lines(tmp_path):
    folder = copy(tmp_path)
    tin = ts.read(folder)
    inner = np.argwhere(tin.neighbors >= 0)[0]
    original = np.fromfile(folder / "tnod.adf", ">i4").reshape(-1, 3)
    beside = np.fromfile(folder / "tedg.adf", ">i4")
    enforced = np.fromfile(folder / "teval.adf", ">i4").reshape(-1, 4)
    slot = next(k for k in range(len(beside)) if beside[k] > 0 and _is_inner(k, original))
    twin = beside[slot] - 1
    rows = [[twin + 1, slot + 1, 4, 0], [slot + 1, twin + 1, 4, 0]]
    beside[slot], beside[twin] = -(len(enforced) + 1), -(len(enforced) + 2)
    np.concatenate([enforced, np.array(rows, ">i4")]).astype(">i4").tofile(folder / "teval.adf")
    beside.tofile(folder / "tedg.adf")
    changed = ts.read(folder)
    assert inner.size == 2
    assert changed.lines.kinds.count("hard") == 1
    assert changed.constrained.sum() == tin.constrained.sum() + 2


def _is_inner(slot, corners):
    """Whether an edge and its triangle are far from the superpoints, 1 to 4, and the boundary."""
    triangle, corner = divmod(slot, 3)
    return corners[triangle].min() > 40 and corners[triangle, corner] > 40


@pytest.mark.parametrize("name", ["tnxy.adf", "tnz.adf", "tnod.adf", "tedg.adf", "tmsk.adf"])
@pytest.mark.parametrize("keep", [0, 3, 100])
def test_cut_files_are_refused(tmp_path, name, keep):
    folder = copy(tmp_path)
    content = (folder / name).read_bytes()
    (folder / name).write_bytes(content[:keep])
    with pytest.raises(ts.ReadError):
        ts.read(folder)


def test_a_mask_whose_counts_contradict_is_refused(tmp_path):
    folder = copy(tmp_path)
    mask = bytearray((folder / "tmsk.adf").read_bytes())
    start = len(mask) - 2 * int.from_bytes((folder / "tmsx.adf").read_bytes()[-4:], "big")
    words = int.from_bytes(mask[start : start + 4], "big")
    mask[start : start + 4] = (words + 1).to_bytes(4, "big")
    (folder / "tmsk.adf").write_bytes(mask)
    with pytest.raises(ts.ReadError, match="promises"):
        ts.read(folder)


def test_a_missing_file_is_named(tmp_path):
    folder = copy(tmp_path)
    (folder / "tmsk.adf").unlink()
    with pytest.raises(ts.ReadError, match=r"tmsk\.adf"):
        ts.read(folder)


def test_an_unknown_crs_is_none(tmp_path):
    folder = copy(tmp_path)
    (folder / "prj.adf").write_text("{B286C06B-0879-11D2-AACA-00C04FA33C20}")
    assert ts.read(folder).crs is None
