"""Make the picture of volumes: cut and fill of a pad designed into the sample site.

Run ``python docs/gallery/volumes.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"


def main(folder: Path = HERE) -> None:
    """Write volumes.png."""
    ground, design = (
        ts.triangulate(
            ts.lines_from_codes(ts.read(SAMPLES / name, crs="EPSG:32616", elevation_unit="m"))
        )
        for name in ("site_survey.csv", "design_pad.csv")
    )
    figure = ts.earthwork_map(
        ts.difference(ground, design), ground=ground, title="Cut and fill of the building pad"
    )
    figure.savefig(folder / "volumes.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
