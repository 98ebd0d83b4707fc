"""Delimited text against Python's csv module and float() as the second opinion."""

from __future__ import annotations

import contextlib
import csv
import io
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import tinsmith as ts
from tinsmith.io import CrsError, FormatError, OptionError, ReadError, WriteError, read, write
from tinsmith.io.delimited.layout import LayoutOptions, find_layout
from tinsmith.io.delimited.lines import read_lines

ROWS = [
    (1, 4024238.125, 752646.5, 320.565, "CP1"),
    (2, 4024259.25, 752883.75, 324.672, "EP"),
    (3, 4024321.5, 752771.875, 329.146, "DITCH"),
    (4, 4024204.0, 752828.0, 323.272, "TREE"),
]
EXPECTED = np.array([[e, n, z] for _, n, e, z, _ in ROWS])


@pytest.fixture
def survey(tmp_path):
    """Return a function that writes a file and reads it."""

    def of(content, name="survey.csv", **options):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read(path, **options)

    return of


def fault(survey, content, error=ReadError, **options):
    with pytest.raises(error) as caught:
        survey(content, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.endswith(".")
    return caught.value


# ------------------------------------------------------------------ any customary table

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "pipe": "|", "spaces": " "}
LAYOUTS = {
    "PNEZD": ["Point", "Northing", "Easting", "Elevation", "Description"],
    "PENZD": ["PtNo", "E (m)", "N (m)", "Höhe", "Code"],
    "XYZ": ["x", "y", "z"],
    "NEZ": ["North", "East", "RL"],
    "ENZD": ["Rechtswert", "Hochwert", "H", "Bemerkung"],
    "XYZ-": ["X", "Y", "Z", "intensity"],
}
FIELDS = {"E": 0, "X": 0, "N": 1, "Y": 1, "Z": 2, "P": 3, "D": 4, "-": 5}

numbers = st.one_of(
    st.floats(-1e7, 1e7).map(repr),
    st.decimals(-9_999_999, 9_999_999, places=3).map(str),
    st.integers(-(10**7), 10**7).map(str),
    st.sampled_from(["+5.25", ".5", "5.", "1e5", "-1.5E+03", "0.1", "123456789012345678901234.5"]),
)
words = st.text(
    st.characters(codec="utf-8", exclude_categories=["C", "Z"], exclude_characters="\x1a"),
    min_size=1,
    max_size=6,
).filter(lambda word: any(map(str.isalpha, word)) and not any(map(str.isdecimal, word)))


@st.composite
def tables(draw):
    """Draw a file, how it was made, and its cells."""
    layout = draw(st.sampled_from(sorted(LAYOUTS)))
    delimiter = draw(st.sampled_from(sorted(DELIMITERS)))
    decimal = "." if delimiter == "comma" else draw(st.sampled_from(".,"))
    point = st.tuples(numbers, numbers, numbers, st.just(""), words, st.integers(0, 255).map(str))
    points = draw(st.lists(point, min_size=3, max_size=12))
    points = [(*p[:3], str(i + 1), *p[4:]) for i, p in enumerate(points)]
    rows = [[p[FIELDS[letter]] for letter in layout] for p in points]
    return (
        layout,
        delimiter,
        decimal,
        rows,
        draw(st.sampled_from(["\n", "\r\n"])),
        draw(st.booleans()),
    )


def text_of(layout, delimiter, decimal, rows, line_end, is_quoted):
    """Write a table by Python's csv module, numbers with the decimal mark wanted."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(
        buffer,
        delimiter=DELIMITERS[delimiter],
        lineterminator=line_end,
        quoting=csv.QUOTE_ALL if is_quoted else csv.QUOTE_MINIMAL,
    )
    writer.writerow(LAYOUTS[layout])
    for row in rows:
        cells = [
            cell if letter in "PD" else cell.replace(".", decimal)
            for letter, cell in zip(layout, row, strict=True)
        ]
        writer.writerow(cells)
    return buffer.getvalue()


def has_unproved_commas(layout, delimiter, rows):
    """Tell if no decimal comma is surely one: 1,000 may be a thousand, "5, 6" two columns."""
    numbers = [
        (cell, all(other.startswith(".") for other in row[1:]))
        for row in rows
        for letter, cell in zip(layout, row, strict=True)
        if letter != "D"
    ]
    may_delimit = delimiter == "spaces" or any(cell.endswith(".") for cell, _ in numbers)
    inner = [cell.strip(".") if may_delimit or leads else cell for cell, leads in numbers]
    unproved = [cell for cell in inner if re.fullmatch(r"[+-]?[1-9]\d{0,2}\.\d{3}|[^.]*", cell)]
    marked = [cell for cell, _ in numbers if "." in cell.rstrip(".")]
    by_custom = delimiter == "semicolon" and not any(cell.strip(".") != cell for cell, _ in numbers)
    return unproved == inner and bool(marked) and not by_custom


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(table=tables())
@example(table=("NEZ", "pipe", ",", [["1.000", ".5", ".5"]] * 3, "\n", False))
@example(
    table=("XYZ", "spaces", ",", [["0.0", "0.0", ".5"], ["0.0", ".5", "0.0"]] * 2, "\n", False)
)
@example(table=("NEZ", "spaces", ",", [["0.0", ".5", ".5"], ["0.0", "5.", "0.0"]] * 2, "\n", False))
@example(table=("NEZ", "spaces", ",", [["6.", "5.", "0"]] * 3, "\n", False))
@example(table=("ENZD", "pipe", ",", [["0", "0", "5.", "A"]] * 3, "\n", False))
def test_every_table_reads_as_csv_and_float_say(survey, table):
    layout, delimiter, decimal, rows, *_ = table
    content = text_of(*table)
    if "(" in content.split("\n")[0] and table[1] == "spaces" and not table[5]:
        content = content.replace("E (m)", "E_m").replace("N (m)", "N_m")
    options = {}
    if decimal == "," and has_unproved_commas(layout, delimiter, rows):
        fault(survey, content)
        options = {"decimal": ","}
    found = survey(content, **options)
    places = [next(i for i, x in enumerate(layout) if FIELDS[x] == k) for k in range(3)]
    expected = np.array([[float(row[i]) for i in places] for row in rows])
    assert found.points.tobytes() == expected.tobytes()
    assert found.skipped == {"header lines": 1}
    if "D" in layout:
        assert found.attributes["description"].tolist() == [row[-1] for row in rows]
    if "P" in layout:
        assert found.attributes["number"].tolist() == list(range(1, len(rows) + 1))
    if layout == "XYZ-":
        assert found.attributes["intensity"].tolist() == [int(row[-1]) for row in rows]


@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("North East RL", "{}, {}, {}"),
        ("North East RL", "{},{},{}"),
        ("North;East;RL", "{},{},{}"),
        ("North, East, RL", "{} {} {}"),
        ("# North East RL", "{},{},{}"),
        ("North East RL Code", "{}, {}, {}, A"),
    ],
)
def test_a_header_parted_otherwise_than_the_rows_is_heard(survey, header, row):
    rows = [row.format(1000 + i, 2000 + i, 30 + i) for i in range(3)]
    found = survey("\n".join([header, *rows, ""]))
    assert found.points.tolist() == [[2000 + i, 1000 + i, 30 + i] for i in range(3)]
    assert found.notes == []


def test_a_header_parted_otherwise_that_does_not_fit_is_refused(survey):
    said = str(fault(survey, "North East RL\n1,2,3,4\n2,3,4,5\n3,4,5,6\n"))
    assert "the header names 3 columns" in said
    found = survey("Survey of the x y z\n1.5,2,3\n2,3.5,4\n3,4,5\n")
    assert found.skipped == {"title lines": 1}


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    values=st.lists(
        st.floats(allow_nan=False, allow_infinity=False, width=64), min_size=9, max_size=30
    ),
    style=st.sampled_from(["{!r}", "{:.17g}", "{:.25e}", "{:.3f}"]),
    decimal=st.sampled_from(".,"),
)
def test_every_double_is_the_nearest_to_its_text(survey, values, style, decimal):
    texts = [style.format(value) for value in values[: len(values) // 3 * 3]]
    rows = [texts[i : i + 3] for i in range(0, len(texts), 3)]
    content = "x;y;z\n" + "\n".join(";".join(row).replace(".", decimal) for row in rows) + "\n"
    found = survey(content, decimal=decimal)
    expected = np.array([[float(text) for text in row] for row in rows])
    assert found.points.tobytes() == expected.tobytes()


@pytest.mark.parametrize("name", ["points.csv", "points.txt", "points.xyz", "points.asc", "p.PNT"])
def test_no_header_of_three_columns_is_xyz(survey, name):
    found = survey("1.5 2.5 3.5\n4 5 6\n7 8 9", name=name)
    assert found.points.tolist() == [[1.5, 2.5, 3.5], [4, 5, 6], [7, 8, 9]]
    (note,) = found.notes
    assert note.startswith("No header: the columns are taken as easting, northing, elevation (XYZ)")
    assert ("files of this kind" in note) == (name == "points.xyz")
    assert found.source == name


def test_no_header_with_numbers_and_codes_is_pnezd_where_the_crs_applies(survey):
    content = "\n".join(",".join(map(str, row)) for row in ROWS)
    found = survey(content, crs="EPSG:32616")
    assert np.array_equal(found.points, EXPECTED)
    assert found.attributes["number"].tolist() == [1, 2, 3, 4]
    assert found.attributes["description"].tolist() == [row[-1] for row in ROWS]
    (note,) = found.notes
    assert "number, northing, easting, elevation, description (PNEZD)" in note
    assert "since PENZD, NEZ-D and XYZ-D" in note
    assert "would lie outside the area of use of EPSG:32616" in note


def test_without_a_crs_nothing_tells_northing_from_easting(survey):
    content = "\n".join(",".join(map(str, row)) for row in ROWS)
    said = str(fault(survey, content))
    assert "`columns='PNEZD'` or `columns='PENZD'`" in said
    assert "XYZ" not in said
    assert np.array_equal(survey(content, columns="PNEZD").points, EXPECTED)
    names = "A1;10;20;1,5\nA2;11;21;1,7\nB1;12;20;1,9\n"
    assert "`columns='PNEZ'` or `columns='PENZ'`" in str(fault(survey, names))
    found = survey(names, columns="PNEZ")
    assert found.points.tolist() == [[20, 10, 1.5], [21, 11, 1.7], [20, 12, 1.9]]
    assert found.attributes["number"].tolist() == ["A1", "A2", "B1"]


def test_crs_decides_whether_northing_comes_first(survey):
    """The State Plane zone of Tennessee has larger eastings, UTM larger northings."""
    utm = "\n".join(f"{i},{e},{n},{z},{d}" for i, n, e, z, d in ROWS)
    found = survey(utm, crs="EPSG:32616")
    assert np.array_equal(found.points, EXPECTED)
    assert "number, easting, northing" in found.notes[0]
    assert "since PNEZD would lie outside" in found.notes[0]
    plane = "1,600000.1,2500000.1,9,G\n2,600010.1,2500000.1,9,G\n3,600010.1,2500010.1,9,G\n"
    found = survey(plane, crs="EPSG:2274")
    assert found.points[0].tolist() == [2500000.1, 600000.1, 9]


def test_named_columns_are_refused_where_only_the_exchanged_ones_fit(survey):
    """Neither a header nor the caller's word may put a site on another continent silently."""
    axes = "y,x,z\n752646,4024238,1\n752647,4024238,1\n"
    said = str(fault(survey, axes, CrsError, crs="EPSG:32616"))
    assert "`columns='ENZ'` takes the easting in column 1 ('y')" in said
    content = axes.replace("y,x", "northing,easting")
    said = str(fault(survey, content, CrsError, crs="EPSG:32616"))
    assert "check that EPSG:32616 is the CRS of the points" in said  # not that names are wrong
    assert survey(content).points[0].tolist() == [4024238, 752646, 1]
    found = survey(content, crs="EPSG:32616", columns="ENZ")
    assert found.points[0].tolist() == [752646, 4024238, 1]
    assert "against the header" in found.notes[0]
    bare = content.partition("\n")[2]
    assert "columns='ENZ'" in str(fault(survey, bare, CrsError, crs="EPSG:32616", columns="NEZ"))


@pytest.mark.parametrize(
    ("columns", "order"),
    [
        ("PNEZD", [2, 1, 3]),
        ("penzd", [1, 2, 3]),
        ("-XYZ", [1, 2, 3]),
        ("P-ENZ", [2, 3, 4]),
        (["id", "north", "east", "height"], [2, 1, 3]),
        ("no,easting,northing,elevation,code", [1, 2, 3]),
        ({"easting": 3, "northing": 2, "elevation": 4}, [2, 1, 3]),
        ({"x": 2, "y": 3, "z": 5}, [1, 2, 4]),
    ],
)
def test_columns_by_the_callers_word(survey, columns, order):
    cells = [["1", "10.5", "20.5", "5.25", "7"], ["2", "11.5", "21.5", "6.25", "8"]]
    found = survey("\n".join(",".join(row) for row in cells), columns=columns)
    assert found.points.tolist() == [[float(row[i]) for i in order] for row in cells]
    assert found.notes == []


def test_thousands_that_commas_have_split_are_told(survey):
    """Under a layout of three columns the ends of numbers are further columns."""
    found = survey("518.6,1,077.2,1,033.9\n565.2,1,053.2,1,039.3\n", columns="ENZ")
    assert any("if commas group thousands, check the columns" in note for note in found.notes)
    assert survey("518.6,1.5,77.2,5\n565.2,2.5,53.2,6\n", columns="ENZ").notes == []


def test_columns_by_names_in_a_header_that_says_nothing(survey):
    content = "a;b;c;d\n1;2;3;4\n5;6;7;8\n"
    found = survey(content, columns={"easting": "C", "northing": "b", "elevation": 1})
    assert found.points.tolist() == [[3, 2, 1], [7, 6, 5]]
    assert found.attributes["d"].tolist() == [4, 8]
    assert "easting" in str(fault(survey, content))


# ------------------------------------------------------------------ layouts judged together

UTM = "EPSG:32616"
SITE = [
    (i, 4024240.1 + 7 * (i % 5), 752700.2 + 9 * (i // 5), 322.0 + i * 0.1) for i in range(1, 21)
]


def rows_of(letters, numbers=None, tail=""):
    """Write the site in columns by letters, headerless."""
    cells = {"-": "7.25"}
    lines = []
    for k, (i, n, e, z) in enumerate(SITE):
        cells |= {"P": str(i if numbers is None else numbers[k])}
        cells |= {"N": f"{n:.3f}", "E": f"{e:.3f}", "Z": f"{z:.3f}", "D": "GS"}
        lines.append(",".join(cells[letter] for letter in letters) + tail)
    return "\n".join(lines) + "\n"


TRUE = np.array([[round(e, 3), round(n, 3), round(z, 3)] for _, n, e, z in SITE])
NUMBERS = {
    "ascending": None,
    "repeated": [*range(1, 11), 10, *range(12, 21)],
    "unordered": [*range(20, 0, -1)],
    "all alike": [7] * 20,
    "of two jobs": [*range(1, 11), *range(1, 11)],
    "names": [f"A{i}" for i in range(20)],
    "some names": [*range(1, 19), "19A", "19B"],
    "leading zeros": [f"{i:04d}" for i in range(20)],
    "some missing": [1, "", *range(3, 21)],
}


@pytest.mark.parametrize("layout", ["PNEZD", "PENZD", "PNEZ", "PENZ", "NEZ", "ENZ", "NEZD", "ENZD"])
@pytest.mark.parametrize("numbers", NUMBERS)
def test_where_the_crs_applies_every_layout_is_told(survey, layout, numbers):
    found = survey(rows_of(layout, NUMBERS[numbers]), crs=UTM)
    assert np.array_equal(found.points, TRUE)
    assert found.notes[0].startswith("No header: the columns are taken as")
    assert "since" in found.notes[0]


@pytest.mark.parametrize("layout", ["PNEZD", "PENZD", "PNEZ", "PENZ", "NEZD", "ENZD"])
@pytest.mark.parametrize("numbers", NUMBERS)
def test_without_a_crs_two_layouts_are_plausible(survey, layout, numbers):
    said = str(fault(survey, rows_of(layout, NUMBERS[numbers])))
    mine, other = layout, layout.translate(str.maketrans("NE", "EN"))
    for word in (mine, other):
        shown = word.replace("ENZ", "XYZ") if "P" not in word else word
        assert f"columns='{shown}'" in said
    assert "skip_bad" not in said
    assert np.array_equal(survey(rows_of(layout, NUMBERS[numbers]), columns=layout).points, TRUE)


def test_small_coordinates_of_a_local_grid_are_no_less_doubtful(survey):
    rows = "".join(f"{i},{5000 + i % 5}.5,{1000 + i // 5}.25,{100 + i}.125\n" for i in range(20))
    assert "`columns='PNEZ'` or `columns='PENZ'`" in str(fault(survey, rows))
    whole = "".join(f"{i},{5000 + i % 5},{1000 + i // 5},{100 + i}\n" for i in range(20))
    assert "PNEZ" in str(fault(survey, whole))


def test_two_layouts_inside_the_area_are_refused(survey):
    """Eastings and northings of Birmingham, exchanged, lie in the Irish Sea: Britain's grid."""
    rows = "".join(f"{i},{407000 + i}.5,{287000 + 2 * i}.5,120.25\n" for i in range(9))
    said = str(fault(survey, rows, crs="EPSG:27700"))
    assert "`columns='PNEZ'` or `columns='PENZ'`" in said
    assert "the CRS of the points may tell" not in said
    bare = "".join(f"{407000 + i}.5 {287000 + 2 * i}.5 120.25\n" for i in range(9))
    assert survey(bare, crs="EPSG:27700").points[0].tolist() == [407000.5, 287000.5, 120.25]


def test_elevations_first_are_no_layout(survey):
    rows = "".join(f"322.{i},752{700 + i}.5,40242{40 + i}.5\n" for i in range(9))
    assert "elevations of 4,024,2" in str(fault(survey, rows))


def test_numbers_before_two_coordinates_are_no_coordinates(survey):
    rows = "".join(f"{i},5000.{i},600.{i}5\n" for i in range(1, 9))
    assert "count 1, 2, 3" in str(fault(survey, rows))


def test_point_numbers_in_a_file_of_a_scan_s_suffix(survey):
    rows = "".join(f"{i % 3},{14 + i}.75,{20 + i}.5,32.25,86,EP\n" for i in range(9))
    assert "columns='PENZ-D'" in str(fault(survey, rows, name="a.xyz"))


@pytest.mark.parametrize("suffix", [".xyz", ".pts"])
def test_files_of_scans_begin_with_x_y_z(survey, suffix):
    rows = "".join(f"{i % 5}.5 {i // 5}.5 3.25 {i}\n" for i in range(20))
    assert survey(rows, name=f"scan{suffix}").points[6].tolist() == [1.5, 1.5, 3.25]
    assert "columns='XYZ'" in str(fault(survey, rows, name="scan.txt"))


def test_points_far_from_their_crs_are_told(survey):
    """Norway uses the zone of its middle for all of it: no exchange helps, and all is said."""
    rows = "".join(f"-5{(4 * i) % 9}000.5,6650{i}00.5,12.5\n" for i in range(9))
    found = survey("easting,northing,elevation\n" + rows, crs="EPSG:25833")
    assert "9 of 9 points lie outside the area of use of EPSG:25833" in found.notes[-1]
    assert "outside the area of use" in str(fault(survey, rows, crs="EPSG:25833"))
    far = survey("x,y,z\n752700,4024240,322\n752701,4024240,322\n4024241,752700,321\n", crs=UTM)
    assert "1 of 3 points lies outside" in far.notes[0]
    assert "(line 4); 1 lies inside if exchanged" in far.notes[0]


def test_degrees_in_the_wrong_order_are_refused(survey):
    said = str(fault(survey, "lat,lon,z\n-84,36,1\n-84.1,36,2\n", CrsError, crs=UTM))
    assert "outside the area of use of EPSG:4326 and EPSG:32616" in said
    found = survey("lon,lat,z\n-84,36,1\n-84.1,36,2\n", crs=UTM, columns="lon,lat,z")
    assert 4e6 > found.points[0, 1] > 3.9e6


def test_repeated_numbers_are_named(survey):
    content = "p,n,e,z\n10,1,2,3\n10,2,3,4\nA,3,4,5\n7,4,5,6\nA,5,6,7\n"
    notes = survey(content).notes
    assert notes == ["2 point numbers occur more than once: 10 in lines 2, 3; A in lines 4, 6."]
    assert survey("p,n,e,z\n,1,2,3\n,2,3,4\n9,3,4,5\n").notes == []


def test_n_beside_x_and_y_is_the_number(survey):
    found = survey("N,X,Y,Z\n1,10,20,30\n2,11,21,31\n")
    assert found.points[0].tolist() == [10, 20, 30]
    assert found.attributes["number"].tolist() == [1, 2]


def test_what_a_header_leaves_open_is_told(survey):
    (note,) = survey("Nr;Y;X;H\n1;10;20;30\n2;11;21;31\n").notes
    assert "'X' is the easting and 'Y' the northing" in note
    (note,) = survey("X,Y,E,N,Z\n1,2,30,40,5\n2,3,31,41,6\n").notes
    assert "'E' and 'N' are taken, 'X' and 'Y' are not" in note
    text = "E,N,X,Y,Z\n1,2,30,40,5\n2,3,31,41,6\n"
    assert "('E', 'N'; 'X', 'Y', 'Z')" in str(fault(survey, text, ReadError))
    (note,) = survey("E,N,Height,Elevation\n1,2,30,40\n2,3,31,41\n").notes
    assert "'Elevation' is taken as the elevation, not 'Height'" in note


def test_one_column_cannot_be_two_coordinates(survey):
    columns = {"easting": 1, "northing": 1, "elevation": 2}
    assert "twice" in str(fault(survey, "1,2,3\n4,5,6\n", OptionError, columns=columns))


@pytest.mark.parametrize(
    ("top", "unit"),
    [
        ("x,y,z\n", None),
        ("x,y,Elevation (USft)\n", "USft"),
        ("x,y,elev_ft\n", "ft"),
        ("x,y,Height [m]\n", "m"),
        ("x,y,Height (NAVD88)\n", None),
        ("x,y,z\nm,m,US survey feet\n", "US survey feet"),
    ],
)
def test_units_in_a_header(tmp_path, top, unit):
    path = tmp_path / "a.csv"
    path.write_text(f"{top}1,2,3\n4,5,6\n")
    assert find_layout(read_lines(path), path.suffix, LayoutOptions()).elevation_unit == unit


# ------------------------------------------------------------------ rows that are odd


def test_a_description_may_hold_the_delimiter(survey):
    content = 'p,n,e,z,d\n1,10,20,30,EP, NORTH SIDE\n2,11,21,31,GS\n3,12,22,32,6" PIPE, OLD\n'
    for text in (content, content.replace("p,n,e,z,d\n", "")):
        found = survey(text, columns="PNEZD")
        assert found.attributes["description"].tolist() == ["EP, NORTH SIDE", "GS", '6" PIPE,OLD']
        assert found.points.tolist() == [[20, 10, 30], [21, 11, 31], [22, 12, 32]]
    short = survey("p,n,e,z,d\n1,10,20,30,EP\n2,11,21,31\n3,12,22,32,GS\n")
    assert short.attributes["description"].tolist() == ["EP", "", "GS"]


@pytest.mark.parametrize(
    "row",
    [
        "3,4,024,240.1,752700.2,322.0,EP",
        "3,4024240.1,752700.2,1,032.5,EP",
        "3,4024240,10,752700,20,322,05,EP",
        "3,4024240.1,752700.2,1,032.5,",
    ],
)
def test_numbers_that_hold_the_delimiter_are_no_description(survey, row):
    content = f"p,n,e,z,d\n1,4024240.1,752700.2,322.0,EP\n2,4024241.1,752700.2,322.0,EP\n{row}\n"
    assert fault(survey, content).line == 4
    assert survey(content, skip_bad=True).skipped_lines == {"bad rows": (4,)}


def test_thousands_between_blanks_are_no_description(survey):
    top = "1 10.5 20.5 30.5 EP\n2 11.5 20.5 31.5 24 PINE\n"
    assert fault(survey, f"{top}3 12.5 20.5 1 132.5 EP\n", columns="PNEZD").line == 3
    assert len(survey(f"{top}3 12.5 20.5 1.5 12 PINE\n", columns="PNEZD")) == 3


def test_a_short_row_lacks_its_description_only_where_that_is_never_a_number(survey):
    content = "p,n,e,z,d\n1,10,20,30,EP\n2,11,21,31,12\n3,12,22,14\n"
    assert fault(survey, content).line == 4


def test_points_without_elevation_are_left_out_and_named(survey):
    content = "p,n,e,z,d\n1,10,20,30,A\n2,11,21,,B\n3,12,22,NaN,C\n4,13,23,33,D\n5,9,9,-,E\n"
    found = survey(content)
    assert found.attributes["number"].tolist() == [1, 4]
    assert found.skipped == {"header lines": 1, "points without elevation": 3}
    assert found.skipped_lines == {"points without elevation": (3, 4, 6)}
    assert found.notes == ["3 points are left out, without an elevation: lines 3, 4, 6."]


def test_bad_rows_are_left_out_on_request_and_each_is_accounted_for(survey):
    content = 'x,y,z,d\n1,2,3,a\n4,5\n6,x,8,b\n9,9,"9,c\n5,6,7,d\n7,8,9,e\n7,9,1,f\n7,6,1,g\n'
    fault(survey, content)
    found = survey(content, skip_bad=True)
    assert found.points[:, 0].tolist() == [1, 5, 7, 7, 7]
    assert found.skipped_lines == {"bad rows": (3, 4, 5)}
    (note,) = found.notes
    assert "3 bad rows are left out (line 3: has 2; line 4: northing in column 2" in note
    mostly = "x,y,z\n1,2,3\n4,a,5\n4,b,5\n4,c,5\n"
    assert "3 of 4 rows" in str(fault(survey, mostly, skip_bad=True))


def test_thousands_separators_are_taken_out_where_they_are_proved(survey):
    content = 'x,y,z\n"752,700.5","4,024,240",322.5\n752701.5,4024241.5,"1,322"\n'
    found = survey(content)
    assert found.points.tolist() == [[752700.5, 4024240, 322.5], [752701.5, 4024241.5, 1322]]
    assert "taken out of 3 coordinates" in found.notes[0]
    swiss = survey("x;y;z\n2'600'000,5;1'200'000;432\n2600001,5;1200000;433\n")
    assert swiss.points[0].tolist() == [2600000.5, 1200000, 432]
    point = survey("x;y;z\n752.700,5;4.024.240;1.032,5\n752701,5;4024241;1033,5\n")
    assert point.points[0].tolist() == [752700.5, 4024240, 1032.5]


@pytest.mark.parametrize(("comma", "point"), [("512,350", "512.700"), ("512,700", "512.350")])
def test_a_comma_and_a_point_between_digits_of_one_column_are_refused(survey, comma, point):
    rows = (
        f"1;5400100.5;4570200.5;{comma}\n2;5400110.5;4570210.5;{point}\n3;5400120.5;4570200.5;513\n"
    )
    text = f"Nr;Hoch;Rechts;Höhe\n{rows}"
    assert f"'{comma}' beside '{point}' in column 4" in str(fault(survey, text))
    assert survey(text, decimal=".").points[0, 2] == float(comma.replace(",", ""))


def test_three_elevations_of_zero_leave_the_layout_plain(survey):
    heights = [0 if i % 5 == 0 else 512 + i for i in range(17)]
    rows = "".join(
        f"{i},{5400100 + 9 * (i % 4)}.123,{4570200 + 8 * (i // 4)}.417,{heights[i]},G\n"
        for i in range(1, 17)
    )
    notes = survey(rows, crs="EPSG:31468").notes
    assert "(PNEZD)" in notes[0]
    assert "3 points have the elevation 0" in notes[1]


def test_nodata_in_text_is_told_and_left_out_on_request(survey):
    content = "x,y,z\n1,2,318.5\n4,5,-9999\n7,8,320.5\n9,9,331\n3,4,-9999\n5,6,0\n"
    notes = survey(content).notes
    assert "2 points have the elevation -9999, far from the others (318.5 to 331)" in notes[0]
    assert "`nodata=-9999` leaves them out" in notes[0]
    assert "1 point has the elevation 0" in notes[1]
    found = survey(content, nodata=[-9999, 0])
    assert found.points[:, 2].tolist() == [318.5, 320.5, 331]
    assert found.skipped_lines == {"nodata points": (3, 6, 7)}
    assert "nodata" in str(fault(survey, content, OptionError, nodata="much"))


def test_a_row_too_many_does_not_mislead_the_delimiter(survey):
    top = "X, Y, Z\n289814.15 , 4320978.61 , 170.76,27\n"
    rest = "".join(f"28981{i}.64 , 432097{i}.84 , 170.7{i}\n" for i in range(4, 7))
    error = fault(survey, top + rest, name="c.txt")
    assert error.line == 2
    assert "1 of 4 rows does not have 3 columns (line 2 has 4)" in str(error)
    assert len(survey(top + rest, name="c.txt", skip_bad=True)) == 3


@pytest.mark.parametrize("text", ["1" * 8_000, "1" * 200_000 + "x", "(" * 100_000, "-" * 100_000])
def test_long_cells_are_judged_in_no_time(survey, text):
    started = time.process_time()
    for content in (f"x,y,z\n{text},2,3\n4,5,6\n", f"{text};y;z\n1;2;3\n", f"{text} 1 2\n"):
        with contextlib.suppress(ReadError):
            survey(content)
    assert time.process_time() - started < 5.0


def test_overlong_lines_are_refused(survey):
    error = fault(survey, "x,y,z\n1,2,3\n" + "7" * 1_000_001 + "\n")
    assert error.line == 3
    assert "1,000,001 bytes" in str(error)
    assert "2,000 columns" in str(fault(survey, ",".join(["1"] * 2_000) + "\n"))


# ------------------------------------------------------------------ lines that are no rows


def test_titles_units_comments_and_blank_lines_are_counted(survey):
    content = (
        "Survey of the mill\n# made by hand\n\nPoint,Northing,Easting,Elevation\n,m,m,m\n"
        "1,10,20,30\n// gap\n2,11,21,31\n;off\n   \n,,,\n3,12,22,33\n"
    )
    found = survey(content)
    assert found.points.tolist() == [[20, 10, 30], [21, 11, 31], [22, 12, 33]]
    assert found.skipped == {
        "title lines": 1,
        "comment lines": 3,
        "blank lines": 3,
        "header lines": 2,
    }


@pytest.mark.parametrize("line", ["# N E Z", "//N E Z", "#N\tE\tZ", "; N  E  Z"])
def test_header_in_a_comment(survey, line):
    found = survey(f"{line}\n1 2 3\n4 5 6\n", name="a.xyz")
    assert found.points.tolist() == [[2, 1, 3], [5, 4, 6]]
    assert found.notes == []


def test_number_sign_as_the_name_of_the_point_number(survey):
    found = survey("#,Northing,Easting,Elev\n7,1,2,3\n8,4,5,6\n")
    assert found.points.tolist() == [[2, 1, 3], [5, 4, 6]]
    assert found.attributes["number"].tolist() == [7, 8]


def test_a_comment_prefix_of_the_callers_own(survey):
    found = survey("x,y,z\nREM 1,2,3\n4,5,6\n7,8,9\n", comment="REM")
    assert found.points[:, 0].tolist() == [4, 7]
    found = survey("p,n,e,z\n1,2,3,5\n#4,5,6,7\n", comment="")
    assert found.attributes["number"].tolist() == ["1", "#4"]


def test_number_sign_in_a_description_is_no_comment(survey):
    found = survey("x,y,z,code\n1,2,3,MH#4\n4,5,6,! see note\n")
    assert found.attributes["description"].tolist() == ["MH#4", "! see note"]


def test_points_announced_in_the_first_line(survey):
    found = survey("2\n1 2 3 90\n4 5 6 80\n", name="scan.pts")
    assert len(found) == 2
    assert found.skipped == {"point count": 1}
    error = fault(survey, "3\n1 2 3 90\n4 5 6 80\n", name="scan.pts")
    assert "announces 3 points, but 2" in str(error)


def test_delimiters_at_the_line_end(survey):
    for header in ("x;y;z;", "x;y;z"):
        found = survey(f"{header}\n1;2;3;\n4;5;6;\n")
        assert found.points.tolist() == [[1, 2, 3], [4, 5, 6]]
        assert dict(found.attributes) == {}


# ------------------------------------------------------------------ quotes, blanks, encodings


def test_quotes_as_surveyors_write_them(survey):
    content = (
        'x,y,z,desc\n1,2,3,"DITCH, N side"\n4,5,6,6" PVC\n7,8,9,"say ""hi"""\n'
        '10,11,12,12" and 6" pipes\n'
    )
    found = survey(content)
    oracle = list(csv.reader(io.StringIO(content)))[1:]
    assert found.attributes["description"].tolist() == [row[3] for row in oracle]
    assert found.points.tolist() == [[float(cell) for cell in row[:3]] for row in oracle]


@settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(tails=st.lists(st.text('a",b ', max_size=7), min_size=1, max_size=4))
def test_every_pile_of_quotes_reads_as_csv_says_or_is_refused(survey, tails):
    lines = [f"{i},2.5,3.5,{tail}" for i, tail in enumerate(tails)]
    oracle = [next(csv.reader([line], skipinitialspace=True)) for line in lines]
    top = "x,y,z,desc\n1,2.5,3.5,first\n9,2.5,3.5,second\n"
    content = top + "\n".join(lines) + "\n"
    try:
        found = survey(content)
    except ReadError:
        is_open = any(
            next(csv.reader([line, "\x01"], skipinitialspace=True))[-1].endswith("\x01")
            for line in lines
        )
        assert is_open
    else:
        texts = found.attributes["description"].tolist()[2:]
        joined = [
            row[3] if len(row) == 4 else ",".join(row[3:]) if '"' in tail else tail
            for row, tail in zip(oracle, tails, strict=True)
        ]
        plain = [re.sub(r"\s*,\s*", ",", text).strip() for text in texts]
        assert plain == [re.sub(r"\s*,\s*", ",", text).strip() for text in joined]


def test_a_quote_that_stays_open_is_refused_with_its_line(survey):
    error = fault(survey, 'x,y,z,d\n1,2,3,a\n4,5,6,"\n7,8,9,"\n')
    assert error.line == 3
    assert "quote" in str(error)


def test_a_cell_of_endless_text(survey):
    long = "x" * 200_000
    assert survey(f"x,y,z,d\n1,2,3,{long}\n4,5,6,b\n").attributes["description"][0] == long
    assert fault(survey, f'x,y,z,d\n1,2,3,{long}\n4,5,6,6" pipe, "\n').line == 2
    assert "no table" in str(fault(survey, f'{{"a": "{long}", {long}}}'))


def test_words_of_a_description_between_blanks(survey):
    content = (
        "1  10.0  20.0 30.0 EDGE OF PAVEMENT\n2\t10.0 21.0 30.0 TREE\n"
        "3  11.0  20.0 30.0\n   4  11.0 21.0 30.0 MH  LID  \n"
    )
    found = survey(content, name="a.txt", columns="PNEZD")
    words = ["EDGE OF PAVEMENT", "TREE", "", "MH LID"]
    assert found.attributes["description"].tolist() == words
    assert found.points[:, 0].tolist() == [20, 21, 20, 21]
    error = fault(survey, content + "5 11.0 22.0 30", name="a.txt", columns="PNEZD")
    assert "truncated" in str(error)


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "utf-32"]
)
@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r", "\r\r\n"])
def test_encodings_and_line_ends(survey, encoding, line_end):
    content = line_end.join(["Punkt;Ost;Nord;Höhe;Code", "1;2;3;4,5;Gebäude", "2;3;4;5,5;Zaun", ""])
    found = survey(content.encode(encoding))
    assert found.points.tolist() == [[2, 3, 4.5], [3, 4, 5.5]]
    assert found.attributes["description"].tolist() == ["Gebäude", "Zaun"]


def test_encoding_by_name(survey):
    content = "x,y,z,code\n1,2,3,房子\n4,5,6,树\n".encode("gbk")
    assert survey(content, encoding="gbk").attributes["description"].tolist() == ["房子", "树"]
    assert "encoding" in str(fault(survey, content, encoding="utf-8"))
    assert "encoding" in str(fault(survey, content, encoding="nonsense"))


def test_attributes_keep_their_kind(survey):
    content = "id,x,y,z,r,share,code,empty\n007,1,2,3,255,0.5,12,\n008,4,5,6,0,,NA,\n"
    found = survey(content)
    assert found.attributes["number"].tolist() == ["007", "008"]
    assert found.attributes["r"].tolist() == [255, 0]
    assert found.attributes["share"][0] == 0.5
    assert np.isnan(found.attributes["share"][1])
    assert found.attributes["description"].tolist() == ["12", "NA"]
    assert np.isnan(found.attributes["empty"]).all()


def test_names_that_say_it_best_win(survey):
    found = survey("Height,Northing,Easting,Elevation,X\n1,2,3,4,5\n6,7,8,9,10\n")
    assert found.points.tolist() == [[3, 2, 4], [8, 7, 9]]
    assert "2 columns named 'x'" in str(fault(survey, "x,y,z,x\n1,2,3,4\n5,6,7,8\n"))


# ------------------------------------------------------------------ decimal commas


def test_commas_that_may_be_marks_or_delimiters_are_not_guessed(survey):
    error = fault(survey, "4000123,45,750000,12,300,50\n4000124,45,750001,12,300,61\n")
    assert "decimal" in str(error)
    assert "columns" in str(fault(survey, "7,2,3,255,0,12\n4,5,6,31,7,1\n"))
    found = survey("7.5,2,3,255,0,12\n4,5,6,31,7,1\n")
    assert found.points.tolist() == [[7.5, 2, 3], [4, 5, 6]]


def test_header_and_rows_of_decimal_commas_split(survey):
    error = fault(survey, "x,y,z\n1,25,2,50,3,75\n4,25,5,50,6,75\n")
    assert "3 columns" in str(error)
    assert "decimal mark" in str(error)


def test_decimal_marks_below_the_rows_looked_at(survey):
    """Where the first rows have no decimals the mark is that of the others, a point on a draw."""
    whole = "x;y;z\n" + "".join(f"{i};{i % 7};5\n" for i in range(2_000))
    for mark in ".,":
        lines = whole.splitlines()
        lines[1_002] = f"5000{mark}5;2;3"
        assert survey("\n".join(lines)).points[1_001, 0] == 5000.5
    mixed = "x;y;z\n1,5;2.5;3\n4;5;6\n"
    assert "'1,5'" in str(fault(survey, mixed))


def test_a_comma_behind_a_number_in_a_remark_is_no_decimal_mark(survey):
    rows = "".join(f"{i} 1{i}.5 21 1,032 MH, 12, OLD\n" for i in range(4))
    assert survey(rows, columns="PENZD").points[:, 2].tolist() == [1032.0] * 4
    whole = rows.replace(".5", "")
    assert "separate thousands" in str(fault(survey, whole, columns="PENZD"))


@pytest.mark.parametrize("numbers", [False, True], ids=["coordinates", "point numbers"])
@pytest.mark.parametrize("long", range(6))
def test_commas_may_be_decimal_marks_only_before_a_few_digits(survey, long, numbers):
    """4,25,7,50,1,05 may be three coordinates; with 12345 behind a comma it is six columns."""

    def is_doubted(digits):
        cells = [["4", "25", "7", "50", "1", "05"], ["5", "75", "8", "25", "2", "10"]]
        for row in cells:
            row[long] = digits
        rows = [",".join([str(101 + i)] * numbers + row) for i, row in enumerate(cells)]
        try:
            survey("\n".join(rows) + "\n")
        except ReadError as error:
            return "delimiters or decimal marks" in str(error)
        return False

    assert is_doubted("1234")
    assert is_doubted("12345") == (long % 2 == 0)


def test_commas_that_may_separate_thousands(survey):
    assert "decimal=','" in str(fault(survey, "752,700\t424,240\t132\n752,701\t424,241\t133\n"))
    (note, *_) = survey("x;y;z\n752,700;424,240;132\n752,701;424,241;133\n").notes
    assert "decimal marks, as is usual between semicolons" in note
    found = survey("x\ty\tz\n752,700\t4,024,240\t132\n752,701\t4,024,241\t1,033\n")
    assert found.points[0].tolist() == [752700, 4024240, 132]


def test_decimal_comma_with_semicolon_and_mixed_marks(survey):
    assert survey("x;y;z\n1,234;2;3\n4,5;5;6\n").points[0].tolist() == [1.234, 2, 3]
    error = fault(survey, "x;y;z\n1,5;2,5;3,5\n4,5;5.5;6,5\n")
    assert "line 3: northing in column 2 ('y') is '5.5'" in str(error)
    assert "decimal comma" in str(error)


# ------------------------------------------------------------------ bad input


@pytest.mark.parametrize(
    ("cell", "shown"),
    [
        ("abc", "is 'abc'"),
        ("", "is empty"),
        ("NaN", "is 'NaN'"),
        ("inf", "is 'inf'"),
        ("1e999", "is '1e999'"),
        ("1_000", "is '1_000'"),
        ("0x10", "is '0x10'"),
        ("True", "is 'True'"),
        ("12.5m", "is '12.5m'"),
        ('"12,34.5"', "is '12,34.5'"),
        ('"1,234"', "is '1,234'"),
        ("١٢", "is '١٢'"),
    ],
)
def test_bad_value_is_named_by_line_and_column(survey, cell, shown):
    content = f"# top\n\nPoint,Northing,Easting,Elevation\n1,2,3,4\n# gap\n2,3,{cell},5\n3,4,5,6\n"
    error = fault(survey, content)
    assert error.lines == (6,)
    assert f"line 6: easting in column 3 ('Easting') {shown}" in str(error)
    assert "1 of 3 rows has" in str(error)
    assert "survey.csv" in str(error)


def test_all_bad_values_are_counted_and_the_first_shown(survey):
    content = "x,y,z\n" + "".join(f"{i},?,{i}\n" if i % 3 else f"{i},1,2\n" for i in range(30))
    error = fault(survey, content)
    assert "20 of 30 rows" in str(error)
    assert error.lines == (3, 4, 6, 7, 9)


def test_a_bad_value_in_the_first_row(survey):
    assert fault(survey, "x,y,z\nabc,2,3\n4,5,6\n7,8,9").line == 2
    assert fault(survey, "abc,2,3\n4,5,6\n7,8,9").line == 1


def test_a_whole_column_that_is_no_number(survey):
    assert "2 of 2 rows" in str(fault(survey, "x,y,z\n1,2,True\n3,4,False\n"))
    assert "2 of 2 rows" in str(fault(survey, "x,y,z\n1,,2\n3,,4\n"))
    assert "of 2 rows, none has an elevation" in str(fault(survey, "x,y,z\n1,2,\n3,4,\n"))


def test_rows_of_another_length(survey):
    error = fault(survey, "x,y,z\n1,2,3\n4,5\n6,7,8\n9,10,11,12\n")
    assert error.lines == (3, 5)
    assert "line 3 has 2, line 5 has 4" in str(error)
    assert "2 of 4 rows do not have 3 columns" in str(error)


def test_rows_whose_lengths_make_up_for_each_other(survey):
    assert fault(survey, "x,y,z,c\n1,2,3,4\n4,5,6\n7,8,9,1,2\n6,7,8,1\n").lines == (3, 4)


def test_truncated_file(survey):
    error = fault(survey, "x,y,z,code\n1,2,3,A\n4,5,6,B\n7,8")
    assert error.line == 4
    assert "truncated" in str(error)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("# only\n\n", "no points"),
        ("x,y,z\n", "no row"),
        ("hello\nworld\n", "no table"),
        ("1,2\n3,4\n", "no table"),
        ("x;y\n1;2\n", "no table"),
        (b"\x01\x00\x02\x03" * 50, "binary"),
        (" \n\n", "no points"),
        ("a,b,c\n1,2,3\n", "does not name"),
        ("code,x,y\nA,1,2\nB,3,4\n", "does not name"),
        ("1,4,7,3\n2,5,8,3\n", "may be point numbers"),
        ("1,a,2,3\n2,b,5,6\n3,c,4,4\n", "known layout"),
    ],
)
def test_no_table_of_points(survey, content, words):
    assert words in str(fault(survey, content))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"columns": "PNED"}, "elevation"),
        ({"columns": "XYZZ"}, "twice"),
        ({"columns": "PNEZD"}, "5 columns"),
        ({"columns": ["a", "b"]}, "easting"),
        ({"columns": {"easting": 9, "northing": 1, "elevation": 2}}, "1 to 3"),
        ({"columns": {"easting": "q", "northing": 1, "elevation": 2}}, "'q'"),
        ({"columns": {"colour": 1}}, "colour"),
        ({"delimiter": "ab"}, "delimiter"),
        ({"delimiter": "."}, "delimiter"),
        ({"decimal": ";"}, "decimal"),
    ],
)
def test_bad_options(survey, options, words):
    assert words in str(fault(survey, "1,2.5,3\n4,5.5,6\n", OptionError, **options))


def test_an_option_of_another_format(survey):
    said = str(fault(survey, "1,2.5,3\n4,5.5,6\n", FormatError, stride=2))
    assert "columns, delimiter, decimal" in said


@pytest.mark.parametrize("word", ["semicolon", ";"])
def test_delimiter_by_the_callers_word(survey, word):
    assert len(survey("1;2;3\n4;5;6\n", delimiter=word)) == 2


# ------------------------------------------------------------------ CRS


def test_crs_is_declared_in_its_usual_form(survey):
    assert survey("x,y,z\n1,2,3\n4,5,6\n", crs="epsg:32616").crs == "EPSG:32616"
    fault(survey, "x,y,z\n1,2,3\n", CrsError, crs="EPSG:99999")
    fault(survey, "x,y,z\n1,2,3\n", CrsError, source_crs="nonsense")


def test_longitude_and_latitude_are_projected(survey):
    pyproj = pytest.importorskip("pyproj")
    content = "lat,lon,z\n36.4,-84.2,300\n36.5,-84.3,310\n36.4,-84.3,305\n"
    found = survey(content, crs="EPSG:32616")
    x, y = pyproj.Proj("EPSG:32616")([-84.2, -84.3, -84.3], [36.4, 36.5, 36.4])
    assert np.allclose(found.points[:, :2], np.stack([x, y], axis=1), rtol=0, atol=1e-6)
    assert found.points[:, 2].tolist() == [300, 310, 305]
    for crs in (None, "EPSG:4326"):
        assert "crs='EPSG:32616'" in str(fault(survey, content, crs=crs))


def test_source_crs_is_left_for_another(survey):
    pyproj = pytest.importorskip("pyproj")
    content = "x,y,z\n-84.2,36.4,300\n-84.3,36.5,310\n"
    found = survey(content, crs="EPSG:2274", source_crs="EPSG:4269")
    move = pyproj.Transformer.from_crs("EPSG:4269", "EPSG:2274", always_xy=True)
    assert np.allclose(found.points[0, :2], move.transform(-84.2, 36.4), rtol=0, atol=1e-6)
    fault(survey, "lon,lat,z\n5000,95,1\n", CrsError, crs="EPSG:32616")
    said = str(fault(survey, content, CrsError, source_crs="EPSG:32616"))
    assert "as longitude and latitude" in said
    assert "source_crs" in said
    moved = content.replace("-84.2,36.4", "752640,4024180").replace("-84.3,36.5", "752650,4024190")
    assert survey(moved, source_crs="EPSG:32616").crs == "EPSG:32616"


# ------------------------------------------------------------------ writing


values = st.floats(allow_nan=False, allow_infinity=False)


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    points=st.lists(st.tuples(values, values, values), min_size=1, max_size=8),
    words=st.data(),
    suffix=st.sampled_from([".csv", ".txt", ".tsv"]),
)
def test_what_is_written_reads_back(tmp_path, points, words, suffix):
    texts = words.draw(
        st.lists(st.text('ab",;\t é|', max_size=5), min_size=len(points), max_size=len(points))
    )
    survey = ts.Survey(
        points=np.array(points),
        attributes={
            "number": np.arange(len(points)),
            "description": np.array(texts, object),
            "share": np.linspace(0.1, 0.7, len(points)),
        },
    )
    back = read(write(survey, tmp_path / f"out{suffix}"))
    assert back.points.tobytes() == survey.points.tobytes()
    assert [t.strip() for t in back.attributes["description"]] == [
        " ".join(t.split(" ")).strip() for t in texts
    ]
    assert back.attributes["number"].tolist() == list(range(len(points)))
    assert back.attributes["share"].tobytes() == survey.attributes["share"].tobytes()


def test_tin_is_written_as_its_vertices(tmp_path):
    tin = ts.triangulate(EXPECTED)
    path = write(tin, tmp_path / "vertices.csv")
    assert path.read_bytes().splitlines()[0] == b"easting,northing,elevation"
    assert np.array_equal(read(path).points, tin.points)
    path = write(tin, tmp_path / "vertices.xyz")
    assert path.read_text().splitlines()[0] == "752646.5 4024238.125 320.565"
    assert np.array_equal(read(path).points, tin.points)


def test_letters_choose_what_is_written(tmp_path):
    survey = ts.Survey(points=EXPECTED, attributes={"number": np.arange(4)})
    path = write(survey, tmp_path / "a.csv", columns="PENZ", delimiter=";", header=False)
    assert path.read_text().splitlines()[0] == "0;752646.5;4024238.125;320.565"
    for letters in ("PNEZD", "XX", "Q"):
        with pytest.raises(WriteError):
            write(survey, tmp_path / "b.csv", columns=letters)
    with pytest.raises(WriteError):
        write(survey, tmp_path / "b.csv", delimiter="..")
    assert not (tmp_path / "b.csv").exists()


def test_lines_are_not_lost_silently(tmp_path):
    survey = ts.Survey(points=EXPECTED, breaklines=[EXPECTED[:2]])
    with pytest.warns(ts.LossWarning, match=r"does not hold the lines of the survey \(1 breakline"):
        write(survey, tmp_path / "a.csv")


def test_progress_ends_at_one(tmp_path):
    seen = []
    write(ts.Survey(points=np.zeros((250_000, 3))), tmp_path / "a.csv", progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_large_file_reads_whole(tmp_path):
    """Rows far below those looked at, plain and in need of care, are found with their line."""
    n = 60_000
    path = tmp_path / "large.csv"
    rows = [f"{i},{i * 0.5},{-i},{i % 7},code\n" for i in range(n)]
    path.write_text("P,N,E,Z,D\n" + "".join(rows))
    plain = read(path)
    assert plain.points[:, 0].tolist() == [-float(i) for i in range(n)]
    rows[40_000] = '40000,1,2,3,6" pipe\n'
    path.write_text("P,N,E,Z,D\n" + "".join(rows))
    assert read(path).attributes["description"][40_000] == '6" pipe'
    rows[50_000] = "50000,1,2,x,code\n"
    path.write_text("P,N,E,Z,D\n" + "".join(rows))
    with pytest.raises(ReadError) as caught:
        read(path)
    assert caught.value.line == 50_002


def test_importing_the_room_loads_no_heavy_library():
    heavy = "{'pandas', 'pyproj', 'rasterio', 'pyvista', 'scipy'}"
    code = f"import sys, tinsmith.io; sys.exit(len({heavy} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_examples_of_the_page_on_survey_text_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = Path(__file__).parents[3] / "docs" / "survey-text.md"
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 2
    exec("\n".join(blocks), {})
    printed = " ".join(capsys.readouterr().out.split())
    shown = re.sub(r"\n# ", " ", blocks[0]).split("print(error) ")[1].split("\n")[0]
    assert printed.startswith(shown)
    for line in re.findall(r"^# (\d.*)$", blocks[1], re.MULTILINE):
        assert line in printed


@pytest.mark.parametrize(
    ("rows", "is_stated"),
    [
        ("1.5,2.5,100\n300,20,101\n40,400,103\n", True),  # a local grid
        ("500001,5200002,100\n500300,5200020,101\n500040,5200400,103\n", False),
        # Zone 32 is kept by surveys beyond its eastern edge.
        ("900001,5300002,100\n900300,5300020,101\n900040,5300400,103\n", False),
    ],
)
def test_local_coordinates_with_a_projected_crs_are_told(tmp_path, rows, is_stated):
    """Easting 0 and northing 0 of UTM lie within the margin of its area of use."""
    path = tmp_path / "in.csv"
    path.write_text("x,y,z\n" + rows)
    told = [note for note in ts.read(path, crs="EPSG:32632").notes if "local coordinates" in note]
    assert len(told) == is_stated


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("x,y,z\n1,2,\n", "of 1 row, none has an elevation"),
        ("3\n1 2 3\n", "announces 3 points, but 1 row follows"),
        ("1\n1 2 3\n2 3 4\n", "announces 1 point, but 2 rows follow"),
    ],
)
def test_sentences_about_one_row_are_in_the_singular(survey, content, words):
    assert words in str(fault(survey, content))


@pytest.mark.parametrize("delimiter", ["|", "\t", ";"])
def test_a_comma_before_the_first_digit_is_a_decimal_one(survey, delimiter):
    rows = [["E", "N", "H"], ["0", "0", "0"], ["1", "0", "0"], ["0", "1", ",5"]]
    found = survey("".join(delimiter.join(row) + "\n" for row in rows))
    assert found.points[2].tolist() == [0.0, 1.0, 0.5]


THOUSANDS = [
    [["752,700", "4,024", "1,234"], ["753,100", "4,025", "5"], ["754,200", "4,027", "1,236"]],
    [["752", "4024", "1,234"], ["753", "4025", "1,235"], ["755", "4027", "1,236"]],
    [["752", "4024", "5"], ["753", "4025", "7"], ["755", "4027", "6"]],
    [["1,752", "4024", "5"], ["753", "4025", "7"], ["755", "1,027", "6"]],
]


@pytest.mark.parametrize("rows", THOUSANDS)
@pytest.mark.parametrize("separator", [",\t", "\t,", ",;", ";,", ",|", "|,", ", ", " ,", "\t , "])
@pytest.mark.parametrize("has_header", [True, False])
@pytest.mark.parametrize("line_end", ["\n", ",\n"])
def test_thousands_beside_two_letters_that_separate_columns_are_no_decimals(
    survey, rows, separator, has_header, line_end
):
    """Whatever such a table is taken for, 1,234 never becomes 1.234 or 1."""
    content = separator.join("xyz") + "\n" if has_header else ""
    content += "".join(separator.join(row) + line_end for row in rows)
    try:
        found = survey(content, columns=None if has_header else "x,y,z")
    except ReadError:
        return
    assert found.points.tolist() == [[float(c.replace(",", "")) for c in row] for row in rows]


@pytest.mark.parametrize("delimiter", ["\t", " ", "|"])
def test_one_comma_far_down_the_file_is_no_decimal_mark_by_itself(survey, delimiter):
    rows = [["x", "y", "z"], *([str(i), str(i % 7), "5"] for i in range(5000))]
    rows[2346][2] = "1,234"
    content = "".join(delimiter.join(row) + "\n" for row in rows)
    assert "separate thousands ('1,234')" in str(fault(survey, content))
    assert survey(content, decimal=",").points[2345].tolist() == [2345.0, 0.0, 1.234]
    rows[3000][2] = "0,5"
    content = "".join(delimiter.join(row) + "\n" for row in rows)
    assert survey(content).points[2345].tolist() == [2345.0, 0.0, 1.234]


def test_words_between_tabs_are_one_text(tmp_path):
    """A header and rows that blanks part into equally many words, too."""
    survey = ts.Survey(
        points=[[1, 2, 3], [4, 5.5, 6], [7, 8, 9]],
        attributes={
            "number": np.array([1, 2, 3]),
            "description": np.array(["TOP BANK", "TOE OF", "ROAD CL"]),
        },
        elevation_unit="ft",
    )
    found = ts.read(ts.write(survey, tmp_path / "a.tsv"))
    assert list(found.attributes["description"]) == ["TOP BANK", "TOE OF", "ROAD CL"]
    assert found.points.tolist() == survey.points.tolist()
    assert found.elevation_unit == survey.elevation_unit


# ------------------------------------------------------------------ units of the header


def _with_units(tmp_path, unit, **options):
    path = tmp_path / "units.csv"
    rows = "".join(f"{i},{4024240.5 + i},{752700.5 + i},{5.25 + i}\n" for i in range(4))
    path.write_text(f"p,n ({unit}),e ({unit}),z (m)\n{rows}")
    return ts.read(path, **options)


@pytest.mark.parametrize("unit", ["ft", "US survey foot", "km", "mm"])
def test_a_unit_in_the_header_that_the_crs_has_not_is_refused(tmp_path, unit):
    with pytest.raises(
        ts.CrsError, match=r"gives the easting in .*, and EPSG:32616 measures in me"
    ):
        _with_units(tmp_path, unit, crs="EPSG:32616")
    with pytest.raises(
        ts.CrsError, match=r"gives the easting in .*, and EPSG:32616 measures in me"
    ):
        _with_units(tmp_path, unit, crs="EPSG:32617", source_crs="EPSG:32616")
    told = _with_units(tmp_path, unit, crs="EPSG:32616", columns="PNEZ")
    assert "measures in metre, as which they are taken" in " ".join(told.notes)
    with pytest.raises(ts.CrsError, match="and the elevation in metre: the option `crs` names"):
        _with_units(tmp_path, unit)  # no CRS would keep the unit
    told = _with_units(tmp_path, unit, columns="PNEZ")
    assert "which is not kept where no CRS is named" in " ".join(told.notes)


@pytest.mark.parametrize(("unit", "crs"), [("m", "EPSG:32616"), ("usft", "EPSG:2274")])
def test_the_unit_of_the_crs_in_the_header_is_no_doubt(tmp_path, unit, crs):
    notes = " ".join(_with_units(tmp_path, unit, crs=crs).notes)
    assert "the header gives" not in notes.lower()


def test_feet_of_the_other_kind_are_told(tmp_path):
    told = " ".join(_with_units(tmp_path, "US survey foot", crs="EPSG:2222").notes)
    assert "The header gives the easting in US survey foot, and EPSG:2222 measures in foot" in told
    plain = " ".join(_with_units(tmp_path, "ft", crs="EPSG:2274").notes)
    assert "The header gives the easting in foot, and EPSG:2274 measures in US survey foot" in plain
    same = " ".join(_with_units(tmp_path, "US survey foot", crs="EPSG:2274").notes)
    assert "header gives" not in same


# ------------------------------------------------------------------ a file that was cut off


CUT = "p,n,e,z\n" + "".join(f"{i},{10 + i}.125,{20 + i}.250,{300 + i}.375\n" for i in range(1, 7))


@pytest.mark.parametrize("length", range(2, 8))
def test_a_last_number_that_was_cut_is_no_elevation(tmp_path, length):
    path = tmp_path / "cut.csv"
    path.write_text(CUT[:-length])
    if CUT[:-length].endswith(","):
        assert len(ts.read(path)) == 5
        return
    with pytest.raises(ReadError, match=r"line 7: its last number .*, those above have 3.*truncat"):
        ts.read(path)
    survey = ts.read(path, skip_bad=True)
    assert survey.points[:, 2].tolist() == [301.375, 302.375, 303.375, 304.375, 305.375]
    assert survey.skipped_lines == {"bad rows": (7,)}


def test_rows_are_those_of_the_file_without_the_last(tmp_path):
    path = tmp_path / "cut.csv"
    path.write_text(CUT.replace("\n5,", "\n4,")[:-3])
    survey = ts.read(path, skip_bad=True)
    assert survey.notes[-1] == "1 point number occurs more than once: 4 in lines 5, 6."


def test_a_last_number_with_fewer_decimals_than_any_is_told_or_no_doubt(tmp_path):
    path = tmp_path / "cut.csv"
    ragged = CUT.replace("301.375", "301.5").replace("302.375", "302.25")
    path.write_text(ragged[:-5])
    assert "Line 7, the last, has no end" in ts.read(path).notes[0]
    for text in (CUT[:-1], ragged[:-1], ragged[:-2], CUT.replace("306.375\n", "306\n")):
        path.write_text(text)
        assert len(ts.read(path)) == 6
        assert ts.read(path).notes == []
    path.write_text(CUT.replace("n,e,z", "n,e,z,d").replace("375\n", "375,GS\n")[:-1])
    assert len(ts.read(path)) == 6


# ------------------------------------------------- what random tables in random dialects found


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("Z / us-ft", "US survey foot"),
        ("Elevation US survey ft", "US survey foot"),
        ("Elev. - ft", "foot"),
        ("Z, m", "metre"),
    ],
)
def test_units_are_read_behind_any_mark(survey, name, unit):
    found = survey(f'"E","N","{name}"\n1.5,2.5,3.5\n2.5,7.5,4.5\n')
    assert found.elevation_unit.name == unit


def test_a_header_that_does_not_fit_is_refused_though_columns_are_told(survey):
    text = "E  N  Z\n525.786  1 049.882  5.947\n540.529  1 007.253  3.530\n"
    with pytest.raises(ReadError, match="its blanks may separate columns or thousands"):
        survey(text, columns="ENZ")
    text = "E,N,Z,Q\n12,228,60,15,11,93,0,90\n42,267,68,157,9,82,0,5\n"
    with pytest.raises(ReadError, match=r"names 4 columns .* but rows have 8"):
        survey(text, columns="ENZ-")


@pytest.mark.parametrize("options", [{}, {"columns": "ENZ"}, {"columns": "ENZD"}])
def test_blanks_within_numbers_are_no_delimiters(survey, options):
    text = "525.786  1 049.882  5.947\n540.529  1 007.253  3.530\n534.517  1 060.075  5.027\n"
    if options.get("columns") == "ENZD":  # as many as there are
        assert survey(text, **options).points[0].tolist() == [525.786, 1.0, 49.882]
        return
    with pytest.raises(ReadError, match=r"columns or thousands \('1 049.882'"):
        survey(text, **options)


def test_a_decimal_mark_that_is_the_delimiter_is_refused(survey):
    text = "525,20 , 1072,77 , 5,12\n538,10 , 1040,58 , 9,07\n567,79 , 1083,27 , 7,50\n"
    with pytest.raises(ReadError, match="separated by ',', and no cell holds one"):
        survey(text, columns="ENZ", decimal=",")
    quoted = '"525,20","1072,77","5,12"\n"538,10","1040,58","9,07"\n'
    found = survey(quoted, columns="ENZ", decimal=",", delimiter="comma")
    assert found.points[0].tolist() == [525.2, 1072.77, 5.12]


def test_a_row_short_of_a_number_with_its_unit_is_at_fault(survey):
    rows = [f"{i};328,5 m;4024258,757 m;752720,{i}00 m" for i in range(1, 6)]
    rows[2] = "3;328,081 m;4024312,136 m"
    with pytest.raises(ReadError, match=r"line 4: easting in column 4 .* is empty"):
        survey("NR;Z;N;E\n" + "\n".join(rows))


def test_delimiters_at_the_end_of_rows_are_no_text(survey):
    rows = [
        f"{i},{10 + i}.5,{20 + i}.5,{5 + i / 10},{'12' if i < 3 else 'GS'}," for i in range(1, 9)
    ]
    rows[5] += "7.5,"
    found = survey("P,E,N,Z,Code,\n" + "\n".join(rows) + "\n", skip_bad=True)
    assert found.attributes["description"].tolist() == ["12", "12", "GS", "GS", "GS", "GS", "GS"]
    assert found.skipped_lines == {"bad rows": (7,)}


def test_a_header_and_rows_that_both_end_with_delimiters_have_one_count(survey):
    rows = [f"{i},1,0{i}2.874,322.375,542.227,\n" for i in range(1, 9)]
    with pytest.raises(ReadError, match=r"names 5 columns .* but rows have 6"):
        survey("P,N,Z,E,\n" + "".join(rows))


def test_units_that_blanks_split_off_belong_to_their_names(survey):
    text = "P N E Elevation [ft] Code\n1 5.5 6.5 7.5 GS\n2 8.5 9.5 7.25 EP\n"
    found = survey(text)
    assert found.elevation_unit.name == "foot"
    assert found.attributes["description"].tolist() == ["GS", "EP"]


def test_a_unit_in_every_row_is_told(survey):
    found = survey("E,N,Z,Unit\n1.5,2.5,3.5,ft\n2.5,7.5,4.5,ft\n")
    assert found.elevation_unit is None
    assert found.notes == [
        "'Unit' begins with 'ft' in every row: if this is the unit of the elevations, the option "
        "`elevation_unit` says so."
    ]


def test_a_unit_in_most_rows_is_told(survey):
    rows = ["5.5 1.5 3.1 ft 0.8", "6.5 2.5 NaN 0.2", "7.5 3.5 3.3 ft 0.1", "8.5 4.5 3.4 ft 0.7"]
    found = survey("X Y Z SATS\n" + "\n".join(rows) + "\n", columns="XYZ-")
    assert any("'SATS' begins with 'ft' in 3 of 4 rows: if this is" in note for note in found.notes)


def test_several_units_beside_elevations_are_told(survey):
    found = survey("E,N,Z,Unit\n1.5,2.5,3.5,ft\n2.5,7.5,4.5,m\n3.5,8.5,5.5,\n")
    assert found.notes == [
        "'Unit' begins with 'ft' or 'm' in 2 of 3 rows: if these are the units of the elevations, "
        "make them one."
    ]


def test_codes_that_are_units_in_few_rows_are_not_told(survey):
    assert survey("E,N,Z,Code\n1.5,2.5,3.5,M\n2.5,7.5,4.5,EP\n3.5,8.5,5.5,\n").notes == []


@pytest.mark.parametrize("header", ["Nr;X;Y;H", "Nr;Y;X;H", "Nr;Coord. X;Coord. Y;Z"])
@pytest.mark.parametrize(
    ("crs", "east", "north"),
    [
        ("EPSG:2180", 500_084.8, 500_013.6),
        ("EPSG:3844", 586_100.5, 330_100.5),
        ("EPSG:6677", -12_100.5, -35_100.5),
        ("EPSG:21781", 600_100.5, 200_100.5),
        ("EPSG:31468", 4_570_200.5, 5_400_100.5),
    ],
)
def test_an_x_that_header_and_crs_call_northing_is_the_northing(survey, header, crs, east, north):
    place = {"X": north, "Y": east}
    rows = [
        [i] + [place[name[-1]] + 7 * i for name in header.split(";")[1:3]] + [300 + i]
        for i in range(5)
    ]
    text = header + "\n" + "".join(";".join(map(str, row)) + "\n" for row in rows)
    found = survey(text, crs=crs)
    assert found.points[0].tolist() == [east, north, 300]
    assert any(f"{crs} calls its northing X, as the header does" in note for note in found.notes)


def test_an_x_that_only_the_crs_or_the_area_of_use_turns(survey):
    text = "Nr;X;Y;H\n1;500084.8;250013.6;325.8\n2;500029.1;250046.2;322.1\n3;500040;250090;323\n"
    assert survey(text, crs="EPSG:2180", columns="PENZ").points[0].tolist() == [
        *(500084.8, 250013.6, 325.8)
    ]
    assert not any("calls its northing" in note for note in survey(text, crs="EPSG:32634").notes)
    gis = "X;Y;Z\n4570200;5400100;512\n4570210;5400110;513\n4570220;5400100;512\n"
    assert survey(gis, crs="EPSG:31468").points[0].tolist() == [4570200, 5400100, 512]


@pytest.mark.parametrize(
    ("line", "is_turned"),
    [
        ("# X = Northing, Y = Easting", True),
        ("# X: north, Y: east", True),
        ("X is the Hochwert and Y is the Rechtswert", True),
        ("# Northing (X), Easting (Y)", True),
        ("# X=N Y=E", True),
        ("# X = Easting, Y = Northing", False),
        ("# site North, block Y", False),
        ("# two lines", False),
    ],
)
def test_a_line_that_says_where_x_points_is_followed(survey, line, is_turned):
    text = f"{line}\nP,X,Y,Z\n1,2000,1000,5\n2,2010,1000,6\n3,2000,1020,7\n"
    found = survey(text)
    assert found.points[0].tolist() == ([1000, 2000, 5] if is_turned else [2000, 1000, 5])
    assert any("'X' is taken as the northing" in note for note in found.notes) == is_turned
    assert survey(text, columns="PENZ").points[0].tolist() == [2000, 1000, 5]


def test_brackets_between_blanks_belong_to_the_name_before_them(survey):
    text = "P X (Northing) Y (Easting) Elev (US survey ft)\n1 20 10 5\n2 21 10 6\n3 20 12 7\n"
    found = survey(text, name="a.txt")
    assert found.points[0].tolist() == [10, 20, 5]
    assert found.elevation_unit.name == "US survey foot"


@pytest.mark.parametrize(
    ("header", "row", "is_read"),
    [
        ("Lat,N/S,Lon,E/W,Elev", "36.3{0},N,84.2{0},W,{0}", False),
        ("Lat,N/S,Lon,E/W,Elev", "36.3{0},S,84.2{0},E,{0}", False),
        ("Lat,N/S,Lon,E/W,Elev", "36.3{0},N,84.2{0},E,{0}", True),
        ("Lat,Dir1,Lon,Dir2,Elev", "36.3{0},N,84.2{0},W,{0}", False),
        ("Lat,LatDir,Lon,LonDir,Elev", "36.3{0},1,84.2{0},-1,{0}", False),
    ],
)
def test_columns_of_hemispheres_are_never_thrown_away(survey, header, row, is_read):
    text = header + "\n" + "".join(row.format(i) + "\n" for i in range(1, 6))
    if is_read:
        assert len(survey(text, crs="EPSG:3857")) == 5
    else:
        assert "may turn the sign" in str(fault(survey, text, crs="EPSG:3857"))


def test_points_whose_numbers_begin_as_comments_do_are_told(survey):
    found = survey("P,N,E,Z\n#1,11,21,5.5\n2,12,22,5.6\n# a, b\n//3,13,23,5.7\n4,14,29,5.8\n")
    assert len(found) == 2
    told = "2 lines that begin as comments do hold points and are left out (lines 2, 5)."
    assert told in found.notes
    assert survey("P,N,E,Z\n#1,1,2,5.5\n2,2,2,5.6\n", comment="").notes == []
    assert survey("# x,y,z\nP,N,E,Z\n1,1,2,5\n# 1,2,x,4\n2,2,2,6\n").notes == []


@pytest.mark.parametrize("suffix", ["csv", "tsv", "txt"])
def test_texts_that_begin_as_comments_do_come_back(tmp_path, suffix):
    numbers = np.array(["#1", "//2", ";3", "!", "%5", " #6"], object)
    points = np.array([[i, i % 3, 5.5 + i] for i in range(6)], np.float64)
    attributes = {"number": numbers, "description": numbers[::-1]}
    path = tmp_path / f"names.{suffix}"
    ts.write(ts.Survey(points=points, attributes=attributes), path)
    found = ts.read(path)
    assert np.array_equal(found.points, points)
    assert [one.strip() for one in found.attributes["number"]] == [one.strip() for one in numbers]


def test_line_breaks_within_texts_become_blanks_and_are_told(tmp_path):
    texts = np.array(["a\nb", "a\r\nb", "", "c"], object)
    points = np.array([[0, 0, 1], [1, 0, 2], [0, 1, 3], [1, 1, 4.5]])
    survey = ts.Survey(points=points, attributes={"description": texts, "remark (2)": texts})
    path = tmp_path / "breaks.csv"
    with pytest.warns(ts.LossWarning, match=r"texts of description, remark \(2\) became blanks\.$"):
        ts.write(survey, path)
    found = ts.read(path)
    assert np.array_equal(found.points, points)
    assert found.attributes["description"].tolist() == ["a b", "a b", "", "c"]


def test_elevations_of_no_data_say_nothing_of_a_layout(survey):
    rows = [
        f"{i},{4024240 + i % 4}.5,{752700 + i // 3}.5,{-9999 if i % 3 == 0 else 322}.25,GS\n"
        for i in range(1, 13)
    ]
    told = survey("".join(rows), crs="EPSG:32616")
    assert any("4 points have the elevation -9999.25, far from" in note for note in told.notes)
    found = survey("".join(rows), crs="EPSG:32616", nodata=-9999.25)
    assert found.skipped["nodata points"] == 4
    assert found.points[0].tolist() == [752700.5, 4024241.5, 322.25]


def test_elevations_beside_longitude_and_latitude_are_not_too_steep(survey):
    text = "lat,lon,z\n36.3001,-84.2001,325.8\n36.3002,-84.2002,322.1\n36.3004,-84.2001,323\n"
    assert survey(text, crs="EPSG:32616").notes == []
    assert "rise by" in survey(text.replace("lat,lon", "y,x")).notes[-1]


def test_numbers_with_units_are_no_text_that_holds_the_delimiter(survey):
    rows = [f"{i},752765,119,6,083 m,4024287,230,EP\n" for i in range(1, 9)]
    with pytest.raises(ReadError, match="do not have 5 columns"):
        survey("P,E,Z,N,Code\n" + "".join(rows))


def test_another_header_below_is_no_bad_row(survey):
    rows = [f"{i},{10 + i}.5,{20 + i}.5,{5 + i / 10}\n" for i in range(1, 9)]
    text = "P,N,E,Z\n" + "".join(rows) + "{}\n" + "".join(rows)
    again = survey(text.format("P,N,E,Z"), skip_bad=True)
    assert len(again) == 16
    with pytest.raises(
        ReadError, match=r"line 10: a header \(P, E, N, Z\) names other columns or units"
    ):
        survey(text.format("P,E,N,Z"), skip_bad=True)


def test_another_unit_below_is_no_bad_row(survey):
    rows = [f"{i},{10 + i}.5,{20 + i}.5,{5 + i / 10}\n" for i in range(1, 9)]
    with pytest.raises(ReadError, match="names other columns or units"):
        survey("P,N,E,Z\n" + "".join(rows) + "P,N,E,Z (ft)\n" + "".join(rows), skip_bad=True)


@pytest.mark.parametrize("northing", ["4.02E+06", "4e+06", "4.02424e+06"])
def test_coordinates_that_a_spreadsheet_rounded_are_told(survey, northing):
    rows = [
        "1,4024240.1,752700.2,322.5",
        f"2,{northing},752701.2,322.6",
        "3,4024244.1,752704.2,3.229E2",
    ]
    found = survey("P,N,E,Z\n" + "\n".join(rows) + "\n", crs="EPSG:32616")
    assert found.notes == [
        f"1 coordinate has an exponent and no digits below the tens (line 3: '{northing}'): check "
        "that no spreadsheet has rounded them."
    ]
    exact = survey("P,N,E,Z\n" + "\n".join(rows).replace(northing, "4.0242401E+06") + "\n")
    assert exact.notes == []


NUMBERED = [(f"{i}", f"{10 + i}.5", f"{20 + i * i}.25", f"{5 + i / 10}") for i in range(1, 6)]
WITH_HEADER = "P,N,E,Z\n" + "".join(",".join(row) + "\n" for row in NUMBERED)


def test_statistics_below_the_points_are_told(survey):
    found = survey(WITH_HEADER + "Min,11.5,21.25,5.1\nMean:,13.5,31.25,5.3\n")
    assert found.notes == [
        "2 rows are read as points and may be statistics of the others ('Min', 'Mean:', lines 7, "
        "8)."
    ]
    total = ",".join(f"{sum(float(row[k]) for row in NUMBERED):.6f}" for k in (1, 2, 3))
    found = survey(WITH_HEADER + f",{total}\n")
    assert found.notes == ["The last row (line 7) is the sum of all others, and read as a point."]


@pytest.mark.parametrize("line", ["Units;US Survey Feet", "# units: ft", "Unit = m"])
def test_a_unit_above_the_table_is_told(survey, line):
    found = survey(f"{line}\n{WITH_HEADER}")
    assert found.elevation_unit is None
    (note,) = found.notes
    assert note.startswith(f"Line 1 ('{line}') tells a unit")
    assert survey(f"United we stand\nUnits: many\n{WITH_HEADER}").notes == []


@pytest.mark.parametrize(
    ("line", "unit"),
    [
        ("# elevations in US survey feet", "US survey foot"),
        ("# Elevation unit: ft", "foot"),
        ("// Heights are given in metres", "metre"),
        ("# Höhen in m", "metre"),
        ("# elevations relative to the floor, in ft", None),
        ("# spacing 5 ft", None),
    ],
)
def test_a_line_that_gives_the_unit_of_elevations_is_followed(survey, line, unit):
    found = survey(f"{line}\n{WITH_HEADER}")
    assert (found.elevation_unit and found.elevation_unit.name) == unit
    assert bool(found.notes) == ("5 ft" not in line)
    if unit is not None:
        assert "gives the unit of the elevations" in found.notes[0]
        said = str(fault(survey, f"{line}\n{WITH_HEADER}", elevation_unit="cm"))
        assert "as the unit of the elevations, and the option `elevation_unit` another" in said


def test_geocentric_coordinates_are_no_eastings(survey):
    rows = "".join(f"{i},{630000.5 + i},{-5100000.5 + 2 * i},{3760000.25 - i}\n" for i in range(9))
    assert "geocentric" in str(fault(survey, "P,X,Y,Z\n" + rows))
    assert len(survey("P,E,N,Z\n" + rows)) == len(survey("P,X,Y,Z\n" + rows, columns="PXYZ")) == 9


def test_elevations_that_no_ground_has_are_refused_under_a_crs(survey):
    rows = "".join(f"{752000 + i}.5,{320 + i}.25,{4024000 + i}.75\n" for i in range(9))
    said = str(fault(survey, "E,N,Z\n" + rows, crs="EPSG:32616", check_crs=False))
    assert "`columns`" in said
    turned = survey("E,N,Z\n" + rows, columns="EZN", crs="EPSG:32616")
    assert turned.points[0].tolist() == [752000.5, 4024000.75, 320.25]


def test_white_space_of_any_kind_may_stand_around_a_number(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("7,\x1c3,\x1f-0\n8,4\x1d,5\n")
    found = read(path, columns="XYZ", skip_bad=True)
    assert found.points.tolist() == [[7, 3, 0], [8, 4, 5]]


def test_a_number_alone_of_thousands_of_digits_counts_no_points(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("9" * 5000 + "\n8,35.6,3\n7,4,5\n")
    found = read(path, columns="XYZ")
    assert found.points.tolist() == [[8, 35.6, 3], [7, 4, 5]]
    assert found.skipped == {"title lines": 1}
