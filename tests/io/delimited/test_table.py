"""Rows of a table: cells that are regular or rewritten, numbers, columns described, faults."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest

from tinsmith.io import ReadError
from tinsmith.io.delimited.cell_bounds import find_cell_bounds
from tinsmith.io.delimited.columns import find_columns_by_word
from tinsmith.io.delimited.layout import LayoutOptions, find_layout
from tinsmith.io.delimited.lines import TextLines
from tinsmith.io.delimited.table import (
    describe_columns,
    describe_faults_of_rows,
    read_cells,
    read_table,
)

PATH = Path("a.csv")


def cells_of(text, **options):
    lines = TextLines.of(text.encode())
    layout = find_layout(lines, ".csv", LayoutOptions(**options))
    return read_cells(lines, layout), layout, lines


def is_regular(data, layout):
    return find_cell_bounds(data, layout.delimiter, layout.count) is not None


def table_of(text, columns="ENZ", **options):
    cells, layout, lines = cells_of(text, columns=columns, **options)
    return read_table(cells, layout, find_columns_by_word(columns, [], layout.count), lines)


# --------------------------------------------------------------------- regular rows

PILES = [
    "1,2,3", '1,"2",3', '"1",2,3', '1,2,"3"', '1,"2 ""x"" y",3', '1,"2,5",3', '"1","2","3"',
    '1,2",3', '1,"2"x,3', '1,x"2",3', '"1,2,3', '1,2,3"', '1,"2,3', '1,2', '1,2,3,4', '"",2,3',
    '1,2,""', '1," 2",3', '1, "2",3', '""1,2,3', '1,2,"3"""',
]  # fmt: skip


@pytest.mark.parametrize("first", PILES)
@pytest.mark.parametrize("second", ["1,2,3", '4,"5",6', '7,8,"9"'])
def test_rows_taken_as_regular_read_as_by_csv(first, second):
    """Whatever is called regular must be what Python's csv module makes of each line."""
    lines = TextLines.of(f"{first}\n{second}\n{first}".encode())
    layout = find_layout(TextLines.of(b"1,2,3\n4,5,6\n"), ".csv", LayoutOptions())
    data = lines.join(np.arange(3))
    rows = [next(csv.reader(io.StringIO(line), strict=True), []) for line in (second,)]
    try:
        rows += [next(csv.reader([first], strict=True))]
        is_even = all(len(row) == 3 for row in rows)
    except csv.Error:
        is_even = False
    if is_regular(data, layout):
        assert is_even
    plain = '"' not in first and '"' not in second
    if plain:
        assert is_regular(data, layout) == is_even
    if first in ('1,"2",3', '"1",2,3', '1,2,"3"', '1,"2,5",3', '"1","2","3"', '1,"2 ""x"" y",3'):
        assert is_regular(data, layout)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 2 3\n4 5 6", True), ("1  2\t3\n 4 5 6 ", True), ("1 2 3\n4 5\n6 7 8 9", False),
        ("1 2 3\n4 5 6 7", False), ('1 2 3\n4 5 "6"', False), ("1 2 3 4 5 6", False),
        ("1 2\n3\n4 5 6", False),
    ],
)  # fmt: skip
def test_words_between_blanks_are_counted_line_by_line(text, expected):
    layout = find_layout(TextLines.of(b"1 2 3\n4 5 6\n"), ".csv", LayoutOptions())
    assert is_regular(text.encode(), layout) is expected


def test_delimiters_between_quotes_part_no_cells():
    text = b'"a,b",1,"x,,y"\n2,"3",",,"\n"",4,5\n"6,",7,""'
    bounds = find_cell_bounds(text, ",", 3)
    cells = [
        [text[start + 1 : end] for start, end in zip(*row, strict=True)]
        for row in zip(bounds.before.tolist(), bounds.ends.tolist(), strict=True)
    ]
    assert cells == [
        [b'"a,b"', b"1", b'"x,,y"'],
        [b"2", b'"3"', b'",,"'],
        [b'""', b"4", b"5"],
        [b'"6,"', b"7", b'""'],
    ]


def test_rows_that_are_not_regular_are_rewritten_one_by_one():
    found, _, _ = cells_of(
        'E,N,Z,D\n1,2,3,"a ""b"" c"\n4,5,6,x, y\n7,8\n9,8,7\n"1,2,3,4\n3,2,1,z\n'
    )
    assert found.columns[3].tolist() == ['a "b" c', "x, y", "", "z"]
    assert found.rows.tolist() == [1, 2, 4, 6]
    assert [(fault.line, fault.kind, fault.what) for fault in found.faults] == [
        (3, "columns", "has 2"),
        (
            5,
            "quote",
            "a quote opens a cell and is not closed on the line; a quote at the start of a cell "
            'must be doubled ("")',
        ),
    ]


@pytest.mark.parametrize("count", [1, 1999, 2000, 2001, 4001])
def test_rewritten_rows_are_all_there(count):
    text = "E,N,Z,D\n" + "".join(f"{k},1,2,a, {k}\n" for k in range(count))
    found, _, _ = cells_of(text)
    assert found.columns[0].tolist() == list(range(count))
    assert found.columns[3].tolist() == [f"a, {k}" for k in range(count)]
    assert found.rows.tolist() == list(range(1, count + 1))


@pytest.mark.parametrize(
    ("row", "tail"),
    [
        ("1 2 3", ""), ("1 2 3 a", "a"), ("1 2 3 a  b", "a b"), ("1 2 3 250 a", None),
        ("1.5 2 3 7 a", "7 a"), ("1 2 3.5 250 a", "250 a"), ("1 2 3 7 8", None),
    ],
)  # fmt: skip
def test_a_description_between_blanks_takes_the_rest(row, tail):
    found, _, _ = cells_of(f"E N Z Desc\n1 2 3 word\n{row}\n5 6 7 more words\n")
    if tail is None:
        assert found.rows.tolist() == [1, 3]
    else:
        assert found.columns[3].tolist()[1] == tail


# ---------------------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("cell", "value"),
    [
        ("4", 4.0), ("-4.5", -4.5), ("1e3", 1000.0), ("1,234.5", 1234.5), ("1,234,567", 1234567.0),
        ("'12", None), ("abc", None), ("inf", None), ("True", None),
    ],
)  # fmt: skip
def test_an_elevation_is_a_number_or_a_fault(cell, value):
    found = table_of(f"1.5;2.5;3.5\n4;5;{cell}\n7;8;9.5\n", delimiter=";")
    if value is None:
        assert found.points[:, 2].tolist() == [3.5, 9.5]
        assert found.rows.tolist() == [0, 2]
        (fault,) = found.faults
        assert (fault.line, fault.kind) == (1, "number")
        assert fault.what == f"elevation in column 3 ('elevation') is '{cell}'"
    else:
        assert found.points[:, 2].tolist() == [3.5, value, 9.5]
        assert found.n_grouped == (1 if "," in cell else 0)


@pytest.mark.parametrize("cell", ["", "nan", "NA", "-", "***", "null"])
def test_a_missing_elevation_is_none_and_a_missing_easting_a_fault(cell):
    found = table_of(f"1;2;{cell}\n4;5;6.5\n")
    assert np.isnan(found.points[0, 2])
    assert found.faults == ()
    found = table_of(f"1;2;3\n{cell};5;6.5\n7;8;9\n")
    assert found.rows.tolist() == [0, 2]
    shown = f"is '{cell}'" if cell else "is empty"
    assert found.faults[0].what == f"easting in column 1 ('easting') {shown}"


def test_faults_are_in_the_order_of_lines_and_shown_to_forty_letters():
    long = "x" * 41
    found = table_of(f"1,2,3\n{long},2,3\n4,5\n6,y,z\n7,8,9\n")
    assert [fault.line for fault in found.faults] == [1, 2, 3]
    assert found.faults[0].what.endswith(f"is '{'x' * 40}'")
    assert found.faults[2].what == "northing in column 2 ('northing') is 'y'"


def test_attributes_are_the_other_columns_by_role_or_name():
    found = table_of("1,2,3,7,,a\n4,5,6,8,,\n", columns="ENZP-D")
    assert list(found.attributes) == ["number", "description"]
    assert found.attributes["number"].tolist() == [7, 8]
    assert found.attributes["description"].tolist() == ["a", ""]
    found = table_of("1,2,3,7.5\n4,5,6,\n", columns="ENZ-")
    assert list(found.attributes) == ["column 4"]
    assert found.attributes["column 4"][0] == 7.5
    assert np.isnan(found.attributes["column 4"][1])
    assert table_of("1,2,3,\n4,5,6,\n", columns="ENZ-").attributes == {}


# --------------------------------------------------------------------- what columns hold


def test_columns_are_described_by_what_is_in_them():
    text = "1,007,5.5,-1,a,,x,1e2\n2,008,6,2,a,,7,200\n2,009,7,3,b,,y,300\n4,010,8,nan,b,,z,400\n"
    cells, layout, _ = cells_of(text)
    found = describe_columns(cells, layout)
    assert [one.is_whole for one in found] == [True, True] + [False] * 6
    assert [one.is_padded for one in found] == [False, True] + [False] * 6
    assert [one.is_text for one in found] == [False] * 4 + [True, False, True, False]
    assert [one.distinct_share for one in found[:2]] == [0.75, 1.0]
    assert found[4].distinct_share == 0.5
    assert found[6].distinct_share == 1.0
    assert [one.text_share for one in found] == [0.0] * 8
    assert np.isnan(found[5].values).all()
    assert found[3].values[:3].tolist() == [-1, 2, 3]
    assert np.isnan(found[3].values[3])


def test_the_share_of_words_among_numbers_is_told():
    cells, layout, _ = cells_of("1,2.5,3.5\n2,x,4.5\n3,5.5,\n4,6.5,7.5\n")
    found = describe_columns(cells, layout)
    assert [one.text_share for one in found] == [0.0, 0.25, 0.0]
    assert found[0].is_whole


# --------------------------------------------------------------------------- sentences


@pytest.mark.parametrize(
    ("text", "sentence", "lines"),
    [
        (
            "1,2,3\n4,5\n6,7\n1,2,3\n1,2,3\n",
            "2 of 5 rows do not have 3 columns (line 2 has 2, line 3 has 2); the option "
            "`skip_bad` leaves such rows out.",
            [2, 3],
        ),
        (
            "1,2,3\n4,5",
            "1 of 2 rows does not have 3 columns (line 2 has 2); the last line has no "
            "end, so the file may be truncated; the option `skip_bad` leaves such rows out.",
            [2],
        ),
        (
            "1,2,3\n4,5\n4,5,6",
            "1 of 3 rows does not have 3 columns (line 2 has 2); the option `skip_bad` "
            "leaves such rows out.",
            [2],
        ),
        (
            "1,2,3\n" + "4,5\n" * 6 + "1,2,3\n" * 7,
            "6 of 14 rows do not have 3 columns (line 2 has 2, line 3 has 2, line 4 has "
            "2, line 5 has 2, line 6 has 2, ...); the option `skip_bad` leaves such rows out.",
            [2, 3, 4, 5, 6],
        ),
        (
            "1,2,3\nx,5,6\n7,8,9\n",
            "1 of 3 rows has a coordinate that is not a finite number with decimal point "
            "(line 2: easting in column 1 ('easting') is 'x'); the option `skip_bad` leaves such "
            "rows out.",
            [2],
        ),
        (
            '1,2,3\n4,5\n"6,7,8\n7,8,9\n',
            "the file, line 3: a quote opens a cell and is not closed on the line; a quote at the "
            'start of a cell must be doubled ("").',
            [3],
        ),
    ],
)
def test_faults_are_one_sentence(text, sentence, lines):
    cells, layout, source = cells_of(text, columns="ENZ")
    faults = read_table(cells, layout, find_columns_by_word("ENZ", [], 3), source).faults
    error = describe_faults_of_rows(faults, len(layout.rows), source, layout)
    assert isinstance(error, ReadError)
    assert str(error) == sentence
    assert list(error.lines) == lines


def test_a_decimal_comma_is_named():
    cells, layout, source = cells_of("1,5;2;3\nx;5;6\n", columns="ENZ", decimal=",")
    faults = read_table(cells, layout, find_columns_by_word("ENZ", [], 3), source).faults
    assert "finite number with decimal comma" in str(
        describe_faults_of_rows(faults, 2, source, layout)
    )
