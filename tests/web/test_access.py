"""Every kind of page by axe-core: no rule of WCAG 2.1, level A or AA, is broken."""

from __future__ import annotations

import pytest
from support.orthos import make_square
from support.pages import open_page, open_served
from support.tilesets import write_quadtree
from support.validators import find_violations

import tinsmith as ts

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

SCREENS = {
    "desktop": {"viewport": {"width": 1200, "height": 800}},
    "desktop, dark": {"viewport": {"width": 1200, "height": 800}, "color_scheme": "dark"},
    "phone": {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True},
}
MEASURE = """() => window.terrain.then((p) => { document.getElementById("distance").click();
  const { clientWidth: w, clientHeight: h } = p.scene.canvas;
  p.tool.mark(0.45 * w, 0.5 * h); p.tool.mark(0.55 * w, 0.6 * h);
  p.tool.read(0.5 * w, 0.5 * h); })"""
OPEN = """() => { for (const one of document.querySelectorAll("details")) one.open = true;
  const fold = document.getElementById("fold");
  if (fold.getAttribute("aria-expanded") === "false") fold.click();
  for (const id of ["contours", "comparing"]) {
    const box = document.getElementById(id);
    if (box.checkVisibility() && !box.checked) box.click(); } }"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("access")
    ground = make_square()
    design = ground.replace(points=ground.points * (1, 1, 1.01))
    lined = ts.triangulate(
        ground.points, breaklines=[ground.points[[0, -1]]], crs=ground.crs, elevation_unit="m"
    )
    survey = ts.Survey(points=ground.points, crs=ground.crs, elevation_unit="m")
    ts.preview(lined, survey=survey, title="One").save(folder / "one.html")
    ts.preview({"Ground": lined, "Design": design}, title="Two").save(folder / "several.html")
    write_quadtree(folder / "tiles", levels=2)
    ts.preview_tileset(folder / "tiles", output=folder / "tiles/index.html")
    return folder


def check_panels(page):
    """Examine a page at its start, with a measurement, and with each panel open."""
    assert find_violations(page) == []
    page.evaluate(MEASURE)
    assert page.is_visible("#measured")
    assert find_violations(page) == []
    page.evaluate(OPEN)
    assert page.is_visible("#settings")
    assert find_violations(page) == []


@pytest.mark.parametrize("screen", SCREENS)
@pytest.mark.parametrize("name", ["one", "several"])
def test_pages_of_surfaces(folder, name, screen):
    with open_page(folder / f"{name}.html", **SCREENS[screen]) as page:
        check_panels(page)


@pytest.mark.parametrize("screen", SCREENS)
def test_pages_of_tilesets(folder, screen):
    with open_served(folder / "tiles", "index.html", **SCREENS[screen]) as page:
        page.evaluate("window.terrain.then((p) => p.tileset.settle())")
        check_panels(page)
    page_path = folder / "tiles/index.html"
    with open_page(page_path, ready="Promise.resolve(1)", **SCREENS[screen]) as page:
        page.wait_for_selector("#folder")
        assert find_violations(page) == []


def test_a_page_without_webgl(folder):
    with open_page(folder / "one.html", webgl=False) as page:
        assert find_violations(page) == []


def test_axe_finds_faults(folder):
    with open_page(folder / "several.html") as page:
        page.evaluate("""() => { document.documentElement.removeAttribute("lang");
          document.getElementById("picture").textContent = ""; }""")
        assert {rule for rule, *_ in find_violations(page)} == {"html-has-lang", "button-name"}
