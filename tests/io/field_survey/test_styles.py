"""Styles of field codes: the same figures in each, found out, told, and refused in doubt."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import lines_from_codes
from tinsmith.io.field_survey.styles import STYLES


def survey(*descriptions, numbers=None):
    n = len(descriptions)
    points = np.column_stack([np.arange(n) * 3.0, np.arange(n) ** 2 % 7, np.full(n, 5.0)])
    attributes = {"description": np.array(descriptions, object)}
    if numbers is not None:
        attributes["number"] = np.array(numbers)
    return ts.Survey(points=points, attributes=attributes)


def lines(*descriptions, **options):
    """Return names and the rows of their vertices."""
    found = lines_from_codes(survey(*descriptions), **options).breaklines
    return [(one.name, (one.coords[:, 0] / 3).round(9).tolist()) for one in found]


def notes(*descriptions, **options):
    return " ".join(lines_from_codes(survey(*descriptions), **options).notes)


def refused(words, *descriptions, **options):
    with pytest.raises(ts.TinsmithError, match=words) as caught:
        lines_from_codes(survey(*descriptions), **options)
    assert str(caught.value).endswith(".")


TWO = [("EP1", [0, 1, 2]), ("EP1", [3, 4])]


@pytest.mark.parametrize(
    ("style", "begin", "end"),
    [
        ("dash", "EP1-B", "EP1-E"),
        ("dash", "EP-1-BEG", "EP-1-END"),
        ("dash", "EP1 -B", "EP1 -E"),
        ("dot", "EP1.B", "EP1.E"),
        ("dot", "EP1 .B", "EP1 .E"),
        ("star", "EP1*", "EP1"),
        ("star", "EP1 *", "EP 1"),
        ("carlson", "EP1 +7", "EP1 -7"),
        ("carlson", "EP1+7", "EP1-7"),
        ("cg", "EP1 BL", "EP1 EL"),
    ],
)
def test_a_style_is_found_out_and_told(style, begin, end):
    rows = (begin, "EP1", end, begin, "EP1")
    assert lines(*rows) == TWO
    assert f"in the style '{style}'" in notes(*rows)
    assert lines(*rows, code_style=style) == TWO
    assert "in the style" not in notes(*rows, code_style=style)


@pytest.mark.parametrize(
    ("style", "begin", "end"),
    [
        ("slash", "EP1/B", "EP1/E"),
        ("civil3d", "EP1 B", "EP1 E"),
        ("trimble", "EP1 ST", "EP1 END"),
        ("leica", "EP1 N", "EP1"),
        ("leica", "EP1 -N", "EP1"),
        ("star-end", "EP1", "EP1 *"),
    ],
)
def test_a_style_that_is_named_is_used(style, begin, end):
    assert lines(begin, "EP1", end, begin, "EP1", code_style=style) == TWO


def test_the_note_counts_what_makes_no_sense_in_both_styles():
    """A figure that ends without a beginning is odd in any style."""
    sound = ("EP1 BL", "EP1", "EP1 EL", "EP1 BL", "EP1")
    assert "none in 'cg'" in notes(*sound)
    odd = notes(*sound, "FL7")  # a line of one shot
    assert "in the style 'cg'" in odd
    assert "none in 'cg'" not in odd
    assert " in 'words', 1 in 'cg'." in odd


def test_a_slash_parts_words_or_begins_a_remark_and_is_refused():
    rows = ("EP1/B", "EP1", "EP1/E", "EP1/B", "EP1")
    refused("two styles, 'words' and 'slash'.*EP1 of 5 shots.*the option `code_style`", *rows)
    assert lines(*rows, code_style="words") == [("EP1", [0, 1, 2, 3, 4])]
    assert lines(*rows, code_style="slash") == TWO


def test_a_slash_is_a_doubt_whatever_else_is_odd():
    for rows in (("EP1/B", "EP1", "EP1/E", "EP1"), ("EP1/B", "EP1", "CL1", "EP1/E", "EP1", "EP1")):
        refused("two styles, 'words' and 'slash'", *rows)


def test_a_remark_behind_a_slash_is_no_doubt():
    for remark in ("EP1 / SEE SKETCH", "EP1/SEALED", "EP1 / E SIDE", "EP1/END OF SEAL"):
        assert lines(remark, "EP1", "EP1") == [("EP1", [0, 1, 2])], remark


def test_a_star_at_both_ends_is_refused():
    refused("'star' and 'star-end'", "EP1 *", "EP1", "EP1 *")
    assert lines("EP1 *", "EP1", "EP1", "EP1 *", "EP1", code_style="star-end") == [
        ("EP1", [1, 2, 3])
    ]


def test_the_letter_c_closes_a_line_at_its_end_and_continues_it_before():
    assert lines("EP1 B", "EP1", "EP1", "EP1 C") == [("EP1", [0, 1, 2, 3, 0])]
    rows = ("EP1 B", "EP1 C", "EP1", "EP1 E")
    assert lines(*rows) == [("EP1", [0, 1, 2, 3])]
    assert "style 'civil3d'" in notes(*rows)


def test_the_letter_x_closes_excludes_or_extends():
    rows = ("BLDG1", "BLDG1", "BLDG1", "BLDG1 X")
    assert lines(*rows) == [("BLDG1", [0, 1, 2, 3, 0])]
    made = lines_from_codes(survey(*rows), code_style="leica")
    assert len(made.points) == 3
    assert made.skipped == {"points not for the surface": 1}
    assert lines(*rows, code_style="leica") == [("BLDG1", [0, 1, 2])]
    told = notes("EP1", "EP1", "EP1 X10.5", code_style="civil3d")
    assert "1 mark is known and not applied ('X10.5' at row 2)" in told


def test_short_words_that_may_be_remarks_do_not_make_a_style():
    rows = ("EP1 N", "EP1", "EP1 N", "EP1 S", "EP1")
    assert lines(*rows) == [("EP1", [0, 1, 2, 3, 4])]
    assert "3 unknown marks" in notes(*rows)
    doubtful = ("EP1 N", "EP1", "EP1 N", "EP1")
    refused("two styles, 'leica' and 'words'", *doubtful)
    assert lines(*doubtful, code_style="words") == [("EP1", [0, 1, 2, 3])]


def test_several_codes_of_one_shot():
    rows = ("EP1 FL1", "EP1 FL1", "EP1", "FL1")
    assert lines(*rows) == [("EP1", [0, 1, 2]), ("FL1", [0, 1, 3])]
    rows = ("EP1 B FL1 B", "EP1 FL1 E", "EP1 E")
    assert lines(*rows) == [("EP1", [0, 1, 2]), ("FL1", [0, 1])]
    assert lines("EP FL", "EP FL", "FL", "EP") == [("EP", [0, 1, 3]), ("FL", [0, 1, 2])]
    assert lines("EP 1 FL 2", "EP 1 FL 2") == [("EP1", [0, 1]), ("FL2", [0, 1])]


def test_a_code_that_may_be_a_remark_is_told():
    rows = ("EP1", "EP1 WALL", "EP1 WALL", "EP1")
    assert lines(*rows) == [("EP1", [0, 1, 2, 3]), ("WALL", [1, 2])]
    assert "1 code stands behind others only" in notes(*rows)
    assert "WALL" not in notes("EP1", "EP1 SEE WALL", "EP1 'WALL'", "EP1, WALL")


def test_a_line_ends_where_the_next_begins():
    assert lines("EP1 B", "EP1", "EP1 E B", "EP1", "EP1 E") == [
        ("EP1", [0, 1, 2]),
        ("EP1", [2, 3, 4]),
    ]


def test_a_number_beside_the_code_is_a_whole_number():
    assert lines("EP 12", "EP 12", "EP 7", "EP 7") == [("EP12", [0, 1]), ("EP7", [2, 3])]
    told = notes("EP 1.5 WIDE", "EP", code_style="words")
    assert "'1.5' at row 0" in told
    assert lines("EP 1.5 WIDE", "EP", code_style="words") == [("EP", [0, 1])]


def test_an_unknown_style_is_refused():
    refused("Invalid code_style 'civil': it must be one of words, dash", "EP1", code_style="civil")
    assert set(STYLES) == set(ts.base.policies.CodeStyle.__args__)


# ------------------------------------------------------------------ findings


def kinds(*descriptions, **options):
    made = lines_from_codes(survey(*descriptions), **options)
    return [(one.kind, one.rows) for one in made.findings]


@pytest.mark.parametrize(
    ("rows", "kind", "at"),
    [
        (("EP1 E", "CL1", "CL1"), "end without a begin", (0,)),
        (("EP1", "CL1", "CL1"), "too few points", (0,)),
        (("EP1 B", "EP1", "CL1 B", "CL1 E"), "line without an end", (0, 1)),
        (("EP1", "EP1 BC", "EP1"), "curve of too few points", (1, 2)),
        (("EP1", "EP1 EC", "EP1"), "end of no curve", (1,)),
        (("EP1 BC", "EP1", "EP1"), "curve without an end", (0, 1, 2)),
        (("EP1 PC", "EP1 PT"), "curve without a leg", (0, 1)),
        (("WE1", "WE1", "WE1", "WE1"), "open figure", (0, 3)),
        (("EP1 Q", "EP1"), "unknown mark", (0,)),
    ],
)
def test_findings_name_their_rows(rows, kind, at):
    assert (kind, at) in kinds(*rows)


def test_a_point_shot_twice_is_taken_once():
    given = survey("EP1", "EP1", "EP1", "EP1", numbers=[7, 8, 9, 10])
    given.points[2] = given.points[1]
    made = lines_from_codes(given)
    assert len(made.breaklines[0].coords) == 3
    assert ("repeated point", (1, 2)) in [(one.kind, one.rows) for one in made.findings]
    assert "EP1: point 8, point 9" in " ".join(made.notes)


def test_findings_reach_the_report(tmp_path):
    made = lines_from_codes(survey("EP1", "EP1", "CL1", "GS"))
    assert made.findings[0].to_dict() == {
        "kind": "too few points",
        "rows": [2],
        "sentence": "Too few points: CL1: row 2.",
    }


def test_marks_before_their_codes_are_told():
    told = notes("B EP1", "EP1", "EP1", "E EP1", "ST FL", "FL", "FL", "B the gate", "C")
    assert (
        "3 marks stand before their codes and are not read (B EP1: row 0, E EP1: row 3, ST FL: "
        'row 4): place = "before" in a code table reads them.'
    ) in told
    assert "before" not in notes("EP1 B", "EP1", "EP1 E", "C GS", "B12")
    table = {"place": "before", "codes": {"EP": "hard", "FL": "hard"}}
    assert "marks stand" not in notes("B EP1", "EP1", "E EP1", code_table=table)
