"""Make the picture of a hillshade: the mountains of the Jacksboro elevation raster.

Run ``python docs/gallery/hillshade.py [FOLDER]``; needs the extras "raster" and "plot".
"""

import sys
from pathlib import Path

from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts


def main(folder: Path = FOLDER) -> None:
    """Write hillshade.png."""
    tin = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    shade = ts.hillshade(tin, spacing=60.0, exaggeration=1.5, smooth=True)
    figure = ts.relief_map(tin, shade=shade, title="Jacksboro: hillshade, light from north-west")
    save(draw(figure, 80, "L"), folder / "hillshade.png", colors=64)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
