"""Campaign: products of any surface, unit and format, read back by what takes them."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np

import tinsmith as ts
from tinsmith.io.vector.geometries import read_geometries

from .campaign import Campaign, Case
from .samples import MEMORY

LAYERS = (".geojson", ".geojsonl", ".gpkg", ".fgb", ".shp", ".parquet")
DRAWN = (".xml", ".dxf")
UNITS = {"m": 1.0, "ft": 0.3048, "US survey foot": 1200 / 3937}
PRODUCTS = {
    "contours": lambda tin: ts.contours(tin, interval=2.0),
    "bands": lambda tin: ts.contour_bands(tin, interval=2.0),
    "slope": ts.slope_classes,
    "ridges": ts.ridges_and_valleys,
    "pits": ts.pits,
    "catchments": ts.catchments,
    "triangles": ts.to_features,
}
CORNER = np.array([752_640.0, 4_024_180.0, 0.0])


def generate(rng: np.random.Generator) -> Case:
    product = str(rng.choice(list(PRODUCTS)))
    formats = (*LAYERS, *DRAWN) if product == "contours" else LAYERS
    return {
        "points": np.column_stack(
            [rng.uniform(0, 80, (14, 2)), rng.uniform(300, 312, 14)]
        ).round(3).tolist(),
        "product": product,
        "unit": str(rng.choice(list(UNITS))),
        "suffix": str(rng.choice(formats)),
    }  # fmt: skip


def examine(case: Case) -> str:
    points = np.array(case["points"], float).reshape(-1, 3) + CORNER
    try:
        tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit=case["unit"])
        made = PRODUCTS[case["product"]](tin)
    except ts.TinsmithError:
        return "no product"
    if len(made) == 0:
        return "empty"
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        path = ts.write(made, Path(folder, f"a{case['suffix']}"))
        if case["product"] == "contours":
            require_levels(made, path, case)
        if case["suffix"] not in DRAWN:
            require_features(made, path)
    return case["suffix"]


def require_levels(made: ts.Features, path: Path, case: Case) -> None:
    """Read contours as breaklines of points in metres: each lies at its level."""
    declared = {"elevation_unit": case["unit"]} if case["suffix"] == ".shp" else {}
    corners = np.array([[0, 0, 305], [80, 0, 305], [0, 80, 305], [80, 80, 305.0]]) + CORNER
    points = ts.Survey(points=corners, crs="EPSG:32616", elevation_unit="m")
    lines = ts.io.with_lines(points, breaklines=[path], **declared).breaklines
    levels = np.sort(made.columns["elevation"] * UNITS[case["unit"]])
    found = np.sort([line.coords[0, 2] for line in lines])
    assert len(found) == len(levels), (len(found), len(levels))
    assert np.abs(found - levels).max() < 2e-3, (found, levels)
    assert all(np.ptp(line.coords[:, 2]) < 2e-3 for line in lines)


def require_features(made: ts.Features, path: Path) -> None:
    """Require the features, their columns and places."""
    found = read_geometries(path, crs="EPSG:32616")
    assert len(found) == len(made)
    assert found.kind == made.kind
    for name, column in made.columns.items():
        again = found.columns.get(name.lower(), found.columns.get(name.lower()[:10]))
        assert again is not None, (name, list(found.columns))
        if column.dtype.kind == "f":  # FlatGeobuf has an order of its own
            again, wanted = np.sort(again.astype(float)), np.sort(column)
            assert np.allclose(again, wanted, rtol=1e-6, atol=1e-6, equal_nan=True), name
        elif column.dtype.kind in "iu":
            assert sorted(int(one) for one in again) == sorted(column.tolist()), name
        elif column.dtype.kind == "b":
            assert sum(bool(one) for one in again) == int(column.sum()), name
        else:
            assert sorted(map(str, again)) == sorted(map(str, column)), name
    low, high = (np.sort([f(made.coordinates[:, k]) for k in (0, 1)]) for f in (np.min, np.max))
    assert np.allclose(np.sort(found.coordinates[:, :2].min(axis=0)), low, atol=2e-3)
    assert np.allclose(np.sort(found.coordinates[:, :2].max(axis=0)), high, atol=2e-3)


CAMPAIGNS = (
    Campaign(
        "read-back",
        "products of any unit in every format, read back by commands",
        generate,
        examine,
    ),
)
