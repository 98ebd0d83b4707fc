"""What the first bytes of a file say about its format."""

from __future__ import annotations

import re
from mmap import ACCESS_READ, mmap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

HEAD_BYTES = 65536

_NUMBER = rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
_RASTER_STARTS = (
    b"II*\x00",  # TIFF and BigTIFF in both byte orders
    b"MM\x00*",
    b"II+\x00",
    b"MM\x00+",
    b"\x89PNG\r\n\x1a\n",
    b"\xff\xd8\xff",  # JPEG
    b"\x00\x00\x00\x0cjP  ",  # JPEG 2000
    b"EHFA_HEADER_TAG",  # Erdas Imagine
    b"DSAA",  # Surfer grids
    b"DSBB",
    b"DSRB",
    b"CDF\x01",  # netCDF, and HDF5 which netCDF 4 is
    b"CDF\x02",
    b"CDF\x05",
    b"\x89HDF\r\n\x1a\n",
    b"RUU CROSS SYSTEM MAP FORMAT",  # PCRaster
    b"binterr1.",
    b"GRIB",
    b"NITF0",
    b"UHL1",  # DTED
)
_GRID_HEADER = re.compile(rb"\s*(?:ncols|nrows|xll(?:corner|center)|north:)\s*[-+.\d]", re.I)
_OBJ_LINE = re.compile(rb"(?:v|vn|vt|f|o|g|s|usemtl|mtllib)[ \t]")
_OBJ_VERTEX = re.compile(rb"^v(?:[ \t]+" + _NUMBER + rb"){3}", re.M)
_GEOJSON_TYPE = re.compile(
    rb'"type"\s*:\s*"(?:FeatureCollection|Feature|GeometryCollection|(?:Multi)?'
    rb'(?:Point|LineString|Polygon))"'
)
_FOREIGN_STARTS = {
    b"PK\x03\x04": "a ZIP archive (such as an Excel workbook or KMZ)",
    b"\x1f\x8b": "a gzip archive",
    b"%PDF": "a PDF document",
    b"SQLite format 3": "an SQLite database (such as a GeoPackage)",
    b"\xd0\xcf\x11\xe0": "an old Office document (such as .xls)",
    b"AC10": "a DWG drawing",
    b"{\\rtf": "an RTF document",
}
_PROLOGUE = ((b"<?xml", b"?>"), (b"<!--", b"-->"), (b"999\n", b"\n"), (b"999\r\n", b"\n"))
"""Beginnings and ends of what may stand before the content of XML and DXF."""

_REFERENCES = (
    (re.compile(rb"<VRTDataset"), "a virtual raster (VRT) without its suffix .vrt"),
    (re.compile(rb"<OGRVRT"), "a virtual vector file (OGR VRT), which names other files"),
    (re.compile(rb"<(?:GDAL_WMS|WCS_GDAL|OGRWFS)"), "a description of a service in the network"),
)
_FOREIGN_TEXTS = (
    *_REFERENCES,
    (re.compile(rb"<(?:!doctype )?html", re.I), "an HTML page"),
    (re.compile(rb"<[?!]?[A-Za-z_-]"), "an XML document"),
)


def is_raster(head: bytes) -> bool:
    """Whether the file is certainly a raster: a binary signature or the header of a text grid."""
    if is_ugrid(head):
        return False
    return head.startswith(_RASTER_STARTS) or _GRID_HEADER.match(head) is not None


def is_ugrid(head: bytes) -> bool:
    """Whether the file is a UGRID mesh: netCDF of that convention, or with a mesh's topology.

    In netCDF-4 the convention is told at the head, the topology where the mesh has its variable.
    """
    is_netcdf = head.startswith((b"CDF", b"\x89HDF"))
    return is_netcdf and (b"mesh_topology" in head or b"UGRID-" in head)


def is_ply(head: bytes) -> bool:
    """Whether the file is a PLY mesh."""
    return re.match(rb"ply[ \t]*[\r\n]", head) is not None


def is_obj(head: bytes) -> bool:
    """Whether the file is a Wavefront OBJ mesh: its first statement, and a vertex."""
    lines = (line.strip() for line in head.splitlines())
    first = next((line for line in lines if line and not line.startswith(b"#")), b"")
    return _OBJ_LINE.match(first) is not None and _OBJ_VERTEX.search(head) is not None


def is_stl(head: bytes) -> bool:
    """Whether the file is a text STL mesh; a binary one has no signature."""
    words = head.lower()
    return words.startswith(b"solid") and re.search(rb"\n\s*facet\s+normal\s", words) is not None


_SQLITE = b"SQLite format 3\0"


def is_tin_geopackage(head: bytes) -> bool:
    """Whether the file is a GeoPackage with the table that the record of a TIN is in."""
    return head.startswith(_SQLITE) and b"TABLE tinsmith_tin" in head


def has_tin_among_layers(path: Path) -> bool:
    """Whether a GeoPackage has that table behind layers of others, far from the first bytes."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        if file.read(len(_SQLITE)) != _SQLITE:
            return False
        with mmap(file.fileno(), 0, access=ACCESS_READ) as content:
            return content.find(b"TABLE tinsmith_tin") >= 0


def is_vtk_xml(head: bytes) -> bool:
    """Whether the file is a VTK XML file."""
    return b"<VTKFile" in head[:1024]


def is_gmsh(head: bytes) -> bool:
    """Whether the file is a Gmsh mesh."""
    return head.lstrip().startswith(b"$MeshFormat")


def is_geojson(head: bytes) -> bool:
    """Whether the file is GeoJSON."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") and (
        _GEOJSON_TYPE.search(head) is not None
    )


def find_foreign_kind(head: bytes) -> str | None:
    """Name a kind of file that no format here reads, for a sentence; None if none is recognised."""
    for start, kind in _FOREIGN_STARTS.items():
        if head.startswith(start):
            return kind
    content = skip_prologue(head)
    return next((kind for pattern, kind in _FOREIGN_TEXTS if pattern.match(content)), None)


def find_reference_kind(head: bytes) -> str | None:
    """Name a text that tells where data are instead of holding them; None if it is no such."""
    content = skip_prologue(head)
    return next((kind for pattern, kind in _REFERENCES if pattern.match(content)), None)


def skip_prologue(head: bytes) -> bytes:
    """Skip the byte order mark, the declaration and the comments before the content of a text."""
    rest = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    while found := next((mark for mark in _PROLOGUE if rest.startswith(mark[0])), None):
        _, end, after = rest.partition(found[1])
        if not end:
            return rest
        rest = after.lstrip()
    return rest
