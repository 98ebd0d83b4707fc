"""Make the picture of a viewshed: what is seen from above a hill near Jacksboro.

Run ``python docs/gallery/sight.py [FOLDER]``; needs the extra "plot".
"""

import sys
from pathlib import Path

import numpy as np
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

RADIUS = 2500.0
HEIGHT = 10.0


def main(folder: Path = FOLDER) -> None:
    """Write sight.png."""
    whole = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    middle = np.array(whole.bounds.center)
    near = whole.points[np.abs(whole.points[:, :2] - middle).max(axis=1) < RADIUS]
    tin = ts.triangulate(near, crs=whole.crs, z_unit=whole.elevation_unit)
    inner = np.abs(near[:, :2] - middle).max(axis=1) < RADIUS / 2
    eye = near[inner][np.argmax(near[inner, 2]), :2]
    seen = ts.viewshed(tin, eye, eye_height=HEIGHT)
    figure = ts.relief_map(tin, seen, title=f"Seen from {HEIGHT:g} m above a hill")
    figure.axes[0].plot(*eye, "k*", markersize=12)
    save(draw(figure, 110), folder / "sight.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
