"""Campaign: headers with several groups of coordinates, of which one is wanted.

Each group (on the map, local, geocentric, in degrees) has values of its own, and other columns say
how good or how high something else is. The points must be those on the map, or the file refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case
from .delimited import choose, read

CRS = "EPSG:32616"
ROWS = 9
MAP = (
    *(("Easting", "Northing", z) for z in ("Elevation", "Height", "Z", "RL", "H", "Elev (m)")),
    *(("E", "N", z) for z in ("Z", "H", "Elev", "Elevation (NAVD88)")),
    *(
        ("East", "North", "Elevation"),
        ("Rechtswert", "Hochwert", "Höhe"),
        ("Este", "Norte", "Cota"),
    ),
    *(("E (UTM16)", "N (UTM16)", "Elev"), ("Grid E", "Grid N", "Elev"), ("X (E)", "Y (N)", "Z")),
)
OTHERS = {
    "geocentric": (
        ("X", "Y", "Z"),
        ("X (ECEF)", "Y (ECEF)", "Z (ECEF)"),
        ("WGS84 X", "WGS84 Y", "h"),
    ),
    "local": (
        *(("x", "y", "z"), ("Local E", "Local N", "Local Z"), ("Station", "Offset", "Z")),
        *(
            ("Easting (local)", "Northing (local)", "Elevation (local)"),
            ("X local", "Y local", "H"),
        ),
    ),
    "degrees": (
        *(("Longitude", "Latitude", "Height"), ("Lon", "Lat", "Alt"), ("Lon", "Lat", "h")),
        ("Long", "Lat", "Ell. height"),
    ),
}
ASIDES = (
    *("Code", "sigma E", "sN", "sigma Z", "HRMS", "Z error", "Height of antenna", "Rod height"),
    *("HI", "PDOP", "Geoid N", "Depth", "Z (sdev)", "Elev diff", "E - 500000", "-Z", "Z (x0.01)"),
)


def generate(rng: np.random.Generator) -> Case:
    count = int(choose(rng, (0, 1, 1, 2)))
    groups = ["map", *rng.permutation(list(OTHERS))[:count].tolist()]
    columns: list[list[Any]] = []
    for group in rng.permutation(groups).tolist():
        names = choose(rng, MAP if group == "map" else OTHERS[group])
        order = [1, 0, 2] if rng.random() < 0.4 else [0, 1, 2]
        if group != "map" and rng.random() < 0.3:
            order = order[:2]
        columns += [[names[k], group, k] for k in order]
        columns += [[str(one), "", 0] for one in rng.permutation(ASIDES)[: int(rng.integers(3))]]
    return {"columns": columns, "is_told": bool(rng.random() < 0.7), "seed": int(rng.integers(1e6))}


def make_groups(seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    steps = rng.random((ROWS, 3)) * (180, 140, 6)
    places = {
        "map": (752_700.0, 4_024_240.0, 320.0),
        "local": (5_000.0, 1_000.0, 98.0),
        "geocentric": (630_000.0, -5_100_000.0, 3_760_000.0),
    }
    made = {name: np.round(steps + place, 3) for name, place in places.items()}
    made["degrees"] = np.round(steps / (1e5, 1e5, 1) + (-84.2, 36.3, 289.0), 6)
    return made


def text_of(case: Case) -> str:
    groups = make_groups(case["seed"])
    lines = [";".join(["Pt", *(name for name, _, _ in case["columns"])])]
    for row in range(ROWS):
        cells = [
            repr(float(groups[group][row, k])) if group else f"0.01{row}"
            for _, group, k in case["columns"]
        ]
        lines.append(";".join([str(row + 1), *cells]))
    return "\n".join(lines) + "\n"


def examine(case: Case) -> str:
    options = {"crs": CRS} if case["is_told"] else {}
    found = read(text_of(case).encode(), ".csv", **options)
    groups = {group for _, group, _ in case["columns"]} - {""}
    if isinstance(found, ts.TinsmithError):
        assert "\n" not in str(found)
        assert groups != {"map"}, f"one group is refused: {found}"
        return "refused"
    expected = make_groups(case["seed"])["map"]
    assert np.array_equal(found.points, expected), f"other points, and notes say {found.notes}"
    return "read"


CAMPAIGNS = (
    Campaign(
        "column groups",
        "headers with several groups of coordinates, of which one is wanted",
        generate,
        examine,
    ),
)
