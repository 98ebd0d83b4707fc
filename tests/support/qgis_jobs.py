"""Jobs for the QGIS plugin: the layers of a project, and what is asked of the answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import tinsmith as ts

from .qgis_plugin import ROOT

__all__ = [
    "CUT",
    "DEM",
    "KERB",
    "RING",
    "SURVEY",
    "UTM",
    "assert_same_tin",
    "job",
    "make_inputs",
    "make_layer",
    "read_layer",
    "read_survey",
    "require_done",
    "take_layer",
    "write_wkt",
]

UTM = "EPSG:32616"
SURVEY = ROOT / "sample_data" / "site_survey.csv"
DEM = ROOT / "sample_data" / "jacksboro.tif"
KERB = [[752700.0, 4024240.0, 322.0], [752740.0, 4024250.0, 323.5]]
RING = [[752660, 4024210], [752860, 4024210], [752860, 4024310], [752660, 4024310]]
CUT = [[752690.0, 4024225.0], [752850.0, 4024330.0]]


def read_survey():
    """Return the points of the sample."""
    return ts.read(SURVEY, crs=UTM)


def write_wkt(kind, rows):
    """Return a geometry as WKT."""
    vertices = ", ".join(" ".join(map(repr, map(float, row))) for row in rows)
    return f"{kind}({'(' * (kind == 'Polygon')}{vertices}{')' * (kind == 'Polygon')})"


def make_layer(kind, rows, *, columns=(), crs=UTM, **more):
    """Return a layer in memory: each row has its geometry and its attributes."""
    return {"kind": kind, "crs": crs, "columns": list(columns), "features": rows, **more}


def make_inputs(folder, survey):
    """Write a survey and its TIN; return the layers of a project."""
    ts.write(survey, folder / "points.gpkg")
    tin = ts.triangulate(survey)
    ts.write(tin, folder / "ground.ply")
    ts.write(tin, folder / "ground.2dm")
    flat = [
        [write_wkt("Point", [row[:2]]), [row[2] + 1.0, k]] for k, row in enumerate(survey.points)
    ]
    closed = [*RING, RING[0]]
    return tin, {
        "points": {"kind": "vector", "path": str(folder / "points.gpkg")},
        "ground": {"kind": "mesh", "path": str(folder / "ground.ply")},
        "no crs": {"kind": "mesh", "path": str(folder / "ground.2dm"), "crs": UTM},
        "dem": {"kind": "raster", "path": str(DEM)},
        "flat": make_layer(
            "Point", flat, columns=["high:double", "fid:integer"], selected=list(range(1, 301))
        ),
        "kerb": make_layer(
            "LineStringZ", [[write_wkt("LineString Z", KERB), ["k1"]]], columns=["name:string"]
        ),
        "site": make_layer("Polygon", [[write_wkt("Polygon", closed), []]]),
        "cut": make_layer("LineString", [[write_wkt("LineString", CUT), []]]),
    }


def require_done(told):
    """Require that every job has made what it was asked for."""
    for name, one in told.items():
        if name != "provider":
            assert one["error"] is None, (name, one["error"], one["log"])
            assert "not correctly generated" not in str(one["log"]), (name, one["log"])


def take_layer(answer, name):
    """Return what is told of the layer with this name, or with it and a unit."""
    (found,) = [
        layer for told, layer in answer["layers"].items() if told.partition(" (")[0] == name
    ]
    return found


def job(name, *, load=True, **parameters):
    """Return an algorithm with its parameters."""
    plain = {key: str(one) if isinstance(one, Path) else one for key, one in parameters.items()}
    return {"algorithm": f"tinsmith:{name}", "parameters": plain, "load": load}


def read_layer(path):
    """Return columns, geometries and values of a layer."""
    import pyogrio

    columns, _, shapes, values = pyogrio.raw.read(path)
    return list(columns["fields"]), list(shapes), [one.tolist() for one in values]


def assert_same_tin(found, wanted):
    """Require the same vertices, triangles and CRS."""
    np.testing.assert_array_equal(found.points, wanted.points)
    np.testing.assert_array_equal(found.triangles, wanted.triangles)
    assert str(found.crs) == str(wanted.crs)
