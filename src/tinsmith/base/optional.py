"""Optional libraries: whether they are there, and loaded when first needed."""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from .errors import MissingExtraError

_INCLUDED = (
    *("ezdxf", "laspy", "lazrs", "matplotlib", "numpy", "pandas", "pyogrio", "pyproj", "pyvista"),
    *("rasterio", "shapely"),
)
"""What every ordinary installation has; one without dependencies may lack what it does not use."""

_EXTRA_OF = {
    "distributed": "dask",
    "geopandas": "interop",
    "meshio": "mesh",
    "netCDF4": "mesh",
    "pmtiles": "interop",
    "pyarrow": "interop",
    "trimesh": "interop",
    "xarray": "interop",
}


def load(module: str, purpose: str = "This") -> Any:
    """Return a module of an optional library, or name what brings it in a MissingExtraError.

    ``purpose`` is the subject of the sentence: what needs the library. Figures of
    ``"matplotlib.figure"`` are drawn without a screen and leave no state behind.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise _describe_missing(module.partition(".")[0], purpose) from error


def describe_missing(error: ImportError) -> MissingExtraError | None:
    """Return what to install where a module was not found that comes with this package."""
    library = (error.name or "").partition(".")[0]
    is_ours = isinstance(error, ModuleNotFoundError) and library in _INCLUDED
    return _describe_missing(library, "This") if is_ours else None


def require(library: str, purpose: str) -> None:
    """Raise MissingExtraError if a library is not installed; do not load it."""
    if find_spec(library) is None:
        raise _describe_missing(library, purpose)


def is_installed(extra: str) -> bool:
    """Whether every library that an extra brings is there; none is loaded.

    Examples
    --------
    >>> is_installed("no such extra")
    False
    """
    libraries = [library for library, brought_by in _EXTRA_OF.items() if brought_by == extra]
    return bool(libraries) and all(find_spec(library) is not None for library in libraries)


def _describe_missing(library: str, purpose: str) -> MissingExtraError:
    return MissingExtraError(library, extra=_EXTRA_OF.get(library, ""), purpose=purpose)


def find_loaded(name: str, *needed: str) -> Any:
    """Return a module that is loaded, with the names that are needed of it; else None.

    A module that another thread is importing is listed before it has its names; until then nobody
    has objects of its classes.
    """
    module = sys.modules.get(name)
    is_whole = module is not None and all(hasattr(module, one) for one in needed)
    return module if is_whole else None
