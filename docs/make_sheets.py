"""Make the picture of docs/profiles.md: the pad of the sample site on a sheet of cross sections.

Run ``python docs/make_sheets.py [FOLDER]``; needs the extra "plot" and pdftoppm of Poppler.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

import tinsmith as ts

FOLDER = Path(__file__).parent
SAMPLES = FOLDER.parent / "sample_data"
AXIS = [(752765, 4024303), (752800, 4024300), (752832, 4024294)]
DPI = 90
COLORS = 64


def main(folder: Path = FOLDER) -> None:
    """Write section-sheet.png."""
    ground, design = (
        ts.triangulate(
            ts.lines_from_codes(ts.read(SAMPLES / name, crs="EPSG:32616", elevation_unit="m"))
        )
        for name in ("site_survey.csv", "design_pad.csv")
    )
    sheets = ts.section_sheets(
        {"ground": ground, "design": design},
        AXIS,
        interval=10,
        width=36,
        scale=250,
        orientation="landscape",
        title="Cross sections of the building pad",
        date="2026-11-27",
    )
    with tempfile.TemporaryDirectory() as scratch:
        (file,) = sheets.save(Path(scratch, "pad.pdf"))
        page = Path(scratch, "pad")
        subprocess.run(["pdftoppm", "-r", str(DPI), "-f", "1", "-l", "1", "-singlefile", "-png",
                        file, page], check=True)  # fmt: skip
        picture = Image.open(page.with_suffix(".png")).convert("RGB")
    picture.quantize(COLORS, dither=Image.Dither.NONE).save(
        folder / "section-sheet.png", optimize=True
    )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
