"""Points: the ladder of bad input through triangulate, and good input of every make."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin import PointsError, _kernel, check, predicates
from tinsmith.tin.validation.points import as_points, as_xy, require_exact_range

GOOD = np.array([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [1, 2, 9]], float)

TOO_FEW = {
    "no points": np.empty((0, 3)),
    "one point": [[1, 2, 3]],
    "two points": [[1, 2, 3], [4, 5, 6]],
    "three at one place": [[1, 2, 3], [1, 2, 4], [1, 2, 5]],
    "many at two places": [[1, 2, 3], [1, 2, 4], [7, 2, 5]] * 50,
    "three on a line": [[0, 0, 1], [1, 1, 5], [2, 2, 1]],
    "a level line": [[x, 5, x % 7] for x in range(200)],
    "a plumb line": [[5, y, y % 7] for y in range(200)],
    "a slanted line": [[x, 2 * x + 1, 0] for x in range(-50, 50)],
    "a line of huge coordinates": [[x * 2.0**240, x * 3 * 2.0**240, 0] for x in range(-20, 20)],
    "a line of tiny coordinates": [[x * 2.0**-190, x * 3 * 2.0**-190, 0] for x in range(-20, 20)],
    "a line of dyadic fractions": [[x / 8, 3 * x / 8, 0] for x in range(100)],
}


@pytest.mark.parametrize("points", TOO_FEW.values(), ids=TOO_FEW)
def test_too_few_places_get_a_sentence_on_what_a_tin_needs(points):
    with pytest.raises(ts.PointsError, match="at least three") as caught:
        ts.triangulate(points)
    assert "collinear" in str(caught.value)


def test_all_duplicates_are_called_so():
    with pytest.raises(ts.PointsError, match="All 4 points lie at one place"):
        ts.triangulate([[1, 2, 3]] * 4)
    with pytest.raises(ts.PointsError, match="All 4 points lie at two places"):
        ts.triangulate([[1, 2, 3]] * 3 + [[4, 4, 4]])


def test_collinear_points_are_called_so():
    with pytest.raises(ts.PointsError, match="All 9 points are collinear"):
        ts.triangulate([[x, x, 0] for x in range(9)])


def test_three_points_make_one_triangle():
    assert len(ts.triangulate(GOOD[:3]).triangles) == 1


def test_rounding_alone_keeps_tenths_from_being_collinear():
    """0.1, 0.2, 0.30000000000000004 times (1, 3) are not on one line, and are not said to be."""
    tin = ts.triangulate([[0.1 * x, 0.3 * x, 0] for x in range(20)])
    assert check(tin).ok


# ------------------------------------------------------------------ values


@pytest.mark.parametrize(("column", "name"), [(0, "easting"), (1, "northing"), (2, "elevation")])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite(column, name, value):
    points = GOOD.copy()
    points[3, column] = points[4, column] = value
    with pytest.raises(ts.PointsError, match=f"row 3, {name} {value}") as caught:
        ts.triangulate(points)
    assert caught.value.rows == (3, 4)
    assert str(caught.value).startswith("2 of 5 points are not finite")


def test_infinities_of_both_signs_are_found():
    points = GOOD.copy()
    points[1, 2], points[2, 2] = np.inf, -np.inf
    with pytest.raises(ts.PointsError, match="not finite") as caught:
        ts.triangulate(points)
    assert caught.value.rows == (1, 2)


@pytest.mark.parametrize("value", [1e76, -1e76, 1e300, 1e-61, -1e-61, 5e-324])
@pytest.mark.parametrize("column", [0, 1])
def test_coordinates_beyond_the_exact_range(column, value):
    points = GOOD.copy()
    points[2, column] = value
    with pytest.raises(ts.PointsError, match=r"exact range .*row 2.* are allowed") as caught:
        ts.triangulate(points)
    assert caught.value.rows == (2,)
    assert repr(value) in str(caught.value)


def test_elevations_may_have_any_size_to_the_largest():
    points = GOOD.copy()
    points[:2, 2] = 1e300, 5e-324
    assert ts.triangulate(points).points[:2, 2].tolist() == [1e300, 5e-324]
    assert predicates.LARGEST_ELEVATION == _kernel.LARGEST_ELEVATION == 1e300


BEYOND = [np.nextafter(1e300, np.inf), -1.7e308]


@pytest.mark.parametrize("z", BEYOND)
def test_elevations_above_the_largest_are_refused_at_every_door(z):
    points = GOOD.copy()
    points[2, 2] = z
    with pytest.raises(ts.PointsError, match=r"row 2, elevation .*up to 1e\+300") as caught:
        ts.triangulate(points)
    assert caught.value.rows == (2,)
    tin = ts.triangulate(GOOD)
    x, y = GOOD[:, :2].mean(axis=0).tolist()
    doors = {
        "insert": lambda: tin.insert([[x, y, z]]),
        "move": lambda: tin.move(0, [x, y, z]),
        "set one": lambda: tin.set_elevation(0, z),
        "set": lambda: tin.set_elevation([0, 1], [1.0, z]),
        "line": lambda: tin.add_breakline([[x, y, z], [x + 0.1, y, 1.0]]),
        "triangles": lambda: ts.TIN.from_triangles(points, tin.triangles),
        "breakline": lambda: ts.triangulate(GOOD, breaklines=[[[x, y, z], [x + 0.1, y, 1.0]]]),
        "array": lambda: ts.triangulate(GOOD, breaklines=[np.array([[x, y, 0], [x, y + 0.1, z]])]),
    }
    before = tin.points.copy()
    for door in doors.values():
        with pytest.raises(ts.TinsmithError, match=r"levation.*up to 1e\+300"):
            door()
    assert np.array_equal(tin.points, before)


NO_NUMBERS = {
    "text": [["a", "b", "c"]] * 3,
    "numbers as text": [["1", "2", "3"]] * 3,
    "complex": GOOD * 1j,
    "complex without imaginary part": GOOD + 0j,
    "dates": np.zeros((3, 3), "datetime64[s]"),
    "durations": np.zeros((3, 3), "timedelta64[s]"),
    "objects": [[object()] * 3] * 3,
    "ragged rows": [[1, 2, 3], [4, 5], [6, 7, 8]],
    "dictionaries": [{"x": 1}] * 3,
    "integers beyond all doubles": [[10**400, 0, 0], [1, 0, 0], [0, 1, 0]],
}


@pytest.mark.parametrize("points", NO_NUMBERS.values(), ids=NO_NUMBERS)
def test_values_that_are_no_numbers(points):
    with pytest.raises(ts.PointsError, match="no table of real numbers"):
        ts.triangulate(points)


def test_none_is_not_finite():
    with pytest.raises(ts.PointsError, match="not finite"):
        ts.triangulate([[0, 0, None], [1, 0, 0], [0, 1, 0]])


WRONG_SHAPES = {
    "()": 5,
    "(0,)": [],
    "(3,)": [1, 2, 3],
    "(3, 2)": [[1, 2], [3, 4], [5, 7]],
    "(3, 4)": np.zeros((3, 4)),
    "(1, 3, 3)": [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]],
    "(0, 2)": np.empty((0, 2)),
}


@pytest.mark.parametrize(("shape", "points"), WRONG_SHAPES.items(), ids=WRONG_SHAPES)
def test_wrong_shapes(shape, points):
    with pytest.raises(ts.PointsError, match=r"\(n, 3\) is needed") as caught:
        ts.triangulate(points)
    assert shape in str(caught.value)


def test_faults_are_value_errors_and_our_own():
    with pytest.raises(ValueError, match="3"):
        ts.triangulate([1])
    with pytest.raises(ts.TinsmithError):
        ts.triangulate([1])


# ------------------------------------------------------------------ makes

MAKES = {
    "list of lists": GOOD.tolist(),
    "tuple of tuples": tuple(map(tuple, GOOD.tolist())),
    "list of arrays": list(GOOD),
    "integers": GOOD.astype(int),
    "small unsigned integers": GOOD.astype(np.uint8),
    "single precision": GOOD.astype(np.float32),
    "half precision": GOOD.astype(np.float16),
    "other byte order": GOOD.astype(">f8"),
    "objects": GOOD.astype(object),
    "Fortran order": np.asfortranarray(GOOD),
    "every second row": np.repeat(GOOD, 2, axis=0)[::2],
    "columns of a wider table": np.hstack([GOOD, GOOD])[:, :3],
    "reversed columns of reversed ones": np.ascontiguousarray(GOOD[:, ::-1])[:, ::-1],
    "Survey": ts.Survey(points=GOOD),
    "Survey of a list": ts.Survey(points=GOOD.tolist()),
}


@pytest.mark.parametrize("points", MAKES.values(), ids=list(MAKES))
def test_every_make_of_points_gives_the_same_tin(points):
    tin, wanted = ts.triangulate(points), ts.triangulate(GOOD)
    np.testing.assert_array_equal(tin.points, GOOD)
    np.testing.assert_array_equal(tin.triangles, wanted.triangles)
    assert tin.points.dtype == np.float64


def test_input_is_neither_changed_nor_kept():
    points = np.concatenate([GOOD, [[-0.0, 1.0, -0.0]]])
    points.flags.writeable = False
    before = points.tobytes()
    tin = ts.triangulate(points)
    assert points.tobytes() == before
    assert not np.shares_memory(tin.points, points)


def test_input_stays_writable():
    points = GOOD.copy()
    tin = ts.triangulate(points)
    points[0] = 77
    assert tin.points[0].tolist() == [0, 0, 5]


def test_crs_of_the_survey_and_no_other():
    survey = ts.Survey(points=GOOD, crs="EPSG:32616")
    assert ts.triangulate(survey).crs == "EPSG:32616"
    assert ts.triangulate(survey, crs="EPSG:32616").crs == "EPSG:32616"
    assert ts.triangulate(GOOD, crs="EPSG:25832").crs == "EPSG:25832"
    assert ts.triangulate(GOOD).crs is None
    with pytest.raises(ts.TinsmithError, match="EPSG:32616, and EPSG:25832 is another"):
        ts.triangulate(survey, crs="EPSG:25832")


def test_skipped_cells_reach_the_report():
    survey = ts.Survey(points=GOOD, skipped={"nodata cells": 12})
    assert ts.triangulate(survey).report.skipped == {"nodata cells": 12}


# ------------------------------------------------------------------ entry points


def test_points_come_out_fresh_contiguous_and_without_negative_zero():
    given = np.array([[-0.0, 1, 2]])
    points = as_points(given)
    assert points.flags.c_contiguous
    assert not np.shares_memory(points, given)
    assert not np.signbit(points[0, 0])


def test_places_may_be_nan_but_not_infinite():
    assert np.isnan(as_xy([[np.nan, 0.0]])[0, 0])
    assert as_xy(np.empty((0, 2))).shape == (0, 2)
    with pytest.raises(ts.PointsError, match="exact range"):
        as_xy([[np.inf, 0.0]])
    with pytest.raises(ts.PointsError, match=r"shape \(2,\).*\(k, 2\)"):
        as_xy([1.0, 2.0])
    with pytest.raises(ts.PointsError, match="no table of real numbers"):
        as_xy([["a", "b"]])


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_ends_of_the_exact_range_are_allowed_and_nothing_beyond(axis, sign):
    smallest, largest = _kernel.EXACT_RANGE
    for size, beyond in ((largest, np.inf), (smallest, 0.0)):
        points = np.zeros((3, 3))
        points[1, axis], points[2, 1 - axis] = sign * size, size
        assert len(ts.triangulate(points).triangles) == 1
        points[1, axis] = sign * np.nextafter(size, beyond)
        with pytest.raises(PointsError, match="1 row outside the exact range") as caught:
            ts.triangulate(points)
        assert list(caught.value.rows) == [1]


def test_errors_keep_the_first_five_rows_of_many():
    points = np.random.default_rng(1).random((9, 3))
    for bad, kind in ((np.nan, "are not finite"), (1e300, "outside the exact range")):
        rows = points.copy()
        rows[2:, 0] = bad
        with pytest.raises(PointsError, match=kind) as caught:
            ts.triangulate(rows)
        assert list(caught.value.rows) == [2, 3, 4, 5, 6]
        assert "(first: row 2" in str(caught.value)
    triangles = np.full((8, 3), [0, 1, 99])
    triangles[0] = [0, 1, 2]
    with pytest.raises(PointsError) as caught:
        ts.TIN.from_triangles(points, triangles)
    assert list(caught.value.rows) == [1, 2, 3, 4, 5]
    assert str(caught.value) == (
        "Triangle 1 has the vertices [0, 1, 99]: numbers 0 to 8 are allowed."
    )
    with pytest.raises(PointsError, match="Triangle 0 has the vertices"):
        ts.TIN.from_triangles(points, [[0, 1, -1]])
    assert len(ts.TIN.from_triangles(points, [[0, 1, 8]]).triangles) == 1


@pytest.mark.parametrize("value", [0.0, -0.0, np.nan, 1.0, *_kernel.EXACT_RANGE])
def test_exact_range_holds_its_ends_zero_and_what_is_no_number(value):
    xy = np.array([[1.0, 2.0], [-value, 3.0], [4.0, value]])
    assert _kernel.are_in_exact_range(xy)
    require_exact_range(xy[::2], "Points")
    require_exact_range(xy[:, ::-1], "Points")


@pytest.mark.parametrize(
    "value",
    [
        np.inf,
        -np.inf,
        np.nextafter(_kernel.EXACT_RANGE[0], 0),
        2.0 * _kernel.EXACT_RANGE[1],
        5e-324,
    ],
)
@pytest.mark.parametrize("place", [(0, 0), (2, 1)])
def test_one_coordinate_outside_the_exact_range_is_found(value, place):
    xy = np.ones((3, 2))
    xy[place] = value
    assert not _kernel.are_in_exact_range(xy)
    for same in (xy, np.repeat(xy, 2, axis=1)[:, ::2]):
        with pytest.raises(
            PointsError, match=f"1 row outside the exact range .first: row {place[0]}"
        ):
            require_exact_range(same, "Points")
