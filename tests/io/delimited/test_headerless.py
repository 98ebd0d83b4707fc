"""What the columns of a table without header are taken for, case by case with plain reasons."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.crs import CRS
from tinsmith.io import ReadError
from tinsmith.io.delimited.headerless import (
    are_plausible_elevations,
    find_columns_by_content,
    is_too_steep,
    measure_relief_and_extent,
    require_no_split_decimals,
)
from tinsmith.io.delimited.parsing import Column
from tinsmith.tin.screening.area_of_use import AreaOfUse

RNG = np.random.default_rng(5)
N = 40
EASTING = Column(740_000 + RNG.uniform(0, 500, N))
NORTHING = Column(4_024_000 + RNG.uniform(0, 500, N))
ELEVATION = Column(RNG.uniform(300, 340, N))
NUMBERS = Column(np.arange(1.0, N + 1), is_whole=True)
MIXED = Column(RNG.permutation(NUMBERS.values), is_whole=True)
NAMES = Column(np.full(N, np.nan), is_text=True, text_share=1.0)
CODES = Column(np.full(N, np.nan), is_text=True, text_share=1.0, distinct_share=0.1)
UTM_16 = AreaOfUse.of(CRS.of("EPSG:32616"), None)


def whole(column):
    return Column(np.round(column.values), is_whole=True, distinct_share=column.distinct_share)


@pytest.mark.parametrize(
    ("columns", "area", "word"),
    [
        ([EASTING, NORTHING, ELEVATION], None, "XYZ"),
        ([EASTING, NORTHING, ELEVATION], UTM_16, "XYZ"),
        ([NORTHING, EASTING, ELEVATION], UTM_16, "NEZ"),
        ([NUMBERS, NORTHING, EASTING, ELEVATION], UTM_16, "PNEZ"),
        ([NUMBERS, EASTING, NORTHING, ELEVATION], UTM_16, "PENZ"),
        ([MIXED, NORTHING, EASTING, ELEVATION], UTM_16, "PNEZ"),
        ([NUMBERS, NORTHING, EASTING, ELEVATION, CODES], UTM_16, "PNEZD"),
        ([NAMES, NORTHING, EASTING, ELEVATION, CODES], UTM_16, "PNEZD"),
        ([CODES, EASTING, NORTHING, ELEVATION], UTM_16, "DENZ"),
        ([CODES, NORTHING, EASTING, ELEVATION, NAMES], UTM_16, "DNEZ"),
        ([EASTING, NORTHING, ELEVATION, CODES], UTM_16, "XYZD"),
        ([EASTING, NORTHING, ELEVATION, ELEVATION, CODES], UTM_16, "XYZ-D"),
        ([NUMBERS, EASTING, NORTHING, ELEVATION, ELEVATION, NAMES], UTM_16, "PENZ-D"),
    ],
)
def test_the_layout_that_nothing_speaks_against_is_taken(columns, area, word):
    found, note = find_columns_by_content(columns, area)
    assert f"({word})" in note
    letters = dict(zip(word, range(len(word)), strict=True))
    east, north = letters.get("X", letters.get("E")), letters.get("Y", letters.get("N"))
    assert found.coordinates == [east, north, letters["Z"]]
    if area is not None:
        start = word.index("Z") - 2
        other = word[:start] + ("EN" if start else "XY") + word[start + 2 :]
        other = other if other != word else f"{word[:start]}NE{word[start + 2 :]}"
        assert other in note.partition(" would lie outside the area of use of EPSG:32616")[0]


def test_numbers_in_columns_alone_are_x_y_z_by_convention():
    _, note = find_columns_by_content([EASTING, NORTHING, ELEVATION], None)
    assert note.endswith("(XYZ), the convention for columns of numbers alone.")
    all_whole = [whole(one) for one in (EASTING, NORTHING)]
    _, note = find_columns_by_content([*all_whole, ELEVATION, ELEVATION], None, is_scan=True)
    assert note.endswith("(XYZ), the convention for files of this kind.")
    _, note = find_columns_by_content([EASTING, NORTHING, ELEVATION], None, is_announced=True)
    assert note.endswith("(XYZ), the convention for files of this kind.")


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ([EASTING, NORTHING, ELEVATION, CODES], ["NEZD", "XYZD"]),
        ([EASTING, NORTHING, ELEVATION, MIXED], ["NEZ", "XYZ"]),
        ([EASTING, NORTHING, ELEVATION, MIXED, ELEVATION], ["NEZ", "XYZ"]),
        ([NUMBERS, NORTHING, EASTING, ELEVATION], ["PNEZ", "PENZ"]),
        ([NAMES, NORTHING, EASTING, ELEVATION], ["PNEZ", "PENZ"]),
    ],
)
def test_two_plausible_layouts_are_refused(columns, words):
    with pytest.raises(ReadError) as caught:
        find_columns_by_content(columns, None)
    message = str(caught.value)
    assert f"its columns may be {' or '.join(words)}: " in message
    assert " or ".join(f"`columns='{word}'`" for word in words) in message
    assert message.endswith("the CRS of the points may decide, too.")


def test_whole_numbers_before_whole_coordinates_may_be_coordinates_themselves():
    small = [Column(np.round(RNG.uniform(100, 200, N)), is_whole=True) for _ in range(4)]
    with pytest.raises(ReadError, match=r"its first column may be point numbers") as caught:
        find_columns_by_content(small, None)
    assert "PNEZ or PENZ or NEZ or XYZ" in str(caught.value)
    with pytest.raises(ReadError) as caught:
        find_columns_by_content(small, AreaOfUse.of(CRS.of("EPSG:4326"), None))
    assert "may decide, too" not in str(caught.value)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ([EASTING, NORTHING], "its 2 columns do not hold three of numbers"),
        ([NAMES, EASTING, NORTHING], "its 3 columns do not hold three of numbers"),
        ([EASTING, NAMES, NORTHING, ELEVATION], "not those of a known layout"),
        ([EASTING, NORTHING, NAMES, ELEVATION], "not those of a known layout"),
    ],
)
def test_columns_of_no_layout_are_refused(columns, words):
    with pytest.raises(ReadError, match=words):
        find_columns_by_content(columns, None)


def test_no_layout_fits_and_each_is_told_why():
    high = Column(np.full(N, 50_000.0))
    with pytest.raises(ReadError) as caught:
        find_columns_by_content([EASTING, NORTHING, high], UTM_16)
    message = str(caught.value)
    assert "no customary layout fits: NEZ would" in message
    assert "XYZ would have elevations of 50,000 to 50,000" in message


@pytest.mark.parametrize("padded", range(4))
def test_coordinates_have_no_leading_zeros(padded):
    columns = [NUMBERS, EASTING, NORTHING, ELEVATION]
    columns[padded] = Column(columns[padded].values, is_whole=padded == 0, is_padded=True)
    if padded == 0:
        _, note = find_columns_by_content(columns, UTM_16)
        assert "(PENZ)" in note
        return
    with pytest.raises(ReadError) as caught:
        find_columns_by_content(columns, UTM_16)
    assert "PENZ would have coordinates with leading zeros" in str(caught.value)


def test_what_counts_the_rows_is_no_coordinate():
    assert NUMBERS.counts_rows
    assert not MIXED.counts_rows
    assert not Column(NUMBERS.values).counts_rows
    near, high = [Column(100 + RNG.uniform(0, 10, N)) for _ in range(2)], Column(np.full(N, 5e4))
    for numbers, words in (
        (NUMBERS, "would have coordinates that count 1, 2, 3"),
        (MIXED, "would have whole numbers in one coordinate and decimals in the other"),
    ):
        with pytest.raises(ReadError) as caught:
            find_columns_by_content([numbers, *near, high], None)
        assert f"NEZ {words}; XYZ {words}" in str(caught.value)
    with pytest.raises(ReadError, match="coordinates that count 1, 2, 3"):
        find_columns_by_content([NUMBERS, NORTHING, ELEVATION], None)
    with pytest.raises(ReadError, match="grows by 1 from row to row"):
        find_columns_by_content([NUMBERS, whole(NORTHING), ELEVATION], None)
    few = [Column(one.values[:2], is_whole=one.is_whole) for one in (NUMBERS, EASTING, ELEVATION)]
    find_columns_by_content(few, None)


def test_a_column_with_words_or_a_cliff_is_no_coordinate():
    near = [Column(100 + RNG.uniform(0, 10, N)) for _ in range(2)]
    gaps = Column(np.where(np.arange(N) % 5 == 0, np.nan, ELEVATION.values), text_share=0.2)
    for last, words in (
        (gaps, "would have coordinates that are no numbers"),
        (Column(RNG.uniform(0, 9000, N)), "would rise by "),
    ):
        with pytest.raises(ReadError) as caught:
            find_columns_by_content([MIXED, *near, last], None)
        assert f"no customary layout fits: PNEZ {words}" in str(caught.value)
        assert f"PENZ {words}" in str(caught.value)


def test_whole_numbers_before_two_columns_with_decimals_may_be_point_numbers():
    with pytest.raises(ReadError, match="its first column may be point numbers"):
        find_columns_by_content([whole(EASTING), NORTHING, ELEVATION], None)
    grid = Column(740_000.0 + np.arange(N) % 8, is_whole=True, distinct_share=0.2)
    rows = Column(4_024_000.5 + np.arange(N) // 8)
    assert find_columns_by_content([grid, rows, ELEVATION], None)[0].word == "ENZ"
    with pytest.raises(ReadError, match="its first column may be point numbers"):
        find_columns_by_content([grid, NORTHING, ELEVATION], None)


def test_whole_numbers_again_and_again_are_elevations_of_a_grid_only():
    codes = Column(np.arange(N) % 4.0, is_whole=True, distinct_share=0.1)
    with pytest.raises(ReadError, match="its elevations would be whole numbers"):
        find_columns_by_content([EASTING, NORTHING, codes], None)
    centres = [Column(0.5 + np.arange(N) % 8), Column(0.5 + np.arange(N) // 8)]
    assert find_columns_by_content([*centres, codes], None)[0].word == "ENZ"


def rounded(column, digits):
    return Column(np.round(column.values, digits))


EAST, NORTH = (Column(low + np.round(RNG.uniform(0, 150, N), 3)) for low in (5_000, 1_000))
CHAINAGE = Column(20.0 * np.arange(N))
TIMES = Column(np.round(432_000 + np.cumsum(RNG.uniform(1, 5, N)), 3))
PART = Column(np.round(RNG.uniform(0, 59.9, N), 3))


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ([CHAINAGE, EAST, NORTH, ELEVATION], "grows by 20 from row to row"),
        ([CHAINAGE, EAST, NORTH], "grows by 20 from row to row"),
        ([TIMES, EAST, NORTH, ELEVATION], "easting and northing may be the second and third"),
        (
            [rounded(one, k) for one, k in ((MIXED, 1), (EAST, 3), (NORTH, 3))],
            "its first column may be point numbers",
        ),
        (
            [rounded(one, k) for one, k in ((ELEVATION, 1), (EAST, 3), (NORTH, 3))],
            "its first column has fewer decimals than the others",
        ),
        ([EAST, NORTH, NUMBERS], "its third column may be point numbers"),
        (
            [Column(np.full(N, 36.0)), Column(np.full(N, 20.0)), PART] * 2 + [ELEVATION],
            "may be degrees and minutes",
        ),
        ([Column(np.full(N, 36.0)), PART] * 2 + [ELEVATION], "may be degrees and minutes"),
        ([MIXED, *[Column(np.full(N, 36.0)), PART] * 2, ELEVATION], "may be degrees and minutes"),
    ],
)
@pytest.mark.parametrize("is_scan", [False, True])
def test_x_y_z_by_convention_is_doubted(columns, words, is_scan):
    with pytest.raises(ReadError) as caught:
        find_columns_by_content(columns, None, is_scan=is_scan)
    assert words in str(caught.value)


def test_no_convention_holds_where_a_line_speaks_of_coordinates_or_the_area_of_use_is_elsewhere():
    for heading, area, words in (
        ("line 1 ('N E Z')", None, "line 1 ('N E Z') speaks of coordinates"),
        ("", AreaOfUse.of(CRS.of("EPSG:2056"), None), "lie outside the area of use of EPSG:2056"),
    ):
        with pytest.raises(ReadError) as caught:
            find_columns_by_content([EASTING, NORTHING, ELEVATION], area, heading=heading)
        assert words in str(caught.value)
        assert "`columns='XYZ'` says so" in str(caught.value)


# ------------------------------------------------------------------ measures


@pytest.mark.parametrize(
    ("z", "is_plausible"),
    [
        ([30_000.0, -37_000.0], True),
        ([np.nextafter(30_000.0, 1e9), 0.0], True),  # half is enough
        ([30_001.0, 1e6, 5.0], False),
        ([-37_001.0, -1e6, 5.0], False),
    ],
)
def test_elevations_lie_between_the_deepest_trench_and_the_highest_summit(z, is_plausible):
    assert are_plausible_elevations(np.array(z)) is is_plausible


@pytest.mark.parametrize(
    ("relief", "extent", "is_steep"),
    [
        (3.0, 1.0, False),
        (3.001, 1.0, True),
        (5.0, 0.0, False),
        (0.0, 0.0, False),
        (0.0, 9.0, False),
    ],
)
def test_ground_rises_by_three_times_its_extent_at_most(relief, extent, is_steep):
    assert is_too_steep(relief, extent) is is_steep


def test_a_twentieth_of_the_values_at_either_end_counts_for_nothing():
    line = np.arange(101.0)
    points = np.column_stack([3 * line, 4 * line, -line])[RNG.permutation(101)]
    assert measure_relief_and_extent(points) == (90.0, 450.0)
    points[points[:, 2] > -5] = 1e9
    points[points[:, 2] < -95] = -1e9
    relief, extent = measure_relief_and_extent(points)
    assert relief == pytest.approx(90, abs=1)
    assert extent == pytest.approx(450, abs=5)
    assert measure_relief_and_extent(points[:0]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("rows", "delimiter", "is_refused"),
    [
        (["4,25,7,50,3,1"], ",", True),
        (["1,4,25,7,50,3,1", "2,-4,25,+7,50,3,1"], ",", True),
        (["4;25;7;50;3;1"], ";", False),
        (["40000,25,7,50,3,1000"], ",", True),
        (["4,25,7,50,3,10000"], ",", False),
        (["4,25,7,50000,3,1"], ",", False),
        (["4,25000,7,50,3,1"], ",", False),
        (["4,25,7,50,3"], ",", False),
        (["4,024261238E+06,7,527022110e5,1,038352000E+03"], ",", True),
        (["4,024261238E+06,7,5270,1,0383"], ",", True),
        (["4,024261238E+06,7,52702,1,0383"], ",", False),
        (["4,+25000,7,+50000,3,+10000"], ",", False),
        (["1,2,4,25,7,50,3,1"], ",", False),
        (["4.5,25,7,50,3,1"], ",", False),
        (["4,25,7,50,3,1,text"], ",", True),
        (["text,4,25,7,50,3,1"], ",", False),
        ([], ",", False),
    ],
)
def test_decimal_commas_at_commas_are_refused(rows, delimiter, is_refused):
    body = [row.split(delimiter) for row in rows]
    if not is_refused:
        require_no_split_decimals(body, delimiter)
        return
    with pytest.raises(ReadError, match="its commas may be delimiters or decimal marks"):
        require_no_split_decimals(body, delimiter)


def test_text_where_numbers_are_needed_is_shown(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("500000,4000000,322.4 m\n500010,4000000,323.4 m\n500010,4000020,324.1 m\n")
    with pytest.raises(ReadError, match=r"elevation are needed; column 3 has '322.4 m'\.$"):
        ts.read(path)
