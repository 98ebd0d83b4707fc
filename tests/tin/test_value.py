"""A TIN as a value: its length, equality, copies, and another CRS."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import tinsmith as ts

POINTS = np.random.default_rng(2).random((30, 3)) * 10
LINE = POINTS[:2]


def build(**changes):
    given = {
        "points": POINTS,
        "attributes": {"n": np.arange(30.0), "t": ["a"] * 30},
        "crs": "EPSG:32616",
        "elevation_unit": "m",
        "breaklines": [ts.Breakline(LINE, name="a")],
    }
    return ts.triangulate(ts.Survey(**(given | changes)))


@pytest.mark.parametrize(
    "take", [ts.TIN.copy, copy.copy, copy.deepcopy, lambda tin: pickle.loads(pickle.dumps(tin))]
)
def test_copies_are_equal_until_one_is_edited(take):
    tin = build()
    other = take(tin)
    assert other is not tin
    assert (other == tin, other != tin, len(other)) == (True, False, len(tin.triangles))
    other.insert([[5.0, 5.0, 3.0]])
    assert other != tin
    other.undo()
    assert other == tin
    assert tin.copy().edits == tin.edits


def test_an_edited_tin_equals_the_fresh_build():
    tin = build(points=POINTS[:-1], attributes={})
    tin.insert(POINTS[-1:])
    assert tin == build(attributes={})


@pytest.mark.parametrize(
    "changes",
    [
        {"points": np.nextafter(POINTS, np.inf)},
        {"attributes": {"n": np.arange(30.0), "t": ["b"] * 30}},
        {"attributes": {"n": np.arange(30), "t": ["a"] * 30}},
        {"attributes": {}},
        {"crs": None},
        {"elevation_unit": "ft"},
        {"breaklines": []},
        {"breaklines": [ts.Breakline(LINE, name="b")]},
        {"breaklines": [ts.Breakline(LINE, name="a", kind="soft")]},
    ],
)
def test_what_differs_is_not_equal(changes):
    assert build(**changes) != build()


def test_missing_values_of_attributes_are_the_same():
    values = {"n": np.where(np.arange(30) % 2, np.nan, 1.0)}
    assert build(attributes=values) == build(attributes=values)


def test_other_things_are_not_equal_and_a_tin_has_no_hash():
    tin = build()
    assert tin != 5
    assert tin is not None
    assert tin not in (None, [], "a")
    with pytest.raises(TypeError, match="unhashable"):
        hash(tin)


def test_to_crs_is_reproject():
    tin = ts.triangulate(np.add(POINTS, [751_428, 4_020_862, 0]), crs="EPSG:32616")
    assert tin.to_crs("EPSG:32617") == ts.reproject(tin, "EPSG:32617")
    assert tin.to_crs(2274, elevation_unit="m").elevation_unit.name == "US survey foot"
    with pytest.raises(ts.CrsError, match="not known"):
        ts.triangulate(POINTS).to_crs("EPSG:32617")


def test_one_place_gives_a_number_and_two_arrays_their_shape():
    tin = ts.triangulate(POINTS)
    x, y = np.random.default_rng(1).random((2, 4, 5)) * 10
    places = np.stack([x, y], axis=-1)
    for method in ("linear", "natural", "nearest"):
        wanted = tin.interpolate(places.reshape(-1, 2), method=method).reshape(4, 5)
        np.testing.assert_array_equal(tin.interpolate(x, y, method=method), wanted)
    one = tin.interpolate(5.0, 5.0)
    assert type(one) is float
    assert one == tin.interpolate([[5.0, 5.0]])[0]
    assert np.isnan(tin.interpolate(-5.0, 5.0))
    assert tin.interpolate([], []).shape == (0,)
    np.testing.assert_array_equal(tin.interpolate(x[0], 5.0), tin.interpolate(x[0], [5.0] * 5))


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [
        ([1, 2], [1, 2, 3], r"x of shape \(2,\) and y of shape \(3,\)"),
        (["a"], [1], "no table of real numbers"),
        ([[1.0, 2.0]], [1.0, 2.0, 3.0], "x of shape"),
        (np.ma.array([1.0], mask=[True]), [1.0], "masked"),
        (np.inf, 1.0, "infinite|not finite|range"),
    ],
)
def test_coordinates_that_do_not_fit_are_refused(x, y, words):
    with pytest.raises(ts.PointsError, match=words):
        ts.triangulate(POINTS).interpolate(x, y)


def test_files_of_the_other_kind_are_refused(tmp_path):
    tin = build()
    surface, points = ts.write(tin, tmp_path / "a.gpkg"), tmp_path / "b.csv"
    ts.write(ts.Survey(points=POINTS), points)
    assert ts.read_tin(surface) == tin
    assert len(ts.read_points(points)) == 30
    with pytest.raises(ts.ReadError, match="holds a TIN, not points alone"):
        ts.read_points(surface)
    with pytest.raises(ts.ReadError, match="points alone, no TIN"):
        ts.read_tin(points)


@pytest.mark.parametrize(
    ("rows", "why", "option"),
    [({}, "trimmed", "rows"), ([0.5], "trimmed", "rows"), ([0], "lost", "why"), ([0], [], "why")],
)
def test_another_reason_is_of_rows_and_one_that_reports_give(rows, why, option):
    with pytest.raises(ts.OptionError, match=f"^Invalid {option} "):
        build().with_reason(rows, why)


@pytest.mark.parametrize("notes", ["a note", 2.0, None, ["a note", 2]])
def test_notes_are_a_sequence_of_texts(notes):
    with pytest.raises(ts.OptionError, match=r"^Invalid notes .* a sequence of texts"):
        build().with_notes(notes)
