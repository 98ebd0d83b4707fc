"""The page: what is packed comes back, and a real browser shows it, picks on it and measures."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.pages import open_page, read_content, unpack

import tinsmith as ts
from tinsmith.terrain.viewer.page.packing import (
    pack_counts,
    pack_rows,
    pack_triangles,
    sort_in_morton_order,
)

PAGE = Path(__file__).parents[3] / "terrain" / "viewer" / "page"
CORNER = np.array([742_000.0, 4_030_000.0, 0.0])


def hills(n=400, *, seed=3, crs="EPSG:32616", elevation_unit="m"):
    rng = np.random.default_rng(seed)
    xy = np.round(rng.random((n, 2)) * 300, 3)
    z = 300 + 8 * np.sin(xy[:, 0] / 40) + 5 * np.cos(xy[:, 1] / 25)
    return ts.triangulate(
        np.column_stack([xy, np.round(z, 3)]) + CORNER, crs=crs, elevation_unit=elevation_unit
    )


# ------------------------------------------------------------------ packing


@pytest.mark.parametrize("most", [0, 1, 200, 70_000, 2**29])
def test_rows_come_back(most):
    rows = np.random.default_rng(most).integers(-most, most + 1, (50, 3))
    assert np.cumsum(unpack(pack_rows(rows)), axis=0).tolist() == rows.tolist()


def test_counts_come_back():
    counts = np.array([2, 900, 3, 2])
    assert unpack(pack_counts(counts)).ravel().tolist() == counts.tolist()


def test_triangles_come_back_turned_the_same_way_round():
    triangles = hills(40).triangles.astype(np.int64)
    first, *others = unpack(pack_triangles(triangles)).T
    first = np.cumsum(first)
    found = {(a, a + b, a + c) for a, b, c in zip(first, *others, strict=True)}
    turned = {tuple(np.roll(one, -int(one.argmin())).tolist()) for one in triangles}
    assert found == turned


def test_morton_order_goes_through_the_quarters_one_by_one():
    places = np.array([[x, y] for y in range(4) for x in range(4)])
    quarters = [(2 * (y // 2) + x // 2) for x, y in places[sort_in_morton_order(places)].tolist()]
    assert quarters == sorted(quarters)


def test_coordinates_come_back_to_a_millimetre():
    tin = hills()
    page = read_content(ts.preview(tin).to_html())
    surface = page["surfaces"][0]
    across, up = surface["step"]
    rows = np.cumsum(unpack(surface["vertices"]), axis=0)
    found = rows * (across, across, up) + page["origin"]
    key = np.lexsort(found.T)
    assert np.abs(found[key] - tin.points[np.lexsort(tin.points.T)]).max() <= 0.0005


# ------------------------------------------------------------------ the document


def test_numbers_are_read_to_a_millimetre():
    assert read_content(ts.preview(hills(50)).to_html())["decimals"] == [3, 3]


@pytest.mark.slow
def test_one_blunder_hides_no_relief(tmp_path):
    """Tints, contours and the first view are those of the ground; the note tells of the blunder."""
    points = hills(300).points.copy()
    points[77, 2] = 9999.0
    tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
    shown = ts.preview(tin, tint="slope", contours=2.5)
    page = read_content(shown.to_html())
    assert page["elevations"] == page["relief"] == [points[:, 2].min(), np.sort(points[:, 2])[-2]]
    assert "9,999" in page["notes"]
    with open_page(shown.save(tmp_path / "a.html")) as opened:
        away, tint, interval = run(
            opened,
            """const c = p.scene.camera.position.distanceTo(p.scene.controls.target);
          return [c, p.legend.tint, document.getElementById("interval").value];""",
        )
        assert opened.is_checked("#contours")
    assert away < 2000
    assert (tint, interval) == ("slope", "2.5")


def test_nothing_outside_is_asked_for():
    page = ts.preview(hills(20)).to_html()
    addresses = set(re.findall(r"(?:src|href)=[\"']?([a-z]+:[^\"' >]*)", page))
    assert addresses <= {"data:,"}
    assert "default-src 'none'" in page


@pytest.mark.slow
@pytest.mark.parametrize("title", ["</script><script>alert(1)</script>", "x" * 10_000, "a\nb\0c"])
def test_hostile_names_stay_words(title, tmp_path):
    tin = ts.triangulate(
        [[0, 0, 1], [9, 0, 2], [0, 9, 3], [9, 9, 4]],
        breaklines=[ts.Breakline([[1, 1, 2], [7, 6, 3]], name=title)],
    )
    path = ts.preview({title: tin}, title=title).save(tmp_path / "a.html")
    with open_page(path) as page:
        assert page.evaluate("window.terrain.then((p) => p.scene.models.length)") == 1
        assert page.evaluate("document.querySelectorAll('script').length") == 2


def test_the_bundle_is_made_of_the_sources():
    """``make page`` wrote the digest of the sources with the bundle."""
    from support.pages import digest_sources

    assert (PAGE / "viewer.sha256").read_text().strip() == digest_sources(PAGE)


# ------------------------------------------------------------------ in a browser


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    survey = ts.Survey(
        points=hills().points, attributes={"number": np.arange(400).astype(str)}, crs="EPSG:32616"
    )
    tin = hills()
    path = ts.preview(tin, survey=survey, title="Hills").save(folder / "hills.html")
    with open_page(path) as page:
        yield page, tin


def run(page, code):
    return page.evaluate(f"window.terrain.then((p) => {{ {code} }})")


@pytest.mark.slow
def test_the_canvas_is_not_blank(opened):
    page, _ = opened
    colours = run(
        page,
        """
      p.scene.draw();
      const gl = p.scene.renderer.getContext(), seen = new Set(), c = new Uint8Array(4);
      for (let x = 0; x < gl.drawingBufferWidth; x += 9)
        for (let y = 0; y < gl.drawingBufferHeight; y += 9) {
          gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, c); seen.add(c.join()); }
      return seen.size;""",
    )
    assert colours > 100


@pytest.mark.slow
def test_a_pick_is_what_the_surface_says(opened):
    page, tin = opened
    found = run(
        page,
        """
      const picks = [];
      for (let x = 300; x < 900; x += 37) for (let y = 200; y < 700; y += 41) {
        const f = p.scene.pick(x, y);
        if (f !== null) picks.push([f.hit.x, f.hit.y, f.hit.z]); }
      return [p.payload.origin, picks];""",
    )
    places = np.array(found[1]) + found[0]
    assert len(places) > 20
    truth = tin.interpolate(places[:, :2], extrapolate="nearest")
    assert np.abs(truth - places[:, 2]).max() < 0.002


@pytest.mark.slow
def test_the_words_under_the_pointer(opened):
    page, tin = opened
    words = run(page, "p.tool.read(600, 420); return p.tool.readout.textContent;")
    number = r"(-?[\d.]+)"
    pattern = f"Easting {number} m   Northing {number} m   Elevation {number} m   Slope {number}°"
    found = re.match(pattern, words)
    east, north, elevation, steep = map(float, found.groups())
    assert tin.interpolate([[east, north]])[0] == pytest.approx(elevation, abs=0.002)
    triangle = tin.locate([[east, north]])[0]
    assert ts.slope(tin)[triangle] == pytest.approx(steep, abs=0.06)


@pytest.mark.slow
def test_distance_and_profile(opened):
    page, tin = opened
    length, pieces, marked, words = run(
        page,
        """
      p.tool.choose("distance"); p.tool.mark(350, 300); p.tool.mark(600, 330);
      const [a, b] = p.tool.marked.map((m) => m.hit);
      const pieces = p.scene.models[0].surface.profile([a.x, a.y], [b.x, b.y]);
      const words = document.getElementById("measured").textContent;
      p.tool.clear();
      return [Math.hypot(b.x - a.x, b.y - a.y), pieces, [a, b], words];""",
    )
    assert f"Distance {length:.3f} m" in words
    assert len(pieces) == 1
    distances, elevations = np.array(pieces[0]).T
    start, end = (np.array([one["x"], one["y"]]) for one in marked)
    origin = np.array(run(page, "return p.payload.origin;"))
    places = start + np.outer(distances / length, end - start) + origin[:2]
    truth = tin.interpolate(places, extrapolate="nearest")
    assert np.abs(truth - elevations - origin[2]).max() < 0.002
    expected = ts.profile(tin, [start + origin[:2], end + origin[:2]])
    assert abs(len(expected) - len(distances)) <= 2


@pytest.mark.slow
def test_area_of_a_polygon(opened):
    page, _ = opened
    area, corners = run(
        page,
        """
      p.tool.choose("area"); p.tool.mark(400, 320); p.tool.mark(550, 330);
      p.tool.mark(540, 400); p.tool.mark(380, 390);
      const words = document.getElementById("result").textContent;
      const corners = p.tool.marked.map((m) => [m.hit.x, m.hit.y]);
      p.tool.clear();
      return [parseFloat(words.replace("Area ", "")), corners];""",
    )
    import shapely

    assert area == pytest.approx(shapely.Polygon(corners).area, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("switch", ["contours", "edges", "points"])
def test_switches_change_the_picture(opened, switch):
    page, _ = opened
    pictures = run(
        page,
        f"""
      const take = () => p.furniture.takePicture();
      const before = take(); document.getElementById("{switch}").click();
      const during = take(); document.getElementById("{switch}").click();
      return [before, during, take()];""",
    )
    assert pictures[0] != pictures[1]
    assert pictures[0] == pictures[2]


@pytest.mark.slow
def test_every_tint_is_another_picture(opened):
    page, _ = opened
    pictures = run(
        page,
        """
      const taken = ["elevation", "slope", "aspect", "plain"].map((t) => {
        p.legend.setTint(t); return p.furniture.takePicture(); });
      p.legend.setTint("elevation"); return taken;""",
    )
    assert len(set(pictures)) == 4


@pytest.mark.slow
def test_exaggeration_moves_the_ground(opened):
    page, _ = opened
    heights = run(
        page,
        """
      const at = () => p.scene.project(0, 0, p.scene.models[0].surface.high[2])[1];
      p.settings.setExaggeration(1); const low = at(); p.settings.setExaggeration(4);
      const high = at();
      p.settings.setExaggeration(p.payload.exaggeration); return [low, high];""",
    )
    assert heights[0] != pytest.approx(heights[1], abs=3)


@pytest.mark.slow
def test_keys_turn_move_and_look_from_above(opened):
    page, _ = opened
    page.focus("#view")
    before = run(page, "return [p.scene.heading, p.scene.controls.target.x];")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Shift+ArrowRight")
    after = run(page, "return [p.scene.heading, p.scene.controls.target.x];")
    assert before[0] != after[0]
    assert before[1] != after[1]
    page.keyboard.press("t")
    assert run(page, "return p.scene.camera.position.z / p.scene.camera.position.length();") > 0.99
    page.keyboard.press("h")


@pytest.mark.slow
def test_two_surfaces_have_cut_and_fill(tmp_path):
    ground, design = hills(), hills()
    raised = design.points + np.array([0, 0, 1.5])
    design = ts.TIN.from_triangles(raised, design.triangles, crs=design.crs, elevation_unit="m")
    path = ts.preview({"Existing": ground, "Design": design}).save(tmp_path / "a.html")
    with open_page(path) as page:
        names, most = run(
            page,
            """
          const d = p.scene.models[2].surface.difference;
          return [p.scene.models.map((m) => m.surface.data.name), Math.max(...d)];""",
        )
    assert names == ["Existing", "Design", "Cut and fill"]
    assert most == pytest.approx(1.5, abs=0.001)


@pytest.mark.slow
def test_without_webgl_there_is_a_still_picture(tmp_path):
    path = ts.preview(hills()).save(tmp_path / "a.html")
    with open_page(path, webgl=False) as page:
        assert page.evaluate("window.terrain.then((p) => p === null)")
        assert "no WebGL" in page.inner_text("#wait")
        colours = page.evaluate("""() => {
          const c = document.getElementById("notes");
          const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data, seen = new Set();
          for (let i = 0; i < d.length; i += 404) seen.add(d.slice(i, i + 3).join());
          return seen.size; }""")
    assert colours > 50


# ------------------------------------------------------------------ what is refused


def test_surfaces_of_different_crs_are_refused():
    with pytest.raises(
        ts.CrsError, match=r"'a' is in EPSG:32616 and the surface 'b' in EPSG:32617"
    ):
        ts.preview({"a": hills(), "b": hills(crs="EPSG:32617")})


def test_a_survey_of_another_crs_is_refused():
    tin = hills(50)
    for crs in ("EPSG:2274", None):
        with pytest.raises(ts.CrsError, match="the survey"):
            ts.preview(tin, survey=ts.Survey(points=tin.points, crs=crs))


def test_elevations_in_feet_and_metres_are_not_mixed():
    """The same ground in two units is one surface, with neither cut nor fill."""
    metres = hills(60)
    feet = metres.replace(points=metres.points * (1, 1, 1 / 0.3048), elevation_unit="ft")
    shown = read_content(ts.preview({"first": metres, "second": feet}).to_html())
    assert shown["units"]["elevation"] == "m"
    assert "'second' were converted from foot to metre" in shown["notes"]
    first, second, compared = shown["surfaces"]
    assert np.array_equal(unpack(first["vertices"]), unpack(second["vertices"]))
    assert not unpack(compared["difference"]).any()


def test_labels_are_in_the_unit_of_the_page():
    metres = hills(60)
    survey = ts.Survey(
        points=metres.points * (1, 1, 1 / 0.3048), crs=metres.crs, elevation_unit=ts.Unit.of("ft")
    )
    shown = read_content(ts.preview(metres, survey=survey).to_html())
    labels = shown["surfaces"][0]["labels"]
    assert labels["texts"] == [f"{z:.2f}" for z in metres.points[:, 2]]


def test_an_assumed_unit_is_told():
    page = ts.preview(hills(60, elevation_unit=None)).to_html()
    told = "The unit of elevations is not known: taken to be the metre."
    assert any(words.endswith(told) for words in re.findall("<p>(.*)</p>", page))


def test_no_surface_is_refused():
    with pytest.raises(ts.OptionError):
        ts.preview({})


def test_a_picture_of_two_surfaces_is_refused(tmp_path):
    with pytest.raises(ts.RenderError, match=r"shows one surface, and there are 2"):
        ts.preview({"a": hills(), "b": hills()}).save(tmp_path / "a.png")
    assert not list(tmp_path.iterdir())


def test_the_command_writes_a_page(tmp_path):
    path = tmp_path / "a.csv"
    np.savetxt(
        path, hills(50).points, delimiter=",", header="easting,northing,elevation", comments=""
    )
    out = tmp_path / "a.html"
    code = [sys.executable, "-m", "tinsmith", "view", path, "-o", out]
    subprocess.run(code, check=True, capture_output=True)
    assert out.read_text().startswith("<!doctype html>")
