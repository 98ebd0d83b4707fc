"""Viewsheds: each vertex in fractions and by a line of its own, and GDAL's on a fine raster."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from support.point_sets import grid, seeds, whole_number_grid
from support.sight_oracle import find_first_block, require_parts_as_lines
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts
from tinsmith.terrain.sight.lines import as_view, measure_distances
from tinsmith.terrain.sight.vertices import judge_vertices, look_one_by_one, see_vertices


@settings(max_examples=8, deadline=None)
@given(seeds, st.integers(1, 4), st.sampled_from([0.0, 0.5]))
def test_vertices_that_are_seen_are_those_of_brute_force(seed, relief, height):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(6, relief, rng)
    eye = rng.integers(0, 11, 2) / 2
    seen = ts.visible_vertices(tin, eye, eye_height=height)
    start = [*eye, float(tin.interpolate([eye])[0]) + height]
    for vertex, point in enumerate(tin.points.tolist()):
        is_eye = point[:2] == start[:2]
        block = None if is_eye else find_first_block(tin.points, tin.edges, start, point)
        assert seen[vertex] == (block is None)


def require_same_as_lines(tin, eye, fall=0.0, heights=(0.0, 0.0), radius=None):
    """Hold all vertices against lines of sight that are traced one by one."""
    view, _ = as_view(tin, eye, heights, radius, fall)
    distances = measure_distances(tin.points, view.eye)
    asked = np.flatnonzero((distances > 0) & (distances <= view.radius))
    asked = np.intersect1d(asked, tin.triangles)
    asked = asked[np.argsort(distances[asked])]
    seen = see_vertices(tin, view)
    assert seen[asked].tolist() == look_one_by_one(tin, view, asked).tolist()
    others = np.setdiff1d(np.arange(len(tin.points)), asked)
    assert (seen[others] <= (distances[others] == 0)).all()


def make_surface(rng, kind):
    """Make a grid with many equal heights, scattered points far from the origin, or a ramp."""
    if kind == "grid":
        return whole_number_grid(rng, 9, 9, 3)
    if kind == "ramp":
        x, y = grid(9, 9).T
        return np.column_stack([x, y, x / 2 + y / 4 + (rng.random(len(x)) < 0.1)])
    corner = np.array([500_000.3, 4_000_000.7, 200.1])
    return corner + rng.uniform(0, [50, 50, 8], (81, 3))


@settings(max_examples=30, deadline=None)
@given(
    seeds,
    st.sampled_from(["grid", "ramp", "scattered"]),
    st.sampled_from([None, 1.2, 8.0]),
    st.sampled_from([0.0, 1e-7, 1e-3]),
)
def test_the_sweep_sees_what_lines_see(seed, kind, max_edge, fall):
    rng = np.random.default_rng(seed)
    points = make_surface(rng, kind)
    try:
        tin = ts.triangulate(points, max_edge=max_edge)
    except ts.LinesError:  # scattered points are farther apart
        tin = ts.triangulate(points)
    eye = tin.points[rng.choice(np.unique(tin.triangles)), :2]
    if rng.random() < 0.5:
        corners = tin.points[tin.triangles[rng.integers(len(tin.triangles))], :2]
        eye = rng.dirichlet([1, 1, 1]) @ corners
    heights = rng.choice([0.0, 0.5, 2.0], 2)
    radius = None if rng.random() < 0.5 else rng.uniform(0.5, 30)
    require_same_as_lines(tin, eye, fall, heights, radius)


def make_surface_with_holes():
    """Return a surface of random points with two breaklines and two round holes."""
    rng = np.random.default_rng(6)
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    lines = [[[5, 5, 9], [95, 30, 9]], [[5, 90, 3], [95, 80, 9], [60, 20, 1]]]
    points = rng.uniform(0, [100, 100, 5], (300, 3))
    return ts.triangulate(points, breaklines=lines, holes=[50 + 9 * ring, [30, 70] + 5 * ring])


def test_the_sweep_goes_around_holes_and_along_breaklines():
    tin = make_surface_with_holes()
    for eye in ([10, 10], [50, 61], [80, 50]):
        require_same_as_lines(tin, eye, heights=(2.0, 0.0))


@pytest.mark.parametrize("fall", [0.0, 1e-4])
def test_many_sectors_and_threads_see_the_same(fall):
    rng = np.random.default_rng(7)
    xy = rng.uniform(0, 300, (20_000, 2))
    tin = ts.triangulate(
        np.column_stack([xy, 9 * np.sin(xy[:, 0] / 20) + rng.uniform(0, 1, 20_000)])
    )
    view, _ = as_view(tin, [150, 150], (9.0, 0.0), None, fall)
    asked = rng.choice(len(xy), 150, replace=False)
    one, three = (judge_vertices(tin, view, np.ones(len(xy), bool), n) for n in (1, 3))
    assert one.tolist() == three.tolist()
    assert see_vertices(tin, view)[asked].tolist() == look_one_by_one(tin, view, asked).tolist()


def test_elevations_beyond_exact_arithmetic_are_looked_at_in_fractions():
    rng = np.random.default_rng(8)
    points = make_surface(rng, "grid") * [1, 1, 1e-90]
    require_same_as_lines(ts.triangulate(points), [4, 4])


def test_classes_tile_the_surface_and_a_radius_limits_them():
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(0, 90, (400, 2)), rng.uniform(0, 9, 400)])
    tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
    found = ts.viewshed(tin, [45, 45], eye_height=5)
    assert found.columns["area"].sum() == pytest.approx(tin.area)
    assert found.columns["triangles"].sum() >= len(tin.triangles)
    whole = ts.viewshed(tin, [45, 45], eye_height=5, whole_triangles=True)
    assert whole.columns["class"].tolist() == ["visible", "partly", "hidden"]
    assert whole.columns["triangles"].sum() == len(tin.triangles)
    assert whole.columns["area"].sum() == pytest.approx(tin.area)
    seen = ts.visible_vertices(tin, [45, 45], eye_height=5, radius=20)
    far = np.hypot(*(tin.points[:, :2] - 45).T) > 20
    assert not seen[far].any()
    assert seen[~far].tolist() == (ts.visible_vertices(tin, [45, 45], eye_height=5)[~far].tolist())
    near = ts.viewshed(tin, [45, 45], eye_height=5, radius=20)
    assert near.columns["area"].sum() < found.columns["area"].sum()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("radius", [3.0, 15.0, 40.0])
def test_within_a_radius_all_is_told_and_beyond_it_nothing_wrong(seed, radius):
    rng = np.random.default_rng(seed)
    xy = rng.random((int(rng.integers(8, 150)), 2)) * 100
    points = np.column_stack([xy, 10 * rng.random(len(xy))])
    tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
    places = rng.random((400, 2)) * 100
    eye, *others = places[tin.locate(places) >= 0]
    found = ts.viewshed(tin, eye, eye_height=2.0, radius=radius)
    lines = ts.line_of_sight(tin, eye, others, eye_height=2.0).columns
    shapes = found.to_shapely()
    borders = np.array([shapely.distance(one.boundary, shapely.points(others)) for one in shapes])
    sure = (borders.min(axis=0) > 1e-6) & ~(np.abs(lines["clearance"]) < 1e-9)
    inside = np.array([shapely.contains_xy(one, np.array(others)) for one in shapes])
    told = np.where(inside.any(axis=0), found.columns["class"][inside.argmax(axis=0)], "nothing")
    seen = np.where(lines["visible"], "visible", "hidden")
    is_told = sure & (told != "nothing")
    assert (told == seen)[is_told].all()
    assert is_told[sure & (lines["distance"] <= radius)].all()
    assert any("taken whole: what is told reaches as far as" in note for note in found.notes)


def test_a_radius_within_one_triangle_has_that_triangle():
    square = [[0, 0, 0], [90, 0, 0], [90, 90, 0], [0, 90, 0]]
    found = ts.viewshed(ts.triangulate(square), [60, 50], eye_height=1, radius=3)
    assert found.columns["area"].tolist() == [4050.0]
    assert found.columns["class"].tolist() == ["visible"]


def test_a_slope_behind_a_crest_is_hidden_and_the_one_before_it_seen():
    ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    found = ts.viewshed(ts.triangulate(ridge), [1, 2], eye_height=0.5)
    assert found.columns["class"].tolist() == ["visible", "hidden"]
    assert found.columns["area"].tolist() == [16.0, 16.0]


def test_a_target_above_the_ground_is_seen_as_far_as_the_line_over_the_crest():
    ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    found = ts.viewshed(ts.triangulate(ridge), [1, 2], eye_height=0.5, target_height=1)
    # 1 + (x - 1) / 3 = 5 - x / 2, of the line and of what stands on the slope behind.
    assert found.columns["area"] == pytest.approx([5.2 * 4, 2.8 * 4])


@settings(max_examples=25, deadline=None)
@given(
    seeds,
    st.sampled_from(["grid", "ramp", "scattered"]),
    st.sampled_from([None, 8.0]),
    st.sampled_from([0.5, 2.0]),
    st.sampled_from([0.0, 0.5]),
)
def test_parts_of_triangles_are_those_of_lines_of_sight(seed, kind, max_edge, above, target_above):
    rng = np.random.default_rng(seed)
    tin = ts.triangulate(make_surface(rng, kind), max_edge=max_edge)
    eye = tin.points[rng.choice(np.unique(tin.triangles)), :2]
    if rng.random() < 0.5:
        eye = rng.dirichlet([1, 1, 1]) @ tin.points[tin.triangles[0], :2]
    weights = rng.dirichlet([1, 1, 1], 3 * len(tin.triangles))
    corners = np.tile(tin.points[tin.triangles, :2], (3, 1, 1))
    places = (weights[:, :, None] * corners).sum(axis=1)
    assert require_parts_as_lines(tin, eye, places, (above, target_above)) > 50


def test_parts_go_around_holes_and_along_breaklines():
    tin = make_surface_with_holes()
    places = np.random.default_rng(7).uniform(0, 100, (800, 2))
    for eye in ([10.0, 10.0], [50.0, 61.0], [80.0, 50.0]):
        assert require_parts_as_lines(tin, np.array(eye), places, (2.0, 0.0)) > 400


def test_triangles_are_judged_as_wholes_where_they_cannot_be_divided():
    rng = np.random.default_rng(9)
    points = make_surface(rng, "grid")
    for tin, options, words in (
        (
            ts.triangulate(points, crs="EPSG:32616", elevation_unit="m"),
            {"curvature": True},
            "curved earth",
        ),
        (ts.triangulate(points * [1, 1, 1e-90]), {}, "With such elevations"),
    ):
        found = ts.viewshed(tin, [4, 4], **options)
        assert any(f"{words} triangles are not divided" in note for note in found.notes)
        whole = ts.viewshed(tin, [4, 4], whole_triangles=True, **options)
        assert found.columns["area"].tolist() == whole.columns["area"].tolist()
        assert not any("not divided" in note for note in whole.notes)


@pytest.mark.parametrize("seed", range(4))
def test_rays_along_a_rail_have_no_corners_that_coordinates_cannot_tell_apart(seed):
    rng = np.random.default_rng(seed)
    xy = np.array([[x, y] for x in range(200) for y in (0.0, 1.0)])
    z = rng.normal(0.0, 0.1, len(xy))
    tin = ts.triangulate(np.column_stack([xy + rng.normal(0.0, 1e-9, xy.shape), z]))
    seen = ts.viewshed(tin, tin.points[0, :2], eye_height=1.7)
    assert seen.columns["area"].sum() == pytest.approx(tin.area, rel=1e-6)


@pytest.mark.skipif(shutil.which("gdal_viewshed") is None, reason="needs gdal_viewshed")
def test_gdal_sees_the_same_on_a_fine_raster(tmp_path):
    rng = np.random.default_rng(4)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 101, 5.0), np.arange(0, 101, 5.0)))
    z = 6 * np.sin(x / 13) * np.cos(y / 11) + rng.uniform(0, 0.5, len(x))
    origin = np.array([500_000.0, 4_000_000.0, 0.0])
    tin = ts.triangulate(np.column_stack([x, y, z]) + origin, crs="EPSG:32616", elevation_unit="m")
    eye = origin[:2] + 50.25
    ts.write(ts.rasterize(tin, spacing=0.5), tmp_path / "dem.tif")
    # GDAL's own line of sight: no curvature, targets on the ground.
    how = ("-ox", f"{eye[0]}", "-oy", f"{eye[1]}", "-oz", "4", "-cc", "0")
    subprocess.run(
        ["gdal_viewshed", *how, tmp_path / "dem.tif", tmp_path / "seen.tif"],
        check=True,
        timeout=600,
    )
    import rasterio

    with rasterio.open(tmp_path / "seen.tif") as file:
        theirs = [value[0] > 0 for value in file.sample(tin.points[:, :2] + 1e-3)]
    ours = ts.visible_vertices(tin, eye, eye_height=4)
    inner = np.abs(tin.points[:, :2] - origin[:2] - 50).max(axis=1) < 50
    assert (np.array(theirs) == ours)[inner].mean() > 0.9  # GDAL interpolates between cells
    assert 0.1 < ours.mean() < 0.9


def test_wrong_options_are_refused():
    tin = ts.triangulate([[0, 0, 0], [4, 0, 0], [0, 4, 0]])
    for radius in (0, -1, float("nan"), "far"):
        with pytest.raises(ts.OptionError, match="radius"):
            ts.viewshed(tin, [1, 1], radius=radius)
    with pytest.raises(ts.OptionError, match="whole_triangles"):
        ts.viewshed(tin, [1, 1], whole_triangles="yes")
    with pytest.raises(ts.PointsError, match="a viewshed has one"):
        ts.visible_vertices(tin, [[1, 1], [1, 2]])
