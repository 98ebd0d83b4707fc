"""Make the picture of slope classes: a survey's site, on its hillshade, with a legend.

Run ``python docs/gallery/slope.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

from PIL import Image

import tinsmith as ts

HERE = Path(__file__).parent
SURVEY = HERE.parent.parent / "sample_data" / "site_survey.csv"
COLORS = 224
DPI = 110


def main(folder: Path = HERE) -> None:
    """Write slope.png."""
    survey = ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616", z_unit="m"))
    tin = ts.triangulate(survey, max_edge=20.0)
    figure = ts.relief_map(tin, ts.slope_classes(tin), title="Site survey: classes of slope")
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=DPI)
    picture = Image.open(png).convert("RGB")
    picture.quantize(COLORS, dither=Image.Dither.NONE).save(folder / "slope.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
