"""Campaign: headers of quantized-mesh tiles: placed as they tell, refused, or told as open.

Centres come from pyproj, on the globe and in web Mercator, right, of another tile, and nowhere.
"""

from __future__ import annotations

import gzip
import struct
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyproj

import tinsmith as ts

from .campaign import Campaign, Case
from .samples import MEMORY

CENTRES = ("globe", "mercator", "none", "globe of another", "mercator of another", "odd")
STEPS = 32_767
HALF_WORLD = 20_037_508.342789244
TO_SPACE = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)


def generate(rng: np.random.Generator) -> Case:
    level = int(rng.integers(6, 16))
    return {
        "level": level,
        "x": int(rng.integers(1, 2**level - 1)),
        "y": int(rng.integers(2 ** (level - 2), 3 * 2 ** (level - 2))),
        "centre": CENTRES[int(rng.integers(len(CENTRES)))],
        "away": int(rng.choice([2, -2, 7])),
        "odd": [float(rng.choice([np.nan, np.inf, 1e300, 1.0, -4e6])) for _ in range(3)],
        "packed": bool(rng.random() < 0.3),
        "declared": bool(rng.random() < 0.2),
        "turned": bool(rng.random() < 0.3),
    }


def find_bounds(case: Case, kind: str, away: int = 0) -> tuple[float, float, float]:
    """Return west, south and width of a tile."""
    count = 2 ** case["level"]
    if kind == "mercator":
        width = 2 * HALF_WORLD / count
        return (case["x"] + away) * width - HALF_WORLD, case["y"] * width - HALF_WORLD, width
    width = 180.0 / count
    return (case["x"] + away) * width - 180.0, case["y"] * width - 90.0, width


def find_centre(case: Case) -> tuple[float, float, float]:
    kind, _, other = case["centre"].partition(" of ")
    if kind == "none":
        return (0.0, 0.0, 0.0)
    if kind == "odd":
        return tuple(case["odd"])
    west, south, width = find_bounds(case, kind, case["away"] if other else 0)
    middle = (west + width / 2, south + width / 2, 50.0)
    return middle if kind == "mercator" else tuple(TO_SPACE.transform(*middle))


def encode(case: Case) -> bytes:
    """Write four corners of a tile and a fifth vertex, by the specification."""
    u, v = [0, STEPS, STEPS, 0, 9000], [0, 0, STEPS, STEPS, 20_000]
    heights = [0, 100, 32_767, 500, 9]
    triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    if case["turned"]:
        triangles = [one[::-1] for one in triangles]

    def zigzag(values: list[int]) -> bytes:
        steps = np.diff([0, *values])
        return ((steps << 1) ^ (steps >> 31)).astype("<u2").tobytes()

    centre = find_centre(case)
    head = struct.pack("<3d2f4d3d", *centre, 10.0, 60.0, *centre, 1e4, *centre)
    body = struct.pack("<I", 5) + zigzag(u) + zigzag(v) + zigzag(heights)
    codes, highest = [], 0
    for number in np.ravel(triangles).tolist():
        codes.append(highest - number)
        highest += codes[-1] == 0
    if min(codes) < 0:  # vertices that come before they are numbered: number them anew
        order = list(dict.fromkeys(np.ravel(triangles).tolist()))
        body = struct.pack("<I", 5) + b"".join(
            zigzag([row[k] for k in order]) for row in (u, v, heights)
        )
        codes, highest = [], 0
        for number in np.ravel(triangles).tolist():
            codes.append(highest - order.index(number))
            highest += codes[-1] == 0
    body += struct.pack(f"<I{len(codes)}H", len(triangles), *codes) + struct.pack("<4I", 0, 0, 0, 0)
    content = head + body
    return gzip.compress(content, mtime=0) if case["packed"] else content


def examine(case: Case) -> str:
    name = f"{case['level']}/{case['x']}/{case['y']}"
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        path = Path(folder, f"{name}.terrain")
        path.parent.mkdir(parents=True)
        path.write_bytes(encode(case))
        options: dict[str, Any] = {"tile": name} if case["declared"] else {}
        try:
            found = ts.read(path, **options)
        except ts.TinsmithError as error:
            return _require_reason(case, str(error))
    return require_place(case, found)


def _require_reason(case: Case, message: str) -> str:
    assert case["centre"] in ("odd", "globe of another", "mercator of another"), message
    return "refused"


def require_place(case: Case, found: ts.TIN) -> str:
    kind = "mercator" if case["centre"] == "mercator" else "globe"
    west, south, width = find_bounds(case, kind)
    expected = [[west, south], [west + width, south + width]]
    bounds = [found.points[:, :2].min(axis=0), found.points[:, :2].max(axis=0)]
    assert np.allclose(bounds, expected, rtol=0, atol=1e-6 * width), (bounds, expected)
    assert str(found.crs) == ("EPSG:3857" if kind == "mercator" else "EPSG:4979")
    assert len(found.triangles) == 4
    told = " ".join(found.notes)
    if case["centre"] == "none":
        assert "does not tell where it lies" in told
    elif case["centre"] != "globe":
        assert "the centre that" in told or "centre that its" in told or _is_open(case, told), told
    assert abs(found.points[:, 2].max() - 60.0) < 1e-3
    return f"placed: {case['centre']}"


def _is_open(case: Case, told: str) -> bool:
    """Whether a centre that is no number is told as none."""
    return case["centre"] == "odd" and "does not tell where it lies" in told


CAMPAIGNS = (
    Campaign(
        "tile headers", "headers of quantized-mesh tiles: where a tile lies", generate, examine
    ),
)
