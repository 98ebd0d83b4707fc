"""Make the picture of a hillshade: the mountains of the Jacksboro elevation raster.

Run ``python docs/gallery/hillshade.py [FOLDER]``; needs the extras "raster" and "plot".
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

from PIL import Image

import tinsmith as ts

HERE = Path(__file__).parent
RASTER = HERE.parent.parent / "sample_data" / "jacksboro.tif"
COLORS = 64
DPI = 80


def main(folder: Path = HERE) -> None:
    """Write hillshade.png."""
    tin = ts.triangulate(ts.read(RASTER))
    shade = ts.hillshade(tin, spacing=60.0, exaggeration=1.5, smooth=True)
    figure = ts.relief_map(tin, shade=shade, title="Jacksboro: hillshade, light from north-west")
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=DPI)
    picture = Image.open(png).convert("L")
    picture.quantize(COLORS, dither=Image.Dither.NONE).save(folder / "hillshade.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
