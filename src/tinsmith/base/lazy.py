"""What is loaded when it is first used: public names, functions behind methods; missing names."""

from __future__ import annotations

import ast
from functools import cache
from importlib import import_module
from importlib.util import find_spec, resolve_name
from typing import TYPE_CHECKING, Any

from .optional import describe_missing
from .sentences import suggest

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_CALLED = {
    **dict.fromkeys(("vertices", "verts", "coords", "coordinates", "xyz", "pts"), "points"),
    **dict.fromkeys(("simplices", "faces", "cells", "tri", "indices"), "triangles"),
    **dict.fromkeys(("xy",), "points[:, :2]"),
    **dict.fromkeys(("x", "eastings"), "points[:, 0]"),
    **dict.fromkeys(("y", "northings"), "points[:, 1]"),
    **dict.fromkeys(("z", "elevations", "heights"), "points[:, 2]"),
    **dict.fromkeys(("n_points", "npoints", "n_vertices", "num_vertices"), "len(tin.points)"),
    **dict.fromkeys(("n_cells", "n_faces", "num_triangles", "n_triangles"), "len(tin)"),
    **dict.fromkeys(("adjacency", "face_adjacency"), "neighbors"),
    **dict.fromkeys(("bbox", "extent", "total_bounds", "get_bbox"), "bounds"),
    **dict.fromkeys(("crs_wkt", "srs", "epsg", "projection"), "crs"),
    **dict.fromkeys(("constraints", "breaklines", "segments"), "lines"),
    **dict.fromkeys(("save", "export", "to_file", "write_obj", "write_ply"), "tinsmith.write"),
    **dict.fromkeys(("to_mesh", "as_pyvista", "to_polydata"), "tinsmith.to_pyvista"),
    **dict.fromkeys(("query", "sample", "locate_z", "interp"), "interpolate"),
    "show": "plot",
}
"""By names of SciPy, triangle, trimesh, PyVista, startinpy and GeoPandas those of this package."""
_CALLED_BY_CLASS = {
    "Raster": {
        **{name: f"grid.{name}" for name in ("transform", "bounds", "spacing", "cell_size")},
        **dict.fromkeys(("affine", "geotransform"), "grid.transform"),
        **dict.fromkeys(("res", "resolution"), "grid.spacing"),
        **dict.fromkeys(("values", "data", "array", "read"), "bands"),
        **dict.fromkeys(("width", "height", "size"), "shape"),
        **dict.fromkeys(("nodatavals",), "nodata"),
        **dict.fromkeys(("rio", "to_dataset"), "to_xarray()"),
        **dict.fromkeys(("save", "to_file", "to_raster"), "tinsmith.write"),
    }
}
"""The same of a raster, by names of rasterio, xarray and rioxarray."""
_FUNCTIONS: dict[str, str] = {}
"""The function behind each method whose work is done by a package above the one of its class."""


def lazy_names(
    package: str, instead: Mapping[str, str] | None = None
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package.

    Its stub, ``__init__.pyi``, is the one list of its public names, for type checkers and for use:
    lines ``from .module import name as name``, or ``from .package import *`` for all names of the
    stub of another package. The modules of the package that are named there can be used as
    attributes, too. No name is that of a module of the package, which would hide it once loaded.
    ``instead`` has modules of names that are loaded from elsewhere than type checkers are told.
    """
    module_of = _read_stub(package) | dict(instead or {})
    modules = {name for name, module in module_of.items() if module == "."}
    names = module_of.keys() - modules
    near = {module_of[name] for name in names if not module_of[name].startswith("..")}
    modules.update(module.split(".")[1] for module in near)

    def load(name: str) -> Any:
        if name in names:
            try:
                return getattr(import_module(module_of[name], package), name)
            except ModuleNotFoundError as error:
                missing = describe_missing(error)
                if missing is None:
                    raise
                raise missing from error
        if name in modules:
            return import_module(f".{name}", package)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return load, lambda: sorted({*names, *modules}), sorted(module_of)


@cache
def _read_stub(package: str) -> dict[str, str]:
    """Return the module of each name in the stub of a package, relative to it."""
    found: dict[str, str] = {}
    spec: Any = find_spec(package)  # the stub lies beside the source, in a folder or an archive
    stub = spec.loader.get_data(f"{spec.origin.rpartition('.')[0]}.pyi")
    for statement in ast.parse(stub).body:
        if not isinstance(statement, ast.ImportFrom):
            continue
        module = "." * statement.level + (statement.module or "")
        for alias in statement.names:
            if alias.name == "*":
                found |= dict.fromkeys(_read_stub(resolve_name(module, package)), module)
            else:
                found[alias.name] = module
    return found


def register_methods(functions: dict[str, str]) -> None:
    """Name the functions that do the work of methods; each is loaded when first called.

    By class and method (``"TIN.plot"``), as ``package.module:name``; it takes the object first.
    """
    _FUNCTIONS.update(functions)


def call_method(method: str, *given: Any, **options: Any) -> Any:
    """Call the function that does the work of a method."""
    module, _, name = _FUNCTIONS[method].partition(":")
    function: Any = getattr(import_module(module), name)
    return function(*given, **options)


def make_html_repr(thing: object) -> str:
    """Return the HTML that an object shows in a notebook."""
    return str(call_method(f"{type(thing).__name__}._repr_html_", thing))


def describe_attribute(kind: type, name: str) -> str:
    """Return a sentence on an attribute that a class does not have: what to use instead.

    Examples
    --------
    >>> class TIN:
    ...     points = None
    >>> describe_attribute(TIN, "vertices")
    "A TIN has no 'vertices': use `points`."
    """
    public = import_module(__package__.partition(".")[0]).__all__
    what = f"A {kind.__name__} has no '{name}'"
    owner = "raster" if kind.__name__ in _CALLED_BY_CLASS else "tin"
    found = _CALLED_BY_CLASS.get(kind.__name__, _CALLED).get(name)
    if found is None and owner == "tin" and name in public and name.islower():
        found = f"tinsmith.{name}"
    if found is not None:
        call = f"({owner}, ...)" if found.startswith("tinsmith.") else ""
        return f"{what}: use `{found}{call}`."
    known = [one for one in dir(kind) if not one.startswith("_")]
    return f"{what}.{suggest(name, known)}"


def raise_missing(owner: Any, name: str) -> None:
    """Raise the AttributeError of an attribute that an object does not have."""
    if name.startswith("_"):  # which libraries ask for, to see what an object is
        raise AttributeError(f"'{type(owner).__name__}' object has no attribute '{name}'")
    raise AttributeError(describe_attribute(type(owner), name))
