"""The world room: readers, writers and the format registry."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .codes import lines_from_codes
    from .crs import LengthUnit, length_unit, transform_points
    from .errors import CrsError, FormatError, ReadError, WriteError
    from .formats import Format, find_format, known_formats, read, write
    from .vectors import read_lines, read_polygons, read_rings, read_water
    from .vectors_survey import with_lines

# The module that each public name lives in. They are loaded when a name is first used: the
# processes that read files for native libraries start without them.
_NAMES_OF_MODULE = {
    "codes": ("lines_from_codes",),
    "crs": ("LengthUnit", "length_unit", "transform_points"),
    "errors": ("CrsError", "FormatError", "ReadError", "WriteError"),
    "formats": ("Format", "find_format", "known_formats", "read", "write"),
    "vectors": ("read_lines", "read_polygons", "read_rings", "read_water"),
    "vectors_survey": ("with_lines",),
}
_MODULE_OF_NAME = {name: module for module, names in _NAMES_OF_MODULE.items() for name in names}


def __getattr__(name: str) -> Any:
    """Load a module, or a public name from its module, when it is first used."""
    if name in _NAMES_OF_MODULE:
        return import_module(f"{__name__}.{name}")
    if name in _MODULE_OF_NAME:
        return getattr(import_module(f"{__name__}.{_MODULE_OF_NAME[name]}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)


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
