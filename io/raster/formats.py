"""The formats of rasters."""

from pathlib import Path
from typing import Any

from ..registry import Format, signatures


def _make(name: str, description: str, writer: str, **more: Any) -> Format:
    """Describe a format that rasters are written in, GeoTIFF if nothing is said."""
    usual: dict[str, Any] = {"suffixes": (".tif", ".tiff"), "writes": ("Raster",)}
    usual["precision"] = "Every cell is kept bit for bit."
    write = f"{__package__}.{writer}"
    return Format(name=name, description=description, write=write, **(usual | more))


def _list_mosaic(path: Path) -> list[Path]:
    """Return the rasters that a VRT names."""
    from .virtual import is_virtual, require_plain_sources

    return require_plain_sources(path) if is_virtual(path) else []


_OF_GEOTIFF = {"": ("*.aux.xml", "*.ovr", "*.msk", "*.ovr.msk")}
_APPENDED = ("*.aux.xml", "*.ovr", "*.msk", "*.xml", "*.aux")
_WORLD = (".wld", ".prj")
_HEADED = (".hdr", ".blw", ".clr", ".stx", *_WORLD)
_SIDE_FILES = {
    "": _APPENDED,
    **dict.fromkeys((".tif", ".tiff"), (".tfw", ".tifw", ".aux", *_WORLD)),
    **dict.fromkeys((".asc", ".grd", ".bt", ".dem", ".nc"), (".prj", ".clr")),
    **dict.fromkeys((".bil", ".bip", ".bsq", ".flt"), _HEADED),
    ".img": (".rrd", ".ige", ".rde", ".aux", *_WORLD),
    ".sdat": (".sgrd", ".mgrd", ".prj"),
    ".rst": (".rdc", ".ref", ".smp"),
    ".png": (".pgw", ".pngw", *_WORLD),
    ".jpg": (".jgw", ".jpgw", *_WORLD),
    ".jp2": (".j2w", ".jp2w", *_WORLD),
}
"""What GDAL reads beside a raster."""

FORMATS = (
    Format(
        name="raster",
        description="Elevation rasters that GDAL reads: GeoTIFF, VRT, IMG, HGT, ASC, netCDF ...",
        suffixes=(
            *(".tif", ".tiff", ".vrt", ".img", ".dem", ".hgt", ".asc", ".grd", ".nc", ".bil"),
            *(".bip", ".bsq", ".flt", ".dt0", ".dt1", ".dt2", ".adf", ".sdat", ".rst", ".bt"),
            *(".jp2", ".png", ".jpg", ".grb", ".grb2", ".ntf"),
        ),
        read="tinsmith.io.raster.reading:read",
        stream="tinsmith.io.raster.reading:stream",
        describe="tinsmith.io.raster.boxes:describe",
        read_box="tinsmith.io.raster.boxes:read_box",
        read_cells="tinsmith.io.raster.lazy_raster:read_raster",
        sniff=signatures.is_raster,
        side_files=_SIDE_FILES,
        find_sources=_list_mosaic,
    ),
    _make("geotiff", "GeoTIFF", "geotiff:write", side_files=_OF_GEOTIFF),
    _make("cog", "Cloud optimized GeoTIFF", "geotiff:write_cog", side_files=_OF_GEOTIFF),
    _make(
        *("asc", "Esri ASCII grid, one band as text", "ascii_grid:write"),
        suffixes=(".asc",),
        is_text=True,
        side_files={"": (".prj",)},
        precision="Every number is kept bit for bit.",
        losses="Units and notes; all bands but one.",
    ),
    _make(
        "terrain-tiles",
        "Elevations as tiles for maps in browsers (terrain-RGB), in PMTiles or MBTiles",
        "terrain_tiles:write",
        suffixes=(".pmtiles", ".mbtiles"),
        precision="Interpolated in Web Mercator; elevations to 1/256 m, or 0.1 m.",
        losses="The CRS; the unit, which becomes the metre; all bands but one.",
    ),
)
