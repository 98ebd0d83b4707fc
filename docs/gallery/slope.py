"""Make the picture of slope classes: a survey's site, on its hillshade, with a legend.

Run ``python docs/gallery/slope.py [FOLDER]``; needs the extra "plot".
"""

import sys
from pathlib import Path

from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts


def main(folder: Path = FOLDER) -> None:
    """Write slope.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    tin = ts.triangulate(ts.lines_from_codes(survey), max_edge=20.0)
    figure = ts.relief_map(tin, ts.slope_classes(tin), title="Site survey: classes of slope")
    save(draw(figure, 110), folder / "slope.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
