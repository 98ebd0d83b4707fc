"""Lines from survey codes: marks begin, end and close them, and faults are named by point."""

import csv
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import lines_from_codes
from tinsmith.io.field_survey.field_codes import RULES
from tinsmith.io.field_survey.styles import MARKS

SAMPLE = Path(__file__).parents[3] / "sample_data" / "site_survey.csv"


def survey(*descriptions, numbers=None, z=None):
    n = len(descriptions)
    points = np.column_stack([np.arange(n) * 3.0, np.arange(n) ** 2 % 7, np.full(n, 5.0)])
    if z is not None:
        points[:, 2] = z
    attributes = {"description": np.array(descriptions, object)}
    if numbers is not None:
        attributes["number"] = np.array(numbers)
    return ts.Survey(points=points, attributes=attributes)


def lines(*descriptions, **given):
    """Return names and the rows of their vertices."""
    found = lines_from_codes(survey(*descriptions, **given)).breaklines
    return [(line.name, (line.coords[:, 0] / 3).astype(int).tolist()) for line in found]


def refused(words, *descriptions, rules=None, **given):
    with pytest.raises(ts.LinesError, match=words) as caught:
        lines_from_codes(survey(*descriptions, **given), rules)
    assert str(caught.value).endswith(".")


def test_a_line_for_each_code_and_number():
    found = lines("EP1", "EP2", "GS", "EP1", "EP2", "TR OAK", "CL1", "CL1")
    assert found == [("EP1", [0, 3]), ("EP2", [1, 4]), ("CL1", [6, 7])]


def test_marks_begin_and_end_lines_of_one_name():
    found = lines("EP1 B", "EP1", "EP1 E", "EP1 BEG", "EP1", "EP1 B", "EP1 end")
    assert found == [("EP1", [0, 1, 2]), ("EP1", [3, 4]), ("EP1", [5, 6])]


def test_a_closed_line_comes_back_to_its_first_point():
    assert lines("BLDG2 BEG", "BLDG2", "BLDG2", "BLDG2 CLS") == [("BLDG2", [0, 1, 2, 3, 0])]


@pytest.mark.parametrize("mark", MARKS)
def test_every_mark_is_understood_in_either_case(mark):
    rows = {"begin": ("EP1", f"EP1 {mark}"), "end": ("EP1 B", "EP1", f"EP1 {mark}")}
    rows["close"] = rows["end"]
    descriptions = [text.lower() for text in rows[MARKS[mark]]]
    if MARKS[mark] == "begin":
        descriptions += [*descriptions[:1], "EP1"]
        assert len(lines("EP1", *descriptions)) == 2
    else:
        (only,) = lines(*descriptions)
        assert only[1] == ([0, 1, 2, 0] if MARKS[mark] == "close" else [0, 1, 2])


@pytest.mark.parametrize(
    "description",
    [
        *("EP 1", "ep1", "EP1 'CRACKED'", 'EP1 "BROKEN KERB"', "EP1, SEALED", "EP1 / SEE SKETCH"),
        *("EP1 (OLD)", "EP1 ; X", " EP1 ", "EP1\tB", "EP1 BEG/NOTE", 'EP1 B "NOTE"', "EP1 B NOTE"),
    ],
)
def test_spaces_case_and_notes(description):
    assert lines(description, "EP1") == [("EP1", [0, 1])]


def test_other_codes_are_no_lines():
    assert lines("EPX1", "EP1A", "CP1", "GS 12", "", "EP1", "EP1") == [("EP1", [5, 6])]


def test_the_order_is_that_of_the_point_numbers():
    assert lines("EP1", "EP1 E", "EP1 B", numbers=[20, 30, 10]) == [("EP1", [2, 0, 1])]
    assert lines("EP1", "EP1", numbers=["B7", "A9"]) == [("EP1", [0, 1])]


def test_water_is_level_at_the_median_of_its_points():
    given = survey("WE1", "WE1", "WE1", "WE1 CLS", z=[4.9, 5.0, 5.1, 9.0])
    made = lines_from_codes(given)
    assert [(water.name, water.z) for water in made.water] == [("WE1", 5.05)]
    assert np.array_equal(made.water[0].ring, given.points[:, :2])
    assert "5.050, the median of its 4 points (4.900 to 9.000)" in made.notes[0]
    assert made.points is given.points


@pytest.mark.parametrize("role", ["boundary", "hole", "erase", "water", "soft"])
def test_rules_choose_what_a_line_becomes(role):
    given = survey("XY1 B", "XY1", "XY1 C", "EP1", "EP1")
    made = lines_from_codes(given, {"xy": role})
    if role == "soft":
        assert [(line.kind, len(line.coords)) for line in made.breaklines] == [("soft", 4)]
        return
    assert len(made.breaklines) == 0
    ring = {
        "boundary": made.boundary,
        "hole": made.holes,
        "erase": made.erase,
        "water": [water.ring for water in made.water],
    }[role][0]
    assert np.array_equal(ring, given.points[:3, : ring.shape[1]])


def test_lines_are_added_to_those_that_there_are():
    once = lines_from_codes(survey("EP1", "EP1", "WE1", "WE1", "WE1"))
    twice = lines_from_codes(once)
    assert (len(twice.breaklines), len(twice.water)) == (2, 2)


def test_faults_are_counted_and_named_by_point():
    refused("No description begins with a line code: RDG", "GS", "TR")
    with pytest.raises(ts.OptionError, match=r"Invalid rules {'W': 'wall'}: .* one of hard, soft"):
        lines_from_codes(survey("W1"), {"W": "wall"})


def warned(words, *descriptions, **given):
    """Return names and vertex counts of the lines, and require one note with the words."""
    before = survey(*descriptions, **given)
    made = lines_from_codes(before)
    (note,) = made.notes
    assert re.search(words, note)
    assert note.endswith(".")
    assert made.points is before.points
    return [(line.name, len(line.coords)) for line in made.breaklines]


def test_lines_of_too_few_points_are_left_out_and_named():
    words = "1 line is left out, which has too few points .EP1: point 7."
    assert warned(words, "EP1 B", "GS", numbers=[7, 8]) == []
    words = "2 lines are left out, which have too few points .EP1: row 0, EP2: row 1."
    assert warned(words, "EP1", "EP2", "CL1", "CL1") == [("CL1", 2)]
    assert warned("WE1: row 0, row 1", "WE1", "WE1") == []
    words = "BLDG1: row 0, row 1.: a line needs two, a closed one three"
    assert warned(words, "BLDG1", "BLDG1 C") == []


def test_unknown_marks_are_remarks_and_named():
    words = "2 unknown marks .* .'Q' at point 3, 'STOP' at point 4."
    assert warned(words, "EP1 Q", "EP1 STOP", numbers=[3, 4]) == [("EP1", 2)]
    assert warned("1 unknown mark behind .* is taken for", "EP1 Q", "EP1") == [("EP1", 2)]


def test_a_survey_without_descriptions():
    with pytest.raises(ts.LinesError, match="no descriptions"):
        lines_from_codes(ts.Survey(points=np.zeros((3, 3))))


# -------------------------------------------------------------------------- the sample


@pytest.fixture(scope="module")
def sample():
    return lines_from_codes(ts.read(SAMPLE, crs="EPSG:32616"))


def coded_rows():
    """Read the sample's rows by name of their line, with nothing of tinsmith."""
    rows = {}
    with SAMPLE.open(encoding="utf-8", newline="") as file:
        for number, north, east, z, description in list(csv.reader(file))[1:]:
            found = re.match(r"([A-Z]+)(\d+)\b", description)
            if found and found[1] in RULES:
                place = (int(number), float(east), float(north), float(z), description)
                rows.setdefault(found[0], []).append(place)
    return rows


def test_the_sample_has_the_lines_of_its_codes(sample):
    rows = coded_rows()
    for line in sample.breaklines:
        expected = [row[1:4] for row in sorted(rows[line.name])]
        if line.name.startswith("BLDG"):
            expected.append(expected[0])
        assert np.array_equal(line.coords, expected)
    assert {line.name for line in sample.breaklines} | {"WE1"} == set(rows)
    (pond,) = sample.water
    assert pond.z == pytest.approx(np.median([row[3] for row in rows["WE1"]]))
    assert pond.z == pytest.approx(318.4, abs=0.01)


def test_every_step_of_the_sample_s_lines_is_an_edge(sample):
    tin = ts.triangulate(sample)
    edges = {frozenset(edge) for edge in tin.edges.tolist()}
    place = {(x, y): i for i, (x, y) in enumerate(tin.points[:, :2].tolist())}
    steps = 0
    for line in sample.breaklines:
        vertices = [place[x, y] for x, y in line.coords[:, :2].tolist()]
        for step in pairwise(vertices):
            assert frozenset(step) in edges
            steps += 1
    assert steps == 446
    assert ts.check(tin, points=sample).ok


def test_the_pond_of_the_sample_is_flat(sample):
    tin = ts.triangulate(sample)
    level = sample.water[0].z
    inside = sample.water[0].ring.mean(axis=0) + np.random.default_rng(3).uniform(-9, 9, (50, 2))
    assert (tin.interpolate(inside) == level).all()
    soundings = np.array([d == "BOT" for d in sample.attributes["description"]])
    assert (tin.vertex_of[soundings] == -1).all()
    assert tin.report.to_dict()["left_out"] == {"in water": np.flatnonzero(soundings).tolist()}


def test_lines_are_made_of_a_survey_by_rules():
    with pytest.raises(ts.OptionError, match=r"^Invalid survey \{\}: it must be a Survey\.$"):
        lines_from_codes({})
    survey = ts.Survey(points=np.zeros((3, 3)))
    with pytest.raises(ts.OptionError, match=r"^Invalid rules \[0, 1\]: it must be a mapping"):
        lines_from_codes(survey, [0, 1])


# ------------------------------------------------------------------ the order of shots


def two_crews(**given):
    """Two crews number their shots from 1; each surveys the edge of pavement 1."""
    codes = ["EP1 BEG", "EP1", "EP1 END"]
    points = [[x, y, 5.0] for y in (0.0, 7.0) for x in (0.0, 8.0, 16.0)]
    made = ts.Survey(
        points=points,
        attributes={
            "description": np.array(codes * 2, object),
            "number": np.array([1, 2, 3, 1, 2, 3]),
        },
    )
    return ts.lines_from_codes(made, **given)


def test_repeated_numbers_of_two_crews_are_refused_until_the_order_is_said():
    with pytest.raises(ts.LinesError, match=r"3 numbers .*first: 1.*option `shot_order"):
        two_crews()
    found = two_crews(shot_order="row").breaklines
    assert [one.coords[:, 0].tolist() for one in found] == [[0, 8, 16], [0, 8, 16]]
    (zigzag,) = two_crews(shot_order="number").breaklines
    assert zigzag.coords[:, 1].tolist() == [7, 0, 7, 0]
    with pytest.raises(ts.OptionError, match="number, row"):
        two_crews(shot_order="file")


def test_repeated_numbers_that_change_no_line_are_no_doubt():
    made = ts.Survey(
        points=[[0, 0, 5], [4, 0, 6], [9, 1, 6], [3, 3, 7]],
        attributes={
            "description": np.array(["EP1 BEG", "EP1", "EP1 END", "GS"], object),
            "number": np.array([1, 2, 2, 1]),
        },
    )
    assert len(ts.lines_from_codes(made).breaklines) == 1


def test_shots_without_marks_whose_line_crosses_itself_are_refused():
    rng = np.random.default_rng(2)
    made = ts.Survey(
        points=rng.random((40, 3)) * 100,
        attributes={"description": np.array(["RDG"] * 40, object)},
    )
    with pytest.raises(ts.LinesError, match=r"40 shots of the code RDG .*crosses itself"):
        ts.lines_from_codes(made)
    (line,) = ts.lines_from_codes(made, shot_order="row").breaklines
    assert len(line.coords) == 40


def test_a_marked_line_that_crosses_itself_is_told():
    made = ts.Survey(
        points=[[0, 0, 1], [9, 9, 1], [9, 0, 1], [0, 9, 1]],
        attributes={"description": np.array(["EP1 BEG", "EP1", "EP1", "EP1 END"], object)},
    )
    (finding,) = ts.lines_from_codes(made).findings
    assert finding.kind == "line that crosses itself"


def shoot(places, numbers=None, *, marks=True, **given):
    """Read one line of shots along the first axis."""
    codes = ["EP1"] * len(places)
    if marks:
        codes[0], codes[-1] = "EP1 BEG", "EP1 END"
    attributes = {"description": np.array(codes, object)}
    if numbers is not None:
        attributes["number"] = np.array(numbers)
    points = [[x, 0.1 * k, 5.0] for k, x in enumerate(places)]
    return ts.lines_from_codes(ts.Survey(points=points, attributes=attributes), **given)


def test_a_marked_line_that_jumps_is_told():
    (finding,) = shoot([0, 1, 2, 3, 50, 51]).findings
    assert (finding.kind, finding.rows) == ("line that jumps", (3, 4))
    assert shoot([0, 1, 2, 3, 9, 10]).findings == []
    assert shoot([0, 1, 30]).findings == []  # too few to say what is usual


def test_shots_without_marks_in_groups_far_apart_are_refused():
    for places in ([0, 1, 2, 100, 101, 102], [0, 1, 2, 100, 101, 102, 200, 201]):
        with pytest.raises(ts.LinesError, match=r"EP1 have no mark .* in groups .* apart"):
            shoot(places, marks=False)
        (line,) = shoot(places, marks=False, shot_order="row").breaklines
        assert len(line.coords) == len(places)


def test_a_line_that_jumps_in_one_order_alone_is_refused():
    numbers = [10 * k for k in range(30)]
    numbers[25] = 35  # the shot at 25 between those at 3 and 4
    with pytest.raises(ts.LinesError, match="jumps in the order of numbers and not in that of ro"):
        shoot(range(30), numbers)
    (line,) = shoot(range(30), numbers, shot_order="row").breaklines
    assert line.coords[:, 0].tolist() == list(range(30))
    assert shoot(range(30), numbers, shot_order="number").findings[0].kind == "line that jumps"


def test_unknown_codes_with_marks_of_lines_are_told():
    codes = ["EP1 BEG", "EP1 END", "FENCE1 BEG", "FENCE1", "FENCE1 END", "EPP5 BEG", "GS", "TREE 7"]
    made = ts.Survey(
        points=np.random.default_rng(1).random((len(codes), 3)),
        attributes={"description": np.array(codes, object)},
    )
    found = {one.sentence.split(": ")[1]: one.rows for one in ts.lines_from_codes(made).findings}
    assert found == {"FENCE": (2, 3, 4), "EPP": (5,)}
