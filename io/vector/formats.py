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
        precision="Longitude and latitude to 9 decimals (0.1 mm), elevations in metres to 6; in "
        "the CRS of the points (projected) every number bit for bit.",
        losses="Triangles are separate polygons, without the numbers of their vertices.",
    ),
    Format(
        name="gpkg",
        description="GeoPackage",
        suffixes=(".gpkg",),
        write="tinsmith.io.vector.geopackage:write",
        writes=("Features",),
        extra="vector",
        precision="Every number comes back bit for bit.",
        losses="",
    ),
    Format(
        name="flatgeobuf",
        description="FlatGeobuf",
        suffixes=(".fgb",),
        write="tinsmith.io.vector.flatgeobuf:write",
        writes=("Features",),
        extra="vector",
        precision="Every number comes back bit for bit.",
        losses="The order of features: they stand in that of the spatial index.",
    ),
    Format(
        name="shapefile",
        description="Shapefile (with its parts .shx, .dbf, .prj, .cpg)",
        suffixes=(".shp",),
        write="tinsmith.io.vector.shapefile:write",
        writes=("Features",),
        extra="vector",
        precision="Coordinates come back bit for bit; numbers have 15 decimals at most.",
        losses="Names of columns beyond 10 bytes, texts beyond 254, units and notes.",
    ),
)
