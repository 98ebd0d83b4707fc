"""Rows and strips: every place is on a sheet, and match lines say where it goes on."""

import numpy as np
import pytest
import shapely
from support.printed import georeference, read_pdf, read_svg

import tinsmith as ts


def corridor(length=2000.0, width=40.0, sway=400.0, turns=7.0, angle=0.0, steps=300):
    """A road that winds about its way, with a breakline in the middle."""
    t = np.linspace(0, 1, steps)
    middle = np.column_stack([length * t, sway * np.sin(turns * t)])
    along = np.gradient(middle, axis=0)
    along /= np.hypot(*along.T)[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    turn = np.radians(angle)
    matrix = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])

    def place(offset, z):
        return np.column_stack([(middle + offset * across) @ matrix + [500000, 4e6], z])

    heights = 300 + 20 * t + np.sin(30 * t)
    rows = [place(offset, heights - abs(offset) / 10) for offset in (-width / 2, 0, width / 2)]
    ring = np.concatenate([rows[0], rows[2][::-1]])[:, :2]
    tin = ts.triangulate(
        np.concatenate(rows),
        boundary=[ring],
        breaklines=[rows[1]],
        crs="EPSG:32616",
        elevation_unit="m",
    )
    return tin, rows[1][:, :2]


def outline(tin):
    return shapely.union_all(
        [shapely.Polygon(tin.points[triangle, :2]) for triangle in tin.triangles]
    )


def uncovered(tin, made):
    frames = shapely.union_all([shapely.Polygon(frame) for frame in made.frames[1:]])
    return shapely.difference(outline(tin), frames.buffer(1e-6)).area


@pytest.mark.each_value
@pytest.mark.parametrize(
    "shape",
    [
        {},
        {"sway": 0.0},
        {"sway": 0.0, "angle": 33.0},
        {"angle": 100.0},
        {"length": 900.0, "sway": 250.0, "turns": 3.0},
        {"length": 20_000.0, "sway": 0.0, "angle": 70.0},
    ],
)
@pytest.mark.parametrize("layout", ["rows", "strips"])
def test_sheets_cover_the_whole_surface(shape, layout):
    tin, _ = corridor(**shape)
    made = ts.plan(tin, scale=1000, layout=layout)
    assert len(made) > 2
    assert uncovered(tin, made) == 0.0


def test_strips_of_a_straight_corridor_are_few_and_lie_along_it():
    tin, _ = corridor(length=20_000.0, sway=0.0, angle=-30.0)
    made = ts.plan(tin, scale=1000, layout="strips")
    alone = 392 - 16  # metres of ground on a sheet of A3 at 1:1000, less its overlaps
    assert len(made) - 1 <= np.ceil(20_000 / alone) + 2
    for frame in made.frames[1:]:
        east, north = frame[1] - frame[0]
        assert np.degrees(np.arctan2(north, east)) == pytest.approx(-30.0, abs=1e-6)


def test_strips_follow_a_given_axis_in_its_direction():
    tin, axis = corridor()
    made = ts.plan(tin, scale=1000, layout="strips", axis=axis[::-1])
    first, last = (made.frames[k].mean(axis=0) for k in (1, -1))
    assert first[0] > last[0]  # it goes from east to west
    assert uncovered(tin, made) == 0.0


@pytest.mark.parametrize("layout", [pytest.param("rows", marks=pytest.mark.slow), "strips"])
def test_every_sheet_is_true_to_scale_however_it_is_turned(layout, tmp_path):
    tin, _ = corridor()
    made = ts.plan(tin, scale=1000, layout=layout, interval=0.5)
    labels = 0
    for file, frame in list(zip(made.save(tmp_path / "road.svg"), made.frames, strict=True))[1:]:
        page = read_svg(file)
        ground = georeference(page)
        left, low, right, top = page.frame
        corners = [(left, low), (right, low), (right, top), (left, top)]
        assert ground.units_per_mm == pytest.approx((1.0, 1.0), rel=1e-4)
        assert ground.to_ground(corners) == pytest.approx(frame, abs=0.05)
        for label in page.named("contour-label"):
            assert -90.0 < (label.rotation + 180.0) % 360.0 - 180.0 <= 90.0
            up = np.radians(label.rotation + 90.0)
            center = label.place + 0.36 * label.size * np.array([np.cos(up), np.sin(up)])
            found = tin.interpolate(ground.to_ground(center))[0]
            assert abs(found - float(label.text)) < 0.25
            labels += 1
    assert labels > 10


@pytest.mark.slow
def test_north_arrows_point_north_on_turned_sheets(tmp_path):
    tin, _ = corridor()
    made = ts.plan(tin, scale=1000, layout="strips")
    angles = set()
    for file in made.save(tmp_path / "road.svg")[1:]:
        page = read_svg(file)
        ground = georeference(page)
        arrow = page.paths["north-arrow-outline"][0]
        tip, foot = arrow[0], arrow[2]
        east, north = np.subtract(*ground.to_ground([tip, foot]))
        assert abs(east) < 1e-3 * north
        angles.add(round(float(np.arctan2(*(tip - foot)[::-1])), 3))
    assert len(angles) > 3


@pytest.mark.slow
def test_match_lines_are_the_same_on_both_sheets(tmp_path):
    tin, _ = corridor()
    made = ts.plan(tin, scale=1000, layout="strips")
    found = {}
    for number, file in enumerate(made.save(tmp_path / "road.svg"), 1):
        page = read_svg(file)
        if number == 1:
            assert "match-lines" not in page.paths
            assert {text.text for text in page.named("sheet-number")} == {
                str(k) for k in range(2, len(made) + 1)
            }
            continue
        ground = georeference(page)
        names = page.named("match-label")
        assert len(names) == len(page.paths["match-lines"])
        for line, name in zip(page.paths["match-lines"], names, strict=True):
            other = int(name.text.removeprefix("Match line: sheet "))
            assert abs(other - number) == 1
            ends = shapely.LineString(ground.to_ground(line))
            found.setdefault(frozenset((number, other)), []).append(ends)
    assert len(found) == len(made) - 2
    for one, other in found.values():
        assert shapely.hausdorff_distance(one, other) < 400  # they are clipped to their frames
        assert one.distance(other.interpolate(0.5, normalized=True)) < 0.1
        assert one.crosses(outline(tin)) or one.intersects(outline(tin))


@pytest.mark.slow
def test_a_pdf_has_a_page_for_each_sheet(tmp_path):
    tin, _ = corridor()
    made = ts.plan(tin, scale=1000, layout="strips", paper="A4")
    (file,) = made.save(tmp_path / "road.pdf")
    pages = read_pdf(file)
    assert len(pages) == len(made)
    for number, page in enumerate(pages, 1):
        assert f"Sheet {number} of {len(made)}" in [text.text for text in page.texts]


@pytest.mark.slow
def test_files_of_several_sheets_have_numbers(tmp_path):
    tin, _ = corridor(length=5000.0, sway=0.0)
    made = ts.plan(tin, scale=500, layout="strips", paper="A4")
    names = [file.name for file in made.list_files(tmp_path / "road.png")]
    assert names[0] == "road-01.png"
    assert names[-1] == f"road-{len(made)}.png"


def test_one_sheet_that_is_enough_has_no_index():
    tin, _ = corridor(length=300.0, sway=0.0, angle=50.0)
    assert len(ts.plan(tin, scale=1000, layout="strips")) == 1
    assert len(ts.plan(tin, scale=2500, layout="rows")) == 1


def test_a_surface_too_wide_for_strips_is_refused_with_the_scale_that_fits():
    rng = np.random.default_rng(1)
    points = np.column_stack(
        [rng.uniform([500000, 4e6], [501000, 4001000], (300, 2)), rng.random(300)]
    )
    tin = ts.triangulate(points, crs="EPSG:32616")
    with pytest.raises(
        ts.OptionError, match=r"it must be (1:\d+) or smaller, for the surface"
    ) as refused:
        ts.plan(tin, scale=500, layout="strips")
    fitting = str(refused.value).split("must be ")[1].split(" ")[0]
    frames = ts.plan(tin, scale=fitting, layout="strips").frames
    covered = shapely.union_all([shapely.Polygon(frame) for frame in frames])
    assert shapely.difference(outline(tin), covered.buffer(1e-6)).area == 0.0


def test_more_sheets_than_anybody_prints_are_refused():
    tin, _ = corridor(length=90_000.0, sway=0.0)
    for layout in ("rows", "strips"):
        with pytest.raises(ts.OptionError, match="at most 500 are drawn"):
            ts.plan(tin, scale=100, paper="A4", layout=layout)


def test_a_surface_in_two_parts_is_covered():
    first, second = ([[x + 500000, y + 4e6, x / 10] for x in range(a, b, 10) for y in (0, 20)]
                     for a, b in ((0, 300), (600, 1200)))  # fmt: skip
    tin = ts.triangulate(first + second, max_edge=50.0, crs="EPSG:32616")
    assert len(tin.boundary) == 2
    for layout in ("rows", "strips"):
        assert uncovered(tin, ts.plan(tin, scale=500, paper="A4", layout=layout)) == 0.0


def test_an_axis_that_is_none():
    tin, axis = corridor()
    for wrong in ([axis[:100], axis[100:]], "road", [[0, 0]], [[0, 0], [0, 0]], 5):
        with pytest.raises(ts.TinsmithError, match=r"\.$"):
            ts.plan(tin, scale=1000, layout="strips", axis=wrong)
