"""What cannot be computed tile by tile, and why."""

from __future__ import annotations

from ...base.errors import OptionError

_WATER = (
    "water that falls on one tile runs through others, so that each place depends on all of the "
    "surface above it"
)
_SIGHT = "what is seen from a place may be hidden by any part of the surface between"

NOT_LOCAL = {
    "catchments": _WATER,
    "depressions": "a depression is as deep as the lowest way out of it, wherever that leads",
    "flow_accumulation": _WATER,
    "flow_path": "where water runs is known only by following it, from tile to tile",
    "ponds": "a pond is as deep as the lowest way out of it, wherever that leads",
    "ridges_and_valleys": _WATER,
    "line_of_sight": _SIGHT,
    "viewshed": _SIGHT,
    "visible_vertices": _SIGHT,
    "max_edge": (
        "triangles with long edges are removed one after the other from the boundary on, so that "
        "each depends on all between it and the boundary"
    ),
    "smooth": (
        "each line is rounded in what room the lines before it have left, so that each depends on "
        "all others"
    ),
    "simplify": (
        "points are dropped in the order of what they change along the whole line, or over the "
        "whole surface"
    ),
    "extrapolate": "the nearest place of the boundary may lie in any tile",
}
"""Why products and options are not local, by name: the surface is needed as a whole."""


def require_local(name: str) -> None:
    """Refuse a product, or an option of one, that needs the surface as a whole.

    Raises
    ------
    OptionError

    Examples
    --------
    >>> require_local("slope")
    >>> require_local("viewshed")
    Traceback (most recent call last):
    ...
    tinsmith.base.errors.OptionError: ...
    """
    if name in NOT_LOCAL:
        raise OptionError(name, "a surface in tiles", f"a surface in memory: {NOT_LOCAL[name]}")
