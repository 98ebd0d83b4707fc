"""The world room: readers, writers and the format registry."""

from .codes import lines_from_codes
from .crs import LengthUnit, length_unit, transform_points
from .errors import CrsError, FormatError, ReadError, WriteError
from .formats import Format, find_format, known_formats, read, write
from .vectors import read_lines, read_polygons, read_rings, read_water
from .vectors_survey import with_lines

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
    "lines_from_codes",
    "read",
    "read_lines",
    "read_polygons",
    "read_rings",
    "read_water",
    "transform_points",
    "with_lines",
    "write",
]
