"""tinsmith: exact terrain surfaces (TINs) from elevation points.

>>> import tinsmith as ts
>>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
>>> tin.interpolate([[2.0, 1.0]]).round(3)
array([6.5])
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import io, terrain, tin
    from .crs import CRS, Unit
    from .io import CrsError, FormatError, ReadError, WriteError, read, write
    from .terrain import OptionError, RenderError
    from .tin import (
        TIN,
        Bounds,
        Breakline,
        CheckError,
        CheckResult,
        Grid,
        Lines,
        LinesError,
        MissingExtraError,
        PointsError,
        Report,
        Survey,
        TinsmithError,
        Water,
        check,
        triangulate,
    )

# The room that each public name lives in; rooms are loaded when a name is first used.
_NAMES_OF_ROOM = {
    "crs": ("CRS", "Unit"),
    "io": ("CrsError", "FormatError", "ReadError", "WriteError", "read", "write"),
    "terrain": ("OptionError", "RenderError"),
    "tin": (
        "TIN",
        "Bounds",
        "Breakline",
        "CheckError",
        "CheckResult",
        "Grid",
        "Lines",
        "LinesError",
        "MissingExtraError",
        "PointsError",
        "Report",
        "Survey",
        "TinsmithError",
        "Water",
        "check",
        "triangulate",
    ),
}
_ROOM_OF_NAME = {name: room for room, names in _NAMES_OF_ROOM.items() for name in names}

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Load a room, or a public name from its room, when it is first used."""
    if name in _NAMES_OF_ROOM:
        return import_module(f"{__name__}.{name}")
    if name in _ROOM_OF_NAME:
        return getattr(import_module(f"{__name__}.{_ROOM_OF_NAME[name]}"), name)
    raise AttributeError(f"module 'tinsmith' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "CRS",
    "TIN",
    "Bounds",
    "Breakline",
    "CheckError",
    "CheckResult",
    "CrsError",
    "FormatError",
    "Grid",
    "Lines",
    "LinesError",
    "MissingExtraError",
    "OptionError",
    "PointsError",
    "ReadError",
    "RenderError",
    "Report",
    "Survey",
    "TinsmithError",
    "Unit",
    "Water",
    "WriteError",
    "__version__",
    "check",
    "io",
    "read",
    "terrain",
    "tin",
    "triangulate",
    "write",
]
