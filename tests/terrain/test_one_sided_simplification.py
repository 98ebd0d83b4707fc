"""Simplified surfaces that lie nowhere below the points, or nowhere above them."""

import json

import numpy as np
import pytest
from support.commands import run_command as run
from support.simplification import largest_crossing

import tinsmith as ts

TURNS = {"above": 1.0, "below": -1.0}


def make_hills(n=1500, seed=0, **options):
    xy = np.random.default_rng(seed).random((n, 2)) * 300
    z = 50 + 8 * np.sin(xy[:, 0] / 25) * np.cos(xy[:, 1] / 31) + 0.2 * np.sin(xy[:, 0])
    return ts.triangulate(np.column_stack([np.add(xy, [500_000, 4_000_000]), z]), **options)


def measure(tin, simple):
    """Return how far the points lie above the surface."""
    return tin.points[:, 2] - simple.interpolate(tin.points[:, :2])


@pytest.mark.parametrize("side", TURNS)
@pytest.mark.parametrize("tolerance", [0.2, 1.0, 5.0])
def test_the_surface_lies_on_one_side_within_the_tolerance(side, tolerance):
    tin = make_hills()
    simple = ts.simplify(tin, tolerance=tolerance, side=side)
    assert ts.check(simple).ok
    heights = TURNS[side] * measure(tin, simple)
    assert heights.max() <= 2e-12
    assert heights.min() >= -tolerance - 1e-9
    told = simple.report.simplification
    assert told.side == side
    assert told.largest_error == pytest.approx(np.abs(heights).max(), abs=1e-9)
    assert len(simple.points) < len(tin.points)
    other = "below" if side == "above" else "above"
    assert f"nowhere {other} a point" in simple.report.notes[-1]


@pytest.mark.parametrize("side", TURNS)
def test_it_takes_more_points_than_both_sides_and_fewer_than_all(side):
    tin = make_hills()
    counts = [len(ts.simplify(tin, tolerance=2.0, side=one).points) for one in ("both", side)]
    assert counts[0] < counts[1] < len(tin.points) / 2


@pytest.mark.parametrize("side", TURNS)
def test_no_vertex_inside_is_needless(side):
    tin = make_hills(300)
    simple = ts.simplify(tin, tolerance=1.0, side=side)
    ring = set(np.concatenate(simple.boundary).tolist())
    for vertex in sorted(set(range(len(simple.points))) - ring)[:25]:
        without = simple.replace()
        without.remove(vertex)
        heights = TURNS[side] * measure(tin, without)
        assert heights.max() > 1e-12 or heights.min() < -1.0


@pytest.mark.parametrize("side", TURNS)
def test_above_of_the_heights_is_below_of_the_depths(side):
    tin = make_hills()
    depths = tin.replace(points=tin.points * [1, 1, -1])
    other = "below" if side == "above" else "above"
    one = ts.simplify(tin, tolerance=1.0, side=side)
    two = ts.simplify(depths, tolerance=1.0, side=other)
    np.testing.assert_array_equal(one.points, two.points * [1, 1, -1])


@pytest.mark.parametrize("side", TURNS)
def test_between_the_points_too(side):
    tin = make_hills(250)
    simple = ts.simplify(tin, tolerance=1.0, side=side, hold="surface")
    assert float(largest_crossing(tin, simple, TURNS[side])) <= 1e-8
    assert float(largest_crossing(tin, simple)) <= 1.0 + 1e-8
    assert len(simple.points) < len(tin.points)


@pytest.mark.parametrize("hold", ["points", "surface"])
def test_of_a_plane_its_corners_are_left(hold):
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0))
    points = np.column_stack([x.ravel(), y.ravel(), (2 * x + y).ravel()])
    simple = ts.simplify(ts.triangulate(points), tolerance=0.5, side="above", hold=hold)
    assert len(simple.points) == 4


def test_lines_stay_and_the_surface_is_held_beside_them():
    line = np.array(
        [[500_010.0, 4_000_010, 49], [500_200, 4_000_150, 52], [500_290, 4_000_020, 50]]
    )
    tin = make_hills(400, breaklines=[line])
    simple = ts.simplify(tin, tolerance=1.0, side="above")
    assert simple.report.simplification.hold == "surface"
    assert "nowhere below the surface given" in simple.report.notes[-1]
    assert measure(tin, simple).max() <= 1e-9


def test_what_cannot_be_is_refused():
    tin = make_hills(50)
    with pytest.raises(ts.OptionError, match="side"):
        ts.simplify(tin, tolerance=1.0, side="over")
    with pytest.raises(ts.OptionError, match="side"):
        ts.simplify(tin, points=20, side="above")
    raster = ts.rasterize(tin, spacing=30.0)
    with pytest.raises(ts.OptionError, match="side"):
        ts.simplify(raster, tolerance=1.0, side="above")


def test_the_command_says_it(tmp_path):
    tin = make_hills(300, crs="EPSG:32616", elevation_unit="m")
    file, out = ts.write(tin, tmp_path / "hills.gpkg"), tmp_path / "bed.gpkg"
    done = run("simplify", file, "--tolerance", 1, "--side", "above", "-o", out, "--json")
    assert ts.read(out) == ts.simplify(tin, tolerance=1.0, side="above")
    assert json.loads(done.stdout)["simplification"]["side"] == "above"
    assert ts.read(out).report.simplification.side == "above"
