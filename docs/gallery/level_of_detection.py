"""Make the picture of a level of detection: a yard surveyed twice, beyond the noise of both.

Run ``python docs/gallery/level_of_detection.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import tinsmith as ts

HERE = Path(__file__).parent
NOISE = 0.03


def survey(seed: int, *heaps: tuple[float, float, float]) -> ts.TIN:
    """Return a sloping yard of 120 m by 80 m with conical heaps (east, north, height)."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, 120, 4000), rng.uniform(0, 80, 4000)
    z = 318 + 0.01 * x + NOISE * rng.standard_normal(len(x))
    for east, north, height in heaps:
        z += np.maximum(height - np.hypot(x - east, y - north) / 1.5, 0.0)
    points = np.column_stack([752_700 + x, 4_024_200 + y, z])
    return ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")


def main(folder: Path = HERE) -> None:
    """Write level_of_detection.png."""
    before = survey(1, (30, 30, 7), (85, 50, 9))
    after = survey(2, (30, 30, 4), (85, 50, 9), (65, 25, 6))
    change = ts.difference(
        before, after, standard_error=NOISE, other_standard_error=NOISE, confidence=0.99
    )
    figure = ts.earthwork_map(change, ground=after, title="What changed in a stockpile yard")
    figure.savefig(folder / "level_of_detection.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
