"""Make the picture of cross sections: the site and the pad designed into it, square to an axis.

Run ``python docs/gallery/cross_sections.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"
AXIS = [(752765, 4024303), (752800, 4024300), (752832, 4024294)]


def main(folder: Path = HERE) -> None:
    """Write cross_sections.png."""
    ground, design = (
        ts.triangulate(
            ts.lines_from_codes(ts.read(SAMPLES / name, crs="EPSG:32616", elevation_unit="m"))
        )
        for name in ("site_survey.csv", "design_pad.csv")
    )
    surfaces = {"existing ground": ground, "design": design}
    table = ts.cross_sections(surfaces, AXIS, interval=10, width=60)
    figure = ts.section_picture(
        table, title="Cross sections of the building pad", crs=ground.crs, exaggeration=3
    )
    figure.savefig(folder / "cross_sections.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
