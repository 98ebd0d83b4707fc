"""Make the picture of contours before and after their flat triangles are mended.

Run ``python docs/gallery/from_contours.py [FOLDER]``; needs the extras "plot" and "raster".
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

WINDOW = ts.Bounds(743_000, 4_018_000, 749_000, 4_023_000)
INTERVAL = 40.0


def main(folder: Path = FOLDER) -> None:
    """Write from_contours.png."""
    ground = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif", window=WINDOW))
    lines = ts.contours(ground, interval=INTERVAL)
    offsets = lines.offsets[0]
    chains = [lines.coordinates[a:b] for a, b in pairwise(offsets.tolist())]
    survey = ts.Survey(points=lines.coordinates, breaklines=chains, crs=ground.crs)
    flat = ts.triangulate(survey)
    figure = Figure(figsize=(11, 4.9), layout="constrained")
    for axes, (title, tin) in zip(
        figure.subplots(1, 2),
        {"As triangulated": flat, "Mended": ts.mend_flats(flat)}.items(),
        strict=True,
    ):
        show(axes, tin, chains)
        axes.set_title(f"{title}: flat triangles left: {count_flat(tin):,}", fontsize=11)
    save(draw(figure, 100), folder / "from_contours.png")


def show(axes, tin, chains):
    """Draw a hillshade with the contours on it."""
    shade = ts.hillshade(tin, spacing=12.0)
    bounds = shade.grid.bounds
    (band,) = shade.bands.values()
    extent = (bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax)
    axes.imshow(band, cmap="gray", extent=extent, vmin=0, vmax=255)
    for chain in chains:
        axes.plot(*chain[:, :2].T, color="#b5651d", linewidth=0.5)
    axes.set(xlim=(WINDOW.xmin, WINDOW.xmax), ylim=(WINDOW.ymin, WINDOW.ymax))
    axes.set_xticks([])
    axes.set_yticks([])


def count_flat(tin):
    """Return the number of triangles with one elevation."""
    return int((np.ptp(tin.points[tin.triangles, 2], axis=1) == 0).sum())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
