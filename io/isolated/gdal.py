"""What GDAL may do in a child: read plain files, with drivers that follow no references.

Many of its drivers take a text for a description of data elsewhere, whatever the file is called:
virtual rasters and layers, web services, catalogs. They read any file that the text names, or fetch
it. So drivers are allowed one by one, and those that follow references are not even loaded, which
holds for the files beside a file (overviews, masks) and the sources of a virtual raster too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

RASTER_DRIVERS = (
    *("GTiff", "HFA", "AAIGrid", "GRASSASCIIGrid", "ISG", "GSAG", "GSBG", "GS7BG", "NWT_GRD"),
    *("RRASTER", "netCDF", "HDF5", "HDF5Image", "BAG", "USGSDEM", "SRTMHGT", "DTED", "AIG"),
    *("EHdr", "ENVI", "GenBin", "SAGA", "RST", "BT", "JP2OpenJPEG", "PNG", "JPEG", "GRIB", "NITF"),
    *("PCRaster", "Terragen", "SIGDEM", "HF2", "GXF", "ZMap", "ACE2"),
)
"""Drivers of elevation rasters (and of pictures, to name them) that read a file, and files of the
same name beside it, and nothing else."""

VECTOR_DRIVERS = (
    *("GPKG", "ESRI Shapefile", "GeoJSON", "GeoJSONSeq", "JSONFG", "ESRIJSON", "TopoJSON"),
    *("FlatGeobuf", "DXF", "DGN", "KML", "LIBKML", "GPX", "GML", "CSV", "MapInfo File", "MapML"),
    *("OGR_GMT", "OpenFileGDB", "SQLite", "S57", "JML", "AVCE00", "Parquet", "Arrow"),
)
"""Drivers of vector files likewise."""

REFERRING_DRIVERS = (
    *("VRT", "DERIVED", "GTI", "OGR_VRT", "GDALG", "WMS", "WMTS", "WCS", "OGCAPI", "HTTP"),
    *("STACTA", "STACIT", "PLMOSAIC", "PLSCENES", "EEDA", "EEDAI", "DAAS", "NGW", "DIMAP", "TIL"),
    *("ERS", "MRF", "MAP", "OZI", "PDS", "PDS4", "ISIS2", "ISIS3", "VICAR", "OGR_PDS", "SDTS"),
    *("RPFTOC", "ECRGTOC", "SENTINEL2", "SAFE", "TSX", "RS2", "COSAR", "ESRIC", "Rasterlite"),
    *("MBTiles", "PMTiles", "MVT", "KMLSUPEROVERLAY", "PDF", "GMLAS", "WFS", "OAPIF", "CSW"),
    *("Carto", "AmigoCloud", "Elasticsearch", "ADBC", "GNMFile", "GNMDatabase", "Zarr", "ROI_PAC"),
    *("PAux", "MFF", "FAST", "LAN", "ISCE", "GPSBabel", "OSM", "XLSX", "ODS", "EIR", "DOQ2"),
)
"""Drivers that follow references, speak to services, or run commands."""

_ENVIRONMENT = {
    "CPL_VSIL_CURL_ALLOWED_FILENAME": "none",  # no /vsicurl, whatever asks for it
    "GDAL_HTTP_PROXY": "127.0.0.1:9",  # port 9 discards; a last fence around other requests
    "GDAL_HTTP_CONNECTTIMEOUT": "1",
    "GDAL_HTTP_TIMEOUT": "1",
    "GDAL_HTTP_MAX_RETRY": "0",
    "PROJ_NETWORK": "OFF",
    "AAIGRID_DATATYPE": "Float64",  # else numbers of text grids have seven digits
    "GDAL_VRT_ENABLE_PYTHON": "NO",
    "GDAL_VRT_ENABLE_RAWRASTERBAND": "NO",
    "GML_DOWNLOAD_SCHEMA": "NO",
    "GML_SKIP_RESOLVE_ELEMS": "ALL",
}


def make_environment(*, allowed: Iterable[str] = ()) -> dict[str, str]:
    """Return the variables of a child that reads with GDAL.

    Parameters
    ----------
    allowed : iterable of str
        Drivers that follow references and are loaded all the same.
    """
    unwanted = [name for name in REFERRING_DRIVERS if name not in set(allowed)]
    return {**_ENVIRONMENT, "GDAL_SKIP": ",".join(unwanted)}
