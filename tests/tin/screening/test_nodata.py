"""Elevations that may stand for no data, by the rules that the docstring promises."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.screening.nodata import (
    describe_elevations,
    describe_suspects,
    find_suspect_elevations,
    parse_nodata,
)

NINES = [-99.0, -999.0, -9999.0, -99999.0, -999999.0, -99.9, -999.9, -9999.9]
POSITIVE_NINES = [9999.0, 99999.0, 999999.0]
INTEGERS = [-32768.0, -32767.0, 32767.0]
FLOATS = [
    float(np.finfo(np.float32).max),
    float(np.finfo(np.float64).max),
    1e30,
    1e20,
    1e38,
    3.4e38,
]
SURFER = [1.70141e38, 1.70141183460469e38]
HILLS = np.linspace(300.0, 340.0, 50)


def suspects(*values, count=1, others=HILLS):
    z = np.concatenate([others, np.repeat(values, count)])
    return find_suspect_elevations(np.random.default_rng(1).permutation(z))


@pytest.mark.parametrize(
    "value",
    [*NINES, *POSITIVE_NINES, *INTEGERS, *FLOATS, *SURFER, 0.0, 1e10, *(-one for one in FLOATS)],
)
def test_what_programs_write_for_no_data_is_suspect_even_alone(value):
    found = suspects(value)
    assert [(one.value, one.count) for one in found] == [(value, 1)]
    assert (found[0].lowest, found[0].highest) == (300.0, 340.0)


@pytest.mark.parametrize("value", [-99.5, -9998.0, 9998.0, 1.0, -32766.0, 12345.6])
def test_other_values_are_not_suspect_alone(value):
    assert suspects(value) == []
    assert suspects(value, count=2) == []


@pytest.mark.parametrize(("span", "is_suspect"), [(98.0, True), (99.0, False), (120.0, False)])
def test_the_gap_beside_a_customary_value_is_wider_than_the_range(span, is_suspect):
    assert bool(suspects(-99.0, others=np.linspace(0.0, span, 50))) is is_suspect
    assert bool(suspects(9999.0, others=9999 - 99 - np.linspace(0.0, span, 50))) is is_suspect


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize(
    ("gap", "count", "is_suspect"),
    [(10_001, 3, True), (9_999, 3, False), (10_001, 2, False), (10_001, 25, True)],
)
def test_a_value_of_three_points_is_suspect_ten_ranges_away(side, gap, count, is_suspect):
    others = np.linspace(0.0, 1000.0, 60) * side
    found = suspects(side * (1000.0 + gap), count=count, others=others)
    assert [one.count for one in found] == ([count] if is_suspect else [])


@pytest.mark.parametrize(("size", "is_suspect"), [(50_000.0, False), (50_001.0, True)])
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_value_beyond_the_earth_is_suspect(size, is_suspect, sign):
    assert bool(suspects(sign * size)) is is_suspect


@pytest.mark.parametrize("sign", [-1, 1])
def test_values_are_not_beyond_the_earth_where_most_are(sign):
    others = sign * np.linspace(60_000.0, 90_000.0, 50)
    assert suspects(sign * 100_000.0, others=others) == []


def test_values_are_found_from_the_outside_inwards_and_three_at_most():
    found = suspects(-9999.0, 1e30, 0.0)
    assert [one.value for one in found] == [1e30, -9999.0, 0.0]
    assert {(one.lowest, one.highest) for one in found} == {(300.0, 340.0)}
    found = suspects(-9999.0, 1e30, -1e38, 0.0)
    assert [one.value for one in found] == [-1e38, 1e30, -9999.0]
    assert {one.lowest for one in found} == {0.0}


def test_zero_around_the_sea_is_left_alone():
    assert suspects(0.0, count=9, others=np.linspace(-5.0, 60.0, 50)) == []
    assert suspects(0.0, count=9, others=np.linspace(70.0, 130.0, 50))


@pytest.mark.parametrize(
    ("value", "count", "is_suspect"),
    [(-9999.0, 200, True), (0.0, 200, False), (20_000.0, 200, False), (0.0, 50, True),
     (0.0, 51, False), (20_000.0, 50, True), (20_000.0, 51, False)],
)  # fmt: skip
def test_most_points_are_no_data_only_where_it_is_sure(value, count, is_suspect):
    assert bool(suspects(value, count=count)) is is_suspect


def test_nothing_is_suspect_without_others():
    assert find_suspect_elevations(np.empty(0)) == []
    assert find_suspect_elevations(np.full(5, -9999.0)) == []


def test_a_gap_that_a_few_of_many_values_close_is_none():
    z = np.concatenate([np.linspace(300.0, 340.0, 50_000), [-9999.0]])
    assert [one.value for one in find_suspect_elevations(z)] == [-9999.0]
    z[12_345] = -9000.0  # among the others: no gap wider than the range is left
    assert find_suspect_elevations(z) == []


@pytest.mark.parametrize(
    ("count", "what", "begin", "end"),
    [
        (1, "point", "1 point has the elevation -9999,", "leaves it out."),
        (1200, "cell", "1,200 cells have the elevation -9999,", "leaves them out."),
    ],
)
def test_sentences_on_suspects(count, what, begin, end):
    (sentence,) = describe_suspects(suspects(-9999.0, count=count), what)
    assert sentence.startswith(begin)
    assert "far from the others (300 to 340)" in sentence
    assert sentence.endswith(f"`nodata=-9999` {end}")
    (sentence,) = describe_suspects(suspects(-9999.0))
    assert "1 point has" in sentence


def test_one_elevation_for_all_that_programs_write_for_none_is_told():
    told = "All 3 points have the elevation 0: check that it stands not for no data."
    assert describe_elevations(np.zeros(3)) == [told]
    assert describe_elevations(np.full(4, -9999.0), "cell")[0].startswith("All 4 cells have")
    assert describe_elevations(np.full(4, 318.0)) == describe_elevations(np.zeros(2)) == []
    assert describe_elevations(np.array([])) == describe_elevations(np.array([0.0, 0, 1])) == []


@pytest.mark.parametrize(
    ("given", "values"),
    [(None, []), (-9999, [-9999.0]), ([0, -1.5], [0.0, -1.5]), (np.float32(2), [2.0])],
)
def test_values_that_callers_name(given, values):
    found = parse_nodata(given)
    assert found.dtype == np.float64
    assert found.tolist() == values


@pytest.mark.parametrize("given", ["none", [1, "x"], {}, 10**400])
def test_what_is_no_value_is_refused(given):
    with pytest.raises(
        ts.OptionError, match=r"Invalid nodata .*: it must be a number, or several\."
    ):
        parse_nodata(given)
