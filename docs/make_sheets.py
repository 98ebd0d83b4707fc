"""Make the pictures of docs/profiles.md: cross sections of the pad, a long profile of the road.

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
ROAD = [(752645, 4024255), (752760, 4024275), (752888, 4024270)]
DPI = 90
COLORS = 64


def main(folder: Path = FOLDER) -> None:
    """Write section-sheet.png and long-profile.png."""
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
    save_picture(sheets, folder / "section-sheet.png")
    point = ts.VerticalPoint
    rise = ts.VerticalAlignment(
        [
            point(0, 321),
            point(80, 322.6, "parabola", 20, 20),
            point(170, 323.9, "arc", radius=3000),
            point(244, 324.2),
        ],
        "road",
    )
    road = ts.Alignment.from_points(ROAD, radii=[150], crs="EPSG:32616", verticals=[rise])
    save_picture(
        ts.profile_sheets({"ground": ground}, road, scale=750, title="Road", date="2026-11-27"),
        folder / "long-profile.png",
    )


def save_picture(sheets: ts.SectionSheets | ts.ProfileSheets, path: Path) -> None:
    """Write the first sheet as a picture."""
    with tempfile.TemporaryDirectory() as scratch:
        (file,) = sheets.save(Path(scratch, "sheets.pdf"))
        page = Path(scratch, "page")
        subprocess.run(["pdftoppm", "-r", str(DPI), "-f", "1", "-l", "1", "-singlefile", "-png",
                        file, page], check=True)  # fmt: skip
        picture = Image.open(page.with_suffix(".png")).convert("RGB")
    picture.quantize(COLORS, dither=Image.Dither.NONE).save(path, optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
