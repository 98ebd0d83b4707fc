"""Headers that are repeated, titles of pages and last lines, in tables whose points are known."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

HEADER = "Nr,E,N,Z"
ROWS = [f"{i},{5000 + 7 * i}.5,{1000 + 3 * i}.25,{90 + i}.125" for i in range(8)]
POINTS = np.array([[5000.5 + 7 * i, 1000.25 + 3 * i, 90.125 + i] for i in range(8)])


def read(tmp_path, lines, name="a.csv", **options):
    path = tmp_path / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return ts.read(path, **options)


def test_a_repeated_header_is_left_out_and_named(tmp_path):
    survey = read(tmp_path, [HEADER, *ROWS[:4], HEADER, *ROWS[4:]])
    assert np.array_equal(survey.points, POINTS)
    assert survey.skipped_lines == {"repeated header lines": (6,)}
    assert list(survey.notes) == ["1 repeated header line is left out: line 6."]


def test_a_page_break_is_left_out_with_its_title_and_units(tmp_path):
    units = ",m,m,m"
    page = ["\fPage 2", "Project: A7", HEADER, units]
    survey = read(tmp_path, [HEADER, units, *ROWS[:4], *page, *ROWS[4:]])
    assert np.array_equal(survey.points, POINTS)
    assert survey.skipped_lines == {"repeated header lines": (9, 10), "page titles": (7, 8)}


@pytest.mark.parametrize("end", ["END", "EOF", "*** end of file ***", "Ende", "Fin de fichier"])
def test_a_last_line_that_says_end_is_left_out(tmp_path, end):
    survey = read(tmp_path, [HEADER, *ROWS, end])
    assert np.array_equal(survey.points, POINTS)
    assert survey.skipped_lines == {"end lines": (10,)}


def test_another_header_and_another_last_line_are_refused(tmp_path):
    with pytest.raises(ts.ReadError):
        read(tmp_path, [HEADER, *ROWS[:4], "Nr,N,E,Z", *ROWS[4:]])
    with pytest.raises(ts.ReadError):
        read(tmp_path, [HEADER, *ROWS, "total 8"])


@pytest.mark.parametrize("sign", ["\u2212", "\uff0d", "-"])
def test_signs_of_minus(tmp_path, sign):
    rows = [row.replace(",5", f",{sign}5", 1) for row in ROWS]
    survey = read(tmp_path, [HEADER, *rows])
    assert np.array_equal(survey.points, POINTS * (-1, 1, 1))


def test_a_count_and_a_header_without_rows_are_refused(tmp_path):
    with pytest.raises(ts.ReadError, match="no row"):
        read(tmp_path, ["6", "E;N;Z"], "a.txt")


def test_two_words_for_a_number_between_blanks_are_one_column(tmp_path):
    """The code of digits behind the elevation was read as the elevation."""
    lines = [f"{row.replace(',', ' ')} {11 + i % 3}" for i, row in enumerate(ROWS)]
    survey = read(tmp_path, ["Point No. Easting Northing Elevation Description", *lines], "a.txt")
    assert np.array_equal(survey.points, POINTS)


@pytest.mark.parametrize("label", ["# order:", "# columns", "//", "# column order is", ";"])
def test_what_stands_before_an_order_is_no_column(tmp_path, label):
    """With a column more than the line names, its label was taken for the first."""
    rows = [f"{row.partition(',')[2]},{11 + i % 3}" for i, row in enumerate(ROWS)]
    try:
        survey = read(tmp_path, [f"{label} easting northing elevation", *rows])
    except ts.ReadError:
        return
    assert np.array_equal(survey.points, POINTS)


@pytest.mark.parametrize("line", ["", "#", "//", "# ", ";;", "#;"])
@pytest.mark.parametrize("separator", [",", " ", ";", "\t"])
def test_a_line_without_words_above_rows_says_nothing(tmp_path, line, separator):
    rows = [row.replace(",", separator) for row in ROWS]
    survey = read(tmp_path, ["# job A7", line, *rows], columns="PENZ")
    assert np.array_equal(survey.points, POINTS)


@pytest.mark.parametrize("header", ["Nr;X;Y;Wysokość", "点名;X座標;Y座標;標高", "Имя;X;Y;Отметка"])
def test_languages_that_call_the_northing_x(tmp_path, header):
    """Where neither a CRS nor the area of use decides, the file is refused."""
    rows = [row.replace(",", ";") for row in ROWS]
    with pytest.raises(ts.ReadError, match="where X is the northing on maps"):
        read(tmp_path, [header, *rows])
    assert np.array_equal(read(tmp_path, [header, *rows], columns="PENZ").points, POINTS)
    grid = [f"{i};{5788000 + i}.5;{7501000 + 2 * i}.5;{90 + i}.5" for i in range(8)]
    survey = read(tmp_path, [header, *grid], crs="EPSG:2178")
    assert survey.points[0].tolist() == [7501000.5, 5788000.5, 90.5]


def test_the_empty_name_of_an_index_is_a_column(tmp_path):
    """As pandas and R write the numbers of rows."""
    path = tmp_path / "a.csv"
    for name in ("", '""'):
        rows = "".join(f"{i},{1000.25 + 3 * i},{90.125 + i},{11 + i % 3}\n" for i in range(8))
        path.write_text(f"{name},easting,northing,elevation\n{rows}")
        assert ts.read(path).points[0].tolist() == [1000.25, 90.125, 11.0]
