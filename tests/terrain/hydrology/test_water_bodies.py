"""Pits, depressions and ponds: closed forms, priority flood on edges and on a fine raster."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from support.hydrology_oracle import flood, flood_raster
from support.point_sets import seeds
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts


def waves(seed, count, noise=1.0):
    rng = np.random.default_rng(seed)
    xy = np.vstack([rng.uniform(0, 100, (count, 2)), [[0, 0], [100, 0], [0, 100], [100, 100]]])
    z = 8 * np.sin(xy[:, 0] / 9) * np.cos(xy[:, 1] / 11) + rng.uniform(0, noise, len(xy))
    return ts.triangulate(np.column_stack([xy, z]))


def bowl_with_a_notch():
    """Return a pyramid upside down, 3 deep, whose rim has a notch 1 deep."""
    corners = [[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3]]
    return ts.triangulate([*corners, [3, 0, 2], [3, 3, 0], [6, 3, 3], [3, 6, 3], [0, 3, 3]])


def test_a_bowl_spills_at_its_notch():
    found = ts.depressions(bowl_with_a_notch())
    row = {name: values[0] for name, values in found.columns.items()}
    assert (row["spill_x"], row["spill_y"], row["depth"]) == (3, 0, 2)
    stage = ts.stage_storage(bowl_with_a_notch(), levels=[2.0])
    assert row["volume"] == pytest.approx(stage["volume"][0], rel=1e-14)
    assert row["area"] == pytest.approx(shapely.area(found.to_shapely())[0], rel=1e-14)
    assert (found.coordinates[:, 2] == 2.0).all()


def test_two_hollows_join_before_they_spill():
    x = [0, 1, 2, 3, 4]
    floor = [9, 0, 5, 1, 7]
    points = [[a, b, z + 10 * (b != 0)] for a, z in zip(x, floor, strict=True) for b in (-1, 0, 1)]
    tin = ts.triangulate(np.array(points, float) * [10, 10, 1])
    nested = ts.depressions(tin, nested=True).columns
    assert nested["depth"].tolist() == [7, 5, 4]
    assert nested["parent"].tolist() == [-1, 0, 0]
    assert nested["spill_level"].tolist() == [7, 5, 5]
    assert ts.depressions(tin).columns["depth"].tolist() == [7]
    assert ts.depressions(tin, nested=True, min_depth=4.5).columns["depth"].tolist() == [7, 5]
    assert ts.pits(tin).coordinates[:, 2].tolist() == [0, 1]


def test_flat_ground_above_an_outlet_is_no_depression():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    z = np.full(25, 2.0)
    z[2] = 1.0
    assert len(ts.pits(ts.triangulate(np.column_stack([x, y, z])))) == 0
    z[[12, 13]] = 0.0
    assert len(ts.pits(ts.triangulate(np.column_stack([x, y, z])))) == 1


@settings(max_examples=25, deadline=None)
@given(seeds, st.integers(1, 6), st.sampled_from([4, 7, 10]))
def test_depressions_are_those_of_a_priority_flood(seed, relief, side):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(side, relief, rng)
    rim = {vertex for ring in tin.boundary for vertex in ring.tolist()}
    filled = flood(tin.points, tin.edges, rim)
    found = ts.depressions(tin)
    under = filled > tin.points[:, 2]
    deep = sorted(filled[under].tolist())
    assert (len(found) == 0) == (len(deep) == 0)
    shapes = found.to_shapely()
    assert shapely.is_valid(shapes).all()
    for vertex in np.flatnonzero(under):
        inside = shapely.intersects_xy(shapes, *tin.points[vertex, :2])
        assert found.columns["spill_level"][inside].tolist() == [filled[vertex]]
    for vertex in np.flatnonzero(~under):  # a tip that just reaches the water is not cut out
        around = shapely.contains_xy(shapes, *tin.points[vertex, :2])
        assert (found.columns["spill_level"][around] == tin.points[vertex, 2]).all()
    assert shapely.area(shapes) == pytest.approx(found.columns["area"], rel=1e-12)


def test_volumes_and_levels_are_those_of_a_fine_raster():
    tin = waves(4, 600)
    spacing = 0.5
    x, y = (spacing * (0.5 + np.arange(200)) for _ in range(2))
    east, north = np.meshgrid(x, y)
    z = tin.interpolate(np.column_stack([east.ravel(), north.ravel()])).reshape(east.shape)
    filled = flood_raster(z)
    found = ts.depressions(tin, min_depth=1.0)
    for shape, row in zip(found.to_shapely(), range(len(found)), strict=True):
        west, south, east, north = shape.bounds
        columns, rows = (x > west) & (x < east), (y > south) & (y < north)
        east, north = np.meshgrid(x[columns], y[rows])
        inside = shapely.contains_xy(shape, east, north)
        level, own = found.columns["spill_level"][row], np.ix_(rows, columns)
        volume = (level - z[own])[inside].sum() * spacing**2
        assert volume == pytest.approx(found.columns["volume"][row], rel=0.02)
        assert inside.sum() * spacing**2 == pytest.approx(found.columns["area"][row], rel=0.05)
        # Between two cells that touch at a corner a crest is passed over.
        assert filled[own][inside].max() == pytest.approx(level, abs=2 * spacing)


def test_nested_depressions_hold_each_other():
    tin = waves(8, 800, noise=4.0)
    found = ts.depressions(tin, nested=True)
    shapes, parents = found.to_shapely(), found.columns["parent"]
    for child in np.flatnonzero(parents >= 0):
        assert shapes[child].difference(shapes[parents[child]]).area < 1e-9
        for name in ("area", "volume", "spill_level"):
            assert found.columns[name][child] < found.columns[name][parents[child]]
    for row in range(len(found)):
        level = found.columns["spill_level"][row]
        ponds = ts.ponds(tin, level)
        pit = tin.points[found.columns["pit_vertex"][row], :2]
        pond = shapely.intersects_xy(ponds.to_shapely(), *pit)
        assert ponds.columns["volume"][pond] == pytest.approx([found.columns["volume"][row]])
        assert ponds.columns["is_contained"][pond].all()


def test_ponds_add_up_to_the_stage():
    tin = waves(9, 2000, noise=3.0)
    for level in (-6.0, 0.0, float(tin.points[77, 2])):
        found, stage = ts.ponds(tin, level), ts.stage_storage(tin, levels=[level])
        assert found.columns["volume"].sum() == pytest.approx(stage["volume"][0], rel=1e-12)
        assert found.columns["area"].sum() == pytest.approx(stage["area"][0], rel=1e-12)
        assert bool(found.columns["is_contained"].all()) == bool(stage["is_contained"][0])
    assert len(ts.ponds(tin, -99.0)) == 0


def test_the_order_of_points_does_not_matter():
    tin = waves(10, 300, noise=4.0)
    mixed = ts.triangulate(np.random.default_rng(1).permutation(tin.points))
    one, other = ts.depressions(tin), ts.depressions(mixed)
    for name in ("spill_x", "spill_y", "spill_level", "depth", "volume"):
        assert sorted(one.columns[name]) == pytest.approx(sorted(other.columns[name]), rel=1e-12)


def test_feet_and_metres_are_minded():
    tin = bowl_with_a_notch()
    feet = ts.triangulate(tin.points, crs="EPSG:32616", elevation_unit="ft")
    found = ts.depressions(feet)
    plain = ts.depressions(tin).columns["volume"]
    assert found.columns["volume"] == pytest.approx(0.3048 * plain)
    assert (found.units["volume"], found.units["depth"].symbol) == ("m³", "ft")


def test_water_thinner_than_rounding_has_no_polygon_and_that_is_told():
    corner, width = [752_015.5416232125, 4_024_021.3012590385], 17.939999999999998
    x, y = corner
    hole = [[x, y], [x + width, y], [x + width, y + width], [x, y + width]]
    points = [
        [752_033.6, 4_024_048.3, 306.3],
        [752_026.8, 4_024_014.8, 302.3],
        [752_014.0, 4_024_051.8, 305.3],
        [752_004.2, 4_024_002.5, 301.3],
        [752_059.9, 4_024_015.0, 308.3],
        [752_023.4, 4_024_043.4, 300.3],
        [752_039.4, 4_024_026.3, 300.3],
    ]
    tin = ts.triangulate(points, max_edge=20.0, trim="everywhere", holes=[hole])
    found = ts.depressions(tin)
    depths = ts.pits(tin).columns["depth"]
    assert (depths < 1e-9).all()
    assert len(found) == len(depths) or any("made valid" in note for note in found.notes)


@pytest.mark.parametrize("level", [float("nan"), float("inf"), "high", None, True])
def test_a_level_that_is_none_is_refused(level):
    with pytest.raises(ts.OptionError, match="level"):
        ts.ponds(bowl_with_a_notch(), level)


def test_options_that_are_none_are_refused():
    tin = bowl_with_a_notch()
    for bad in (-1, "deep", float("nan")):
        with pytest.raises(ts.OptionError, match="min_depth"):
            ts.depressions(tin, min_depth=bad)
    with pytest.raises(ts.OptionError, match="nested"):
        ts.depressions(tin, nested="yes")
    with pytest.raises(ts.OptionError, match="min_angle"):
        ts.ridges_and_valleys(tin, min_angle=200)


def test_ridges_and_valleys_of_a_folded_sheet():
    points = [[a, b, abs(a % 4 - 2) + 0.1 * b] for a in range(9) for b in range(0, 9, 2)]
    found = ts.ridges_and_valleys(ts.triangulate(np.array(points, float)))
    at = found.coordinates[::2, 0]
    kinds = found.columns["kind"]
    assert set(at[kinds == "valley"]) == {2.0, 6.0}
    assert set(at[kinds == "ridge"]) == {4.0}
    assert (np.diff(found.coordinates[:, 2].reshape(-1, 2)) < 0).all()
    bend = np.degrees(2 * np.arctan(1 / np.sqrt(1 + 0.1**2)))
    assert found.columns["angle"] == pytest.approx(bend)


@pytest.mark.parametrize("turn", [(1, 3), (3, 1), (-7, 11)])
def test_waters_along_a_slanted_line_are_whole_polygons(turn):
    """Its triangles are thinner than rounding, and hang together with none but in decimals."""
    along = np.arange(300.0)
    line = np.column_stack([along * turn[0] / 3, along * turn[1] / 3, np.sin(along)])
    aside = [[450.0 * turn[1] / 10, -450.0 * turn[0] / 10, 0.0]]
    tin = ts.triangulate(np.vstack([line, aside]))
    for found in (ts.ponds(tin, 0.01), ts.depressions(tin)):
        assert not any("met themselves" in note for note in found.notes)
        shapes = found.to_shapely()
        assert shapely.is_valid(shapes).all()
        assert shapely.area(shapes) == pytest.approx(found.columns["area"], rel=1e-9, abs=1e-9)
