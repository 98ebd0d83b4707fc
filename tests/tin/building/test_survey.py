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


NAN = float("nan")


@pytest.mark.parametrize(
    ("given", "kept", "kind"),
    [
        ([1, 2, 3, 4], [1, 2, 3, 4], "i"),
        ((1.5, 2, 3, 4), [1.5, 2, 3, 4], "f"),
        (["EP1", "EP2", "", "GS"], ["EP1", "EP2", "", "GS"], "U"),
        ([1, "2A", 3, 4], [1, "2A", 3, 4], "O"),
        ([2**63 + 1, -1, 0, 0], [2**63 + 1, -1, 0, 0], "O"),
        ([1, None, 3, 4], [1, None, 3, 4], "O"),
        (np.ma.array([1, 2, 3, 4], mask=[0, 1, 0, 0]), [1, None, 3, 4], "O"),
        (np.ma.array([1, 2, 3, 4], mask=False), [1, 2, 3, 4], "i"),
    ],
)
def test_lists_of_attributes_keep_their_values(given, kept, kind):
    column = ts.Survey(points=POINTS, attributes={"number": given}).attributes["number"]
    assert column.tolist() == kept
    assert [type(one) for one in column.tolist()] == [type(one) for one in kept] or kind == "f"
    assert column.dtype.kind == kind


def test_nan_and_texts_stay_apart():
    attributes = {"mixed": [NAN, "a", "b", "c"], "real": [NAN, 1.0, 2.0, 3.0]}
    attributes["masked"] = np.ma.array([1.0, 2, 3, 4], mask=[1, 0, 0, 0])
    found = ts.Survey(points=POINTS, attributes=attributes).attributes
    assert isinstance(found["mixed"][0], float)
    assert found["real"].dtype == found["masked"].dtype == np.float64
    assert np.isnan(found["real"][0])
    assert np.isnan(found["masked"][0])


@pytest.mark.parametrize(
    "wrong", [[1, 2, 3], [[1], [1, 2], [3], [4]], [[1], [2], [3], [4]], {1: 2}]
)
def test_attributes_of_another_length_or_shape_are_refused_in_a_sentence(wrong):
    with pytest.raises(ts.OptionError, match="one value for each point") as caught:
        ts.Survey(points=POINTS, attributes={"number": wrong})
    assert str(caught.value).startswith("Invalid attribute 'number' ")
    assert "\n" not in str(caught.value)
