"""The page on a phone: panels lie beside the view, nothing is cut, and fingers reach everything."""

from __future__ import annotations

import pytest
from support.orthos import make_square
from support.pages import open_page

import tinsmith as ts

pytestmark = pytest.mark.slow  # a browser for each

SCREENS = [(360, 640), (390, 844), (640, 360), (844, 390)]
LEAST_TARGET = 40
"""Pixels of width and height of what a finger touches."""

BOXES = """() => Object.fromEntries(
  ["view", "panel", "measured", "readout", "legend"].map((id) => {
    const e = document.getElementById(id), b = e.getBoundingClientRect();
    return [id, b.width * b.height > 0 ? [b.left, b.top, b.right, b.bottom] : null]; }))"""

TARGETS = """() => [...document.querySelectorAll("button, summary, select, input")]
  .filter((e) => e.checkVisibility())
  .map((e) => { const whole = e.type === "checkbox" ? e.closest("label") : e;
    const b = whole.getBoundingClientRect();
    return [e.id || e.tagName, b.width, b.height]; })"""

CUT = """() => [...document.querySelectorAll(
    "button, h1, summary, header p, figcaption, #ticks span, #result, #readout, #side legend, "
    + "#settings label")]
  .filter((e) => e.checkVisibility() && !e.classList.contains("unseen"))
  .filter((e) => e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0
    && getComputedStyle(e).display !== "inline")
  .map((e) => [e.id, e.textContent.slice(0, 40), e.scrollWidth, e.clientWidth])"""


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    ground = make_square()
    design = ground.replace(points=ground.points * (1, 1, 1.01))
    lined = ts.triangulate(
        ground.points,
        breaklines=[ground.points[[0, -1]]],
        crs=ground.crs,
        elevation_unit="m",
    )
    path = tmp_path_factory.mktemp("phone") / "a.html"
    title = "Regional road 12, section from the bridge to the quarry"
    return ts.preview({"Ground": lined, "Design": design}, title=title).save(path)


@pytest.fixture(scope="module", params=SCREENS, ids=lambda size: f"{size[0]} x {size[1]}")
def phone(request, saved):
    width, height = request.param
    viewport = {"width": width, "height": height}
    with open_page(saved, viewport=viewport, has_touch=True, is_mobile=True) as page:
        yield page


def press(page, *ids):
    for one in ids:
        page.locator(f"#{one}").tap()
    page.wait_for_timeout(150)


def check_layout(page):
    """Nothing lies over the view or over another panel, and nothing is cut."""
    boxes = {k: box for k, box in page.evaluate(BOXES).items() if box is not None}
    names = list(boxes)
    for k, one in enumerate(names):
        for other in names[k + 1 :]:
            a, b = boxes[one], boxes[other]
            wide = min(a[2], b[2]) - max(a[0], b[0])
            high = min(a[3], b[3]) - max(a[1], b[1])
            assert min(wide, high) <= 0.5, f"{one} {a} and {other} {b} cover each other"
    size = page.viewport_size
    view = boxes["view"]
    assert view[2] - view[0] >= 200
    assert view[3] - view[1] >= 119
    assert page.evaluate("document.documentElement.scrollWidth") <= size["width"]
    assert max(box[2] for box in boxes.values()) <= size["width"]
    assert page.evaluate(CUT) == []
    small = [one for one in page.evaluate(TARGETS) if min(one[1:]) < LEAST_TARGET - 0.5]
    assert small == []


def test_panels_lie_beside_the_view(phone):
    assert phone.get_attribute("#fold", "aria-expanded") == "false"
    check_layout(phone)
    size = phone.viewport_size
    for box in phone.evaluate(BOXES).values():
        assert box is None or box[3] <= size["height"] + 0.5


def test_settings_open_beside_the_view(phone):
    press(phone, "fold")
    check_layout(phone)
    for one in ("theme", "comparing", "edges"):
        phone.locator(f"#{one}").scroll_into_view_if_needed()
        box = phone.locator(f"#{one}").bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= phone.viewport_size["width"]
        assert 0 <= box["y"] <= phone.viewport_size["height"] - box["height"]
    press(phone, "comparing")
    check_layout(phone)
    press(phone, "comparing", "fold")


def test_a_measurement_is_taken_by_taps(phone):
    press(phone, "distance")
    check_layout(phone)
    view = phone.locator("#view").bounding_box()
    for x, y in ((0.45, 0.45), (0.55, 0.55)):
        phone.touchscreen.tap(view["x"] + x * view["width"], view["y"] + y * view["height"])
    assert phone.inner_text("#result").startswith("Distance ")
    check_layout(phone)
    letters = phone.evaluate("""() => { const s = document.querySelector("#curves svg");
      return 11 * s.getBoundingClientRect().width / s.viewBox.baseVal.width; }""")
    assert letters > 9
    press(phone, "done")
    assert phone.locator("#done").is_hidden()
    press(phone, "clear")
    assert phone.locator("#measured").is_hidden()


def test_the_whole_terrain_is_in_view_whatever_its_size(phone):
    corners = """window.terrain.then((p) => { const s = p.scene.models[0].surface, found = [];
      p.scene.draw();
      for (const x of [s.low[0], s.high[0]]) for (const y of [s.low[1], s.high[1]])
        found.push(p.scene.project(x, y, s.high[2]));
      return [found, p.scene.canvas.clientWidth, p.scene.canvas.clientHeight]; })"""
    for button in ("fold", "fold"):
        press(phone, button)
        found, width, height = phone.evaluate(corners)
        assert all(0 <= x <= width and 0 <= y <= height for x, y, _ in found)


def test_notes_are_folded_and_open_by_a_tap(saved):
    with open_page(
        saved, viewport={"width": 360, "height": 640}, has_touch=True, is_mobile=True
    ) as page:
        page.evaluate("""() => { const words = document.querySelector("#remarks p");
          words.textContent = "A note that is long. ".repeat(30); }""")
        assert page.evaluate("document.getElementById('remarks').open") is False
        page.locator("summary").tap()
        page.wait_for_timeout(150)
        check_layout(page)
