"""Odd surfaces on the page: every readout against the surface, from every side."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.pages import open_page

import tinsmith as ts

pytestmark = pytest.mark.slow  # a browser for each

READ = """window.terrain.then((p) => {
  const found = [];
  for (const [azimuth, tilt, factor] of [[195, 35, null], [180, 90, null], [40, 60, 3]]) {
    if (factor !== null) p.settings.setExaggeration(factor);
    p.scene.look(azimuth, tilt); p.scene.draw(); p.scene.camera.updateMatrixWorld();
    for (let x = 250; x < 1000; x += 83) for (let y = 120; y < 720; y += 67) {
      const m = p.scene.pick(x, y);
      if (m === null) continue;
      p.tool.read(x, y);
      found.push([m.hit.x, m.hit.y, m.hit.z, m.model.surface.slope(m.hit.triangle),
                  p.tool.readout.textContent, p.scene.models.indexOf(m.model)]); } }
  return [p.payload.origin, p.payload.scale, found]; })"""


def grid(n, size, height, origin=(0.0, 0.0), **more):
    """Return the TIN of a wave on a square, its elevations given by share of the way."""
    u, v = (one.ravel() for one in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    places = np.column_stack([u * size + origin[0], v * size + origin[1], height(u, v)])
    return ts.triangulate(places, **more)


def wave(height):
    return lambda u, v: height * np.sin(5 * u) * np.cos(4 * v)


UTM = (742_000.123456, 4_030_000.654321)
SURFACES = {
    "one triangle": lambda: ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]]),
    "flat": lambda: grid(5, 100, lambda u, v: 0 * u + 7),
    "small": lambda: grid(9, 1e-3, wave(1e-4)),
    "small at UTM": lambda: grid(9, 1e-3, wave(1e-4), UTM, crs="EPSG:32616"),
    "large": lambda: grid(30, 1e7, wave(5e3)),
    "huge": lambda: grid(8, 1e12, wave(5e3)),
    "almost flat": lambda: grid(6, 50, lambda u, v: 300 + np.round(5 * u) * 1e-12),
    "almost flat at 0": lambda: grid(6, 50, lambda u, v: np.round(5 * u) * 1e-12),
    "degrees": lambda: grid(12, 0.5, wave(300), (8, 60), crs="EPSG:4326", elevation_unit="m"),
    "degrees, feet": lambda: grid(
        9, 0.01, wave(99), (-84, 36), crs="EPSG:4326", elevation_unit="ft"
    ),
    "feet": lambda: grid(12, 1000, wave(30), (1.8e6, 6e5), crs="EPSG:2274"),
    "feet, metres": lambda: grid(
        12, 1000, wave(30), (1.8e6, 6e5), crs="EPSG:2274", elevation_unit="m"
    ),
    "steep": lambda: grid(9, 10, wave(200), UTM),
    "clipped": lambda: ts.triangulate(
        grid(20, 90, wave(9)).points, boundary=[[[5, 5], [80, 9], [70, 85], [11, 60]]]
    ),
}


ALSO = ("large", "small", "almost flat at 0", "degrees, feet", "feet", "steep", "one triangle")
"""Left to the slow tests: others in the list are much like them."""


@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=[pytest.mark.slow] * (one in ALSO)) for one in SURFACES]
)
def test_readouts_are_those_of_the_surface(name, tmp_path):
    tin = SURFACES[name]()
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        origin, scale, found = page.evaluate(READ)
    assert len(found) >= 8
    numbers = np.array([one[:4] for one in found])
    places = numbers[:, :2] / scale + np.array(origin[:2])
    span = np.ptp(tin.points, axis=0)
    truth = tin.interpolate(places, extrapolate="nearest")
    tolerance = 1e-6 * max(span[2], 1e-6 * span[:2].max()) + 4 * np.spacing(np.abs(truth).max())
    if span[2] < 1e-9:
        tolerance = 1e-3 * span[2] + np.spacing(np.abs(truth).max())
    assert np.abs(truth - numbers[:, 2] - origin[2]).max() <= tolerance
    triangles = tin.locate(places)
    assert (triangles >= 0).mean() > 0.9
    slopes = ts.slope(tin)[np.maximum(triangles, 0)]
    # A place on an edge may be told of either triangle.
    off = np.abs(slopes - numbers[:, 3])[triangles >= 0]
    assert np.quantile(off, 0.95) < 1e-3
    check_words(found, places, truth, tolerance)


def check_words(found, places, truth, tolerance):
    """Read the words as a person does: no digit that is wrong, and none that is missing."""
    pattern = re.compile(
        r"(?:Easting|Longitude) (-?[\d.]+)\S*.*? +(?:Northing|Latitude) (-?[\d.]+)\S*.*? +"
        r"Elevation (-?[\d.]+)"
    )
    for (*_, words, _), place, elevation in zip(found, places, truth, strict=True):
        told = pattern.match(words)
        for text, value in zip(told.groups(), (*place, elevation), strict=True):
            decimals = len(text.partition(".")[2])
            half = 0.5 * 10.0**-decimals
            assert float(text) == pytest.approx(value, abs=half + tolerance + 1e-9 * abs(value))
            assert text != "-0"


def test_readouts_of_the_second_surface(tmp_path):
    ground = grid(12, 300, wave(8), UTM, crs="EPSG:32616", elevation_unit="m")
    design = grid(5, 300, lambda u, v: 20 + 9 * u, UTM, crs="EPSG:32616", elevation_unit="m")
    path = ts.preview({"Ground": ground, "Design": design}).save(tmp_path / "a.html")
    with open_page(path) as page:
        for k, tin in enumerate((ground, design)):
            for other in range(3):
                page.set_checked(f"#surface-{other}", other == k)
            origin, scale, found = page.evaluate(READ)
            assert {one[5] for one in found} == {k}
            assert all(("Ground", "Design")[k] in one[4] for one in found)
            numbers = np.array([one[:3] for one in found])
            places = numbers[:, :2] / scale + np.array(origin[:2])
            truth = tin.interpolate(places, extrapolate="nearest")
            assert np.abs(truth - numbers[:, 2] - origin[2]).max() < 1e-4


MEASURE = """window.terrain.then((p) => {
  const at = (x, y) => ({ model: p.scene.models[0], hit: { triangle: 0, x, y, z: 0 } });
  const s = p.payload.scale, o = p.payload.origin;
  p.tool.choose("TOOL");
  p.tool.marked = PLACES.map(([x, y]) => at((x - o[0]) * s[0], (y - o[1]) * s[1]));
  p.tool.showMeasured();
  const box = document.getElementById("measured");
  const words = box.firstChild.textContent, svg = box.querySelector("svg");
  const curves = svg === null ? 0 : svg.querySelectorAll("polyline").length;
  p.tool.clear();
  return [words, curves]; })"""


def measure(page, tool, places):
    code = MEASURE.replace("TOOL", tool).replace("PLACES", repr(np.asarray(places).tolist()))
    return page.evaluate(code)


@pytest.mark.parametrize("name", ["degrees", "feet, metres", "steep", "large"])
def test_lengths_along_the_ground(name, tmp_path):
    tin = SURFACES[name]()
    low, span = tin.points.min(axis=0)[:2], np.ptp(tin.points, axis=0)[:2]
    line = low + span * np.array([[0.1, 0.15], [0.85, 0.35], [0.6, 0.9]])
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        words, curves = measure(page, "distance", line)
    assert curves > 0
    flat, ground = (float(one) for one in re.findall(r"(?:Distance|ground) ([\d.]+)", words))
    shown = 0.5 * 10.0 ** -len(words.split()[1].rstrip(",").partition(".")[2])
    if name == "degrees":
        from pyproj import Geod

        expected = Geod(ellps="WGS84").line_length(*line.T)
        assert flat == pytest.approx(expected, rel=1e-4)
        assert ground > flat
        return
    expected = np.hypot(*np.diff(line, axis=0).T).sum()
    assert flat == pytest.approx(expected, rel=1e-6, abs=shown)
    along = ts.profile(tin, line)
    distances, z = (np.asarray(along[key]) for key in ("station", "elevation"))
    up = 3937 / 1200 if name == "feet, metres" else 1.0
    assert ground == pytest.approx(
        np.hypot(np.diff(distances), up * np.diff(z)).sum(), rel=1e-5, abs=shown
    )


def test_an_area_in_degrees(tmp_path):
    tin = SURFACES["degrees"]()
    ring = np.array([[8.1, 60.05], [8.4, 60.1], [8.45, 60.4], [8.05, 60.3]])
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        words, _ = measure(page, "area", ring)
    from pyproj import Geod

    area, perimeter = Geod(ellps="WGS84").polygon_area_perimeter(*ring.T)
    told = [float(one) for one in re.findall(r"[\d.]+", words)]
    assert told[0] == pytest.approx(abs(area), rel=1e-3)
    assert told[-1] == pytest.approx(perimeter, rel=1e-4)


def test_a_line_beyond_the_surface_and_a_polygon_that_crosses_itself(tmp_path):
    tin = SURFACES["clipped"]()
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        words, _ = measure(page, "distance", [[-20, 40], [40, 40]])
        assert re.match(r"Distance 60.000, along the ground \d+.\d+ on the \d+.\d+ that", words)
        words, _ = measure(page, "area", [[20, 20], [60, 60], [60, 20], [20, 60]])
        assert "cannot be told" in words
        words, _ = measure(page, "area", [[20, 20], [60, 20], [60, 60], [20, 60]])
        assert words == "Area 1600.000, perimeter 160.000"


@pytest.mark.every_case("slow")
@pytest.mark.parametrize(
    "name",
    ["</script><b>x", "x" * 10_000, "\u202e\u05d0\u05d1\u05d2 right to left", "\U0001f3d4 \u26cf"],
)
def test_hostile_names_of_surfaces_and_points(name, tmp_path):
    tin = SURFACES["flat"]()
    survey = ts.Survey(points=tin.points, attributes={"number": np.array([name] * 25)})
    path = ts.preview({name: tin, "b": tin}, survey=survey, title=name).save(tmp_path / "a.html")
    with open_page(path) as page:
        page.check("#points")
        page.evaluate("window.terrain.then((p) => { p.scene.draw(); p.tool.read(500, 400); })")
        box = page.locator("#panel").bounding_box()
        assert box["width"] < 260
        assert page.locator("label[for='surface-0'], #surfaces label").first.inner_text().strip()
        assert page.evaluate("document.querySelectorAll('b, script').length") == 2
        assert page.evaluate("document.documentElement.scrollWidth") <= 1200


def test_long_triangles_aslant_fill_few_cells(tmp_path):
    """Between a curve and a far vertex: the boxes of a fan would be most of the cells, each."""
    along = np.linspace(0, 1, 3000)
    curve = np.column_stack([1000 * along, 1000 * along**2, along])
    tin = ts.triangulate(np.vstack([curve, [[0, 1000, 0]]]))
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        cells = page.evaluate(
            "window.terrain.then((p) => p.scene.models[0].surface.members.length)"
        )
        origin, scale, found = page.evaluate(READ)
    assert cells < 60 * len(tin.triangles)
    numbers = np.array([one[:3] for one in found])
    places = numbers[:, :2] / scale + np.array(origin[:2])
    truth = tin.interpolate(places, extrapolate="nearest")
    assert np.abs(truth - numbers[:, 2] - origin[2]).max() < 1e-4


# ------------------------------------------------------------------ large surfaces


def scatter(triangles):
    xy = np.random.default_rng(1).random((triangles // 2, 2)) * 2000
    z = 300 + 30 * np.sin(xy[:, 0] / 150) * np.cos(xy[:, 1] / 210)
    return ts.triangulate(
        np.round(np.column_stack([xy + np.array(UTM), z]), 3), crs="EPSG:32616", elevation_unit="m"
    )


def test_a_slow_machine_draws_fewer_triangles_while_the_view_moves(tmp_path):
    tin = scatter(150_000)
    path = ts.preview(tin).save(tmp_path / "a.html")
    with open_page(path) as page:
        counts = page.evaluate("""window.terrain.then(async (p) => {
          const { scene } = p, count = () => scene.models[0].geometry.index.count / 3;
          const wait = () => new Promise((done) => setTimeout(done, 50));
          const counts = [count()], start = performance.now();
          scene.pace.note(start - 400); scene.pace.note(start - 200); scene.pace.note(start);
          scene.setDetail();
          counts.push(count());
          while (scene.isCoarse) await wait();
          return [...counts, count()]; })""")
    assert counts[0] == counts[2] == len(tin.triangles)
    assert 20_000 < counts[1] < 125_000


def test_100_000_triangles_within_3_mb(tmp_path):
    page = ts.preview(scatter(100_000)).to_html()
    assert len(page.encode()) < 3_000_000


@pytest.mark.proof
def test_a_million_triangles_open(tmp_path):
    tin = scatter(1_000_000)
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        origin, scale, found = page.evaluate(READ)
    numbers = np.array([one[:3] for one in found])
    places = numbers[:, :2] / scale + np.array(origin[:2])
    truth = tin.interpolate(places, extrapolate="nearest")
    assert np.abs(truth - numbers[:, 2] - origin[2]).max() < 0.002
