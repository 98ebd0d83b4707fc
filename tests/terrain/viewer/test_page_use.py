"""The page in use: by keys, by touch, with a screen reader, in the dark, and its still picture."""

from __future__ import annotations

import base64
import io
import itertools
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


def wait_for_picture(page):
    """Wait until the view has its new size and is drawn."""
    page.evaluate("""new Promise((done) => requestAnimationFrame(() =>
        requestAnimationFrame(() => requestAnimationFrame(done))))""")


def place(page, x, y):
    """Return the pixel of a place in the view, given by shares of its width and height."""
    box = page.locator("#view").bounding_box()
    return box["x"] + x * box["width"], box["y"] + y * box["height"]


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
        if order[-1] == "area":
            break
    wanted = [
        *("view", "fold", "surface-0", "comparing", "tint", "exaggeration", "contours", "interval"),
        *("shading", "edges", "picture", "link", "theme", "above", "start", "distance", "area"),
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
    """Space marks the place in the middle, Enter ends, Escape cancels."""
    page.focus("#distance")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "view"
    assert "Space marks" in page.inner_text("#told")
    wait_for_picture(page)
    page.keyboard.press(" ")
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press(" ")
    found = r"Distance \d+\.\d+ m, along the ground .* rise .*, grade"
    assert re.match(found, page.inner_text("#result"))
    assert re.match(f"2 places. {found}", page.inner_text("#told"))
    page.keyboard.press("Backspace")
    assert page.evaluate(STATE)["marked"] == 1
    page.keyboard.press(" ")
    page.keyboard.press("Enter")
    assert "Measurement ended. Distance" in page.inner_text("#told")
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press(" ")  # reads
    assert page.evaluate(STATE)["marked"] == 2
    assert "Easting" in page.inner_text("#readout")
    assert page.is_hidden("#done")
    page.keyboard.press("Escape")
    assert page.is_hidden("#measured")
    page.keyboard.press("Enter")
    assert "Easting" in page.inner_text("#readout")
    page.keyboard.press("h")


def test_enter_ends_a_measurement_of_the_mouse(page):
    page.click("#area")
    wait_for_picture(page)
    for x, y in ((0.4, 0.5), (0.6, 0.5), (0.5, 0.6)):
        page.mouse.click(*place(page, x, y))
    page.keyboard.press("Enter")
    page.mouse.click(*place(page, 0.45, 0.45))
    assert page.evaluate(STATE)["marked"] == 3
    assert page.inner_text("#result").startswith("Area ")
    page.focus("#clear")
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.id") == "view"
    page.click("#distance")
    wait_for_picture(page)
    page.mouse.click(*place(page, 0.4, 0.5))
    page.mouse.dblclick(*place(page, 0.6, 0.5))
    assert page.evaluate(STATE)["marked"] == 2
    assert page.is_hidden("#done")
    page.click("#clear")


def test_the_view_is_told_once_it_rests(page):
    page.focus("#view")
    page.keyboard.press("t")
    page.keyboard.press("ArrowDown")
    page.evaluate("""new Promise((done) => {
      const told = document.getElementById("told");
      const look = () => told.textContent.startsWith("Seen") ? done() : setTimeout(look, 50);
      look(); })""")
    assert re.fullmatch(
        r"Seen from the south, 8\d degrees above the horizon\.", page.inner_text("#told")
    )
    assert re.match(r"Elevations from [\d.]+ to [\d.]+ m; ", page.text_content("#extent"))
    assert page.get_attribute("#view", "aria-describedby") == "extent"
    page.keyboard.press("h")


def test_nothing_moves_by_itself(saved):
    with open_page(saved, reduced_motion="reduce") as page:
        assert page.evaluate("document.getAnimations().length") == 0
        before = page.evaluate(STATE)
        page.wait_for_timeout(300)
        assert page.evaluate(STATE) == before


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
    wait_for_picture(page)
    middle, right = place(page, 0.45, 0.5), place(page, 0.6, 0.5)
    fingers.drag((middle, middle), steps=1)
    fingers.drag((place(page, 0.4, 0.6), place(page, 0.4, 0.6)), (right, place(page, 0.65, 0.5)))
    fingers.drag((middle, right))
    assert page.evaluate(STATE)["marked"] == 1
    fingers.drag((place(page, 0.55, 0.52), place(page, 0.55, 0.52)), steps=1)
    assert page.evaluate(STATE)["marked"] == 2


# ------------------------------------------------------------------ the still picture


def test_the_saved_picture_has_title_legend_and_arrow(page, tmp_path):
    pil = pytest.importorskip("PIL.Image")
    text = page.evaluate("window.terrain.then((p) => { p.legend.setTint('elevation');"
                         " return p.furniture.takePicture(); })")  # fmt: skip
    picture = np.asarray(pil.open(io.BytesIO(base64.b64decode(text.partition(",")[2]))))[..., :3]
    box = page.locator("#view").bounding_box()
    height, width = picture.shape[:2]
    assert (height, width) == (round(box["height"]), round(box["width"]))
    paper = picture[400, 2].astype(int)

    def inked(top, bottom, left, right):
        part = picture[top:bottom, left:right].astype(int)
        return (np.abs(part - paper).max(axis=2) > 60).mean()

    assert inked(14, 40, 10, 160) > 0.03  # title
    assert inked(height - 44, height - 32, width - 224, width - 16) > 0.5  # ramp of the legend
    assert inked(10, 60, width - 60, width - 20) > 0.05  # north arrow
    assert inked(height - 30, height - 10, 16, 60) > 0.02  # scale bar


def test_the_picture_is_offered_as_a_file(page):
    with page.expect_download() as told:
        page.click("#picture")
    assert told.value.suggested_filename == "Terrain surface.png"


# ------------------------------------------------------------------ on paper and for the hostile


def test_the_terrain_is_printed_without_the_controls(saved, tmp_path):
    """What WebGL has drawn is gone on paper: a picture stands in its place."""
    with open_page(saved) as page:
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        page.emulate_media(media="print")
        assert page.is_hidden("#side")
        assert page.is_hidden("#view")
        colors = page.evaluate("""() => { const c = document.getElementById("printed");
          const pixels = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
          return new Set(new Uint32Array(pixels.buffer)).size; }""")
        assert colors > 500
        page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        assert page.locator("#printed").count() == 0


def test_long_elevations_stand_beside_each_other(tmp_path):
    points = np.random.default_rng(1).random((60, 3)) * (100, 100, 5) + (0, 0, 1e6)
    path = ts.preview(ts.triangulate(points)).save(tmp_path / "a.html")
    with open_page(path) as page:
        boxes = page.evaluate("""() => [...document.querySelectorAll("#ticks span")].map((e) => {
          const b = e.getBoundingClientRect(); return [b.left, b.right]; })""")
        assert all(a[1] + 4 < b[0] for a, b in itertools.pairwise(boxes))
        assert re.match(r"Elevations from 1\d+\.\d+ to 1\d+\.\d+; ", page.text_content("#extent"))
