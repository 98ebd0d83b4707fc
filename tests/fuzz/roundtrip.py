"""Writers and readers: what comes back is what was written, as exactly as the format promises."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from support.point_sets import coordinates

import tinsmith as ts

from .campaign import Campaign
from .samples import MEMORY

SUFFIXES = ("ply", "obj", "vtp", "vtu", "msh", "stl", "geojson", "csv", "14", "slf")
_NO_FLAGS = ("obj", "msh", "stl", "14", "slf")
_NO_CRS = ("msh", "14", "slf")


def generate(rng: np.random.Generator) -> dict[str, Any]:
    """Choose points, a breakline among them, and a format."""
    n = int(rng.integers(3, 30))
    xy = coordinates(rng, n)
    z = rng.choice(
        [
            np.round(rng.random(len(xy)) * 500, 2),
            rng.normal(size=len(xy)) * 10.0 ** rng.integers(-9, 9),
        ]
    )
    line = xy[rng.choice(len(xy), 2, replace=False)].tolist() if rng.random() < 0.5 else []
    return {
        "points": np.column_stack([xy, z]).tolist(),
        "line": line,
        "crs": [None, "EPSG:32616"][int(rng.integers(2))],
        "suffix": str(rng.choice(SUFFIXES)),
    }


def examine(case: dict[str, Any]) -> str:
    """Write, read, compare."""
    suffix = case["suffix"]
    lines = [ts.Breakline(case["line"])] if len(case["line"]) > 1 else []
    try:
        tin = ts.triangulate(
            ts.Survey(points=np.array(case["points"], float).reshape(-1, 3), crs=case["crs"]),
            breaklines=lines,
        )
    except ts.TinsmithError:
        return "no TIN"
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        path = Path(folder, f"a.{suffix}")
        if suffix == "geojson":
            _require_same_triangles(tin, ts.write(tin, path, projected=True))
        elif suffix == "csv":
            _require_same_points(tin, path)
        elif suffix == "stl":
            return _require_close(tin, path)
        else:
            ts.write(tin, path)
            _require_same(tin, ts.read(path), suffix)
    return suffix


def _require_same(tin: ts.TIN, again: Any, suffix: str) -> None:
    assert isinstance(again, ts.TIN)
    assert again.points.tobytes() == tin.points.tobytes()
    assert np.array_equal(again.triangles, tin.triangles)
    assert np.array_equal(again.neighbors, tin.neighbors)
    assert suffix in _NO_CRS or again.crs == tin.crs
    if suffix not in _NO_FLAGS:
        assert np.array_equal(again.constrained, tin.constrained)
    if suffix == "14":  # its boundaries are lines
        assert np.array_equal(again.constrained, tin.neighbors < 0)
    if suffix == "msh":  # its boundary is written as line elements, too
        assert np.array_equal(again.constrained, tin.constrained | (tin.neighbors < 0))


def _require_same_triangles(tin: ts.TIN, path: Path) -> None:
    features = json.loads(path.read_text())["features"]
    corners = [feature["geometry"]["coordinates"][0] for feature in features]
    assert np.array_equal(np.array(corners)[:, :3], tin.points[tin.triangles])
    assert all(ring[0] == ring[3] for ring in corners)


def _require_same_points(tin: ts.TIN, path: Path) -> None:
    ts.write(ts.Survey(points=tin.points, crs=tin.crs), path)
    again = ts.read(path, columns="XYZ")
    assert again.points.tobytes() == tin.points.tobytes()


def _require_close(tin: ts.TIN, path: Path) -> str:
    """Single precision relative to the origin: half a unit of the 24th bit, and the addition."""
    try:
        again = ts.read(ts.write(tin, path))
    except ts.TinsmithError as error:
        if not _falls_together(tin):
            raise AssertionError(str(error)) from error
        return "stl: too fine for single precision"
    if len(again.triangles) != len(tin.triangles):  # what rounding leaves without area
        assert _falls_together(tin)
        assert any("Left out" in note for note in again.report.notes)
        return "stl: too fine for single precision"
    corners, expected = again.points[again.triangles], tin.points[tin.triangles]
    extent = np.ptp(tin.points, axis=0) + 1.0
    allowed = extent * 2.0**-24 + np.spacing(np.abs(tin.points).max(axis=0))
    as_it_is, turned = (np.abs(corners - expected[:, order]) <= 2 * allowed
                        for order in ([0, 1, 2], [0, 2, 1]))  # fmt: skip
    assert (as_it_is.all(axis=(1, 2)) | turned.all(axis=(1, 2))).all()
    return "stl"


def _falls_together(tin: ts.TIN) -> bool:
    """Whether rounding to single precision can leave a triangle without area, or turn it."""
    origin = np.floor(tin.points.min(axis=0))
    with np.errstate(over="ignore", invalid="ignore"):
        xy = ((tin.points - origin).astype(np.float32).astype(float) + origin)[:, :2]
        a, b, c = (xy[tin.triangles[:, k]] for k in range(3))
        area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        size = np.abs(b - a).max(axis=1) * np.abs(c - a).max(axis=1)
    return bool(not np.isfinite(xy).all() or (area <= 1e-3 * size).any())


CAMPAIGNS = (
    Campaign("roundtrip", "what is written is read again, bit for bit", generate, examine),
)
