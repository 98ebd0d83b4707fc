"""What shows the formats of vector layers."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..registry import skip_prologue

if TYPE_CHECKING:
    from pathlib import Path

_APPLICATIONS = (b"GPKG", b"GP10", b"GP11")
"""Application ids of GeoPackages, 68 bytes from the start of an SQLite file."""

_XML = re.compile(rb"<(?:kml|gpx|JCSDataFile|(?:\w+:)?FeatureCollection)[\s>]")
_GMT = b"# @VGMT1.0"


def is_geopackage(head: bytes) -> bool:
    """Whether the file is a GeoPackage."""
    return head.startswith(b"SQLite format 3\0") and head[68:72] in _APPLICATIONS


def is_shapefile(head: bytes) -> bool:
    """Whether the file is the main part of a shapefile."""
    return head.startswith(b"\0\0\x27\x0a") and head[28:32] == b"\xe8\x03\0\0"


def is_flatgeobuf(head: bytes) -> bool:
    """Whether the file is a FlatGeobuf."""
    return head[:3] == b"fgb" and head[4:7] == b"fgb"


def is_parquet(head: bytes) -> bool:
    """Whether the file is Parquet."""
    return head.startswith(b"PAR1")


def is_geojson_sequence(head: bytes) -> bool:
    """Whether the file is a sequence of GeoJSON texts with the separators of RFC 8142."""
    return head.startswith(b"\x1e") and head[1:].lstrip().startswith(b"{")


def is_vector_text(head: bytes) -> bool:
    """Whether the file is KML, GPX, GML, JML, or vectors of GMT, whose rows are no table."""
    return head.startswith(_GMT) or _XML.match(skip_prologue(head)) is not None


def is_geodatabase(folder: Path) -> bool:
    """Whether a folder is a file geodatabase of Esri."""
    return folder.suffix.lower() == ".gdb" and (folder / "gdb").is_file()
