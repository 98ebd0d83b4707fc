"""Beds of rivers: closed forms, a real survey with sections held out, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from fuzz.rivers import Course, examine_bed, generate_bed
from support.refusals import refuse

import tinsmith as ts

DATA = Path(__file__).parents[3] / "data" / "river"
UTM = {"crs": "EPSG:26916", "elevation_unit": "US survey foot"}
SHAPE = np.array([[10.0, 5], [6, 2], [4, 2], [0, 5]])
"""Offsets and elevations of a trapezoid, from left to right."""
AXIS = [[-5.0, 5.0], [105.0, 5.0]]


def make_section(x, fall=0.0, shape=SHAPE):
    return np.column_stack([np.full(len(shape), float(x)), shape[:, 0], shape[:, 1] - fall])


def channel(stations=(0, 40, 100), slope=0.01):
    return [make_section(x, slope * x) for x in stations]


def read_wabash():
    table = np.genfromtxt(DATA / "sections.csv", delimiter=",", skip_header=1)
    line = np.genfromtxt(DATA / "centreline.csv", delimiter=",", skip_header=1)
    return [table[table[:, 0] == k, 1:] for k in np.unique(table[:, 0])], line


def rms(tin, points):
    apart = tin.interpolate(points[:, :2]) - points[:, 2]
    return float(np.sqrt(np.nanmean(apart**2)))


# ---------------------------------------------------------------- closed forms


@pytest.mark.parametrize("spacing", [3.0, 7.5, 1000.0])
def test_prismatic_channel_with_an_even_slope_is_reproduced(spacing):
    bed = ts.riverbed(channel(), AXIS, spacing=spacing)
    x, y = np.random.default_rng(1).uniform([0, 0], [100, 10], (500, 2)).T
    wanted = np.interp(y, SHAPE[::-1, 0], SHAPE[::-1, 1]) - 0.01 * x
    assert np.abs(bed.interpolate(np.column_stack([x, y])) - wanted).max() < 1e-12
    assert bed.area == pytest.approx(1000.0)
    assert ts.check(bed).ok


def test_bent_prismatic_channel_is_reproduced_up_to_the_chords_of_its_steps():
    angle = np.linspace(0.0, np.pi / 2, 400)
    line = 50.0 * np.column_stack([np.sin(angle), np.cos(angle)])  # clockwise: left is outside
    sections = []
    for turn in np.linspace(0.0, np.pi / 2, 4):
        radius = 45.0 + SHAPE[:, 0]
        z = SHAPE[:, 1] - 0.01 * 50.0 * turn
        sections.append(np.column_stack([radius * np.sin(turn), radius * np.cos(turn), z]))
    errors = {}
    for spacing in (4.0, 1.0):
        bed = ts.riverbed(sections, line, spacing=spacing)
        draw = np.random.default_rng(1).uniform([0.01, 45.2], [1.56, 54.8], (500, 2))
        xy = draw[:, 1:] * np.column_stack([np.sin(draw[:, 0]), np.cos(draw[:, 0])])
        wanted = np.interp(draw[:, 1] - 45.0, SHAPE[::-1, 0], SHAPE[::-1, 1]) - 0.5 * draw[:, 0]
        errors[spacing] = float(np.abs(bed.interpolate(xy) - wanted).max())
    sagitta = 4.0**2 / (8 * 45.0)
    assert errors[4.0] < 1.5 * sagitta  # on a slope of 3 to 4
    assert errors[1.0] < 0.12 * errors[4.0]


def test_winding_channel_is_nearer_to_its_surface_than_the_tin_of_its_points():
    course = Course({"swing": 40.0, "wave": 60.0, "turn": 0.3, "origin": [5e5, 4e6]})

    def measure(station, offset):
        return 100 - 0.002 * station + 3 * (offset / 15) ** 2 - np.sin(station / 90) * offset / 15

    offsets = np.linspace(15, -15, 17)
    sections = [
        np.column_stack([course.places(np.full(17, s), offsets), measure(s, offsets)])
        for s in np.arange(20.0, 520.0, 50.0)
    ]
    line = course.places(np.linspace(0, 520, 300), np.zeros(300))
    bed = ts.riverbed(sections, line, spacing=4.0)
    plain = ts.triangulate(np.concatenate(sections))
    s, n = np.random.default_rng(2).uniform([25, -14], [465, 14], (3000, 2)).T
    known = np.column_stack([course.places(s, n), measure(s, n)])
    assert rms(bed, known) < 0.02
    assert rms(plain, known) > 5 * rms(bed, known)


def test_offsets_are_compared_between_thalweg_and_ends():
    left, right = np.array([[10.0, 5], [8, 1], [0, 5]]), np.array([[10.0, 5], [2, 1], [0, 5]])
    sections = [make_section(0, shape=left), make_section(40, shape=right)]
    along = ts.riverbed(sections, AXIS, spacing=5, thalweg=[[-1, 8.15], [41, 1.85]])
    assert along.interpolate([[20, 5]])[0] == pytest.approx(1.0)
    crossing = ts.riverbed(sections, AXIS, spacing=5)
    assert crossing.interpolate([[20, 5]])[0] > 2.4
    assert "thalweg" in along.lines.names


def test_banks_lie_on_their_lines():
    banks = [[[-1, 8], [20, 9], [101, 8]], [[-1, 2], [50, 3], [101, 2]]]
    bed = ts.riverbed(channel(), AXIS, spacing=10, banks=banks)
    places = dict(zip(bed.lines.names, bed.lines.chains(), strict=True))
    for name, line in (("left bank", banks[0]), ("right bank", banks[1])):
        xy = bed.points[places[name], :2]
        x, y = np.array(line, float).T
        assert np.abs(xy[:, 1] - np.interp(xy[:, 0], x, y)).max() < 0.02  # between are chords


def test_banks_at_the_ends_of_sections_leave_nothing_beyond():
    banks = [[[-1, 10], [101, 10]], [[-1, 0], [101, 0]]]
    bed = ts.riverbed(channel(), AXIS, spacing=10, banks=banks)
    assert bed.area == pytest.approx(1000.0)
    assert ts.check(bed).ok


def test_bank_beside_a_point_stays_beside_it_at_large_coordinates():
    move = np.array([5e5, 4e6, 0.0])
    y = 8.002
    banks = [[[5e5 - 1, 4e6 + y], [5e5 + 101, 4e6 + y]], [[5e5 - 1, 4e6 + 2], [5e5 + 101, 4e6 + 2]]]
    shape = np.array([[10.0, 5], [8, 1], [0, 5]])
    sections = [make_section(x, shape=shape) + move for x in (0, 100)]
    bed = ts.riverbed(sections, np.array(AXIS) + move[:2], spacing=50, banks=banks)
    chain = dict(zip(bed.lines.names, bed.lines.chains(), strict=True))["left bank"]
    assert np.abs(bed.points[chain, 2] - (1 + 0.002 * 2)).max() < 1e-6


# ---------------------------------------------------------------- a survey


def test_sections_of_a_survey_that_are_held_out_are_met_better_than_by_its_tin():
    sections, line = read_wabash()
    errors = []
    for k in range(1, len(sections) - 1):
        rest = [one for j, one in enumerate(sections) if j != k]
        bed = ts.riverbed(rest, line, spacing=10, omit_returns=True, **UTM)
        errors.append(
            [rms(bed, sections[k]), rms(ts.triangulate(np.concatenate(rest)), sections[k])]
        )
    own, plain = np.array(errors).T
    assert (own < 1.05 * plain).all()
    assert own.mean() < 0.8 * plain.mean()


def test_points_of_a_survey_stay_bit_for_bit():
    sections, line = read_wabash()
    bed = ts.riverbed(sections, line, spacing=10, omit_returns=True, **UTM)
    vertices = {tuple(one) for one in bed.points.tolist()}
    lost = [one for line in sections for one in line.tolist() if tuple(one) not in vertices]
    notes = " ".join(bed.report.notes)
    assert len(lost) == 1
    assert "goes back across the channel" in notes
    assert "1 point was left out" in notes


def test_a_wrong_shot_is_told_with_its_section_and_place():
    sections, line = read_wabash()
    plain = ts.riverbed(sections, line, spacing=50, omit_returns=True, **UTM)
    assert "blunder" not in " ".join(plain.report.notes)
    x, y = sections[2][20, :2]
    for elevation in (0.0, 5081.5):
        sections[2][20, 2] = elevation
        bed = ts.riverbed(sections, line, spacing=50, omit_returns=True, **UTM)
        [told] = [one for one in bed.report.notes if "looks like a blunder" in one]
        assert f"section 3, {x:.3f} {y:.3f} at elevation {elevation:g}" in told


# ---------------------------------------------------------------- what is given


def test_order_and_direction_of_sections_do_not_count_and_are_told():
    one, two, three = channel()
    plain = ts.riverbed([one, two, three], AXIS, spacing=10)
    other = ts.riverbed([two, one[::-1], three], AXIS, spacing=10)
    assert (plain.points == other.points).all()
    notes = " ".join(other.report.notes)
    assert "were sorted by it" in notes
    assert "Section 2: given from right to left" in notes


def test_line_that_is_drawn_upstream_is_told():
    bed = ts.riverbed(channel(), AXIS[::-1], spacing=10)
    assert "seems to run upstream" in " ".join(bed.report.notes)


def test_sections_beyond_the_centreline_prolong_it():
    bed = ts.riverbed(channel(), [[3, 5], [93, 5]], spacing=10)
    notes = " ".join(bed.report.notes)
    assert "beyond the start of the centreline, which was prolonged by 3" in notes
    refuse(
        "does not cross", ts.riverbed, channel(), [[30, 5], [60, 5]], spacing=9, error=ts.LinesError
    )


def test_points_are_grouped_by_a_column_and_sorted_across():
    rows = np.concatenate(channel())
    labels = np.repeat(["A", "B", "C"], 4).astype(object)
    order = np.array([0, 2, 1, 3, *range(4, 12)])
    rows = np.vstack([rows[order], [[50.0, 5, 5]], [[51, 5, 5]]])
    labels = np.append(labels, ["", "D"])
    survey = ts.Survey(points=rows, attributes={"code": labels}, crs="EPSG:32616")
    bed = ts.riverbed(survey, AXIS, spacing=10, by="code")
    notes = " ".join(bed.report.notes)
    assert "1 point without a section was left out" in notes
    assert "Sections of one point were left out: 'D'" in notes
    assert "sorted along the direction in which they spread most: 'A'" in notes
    assert bed.crs.label == "EPSG:32616"
    words = "there is 'code'"
    refuse(words, ts.riverbed, survey, AXIS, spacing=9, by="line", error=ts.OptionError)
    points = ts.Features.of_points(rows[:12], columns={"code": labels[:12]})
    assert len(ts.riverbed(points, AXIS, spacing=10, by="code").points) == len(bed.points)


def test_breaklines_of_a_survey_are_sections():
    lines = [ts.Breakline(one, name=f"XS{k}") for k, one in enumerate(channel())]
    points = np.vstack([*channel(), [[50.0, 5, 5]]])
    bed = ts.riverbed(ts.Survey(points=points, breaklines=lines), AXIS, spacing=10)
    assert "1 point that is on no section was left out" in " ".join(bed.report.notes)


def test_left_is_right_in_a_crs_with_mirrored_axes():
    for crs, is_turned in (("EPSG:2048", False), ("EPSG:2065", True)):  # south before west
        bed = ts.riverbed(channel(), AXIS, spacing=10, crs=crs)
        assert any("right to left" in one for one in bed.report.notes) == is_turned


BAD = {
    "one": (channel()[:1], "There is 1 cross section: 2 or more"),
    "meeting": ([make_section(0), [[-1, 8, 1], [1, 9, 1], [1, -4, 2]]], "meet at 0 8.5"),
    "flat": ([one[:, :2] for one in channel()], "without elevations"),
    "vertical": ([make_section(0), [[9, 8, 1], [9, 8, 2], [9, 2, 2]]], "is vertical at 9 8"),
    "beside": (
        [make_section(0), make_section(50) + np.array([0, 20, 0])],
        "does not cross the centreline",
    ),
    "itself": ([make_section(0), [[9, 8, 1], [9, 2, 2], [8, 4, 1], [10, 5, 1]]], "crosses itself"),
    "twice": ([make_section(0), [[9, 8, 1], [9, 2, 2], [12, 8, 1]]], "meets the centreline more"),
    "back": ([make_section(0), [[9, 8, 1], [9, 3, 2], [12, 4, 1]]], "give `omit_returns`"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_sections_are_refused(name):
    sections, words = BAD[name]
    refuse(words, ts.riverbed, sections, AXIS, spacing=5, error=ts.LinesError)


def test_bend_that_is_too_sharp_is_refused_with_its_place():
    line = [[-5, 5], [50, 5], [50, 60]]
    sections = [make_section(0), [[60, 50, 4], [40, 50, 4]]]
    wide = [one * [1, 1, 1] for one in map(np.array, sections)]
    assert ts.check(ts.riverbed(wide, line, spacing=5)).ok
    far = [[[0, 65, 5], [0, -65, 4]], [[-15, 70, 4], [110, 70, 4]]]
    line = [[-5, 5], [50, 5], [50, 75]]
    refuse("", ts.riverbed, far, line, spacing=2, error=ts.LinesError)


def test_options_and_references_are_checked():
    for spacing in (0, -1, np.nan, "a"):
        refuse("spacing", ts.riverbed, channel(), AXIS, spacing=spacing, error=ts.OptionError)
    refuse("spacing", ts.riverbed, channel(), AXIS, spacing=1e-7, error=ts.OptionError)
    lines = ts.Features.of_lines(
        np.concatenate(channel()), [0, 4, 8, 12], crs="EPSG:32616", elevation_unit="m"
    )
    bed = ts.riverbed(lines, AXIS, spacing=10)
    assert (bed.crs.label, bed.elevation_unit.symbol) == ("EPSG:32616", "m")
    line = ts.Features.of_lines(AXIS, [0, 2], crs="EPSG:32617")
    refuse("must be the same", ts.riverbed, lines, line, spacing=10, error=ts.CrsError)
    refuse("one CRS", ts.riverbed, lines, AXIS, spacing=9, crs="EPSG:32617", error=ts.CrsError)
    refuse("degrees", ts.riverbed, channel(), AXIS, spacing=9, crs="EPSG:4326", error=ts.CrsError)
    refuse(
        "elevation_unit", ts.riverbed, lines, AXIS, spacing=9, elevation_unit="ft",
        error=ts.OptionError,
    )  # fmt: skip


def test_progress_ascends_to_one():
    seen = []
    ts.riverbed(channel(), AXIS, spacing=10, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.parametrize("seed", range(12))
def test_random_beds_keep_their_sections_and_lie_between(seed):
    examine_bed(generate_bed(np.random.default_rng(seed)))
