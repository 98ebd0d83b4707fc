"""Make the picture of docs/plan.md: strips along a valley in the hills around Jacksboro.

Run ``python docs/make_plan.py [FOLDER]``; needs the extras "plot" and "raster".
"""

import sys
import tempfile
from pathlib import Path

import shapely
from PIL import Image

import tinsmith as ts

FOLDER = Path(__file__).parent
SAMPLES = FOLDER.parent / "sample_data"
WAY = [(739000, 4008000), (744000, 4013000), (746500, 4018500), (751500, 4022500),
       (752500, 4028500), (758500, 4033500)]  # fmt: skip
WIDTH = 1500.0
DPI = 84
COLORS = 64


def main(folder: Path = FOLDER) -> None:
    """Write plan-strips.png: the index sheet, and one of the strips."""
    survey = ts.read(SAMPLES / "jacksboro.tif")
    corridor = shapely.LineString(WAY).buffer(WIDTH / 2, cap_style="flat").simplify(5.0)
    tin = ts.triangulate(survey, boundary=[corridor])
    made = ts.plan(
        tin,
        scale=25_000,
        paper="A4",
        layout="strips",
        interval=20,
        title="A corridor near Jacksboro",
        date="2026-11-22",
    )
    with tempfile.TemporaryDirectory() as scratch:
        files = made.save(Path(scratch, "plan.png"), dpi=DPI)
        pictures = [Image.open(file).convert("RGB") for file in (files[0], files[2])]
        sheet = Image.new("RGB", (sum(one.width for one in pictures) + 12, pictures[0].height))
        sheet.paste("#999999", (0, 0, *sheet.size))
        sheet.paste(pictures[0], (0, 0))
        sheet.paste(pictures[1], (pictures[0].width + 12, 0))
    sheet.quantize(COLORS, dither=Image.Dither.NONE).save(folder / "plan-strips.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
