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
    from .tin import (
        TIN,
        Bounds,
        Grid,
        MissingExtraError,
        PointsError,
        Report,
        Survey,
        TinsmithError,
        triangulate,
    )

_HOME = {
    "TIN": "tin",
    "Bounds": "tin",
    "Grid": "tin",
    "MissingExtraError": "tin",
    "PointsError": "tin",
    "Report": "tin",
    "Survey": "tin",
    "TinsmithError": "tin",
    "triangulate": "tin",
}
_ROOMS = ("io", "terrain", "tin")

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Load a public name from its room when it is first used."""
    if name in _ROOMS:
        return import_module(f"{__name__}.{name}")
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module 'tinsmith' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "TIN",
    "Bounds",
    "Grid",
    "MissingExtraError",
    "PointsError",
    "Report",
    "Survey",
    "TinsmithError",
    "__version__",
    "io",
    "terrain",
    "tin",
    "triangulate",
]
