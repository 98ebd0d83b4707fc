"""Slope and aspect against planes of known dip, and against a least-squares plane."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tinsmith import CRS, TIN, OptionError, triangulate
from tinsmith.terrain import aspect, slope
from tinsmith.terrain.surface.normals import measure_areas, measure_ring_area

UTM = np.array([742_000.0, 4_030_000.0])


def plane(gradient_east, gradient_north, *, origin=(0.0, 0.0)):
    """A 5 x 5 grid on the plane z = gradient_east * x + gradient_north * y."""
    x, y = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(5), np.arange(5)))
    z = gradient_east * x + gradient_north * y
    return triangulate(np.column_stack([x + origin[0], y + origin[1], z]))


def rough(n=500, seed=7):
    """Random points on UTM coordinates, of every steepness."""
    random = np.random.default_rng(seed)
    xy = random.uniform(0, 100, (n, 2)) + UTM
    return triangulate(np.column_stack([xy, random.uniform(0, 40, n)]))


def plane_fit(corners):
    """Gradient (dz/dx, dz/dy) of the plane through three corners, by a linear solve."""
    system = np.column_stack([corners[:, :2] - corners[0, :2], np.ones(3)])
    return np.linalg.solve(system, corners[:, 2] - corners[0, 2])[:2]


@pytest.mark.parametrize(
    ("gradient", "azimuth"),
    [
        ((0.0, -1.0), 0.0),
        ((-1.0, -1.0), 45.0),
        ((-1.0, 0.0), 90.0),
        ((-1.0, 1.0), 135.0),
        ((0.0, 1.0), 180.0),
        ((1.0, 1.0), 225.0),
        ((1.0, 0.0), 270.0),
        ((1.0, -1.0), 315.0),
    ],
)
def test_a_plane_falls_to_the_side_it_was_tilted_to(gradient, azimuth):
    tin = plane(*gradient)
    np.testing.assert_allclose(aspect(tin), azimuth, atol=1e-12)
    steepness = math.degrees(math.atan(math.hypot(*gradient)))
    np.testing.assert_allclose(slope(tin), steepness, atol=1e-12)


def test_level_ground_has_slope_zero_and_no_aspect():
    tin = plane(0.0, 0.0, origin=UTM)
    assert (slope(tin) == 0.0).all()
    assert np.isnan(aspect(tin)).all()


def test_a_cliff_stays_below_ninety_degrees():
    tin = TIN.from_triangles([[0, 0, 0], [1e-6, 0, 1000], [0, 1, 0]], [[0, 1, 2]])
    assert 89.99 < slope(tin)[0] <= 90.0
    assert aspect(tin)[0] == 270.0


def test_a_hair_west_of_north_is_within_the_circle():
    tin = plane(1e-17, -1.0)
    assert (aspect(tin) >= 0.0).all()
    assert (aspect(tin) < 360.0).all()


def test_slope_and_aspect_agree_with_a_plane_fit_of_every_triangle():
    tin = rough()
    gradients = np.array([plane_fit(tin.points[corners]) for corners in tin.triangles])
    expected_slope = [math.degrees(math.atan(math.hypot(*g))) for g in gradients]
    np.testing.assert_allclose(slope(tin), expected_slope, atol=1e-6)
    downhill = -gradients / np.linalg.norm(gradients, axis=1, keepdims=True)
    azimuth = np.radians(aspect(tin))
    np.testing.assert_allclose(np.sin(azimuth), downhill[:, 0], atol=1e-6)
    np.testing.assert_allclose(np.cos(azimuth), downhill[:, 1], atol=1e-6)


def test_slope_is_the_angle_between_the_areas():
    tin = rough(seed=8)
    cosine = tin.triangle_areas / tin.triangle_surface_areas
    np.testing.assert_allclose(np.cos(np.radians(slope(tin))), cosine, atol=1e-12)


def test_results_are_one_float_a_triangle():
    tin = rough(n=3)
    for values in (slope(tin), aspect(tin)):
        assert values.shape == (1,)
        assert values.dtype == np.float64


@given(
    st.integers(-8, 8),
    st.integers(-8, 8),
    st.sampled_from([0.25, 1.0, 1024.0]),
)
def test_scaling_a_plane_leaves_its_angles(east, north, scale):
    tin = plane(east / 4, north / 4)
    scaled = TIN.from_triangles(tin.points * scale, tin.triangles)
    np.testing.assert_array_equal(slope(scaled), slope(tin))
    np.testing.assert_array_equal(aspect(scaled), aspect(tin))


# ------------------------------------------------------------------------------ units, vertices


def test_percent_and_ratio_are_tangents():
    tin = rough()
    tangent = np.tan(np.radians(slope(tin)))
    np.testing.assert_allclose(slope(tin, unit="ratio"), tangent, rtol=1e-9)
    np.testing.assert_allclose(slope(tin, unit="percent"), 100 * tangent, rtol=1e-9)


def test_a_vertex_of_a_plane_has_the_slope_of_the_plane():
    tin = plane(0.75, -1.0)
    np.testing.assert_allclose(slope(tin, unit="ratio", per="vertex"), 1.25, rtol=1e-12)
    np.testing.assert_allclose(aspect(tin, per="vertex"), aspect(tin)[0], rtol=1e-12)


def test_the_gradient_at_a_vertex_is_the_mean_weighted_by_area():
    tin = rough()
    gradients = np.array([plane_fit(tin.points[corners]) for corners in tin.triangles])
    found = slope(tin, unit="ratio", per="vertex")
    azimuth = np.radians(aspect(tin, per="vertex"))
    for vertex in range(0, len(tin.points), 25):
        own = tin.vertex_triangles(vertex)
        mean = np.average(gradients[own], axis=0, weights=tin.triangle_areas[own])
        assert found[vertex] == pytest.approx(math.hypot(*mean), rel=1e-6)
        assert np.sin(azimuth[vertex]) == pytest.approx(-mean[0] / math.hypot(*mean), abs=1e-6)


def test_a_vertex_without_a_triangle_has_no_slope():
    points = [[0, 0, 0], [1, 0, 1], [0, 1, 0], [5, 5, 5]]
    tin = TIN.from_triangles(points, [[0, 1, 2]])
    for unit in ("degrees", "percent", "ratio"):
        assert np.isnan(slope(tin, unit=unit, per="vertex")[3])
    assert np.isnan(aspect(tin, per="vertex")[3])


@pytest.mark.parametrize("given", [{"unit": "radians"}, {"unit": None}, {"per": "edge"}])
def test_words_that_are_none(given):
    with pytest.raises(OptionError, match=f"Invalid {next(iter(given))}"):
        slope(rough(20), **given)


def exact_gradient(corners):
    """Gradient of the plane through three corners in fractions."""
    a, b, c = ([Fraction(value) for value in corner] for corner in corners.tolist())
    u, v = ([end - start for start, end in zip(a, other, strict=True)] for other in (b, c))
    up = u[0] * v[1] - u[1] * v[0]
    return (u[1] * v[2] - u[2] * v[1]) / -up, (u[2] * v[0] - u[0] * v[2]) / -up


@pytest.mark.parametrize("seed", range(4))
def test_slivers_are_exact(seed):
    """Points along a line, some of them off it by roundings: their products cancel."""
    random = np.random.default_rng(seed)
    along = random.uniform(0, 1, 30)[:, None]
    xy = UTM + along * random.normal(size=2) * 100
    points = np.column_stack([xy, random.uniform(0, 30, 30)])
    side = random.normal(size=2) * 100
    tin = triangulate(np.vstack([points, [*(UTM + side), 3.0]]))
    assert (tin.triangle_areas < 1e-9).any()
    found, falls = slope(tin, unit="ratio"), aspect(tin)
    for row, corners in enumerate(tin.triangles):
        east, north = exact_gradient(tin.points[corners])
        squared = east * east + north * north
        assert found[row] == pytest.approx(math.sqrt(squared), rel=1e-9)
        turn = math.degrees(math.atan2(-float(east), -float(north))) % 360
        assert abs((falls[row] - turn + 180) % 360 - 180) < 1e-6
    assert (slope(tin) <= 90.0).all()


@pytest.mark.parametrize("place", [(0.0, 0.0), (742_000.0, 4_030_000.0), (-6e6, 9e6)])
@pytest.mark.parametrize("turned", [False, True])
def test_the_area_of_a_small_ring_far_from_the_origin_is_exact(place, turned):
    ring = np.array([[0, 0], [0.25, 0], [0.25, 0.5], [0, 0.5]]) + place
    area = measure_ring_area(CRS.of("EPSG:32616"), ring[::-1] if turned else ring)
    assert area == pytest.approx(-0.125 if turned else 0.125, rel=1e-12)


@pytest.mark.parametrize("latitude", [-60.0, 0.0, 36.0])
def test_the_area_of_a_ring_in_degrees_is_that_of_its_triangles(latitude):
    ring = np.array([[10, 0], [10.01, 0], [10.01, 0.01], [10, 0.01]])
    ring[:, 1] += latitude
    tin = triangulate(np.column_stack([ring, np.zeros(4)]), crs="EPSG:4326")
    assert measure_ring_area(tin.crs, ring) == pytest.approx(measure_areas(tin).sum(), rel=1e-9)
    feet = triangulate([[0, 0, 0], [100, 0, 0], [0, 100, 0]], crs="EPSG:2264")
    assert measure_areas(feet).sum() == pytest.approx(5000 * (1200 / 3937) ** 2, rel=1e-12)
    assert measure_ring_area(feet.crs, feet.points[feet.rings[0]]) == pytest.approx(
        measure_areas(feet).sum()
    )
