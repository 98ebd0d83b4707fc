"""A GeoPackage that holds a TIN (OGC 12-128r18, GeoPackage 1.3): tables, geometries, digests.

A geometry is a header, then little-endian well-known binary with z. Digests tell whether layers and
record are still those that were written together.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.crs import CRS, find_wkt

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ....base.arrays import AnyArray, Float64Array

APPLICATION_ID = 0x47504B47  # "GPKG"
USER_VERSION = 10300
RECORD = "tinsmith_tin"
"""The table of what no layer can show; its name is how a file of ours is recognised."""

NO_CLOCK = "1970-01-01T00:00:00.000Z"
"""Time of the last change: the same TIN gives the same bytes."""

NUMBERS = "tinsmith_triangles"
"""The table of the vertices of each triangle, where the layer of triangles is a view."""

_CORNERS = (
    "a INTEGER NOT NULL, b INTEGER NOT NULL, c INTEGER NOT NULL, constrained INTEGER NOT NULL"
)

LAYERS = {
    "vertices": ("POINT", "vertex INTEGER NOT NULL"),
    "triangles": ("POLYGON", f"{_CORNERS}, slope REAL, aspect REAL"),
    "lines": ("LINESTRING", "kind TEXT NOT NULL, name TEXT NOT NULL, source INTEGER NOT NULL"),
    "boundary": ("LINESTRING", "ring INTEGER NOT NULL"),
    "water": ("POLYGON", "name TEXT NOT NULL, elevation REAL NOT NULL"),
}
"""Geometry and columns of each layer."""

TABLES = (
    f"CREATE TABLE {RECORD} (id INTEGER PRIMARY KEY NOT NULL, name TEXT NOT NULL UNIQUE, "
    "type TEXT NOT NULL, shape TEXT NOT NULL, data BLOB NOT NULL)",
    "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, "
    "organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL, "
    "definition TEXT NOT NULL, description TEXT, definition_12_063 TEXT NOT NULL)",
    "CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, "
    "identifier TEXT UNIQUE, description TEXT DEFAULT '', last_change DATETIME NOT NULL DEFAULT "
    "(strftime('%Y-%m-%dT%H:%M:%fZ','now')), min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, "
    "max_y DOUBLE, srs_id INTEGER, CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) "
    "REFERENCES gpkg_spatial_ref_sys(srs_id))",
    "CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL, "
    "geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, "
    "m TINYINT NOT NULL, CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), "
    "CONSTRAINT uk_gc_table_name UNIQUE (table_name), CONSTRAINT fk_gc_tn FOREIGN KEY "
    "(table_name) REFERENCES gpkg_contents(table_name), CONSTRAINT fk_gc_srs FOREIGN KEY "
    "(srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id))",
    "CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, "
    "extension_name TEXT NOT NULL, definition TEXT NOT NULL, scope TEXT NOT NULL, "
    "CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name))",
)


def declare_layer(name: str) -> str:
    """Return the statement that makes the table of a layer."""
    geometry, columns = LAYERS[name]
    return (
        f"CREATE TABLE {name} (fid INTEGER PRIMARY KEY NOT NULL, geom {geometry} NOT NULL, "
        f"{columns})"
    )


def declare_numbers() -> str:
    """Return the statement that makes the table of the vertices of each triangle.

    No row has a value in the last column, from which the view has the type of its polygons. It is
    not among the contents, where a table with such a column would have to be a layer.
    """
    return f"CREATE TABLE {NUMBERS} (fid INTEGER PRIMARY KEY NOT NULL, {_CORNERS}, geom POLYGON)"


FORMER_NUMBERS = f"CREATE TABLE triangles (fid INTEGER PRIMARY KEY NOT NULL, {_CORNERS})"
"""The table of a file without a view."""


def declare_view() -> str:
    """Return the statement that makes triangles a view: polygons put together from the vertices.

    Of the point of a vertex the first 8 bytes are the header, which is that of a polygon too, and
    those from the 14th on its coordinates. Polygons have the type of the query behind theirs, which
    finds no row: an expression alone has none.
    """
    header, ring = "substr(p.geom, 1, 8)", np.array([(1, _POLYGON_Z, 1, 4)], _RING).tobytes().hex()
    corners = " || ".join(f"substr({corner}.geom, 14)" for corner in "pqrp")
    polygon = f"CAST({header} || x'{ring}' || {corners} AS BLOB)"
    joined = " ".join(
        f"CROSS JOIN vertices {corner} ON {corner}.fid = t.{column} + 1"
        for corner, column in zip("pqr", "abc", strict=True)
    )
    return (
        f"CREATE VIEW triangles AS SELECT t.fid AS fid, (SELECT {polygon} UNION ALL SELECT geom "
        f"FROM {NUMBERS} WHERE 0) AS geom, t.a AS a, t.b AS b, t.c AS c, t.constrained AS "
        f"constrained FROM {NUMBERS} t {joined}"
    )


_OWN_SRS = 100000
"""Number of a CRS that no authority has; GDAL takes the same."""

_UNDEFINED = ("undefined", "undefined")
_Row = tuple[str, int, str, int, str, str, str]


def describe_crs(crs: CRS | None) -> list[_Row]:
    """Return the rows of ``gpkg_spatial_ref_sys``; the last is that of the CRS."""
    always: list[_Row] = [
        ("Undefined geographic SRS", 0, "NONE", 0, *_UNDEFINED, "undefined"),
        (
            "WGS 84",
            4326,
            "EPSG",
            4326,
            _format_wkt(CRS("EPSG:4326"), "WKT1_GDAL"),
            "longitude and latitude in degrees",
            _format_wkt(CRS("EPSG:4326"), "WKT2_2015"),
        ),
        ("Undefined Cartesian SRS", -1, "NONE", -1, *_UNDEFINED, "undefined"),
    ]
    if crs is None:
        return always
    if crs.to_epsg() == 4326:
        return [always[0], always[2], always[1]]
    number = crs.to_epsg()
    organization, code = ("EPSG", number) if number is not None else ("NONE", _OWN_SRS)
    wkt = [_format_wkt(crs, version) for version in ("WKT1_GDAL", "WKT2_2015")]
    return [*always, (crs.name, code, organization, code, wkt[0], crs.name, wkt[1])]


def _format_wkt(crs: CRS, version: str) -> str:
    return find_wkt(crs, version) or "undefined"


def digest_arrays(*arrays: AnyArray, text: str = "") -> str:
    """Return a digest of arrays, their types and shapes, and a text."""
    found = blake2b(text.encode(), digest_size=16)
    for array in arrays:
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def digest_lines(rows: Iterable[tuple[bytes, str, str]]) -> str:
    """Return a digest of the geometries, kinds and names of a layer of lines."""
    found = blake2b(digest_size=16)
    for geometry, kind, name in rows:
        found.update(f"{kind}\n{name}\n{len(geometry)}\n".encode())
        found.update(geometry)
    return found.hexdigest()


_HEADER = [("magic", "S2"), ("version", "u1"), ("flags", "u1"), ("srs", "<i4")]
_ENVELOPE = [("bounds", "<f8", (4,))]  # min x, max x, min y, max y
_KIND = [("order", "u1"), ("kind", "<u4")]
_WITH_ENVELOPE, _WITHOUT = 0b011, 0b001  # the last bit: little-endian

POINT = np.dtype([*_HEADER, *_KIND, ("xyz", "<f8", (3,))])
"""A point, as it lies in the file."""

TRIANGLE = np.dtype(
    [*_HEADER, *_ENVELOPE, *_KIND, ("rings", "<u4"), ("count", "<u4"), ("xyz", "<f8", (4, 3))]
)
"""A polygon of three sides, likewise."""

_RING = np.dtype([*_KIND, ("rings", "<u4"), ("count", "<u4")])
_POINT_Z, _LINE_Z, _POLYGON_Z = 1001, 1002, 1003


def make_points(points: Float64Array, srs: int) -> AnyArray:
    """Return a point for each row of an (n, 3) array, as they lie in the file."""
    rows = _begin(np.zeros(len(points), POINT), _WITHOUT, srs, _POINT_Z)
    rows["xyz"] = points
    return rows


def make_triangles(corners: Float64Array, srs: int) -> AnyArray:
    """Return a closed ring of four vertices for each of the (m, 3, 3) corners."""
    rows = _begin(np.zeros(len(corners), TRIANGLE), _WITH_ENVELOPE, srs, _POLYGON_Z)
    rows["rings"], rows["count"] = 1, 4
    rows["xyz"][:, :3] = corners
    rows["xyz"][:, 3] = corners[:, 0]
    for axis in (0, 1):
        one, two, three = corners[:, :, axis].T
        rows["bounds"][:, 2 * axis] = np.minimum(np.minimum(one, two), three)
        rows["bounds"][:, 2 * axis + 1] = np.maximum(np.maximum(one, two), three)
    return rows


def make_chain_blobs(chains: list[Float64Array], srs: int, *, as_rings: bool) -> list[bytes]:
    """Return a line, or a polygon of one ring, for each (k, 3) array of vertices."""
    rings = [("rings", "<u4")] if as_rings else []
    kind = _POLYGON_Z if as_rings else _LINE_Z
    blobs = []
    for chain in chains:
        fields: list[Any] = [*_HEADER, *_ENVELOPE, *_KIND, *rings, ("count", "<u4")]
        row = _begin(np.zeros(1, np.dtype(fields)), _WITH_ENVELOPE, srs, kind)
        if as_rings:
            row["rings"] = 1
        row["count"] = len(chain)
        (low_x, low_y), (high_x, high_y) = chain[:, :2].min(axis=0), chain[:, :2].max(axis=0)
        row["bounds"] = (low_x, high_x, low_y, high_y)
        blobs.append(row.tobytes() + np.ascontiguousarray(chain, "<f8").tobytes())
    return blobs


def _begin(rows: AnyArray, flags: int, srs: int, kind: int) -> AnyArray:
    rows["magic"], rows["flags"], rows["srs"] = b"GP", flags, srs
    rows["order"], rows["kind"] = 1, kind
    return rows
