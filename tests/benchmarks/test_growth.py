"""The benchmark of growth: exponents of times, and that every product runs on every data set."""

import math

import pytest

import tinsmith as ts
from benchmarks.growth import DATASETS, PRODUCTS, TASKS, Growth, measure


@pytest.mark.parametrize("exponent", [1.0, 1.5, 3.0])
def test_the_exponent_is_that_of_the_last_sizes(exponent):
    sizes = tuple(500 * 2**k for k in range(6))
    times = (9.0, 9.0, *((size / 1000) ** exponent for size in sizes[2:]))
    assert Growth(sizes, times).exponent == pytest.approx(exponent)
    assert math.isnan(Growth(sizes[:2], times[:2]).exponent)


def test_the_time_of_a_point_is_compared_with_that_at_the_smallest_size():
    assert Growth((10, 20, 40), (1.0, 9.0, 6.0)).per_point == pytest.approx(1.5)
    assert math.isnan(Growth((10,), (1.0,)).per_point)


@pytest.mark.parametrize("data", DATASETS)
def test_every_product_runs_on_every_data_set(data):
    for product in PRODUCTS.values():
        found = measure(
            lambda n: ts.triangulate(DATASETS[data](n)), product, start=60, most=60, limit=9.0
        )
        assert (found.sizes, found.refusal) == ((60,), "")


@pytest.mark.parametrize("task", TASKS)
def test_every_task_runs(task):
    found = measure(*TASKS[task], start=20, most=40, limit=9.0)
    assert (found.sizes, found.refusal) == ((20, 40), "")
