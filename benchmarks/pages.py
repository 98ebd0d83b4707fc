"""How large pages are, how soon they open in Chromium and how fast they turn.

``python -m benchmarks.pages [TRIANGLES ...]`` needs Chromium and playwright. Without a graphics
card Chromium draws on the processor, so turning is the worst case.
"""

from __future__ import annotations

import argparse
import shutil
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import tinsmith as ts

from .report.tables import Table, add_option

COLUMNS = {
    "triangles": "{:,}",
    "written, s": "{:.2f}",
    "size, MB": "{:.2f}",
    "opened, s": "{:.2f}",
    "picture, ms": "{:.1f}",
}

_ARGUMENTS = (
    *("--no-sandbox", "--use-angle=swiftshader"),
    *("--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"),
)
_OPENED = "window.terrain.then(() => performance.now())"
_TURNED = """window.terrain.then((page) => {
  const start = performance.now(), gl = page.scene.renderer.getContext();
  for (let k = 0; k < 20; k += 1) {
    page.scene.turn(0.02, 0); page.scene.draw(); gl.readPixels(0, 0, 1, 1, gl.RGBA,
      gl.UNSIGNED_BYTE, new Uint8Array(4)); }
  return (performance.now() - start) / 20; })"""


def make_terrain(triangles: int) -> ts.TIN:
    """Return a hilly TIN of scattered points, in coordinates of UTM."""
    xy = np.random.default_rng(1).random((triangles // 2, 2)) * 2000
    z = 300 + 30 * np.sin(xy[:, 0] / 150) * np.cos(xy[:, 1] / 210) + xy[:, 0] / 100
    points = np.round(np.column_stack([xy + np.array([742_000.0, 4_030_000.0]), z]), 3)
    return ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")


def measure_page(triangles: int) -> tuple[int, float, float, float, float]:
    """Return triangles, seconds to write, MB, seconds to open, and ms of a picture of a page."""
    from playwright.sync_api import sync_playwright

    browser_path = shutil.which("chromium") or shutil.which("chromium-browser")
    tin = make_terrain(triangles)
    with TemporaryDirectory() as folder, sync_playwright() as driver:
        begin = time.perf_counter()
        path = ts.preview(tin).save(Path(folder, "terrain.html"))
        written = time.perf_counter() - begin
        browser = driver.chromium.launch(executable_path=browser_path, args=[*_ARGUMENTS])
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(path.as_uri(), timeout=120_000)
        opened = page.evaluate(_OPENED) / 1000
        turned = page.evaluate(_TURNED)
        megabytes = path.stat().st_size / 1e6
        browser.close()
    assert len(tin.triangles) > 0.9 * triangles
    return len(tin.triangles), written, megabytes, opened, turned


def main() -> None:
    """Show the figures of pages of as many triangles as the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pages", description=__doc__)
    parser.add_argument("triangles", nargs="*", type=int, default=[100_000, 1_000_000])
    add_option(parser)
    given = parser.parse_args()
    table = Table(COLUMNS)
    for count in given.triangles:
        table.show(*measure_page(count))
    table.write(given.json)


if __name__ == "__main__":
    main()
