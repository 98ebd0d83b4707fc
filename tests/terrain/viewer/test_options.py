"""Options of pictures: what is drawn follows them, and what is not allowed is told."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PIL import Image
from support.pictures import make_dipping_plane, read_pixels

from tinsmith import triangulate
from tinsmith.base.crs import METRE
from tinsmith.terrain import OptionError, preview
from tinsmith.terrain.drawing import make_legend
from tinsmith.terrain.drawing.palette import choose_palette, compute_lightness
from tinsmith.terrain.viewer.actors import add_lights
from tinsmith.terrain.viewer.annotations import Layout, TitleBlock, annotate
from tinsmith.terrain.viewer.camera import View, aim, measure_pixels_per_unit, project_ground_axes
from tinsmith.terrain.viewer.options import PreviewOptions

pv = pytest.importorskip("pyvista")

LEGEND = make_legend("elevation", (0.0, 1.0), "m")


# ------------------------------------------------------------------ what is allowed


@pytest.mark.parametrize(
    ("option", "values"),
    [
        ("size", [(0, 100), (100_000, 800), (800.5, 800), (800,), "800", 800, (True, 800)]),
        ("azimuth", [math.nan, math.inf, "north", True, (1, 2)]),
        ("tilt", [-1, 90.5, math.nan, "35", True]),
        ("sun", [(315,), (315, 45, 1), (315, -1), (315, 91), (math.nan, 45), 315, "315,45"]),
        ("background", ["", "reddish", "#fff", "#12345g", 7, (1, 2, 3)]),
        ("dpi", [0, 35, 2401, math.nan, "300", True]),
        ("elevations", [(1,), (2, 1), (1, 1), (1, math.inf), "1,2", 5]),
        ("exaggeration", [0, -1, math.nan, "2", True]),
        ("tint", ["height", 1, None]),
        ("contours", [0, -1.0, math.inf, "1", True]),
        ("edges", [1, "yes"]),
        ("lines", [0, "no"]),
        ("title", [5, b"x"]),
        ("view", ["side", 1, None]),
    ],
)
def test_options_out_of_range_are_refused(tmp_path, option, values):
    tin = make_dipping_plane(0)
    for value in values:
        with pytest.raises(OptionError) as caught:
            preview(tin, output=tmp_path / "a.png", **{option: value})
        assert caught.value.option == option
        assert str(caught.value).startswith(f"Invalid {option} ")
    assert not list(tmp_path.iterdir())


def test_a_map_has_no_tilt():
    with pytest.raises(OptionError, match="90, or left out: the view 'top' is from above"):
        PreviewOptions.of(view="top", tilt=35.0)
    assert PreviewOptions.of(view="top", tilt=90).seen_from == View(180.0, 90.0)


def test_an_unknown_option_is_refused():
    with pytest.raises(TypeError, match="colour"):
        preview(make_dipping_plane(0), colour="red")


def test_none_is_the_usual_value():
    options = (
        "size",
        "azimuth",
        "tilt",
        "sun",
        "background",
        "dpi",
        "elevations",
        "title",
        "contours",
    )
    assert PreviewOptions.of(**dict.fromkeys(options)) == PreviewOptions.of()


def test_azimuths_go_around():
    assert PreviewOptions.of(azimuth=-30).seen_from == View(330.0, 35.0)
    assert PreviewOptions.of(azimuth=720.0, tilt=0).seen_from == View(0.0, 0.0)
    assert PreviewOptions.of(sun=(405, 10)).sun == (45.0, 10.0)


# ------------------------------------------------------------------ what is drawn


@pytest.mark.parametrize("azimuth", [0.0, 30.0, 77.0, 180.0, 202.5, 300.0])
@pytest.mark.parametrize("tilt", [0.0, 5.0, 35.0, 80.0, 90.0])
def test_north_arrow_and_scale_bar_are_those_of_the_projection(azimuth, tilt):
    """Against VTK's own matrix: where a step to the north, and one across, land in the picture."""
    camera, layout = pv.Camera(), Layout(1600.0, 1000.0)
    corners = np.array([[x, y, z] for x in (0, 300) for y in (0, 200) for z in (0, 40)], float)
    options = PreviewOptions.of(azimuth=azimuth, tilt=tilt)
    view = options.seen_from
    size = (1600, 1000)
    aim(camera, corners, view=view, frame=layout.frame, size=size)
    start, north, across = project(camera, [[0, 0, 0], [0, 1, 0], view.axes[0]], size)
    pixels = measure_pixels_per_unit(camera, 1000.0)
    np.testing.assert_allclose(across - start, [pixels, 0.0], atol=1e-6)
    np.testing.assert_allclose((north - start) / pixels, project_ground_axes(camera)[1], atol=1e-9)
    title_block = TitleBlock("T", "S", 1.0, LEGEND, METRE)
    drawn = record(layout, title_block, camera)
    tip, center = drawn["tip"], drawn["center"]
    np.testing.assert_allclose((tip - center) / 40.0, (north - start) / pixels, atol=1e-6)
    assert drawn["bar"] == pytest.approx(drawn["length"] * pixels)
    shown = project(camera, corners, size)
    assert (shown.min(axis=0) >= (layout.frame.xmin - 1e-6, layout.frame.ymin - 1e-6)).all()
    assert (shown.max(axis=0) <= (layout.frame.xmax + 1e-6, layout.frame.ymax + 1e-6)).all()


def project(camera, points, size):
    """Window coordinates by VTK's own matrix."""
    camera.clipping_range = (1.0, 1e5)
    matrix = camera.GetCompositeProjectionTransformMatrix(size[0] / size[1], -1, 1)
    values = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    clip = np.column_stack([np.array(points, float), np.ones(len(points))]) @ values.T
    return (clip[:, :2] / clip[:, 3:] + 1) / 2 * size


class WithoutScale:
    def draw_scale(self, corner, size, colors):
        """Draw nothing: nobody asks for the legend's."""


def record(layout, title_block, camera):
    """Where the compass and the scale bar are drawn, and the length that it says."""
    found = {}

    class Recorder(WithoutScale):
        def clear(self):
            found.clear()

        def draw_rectangle(self, corner, size, color):
            if size[1] == 7.0:
                found["bar"] = found.get("bar", 0.0) + size[0]

        def draw_polygon(self, corners, color):
            found.setdefault("tip", np.array(corners[0], float))

        def draw_line(self, places, color, *, width=1.0):
            if len(places) > 40:
                ring = np.array(places)
                found["center"] = (ring.max(axis=0) + ring.min(axis=0)) / 2

        def draw_text(self, place, words, color, *, size, bold=False, align="left"):
            if size == 15 and place[1] == 76.0 and align == "center" and words != "0":
                found["length"] = float(words.replace(",", ""))

        def measure_text(self, words, *, size, bold=False):
            return 0.5 * size * len(words)

    annotate(Recorder(), layout, title_block, camera)
    return found


@pytest.mark.parametrize(
    ("sun", "words"),
    [
        ((315, 45), "Light from the northwest, 45° high"),
        ((90, 12.5), "Light from the east, 12.5° high"),
        ((0, 0), "Light from the north, 0° high"),
        ((10, 90), "Light from straight above"),
    ],
)
def test_the_caption_says_where_the_light_comes_from(sun, words):
    texts = []

    class Recorder:
        def __getattr__(self, name):
            return lambda *_, **__: 1.0

        def draw_text(self, place, said, *_, **__):
            texts.append(said)

    camera = pv.Camera()
    aim(camera, np.eye(3), view=View(0, 40), frame=Layout(1600, 1000).frame, size=(1600, 1000))
    title_block = TitleBlock("T", "S", 1.0, LEGEND, METRE, sun=PreviewOptions.of(sun=sun).sun)
    annotate(Recorder(), Layout(1600.0, 1000.0), title_block, camera)
    assert words in texts


@pytest.mark.parametrize("altitude", [0.0, 10.0, 30.0, 45.0, 60.0, 80.0, 90.0])
def test_level_ground_is_lit_alike_by_every_sun(altitude):
    plotter = pv.Plotter(off_screen=True)
    add_lights(plotter, PreviewOptions.of(sun=(70.0, altitude)).sun)
    total = sum(light.intensity * light.position[2] for light in plotter.renderer.lights)
    usual = 0.58 * math.sin(math.pi / 4) + 0.1 + 0.16 * math.sin(math.radians(50))
    assert total == pytest.approx(usual, abs=1e-6)
    assert all(light.intensity >= 0 for light in plotter.renderer.lights)
    east, north, up = plotter.renderer.lights[0].position
    assert math.degrees(math.asin(min(up, 1.0))) == pytest.approx(altitude, abs=1e-4)
    if altitude < 90:
        assert math.degrees(math.atan2(east, north)) == pytest.approx(70.0)


@pytest.mark.usefixtures("can_draw")
@pytest.mark.parametrize("azimuth", [0, 90, 225])
def test_slopes_towards_the_sun_are_brightest(tmp_path, azimuth):
    brightness = {}
    for fall in (azimuth, (azimuth + 45) % 360, (azimuth - 45) % 360, (azimuth + 180) % 360):
        path = preview(
            make_dipping_plane(fall),
            output=tmp_path / f"{fall}.png",
            size=(400, 250),
            view="top",
            sun=(azimuth, 40),
        )
        brightness[fall] = read_pixels(path)[110:130, 195:205].mean()
    assert max(brightness, key=brightness.get) == azimuth


@pytest.mark.usefixtures("can_draw")
@pytest.mark.parametrize("background", ["black", "dark", "light", "#204060", "#c8c8c8", "#808080"])
def test_words_can_be_read_on_every_background(tmp_path, background):
    path = preview(
        make_dipping_plane(0),
        output=tmp_path / "a.png",
        size=(800, 500),
        background=background,
        title="X" * 9,
    )
    pixels = read_pixels(path)
    paper = PreviewOptions.of(background=background).palette.paper
    assert (pixels[[0, -1]] == paper).all()
    assert (pixels[:, [0, -1]] == paper).all()
    title = pixels[15:35, 20:200].astype(np.uint8).reshape(-1, 3)
    light = compute_lightness(title)
    assert np.ptp(light) > 0.35


def test_every_grey_has_ink_that_stands_out():
    for grey in range(0, 256, 5):
        palette = choose_palette((grey, grey, grey))
        ink, second, paper, warning = compute_lightness(np.array(palette, np.uint8))
        assert abs(ink - paper) > 0.35
        assert abs(second - paper) > 0.22
        assert abs(warning - paper) > 0.14


@pytest.mark.usefixtures("can_draw")
@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif"])
def test_dots_per_inch_are_written_into_the_picture(tmp_path, suffix):
    path = preview(make_dipping_plane(0), output=tmp_path / f"a{suffix}", size=(400, 250), dpi=300)
    with Image.open(path) as image:
        assert image.size == (400, 250)
        assert image.info["dpi"] == pytest.approx((300, 300), abs=0.01)
    path = preview(make_dipping_plane(0), output=tmp_path / f"b{suffix}", size=(400, 250))
    with Image.open(path) as image:
        assert image.info.get("dpi", (72, 72))[0] in {1, 72, 96}


@pytest.mark.usefixtures("can_draw")
def test_the_same_elevations_make_the_same_tints(tmp_path):
    """Two level surfaces: as high as the ends of one range, they have the ends' colours."""
    shown = {}
    for level in (0.0, 10.0):
        tin = triangulate([[0, 0, level], [9, 0, level], [9, 9, level], [0, 9, level]])
        path = preview(
            tin,
            output=tmp_path / f"{level}.png",
            size=(400, 250),
            view="top",
            elevations=(0, 10),
        )
        shown[level] = read_pixels(path)[120, 200]
    assert np.abs(shown[0.0] - (77, 115, 93)).max() <= 6
    assert np.abs(shown[10.0] - (243, 233, 223)).max() <= 6
