"""Labels of points and spot heights: what they say, how large, where; and none hides another."""

from itertools import combinations

import ezdxf
import numpy as np
import pytest
import shapely
from support.printed import read_svg

import tinsmith as ts
from tinsmith.terrain.plans.point_labels import find_peaks

EAST, NORTH = 500_000.0, 4_000_000.0
ORIGIN = np.array([EAST, NORTH])
CORNERS = np.array([[0, 0, 5], [40, 0, 6], [40, 30, 7], [0, 30, 9]]) + np.array([*ORIGIN, 0])
PLANE = np.array([[0, 0, 10], [100, 0, 20], [100, 60, 26], [0, 60, 16]]) + np.array([*ORIGIN, 0])


def survey(points=CORNERS, **attributes):
    named = {name: np.array(values) for name, values in attributes.items()}
    return ts.Survey(points=points, attributes=named, crs="EPSG:32616")


def draw(given, folder, **how):
    tin = ts.triangulate(given)
    made = ts.plan(tin, survey=given, labels="none", **how)
    return made, read_svg(made.save(folder / "plan.svg")[0])


def texts(page, name):
    return [text.text for text in page.named(name)]


@pytest.mark.parametrize("words", ["numbers,elevations,codes", " codes, elevations ,numbers"])
def test_labels_say_several_things_from_the_top_down(words, tmp_path):
    given = survey(number=["P1", "P2", "P3", "P4"], description=["EP", "TOE", "", "RDG"])
    _, page = draw(given, tmp_path, points=words)
    assert texts(page, "point-number") == ["P1", "P2", "P3", "P4"]
    assert texts(page, "point-elevation") == ["5", "6", "7", "9"]
    assert texts(page, "point-code") == ["EP", "TOE", "RDG"]
    for number, elevation in zip(
        page.named("point-number"), page.named("point-elevation"), strict=True
    ):
        assert number.place[0] == pytest.approx(elevation.place[0])
        assert number.place[1] > elevation.place[1]


def test_a_code_goes_before_a_description(tmp_path):
    given = survey(code=["A", "B", "C", "D"], description=["w", "x", "y", "z"])
    assert texts(draw(given, tmp_path, points="codes")[1], "point-code") == ["A", "B", "C", "D"]


@pytest.mark.parametrize(("decimals", "wanted"), [(0, "7"), (1, "7.0"), (4, "7.0000")])
def test_decimals_are_those_asked_for(decimals, wanted, tmp_path):
    how = {"points": "elevations", "decimals": decimals, "spots": 20.0}
    _, page = draw(survey(), tmp_path, **how)
    assert wanted in texts(page, "point-elevation")
    assert {len(one.partition(".")[2]) for one in texts(page, "spot-elevation")} == {decimals}


def test_no_elevation_is_minus_zero(tmp_path):
    low = CORNERS - [0, 0, 5.001]
    _, page = draw(survey(low), tmp_path, points="elevations", decimals=1)
    assert texts(page, "point-elevation")[0] == "0.0"


@pytest.mark.parametrize("size", [0.8, 1.8, 3.5])
def test_digits_have_the_height_asked_for(size, tmp_path):
    _, page = draw(survey(), tmp_path, points="elevations", label_size=size)
    sizes = [one.size * 0.73 for one in page.named("point-elevation")]
    assert sizes == pytest.approx([size] * 4, abs=0.01)


def test_spot_heights_are_the_surface_at_multiples_of_their_spacing(tmp_path):
    made, page = draw(survey(PLANE), tmp_path, spots=25.0, scale=1000)
    wanted = [(x, y) for y in (50, 25, 0) for x in (0, 25, 50, 75, 100)]
    assert texts(page, "spot-elevation") == [f"{10 + x / 10 + y / 10:.2f}" for x, y in wanted]
    middles = np.array([one.mean(axis=0) for one in page.paths["spots"]])[::2]
    frame = np.array(page.frame)
    ground = (middles - (frame[:2] + frame[2:]) / 2) + [EAST + 50, NORTH + 30]
    assert ground == pytest.approx(np.array(wanted) + ORIGIN, abs=0.01)
    assert "spot height" in texts(page, "legend")
    assert not any("left out" in note for note in made.notes)


def test_spot_heights_at_points(tmp_path):
    places = [[EAST + 10, NORTH + 10], [EAST + 70, NORTH + 20]]
    gathered = ts.Features.of_points(np.array(places), columns={}, crs="EPSG:32616")
    for given in (places, gathered):
        _, page = draw(survey(PLANE), tmp_path, spots=given)
        assert texts(page, "spot-elevation") == ["12.00", "19.00"]


def test_peaks_and_pits_are_those_a_plain_search_finds(tmp_path):
    rng = np.random.default_rng(5)
    xy = rng.uniform(0, 100, (300, 2)) + ORIGIN
    z = 300 + 5 * np.sin(xy[:, 0] / 9) * np.cos(xy[:, 1] / 9) + rng.normal(0, 0.2, 300)
    tin = ts.triangulate(np.column_stack([xy, z]), crs="EPSG:32616")
    around = {}
    for triangle in tin.triangles.tolist():
        for one in triangle:
            around.setdefault(one, set()).update(set(triangle) - {one})
    rim = set(np.concatenate(tin.boundary).tolist())
    heights = tin.points[:, 2]
    wanted = {
        one for one, near in around.items()
        if one not in rim and (heights[one] > heights[list(near)].max()
                               or heights[one] < heights[list(near)].min())
    }  # fmt: skip
    found = find_peaks(tin)
    assert {tuple(one) for one in found} == {tuple(tin.points[one, :2]) for one in wanted}
    assert len(wanted) > 10
    made = ts.plan(tin, spots="peaks", scale=500, labels="none")
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    highest = max(heights[list(wanted)])
    assert f"{highest:.2f}" in texts(page, "spot-elevation")


def test_labels_hide_neither_each_other_nor_points_and_those_left_out_are_counted(tmp_path):
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.uniform(0, 90, (250, 2)) + ORIGIN, rng.uniform(5, 9, 250)])
    given = survey(points.round(2), number=np.arange(250))
    made, page = draw(given, tmp_path, points="both", spots=15.0, paper="A4", grid="none")
    written = page.named("point-number")
    assert f"{250 - len(written)} labels of points were left out" in " ".join(made.notes)
    spots = page.named("spot-elevation")
    assert 0 < len(spots) == len(page.paths["spots"]) // 2
    # marks are crosses of 1.4 mm; digits are at least 0.55 of the size wide and 0.7 high
    crosses = np.array([one.mean(axis=0) for one in (*page.paths["points"], *page.paths["spots"])])
    crosses = shapely.box(*(crosses - 0.35).T, *(crosses + 0.35).T)
    beside = (*written, *page.named("point-elevation"), *spots)
    boxes = []
    for one in beside:
        width, (x, y) = 0.55 * one.size * len(one.text), one.place
        x -= width if one.anchor == "end" else 0.0
        boxes.append(shapely.box(x, y, x + width, y + 0.7 * one.size))
    for box in boxes:
        assert not shapely.intersects(crosses, box).any()
    for one, other in combinations(boxes, 2):
        assert not shapely.area(shapely.intersection(one, other)) > 1e-9


def test_a_drawing_of_one_sheet_lies_at_its_own_coordinates(tmp_path):
    given = survey(PLANE, number=["P1", "P2", "P3", "P4"])
    tin = ts.triangulate(given)
    made = ts.plan(tin, survey=given, points="numbers", spots=25.0, label_size=2.5, scale=500)
    document = ezdxf.readfile(made.save(tmp_path / "a.dxf")[0])
    assert not document.audit().errors
    space = document.modelspace()
    marks = [np.array(one.get_points("xy")) for one in space.query('LWPOLYLINE[layer=="POINTS"]')]
    middles = np.unique(np.round([one.mean(axis=0) for one in marks], 6), axis=0)
    assert middles == pytest.approx(np.unique(PLANE[:, :2], axis=0), abs=1e-6)
    for text in space.query('TEXT[layer=="POINT_NUMBERS"]'):
        place = PLANE[int(text.dxf.text[1]) - 1, :2]
        assert np.hypot(*(np.array(text.dxf.align_point or text.dxf.insert)[:2] - place)) < 2.0
        assert text.dxf.height == pytest.approx(2.5 * 0.5)
    spots = space.query('TEXT[layer=="SPOT_HEIGHTS"]')
    assert f"{15 - len(spots)} spot heights were left out" in " ".join(made.notes)
    rim = [np.array(one.get_points("xy")) for one in space.query('LWPOLYLINE[layer=="OUTLINE"]')]
    assert np.concatenate(rim).max(axis=0) == pytest.approx([EAST + 100, NORTH + 60], abs=1e-6)
    contours = space.query('LWPOLYLINE[layer=="CONTOURS"]')
    level = {round(float(tin.interpolate(*one.get_points("xy")[0])), 6) for one in contours}
    assert all(abs(one / made.interval - round(one / made.interval)) < 1e-5 for one in level)


def test_sheets_of_a_drawing_lie_side_by_side(tmp_path):
    tin = ts.triangulate(PLANE, crs="EPSG:32616")
    made = ts.plan(tin, layout="rows", scale=200, paper="A4")
    document = ezdxf.readfile(made.save(tmp_path / "a.dxf")[0])
    assert len(made) > 2
    titles = [one for one in document.modelspace().query("TEXT") if "Sheet" in one.dxf.text]
    places = [one.dxf.insert[0] for one in titles]
    assert np.diff(places) == pytest.approx((made.paper[0] + 20) * 0.2)


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ({"points": "names"}, "none, marks, both, or some of numbers, elevations, codes"),
        ({"points": "numbers,numbers"}, "Invalid points 'numbers,numbers'"),
        ({"points": "numbers,"}, "Invalid points"),
        ({"points": "marks,numbers"}, "Invalid points"),
        ({"points": ""}, "Invalid points"),
        ({"points": None}, "Invalid points None"),
        ({"points": "codes"}, "where there is no survey with codes of points"),
        ({"label_size": 0.1}, "Invalid label_size 0.1: it must be a finite number from 0.5 to 20"),
        ({"label_size": "x"}, "Invalid label_size 'x'"),
        ({"decimals": -1}, "Invalid decimals -1: it must be a whole number from 0 to 9"),
        ({"decimals": 1.5}, "Invalid decimals 1.5"),
        ({"spots": 0}, "Invalid spots 0: it must be a spacing > 0."),
        ({"spots": -3.0}, "Invalid spots -3.0"),
        ({"spots": float("nan")}, "Invalid spots nan: it must be a spacing > 0."),
        ({"spots": "summits"}, "Invalid spots 'summits': it must be a spacing, 'peaks', or points"),
        ({"spots": 1e-3}, "so large that there are at most 100,000 spot heights."),
        ({"spots": 1e-320}, "at most 100,000 spot heights"),
    ],
)
def test_options_that_cannot_be_are_refused(how, sentence):
    tin = ts.triangulate(CORNERS, crs="EPSG:32616")
    with pytest.raises(ts.OptionError) as raised:
        ts.plan(tin, **how)
    assert sentence in str(raised.value)


def test_spot_heights_outside_the_surface_or_in_another_crs_are_refused():
    tin = ts.triangulate(CORNERS, crs="EPSG:32616")
    with pytest.raises(ts.PointsError, match="1 of 2 points for spot heights lies outside"):
        ts.plan(tin, spots=[[EAST + 1, NORTH + 1], [0, 0]])
    other = ts.Features.of_points(np.array([[EAST, NORTH]]), columns={}, crs="EPSG:32617")
    with pytest.raises(ts.CrsError):
        ts.plan(tin, spots=other)
    with pytest.raises(ts.PointsError, match="There is no point for spot heights"):
        ts.plan(tin, spots=np.empty((0, 2)))


def test_a_spacing_wider_than_the_surface_makes_no_spot_height(tmp_path):
    _, page = draw(survey(), tmp_path, spots=1e9)
    assert page.named("spot-elevation") == []
    assert "spot height" not in texts(page, "legend")


def test_notes_of_points_for_spot_heights_reach_the_plan():
    tin = ts.triangulate(CORNERS, crs="EPSG:32616")
    given = ts.Features.of_points(CORNERS[:, :2] + [[1, 1], [-1, 1], [-1, -1], [1, -1]], columns={})
    noted = given.with_notes(["One row was left out."])
    assert "One row was left out." in ts.plan(tin, spots=noted).notes
