"""The formats of rasters."""

from typing import Any

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]


def _make(name: str, description: str, function: str) -> Format:
    """Describe a kind of GeoTIFF that is written."""
    write = f"{__package__}.geotiff:{function}"
    kinds: dict[str, Any] = {"suffixes": (".tif", ".tiff"), "writes": ("Raster",)}
    kinds["precision"] = "Every cell is kept bit for bit."
    return Format(name=name, description=description, write=write, **kinds)


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
    _make("geotiff", "GeoTIFF", "write"),
    _make("cog", "Cloud optimized GeoTIFF", "write_cog"),
    Format(
        name="asc",
        description="Esri ASCII grid, one band as text",
        suffixes=(".asc",),
        write="tinsmith.io.raster.ascii_grid:write",
        writes=("Raster",),
        precision="Every number is kept bit for bit.",
        losses="Units and notes; all bands but one.",
    ),
)
