"""Seams between threads, where they are hard: through rows, clusters, lines and duplicates."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import oracles
from support.kernel_datasets import (
    Method,
    require_same_by_threads,
    require_same_growth,
    require_sound,
    with_heights,
)
from support.point_sets import places

from tinsmith.tin import _kernel

THREADS = (2, 3, 4, 5, 6, 7, 11, 16, 33)
UTM_CORNER = np.array([500_000.0, 4_000_000.0])


def lattice(columns, rows):
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel()]).astype(float)


def raster_cut_within_its_rows():
    """37 columns: no number of threads ends all its ranges at the end of a row."""
    return lattice(37, 29) * 30.0 + UTM_CORNER


def three_long_rows():
    """Ranges begin and end inside a row of collinear points."""
    return lattice(211, 3)


def three_long_columns():
    return lattice(3, 211)


def row_of_cells_with_one_point_off():
    """One row of cells holds all but one point: every seam runs across the same row."""
    x = np.arange(300.0)
    return [*np.column_stack([x, 0.001 * np.sin(x)]), (150.2, 40.0)]


def line_with_one_point_off():
    return [*((x, 0) for x in range(250)), (117, 1)]


def line_with_one_point_off_first_in_the_sweep():
    return [*((x, 0) for x in range(250)), (117, -1)]


def far_outlier():
    """All points but one in one cell: seams only within nested levels."""
    cluster = np.random.default_rng(1).random((400, 2))
    return np.concatenate([cluster, [[1e9, 1e9]]])


def far_outlier_first_in_the_sweep():
    cluster = np.random.default_rng(2).random((400, 2))
    return np.concatenate([[[-1e9, -1e9]], cluster])


def two_far_clusters():
    rng = np.random.default_rng(3)
    return np.concatenate([rng.random((350, 2)), rng.random((350, 2)) + 1e6])


def three_far_clusters_in_a_row():
    """An even number of threads cuts the middle cluster in two."""
    rng = np.random.default_rng(4)
    return np.concatenate([rng.random((250, 2)) + 1e6 * np.array([k, 0]) for k in range(3)])


def clusters_within_clusters():
    """Each a thousandth of the one around it, so levels nest."""
    rng = np.random.default_rng(5)
    rings = [rng.normal(0, 1000.0**-depth, (150, 2)) for depth in range(4)]
    return np.concatenate(rings) + UTM_CORNER * 1e-3


def raster_with_duplicates():
    xy = lattice(23, 19)
    return np.concatenate([xy, xy[::3], xy[::-5], xy[:40], xy[:40]])


def one_place_held_by_most_rows():
    """The seams by rows and by places are far apart."""
    return np.concatenate([np.full((500, 2), 7.0), lattice(12, 12)])


def integer_cloud_with_duplicates():
    return np.random.default_rng(6).integers(0, 25, (900, 2))


def small_circle_in_a_raster():
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    circle = 0.3 * np.column_stack([np.cos(angle), np.sin(angle)]) + 10.5
    return np.concatenate([lattice(21, 21), circle])


def wide_fan():
    """Triangles of the apex, first in the sweep, touch every range."""
    angle = np.linspace(0.3, np.pi - 0.3, 400)
    return np.concatenate([[[0, 0]], 100 * np.column_stack([np.cos(angle), np.sin(angle)])])


def fan_about_the_last_point():
    return -wide_fan()


def cloud_with_holes():
    """Circles across a hole reach rows far behind a seam."""
    xy = np.random.default_rng(8).random((3_000, 2)) * 50
    return xy[np.sin(1.2 * xy).prod(axis=1) > 0]


def scattered_tenths():
    return np.round(np.random.default_rng(7).random((900, 2)) * 20, 1) + UTM_CORNER


SEAM_CASES = [
    raster_cut_within_its_rows,
    three_long_rows,
    three_long_columns,
    row_of_cells_with_one_point_off,
    line_with_one_point_off,
    line_with_one_point_off_first_in_the_sweep,
    far_outlier,
    far_outlier_first_in_the_sweep,
    two_far_clusters,
    three_far_clusters_in_a_row,
    clusters_within_clusters,
    raster_with_duplicates,
    one_place_held_by_most_rows,
    integer_cloud_with_duplicates,
    small_circle_in_a_raster,
    wide_fan,
    fan_about_the_last_point,
    cloud_with_holes,
    scattered_tenths,
]

each_seam_case = pytest.mark.parametrize("case", SEAM_CASES, ids=lambda case: case.__name__)


@each_seam_case
def test_seams_leave_no_trace(case):
    points = with_heights(case())
    require_sound(points)
    require_same_by_threads(points, THREADS, methods=(Method.INSERTION, Method.GROWTH))
    require_same_by_threads(points, (2, 5), methods=(Method.AUTOMATIC,))


@each_seam_case
def test_seams_leave_no_trace_on_any_vector_path(case):
    points = with_heights(case())
    wanted = _kernel.grow(points, method=Method.INSERTION)
    for path in _kernel.VECTOR_PATHS:
        for threads in (2, 7):
            found = _kernel.grow(points, method=Method.GROWTH, threads=threads, path=path)
            require_same_growth(found, wanted)


@each_seam_case
def test_rows_in_reverse_give_the_same_triangles(case):
    """By place, since of several rows at one place the first one is kept."""
    points = with_heights(case())
    wanted = require_sound(points)
    found = _kernel.grow(points[::-1].copy(), method=Method.GROWTH, threads=5)
    rows = len(points) - 1 - kept_rows(found, len(points))
    np.testing.assert_array_equal(points[rows[found.triangles], :2], corners(wanted))
    np.testing.assert_array_equal(found.neighbors, wanted.neighbors)


def kept_rows(growth, n_rows):
    row = np.arange(n_rows)
    return row if growth.kept_row is None else row[growth.kept_row == row]


def corners(tin):
    return tin.points[tin.triangles, :2]


def test_more_threads_than_points():
    for n in (3, 4, 5, 9):
        points = with_heights(np.random.default_rng(n).random((n, 2)))
        require_same_by_threads(points, (n - 1, n, n + 1, 4 * n, 100))


def test_more_threads_than_places():
    points = with_heights(np.tile([(0, 0), (5, 1), (2, 4)], (30, 1)))
    require_same_by_threads(points, (2, 3, 4, 8, 50))


# ------------------------------------------------------------------ properties

small_grids = places(st.integers(0, 9), 60, unique=False)
# Tenths at UTM coordinates: neither ties nor their differences are exact.
utm_tenths = places(st.integers(0, 60), 60, unique=False).map(
    lambda steps: (np.round(UTM_CORNER * 10) + np.array(steps)) / 10
)
clouds = st.one_of(small_grids, utm_tenths).map(lambda xy: np.array(xy, float))
clouds_with_triangles = clouds.filter(lambda xy: np.linalg.matrix_rank(xy - xy[0]) == 2)


@given(clouds_with_triangles, st.sampled_from([2, 5]))
def test_one_two_and_five_threads_agree(xy, threads):
    require_same_by_threads(with_heights(xy), (1, threads))


@given(clouds_with_triangles, st.integers(-100, 100), st.sampled_from([1, 2, 5]))
def test_scaling_by_powers_of_two_keeps_the_rows(xy, exponent, threads):
    """Exact, so nothing may change but the last bit of a cell's size: the same set."""
    wanted = _kernel.grow(with_heights(xy))
    found = _kernel.grow(with_heights(xy * 2.0**exponent), method=Method.GROWTH, threads=threads)
    require_same_set(found, wanted)


@given(
    clouds_with_triangles,
    st.tuples(st.integers(0, 2000), st.integers(0, 2000)),
    st.booleans(),
    st.sampled_from([1, 2, 5]),
)
def test_exact_moves_keep_the_rows(xy, whole_metres, is_from_corner, threads):
    """Whole metres fit beside a UTM coordinate's tenths, and so does the way to the origin."""
    shift = -xy.min(axis=0) if is_from_corner else np.array(whole_metres, float)
    moved = xy + shift
    np.testing.assert_array_equal(moved - shift, xy)
    wanted = _kernel.grow(with_heights(xy))
    found = _kernel.grow(with_heights(moved), method=Method.GROWTH, threads=threads)
    require_same_set(found, wanted)


def require_same_set(found, wanted):
    assert oracles.canonical(found.triangles) == oracles.canonical(wanted.triangles)
    assert (found.kept_row is None) == (wanted.kept_row is None)
    if wanted.kept_row is not None:
        np.testing.assert_array_equal(found.kept_row, wanted.kept_row)
