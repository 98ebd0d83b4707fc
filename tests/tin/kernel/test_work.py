"""How much the searches do: counted, so that a regression shows on any machine."""

from __future__ import annotations

import numpy as np
import pytest
from support.kernel_datasets import (
    DATASETS,
    Method,
    make_points,
    require_same_growth,
    require_sound,
    with_heights,
)

import tinsmith as ts
from tinsmith.tin import _kernel

N = 20_000
EVEN = ["uniform", "raster", "decimal raster", "scan lines", "dense corner"]
RASTERS = ["raster", "decimal raster"]
# Data with circles much wider than the spacing, and a size that makes them so: at 20,000 points
# contour lines and tracks are nearly as dense across as along.
UNEVEN = [
    ("clusters", N),
    ("contour lines", 100_000),
    ("survey tracks", 100_000),
    ("rails", N),
    ("circle", N),
    ("few circles", N),
]


def work_per_triangle(name, **options):
    counts = _kernel.count_work(make_points(name, N), **options)
    return {key: count / counts["triangles"] for key, count in counts.items()}


@pytest.mark.parametrize("name", EVEN)
def test_even_data_are_searched_near_the_vertex(name):
    """A search looks at the cells within 1.2 cells on either side of the vertex and 2 rows ahead.

    These are 3.4 columns by 2 to 3 rows of 2 points, half of the vertex's own row done: about 18
    points, once a triangle. One more column or row costs 4 to 6.
    """
    assert 0 < work_per_triangle(name, method=Method.GROWTH)["candidates"] < 24


def test_uniform_data_seldom_need_the_whole_index():
    """Of random triangles about 4 in 100 have a circle that leaves the cells gathered."""
    work = work_per_triangle("uniform")
    assert 0 < work["full_searches"] < 0.08
    # Such a circle is a few cells wide: some 5 rows each.
    assert work["cell_rows"] < 0.4


@pytest.mark.parametrize("name", [*RASTERS, "scan lines"])
def test_regular_data_seldom_need_the_whole_index(name):
    """A raster's circles are as wide as its spacing: only the border may need it."""
    assert work_per_triangle(name, method=Method.GROWTH)["full_searches"] < 0.02


@pytest.mark.parametrize("name", RASTERS)
def test_rasters_decide_each_tie_once(name):
    """Four corners of a raster cell are one tie, and two triangles."""
    work = work_per_triangle(name, method=Method.GROWTH)
    assert 0.4 < work["exact_decisions"] < 0.6


@pytest.mark.parametrize("name", ["uniform", "scan lines"])
def test_points_in_general_position_need_no_exact_decisions(name):
    """The error bound settles all but some 1e-6 of random comparisons; cm give a tie or two."""
    assert work_per_triangle(name)["exact_decisions"] < 1e-3


@pytest.mark.parametrize("name", EVEN)
@pytest.mark.parametrize(
    "method", [Method.GROWTH, Method.GROWTH_OR_INSERTION], ids=lambda m: m.name
)
def test_each_triangle_is_searched_once(name, method):
    counts = _kernel.count_work(make_points(name, N), method=method)
    assert counts["searches"] == counts["triangles"]


@pytest.mark.parametrize("name", DATASETS)
def test_growth_alone_searches_each_triangle_once(name):
    counts = _kernel.count_work(make_points(name, 2_000), method=Method.GROWTH)
    assert counts["searches"] == counts["triangles"]


@pytest.mark.parametrize("name", EVEN)
def test_threads_share_the_searches(name):
    """Only triangles across a seam are found twice: about three a column of cells and seam."""
    counts = _kernel.count_work(make_points(name, N), method=Method.GROWTH, threads=4)
    seams, columns = 3, (N / 2) ** 0.5
    assert 0 < counts["searches"] - counts["triangles"] < 6 * seams * columns


@pytest.mark.parametrize("name", DATASETS)
def test_vector_paths_do_the_same_work(name):
    points = make_points(name, 2_000)
    wanted = _kernel.count_work(points, path=_kernel.VECTOR_PATHS[0])
    for path in _kernel.VECTOR_PATHS[1:]:
        assert _kernel.count_work(points, path=path) == wanted


@pytest.mark.parametrize(("name", "n"), UNEVEN)
def test_growth_is_not_begun_on_uneven_data(name, n):
    """A sample of the vertices tells that insertion is quicker."""
    counts = _kernel.count_work(make_points(name, n))
    assert counts["searches"] == 0 < counts["walk_steps"]


@pytest.mark.parametrize("kind", ["rails", "circle", "contour lines", "survey tracks"])
@pytest.mark.parametrize("share", [0.1, 0.5])
def test_data_that_are_uneven_in_part_are_not_grown_first(kind, share):
    """Growth and insertion together would cost more than either: half of the points at most."""
    even = np.random.default_rng(5).random((int(40_000 * (1 - share)), 2))
    uneven = make_points(kind, int(40_000 * share))[:, :2]
    uneven = 0.3 * (uneven - uneven.min(axis=0)) / np.ptp(uneven, axis=0).max()
    for place in ([0.4, 0.4], [1.5, 0.0], [0.0, 1.5]):
        counts = _kernel.count_work(with_heights(np.vstack([even, uneven + place])))
        is_grown = counts["walk_steps"] == 0
        assert is_grown or counts["searches"] < 0.25 * counts["triangles"]


@pytest.mark.parametrize("name", ["rails", "few circles"])
def test_points_too_few_for_a_sample_are_given_up_within_the_first_rows(name):
    """Every search there sees a share of all points: a few of them spend the budget."""
    counts = _kernel.count_work(make_points(name, 8_000))
    assert counts["walk_steps"] > 0
    assert counts["searches"] < 0.01 * counts["triangles"]


def test_insertion_searches_nothing():
    counts = _kernel.count_work(make_points("uniform", N), method=Method.INSERTION)
    assert counts["triangles"] > N
    assert counts["searches"] == counts["candidates"] == counts["cell_rows"] == 0


SLOPES = [1 / 3, 1 / 7, -1 / 3, 0.1, 0.3717, 4711.3]


def slanted_line(n, slope, east=0.0):
    """Rows on a straight line but for the rounding of their northings."""
    x = np.arange(n) + east
    return with_heights(np.column_stack([x, x * slope]))


@pytest.mark.parametrize("slope", SLOPES)
def test_points_in_line_but_for_rounding_are_found_by_short_walks(slope):
    """Vertices with thousands of slivers about them lie along such a line.

    A walk that may cross any edge with the point beyond it goes round them: 500 steps a point at
    50,000 points, 1,700 at 200,000.
    """
    points = slanted_line(100_000, slope)
    counts = _kernel.count_work(points, method=Method.INSERTION)
    assert 0 < counts["walk_steps"] / len(points) < 20


@pytest.mark.parametrize("slope", SLOPES)
def test_points_in_line_but_for_rounding_have_one_triangulation(slope):
    """Growth looks at all points in every search here, so the long line is only checked."""
    points = slanted_line(1_000, slope, east=0.1)
    inserted = _kernel.grow(points, method=Method.INSERTION)
    require_same_growth(inserted, _kernel.grow(points, method=Method.GROWTH))
    require_sound(slanted_line(20_000, slope, east=0.1))


@pytest.mark.parametrize("slope", SLOPES[:3])
def test_points_in_line_but_for_rounding_are_inserted_by_edits(slope):
    points = slanted_line(20_000, slope)
    tin = ts.triangulate(points[::2])
    tin.insert(points[1:1000:2])
    order = np.r_[0:20_000:2, 1:1000:2]
    fresh = ts.triangulate(points[order])
    np.testing.assert_array_equal(tin.triangles, fresh.triangles)
