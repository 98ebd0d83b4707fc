"""The page that triangulates in the browser: equal to the package to the bit, and its refusals."""

from __future__ import annotations

import base64
import importlib.util
import shutil
from pathlib import Path

import numpy as np
import pytest
from support.pages import open_page
from support.validators import find_violations

import tinsmith as ts

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

ROOT = Path(__file__).parents[2]
BUILD = """async (text) => {
  const encode = (array) => {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    let words = "";
    for (let k = 0; k < bytes.length; k += 8192) {
      words += String.fromCharCode(...bytes.subarray(k, k + 8192));
    }
    return btoa(words);
  };
  const found = await window.tin.build(new TextEncoder().encode(text).buffer, "a.csv");
  if (found.error) return { error: found.error };
  const files = {};
  for (const format of ["ply", "obj"]) {
    files[format] = encode(new Uint8Array((await window.tin.ask({ format })).file));
  }
  return { points: encode(found.points), triangles: encode(found.triangles),
    notes: found.notes.join(" "), files };
}"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Return the page, compiled from the sources that are there."""
    if shutil.which("em++") is None:
        pytest.skip("needs Emscripten")
    spec = importlib.util.spec_from_file_location("make_page", ROOT / "web/make_page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.pack(tmp_path_factory.mktemp("web") / "page.html")


@pytest.fixture(scope="module")
def page(path):
    with open_page(path, webgl=False, ready="window.tin.ready") as opened:
        yield opened


def write_rows(rows, head="x,y,z"):
    return "\n".join([head, *(",".join(map(repr, map(float, row))) for row in rows)]) + "\n"


def decode(text, dtype):
    return np.frombuffer(base64.b64decode(text), dtype).reshape(-1, 3)


def with_z(xy):
    xy = np.asarray(xy, float)
    return np.column_stack([xy, np.sin(xy[:, 0]) + 300.0])


def make_cases():
    """Return sets of points, by what is hard about them."""
    rng = np.random.default_rng(12)
    corner = np.array([752_640.0, 4_024_180.0])
    grid = np.stack(np.meshgrid(np.arange(40.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    turns = 2 * np.pi * np.arange(3000) / 3000
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    ulp = np.spacing(corner)
    return {
        "survey": ts.read(ROOT / "sample_data/site_survey.csv").points,
        "raster": ts.read(ROOT / "sample_data/jacksboro.tif", stride=4).points,
        "random": with_z(rng.random((20_000, 2))),
        "grid": with_z(grid),
        "shuffled grid": with_z(rng.permutation(grid)),
        "grid with holes": with_z(grid[rng.random(len(grid)) > 0.3]),
        "grid of thirds": with_z(grid / 3),
        "steps of one ulp": with_z(corner + ulp * rng.integers(0, 40, (600, 2))),
        "nearly in line": with_z(np.column_stack([grid[:, 0] * 0.1, grid[:, 0] * 0.3])
                                 + ulp * rng.integers(-2, 3, (len(grid), 2))),
        "cocircular": with_z(corner + np.round(circle * 1000) / 8),
        "circle": with_z(circle),
        "clusters": with_z(rng.normal(size=(6000, 2)) * 10.0 ** -rng.integers(0, 9, (6000, 1))),
        "tiny and huge": with_z(rng.random((500, 2)) * 2.0 ** rng.integers(-90, 90, (500, 1))),
        "three": with_z([[0, 0], [1, 0], [0, 1]]),
    }  # fmt: skip


CASES = make_cases()


def drop_conflicts(rows):
    """Return rows of which those at one place have one elevation."""
    first = {}
    return np.array([[x, y, first.setdefault((x, y), z)] for x, y, z in rows.tolist()])


@pytest.mark.parametrize("name", CASES)
def test_the_page_builds_the_same_tin(page, tmp_path, name):
    rows = drop_conflicts(CASES[name])
    found = page.evaluate(BUILD, write_rows(rows))
    assert "error" not in found, found
    tin = ts.triangulate(rows)
    assert decode(found["points"], "<f8").tobytes() == tin.points.tobytes()
    assert decode(found["triangles"], "<i4").tobytes() == tin.triangles.tobytes()
    written = ts.write(tin, tmp_path / "a.ply").read_bytes()
    assert base64.b64decode(found["files"]["ply"]) == written
    (tmp_path / "a.obj").write_bytes(base64.b64decode(found["files"]["obj"]))
    again = ts.read(tmp_path / "a.obj")
    assert again.points.tobytes() == tin.points.tobytes()
    assert again.triangles.tobytes() == tin.triangles.tobytes()


def test_small_sets_where_everything_degenerates(page):
    rng = np.random.default_rng(3)
    for _ in range(150):
        rows = drop_conflicts(rng.integers(0, 4, (int(rng.integers(3, 14)), 3)).astype(float))
        found = page.evaluate(BUILD, write_rows(rows))
        try:
            tin = ts.triangulate(rows)
        except ts.TinsmithError:
            assert "in one line" in found["error"]
            continue
        assert decode(found["points"], "<f8").tobytes() == tin.points.tobytes()
        assert decode(found["triangles"], "<i4").tobytes() == tin.triangles.tobytes()


SQUARE = "0,0,1\n4,0,2\n4,4,3\n0,5,4\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,z\n" + SQUARE, "Columns x, y, z."),
        ("\ufeffEasting;Northing;Elevation;Code\r\n0;0;1;a\r\n4;0;2;b\r\n4;4;3;\r\n",
         "Columns easting, northing, elevation. Not read: code."),
        (SQUARE, "No names of columns: taken as x"),
        (SQUARE.replace(",", "  "), "No names of columns: taken as x"),
        ('"z"\t"x"\t"y"\n' + SQUARE.replace(",", "\t"), "Columns x, y, z."),
        ("x,y,z\n0,0,1\n0,0,1\n" + SQUARE, "Rows that were there twice: 2."),
    ],
)  # fmt: skip
def test_what_is_told(page, text, words):
    found = page.evaluate(BUILD, text)
    assert words in found["notes"]
    if '"z"' in text:
        np.testing.assert_array_equal(decode(found["points"], "<f8")[1], [0, 2, 4])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "empty"),
        ("n,e,z\n" + SQUARE, "must be named x, y, z or easting"),
        ("x,y,z,easting,northing,elevation\n1,2,3,1,2,3\n", "must be named"),
        ("x,x,y,z\n1,1,1,1\n", "two columns 'x'"),
        ("1,2,3,4\n", "there must be three"),
        ("1,5;2,5;3,5\n", "comma and semicolon"),
        ("x;y;z\n1,5;2;3\n", "Line 2: '1,5' is no number"),
        ("x,y,z\n1,2\n", "Line 2 has 2 columns, and line 1 3"),
        ("x,y,z\n0,0,1\n1,nan,2\n", "Line 3: 'nan' is no number"),
        ("x,y,z\n0,0,1\n1,1e999,2\n", "is no number"),
        ("x,y,z\n0,0,1\n1,1e300,2\n3,4,5\n", "beyond the range"),
        ("x,y,z\n0,0,1\n1,0,2\n", "needs three points"),
        ("x,y,z\n0,0,1\n1,1,2\n2,2,3\n", "in one line"),
        ("x,y,z\n0,0,1\n4,0,2\n4,4,3\n0,0,9\n", "Lines 2 and 5 are at one place"),
    ],
)
def test_what_cannot_be_told_is_refused(page, text, words):
    assert words in page.evaluate(BUILD, text)["error"]
    assert page.locator("#told.error").count() == 1
    assert page.locator("button:disabled").count() == 2


def test_a_file_is_taken_drawn_and_saved(path, tmp_path):
    rows = CASES["survey"]
    rows = drop_conflicts(rows)
    (tmp_path / "site.csv").write_text(write_rows(rows, "easting,northing,elevation"))
    with open_page(path, webgl=False, ready="window.tin.ready", accept_downloads=True) as page:
        page.set_input_files("#file", tmp_path / "site.csv")
        page.wait_for_selector("#ply:enabled")
        assert "2,121 vertices, 4,222 triangles" in page.inner_text("#told")
        page.screenshot(path=tmp_path / "page.png")
        with page.expect_download() as saved:
            page.click("#ply")
        assert saved.value.suggested_filename == "site.ply"
        saved.value.save_as(tmp_path / "site.ply")
    tin = ts.read(tmp_path / "site.ply")
    assert tin.points.tobytes() == ts.triangulate(rows).points.tobytes()
    assert (tmp_path / "page.png").stat().st_size > 50_000


@pytest.mark.parametrize("size", [(1200, 800), (360, 640)])
def test_axe_core_finds_nothing(path, tmp_path, size):
    """No rule of WCAG 2.1, level A or AA, is broken: empty, with a TIN, with a refusal."""
    viewport = dict(zip(("width", "height"), size, strict=True))
    with open_page(path, webgl=False, ready="window.tin.ready", viewport=viewport) as page:
        assert find_violations(page) == []
        for text, words in (("x,y,z\n" + SQUARE, "2 triangles"), ("", "empty")):
            path_of_table = tmp_path / f"{len(text)}.csv"
            path_of_table.write_text(text)
            page.set_input_files("#file", path_of_table)
            page.get_by_text(words).wait_for()
            assert find_violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
