"""Cut and fill against closed forms, fractions and shapely's overlay; regions, units, refusals."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from support.each_value import list_seeds
from support.earthwork_oracle import exact_heights, exact_volume
from support.point_sets import small_surfaces

import tinsmith as ts

UTM = np.array([752_640.0, 4_024_180.0, 320.0])
NAMES = ("area", "cut_area", "fill_area", "cut", "fill")
ORIGINS = [np.zeros(3), UTM]


def square(elevations, *, side=4.0, origin=(0.0, 0.0, 0.0)):
    """A square by its four corners' elevations, counter-clockwise from the south-west."""
    corners = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    return ts.triangulate(np.column_stack([corners, elevations]) + origin)


def pyramid(*, half=3.0, height=3.0, foot=0.0, origin=(0.0, 0.0, 0.0)):
    corners = [[-half, -half, foot], [half, -half, foot], [half, half, foot], [-half, half, foot]]
    return ts.triangulate(np.array([*corners, [0, 0, foot + height]]) + origin)


def cone(n, *, radius=5.0, height=2.0):
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(n)])
    return ts.triangulate(np.vstack([rim, [0, 0, height]]))


def rough(n, seed, *, size=100.0, origin=(0.0, 0.0, 0.0)):
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * size
    return ts.triangulate(np.column_stack([xy, np.sin(xy[:, 0] / 9) + rng.random(n)]) + origin)


def one(table, name):
    assert len(table) == 1
    return float(table[name][0])


# ----------------------------------------------------------------- closed forms


@pytest.mark.parametrize("origin", ORIGINS)
def test_a_ramp_and_a_level_surface_make_two_prisms(origin):
    flat, ramp = square([3, 3, 3, 3], origin=origin), square([0, 8, 8, 0], origin=origin)
    table = ts.volume(flat, ramp)
    # 2 (x - 1.5) over 4 m: cut over 1.5 m, fill over 2.5 m.
    assert one(table, "cut") == pytest.approx(4 * 1.5**2, rel=1e-9)
    assert one(table, "fill") == pytest.approx(4 * 2.5**2, rel=1e-9)
    assert one(table, "cut_area") == pytest.approx(6, rel=1e-9)
    assert one(table, "net") == pytest.approx(16, rel=1e-9)
    assert one(table, "mean") == pytest.approx(1, rel=1e-9)
    assert one(table, "base_surface_area") == pytest.approx(16 * math.sqrt(5), rel=1e-9)
    assert one(table, "surface_area") == pytest.approx(16, rel=1e-9)


@pytest.mark.parametrize("origin", ORIGINS)
@pytest.mark.parametrize("level", [0.0, 0.75, 1.5, 3.0])
def test_a_pyramid_above_a_level(origin, level):
    found = ts.volume(pyramid(origin=origin), base=level + origin[2])
    above = (1 - level / 3) ** 3 * 36
    assert one(found, "cut") == pytest.approx(above, rel=1e-9, abs=1e-12)
    assert one(found, "fill") == pytest.approx(above + 36 * level - 36, rel=1e-9, abs=1e-8)
    assert one(found, "cut_area") == pytest.approx((6 - 2 * level) ** 2, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("origin", ORIGINS)
def test_a_pyramid_and_its_counterpart(origin):
    """Both are linear in the greater distance r of the two axes: 3 - r and r."""
    up, down = pyramid(origin=origin), pyramid(height=-3.0, foot=3.0, origin=origin)
    found = ts.volume(up, down)
    assert one(found, "cut") == pytest.approx(9, rel=1e-9)
    assert one(found, "fill") == pytest.approx(45, rel=1e-9)
    assert one(found, "cut_area") == pytest.approx(9, rel=1e-9)


@pytest.mark.parametrize("n", [3, 7, 360])
def test_a_plane_under_a_cone(n):
    table = ts.volume(cone(n), base=[[0, 0, -4], [1, 0, -3.7], [0, 1, -3.9]])
    area = n / 2 * math.sin(2 * math.pi / n) * 25
    assert one(table, "area") == pytest.approx(area, rel=1e-9)
    # The plane's mean over a regular polygon is its elevation in the middle.
    assert one(table, "cut") == pytest.approx(area * (2 / 3 + 4), rel=1e-9)
    assert one(table, "fill") == 0.0
    assert one(table, "base_surface_area") == pytest.approx(area * math.sqrt(1.1), rel=1e-9)


def test_a_plane_and_a_tin_on_it_measure_the_same():
    tin = rough(300, 1)
    plane = [[0, 0, 0.2], [100, 0, 1.4], [0, 100, 0.8]]
    other = ts.triangulate([*plane, [100, 100, 2.0], [50, 50, 1.1], [30, 20, 0.68]])
    by_plane, by_tin = ts.volume(tin, base=plane), ts.volume(tin, other)
    for name in NAMES:
        assert one(by_plane, name) == pytest.approx(one(by_tin, name), rel=1e-11)


def test_surfaces_that_agree_have_no_volume():
    """Coplanar, but triangulated otherwise: every difference is exactly 0."""
    rng = np.random.default_rng(5)
    xy = rng.integers(0, 40, (60, 2)).astype(float)
    corners = np.array([[0, 0], [40, 0], [40, 40], [0, 40]], float)
    tins = [
        ts.triangulate(np.column_stack([places, 3 * places[:, 0] - 7 * places[:, 1]]))
        for places in (np.vstack([corners, xy[:30]]), np.vstack([corners, xy[30:]]))
    ]
    found = ts.volume(*tins)
    assert one(found, "area") == 1600.0
    assert one(found, "unchanged_area") == 1600.0
    assert [one(found, name) for name in ("cut", "fill", "cut_area", "fill_area")] == [0.0] * 4


def test_a_surface_and_itself_have_no_volume():
    tin = rough(500, 2, origin=UTM)
    found = ts.volume(tin, tin)
    assert one(found, "cut") == one(found, "fill") == 0.0
    assert one(found, "area") == pytest.approx(tin.area, rel=1e-12)
    assert one(found, "surface_area") == pytest.approx(tin.surface_area, rel=1e-12)


# ------------------------------------------------------------ independent opinions


def built(points):
    try:
        return ts.triangulate(np.array(points, float))
    except ts.PointsError:
        return None


@given(small_surfaces, small_surfaces, st.integers(0, 2**8 - 1))
def test_volumes_are_those_in_fractions(points, others, kept):
    """Shared vertices, edges on each other, vertices on edges, flats, parts cut away."""
    tin, other = built(points), built(others)
    assume(tin is not None and other is not None)
    chosen = np.array([kept >> (k % 8) & 1 for k in range(len(tin.triangles))], bool)
    if chosen.any():
        tin = ts.TIN.from_triangles(tin.points, tin.triangles[chosen])
    found, exact = ts.volume(tin, other), exact_volume(tin, other)
    for name in NAMES:
        true = getattr(exact, name)
        assert one(found, name) == pytest.approx(float(true), rel=1e-12)
        assert (one(found, name) == 0.0) == (true == 0)


@given(small_surfaces, st.fractions(-2, 2, max_denominator=8))
def test_volumes_above_a_level_are_those_in_fractions(points, level):
    tin = built(points)
    assume(tin is not None)
    found, exact = ts.volume(tin, base=float(level)), exact_heights(tin, lambda x, y, z: level - z)
    for name in NAMES:
        assert one(found, name) == pytest.approx(float(getattr(exact, name)), rel=1e-12)


def test_the_oracle_knows_a_wedge():
    exact = exact_volume(square([0, 0, 0, 0], side=2.0), square([-1, 1, 1, -1], side=2.0))
    assert exact.fill == exact.cut == Fraction(1)
    assert exact.squares == Fraction(4, 3)


def overlaid_by_shapely(tin, other):
    """Integrate over the intersections that GEOS finds, clipped at the zero line by it as well."""
    ours, theirs = (shapely.polygons(t.points[t.triangles, :2]) for t in (tin, other))
    pairs = shapely.STRtree(theirs).query(ours, predicate="intersects").T
    total = {"area": 0.0, "cut": 0.0, "fill": 0.0}
    for a, b in pairs:
        cell = shapely.intersection(ours[a], theirs[b])
        if cell.geom_type != "Polygon" or cell.is_empty:
            continue
        plane = gradient(other, b) - gradient(tin, a)
        total["area"] += cell.area
        for name, sign in (("fill", 1.0), ("cut", -1.0)):
            part = above(cell, sign * plane)
            total[name] += (
                part.area * (sign * plane @ [part.centroid.x, part.centroid.y, 1.0])
                if (part.area > 0)
                else 0.0
            )
    return total


def gradient(tin, triangle):
    xyz = tin.points[tin.triangles[triangle]]
    return np.linalg.solve(np.column_stack([xyz[:, :2], np.ones(3)]), xyz[:, 2])


def above(cell, plane):
    """The part of a convex polygon where a linear function is positive."""
    kept = []
    corners = np.array(cell.exterior.coords)
    values = corners @ plane[:2] + plane[2]
    for p, q, u, v in zip(corners, corners[1:], values, values[1:], strict=False):
        kept += [p] if u >= 0 else []
        kept += [p + u / (u - v) * (q - p)] if u * v < 0 else []
    return shapely.Polygon(kept) if len(kept) > 2 else shapely.Polygon()


@pytest.mark.parametrize("seed", [1, 2])
def test_volumes_are_those_of_shapelys_overlay(seed):
    tin, other = rough(150, seed), rough(150, seed + 50)
    expected, found = overlaid_by_shapely(tin, other), ts.volume(tin, other)
    for name, value in expected.items():
        assert one(found, name) == pytest.approx(value, rel=1e-9)


# ---------------------------------------------------------------------- symmetries


def test_exchanged_surfaces_exchange_cut_and_fill_to_the_last_bit():
    tin, other = rough(400, 3, origin=UTM), rough(300, 4, origin=UTM + np.array([7.0, -3.0, 0.4]))
    there, back = ts.volume(tin, other), ts.volume(other, tin)
    for name, opposite in (("cut", "fill"), ("cut_area", "fill_area"), ("area", "area")):
        assert one(there, name) == one(back, opposite)
        assert one(there, opposite) == one(back, name)
    assert one(there, "net") == -one(back, "net")
    assert one(there, "lowest") == -one(back, "highest")
    assert one(there, "area_alone") == one(back, "base_area_alone")


def test_order_and_threads_change_no_bit():
    tin, other = rough(400, 5, origin=UTM), rough(300, 6, origin=UTM)
    rng = np.random.default_rng(0)
    number = rng.permutation(len(tin.points))
    moved = np.empty_like(tin.points)
    moved[number] = tin.points
    corners = np.roll(number[tin.triangles][rng.permutation(len(tin.triangles))], 1, axis=1)
    shuffled = ts.TIN.from_triangles(moved, corners)
    expected = ts.volume(tin, other, threads=1)
    for again in (ts.volume(shuffled, other), ts.volume(tin, other, threads=3)):
        assert all(
            one(again, name) == one(expected, name) for name in expected.columns if name != "region"
        )


# ------------------------------------------------------------------------- regions

QUARTERS = {
    "sw": [[0, 0], [60, 0], [60, 45], [0, 45]],
    "se": [[60, 0], [100, 0], [100, 45], [60, 45]],
    "north": shapely.Polygon(
        [(0, 45), (100, 45), (100, 100), (0, 100)], [[(30, 60), (50, 60), (50, 80), (30, 80)]]
    ),
    "island": [[30, 60], [50, 60], [50, 80], [30, 80]],
}


@pytest.mark.parametrize("origin", ORIGINS)
def test_regions_add_up_to_the_whole(origin):
    tin, other = rough(300, 7, origin=origin), rough(300, 8, origin=origin)
    regions = {
        name: shapely.transform(shapely.Polygon(shape), lambda xy: xy + origin[:2])
        for name, shape in QUARTERS.items()
    }
    whole, parts = ts.volume(tin, other), ts.volume(tin, other, regions=regions)
    assert parts["region"].tolist() == list(QUARTERS)
    for name in (*NAMES, "surface_area", "base_surface_area", "area_alone"):
        assert parts[name].sum() == pytest.approx(one(whole, name), rel=1e-9, abs=1e-6)
    assert not any("overlap" in note for note in parts.notes)
    level = ts.volume(tin, base=0.5 + origin[2], regions=regions)
    assert level["cut"].sum() == pytest.approx(
        one(ts.volume(tin, base=0.5 + origin[2]), "cut"), rel=1e-9
    )


def test_a_region_is_the_surface_clipped_to_it():
    flat, ramp = square([0, 0, 0, 0]), square([0, 4, 4, 0])
    table = ts.volume(flat, ramp, regions={"west": [[-1, 0], [2, 0], [2, 4], [-1, 4]]})
    assert one(table, "fill") == pytest.approx(8, rel=1e-12)
    assert one(table, "area") == pytest.approx(8, rel=1e-12)


def test_regions_are_taken_from_features_geojson_and_rings():
    flat, ramp = square([0, 0, 0, 0]), square([0, 4, 4, 0])
    ring = [[0, 0], [2, 0], [2, 4], [0, 4], [0, 0]]
    features = ts.Features.of_polygons(ring, [0, 5], [0, 1], columns={"name": ["west"]})
    feature = {
        "type": "Feature",
        "properties": {"Name": "west"},
        "geometry": shapely.Polygon(ring).__geo_interface__,
    }
    collection = {"type": "FeatureCollection", "features": [feature]}
    for regions, name in (
        (features, "west"),
        (collection, "west"),
        ([ring], "1"),
        ({"a": ring}, "a"),
    ):
        table = ts.volume(flat, ramp, regions=regions)
        assert table["region"].tolist() == [name]
        assert one(table, "fill") == pytest.approx(8, rel=1e-12)


def test_regions_that_overlap_are_told():
    flat, ramp = square([0, 0, 0, 0]), square([0, 4, 4, 0])
    west, middle = [[0, 0], [2, 0], [2, 4], [0, 4]], [[1, 0], [3, 0], [3, 4], [1, 4]]
    (note,) = [
        one for one in ts.volume(flat, ramp, regions=[west, middle]).notes if "overlap" in one
    ]
    assert note.startswith("2 of the regions overlap others, by 4 in all")


def test_a_region_outside_has_nothing():
    table = ts.volume(square([0] * 4), square([1] * 4), regions=[[[9, 9], [10, 9], [9, 10]]])
    assert one(table, "area") == one(table, "fill") == 0.0
    assert np.isnan(one(table, "mean"))


@pytest.mark.parametrize(
    ("regions", "part"),
    [
        ({}, "number of regions"),
        ({"a": [[0, 0], [4, 4], [4, 0], [0, 4]]}, "region 'a' is no sound polygon"),
        (shapely.Point(1, 1), "Point is no polygon"),
        (7, "Invalid regions"),
    ],
)
def test_unsound_regions_are_refused(regions, part):
    with pytest.raises(ts.TinsmithError, match=part):
        ts.volume(square([0] * 4), square([1] * 4), regions=regions)


# ------------------------------------------------------------- coverage and units


def test_what_lies_outside_either_surface_is_reported():
    table = ts.volume(square([0] * 4), square([1] * 4, origin=(3.0, 2.0, 0.0), side=6.0))
    assert one(table, "area") == pytest.approx(2, rel=1e-12)
    assert one(table, "area_alone") == pytest.approx(14, rel=1e-12)
    assert one(table, "base_area_alone") == pytest.approx(34, rel=1e-12)


def test_surfaces_that_do_not_overlap_have_no_area_in_common():
    table = ts.volume(square([0] * 4), square([1] * 4, origin=(4.0, 0.0, 0.0)))
    assert one(table, "area") == one(table, "cut") == one(table, "fill") == 0.0
    assert one(table, "area_alone") == one(table, "base_area_alone") == 16.0
    assert np.isnan(one(table, "lowest"))


def test_clipped_surfaces_of_several_parts_count_where_they_are():
    tin, other = rough(200, 9), rough(200, 10)
    is_west = other.points[other.triangles].mean(axis=1)[:, 0] < 40
    west, east = (
        ts.TIN.from_triangles(other.points, other.triangles[chosen])
        for chosen in (is_west, ~is_west)
    )
    whole = ts.volume(tin, other)
    for name in NAMES:
        both = one(ts.volume(tin, west), name) + one(ts.volume(tin, east), name)
        assert both == pytest.approx(one(whole, name), rel=1e-11)


def test_units_are_those_of_the_crs_and_elevations_are_converted():
    tennessee = "EPSG:2274"  # US survey feet
    flat = square([0] * 4).replace(crs=tennessee, elevation_unit="US survey foot")
    metric = square([0.3048006096012192] * 4).replace(crs=tennessee, elevation_unit="m")
    table = ts.volume(flat, metric)
    assert one(table, "fill") == pytest.approx(16, rel=1e-12)
    assert table.units["fill"] == "US ft³"
    assert any("converted from metre to US survey foot" in note for note in table.notes)
    back = ts.volume(metric, flat)
    assert one(back, "cut") == pytest.approx(16, rel=1e-12)  # cubic feet still
    assert one(back, "mean") == pytest.approx(-0.3048006096012192, rel=1e-12)
    assert back.units["mean"].name == "metre"


def test_unknown_units_are_written_so():
    table = ts.volume(square([0] * 4), square([1] * 4))
    assert table.units["cut"] is None
    assert table.units["area"] is None


@pytest.mark.parametrize(
    ("ours", "theirs", "part"),
    [
        ({"crs": "EPSG:32616"}, {}, "CRS of the other surface is not known"),
        ({}, {"crs": "EPSG:32616"}, "CRS of the first surface is not known"),
        (
            {"crs": "EPSG:32616"},
            {"crs": "EPSG:32617"},
            "EPSG:32616 and the other surface in EPSG:32617",
        ),
        ({"crs": "EPSG:4326"}, {"crs": "EPSG:4326"}, "cannot be measured in degrees"),
        (
            {"crs": "EPSG:2274", "elevation_unit": "m"},
            {"crs": "EPSG:2274"},
            "never mixed on a guess",
        ),
        ({"crs": "EPSG:2274+6360"}, {"crs": "EPSG:2274+8228"}, "one vertical CRS"),
    ],
)
def test_surfaces_that_cannot_be_compared_are_refused(ours, theirs, part):
    tin, other = square([0] * 4).replace(**ours), square([1] * 4).replace(**theirs)
    with pytest.raises(ts.CrsError, match=part):
        ts.volume(tin, other)
    with pytest.raises(ts.CrsError, match=part):
        ts.difference(tin, other)


@pytest.mark.parametrize(
    "base", [None, "high", [1, 2], math.nan, math.inf, [[0, 0, 1], [1, 1, 2], [2, 2, 5]], True]
)
def test_a_base_that_is_none_is_refused(base):
    with pytest.raises(ts.OptionError, match="Invalid base"):
        ts.volume(square([0] * 4), base=base)


def test_a_base_and_another_surface_are_refused():
    with pytest.raises(ts.OptionError, match="one of them"):
        ts.volume(square([0] * 4), square([1] * 4), base=3.0)


def test_elevations_beyond_double_precision_are_refused():
    with pytest.raises(ts.PointsError, match="too large"):
        ts.volume(square([0] * 4, side=1e5), square([1e300] * 4, side=1e5))


@pytest.mark.parametrize("seed", list_seeds(3, few=1))
def test_surfaces_that_share_most_of_their_triangles(seed):
    """Shared ones meet no others; numbered and turned in another way they are the same."""
    rng = np.random.default_rng(seed)
    tin = rough(60, seed)
    points = np.add(tin.points, [0, 0, 0.1])
    inner = np.setdiff1d(np.arange(len(points)), tin.hull)[:6]
    points[inner] += rng.random((6, 3))
    other = ts.triangulate(points)
    shared = {frozenset(map(tuple, corners)) for corners in tin.points[tin.triangles, :2].tolist()}
    kept = [
        frozenset(map(tuple, corners)) in shared
        for corners in other.points[other.triangles, :2].tolist()
    ]
    assert 0.2 < np.mean(kept) < 1.0
    turned = rng.permutation(other.triangles)[:, [1, 2, 0]]
    exact = exact_volume(tin, other)
    for version in (other, ts.TIN.from_triangles(other.points, turned)):
        for name in NAMES:
            expected = float(getattr(exact, name))
            assert one(ts.volume(tin, version), name) == pytest.approx(expected, rel=1e-12)
            found = ts.difference(tin, version).volumes
            assert one(found, name) == pytest.approx(expected, rel=1e-12)
