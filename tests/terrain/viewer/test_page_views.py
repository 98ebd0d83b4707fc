"""Views in the address, sections as CSV, ways along lines and two epochs side by side."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest
from support.pages import open_page, read_content, unpack

import tinsmith as ts

CORNER = np.array([742_000.0, 4_030_000.0, 0.0])


def make_hills(n=300, *, seed=3, phase=0.0, **more):
    rng = np.random.default_rng(seed)
    xy = np.round(rng.random((n, 2)) * 300, 3)
    z = 300 + 8 * np.sin(xy[:, 0] / 40 + phase) + 5 * np.cos(xy[:, 1] / 25)
    points = np.column_stack([xy, np.round(z, 3)]) + CORNER
    return ts.triangulate(points, **{"crs": "EPSG:32616", "elevation_unit": "m", **more})


def run(page, code):
    return page.evaluate(f"window.terrain.then(async (p) => {{ {code} }})")


MARK = """p.tool.clear(); p.tool.choose("distance");
  const s = p.payload.scale, o = p.payload.origin, axes = p.payload.axes;
  p.tool.marked = PLACES.map(([x, y]) => ({ model: p.scene.models[0], hit: { triangle: 0,
    x: (axes[0][1] * x - o[0]) * s[0], y: (axes[1][1] * y - o[1]) * s[1], z: 0 } }));
  p.tool.showMeasured(); return p.tool.formatCsv();"""


def read_section(page, line):
    text = run(page, MARK.replace("PLACES", repr(np.asarray(line).tolist())))
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    return header, np.array([[float(one or "nan") for one in row] for row in rows])


# ------------------------------------------------------------------ sections


HOLE = CORNER[:2] + np.array([[120, 120], [180, 120], [180, 180], [120, 180]])
SECTIONS = {
    "one surface": lambda: {"Ground": make_hills()},
    "two surfaces": lambda: {"Ground": make_hills(), "Design": make_hills(200, seed=8, phase=0.4)},
    "a hole": lambda: {"Ground": make_hills(holes=[HOLE])},
    "feet": lambda: {"Ground": make_hills(crs="EPSG:2274", elevation_unit="ft")},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SECTIONS)
def test_a_section_is_that_of_profile(name, tmp_path):
    surfaces = SECTIONS[name]()
    line = CORNER[:2] + np.array([[-10.0, 150.5], [205.25, 140.125], [260.5, 290.75]])
    with open_page(ts.preview(surfaces).save(tmp_path / "a.html")) as page:
        header, rows = read_section(page, line)
    unit = "m" if name != "feet" else "US survey foot"
    assert header[0] == f"station ({ts.Unit.of(unit).symbol})"
    assert header[1].startswith("easting (")
    assert len(header) == 3 + len(surfaces)
    expected = ts.profile(surfaces if len(surfaces) > 1 else surfaces["Ground"], line)
    truth = expected.to_dataframe()
    stations = truth["station"].to_numpy()
    # A row for each of profile's, but for those that the rounding to a millimetre joins.
    near = np.abs(rows[:, 0] - stations[:, None]).min(axis=1)
    assert near.max() < 0.02
    assert abs(len(rows) - len(stations)) <= 3
    places = np.column_stack([rows[:, 1], rows[:, 2]])
    for k, tin in enumerate(surfaces.values()):
        z, found = tin.interpolate(places), rows[:, 3 + k]
        both = np.isfinite(z) & np.isfinite(found)
        assert both.sum() > 20
        assert np.abs(z - found)[both].max() < 0.004
        assert (np.isfinite(z) == np.isfinite(found)).mean() > 0.9
    along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    assert np.abs(along - rows[:, 0]).max() < 1e-4


@pytest.mark.slow
def test_a_line_along_the_boundary_lies_on_the_surface(tmp_path):
    """Vertices on one line, whose coordinates from the page's origin are no doubles."""
    step = np.array([3.007, 1.003])
    edge = CORNER[:2] + np.arange(21)[:, None] * step
    inside = CORNER[:2] + np.random.default_rng(4).integers(5_000, 20_000, (30, 2)) / 1000 * [1, 3]
    xy = np.concatenate([edge, inside]).round(3)
    z = 300 + np.arange(len(xy)) % 7 / 4
    tin = ts.triangulate(np.column_stack([xy, z]), crs="EPSG:32616", elevation_unit="m")
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        for line in (xy[[0, 20]], xy[[20, 0]], xy[[3, 17]]):
            _, rows = read_section(page, line)
            assert len(rows) == round(np.hypot(*(line[1] - line[0])) / np.hypot(*step)) + 1
            nearest = np.abs(xy[:, None] - rows[:, 1:3]).sum(axis=2).argmin(axis=0)
            assert np.abs(rows[:, 3] - z[nearest]).max() < 1e-3


@pytest.mark.slow
def test_a_section_is_blank_in_a_gap_and_is_saved_as_a_file(tmp_path):
    tin = make_hills(holes=[HOLE])
    line = CORNER[:2] + np.array([[100.0, 150.0], [200.0, 150.0]])
    with open_page(ts.preview(tin, title="Pit").save(tmp_path / "a.html")) as page:
        _, rows = read_section(page, line)
        with page.expect_download() as told:
            page.click("#export")
        saved = Path(told.value.path()).read_text()
    blank = rows[np.isnan(rows[:, 3])]
    assert blank[:, 0].tolist() == pytest.approx([50.0], abs=1e-3)
    assert told.value.suggested_filename == "Pit section.csv"
    assert saved.startswith("station (m),easting (m),northing (m),elevation (m)\n")
    assert len(saved.splitlines()) == 1 + len(rows)


@pytest.mark.slow
def test_a_section_in_degrees_has_stations_in_metres(tmp_path):
    u, v = (one.ravel() for one in np.meshgrid(np.linspace(8, 8.3, 9), np.linspace(60, 60.2, 9)))
    tin = ts.triangulate(
        np.column_stack([u, v, 300 + 50 * np.sin(9 * u)]), crs="EPSG:4326", elevation_unit="m"
    )
    line = np.array([[8.05, 60.03], [8.25, 60.15]])
    with open_page(ts.preview(tin).save(tmp_path / "a.html")) as page:
        header, rows = read_section(page, line)
    from pyproj import Geod

    assert header[:3] == ["station (m)", "longitude (degree)", "latitude (degree)"]
    assert rows[0, 1:3].tolist() == pytest.approx(line[0], abs=1e-9)
    assert rows[-1, 1:3].tolist() == pytest.approx(line[1], abs=1e-9)
    assert rows[-1, 0] == pytest.approx(Geod(ellps="WGS84").line_length(*line.T), rel=1e-4)
    assert np.abs(tin.interpolate(rows[:, 1:3]) - rows[:, 3]).max() < 0.002


@pytest.mark.slow
def test_names_in_a_section_are_quoted(tmp_path):
    names = ['=HYPERLINK("x"), a', "b\nc"]
    surfaces = dict(zip(names, (make_hills(), make_hills(seed=4)), strict=True))
    line = CORNER[:2] + np.array([[100.0, 150.0], [200.0, 150.0]])
    with open_page(ts.preview(surfaces).save(tmp_path / "a.html")) as page:
        header, rows = read_section(page, line)
    assert header[3:] == ['elevation =HYPERLINK("x"), a (m)', "elevation b c (m)"]
    assert rows.shape[1] == 5


# ------------------------------------------------------------------ along lines


KERB = np.array([[20, 60, 300], [100, 80, 303], [180, 70, 306], [280, 90, 304]]) + CORNER
BRANCH = np.array([[180, 70, 306], [170, 160, 309], [200, 260, 311]]) + CORNER
APART = np.array([[30, 200, 300], [120, 230, 302]]) + CORNER


@pytest.fixture(scope="module")
def lined(tmp_path_factory):
    tin = ts.triangulate(
        make_hills().points,
        breaklines=[KERB, BRANCH, APART],
        crs="EPSG:32616",
        elevation_unit="m",
    )
    path = ts.preview(tin).save(tmp_path_factory.mktemp("lines") / "a.html")
    with open_page(path) as page:
        page.evaluate("window.terrain.then((p) => { p.scene.look(180, 90); p.scene.draw(); })")
        page.click("#along")
        page.evaluate("new Promise((done) => setTimeout(done, 200))")
        yield page, tin


def pick_along(page, *places):
    """Mark places from above by their pixels, and return the words and the marked path."""
    return run(
        page,
        f"""p.tool.clear(); p.tool.choose("along"); p.scene.draw();
        const o = p.payload.origin;
        for (const [x, y, z] of {np.asarray(places).tolist()}) {{
          const at = p.scene.project(x - o[0], y - o[1], z - o[2]);
          p.tool.point(at[0], at[1]); }}
        return [document.getElementById("result").textContent,
                p.tool.path.map(({{ hit }}) => [hit.x + o[0], hit.y + o[1], hit.z + o[2]]),
                p.tool.marked.length ? p.tool.formatCsv() : ""];""",
    )


@pytest.mark.slow
def test_a_length_along_a_breakline(lined):
    import shapely

    page, tin = lined
    kerb = shapely.LineString(KERB)
    ends = [np.array(kerb.interpolate(share, normalized=True).coords[0]) for share in (0.1, 0.9)]
    words, path, text = pick_along(page, *ends)
    flat, ground, rise = (
        float(one) for one in re.findall(r"(?:Distance|ground|rise) (-?[\d.]+)", words)
    )
    marked = np.array(path)
    # The path ends where lines were reached, within a pixel of the places, and follows the kerb.
    assert shapely.hausdorff_distance(shapely.LineString(marked[:, :2]), kerb) < 60
    assert max(kerb.distance(shapely.Point(one)) for one in marked[:, :2]) < 0.001
    steps = np.diff(marked, axis=0)
    assert flat == pytest.approx(np.hypot(*steps[:, :2].T).sum(), abs=0.0006)
    assert flat == pytest.approx(0.8 * kerb.length, abs=1.0)
    assert ground == pytest.approx(np.linalg.norm(steps, axis=1).sum(), abs=0.0006)
    assert rise == pytest.approx(marked[-1, 2] - marked[0, 2], abs=0.0006)
    assert np.abs(tin.interpolate(marked[:, :2]) - marked[:, 2]).max() < 0.002
    rows = np.array(
        [[float(x) for x in row.split(",")] for row in text.split()[4:] if row[0].isdigit()]
    )
    assert rows[-1, 0] == pytest.approx(flat, abs=0.0006)


@pytest.mark.slow
def test_the_way_turns_at_a_junction(lined):
    page, _ = lined
    start, end = (KERB[0] + KERB[1]) / 2, (BRANCH[1] + BRANCH[2]) / 2
    _, path, _ = pick_along(page, start, end)
    marked = np.array(path)
    for corner in (KERB[1], BRANCH[0], BRANCH[1]):
        assert np.abs(marked - corner).max(axis=1).min() < 0.001


@pytest.mark.slow
def test_lines_that_are_not_connected_are_told(lined):
    page, _ = lined
    words, path, _ = pick_along(page, (KERB[0] + KERB[1]) / 2, (APART[0] + APART[1]) / 2)
    assert words.startswith("This line is not connected to the one before.")
    assert len(path) == 1
    words, path, _ = pick_along(page, CORNER + np.array([60, 140, 300]))
    assert words.startswith("There is no line here.")
    assert path == []


@pytest.mark.slow
def test_without_lines_there_is_no_way_along_them(tmp_path):
    with open_page(ts.preview(make_hills(60)).save(tmp_path / "a.html")) as page:
        assert page.is_hidden("#along")


# ------------------------------------------------------------------ two epochs


@pytest.fixture(scope="module")
def epochs():
    return make_hills(200), make_hills(260, seed=9, phase=0.3)


@pytest.mark.slow
def test_a_slider_between_two_epochs(epochs, tmp_path):
    path = ts.preview(list(epochs)).save(tmp_path / "a.html")
    with open_page(path) as page:
        assert page.is_hidden("#swipe")
        page.check("#comparing")
        assert page.is_disabled("#surface-0")
        for value in ("25", "75"):
            page.fill("#split", value)
            found = run(
                page,
                """p.scene.look(180, 90); p.scene.draw();
                const w = p.scene.canvas.clientWidth, h = p.scene.canvas.clientHeight, found = [];
                for (let x = 0.3 * w; x < 0.7 * w; x += 7) {
                  const m = p.scene.pick(x, h / 2);
                  if (m === null) continue;
                  found.push([x, p.scene.models.indexOf(m.model), m.hit.x, m.hit.y, m.hit.z]); }
                return [p.scene.border, w, p.payload.origin, found];""",
            )
            border, width, origin, picks = found
            assert border == pytest.approx(20 + float(value) / 100 * (width - 40))
            assert len(picks) > 20
            for x, model, *place in picks:
                assert model == int(x >= border)
                at = np.array(place) + origin
                assert epochs[model].interpolate(at[None, :2])[0] == pytest.approx(at[2], abs=0.002)
        label = page.get_attribute("#split", "aria-valuetext")
        assert label == "75 percent: Surface 1 to the left of it, Surface 2 to the right"


@pytest.mark.slow
def test_both_sides_of_the_slider_are_drawn(epochs, tmp_path):
    path = ts.preview({"Before": epochs[0], "After": epochs[1]}).save(tmp_path / "a.html")
    look = """p.scene.standpoint = { target: [0, 0, 0], azimuth: 180, tilt: 90, away: 700 };
      await new Promise((done) => setTimeout(done, 100));
      while (p.scene.isCoarse) await new Promise((done) => setTimeout(done, 100));
      p.scene.draw();
      const gl = p.scene.renderer.getContext();
      const w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
      const pixels = new Uint8Array(4 * w * h);
      gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const row = Math.floor(h / 2), found = [];
      for (let x = 0; x < w; x += 1) found.push(pixels[4 * (row * w + x)]);
      return [p.scene.border * w / p.scene.canvas.clientWidth, found];"""
    with open_page(path) as page:
        pictures = []
        for k in (0, 1):
            for other in (0, 1, 2):
                page.set_checked(f"#surface-{other}", other == k)
            pictures.append(np.array(run(page, look)[1]))
        page.check("#comparing")
        border, row = run(page, look)
    border = round(border)
    row = np.array(row)
    assert (pictures[0] != pictures[1]).mean() > 0.2
    assert np.abs(row - pictures[0])[: border - 2].max() <= 1
    assert np.abs(row - pictures[1])[border + 2 :].max() <= 1


@pytest.mark.slow
def test_colours_of_cut_and_fill_show_it(epochs, tmp_path):
    before, after = epochs
    path = ts.preview({"Before": before, "After": after}).save(tmp_path / "a.html")
    with open_page(path) as page:
        assert page.is_checked("#surface-1")
        page.select_option("#tint", "difference")
        assert page.is_checked("#surface-2")
        assert page.inner_text("#basis").startswith("After minus Before, on the overlay of both")
        told = run(
            page,
            """p.scene.look(180, 90); p.scene.draw();
            const w = p.scene.canvas.clientWidth, h = p.scene.canvas.clientHeight, found = [];
            for (let x = 0.3 * w; x < 0.7 * w; x += 23) for (const y of [0.4 * h, 0.6 * h]) {
              p.tool.read(x, y); found.push(document.getElementById("readout").textContent); }
            return found;""",
        )
        page.select_option("#tint", "slope")
        assert page.is_checked("#surface-1")
        assert not page.is_checked("#surface-2")
        assert page.is_hidden("#basis")
    assert len(told) > 10
    for words in told:
        x, y, size = (float(one) for one in re.findall(r"(?:ing|Cut|Fill) ([\d.]+) m", words))
        truth = after.interpolate([[x, y]])[0] - before.interpolate([[x, y]])[0]
        assert (-size if "Cut " in words.split("Cut and")[0] else size) == pytest.approx(
            truth, abs=0.004
        )


def test_three_surfaces_have_cut_and_fill_from_each_to_the_next():
    flat = make_hills(80)
    raised = [flat.replace(points=flat.points + np.array([0, 0, up])) for up in (0.0, 1.0, 3.0)]
    shown = read_content(ts.preview(dict(zip("abc", raised, strict=True))).to_html())
    names = [one["name"] for one in shown["surfaces"]]
    assert names == ["a", "b", "c", "Cut and fill, a to b", "Cut and fill, b to c"]
    rises = [
        np.cumsum(unpack(one["difference"]))[0] * one["step"][1] for one in shown["surfaces"][3:]
    ]
    assert rises == pytest.approx([1.0, 2.0], abs=0.001)
    assert shown["basis"].startswith("Each surface minus the one before, on the overlay")


def test_surfaces_of_a_sequence_are_named_by_their_files(tmp_path):
    tin = make_hills(60)
    for name in ("survey_2024", "survey_2025"):
        ts.write(tin, tmp_path / f"{name}.ply")
    read = [ts.read(tmp_path / f"survey_{year}.ply") for year in (2024, 2025)]
    for given, names in (
        (read, ["survey 2024", "survey 2025"]),
        ([read[0], read[0]], ["Surface 1", "Surface 2"]),
        ((tin, read[0]), ["Surface 1", "Surface 2"]),
        ([tin], ["Surface"]),
    ):
        shown = read_content(ts.preview(given).to_html())
        assert [one["name"] for one in shown["surfaces"]][: len(names)] == names
    with pytest.raises(ts.OptionError, match="a sequence of TINs"):
        ts.preview([])
    with pytest.raises(ts.PointsError):
        ts.preview([tin, "b"])


def test_a_surface_called_cut_and_fill_is_kept():
    tin = make_hills(60)
    shown = read_content(ts.preview({"Cut and fill": tin, "b": tin}).to_html())
    assert [one["name"] for one in shown["surfaces"]] == ["Cut and fill", "b", "Cut and fill *"]


# ------------------------------------------------------------------ views in the address


VIEW = """window.terrain.then((p) => { const s = p.scene.standpoint; return {
  target: s.target, azimuth: s.azimuth, tilt: s.tilt, away: s.away, colour: p.legend.tint,
  factor: p.scene.exaggeration, split: p.scene.split === null ? null : p.scene.split.share,
  shown: p.scene.models.map((m) => m.group.visible), hash: location.hash,
  contours: p.scene.models[0].material.uniforms.interval.value,
  shading: p.scene.models[0].material.uniforms.shading.value,
  edges: document.getElementById("edges").checked,
  note: document.getElementById("unreadable")?.textContent ?? "" }; })"""


@pytest.fixture(scope="module")
def shared(epochs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("views")
    return ts.preview({"Before": epochs[0], "After": epochs[1]}).save(folder / "a b.html")


def open_address(page, path, fragment):
    page.goto("about:blank")
    page.goto(f"{path.as_uri()}#{fragment}")
    return page.evaluate(VIEW)


@pytest.mark.slow
def test_a_link_opens_the_view_as_it_was(shared):
    with open_page(shared, viewport={"width": 1100, "height": 700}) as page:
        page.select_option("#tint", "slope")
        page.fill("#exaggeration", "0.6")
        for one in ("contours", "edges", "shading", "comparing"):
            page.click(f"#{one}")
        page.fill("#interval", "2.5")
        page.fill("#split", "30")
        page.focus("#view")
        for key in ("ArrowLeft", "ArrowUp", "+", "Shift+ArrowRight"):
            page.keyboard.press(key)
        before = page.evaluate(VIEW)
        address = run(page, "return p.link.address;")
        page.click("#link")
        page.locator("#readout", has_text="The link to this view").wait_for()
        after = open_address(page, shared, address.partition("#")[2])
    assert after["target"] == pytest.approx(before["target"], abs=0.002)
    for key in ("azimuth", "tilt", "away", "factor"):
        assert after[key] == pytest.approx(before[key], rel=1e-3, abs=0.01)
    for key in ("colour", "split", "shown", "contours", "shading", "edges"):
        assert after[key] == before[key]
    assert (after["colour"], after["split"], after["contours"]) == ("slope", 0.3, 2.5)
    assert re.search(r"#from=[\d.,]+&at=742\d{3}\.\d{3},40301\d\d", address)


@pytest.mark.slow
def test_the_address_follows_the_view_once_it_rests(shared):
    with open_page(shared) as page:
        page.wait_for_timeout(600)
        assert page.evaluate("location.hash") == ""
        page.click("#above")
        page.wait_for_timeout(900)
        assert page.evaluate("location.hash").startswith("#from=180.00,90.00&colour=elevation")
        assert page.evaluate("history.length") <= 2


@pytest.mark.slow
def test_a_view_of_the_whole_fits_another_screen(shared):
    with open_page(shared, viewport={"width": 390, "height": 844}) as page:
        found = open_address(page, shared, "from=180,90&colour=aspect")
        inside = run(
            page,
            """p.scene.draw(); const s = p.scene.models[1].surface;
            return [s.low[0], s.high[0]].every((x) => { const at = p.scene.project(x, 0, 0);
              return at[0] >= 0 && at[0] <= p.scene.canvas.clientWidth; });""",
        )
    assert (round(found["tilt"]), found["colour"], inside) == (90, "aspect", True)


@pytest.mark.slow
@pytest.mark.parametrize(
    "fragment",
    [
        "from=1,2,3,4&at=1,2,3", "from=abc&at=1,2,3", "at=1,2,3", "from=180,91",
        "from=0,10,-5&at=1,2,3",
        "colour=ortho", "colour=%3Cscript%3E", "show=9", "show=1.5", "split=50", "split=101,1,2",
        "split=50,0,2", "exaggeration=0", "exaggeration=NaN", "contours=-1", "from=1e999,3",
    ],
)  # fmt: skip
def test_a_view_that_cannot_be_read_is_told(shared, fragment, opened_once):
    before, page = opened_once
    found = open_address(page, shared, fragment)
    assert found["note"].startswith("The view in the address cannot be shown: '")
    assert {**found, "hash": "", "note": ""} == {**before, "hash": ""}


@pytest.fixture(scope="module")
def opened_once(shared):
    with open_page(shared) as page:
        yield page.evaluate(VIEW), page


@pytest.mark.slow
def test_other_fragments_are_left_alone(shared, opened_once):
    before, page = opened_once
    assert {**open_address(page, shared, "section-2"), "hash": ""} == {**before, "hash": ""}


@pytest.mark.slow
def test_a_changed_address_is_followed(shared):
    with open_page(shared) as page:
        page.evaluate("location.hash = '#colour=aspect&show=1,2&shading=0'")
        page.wait_for_timeout(200)
        found = page.evaluate(VIEW)
        assert (found["colour"], found["shown"], found["shading"]) == (
            "aspect",
            [True, True, False],
            0,
        )
        page.evaluate("location.hash = '#colour=slope'")
        page.wait_for_timeout(200)
        found = page.evaluate(VIEW)
        assert (found["colour"], found["shown"], found["shading"]) == (
            "slope",
            [False, True, False],
            1,
        )
