"""The formats of points, lines and polygons."""

from typing import Any

from ..registry import SURFACES, Format, Loss, signatures
from .signatures import (
    is_flatgeobuf,
    is_geodatabase,
    is_geojson_sequence,
    is_geopackage,
    is_parquet,
    is_shapefile,
    is_vector_text,
)

_LOSSES = (
    "Of a TIN all that is not of the kind written: with triangles lines and attributes, the "
    "report, vertices of no triangle; of a survey its lines."
)
_LOSES: tuple[Loss, ...] = (
    *("order", "constrained", "lines", "survey lines"),
    *("attributes", "notes", "report"),
)


def _make(name: str, description: str, *suffixes: str, writer: str = "", **more: Any) -> Format:
    """Describe a format whose points and triangles are read by GDAL or as GeoJSON."""
    ends: dict[str, Any] = {"read": f"{__package__}.points:read", "reads": ("Survey", "TIN")}
    if writer:
        ends["write"] = f"{__package__}.{writer}"
        ends |= {"writes": ("Features", *SURFACES), "losses": _LOSSES, "loses": _LOSES}
        ends["precision"] = "Every coordinate is the same double."
    return Format(name=name, description=description, suffixes=suffixes, **(ends | more))


_OF_SHAPEFILES = (
    *(".shx", ".dbf", ".prj", ".cpg", ".qpj", ".sbn", ".sbx", ".qix", ".idx"),
    "*.xml",
)
_OF_OTHERS = {
    ".tab": (".dat", ".map", ".id", ".ind"),
    ".mif": (".mid",),
    ".gml": (".gfs", ".xsd"),
}

FORMATS = (
    _make(
        *("geojson", "GeoJSON (RFC 7946)", ".geojson", ".json"),
        writer="geojson.writing:write",
        is_text=True,
        writes=(*SURFACES, "Features"),
        precision=(
            "Longitude and latitude with 9 decimals, elevations in metres with 6; with the option "
            "projected every coordinate is kept bit for bit."
        ),
        rounding=2e-4,
        losses="The CRS, since RFC 7946 allows only WGS 84: name it when reading. " + _LOSSES,
        sniff=signatures.is_geojson,
    ),
    _make(
        "geojsonseq",
        "Sequence of GeoJSON features, one per line (RFC 8142 without its separators)",
        *(".geojsonl", ".geojsons", ".ndjson"),
        writer="geojson.features:write_feature_lines",
        is_text=True,
        precision="Longitude and latitude with 9 decimals, elevations in metres with 6.",
        rounding=2e-4,
        losses="CRS, units and notes: name the CRS when reading. " + _LOSSES,
        sniff=is_geojson_sequence,
    ),
    _make(
        *("gpkg", "GeoPackage", ".gpkg"),
        writer="geopackage:write",
        has_layers=True,
        writes=("Features", "Survey"),
        losses="Of a survey its lines.",
        loses=("survey lines",),
        sniff=is_geopackage,
        side_files={"": ("*-wal", "*-shm", "*-journal")},
    ),
    _make(
        *("flatgeobuf", "FlatGeobuf", ".fgb"),
        writer="ogr:write_flatgeobuf",
        sniff=is_flatgeobuf,
    ),
    _make(
        *("shapefile", "Shapefile (with its parts .shx, .dbf, .prj, .cpg)", ".shp"),
        writer="shapefile:write",
        precision="Coordinates are kept bit for bit; other numbers have at most 15 decimals.",
        losses="Names beyond 10 bytes, texts beyond 254, units and notes. As a MultiPatch (on "
        "request) slope, aspect and area too. " + _LOSSES,
        loses=("elevation unit", *_LOSES),
        sniff=is_shapefile,
        side_files={"": _OF_SHAPEFILES},
    ),
    _make(
        *("geoparquet", "GeoParquet", ".parquet", ".geoparquet"),
        writer="geoparquet:write",
        stream=f"{__package__}.parquet.streaming:stream",
        describe=f"{__package__}.parquet.streaming:describe",
        read_box=f"{__package__}.parquet.streaming:read_box",
        extra="interop",
        sniff=is_parquet,
    ),
    _make(
        "vector",
        "Other vector layers that GDAL reads: KML, GML, GPX, MapInfo, geodatabases ...",
        *(".kml", ".gml", ".gpx", ".tab", ".mif", ".gmt", ".jml", ".gdb"),
        sniff=is_vector_text,
        sniff_folder=is_geodatabase,
        side_files=_OF_OTHERS,
    ),
)
