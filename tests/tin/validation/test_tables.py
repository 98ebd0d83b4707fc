"""Tables of coordinates as callers have them: masks, names of columns, geometries."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import shapely

import tinsmith as ts

CORNERS = [[0.0, 0.0, 1.0], [4.0, 0.0, 2.0], [4.0, 3.0, 3.0], [0.0, 3.0, 4.0]]
XYZ = np.array([*CORNERS, [1.0, 1.0, 9.0]])


def masked(rows=(4,), column=2):
    table = np.ma.array(XYZ.copy(), mask=np.zeros(XYZ.shape, bool))
    table.data[list(rows), column] = -9999.0
    table[list(rows), column] = np.ma.masked
    return table


def structured(names):
    table = np.empty(len(XYZ), [(name, float) for name in names])
    for name, column in names.items():
        table[name] = 0.0 if column is None else XYZ[:, column]
    return table


# ------------------------------------------------------------------------ masks


@pytest.mark.parametrize("column", [0, 2])
def test_masked_rows_are_left_out_and_reported(column):
    tin = ts.triangulate(masked([1, 4], column=column))
    assert tin.points[:, 2].tolist() == [1.0, 3.0, 4.0]
    assert tin.vertex_of.tolist() == [0, -1, 1, 2, -1]
    assert tin.report.n_rows == 5
    assert tin.report.to_dict()["left_out"] == {"masked": [1, 4]}
    assert ts.check(tin, points=masked([1, 4], column=column)).ok


def test_masked_rows_with_lines_and_duplicates_keep_their_numbers():
    points = np.ma.concatenate([masked([0]), np.ma.array(XYZ[1:2])])
    tin = ts.triangulate(points, breaklines=[CORNERS[:2]], duplicates="highest")
    assert tin.report.to_dict()["left_out"] == {"masked": [0]}
    (merge,) = tin.report.merges()
    assert merge.rows == (1, 5)
    with pytest.raises(ts.PointsError, match="rows 1, 5 at") as caught:
        ts.triangulate(points, duplicates="error")
    assert caught.value.rows == (1, 5)


def test_rows_merged_beside_erased_ones_keep_their_numbers():
    ring = [[-1, -1], [1, -1], [1, 0.5], [-1, 0.5]]
    tin = ts.triangulate([*XYZ, XYZ[3]], erase=[ring])
    assert tin.report.to_dict()["left_out"] == {"erased": [0]}
    assert [merge.rows for merge in tin.report.merges()] == [(3, 5)]


def test_masks_in_structured_arrays_and_lists_of_rows():
    names = np.ma.array(structured({"z": 2, "x": 0, "y": 1}))
    names["z"][4] = np.ma.masked
    assert ts.triangulate(names).vertex_of.tolist() == [0, 1, 2, 3, -1]
    assert ts.triangulate(list(masked())).vertex_of.tolist() == [0, 1, 2, 3, -1]


@pytest.mark.parametrize(
    ("act", "error", "sentence"),
    [
        (lambda tin: ts.Breakline(masked()), ts.LinesError, "1 masked vertex"),
        (lambda tin: ts.Water(masked()[:, :2], 1.0), None, ""),
        (lambda tin: ts.Water(masked(column=0)[:, :2], 1.0), ts.LinesError, "masked"),
        (lambda tin: tin.insert(masked()), ts.PointsError, "1 of 5 points is masked"),
        (lambda tin: tin.move(0, masked()[4]), ts.PointsError, "masked"),
        (lambda tin: tin.set_elevation([0, 1], masked()[3:, 2]), ts.PointsError, "masked"),
        (lambda tin: ts.TIN.from_triangles(masked(), [[0, 1, 2]]), ts.PointsError, "masked"),
    ],
)
def test_masks_are_refused_where_nothing_can_be_left_out(act, error, sentence):
    tin = ts.triangulate(XYZ)
    if error is None:
        act(tin)
        return
    with pytest.raises(error, match=sentence):
        act(tin)


def test_masked_queries_lie_nowhere():
    tin = ts.triangulate(XYZ)
    queries = np.ma.array([[1.0, 1.0], [1.0, 1.0]], mask=[[False, False], [False, True]])
    assert tin.locate(queries)[1] == -1
    assert np.isnan(tin.interpolate(queries)).tolist() == [False, True]


def test_survey_of_masked_points_leaves_them_out_with_their_attributes():
    survey = ts.Survey(points=masked(), attributes={"number": np.arange(5)})
    assert len(survey) == 4
    assert survey.attributes["number"].tolist() == [0, 1, 2, 3]
    assert survey.skipped == {"masked points": 1}


# ------------------------------------------------------------------------ names


@pytest.mark.parametrize(
    "names",
    [
        {"z": 2, "y": 1, "x": 0},
        {"northing": 1, "easting": 0, "elevation": 2},
        {"Lat": 1, "LON": 0, "Height": 2},
        {"number": None, "n": 1, "e": 0, "h": 2, "code": None},
    ],
)
def test_columns_are_taken_by_name(names):
    tables = [structured(names), pd.DataFrame(structured(names))]
    tables.append({name: tables[0][name] for name in names})
    for table in tables:
        np.testing.assert_array_equal(ts.triangulate(table).points, XYZ)
        np.testing.assert_array_equal(ts.Survey(points=table).points, XYZ)
        np.testing.assert_array_equal(ts.Breakline(table).coords, XYZ)
        tin = ts.triangulate(CORNERS)
        assert tin.interpolate(table).tolist() == tin.interpolate(XYZ[:, :2]).tolist()
        tin.insert(table)
        assert len(tin.points) == 5


def test_columns_without_names_are_taken_by_their_order():
    np.testing.assert_array_equal(ts.triangulate(pd.DataFrame(XYZ)).points, XYZ)


@pytest.mark.parametrize(
    ("names", "sentence"),
    [
        ({"a": 0, "b": 1, "c": 2}, "columns 'a', 'b', 'c', and none of them is called easting"),
        ({"x": 0, "y": 1, "value": 2}, "none of them is called elevation: one of z, elevation"),
        ({"x": 0, "lon": 0, "y": 1, "z": 2}, "two columns for the easting, 'x' and 'lon'"),
    ],
)
def test_names_that_do_not_tell_the_coordinates_are_refused(names, sentence):
    for table in (structured(names), pd.DataFrame(structured(names))):
        with pytest.raises(ts.PointsError, match=sentence):
            ts.triangulate(table)


@pytest.mark.parametrize(("count", "listed"), [(7, 7), (8, 8), (9, 8), (12, 8)])
def test_eight_names_at_most_are_listed(count, listed):
    names = [f"column{k}" for k in range(count)]
    with pytest.raises(ts.PointsError) as caught:
        ts.triangulate(pd.DataFrame({name: [0.0, 1.0, 2.0] for name in names}))
    shown = ", ".join(f"'{name}'" for name in names[:listed])
    assert f"{shown}{', ...' if count > listed else ', and none'}" in str(caught.value)
    assert f"column{listed}'" not in str(caught.value)


def test_line_of_two_named_columns_is_draped():
    line = ts.Breakline(pd.DataFrame({"y": [0.0, 3.0], "x": [0.0, 4.0]}))
    assert line.is_draped
    assert line.coords.tolist() == [[0.0, 0.0], [4.0, 3.0]]


def test_missing_value_of_a_data_frame_is_not_finite():
    table = pd.DataFrame({"x": [0, 4, 4], "y": [0, 0, 3], "z": pd.array([1, None, 3], "Int64")})
    with pytest.raises(ts.PointsError, match=r"first: row 1, elevation nan"):
        ts.triangulate(table)


@pytest.mark.parametrize("text", ["1.5", b"1.5"])
def test_text_is_no_number_even_where_it_looks_like_one(text):
    with pytest.raises(ts.PointsError, match="without text"):
        ts.triangulate(np.array([[0, 0, text], [4, 0, 1], [4, 3, 2]], object))


# -------------------------------------------------------------------- geometries


def test_points_of_shapely():
    points = shapely.points(XYZ)
    for given in (points, points.tolist()):
        np.testing.assert_array_equal(ts.triangulate(given).points, XYZ)
    tin = ts.triangulate(CORNERS)
    assert tin.interpolate(points).tolist() == tin.interpolate(XYZ[:, :2]).tolist()
    with pytest.raises(ts.PointsError, match=r"shape \(5, 2\)"):
        ts.triangulate(shapely.points(XYZ[:, :2]))
    with pytest.raises(ts.PointsError, match="not all of them points"):
        ts.triangulate([points[0], shapely.LineString(XYZ)])


def test_line_of_shapely():
    assert ts.Breakline(shapely.LineString(XYZ)).coords.tolist() == XYZ.tolist()
    assert ts.Breakline(shapely.LineString(XYZ[:, :2])).is_draped


def test_geometries_and_a_column_of_elevations():
    frame = pd.DataFrame({"z": XYZ[:, 2], "geometry": shapely.points(XYZ[:, :2])})
    np.testing.assert_array_equal(ts.triangulate(frame).points, XYZ)
    frame["geometry"] = shapely.points(np.add(XYZ, [0, 0, 100]))
    with pytest.raises(ts.PointsError, match="elevations in their geometries and others"):
        ts.triangulate(frame)


def test_masked_table_without_rows():
    with pytest.raises(ts.PointsError, match="0 points cannot make a TIN"):
        ts.triangulate(np.ma.array(np.zeros((0, 3))))


@pytest.mark.parametrize("number", [2**53 + 1, -(2**53) - 1, 2**63 - 1, 2**64 - 1, -(2**63)])
@pytest.mark.parametrize("make", [np.array, pd.DataFrame])
def test_whole_numbers_that_doubles_may_not_hold_are_refused(number, make):
    dtype = np.int64 if number < 2**63 else np.uint64
    rows = np.array([[0, 0, 5], [4, 0, 6], [0, number, 7]], dtype)
    rows = make(rows) if make is np.array else make(rows, columns=["x", "y", "z"])
    with pytest.raises(ts.PointsError, match=rf"whole number {number}: doubles.* up to 2\*\*53"):
        ts.triangulate(rows)


def test_the_largest_whole_numbers_are_kept():
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 2**53, 7]])
    assert tin.points[:, 1].max() == 2**53
