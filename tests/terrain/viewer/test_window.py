"""The window: what it reads is the surface's own, and what it draws follows slider and keys."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.viewer.camera import measure_pixels_per_unit
from tinsmith.terrain.viewer.options import PreviewOptions
from tinsmith.terrain.viewer.picture import keep_vtk_plain
from tinsmith.terrain.viewer.scene import place_in_scene
from tinsmith.terrain.viewer.window import Window

pv = pytest.importorskip("pyvista")
pytestmark = pytest.mark.usefixtures("can_draw")

SIZE = (800, 500)


def hills(*, crs="EPSG:32616", elevation_unit="m", scale=1.0, corner=(742_000.0, 4_030_000.0)):
    rng = np.random.default_rng(5)
    xy = rng.random((600, 2)) * [300, 200]
    z = 310 + 9 * np.sin(xy[:, 0] / 45) + 6 * np.cos(xy[:, 1] / 30)
    points = np.column_stack([xy * scale + corner, z])
    return ts.triangulate(points, crs=crs, elevation_unit=elevation_unit)


@pytest.fixture
def opened():
    """Open windows that nobody sees, and close them."""
    made = []

    def open_one(tin, **options):
        made.append(Window(tin, PreviewOptions.of(size=SIZE, **options), off_screen=True))
        made[-1].connect()
        made[-1].drawn.plotter.render()
        return made[-1]

    with keep_vtk_plain():
        yield open_one
        for window in made:
            window.drawn.plotter.close()


def find_pixel(window, place):
    """Where in the window a point of the surface is drawn, by the camera's own axes."""
    camera = window.drawn.plotter.camera
    drawn = place_in_scene(window.scene, np.array([place]))[0]
    right, up, _ = window.scene.view.axes
    pixels = measure_pixels_per_unit(camera, SIZE[1])
    away = (drawn - np.array(camera.focal_point)) * pixels
    return SIZE[0] / 2 + away @ right, SIZE[1] / 2 + away @ up


# ------------------------------------------------------------------ reading


@pytest.mark.parametrize("options", [{"view": "top"}, {"azimuth": 200.0, "tilt": 60.0}])
@pytest.mark.parametrize(
    ("crs", "elevation_unit"), [("EPSG:32616", "m"), ("EPSG:2264", "m"), (None, None)]
)
def test_a_pick_reads_what_the_surface_is_there(opened, options, crs, elevation_unit):
    tin = hills(crs=crs, elevation_unit=elevation_unit)
    window = opened(tin, exaggeration=1.5, **options)
    slopes = ts.slope(tin)
    for place in tin.points[tin.triangles[100:400:60]].mean(axis=1):
        found = window.pick(*(round(value) for value in find_pixel(window, place)))
        xy = [[found.easting, found.northing]]
        assert np.hypot(*(xy[0] - place[:2])) < 2.5  # a pixel or two
        assert found.elevation == tin.interpolate(xy)[0]
        assert found.slope == slopes[tin.locate(xy)[0]]


def test_a_pick_beside_the_surface_reads_nothing(opened):
    window = opened(hills())
    assert window.pick(5, 250) is None
    assert window.readings == []
    assert window.cut_section() is None


def test_lines_and_marks_are_not_picked(opened):
    """The surface is read below what is drawn over it."""
    tin = hills()
    window = opened(tin, view="top", contours=1.0)
    x, y = find_pixel(window, tin.points.mean(axis=0))
    first, second = window.pick(x, y), window.pick(x, y)
    assert first == second


@pytest.mark.parametrize(
    ("crs", "elevation_unit", "words"),
    [
        (
            "EPSG:32616",
            "m",
            "Northing 4,030,100.250 m   Elevation 312.250 m   Slope",
        ),
        ("EPSG:2264", "US survey foot", "Easting 742,120.500 US ft   Northing 4,030,100.250 US ft"),
        (None, None, "Easting 742,120.500   Northing 4,030,100.250   Elevation 312.250   Slope"),
        ("EPSG:32616", None, "Elevation 312.250 m assumed"),
    ],
)
def test_readings_are_written_in_the_units_of_the_crs(opened, crs, elevation_unit, words):
    from tinsmith.terrain.viewer.window import Reading

    window = opened(hills(crs=crs, elevation_unit=elevation_unit))
    said = window.describe(Reading(742_120.5, 4_030_100.25, 312.25, 12.34))
    assert words in said
    assert said.endswith("Slope 12.3°")


def test_degrees_are_read_as_degrees(opened):
    tin = hills(crs="EPSG:4326", scale=1e-5, corner=(10.0, 50.0))
    window = opened(tin, view="top")
    place = tin.points[tin.triangles[200]].mean(axis=0)
    found = window.pick(*find_pixel(window, place))
    assert found.elevation == tin.interpolate([[found.easting, found.northing]])[0]
    assert np.abs(np.array([found.easting, found.northing]) - place[:2]).max() < 2e-5
    assert f"Easting {found.easting:.7f}°" in window.describe(found)
    window.pick(*find_pixel(window, tin.points[tin.triangles[20]].mean(axis=0)))
    assert window.cut_section() is None  # a length in degrees is none


# ------------------------------------------------------------------ sections


def test_a_section_is_the_profile_between_the_last_two_places(opened):
    tin = hills()
    window = opened(tin, view="top")
    for row in (10, 300, 150):
        window.pick(*find_pixel(window, tin.points[tin.triangles[row]].mean(axis=0)))
    assert len(window.readings) == 2
    table = window.cut_section()
    ends = [[one.easting, one.northing] for one in window.readings]
    expected = ts.profile(tin, ends)
    for name in ("station", "elevation"):
        np.testing.assert_array_equal(table[name], expected[name])
    assert table["elevation"][0] == pytest.approx(window.readings[0].elevation)
    assert table["elevation"][-1] == pytest.approx(window.readings[1].elevation)
    (plot,) = window._chart.plots()
    np.testing.assert_allclose(plot.x, expected["station"])
    np.testing.assert_allclose(plot.y, expected["elevation"])
    assert window._chart.x_label == "Distance (m)"
    assert window._chart.y_label == "Elevation (m)"
    length = np.hypot(*np.subtract(*ends))
    mark = window._marks[-1].mapper.dataset
    assert np.ptp(mark.points[:, :2] @ (np.subtract(*ends) / length)) == pytest.approx(length)
    window.cut_section()
    assert len(list(window.drawn.plotter.renderer._charts)) == 1


# ------------------------------------------------------------------ drawing


def heights_of(window):
    return window.drawn.surfaces[0].mapper.dataset.points[:, 2]


def test_the_slider_exaggerates_surface_caption_and_marks(opened):
    tin = hills()
    window = opened(tin, exaggeration=2.0)
    before, camera = np.ptp(heights_of(window)), window.drawn.plotter.camera_position
    x, y = find_pixel(window, tin.points[tin.triangles[100]].mean(axis=0))
    found = window.pick(x, y)
    window._slide(5.04)
    assert np.ptp(heights_of(window)) == pytest.approx(2.5 * before)
    assert window.scene.title_block.exaggeration == 5.0
    assert window.drawn.plotter.camera_position == camera
    mark = window._marks[0].mapper.dataset.points[0]
    place = (found.easting, found.northing, found.elevation)
    np.testing.assert_allclose(mark, place_in_scene(window.scene, np.array([place]))[0], rtol=1e-6)
    again = window.pick(*find_pixel(window, place))
    assert again.elevation == tin.interpolate([[again.easting, again.northing]])[0]
    assert np.hypot(again.easting - found.easting, again.northing - found.northing) < 1.5


def test_tints_go_around_and_have_the_colours_of_the_page(opened):
    tin = hills()
    window = opened(tin)
    pages = ts.preview(tin).to_html()
    for tint in ("slope", "aspect", "plain", "elevation"):
        window.change_tint()
        assert window.scene.options.tint == tint
        assert (window.scene.title_block.legend is None) == (tint == "plain")
        if tint == "plain":
            continue
        table = window.drawn.surfaces[0].mapper.lookup_table
        ends = [table.values[k, :3] for k in (0, -1)]
        low, high = ("#" + "".join(f"{part:02x}" for part in end) for end in ends)
        assert low in pages
        assert high in pages
        expected = {"slope": (0, 60), "aspect": (0, 360)}.get(
            tint, (tin.points[:, 2].min(), tin.points[:, 2].max())
        )
        assert table.scalar_range == pytest.approx(expected)


def test_contours_are_switched_on_and_off(opened):
    tin = hills()
    window = opened(tin)
    count = len(window.drawn.plotter.renderer.actors)
    window.toggle_contours()
    interval = window.scene.options.contours
    lines = [
        actor.mapper.dataset
        for actor in window.drawn.plotter.renderer.actors.values()
        if isinstance(actor, pv.Actor) and actor.mapper.dataset.n_lines
    ]
    heights = np.concatenate([one.points[:, 2] for one in lines])
    scale = window.scene.exaggeration
    origin = place_in_scene(window.scene, np.zeros((1, 3)))[0, 2]
    levels = (heights - origin) / scale / interval
    np.testing.assert_allclose(levels, np.round(levels), atol=1e-4)
    assert 4 <= np.ptp(tin.points[:, 2]) / interval <= 30
    window.toggle_contours()
    assert window.scene.options.contours is None
    assert len(window.drawn.plotter.renderer.actors) == count


def test_keys_do_what_the_foot_says(opened):
    tin = hills()
    window = opened(tin)
    interactor = window.drawn.plotter.iren.interactor
    x, y = (round(value) for value in find_pixel(window, tin.points.mean(axis=0)))
    for key in "tcp":
        interactor.SetEventInformation(x, y, 0, 0, key, 0, key)
        interactor.InvokeEvent("KeyPressEvent")
    assert window.scene.options.tint == "slope"
    assert window.scene.options.contours is not None
    assert len(window.readings) == 1


def test_a_corridor_is_one_piece_in_a_window(opened):
    xy = np.random.default_rng(1).random((300, 2)) * [3000, 60]
    window = opened(ts.triangulate(np.column_stack([xy, xy[:, 0] / 100])))
    assert window.scene.strips is None
    assert not window.scene.has_block
    assert window.scene.view.azimuth == pytest.approx(180.0, abs=0.5)


def test_level_ground_has_no_contours(opened):
    window = opened(ts.triangulate([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5]]))
    window.toggle_contours()
    assert window.scene.options.contours is None
