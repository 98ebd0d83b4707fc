"""Make the picture of a pad in balance: the elevation at which the cut makes the fill.

Run ``python docs/gallery/balance.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"
PAD = np.add([752_740, 4_024_290], [[0, 0], [50, 0], [50, 32], [0, 32]])


def main(folder: Path = HERE) -> None:
    """Write balance.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    ground = ts.triangulate(ts.lines_from_codes(survey))
    found = ts.balance(
        ground, PAD, cut_slope=2, fill_slope=3, gradient=(0.01, 0.01), shrink_factor=0.9
    )
    west, south = PAD.min(axis=0) - 25
    east, north = PAD.max(axis=0) + 25
    around = [[west, south], [east, south], [east, north], [west, north]]
    change = ts.difference(ground, found.tin, regions={"pad": around}, level_of_detection=0.001)
    title = f"Pad in balance at {found.elevation:.2f} m: 0.9 of the cut makes the fill"
    figure = ts.earthwork_map(change, ground=ground, title=title)
    figure.savefig(folder / "balance.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
