"""Surfaces with lines, boundaries and holes, part by part: those of the whole."""

from __future__ import annotations

import numpy as np
import pytest
from support.tiled import divide, make_inputs, node_all, require_triangles_of_the_whole

import tinsmith as ts
from tinsmith.base.errors import LinesError, OptionError
from tinsmith.tin.tiling.boxes import widen
from tinsmith.tin.tiling.draping import Draping, KnownTriangles, find_rim
from tinsmith.tin.tiling.lines import node_lines, require_local
from tinsmith.tin.tiling.local_triangulation import triangulate_box
from tinsmith.tin.tiling.sources import NumberedPoints


def rng(seed=0):
    return np.random.default_rng(seed)


def lift(xy, seed=0):
    return np.column_stack([xy, rng(seed).random(len(xy)) * 50])


def walk(seed, steps=40, size=1000.0):
    """Return a line that wanders over all tiles."""
    turns = np.cumsum(rng(seed).normal(0, 0.5, steps)) + rng(seed + 50).random() * 6
    xy = np.cumsum(np.column_stack([np.cos(turns), np.sin(turns)]), axis=0) * size / 25
    return lift((xy - xy.mean(axis=0)) + size / 2, seed)


def ring(center, radius, corners=24, seed=0):
    angles = 2 * np.pi * np.arange(corners) / corners
    return lift(center + radius * np.column_stack([np.cos(angles), np.sin(angles)]), seed)


CLOUD = lift(rng(1).random((1500, 2)) * 1000)
LATTICE = lift(np.stack(np.meshgrid(np.arange(24.0), np.arange(24.0)), axis=-1).reshape(-1, 2), 2)
SPARSE = lift(np.concatenate([rng(3).random((300, 2)) * 200, rng(4).random((300, 2)) * 200 + 800]))

SURVEYS = {
    "wandering lines": (CLOUD, {"breaklines": [walk(k) for k in range(6)]}),
    "one line from end to end": (CLOUD, {"breaklines": [[[-50, 480, 1], [1040, 520, 2]]]}),
    "lines along the borders of tiles": (
        CLOUD,
        {"breaklines": [[[x, 0, x], [x, 1000, x]] for x in (250.0, 500.0, 750.0)]},
    ),
    "a fan of lines in one vertex": (
        CLOUD,
        {
            "breaklines": [
                [[500, 500, 9], [500 + 490 * c, 500 + 490 * s, 1]]
                for c, s in np.column_stack([np.cos(np.arange(15)), np.sin(np.arange(15))])
            ]
        },
    ),
    "lines through points of a lattice": (
        LATTICE,
        {
            "breaklines": [
                [[0, 0, 5], [23, 23, 5]],
                [[0, 7, 1], [23, 7, 2]],
                [[1, 3, 0], [21, 13, 0]],
            ]
        },
    ),
    "lines that end between points of a lattice": (
        LATTICE,
        {"breaklines": [[[0.5, 0.5, 5], [11.5, 18.5, 5]], [[11.5, 0.25, 1], [11.5, 22.75, 2]]]},
    ),
    "lines over a void": (SPARSE, {"breaklines": [[[100, 100, 1], [900, 900, 2]], walk(7)]}),
    "points beside a long line": (
        lift(np.column_stack([rng(5).random(800) * 1000, 500 + rng(6).random(800) * 100])),
        {"breaklines": [[[0, 499, 0], [1000, 499.5, 0]], [[0, 300, 0], [1000, 300, 0]]]},
    ),
    "hole over many tiles": (CLOUD, {"holes": [ring((480.0, 510.0), 300.0)]}),
    "holes side by side": (
        CLOUD,
        {"holes": [ring((x, y), 60.0, 9) for x in (200.0, 400.0, 620.0) for y in (300.0, 700.0)]},
    ),
    "boundary, hole and lines": (
        CLOUD,
        {
            "boundary": [ring((500.0, 500.0), 450.0, 60)],
            "holes": [ring((300.0, 600.0), 90.0), ring((650.0, 400.0), 120.0)],
            "breaklines": [walk(9), walk(10)],
        },
    ),
    "two boundaries": (
        CLOUD,
        {"boundary": [ring((250.0, 250.0), 200.0), ring((700.0, 700.0), 220.0)]},
    ),
    "hole that crosses the boundary": (
        CLOUD,
        {"boundary": [ring((500.0, 500.0), 400.0)], "holes": [ring((850.0, 500.0), 120.0)]},
    ),
}

SURVEYS |= {
    "draped lines": (
        CLOUD,
        {"breaklines": [walk(k)[:, :2] if k % 2 else walk(k) for k in range(4)]},
    ),
    "draped lines along the hull of a lattice": (
        LATTICE,
        {
            "breaklines": [[[-3, 0], [11, 0]], [[23, -5], [23, 40]], [[0, 0], [23, 23]]],
            "holes": [[[-1, 11], [3, 11], [3, 15], [-1, 15]]],
        },
    ),
    "draped rings that leave the points": (
        CLOUD,
        {
            "boundary": [ring((500.0, 500.0), 560.0, 60)[:, :2]],
            "holes": [ring((0.0, 600.0), 90.0)[:, :2], ring((650.0, 400.0), 120.0)],
            "breaklines": [walk(9, size=1600.0)[:, :2]],
        },
    ),
    "draped boundary around all points": (
        CLOUD,
        {"boundary": [ring((500.0, 500.0), 900.0)[:, :2]]},
    ),
}


@pytest.mark.each_value
@pytest.mark.parametrize("side", [1, 2, 4, pytest.param(8, marks=pytest.mark.proof)])
@pytest.mark.parametrize("name", SURVEYS)
def test_the_parts_are_those_of_the_whole(name, side):
    points, lines = SURVEYS[name]
    margin = float(np.ptp(points[:, 0])) / 40
    require_triangles_of_the_whole(points, divide(points, side), margin=margin, **lines)


@pytest.mark.parametrize("duplicates", ["mean", "first", "last", "lowest", "highest"])
def test_elevations_on_lines_are_those_of_the_whole(duplicates):
    points = lift(np.round(rng(10).random((900, 2)) * 20))
    lines = {"breaklines": [[[0, 3, -9], [20, 3, -8]], [[2, 0, 70], [17, 15, 71], [17, 3, 72]]]}
    require_triangles_of_the_whole(
        points, divide(points, 3), margin=1.0, duplicates=duplicates, **lines
    )


def test_without_a_margin_the_same_is_found():
    points, lines = SURVEYS["wandering lines"]
    source, noded = divide(points, 4), node_all(points, **lines)
    box = source.box_of((1, 2))
    one, other = (
        triangulate_box(source, box, around=widen(box, margin), lines=noded)
        for margin in (0.0, 200.0)
    )
    for name in ("points", "numbers", "triangles", "neighbors", "constrained", "owned"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert one.rounds > 0


def test_points_behind_a_line_are_not_asked_for():
    """Triangles along a long line have discs that hold all that lies behind it."""
    front = np.column_stack([np.arange(1.0, 1000.0, 10), np.full(100, 501.0)])
    behind = np.column_stack([rng(2).random(20_000) * 1000, rng(3).random(20_000) * 480])
    points = lift(np.concatenate([front, behind, [[500.0, 1000.0]]]))
    source = divide(points, 8)
    noded = node_all(points, chunk=5000, breaklines=[[[-1, 500, 0], [1001, 500, 0]]])
    before = source.rows_read
    local = triangulate_box(source, ts.Bounds(480, 500.5, 520, 600), lines=noded)
    assert len(local.triangles) > 4
    seen = triangulate_box(source, ts.Bounds(480, 500.5, 520, 600))
    assert local.rounds <= seen.rounds
    assert source.rows_read - before < 40_000


def test_holes_that_cut_are_told():
    lines = {"holes": [ring((200.0, 200.0), 60.0), ring((800.0, 800.0), 60.0)]}
    source, noded = divide(CLOUD, 2), node_all(CLOUD, **lines)
    cutting = [
        triangulate_box(source, source.box_of(key), lines=noded).cutting.tolist()
        for key in ((0, 0), (1, 0), (1, 1))
    ]
    assert cutting == [[True, False], [False, False], [False, True]]


def test_places_in_triangles_that_are_not_known_are_told():
    """Of a line of which the triangles at one end are missing."""
    inputs = make_inputs(CLOUD, breaklines=[[[100, 480], [900, 520]]])
    source = divide(CLOUD, 2)
    draping = Draping.of(inputs, find_rim(source.skeleton))
    assert draping.list_asked().tolist() == [[[100, 480], [900, 520]]]
    parts = [triangulate_box(source, source.box_of(key)) for key in source.list_cells()]
    known = [KnownTriangles(one.points, one.triangles) for one in parts]
    laid, unknown = draping.lay(known)
    assert len(laid.inputs.lines.xy) > 50
    assert len(unknown) == 0
    laid, unknown = draping.lay([])  # on the triangles of the hull alone
    np.testing.assert_array_equal(unknown, laid.inputs.lines.xy)
    western = [one for key, one in zip(source.list_cells(), known, strict=True) if key[0] == 0]
    _, unknown = draping.lay(western)
    assert unknown[:, 0].min() > 500.0


def test_lines_without_elevations_are_not_cut():
    inputs = make_inputs(CLOUD, breaklines=[[[0, 0], [9, 9]]])
    with pytest.raises(LinesError, match="Breakline 0 has no elevations: it must be draped before"):
        node_lines(NumberedPoints.none(), inputs, first_number=0)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"max_edge": 5.0}, OptionError, "None for a surface in tiles: what it drops"),
        ({"snap": 0.1}, OptionError, "Invalid snap 0.1: it must be 0 for a surface in tiles"),
        ({"conforming": True}, OptionError, "it must be False for a surface"),
    ],
)
def test_what_is_not_local_is_refused(given, error, message):
    with pytest.raises(error, match=message):
        require_local(make_inputs(CLOUD, **given))
