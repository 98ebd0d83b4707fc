"""Where a surface with lines ends, from its lines and hull alone: as the whole has it."""

from __future__ import annotations

import numpy as np
import pytest
from support.tiled import node_all, sum_areas

import tinsmith as ts
from tinsmith.tin.tiling import NumberedPoints, find_outline

POINTS = np.random.default_rng(1).random((400, 3)) * [100, 80, 9]


def box(west, south, east, north):
    return [[west, south, 1.0], [east, south, 2.0], [east, north, 3.0], [west, north, 4.0]]


LINES = {
    "breaklines": {"breaklines": [[[-5, 40, 1], [60, 41, 2]], [[20, 0, 3], [20, 90, 3]]]},
    "boundary": {"boundary": [box(10, 10, 70, 70)]},
    "boundary beyond the points": {"boundary": [box(-10, -10, 50, 120)]},
    "holes": {"holes": [box(30, 30, 50, 50), box(60, 10, 120, 40)]},
    "a breakline outside the boundary": {
        "boundary": [box(10, 10, 40, 40)],
        "breaklines": [[[60, 60, 1], [70, 70, 1]]],
    },
}


@pytest.mark.parametrize("kind", LINES)
def test_the_outline_is_that_of_the_whole(kind):
    lines = LINES[kind]
    whole = ts.triangulate(POINTS, **lines)
    rows = NumberedPoints(POINTS, np.arange(len(POINTS)))
    found = find_outline(rows, node_all(POINTS, **lines))
    rim = np.unique(np.concatenate(whole.rings))
    assert sorted(map(tuple, found.rim[:, :2])) == sorted(map(tuple, whole.points[rim, :2]))
    assert found.bounds == whole.bounds
    assert found.area == sum_areas(whole.points[whole.triangles])
    assert found.is_clipped == (kind != "breaklines")
    assert found.has_inner_lines == (whole.constrained & (whole.neighbors >= 0)).any()


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ({"boundary": [box(10, 10, 40, 40)], "holes": [box(60, 60, 70, 70)]}, "Hole 0 lies out"),
        ({"boundary": [box(10, 10, 40, 40)], "holes": [box(5, 5, 45, 45)]}, "leave no triangle"),
    ],
)
def test_rings_that_leave_nothing_are_refused_as_in_memory(lines, message):
    with pytest.raises(ts.LinesError, match=message):
        ts.triangulate(POINTS, **lines)
    rows = NumberedPoints(POINTS, np.arange(len(POINTS)))
    with pytest.raises(ts.LinesError, match=message):
        find_outline(rows, node_all(POINTS, **lines))
