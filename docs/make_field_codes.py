"""Make the picture of field-codes.md: shots with their codes, and the lines that these make.

Run ``python docs/make_field_codes.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import tinsmith as ts

HERE = Path(__file__).parent
CODES = HERE.parent / "sample_data" / "codes"
CORNER = np.array([752_100.0, 4_024_400.0])
COLORS = 128
DPI = 110
LABELLED = ("EP", "CL", "WALL", "WE", "BLDG", "PATH", "CP", "BM")
DRAWN = {"EP": "black", "CL": "tab:red", "WALL": "tab:brown", "BLDG": "tab:purple"}


def main(folder: Path = HERE) -> None:
    """Write field-codes.png."""
    from matplotlib.figure import Figure

    survey = ts.read(CODES / "junction.csv", crs="EPSG:32616", elevation_unit="m")
    made = ts.lines_from_codes(survey, code_table=CODES / "words.toml")
    tin = ts.triangulate(made)
    figure = Figure(figsize=(11, 7.6), layout="constrained")
    axes = figure.add_subplot()
    draw_surface(axes, tin)
    draw_lines(axes, made)
    draw_shots(axes, survey, made)
    axes.set(aspect="equal", xlabel="easting - 752,100 m", ylabel="northing - 4,024,400 m")
    axes.use_sticky_edges = False  # of contours, which end at the border of the points
    axes.margins(0.05)
    axes.autoscale()
    axes.set_title("Codes in the field, lines on the map (EPSG:32616)")
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=DPI)
    sheet = (
        Image.open(png)
        .convert("RGB")
        .quantize(COLORS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    )
    sheet.save(folder / "field-codes.png", optimize=True)


def draw_surface(axes: Any, tin: ts.TIN) -> None:
    """Draw the triangles and contours of the surface, pale."""
    x, y = (tin.points[:, :2] - CORNER).T
    axes.triplot(x, y, tin.triangles, color="0.88", linewidth=0.5)
    z = tin.points[:, 2]
    levels = np.arange(np.floor(z.min()), z.max(), 0.25)
    axes.tricontour(x, y, tin.triangles, z, levels=levels, colors="tan", linewidths=0.6)


def draw_lines(axes: Any, survey: ts.Survey) -> None:
    """Draw lines by what they are, vertices of curves as small dots."""
    for line in survey.breaklines:
        code = line.name.rstrip("0123456789")
        xy = line.coords[:, :2] - CORNER
        style = "--" if line.kind == "soft" else "-"
        axes.plot(*xy.T, style, color=DRAWN.get(code, "tab:green"), linewidth=1.6)
        axes.plot(*xy.T, ".", color=DRAWN.get(code, "tab:green"), markersize=2.5)
    for water in survey.water:
        axes.fill(*(water.ring - CORNER).T, color="tab:blue", alpha=0.35)
        axes.annotate(f"level {water.z:.2f} m", water.ring.mean(axis=0) - CORNER, ha="center")


def draw_shots(axes: Any, survey: ts.Survey, made: ts.Survey) -> None:
    """Draw shots, crossed where they are not for the surface, with codes of lines and others."""
    kept = {tuple(point) for point in made.points.tolist()}
    for point, text in zip(
        survey.points.tolist(), survey.attributes["description"].tolist(), strict=True
    ):
        is_in = tuple(point) in kept
        x, y = np.array(point[:2]) - CORNER
        axes.plot(x, y, "o" if is_in else "x", color="0.35" if is_in else "tab:red", markersize=4)
        if text.startswith(LABELLED):
            words = text.partition(",")[0]
            axes.annotate(words, (x, y), (3, 3), textcoords="offset points", fontsize=6.5)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
