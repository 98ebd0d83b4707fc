"""Make the pictures of preview.md: pages of both samples and of a tileset, and with an ortho.

Run ``python docs/make_preview.py [FOLDER]``; needs the extras "raster" and "view", Chromium and
playwright. The orthos are invented: land cover by elevation and slope, in a GeoTIFF each,
which are made and left in the folder ``build/orthos``.
"""

from __future__ import annotations

import shutil
import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
import rasterio

import tinsmith as ts
from tinsmith.terrain.drawing.linework import find_line_edges

if TYPE_CHECKING:
    from tinsmith.base.arrays import Float64Array

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_data"
ORTHOS = HERE.parent / "build" / "orthos"
CRS = "EPSG:32616"
COLORS = 128
SIZE = (1200, 740)
ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SHOW = "p.scene.draw(); p.tool.read(460, 400);"
SHOW_TILES = """p.scene.zoom(2.2); p.scene.move(0.05, -0.05);
  document.getElementById("edges").click();
  await p.tileset.settle(); p.scene.draw();
  const { clientWidth: w, clientHeight: h } = p.scene.canvas; p.tool.read(0.5 * w, 0.5 * h);"""
SHOW_EPOCHS = """document.getElementById("comparing").click(); p.tool.choose("distance");
  await new Promise((done) => setTimeout(done, 500));
  const { clientWidth: w, clientHeight: h } = p.scene.canvas;
  p.tool.mark(0.35 * w, 0.5 * h); p.tool.mark(0.65 * w, 0.55 * h); p.tool.read(0.5 * w, 0.5 * h);"""
FOREST, MEADOW, FIELD, ROCK = (62, 84, 50), (126, 142, 84), (186, 172, 118), (150, 142, 128)
PAVED = (128, 127, 124)


def main(folder: Path = HERE) -> None:
    """Make the orthos and the pictures."""
    ORTHOS.mkdir(parents=True, exist_ok=True)
    survey = ts.read(SAMPLES / "site_survey.csv", crs=CRS)
    site = ts.triangulate(ts.lines_from_codes(survey))
    hills = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    draw_page(ts.preview(site, survey=survey, title="Site survey"), folder / "preview-page.png")
    draw_page(
        ts.preview({"Before": site, "After": move_ground(site)}, title="Two epochs"),
        folder / "preview-epochs.png",
        show=SHOW_EPOCHS,
    )
    draw_page(ts.preview(hills, title="Jacksboro, Tennessee"), folder / "preview-hills.png")
    draw_tileset(folder / "preview-tileset.png")
    ortho = paint_site(site)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        draped = ts.preview(site, survey=survey, title="Site survey", ortho=ortho)
        draw_page(draped, folder / "preview-page-ortho.png")
        ts.preview(
            hills,
            title="Jacksboro, Tennessee",
            ortho=paint_hills(hills),
            output=folder / "preview-ortho.png",
            size=(1200, 750),
        )
    save_colors(folder / "preview-ortho.png")


def move_ground(tin: ts.TIN) -> ts.TIN:
    """Return a surface with invented cut and fill."""
    points = tin.points.copy()
    points[:, 2] += 2 * np.sin(points[:, 0] / 23) * np.cos(points[:, 1] / 31)
    return tin.replace(points=points)


def draw_tileset(path: Path, size: tuple[int, int] = SIZE) -> None:
    """Take a picture of the page of a tileset, as it is served."""
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        cloud = ts.tiles(SAMPLES / "jacksboro.tif")
        cloud.write(Path(folder, "terrain"), format="3dtiles", node_points=500)
        shown = ts.preview_tileset(Path(folder, "terrain"), title="Jacksboro, Tennessee")
        with shown.serve() as address:
            draw_address(address, path, show=SHOW_TILES, size=size)


def draw_page(shown: ts.Preview, path: Path, show: str = SHOW) -> None:
    """Take a picture of a page that is opened from a file."""
    with TemporaryDirectory() as folder:
        draw_address(shown.save(Path(folder, "page.html")).as_uri(), path, show=show)


def draw_address(address: str, path: Path, *, show: str, size: tuple[int, int] = SIZE) -> None:
    """Take a picture of a page as Chromium shows it, in few colours."""
    from playwright.sync_api import sync_playwright

    browser_path = shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=browser_path, args=[*ARGUMENTS])
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.goto(address, timeout=120_000)
        page.evaluate(f"window.terrain.then(async (p) => {{ {show} }})")
        page.wait_for_timeout(2000)
        page.screenshot(path=path, timeout=120_000)
        browser.close()
    save_colors(path)


def save_colors(path: Path) -> None:
    """Write a picture anew in few colours, for a small file."""
    from PIL import Image

    Image.open(path).convert("RGB").quantize(COLORS).save(path, optimize=True)


# ----------------------------------------------------------------------- invented orthos


def paint_hills(tin: ts.TIN) -> Path:
    """Paint forest on what is steep, fields in the valleys, meadows between."""
    x, y, z = sample(tin, 40.0)
    steepness = np.hypot(*np.gradient(z, 40.0))
    patches = np.random.default_rng(4).random((400, 400))
    field = patches[(y // 350).astype(int) % 400, (x // 520).astype(int) % 400]
    colors = np.where((field > 0.55)[..., None], FIELD, MEADOW).astype(float)
    colors[(steepness > 0.16) | (z > 520)] = FOREST
    colors[(steepness > 0.75)] = ROCK
    return write_ortho(ORTHOS / "hills.tif", tin, 40.0, colors, z)


def paint_site(tin: ts.TIN) -> Path:
    """Paint meadow, and what is paved along the breaklines."""
    spacing = 0.25
    x, y, z = sample(tin, spacing)
    colors = np.full((*z.shape, 3), MEADOW, float)
    colors[(np.sin(x / 17) + np.sin(y / 23 + x / 40)) > 1.1] = FIELD
    found = find_line_edges(tin)
    ends = tin.points[found.pairs][:, :, :2]
    for start, stop in ends:
        paint_strip(colors, tin, spacing, start, stop)
    return write_ortho(ORTHOS / "site.tif", tin, spacing, colors, z)


def paint_strip(
    colors: Float64Array,
    tin: ts.TIN,
    spacing: float,
    start: Float64Array,
    stop: Float64Array,
) -> None:
    """Paint a strip of 1.5 m along a line."""
    box = tin.bounds
    count = max(int(np.hypot(*(stop - start)) / spacing), 1)
    width = int(0.75 / spacing)
    for place in start + np.linspace(0, 1, count + 1)[:, None] * (stop - start):
        column = int((place[0] - box.xmin) / spacing)
        row = int((box.ymax - place[1]) / spacing)
        colors[max(row - width, 0) : row + width, max(column - width, 0) : column + width] = PAVED


def sample(tin: ts.TIN, spacing: float) -> tuple[Float64Array, ...]:
    """Return eastings, northings and elevations of pixels, rows from the north."""
    box = tin.bounds
    x = np.arange(box.xmin + spacing / 2, box.xmax, spacing)
    y = np.arange(box.ymax - spacing / 2, box.ymin, -spacing)
    x, y = np.meshgrid(x, y)
    z = tin.interpolate(np.column_stack([x.ravel(), y.ravel()]), extrapolate="nearest")
    return x, y, z.reshape(x.shape)


def write_ortho(
    path: Path, tin: ts.TIN, spacing: float, colors: Float64Array, z: Float64Array
) -> Path:
    """Write a picture with grain and faint shadows of a sun in the southeast."""
    down, right = np.gradient(z, spacing)
    light = 1.0 + 0.4 * np.clip(down - right, -0.6, 0.6)
    grain = np.random.default_rng(1).normal(1.0, 0.06, z.shape)
    pixels = np.clip(colors * (light * grain)[..., None], 0, 255).astype(np.uint8)
    place = rasterio.Affine(spacing, 0.0, tin.bounds.xmin, 0.0, -spacing, tin.bounds.ymax)
    shape = {"height": z.shape[0], "width": z.shape[1], "count": 3}
    with rasterio.open(
        path, "w", driver="GTiff", dtype="uint8", crs=CRS, transform=place, **shape
    ) as target:
        target.write(np.moveaxis(pixels, 2, 0))
    return path


if __name__ == "__main__":
    main(*(Path(argument) for argument in sys.argv[1:]))
