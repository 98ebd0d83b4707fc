"""How a table is laid out, case by case: delimiter, columns, rows, what stands above them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tinsmith.base.notes import naming_file
from tinsmith.io import ReadError
from tinsmith.io.delimited import layout as layouts
from tinsmith.io.delimited.layout import LayoutOptions, find_layout
from tinsmith.io.delimited.lines import TextLines, decode_head, read_lines

USUAL = {
    "delimiter": ",",
    "decimal": ".",
    "word": None,
    "has_text_tail": False,
    "may_lack_tail": False,
    "text_columns": [],
    "mostly_text": [],
    "padded": [],
    "divided": [],
    "is_announced": False,
    "skipped": {},
    "elevation_unit": None,
    "notes": (),
}
TEXT_TAIL = {
    "has_text_tail": True,
    "may_lack_tail": True,
    "text_columns": [4],
    "mostly_text": [4],
    "divided": [1, 2, 3],
}
"""Points with descriptions of several words behind their numbers and coordinates."""

CASES = {
    "xyz": ("1.5,2.5,3.5\n4.5,5.5,6.5\n", 3, [0, 1], {"divided": [0, 1, 2]}),
    "header": (
        "Point,N,E,Z,Code\n1,2.5,3.5,4.5,EP\n2,5.5,6.5,7.5,CL\n",
        5,
        [1, 2],
        {
            "has_text_tail": True,
            "may_lack_tail": True,
            "text_columns": [4],
            "mostly_text": [4],
            "divided": [1, 2, 3],
            "skipped": {"header lines": 1},
            "word": "PNEZD",
        },
    ),
    "units": (
        "E,N,Z\n(m),(m),(m)\n1.5,2.5,3.5\n",
        3,
        [2],
        {
            "divided": [0, 1, 2],
            "skipped": {"header lines": 2},
            "elevation_unit": "m",
            "word": "ENZ",
        },
    ),
    "units ft": (
        "E,N,Z\nft,ft,\n1.5,2.5,3.5\n",
        3,
        [2],
        {"divided": [0, 1, 2], "skipped": {"header lines": 2}, "word": "ENZ"},
    ),
    "title": (
        "Survey of the yard\n\n# made by hand\nE,N,Z\n1.5,2.5,3.5\n4.5,5.5,6.5\n",
        3,
        [4, 5],
        {
            "divided": [0, 1, 2],
            "skipped": {"blank lines": 1, "comment lines": 1, "title lines": 1, "header lines": 1},
            "word": "ENZ",
        },
    ),
    "count": (
        "2\n1.5 2.5 3.5\n4.5 5.5 6.5\n",
        3,
        [1, 2],
        {
            "delimiter": " ",
            "divided": [0, 1, 2],
            "is_announced": True,
            "skipped": {"point count": 1},
        },
    ),
    "comment header": (
        "# E,N,Z\n1.5,2.5,3.5\n",
        3,
        [1],
        {"divided": [0, 1, 2], "skipped": {"comment lines": 1}, "word": "ENZ"},
    ),
    "comment header //": (
        "// Easting;Northing;Elevation\n1.5;2.5;3.5\n",
        3,
        [1],
        {"delimiter": ";", "divided": [0, 1, 2], "skipped": {"comment lines": 1}, "word": "ENZ"},
    ),
    "comment above": (
        "# E,N,Z\n# of 1999\n1.5,2.5,3.5\n",
        3,
        [2],
        {
            "divided": [0, 1, 2],
            "skipped": {"comment lines": 2},
            "word": "ENZ",
            "notes": ("Line 1 ('# E,N,Z') gives the order of the columns.",),
        },
    ),
    "semicolon comment": (
        "1.5,2.5,3.5\n;no row\n4.5,5.5,6.5\n",
        3,
        [0, 2],
        {"divided": [0, 1, 2], "skipped": {"comment lines": 1}},
    ),
    "fillers": (
        "1.5,2.5,3.5\n,,\n , , \n4.5,5.5,6.5\n",
        3,
        [0, 3],
        {"divided": [0, 1, 2], "skipped": {"blank lines": 2}},
    ),
    "tail": (
        "1 2.5 3.5 4.5 red barn\n2 5.5 6.5 7.5 old well here\n3 5.5 6.5 7.5 x\n",
        5,
        [0, 1, 2],
        {"delimiter": " ", **TEXT_TAIL},
    ),
    "tail comma": (
        "1,2.5,3.5,4.5,barn\n2,5.5,6.5,7.5,well, old\n3,5.5,6.5,7.5,x\n",
        5,
        [0, 1, 2],
        TEXT_TAIL,
    ),
    "word column": (
        "1 2.5 3.5 4.5 EP 7 8\n2 5.5 6.5 7.5 CL 9 8\n",
        7,
        [0, 1],
        {"delimiter": " ", "text_columns": [4], "mostly_text": [4], "divided": [1, 2, 3]},
    ),
    "two words": (
        "1 2.5 3.5 4.5 EP x 8\n2 5.5 6.5 7.5 CL y 8\n",
        5,
        [0, 1],
        {"delimiter": " ", **TEXT_TAIL},
    ),
    "padded": (
        "001,2.5,3.5,4.5\n002,5.5,6.5,7.5\n",
        4,
        [0, 1],
        {"text_columns": [0], "padded": [0], "divided": [1, 2, 3]},
    ),
    "divided": ("1,2.5,30,4e1\n2,5,60,7E1\n", 4, [0, 1], {"divided": [1, 3]}),
    "missing": ("1,2.5,3.5,\n2,5.5,6.5,nan\n3,5.5,6.5,1.5\n", 4, [0, 1, 2], {"divided": [1, 2, 3]}),
    "half text": (
        "1,2.5,3.5,4.5,a\n2,5.5,6.5,7.5,7\n",
        5,
        [0, 1],
        {"text_columns": [4], "divided": [1, 2, 3]},
    ),
    "most text": (
        "1,2.5,3.5,4.5,a\n2,5.5,6.5,7.5,7\n3,5.5,6.5,7.5,b\n",
        5,
        [0, 1, 2],
        {"has_text_tail": True, "text_columns": [4], "mostly_text": [4], "divided": [1, 2, 3]},
    ),
    "short header": (
        "E,N,Z\n1.5,2.5,3.5,\n4.5,5.5,6.5,\n",
        4,
        [1, 2],
        {
            "may_lack_tail": True,
            "divided": [0, 1, 2],
            "skipped": {"header lines": 1},
            "word": "ENZ",
        },
    ),
    "long header": (
        "E,N,Z,\n1.5,2.5,3.5\n4.5,5.5,6.5\n",
        3,
        [1, 2],
        {"divided": [0, 1, 2], "skipped": {"header lines": 1}, "word": "ENZ"},
    ),
    "desc header": (
        "E N Z Description\n1 2 3 a b c\n4 5 6\n",
        4,
        [1, 2],
        {
            "delimiter": " ",
            "has_text_tail": True,
            "may_lack_tail": True,
            "text_columns": [3],
            "skipped": {"header lines": 1},
            "word": "ENZD",
        },
    ),
    "german": (
        "Rechtswert;Hochwert;Hoehe\n1,5;2,5;3,5\n",
        3,
        [1],
        {
            "delimiter": ";",
            "decimal": ",",
            "divided": [0, 1, 2],
            "skipped": {"header lines": 1},
            "word": "ENZ",
        },
    ),
    "one line": ("1 2 3", 3, [0], {"delimiter": " "}),
    "xyz scan": ("1 2 3\n", 3, [0], {"delimiter": " "}),
}


def found_in(text, name="a.csv", **options):
    lines = TextLines.of(text.encode())
    with naming_file(Path(name)):
        return find_layout(lines, Path(name).suffix, LayoutOptions(**options))


@pytest.mark.parametrize("name", CASES)
def test_the_layout_of_a_table(name):
    text, count, rows, unusual = CASES[name]
    layout = found_in(text)
    assert layout.count == count
    assert layout.rows.tolist() == rows
    for what, value in {**USUAL, **unusual}.items():
        told = layout if what != "word" else layout.columns
        found = told and getattr(told, what)
        assert (sorted(found) if isinstance(found, frozenset) else found) == value, what


@pytest.mark.parametrize(
    ("name", "is_scan"), [("a.xyz", True), ("a.PTS", True), ("a.csv", False), ("xyz", False)]
)
def test_scans_are_known_by_their_suffix(name, is_scan):
    assert found_in("1 2 3\n", name).is_scan is is_scan


@pytest.mark.parametrize(("decimal", "is_stated"), [(None, False), (".", True)])
def test_a_decimal_mark_that_is_told_is_known_to_be(decimal, is_stated):
    layout = found_in("1.5;2.5;3.5\n", decimal=decimal)
    assert (layout.is_decimal_stated, layout.decimal) == (is_stated, ".")


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        ("\n \n# c\n", {}, "'a.csv' holds no points: only blank and comment lines."),
        ("; c\n", {}, "'a.csv' holds no points: only blank and comment lines."),
        (
            "hello world\n",
            {},
            "'a.csv' holds no table of points: no delimiter (comma, semicolon, tab, pipe, spaces) "
            "gives three columns of numbers; its first line is 'hello world'.",
        ),
        (
            "x" * 70 + "\n",
            {},
            "'a.csv' holds no table of points: no delimiter (comma, semicolon, tab, pipe, spaces) "
            f"gives three columns of numbers; its first line is '{'x' * 60}'.",
        ),
        ("E,N,Z\n", {}, "'a.csv': there is no row of numbers below the header."),
        (
            "3\n1 2 3\n4 5 6\n",
            {},
            "'a.csv': the first line announces 3 points, but 2 rows follow: the file may be "
            "truncated.",
        ),
        (
            "2\n1 2 3\n",
            {},
            "'a.csv': the first line announces 2 points, but 1 row follows: the file may be "
            "truncated.",
        ),
        (
            "E,N,Z,Q,R\n1.5,2.5,3.5\n",
            {},
            "'a.csv': the header names 5 columns (E, N, Z, Q, R), but rows have 3: say with the "
            "option `columns` what all of them are, and check delimiter and decimal mark.",
        ),
        (
            "E,Q,Z\n1.5,2.5,3.5\n",
            {},
            "'a.csv': the header (E, Q, Z) does not name easting, northing and elevation (known: "
            "easting 'E', elevation 'Z'): say with the option `columns` which columns they are.",
        ),
        (
            "Q,R,S\n1.5,2.5,3.5\n",
            {},
            "'a.csv': the header (Q, R, S) does not name easting, northing and elevation (known: "
            "none of it): say with the option `columns` which columns they are.",
        ),
        (
            ",".join(["1.5"] * 1001) + "\n",
            {},
            "'a.csv': its rows have 1,001 columns; at most 1,000 are read.",
        ),
    ],
)
def test_what_is_no_table_is_told(text, options, sentence):
    with pytest.raises(ReadError) as caught:
        found_in(text, **options)
    assert str(caught.value) == sentence
    assert caught.value.file == Path("a.csv")


def test_a_thousand_columns_are_read():
    assert found_in(",".join(["1.5"] * 1000) + "\n").count == 1000


def test_a_count_that_fits_is_no_row():
    assert found_in("1\n1 2 3\n").rows.tolist() == [1]
    assert found_in("2\n1 2 3\n4 5 6\n").is_announced


@pytest.mark.parametrize(
    ("rows", "sampled"),
    [
        (0, 0), (99, 99), (100, 100), (101, 101), (300, 300), (499, 499), (500, 300), (700, 300),
    ],
)  # fmt: skip
def test_lines_are_looked_at_on_top_and_spread(rows, sampled):
    looked = layouts._sample_lines(np.arange(rows) * 2)
    assert len(looked) == sampled
    assert looked[:100] == list(range(0, 2 * min(rows, 100), 2))
    assert all(np.diff(looked) > 0)
    if rows >= 500:
        assert set(np.diff(looked[100:]).tolist()) == {2 * ((rows - 100) // 200)}
        assert looked[100] == 200


@pytest.mark.parametrize(
    ("row", "tail"),
    [
        ("1 2 3", None),
        ("1 2 3 a", 3),
        ("1 2 3 4 a b", 4),
        ("1 2 3 a 5", 3),  # one number behind the word may be part of the text
        ("1 2 3 a 5 6", None),
        ("1 2 3 a b 6", 3),
        ("a 2 3 4", None),
        ("1 2 a 4 b", 4),
    ],
)
def test_where_the_text_of_a_row_begins(row, tail):
    assert layouts._find_text_tail(row.split(), ".") == tail


# -------------------------------------------------------------------------- lines


@pytest.mark.parametrize(
    ("data", "lines", "is_whole"),
    [
        (b"", [""], False),
        (b"\n", [""], True),
        (b"a", ["a"], False),
        (b"a\nb", ["a", "b"], False),
        (b"a\r\nb\rc\r\r\nd\n", ["a", "b", "c", "d"], True),
        (b"\n\na\n", ["", "", "a"], True),
    ],
)
def test_every_customary_line_end_ends_a_line(data, lines, is_whole):
    found = TextLines.of(data)
    assert found.decode_lines(range(len(found))) == lines
    assert found.is_whole == is_whole


def test_lines_tell_how_they_begin():
    found = TextLines.of(b"# a\n \t#b\n\n \t \n/ c\n//d\n #\n/")
    assert found.is_blank.tolist() == [False, False, True, True, False, False, False, False]
    assert found.starts_with("#").tolist() == [1, 1, 0, 0, 0, 0, 1, 0]
    assert found.starts_with("//").tolist() == [0, 0, 0, 0, 0, 1, 0, 0]
    assert found.firsts.tolist() == [0, 6, 9, 13, 14, 18, 23, 25]


@pytest.mark.parametrize("chosen", [[], [0], [1, 2], [0, 2, 3], [0, 1, 2, 3], [3]])
def test_chosen_lines_are_joined(chosen):
    found = TextLines.of(b"a\nbb\n\nc\n")
    texts = [b"a", b"bb", b"", b"c"]
    assert found.join(np.array(chosen, np.int64)) == b"\n".join(texts[k] for k in chosen)


def test_lines_with_decimals_are_found():
    found = TextLines.of(b"1.5 2\n1 .5\n1,5\n1, 5\n0.0\n9,9\n.1.\n")
    assert found.find_with_decimals(np.arange(7)).tolist() == [0, 2, 4, 5]
    assert found.find_with_decimals(np.array([1, 2, 6])).tolist() == [2]


@pytest.mark.parametrize(
    ("head", "text"),
    [
        (b"a\nb\nc", "a\nb"),
        (b"abc", "abc"),
        (b"\xef\xbb\xbfabc\n", "abc"),
        ("aé\nb".encode("utf-16"), "aé"),
        ("ab\nc".encode("utf-16-le"), "ab"),
        ("ab\nc".encode("utf-16-be"), "ab"),
        ("ab\nc".encode("utf-32"), "ab"),
        (b"a\x00b\x00\x00c\nd", None),
    ],
)
def test_the_head_of_a_file_as_text(head, text):
    assert decode_head(head) == text


@pytest.mark.parametrize(
    ("data", "encoding", "text"),
    [
        ("Höhe".encode("cp1252"), None, "Höhe"),
        (b"\x81", None, "\x81"),  # no letter of Windows-1252
        ("Höhe".encode("utf-16"), None, "Höhe"),
        ("Höhe".encode("utf-8-sig"), None, "Höhe"),
        ("Höhe".encode("utf-8-sig"), "utf-8", "Höhe"),
        ("Höhe".encode("cp850"), "cp850", "Höhe"),
        (b"a\x1a", None, "a"),
    ],
)
def test_the_encoding_is_found_or_told(tmp_path, data, encoding, text):
    (tmp_path / "a.csv").write_bytes(data)
    assert read_lines(tmp_path / "a.csv", encoding=encoding).decode_line(0) == text


@pytest.mark.parametrize(
    ("data", "encoding", "words"),
    [
        (b"\xff", "utf-8", "is not utf-8 text: invalid start byte; the option `encoding` names"),
        (b"\xff\xfea", None, "is not utf-16-le text: truncated data; the option `encoding` names"),
        (b"a", "latin-7000", "Unknown encoding 'latin-7000' for"),
        (b"a\x00bcdefghijklmnop", None, "holds binary data, not delimited text."),
        (b"x" * 1_000_001, None, "line 1: 1,000,001 bytes are no row of points; at most 1,000,000"),
    ],
)
def test_text_that_cannot_be_read_is_told(tmp_path, data, encoding, words):
    path = tmp_path / "a.csv"
    path.write_bytes(data)
    with pytest.raises(ReadError) as caught, naming_file(path):
        read_lines(path, encoding=encoding)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)
    assert caught.value.file == path


def test_a_line_of_a_million_bytes_is_read(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"a\n" + b"x" * 1_000_000 + b"\nb\n")
    assert len(read_lines(path)) == 3
    path.write_bytes(b"a\n" + b"x" * 1_000_001)
    with pytest.raises(ReadError, match="line 2: 1,000,001 bytes") as caught:
        read_lines(path)
    assert list(caught.value.lines) == [2]
