"""Make the picture of profiles: the sample site and the pad designed into it.

Run ``python docs/gallery/profile.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"
LINE = [(752770, 4024240), (752835, 4024340)]


def main(folder: Path = HERE) -> None:
    """Write profile.png."""
    ground, design = (
        ts.triangulate(
            ts.lines_from_codes(ts.read(SAMPLES / name, crs="EPSG:32616", elevation_unit="m"))
        )
        for name in ("site_survey.csv", "design_pad.csv")
    )
    table = ts.profile({"existing ground": ground, "design": design}, LINE)
    figure = ts.profile_picture(
        table, title="Profile A-A of the building pad", crs=ground.crs, exaggeration=4
    )
    figure.savefig(folder / "profile.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
