"""Make the picture of blunders: the sample site with some points spoilt.

Run ``python docs/gallery/blunders.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

DPI = 100


def main(folder: Path = FOLDER) -> None:
    """Write blunders.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    points = survey.points.copy()
    points[1703, 2] *= 10.0
    points[993, 2] = 0.0
    points[1336, 2] *= 0.3048
    points[[47, 1500], 2] += [12.0, 1.2]
    points[[1092, 400], 2] -= [5.0, 1.5]
    points[1711, :2] = points[1711, 1::-1]
    spoilt = replace(survey, points=points)
    tin = ts.triangulate(spoilt)
    figure = ts.blunder_map(
        tin, ts.blunders(tin), title="Points of the site that look like blunders"
    )
    save(draw(figure, DPI), folder / "blunders.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
