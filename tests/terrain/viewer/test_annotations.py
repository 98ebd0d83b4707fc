"""Annotations measured: what is drawn is as long, as high and turned as the words say."""

from __future__ import annotations

import importlib
import itertools
import math

import numpy as np
import pytest

from tinsmith import triangulate
from tinsmith.base.crs import METRE
from tinsmith.base.georeference.scales import find_ground
from tinsmith.terrain.drawing import make_legend, make_scale_bar
from tinsmith.terrain.drawing.palette import Palette, interpolate_tints
from tinsmith.terrain.viewer.actors import add_lights, place_vertices
from tinsmith.terrain.viewer.annotations import (
    BAR_WIDTH,
    Layout,
    TitleBlock,
    annotate,
)
from tinsmith.terrain.viewer.camera import (
    VIEWS,
    View,
    aim,
    measure_pixels_per_unit,
    project_ground_axes,
)
from tinsmith.terrain.viewer.overlay import Overlay, _find_wide_font
from tinsmith.tin import Bounds

pv = pytest.importorskip("pyvista")

INK, GREY, PAPER, WARNING = Palette()
LAYOUT = Layout(1400.0, 900.0)
EXTENT = 500.0
LEGEND = make_legend("elevation", (0.0, 1.0), "m")


class Recorder:
    """An overlay that draws nothing and keeps all that it was asked for."""

    def __init__(self):
        self.rectangles, self.polygons, self.lines = [], [], []
        self.texts, self.styles = [], []

    def clear(self):
        self.__init__()

    def draw_rectangle(self, corner, size, color):
        self.rectangles.append((*corner, *size, tuple(color)))

    def draw_scale(self, corner, size, colors):
        step = size[0] / len(colors)
        for k, color in enumerate(colors.tolist()):
            self.draw_rectangle((corner[0] + k * step, corner[1]), (step, size[1]), color)

    def draw_polygon(self, corners, color):
        self.polygons.append((np.array(corners, float), tuple(color)))

    def draw_line(self, places, color, *, width=1.0):
        self.lines.append((np.array(places, float), tuple(color)))

    def draw_text(self, place, words, color, *, size, bold=False, align="left"):
        self.texts.append((words, *place, align))
        self.styles.append((tuple(color), size, bold))

    def measure_text(self, words, *, size, bold=False):
        return 0.6 * size * len(words)

    def place_of(self, words):
        (found,) = [(x, y) for said, x, y, _ in self.texts if said == words]
        return np.array(found)


def annotated(view, *, extent=EXTENT, elevations=(312.4, 398.6), exaggeration=2.0):
    """The annotations of a view of a square, and its camera."""
    camera, overlay = pv.Camera(), Recorder()
    square = np.array([[x, y, 0.0] for x in (0, extent) for y in (0, extent)])
    aim(camera, square, view=view, frame=LAYOUT.frame, size=(LAYOUT.width, LAYOUT.height))
    legend = make_legend("elevation", elevations, "m")
    title_block = TitleBlock("Title", "Subtitle", exaggeration, legend, METRE)
    annotate(overlay, LAYOUT, title_block, camera)
    return overlay, camera


def tinsmith_hill(crs):
    axis = np.linspace(0.0, 100.0, 11)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    return triangulate(np.column_stack([x, y, 300 + 20 * np.sin(x / 30) * y / 100]), crs=crs)


# ------------------------------------------------------------------ exaggeration


@pytest.mark.parametrize("factor", [1.0, 2.5, 5.0, 100.0])
@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:2264+5703"])
def test_elevations_are_drawn_with_the_exaggeration(crs, factor):
    tin = tinsmith_hill(crs)
    ground = find_ground(tin)
    plain, drawn = place_vertices(tin, ground, 1.0), place_vertices(tin, ground, factor)
    np.testing.assert_array_equal(drawn[:, :2], plain[:, :2])
    np.testing.assert_allclose(np.ptp(drawn[:, 2]), factor * np.ptp(plain[:, 2]), rtol=1e-12)
    assert np.ptp(drawn[:, 2]) == pytest.approx(
        np.ptp(tin.points[:, 2]) * ground.scale[2] * factor, rel=1e-12
    )
    order = np.argsort(tin.points[:, 2], kind="stable")
    assert (np.diff(drawn[order, 2]) >= 0).all()


@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_the_caption_states_the_exaggeration_that_is_drawn(factor):
    overlay, _ = annotated(View(200.0, 35.0), exaggeration=factor)
    (words,) = [said for said, *_ in overlay.texts if "exaggeration" in said]
    assert words.startswith(f"Vertical exaggeration {factor:g}\N{MULTIPLICATION SIGN}")
    assert words.endswith("(true to scale)") == (factor == 1)


# -------------------------------------------------------------------- scale bar


@pytest.mark.parametrize("extent", [0.7, 37.0, 500.0, 8_300.0, 120_000.0])
def test_the_scale_bar_is_as_long_as_it_says(extent):
    overlay, camera = annotated(VIEWS["top"], extent=extent)
    pixels = measure_pixels_per_unit(camera, LAYOUT.height)
    length, symbol, labels = make_scale_bar(METRE, BAR_WIDTH / pixels)
    parts = [r for r in overlay.rectangles if r[3] == 7.0]
    assert [color for *_, color in parts] == [INK, PAPER, INK, PAPER]
    left = parts[0][0]
    for k, (x, _, width, _, _) in enumerate(parts):
        assert x == pytest.approx(left + k * length * pixels / 4)
        assert width == pytest.approx(length * pixels / 4)
    (outline,) = [p for p, _ in overlay.lines if len(p) == 5 and np.ptp(p[:, 1]) == 7.0]
    assert np.ptp(outline[:, 0]) == pytest.approx(length * pixels)
    assert outline[:, 0].min() == pytest.approx(left)
    assert 0.4 * 260 <= length * pixels <= 260
    shown = length / 1000 if symbol == "km" else length
    assert labels[-1] == (1.0, f"{shown:,.12g}")
    assert overlay.place_of(labels[-1][1])[0] == pytest.approx(left + length * pixels)
    assert overlay.place_of("0")[0] == pytest.approx(left)
    assert overlay.place_of(symbol)[0] > left + length * pixels


@pytest.mark.parametrize(
    ("length", "expected"),
    [(1000, (1000, "1", "km")), (500, (500, "500", "m")), (2000, (2000, "2", "km"))],
)
def test_kilometres_begin_at_one(length, expected):
    bar = make_scale_bar(METRE, BAR_WIDTH * length / 259.9)
    assert (bar.length, bar.labels[-1][1], bar.symbol) == expected


# ------------------------------------------------------------------ north arrow


@pytest.mark.parametrize("view", [*VIEWS.values(), View(90.0, 90.0), View(300.0, 20.0)])
def test_needle_and_letter_lie_to_the_north(view):
    overlay, camera = annotated(view)
    axes = project_ground_axes(camera)
    (left, dark), (right, light) = overlay.polygons
    assert (dark, light) == (INK, PAPER)
    circle = max((p for p, _ in overlay.lines), key=len)
    center = (circle.max(axis=0) + circle.min(axis=0)) / 2
    np.testing.assert_allclose(circle[0], circle[-1], atol=1e-9)  # once around
    reach = np.hypot(*((circle - center) @ np.linalg.pinv(axes)).T)
    np.testing.assert_allclose(reach, reach[0], rtol=1e-6)
    assert np.abs(np.diff(circle, axis=0)).max() < 0.14 * np.abs(circle - center).max()
    tip = left[0]
    np.testing.assert_array_equal(tip, right[0])
    np.testing.assert_allclose(tip - center, 1.25 * 32.0 * axes[1], atol=1e-6)
    letter = overlay.place_of("N") - center
    letter[1] += 6.0
    assert letter @ axes[1] > (tip - center) @ axes[1]
    assert letter[0] * axes[1][1] - letter[1] * axes[1][0] == pytest.approx(0.0, abs=1e-6)
    west = left[1] - center
    assert west @ np.linalg.pinv(axes)[:, 0] < 0 < (right[2] - center) @ np.linalg.pinv(axes)[:, 0]
    (x, y), (other_x, other_y), notch = (
        (place - center) @ np.linalg.pinv(axes) for place in (left[1], right[2], left[2])
    )
    assert (other_x, other_y) == pytest.approx((-x, y), abs=1e-6)  # both halves alike
    assert y < notch[1] < 0


def test_north_is_up_on_a_map():
    overlay, _ = annotated(VIEWS["top"])
    tip = overlay.polygons[0][0][0]
    assert overlay.place_of("N")[1] + 6.0 > tip[1] > overlay.polygons[0][0][1][1]


# ----------------------------------------------------------------------- legend


@pytest.mark.parametrize("elevations", [(312.4, 398.6), (-20.0, 5.0), (0.01, 0.09)])
def test_the_legend_rises_from_left_to_right(elevations):
    overlay, _ = annotated(VIEWS["top"], elevations=elevations)
    low, high = elevations
    boxes = [r for r in overlay.rectangles if r[3] == 14.0]
    assert [color for *_, color in boxes] == [tuple(c) for c in interpolate_tints(100).tolist()]
    assert (np.diff([x for x, *_ in boxes]) > 0).all()
    left = boxes[0][0]
    width = boxes[-1][0] - left + boxes[1][0] - left
    ticks = sorted((x, words) for words, x, y, align in overlay.texts if y == 62.0 - 19.0)
    assert len(ticks) >= 3
    for x, words in ticks:
        value = float(words.replace(",", "").replace("\N{MINUS SIGN}", "-"))
        assert left + width * (value - low) / (high - low) == pytest.approx(x, abs=width * 0.01)
    assert ticks[0][0] == pytest.approx(left)
    assert ticks[-1][0] == pytest.approx(left + width)
    marks = {p[0][0] for p, _ in overlay.lines if len(p) == 2 and p[0][0] == p[1][0]}
    assert {x for x, _ in ticks} <= marks


def test_the_legend_of_level_ground_has_one_number():
    overlay, _ = annotated(VIEWS["top"], elevations=(7.0, 7.0))
    ticks = [words for words, _, y, _ in overlay.texts if y == 62.0 - 19.0]
    assert len(ticks) == 1
    assert math.isclose(float(ticks[0]), 7.0)
    assert overlay.place_of("Elevation (m)")[1] > 62.0


# -------------------------------------------------------------------- the layout


def test_the_margins_keep_the_terrain_from_the_words():
    overlay, _ = annotated(VIEWS["top"])
    frame = LAYOUT.frame
    assert isinstance(frame, Bounds)
    below, above = overlay.rectangles[:2]
    assert below[:2] == (0.0, 0.0)
    assert below[2] == above[2] == LAYOUT.width
    assert frame.ymin - 20 < below[3] <= frame.ymin
    assert frame.ymax <= above[1] < frame.ymax + 20
    assert above[1] + above[3] >= LAYOUT.height
    assert overlay.place_of("Title")[1] > overlay.place_of("Subtitle")[1] > above[1]


def written_title(title, subtitle="short"):
    """The lines of a title as an overlay is asked to write them, with their sizes."""
    overlay, camera = Recorder(), pv.Camera()
    aim(camera, np.eye(3), view=VIEWS["top"], frame=LAYOUT.frame, size=(1400, 900))
    annotate(overlay, LAYOUT, TitleBlock(title, subtitle, 1.0, LEGEND, METRE), camera)
    written = zip(overlay.texts, overlay.styles, strict=True)
    lines = [(said, y, size) for (said, _, y, _), (_, size, bold) in written if bold]
    return overlay, [line for line in lines if line[0] != "N"]


@pytest.mark.parametrize("count", [1, 14, 15, 30, 60, 80])
def test_a_long_title_is_written_whole_in_smaller_letters_and_more_lines(count):
    title = " ".join(["word"] * count)
    overlay, lines = written_title(title)
    assert " ".join(said for said, *_ in lines) == title
    assert len(lines) == {1: 1, 14: 1, 15: 1, 30: 2, 60: 3, 80: 3}[count]
    assert len({size for *_, size in lines}) == 1
    heights = [y for _, y, _ in lines] + [overlay.place_of("short")[1]]
    for (said, y, size), below in zip(lines, heights[1:], strict=True):
        assert overlay.measure_text(said, size=size) <= 1312
        assert y - below >= 1.2 * min(size, 17.0)
        assert y + size < LAYOUT.height
    assert heights[-1] > LAYOUT.frame.ymax + 8.0


@pytest.mark.parametrize("words", ["word " * 200, "x" * 10_000, "x " * 5_000])
def test_a_title_too_long_for_three_lines_is_cut_and_shows_it(words):
    overlay, lines = written_title(words.strip())
    assert len(lines) == 3
    *whole, (last, _, size) = lines
    assert last.endswith("...")
    assert 1312 - 6 * 0.6 * size < overlay.measure_text(last, size=size) <= 1312
    assert not any(said.endswith("...") for said, *_ in whole)
    kept = "".join(said for said, *_ in lines).removesuffix("...").replace(" ", "")
    assert words.replace(" ", "").startswith(kept)


def test_a_subtitle_is_cut_to_the_last_letter_that_fits():
    overlay, _ = written_title("Title", "y" * 300)
    (subtitle,) = [said for said, *_ in overlay.texts if said.startswith("y")]
    letter = overlay.measure_text("y", size=17.0)
    assert 1312 - letter < overlay.measure_text(subtitle, size=17.0) <= 1312
    assert subtitle.endswith("...")


def test_every_word_stands_where_the_layout_has_it():
    """The layout as a whole, so that nothing moves, is lost or says something else unseen."""
    overlay, camera = annotated(VIEWS["oblique"])
    pixels = measure_pixels_per_unit(camera, LAYOUT.height)
    assert 100 * pixels <= 260 < 200 * pixels
    tip = overlay.polygons[0][0][0]
    north = project_ground_axes(camera)[1]
    letter = tip + 12.0 * north / np.linalg.norm(north) - (0, 6)
    expected = [
        ("Title", 44.0, 838.0, "left"),
        ("Subtitle", 44.0, 808.0, "left"),
        ("N", *letter, "center"),
        ("0", 156.0, 76.0, "center"),
        ("50", 156.0 + 50 * pixels, 76.0, "center"),
        ("100", 156.0 + 100 * pixels, 76.0, "center"),
        ("m", 156.0 + 100 * pixels + 0.6 * 15 * 3 / 2 + 5.0, 76.0, "left"),
        ("true from left to right", 156.0, 38.0, "left"),
        ("Vertical exaggeration 2\N{MULTIPLICATION SIGN}", 500.0, 84.0, "left"),
        (VIEWS["oblique"].caption, 500.0, 61.0, "left"),
        ("Light from the northwest, 45° high", 500.0, 38.0, "left"),
        ("Elevation (m)", 956.0, 84.0, "left"),
        ("312", 956.0, 43.0, "center"),
        ("399", 1356.0, 43.0, "center"),
        *((f"{z}", 956.0 + 400 * (z - 312.4) / 86.2, 43.0, "center") for z in (340, 360, 380)),
    ]
    assert [words for words, *_ in overlay.texts] == [words for words, *_ in expected]
    for found, wanted in zip(overlay.texts, expected, strict=True):
        assert found[1:3] == pytest.approx(wanted[1:3])
        assert found[3] == wanted[3]


def test_words_have_the_size_and_colour_of_their_rank():
    overlay, _ = annotated(VIEWS["top"])
    styles = dict(zip((words for words, *_ in overlay.texts), overlay.styles, strict=True))
    dark, grey = (28, 34, 40), (96, 106, 114)
    assert styles["Title"] == (dark, 30.0, True)
    assert styles["Subtitle"] == (grey, 17.0, False)
    assert styles["N"] == (dark, 17, True)
    assert styles["200"] == styles["m"] == styles["Elevation (m)"] == (dark, 15, False)
    assert styles["true from left to right"] == styles["Map view, north up"] == (grey, 14, False)
    assert styles["312"] == (dark, 13, False)
    assert styles["360"] == (grey, 13, False)
    assert overlay.rectangles[0][-1] == overlay.rectangles[1][-1] == (255, 255, 255)


@pytest.mark.parametrize(
    ("view", "factor", "words"),
    [
        (VIEWS["top"], 2.0, "Hillshade with vertical exaggeration 2\N{MULTIPLICATION SIGN}"),
        (VIEWS["oblique"], 1.5, "Vertical exaggeration 1.5\N{MULTIPLICATION SIGN}"),
        (VIEWS["oblique"], 1.0, "Vertical exaggeration 1\N{MULTIPLICATION SIGN} (true to scale)"),
    ],
)
def test_the_exaggeration_is_put_in_words(view, factor, words):
    overlay, _ = annotated(view, exaggeration=factor)
    assert overlay.place_of(words).tolist() == [500.0, 84.0]


@pytest.mark.parametrize(
    ("elevations", "words"),
    [
        ((0.0, 100.0), ["0", "20", "40", "60", "80", "100"]),
        ((0.0, 96.0), ["0", "20", "40", "60", "80", "96"]),  # 80 + half its width has room
        ((1.0, 99.0), ["1", "20", "40", "60", "80", "99"]),
        ((0.0, 1.0), ["0.00", "0.2", "0.4", "0.6", "0.8", "1.00"]),
        ((-3.0, 4.0), ["-3.0", "-2", "-1", "0", "1", "2", "3", "4.0"]),
        ((1e5, 1e5 + 40), ["100,000", "100,010", "100,020", "100,030", "100,040"]),
    ],
)
def test_numbers_of_the_legend_do_not_run_into_each_other(elevations, words):
    overlay, _ = annotated(VIEWS["top"], elevations=elevations)
    low, high = elevations
    found = sorted((x, said) for said, x, y, _ in overlay.texts if y == 43.0)
    assert [said for _, said in found] == words
    for (x, said), (other, after) in itertools.pairwise(found):
        room = (overlay.measure_text(said, size=13) + overlay.measure_text(after, size=13)) / 2
        assert other - x >= room + 12.0
    inner = [float(said.replace(",", "")) for _, said in found[1:-1]]
    for (x, _), value in zip(found[1:-1], inner, strict=True):
        assert x == pytest.approx(956.0 + 400.0 * (value - low) / (high - low))


# ----------------------------------------------------------------------- lights


def test_the_sun_stands_in_the_northwest_and_the_sky_around():
    plotter = pv.Plotter(off_screen=True)
    add_lights(plotter)
    found = []
    for light in plotter.renderer.lights:
        east, north, up = light.position
        assert math.hypot(east, north, up) == pytest.approx(1.0)
        assert light.focal_point == (0.0, 0.0, 0.0)
        azimuth = math.degrees(math.atan2(east, north)) % 360 if up < 1 - 1e-9 else 0.0
        found.append((azimuth, math.degrees(math.asin(min(1.0, up))), light.intensity))
    found.sort(key=lambda one: -one[2])
    assert len(found) == 4
    assert found[0] == pytest.approx((315.0, 45.0, 0.58))
    assert all(height >= 45.0 - 1e-9 for _, height, _ in found)
    assert all(strength <= 0.10 for *_, strength in found[1:])
    assert max(height for _, height, _ in found) == pytest.approx(90.0, abs=1e-4)
    assert {round(azimuth) for azimuth, *_ in found[1:]} == {0, 45, 225}


def test_the_settings_of_vtk_come_back_after_drawing():
    from vtkmodules.vtkRenderingFreeType import vtkMathTextFreeTypeTextRenderer

    drawing = importlib.import_module("tinsmith.terrain.viewer.picture")
    words = vtkMathTextFreeTypeTextRenderer.GetInstance()
    before = words.GetDefaultBackend()
    try:
        for backend in (words.MathText, words.FreeType):
            words.SetDefaultBackend(backend)
            with drawing.keep_vtk_plain():
                assert words.GetDefaultBackend() == words.FreeType
            assert words.GetDefaultBackend() == backend
    finally:
        words.SetDefaultBackend(before)


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_parts_of_a_scale_lie_side_by_side(factor, can_draw):
    colors = np.array([(255, 0, 255), (0, 255, 255), (255, 255, 0)], np.uint8)
    plotter = pv.Plotter(off_screen=True, window_size=[int(100 * factor), int(80 * factor)])
    plotter.background_color = "white"
    plotter.disable_anti_aliasing()
    Overlay(plotter.renderer, factor=factor).draw_scale((20, 50), (60, 20), colors)
    shot = plotter.screenshot(return_img=True)[::-1].astype(int)
    plotter.close()
    for k, color in enumerate(colors.astype(int)):
        rows, columns = np.nonzero(np.abs(shot - color).sum(axis=2) < 120)
        box = np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]) / factor
        assert box == pytest.approx([20 + 20 * k, 50, 40 + 20 * k, 70], abs=1.1)
        assert len(rows) / factor**2 == pytest.approx(20 * 20, rel=0.1)


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_what_an_overlay_draws_is_where_it_was_asked_for(factor, can_draw):
    """In design pixels from the lower left corner, times the factor."""
    red, green, blue, black = (255, 0, 0), (0, 255, 0), (0, 0, 255), (0, 0, 0)
    plotter = pv.Plotter(off_screen=True, window_size=[int(200 * factor), int(120 * factor)])
    plotter.background_color = "white"
    plotter.disable_anti_aliasing()
    overlay = Overlay(plotter.renderer, factor=factor)
    overlay.draw_rectangle((20, 10), (60, 30), red)
    overlay.draw_polygon([(100, 10), (140, 10), (100, 50)], green)
    overlay.draw_line([(20, 80), (80, 80), (80, 110)], blue, width=3.0)
    for align, low in (("left", 20), ("center", 60), ("right", 95)):
        overlay.draw_text((150, low), "HHH", black, size=16, align=align)
    width = overlay.measure_text("HHH", size=16)
    shot = plotter.screenshot(return_img=True)[::-1].astype(int)

    def box_of(color):
        rows, columns = np.nonzero(np.abs(shot - color).sum(axis=2) < 120)
        corners = columns.min(), rows.min(), columns.max() + 1, rows.max() + 1
        return np.array(corners) / factor, len(rows) / factor**2

    box, area = box_of(red)
    assert box == pytest.approx([20, 10, 80, 40], abs=1.1)
    assert area == pytest.approx(60 * 30, rel=0.06)
    box, area = box_of(green)
    assert box == pytest.approx([100, 10, 140, 50], abs=1.6)
    assert area == pytest.approx(40 * 40 / 2, rel=0.08)
    box, area = box_of(blue)
    assert box == pytest.approx([20, 79, 81, 110], abs=2.1)
    assert area == pytest.approx(3 * 90, rel=0.15)
    dark = np.abs(shot - black).sum(axis=2) < 120
    for align, low in (("left", 20), ("center", 60), ("right", 95)):
        strip = dark[int((low - 4) * factor) : int((low + 20) * factor)]
        columns = np.flatnonzero(strip.any(axis=0)) / factor
        middle = 150 + {"left": width / 2, "center": 0, "right": -width / 2}[align]
        assert (columns.min() + columns.max()) / 2 == pytest.approx(middle, abs=2.5)
        assert 0.75 * width < np.ptp(columns) < width + 2
    overlay.clear()
    plotter.render()
    assert (plotter.screenshot(return_img=True) == 255).all()
    plotter.close()


def test_letters_beyond_latin_are_written_with_a_font_that_has_them():
    names = [_find_wide_font(bold=bold).name for bold in (False, True)]
    assert names == ["DejaVuSans.ttf", "DejaVuSans-Bold.ttf"]
    overlay, chosen = Overlay(None), []

    class Style:
        def __getattr__(self, name):
            return lambda *given: chosen.append((name, *given))

    for words in ("Größe \N{LATIN SMALL LETTER LONG S}", "Пример", ""):
        overlay._set_font(Style(), words, size=10, bold=False)
    kinds = [name for name, *_ in chosen if "Font" in name and name != "SetFontSize"]
    assert kinds == [
        *("SetFontFamilyToArial", "SetFontFamily", "SetFontFile", "SetFontFamilyToArial")
    ]
    overlay.factor = 0.01
    overlay._set_font(Style(), "x", size=10, bold=True)
    assert chosen[-2:] == [("SetFontSize", 1), ("SetBold", True)]
