"""Make the picture of a pad graded into a slope: contours, pad edge, daylight line, cut and fill.

Run ``python docs/gallery/grade.py [FOLDER]``; needs the extra "plot".
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

PAD = np.add([752_740, 4_024_290], [[0, 0], [50, 0], [50, 32], [28, 32], [28, 18], [0, 18]])
LEVEL = 327.0


def main(folder: Path = FOLDER) -> None:
    """Write grade.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    ground = ts.triangulate(ts.lines_from_codes(survey))
    graded = ts.grade(ground, PAD, LEVEL, cut_slope=2, fill_slope=3)
    found = ts.volume(ground, graded)
    change = ts.difference(ground, graded).tin
    figure = Figure(figsize=(11, 5.6), layout="constrained")
    axes = figure.subplots(1, 2)
    titles = (
        "Ground and graded: contours every 0.5 m",
        f"Cut {found['cut'][0]:,.0f} m³, fill {found['fill'][0]:,.0f} m³",
    )
    x, y, z = graded.points.T
    levels = np.arange(np.floor(z.min()), z.max(), 0.5)
    axes[0].tricontour(
        *ground.points[:, :2].T, ground.triangles, ground.points[:, 2], levels, colors="#bbbbbb"
    )
    axes[0].tricontour(x, y, graded.triangles, z, levels, colors="#7a5230", linewidths=0.9)
    largest = float(np.abs(change.points[:, 2]).max())
    drawn = axes[1].tripcolor(
        *change.points[:, :2].T, change.triangles, change.points[:, 2],
        cmap="RdBu", vmin=-largest, vmax=largest, shading="gouraud",
    )  # fmt: skip
    figure.colorbar(drawn, ax=axes[1], label="fill (blue) and cut (red), m", shrink=0.8)
    for one, title in zip(axes, titles, strict=True):
        _draw_lines(one, graded)
        west, south = PAD.min(axis=0) - 25
        east, north = PAD.max(axis=0) + 25
        one.set(xlim=(west, east), ylim=(south, north), aspect="equal", xticks=[], yticks=[])
        one.set_title(title, fontsize=11)
    save(draw(figure, 100), folder / "grade.png")


def _draw_lines(axes: object, graded: ts.TIN) -> None:
    styles = {"pad edge": ("#000000", 1.8), "daylight": ("#1a7f37", 1.6)}
    for chain, name in zip(graded.lines.chains(), graded.lines.names, strict=True):
        if name in styles:
            color, width = styles[name]
            axes.plot(*graded.points[chain, :2].T, color=color, linewidth=width)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
