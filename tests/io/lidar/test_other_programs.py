"""Lidar files as other programs write them, though the formats' own texts have it otherwise."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from support.lidar_files import make_cloud, write_copc

import tinsmith as ts

laspy = pytest.importorskip("laspy")

_USER_DEFINED = 32767


@pytest.mark.parametrize("chunk_size", [0, 2**32 - 1])
def test_an_octree_whose_chunks_have_no_fixed_size_is_read(tmp_path, chunk_size):
    made = make_cloud(500)
    path = write_copc(tmp_path / "a.copc.laz", made)
    content = bytearray(path.read_bytes())
    at = content.index(struct.pack("<H16sH", 0, b"laszip encoded", 22204)) + 54 + 12
    assert struct.unpack_from("<I", content, at) == (2**32 - 1,)
    struct.pack_into("<I", content, at, chunk_size)
    path.write_bytes(content)
    survey = ts.read(path, withheld=True)
    assert sorted(map(tuple, survey.points)) == sorted(map(tuple, made.xyz))


def write_cloud(path, *, keys=(), wkt=""):
    cloud = make_cloud(20, version="1.2", point_format=1)
    if keys:
        rows = [(1, 1, 0, len(keys)), *((key, 0, 1, value) for key, value in keys)]
        content = b"".join(struct.pack("<4H", *row) for row in rows)
        cloud.header.vlrs.append(laspy.VLR("LASF_Projection", 34735, "", content))
    if wkt:
        cloud.header.vlrs.append(laspy.VLR("LASF_Projection", 2112, "", wkt.encode() + b"\0"))
    cloud.write(path)
    return path


UNNAMED = {
    "projected key": {"keys": [(1024, 1), (3072, _USER_DEFINED)]},
    "with a unit": {"keys": [(1024, 1), (3072, _USER_DEFINED), (3076, 9003)]},
    "wkt": {"wkt": 'LOCAL_CS["unnamed",UNIT["metre",1]]'},
    "wkt and keys": {"wkt": 'LOCAL_CS["Unknown",UNIT["metre",1]]',
                     "keys": [(1024, 1), (3072, _USER_DEFINED)]},
}  # fmt: skip


@pytest.mark.parametrize("name", UNNAMED)
def test_a_crs_that_nothing_describes_is_not_known(tmp_path, name):
    path = write_cloud(tmp_path / "a.las", **UNNAMED[name])
    survey = ts.read(path)
    assert survey.crs is None
    assert any("nothing describes it" in note for note in survey.notes)
    declared = ts.read(path, crs="EPSG:32616")
    assert declared.crs == "EPSG:32616"
    assert np.array_equal(declared.points, survey.points)
    assert any("nothing describes it" in note for note in declared.notes)


def test_the_unit_of_a_crs_that_nothing_describes_is_told(tmp_path):
    survey = ts.read(write_cloud(tmp_path / "a.las", **UNNAMED["with a unit"]))
    assert any("US survey foot" in note for note in survey.notes)
    assert survey.elevation_unit is None


def test_keys_stand_in_for_a_text_that_describes_nothing(tmp_path):
    path = write_cloud(tmp_path / "a.las", wkt=UNNAMED["wkt"]["wkt"], keys=[(3072, 32616)])
    assert ts.read(path).crs == "EPSG:32616"
