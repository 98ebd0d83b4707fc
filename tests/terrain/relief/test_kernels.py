"""The compiled kernels of relief beside their plain twins, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from support import relief_oracle

import tinsmith as ts
from tinsmith.terrain import _kernel

ONE = np.ones(1)


def scatter(rng, *, n=60, corner=0.0):
    xy = rng.uniform(0, 30, (n, 2)).round(int(rng.choice([0, 1, 9]))) + corner
    return np.column_stack([xy, rng.normal(0, 3, n)])


def lattice(rng):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(7.0), np.arange(6.0)))
    return np.column_stack([x, y, rng.integers(0, 4, len(x))])


def hub(rng):
    """A vertex with many more neighbours than are looked through at once."""
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = np.column_stack([10 * np.cos(turn), 10 * np.sin(turn), rng.normal(size=40)])
    return np.vstack([ring, [0.1, 0.2, 3.0]])


def needle(rng):
    along = rng.uniform(0, 100, 30)
    return np.column_stack([along, 0.01 * along + rng.uniform(0, 1e-7, 30), rng.normal(size=30)])


SURFACES = [scatter, lattice, hub, needle, lambda rng: scatter(rng, corner=4_030_000.0)]


def surface(make, seed, **options):
    return ts.triangulate(make(np.random.default_rng(seed)), duplicates="mean", **options)


def measure_longest_sides(tin):
    corners = tin.points[tin.triangles, :2]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)


@pytest.mark.each_value
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", SURFACES)
@pytest.mark.parametrize("share", [1.0, 0.7])
def test_fits_are_those_of_the_twin(make, seed, share):
    """Of the whole surface and of one with gaps."""
    longest = measure_longest_sides(surface(make, seed))
    tin = surface(make, seed, max_edge=float(np.quantile(longest, share)) * (1 + 1e-9))
    for threads in (1, 3):
        found = _kernel.fit_quadratics(tin.points, tin.triangles, ONE, ONE, 0.3048, threads)
        wanted = relief_oracle.fit_quadratics(tin.points, tin.triangles, up=0.3048)
        np.testing.assert_array_equal(found, wanted)


def test_factors_may_be_those_of_each_vertex():
    tin = surface(scatter, 9)
    east, north = np.random.default_rng(0).uniform(0.5, 2, (2, len(tin.points)))
    found = _kernel.fit_quadratics(tin.points, tin.triangles, east, north, 2.0, 1)
    wanted = relief_oracle.fit_quadratics(tin.points, tin.triangles, east, north, 2.0)
    np.testing.assert_array_equal(found, wanted)


def test_fits_are_least_squares():
    """Against another solver, where the neighbours determine the surface well."""
    tin = surface(scatter, 1)
    found = _kernel.fit_quadratics(tin.points, tin.triangles, ONE, ONE, 1.0, 1)
    neighbors = relief_oracle.list_neighbors(tin.points, tin.triangles)
    for v, ring in enumerate(
        relief_oracle.within_two_edges(v, neighbors) for v in range(len(tin.points))
    ):
        x, y, z = (tin.points[ring] - tin.points[v]).T
        terms = np.column_stack([x, y, x * x / 2, x * y, y * y / 2])
        wanted = np.linalg.lstsq(terms, z, rcond=None)[0]
        np.testing.assert_allclose(found[:, v], wanted, rtol=1e-6, atol=1e-9)


def test_curvature_does_not_depend_on_the_order_of_points():
    rng = np.random.default_rng(3)
    points = scatter(rng, n=300, corner=500_000.0)
    points = points[np.unique(points[:, :2], axis=0, return_index=True)[1]]
    order = rng.permutation(len(points))
    one, other = (ts.triangulate(rows) for rows in (points, points[order]))
    for kind in ("profile", "gaussian"):
        found, again = (
            ts.curvature(tin, kind=kind)[np.lexsort(tin.points[:, :2].T)] for tin in (one, other)
        )
        np.testing.assert_array_equal(found, again)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", SURFACES)
def test_normals_are_those_of_the_twin(make, seed):
    tin = surface(make, seed)
    for threads in (1, 3):
        normals, slivers = _kernel.triangle_normals(tin.points, tin.triangles, threads)
        wanted, thin = relief_oracle.compute_normals(tin.points, tin.triangles)
        np.testing.assert_array_equal(normals, wanted)
        np.testing.assert_array_equal(slivers, thin)
    sums = _kernel.vertex_normals(tin.points, tin.triangles, normals)
    wanted = relief_oracle.sum_at_vertices(tin.triangles, normals, len(tin.points))
    np.testing.assert_array_equal(sums, wanted)


def test_light_is_that_of_the_twin():
    rng = np.random.default_rng(5)
    normals = rng.normal(size=(2000, 3)) * 10.0 ** rng.integers(-300, 300, (2000, 1))
    normals = np.vstack([normals, np.zeros(3), [np.inf, 0, 1], [0, 0, 5e-324], [0, -3.0, 0]])
    towards = np.array([-0.5, 0.5, np.sqrt(0.5)])
    found = _kernel.shade_planes(normals, *towards.tolist(), 1, 255)
    np.testing.assert_array_equal(found, relief_oracle.shade(normals, towards.tolist()))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda p, t: _kernel.fit_quadratics(p, t, ONE[:0], ONE[:0], 1.0, 1), "one factor"),
        (lambda p, t: _kernel.fit_quadratics(p, t + 1, ONE, ONE, 1.0, 1), "vertex numbers"),
        (lambda p, t: _kernel.triangle_normals(p, t - 1, 1), "vertex numbers"),
        (lambda p, t: _kernel.vertex_normals(p, t, np.zeros((2, 3))), "one normal"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(call, words):
    tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    with pytest.raises(ValueError, match=words):
        call(np.array(tin.points), np.array(tin.triangles))
