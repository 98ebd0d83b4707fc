"""The formats of points, lines and polygons."""

from ..registry import signatures
from ..registry.format import SURFACES, Format

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        write="tinsmith.io.vector.geojson.writing:write",
        writes=(*SURFACES, "Features"),
        sniff=signatures.is_geojson,
    ),
    Format(
        name="gpkg",
        description="GeoPackage",
        suffixes=(".gpkg",),
        write="tinsmith.io.vector.geopackage:write",
        writes=("Features",),
        extra="vector",
    ),
    Format(
        name="flatgeobuf",
        description="FlatGeobuf",
        suffixes=(".fgb",),
        write="tinsmith.io.vector.flatgeobuf:write",
        writes=("Features",),
        extra="vector",
    ),
    Format(
        name="shapefile",
        description="Shapefile (with its parts .shx, .dbf, .prj, .cpg)",
        suffixes=(".shp",),
        write="tinsmith.io.vector.shapefile:write",
        writes=("Features",),
        extra="vector",
    ),
)
