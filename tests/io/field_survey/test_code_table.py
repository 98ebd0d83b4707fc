"""Tables of field codes: what each kind does, and one sentence for each fault of a table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import lines_from_codes
from tinsmith.io.field_survey.code_table import read_code_table

TABLES = Path(__file__).parents[3] / "sample_data" / "codes"


def survey(*descriptions):
    n = len(descriptions)
    points = np.column_stack([np.arange(n) * 3.0, np.arange(n) ** 2 % 7, np.arange(n) + 5.0])
    return ts.Survey(
        points=points,
        attributes={"description": np.array(descriptions, object), "number": np.arange(n) + 101},
    )


def make(table, *descriptions, **options):
    return lines_from_codes(survey(*descriptions), code_table=table, **options)


def test_each_kind_becomes_what_it_says():
    kinds = ("hard", "soft", "boundary", "hole", "erase", "water", "building", "contour")
    for kind in kinds:
        made = make({"codes": {"XY": kind}}, "XY1", "XY1", "XY1", "XY1 C")
        rings = {
            "boundary": made.boundary,
            "hole": made.holes,
            "erase": made.erase,
            "water": made.water,
        }
        if kind in rings:
            assert [len(one) for name, one in rings.items() if name == kind] == [1]
            assert len(made.breaklines) == 0
        else:
            (line,) = made.breaklines
            assert line.kind == ("soft" if kind in ("soft", "contour") else "hard")
            assert len(line.coords) == 5
    told = make({"codes": {"XY": "contour"}}, "XY1", "XY1").notes
    assert "1 contour line has several elevations (XY1: point 101, point 102)." in told


def test_points_are_points_and_excluded_ones_are_left_out():
    table = {"codes": {"EP": "hard", "GS": "point", "CP": "exclude"}}
    made = make(table, "EP1", "GS", "CP1 NAIL", "EP1 CP", "CP CP")
    assert len(made.breaklines) == 1
    assert made.attributes["number"].tolist() == [101, 102, 104]
    assert made.skipped == {"points not for the surface": 2}
    assert [f.kind for f in made.findings] == []
    only = make(table, "CP1", "GS", "GS", "GS")
    assert (len(only.points), only.has_lines) == (3, False)


def test_unknown_codes_are_findings_with_their_rows():
    made = make({"codes": {"EP": "hard"}}, "EP1", "MH 12", "EP1", "mh3", "", "TR OAK")
    found = [(one.kind, one.rows) for one in made.findings]
    assert found == [("unknown code", (1, 3)), ("unknown code", (5,))]
    assert "2 codes are not in the code table (MH: point 102, point 104, TR: point 106)" in str(
        made.notes
    )
    assert len(made.points) == 6


def test_rings_are_closed_by_their_rule():
    table = {"codes": {"BLDG": {"kind": "building", "closed": True}, "SHED": "building"}}
    made = make(table, "BLDG1", "BLDG1", "BLDG1", "SHED1", "SHED1", "SHED1")
    house, shed = made.breaklines
    assert np.array_equal(house.coords[0], house.coords[-1])
    assert len(shed.coords) == 3
    kinds = {one.kind for one in made.findings}
    assert kinds == {"open figure", "open building"}


def test_upper_and_lower_case():
    assert len(make({"codes": {"ep": "hard"}}, "EP1", "ep1 e").breaklines) == 1
    exact = {"case": "exact", "codes": {"ep": "hard", "EP": "soft"}}
    made = make(exact, "EP1", "ep1", "EP1", "ep1 E", "ep1 e")
    assert [one.kind for one in made.breaklines] == ["soft", "hard"]
    assert [len(one.coords) for one in made.breaklines] == [2, 2]


def test_own_words_and_letters():
    table = {
        "separators": "-",
        "comments": "#",
        "marks": {"begin": "A", "end": ["Z", "STOP"], "begin_curve": "ARC", "end_curve": "LIN"},
        "codes": {"12": "hard", "K": "hard", "K_L": "hard"},
    }
    rows = ("12-1-A", "12 1", "12-1-STOP # end, of 'it'", "12 1", "12 1 Z", "K_L2", "K_L2")
    made = make(table, *rows)
    assert [(one.name, len(one.coords)) for one in made.breaklines] == [
        ("121", 3),
        ("121", 2),
        ("K_L2", 2),
    ]


def test_words_before_the_code():
    table = {"place": "before", "codes": {"EP": "hard", "FL": "hard"}}
    made = make(table, "BEG EP1", "EP1 BEG FL1", "END EP 1 FL1", "EP1", "EP1")
    assert [(one.name, len(one.coords)) for one in made.breaklines] == [
        ("EP1", 3),
        ("FL1", 2),
        ("EP1", 2),
    ]


def test_the_longest_code_wins():
    table = {"codes": {"EP": "hard", "EP1": "soft", "T2A": "soft"}}
    made = make(table, "EP1", "EP1", "EP2", "EP2", "T2A3", "T2A3")
    assert [(one.name, one.kind) for one in made.breaklines] == [
        ("EP1", "soft"),
        ("EP2", "hard"),
        ("T2A3", "soft"),
    ]


def test_arc_tolerances_of_table_and_code():
    def count(table, **options):
        made = make(table, "EP1 BC", "EP1", "EP1 EC", **options)
        return len(made.breaklines[0].coords)

    wide = count({"arc_tolerance": 0.5, "codes": {"EP": "hard"}})
    fine = count({"arc_tolerance": 0.5, "codes": {"EP": {"kind": "hard", "arc_tolerance": 0.001}}})
    assert wide < fine
    assert count({"arc_tolerance": 0.5, "codes": {"EP": "hard"}}, arc_tolerance=0.001) == fine


@pytest.mark.parametrize("path", sorted(TABLES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_tables_of_the_samples_are_sound(path):
    table = read_code_table(path)
    assert len(table.rules) >= 8
    assert any(rule.kind == "exclude" for rule in table.rules.values())
    style = None if table.style is None else table.style.name
    assert (style or path.stem).split(" ")[0] == path.stem


# ------------------------------------------------------------------ faults


def refused(content, words, tmp_path):
    path = tmp_path / "codes.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ts.ReadError, match=words) as caught:
        read_code_table(path)
    message = str(caught.value)
    assert str(path) in message
    assert "\n" not in message
    assert message.endswith(".")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "codes is missing, and it must be a table of codes"),
        ("codes = 3", "codes is 3, and it must be a table"),
        ("[codes]", "codes is {}, and it must be a table"),
        ("[code]\nEP='hard'", "unknown key 'code'; allowed are style, case"),
        ("[codes]\nEP='breakline'", "codes.EP is 'breakline', and it must be one of hard, soft"),
        ("[codes]\nEP=1", "codes.EP is 1, and it must be one of hard.* or a table"),
        ("[codes]\nEP={}", "codes.EP.kind is missing, and it must be one of hard"),
        ("[codes]\nEP={kind='hard', sort=1}", "unknown key 'codes.EP.sort'; allowed are kind"),
        ("[codes]\nEP={kind='hard', closed='yes'}", "codes.EP.closed is 'yes'.* true or false"),
        ("[codes]\nEP={kind='hard', description=2}", "codes.EP.description is 2.* a text"),
        ("[codes]\nEP={kind='hard', arc_tolerance=0}", "codes.EP.arc_tolerance is 0.* above 0"),
        ("arc_tolerance=nan\n[codes]\nEP='hard'", "arc_tolerance is nan"),
        ("arc_tolerance=true\n[codes]\nEP='hard'", "arc_tolerance is True"),
        (f"arc_tolerance=1{'0' * 400}\n[codes]\nEP='hard'", "arc_tolerance is 2"),
        ("[codes]\nEP='hard'\nep='soft'", "a code is 'ep'.* there once"),
        ("[codes]\n'E P'='hard'", "a code is 'E P'.* a word of up to 64 letters without"),
        ("style='civil'\n[codes]\nEP='hard'", "style is 'civil', and it must be one of words"),
        ("case='any'\n[codes]\nEP='hard'", "case is 'any', and it must be one of ignore, exact"),
        ("place='over'\n[codes]\nEP='hard'", "place is 'over'.* one of behind, before"),
        ("style='civil3d'\n[codes]\nC='hard'", "a code is 'C'.* it says 'continue'"),
        ("separators='x'\n[codes]\nEP='hard'", "separators is 'x'.* letters out of"),
        ("separators=[1]\n[codes]\nEP='hard'", "separators is .1.* letters out of"),
        ("separators='-'\ncomments='-'\n[codes]\nEP='hard'", "comments is '-'.* other letters"),
        ("marks=1\n[codes]\nEP='hard'", "marks is 1.* a table of begin"),
        ("[marks]\nstart='B'\n[codes]\nEP='hard'", "unknown key 'marks.start'; allowed are begin"),
        ("[marks]\nbegin=3\n[codes]\nEP='hard'", "marks.begin is 3.* a word, or a list"),
        ("[marks]\nbegin='B'\nend='b'\n[codes]\nEP='hard'", "marks.end is 'b'.* says 'begin'"),
        ("[marks]\nbegin=''\n[codes]\nEP='hard'", "marks.begin is ''.* a word"),
        ("[codes\nEP='hard'", "is no TOML: .*line 1"),
        ("EP='hard'\nEP='soft'\nA=1", "is no TOML: .*line 2"),
        ("a=" + "[" * 5_000, "is no TOML"),
        (b"[codes]\nEP='\xff'", "is not UTF-8 text"),
        (b"\x00\x01\x02", "is no TOML"),
    ],
)
def test_a_fault_of_a_table_is_one_sentence(content, words, tmp_path):
    refused(content, words, tmp_path)


def test_a_table_that_is_not_there(tmp_path):
    with pytest.raises(ts.ReadError, match=r"Cannot read '.*none\.toml': No such file"):
        read_code_table(tmp_path / "none.toml")
    with pytest.raises(ts.ReadError, match="Cannot read"):
        read_code_table(tmp_path)
    with pytest.raises(
        ts.OptionError, match=r"Invalid rules .* left out where there is a `code_tab"
    ):
        make({"codes": {"EP": "hard"}}, "EP1", "EP1", rules={"EP": "hard"})


def test_a_byte_order_mark_is_no_part_of_a_table(tmp_path):
    path = tmp_path / "codes.toml"
    path.write_bytes(b"\xef\xbb\xbf[codes]\r\nEP = 'hard'\r\n")
    assert read_code_table(path).rules["EP"].kind == "hard"
