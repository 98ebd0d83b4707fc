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
    assert tin.to_crs(2274, z_unit="m").elevation_unit.name == "US survey foot"
    with pytest.raises(ts.CrsError, match="not known"):
        ts.triangulate(POINTS).to_crs("EPSG:32617")
