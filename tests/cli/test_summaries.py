"""What the commands say of points, TINs and reports: small cases worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.cli.output import line_summaries, summaries
from tinsmith.tin.meshing.shape_quality import quality

GROUND = [[0, 0, 10], [4, 0, 10], [4, 3, 10], [0, 3, 10], [4, 0, 10], [0, 0, 12], [0, 0, 11.5]]
NUMBERS = np.array([5, 6, 7, 8, 9, 10, 11])
LINES = [[[1, 1, 20], [3, 2, 20]], [[1, 2, 23], [3, 1, 23]]]
UTM = "EPSG:32616"
TETRA = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, 2]]


@pytest.fixture(scope="module")
def survey():
    return ts.Survey(points=GROUND, breaklines=LINES, attributes={"number": NUMBERS})


@pytest.fixture(scope="module")
def report(survey):
    return ts.triangulate(survey).report


def test_merged_rows_are_named_by_point_number_or_row(survey, report):
    assert summaries.summarise_merges(report, survey) == [
        ("Merged", "3 rows at 2 places, elevation by 'mean'"),
        (
            "",
            "elevations differ at 1 place, most by 2.000: "
            "points 5 (10.000), 10 (12.000), 11 (11.500)",
        ),
    ]
    metres = ts.Survey(points=GROUND, crs=UTM, elevation_unit="m")
    (_, (_, text)) = summaries.summarise_merges(ts.triangulate(metres).report, metres)
    assert text.endswith("most by 2.000 m: rows 0 (10.000), 5 (12.000), 6 (11.500)")


def test_the_place_where_elevations_differ_most_is_told():
    points = [[0, 0, 1], [9, 0, 1], [0, 9, 1], [0, 0, 1.5], [9, 0, -6], [0, 9, 1]]
    many = [*points, *([9, 0, z] for z in range(2, 6))]
    tin = ts.triangulate(many)
    (_, total), (_, worst) = summaries.summarise_merges(tin.report, ts.Survey(points=many))
    assert total == "7 rows at 3 places, elevation by 'mean'"
    assert worst == (
        "elevations differ at 2 places, most by 11.000: "
        "rows 1 (1.000), 4 (-6.000), 6 (2.000), 7 (3.000) ..."
    )
    same = [*points[:3], points[0], points[0]]
    assert summaries.summarise_merges(ts.triangulate(same).report, ts.Survey(points=same)) == [
        ("Merged", "2 rows at 1 place, with equal elevations")
    ]
    assert (
        summaries.summarise_merges(ts.triangulate(points[:3]).report, ts.Survey(points=points[:3]))
        == []
    )


def test_crossings_are_told_by_the_worst(survey, report):
    assert line_summaries.summarise_lines(survey, ts.triangulate(survey)) == [
        ("Lines", "2 breaklines"),
        ("Crossings", "at 1 place, elevations differ most by 3.000"),
        ("", "at x 2.000, y 1.500: breakline 0 at 20.000, breakline 1 at 23.000, taken 20.000"),
    ]
    level = ts.Survey(points=GROUND, breaklines=[LINES[0], np.array(LINES[1]) - [0, 0, 3]])
    assert line_summaries.summarise_lines(level, ts.triangulate(level))[1:] == [
        ("Crossings", "at 1 place, at equal elevations")
    ]
    assert line_summaries.summarise_lines(ts.Survey(points=TETRA), ts.triangulate(TETRA)) == []


def test_what_gave_way_and_what_was_left_out():
    lines = [[[1, 1, 20], [2, 2, 21]]]
    points = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0], [1, 1, 17], [2, 2, 20], [8, 1, 5]]
    ring = [[0, 0], [7, 0], [7, 9], [0, 9]]
    survey = ts.Survey(points=points, breaklines=lines, boundary=[ring])
    fields = dict(line_summaries.summarise_lines(survey, ts.triangulate(survey)))
    assert fields["Lines"] == "1 breakline, 1 boundary ring"
    told = "2 overruled by lines of higher priority, the most by 3.000"
    assert fields["Elevations"].startswith(told)
    assert fields["Left out"].startswith("3 rows: 3 ")


def test_points_in_words_and_numbers(survey):
    assert summaries.summarise_survey(survey) == [
        ("Points", "7"),
        ("Columns", "number"),
        ("Lines", "2 breaklines"),
        ("Extent", "4.000 units x 3.000 units"),
        ("", "easting 0.000 to 4.000"),
        ("", "northing 0.000 to 3.000"),
        ("Elevation", "10.000 to 12.000 (unit not known)"),
        ("CRS", "unknown (name it with --crs)"),
    ]
    found = summaries.describe_survey(survey)
    assert found["points"] == 7
    assert found["kind"] == "points"
    assert found["bounds"] == {"xmin": 0.0, "ymin": 0.0, "xmax": 4.0, "ymax": 3.0}
    mean = pytest.approx(sum(z for *_, z in GROUND) / 7)
    assert found["elevation"] == {"min": 10.0, "max": 12.0, "mean": mean, "unit_assumed": None}
    assert (found["breaklines"], found["water"]) == (2, 0)
    assert found["units"] == {"horizontal": "unknown", "vertical": "unknown"}


def test_a_pyramid_in_words_and_numbers():
    tin = ts.triangulate(TETRA, crs=UTM)
    assert summaries.summarise_tin(tin) == [
        ("TIN", "5 vertices, 4 triangles"),
        ("Edges", "8, 4 of them on the boundary"),
        ("Extent", "4.000 m x 4.000 m"),
        ("", "easting 0.000 to 4.000"),
        ("", "northing 0.000 to 4.000"),
        (
            "Elevation",
            f"0.000 to 2.000 (unit not known, taken to be metre, the usual one in {UTM})",
        ),
        ("Area", "16.0 m² in the plane"),
        ("", f"{16 * math.sqrt(2):.1f} m² in space"),
        ("Slope", "45.0° to 45.0°, mean 45.0°"),
        ("CRS", f"{UTM}, WGS 84 / UTM zone 16N"),
    ]
    found = summaries.describe_tin(tin)
    assert found["elevation"]["unit_assumed"] == "metre"
    assert found["hull_vertices"] == 4
    assert (found["crs"], found["crs_name"]) == (UTM, "WGS 84 / UTM zone 16N")
    known = ts.triangulate(TETRA, crs=UTM, elevation_unit="ft")
    assert summaries.find_symbols(known) == (" m", " ft")
    assert summaries.note_assumed_unit(known) == ""
    assert ("Elevation", "0.000 to 2.000 ft") in summaries.summarise_tin(known)


def test_degrees_have_no_area():
    tin = ts.triangulate(TETRA, crs="EPSG:4326")
    labels = [label for label, _ in summaries.summarise_tin(tin)]
    assert "Area" not in labels
    assert ("Extent", "4.0000000° x 4.0000000°") in summaries.summarise_tin(tin)
    assert ("", "longitude 0.0000000 to 4.0000000") in summaries.summarise_tin(tin)
    assert summaries.measure_quality(tin) is None
    assert summaries.summarise_quality(None) == []


def test_quality_in_words():
    right = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])  # 45, 45, 90 degrees
    (_, angles), (_, aspect) = summaries.summarise_quality(summaries.measure_quality(right))
    assert angles == "smallest angle: median 45.0°, worst 45°, below 20° in 0.0 % of triangles"
    assert aspect.startswith(f"aspect ratio: median {quality(right).aspect_ratio[0]:.2f}, worst ")
    thin = ts.triangulate([[0, 0, 0], [100, 0, 0], [50, 1, 0]])
    (_, angles), (_, aspect) = summaries.summarise_quality(quality(thin))
    assert angles.endswith("below 20° in 100.0 % of triangles")
    assert f"worst {math.degrees(math.atan(1 / 50)):.2g}°" in angles


@pytest.mark.parametrize(
    ("value", "words"),
    [(1.234, "1.23"), (99.96, "100"), (100.4, "100"), (12_345.6, "12,346"), (1e9, "1e+09")],
)
def test_ratios(value, words):
    assert summaries._format_ratio(value) == words


def test_what_the_reader_skipped_and_noted():
    survey = replace(
        ts.Survey(points=TETRA),
        skipped={"header lines": 1, "rows without an elevation": 1, "nodata cells": 1200},
        notes=("odd",),
    )
    assert summaries.summarise_reading(survey) == [
        ("Note", "Left out by the reader: 1 row without an elevation, 1,200 nodata cells."),
        ("Note", "odd"),
    ]
    plain = ts.Survey(points=TETRA)
    assert summaries.summarise_reading(replace(plain, skipped={"header lines": 3})) == []


def test_the_report_with_point_numbers(survey, report):
    tin = SimpleNamespace(report=report, row_attributes=survey.attributes)
    found = summaries.describe_report(tin, survey, ["a gap"])
    assert found["notes"][-1] == "a gap"
    assert [merge["numbers"] for merge in found["merges"]] == [[5, 10, 11], [6, 9]]
    assert all(type(n) is int for merge in found["merges"] for n in merge["numbers"])
    plain = SimpleNamespace(report=report, row_attributes={})
    without = summaries.describe_report(plain, ts.Survey(points=GROUND))
    assert "numbers" not in without["merges"][0]
    assert line_summaries.count_lines(report) == {
        "rows": 7,
        "merged": 3,
        "left_out": {},
        "lines": 2,
        "crossings": 1,
        "overruled": 0,
    }
