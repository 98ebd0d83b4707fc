"""Surveys inserted into a TIN: their points, breaklines and attributes, and those that it has."""

import copy
import json
import pickle

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.editing.history import apply_edits

KNOWN = {"crs": "EPSG:32616", "elevation_unit": "m"}
KERB = ts.Breakline([[10, 10, 3], [50, 60, 4], [90, 95, 5]], name="kerb", priority=2)
DITCH = ts.Breakline([[5, 90, 1], [95, 85, 2]], name="ditch", kind="soft")
ACROSS = ts.Breakline([[50, 95], [50, 70]], name="draped")


def make_survey(count, seed, lines=(), **columns):
    xy = np.random.default_rng(seed).random((count, 2)) * 100
    return ts.Survey(
        points=np.column_stack([xy, xy[:, 0] / 10]),
        attributes={"number": np.arange(count) + 1000 * seed, **columns},
        breaklines=lines,
        **KNOWN,
    )


BASE = make_survey(200, 1, [DITCH])
EXTRA = make_survey(30, 2, [KERB, ACROSS], code=np.array(["GR"] * 30))


def build_together():
    points = np.concatenate([BASE.points, EXTRA.points])
    lines = [*BASE.breaklines, *EXTRA.breaklines]
    return ts.triangulate(ts.Survey(points=points, breaklines=lines, **KNOWN))


@pytest.fixture
def tin():
    made = ts.triangulate(BASE)
    made.insert(EXTRA)
    return made


def test_the_result_is_the_build_of_all_points_and_lines(tin):
    whole = build_together()
    np.testing.assert_array_equal(tin.points, whole.points)
    np.testing.assert_array_equal(tin.triangles, whole.triangles)
    assert tin.lines.is_same(whole.lines)
    assert ts.check(tin).ok
    assert any("crosses breakline 0 'ditch'" in note for note in tin.edits[0].notes)


def test_attributes_of_both_are_kept(tin):
    own, new = tin.vertex_of[:200], tin.vertex_of[200:]
    np.testing.assert_array_equal(tin.attributes["number"][own], BASE.attributes["number"])
    np.testing.assert_array_equal(tin.attributes["number"][new], EXTRA.attributes["number"])
    assert set(tin.attributes["code"][own]) == {""}
    assert set(tin.attributes["code"][new]) == {"GR"}
    assert len(tin.row_attributes["number"]) == 230


def test_it_is_one_edit_and_is_taken_back(tin):
    assert [edit.operation for edit in tin.edits] == ["insert"]
    tin.undo()
    assert tin == ts.triangulate(BASE)
    tin.insert([[50.5, 50.5, 9.0]])
    assert np.isnan(tin.attributes["number"][tin.vertex_of[-1]])


def test_other_edits_may_follow(tin):
    tin.set_elevation([len(tin.points) - 1], [9.0])  # of a vertex of a line, which becomes a row
    tin.remove([5])
    tin.insert(make_survey(3, 7))
    np.testing.assert_array_equal(tin.attributes["number"][tin.vertex_of[-3:]], [7000, 7001, 7002])
    new = tin.vertex_of[200:230]
    np.testing.assert_array_equal(tin.attributes["number"][new], EXTRA.attributes["number"])


COPIES = {
    "copy": copy.copy,
    "pickle": lambda tin: pickle.loads(pickle.dumps(tin)),
    "notes": lambda tin: tin.with_notes(["Looked at."]),
    "snapshot": lambda tin: tin.snapshot().to_tin(),
}


@pytest.mark.parametrize("name", COPIES)
def test_copies_keep_it_and_take_it_back(tin, name):
    made = COPIES[name](tin)
    assert made == tin
    made.undo()
    assert made == ts.triangulate(BASE)


def test_a_file_keeps_it_and_takes_it_back(tin, tmp_path):
    read = ts.read(ts.write(tin, tmp_path / "site.gpkg"))
    assert read == tin
    read.undo()
    assert read == ts.triangulate(BASE)


def test_the_record_does_it_again(tin):
    again = ts.triangulate(BASE)
    apply_edits(again, json.loads(json.dumps([edit.to_dict() for edit in tin.edits])))
    assert again == tin


def test_moved_and_clipped_surfaces_keep_the_attributes(tin):
    moved = tin.transform(lambda points: np.add(points, [0.0, 5.0, 0.0]), crs="EPSG:32616")
    np.testing.assert_array_equal(moved.attributes["number"], tin.attributes["number"])
    part = ts.clip(tin, [[[20, 20], [80, 20], [50, 80]]])
    assert "GR" in part.attributes["code"]


def test_elevations_are_converted_and_lines_with_them():
    tin = ts.triangulate(BASE)
    in_feet = ts.Survey(
        points=EXTRA.points / [1, 1, 0.3048],
        breaklines=[ts.Breakline(KERB.coords / [1, 1, 0.3048], name="kerb", priority=2), ACROSS],
        crs="EPSG:32616",
        elevation_unit="ft",
    )
    tin.insert(in_feet)
    np.testing.assert_allclose(tin.points, build_together().points, atol=1e-12)


def test_given_columns_and_lines_come_with_plain_points():
    tin = ts.triangulate(BASE)
    new = tin.insert(
        EXTRA.points, attributes=EXTRA.attributes, breaklines=[KERB, {"coords": ACROSS.coords}]
    )
    assert tin.lines.names == ("ditch", "kerb", "")
    assert set(tin.attributes["code"][new]) == {"GR"}


REFUSED = {
    "a boundary": (
        {"points": ts.Survey(points=[[5, 5, 1]], boundary=[KERB.coords], crs="EPSG:32616")},
        ts.LinesError,
        "survey has boundary",
    ),
    "another CRS": (
        {"points": ts.Survey(points=[[5, 5, 1]], crs="EPSG:32617")},
        ts.CrsError,
        "EPSG:32617",
    ),
    "too few values": (
        {"points": [[5, 5, 1]], "attributes": {"number": [1, 2]}},
        ts.OptionError,
        "attribute 'number'",
    ),
    "a line that is none": (
        {"points": [[5, 5, 1]], "breaklines": [{"coords": [[1, 1, 1]]}]},
        ts.LinesError,
        "k >= 2",
    ),
    "an unknown word": (
        {"points": [[5, 5, 1]], "breaklines": [{"coords": KERB.coords, "colour": "red"}]},
        ts.LinesError,
        "coords are needed",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_inserted_changes_nothing(name):
    given, error, sentence = REFUSED[name]
    tin = ts.triangulate(BASE)
    with pytest.raises(error, match=sentence):
        tin.insert(**given)
    assert tin.edits == ()
    assert tin == ts.triangulate(BASE)
