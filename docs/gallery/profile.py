"""Draw the profile of docs/profiles.md: the sample site and a pad levelled on it.

Run from the root of the repository: python docs/gallery/profile.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import tinsmith as ts

ROOT = Path(__file__).resolve().parents[2]
LEVEL = 323.6
"""Of the pad, metres."""

PAD = (752745.0, 752805.0, 4024240.0, 4024290.0)
"""West, east, south and north edge of the pad."""

SLOPE = 1 / 2
"""Of the banks around it: one metre of elevation in two metres."""


def make_pad(site: ts.TIN) -> ts.TIN:
    """Return the site with a pad: level inside its edges, with banks as far as the ground."""
    eastings, northings = np.arange(752715, 752836.0), np.arange(4024210, 4024321.0)
    x, y = (axis.ravel() for axis in np.meshgrid(eastings, northings))
    west, east, south, north = PAD
    beyond_x = np.maximum(np.maximum(west - x, x - east), 0)
    beyond_y = np.maximum(np.maximum(south - y, y - north), 0)
    bank = SLOPE * np.hypot(beyond_x, beyond_y)
    ground = site.interpolate(np.column_stack([x, y]))
    design = np.clip(ground, LEVEL - bank, LEVEL + bank)
    return ts.triangulate(np.column_stack([x, y, design]), crs=site.crs, z_unit="m")


def main() -> None:
    """Write the picture beside this script."""
    survey = ts.read(ROOT / "sample_data" / "site_survey.csv", crs="EPSG:32616", z_unit="m")
    site = ts.triangulate(ts.lines_from_codes(survey))
    line = [(752690, 4024225), (752780, 4024265), (752850, 4024330)]
    table = ts.profile({"existing ground": site, "design": make_pad(site)}, line)
    figure = ts.profile_picture(table, title="Site survey: profile A-A", crs=site.crs)
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
