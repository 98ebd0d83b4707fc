"""The formats of points, lines and polygons."""

from ..registry import signatures
from ..registry.format import SURFACES, Format, Loss
from .signatures import (
    is_flatgeobuf,
    is_geodatabase,
    is_geojson_sequence,
    is_geopackage,
    is_parquet,
    is_shapefile,
    is_vector_text,
)

__all__ = ["FORMATS"]

_READ = "tinsmith.io.vector.points:read"
_WRITE = "tinsmith.io.vector.surface_layers:write_"
_BOTH = ("Survey", "TIN")
_EXACT = "Every coordinate is the same double."
_LOSSES = (
    "Of a TIN what the kind that is written does not show: lines and attributes beside triangles, "
    "the report, vertices of no triangle; of a survey its lines."
)
_LOSES: tuple[Loss, ...] = ("order", "constrained", "lines", "attributes", "notes", "report")

FORMATS = (
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        read=_READ,
        reads=_BOTH,
        write="tinsmith.io.vector.geojson.writing:write",
        writes=(*SURFACES, "Features"),
        precision=(
            "Longitude and latitude with 9 decimals, elevations in metres with 6; with the option "
            "projected every coordinate is the same double."
        ),
        rounding=2e-4,
        losses="The CRS, as RFC 7946 knows WGS 84 alone: name it on reading. " + _LOSSES,
        loses=_LOSES,
        sniff=signatures.is_geojson,
    ),
    Format(
        name="geojsonseq",
        description="Sequence of GeoJSON features, a line each (RFC 8142 without its separators)",
        suffixes=(".geojsonl", ".geojsons", ".ndjson"),
        read=_READ,
        reads=_BOTH,
        write=_WRITE + "geojson_sequence",
        writes=("Features", "TIN", "Survey"),
        precision="Longitude and latitude with 9 decimals, elevations in metres with 6.",
        rounding=2e-4,
        losses="The CRS, units and notes, which a sequence has no place for: name it on reading. "
        + _LOSSES,
        loses=_LOSES,
        sniff=is_geojson_sequence,
    ),
    Format(
        name="gpkg",
        description="GeoPackage",
        suffixes=(".gpkg",),
        read=_READ,
        reads=_BOTH,
        write=_WRITE + "geopackage",
        writes=("Features", "Survey"),
        precision=_EXACT,
        losses="Of a survey its lines.",
        extra="vector",
        sniff=is_geopackage,
    ),
    Format(
        name="flatgeobuf",
        description="FlatGeobuf",
        suffixes=(".fgb",),
        read=_READ,
        reads=_BOTH,
        write=_WRITE + "flatgeobuf",
        writes=("Features", "TIN", "Survey"),
        precision=_EXACT,
        losses=_LOSSES,
        loses=_LOSES,
        extra="vector",
        sniff=is_flatgeobuf,
    ),
    Format(
        name="shapefile",
        description="Shapefile (with its parts .shx, .dbf, .prj, .cpg)",
        suffixes=(".shp",),
        read=_READ,
        reads=_BOTH,
        write=_WRITE + "shapefile",
        writes=("Features", "TIN", "Survey"),
        precision="Coordinates are the same doubles; other numbers have 15 decimals at most.",
        losses="Names beyond 10 bytes, texts beyond 254, units and notes. As a MultiPatch (on "
        "request) slope, aspect and area too. " + _LOSSES,
        loses=("elevation unit", *_LOSES),
        extra="vector",
        sniff=is_shapefile,
    ),
    Format(
        name="geoparquet",
        description="GeoParquet",
        suffixes=(".parquet", ".geoparquet"),
        read=_READ,
        reads=_BOTH,
        write=_WRITE + "geoparquet",
        writes=("Features", "TIN", "Survey"),
        precision=_EXACT,
        losses=_LOSSES,
        loses=_LOSES,
        extra="interop",
        sniff=is_parquet,
    ),
    Format(
        name="vector",
        description="Other vector layers that GDAL reads: KML, GML, GPX, MapInfo, geodatabases ...",
        suffixes=(".kml", ".gml", ".gpx", ".tab", ".mif", ".gmt", ".jml", ".gdb"),
        read=_READ,
        reads=_BOTH,
        extra="vector",
        sniff=is_vector_text,
        sniff_folder=is_geodatabase,
    ),
)
