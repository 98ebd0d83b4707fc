"""Make the picture of a pad in balance around regions held fixed.

Run ``python docs/gallery/fixed.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"
CORNER = np.array([752_740, 4_024_290])
PAD = np.add(CORNER, [[0, 0], [50, 0], [50, 32], [0, 32]])
OAK = np.add(CORNER, [[8, 7], [16, 7], [16, 15], [8, 15]])
HOUSE = np.add(CORNER, [[30, 14], [44, 14], [44, 24], [30, 24]])
LEVEL = 328.5
INK = "#333333"
PLATE = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 1.5}


def main(folder: Path = HERE) -> None:
    """Write fixed.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    ground = ts.triangulate(ts.lines_from_codes(survey))
    slab = np.column_stack([HOUSE, np.full(len(HOUSE), LEVEL)])
    found = ts.balance(
        ground, PAD, cut_slope=2, fill_slope=3, shrink_factor=0.9, fixed={"oak": OAK, "house": slab}
    )
    around = ts.Bounds(*(PAD.min(axis=0) - 25), *(PAD.max(axis=0) + 25))
    corners = [[around.xmin, around.ymin], [around.xmax, around.ymin]]
    corners += [[around.xmax, around.ymax], [around.xmin, around.ymax]]
    change = ts.difference(ground, found.tin, regions={"site": corners}, level_of_detection=0.001)
    title = f"In balance at {found.elevation:.2f} m: the fill is 0.9 of the cut"
    figure = ts.earthwork_map(change, ground=ground, title=title)
    axes = figure.axes[0]
    named = {"pad": PAD, "oak: stays": OAK, f"house: {LEVEL} m": HOUSE}
    for name, ring in named.items():
        closed = np.vstack([ring, ring[:1]])
        axes.plot(*closed.T, color=INK, linewidth=1.2, zorder=8)
        below = [ring[:, 0].mean(), ring[:, 1].min() - 1.5]
        place = {"color": INK, "fontsize": 9, "ha": "center", "va": "top", "zorder": 9}
        axes.text(*below, name, bbox=PLATE, **place)
    figure.savefig(folder / "fixed.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
