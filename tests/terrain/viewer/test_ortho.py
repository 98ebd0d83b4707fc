"""What is draped lies at its place, in its colours: in the page, in pictures, however it comes."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from support.orthos import (
    NORTH,
    SIDE,
    WEST,
    list_places,
    make_square,
    paint_quarters,
    write_raster,
)
from support.pages import open_page

import tinsmith as ts
from tinsmith.terrain.viewer import ortho as ortho_module
from tinsmith.terrain.viewer.ortho import read_ortho

rasterio = pytest.importorskip("rasterio")
pytest.importorskip("PIL")

NOWHERE = rasterio.Affine(1, 0, 0, 0, 1, 0)
NEAR = 26
"""By which JPEG and WebP may change a colour of 255."""


def find_colors(ortho, places):
    """Return red, green, blue and opacity of a picture at eastings and northings."""
    rows, columns = ortho.shape
    at = ortho.place(places)
    assert ((at >= 0) & (at <= 1)).all()
    pixels = ortho.decode()
    return pixels[(at[:, 1] * rows).astype(int), (at[:, 0] * columns).astype(int)].astype(int)


def require_quarters(ortho, tolerance=NEAR):
    places, colors = list_places()
    found = find_colors(ortho, places)
    assert np.abs(found[:, :3] - colors).max() <= tolerance
    assert (found[:, 3] == 255).all()


# ------------------------------------------------------------------ how pictures come


def make_palette():
    """Return indices of a palette and the palette."""
    half = np.arange(200) // 100
    indices = (3 + 2 * half[:, None] + half)[None].astype(np.uint8)
    return indices, {3: (255, 0, 0), 4: (0, 255, 0), 5: (0, 0, 255), 6: (255, 255, 0)}


def test_colours_of_8_bits(tmp_path):
    require_quarters(
        read_ortho(write_raster(tmp_path / "a.tif", paint_quarters(200)), [make_square()])
    )


@pytest.mark.parametrize("compress", ["jpeg", "deflate", "lzw"])
def test_compressed_and_tiled(tmp_path, compress):
    more = {"photometric": "ycbcr"} if compress == "jpeg" else {}
    path = write_raster(
        tmp_path / "a.tif", paint_quarters(256), compress=compress, tiled=True, **more
    )
    require_quarters(read_ortho(path, [make_square()]))


def test_colours_of_16_bits(tmp_path):
    bands = paint_quarters(200, top=65_535, dtype=np.uint16)
    path = write_raster(tmp_path / "a.tif", bands, photometric="rgb")
    require_quarters(read_ortho(path, [make_square()]))


def test_colours_of_12_bits_in_16_are_told(tmp_path):
    bands = paint_quarters(200, top=4_095, dtype=np.uint16)
    path = write_raster(tmp_path / "a.tif", bands, photometric="rgb")
    with pytest.warns(ts.LossWarning, match=r"up to 4,095: they are taken for colours of 12 bits"):
        require_quarters(read_ortho(path, [make_square()]))


def test_bands_without_colours_are_told(tmp_path):
    bands = np.concatenate([paint_quarters(200), np.full((1, 200, 200), 77, np.uint8)])
    path = write_raster(tmp_path / "a.tif", bands, photometric="minisblack", alpha="unspecified")
    with pytest.warns(ts.LossWarning, match="the first three are taken"):
        require_quarters(read_ortho(path, [make_square()]))


def test_a_palette_stays_sharp(tmp_path):
    indices, palette = make_palette()
    ortho = read_ortho(write_raster(tmp_path / "a.tif", indices, palette=palette), [make_square()])
    assert ortho.kind == "png"
    require_quarters(ortho, tolerance=0)


@pytest.mark.parametrize("is_inverted", [False, True])
def test_grey(tmp_path, is_inverted):
    grey = np.tile(np.linspace(0, 255, 200).astype(np.uint8), (1, 200, 1))
    how = {"photometric": "miniswhite"} if is_inverted else {}
    ortho = read_ortho(write_raster(tmp_path / "a.tif", grey, **how), [make_square()])
    places, _ = list_places()
    expected = (places[:, 0] - WEST) / SIDE * 255
    expected = 255 - expected if is_inverted else expected
    found = find_colors(ortho, places)[:, :3]
    assert np.abs(found - expected[:, None]).max() < 6


def test_opacity_leaves_the_tints(tmp_path):
    opacity = np.zeros((1, 200, 200), np.uint8)
    opacity[0, :100] = 255
    bands = np.concatenate([paint_quarters(200), opacity])
    check_upper_half(write_raster(tmp_path / "a.tif", bands))


def test_a_mask_leaves_the_tints(tmp_path):
    mask = np.zeros((200, 200), np.uint8)
    mask[:100] = 255
    check_upper_half(write_raster(tmp_path / "a.tif", paint_quarters(200), mask=mask))


def test_nodata_leaves_the_tints(tmp_path):
    bands = paint_quarters(200)
    bands[:, 100:] = 7
    check_upper_half(write_raster(tmp_path / "a.tif", bands, nodata=7))


def test_inks_become_light(tmp_path):
    """Cyan, magenta, yellow and black as on paper; GDAL turns them into red, green and blue."""
    light = paint_quarters(200)
    inks = np.concatenate([255 - light, np.zeros((1, 200, 200), np.uint8)])
    path = write_raster(tmp_path / "a.tif", inks, photometric="cmyk")
    require_quarters(read_ortho(path, [make_square()]))


def test_two_colours_of_a_bit(tmp_path):
    bits = (paint_quarters(200)[:1] > 0).astype(np.uint8)
    ortho = read_ortho(write_raster(tmp_path / "a.tif", bits, nbits=1), [make_square()])
    places, colors = list_places()
    assert np.array_equal(find_colors(ortho, places)[:, 0], colors[:, 0])


def check_upper_half(path):
    with pytest.warns(ts.LossWarning, match="does not reach over"):
        ortho = read_ortho(path, [make_square()])
    places, colors = list_places()
    found = find_colors(ortho, places)
    upper = places[:, 1] > NORTH - SIDE / 2
    assert np.abs(found[upper, :3] - colors[upper]).max() <= NEAR
    assert (found[upper, 3] == 255).all()
    assert (found[~upper, 3] == 0).all()
    assert 0.4 < ortho.gap < 0.6
    return ortho


# ------------------------------------------------------------------ where pictures lie


@pytest.mark.parametrize("turn", [0.0, 30.0, 200.0])
def test_a_turned_picture(tmp_path, turn):
    middle = rasterio.Affine.translation(WEST + SIDE / 2, NORTH - SIDE / 2)
    pixel = rasterio.Affine.scale(1.0, -1.0) @ rasterio.Affine.translation(-300, -300)
    place = middle @ rasterio.Affine.rotation(turn) @ pixel
    rows, columns = np.mgrid[0:600, 0:600] + 0.5
    x, y = locate(place, columns, rows)
    colors = np.zeros((3, 600, 600), np.uint8)
    colors[0] = np.clip((x - WEST) / SIDE * 255, 0, 255)
    colors[1] = np.clip((NORTH - y) / SIDE * 255, 0, 255)
    path = write_raster(tmp_path / "a.tif", colors, transform=place)
    places, _ = list_places()
    found = find_colors(read_ortho(path, [make_square()]), places)
    assert np.abs(found[:, 0] - (places[:, 0] - WEST) / SIDE * 255).max() < 6
    assert np.abs(found[:, 1] - (NORTH - places[:, 1]) / SIDE * 255).max() < 6


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:32617", "EPSG:3857", "EPSG:2274"])
def test_another_crs_is_warped_and_told(tmp_path, crs):
    tin = make_square()
    path = write_elsewhere(tmp_path / "a.tif", crs)
    with pytest.warns(ts.LossWarning) as told:
        ortho = read_ortho(path, [tin])
    assert any(f"was warped from {crs} to EPSG:32616" in str(one.message) for one in told)
    places, _ = list_places()
    found = find_colors(ortho, places)
    assert np.abs(found[:, 0] - (places[:, 0] - WEST) / SIDE * 255).max() < 6
    assert np.abs(found[:, 1] - (NORTH - places[:, 1]) / SIDE * 255).max() < 6
    assert ortho.gap == 0.0


def locate(place, columns, rows):
    return (
        place.a * columns + place.b * rows + place.c,
        place.d * columns + place.e * rows + place.f,
    )


def write_elsewhere(path, crs):
    """Write a picture in another CRS, each of whose pixels is coloured by its place on the square.

    Places go through pyproj here, and through GDAL where the picture is read.
    """
    corners = [[WEST + i * SIDE, NORTH - j * SIDE, 0.0] for i in (0, 1) for j in (0, 1)]
    known = ts.transform_points(corners, "EPSG:32616", crs)[:, :2]
    low, high = known.min(axis=0), known.max(axis=0)
    margin = 0.1 * (high - low)
    low, high, n = low - margin, high + margin, 500
    step = (high - low) / n
    place = rasterio.Affine(step[0], 0.0, low[0], 0.0, -step[1], high[1])
    rows, columns = np.mgrid[0:n, 0:n] + 0.5
    x, y = locate(place, columns.ravel(), rows.ravel())
    back = ts.transform_points(np.column_stack([x, y, np.zeros(n * n)]), crs, "EPSG:32616")
    colors = np.zeros((3, n, n), np.uint8)
    colors[0] = np.clip((back[:, 0] - WEST) / SIDE * 255, 0, 255).reshape(n, n)
    colors[1] = np.clip((NORTH - back[:, 1]) / SIDE * 255, 0, 255).reshape(n, n)
    return write_raster(path, colors, crs=crs, transform=place)


def test_of_a_large_picture_the_part_over_the_surface_is_kept(tmp_path):
    bands = paint_quarters(200)
    wide = np.full((3, 1000, 1200), 99, np.uint8)
    wide[:, 500:700, 300:500] = bands
    place = rasterio.Affine(1.5, 0, WEST - 450, 0, -1.5, NORTH + 750)
    ortho = read_ortho(write_raster(tmp_path / "a.tif", wide, transform=place), [make_square()])
    assert max(ortho.shape) < 210
    require_quarters(ortho)


def test_a_large_picture_is_made_smaller_and_it_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(ortho_module, "MOST_PIXELS", 100)
    path = write_raster(tmp_path / "a.tif", paint_quarters(400))
    with pytest.warns(ts.LossWarning, match=r"from 400 x 400 to 100 x 100 pixels"):
        ortho = read_ortho(path, [make_square()])
    assert ortho.shape == (100, 100)
    require_quarters(ortho)


def test_a_picture_inside_one_triangle_is_seen(tmp_path):
    tin = ts.triangulate(
        np.array([[0, 0, 1], [4000, 0, 2], [0, 4000, 3]]) + np.array([WEST - 500, NORTH - 900, 0]),
        crs="EPSG:32616",
    )
    path = write_raster(tmp_path / "a.tif", paint_quarters(50))
    with pytest.warns(ts.LossWarning, match=r"does not reach over 100.0% of the vertices"):
        assert read_ortho(path, [tin]).gap == 1.0


def test_boxes_that_meet_are_not_enough(tmp_path):
    tin = ts.triangulate(
        np.array([[0, 0, 1], [4000, 0, 2], [0, 4000, 3]])
        + np.array([WEST - 3500, NORTH - 3500, 0]),
        crs="EPSG:32616",
    )
    path = write_raster(tmp_path / "a.tif", paint_quarters(50))
    with pytest.raises(ts.ReadError, match="shows nothing of the surface"):
        read_ortho(path, [tin])


@pytest.mark.parametrize(("of_tin", "of_picture"), [(None, "EPSG:32616"), ("EPSG:32616", None)])
def test_a_crs_that_is_not_known_is_told(tmp_path, of_tin, of_picture):
    path = write_raster(tmp_path / "a.tif", paint_quarters(200), crs=of_picture)
    with pytest.warns(ts.LossWarning, match=r"no CRS"):
        require_quarters(read_ortho(path, [make_square(of_tin)]))


# ------------------------------------------------------------------ what is refused


@pytest.mark.parametrize(
    ("bands", "profile", "sentence"),
    [
        (np.zeros((1, 9, 9), np.float32), {}, "it holds float32 numbers"),
        (np.zeros((7, 9, 9), np.uint8), {"photometric": "minisblack"}, "it has 7 bands"),
        (np.zeros((3, 9, 9), np.uint8), {"transform": NOWHERE}, "no place"),
        (
            np.zeros((3, 9, 9), np.uint8),
            {"transform": rasterio.Affine(1, 0, 5, 0, -1, 5)},
            "shows nothing of the surface",
        ),
        (np.zeros((3, 9, 9), np.uint8), {"crs": "EPSG:25832"}, "shows nothing of the surface"),
    ],
)
def test_what_is_no_picture_of_the_surface(tmp_path, bands, profile, sentence):
    path = write_raster(tmp_path / "a.tif", bands, **profile)
    with pytest.raises(ts.ReadError, match=sentence) as told:
        ts.preview(make_square(), ortho=path)
    assert str(path) in str(told.value)


def test_what_is_no_file(tmp_path):
    tin = make_square()
    (tmp_path / "text.tif").write_text("no picture")
    for source, sentence in [
        (tmp_path / "none.tif", "Cannot read"),
        (tmp_path, "is a folder"),
        ("https://example.org/a.tif", "only files of this machine"),
        (tmp_path / "text.tif", "cannot be read"),
    ]:
        with pytest.raises(ts.ReadError, match=sentence):
            ts.preview(tin, ortho=source)
    with pytest.raises(ts.OptionError, match="path of a GeoTIFF"):
        ts.preview(tin, ortho=7)


# ------------------------------------------------------------------ where it is seen

READ = """(places) => window.terrain.then((p) => {
  const gl = p.scene.renderer.getContext(), o = p.payload.origin;
  const [width, height] = [p.scene.canvas.width, p.scene.canvas.height],
    all = new Uint8Array(4 * width * height);
  const ratio = p.scene.canvas.width / p.scene.canvas.clientWidth;
  const surface = p.scene.models[0].surface;
  document.getElementById("shading").click();
  p.scene.draw();
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
  const seen = places.map(([x, y, z]) => {
    const s = p.payload.scale;
    const at = p.scene.project((x - o[0]) * s[0], (y - o[1]) * s[1], z - o[2]);
    const at_pixel = Math.floor(height - at[1] * ratio) * width + Math.floor(at[0] * ratio);
    return [...all.slice(4 * at_pixel, 4 * at_pixel + 4)]; });
  document.getElementById("shading").click();
  return seen; })"""


def read_canvas(page, tin, places):
    z = tin.interpolate(places, extrapolate="nearest")
    return np.array(page.evaluate(READ, np.column_stack([places, z]).tolist()))[:, :3].astype(int)


@pytest.mark.slow
@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:4326"])
def test_the_page_shows_each_colour_at_its_place(tmp_path, crs):
    path = write_raster(tmp_path / "a.tif", paint_quarters(400))
    tin = make_square()
    if crs != "EPSG:32616":
        moved = ts.transform_points(tin.points, "EPSG:32616", crs)
        tin = ts.TIN.from_triangles(moved, tin.triangles, crs=crs, elevation_unit="m")
    places, colors = list_places()
    if crs == "EPSG:32616":
        made = ts.preview(tin, ortho=path)
    else:
        with pytest.warns(ts.LossWarning):
            made = ts.preview(tin, ortho=path)
        lifted = np.column_stack([places, np.zeros(len(places))])
        places = ts.transform_points(lifted, "EPSG:32616", crs)[:, :2]
    with open_page(made.save(tmp_path / "a.html")) as page:
        assert page.input_value("#tint") == "ortho"
        for azimuth, tilt, factor in [(180, 90, 1), (195, 50, 2), (40, 70, 0.5)]:
            page.evaluate(
                f"window.terrain.then((p) => {{ p.settings.setExaggeration({factor});"
                f" p.scene.look({azimuth}, {tilt}); }})"
            )
            assert np.abs(read_canvas(page, tin, places) - colors).max() <= NEAR
        page.select_option("#tint", "elevation")
        assert np.abs(read_canvas(page, tin, places) - colors).max() > 100


@pytest.mark.slow
def test_the_tints_stay_where_there_is_no_picture(tmp_path):
    bands = np.concatenate([paint_quarters(200), np.zeros((1, 200, 200), np.uint8)])
    bands[3, :100] = 255
    tin = make_square()
    with pytest.warns(ts.LossWarning, match="does not reach"):
        made = ts.preview(tin, ortho=write_raster(tmp_path / "a.tif", bands))
    places, colors = list_places()
    upper = places[:, 1] > NORTH - SIDE / 2
    with open_page(made.save(tmp_path / "a.html")) as page:
        page.evaluate("window.terrain.then((p) => p.scene.look(180, 90))")
        draped = read_canvas(page, tin, places)
        page.select_option("#tint", "elevation")
        tinted = read_canvas(page, tin, places)
        assert page.is_visible("#legend")
        assert "does not reach over" in page.inner_text("header")
    assert np.abs(draped[upper] - colors[upper]).max() <= NEAR
    assert np.abs(draped[~upper] - tinted[~upper]).max() <= 1


@pytest.mark.slow
def test_all_surfaces_of_a_page_are_draped(tmp_path):
    tin = make_square()
    raised = ts.TIN.from_triangles(
        tin.points + np.array([0, 0, 20]), tin.triangles, crs=tin.crs, elevation_unit="m"
    )
    path = write_raster(tmp_path / "a.tif", paint_quarters(200))
    made = ts.preview({"Existing": tin, "Design": raised}, ortho=path)
    places, colors = list_places()
    with open_page(made.save(tmp_path / "a.html")) as page:
        for shown, surface in [(0, tin), (1, raised)]:
            for k in range(3):
                page.set_checked(f"#surface-{k}", k == shown)
            page.evaluate("window.terrain.then((p) => p.scene.look(180, 90))")
            assert np.abs(read_canvas(page, surface, places) - colors).max() <= NEAR


def test_without_webgl_the_picture_is_on_the_still(tmp_path):
    path = write_raster(tmp_path / "a.tif", paint_quarters(200))
    saved = ts.preview(make_square(), ortho=path).save(tmp_path / "a.html")
    with open_page(saved, webgl=False) as page:
        seen = page.evaluate("""() => {
          const c = document.getElementById("notes"), side = 0.94 * Math.min(c.width, c.height);
          const pen = c.getContext("2d"), found = [];
          for (const j of [-0.25, 0.25]) for (const i of [-0.25, 0.25])
            found.push([...pen.getImageData(c.width / 2 + i * side, c.height / 2 + j * side, 1, 1)
              .data]);
          return found; }""")
    expected = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)]
    assert np.abs(np.array(seen)[:, :3] - expected).max() <= NEAR


def test_the_picture_lies_right_in_a_png(tmp_path):
    pil = pytest.importorskip("PIL.Image")
    pytest.importorskip("pyvista")
    path = write_raster(tmp_path / "a.tif", paint_quarters(2000))
    tin = make_square(height=0.0)
    out = ts.preview(tin, ortho=path, view="top", output=tmp_path / "a.png", lines=False,
                     size=(800, 600))  # fmt: skip
    pixels = np.asarray(pil.open(out).convert("RGB")).astype(int)
    frames = {}
    for name, color in zip("rgby", [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)],
                           strict=True):  # fmt: skip
        rows, columns = np.nonzero(np.abs(pixels - color).max(axis=2) < 60)
        frames[name] = (columns.min(), columns.max() + 1, rows.min(), rows.max() + 1)
    left, right, top, bottom = (
        min(one[0] for one in frames.values()),
        max(one[1] for one in frames.values()),
        min(one[2] for one in frames.values()),
        max(one[3] for one in frames.values()),
    )
    assert right - left == pytest.approx(bottom - top, abs=2)
    x, y = (left + right) / 2, (top + bottom) / 2
    expected = {"r": (left, x, top, y), "g": (x, right, top, y),
                "b": (left, x, y, bottom), "y": (x, right, y, bottom)}  # fmt: skip
    for name, frame in expected.items():
        assert np.abs(np.subtract(frames[name], frame)).max() <= 1.0


@pytest.mark.slow
def test_a_png_keeps_the_tints_beyond_the_picture(tmp_path):
    pil = pytest.importorskip("PIL.Image")
    pytest.importorskip("pyvista")
    tin = make_square()
    place = rasterio.Affine(1, 0, WEST + 100, 0, -1, NORTH - 100)
    path = write_raster(tmp_path / "a.tif", np.full((3, 100, 100), 255, np.uint8) *
                        np.array([1, 0, 1], np.uint8)[:, None, None], transform=place)  # fmt: skip
    plain = ts.preview(tin, view="top", output=tmp_path / "plain.png", size=(800, 500))
    with pytest.warns(ts.LossWarning, match="does not reach"):
        draped = ts.preview(tin, ortho=path, view="top", output=tmp_path / "a.png", size=(800, 500))
    a, b = (np.asarray(pil.open(one).convert("RGB")).astype(int) for one in (plain, draped))
    rows, columns = np.nonzero(np.abs(a - b).max(axis=2) > 8)
    assert np.ptp(rows) == pytest.approx(np.ptp(columns), abs=2)
    magenta = b[rows.mean().astype(int), columns.mean().astype(int)]
    assert np.abs(magenta - (255, 0, 255)).max() < 60


def test_glb_takes_the_same_picture(tmp_path):
    path = write_elsewhere(tmp_path / "a.tif", "EPSG:4326")
    with pytest.warns(ts.LossWarning, match="was warped"):
        made = ts.write(make_square(), tmp_path / "a.glb", ortho=path)
    assert b"image/" in made.read_bytes()


@pytest.mark.slow
def test_the_command_drapes(tmp_path):
    surface = ts.write(make_square(), tmp_path / "a.ply")
    write_raster(tmp_path / "far.tif", paint_quarters(20),
                 transform=rasterio.Affine(1, 0, 5, 0, -1, 5))  # fmt: skip
    write_raster(tmp_path / "a.tif", paint_quarters(20))
    command = [sys.executable, "-m", "tinsmith", "view", surface, "-o", tmp_path / "a.html"]
    done = subprocess.run([*command, "--ortho", tmp_path / "far.tif"], capture_output=True,
                          text=True, check=False)  # fmt: skip
    assert done.returncode == 1
    assert "shows nothing of the surface" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "a.html").exists()
    subprocess.run([*command, "--ortho", tmp_path / "a.tif"], check=True, capture_output=True)
    assert '"ortho":{"kind"' in (tmp_path / "a.html").read_text()
