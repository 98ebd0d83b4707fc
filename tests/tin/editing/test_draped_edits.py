"""Draped breaklines added to a TIN, as given to a fresh build."""

from __future__ import annotations

import numpy as np

import tinsmith as ts


def test_a_draped_line_that_leaves_the_hull_twice_is_added_in_its_parts():
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.integers(0, 101, (60, 2)), rng.integers(0, 9, 60)]).astype(float)
    corners = [[0, 0, 1], [100, 0, 2], [100, 100, 3], [0, 100, 4.0]]
    points = np.unique(np.vstack([points, corners]), axis=0)
    line = [[10, 10], [-20, 30], [10, 50], [-20, 70], [10, 90]]
    fresh = ts.triangulate(points, breaklines=[ts.Breakline(line)], duplicates="first")
    tin = ts.triangulate(points, duplicates="first")
    tin.add_breakline(line)
    chains = [tin.points[chain].tolist() for chain in tin.lines.chains()]
    assert len(chains) == 3
    for chain in chains:
        assert chain[0][0] == 0.0 or chain[0][:2] == [10, 10]
        assert chain[-1][0] == 0.0 or chain[-1][:2] == [10, 90]
    assert chains == [fresh.points[chain].tolist() for chain in fresh.lines.chains()]
    ts.check(tin).raise_if_failed()
