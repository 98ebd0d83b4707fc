"""The formats of rasters."""

from typing import Any

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]


def _make(name: str, description: str, writer: str, **more: Any) -> Format:
    """Describe a format that rasters are written in, GeoTIFF if nothing is said."""
    usual: dict[str, Any] = {"suffixes": (".tif", ".tiff"), "writes": ("Raster",)}
    usual["precision"] = "Every cell is kept bit for bit."
    write = f"{__package__}.{writer}"
    return Format(name=name, description=description, write=write, **(usual | more))


FORMATS = (
    Format(
        name="raster",
        description="Elevation rasters that GDAL reads: GeoTIFF, VRT, IMG, HGT, ASC, netCDF ...",
        suffixes=(
            *(".tif", ".tiff", ".vrt", ".img", ".dem", ".hgt", ".asc", ".grd", ".nc", ".bil"),
            *(".bip", ".bsq", ".flt", ".dt0", ".dt1", ".dt2", ".adf", ".sdat", ".rst", ".bt"),
            *(".jp2", ".png", ".jpg", ".grb", ".grb2", ".ntf"),
        ),
        read="tinsmith.io.raster.dem:read",
        sniff=signatures.is_raster,
    ),
    _make("geotiff", "GeoTIFF", "geotiff:write"),
    _make("cog", "Cloud optimized GeoTIFF", "geotiff:write_cog"),
    _make(
        *("asc", "Esri ASCII grid, one band as text", "ascii_grid:write"),
        suffixes=(".asc",),
        precision="Every number is kept bit for bit.",
        losses="Units and notes; all bands but one.",
    ),
)
