"""From checked inputs to a triangulated surface: rows merged, lines forced, parts cut away."""

from .assembly import find_ring_groups
from .duplicates import merge_rows
from .inputs import BuildInputs, gather_inputs
from .options import BuildOptions
from .reference import find_crs

__all__ = [
    "BuildInputs",
    "BuildOptions",
    "find_crs",
    "find_ring_groups",
    "gather_inputs",
    "merge_rows",
]
