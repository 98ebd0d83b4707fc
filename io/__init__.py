"""The world room: readers, writers and the format registry."""

from typing import TYPE_CHECKING

from .._lazy import lazy_names

if TYPE_CHECKING:
    from ..errors import CrsError, FormatError, ReadError, WriteError
    from .codes import lines_from_codes
    from .crs import LengthUnit, length_unit, transform_points
    from .formats import Format, find_format, known_formats, read, write
    from .vectors import read_lines, read_polygons, read_rings, read_water
    from .vectors_survey import with_lines

# The processes that read files for native libraries start without what they do not use.
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        ".codes": ("lines_from_codes",),
        ".crs": ("LengthUnit", "length_unit", "transform_points"),
        "..errors": ("CrsError", "FormatError", "ReadError", "WriteError"),
        ".formats": ("Format", "find_format", "known_formats", "read", "write"),
        ".vectors": ("read_lines", "read_polygons", "read_rings", "read_water"),
        ".vectors_survey": ("with_lines",),
    },
)

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
