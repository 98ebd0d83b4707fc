"""What a format does not hold of a survey: all of it comes back, or a warning names it."""

import re
import warnings

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io.registry.lookup import known_formats

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case

ATTRIBUTES = {
    "number": np.array(["1", "2", "A3"]),
    "description": np.array(["kerb", "", "edge of the pond"]),
    "code": np.array(["EP", "EP", "GR"]),
    "depth": np.array([1.5, 2.25, -3.0]),
    "visits": np.array([4, 5, 6]),
    "id": np.array([2**53 + 1, 2, 3]),
}
POINTS = [[500_000, 4_000_000, 10], [500_010, 4_000_000, 11], [500_010, 4_000_010, 12.5]]
WRITERS = {one.name: one for one in known_formats() if one.write and "Survey" in one.writes}


def make_survey(**attributes):
    return ts.Survey(points=np.array(POINTS), attributes=attributes, crs="EPSG:32616")


def write(survey, path, **options):
    """Write and return what was told of losses."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        ts.write(survey, path, **options)
    return [str(one.message) for one in told if issubclass(one.category, ts.LossWarning)]


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("attribute", ATTRIBUTES)
def test_an_attribute_comes_back_or_is_named(tmp_path, name, attribute):
    values = ATTRIBUTES[attribute]
    path = tmp_path / f"a{WRITERS[name].suffixes[0]}"
    told = write(make_survey(**{attribute: values}), path, format=name)
    is_stated = bool(re.search(rf"\b{attribute}\b", " ".join(told).replace(str(path), "")))
    found = read(path, name).attributes.values()
    comes_back = any(list(column) == list(values) for column in found)
    assert is_stated or comes_back


def read(path, name):
    """Read a file; readers of text call a column as they understand its header."""
    given = {
        "landxml": {"elevation_unit": "metre"},
        "geojson": {"crs": "EPSG:32616"},
        "geojsonseq": {"crs": "EPSG:32616"},
        "las": {"attributes": "all"},
    }
    chosen = None if name == "gpkg" else name
    return ts.read(path, format=chosen, **given.get(name, {}))


@pytest.mark.parametrize("suffix", [".csv", ".xml", ".dxf"])
def test_a_line_break_becomes_a_blank_and_is_told(tmp_path, suffix):
    survey = make_survey(description=np.array(["two\nlines", "one", ""]))
    (told,) = write(survey, tmp_path / f"a{suffix}")
    assert "line breaks within the texts of description became blanks" in told
    again = ts.read(
        tmp_path / f"a{suffix}", **({"elevation_unit": "m"} if suffix == ".xml" else {})
    )
    assert list(again.attributes["description"]) == ["two lines", "one", ""]


@pytest.mark.parametrize("numbers", [["1", "1", "2"], ["1", "", "2"]])
def test_numbers_that_landxml_does_not_allow_are_told(tmp_path, numbers):
    (told,) = write(make_survey(number=np.array(numbers)), tmp_path / "a.xml")
    assert "points are numbered 1, 2, 3 ... anew" in told
    again = ts.read(tmp_path / "a.xml", elevation_unit="m")
    assert list(again.attributes["number"]) == ["1", "2", "3"]


@pytest.mark.parametrize("suffix", [".xml", ".dxf"])
def test_lines_that_lose_their_elevations_are_told(tmp_path, suffix):
    rows = [[500_000, 4_000_000, 5], [500_010, 4_000_000, np.nan], [500_010, 4_000_010, 7]]
    lines = ts.Features.of_lines(rows, [0, 3], crs="EPSG:32616", elevation_unit="metre")
    (told,) = write(lines, tmp_path / f"a{suffix}")
    assert "lines with 1 vertex of unknown elevation lost all their elevations" in told


def test_a_survey_without_what_is_lost_is_written_in_silence(tmp_path):
    for name in WRITERS:
        assert write(make_survey(), tmp_path / f"a{WRITERS[name].suffixes[0]}", format=name) == []
