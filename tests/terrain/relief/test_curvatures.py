"""Curvature against the closed forms of quadratic surfaces, spheres and cylinders."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tinsmith as ts

KINDS = ["profile", "plan", "tangential", "mean", "gaussian"]


def scattered(surface, *, n=250, size=10.0, seed=0, **about):
    xy = np.random.default_rng(seed).uniform(-size, size, (n, 2))
    return ts.triangulate(np.column_stack([xy, surface(*xy.T)]), **about)


def closed_form(kind, x, y, coefficients):
    """Curvatures of z = a x^2 + b x y + c y^2 + d x + e y, from the fundamental forms."""
    a, b, c, d, e = coefficients
    gradient = np.array([2 * a * x + b * y + d, b * x + 2 * c * y + e])
    hessian = np.array([[2 * a, b], [b, 2 * c]])
    first = np.eye(2) + np.outer(gradient, gradient)
    second = hessian / math.sqrt(1 + gradient @ gradient)
    shape = np.linalg.solve(first, second)
    if kind == "mean":
        return -np.trace(shape) / 2
    if kind == "gaussian":
        return np.linalg.det(shape)
    along = gradient if kind == "profile" else np.array([-gradient[1], gradient[0]])
    normal = -(along @ second @ along) / (along @ first @ along)
    if kind != "plan":
        return normal
    # Meusnier: the contour's own curvature is that of its normal section over the sine of slope.
    return normal / math.sin(math.atan(np.linalg.norm(gradient)))


COEFFICIENTS = [
    (0.05, 0.0, 0.05, 0.0, 0.0),
    (0.02, 0.01, -0.04, 0.3, -0.2),
    (-0.1, 0.05, -0.02, 1.0, 2.0),
    (0.0, 0.0, 0.0, 0.5, 0.1),
]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("coefficients", COEFFICIENTS)
def test_quadratic_surfaces_are_exact(kind, coefficients):
    a, b, c, d, e = coefficients
    tin = scattered(lambda x, y: a * x * x + b * x * y + c * y * y + d * x + e * y)
    found = ts.curvature(tin, kind=kind)
    expected = [closed_form(kind, x, y, coefficients) for x, y in tin.points[:, :2]]
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-7)


def test_a_ball_is_round_in_every_direction():
    radius = 1000.0
    tin = scattered(lambda x, y: np.sqrt(radius**2 - (x - 300) ** 2 - y**2), size=0.1)
    for kind in ("profile", "tangential", "mean"):
        np.testing.assert_allclose(ts.curvature(tin, kind=kind), 1 / radius, rtol=1e-3)
    np.testing.assert_allclose(ts.curvature(tin, kind="gaussian"), 1 / radius**2, rtol=2e-3)


def test_ridges_are_convex_and_valleys_concave():
    ridge = scattered(lambda x, y: -0.01 * x**2 + 0.2 * y)
    assert (ts.curvature(ridge, kind="tangential") > 0).mean() > 0.99
    valley = scattered(lambda x, y: 0.01 * x**2 + 0.2 * y)
    assert (ts.curvature(valley, kind="tangential") < 0).mean() > 0.99


def test_feet_and_metres_are_one_surface():
    """The same ground with eastings in feet and elevations in metres or in feet."""
    foot = 1200 / 3937
    metres = scattered(lambda x, y: 0.02 * x * x + 0.1 * y, crs="EPSG:2274", elevation_unit="m")
    scaled = metres.points * (1.0, 1.0, 1 / foot)
    feet = ts.triangulate(scaled, crs="EPSG:2274", elevation_unit="US survey foot")
    for kind in KINDS:
        one, other = ts.curvature(metres, kind=kind), ts.curvature(feet, kind=kind)
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-9)


def test_too_few_neighbours_have_no_curvature():
    tin = ts.triangulate([[0, 0, 0], [4, 0, 1], [4, 4, 3], [0, 4, 0]])
    assert np.isnan(ts.curvature(tin, kind="mean")).all()


def test_neighbours_on_a_conic_have_no_curvature():
    """Five points on two lines through the vertex: x y = 0 fits them whatever its factor."""
    cross = [[0, 0, 0], [1, 0, 1], [-1, 0, 2], [0, 1, 3], [0, -1, 1], [2, 0, 5], [0, 2, 3]]
    assert np.isnan(ts.curvature(ts.triangulate(cross), kind="mean")[0])


def test_level_ground_has_no_direction():
    tin = scattered(lambda x, y: 0 * x)
    assert np.isnan(ts.curvature(tin, kind="profile")).all()
    assert (ts.curvature(tin, kind="mean") == 0).all()


def test_a_triangle_has_the_mean_of_its_corners():
    tin = scattered(lambda x, y: 0.02 * x * x + 0.3 * y)
    at_corners = ts.curvature(tin)[tin.triangles]
    found = ts.curvature(tin, per="triangle")
    np.testing.assert_allclose(found, at_corners.mean(axis=1), rtol=1e-12)


def test_chunks_do_not_show(monkeypatch):
    tin = scattered(lambda x, y: np.sin(x) + y)
    whole = ts.curvature(tin)
    monkeypatch.setattr("tinsmith.terrain.relief.curvatures._CHUNK", 7)
    np.testing.assert_array_equal(ts.curvature(tin), whole)


@pytest.mark.parametrize("given", [{"kind": "round"}, {"per": "edge"}])
def test_words_that_are_none(given):
    with pytest.raises(ts.OptionError):
        ts.curvature(scattered(lambda x, y: x), **given)
