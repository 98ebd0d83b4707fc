"""The kernel on every data set of the benchmarks: proved, and the same by every way."""

from __future__ import annotations

import numpy as np
import pytest
from support import oracles
from support.kernel_datasets import (
    DATASETS,
    Method,
    make_points,
    require_same_by_threads,
    require_same_growth,
    require_sound,
)

import tinsmith as ts
from tinsmith.tin import _kernel

N = 3_000
THREADS = (1, 2, 3, 5, 8)
# Every search over points on a circle or on straight rails sees nearly all of them, so growth
# alone is quadratic there; only small sets are grown without the way out.
QUADRATIC_TO_GROW = {"rails", "circle", "few circles"}

each_data_set = pytest.mark.parametrize("name", DATASETS)


@each_data_set
def test_data_set_passes_the_check(name):
    points = make_points(name, N)
    tin = require_sound(points)
    assert len(tin.points) == len(points)
    assert len(tin.triangles) == 2 * len(points) - 2 - oracles.hull_size(points)


@each_data_set
def test_shuffled_data_set_gives_the_same_arrays(name):
    """The order of the triangles is a function of the point set too."""
    points = make_points(name, N)
    wanted = _kernel.grow(points)
    for seed in range(3):
        row = np.random.default_rng(seed).permutation(len(points))
        found = _kernel.grow(points[row])
        np.testing.assert_array_equal(row[found.triangles], wanted.triangles)
        np.testing.assert_array_equal(found.neighbors, wanted.neighbors)


@each_data_set
def test_shuffled_data_set_gives_the_same_tin(name):
    points = make_points(name, N)
    row = np.random.default_rng(4).permutation(len(points))
    wanted, found = ts.triangulate(points), ts.triangulate(points[row], threads=3)
    np.testing.assert_array_equal(found.points[found.vertex_of], points[row])
    assert oracles.canonical(row[found.triangles]) == oracles.canonical(wanted.triangles)


@each_data_set
@pytest.mark.parametrize("method", [Method.GROWTH, Method.AUTOMATIC], ids=lambda m: m.name)
def test_threads_give_the_same_arrays(name, method):
    require_same_by_threads(make_points(name, N), THREADS, methods=(method,))


@each_data_set
@pytest.mark.parametrize("threads", [1, 3])
def test_vector_paths_give_the_same_arrays(name, threads):
    points = make_points(name, N)
    wanted = _kernel.grow(points, method=Method.GROWTH, path=_kernel.VECTOR_PATHS[0])
    for path in _kernel.VECTOR_PATHS[1:]:
        found = _kernel.grow(points, method=Method.GROWTH, path=path, threads=threads)
        require_same_growth(found, wanted)


@each_data_set
def test_methods_give_the_same_arrays(name):
    points = make_points(name, N)
    wanted = _kernel.grow(points, method=Method.INSERTION)
    for method in (Method.GROWTH, Method.AUTOMATIC):
        require_same_growth(_kernel.grow(points, method=method), wanted)


# ------------------------------------------------------------------ size


@pytest.mark.proof
@each_data_set
def test_a_hundred_thousand_points_pass_the_check(name):
    points = make_points(name, 100_000)
    assert len(require_sound(points).points) == len(points)


@pytest.mark.proof
@each_data_set
def test_a_hundred_thousand_points_give_the_same_arrays_by_every_way(name):
    points = make_points(name, 100_000)
    methods = [Method.INSERTION, Method.AUTOMATIC]
    if name not in QUADRATIC_TO_GROW:
        methods.append(Method.GROWTH)
    require_same_by_threads(points, THREADS, methods=methods)
    wanted = _kernel.grow(points)
    for path in _kernel.VECTOR_PATHS:
        require_same_growth(_kernel.grow(points, path=path, threads=2), wanted)
    row = np.random.default_rng(5).permutation(len(points))
    found = _kernel.grow(points[row], threads=2)
    np.testing.assert_array_equal(row[found.triangles], wanted.triangles)
    np.testing.assert_array_equal(found.neighbors, wanted.neighbors)


@pytest.mark.proof
@each_data_set
def test_a_million_points_pass_the_check_of_shape(name):
    points = make_points(name, 1_000_000)
    tin = ts.triangulate(points)
    assert len(tin.points) == len(points)
    ts.check(tin, level=2).raise_if_failed()
    require_same_growth(_kernel.grow(points, threads=3), _kernel.grow(points))
