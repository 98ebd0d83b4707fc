"""The tables of a GeoPackage that holds a TIN, as SQL (OGC 12-128r18, GeoPackage 1.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ....base.crs import CRS

__all__ = [
    "APPLICATION_ID",
    "LAYERS",
    "NO_CLOCK",
    "RECORD",
    "TABLES",
    "USER_VERSION",
    "describe_crs",
]

APPLICATION_ID = 0x47504B47  # "GPKG"
USER_VERSION = 10300
RECORD = "tinsmith_tin"
"""The table of what no layer can show; its name is how a file of ours is recognised."""

NO_CLOCK = "1970-01-01T00:00:00.000Z"
"""Time of the last change: the same TIN gives the same bytes."""

LAYERS = {
    "vertices": ("POINT", "vertex INTEGER NOT NULL"),
    "triangles": (
        "POLYGON",
        "a INTEGER NOT NULL, b INTEGER NOT NULL, c INTEGER NOT NULL, "
        "constrained INTEGER NOT NULL, slope REAL, aspect REAL",
    ),
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
    *(
        f"CREATE TABLE {name} (fid INTEGER PRIMARY KEY NOT NULL, geom {geometry} NOT NULL, "
        f"{columns})"
        for name, (geometry, columns) in LAYERS.items()
    ),
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
            _format_wkt("EPSG:4326", "WKT1_GDAL"),
            "longitude and latitude in degrees",
            _format_wkt("EPSG:4326", "WKT2_2015"),
        ),
        ("Undefined Cartesian SRS", -1, "NONE", -1, *_UNDEFINED, "undefined"),
    ]
    if crs is None:
        return always
    if crs.to_epsg() == 4326:
        return [always[0], always[2], always[1]]
    number = crs.to_epsg()
    organization, code = ("EPSG", number) if number is not None else ("NONE", _OWN_SRS)
    wkt = [_format_wkt(str(crs), version) for version in ("WKT1_GDAL", "WKT2_2015")]
    return [*always, (crs.name, code, organization, code, wkt[0], crs.name, wkt[1])]


def _format_wkt(text: str, version: str) -> str:
    """Return WKT; "undefined" where the version cannot say it."""
    from pyproj import CRS as ProjCrs
    from pyproj.exceptions import CRSError

    try:
        found: str | None = ProjCrs(text).to_wkt(version)
    except CRSError:
        found = None
    return found or "undefined"
