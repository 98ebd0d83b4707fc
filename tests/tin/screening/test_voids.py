"""Filled voids are told from lakes and from the sea."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.inspection.findings import list_wrong_rows, screen
from tinsmith.tin.screening import describe_findings
from tinsmith.tin.screening.voids import find_voids

COUNT = 60


def hills(level=500.0, relief=150.0):
    x, y = np.meshgrid(np.arange(COUNT) * 30.0, np.arange(COUNT) * 30.0)
    z = level + relief * np.sin(x / 400) * np.cos(y / 300)
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()])


def is_block(points, west, south, size):
    x, y = points[:, 0] / 30.0, points[:, 1] / 30.0
    return (x >= west) & (x < west + size) & (y >= south) & (y < south + size)


@pytest.mark.parametrize("value", [0.0, 9999.0, -99.0])
def test_each_filled_void_is_found_with_the_ground_around_it(value):
    points = hills()
    first, second = is_block(points, 10, 10, 12), is_block(points, 40, 35, 5)
    points[first | second, 2] = value
    found = find_voids(ts.triangulate(points).triangulation)
    assert [one.value for one in found] == [value] * 2
    assert [set(one.vertices.tolist()) for one in found] == [
        set(np.flatnonzero(first).tolist()),
        set(np.flatnonzero(second).tolist()),
    ]
    assert all(330 < one.lowest < one.highest < 670 for one in found)


def test_a_void_of_0_is_told_as_doubtful_and_not_dropped():
    """The range of the hills is larger than the gap to 0: as a code it is not suspicious."""
    points = hills(350.0, 240.0)
    points[is_block(points, 20, 20, 8), 2] = 0.0
    tin = ts.triangulate(points)
    for table in (ts.blunders(tin), screen(tin)):
        assert table["reason"].tolist() == ["void"]
        assert table["certainty"].tolist() == ["medium"]
        assert table["explanation"][0].startswith(
            "64 points that lie together have the elevation 0"
        )
        assert len(list_wrong_rows(table)) == 0
    (note,) = describe_findings(tin)
    assert note.startswith("64 points that lie together")


def sea(points):
    points[:, 2] = np.maximum(points[:, 2], 0.0)
    return points


NO_VOIDS = {
    "hills": hills(),
    "sea beside a coast": sea(hills(40.0)),
    "a lake at 0 in a basin": sea(hills(145.0)),
    "flat": hills(0.0, 0.0),
    "steps of 3 m from a floor at 0": np.floor(hills(150.0) / [1, 1, 3.0]) * [1, 1, 3.0],
}


@pytest.mark.parametrize("kind", NO_VOIDS)
def test_ground_that_comes_near_the_water_has_no_void(kind):
    assert find_voids(ts.triangulate(NO_VOIDS[kind]).triangulation) == []


def test_an_excavation_with_a_floor_of_less_than_four_points_is_none():
    points = hills()
    points[np.flatnonzero(is_block(points, 10, 10, 2))[:3], 2] = 0.0
    assert find_voids(ts.triangulate(points).triangulation) == []
