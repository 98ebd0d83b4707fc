"""GeoJSON of lines and polygons about the antimeridian: cut, in one box, and joined again."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyproj
import shapely

import tinsmith as ts

from .campaign import Campaign, Case

SYSTEMS = (
    "EPSG:32601",
    "EPSG:32760",
    "EPSG:3832",
    "EPSG:3460",
    "+proj=laea +lat_0=80 +lon_0=180 +ellps=WGS84 +units=m +type=crs",
)


def generate(rng: np.random.Generator) -> Case:
    """Points about a place near the antimeridian, as a surface or as lines."""
    count = int(rng.integers(3, 60))
    return {
        "crs": int(rng.integers(len(SYSTEMS))),
        "latitude": float(rng.choice([-17.0, -0.1, 0.0, 12.0, 63.0])),
        "size": float(10.0 ** rng.uniform(-1, 5.3)),
        "shift": float(rng.choice([0.0, 0.0, rng.uniform(-1, 1)])),
        "xyz": rng.uniform(-1, 1, (count, 3)).round(int(rng.integers(1, 6))).tolist(),
        "kind": str(rng.choice(["triangles", "edges", "hull", "lines", "contours", "bands"])),
    }


def examine(case: Case) -> str:
    """Compare areas and lengths in the plane, before and after."""
    crs = SYSTEMS[case["crs"]]
    latitude = abs(case["latitude"]) if case["crs"] in (0, 4) else -abs(case["latitude"])
    to_plane = pyproj.Transformer.from_crs("OGC:CRS84", crs, always_xy=True).transform
    middle = np.array([*to_plane(180.0, latitude), 0.0])
    middle[0] += case["shift"] * case["size"]
    points = np.array(case["xyz"]) * (case["size"], case["size"], 50.0) + middle
    try:
        made = make(case["kind"], points, crs)
    except ts.TinsmithError as error:
        return f"refused: {str(error)[:25]}"
    plane = made.to_shapely()
    if len(plane) == 0:
        return "nothing"
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        path = Path(folder, "a.geojson")
        document = json.loads(ts.write(made, path).read_text(encoding="utf-8"))
        back = ts.read_lines(path, crs=crs, drape=True)
    texts = [json.dumps(one["geometry"]) for one in document["features"]]
    shapes = np.array([shapely.from_geojson(text) for text in texts], object)
    spans = shapely.bounds(shapely.get_parts(shapes))[:, [0, 2]]
    assert (np.abs(spans) <= 180).all()
    assert (spans[:, 1] - spans[:, 0] <= 180).all(), spans
    require_box(document["bbox"], shapes)
    found = shapely.transform(shapes, to_plane, interleaved=False)
    slack = 1e-3 * (shapely.get_num_coordinates(shapes) + 2)
    measure, width = (
        (shapely.area, 1 + shapely.length(plane))
        if made.kind == "polygons"
        else (shapely.length, 1)
    )
    assert (np.abs(measure(found) - measure(plane)) <= slack * width).all()
    parts = shapely.get_parts(plane)
    rings = shapely.get_rings(parts) if made.kind == "polygons" else parts
    lengths = [shapely.LineString(line.coords).length for line in back]
    np.testing.assert_allclose(np.sort(lengths), np.sort(shapely.length(rings)), atol=slack.max())
    return "cut" if any("Multi" in text for text in texts) and not made.is_multi else "whole"


def make(kind: str, points: np.ndarray, crs: str) -> ts.Features:
    if kind == "lines":
        count = len(points) // 3 * 3
        return ts.Features.of_lines(points[:count], np.arange(0, count + 1, 3), crs=crs)
    tin = ts.triangulate(points, crs=crs)
    if kind in ("contours", "bands"):
        return ts.contours(tin, interval=20) if kind == "contours" else ts.contour_bands(
            tin, interval=20
        )  # fmt: skip
    return ts.to_features(tin, kind)


def require_box(box: list[float], shapes: np.ndarray) -> None:
    """All longitudes lie between west and east, going east, and both are reached."""
    half = len(box) // 2
    west, east = box[0], box[half]
    longitudes = shapely.get_coordinates(shapes)[:, 0]
    width = (east - west) % 360
    away = (longitudes - west) % 360
    assert (np.minimum(away, 360 - away)[away > width + 1e-9] < 1e-9).all(), (box, longitudes)


CAMPAIGNS = (Campaign("antimeridian", "GeoJSON cut at 180 degrees, and joined", generate, examine),)
