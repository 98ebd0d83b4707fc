"""Quantized-mesh tiles where their headers tell: on the globe, or in web Mercator."""

from __future__ import annotations

import gzip
import struct

import numpy as np
import pyproj
import pytest
from support.face_files import write_faces

import tinsmith as ts

HALF = 20_037_508.342789244
FACES = [[0, 1, 2], [0, 2, 3]]
CORNERS = [[0, 0, 0], [32767, 0, 9], [32767, 32767, 32767], [0, 32767, 20]]


def write_tile(folder, name, center, *, packed=False, radius=5e4):
    """Write a tile of two triangles under its path, with the centre in its header."""
    path, _ = write_faces("terrain", CORNERS, FACES, folder)
    content = bytearray(path.read_bytes())
    struct.pack_into("<3d", content, 0, *center)
    struct.pack_into("<3dd", content, 32, *center, radius)
    place = folder / f"{name}.terrain"
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(gzip.compress(content) if packed else content)
    path.unlink()
    return place


def bounds_of(tin):
    return (*tin.points[:, :2].min(axis=0).tolist(), *tin.points[:, :2].max(axis=0).tolist())


def center_in_mercator(level, x, y):
    width = 2 * HALF / 2**level
    return (x + 0.5) * width - HALF, (y + 0.5) * width - HALF, 1465.4


def center_on_globe(level, x, y, height=300.0):
    width = 180 / 2**level
    to_space = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    return to_space.transform((x + 0.5) * width - 180, (y + 0.5) * width - 90, height)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", [(0, 0, 0), (3, 2, 5), (9, 81, 323), (10, 163, 646), (18, 7, 9)])
def test_a_tile_of_web_mercator_lies_there(tmp_path, name, packed):
    level, x, y = name
    path = write_tile(tmp_path, f"{level}/{x}/{y}", center_in_mercator(*name), packed=packed)
    tin = ts.read(path)
    assert tin.crs == "EPSG:3857"
    assert tin.elevation_unit.name == "metre"
    width = 2 * HALF / 2**level
    expected = [x * width - HALF, y * width - HALF, (x + 1) * width - HALF, (y + 1) * width - HALF]
    assert np.allclose(bounds_of(tin), expected, rtol=1e-12, atol=1e-6)
    assert any("web Mercator" in note for note in tin.notes)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", [(0, 0, 0), (0, 1, 0), (2, 3, 1), (9, 82, 323), (17, 70_000, 3)])
def test_a_tile_of_the_globe_lies_there(tmp_path, name, packed):
    level, x, y = name
    path = write_tile(tmp_path, f"{level}/{x}/{y}", center_on_globe(*name), packed=packed)
    tin = ts.read(path)
    width = 180 / 2**level
    assert tin.crs == "EPSG:4979"
    assert bounds_of(tin)[:2] == pytest.approx((x * width - 180, y * width - 90))
    assert not any("web Mercator" in note for note in tin.notes)


@pytest.mark.parametrize("make", [center_in_mercator, center_on_globe])
def test_rows_from_the_north_are_refused_with_the_tile_that_is_right(tmp_path, make):
    path = write_tile(tmp_path, f"10/163/{1023 - 646}", make(10, 163, 646))
    with pytest.raises(ts.ReadError, match="rows are counted from the south") as caught:
        ts.read(path)
    assert "tile='10/163/646'" in str(caught.value)
    assert len(ts.read(path, tile="10/163/646").triangles) == 2


def test_a_tile_of_another_place_is_refused(tmp_path):
    path = write_tile(tmp_path, "10/12/34", center_on_globe(10, 163, 646))
    with pytest.raises(ts.ReadError, match=r"longitude -151\.\d+, latitude 23\.\d+, does not lie"):
        ts.read(path)
    told = ts.read(path, tile="10/12/34").notes
    assert any("lies where it is declared to lie, and the centre" in note for note in told)


def test_a_header_without_a_place_is_told(tmp_path):
    tin = ts.read(write_tile(tmp_path, "10/12/34", (0, 0, 0)))
    assert any("does not tell where it lies" in note for note in tin.notes)


@pytest.mark.parametrize("make", [center_in_mercator, center_on_globe])
def test_gzipped_tiles_are_recognised_by_their_content(tmp_path, make):
    path = write_tile(tmp_path, "10/163/646", make(10, 163, 646), packed=True)
    other = path.rename(tmp_path / "tile.bin")
    assert len(ts.read(other, tile="10/163/646").triangles) == 2


def test_a_gzipped_tile_without_a_place_is_read_by_its_suffix(tmp_path):
    path = write_tile(tmp_path, "10/163/646", (0, 0, 0), packed=True)
    assert len(ts.read(path).triangles) == 2
