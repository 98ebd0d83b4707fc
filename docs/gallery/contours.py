"""Make the picture of contours: a survey's lines with labels on its hillshade, and its bands.

Run ``python docs/gallery/contours.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import Any

from PIL import Image

import tinsmith as ts

HERE = Path(__file__).parent
SURVEY = HERE.parent.parent / "sample_data" / "site_survey.csv"
COLORS = 224
DPI = 100


def main(folder: Path = HERE) -> None:
    """Write contours.png."""
    survey = ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616", z_unit="m"))
    tin = ts.triangulate(survey, max_edge=20.0)
    lines = ts.contours(tin, interval=0.5, smooth=0.1)
    labels = ts.contour_labels(lines, spacing=70)
    bands = ts.contour_bands(tin, interval=1)
    shaded = ts.contour_map(tin, lines, labels=labels, title="Site contours")
    tinted = ts.contour_map(tin, bands=bands, title="Bands of elevation")
    pictures = [drawn(figure) for figure in (shaded, tinted)]
    height = max(picture.height for picture in pictures)
    sheet = Image.new("RGB", (sum(one.width for one in pictures), height), "white")
    west = 0
    for picture in pictures:
        sheet.paste(picture, (west, 0))
        west += picture.width
    sheet.quantize(COLORS, dither=Image.Dither.NONE).save(folder / "contours.png", optimize=True)


def drawn(figure: Any) -> Image.Image:
    """Return a figure as an image."""
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=DPI)
    return Image.open(png).convert("RGB")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
