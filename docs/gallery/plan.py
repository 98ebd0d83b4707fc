"""Make the picture of a plan: the sample site at 1:1000 on A3.

Run ``python docs/gallery/plan.py [FOLDER]``; needs the extra "plot".
"""

import sys
import tempfile
from pathlib import Path

from pictures import FOLDER, SAMPLES, save
from PIL import Image

import tinsmith as ts

DPI = 96
COLORS = 128


def main(folder: Path = FOLDER) -> None:
    """Write plan.png."""
    survey = ts.lines_from_codes(
        ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    )
    tin = ts.triangulate(survey, max_edge=20.0)
    made = ts.plan(
        tin, scale=1000, interval=0.5, smooth=0.1, title="Site survey", date="2026-11-22"
    )
    with tempfile.TemporaryDirectory() as scratch:
        (file,) = made.save(Path(scratch, "plan.png"), dpi=DPI)
        save(Image.open(file).convert("RGB"), folder / "plan.png", COLORS)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
