"""Make the picture of flow paths and depressions: the hills around Jacksboro, on their light.

Run ``python docs/gallery/hydrology.py [FOLDER]``; needs the extra "plot".
"""

import sys
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

SPACING = 15.0


def main(folder: Path = FOLDER) -> None:
    """Write hydrology.png."""
    tin = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    west, east, south, north = extent = choose_extent(tin)
    shade = ts.hillshade(tin, spacing=SPACING)
    box = shade.grid.bounds
    figure, axes = plt.subplots(figsize=(8, 6), layout="constrained")
    light = np.array(shade.bands["hillshade"][:, :])
    bounds = (box.xmin, box.xmax, box.ymin, box.ymax)
    axes.imshow(light, cmap="gray", extent=bounds, vmin=-60, vmax=255)
    waters = ts.depressions(tin, min_depth=0.5)
    for shape in waters.to_shapely():
        for part in shape.geoms:
            axes.fill(*np.array(part.exterior.coords)[:, :2].T, color="#2a6fb5", alpha=0.85, lw=0)
    x, y = np.meshgrid(np.arange(west, east, 180.0), np.arange(south, north, 180.0))
    paths = ts.flow_path(tin, np.column_stack([x.ravel(), y.ravel()]))
    lines = [paths.coordinates[a:b, :2] for a, b in pairwise(paths.offsets[0].tolist())]
    axes.add_collection(LineCollection(lines, colors="#0b4f8a", linewidths=0.7))
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal", xticks=[], yticks=[])
    axes.set_title("Jacksboro: flow paths, and depressions deeper than 0.5 m")
    save(draw(figure, 110), folder / "hydrology.png")


def choose_extent(tin: ts.TIN) -> tuple[float, float, float, float]:
    """Return a part of the surface: west, east, south, north."""
    x, y = tin.bounds.center
    half_width, half_height = 0.18 * tin.bounds.width, 0.18 * tin.bounds.height
    return x - half_width, x + half_width, y - half_height, y + half_height


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
