"""Make the picture of contours: a survey's lines with labels on its hillshade, and its bands.

Run ``python docs/gallery/contours.py [FOLDER]``; needs the extra "plot".
"""

import sys
from pathlib import Path

from pictures import FOLDER, SAMPLES, draw, save
from PIL import Image

import tinsmith as ts

DPI = 100


def main(folder: Path = FOLDER) -> None:
    """Write contours.png."""
    survey = ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    tin = ts.triangulate(ts.lines_from_codes(survey), max_edge=20.0)
    lines = ts.contours(tin, interval=0.5, smooth=0.1)
    labels = ts.contour_labels(lines, spacing=70)
    bands = ts.contour_bands(tin, interval=1)
    shaded = ts.contour_map(tin, lines, labels=labels, title="Site contours")
    tinted = ts.contour_map(tin, bands=bands, title="Bands of elevation")
    pictures = [draw(figure, DPI) for figure in (shaded, tinted)]
    height = max(picture.height for picture in pictures)
    sheet = Image.new("RGB", (sum(one.width for one in pictures), height), "white")
    west = 0
    for picture in pictures:
        sheet.paste(picture, (west, 0))
        west += picture.width
    save(sheet, folder / "contours.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
