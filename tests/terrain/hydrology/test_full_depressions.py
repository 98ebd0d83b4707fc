"""Water over full depressions: closed forms, a priority flood and a plain search on the edges."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.hydrology_oracle import (
    find_boundary,
    flood,
    require_full_catchments,
    require_full_routes,
)
from support.point_sets import rolling, seeds
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts
from tinsmith.terrain.hydrology.filling import fill


def fold_gutter(floor, wall=10.0):
    """Return a gutter along the x axis, 10 from one vertex of its floor to the next."""
    points = [
        [10 * x, 10 * y, z + wall * (y != 0)] for x, z in enumerate(floor) for y in (-1, 0, 1)
    ]
    return ts.triangulate(np.array(points, float))


def trim_scattered(seed, count, max_edge=None, digits=9):
    """Return scattered points, with holes where edges are long."""
    points = rolling(np.random.default_rng(seed), count).round(digits)
    return ts.triangulate(points, max_edge=max_edge, trim="everywhere")


def summarise(path):
    return list(zip(*(path.columns[name].tolist() for name in ("kind", "pit", "end")), strict=True))


def test_water_runs_from_pond_to_pond_to_the_boundary():
    tin = fold_gutter([6, 3, 5, 1, 4, 0])
    pits = ts.pits(tin).columns["vertex"].tolist()
    path = ts.flow_path(tin, [[5, 0]], fill_depressions=True)
    assert summarise(path) == [
        ("pond", pits[1], "descent"),
        ("descent", -1, "pond"),
        ("pond", pits[0], "descent"),
        ("descent", -1, "boundary"),
    ]
    # The floor falls from 5 at x = 20 to 1 at x = 30: water at 4 begins at x = 22.5.
    assert path.coordinates.tolist() == [
        *([5, 0, 5], [10, 0, 5], [20, 0, 5]),
        *([20, 0, 5], [22.5, 0, 4]),
        *([22.5, 0, 4], [30, 0, 4], [40, 0, 4]),
        *([40, 0, 4], [50, 0, 0]),
    ]
    assert path.columns["length"].tolist() == [15, 2.5, 17.5, 10]
    assert path.columns["drop"].tolist() == [0, 1, 0, 4]
    into = ts.depressions(tin).columns
    assert (into["pit_vertex"].tolist(), into["into"].tolist()) == (pits, [-1, 0])


def test_what_spills_into_each_other_is_one_pond():
    tin = fold_gutter([9, 0, 5, 1, 7])
    low = ts.depressions(tin).columns["pit_vertex"].tolist()
    for x in (12, 33):
        path = ts.flow_path(tin, [[x, 0]], fill_depressions=True)
        assert summarise(path) == [("pond", low[0], "boundary")]
        assert path.coordinates[-1].tolist() == [40, 0, 7]


def test_without_the_option_nothing_is_filled():
    tin = fold_gutter([6, 3, 5, 1, 4, 0])
    assert ts.flow_path(tin, [[5, 0]]).columns["end"].tolist() == ["pit"]


def test_a_pond_beyond_a_pond_of_the_same_level_is_crossed():
    tin = fold_gutter([9, 1, 5, 2, 5, 0])
    path = ts.flow_path(tin, [[12, 0]], fill_depressions=True)
    first, second = sorted(ts.depressions(tin).columns["pit_vertex"].tolist())
    assert summarise(path)[:2] == [("pond", first, "pond"), ("pond", second, "descent")]
    found = ts.depressions(tin).columns
    assert found["spill_x"].tolist() == [20, 40]
    assert found["into"].tolist() == [1, -1]


def test_level_ground_is_crossed_the_shortest_way():
    tin = fold_gutter([6, 5, 5, 5, 5, 0])
    path = ts.flow_path(tin, [[5, 0]], fill_depressions=True)
    assert [kind for kind, *_ in summarise(path)] == ["descent", "flat", "descent"]
    assert path.coordinates[path.offsets[0][1] : path.offsets[0][2], 0].tolist() == [10, 20, 30, 40]
    level = ts.triangulate([[0, 0, 1], [2, 0, 1], [0, 2, 1]])
    path = ts.flow_path(level, [[0.5, 0.5]], fill_depressions=True)
    assert summarise(path) == [("flat", -1, "boundary")]
    assert path.coordinates[-1].tolist() == [0, 0, 1]


def test_at_a_spill_point_water_does_not_run_back():
    # From (20, 0) the way back into the pond is the steeper one.
    tin = fold_gutter([9, -50, 5, 4.5, 0], wall=100.0)
    path = ts.flow_path(tin, [[20, 0]], fill_depressions=True)
    assert summarise(path) == [("descent", -1, "boundary")]
    assert path.coordinates[-1].tolist() == [40, 0, 0]
    assert ts.flow_path(tin, [[20, 0]]).coordinates[-1].tolist() == [10, 0, -50]


def test_everything_drains_through_the_last_spill_point():
    tin = fold_gutter([6, 3, 5, 1, 4, 0])
    full = ts.flow_accumulation(tin, fill_depressions=True).columns
    empty = ts.flow_accumulation(tin).columns
    spill = int(ts.depressions(tin).columns["spill_vertex"][0])
    through = np.unique(full["start_area"][full["start"] == spill])
    outlet = ts.catchments(tin, tin.points[[spill], :2], fill_depressions=True)
    assert through == pytest.approx(outlet.columns["area"])
    assert through[0] > 10 * empty["start_area"][empty["start"] == spill].sum()
    basins = ts.catchments(tin, fill_depressions=True).columns
    assert basins["area"].sum() == pytest.approx(tin.area, rel=1e-14)
    assert set(full["kind"].tolist()) == {"descent", "pond"}


def test_an_outlet_under_water_is_where_the_pond_spills():
    tin = fold_gutter([6, 3, 5, 1, 4, 0])
    spill = ts.depressions(tin).columns["spill_vertex"][0]
    found = ts.catchments(tin, [[30, 0]], fill_depressions=True)
    assert found.columns["vertex"].tolist() == [spill]
    with pytest.raises(ts.PointsError, match="same vertex"):
        ts.catchments(tin, [[30, 0], [31, 0]], fill_depressions=True)


def test_levels_are_those_of_a_priority_flood():
    for seed, max_edge in ((1, None), (2, 9.0)):
        tin = trim_scattered(seed, 500, max_edge)
        used = np.unique(tin.triangles)
        wanted = flood(tin.points, tin.edges, find_boundary(tin))
        assert (fill(tin).levels[used] == wanted[used]).all()


@settings(max_examples=15, deadline=None)
@given(seeds, st.integers(1, 5), st.sampled_from([4, 8]))
def test_routes_of_integer_grids_are_those_of_a_plain_search(seed, relief, side):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(side, relief, rng)
    starts = np.vstack([tin.points[:, :2], rng.integers(0, 4 * side - 3, (20, 2)) / 4])
    require_full_routes(tin, starts, 1e-9)
    require_full_catchments(tin, rng.random((20, 2)))


@pytest.mark.parametrize(("seed", "digits"), [(3, 9), (4, 1), (5, 0)])
def test_routes_of_scattered_points_with_holes_end_at_the_boundary(seed, digits):
    tin = trim_scattered(seed, 400, max_edge=9.0, digits=digits)
    assert len(tin.boundary) > 1
    require_full_routes(tin, tin.points[np.unique(tin.triangles), :2], 1e-6)
    require_full_catchments(tin, np.random.default_rng(seed).random((40, 2)))


def test_every_depression_spills_for_every_part_has_a_boundary():
    tin = trim_scattered(6, 600, max_edge=7.0)
    assert (ts.depressions(tin, nested=True).columns["spill_vertex"] >= 0).all()
    # A pool around a hole is none: the hole is a boundary, which water leaves through.
    ring = [[x, y, 5.0] for x in (0, 30) for y in (0, 30)]
    inner = [[x, y, 0.0] for x in (10, 20) for y in (10, 20)]
    pool = ts.triangulate([*ring, *inner], holes=[[(10, 10), (20, 10), (20, 20), (10, 20)]])
    assert len(ts.pits(pool)) == 0
    path = ts.flow_path(pool, [[3, 3]], fill_depressions=True)
    assert path.columns["end"].tolist() == ["boundary"]


def test_the_order_of_points_does_not_matter():
    rng = np.random.default_rng(7)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(9.0), np.arange(9.0)))
    points = np.column_stack([x, y, rng.integers(0, 4, len(x))])
    starts = rng.uniform(0.5, 7.5, (30, 2))
    one, other = (
        ts.flow_path(ts.triangulate(rows), starts, fill_depressions=True)
        for rows in (points, rng.permutation(points))
    )
    assert (one.coordinates == other.coordinates).all()
    assert one.columns["kind"].tolist() == other.columns["kind"].tolist()


def test_parts_add_up_to_the_fall_from_water_to_boundary():
    tin = trim_scattered(8, 800)
    rng = np.random.default_rng(8)
    starts = rng.uniform(20, 80, (30, 2))
    path = ts.flow_path(tin, starts, fill_depressions=True)
    lines = [path.coordinates[a:b] for a, b in pairwise(path.offsets[0].tolist())]
    for number in range(len(starts)):
        rows = np.flatnonzero(path.columns["start"] == number)
        assert path.columns["part"][rows].tolist() == list(range(len(rows)))
        fall = lines[rows[0]][0, 2] - lines[rows[-1]][-1, 2]
        assert path.columns["drop"][rows].sum() == pytest.approx(fall)


def test_an_option_that_is_no_flag_is_refused():
    tin = fold_gutter([6, 3, 5])
    asks = (
        lambda: ts.flow_path(tin, [[5, 0]], fill_depressions="yes"),
        lambda: ts.catchments(tin, fill_depressions=2),
        lambda: ts.flow_accumulation(tin, fill_depressions=None),
    )
    for ask in asks:
        with pytest.raises(ts.OptionError, match="fill_depressions"):
            ask()
