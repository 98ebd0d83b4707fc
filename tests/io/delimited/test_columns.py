"""Which column means what, by header and by the caller's word: names, units, notes, refusals."""

from __future__ import annotations

import pytest

from tinsmith.base.errors import OptionError
from tinsmith.io import ReadError
from tinsmith.io.delimited import columns

ROLES = {
    "easting": "Easting EAST e X x_coord POINT_X Rechtswert RW este grid-easting utm.x lon",
    "northing": "Northing NORTH n Y y_coord POINT_Y Hochwert HW norte grid-northing Breite",
    "elevation": "Elevation Elev EL Z z_value POINT_Z RL Höhe hoehe H altitude cota kote Alt level",
    "number": "Point PT PointNo pt_id P No. nr ID name Punktnummer # fid",
    "description": "Description Desc CODE feature_code D remarks Bemerkung código note type",
}
OTHERS = ["intensity", "red", "classification", "time", "gridz", "quality", "date", "x2", "zz"]


@pytest.mark.parametrize("role", ROLES)
def test_names_say_what_a_column_means(role):
    for name in ROLES[role].split():
        assert columns.find_role(name) == role, name
        assert columns.find_role(f" {name} ") == role, name


@pytest.mark.parametrize("name", ["Elev (ft)", "elev_us_ft", "Elev US-ft", "ELEV.m", "Elev [m]"])
def test_a_unit_is_no_part_of_a_name(name):
    assert columns.find_role(name) == "elevation"


def test_other_names_say_nothing():
    assert [columns.find_role(name) for name in (*OTHERS, "", "x" * 300)] == [None] * (
        len(OTHERS) + 2
    )
    assert columns.find_role("e" + " " * 199) == "easting"
    assert columns.find_role("e" + " " * 200) is None  # some other text


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("Elevation (USft)", "USft"), ("elev_ft", "ft"), ("Height (NAVD88)", None), ("Z [m]", "m"),
        ("N (US survey feet)", "US survey feet"), ("E US_ft", "US_ft"), ("elev_us_ft", "us_ft"),
        ("Z us ft", "us ft"), ("Elev ( m )", "m"),
        ("ft", None), ("m", None), ("(m)", "m"), ("Z (NAVD88) (ft)", "ft"), ("Soft", None),
        ("Z.m", "m"), ("Z-intft", "intft"), ("Z metres", "metres"), ("Z (inch)", None),
        ("Z (FT.)", "FT."), ("Z (yd)", "yd"), ("depth fathoms", "fathoms"),
        ("Z" + " " * 196 + "(m)", "m"), ("Z" + " " * 197 + "(m)", None),
    ],
)  # fmt: skip
def test_units_stand_in_brackets_or_behind_a_name(name, unit):
    assert columns.find_unit_word(name) == unit


TWO_PAIRS = "The header names two pairs of coordinates: {} are taken, {} are not."
HEIGHTS = "The header's 'Z' is taken as the elevation, not {}."


@pytest.mark.parametrize(
    ("header", "word", "notes"),
    [
        ("E N Z", "ENZ", []),
        ("X Y E N Z", "--ENZ", [TWO_PAIRS.format("'E' and 'N'", "'X' and 'Y'")]),
        ("East North RL x y", "ENZ", [TWO_PAIRS.format("'East' and 'North'", "'x' and 'y'")]),
        ("N Este Norte Cota", "PENZ", []),
        ("N° Est Nord Altitude", "PENZ", []),
        ("N. RW HW H", "PENZ", []),
        ("N# E N Z", "PENZ", []),
        ("E Easting Northing Z", "-ENZ", []),
        ("Pkt Rechts Hoch NHN Libellé", "PENZD", []),
        ("№ Øst Nord Høyde", "PENZ", []),
        ("Y X Z", "NEZ", []),
        ("N E Z", "NEZ", []),
        ("N X Y Z", "PENZ", []),
        ("No N X Y Z", "P-ENZ", []),
        ("N Y X Z D", "PNEZD", []),
        ("E N Z Height", "ENZ", [HEIGHTS.format("'Height'")]),
        ("Height E N Z", "-ENZ", [HEIGHTS.format("'Height'")]),
        (
            "Lon Lat Elev Easting Northing",
            "--ZEN",
            [TWO_PAIRS.format("'Easting' and 'Northing'", "'Lon' and 'Lat'")],
        ),
        ("P N E Z D", "PNEZD", []),
        ("a E N Z b", "-ENZ", []),
    ],
)
def test_a_header_names_the_columns_and_what_it_leaves_open_is_told(header, word, notes):
    found = columns.find_columns_by_header(header.split())
    assert found.word == word
    assert list(found.notes) == notes
    assert not found.is_degrees


@pytest.mark.parametrize("header", ["E N Northing Z", "n;e;nord;z", "Easting E N Z"])
def test_n_and_e_beside_another_northing_or_easting_are_refused(header):
    with pytest.raises(ReadError, match=r"several columns for the (north|east)ing \('.', '.*'\)"):
        columns.find_columns_by_header(header.replace(";", " ").split())


def test_letters_of_other_alphabets_are_no_blanks():
    assert [columns.find_role(name) for name in ("«ø±ê", "Zд", "東N", "Xé", "é")] == [
        *(None, None, None, None, "easting")
    ]


@pytest.mark.parametrize("name", ["Z (pieds)", "Z (')", "Z (sdev)", "-Z", "Z2", "Geoid height"])
def test_a_name_with_words_that_are_not_known_is_no_coordinate(name):
    assert columns.find_columns_by_header(["E", "N", name]) is None
    assert columns.find_columns_by_header(["E", "N", name, "H"]).word == "EN-Z"
    told = columns.describe_doubts(["E", "N", name])
    assert f"'{name}' is not taken as the elevation" in told
    assert "columns='ENZ'" in told


@pytest.mark.parametrize(
    ("header", "word"),
    [
        ("X (Northing);Y (Easting);Z", "NEZ"),
        ("X(N);Y(E);H", "NEZ"),
        ("X [m];Y [m];Elev (ft NAVD88)", "ENZ"),
        ("Easting / Rechtswert;Northing / Hochwert;Höhe (NHN)", "ENZ"),
        ("E (UTM 32N);N (UTM 32N);Height (EGM96)", "ENZ"),
        ("Easting (local);Northing (local);E;N;H", "--ENZ"),
        ("X;Y;Z;Easting;Northing;Height", "---ENZ"),
        ("Lat;Lon;Height;E;N;Level", "---ENZ"),
        ("E;sE;N;sN;Z;sZ", "E-N-Z"),
        ("Lat (N);Lon (E);Alt", "NEZ"),
        ("E;N;Height (instrument);RL", "EN-Z"),
    ],
)
def test_every_word_of_a_name_counts(header, word):
    assert columns.find_columns_by_header(header.split(";")).word == word


@pytest.mark.parametrize(
    "header",
    [
        *("X;Y;Z;E;N", "East;North;x;y;H", "Height;E;N;Z;RL", "E;N;Z;Elevation", "E;N;H;Height"),
        *("E (local);N (local);E (grid);N (grid);Z", "E;N;Z;Easting;Northing;Elevation"),
        *("E (UTM);N (UTM);Z (local)", "Z;E;N;Height;X;Y", "Station;Offset;Z;N;E;H"),
    ],
)
def test_coordinates_of_several_groups_are_refused(header):
    with pytest.raises(ReadError):
        columns.find_columns_by_header(header.split(";"))


@pytest.mark.parametrize("header", ["E N", "X Z q", "Lon N Z", "E Lat Z", "", "P D"])
def test_a_header_without_three_coordinates_names_none(header):
    assert columns.names_coordinates(header.split()) is None


def test_longitude_and_latitude_are_degrees():
    found = columns.find_columns_by_header(["Lat", "Long", "Alt"])
    assert found.is_degrees
    assert found.coordinates == [1, 0, 2]
    assert columns.find_columns_by_word("x,y,z", ["Long", "Lat", "Z"], 3).is_degrees
    assert not columns.find_columns_by_word("x,y,z", ["Long", "North", "Z"], 3).is_degrees
    assert columns.find_columns_by_word("lon,lat,z", [], 3).is_degrees
    assert not columns.find_columns_by_word("ENZ", [], 3).is_degrees
    named = {"easting": 2, "northing": 1, "elevation": 3}
    assert columns.find_columns_by_word(named, ["Lat", "Lon", "h"], 3).is_degrees
    assert not columns.find_columns_by_word(named, [], 3).is_degrees


def test_units_stand_in_the_header_or_below_it():
    units = {"easting": "ft", "elevation": "m"}
    assert columns.find_columns_by_header(["E (ft)", "N", "Z"], ["", "", "(m)"]).units == units
    assert (
        columns.find_columns_by_word("ENZ", ["E (ft)", "N", "Z"], 3, ["ft", "q", "[m]"]).units
        == units
    )
    assert columns.find_columns_by_header(["E", "N", "Z"], ["m"]).units == {"easting": "m"}
    assert columns.find_columns_by_header(["E", "N", "Z"]).units == {}


def test_units_that_contradict_each_other_are_refused():
    with pytest.raises(ReadError, match=r"in ft .* and the line below it in m"):
        columns.find_columns_by_header(["E", "N", "Z (ft)"], ["", "", "m"])
    assert columns.find_columns_by_header(["E", "N (m)", "Z (feet)"], ["m", "m", "ft"]).units


def test_equal_names_of_a_coordinate_are_refused():
    header = ["E", "N", "Z", "z (m)", "e"]
    with pytest.raises(ReadError) as caught:
        columns.find_columns_by_header(header)
    assert str(caught.value) == (
        "the header has 2 columns named 'E' for the easting: say with the option `columns` which "
        "is meant."
    )
    assert columns.names_coordinates(header).word == "ENZ"  # it is a header nonetheless


# ---------------------------------------------------------------- the caller's word


@pytest.mark.parametrize(
    ("word", "header", "count", "letters", "names"),
    [
        ("PNEZD", [], 5, "PNEZD", "number northing easting elevation description"),
        ("pnezd", [], 6, "PNEZD", "number northing easting elevation description column_6"),
        ("-xyz", [], 4, "-ENZ", "column_1 easting northing elevation"),
        ("XYH", ["a", "b", "c"], 3, "ENZ", "a b c"),
        ("x,y,z,intensity", [], 4, "ENZ", "easting northing elevation intensity"),
        (["z", "n", "e"], [], 3, "ZNE", "elevation northing easting"),
        ({"easting": "A", "northing": 1, "elevation": 3}, ["b", "a", "c"], 3, "NEZ", "b a c"),
        ({"x": 1, "y": 2, "z": 3, "number": 4}, [], 4, "ENZP", None),
    ],
)
def test_columns_by_the_callers_word(word, header, count, letters, names):
    found = columns.find_columns_by_word(word, header, count)
    assert found.word == letters
    if names is not None:
        assert found.names == tuple(name.replace("_", " ") for name in names.split())
    assert len(found.names) == count


def test_the_caller_may_contradict_the_header_which_is_told():
    found = columns.find_columns_by_word("NEZ", ["E", "N", "Z"], 3)
    assert found.notes == (
        "The option `columns` takes 'E' as the northing and 'N' as the easting, "
        "against the header.",
    )
    assert columns.find_columns_by_word("ENZ", ["E", "N", "Z"], 3).notes == ()
    assert columns.find_columns_by_word("ENZ", ["a", "b", "c"], 3).notes == ()
    assert columns.find_columns_by_word("ENZD", ["E", "N"], 4).notes == ()
    three = columns.find_columns_by_word("NZE", ["E", "N", "Z"], 3).notes[0]
    assert "'E' as the northing, 'Z' as the easting and 'N' as the elevation" in three or (
        three.count("'") == 6
    )


NO_LAYOUT = "Invalid columns '{}': it must be a layout {}."
MISSING = (
    "Invalid columns '{}': it must be letters (P number, N northing, E easting, Z elevation, "
    "D description, X easting, Y northing, - other) or names that say which column is the {}."
)


@pytest.mark.parametrize(
    ("word", "header", "count", "sentence"),
    [
        (
            "NEZE",
            [],
            4,
            NO_LAYOUT.format("NEZE", "that does not name the easting twice"),
        ),
        ("EN", [], 3, MISSING.format("EN", "elevation")),
        ("P", [], 3, MISSING.format("P", "easting, northing and elevation")),
        (
            "ENZD",
            [],
            3,
            NO_LAYOUT.format("ENZD", "of the 3 columns of the file, not of 4 columns"),
        ),
        (
            {"colour": 1},
            [],
            3,
            "Invalid columns 'colour': it must be one of easting, northing, elevation, number, "
            "description.",
        ),
        (
            {"easting": 4, "northing": 2, "elevation": 3},
            [],
            3,
            "Invalid columns 4: it must be a column from 1 to 3.",
        ),
        (
            {"easting": 0, "northing": 2, "elevation": 3},
            [],
            3,
            "Invalid columns 0: it must be a column from 1 to 3.",
        ),
        (
            {"easting": 1, "northing": 1, "elevation": 3},
            [],
            3,
            "Invalid columns {'easting': 1, 'northing': 1, 'elevation': 3}: it must be a layout "
            "that takes no column twice: column 1 is easting and northing.",
        ),
        (
            {"easting": "q", "northing": 2, "elevation": 3},
            ["a", "b", "c"],
            3,
            "Invalid columns 'q': it must be the name of one column, and no columns have it: "
            "the header has a, b, c.",
        ),
        (
            {"easting": "A", "northing": 2, "elevation": 3},
            ["a", "a", "c"],
            3,
            "Invalid columns 'A': it must be the name of one column, and 2 columns have it: "
            "the header has a, a, c.",
        ),
        (
            {"easting": "q", "northing": 2, "elevation": 3},
            [],
            3,
            "Invalid columns 'q': it must be the name of one column, and no columns have it: "
            "the file has no header.",
        ),
    ],
)
def test_words_that_fit_no_table_are_refused(word, header, count, sentence):
    with pytest.raises(OptionError) as caught:
        columns.find_columns_by_word(word, header, count)
    assert str(caught.value) == sentence


def test_letters_and_names_are_told_apart():
    assert columns.list_meanings("PNEZD") == [
        "number",
        "northing",
        "easting",
        "elevation",
        "description",
    ]
    assert columns.list_meanings("-H") == ["", "elevation"]
    assert columns.list_meanings("x,Q ,z") == ["easting", "Q", "elevation"]
    assert columns.list_meanings(["PN", "N"]) == ["PN", "northing"]


# ------------------------------------------------------------------- for sentences


def test_names_are_shortened_and_listed_to_a_limit():
    assert columns.shorten("x" * 40) == "x" * 40
    assert columns.shorten("x" * 41) == "x" * 40 + "..."
    assert columns.list_names(["a"] * 12) == ", ".join("a" * 12)
    assert columns.list_names(["a"] * 13) == ", ".join("a" * 12) + ", ..."


@pytest.mark.parametrize(
    ("names", "count", "unique"),
    [
        (["a", "b"], 2, ["a", "b"]),
        ([" a", "", "a"], 4, ["a", "column 2", "a (2)", "column 4"]),
        (["a", "a", "a"], 3, ["a", "a (2)", "a (3)"]),
        (["a", "b"], 1, ["a"]),
        (["column 2", ""], 2, ["column 2", "column 2 (2)"]),
    ],
)
def test_every_column_has_a_name_of_its_own(names, count, unique):
    assert list(columns.name_columns(names, count)) == unique


def test_columns_are_named_in_sentences():
    roles = {"easting": 1, "northing": 2, "elevation": 3, "number": 0}
    found = columns.Columns(("id", "column 2", "", "N" * 50, "red"), roles)
    assert [found.label(k) for k in range(4)] == [
        *("column 1 ('id')", "column 2", "column 3"),
        f"column 4 ('{'N' * 40}...')",
    ]
    assert found.coordinates == [1, 2, 3]
    assert found.layout == "number, easting, northing, elevation, red"
    assert found.word == "PENZ"
    turned = found.permute([2, 0, 1])
    assert turned.coordinates == [3, 1, 2]
    assert turned.roles["number"] == 0
    assert turned.word == "PNZE"
