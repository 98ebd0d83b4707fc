"""The map of suspicious points: where marks stand, and what is told in words."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts


def make():
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.random((400, 2)) * 100, 300 + rng.normal(0, 0.02, 400)])
    points[10, 2] += 5.0
    points[20, 2] -= 5.0
    points[30, 0] += 4_000.0
    tin = ts.triangulate(points)
    return tin, ts.blunders(tin)


def test_marks_stand_at_their_points_and_what_is_beyond_is_told():
    tin, table = make()
    axes = ts.blunder_map(tin, table).axes[0]
    marked = np.concatenate([one.get_offsets() for one in axes.collections])
    assert {tuple(place) for place in marked} == {tuple(tin.points[v, :2]) for v in (10, 20)}
    assert axes.get_title(loc="left") == "3 findings, 1 beyond the map"
    assert axes.get_xlim()[1] < 200
    assert {text.get_text() for text in axes.texts} >= {"10", "20"}
    labels = {text.get_text() for text in axes.get_legend().get_texts()}
    assert labels == {"spike, high", "pit, high"}


def test_none_found_is_said():
    points = np.random.default_rng(1).random((50, 3))
    tin = ts.triangulate(points)
    assert ts.blunder_map(tin, ts.blunders(tin)).axes[0].get_title(loc="left") == "None found."


def test_another_table_is_refused():
    tin, _ = make()
    with pytest.raises(ts.OptionError, match=r"one of ts\.blunders"):
        ts.blunder_map(tin, ts.Table({"level": [1.0]}))
