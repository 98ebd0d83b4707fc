"""The world room: readers, writers and the format registry."""

from .crs import LengthUnit, length_unit, transform_points
from .errors import CrsError, FormatError, ReadError, WriteError
from .formats import Format, find_format, known_formats, read, write

__all__ = [
    "CrsError",
    "Format",
    "FormatError",
    "LengthUnit",
    "ReadError",
    "WriteError",
    "find_format",
    "known_formats",
    "length_unit",
    "read",
    "transform_points",
    "write",
]
