"""The card of a TIN in a notebook: its figures, escaped, and a map that shows its elevations."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from PIL import Image
from support.html_reprs import picture_of, read
from support.pages import open_page
from support.processes import run_alone

import tinsmith as ts
from tinsmith.terrain.drawing.html_repr.frame import encode_png
from tinsmith.terrain.drawing.palette import compute_lightness
from tinsmith.terrain.viewer.html_repr import draw_map

CORNER = np.array([742_000.0, 4_030_000.0])


def hills(count=3000, *, width=1000.0, height=600.0, crs="EPSG:32616", elevation_unit=None):
    xy = np.random.default_rng(3).random((count, 2)) * (width, height)
    corners = [(0, 0), (width, 0), (width, height), (0, height)]
    xy = np.concatenate([xy, corners])
    z = 300 + 20 * np.sin(xy[:, 0] / 150) + 10 * np.cos(xy[:, 1] / 90)
    points = np.column_stack([xy + CORNER, z])
    return ts.triangulate(points, crs=crs, elevation_unit=elevation_unit)


# ------------------------------------------------------------------ figures


def test_a_card_tells_counts_crs_units_and_bounds():
    tin = hills()
    words = read(tin._repr_html_()).words
    told = dict(zip(words[1::2], words[2::2], strict=True))
    assert words[0] == "TIN"
    assert told["Surface"] == f"3,004 vertices, {len(tin.triangles):,} triangles"
    assert told["CRS"] == "WGS 84 / UTM zone 16N (EPSG:32616)"
    assert told["Units"] == "metre, elevations not known"
    assert told["Easting"] == "742,000 to 743,000"
    assert told["Northing"] == "4,030,000 to 4,030,600"
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    assert told["Elevation"] == f"{low:,.1f} to {high:,.1f}"
    assert "Lines" not in told


@pytest.mark.parametrize(
    ("crs", "elevation_unit", "units"),
    [
        ("EPSG:2264", "US survey foot", "US survey foot"),
        ("EPSG:32616", "foot", "metre, elevations foot"),
        (None, None, "not known"),
        ("EPSG:32616", "m", "metre"),
    ],
)
def test_units_are_those_that_are_known(crs, elevation_unit, units):
    words = read(hills(50, crs=crs, elevation_unit=elevation_unit)._repr_html_()).words
    assert units in words
    assert ("not known" in words) == (crs is None)


def test_lines_are_counted():
    tin = ts.triangulate(
        [[0, 0, 1], [9, 0, 2], [0, 9, 3], [9, 9, 4]],
        breaklines=[ts.Breakline([[1, 1, 2], [7, 6, 3]], name="</script><b>")],
    )
    assert "1 line" in read(tin._repr_html_()).words


def test_hostile_names_of_a_crs_stay_words():
    name = '</td><script>alert("x")</script>' + "y" * 10_000
    wkt = ts.CRS.of("EPSG:32616").to_pyproj().to_wkt().replace("WGS 84 / UTM zone 16N", "NAME", 1)
    wkt = re.sub(r',ID\["EPSG",32616\]\]$', "]", wkt).replace("NAME", name.replace('"', '""'))
    card = hills(30, crs=ts.CRS.of(wkt))._repr_html_()
    reader = read(card)
    assert "script" not in [tag for tag, _ in reader.tags]
    assert any("alert(" in words for words in reader.words)


# ------------------------------------------------------------------ map


def test_the_map_shows_the_surface_where_it_is():
    """Clear outside, and lighter where the surface is higher."""
    tin = ts.triangulate([[0, 0, 0], [100, 0, 0], [0, 50, 10]])
    picture = draw_map(tin)
    assert picture.shape == (160, 320, 4)
    rows, columns = np.mgrid[:160, :320] + 0.5
    inside = columns / 320 + (160 - rows) / 160 < 1
    far = np.abs(columns / 320 + (160 - rows) / 160 - 1) > 0.01
    assert ((picture[..., 3] == 255) == inside)[far].all()
    light = compute_lightness(picture[10:150:20, 3, :3])
    assert (np.diff(light) < 0).all()


def test_the_map_is_lit_from_the_northwest():
    axis = np.linspace(0, 100, 41)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    tin = ts.triangulate(np.column_stack([x, y, 30 - np.hypot(x - 50, y - 50) / 2]))
    picture = draw_map(tin)[..., :3].astype(int).sum(axis=2)
    size = picture.shape[0]
    near, far = size // 4, size - size // 4
    assert picture[near, near] > picture[far, far] + 100  # alike in elevation


def test_a_blunder_does_not_take_the_tints():
    points = hills(500).points.copy()
    wrong = points.copy()
    wrong[77, 2] = 9999.0
    maps = [draw_map(ts.triangulate(one, crs="EPSG:32616")).astype(int) for one in (points, wrong)]
    differs = np.abs(maps[0] - maps[1]).max(axis=2) > 8
    assert 0 < differs.mean() < 0.03


@pytest.mark.parametrize("crs", ["EPSG:4326", None])
def test_square_pixels_are_square_on_the_ground(crs):
    tin = ts.triangulate([[x, y, x + y] for x in (10, 10.2) for y in (60, 60.1)], crs=crs)
    height, width, _ = draw_map(tin).shape
    assert width / height == pytest.approx(1.0 if crs else 2.0, abs=0.02)


@pytest.mark.parametrize(
    "points",
    [
        [[0, 0, 1], [1, 0, 2], [0, 1, 3]],
        [[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5]],
        [[0, 0, 1], [1e6, 0, 2], [1e6, 1e-3, 3]],
        [[0, 0, 1], [0, 1e6, 2], [1e-3, 1e6, 3]],
        [[0, 0, -1e300], [1, 0, 1e300], [0, 1, 3]],
        [[0, 0, -1e300], [1e-9, 0, 1e300], [0, 1e-9, 3]],
    ],
    ids=["one triangle", "level", "flat sliver", "upright sliver", "huge", "infinite span"],
)
@pytest.mark.filterwarnings("error")
def test_every_surface_has_a_card(points):
    card = ts.triangulate(points)._repr_html_()
    height, width, _ = picture_of(card).shape
    assert 1 <= height <= 240
    assert 1 <= width <= 320


def test_the_encoder_writes_what_others_read():
    picture = np.random.default_rng(1).integers(0, 256, (17, 31, 4)).astype(np.uint8)
    with Image.open(io.BytesIO(encode_png(picture))) as image:
        assert image.mode == "RGBA"
        np.testing.assert_array_equal(np.asarray(image), picture)


def test_a_card_is_the_same_each_time_and_small():
    tin = hills(20_000)
    card = tin._repr_html_()
    assert card == hills(20_000)._repr_html_()
    assert len(card) < 200_000


def test_a_card_needs_neither_pyvista_nor_matplotlib_nor_pillow():
    code = (
        "import sys, tinsmith as ts\n"
        "heavy = dict.fromkeys(('pyvista', 'vtkmodules', 'matplotlib', 'PIL'))\n"
        "sys.modules.update(heavy)\n"
        "tin = ts.tin.triangulate([[0, 0, 1], [4, 0, 2], [0, 3, 4]])\n"
        "assert 'tinsmith.terrain' not in sys.modules\n"
        "assert tin._repr_html_().startswith('<div')\n"
    )
    run_alone(code)


@pytest.mark.slow
def test_an_exported_notebook_shows_card_and_page_without_a_network(tmp_path):
    """As nbconvert writes them: outputs of cells one below the other in one file."""
    tin = hills(300)
    file = tmp_path / "notebook.html"
    outputs = (tin._repr_html_(), ts.preview(tin, title='Site & "survey"')._repr_html_())
    ready = "<script>window.terrain = Promise.resolve()</script>"
    file.write_text(
        f"<!doctype html><meta charset='utf-8'>{ready}<div>{'</div><div>'.join(outputs)}</div>",
        encoding="utf-8",
    )
    with open_page(file) as page:
        sizes = page.evaluate("[...document.images].map((i) => [i.naturalWidth, i.naturalHeight])")
        assert sizes == [[picture_of(outputs[0]).shape[1], picture_of(outputs[0]).shape[0]]]
        (inner,) = [frame for frame in page.frames if frame != page.main_frame]
        assert inner.evaluate("window.terrain.then((p) => p.scene.models.length)") == 1
        assert inner.title() == 'Site & "survey"'
