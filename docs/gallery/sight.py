"""Make the picture of a viewshed: what is seen from above a hill near Jacksboro.

Run ``python docs/gallery/sight.py [FOLDER]``; needs the extra "plot".
"""

import pathlib
import sys
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.path import Path
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

RADIUS = 2500.0
HEIGHT = 10.0


def main(folder: pathlib.Path = FOLDER) -> None:
    """Write sight.png."""
    whole = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    middle = np.array(whole.bounds.center)
    near = whole.points[np.abs(whole.points[:, :2] - middle).max(axis=1) < RADIUS]
    tin = ts.triangulate(near, crs=whole.crs, elevation_unit=whole.elevation_unit)
    inner = np.abs(near[:, :2] - middle).max(axis=1) < RADIUS / 2
    eye = near[inner][np.argmax(near[inner, 2]), :2]
    seen = ts.viewshed(tin, eye, eye_height=HEIGHT)
    figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
    rows = zip(*(seen.columns[name] for name in ("class", "color", "share")), strict=True)
    for shape, (name, color, share) in zip(seen.to_shapely(), rows, strict=True):
        paths = [Path.make_compound_path(*map(as_path, list_rings(one))) for one in shape.geoms]
        axes.add_collection(PathCollection(paths, facecolors=color))
        axes.plot([], [], "s", color=color, markersize=10, label=f"{name}: {share:.0f} %")
    contours = ts.contours(tin, 20)
    lines = [contours.coordinates[a:b, :2] for a, b in pairwise(contours.offsets[0].tolist())]
    axes.add_collection(LineCollection(lines, colors="#444444", linewidths=0.4))
    axes.plot(*eye, "k*", markersize=12, label="eye")
    axes.set(aspect="equal", xticks=[], yticks=[])
    axes.autoscale_view()
    axes.set_title(f"Seen from {HEIGHT:g} m above a hill; contours every 20 m")
    axes.legend(loc="lower right")
    save(draw(figure, 110), folder / "sight.png")


def list_rings(polygon: Any) -> list[Any]:
    """Return the exterior of a polygon, and its holes."""
    return [polygon.exterior, *polygon.interiors]


def as_path(ring: Any) -> Path:
    """Return a ring as a path of matplotlib."""
    return Path(np.array(ring.coords)[:, :2], closed=True)


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:]))
