"""Draw docs/terrain-tiles.png: terrain tiles as they are stored, and what they mean.

python docs/make_terrain_tiles.py
"""

from __future__ import annotations

import sqlite3
import warnings
from contextlib import closing
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib as mpl
import numpy as np
from PIL import Image

import tinsmith as ts

mpl.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
SIDE = 512


def read_finest(path):
    """Return the picture of the finest tiles, and where they meet."""
    with closing(sqlite3.connect(path)) as base:
        rows = base.execute(
            "SELECT tile_column, -tile_row, tile_data FROM tiles "
            "WHERE zoom_level = (SELECT max(zoom_level) FROM tiles)"
        ).fetchall()
    columns, lines = sorted({row[0] for row in rows}), sorted({row[1] for row in rows})
    picture = np.zeros((SIDE * len(lines), SIDE * len(columns), 4), np.uint8)
    for column, line, content in rows:
        top, left = (line - lines[0]) * SIDE, (column - columns[0]) * SIDE
        tile = np.asarray(Image.open(BytesIO(content)).convert("RGBA"))
        picture[top : top + SIDE, left : left + SIDE] = tile
    return picture


with TemporaryDirectory() as folder, warnings.catch_warnings():
    warnings.simplefilter("ignore")
    survey = ts.read(HERE.parent / "sample_data" / "site_survey.csv", crs="EPSG:32616")
    raster = ts.rasterize(ts.triangulate(survey), spacing=0.5)
    picture = read_finest(ts.write(raster, Path(folder, "a.mbtiles"), gaps="transparent"))

red, green, blue, alpha = np.moveaxis(picture.astype(float), 2, 0)
elevations = np.where(alpha > 0, red * 256 + green + blue / 256 - 32_768, np.nan)
rows, columns = (np.flatnonzero((alpha > 0).any(axis=axis)) for axis in (1, 0))
figure, axes = plt.subplots(1, 2, figsize=(10, 3.9), constrained_layout=True)
axes[0].imshow(picture)
axes[0].set_title("As stored: red, green, blue (lines: borders of tiles)")
drawn = axes[1].imshow(elevations, cmap="terrain")
axes[1].set_title("As decoded")
figure.colorbar(drawn, ax=axes[1], label="elevation (m)", shrink=0.75)
for one in axes:
    for at in range(0, picture.shape[1] + 1, SIDE):
        one.axvline(at - 0.5, color="0.4", linewidth=0.8)
    for at in range(0, picture.shape[0] + 1, SIDE):
        one.axhline(at - 0.5, color="0.4", linewidth=0.8)
    one.set_xlim(columns[0] - 40, columns[-1] + 40)
    one.set_ylim(rows[-1] + 40, rows[0] - 40)
    one.set_xticks([])
    one.set_yticks([])
figure.savefig(HERE / "terrain-tiles.png", dpi=90)
