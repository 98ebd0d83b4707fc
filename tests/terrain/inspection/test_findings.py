"""The table of blunders: reasons, rows, what is left out, and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.inspection.findings import drop_blunders, list_wrong_rows, screen
from tinsmith.tin.screening.slips import FACTORS, name_factor

SAMPLES = Path(__file__).parents[3] / "sample_data"
COUNT = 900


def make(seed=0, **columns):
    rng = np.random.default_rng(seed)
    xy = rng.random((COUNT, 2)) * [250, 180] + [752_640, 4_024_180]
    z = 320 + 3 * np.sin(xy[:, 0] / 40) + rng.normal(0, 0.02, COUNT)
    return np.column_stack([xy, z]), {"number": np.arange(1, COUNT + 1), **columns}


def survey_of(points, columns, crs="EPSG:32616"):
    return ts.Survey(points=points, attributes=columns, crs=crs)


def reasons(table):
    return dict(zip(table["row"].tolist(), table["reason"].tolist(), strict=True))


def test_each_kind_of_blunder_is_named_by_its_reason():
    points, columns = make()
    points[10, 2] = 0.0
    points[20, 2] *= 10
    points[30, 2] *= 0.3048
    points[40, 2] += 6.0
    points[50, 2] -= 6.0
    points[60, :2] = points[60, 1::-1]
    points[70, 0] *= 10
    points[80, 1] += 5_000
    points[90, :2] = [-3.0e6, 1.0e6]
    columns["number"][101] = columns["number"][100]
    table = ts.blunders(survey_of(points, columns))
    assert reasons(table) == {
        10: "code",
        20: "factor",
        30: "factor",
        40: "spike",
        50: "pit",
        60: "swapped",
        70: "factor",
        80: "isolated",
        90: "outside",
        100: "number",
        101: "number",
    }
    by_row = {row: i for i, row in enumerate(table["row"].tolist())}
    assert table["number"][by_row[40]] == "41"
    assert table["residual"][by_row[40]] == pytest.approx(6.0, abs=0.5)
    np.testing.assert_array_equal(table["z"][by_row[20]], points[20, 2])
    assert np.isnan(table["residual"][by_row[80]])
    certainty = table["certainty"].tolist()
    assert certainty == sorted(certainty, key=["high", "medium", "low"].index)


def test_a_clean_survey_has_an_empty_table_with_all_columns():
    table = ts.blunders(survey_of(*make(3)))
    assert len(table) == 0
    assert list(table.columns) == [
        *("row", "number", "file", "line", "x", "y", "z", "residual", "scale"),
        *("reason", "certainty", "explanation"),
    ]


def test_rows_of_one_place_are_judged_each_by_its_own_elevation():
    points, columns = make()
    points[11] = points[10] + [0, 0, 8.0]
    table = ts.blunders(survey_of(points, columns))
    told = [(row, why) for row, why in zip(table["row"].tolist(), table["reason"], strict=True)]
    assert set(told) >= {(10, "place"), (11, "place")}
    one = told.index((11, "place"))
    assert "differ by 8" in table["explanation"][one]


def test_lines_that_cross_at_different_elevations_are_named():
    points, columns = make()
    x, y = 752_760.0, 4_024_270.0
    level = 320 + 3 * np.sin(x / 40)
    lines = [
        ts.Breakline([[x - 5, y, level], [x + 5, y, level]], name="kerb"),
        ts.Breakline([[x, y - 5, level + 4], [x, y + 5, level + 4]], name="wall"),
    ]
    survey = ts.Survey(points=points, attributes=columns, breaklines=lines)
    table = ts.blunders(survey)
    crossing = table["reason"].tolist().index("crossing")
    assert table["row"][crossing] == -1
    assert "'kerb'" in table["explanation"][crossing]
    assert table["residual"][crossing] == pytest.approx(4.0)
    assert (table["x"][crossing], table["y"][crossing]) == (x, y)


def test_repeated_numbers_that_most_points_have_are_a_note():
    points, columns = make()
    columns["number"] = np.repeat(np.arange(COUNT // 2), 2)
    table = ts.blunders(survey_of(points, columns))
    assert len(table) == 0
    assert "900 of 900 point numbers are repeated" in " ".join(table.notes)


def test_a_second_site_is_no_blunder():
    points, columns = make()
    points[:30, 0] += 20_000
    assert len(ts.blunders(survey_of(points, columns))) == 0


def test_a_wrong_crs_is_a_note_and_not_a_table_of_all_points():
    points, columns = make()
    table = ts.blunders(survey_of(points, columns, crs="EPSG:27700"))
    assert len(table) == 0
    assert "outside the area of use" in " ".join(table.notes)


def test_rows_keep_their_numbers_after_edits():
    points, columns = make()
    points[40, 2] += 6.0
    tin = ts.triangulate(survey_of(points, columns))
    tin.remove(3)
    assert reasons(ts.blunders(tin)) == {40: "spike"}


def test_nothing_is_changed_by_looking():
    points, columns = make()
    points[40, 2] += 6.0
    points[80, 1] += 5_000
    tin = ts.triangulate(survey_of(points, columns))
    before = tin.points.copy(), tin.triangles.copy()
    ts.blunders(tin)
    screen(tin)
    np.testing.assert_array_equal(tin.points, before[0])
    np.testing.assert_array_equal(tin.triangles, before[1])
    assert tin.edits == ()


def test_dropping_leaves_the_surface_of_the_others():
    points, columns = make()
    points[40, 2] += 6.0
    points[80, 1] += 5_000
    columns["number"][101] = columns["number"][100]
    tin = ts.triangulate(survey_of(points, columns))
    table = ts.blunders(tin)
    assert drop_blunders(tin, table)[1].tolist() == list_wrong_rows(table).tolist() == [40, 80]
    assert tin.report.left_out_rows.tolist() == [40, 80]
    rest = ts.triangulate(np.delete(points, [40, 80], axis=0))
    np.testing.assert_array_equal(tin.points, rest.points)
    np.testing.assert_array_equal(tin.triangles, rest.triangles)


def test_a_vertex_of_a_sound_row_is_not_dropped():
    points, columns = make()
    points[11] = points[10] + [0, 0, 900.0]
    tin = ts.triangulate(survey_of(points, columns), duplicates="first")
    assert drop_blunders(tin, ts.blunders(tin))[1].tolist() == []


def test_screening_finds_spikes_and_pits_of_many_points():
    rng = np.random.default_rng(2)
    xy = rng.random((15_000, 2)) * 1_000
    points = np.column_stack([xy, 300 + 10 * np.sin(xy[:, 0] / 90) + rng.normal(0, 0.02, 15_000)])
    inside = np.flatnonzero((np.abs(xy - 500) < 450).all(axis=1))
    chosen = np.sort(inside[:: len(inside) // 8][:8])
    points[chosen, 2] += 25.0
    tin = ts.triangulate(points)
    assert sorted(screen(tin)["row"].tolist()) == chosen.tolist()
    assert sorted(ts.blunders(tin)["row"].tolist()) == chosen.tolist()


def test_the_sample_data_raise_no_alarm_that_would_be_dropped():
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616")
    for one in (survey, ts.lines_from_codes(survey)):
        assert len(list_wrong_rows(ts.blunders(one))) == 0
    hills = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif", stride=4))
    assert len(ts.blunders(hills)) == 0


@pytest.mark.parametrize("points", [3, None, [[0, 0, 1]], "points.csv"])
def test_what_is_no_survey_is_refused(points):
    with pytest.raises(ts.OptionError, match="a Survey or a TIN"):
        ts.blunders(points)


@pytest.mark.parametrize("count", [3, 4, 5])
def test_a_few_points_are_never_blunders(count):
    points = np.random.default_rng(count).random((count, 3))
    assert len(ts.blunders(ts.triangulate(points))) == 0


def test_equal_elevations_and_one_that_is_not():
    x, y = np.divmod(np.arange(100.0), 10)
    z = np.full(100, 318.0)
    assert len(ts.blunders(ts.triangulate(np.column_stack([x, y, z])))) == 0
    z[44] = 318.5
    assert reasons(ts.blunders(ts.triangulate(np.column_stack([x, y, z])))) == {44: "spike"}


@pytest.mark.parametrize("factor", FACTORS)
def test_factors_are_told_from_each_other(factor):
    others = [one for one in FACTORS if one != factor]
    assert name_factor(327.4 * factor, 327.4, 0.5) == FACTORS[factor]
    assert all(name_factor(327.4 * factor, 327.4, 0.5) != FACTORS[one] for one in others)
    assert name_factor(327.4 * factor * 1.7, 327.4, 0.5) is None
