"""File and line of each row, from text to the table of findings."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

COUNT = 8


def write(path, wrong=(), first=1, skipped=""):
    """Write a grid, with a header, an empty line, and rows that are skipped."""
    rows = ["Pt,N,E,Z", ""]
    for i in range(COUNT**2):
        y, x = divmod(i, COUNT)
        z = 0.0 if i in wrong else 320 + 0.3 * x
        rows.append(f"{first + i},{4024200 + 10 * y},{752700 + 10 * x},{z:.3f}")
        if i == 4:
            rows += [skipped] if skipped else []
    path.write_text("\n".join(rows) + "\n")
    return path


def find_line(path, number):
    lines = path.read_text().splitlines()
    return 1 + next(i for i, line in enumerate(lines) if line.startswith(f"{number},"))


def test_a_finding_has_the_line_that_an_editor_shows(tmp_path):
    path = write(tmp_path / "a.csv", wrong=(20,), skipped="77,bad,752700,3")
    survey = ts.read(path, crs="EPSG:32616", skip_bad=True)
    table = ts.blunders(survey)
    assert table["row"].tolist() == [20]
    assert table["number"].tolist() == ["21"]
    assert table["file"].tolist() == ["a.csv"]
    assert table["line"].tolist() == [find_line(path, 21)]


def test_of_several_files_each_row_has_its_own(tmp_path):
    one = write(tmp_path / "a.csv", wrong=(20,))
    other = tmp_path / "b.csv"
    write(other, wrong=(30,), first=101)
    moved = other.read_text().replace(",7527", ",7537")
    other.write_text(moved)
    tin = ts.triangulate(ts.read([one, other], crs="EPSG:32616"))
    table = ts.blunders(tin)
    places = dict(zip(table["number"], zip(table["file"], table["line"], strict=True), strict=True))
    assert places == {"21": ("a.csv", find_line(one, 21)), "131": ("b.csv", find_line(other, 131))}


def test_they_stay_with_their_rows_through_edits_and_moves(tmp_path):
    path = write(tmp_path / "a.csv", wrong=(20,))
    tin = ts.triangulate(ts.read(path, crs="EPSG:32616"))
    tin.remove(tin.vertex_of[3])
    tin.insert([[752_731.0, 4_024_233.0, 900.0]])
    moved = tin.transform(lambda points: points * [1.0, 1.0, 2.0], crs="EPSG:32616")
    for one in (tin, moved):
        table = ts.blunders(one)
        found = dict(zip(table["number"].tolist(), table["line"].tolist(), strict=True))
        assert found["21"] == find_line(path, 21)
        assert found.get("", 0) == found.get("nan", 0) == 0  # what was inserted has no line


def test_points_that_were_left_out_take_their_lines_with_them(tmp_path):
    survey = ts.read(write(tmp_path / "a.csv"), crs="EPSG:32616")
    points = np.ma.masked_array(survey.points, np.zeros(survey.points.shape, bool))
    points[5] = np.ma.masked
    masked = ts.Survey(points=points, row_sources=survey.row_sources)
    assert masked.row_sources.lines.tolist() == np.delete(survey.row_sources.lines, 5).tolist()
    fewer = ts.Survey(points=survey.points[:7], row_sources=survey.row_sources)
    assert fewer.row_sources is None


def test_what_is_no_source_is_refused():
    with pytest.raises(ts.OptionError, match="row_sources"):
        ts.Survey(points=[[0, 0, 1]], row_sources=[1])
