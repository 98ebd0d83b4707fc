"""CityJSON: round trips, cjio, versions, several objects, damaged files."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys

import numpy as np
import pytest
from support.surfaces import hills

import tinsmith as ts

SHAPE = {"type": "CompositeSurface", "lod": "1", "boundaries": [[[0, 1, 2]], [[0, 2, 3]]]}
RELIEF = {"type": "TINRelief", "geometry": [SHAPE]}
CITY = {
    "type": "CityJSON",
    "version": "2.0",
    "transform": {"scale": [0.01, 0.01, 0.1], "translate": [745000.0, 4033000.0, 100.0]},
    "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/32616"},
    "CityObjects": {"ground": RELIEF},
    "vertices": [[0, 0, 50], [400, 0, 60], [400, 300, 70], [0, 300, 80]],
}


def read(tmp_path, changes=(), **options):
    path = tmp_path / "a.city.json"
    path.write_text(json.dumps({**CITY, **dict(changes)}))
    return ts.read(path, **options)


@pytest.mark.parametrize("digits", [0, 2, 3, None])
def test_a_tin_comes_back(tmp_path, digits):
    tin = hills(lines=False)
    if digits is not None:
        tin = ts.triangulate(tin.points.round(digits), crs=tin.crs)
    back = ts.read(ts.write(tin, tmp_path / "a.city.json"))
    if digits is None:
        assert np.abs(back.points - tin.points).max() < 2e-9
    else:
        assert np.array_equal(back.points, tin.points)
    assert np.array_equal(back.triangles, tin.triangles)
    assert (back.crs, back.elevation_unit) == (tin.crs, tin.elevation_unit)


def test_the_precision_asked_for(tmp_path):
    tin = hills(lines=False)
    path = ts.write(tin, tmp_path / "a.city.json", precision=0.001)
    back = ts.read(path)
    assert 1e-5 < np.abs(back.points - tin.points).max() <= 0.000501
    assert json.loads(path.read_text())["transform"]["scale"] == [0.001] * 3
    with pytest.raises(ts.OptionError, match="power of ten"):
        ts.write(tin, path, precision=0.002)
    with pytest.raises(ts.WriteError, match="would have no area"):
        ts.write(ts.triangulate(np.array([[0, 0, 1], [0.1, 0, 1], [0, 0.1, 1]])), path, precision=1)


_CJIO = """
import json, sys
from cjio import cityjson
with open(sys.argv[1]) as file:
    city = cityjson.reader(file=file, ignore_duplicate_keys=False)
shape = city.j["CityObjects"]["terrain"]["geometry"][0]
bbox = [repr(value) for value in city.get_bbox()]
print(repr([city.get_epsg(), city.get_version(), bbox, shape["boundaries"]]))
"""


def test_cjio_reads_our_file(tmp_path):
    """In a process of its own: cjio changes how the json module writes numbers."""
    pytest.importorskip("cjio")
    tin = hills()
    path = ts.write(tin, tmp_path / "a.city.json")
    command = [sys.executable, "-c", _CJIO, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600)
    epsg, version, bbox, boundaries = ast.literal_eval(done.stdout.splitlines()[-1])
    assert (epsg, version) == (32616, "2.0")
    low, high = tin.points.min(axis=0), tin.points.max(axis=0)
    assert [float(value) for value in bbox] == pytest.approx([*low, *high])
    assert [ring for (ring,) in boundaries] == tin.triangles.tolist()


_TOP = {"type", "version", "metadata", "transform", "CityObjects", "vertices"}
_URL = re.compile(r"^https?://www\.opengis\.net/def/crs/[^/]+/[^/]+/\d+$")


def list_faults(city):
    """Return what of the schema of CityJSON 2.0 a file with one terrain breaks."""
    transform, metadata = city.get("transform", {}), city.get("metadata", {})
    faults = {
        "members": not set(city) <= _TOP or not {*_TOP} - {"metadata"} <= set(city),
        "version": (city.get("type"), city.get("version")) != ("CityJSON", "2.0"),
        "transform": set(transform) != {"scale", "translate"}
        or any(len(row) != 3 for row in transform.values()),
        "vertices": any(
            len(row) != 3 or any(type(one) is not int for one in row) for row in city["vertices"]
        ),
        "metadata": not set(metadata) <= {"geographicalExtent", "referenceSystem"}
        or len(metadata.get("geographicalExtent", [0] * 6)) != 6
        or not _URL.match(metadata.get("referenceSystem", "https://www.opengis.net/def/crs/A/0/1")),
    }
    for terrain in city["CityObjects"].values():
        faults["terrain"] = terrain["type"] != "TINRelief" or not set(terrain) <= {
            "type",
            "attributes",
            "geometry",
            "geographicalExtent",
        }
        for shape in terrain["geometry"]:
            faults["shape"] = (
                set(shape) != {"type", "lod", "boundaries"}
                or shape["type"] != "CompositeSurface"
                or re.fullmatch(r"[0-3](\.[0-3])?", shape["lod"]) is None
            )
            corners = [corner for (ring,) in shape["boundaries"] for corner in ring]
            faults["rings"] = any(len(ring) < 3 for (ring,) in shape["boundaries"]) or any(
                type(one) is not int or not 0 <= one < len(city["vertices"]) for one in corners
            )
    return {name for name, is_wrong in faults.items() if is_wrong}


@pytest.mark.filterwarnings("ignore::tinsmith.base.errors.LossWarning")
@pytest.mark.parametrize(
    ("crs", "options"),
    [
        ("EPSG:32616", {}),
        ("EPSG:2274", {"precision": 0.001}),
        (None, {}),
        ("EPSG:32616+5703", {"precision": 0.01}),
        ("+proj=tmerc +lon_0=9 +x_0=1000 +ellps=GRS80", {}),
    ],
)
def test_what_the_schema_of_version_2_0_asks_for(tmp_path, crs, options):
    tin = hills(crs=crs, unit=None)
    city = json.loads(ts.write(tin, tmp_path / "a.city.json", **options).read_text())
    assert list_faults(city) == set()
    assert list_faults({**city, "vertices": [[0.5, 1, 2]]}) == {"vertices", "rings"}
    assert list_faults({name: city[name] for name in city if name != "transform"}) == {
        "members", "transform"
    }  # fmt: skip


def test_a_crs_without_a_number_is_kept_and_told(tmp_path):
    crs = ts.CRS("+proj=tmerc +lon_0=9 +x_0=1000 +ellps=GRS80")
    tin = hills(crs=crs, unit=None)
    with pytest.warns(ts.LossWarning, match="EPSG number"):
        path = ts.write(tin, tmp_path / "a.city.json")
    assert ts.read(path).crs == crs


@pytest.mark.parametrize(
    ("version", "system"),
    [
        ("2.0", "https://www.opengis.net/def/crs/EPSG/0/32616"),
        ("1.1", "http://www.opengis.net/def/crs/EPSG/0/32616"),
        ("1.0", "urn:ogc:def:crs:EPSG::32616"),
        ("1.0.1", "EPSG:32616"),
    ],
)
def test_versions_and_their_names_of_the_crs(tmp_path, version, system):
    tin = read(tmp_path, {"version": version, "metadata": {"referenceSystem": system}})
    assert tin.crs == "EPSG:32616"
    assert tin.points[2].tolist() == [745004.0, 4033003.0, 107.0]


def test_vertices_without_transform(tmp_path):
    city = {name: value for name, value in CITY.items() if name != "transform"}
    path = tmp_path / "a.json"
    path.write_text(json.dumps({**city, "version": "1.0"}))
    assert ts.read(path).area == 120_000


def test_several_terrains_are_chosen_or_joined(tmp_path):
    def part(*triangle):
        shape = {"type": "CompositeSurface", "lod": 1, "boundaries": [[list(triangle)]]}
        return {"type": "TINRelief", "geometry": [shape]}

    several = {"CityObjects": {"a": part(0, 1, 2), "b": part(0, 2, 3), "c": {"type": "Building"}}}
    with pytest.raises(ts.ReadError, match=r"2 objects TINRelief \('a', 'b'\)"):
        read(tmp_path, several)
    assert read(tmp_path, several, surface="b").area == 6
    joined = read(tmp_path, several, join=True)
    assert (joined.area, len(joined.points)) == (12, 4)
    with pytest.raises(ts.ReadError, match="no TINRelief 'x'"):
        read(tmp_path, several, surface="x")


def test_the_finest_level_of_detail_is_read_and_told(tmp_path):
    coarse = {"type": "CompositeSurface", "lod": "0", "boundaries": [[[0, 1, 3]]]}
    both = {"type": "TINRelief", "geometry": [*RELIEF["geometry"], coarse]}
    tin = read(tmp_path, {"CityObjects": {"g": both}})
    assert tin.area == 12
    assert "2 levels of detail: 1 was read" in tin.report.notes[0]


def test_polygons_are_cut_and_told(tmp_path):
    shape = {"type": "CompositeSurface", "lod": "1", "boundaries": [[[0, 1, 2, 3]]]}
    tin = read(tmp_path, {"CityObjects": {"g": {"type": "TINRelief", "geometry": [shape]}}})
    assert tin.area == 12
    assert "1 polygon" in tin.report.notes[0]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"version": "3.0"}, "version '3.0': 1.0, 1.1, 2.0 are read"),
        ({"CityObjects": {}}, "holds no TINRelief"),
        ({"CityObjects": []}, "has no CityObjects"),
        ({"CityObjects": {"g": {"type": "TINRelief"}}}, "no CompositeSurface"),
        ({"vertices": [[0, 0]]}, "no list of three numbers"),
        ({"vertices": "x"}, "no list of three numbers"),
        ({"vertices": [[0, 0, 1e400], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}, "not finite|no TIN"),
        ({"transform": {"scale": [1, 1]}}, "transform has no scale"),
        ({"vertices": [[0, 0, 0]]}, "names vertex 1"),
    ],
)
def test_damaged_files(tmp_path, changes, sentence):
    with pytest.raises(ts.ReadError, match=sentence):
        read(tmp_path, changes)


@pytest.mark.parametrize("boundaries", [[[0, 1, 2]], [[[0, 1, 2], [0, 1, 2]]], [[[0, 1, "a"]]], 7,
                                        [[[0, 1, True]]], [[[0, 1, -1]]], None])  # fmt: skip
def test_damaged_boundaries(tmp_path, boundaries):
    shape = {"type": "CompositeSurface", "lod": "1", "boundaries": boundaries}
    with pytest.raises(ts.ReadError):
        read(tmp_path, {"CityObjects": {"g": {"type": "TINRelief", "geometry": [shape]}}})


@pytest.mark.parametrize("text", ['{"type":"CityJSON"', '{"type":"CityJSON","a":' + "[" * 99999])
def test_no_json(tmp_path, text):
    path = tmp_path / "a.city.json"
    path.write_text(text)
    with pytest.raises(ts.ReadError, match="no JSON"):
        ts.read(path)
