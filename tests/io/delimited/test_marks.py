"""Delimiters, decimal marks and the numbers in cells, by tables of what people write."""

from __future__ import annotations

import math

import pytest

import tinsmith as ts
from tinsmith.io import OptionError, ReadError
from tinsmith.io.delimited import cells
from tinsmith.io.delimited.cells import BLANKS
from tinsmith.io.delimited.marks import (
    find_decimal_mark,
    find_delimiter,
    looks_like_table,
    parse_decimal_mark,
    parse_delimiter,
    require_one_kind_of_comma,
)


@pytest.mark.parametrize(
    ("lines", "delimiter"),
    [
        (["1,2,3", "4,5,6"], ","),
        (["1;2;3", "4;5;6"], ";"),
        (["1,5;2,5;3,5", "4,5;5,5;6,5"], ";"),
        (["1\t2\t3", "4\t5\t6"], "\t"),
        (["1|2|3", "4|5|6"], "|"),
        (["1 2 3", "4   5 6"], BLANKS),
        (["1,5 2,5 3,5", "4,5 5,5 6,5"], BLANKS),
        (["1, 2, 3", "4, 5, 6"], ","),
        (["1 ; 2 ; 3", "4 ; 5 ; 6"], ";"),
        (["4 024 240,1;752 646,5;320,5", "4 024 259,2;752 883,7;324,6"], ";"),
        (["x,y,z", "no,number,here"], ","),
        (["a,1,2,3,red barn", "b,4,5,6,old well"], ","),
        (["1 2 3 a,b,c,d", "4 5 6 e,f,g,h"], BLANKS),
        (["1,2", "3,4"], None),
        (["hello world", "and all the rest of it"], None),
        (["1", "2"], None),
    ],
)
def test_the_delimiter_gives_the_most_numbers_and_even_rows(lines, delimiter):
    assert find_delimiter(lines) == delimiter


@pytest.mark.parametrize(
    ("head", "is_table"),
    [
        (b"1,2,3\n4,5,6\n", True),
        (b"# a comment, with commas\n1,2,3\n", True),
        (b"\n\n1 2 3\n", True),
        (b"x,y,z\n1,2,3\n", True),
        (b"x,y,z\na,b,c\n1,2,3\n", False),  # less than half
        (b"1,2\n3,4\n", False),
        (b"", False),
        (b"\x89PNG\r\n\x1a\n\x00\x00", False),
    ],
)
def test_what_looks_like_a_table(head, is_table):
    assert looks_like_table(head) is is_table


@pytest.mark.parametrize(
    ("word", "delimiter"),
    [
        (None, None), ("comma", ","), (" Semicolon ", ";"), ("TAB", "\t"), ("\\t", "\t"),
        ("pipe", "|"), ("space", " "), ("spaces", " "), ("whitespace", " "), (" ", " "),
        (";", ";"), ("\t", "\t"), ("~", "~"), (":", ":"),
    ],
)  # fmt: skip
def test_delimiters_by_name(word, delimiter):
    assert parse_delimiter(word) == delimiter


@pytest.mark.parametrize("word", ["", ",,", "a", "7", ".", "+", "-", '"', "\n", "\r", "\x7f", "é"])
def test_what_is_no_delimiter(word):
    with pytest.raises(OptionError, match="one letter such as ',' or one of comma, semicolon") as e:
        parse_delimiter(word)
    assert "tab" in e.value.allowed


def test_decimal_marks_by_name():
    assert [parse_decimal_mark(word) for word in (None, ".", ",")] == [None, ".", ","]
    for word in (";", "", "point"):
        with pytest.raises(OptionError, match=r"Invalid decimal .*: it must be '\.' or ','"):
            parse_decimal_mark(word)


@pytest.mark.parametrize(
    ("row", "delimiter", "mark", "is_noted"),
    [
        (["4000,12", "5", "6"], ";", ",", False),
        (["4000.12", "5", "6"], ";", ".", False),
        (["4000,12", "4000,13", "4000.14"], " ", ",", False),
        (["4000,12", "4000.13"], " ", ".", False),
        (["752,700", "1"], ";", ",", True),
        (["752.700", "1"], ";", ".", False),
        (["752.700", "752,700"], ";", ",", True),
        (["1,024,240", "752,700"], " ", ".", False),
        (["1.5", "2"], ",", ".", False),
        (["text, with comma", "1"], ";", None, False),
        (["5,", "6"], ";", None, False),
        (["5,", "6"], " ", None, False),
        ([",5", "6"], " ", None, False),
        ([",5", "6"], "|", ",", False),
        (["-,5", "6"], "\t", ",", False),
        ([",5", "7,25"], "\t", ",", False),
        (["5", "6"], ";", None, False),
        (["5", "6"], ",", None, False),
    ],
)
def test_the_decimal_mark_that_cells_prove(row, delimiter, mark, is_noted):
    found = find_decimal_mark([row], delimiter)
    assert (found and found.mark) == mark
    assert bool(found and found.note) is is_noted
    if is_noted:
        assert "('752,700')" in found.note


def test_a_comma_that_may_separate_thousands_is_refused():
    with pytest.raises(
        ReadError, match=r"\('752,700'\): `decimal=','` or `decimal='\.'` settles it"
    ):
        find_decimal_mark([["752,700", "4"]], BLANKS)


@pytest.mark.parametrize("cell", ["5,", ",5", "1,234", "-1,234"])
@pytest.mark.parametrize("delimiter", [";", "\t", "|"])
def test_a_comma_at_the_edge_of_a_cell_proves_no_decimal_comma(cell, delimiter):
    with pytest.raises(ReadError, match="may be decimal marks or separate thousands"):
        find_decimal_mark([["752,", "4024,", "1,234"], ["753", ",4025", cell]], delimiter)


@pytest.mark.parametrize(
    ("lines", "grouped"),
    [
        (["1, 2, 3,456", "1, 2, 3"], "3,456"),
        (["x, y, z", "1 ,2 ,3", "1,234.5 ,2 ,3", "1 ,2 ,3 ,4 ,5"], "1,234.5"),
        (["Survey of 3 May", "1, 2, 3", "1,\t2,\t-3,456,789,"], "-3,456,789"),
    ],
)
def test_commas_that_may_separate_columns_or_thousands_are_refused(lines, grouped):
    with pytest.raises(ReadError, match=rf"separate columns or thousands \('{grouped}'"):
        require_one_kind_of_comma(lines)


@pytest.mark.parametrize(
    "lines",
    [
        ["1,2,3,456"],
        ["1, 2, 3, 456", "1, 2, 3,456"],
        ["1, 2, 3,45", "1, 2, 3,46"],
        ["1, 2, 0,456", "1, 2, 1234,456"],
        ["1, 2, 3, 1,234 kg"],
        ["1, 2,345"],
    ],
)
def test_commas_that_can_only_separate_columns_are_not(lines):
    require_one_kind_of_comma(lines)


# ------------------------------------------------------------------ cells

NUMBERS = {
    ".": ["0", "-1", "+1.", ".5", "1.25e3", "1E-7", "-.5e+2", "0012.5", "1" * 1000],
    ",": ["0", "-1", "+1,", ",5", "1,25e3", "1E-7", "-,5e+2", "0012,5"],
}
NO_NUMBERS = [
    "",
    ".",
    "-",
    "e5",
    "1e",
    "1.2.3",
    "1 2",
    "0x10",
    "1_000",
    "inf",
    "nan",
    "--1",
    "\u0661",
    "1" * 1001,
]
GROUPED = {
    ".": {
        "4,024,240.10": 4024240.10,
        "4'024": 4024.0,
        "-1 234 567": -1234567.0,
        "1\u202f000.": 1000.0,
    },
    ",": {
        "4.024.240,10": 4024240.10,
        "4'024": 4024.0,
        "-1 234 567": -1234567.0,
        "1\u00a0000,5": 1000.5,
    },
}
NOT_GROUPED = [
    "1000",
    "1,00",
    "0,123",
    "1,2345",
    "1,234 567",
    "1,234,56",
    "",
    "1,,234",
    "12345,678",
]


@pytest.mark.parametrize("decimal", [".", ","])
def test_numbers_of_cells(decimal):
    for text in NUMBERS[decimal]:
        assert cells.is_number(text, decimal), text
        assert cells.is_number_like(text, decimal), text
        assert cells.parse_number(f" {text} ", decimal) == float(text.replace(",", "."))
    for text in NO_NUMBERS:
        assert not cells.is_number(text, decimal), text
        assert math.isnan(cells.parse_number(text, decimal))
    other = {".": ",", ",": "."}[decimal]
    assert not cells.is_number(f"1{other}5", decimal)


@pytest.mark.parametrize("decimal", [".", ","])
def test_numbers_in_groups(decimal):
    for text, value in GROUPED[decimal].items():
        assert cells.is_grouped(text, decimal), text
        assert cells.is_number_like(text, decimal), text
        assert cells.parse_grouped(f" {text} ", decimal) == value
    for text in NOT_GROUPED:
        assert not cells.is_grouped(text, "."), text
        assert math.isnan(cells.parse_grouped(text, "."))
    assert not cells.is_grouped(f"1{decimal}234", decimal)
    assert not cells.is_grouped("1" + ",000" * 300, ".")


@pytest.mark.parametrize(
    ("cell", "is_proof"),
    [("1,234", False), ("-1,234", False), ("1,234,567", True), ("1,234.5", True), ("1'234", True),
     ("1 234", True), ("1234", False), ("x", False)],
)  # fmt: skip
def test_what_proves_groups(cell, is_proof):
    assert cells.proves_groups(cell, ".") is is_proof
    may_be_both = {"1,234", "-1,234"}
    assert cells.may_group_or_divide(cell) is (cell in may_be_both)


@pytest.mark.parametrize(
    "cell", ["", "nan", "NaN", "-nan", "NA", "n/a", "null", "None", "-", "***"]
)
def test_what_is_missing(cell):
    assert cells.is_missing(cell)
    assert cells.is_number_like(cell, ".")


@pytest.mark.parametrize("cell", ["0", "x", "nano", "- -", "*" * 1001])
def test_what_is_not_missing(cell):
    assert not cells.is_missing(cell)


@pytest.mark.parametrize(
    ("cell", "is_padded"),
    [
        ("007", True),
        ("07", True),
        ("0", False),
        ("70", False),
        ("0.5", False),
        ("", False),
        ("0a", False),
    ],
)
def test_leading_zeros(cell, is_padded):
    assert cells.is_padded(cell) is is_padded


def test_infinity_stands_where_a_number_should():
    for cell in ("inf", "-Infinity", "+INF"):
        assert cells.is_number_like(cell, ".")
        assert not cells.is_number(cell, ".")
    assert not cells.is_number_like("information", ".")


@pytest.mark.parametrize(
    ("line", "delimiter", "parts"),
    [
        ("a,b , c", ",", ["a", "b", "c"]),
        ('"a,b", c', ",", ["a,b", "c"]),
        ("  1\t\t2  3 ", BLANKS, ["1", "2", "3"]),
        ("1;;3", ";", ["1", "", "3"]),
        ("", ",", []),
        ("x" * 200_000 + ",2", ",", ["x" * 200_000, "2"]),
    ],
)
def test_lines_are_split_by_the_rules_of_csv(line, delimiter, parts):
    assert cells.split_line(line, delimiter) == parts


@pytest.mark.parametrize("separator", [",|", "|,", ";,", ",;", ", |"])
def test_commas_beside_other_letters_that_may_group_digits_are_refused(tmp_path, separator):
    rows = [separator.join((f"2,500,00{i}", f"600,0{i}3", "1,032", f"{i}")) for i in range(1, 9)]
    path = tmp_path / "a.txt"
    path.write_text("\n".join(rows))
    for options in ({}, {"columns": "ENZ"}, {"columns": "ENZ", "crs": "EPSG:2274"}):
        with pytest.raises(ts.TinsmithError):
            ts.read(path, **options)
