"""Attributes of a TIN: the columns of a survey at the vertices, through edits, copies and files."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import numpy as np
import pytest
from support.each_value import list_seeds

import tinsmith as ts

N = 60
SITE = np.array([500_000.0, 4_000_000.0, 0.0])


def make_survey(seed, n=N):
    rng = np.random.default_rng(seed)
    points = np.floor(rng.random((n, 3)) * 12) if seed % 2 else rng.random((n, 3)) * 100
    points[:4] = [[0, 0, 1], [100, 0, 2], [100, 100, 3], [0, 100, 4]]
    columns = {
        "number": np.arange(n) + 1,
        "code": [f"EP{i}" for i in range(n)],
        "weight": np.arange(n) / 4,
        "seen": np.arange(n) % 2 == 0,
        "mixed": np.array([None, 7, "x"] * (n // 3), object),
    }
    return ts.Survey(points=points, attributes=columns, crs="EPSG:32616")


def require_columns(tin):
    """Compare each value with that of the first row of the vertex, found by a plain loop."""
    first = {}
    for row, vertex in enumerate(tin.vertex_of.tolist()):
        first.setdefault(vertex, row)
    for name, column in tin.attributes.items():
        given = tin.row_attributes[name].tolist()
        empty = "" if tin.row_attributes[name].dtype.kind == "U" else None
        assert len(column) == len(tin.points)
        assert not column.flags.writeable
        for vertex, value in enumerate(column.tolist()):
            row = first.get(vertex, N * 9)
            wanted = given[row] if row < len(given) else empty
            is_nan = value != value
            assert value == wanted or (is_nan and (wanted is None or wanted != wanted))


@pytest.mark.parametrize("seed", list_seeds(8, few=3))
def test_values_follow_their_rows_through_edits(seed):
    rng = np.random.default_rng(seed)
    cross = [[[0, 1, 5], [100, 99, 5]], [[1, 99], [99, 1]]] if seed % 3 else []
    tin = ts.triangulate(make_survey(seed), breaklines=cross)
    require_columns(tin)
    for _ in range(12):
        before, count = tin.attributes["code"].tolist(), len(tin.edits)
        try:
            match rng.integers(4):
                case 0:
                    tin.insert(rng.random((2, 3)) * 100)
                case 1:
                    tin.remove(int(rng.integers(len(tin.points))))
                case 2:
                    tin.move(int(rng.integers(len(tin.points))), rng.random(3) * 100)
                case 3 if count:
                    tin.undo()
        except ts.TinsmithError:
            assert tin.attributes["code"].tolist() == before
        require_columns(tin)
    for other in (copy.copy(tin), copy.deepcopy(tin), pickle.loads(pickle.dumps(tin))):
        require_columns(other)
        other.insert([[50.5, 50.25, 9.0]])
        require_columns(other)
    require_columns(tin.replace(crs=None))
    moved = tin.transform(lambda points: points + SITE, crs="EPSG:32616")
    require_columns(moved)
    assert sorted(moved.attributes["code"]) == sorted(tin.attributes["code"])
    require_columns(ts.reproject(moved, "EPSG:32617"))
    refined = ts.refine(moved)
    assert refined.attributes["code"][: len(moved.points)].tolist() == (
        moved.attributes["code"].tolist()
    )
    require_columns(refined)


def test_merged_rows_have_the_value_of_the_first():
    points = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 0, 9], [4, 0, 1]]
    survey = ts.Survey(points=points, attributes={"number": [10, 11, 12, 13, 14]})
    tin = ts.triangulate(survey, duplicates="last")
    assert tin.points[:, 2].tolist() == [9, 1, 7]
    assert tin.attributes["number"].tolist() == [10, 11, 12]
    assert tin.attributes["number"].dtype == np.int64


def test_vertices_that_lines_made_have_none():
    square = [[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]]
    columns = {
        "number": [1, 2, 3, 2**60],
        "small": [1, 2, 3, 4],
        "code": ["a", "b", "c", "d"],
        "at": np.array(["2026-11-22"] * 4, "M8[D]"),
        "real": np.arange(4, dtype=np.float32),
    }
    lines = [[[0, 0, 5], [4, 4, 7]], [[4, 0, 6], [0, 4, 8]]]
    survey = ts.Survey(points=square, attributes=columns)
    found = ts.triangulate(survey, breaklines=lines).attributes
    assert found["number"].tolist() == [1, 2, 3, 2**60, None]
    assert found["small"].dtype == np.float64
    assert np.isnan(found["small"][4])
    assert found["code"].tolist() == ["a", "b", "c", "d", ""]
    assert np.isnat(found["at"][4])
    assert found["real"].dtype == np.float32
    assert np.isnan(found["real"][4])


def test_a_tin_without_attributes_has_none_and_one_of_triangles_takes_them():
    corners, triangle = [[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]]
    tin = ts.TIN.from_triangles(corners, triangle)
    assert dict(tin.attributes) == tin.row_attributes == {}
    tin = ts.TIN.from_triangles(corners, triangle, attributes={"code": ["a", "b", "c"]})
    assert tin.attributes["code"].tolist() == ["a", "b", "c"]
    assert tin.replace(row_attributes={"code": ["a"]}).attributes["code"].tolist() == ["a", "", ""]
    for wrong in ({"code": ["a", "b"]}, {"code": "abc"}, [1]):
        with pytest.raises(ts.OptionError):
            ts.TIN.from_triangles(corners, triangle, attributes=wrong)
    with pytest.raises(ts.OptionError, match="up to 3 values, one for each row"):
        tin.replace(row_attributes={"code": ["a"] * 4})


def test_masked_and_erased_rows_do_not_shift_values():
    points = np.array([[0, 0, 5], [4, 0, 6], [2, 2, 9], [4, 4, 7], [0, 4, 8.0]])
    mask = np.zeros((5, 3), bool)
    mask[1] = True
    survey = ts.Survey(
        points=np.ma.array(points, mask=mask), attributes={"number": [1, 2, 3, 4, 5]}
    )
    assert ts.triangulate(survey).attributes["number"].tolist() == [1, 3, 4, 5]
    ring = [[1, 1], [3, 1], [3, 3], [1, 3]]
    survey = ts.Survey(points=points, attributes={"number": [1, 2, 3, 4, 5]})
    assert ts.triangulate(survey, erase=[ring]).attributes["number"].tolist() == [1, 2, 4, 5]


@pytest.mark.parametrize("name", ["a.ply", "a.geojson", "a.fgb", "a.gpkg", "a.parquet", "a.shp"])
def test_attributes_of_vertices_go_through_files(name, tmp_path):
    given = make_survey(2)
    wanted = dataclasses.replace(given, points=given.points * [0.01, 0.01, 1] + SITE)
    tin = ts.triangulate(wanted)
    options = {} if name.endswith(("ply", "gpkg")) else {"kind": "points"}
    path = ts.write(tin, tmp_path / name, **options)
    found = ts.read(path, crs="EPSG:32616")
    if name == "a.fgb":  # sorted in space
        order = np.argsort(found.attributes["id"])
        found = dataclasses.replace(
            found,
            points=found.points[order],
            attributes={key: column[order] for key, column in found.attributes.items()},
        )
    assert found.attributes["number"].tolist() == tin.attributes["number"].tolist()
    assert found.attributes["weight"].tolist() == tin.attributes["weight"].tolist()
    if name != "a.ply":
        assert found.attributes["code"].tolist() == tin.attributes["code"].tolist()


def test_numbers_beyond_64_bits_are_text_in_geojson(tmp_path):
    survey = dataclasses.replace(
        make_survey(2), attributes={"large": [2**63 + k for k in range(N)], "small": [7] * N}
    )
    survey = dataclasses.replace(survey, points=survey.points + SITE)
    path = ts.write(survey, tmp_path / "a.geojson")
    found = ts.read(path, crs="EPSG:32616").attributes
    assert found["large"][1] == str(2**63 + 1)
    assert found["small"].tolist() == [7] * N
