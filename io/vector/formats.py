"""The formats of points, lines and polygons."""

from typing import Any

from ..registry import signatures
from ..registry.format import SURFACES, Format

__all__ = ["FORMATS"]

_EXACT = "Every number comes back bit for bit."


def _make(name: str, description: str, suffix: str, *, module: str, **more: Any) -> Format:
    """Describe a format that pyogrio writes for a module here."""
    write = f"{__package__}.{module}:write"
    more |= {"suffixes": (suffix,), "writes": ("Features",), "extra": "vector"}
    return Format(name=name, description=description, write=write, **more)


FORMATS = (
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        write=f"{__package__}.geojson.writing:write",
        writes=(*SURFACES, "Features"),
        sniff=signatures.is_geojson,
        precision="Longitude and latitude to 9 decimals (0.1 mm), elevations in metres to 6; in "
        "the CRS of the points (projected) every number bit for bit.",
        losses="Triangles are separate polygons, without the numbers of their vertices.",
    ),
    _make("gpkg", "GeoPackage", ".gpkg", module="geopackage", precision=_EXACT),
    _make(
        *("flatgeobuf", "FlatGeobuf", ".fgb"),
        module="flatgeobuf",
        precision=_EXACT,
        losses="The order of features: they stand in that of the spatial index.",
    ),
    _make(
        *("shapefile", "Shapefile (with its parts .shx, .dbf, .prj, .cpg)", ".shp"),
        module="shapefile",
        precision="Coordinates come back bit for bit; numbers have 15 decimals at most.",
        losses="Names of columns beyond 10 bytes, texts beyond 254, units and notes.",
    ),
)
