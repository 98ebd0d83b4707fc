"""Sentences on findings: what they name, for any TIN, and that they leave right ground alone."""

from __future__ import annotations

import re

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.inspection.findings import drop_blunders, screen
from tinsmith.tin.screening import describe_findings
from tinsmith.tin.screening.gaps import describe_gaps


def make_points(count=12):
    x, y = np.divmod(np.arange(float(count**2)), count)
    return np.column_stack([10 * x, 10 * y, 320 + 0.3 * x - 0.2 * y])


def test_clean_ground_has_nothing_to_tell():
    assert describe_findings(ts.triangulate(make_points())) == ()


def test_points_are_named_by_their_numbers():
    points = make_points()
    points[[40, 70], 2] += 30.0
    survey = ts.Survey(points=points, attributes={"number": 100 + np.arange(len(points))})
    (note,) = describe_findings(ts.triangulate(survey))
    assert note.startswith("2 points look like blunders (2 spike): point ")
    assert set(re.findall(r"point (\d+) at elevation", note)) == {"140", "170"}


def test_a_tin_of_triangles_alone_is_screened_by_rows():
    points = make_points()
    points[40, 2] = -9999.0
    tin = ts.triangulate(points)
    alone = ts.TIN.from_triangles(tin.points, tin.triangles)
    (note,) = describe_findings(alone)
    assert note == "1 point looks like a blunder (1 code): row 40 at elevation -9999."


def test_three_codes_0_beside_one_of_another_kind_are_all_found():
    points = make_points()
    points[[14, 15, 16], 2] = 0.0
    points[70, 2] = -99.0
    tin = ts.triangulate(points)
    for table in (ts.blunders(tin), screen(tin)):
        assert sorted(table["row"].tolist()) == [14, 15, 16, 70]
        assert set(table["reason"].tolist()) == {"code"}
    assert len(drop_blunders(tin, ts.blunders(tin))[1]) == 4


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_millimetres_beside_metres_are_all_found(share):
    points = make_points()
    wrong = np.arange(int(share * len(points))) * 2
    points[wrong, 2] *= 1000.0
    table = ts.blunders(ts.triangulate(points))
    assert sorted(table["row"].tolist()) == wrong.tolist()
    assert set(table["reason"].tolist()) == {"factor"}
    assert "a thousand times" in table["explanation"][0]


def test_where_no_point_is_left_nothing_is_told_and_nothing_fails():
    """A boundary between the points of a grid, of which none lies inside."""
    ring = [[12.0, 12.0], [14.0, 12.0], [14.0, 14.0]]
    tin = ts.triangulate(make_points(), boundary=[ring])
    assert (tin.vertex_of < 0).all()
    assert describe_findings(tin) == ()
    table = ts.blunders(tin)
    assert len(table) == 0
    assert len(drop_blunders(tin, table)[1]) == 0


def test_a_surface_of_lines_alone_is_screened():
    lines = [[[0, 0, 5], [40, 0, 6]], [[40, 30, 7], [0, 30, 8]]]
    tin = ts.triangulate(np.empty((0, 3)), breaklines=lines)
    assert describe_findings(tin) == ()
    assert len(drop_blunders(tin, ts.blunders(tin))[1]) == 0


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_right_points_where_a_boundary_meets_the_hull_are_not_dropped(turn):
    """Corners of the clipped surface are compared with the plane, which all points are on."""
    points = make_points()
    cosine, sine = np.cos(turn), np.sin(turn)
    points[:, :2] = points[:, :2] @ np.array([[cosine, -sine], [sine, cosine]])
    middle = points[:, :2].mean(axis=0)
    ring = middle + np.array([[0.0, 0.0], [99.0, 0.0], [99.0, 99.0], [0.0, 99.0]])
    tin = ts.triangulate(points, boundary=[ring])
    table = ts.blunders(tin)
    assert len(table) == 0
    assert len(drop_blunders(tin, table)[1]) == 0


def test_the_last_points_are_measured_by_64_others():
    """Of 324 points four were a block of their own, whose scale one blunder spoiled."""
    points = make_points(18)
    for row in range(17 * 18, 18 * 18):
        wrong = points.copy()
        wrong[row, 2] += 50.0
        table = ts.blunders(ts.triangulate(wrong))
        assert table["row"].tolist() == [row]


def make_l(step=10.0):
    x, y = np.meshgrid(np.arange(0.0, 101.0, step), np.arange(0.0, 101.0, step))
    inside = ~((x > 50) & (y > 50))
    return np.column_stack([x[inside], y[inside], np.full(inside.sum(), 10.0)])


@pytest.mark.parametrize("turn", [0.0, 0.4, np.pi / 4])
def test_the_bay_of_an_l_is_told_with_the_edge_that_opens_it(turn):
    points = make_l()
    cosine, sine = np.cos(turn), np.sin(turn)
    points[:, :2] = points[:, :2] @ np.array([[cosine, -sine], [sine, cosine]])
    tin = ts.triangulate(points)
    assert tin.area == pytest.approx(8750)
    (note,) = describe_findings(tin)
    limit = float(re.search(r"`max_edge=([\d.]+)` trims them\.$", note)[1])
    cut = ts.triangulate(points, max_edge=limit)
    assert cut.area == pytest.approx(7550)  # half a cell more, whose edges are as others
    assert describe_findings(cut) == ()
    assert describe_findings(tin, gaps=False) == ()


def rims():
    """Usual outlines: of points at random, of grids, of lines of points."""
    rng = np.random.default_rng(3)
    for count in (30, 300, 3_000):
        u = rng.random((count, 2))
        radius, angle = np.sqrt(u[:, 0]) * 60, u[:, 1] * 2 * np.pi
        disc = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        side = int(np.sqrt(count)) + 1
        grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2) * 1.0
        turned = grid @ np.array([[0.8, -0.6], [0.6, 0.8]])
        yield f"square {count}", u * 100
        yield f"strip {count}", u * [400, 30]
        yield f"disc {count}", disc
        yield f"ellipse {count}", disc * [3, 1]
        yield f"turned grid {count}", turned
        yield f"uneven grid {count}", turned + rng.normal(0, 0.15, turned.shape)
        yield f"round grid {count}", grid[np.hypot(*(grid - side / 2).T) < side / 2]
        yield f"scan lines {count}", grid * [0.4, 6] + rng.normal(0, 0.05, grid.shape)


@pytest.mark.parametrize(
    ("name", "xy"), list(rims()), ids=lambda one: one if type(one) is str else ""
)
def test_usual_outlines_have_no_gaps(name, xy):
    z = 50 + 3 * np.sin(xy[:, 0] / 30) + np.random.default_rng(4).normal(0, 0.02, len(xy))
    tin = ts.triangulate(np.column_stack([xy, z]))
    assert describe_gaps(tin, slivers=False) == [], name


def test_a_note_is_the_same_for_the_same_tin_and_the_tin_is_left_alone():
    points = make_points(30)
    points[400, 2] += 50.0
    points[3, :2] += 5_000.0
    tin = ts.triangulate(points)
    before = tin.triangles.copy()
    assert describe_findings(tin) == describe_findings(tin)
    assert len(describe_findings(tin)) > 0
    assert np.array_equal(tin.triangles, before)
    assert tin.edits == ()
