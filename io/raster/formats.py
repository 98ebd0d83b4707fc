"""The formats of rasters."""

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]

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
        extra="raster",
        sniff=signatures.is_raster,
    ),
    Format(
        name="geotiff",
        description="GeoTIFF",
        suffixes=(".tif", ".tiff"),
        write="tinsmith.io.raster.geotiff:write",
        writes=("Raster",),
        precision="Every cell comes back bit for bit.",
        losses="",
        extra="raster",
    ),
    Format(
        name="cog",
        description="Cloud optimized GeoTIFF",
        suffixes=(".tif", ".tiff"),
        write="tinsmith.io.raster.geotiff:write_cog",
        writes=("Raster",),
        precision="Every cell comes back bit for bit.",
        losses="",
        extra="raster",
    ),
)
