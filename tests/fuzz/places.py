"""Sites under a CRS that is right, exchanged, in degrees, or another: what is read lies there.

The oracle is pyproj: a site is chosen in degrees, and written in the coordinates that pyproj gives.
What is read lies within a metre of it, or the file is refused.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyproj

import tinsmith as ts

from .campaign import Campaign

ZONES = {"EPSG:32616": (-87.0, 36.0), "EPSG:32733": (15.0, -20.0), "EPSG:25833": (15.0, 52.0)}
FAULTS = ("none", "exchanged", "degrees", "exchanged degrees")
FILES = (".csv", ".obj", ".off", ".asc")
METRE = 1.5


def generate(rng: np.random.Generator) -> dict[str, Any]:
    zone = sorted(ZONES)[int(rng.integers(len(ZONES)))]
    return {
        "crs": zone,
        "middle": (np.array(ZONES[zone]) + rng.uniform(-1.0, 1.0, 2)).tolist(),
        "fault": FAULTS[int(rng.integers(len(FAULTS)))],
        "suffix": FILES[int(rng.integers(len(FILES)))],
        "seed": int(rng.integers(2**31)),
    }


def make_points(case: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return the points in metres, and as the file has them."""
    rng = np.random.default_rng(case["seed"])
    to_degrees = pyproj.Transformer.from_crs(case["crs"], "EPSG:4326", always_xy=True)
    middle = to_degrees.transform(*case["middle"], direction="INVERSE")
    xy = np.array(middle) + 20.0 * np.array([[i, j] for j in range(3) for i in range(3)])
    points = np.column_stack([xy, 100.0 + rng.random(9)])
    given = points.copy()
    if "degrees" in case["fault"]:
        given[:, :2] = np.column_stack(to_degrees.transform(*xy.T))
    if "exchanged" in case["fault"]:
        given = given[:, [1, 0, 2]]
    return points, given


def write(given: np.ndarray, path: Path) -> None:
    rows = [" ".join(map(repr, row)) for row in given.tolist()]
    if path.suffix == ".csv":
        lines = ["easting,northing,z", *(row.replace(" ", ",") for row in rows)]
    elif path.suffix == ".obj":
        lines = [f"v {row}" for row in rows] + ["f 1 2 5", "f 1 5 4"]
    elif path.suffix == ".off":
        lines = ["OFF", "9 2 0", *rows, "3 0 1 4", "3 0 4 3"]
    else:
        low, cell = given[:, :2].min(axis=0), float(np.ptp(given[:, 0]) / 2)
        names = ("xllcenter", "yllcenter", "cellsize")
        values = (*low.tolist(), cell)
        head = [f"{name} {value!r}" for name, value in zip(names, values, strict=True)]
        lines = ["ncols 3", "nrows 3", *head, "100 101 102", "100 101 102", "100 101 102"]
    path.write_text("\n".join(lines) + "\n")


def examine(case: dict[str, Any]) -> str:
    points, given = make_points(case)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"a{case['suffix']}")
        write(given, path)
        try:
            found = ts.read(path, crs=case["crs"])
        except ts.TinsmithError:
            if case["fault"] == "none":
                raise
            return "refused"
    low, high = points[:, :2].min(axis=0) - METRE, points[:, :2].max(axis=0) + METRE
    reach = 60.0 if path.suffix == ".asc" else 0.0  # cells are square in degrees, not in metres
    inside = ((found.points[:, :2] > low - reach) & (found.points[:, :2] < high + reach)).all()
    notes = found.notes if isinstance(found, ts.Survey) else found.report.notes
    assert inside, f"{case['fault']}: {notes}"
    return "right"


CAMPAIGNS = (
    Campaign("places", "right, exchanged and other coordinates under a CRS", generate, examine),
)
