"""What callers give, checked on entry: options, tables of coordinates, points."""

from .threads import available_cores

__all__ = ["available_cores"]
