"""Cards of surveys, reports and results: figures, escaped words, pictures in the right place."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.html_reprs import picture_of, read
from support.processes import run_alone

import tinsmith as ts
from tinsmith.terrain.drawing.html_repr.drawings import Canvas, draw_cells
from tinsmith.terrain.drawing.html_repr.frame import write_html

CRS = "EPSG:32616"
HOSTILE = '</td><script>alert("x")</script>&amp;'


def tell(card):
    """Return title and rows of a card."""
    words = read(card).words
    return words[0], dict(zip(words[1::2], words[2::2], strict=False))


def survey(**more):
    points = np.array(
        [[700_000, 4_000_000, 10], [700_400, 4_000_000, 12], [700_400, 4_000_200, 30.0]]
    )
    return ts.Survey(points=points, crs=CRS, elevation_unit="m", **more)


# ------------------------------------------------------------------------------ figures


def test_a_survey_tells_points_lines_columns_and_what_was_left_out():
    card = survey(
        breaklines=[[[700_010, 4_000_010], [700_300, 4_000_090]]],
        attributes={"number": [1, 2, 3]},
        skipped={"header lines": 1, "bad rows": 4},
        notes=[f"Note {k}." for k in range(9)],
        source="field.csv",
    )._repr_html_()
    title, told = tell(card)
    assert title == "Survey"
    assert told["Points"] == "3 points"
    assert told["Lines"] == "1 breakline"
    assert told["Columns"] == "number"
    assert told["From"] == "field.csv"
    assert told["CRS"] == "WGS 84 / UTM zone 16N (EPSG:32616)"
    assert told["Units"] == "metre"
    assert told["Easting"] == "700,000 to 700,400"
    assert told["Elevation"] == "10.0 to 30.0"
    assert told["Left out"] == "4 bad rows"
    assert "and 4 other notes" in card


def test_a_report_tells_what_became_of_the_rows():
    points = [[0, 0, 5], [4, 0, 6], [0, 3, 8], [0, 0, 7], [4, 3, 9], [2, 1, 1]]
    lines = [ts.Breakline([[0, 0, 5], [4, 3, 5]]), ts.Breakline([[0, 3, 7], [4, 0, 7]])]
    report = ts.triangulate(points, breaklines=lines).report
    title, told = tell(report._repr_html_())
    assert title == "Report"
    assert told["Rows"] == "6 rows"
    assert told["Merged"] == "1 row at 1 vertex, elevation by 'mean'"
    assert told["Lines"] == "2 lines"
    assert told["Crossings"] == "1 crossing"
    erased = ts.triangulate(points, erase=[[[1, 0.5], [3, 0.5], [3, 2], [1, 2]]]).report
    assert tell(erased._repr_html_())[1]["Left out"] == "1 row erased"


def test_lines_of_a_survey_that_are_no_arrays_are_counted_and_not_drawn():
    odd = [shapely.LineString([(700_010, 4_000_010), (700_300, 4_000_090)]), [["a", "b"]]]
    card = survey(breaklines=odd)._repr_html_()
    assert tell(card)[1]["Lines"] == "2 breaklines"


def test_features_tell_geometries_columns_and_units():
    lines = ts.Features.of_lines(
        [[0, 0, 5], [4, 0, 5], [4, 3, 5]],
        [0, 3],
        columns={"elevation": [5.0]},
        units={"elevation": "m"},
        crs=CRS,
        name="contours",
    )
    title, told = tell(lines._repr_html_())
    assert title == "Features: contours"
    assert told["Geometries"] == "1 LineString, 3 vertices"
    assert told["Columns"] == "elevation (m)"
    assert told["Units"] == "metre, elevations not known"
    flat = ts.Features.of_points([[0, 0], [4, 3]], crs=CRS)
    assert tell(flat._repr_html_())[1]["Units"] == "metre"


def test_a_raster_tells_cells_range_and_what_has_no_value():
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 3.0, 2.0), shape=(2, 3), spacing=1.0)
    values = np.array([[1, 2, -9999], [4, np.nan, 6]])
    raster = ts.Raster({"elevation": values}, grid, nodata=-9999, units={"elevation": "m"})
    _, told = tell(raster._repr_html_())
    assert told["Cells"] == "2 rows by 3 columns of 1"
    assert told["Bands"] == "elevation (m)"
    assert told["elevation"] == "1.00 to 6.00"
    assert told["Without value"] == "2 cells"


def test_a_table_shows_its_first_rows_with_units():
    table = ts.Table(
        {"stage": np.arange(20.0), "name": [f"n{k}" for k in range(20)]}, units={"stage": "m"}
    )
    words = read(table._repr_html_()).words
    assert "stage (m)" in words
    assert "n7" in words
    assert "n8" not in words
    assert "20 rows" in words
    wide = ts.Table({f"c{k}": [k] for k in range(40)})
    assert "40, of which 12 are shown" in read(wide._repr_html_()).words


# ------------------------------------------------------------------------------- pictures


def test_points_lie_where_they_are_and_the_highest_is_on_top():
    picture = picture_of(survey()._repr_html_())
    height, width = picture.shape[:2]
    assert width == 320
    assert height == pytest.approx((320 - 6) / 2 + 6, abs=1)
    shown = np.argwhere(picture[..., 3] == 255)
    expected = np.array([[height - 4, 3], [height - 4, width - 4], [3, width - 4]])
    distances = np.abs(shown[:, None] - expected).max(axis=2)
    assert distances.min(axis=1).max() <= 2  # nothing elsewhere
    assert distances.min(axis=0).max() <= 2  # and something at each


def test_segments_are_drawn_from_end_to_end():
    """Every pixel lies on a segment, and every place of a segment on a pixel."""
    rng = np.random.default_rng(4)
    start, stop = rng.random((2, 12, 2)) * 100
    canvas = Canvas.around(np.concatenate([start, stop]), None)
    canvas.draw_segments(start, stop)
    rows, columns = np.nonzero(canvas.pixels[..., 3])
    places = np.column_stack([columns - 3, 3 - rows]) / canvas.scale + (canvas.west, canvas.north)
    lines = shapely.multilinestrings([shapely.linestrings(np.stack([start, stop], axis=1))])[0]
    drawn = shapely.points(places)
    assert shapely.distance(drawn, lines).max() * canvas.scale[0] < 0.71
    along = shapely.line_interpolate_point(
        lines.geoms, np.linspace(0, 1, 50)[:, None], normalized=True
    )
    assert shapely.distance(along, shapely.multipoints(drawn)).max() * canvas.scale[0] < 1.01


def test_parts_of_features_are_not_joined():
    two = ts.Features.of_lines([[0, 0], [1, 0], [0, 9], [1, 9]], [0, 2, 4])
    picture = picture_of(two._repr_html_())
    assert not picture[20:-20, :, 3].any()


def test_cells_are_drawn_north_up_and_clear_where_there_is_nothing():
    picture = draw_cells(np.array([[1.0, np.nan], [np.nan, 9.0]]))
    side = picture.shape[0] // 2
    assert picture.shape == (240, 240, 4)
    assert (picture[:side, :side, 3] == 255).all()
    assert (picture[:side, side:, 3] == 0).all()
    low, high = picture[0, 0, :3].astype(int).sum(), picture[-1, -1, :3].astype(int).sum()
    assert low < high


def test_a_band_that_is_computed_as_it_is_written_is_not_asked():
    class Lazy:
        shape, dtype = (2000, 3000), np.dtype(float)

        def __getitem__(self, key):
            raise AssertionError("asked for")

    grid = ts.Grid(ts.Bounds(0.0, 0.0, 3000.0, 2000.0), shape=(2000, 3000), spacing=1.0)
    card = ts.Raster({"elevation": Lazy()}, grid)._repr_html_()
    assert "computed as it is written" in card
    assert "<img" not in card


# -------------------------------------------------------------------- hostile, odd and large


def hostile_things():
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 1.0, 1.0), shape=(1, 1), spacing=1.0)
    more = {"name": HOSTILE, "notes": [HOSTILE + "y" * 9999]}
    yield survey(source=HOSTILE, attributes={HOSTILE: [HOSTILE] * 3}, notes=[HOSTILE])
    yield ts.Features.of_points([[0, 0]], columns={HOSTILE: [HOSTILE]}, **more)
    yield ts.Raster({HOSTILE: np.zeros((1, 1))}, grid, **more)
    yield ts.Table({HOSTILE: [HOSTILE]}, units={HOSTILE: HOSTILE}, **more)


@pytest.mark.parametrize("thing", [*hostile_things()], ids=lambda thing: type(thing).__name__)
def test_hostile_names_stay_words(thing):
    card = thing._repr_html_()
    reader = read(card)
    assert "script" not in [tag for tag, _ in reader.tags]
    assert any("alert(" in words for words in reader.words)
    assert len(card) < 10_000


def test_a_note_of_a_report_stays_words():
    noted = survey(notes=[HOSTILE])
    report = ts.triangulate(noted).report
    assert HOSTILE in report.notes
    assert HOSTILE in read(report._repr_html_()).words


@pytest.mark.parametrize(
    "points",
    [
        np.zeros((0, 3)),
        [[1, 2, 3]],
        [[1, 2, 3], [1, 2, 4]],
        [[0, 0, 1], [1e60, 0, 2]],
        [[0, 0, -1e300], [0, 1e-50, 1e300]],
        [[5, 5, 1], [5, 9, 1]],
    ],
    ids=["none", "one", "one place", "far", "near", "upright"],
)
@pytest.mark.filterwarnings("error")
def test_every_survey_has_a_card(points):
    card = ts.Survey(points=points)._repr_html_()
    assert read(card).words[0] == "Survey"
    if len(points):
        height, width, _ = picture_of(card).shape
        assert 1 <= height <= 240
        assert 1 <= width <= 320


@pytest.mark.filterwarnings("error")
def test_features_and_rasters_without_anything_have_a_card():
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 1.0), shape=(1, 2), spacing=1.0)
    bands = {"a": np.full((1, 2), np.nan), "b": np.array([[True, False]])}
    for thing in (
        ts.Features.of_points(np.empty((0, 2))),
        ts.Features.of_lines(np.empty((0, 3)), [0]),
        ts.Features.of_points([[0, 0, np.nan]]),
        ts.Raster(bands, grid),
        ts.Raster({"b": bands["b"]}, grid),
        ts.Table({"a": []}),
    ):
        read(thing._repr_html_())


def test_degrees_are_as_long_as_they_are_on_the_ground():
    square = ts.Survey(points=[[10, 60, 0], [10.2, 60.1, 0]], crs="EPSG:4326")
    height, width, _ = picture_of(square._repr_html_()).shape
    assert width / height == pytest.approx(1.0, abs=0.03)


def test_cards_are_small_whatever_they_show():
    rng = np.random.default_rng(2)
    noise = rng.random((600, 900))
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 900.0, 600.0), shape=noise.shape, spacing=1.0)
    points = rng.random((200_000, 3)) * 1000
    cells = rng.random((40_000, 3))
    lines = ts.Features.of_lines(points, np.arange(0, 200_001, 4))
    things = [ts.Raster({"a": noise}, grid), ts.Survey(points=points), lines, ts.triangulate(cells)]
    for thing in things:
        assert len(thing._repr_html_()) < 200_000, thing


def test_a_picture_of_any_size_is_one_that_browsers_show():
    card = write_html("A", [], picture=np.full((1, 1, 4), 255, np.uint8))
    assert picture_of(card).shape == (1, 1, 4)


def test_cards_need_no_library_that_draws():
    code = (
        "import sys, tinsmith as ts\n"
        "sys.modules.update(dict.fromkeys(('pyvista', 'vtkmodules', 'matplotlib', 'PIL')))\n"
        "survey = ts.Survey(points=[[0, 0, 1], [4, 0, 2], [0, 3, 4]])\n"
        "assert 'tinsmith.terrain' not in sys.modules\n"
        "assert survey._repr_html_().startswith('<div')\n"
    )
    run_alone(code)
