"""Sound vector layers of each format: points, lines and triangles, ours and of other programs."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

__all__ = ["VECTOR_MAKERS", "WITH_PARTS"]

CRS = "EPSG:32616"
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])
WITH_PARTS = frozenset({"shapefile"})
"""Kinds whose files lie in folders, each one file of several parts."""

_DRIVERS = {".gpkg": "GPKG", ".fgb": "FlatGeobuf", ".shp": "ESRI Shapefile", ".gml": "GML",
            ".kml": "KML", ".gmt": "OGR_GMT", ".jml": "JML",
            ".geojson": "GeoJSON"}  # fmt: skip


def _tin() -> Any:
    points = CORNER + np.random.default_rng(5).random((14, 3)) * (40.0, 30.0, 9.0)
    return ts.triangulate(points.round(3), crs=CRS)


def _survey() -> Any:
    points = _tin().points
    codes = np.array(["EP", "ä", None] * 5, object)[: len(points)]
    return ts.Survey(points=points, crs=CRS, attributes={"k": np.arange(len(points)), "c": codes})


def _write_layer(path: Path, what: str) -> None:
    """Write points without elevations, lines, or a TIN, as GDAL does for other programs."""
    import pyogrio
    import shapely

    tin = _tin()
    shapes = {
        "flat": lambda: shapely.points(tin.points[:, :2]),
        "points": lambda: shapely.points(tin.points),
        "lines": lambda: shapely.linestrings(tin.points[tin.triangles[:3]]),
        "mixed": lambda: [shapely.Point(tin.points[0]), None, shapely.LineString(tin.points[:2])],
    }[what]()
    shapes = np.array(shapes, object)
    if path.suffix in (".kml",):
        shapes = shapely.transform(shapes, lambda xyz: xyz * (1e-5, 1e-5, 1), include_z=True)
    kind = "Unknown" if what == "mixed" else shapes[0].geom_type + " Z" * bool(shapes[0].has_z)
    fields = {"elev": np.arange(len(shapes)) + 300.5}
    pyogrio.raw.write(
        str(path),
        shapely.to_wkb(shapes, flavor="iso"),
        list(fields.values()),
        list(fields),
        geometry_type=kind,
        crs="EPSG:4326" if path.suffix in (".kml",) else CRS,
        driver=_DRIVERS[path.suffix],
    )


def _make(folder: Path, suffix: str, *others: str) -> list[tuple[str, bytes]]:
    ts.write(_survey(), folder / f"survey{suffix}")
    if suffix != ".gpkg":  # a whole TIN is another format
        ts.write(_tin(), folder / f"triangles{suffix}")
    for what in others:
        _write_layer(folder / f"{what}{suffix}", what)
    return [(one.name, one.read_bytes()) for one in sorted(folder.iterdir())]


def _make_geojson(folder: Path) -> list[tuple[str, bytes]]:
    ts.write(_survey(), folder / "degrees.geojson")
    ts.write(_survey(), folder / "survey.geojson", projected=True)
    ts.write(_tin(), folder / "triangles.geojson", projected=True)
    for what in ("flat", "lines", "mixed"):
        _write_layer(folder / f"{what}.geojson", what)
    return [(one.name, one.read_bytes()) for one in sorted(folder.iterdir())]


def _make_sequence(folder: Path) -> list[tuple[str, bytes]]:
    files = _make(folder, ".geojsonl")
    separated = b"".join(b"\x1e" + row + b"\n" for row in files[0][1].splitlines())
    return [*files, ("separated.geojsons", separated)]


def _make_shapefile(folder: Path) -> list[tuple[str, bytes]]:
    for name in ("survey", "triangles", "flat", "lines", "patch"):
        (folder / name).mkdir()
    ts.write(_survey(), folder / "survey" / "a.shp")
    ts.write(_tin(), folder / "triangles" / "a.shp")
    ts.write(_tin(), folder / "patch" / "a.shp", multipatch=True)
    for what in ("flat", "lines"):
        _write_layer(folder / what / "a.shp", what)
    return [(str(one.relative_to(folder)), one.read_bytes())
            for one in sorted(folder.glob("*/*"))]  # fmt: skip


def _make_geoparquet(folder: Path) -> list[tuple[str, bytes]]:
    import pyarrow as pa
    from pyarrow import parquet

    points = _tin().points
    axes = [pa.array(points[:, k]) for k in range(3)]
    native = pa.StructArray.from_arrays(axes, ["x", "y", "z"])
    geo = {"version": "1.1.0", "primary_column": "g", "columns": {"g": {"encoding": "point"}}}
    geo["columns"]["g"]["crs"] = None
    table = pa.table({"k": pa.array(range(len(points))), "g": native})
    parquet.write_table(
        table.replace_schema_metadata({"geo": json.dumps(geo)}), folder / "native.parquet"
    )
    return _make(folder, ".parquet")


def _make_others(folder: Path) -> list[tuple[str, bytes]]:
    for suffix in (".gml", ".kml", ".gmt", ".jml"):
        for what in ("flat", "lines"):
            _write_layer(folder / f"{what}{suffix}", what)
    return [(one.name, one.read_bytes()) for one in sorted(folder.iterdir())
            if one.suffix in _DRIVERS]  # fmt: skip


def _make_geopackage(folder: Path) -> list[tuple[str, bytes]]:
    """Return files of small pages, as dense as SQLite makes them."""
    names = [name for name, _ in _make(folder, ".gpkg", "flat", "lines", "mixed")]
    for name in names:
        with closing(sqlite3.connect(folder / name, isolation_level=None)) as file:
            file.execute("PRAGMA page_size = 512")
            file.execute("VACUUM")
    return [(name, (folder / name).read_bytes()) for name in names]


VECTOR_MAKERS = {
    "geojson": _make_geojson,
    "geojsonseq": _make_sequence,
    "gpkg": _make_geopackage,
    "flatgeobuf": lambda folder: _make(folder, ".fgb", "flat", "lines"),
    "shapefile": _make_shapefile,
    "geoparquet": _make_geoparquet,
    "vector": _make_others,
}
