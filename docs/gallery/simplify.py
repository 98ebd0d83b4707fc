"""Make the picture of a DEM's triangles before and after it is simplified.

Run ``python docs/gallery/simplify.py [FOLDER]``; needs the extras "plot" and "raster".
"""

import sys
from pathlib import Path

from matplotlib.figure import Figure
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

WINDOW = ts.Bounds(744_500, 4_019_500, 748_100, 4_022_500)
TOLERANCE = 10.0


def main(folder: Path = FOLDER) -> None:
    """Write simplify.png."""
    tin = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif", window=WINDOW))
    simple = ts.simplify(tin, tolerance=TOLERANCE)
    told = simple.report.simplification
    figure = Figure(figsize=(11, 4.9), layout="constrained")
    titles = (
        f"DEM: {len(tin.points):,} points",
        f"{len(simple.points):,} points, none of all farther than {told.largest_error:.1f} m",
    )
    for axes, surface, title in zip(figure.subplots(1, 2), (tin, simple), titles, strict=True):
        x, y, z = surface.points.T
        axes.tripcolor(x, y, surface.triangles, z, cmap="YlOrBr_r", shading="gouraud", alpha=0.8)
        axes.triplot(x, y, surface.triangles, color="#222222", linewidth=0.25)
        axes.set(xlim=(x.min(), x.max()), ylim=(y.min(), y.max()), aspect="equal")
        axes.set_xticks([])
        axes.set_yticks([])
        axes.set_title(title, fontsize=11)
    save(draw(figure, 100), folder / "simplify.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
