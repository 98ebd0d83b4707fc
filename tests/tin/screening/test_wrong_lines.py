"""Lines at wrong elevations are found and named; right ones, and points beside them, are left."""

from __future__ import annotations

import re

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.inspection.findings import drop_blunders, list_wrong_rows, screen
from tinsmith.tin.screening import describe_findings

RING = np.array([[20.0, 20.0], [80.0, 20.0], [80.0, 80.0], [20.0, 80.0]])


def ground(xy):
    xy = np.asarray(xy, float)
    return 320 + 0.03 * xy[:, 0] - 0.02 * xy[:, 1]


def lift(xy, z=None):
    return np.column_stack([xy, ground(xy) if z is None else np.broadcast_to(z, len(xy))])


def grid(step=5.0, noise=0.0, size=100.0):
    x, y = np.meshgrid(np.arange(0.0, size + 1, step), np.arange(0.0, size + 1, step))
    points = lift(np.column_stack([x.ravel(), y.ravel()]))
    points[:, 2] += np.random.default_rng(1).normal(0, noise, len(points))
    return points


def find_lines(tin):
    found = []
    for table in (ts.blunders(tin), screen(tin)):
        is_line = table["reason"].astype(str) == "line"
        assert (table["row"][is_line] == -1).all()
        found.append(
            dict(zip(table["explanation"][is_line], table["certainty"][is_line], strict=True))
        )
    return found


def close(ring):
    return np.vstack([ring, ring[:1]])


WRONG = {
    "boundary": {"boundary": [lift(RING, 0.0)]},
    "holes": {"holes": [lift(RING, 0.0)]},
    "water": {"water": [ts.Water(RING, 0.0)]},
    "breaklines": {"breaklines": [ts.Breakline(lift(close(RING), 0.0), name="road")]},
}


@pytest.mark.parametrize("kind", WRONG)
@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_a_line_at_0_in_ground_at_320_is_named_and_no_point_is_dropped(kind, noise):
    tin = ts.triangulate(grid(noise=noise), **WRONG[kind])
    name = {"holes": "Hole 0", "breaklines": "Breakline 0 'road'"}.get(kind, f"{kind} 0")
    name = name[:1].upper() + name[1:]
    for found in find_lines(tin):
        ((sentence, certainty),) = found.items()
        # Water has the points on its ring, too, which lines leave as they are.
        count = 48 if kind == "water" else 4
        assert sentence.startswith(f"{name}: all {count} vertices have the elevation 0, which may")
        assert certainty == "high"
    assert any(note.startswith(name) for note in describe_findings(tin))
    table = ts.blunders(tin)
    assert len(list_wrong_rows(table)) == 0
    before = tin.points.copy()
    assert len(drop_blunders(tin, table)[1]) == 0
    assert np.array_equal(tin.points, before)


def test_the_points_give_what_the_line_should_have():
    tin = ts.triangulate(grid(), **WRONG["boundary"])
    table = ts.blunders(tin)
    row = table["reason"].tolist().index("line")
    expected = ground(RING)
    told = f"the points around give {expected.min():.6g} to {expected.max():.6g}."
    assert table["explanation"][row].endswith(told)
    assert table["residual"][row] == pytest.approx(-np.median(expected))


@pytest.mark.parametrize("offset", [-40.0, -5.0, 5.0, 40.0])
def test_a_boundary_metres_off_the_points_is_told_as_doubtful(offset):
    tin = ts.triangulate(grid(noise=0.02), boundary=[lift(RING, ground(RING) + offset)])
    for found in find_lines(tin):
        ((sentence, certainty),) = found.items()
        side = "above" if offset > 0 else "below"
        told = re.search(
            rf"all 4 vertices lie some ([\d.]+) {side} what the points around", sentence
        )
        assert float(told[1]) == pytest.approx(abs(offset), abs=0.05)
        assert certainty == "medium"


def test_a_line_in_feet_among_metres_is_told_with_its_factor():
    line = lift(close(RING), ground(close(RING)) / 0.3048)
    tin = ts.triangulate(grid(noise=0.02), breaklines=[line])
    for found in find_lines(tin):
        ((sentence, certainty),) = found.items()
        assert "are 1 / 0.3048 times (feet for metres) what the points around give" in sentence
        assert certainty == "high"


def test_some_vertices_at_0_are_counted():
    coords = lift([[10.0, 52.0], [30.0, 52.0], [50.0, 52.0], [70.0, 52.0], [90.0, 52.0]])
    coords[1:3, 2] = 0.0
    for found in find_lines(ts.triangulate(grid(), breaklines=[coords])):
        assert any(one.startswith("Breakline 0: 2 of 5 vertices have the eleva") for one in found)


def make_kerb():
    bottom = lift([[0.0, 51.0], [100.0, 51.0]])
    return {"breaklines": [bottom, bottom + np.array([0, 0.2, 0.15])]}


def make_ditch():
    """Banks and bottom 1.5 m deeper, with points on the banks alone."""
    return {"breaklines": [lift([[0.0, 52.5], [100.0, 52.5]]) - [0, 0, 1.5]]}


RIGHT = {
    "boundary": {"boundary": [lift(RING)]},
    "draped boundary": {"boundary": [RING]},
    "boundary beyond the hull": {"boundary": [RING + 50.0]},
    "boundary without points": {"boundary": [RING[:3] / 60 + 41.1]},
    "pond with banks of half a metre": {
        "water": [ts.Water(RING + 2.4, float(ground(RING).min()) - 0.5)]
    },
    "kerb": make_kerb(),
    "ditch": make_ditch(),
    "hole": {"holes": [lift(RING)]},
}


@pytest.mark.parametrize("kind", RIGHT)
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_right_lines_are_not_told_and_no_point_is(kind, noise):
    tin = ts.triangulate(grid(noise=noise), **RIGHT[kind])
    for table in (ts.blunders(tin), screen(tin)):
        assert table["explanation"][table["certainty"].astype(str) != "low"].tolist() == []
    assert not any("vert" in note or "blunder" in note for note in describe_findings(tin))
    assert len(drop_blunders(tin, ts.blunders(tin))[1]) == 0


def test_sea_beside_a_coast_is_no_wrong_line():
    """A coastline at 0 beside a beach that rises from there."""
    points = grid()
    points[:, 2] = 0.05 * points[:, 0] + 0.02
    coast = np.array([[0.0, 0.0, 0.0], [0.0, 100.0, 0.0]])
    tin = ts.triangulate(points[points[:, 0] > 0], breaklines=[coast])
    assert find_lines(tin) == [{}, {}]


def test_points_where_a_wrong_line_passes_keep_their_own_elevations():
    """The ring overrules points that stand on it: those are right, and not told."""
    tin = ts.triangulate(grid(), boundary=[lift(RING, 0.0)])
    assert (tin.points[tin.points[:, 2] == 0, :2] % 5 == 0).all()
    for table in (ts.blunders(tin), screen(tin)):
        assert set(table["reason"].tolist()) == {"line"}


def test_a_tin_of_points_on_lines_alone_has_nothing_to_judge_them_by():
    line = lift(close(RING), 0.0)
    tin = ts.triangulate(np.empty((0, 3)), breaklines=[line, lift([[40.0, 40.0], [60.0, 60.0]])])
    assert find_lines(tin) == [{}, {}]
    describe_findings(tin)
