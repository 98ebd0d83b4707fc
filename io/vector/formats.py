"""The formats of points, lines and polygons."""

from typing import Any

from ..registry import signatures
from ..registry.format import SURFACES, Format

__all__ = ["FORMATS"]


def _make(name: str, description: str, suffix: str, *, module: str) -> Format:
    """Describe a format that pyogrio writes for a module here."""
    write = f"{__package__}.{module}:write"
    kinds: dict[str, Any] = {"suffixes": (suffix,), "writes": ("Features",)}
    return Format(name=name, description=description, write=write, extra="vector", **kinds)


FORMATS = (
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        write=f"{__package__}.geojson.writing:write",
        writes=(*SURFACES, "Features"),
        sniff=signatures.is_geojson,
    ),
    _make("gpkg", "GeoPackage", ".gpkg", module="geopackage"),
    _make("flatgeobuf", "FlatGeobuf", ".fgb", module="flatgeobuf"),
    _make(
        "shapefile",
        "Shapefile (with its parts .shx, .dbf, .prj, .cpg)",
        ".shp",
        module="shapefile",
    ),
)
