"""CityJSONSeq: features on lines of their own, each with its own vertices."""

from __future__ import annotations

import json

import pytest

import tinsmith as ts

FIRST = {
    "type": "CityJSON",
    "version": "2.0",
    "CityObjects": {},
    "vertices": [],
    "transform": {"scale": [0.01, 0.01, 0.1], "translate": [745000.0, 4033000.0, 100.0]},
    "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/32616"},
}


def feature(name, east=0, *, kind="TINRelief", faces=((0, 1, 2), (0, 2, 3))):
    """Return a square of two triangles, its west side at an easting in centimetres."""
    shape = {"type": "CompositeSurface", "lod": "1", "boundaries": [[list(one)] for one in faces]}
    plane = [(east, 0), (east + 400, 0), (east + 400, 300), (east, 300)]
    corners = [[x, y, 50 + x // 100 + y // 10] for x, y in plane]
    return {
        "type": "CityJSONFeature",
        "id": name,
        "CityObjects": {name: {"type": kind, "geometry": [shape]}},
        "vertices": corners,
    }


def write(tmp_path, *rows, name="a.city.jsonl", separator="\n", begin=""):
    path = tmp_path / name
    texts = [one if isinstance(one, str) else json.dumps(one) for one in rows]
    path.write_text(separator.join(begin + text for text in texts) + separator)
    return path


@pytest.mark.parametrize("name", ["a.city.jsonl", "a.jsonl", "a.city.json", "a.txt"])
@pytest.mark.parametrize(
    ("separator", "begin"), [("\n", ""), ("\r\n", ""), ("\n\n", ""), ("\n", "\x1e")]
)
def test_a_feature_is_read(tmp_path, name, separator, begin):
    path = write(tmp_path, FIRST, feature("ground"), name=name, separator=separator, begin=begin)
    tin = ts.read(path)
    assert tin.crs == "EPSG:32616"
    assert tin.points[:, :2].tolist() == [
        [745000, 4033000], [745004, 4033000], [745004, 4033003], [745000, 4033003]
    ]  # fmt: skip
    assert tin.points[:, 2].tolist() == [105.0, 105.4, 108.4, 108.0]
    assert len(tin.triangles) == 2


def test_features_have_vertices_of_their_own(tmp_path):
    rows = [feature("west"), feature("house", 50, kind="Building"), feature("east", 400)]
    path = write(tmp_path, FIRST, *rows)
    with pytest.raises(ts.ReadError, match=r"2 objects TINRelief .*join them"):
        ts.read(path)
    assert ts.read(path, surface="east").bounds.xmin == 745004
    whole = ts.read(path, join=True)
    assert (len(whole.triangles), whole.area) == (4, 24)
    assert ts.check(whole, level=2).ok


def test_objects_of_the_first_line_keep_their_vertices(tmp_path):
    own = feature("own", 400)
    first = {**FIRST, "CityObjects": own["CityObjects"], "vertices": own["vertices"]}
    path = write(tmp_path, first, feature("further"))
    assert ts.read(path, surface="own").bounds.xmin == 745004
    assert ts.read(path, surface="further").bounds.xmin == 745000


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (["{"], "line 2 is no JSON"),
        ([feature("a"), "[1]"], "line 3 is no JSON object"),
        ([feature("a"), {**feature("b"), "type": "Feature"}], "line 3 is no CityJSONFeature"),
        ([feature("a"), feature("a")], "line 3 has the object 'a', which is there"),
        ([{**feature("a"), "vertices": None}], "line 2 has no vertices"),
        ([{**feature("a"), "CityObjects": 3}], "line 2 has no CityObjects"),
        ([feature("a", faces=[(0, 1, 4)]), feature("b")], "vertex that its feature does not have"),
    ],
)
def test_damaged_sequences_are_refused_by_the_line(tmp_path, rows, words):
    with pytest.raises(ts.ReadError, match=words):
        ts.read(write(tmp_path, FIRST, *rows), join=True)


def test_a_damaged_file_of_many_lines_is_told_where(tmp_path):
    text = json.dumps(FIRST, indent=1).replace('"metadata"', "metadata")
    line = next(k for k, one in enumerate(text.split("\n"), 1) if "metadata" in one)
    with pytest.raises(ts.ReadError, match=f"line {line} is no JSON"):
        ts.read(write(tmp_path, text, name="a.city.json"))
