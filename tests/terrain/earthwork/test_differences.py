"""The difference as a TIN: sound, of the exact volumes, with zones, zero line and statistics."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from support.point_sets import small_surfaces

import tinsmith as ts

UTM = np.array([752_640.0, 4_024_180.0, 320.0])


def square(elevations, *, side=4.0, origin=(0.0, 0.0, 0.0)):
    corners = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    return ts.triangulate(np.column_stack([corners, elevations]) + origin)


def pyramid(*, height, foot):
    corners = [[-3, -3, foot], [3, -3, foot], [3, 3, foot], [-3, 3, foot]]
    return ts.triangulate(np.array([*corners, [0, 0, foot + height]], float))


def rough(n, seed, *, origin=(0.0, 0.0, 0.0)):
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * 100
    return ts.triangulate(np.column_stack([xy, np.sin(xy[:, 0] / 9) + rng.random(n)]) + origin)


def polygons_of(features):
    """Features as shapely's polygons, without the bridge under test elsewhere."""
    rings, spans = features.offsets
    shapes = [features.coordinates[a:b] for a, b in pairwise(rings)]
    return [shapely.Polygon(shapes[a], shapes[a + 1 : b]) for a, b in pairwise(spans)]


def lines_of(features):
    (ends,) = features.offsets
    return [features.coordinates[a:b] for a, b in pairwise(ends)]


@pytest.mark.parametrize("origin", [np.zeros(3), UTM])
def test_the_difference_is_a_sound_tin_with_the_exact_volumes(origin):
    tin, other = rough(200, 1, origin=origin), rough(150, 2, origin=origin)
    found, table = ts.difference(tin, other), ts.volume(tin, other)
    assert ts.check(found.tin).ok
    assert found.tin.area == pytest.approx(table["area"][0], rel=1e-9)
    assert found.cut == pytest.approx(table["cut"][0], rel=1e-12)
    assert found.fill == pytest.approx(table["fill"][0], rel=1e-12)
    kinds, volumes = found.zones.columns["kind"], found.zones.columns["volume"]
    assert volumes[kinds == "cut"].sum() == pytest.approx(table["cut"][0], rel=1e-8)
    assert volumes[kinds == "fill"].sum() == pytest.approx(table["fill"][0], rel=1e-8)


def test_its_elevation_is_the_difference_of_the_interpolated_ones():
    tin, other = rough(200, 3), rough(150, 4)
    found = ts.difference(tin, other).tin
    places = np.random.default_rng(0).random((2000, 2)) * 100
    expected = other.interpolate(places) - tin.interpolate(places)
    both = ~np.isnan(expected)
    np.testing.assert_allclose(found.interpolate(places)[both], expected[both], atol=1e-12)
    assert np.isnan(found.interpolate(places)[~both]).all()


def test_exchanged_surfaces_have_the_opposite_difference():
    tin, other = rough(100, 5), rough(100, 6)
    there, back = ts.difference(tin, other), ts.difference(other, tin)
    places = there.tin.points[:, :2]
    np.testing.assert_allclose(
        np.nan_to_num(back.tin.interpolate(places)),
        np.nan_to_num(-there.tin.interpolate(places)),
        atol=1e-12,
    )
    assert there.cut == back.fill


def test_no_triangle_crosses_the_zero_line():
    found = ts.difference(rough(150, 7), rough(150, 8)).tin
    elevations = found.points[found.triangles, 2]
    assert not ((elevations.max(axis=1) > 0) & (elevations.min(axis=1) < 0)).any()
    assert (elevations != 0).any(axis=1).all()


def test_the_zero_line_of_two_pyramids_is_a_square_with_fill_on_its_left():
    found = ts.difference(pyramid(height=3.0, foot=0.0), pyramid(height=-3.0, foot=3.0))
    (line,) = lines_of(found.zero_line)
    assert (line[0] == line[-1]).all()
    np.testing.assert_allclose(np.abs(line).max(axis=1), 1.5, rtol=1e-12)
    assert found.zero_line.columns["length"][0] == pytest.approx(12, rel=1e-12)
    assert not shapely.LinearRing(line).is_ccw  # the cut in the middle is on the right
    (cut,) = np.flatnonzero(found.zones.columns["kind"] == "cut")
    (fill,) = np.flatnonzero(found.zones.columns["kind"] == "fill")
    assert found.zones.columns["volume"][[cut, fill]] == pytest.approx([9, 45], rel=1e-12)
    shape = polygons_of(found.zones)[fill]
    assert len(shape.interiors) == 1
    assert shape.area == pytest.approx(27, rel=1e-12)


def test_where_surfaces_agree_on_an_area_its_border_is_a_line():
    ground = square([0, 0, 0, 0])
    corners = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [3, 2, 1]]
    design = ts.triangulate(corners, breaklines=[[[2, 0, 0], [2, 4, 0]]])
    found = ts.difference(ground, design)
    kinds = found.zones.columns["kind"]
    assert sorted(set(kinds)) == ["fill", "unchanged"]
    areas = found.zones.columns["area"]
    assert areas[kinds == "unchanged"].sum() + areas[kinds == "fill"].sum() == pytest.approx(16)
    border = sum(found.zero_line.columns["length"])
    shapes = polygons_of(found.zones)
    shared = shapely.unary_union([s for s, k in zip(shapes, kinds, strict=True) if k == "fill"])
    still = shapely.unary_union([s for s, k in zip(shapes, kinds, strict=True) if k != "fill"])
    assert border == pytest.approx(shared.boundary.intersection(still.boundary).length)


@pytest.mark.parametrize("seed", range(3))
def test_zones_are_valid_polygons_that_tile_the_overlap(seed):
    found = ts.difference(rough(120, seed), rough(90, seed + 20))
    shapes = polygons_of(found.zones)
    assert all(shape.is_valid for shape in shapes)
    areas = np.array([shape.area for shape in shapes])
    np.testing.assert_allclose(areas, found.zones.columns["area"], rtol=1e-6, atol=1e-10)
    assert shapely.unary_union(shapes).area == pytest.approx(found.tin.area, rel=1e-9)


def test_the_zero_line_is_the_border_between_zones():
    found = ts.difference(rough(120, 30), rough(90, 31))
    kinds = found.zones.columns["kind"]
    shapes = polygons_of(found.zones)
    cut, fill = (
        shapely.unary_union([s for s, k in zip(shapes, kinds, strict=True) if k == kind])
        for kind in ("cut", "fill")
    )
    border = cut.boundary.intersection(fill.boundary).length
    assert found.zero_line.columns["length"].sum() == pytest.approx(border, rel=1e-6)


def test_a_zone_that_surrounds_another_up_to_a_vertex_is_valid():
    """Its boundary was one ring that went through this vertex twice."""
    flat = square([0] * 4)
    rim = [[0, 0, 1], [2, 0, 0], [4, 0, 1], [4, 4, 1], [0, 4, 1]]
    same = [[2, 0, 0], [3, 2, 0], [1, 2, 0], [2, 0, 0]]
    zones = ts.difference(flat, ts.triangulate(rim, breaklines=[same])).zones
    found = dict(zip(zones.columns["kind"].tolist(), polygons_of(zones), strict=True))
    assert all(shape.is_valid for shape in found.values())
    assert {kind: shape.area for kind, shape in found.items()} == {"fill": 14.0, "unchanged": 2.0}
    assert len(found["fill"].interiors) == 1


# ---------------------------------------------------------------------- statistics


def test_statistics_of_a_ramp_are_those_of_a_uniform_distribution():
    """The difference runs evenly from -1 to 3."""
    table = ts.difference(square([1] * 4), square([0, 4, 4, 0])).statistics
    expected = {
        "mean": 1.0,
        "rms": math.sqrt(1 + 16 / 12),
        "standard_deviation": math.sqrt(16 / 12),
        "mean_absolute": (0.5 * 1 * 0.25) + (0.5 * 3 * 0.75),
        "lowest": -1.0,
        "highest": 3.0,
        "p05": -0.8,
        "p25": 0.0,
        "median": 1.0,
        "p75": 2.0,
        "p95": 2.8,
        "nmad": 1.4826,
        "area": 16.0,
    }
    assert {name: float(values[0]) for name, values in table.columns.items()} == pytest.approx(
        expected, rel=1e-12, abs=1e-12
    )


def test_percentiles_of_a_cone_follow_its_areas():
    """Under a height h of a pyramid lies the share 1 - (1 - h)^2 of its area."""
    found = ts.difference(pyramid(height=0.0, foot=0.0), pyramid(height=1.0, foot=0.0))
    shares = np.array([0, 10, 50, 90, 100])
    np.testing.assert_allclose(
        found.percentiles(shares), 1 - np.sqrt(1 - shares / 100), rtol=1e-9, atol=1e-12
    )


def test_percentiles_are_those_of_a_fine_sample():
    tin, other = rough(60, 40), rough(60, 41)
    found = ts.difference(tin, other)
    places = np.random.default_rng(0).random((200_000, 2)) * 100
    heights = other.interpolate(places) - tin.interpolate(places)
    expected = np.percentile(heights[~np.isnan(heights)], [5, 25, 50, 75, 95])
    assert found.percentiles([5, 25, 50, 75, 95]) == pytest.approx(expected, abs=0.01)


def test_the_nmad_is_that_of_a_fine_sample_and_0_where_most_has_not_changed():
    tin, other = rough(60, 40), rough(60, 41)
    places = np.random.default_rng(0).random((200_000, 2)) * 100
    heights = other.interpolate(places) - tin.interpolate(places)
    heights = heights[~np.isnan(heights)]
    expected = 1.4826 * np.median(np.abs(heights - np.median(heights)))
    found = ts.difference(tin, other).statistics["nmad"][0]
    assert found == pytest.approx(expected, abs=0.01)
    raised = ts.difference(tin, tin.transform(lambda points: points + np.array([0, 0, 0.25])))
    assert raised.statistics["median"][0] == pytest.approx(0.25)
    assert raised.statistics["nmad"][0] == pytest.approx(0.0, abs=1e-12)
    hill = square([0] * 4)
    assert ts.difference(hill, hill).statistics["nmad"][0] == 0.0


def test_an_area_without_change_is_a_step_of_the_percentiles():
    ground = square([0] * 4)
    step = ts.TIN.from_triangles(
        [[0, 0, 0], [2, 0, 0], [2, 4, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2]],
        [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]],
    )
    found = ts.difference(ground, step)
    np.testing.assert_allclose(found.percentiles([0, 25, 50, 75, 100]), [0, 0, 0, 1, 2], atol=1e-12)


@pytest.mark.parametrize("shares", [[-1], [101], [math.nan], "half", 5])
def test_percentiles_that_are_none_are_refused(shares):
    with pytest.raises(ts.OptionError, match="numbers from 0 to 100"):
        ts.difference(square([1] * 4), square([0, 4, 4, 0])).percentiles(shares)


# ---------------------------------------------------------------------- hard cases


@given(small_surfaces, small_surfaces, st.sampled_from([1.0, 0.25]), st.booleans())
def test_differences_of_small_grids_are_sound(points, others, scale, is_far):
    """Vertices on edges, edges on each other; crossings are rounded."""
    try:
        tin, other = (
            ts.triangulate(np.array(xyz) * scale + UTM * is_far) for xyz in (points, others)
        )
    except ts.PointsError:
        assume(False)
    table = ts.volume(tin, other)
    assume(table["area"][0] > 1e-6)
    found = ts.difference(tin, other)
    assert ts.check(found.tin).ok
    zones = found.zones.columns
    for kind, volume in (("cut", found.cut), ("fill", found.fill)):
        assert zones["volume"][zones["kind"] == kind].sum() == pytest.approx(volume, abs=1e-6)


@pytest.mark.slow
def test_a_design_with_vertices_on_edges_of_the_ground_is_subtracted():
    """As a program makes it that computes daylight points: on the edges but for rounding."""
    ground = rough(300, 50, origin=UTM)
    edges = ground.edges[:: len(ground.edges) // 60]
    share = np.random.default_rng(1).random((len(edges), 1))
    on_edges = ground.points[edges[:, 0]] + share * (
        ground.points[edges[:, 1]] - ground.points[edges[:, 0]]
    )
    found = ts.difference(ground, ts.triangulate(on_edges))
    assert ts.check(found.tin).ok
    kept = found.tin.interpolate(on_edges[:, :2])
    assert np.nanmax(np.abs(kept)) < 1e-6


def test_a_wall_of_one_rounding_is_subtracted():
    wall = [
        [1.0, 0, 0],
        [0.1, 1.0, 0],
        [1 / 3, 2 / 3, 0],
        [np.nextafter(1 / 3, 0), np.nextafter(2 / 3, 0), 644],
    ]
    ground = [[0.3, 15.0, 0], [0.1, 0, 0], [0, 0, 0]]
    tin, other = ts.triangulate(ground), ts.triangulate(wall)
    found, volume = ts.difference(tin, other), ts.volume(tin, other)
    assert ts.check(found.tin).ok
    assert found.tin.area == pytest.approx(volume["area"][0], abs=1e-15)
    assert (found.cut, found.fill) == (volume["cut"][0], volume["fill"][0])


def test_walls_thinner_than_rounding_are_refused():
    ground = [
        [1.0336479412594338e17, -0.15634202208331283, 3.0],
        [-15598271020717.594, -1.2831047343797965e19, 3.0],
        [-1.53439544386518e28, -1.332709236434574e-23, 3.0],
    ]
    wall = [
        [1.144897596257742e59, -1.8028027087038767e43, 4.0],
        [-1.400701662182006e-58, 1.31538072620857e-47, 4.0],
        [1.0806810080139007e-06, -15954112808.24771, 3.0],
    ]
    with pytest.raises(ts.PointsError, match="have walls that are thinner than coordinates"):
        ts.difference(ts.triangulate(ground), ts.triangulate(wall))


def test_a_step_at_edges_that_meet_but_for_a_rounding_keeps_both_elevations():
    """Merging the places of top and foot gave one of the sides the other's elevation."""
    ground = [[1039, 948, 3], [1065, 1000, 3], [1033, 1056, 3], [1025, 1060, 3], [967, 944, 3]]
    design = [[1025, 1060, 4], [967, 944, 4], [1065, 1000, 3], [976.8, 949.6, 3]]
    tin, other = ts.triangulate(ground), ts.triangulate([*design, [967, 944, 3]], duplicates="mean")
    found = ts.difference(tin, other)
    assert ts.check(found.tin).ok
    volume = ts.volume(tin, other)
    relief = abs(found.tin.points[:, 2]).max()
    within = 1e-7 * volume["area"][0] * relief
    zones = found.zones.columns
    for kind in ("cut", "fill"):
        assert zones["volume"][zones["kind"] == kind].sum() == pytest.approx(
            volume[kind][0], abs=within
        )


def test_an_overlay_of_too_many_vertices_is_refused(monkeypatch):
    def overlay(*_, **__):
        raise OverflowError

    monkeypatch.setattr("tinsmith.terrain._kernel.overlay", overlay)
    with pytest.raises(ts.PointsError, match="more than 536,870,911 vertices: subtract parts"):
        ts.difference(square([0] * 4), square([1] * 4))


def test_surfaces_apart_are_refused():
    with pytest.raises(ts.PointsError, match="do not overlap: one covers 0 to 4 east"):
        ts.difference(square([0] * 4), square([0] * 4, origin=(4.0, 0.0, 0.0)))


def test_surfaces_that_overlap_by_less_than_a_rounding_have_no_difference():
    """Two edges in one line but for a rounding: a cell without area, whose mean is none."""
    one = [
        [4078.3417448927994, 407.83417448928, 3.0],
        [0.0, 6573.0, 3.0],
        [89228.1090155054, 8922.81090155054, 3.0],
    ]
    other = [
        [24630.0, 2463.0, 3.0],
        [4078.34, 407.8, 3.0],
        [65734.51693023487, 6573.451693023487, 3.0],
    ]
    tin, design = ts.triangulate(one), ts.triangulate(other)
    assert ts.volume(tin, design)["area"].tolist() == [0.0]
    with pytest.raises(ts.PointsError, match="only in what is thinner than coordinates can tell"):
        ts.difference(tin, design)


@pytest.mark.parametrize(
    ("points", "share"),
    [
        ([[0, 0, 10.0], [3.21, 0.4, 871.2], [2.9, 2.7, 33.3], [0.11, 1.9, 412.0]], 1 / 3),
        ([[0, 0, 10.0], [31.7, 4, 71.2], [29, 27.1, 33.3], [1.1, 19, 41.4]], 0.1),
    ],
)
def test_surfaces_that_agree_but_for_rounding_have_a_difference(points, share):
    """What differs is rounding alone, and was measured by itself: it was refused as a wall."""
    utm = np.array(points) + np.array([512_345.0, 5_403_210.0, 0.0])
    tin = ts.triangulate(utm)
    corners = tin.points[tin.triangles]
    middle = corners[:, 0] + share * (corners[:, 1] - corners[:, 0])
    other = ts.triangulate(np.concatenate([utm, middle]))
    found = ts.difference(tin, other)
    assert ts.check(found.tin).ok
    assert found.tin.area == pytest.approx(tin.area, rel=1e-9)
    assert max(found.cut, found.fill) < 1e-4


# --------------------------------------------------------------------- turned grids


def turned_grid(side, degrees, *, origin=(0.0, 0.0), digits=None):
    """A design grid whose boundary points are collinear, but for the rounding of coordinates."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(float(side)), np.arange(float(side))))
    turn = np.deg2rad(degrees)
    east = x * np.cos(turn) - y * np.sin(turn) + origin[0]
    north = x * np.sin(turn) + y * np.cos(turn) + origin[1]
    z = np.sin(x / 9) * 3 + np.cos(y / 7) * 2
    points = np.column_stack([east, north, z])
    return ts.triangulate(points if digits is None else points.round(digits))


@pytest.mark.each_value
@pytest.mark.parametrize("digits", [None, 3, 2])
@pytest.mark.parametrize("origin", [(0.0, 0.0), (500_000.0, 4_000_000.0)])
@pytest.mark.parametrize("degrees", [3.0, 30.0, 45.0, 71.1])
def test_turned_grids_are_subtracted(degrees, origin, digits):
    """They were refused: elevations on the slivers of their hulls are those of no wall."""
    tin = turned_grid(17, degrees, origin=origin, digits=digits)
    shifted = (origin[0] + 0.37, origin[1] + 2.1)
    other = turned_grid(23, degrees + 17.0, origin=shifted, digits=digits)
    table, found = ts.volume(tin, other), ts.difference(tin, other)
    require_agreement(found, table)
    places = tin.points[:, :2] + [0.2, 0.1]
    both = (tin.locate(places) >= 0) & (other.locate(places) >= 0)
    expected = other.interpolate(places) - tin.interpolate(places)
    np.testing.assert_allclose(found.tin.interpolate(places)[both], expected[both], atol=1e-7)


def require_agreement(found, table):
    area = table["area"][0]
    assert ts.check(found.tin).ok
    assert (found.cut, found.fill) == (table["cut"][0], table["fill"][0])
    assert found.statistics["area"][0] == area
    assert found.tin.area == pytest.approx(area, rel=1e-7)
    zones = found.zones.columns
    for kind in ("cut", "fill"):
        assert zones["volume"][zones["kind"] == kind].sum() == pytest.approx(
            table[kind][0], abs=1e-6 * area
        )
    shapes = polygons_of(found.zones)
    assert all(shape.is_valid for shape in shapes)
    assert sum(shape.area for shape in shapes) == pytest.approx(area, rel=1e-7)
    assert shapely.union_all(shapes).area == pytest.approx(area, rel=1e-7)
    lowest, highest = (found.statistics[name][0] for name in ("lowest", "highest"))
    heights = found.tin.points[:, 2]
    assert lowest - 1e-6 <= heights.min() <= heights.max() <= highest + 1e-6


def test_four_points_in_centimetres_three_of_them_on_a_slanted_line_are_subtracted():
    ground = [[0.96, 0.29, 2.33], [1.91, 0.58, 2.66], [1.62, 1.54, 2.64], [1.33, 2.5, 2.58]]
    design = [[2.12, 0.66, 2.66], [1.29, 1.22, 2.64], [-0.1, 0.95, 2.25], [0.46, 1.78, 2.58]]
    tin, other = ts.triangulate(ground), ts.triangulate(design)
    require_agreement(ts.difference(tin, other), ts.volume(tin, other))


def test_a_surface_along_a_slanted_line_is_subtracted():
    """The points of y = x / 3 in doubles make slivers behind slivers."""
    x = np.arange(120.0)
    points = np.vstack([np.column_stack([x, x / 3, np.sin(x)]), [[60.0, 240.0, 0.0]]])
    tin, other = ts.triangulate(points), ts.triangulate(points + np.array([0.125, 0.125, 0.0]))
    require_agreement(ts.difference(tin, other), ts.volume(tin, other))


def test_surfaces_that_overlap_in_a_sliver_alone_are_too_thin():
    above = [2.0, np.nextafter(1.0, 2.0), 5.0]
    upper = ts.triangulate([[1, 1, 0], [3, 1, 0], [2, 3, 0]])
    corners = [[1, 1, 2], [2, -1, 2], [3, 1, 2], above]
    lower = ts.TIN.from_triangles(corners, [[0, 1, 2], [0, 2, 3]])
    assert 0.0 < ts.volume(upper, lower)["area"][0] < 1e-15
    with pytest.raises(ts.PointsError, match="overlap only in what is thinner"):
        ts.difference(upper, lower)
