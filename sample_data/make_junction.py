"""Make codes/junction.csv: shots of an invented road junction, with curves in their field codes.

Run ``python sample_data/make_junction.py [FOLDER]``; the file is the same every time.
"""

from __future__ import annotations

import csv
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
CORNER = (752_100.0, 4_024_400.0)
"""South-west corner of the site, EPSG:32616."""

RADIUS = 12.0
"""Of the kerbs at the junction, metres."""

Place = tuple[float, float]
Row = tuple[float, float, float, str]


def ground(x: float, y: float) -> float:
    """Return the height of the natural ground."""
    return 318.0 + 0.022 * x + 0.035 * y + 0.4 * math.sin(x / 17.0) * math.cos(y / 13.0)


def pavement(x: float, y: float) -> float:
    """Return the height of the road: it falls to the east, and 2.5 % from its crowns."""
    return 319.2 - 0.006 * x - 0.025 * min(abs(y - 24.0), abs(x - 56.0) + max(0.0, 30.0 - y))


def main(folder: Path = HERE / "codes") -> None:
    """Write the survey."""
    rng = np.random.default_rng(14)
    rows = [*control(), *roads(), *pond(), *buildings(), *fill(rng)]
    with (folder / "junction.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["Point", "Northing", "Easting", "Elevation", "Description"])
        for number, (x, y, z, code) in enumerate(rows, start=1):
            north, east = CORNER[1] + y, CORNER[0] + x
            writer.writerow([number, f"{north:.3f}", f"{east:.3f}", f"{z:.3f}", code])


def shoot(places: list[Place], codes: list[str], height: object = pavement) -> list[Row]:
    """Return shots on a surface."""
    return [(x, y, height(x, y), code) for (x, y), code in zip(places, codes, strict=True)]  # type: ignore[operator]


def control() -> list[Row]:
    """Return points that are not on the ground."""
    return [
        (4.0, 8.0, ground(4.0, 8.0) + 1.62, "CP1 TRIPOD, MARK 1.62 BELOW"),
        (96.0, 62.0, ground(96.0, 62.0) + 0.85, "BM1 BOLT IN WALL"),
    ]


def roads() -> list[Row]:
    """Return edges and crowns: kerbs turn into the side street by arcs tangent to both legs."""
    west, east = 56.0 - 6.0, 56.0 + 6.0
    first = shoot(
        [(0, 30), (20, 30), (west - RADIUS, 30), (west, 30 + RADIUS), (west, 56), (west, 72)],
        ["EP1 B", "EP1 WALL1 B", "EP1 PC WALL1 E", "EP1 PT", "EP1", "EP1 E"],
    )
    second = shoot(
        [(east, 72), (east, 56), (east, 30 + RADIUS), (east + RADIUS, 30), (90, 30), (112, 30)],
        ["EP2 B", "EP2", "EP2 PC", "EP2 PT", "EP2", "EP2 E"],
    )
    third = shoot([(112, 18), (75, 18), (37, 18), (0, 18)], ["EP3 B", "EP3", "EP3", "EP3 E"])
    crown = shoot([(0, 24), (56, 24), (112, 24)], ["CL1 B", "CL1", "CL1 E"])
    side = shoot([(56, 32), (56, 50), (56, 72)], ["CL 2 B", "CL 2", "CL 2 E"])
    return [*first, *second, *third, *crown, *side]


def pond() -> list[Row]:
    """Return the edge of a pond: a curve through its shots, closed."""
    turns = np.radians([200, 250, 300, 350, 40, 90, 140])
    places = [(91 + 13 * math.cos(a), 51 + 8 * math.sin(a)) for a in turns.tolist()]
    codes = ["WE1 B BC", *["WE1"] * 5, "WE1 EC CLS"]
    return [
        (x, y, 319.0 + 0.01 * (k % 3), code)
        for k, ((x, y), code) in enumerate(zip(places, codes, strict=True))
    ]


def buildings() -> list[Row]:
    """Return two buildings: one by three corners, one by all of its five."""
    corners = [(12.0, 44.0), (30.0, 48.0), (27.6, 58.8)]
    shed = [(76.0, 4.0), (86.0, 4.0), (86.0, 12.0), (81.0, 12.0), (76.0, 9.0)]
    return [
        *shoot(corners, ["BLDG1 B", "BLDG1", "BLDG1 RECT"], ground),
        *shoot(shed, ["BLDG2 B", *["BLDG2"] * 3, "BLDG2 CLS"], ground),
    ]


def fill(rng: np.random.Generator) -> list[Row]:
    """Return a path, trees, and ground shots off the road."""
    path = [(6.0, 34.0), (12.0, 38.0), (20.0, 40.0), (30.0, 38.0), (44.0, 44.0)]
    codes = ["PATH1 B BC", "PATH1", "PATH1", "PATH1", "PATH1 EC E"]
    rows = shoot(path, codes, ground)
    for k in range(8):
        for j in range(6):
            x, y = 6 + k * 14 + rng.uniform(-3, 3), 4 + j * 13 + rng.uniform(-3, 3)
            if 15 < y < 33 or (44 < x < 68 and y > 30):
                continue
            is_tree = rng.random() < 0.12
            height = ground(x, y) + (1.3 if is_tree else rng.normal(0, 0.01))
            rows.append((float(x), float(y), height, "TR OAK" if is_tree else "GS"))
    return rows


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
