"""What is told of points that were read: places, elevations, numbers, rows left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.crs import CRS, Unit
from tinsmith.base.errors import ReadError
from tinsmith.io import CrsError
from tinsmith.io.delimited.columns import Columns
from tinsmith.io.delimited.findings import (
    describe_faults,
    describe_left_out,
    find_odd_elevations,
    find_repeated_numbers,
    require_ground,
    require_in_area,
)
from tinsmith.io.delimited.table import Fault
from tinsmith.tin.screening.area_of_use import AreaOfUse

PATH = Path("a.csv")
AREA = "the area of use of EPSG:32616 (longitude -90 to -84, latitude 0 to 84)"
UTM_16 = AreaOfUse.of(CRS.of("EPSG:32616"), None)
ROLES = {"easting": 0, "northing": 1, "elevation": 2}
COLUMNS = Columns(("x", "column 2", "z"), ROLES)
HERE = [742_000.0, 4_030_000.0, 320.0]


def told(points, rows=None, area=UTM_16, columns=COLUMNS):
    points = np.array(points, float)
    rows = np.arange(len(points)) if rows is None else np.array(rows)
    return require_in_area(points, rows, columns, area)


# -------------------------------------------------------------------- the area


@pytest.mark.parametrize("order", [(1, 0, 2), (2, 0, 1), (2, 1, 0)])
def test_columns_that_fit_only_when_exchanged_are_refused_with_the_word_that_fits(order):
    given = np.tile(HERE, (5, 1)) + np.arange(5)[:, None]
    points = given[:, np.argsort(order)]
    with pytest.raises(CrsError) as caught:
        told(points)
    right = COLUMNS.permute(order)
    places = [f"{role} in {right.label(right.roles[role])}" for role in ROLES]
    assert str(caught.value) == (
        f"read as ENZ the points lie outside {AREA}, and read as "
        f"{right.word} inside it: `columns='{right.word}'` takes the {', the '.join(places)}."
    )


def test_easting_and_northing_exchanged_are_thought_of_first():
    """Where several orders fit, the usual mistake is named."""
    world = AreaOfUse.of(CRS.of("EPSG:4326"), None)
    with pytest.raises(CrsError, match=r"and read as NEZ inside it"):
        told([[40.0, 120.0, 30.0], [41.0, 121.0, 31.0], [42.0, 122.0, 32.0]], area=world)


def test_points_that_fit_in_no_order_are_told():
    far = [[742_000.0, 9_999_999.0, 320.0]] * 3
    assert told(far) == [
        f"3 of 3 points lie outside {AREA}: check that the CRS of the points is the right one."
    ]
    assert told([HERE] * 3) == []
    assert told(far, area=None) == []


def test_few_points_outside_are_named_by_their_lines():
    away = [742_000.0, 9_999_999.0, 320.0]
    swapped = [4_030_000.0, 742_000.0, 320.0]
    assert told([HERE, HERE, away], rows=[3, 5, 9]) == [
        f"1 of 3 points lies outside {AREA} (line 10)."
    ]
    assert told([HERE] * 4 + [away, swapped]) == [
        f"2 of 6 points lie outside {AREA} (lines 5, 6); 1 lies inside if exchanged."
    ]
    assert told([HERE] * 4 + [swapped, swapped]) == [
        f"2 of 6 points lie outside {AREA} (lines 5, 6); 2 lie inside if exchanged."
    ]
    assert told([HERE] * 6 + [away] * 6)[0].endswith("(lines 7, 8, 9, 10, 11, ...).")
    assert "check that the CRS" in told([HERE] * 6 + [away] * 7)[0]


# ------------------------------------------------------------------ elevations


def points_with(z, extent=1000.0):
    z = np.asarray(z, float)
    return np.column_stack([np.linspace(0, extent, len(z)), np.zeros(len(z)), z])


def test_usual_elevations_are_not_odd():
    assert find_odd_elevations(points_with(np.linspace(300, 340, 50))) == []
    assert find_odd_elevations(points_with([300.0, 9000.0])) == []  # two tell nothing


def test_elevations_where_no_ground_is_are_told():
    z = np.linspace(4_020_000, 4_030_000, 101)
    assert require_ground(z, None, is_free=True) == [
        "Most elevations lie between 4020500 and 4029500, where no ground is: check the columns."
    ]


@pytest.mark.parametrize(
    ("unit", "factor"), [(None, 1), ("m", 1), ("ft", 1 / 0.3048), ("mm", 1000)]
)
def test_elevations_of_the_earth_are_not_refused_in_their_unit(unit, factor):
    z = np.linspace(-400.0, 8_800.0, 11) * factor
    assert require_ground(z, Unit.of(unit), is_free=False) == []


@pytest.mark.parametrize("unit", [None, "m", "ft"])
def test_elevations_where_no_ground_is_are_refused_until_columns_or_unit_are_said(unit):
    with pytest.raises(ReadError, match=r"no ground is: .*`columns`.*`elevation_unit`"):
        require_ground(np.full(9, 320_412.0), Unit.of(unit), is_free=False)


def test_ground_that_rises_too_fast_is_told():
    (note,) = find_odd_elevations(points_with([0.0, 10.0, 20.0], extent=5.0))
    assert note == (
        "The points rise by 20 within an extent of 5: check the columns, and that eastings and "
        "northings are no degrees."
    )
    assert find_odd_elevations(points_with([5.0, 10.0, 15.0], extent=5.0)) == []


def test_suspects_stand_alone():
    (note,) = find_odd_elevations(points_with([*np.linspace(3, 9, 30), -9999.0], extent=3.0))
    assert note.startswith("1 point has the elevation -9999, far from the others (3 to 9)")


# ------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("numbers", "notes"),
    [
        (None, []),
        ([7], []),
        ([1, 2, 3], []),
        ([3, 1, 2], []),
        ([1, 2, 1], ["1 point number occurs more than once: 1 in lines 11, 13."]),
        (
            [2, 2, 1, 1],
            ["2 point numbers occur more than once: 2 in lines 11, 12; 1 in lines 13, 14."],
        ),
        (["a", "", "a", ""], ["1 point number occurs more than once: a in lines 11, 13."]),
        ([1.5, np.nan, 1.5], ["1 point number occurs more than once: 1.5 in lines 11, 13."]),
        ([100000.0, 100000.0], ["1 point number occurs more than once: 100000 in lines 11, 12."]),
        (
            [12345678.0, 12345679.0, 12345679.0, 12345678.0],
            [
                "2 point numbers occur more than once: 12345678 in lines 11, 14; "
                "12345679 in lines 12, 13."
            ],
        ),
        ([1234567.5] * 2, ["1 point number occurs more than once: 1234567.5 in lines 11, 12."]),
        (
            [5] * 6,
            ["1 point number occurs more than once: 5 in lines 11, 12, 13, 14, 15, ...."],
        ),
    ],
)
def test_repeated_numbers_are_named(numbers, notes):
    rows = np.arange(10, 30)
    array = None
    if numbers is not None:
        array = np.array(numbers, object if isinstance(numbers[0], str) else None)
    assert find_repeated_numbers(array, rows) == notes


def test_at_most_five_repeated_numbers_are_named():
    five, six = (np.repeat(np.arange(n), 2) for n in (5, 6))
    rows = np.arange(12)
    assert find_repeated_numbers(five, rows)[0].endswith("; 4 in lines 9, 10.")
    assert find_repeated_numbers(six, rows)[0].startswith("6 point numbers occur")
    assert find_repeated_numbers(six, rows)[0].endswith("; 4 in lines 9, 10; ....")


# ---------------------------------------------------------------- what was left out


def test_points_left_out_are_counted_and_named():
    assert describe_left_out("why", [7]) == "1 point is left out, why: line 7."
    assert describe_left_out("why", [7, 9]) == "2 points are left out, why: lines 7, 9."
    assert describe_left_out("why", range(1, 7)).endswith("why: lines 1, 2, 3, 4, 5, ....")


def test_bad_rows_are_counted_and_named():
    faults = [Fault(k, "number", f"fault {k}") for k in range(6)]
    assert describe_faults(faults[:1]) == "1 bad row is left out (line 1: fault 0)."
    assert describe_faults(faults[:5]).endswith("line 5: fault 4).")
    assert describe_faults(faults).startswith("6 bad rows are left out (line 1: fault 0; line 2")
    assert describe_faults(faults).endswith("line 5: fault 4; ...).")


@pytest.mark.parametrize("unit", ["km", "mm", "km x"])
def test_eastings_in_a_unit_of_no_elevation_are_refused_without_a_crs(tmp_path, unit):
    path = tmp_path / "points.csv"
    rows = "".join(f"{512350 + 7 * i}.1,{5403211 + i * i}.2,31{i}.5\n" for i in range(5))
    path.write_text(f"E ({unit}),N ({unit}),Z\n{rows}")
    with pytest.raises(ts.TinsmithError, match="easting in"):
        ts.read(path)
