"""Surveys: what is given to them is checked where it is given."""

import numpy as np
import pandas as pd
import pytest

import tinsmith as ts

POINTS = [[0, 0, 1], [4, 0, 2], [4, 3, 3], [0, 3, 4]]


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("attributes", [1, 2], "Invalid attributes [1, 2]: it must be a mapping"),
        ("attributes", b"x", "Invalid attributes b'x'"),
        ("attributes", {1: POINTS}, "whose keys are text"),
        ("attributes", {"number": ["a"]}, "Invalid attribute 'number' ['a']"),
        ("attributes", {"number": "abcd"}, "one value for each point"),
        ("boundary", b"x", "Invalid boundary b'x': a sequence of lines is needed"),
        ("holes", "x", "Invalid holes 'x'"),
        ("breaklines", 5, "Invalid breaklines 5"),
        ("water", None, "Invalid water None"),
        ("erase", {"a": 1}, "Invalid erase {'a': 1}"),
        ("extent", np.float64(1), "Invalid extent 1.0"),
        ("notes", "all read", "Invalid notes 'all read': it must be a list of sentences"),
        ("skipped", [3], "Invalid skipped [3]"),
        ("source", 7, "Invalid source 7: it must be text or None"),
    ],
)
def test_what_a_survey_cannot_hold_is_refused_when_it_is_made(name, value, words):
    with pytest.raises(ts.TinsmithError) as caught:
        ts.Survey(points=POINTS, **{name: value})
    assert words in str(caught.value)


def test_columns_are_kept_as_arrays_without_the_rows_that_are_masked():
    masked = np.ma.masked_equal(POINTS, 4)
    survey = ts.Survey(points=masked, attributes={"description": ["a", "b", "c", "d"]})
    assert survey.attributes["description"].tolist() == ["a"]
    assert survey.skipped == {"masked points": 3}


def test_columns_of_a_data_frame_are_columns():
    table = pd.DataFrame({"number": [1, 2, 3, 4], "description": list("abcd")})
    survey = ts.Survey(points=POINTS, attributes=table)
    assert list(survey.attributes) == ["number", "description"]
    assert survey.attributes["number"].tolist() == [1, 2, 3, 4]


def test_one_ring_alone_is_a_boundary():
    ring = np.array([[1, 1], [3, 1], [2, 2]], float)
    tin = ts.triangulate(ts.Survey(points=POINTS, boundary=ring))
    assert tin.area == pytest.approx(1.0)
