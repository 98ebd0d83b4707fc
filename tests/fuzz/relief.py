"""Classes, statistics, curvature and light of hard surfaces; and features through files.

The oracles: fractions for slopes, shapely for polygons, plain sums for statistics, and what GDAL
reads back.
"""

from __future__ import annotations

import math
import tempfile
import warnings
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from support.point_sets import scattered, whole_number_grid

import tinsmith as ts

from .campaign import Campaign, Case

SUFFIXES = (".gpkg", ".fgb", ".shp", ".geojson")
LEVEL = 1e-12


def generate(rng: np.random.Generator) -> Case:
    """A small grid with many flats, points along a line, or scattered ones, perhaps trimmed."""
    kind = str(rng.choice(["grid", "line", "scatter"]))
    points = {"grid": small_grid, "line": slanted, "scatter": scatter}[kind](rng)
    return {
        "points": points.tolist(),
        "max_edge": [None, 1.5, 20.0][int(rng.integers(3))],
        "breaks": np.unique(rng.choice([1.0, 5.0, 20.0, 45.0, 60.0, 89.0], 4)).tolist(),
        "suffix": str(rng.choice(SUFFIXES)),
    }


def small_grid(rng: np.random.Generator) -> Any:
    return whole_number_grid(rng, *rng.integers(2, 9, 2), int(rng.integers(3)))


def slanted(rng: np.random.Generator) -> Any:
    xy = rng.uniform(0, 1, (int(rng.integers(3, 30)), 1)) * rng.normal(size=2) * 100
    points = np.column_stack([xy, rng.uniform(0, 30, len(xy))])
    return np.vstack([points, [*(rng.normal(size=2) * 100), 3.0]]) + np.array(
        [742_000.1, 4_030_000.3, 0]
    )


def scatter(rng: np.random.Generator) -> Any:
    xy = scattered(rng, int(rng.integers(3, 120)), 60.0)
    return np.column_stack([xy + rng.choice([0.0, 500_000.0]), rng.uniform(0, 9, len(xy))])


def examine(case: Case) -> str:
    """Ask for every measure of the relief, and for files that hold it."""
    try:
        tin = ts.triangulate(case["points"], max_edge=case["max_edge"], crs="EPSG:32616")
    except ts.TinsmithError:
        return "refused: points"
    require_slopes(tin)
    classes = ts.slope_classes(tin, breaks=case["breaks"])
    for made in (classes, ts.aspect_classes(tin)):
        require_partition(tin, made)
    require_statistics(tin)
    require_file(classes, case["suffix"])
    return "classes"


def require_slopes(tin: Any) -> None:
    steepness = ts.slope(tin, unit="ratio")
    for row in range(0, len(steepness), max(1, len(steepness) // 20)):
        a, b, c = ([Fraction(v) for v in tin.points[k].tolist()] for k in tin.triangles[row])
        u, v = ([e - s for s, e in zip(a, other, strict=True)] for other in (b, c))
        up = u[0] * v[1] - u[1] * v[0]
        run = (u[1] * v[2] - u[2] * v[1]) ** 2 + (u[2] * v[0] - u[0] * v[2]) ** 2
        exact = math.sqrt(run / up**2)
        assert abs(steepness[row] - exact) <= 1e-8 * exact + LEVEL, f"slope of triangle {row}"
    assert (ts.slope(tin) <= 90.0).all()


def require_partition(tin: Any, made: Any) -> None:
    shapes = made.to_shapely()
    assert shapely.is_valid(shapes).all(), "a class is not valid"
    areas = shapely.area(shapes)
    total = tin.triangle_areas.sum()
    rounding = 1e-9 * total + LEVEL * tin.bounds.diagonal**2  # of shapely's own sums
    assert np.allclose(areas, made.columns["area"], rtol=1e-9, atol=rounding), "areas"
    assert abs(made.columns["area"].sum() - total) <= 1e-9 * total, "the sum of areas"
    assert made.columns["triangles"].sum() == len(tin.triangles)


def require_statistics(tin: Any) -> None:
    row = ts.slope_statistics(tin)
    steepness, weights = ts.slope(tin), tin.triangle_areas
    assert abs(row["mean"][0] - np.average(steepness, weights=weights)) <= 1e-9
    assert row["minimum"][0] <= row["p5"][0] <= row["p50"][0] <= row["p95"][0] <= row["maximum"][0]


def require_file(made: Any, suffix: str) -> None:
    import geopandas

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = ts.write(made, Path(folder, f"a{suffix}"))
        frame = geopandas.read_file(path)
    assert sorted(frame["class"]) == made.columns["class"].tolist(), "classes in the file"
    frame = frame.sort_values("class").to_crs("EPSG:32616")
    expected = shapely.area(made.to_shapely())
    total = expected.sum()
    slack = 1e-9 * total + LEVEL * made.bounds.diagonal**2
    if suffix == ".geojson":  # nine decimals of a degree
        slack += 1e-3 * made.bounds.diagonal
    assert np.allclose(frame.area, expected, rtol=0, atol=slack), "areas in the file"


CAMPAIGNS = (Campaign("relief", "classes, measures and files of the relief", generate, examine),)
