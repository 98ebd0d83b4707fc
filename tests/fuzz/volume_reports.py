"""Reports of random surfaces, whose figures are those of the table of volumes."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

CRSS = {"EPSG:32616": (500_000, 4e6), "EPSG:2274": (2e6, 6e5), None: (0.0, 0.0)}
PAPERS = ("A4", "A3", "letter", (190, 190))


def generate(rng: np.random.Generator) -> Case:
    """Two clouds of points that overlap in part, or one and a level."""
    crs = (*CRSS,)[int(rng.integers(len(CRSS)))]
    size = float(10 ** rng.uniform(-1, 4))
    relief = float(rng.choice([0.0, 0.01, 0.3, 5.0])) * size
    surfaces = []
    for _ in range(2):
        xy = size * rng.uniform(0.0, 1.0, (int(rng.integers(3, 40)), 2)) + CRSS[crs]
        z = 300.0 + relief * rng.uniform(0.0, 1.0, len(xy))
        surfaces.append(np.column_stack([xy.round(4), z.round(3)]).tolist())
    return {
        "surfaces": surfaces,
        "crs": crs,
        "base": 300.0 + relief * rng.random() if rng.random() < 0.3 else None,
        "paper": PAPERS[int(rng.integers(len(PAPERS)))],
        "level": None if rng.random() < 0.7 else max(0.1 * relief, 0.01),
    }


def examine(case: Case) -> str:
    """Ask for the volumes of the table, in pages that are numbered."""
    try:
        tins = [
            ts.triangulate(points, crs=case["crs"], elevation_unit="m")
            for points in case["surfaces"][: 1 + (case["base"] is None)]
        ]
    except ts.TinsmithError:
        return "refused: points"
    how: dict[str, Any] = {"base": case["base"], "level_of_detection": case["level"]}
    paper = case["paper"] if isinstance(case["paper"], str) else tuple(case["paper"])
    unit = "m" if case["crs"] is None else None
    try:
        made = ts.volume_report(*tins, **how, paper=paper, ground_unit=unit)
    except ts.PointsError:
        return "refused: no overlap"
    except ts.OptionError as error:
        if error.option != "paper":
            raise
        return "refused: paper"
    table = ts.volume(*tins, **how)
    with tempfile.TemporaryDirectory() as folder:
        (file,) = made.save(Path(folder, "a.pdf"))
        done = subprocess.run(["pdftotext", file, "-"], capture_output=True, text=True, check=True)
    words = done.stdout.split()
    for name in ("cut", "fill", "net", "area"):
        expected = f"{table[name][0]:,.2f}"
        assert expected in words, f"{name} {expected} is not in the report"
    assert f"Page {len(made)} of {len(made)}" in done.stdout, "a page is missing"
    return "a level" if case["base"] is not None else "two surfaces"


CAMPAIGNS = (Campaign("volume reports", "figures of a PDF against the table", generate, examine),)
