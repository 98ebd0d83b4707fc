"""Campaign: points and lines as other libraries have them, against the TIN of plain arrays."""

from __future__ import annotations

import json
from typing import Any

import geopandas
import numpy as np
import pandas as pd
import shapely
from support.point_sets import points as draw_points
from support.same_tins import find_differences

import tinsmith as ts

from .campaign import Campaign, Case

NAMES = (("x", "y", "z"), ("Easting", "NORTHING", "elev"), ("e", "n", "h"), ("lon", "lat", "alt"))
ROLES = ("breaklines", "boundary", "holes", "erase", "water")
GUISES = ("shapely", "array", "multi", "series", "frame", "interface", "features", "geojson")
CRS = "EPSG:32616"


def generate(rng: np.random.Generator) -> Case:
    rows = draw_points(rng, int(rng.integers(3, 25)))
    return {
        "points": rows,
        "guise": str(rng.choice(["frame", "mapping", "series", "geo frame", "multi", "features"])),
        "names": int(rng.integers(len(NAMES))),
        "order": rng.permutation(3).tolist(),
        "role": str(rng.choice(ROLES)),
        "line guise": str(rng.choice(GUISES)),
        "lines": [
            [rows[i] for i in rng.choice(len(rows), int(rng.integers(3, 6)))]
            for _ in range(int(rng.integers(0, 4)))
        ],
        "is flat": bool(rng.random() < 0.4),
        "has crs": bool(rng.random() < 0.5),
    }


def examine(case: Case) -> str:
    rows = np.array(case["points"], np.float64).reshape(-1, 3)
    crs = CRS if case["has crs"] else None
    lines = [np.array(line, np.float64).reshape(-1, 3) for line in case["lines"]]
    lines = [line[:, :2] if case["is flat"] else line for line in lines if len(line) > 2]
    role = case["role"]
    if role != "breaklines":
        lines = [_close(line) for line in lines]
    if role == "water":
        lines = [np.column_stack([line[:, :2], np.full(len(line), line[0, -1])]) for line in lines]
    shapes = [shapely.LineString(x) if role == "breaklines" else shapely.Polygon(x) for x in lines]
    if role == "water":
        plain: list[Any] = [ts.Water(line[:, :2], line[0, 2]) for line in lines if _is_ring(line)]
        shapes = [one for one, line in zip(shapes, lines, strict=True) if _is_ring(line)]
    else:
        plain = lines
    given = _dress_lines(shapes, case["line guise"], crs) if shapes else ()
    wanted = _build(rows, {role: plain}, crs)
    found = _build(_dress_points(rows, case, crs), {role: given}, None)
    if isinstance(wanted, str) or isinstance(found, str):
        assert isinstance(wanted, str), f"refused in a guise only: {found}"
        assert isinstance(found, str), f"taken in a guise only: {wanted}"
        return "refused"
    carries = case["guise"] in ("series", "geo frame", "features")
    carries |= bool(shapes) and case["line guise"] in ("series", "frame", "features")
    assert found.crs == (crs if carries else None), found.crs
    assert find_differences(_strip(wanted), _strip(found)) == []
    _require_way_back(found)
    return f"built, {role}"


def _require_way_back(tin: ts.TIN) -> None:
    """A mesh of another library comes back with the same bits, whatever was subtracted."""
    for make in (ts.to_meshio, ts.to_trimesh):
        back = ts.from_mesh(make(tin))
        for name in ("points", "triangles"):
            same = getattr(back, name).tobytes() == getattr(tin, name).tobytes()
            assert same, f"{name} differ after {make.__name__}"
        assert back.crs == tin.crs


def _strip(tin: ts.TIN) -> ts.TIN:
    """Leave out what must differ: notes of where the CRS is from."""
    return tin.replace(crs=None, report=ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]]).report)


def _close(line: np.ndarray) -> np.ndarray:
    return np.concatenate([line, line[:1]])


def _is_ring(line: np.ndarray) -> bool:
    return len(np.unique(line[:, :2], axis=0)) >= 3


def _build(points: Any, lines: dict[str, Any], crs: str | None) -> ts.TIN | str:
    try:
        return ts.triangulate(points, **lines, crs=crs)
    except ts.TinsmithError as error:
        return str(error)


def _dress_points(rows: np.ndarray, case: Case, crs: str | None) -> Any:
    names, guise = NAMES[case["names"]], case["guise"]
    columns = {names[k]: rows[:, k] for k in case["order"]}
    shapes = shapely.points(rows)
    if guise == "frame":
        return pd.DataFrame(columns)
    if guise == "mapping":
        return columns
    if guise == "series":
        return geopandas.GeoSeries(shapes, crs=crs)
    if guise == "geo frame":
        flat = shapely.points(rows[:, :2])
        return geopandas.GeoDataFrame({names[2]: rows[:, 2]}, geometry=flat, crs=crs)
    if guise == "multi":
        return shapely.multipoints(shapes)
    return ts.Features.of_points(rows, crs=crs)


def _dress_lines(shapes: list[Any], guise: str, crs: str | None) -> Any:
    is_line = shapes[0].geom_type == "LineString"
    many = (shapely.multilinestrings if is_line else shapely.multipolygons)(shapes)
    guises: dict[str, Any] = {
        "shapely": lambda: shapes,
        "array": lambda: np.array([*shapes, None], object)[:-1],
        "multi": lambda: many,
        "series": lambda: geopandas.GeoSeries(shapes, crs=crs),
        "frame": lambda: geopandas.GeoDataFrame({"n": [1]}, geometry=[many], crs=crs),
        "interface": lambda: geopandas.GeoSeries(shapes).__geo_interface__,
        "features": lambda: _as_features(shapes, crs),
        "geojson": lambda: json.loads(json.dumps(shapely.geometry.mapping(many))),
    }
    return guises[guise]()


def _as_features(shapes: list[Any], crs: str | None) -> ts.Features:
    kind, coordinates, offsets = shapely.to_ragged_array(shapes)
    make = ts.Features.of_lines if "LINE" in kind.name else ts.Features.of_polygons
    return make(coordinates, *offsets, crs=crs)


CAMPAIGNS = (
    Campaign("given", "points and lines of other libraries, against arrays", generate, examine),
)
