"""Campaign: planes in CRSs whose coordinates grow to any side, through files: which way they face.

The oracle asks pyproj where longitude and latitude grow along the two coordinates, and puts the
same plane, turned to east and north, under a CRS of UTM.
"""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pyproj

import tinsmith as ts

from .campaign import Campaign, Case
from .samples import MEMORY

SITES = {
    "EPSG:2048": (19.0, -33.0),  # westing, southing
    "EPSG:29371": (11.0, -22.0),
    "EPSG:5513": (15.5, 49.8),  # southing, westing
    "EPSG:2065": (15.5, 49.8),
    "EPSG:5514": (15.5, 49.8),  # easting, northing, both negative
    "EPSG:2180": (19.0, 52.0),  # northing, easting
    "EPSG:3844": (25.0, 46.0),
    "EPSG:6677": (139.8, 36.0),
    "EPSG:32616": (-87.0, 36.0),
    "EPSG:2193": (173.0, -41.0),
}
PLAIN = "EPSG:32616"
SUFFIXES = (".ply", ".obj", ".gpkg", ".fgb", ".parquet", ".csv", ".tif", "")
DIRECTIONS = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])


def generate(rng: np.random.Generator) -> Case:
    return {
        "crs": str(rng.choice(list(SITES))),
        "suffix": str(rng.choice(SUFFIXES)),
        "slope": rng.uniform(-0.6, 0.6, 2).round(3).tolist(),  # of easting and northing
        "seed": int(rng.integers(1 << 30)),
    }


@cache
def find_origin(crs: str) -> tuple[float, float]:
    """Return round coordinates of a site."""
    mover = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True)
    x, y = mover.transform(*SITES[crs])
    return round(x, -2), round(y, -2)


@cache
def find_directions(crs: str) -> np.ndarray:
    """Return the side, east and north, to which each coordinate grows, (2, 2)."""
    mover = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True)
    origin = np.array(find_origin(crs))
    lon, lat = mover.transform(*origin)
    found = []
    for step in np.eye(2) * 1000:
        east, north = np.array(mover.transform(*(origin + step))) - (lon, lat)
        way = np.array([east * np.cos(np.radians(lat)), north])
        found.append(DIRECTIONS[int(np.argmax(DIRECTIONS @ way))])
    return np.array(found)


def make(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a plane in the CRS, and the same to the east and north."""
    rng = np.random.default_rng(case["seed"])
    away = rng.uniform(-50, 50, (12, 2)).round(3)
    turned = away @ find_directions(case["crs"])
    z = 500 + turned @ np.array(case["slope"])
    return (
        np.column_stack([away + find_origin(case["crs"]), z]),
        np.column_stack([np.add(turned, [700_000, 4_000_000]), z]),
    )


def carry(tin: ts.TIN, case: Case) -> ts.TIN:
    """Return a TIN as it comes back from a file."""
    suffix = case["suffix"]
    if not suffix:
        return tin
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        path = Path(folder, f"a{suffix}")
        if suffix == ".tif":
            ts.write(ts.rasterize(tin, spacing=4.0), path)
        elif suffix in (".ply", ".obj"):
            ts.write(tin, path)
        else:
            ts.write(ts.Survey(points=tin.points, crs=tin.crs, elevation_unit="m"), path)
        named = {"crs": case["crs"]} if suffix == ".csv" else {}
        found = ts.read(path, **named)
    return found if isinstance(found, ts.TIN) else ts.triangulate(found)


def examine(case: Case) -> str:
    points, plain = make(case)
    tin = carry(ts.triangulate(points, crs=case["crs"], elevation_unit="m"), case)
    other = ts.triangulate(plain, crs=PLAIN, elevation_unit="m")
    east, north = case["slope"]
    facing = float(np.degrees(np.arctan2(-east, -north)) % 360)
    if np.hypot(east, north) > 0.05:
        away = (ts.aspect(tin) - facing + 180) % 360 - 180
        assert np.abs(away).max() < 0.2, f"aspect {ts.aspect(tin)[:3]} for {facing}"
    steep = float(np.degrees(np.arctan(np.hypot(east, north))))
    assert np.abs(ts.slope(tin) - steep).max() < 0.1
    lit, expected = (shade(one) for one in (tin, other))
    assert abs(lit - expected) <= 1.5, (lit, expected)
    return case["suffix"] or "built"


def shade(tin: ts.TIN) -> float:
    """Return the light of a plane, which is one number."""
    (values,) = ts.hillshade(tin, spacing=10.0).bands.values()
    cells = np.asarray(values)
    return float(np.median(cells[cells > 0]))  # 0 is no light, and outside


CAMPAIGNS = (
    Campaign(
        "axes",
        "planes in CRSs that grow to any side, through files: slope, aspect, hillshade",
        generate,
        examine,
    ),
)
