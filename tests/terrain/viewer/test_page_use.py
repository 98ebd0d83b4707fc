"""The page in use: by keys, by touch, with a screen reader, in the dark, and its still picture."""

from __future__ import annotations

import base64
import io
import re

import numpy as np
import pytest
from support.orthos import make_square
from support.pages import open_page

import tinsmith as ts

pytestmark = pytest.mark.slow  # a browser for each

STATE = """window.terrain.then((p) => ({
  heading: p.scene.heading, away: p.scene.camera.position.distanceTo(p.scene.controls.target),
  target: p.scene.controls.target.toArray(), marked: p.tool.marked.length,
  readout: p.tool.readout.textContent }))"""


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    folder = tmp_path_factory.mktemp("use")
    tin = make_square()
    survey = ts.Survey(points=tin.points, crs=tin.crs, elevation_unit="m")
    return ts.preview({"Ground": tin, "Design": tin}, survey=survey).save(folder / "a.html")


@pytest.fixture(scope="module")
def page(saved):
    with open_page(saved) as page:
        yield page


# ------------------------------------------------------------------ keys


def test_the_order_of_the_focus_is_that_of_the_page(page):
    page.evaluate("document.activeElement.blur()")
    order = []
    for _ in range(30):
        page.keyboard.press("Tab")
        order.append(page.evaluate("document.activeElement.id"))
        if order[-1] == "theme":
            break
    wanted = [
        *("view", "fold", "surface-0", "tint", "exaggeration", "contours", "interval", "shading"),
        *("edges", "above", "start", "distance", "area", "picture", "theme"),
    ]
    assert [one for one in order if one in wanted] == wanted


def test_what_has_the_focus_is_seen(page):
    page.evaluate("document.activeElement.blur()")
    for _ in range(6):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement === document.body"):
            continue
        width = page.evaluate(
            "(() => { const s = getComputedStyle(document.activeElement);"
            " return [parseFloat(s.outlineWidth), s.outlineStyle]; })()"
        )
        assert width[0] >= 1
        assert width[1] != "none", page.evaluate("document.activeElement.outerHTML")


def test_a_distance_by_keys_alone(page):
    page.focus("#distance")
    page.keyboard.press("Enter")
    page.focus("#view")
    page.keyboard.press("Enter")
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Enter")
    assert re.match(r"Distance \d+\.\d+ m, along the ground", page.inner_text("#measured"))
    page.keyboard.press("Escape")
    assert page.is_hidden("#measured")
    page.keyboard.press("Enter")
    assert "Easting" in page.inner_text("#readout")
    page.keyboard.press("h")


def test_keys_zoom(page):
    page.focus("#view")
    before = page.evaluate(STATE)["away"]
    page.keyboard.press("+")
    assert page.evaluate(STATE)["away"] < before
    page.keyboard.press("-")
    assert page.evaluate(STATE)["away"] == pytest.approx(before, rel=1e-6)


def test_settings_fold_by_keys(page):
    page.focus("#fold")
    page.keyboard.press("Enter")
    assert page.get_attribute("#fold", "aria-expanded") == "false"
    assert page.is_hidden("#settings")
    page.keyboard.press("Enter")
    assert page.is_visible("#settings")


# ------------------------------------------------------------------ names and contrast


def test_each_control_has_a_name_and_a_role(page):
    tree = page.locator("main").aria_snapshot()
    for line in (
        "heading", 'button "Settings"', 'combobox "Colour"', 'slider "Vertical exaggeration"',
        'checkbox "Contours every"', 'spinbutton "Interval of the contours"', 'checkbox "Shading"',
        'checkbox "Triangle edges"', 'checkbox "Ground"', 'group "Surfaces"', 'group "Measure"',
        'button "From above"', 'button "Distance, profile"', 'img "North arrow"',
        'application "3D view of the terrain',
    ):  # fmt: skip
        assert line in tree, tree
    unnamed = page.evaluate("""() => [...document.querySelectorAll("button, input, select")]
      .filter((e) => !e.textContent.trim() && !e.labels?.length && !e.ariaLabel)
      .map((e) => e.outerHTML)""")
    assert unnamed == []
    assert page.get_attribute("html", "lang") == "en"
    ids = page.evaluate("[...document.querySelectorAll('[id]')].map((e) => e.id)")
    assert len(ids) == len(set(ids))


def test_the_slider_tells_its_factor(page):
    page.fill("#exaggeration", "0.3010")
    assert page.get_attribute("#exaggeration", "aria-valuetext") == "2 times"


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_words_stand_out(saved, theme):
    """A contrast of 4.5 and more, as WCAG 2.2 asks for (1.4.3)."""
    with open_page(saved, color_scheme=theme) as page:
        assert page.get_attribute("html", "data-theme") == theme
        page.click("#distance")
        page.evaluate(
            "window.terrain.then((p) => { p.tool.mark(500, 400); p.tool.mark(640, 420); })"
        )
        found = page.evaluate("""() => [...document.querySelectorAll(
            "h1, header p, label, button, legend, figcaption, #ticks span, #measured span, "
            + "#measured div, #measured svg text, #readout")]
          .filter((e) => e.textContent.trim() && !e.disabled)
          .map((e) => { const s = getComputedStyle(e);
            let b = e, back = "rgba(0, 0, 0, 0)";
            while (b && back === "rgba(0, 0, 0, 0)") {
              back = getComputedStyle(b).backgroundColor; b = b.parentElement; }
            return [e.textContent.trim().slice(0, 30), e instanceof SVGElement ? s.fill : s.color,
                    back]; })""")
    assert len(found) > 15
    poor = [one for one in found if measure_contrast(one[1], one[2]) < 4.5]
    assert poor == []


def measure_contrast(ink, paper):
    lights = []
    for color in (ink, paper):
        share = np.array([float(one) for one in re.findall(r"[\d.]+", color)[:3]]) / 255
        linear = np.where(share <= 0.03928, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
        lights.append(linear @ (0.2126, 0.7152, 0.0722))
    low, high = sorted(lights)
    return (high + 0.05) / (low + 0.05)


# ------------------------------------------------------------------ touch


class Fingers:
    """Touches sent to Chromium as a screen sends them."""

    def __init__(self, page):
        self.session = page.context.new_cdp_session(page)

    def send(self, kind, *places):
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(places)]
        self.session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def drag(self, *paths, steps=6):
        for k in range(steps + 1):
            places = [
                (a + (c - a) * k / steps, b + (d - b) * k / steps) for (a, b), (c, d) in paths
            ]
            self.send("touchStart" if k == 0 else "touchMove", *places)
        self.send("touchEnd")


@pytest.fixture
def touched(saved):
    phone = {"has_touch": True, "is_mobile": True, "viewport": {"width": 800, "height": 900}}
    with open_page(saved, **phone) as page:
        yield page, Fingers(page)


def test_one_finger_turns(touched):
    page, fingers = touched
    before = page.evaluate(STATE)
    fingers.drag(((300, 500), (420, 500)))
    after = page.evaluate(STATE)
    assert abs(after["heading"] - before["heading"]) > 5
    assert after["away"] == pytest.approx(before["away"], rel=1e-6)


def test_two_fingers_zoom_and_move(touched):
    page, fingers = touched
    before = page.evaluate(STATE)
    fingers.drag(((300, 500), (200, 500)), ((400, 500), (500, 500)))
    zoomed = page.evaluate(STATE)
    assert zoomed["away"] < 0.7 * before["away"]
    fingers.drag(((300, 400), (300, 500)), ((400, 400), (400, 500)))
    moved = page.evaluate(STATE)["target"]
    assert np.hypot(*np.subtract(moved, zoomed["target"])[:2]) > 1


def test_a_tap_reads_a_place(touched):
    page, fingers = touched
    fingers.drag(((400, 450), (400, 450)), steps=1)
    assert "Elevation" in page.evaluate(STATE)["readout"]


def test_taps_measure_and_two_fingers_do_not(touched):
    page, fingers = touched
    page.evaluate("window.terrain.then((p) => p.tool.choose('distance'))")
    fingers.drag(((380, 450), (380, 450)), steps=1)
    fingers.drag(((300, 500), (300, 500)), ((400, 500), (440, 500)))
    fingers.drag(((300, 450), (360, 450)))
    assert page.evaluate(STATE)["marked"] == 1
    fingers.drag(((430, 470), (430, 470)), steps=1)
    assert page.evaluate(STATE)["marked"] == 2


# ------------------------------------------------------------------ the still picture


def test_the_saved_picture_has_title_legend_and_arrow(page, tmp_path):
    pil = pytest.importorskip("PIL.Image")
    text = page.evaluate("window.terrain.then((p) => { p.legend.setTint('elevation');"
                         " return p.furniture.takePicture(); })")  # fmt: skip
    picture = np.asarray(pil.open(io.BytesIO(base64.b64decode(text.partition(",")[2]))))[..., :3]
    assert picture.shape[:2] == (800, 1200)
    paper = picture[400, 2].astype(int)

    def inked(top, bottom, left, right):
        part = picture[top:bottom, left:right].astype(int)
        return (np.abs(part - paper).max(axis=2) > 60).mean()

    assert inked(14, 40, 10, 160) > 0.03  # title
    assert inked(756, 770, 976, 1184) > 0.5  # ramp of the legend
    assert inked(10, 60, 1140, 1180) > 0.05  # north arrow
    assert inked(770, 790, 16, 60) > 0.02  # scale bar


def test_the_picture_is_offered_as_a_file(page):
    with page.expect_download() as told:
        page.click("#picture")
    assert told.value.suggested_filename == "Terrain surface.png"
