"""Make the picture of interpolation methods: one place of the sample site by four of them.

Run ``python docs/gallery/interpolation.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import tinsmith as ts

HERE = Path(__file__).parent
SURVEY = HERE.parent.parent / "sample_data" / "site_survey.csv"
WINDOW = ts.Bounds(752765.0, 4024252.0, 752825.0, 4024292.0)
SPACING = 0.1
EXAGGERATION = 3.0
SUN_UP, SUN_ACROSS = np.sin(np.radians(40)), np.cos(np.radians(40)) / np.sqrt(2)
"""Light from the north-west, 40 degrees above the horizon."""

TITLES = {
    "linear": "linear: the triangles",
    "nearest": "nearest vertex",
    "natural": "natural neighbours (Sibson)",
    "c1": "c1: smooth patches",
}
INK, LINE, POINT = "#333333", "#b3472d", "#0b5fa5"


def main(folder: Path = HERE) -> None:
    """Write interpolation.png."""
    tin = ts.triangulate(ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616", elevation_unit="m")))
    shape = round(WINDOW.height / SPACING), round(WINDOW.width / SPACING)
    grid = ts.Grid(WINDOW, shape=shape, spacing=SPACING)
    figure = Figure(figsize=(10.0, 7.6), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True, sharey=True)
    for axis, (method, title) in zip(axes.ravel(), TITLES.items(), strict=True):
        raster = ts.rasterize(tin, grid=grid, method=method)
        draw(axis, tin, raster.bands["elevation"], title)
    for axis in axes[-1]:
        axis.set_xlabel("Easting (m), WGS 84 / UTM zone 16N")
    for axis in axes[:, 0]:
        axis.set_ylabel("Northing (m)")
    figure.suptitle(
        "Four methods on the same vertices: breaklines (red) stay breaks of slope; vertical 3:1"
    )
    figure.savefig(folder / "interpolation.png", dpi=85, metadata={"Software": None})


def draw(axis: Any, tin: ts.TIN, elevations: Any, title: str) -> None:
    """Draw a hillshade with the vertices and hard lines over it."""
    south, east = np.gradient(elevations, SPACING)
    up = 1 / np.sqrt(1 + EXAGGERATION**2 * (south**2 + east**2))
    shade = up * (SUN_UP + SUN_ACROSS * EXAGGERATION * (south + east))
    extent = (WINDOW.xmin, WINDOW.xmax, WINDOW.ymin, WINDOW.ymax)
    axis.imshow(shade, extent=extent, cmap="gray", vmin=0, vmax=1)
    for chain, kind in zip(tin.lines.chains(), tin.lines.kinds, strict=True):
        style = "-" if kind != "soft" else ":"
        axis.plot(*tin.points[chain, :2].T, style, color=LINE, linewidth=1.1)
    axis.plot(*tin.points[:, :2].T, ".", color=POINT, markersize=2.5)
    axis.set(xlim=(WINDOW.xmin, WINDOW.xmax), ylim=(WINDOW.ymin, WINDOW.ymax))
    axis.set_title(title, color=INK, fontsize=10, loc="left")
    axis.ticklabel_format(useOffset=False, style="plain")
    axis.set_xticks(np.arange(WINDOW.xmin + 5, WINDOW.xmax, 20))
    axis.set_yticks(np.arange(WINDOW.ymin + 8, WINDOW.ymax, 10))
    axis.tick_params(labelsize=8)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
