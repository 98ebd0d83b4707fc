"""What callers give where a number, a flag or a word is needed, and what is told of it."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path
from typing import Literal, get_args

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.checks import (
    as_flag,
    is_finite_number,
    is_whole_number,
    require_tin,
)
from tinsmith.base.errors import TinsmithError, choice
from tinsmith.base.sentences import shown
from tinsmith.tin.editing.history import apply_edits
from tinsmith.tin.paper.comparison import compare
from tinsmith.tin.paper.growth import improved
from tinsmith.tin.validation.points import as_elevations

CORNERS = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]]


class Speechless:
    def __repr__(self):
        raise RuntimeError


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (1, "1"),
        (np.int32(7), "7"),
        (np.float64(0.5), "0.5"),
        ("a word", "'a word'"),
        (None, "None"),
        ([1, np.float64(2)], "[1, 2.0]"),
        ((1, (2, "x")), "[1, [2, 'x']]"),
        ([], "[]"),
        (list(range(5)), "[0, 1, 2, 3, 4]"),
        (list(range(6)), "[0, 1, 2, 3, 4, ...]"),
        (np.zeros((3, 2)), "an array of shape (3, 2)"),
        ("x" * 58, "'" + "x" * 58 + "'"),
        ("x" * 59, "'" + "x" * 56 + "..."),
        ("two\nlines", r"'two\nlines'"),
        (Speechless(), "a Speechless"),
        (True, "True"),
        (2**199, str(2**199)),
        (2**200, "2^200 or more"),
        (-(2**300) - 5, "-2^300 or more"),
    ],
)
def test_values_are_shown_short_and_plain(value, words):
    assert shown(value) == words
    assert len(shown(value)) <= 60


@pytest.mark.parametrize("value", [1, -5, 0, np.int8(3), np.uint64(9), 10**400])
def test_whole_numbers(value):
    assert is_whole_number(value)


@pytest.mark.parametrize("value", [True, np.True_, 1.0, np.float64(2), "1", None, [1]])
def test_what_is_no_whole_number(value):
    assert not is_whole_number(value)


@pytest.mark.parametrize("value", [1, -2.5, np.float32(3), np.int64(4), 10**300])
def test_finite_numbers(value):
    assert is_finite_number(value)


@pytest.mark.parametrize("value", [True, False, math.nan, -math.inf, 10**400, "1", None, [1.0], 1j])
def test_what_is_no_finite_number(value):
    assert not is_finite_number(value)


def test_words_and_flags():
    assert choice("name", "a", ("a", "b")) == "a"
    assert choice("name", "b", Literal["a", "b"]) == "b"
    for value, words in (("c", ("a", "b")), (0, ("a", "b")), ("a", ()), (["a"], Literal["a"])):
        with pytest.raises(ts.OptionError, match=r"Invalid name .*: it must be one of") as caught:
            choice("name", value, words)
        assert caught.value.value is value
        assert caught.value.allowed == (get_args(words) or words)
    assert as_flag("name", np.True_) is True
    assert as_flag("name", False) is False
    with pytest.raises(ts.OptionError, match=r"Invalid name 1: it must be True or False\."):
        as_flag("name", 1)


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))]
)
def test_errors_are_copied_with_what_they_carry(again):
    for error in (
        ts.OptionError("snap", -1, "a distance"),
        ts.OptionError("crossing", "join", ("split", "error")),
        ts.PointsError("No.", rows=[1, 2]),
        ts.MissingExtraError("pyproj", extra="crs", purpose="A CRS"),
        ts.WriteError("No room.", path=Path("a.ply")),
    ):
        found = again(error)
        assert (type(found), str(found)) == (type(error), str(error))
        assert vars(found) == vars(error)


def test_an_edit_that_fails_is_numbered_and_keeps_what_its_error_carries():
    edit = {"op": "insert", "points": [[1, 1, 1]], "duplicates": 0}
    with pytest.raises(ts.OptionError, match=r"Edit 0 \(insert\): Invalid duplicates") as caught:
        apply_edits(ts.triangulate(CORNERS), [edit])
    assert (caught.value.option, caught.value.value) == ("duplicates", 0)


def test_what_is_no_tin():
    require_tin(ts.triangulate(CORNERS))
    for other in (CORNERS, ts.TIN, None, np.zeros(3)):
        with pytest.raises(ts.PointsError, match="one made by triangulate is needed"):
            require_tin(other)


POLYGON = [[0.5, 0.5], [3.5, 0.5], [3.5, 2.5]]


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda: compare(CORNERS, limit=0), "Invalid limit 0: it must be a whole number >= 1."),
        (lambda: compare(CORNERS, limit=2.5), "Invalid limit 2.5: it must be a whole number >= 1"),
        (lambda: compare(CORNERS, limit=4), "5 points are too many to compare"),
        (
            lambda: improved(CORNERS, distance="far"),
            "Invalid distance 'far': it must be one of circle, ties",
        ),
        (lambda: improved(CORNERS, empty="x"), "Invalid empty 'x': it must be one of angle, open"),
        (
            lambda: improved(CORNERS, most_triangles=0),
            "Invalid most_triangles 0: it must be a whole number >= 1",
        ),
        (lambda: improved(CORNERS, removal=1), "Invalid removal 1: it must be True or False."),
        (lambda: as_elevations([[1.0, 2.0]]), r"Elevations have shape \(1, 2\): one, or a row"),
        (lambda: as_elevations(np.ma.masked_less([1.0, 2.0], 2)), "An elevation is masked"),
        (lambda: ts.Breakline(POLYGON, name=["a"]), r"Invalid name \['a'\]: it must be text."),
        (lambda: ts.Water(POLYGON, z=math.nan), "Invalid elevation nan of a water polygon"),
        (lambda: ts.triangulate(CORNERS, holes=[[], []]), "(?i)invalid|shape"),
        (lambda: ts.triangulate({"x": [0, 1], "y": [0, 1, 2], "z": [0, 1]}), "different lengths"),
        (lambda: ts.triangulate(CORNERS).remove_breakline(0), "There is no breakline 0."),
        (lambda: ts.triangulate(CORNERS).remove_breakline("a"), "a whole number is needed"),
        (lambda: ts.triangulate(CORNERS).move(0, CORNERS[:2]), "There are 2 points: one, easting"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(act, sentence):
    with pytest.raises(TinsmithError, match=sentence):
        act()


def test_limits_are_allowed_themselves():
    assert len(compare(CORNERS, limit=5).outcomes) == 5
    assert len(improved(CORNERS, most_triangles=1).triangles) == 1


def test_water_and_lines_say_what_they_are():
    assert repr(ts.Water(POLYGON, 7.5)) == "<Water: 3 corners at 7.5>"
    assert repr(ts.Water(POLYGON, 7.5, name="pond")) == "<Water: 3 corners at 7.5, 'pond'>"
