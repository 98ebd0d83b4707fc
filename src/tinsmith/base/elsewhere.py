"""Names of other libraries: what a surface calls what is asked of it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .sentences import suggest

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


def describe_missing(kind: type, name: str) -> str:
    """Return a sentence on an attribute that a class does not have: what to use instead.

    Examples
    --------
    >>> class TIN:
    ...     points = None
    >>> describe_missing(TIN, "vertices")
    "A TIN has no 'vertices': use `points`."
    """
    public = import_module(__package__.partition(".")[0]).__all__
    what = f"A {kind.__name__} has no '{name}'"
    found = _CALLED.get(name)
    if found is None and name in public and name.islower():
        found = f"tinsmith.{name}"
    if found is not None:
        call = "(tin, ...)" if found.startswith("tinsmith.") else ""
        return f"{what}: use `{found}{call}`."
    known = [one for one in dir(kind) if not one.startswith("_")]
    return f"{what}.{suggest(name, known)}"


def raise_missing(owner: Any, name: str) -> None:
    """Raise the AttributeError of an attribute that an object does not have."""
    if name.startswith("_"):  # which libraries ask for, to see what an object is
        raise AttributeError(f"'{type(owner).__name__}' object has no attribute '{name}'")
    raise AttributeError(describe_missing(type(owner), name))
