"""Elevations keep what they mean: through reprojections, files, and a change of all units.

The oracle knows units from pyproj's data base of units and from the axes of pyproj's own CRSs, and
computes slopes by a plane through three points on the ground.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyproj

import tinsmith as ts
from tinsmith import TIN, Survey, Unit

from .campaign import Campaign

# Horizontal CRSs that hold the same places in Tennessee, in many units.
PLANES = (
    *("EPSG:32616", "EPSG:26916", "EPSG:2274", "EPSG:2915", "EPSG:4326", "EPSG:4269"),
    *("+proj=utm +zone=16 +ellps=GRS80 +units=ft", "+proj=utm +zone=16 +ellps=GRS80 +units=km"),
    "+proj=tmerc +lat_0=36 +lon_0=-84 +ellps=GRS80 +units=us-ft",
    "+proj=tmerc +lat_0=36 +lon_0=-84 +ellps=GRS80 +to_meter=0.9144",
)
VERTICALS = ("", "", "", "+5703", "+6360", "+8228")
WORDS = {
    "m": "metre",
    "ft": "foot",
    "foot": "foot",
    "US survey foot": "US survey foot",
    "usft": "US survey foot",
    "yd": "yard",
    "cm": "centimetre",
    "Clarke's foot": "Clarke's foot",
    "km": "kilometre",
}
FILES = (".ply", ".obj", ".geojson")


def pick(rng: np.random.Generator, values: Any) -> Any:
    return values[int(rng.integers(len(values)))]


def any_crs(rng: np.random.Generator) -> str:
    plane = str(pick(rng, PLANES))
    return plane + str(pick(rng, VERTICALS)) if plane.startswith("EPSG") else plane


def generate(rng: np.random.Generator) -> dict[str, Any]:
    corners = rng.uniform(0, 1, (3, 2)) * 0.01 + (-84.3, 36.2)
    heights = rng.uniform(-50, 2000, 3)
    return {
        "places": np.column_stack([corners, heights]).tolist(),
        "source": any_crs(rng),
        "target": any_crs(rng),
        "unit": pick(rng, [None, *WORDS]),
        "file": str(pick(rng, FILES)),
    }


def vertical_metres(crs: pyproj.CRS) -> float | None:
    """Return the metres in the unit of the vertical axis, as pyproj has it."""
    up = [axis for axis in crs.axis_info if axis.direction == "up"]
    return up[0].unit_conversion_factor if up else None


def usual_metres(crs: pyproj.CRS) -> float:
    vertical = vertical_metres(crs)
    if vertical is not None:
        return vertical
    return 1.0 if crs.is_geographic else crs.axis_info[0].unit_conversion_factor


def declared_metres(word: str | None) -> float | None:
    if word is None:
        return None
    return pyproj.get_units_map(category="linear")[WORDS[word]].conv_factor


def examine(case: dict[str, Any]) -> str:
    """Check the source's TIN by every entry point, then what a reprojection makes of it."""
    source, word = pyproj.CRS(case["source"]), case["unit"]
    vertical, declared = vertical_metres(source), declared_metres(word)
    points = ts.io.transform_points(
        np.array(case["places"]), "EPSG:4326", ts.CRS.of(source).horizontal
    )
    points[:, 2] = np.array(case["places"])[:, 2]
    differ = vertical is not None and declared is not None and not near(vertical, declared)
    try:
        survey = Survey(points=points, crs=source, elevation_unit=word)
    except ts.OptionError:
        assert differ, "a unit was refused that does not differ"
        return "refused: two units"
    assert not differ, "two units that differ were taken"
    up = vertical or declared or usual_metres(source)
    try:
        tin = ts.triangulate(survey)
    except ts.PointsError:
        return "refused: no TIN"
    examine_slope(tin, source, up, case["file"])
    examine_move(tin, source, case["target"], up)
    return "geographic" if source.is_geographic else "projected"


def near(one: float, other: float, share: float = 1e-9) -> bool:
    return abs(one - other) <= share * abs(other)


def examine_slope(tin: TIN, source: pyproj.CRS, up: float, suffix: str) -> None:
    expected = slope_on_the_ground(tin.points, source, up)
    found = float(ts.terrain.slope(tin)[0])
    rough = 1e-2 if source.is_geographic else 1e-7
    assert abs(found - expected) <= rough, f"slope {found} for {expected}"
    unit = tin.elevation_unit
    other = Unit.of("cm")
    factor = up / 0.01
    again = TIN.from_triangles(
        tin.points * (1, 1, factor), tin.triangles, crs=flat(source), elevation_unit=other
    )
    assert abs(float(ts.terrain.slope(again)[0]) - found) <= 1e-9, "slope depends on the unit"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"a{suffix}"
        if suffix == ".geojson":
            ts.write(tin, path)
            examine_geojson(path, tin, found, up, source)
            return
        ts.write(tin, path)
        back = ts.read(path)
        assert (back.crs, back.elevation_unit) == (tin.crs, unit), "a file lost CRS or unit"
        assert float(ts.terrain.slope(back)[0]) == found, "a file changed the slope"


def flat(crs: pyproj.CRS) -> ts.CRS:
    return ts.CRS.of(crs).horizontal


def slope_on_the_ground(points: Any, source: pyproj.CRS, up: float) -> float:
    """Fit a plane through three places in metres."""
    xy = points[:, :2]
    if source.is_geographic:
        lon, lat = xy.mean(axis=0)
        local = f"+proj=aeqd +lat_0={lat} +lon_0={lon} +ellps=WGS84"
        move = pyproj.Transformer.from_crs("+proj=longlat +ellps=WGS84", local, always_xy=True)
        xy = np.stack(move.transform(*xy.T), axis=1)
    else:
        xy = (xy - xy[0]) * source.axis_info[0].unit_conversion_factor
    z = (points[:, 2] - points[0, 2]) * up
    gradient = np.linalg.solve(xy[1:] - xy[0], z[1:])
    return float(np.degrees(np.arctan(np.hypot(*gradient))))


def examine_geojson(path: Path, tin: TIN, slope: float, up: float, source: pyproj.CRS) -> None:
    (feature,) = json.loads(path.read_text())["features"]
    assert abs(feature["properties"]["slope"] - slope) <= 1e-4, "GeoJSON has another slope"
    if vertical_metres(source) is None:
        written = sorted(corner[2] for corner in feature["geometry"]["coordinates"][0][:3])
        assert np.allclose(written, np.sort(tin.points[:, 2] * up), rtol=0, atol=2e-6)


def examine_move(tin: TIN, source: pyproj.CRS, target_text: str, up: float) -> None:
    """Elevations in metres are the same after a reprojection, and again on the way back."""
    target = pyproj.CRS(target_text)
    unit = tin.elevation_unit
    moved = ts.io.transform_points(tin.points, source, target, elevation_unit=unit)
    metres = tin.points[:, 2] * up
    after = moved[:, 2] * usual_metres(target)
    assert np.allclose(after, metres, rtol=1e-9, atol=1e-9), f"{after} m for {metres} m"
    back = ts.io.transform_points(moved, target, source)
    again = back[:, 2] * usual_metres(source)
    assert np.allclose(again, metres, rtol=1e-9, atol=1e-9), "elevations do not come back"


CAMPAIGNS = (Campaign("units", "CRSs and units: slopes, files, reprojections", generate, examine),)
