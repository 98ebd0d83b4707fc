"""The axis of a plan: stations stand where they are, and strips show a range of them."""

import math

import ezdxf
import numpy as np
import pytest
import shapely
from support.printed import read_svg

import tinsmith as ts

EAST, NORTH = 500_000.0, 4_000_000.0
ORIGIN = np.array([EAST, NORTH])
LINE = np.array([[0.0, 30.0], [200.0, 30.0], [350.0, 90.0]]) + ORIGIN
ROAD = ts.Alignment.from_points(LINE, radii=[80.0], start=1000.0, crs="EPSG:32616")


@pytest.fixture(scope="module")
def tin():
    x, y = np.meshgrid(np.arange(0.0, 361.0, 10.0), np.arange(0.0, 121.0, 10.0))
    z = 300 + x / 20 + np.sin(y / 9)
    points = np.column_stack([x.ravel() + EAST, y.ravel() + NORTH, z.ravel()])
    return ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")


def draw(tin, folder, **how):
    made = ts.plan(tin, interval=2.0, **how)
    return made, [read_svg(file) for file in made.save(folder / "a.svg")]


def find_ground(page, made, number=0):
    """Return what takes places on paper to the ground: by the corners of the frame."""
    left, low, right, top = page.frame
    corners = np.array([[left, low], [right, low], [right, top], [left, top]])
    terms = np.column_stack([corners, np.ones(4)])
    matrix, *_ = np.linalg.lstsq(terms, made.frames[number] - ORIGIN, rcond=None)
    return lambda places: np.column_stack([places, np.ones(len(places))]) @ matrix + ORIGIN


def test_ticks_and_texts_are_at_their_stations(tin, tmp_path):
    made, (page,) = draw(tin, tmp_path, axis=ROAD, station_interval=25.0, scale=1000)
    labels = page.named("station-label")
    stations = np.array([float(one.text) for one in labels])
    inner = np.arange(1000.0, ROAD.end, 25.0)
    assert stations == pytest.approx([*inner, ROAD.end], abs=1e-3)
    ticks = page.paths["station-ticks"]
    ground = find_ground(page, made)
    middles = ground(np.array([one.mean(axis=0) for one in ticks]))
    wanted = ROAD.points_at(np.append(inner, ROAD.end))
    assert middles == pytest.approx(wanted, abs=0.02)
    for tick, tangent in zip(ticks, ROAD.tangents_at(np.append(inner, ROAD.end)), strict=True):
        across = (tick[1] - tick[0]) / 2.6
        assert np.hypot(*across) == pytest.approx(1.0, abs=1e-3)
        assert abs(across @ tangent) < 1e-3
    for label, middle in zip(labels, np.array([one.mean(axis=0) for one in ticks]), strict=True):
        assert np.hypot(*(label.place - middle)) < 10.0
        assert -90.001 <= (label.rotation + 180.0) % 360.0 - 180.0 <= 90.001
    assert {"Axis from station 1000 to " + f"{ROAD.end:.3f}".rstrip("0")} <= {
        text.text for text in page.named("fact")
    }
    assert "axis" in {text.text for text in page.named("legend")}


def test_the_line_drawn_is_the_axis(tin, tmp_path):
    made, (page,) = draw(tin, tmp_path, axis=ROAD, scale=1000)
    drawn = find_ground(page, made)(np.concatenate(page.paths["axis-lines"]))
    wanted = shapely.LineString(ROAD.points_at(np.linspace(1000.0, ROAD.end, 4000)))
    assert shapely.hausdorff_distance(shapely.LineString(drawn), wanted) < 0.03
    assert page.named("station-label") == []
    assert "station-ticks" not in page.paths


def test_station_equations_are_written(tin, tmp_path):
    road = ts.Alignment.from_points(LINE, equations=[ts.StationEquation(100.0, ahead=500.0)])
    _, (page,) = draw(tin, tmp_path, axis=road, station_interval=50.0, scale=1000)
    written = [text.text for text in page.named("station-label")][:5]
    assert written == ["0", "50", "500", "550", "600"]


@pytest.mark.parametrize("reach", [(1040.0, 1100.0), (1150.0, 1320.0)])
def test_a_range_of_stations_is_on_sheets_along_the_axis(tin, reach, tmp_path):
    how = {"axis": ROAD, "station_interval": 20.0, "station_range": reach}
    made, pages = draw(tin, tmp_path, **how, layout="strips", scale=500, paper="A4")
    sheets = list(enumerate(pages))[1:] if len(pages) > 1 else [(0, pages[0])]
    whole = shapely.LineString(ROAD.points_at(np.linspace(*reach, 300)))
    seen = shapely.union_all([shapely.Polygon(made.frames[number]) for number, _ in sheets])
    assert shapely.length(shapely.difference(whole, seen.buffer(1e-6))) == 0.0
    assert (len(pages) > 1) == (reach[1] - reach[0] > 130.0)
    inner = np.arange(math.ceil(reach[0] / 20) * 20, reach[1] + 1e-6, 20.0)
    marked = set()
    for number, page in sheets:
        corners = made.frames[number]
        along = corners[1] - corners[0]
        middle = float(shapely.line_locate_point(whole, shapely.Point(corners.mean(axis=0))))
        station = reach[0] + min(max(middle, 1.0), reach[1] - reach[0] - 1.0)
        (tangent,) = ROAD.tangents_at([station])
        assert along @ tangent / np.hypot(*along) > 0.8
        ticks = np.array([one.mean(axis=0) for one in page.paths["station-ticks"]])
        places = find_ground(page, made, number)(ticks)
        found = ROAD.stations_of(places)["station"]
        assert np.abs(found - np.round(found / 10.0) * 10.0).max() < 0.02
        marked |= set(np.round(found).tolist())
        (north,) = page.named("north")
        angle = math.degrees(math.atan2(along[1], along[0]))
        assert (north.rotation + angle + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.01)
    assert set(inner.tolist()) <= marked
    assert min(marked) >= reach[0] - 0.5
    assert max(marked) <= reach[1] + 0.5


def test_a_drawing_has_the_stations_on_layers_of_their_own(tin, tmp_path):
    made = ts.plan(tin, interval=2.0, axis=ROAD, station_interval=50.0, scale=1000)
    document = ezdxf.readfile(made.save(tmp_path / "a.dxf")[0])
    space = document.modelspace()
    texts = {one.dxf.text: one for one in space.query('TEXT[layer=="STATIONS"]')}
    assert {"1000", "1050", "1300"} <= set(texts)
    for station in (1050.0, 1200.0):
        place = np.array(texts[f"{station:.0f}"].dxf.align_point)[:2]
        assert np.hypot(*(place - ROAD.points_at([station])[0])) < 8.0
    lines = [np.array(one.get_points("xy")) for one in space.query('LWPOLYLINE[layer=="AXIS"]')]
    longest = max(lines, key=len)
    assert longest[0] == pytest.approx(LINE[0], abs=1e-6)
    assert longest[-1] == pytest.approx(LINE[-1], abs=1e-6)


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ({"station_interval": 0.0}, "Invalid station_interval 0.0"),
        ({"station_interval": 1e-9}, "at most 10,000 stations"),
        ({"station_range": (1100.0, 1000.0)}, "two stations, the smaller one first"),
        ({"station_range": 1000.0}, "two stations, the smaller one first"),
        ({"station_range": (math.nan, 1100.0)}, "two stations, the smaller one first"),
        ({"station_range": (900.0, 1100.0)}, "which reaches from 1000 to 13"),
        ({"station_range": (1000.0, 1100.0), "layout": "single"}, "'strips' where a range"),
        ({"axis": None, "station_interval": 10.0}, "None where there is no axis"),
        ({"axis": None, "station_range": (0.0, 1.0)}, "None where there is no axis"),
        ({"station_range": (1000.0, 1100.0), "scale": None}, "given for the layout 'strips'"),
    ],
)
def test_what_does_not_fit_the_axis_is_refused(tin, how, sentence):
    with pytest.raises(ts.OptionError) as raised:
        ts.plan(tin, **{"axis": ROAD, "layout": "strips", "scale": 500, **how})
    assert sentence in str(raised.value)


def test_an_axis_without_ground_along_it_is_refused(tin):
    far = LINE + np.array([0.0, 5000.0])
    how = {"layout": "strips", "scale": 500, "station_range": (0.0, 100.0)}
    with pytest.raises(ts.LinesError, match="no surface along the axis from station 0 to 100"):
        ts.plan(tin, axis=far, **how)
    for layout in ("single", "rows"):
        with pytest.raises(ts.LinesError, match="The axis runs through none of the sheets"):
            ts.plan(tin, axis=far, layout=layout, scale=5000)
    with pytest.raises(ts.LinesError, match="axis of a plan is one line, and there are 2 lines"):
        ts.plan(tin, axis=[LINE, far])
    with pytest.raises(ts.CrsError):
        ts.plan(tin, axis=ts.Alignment.from_points(LINE, crs="EPSG:32617"))


def test_notes_of_the_axis_reach_the_plan(tin):
    line = ts.Features.of_lines(LINE, [0, 3], columns={}).with_notes(["One row was left out."])
    assert "One row was left out." in ts.plan(tin, axis=line).notes
