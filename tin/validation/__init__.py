"""What callers give, checked on entry: options, tables of coordinates, points."""

from .points import as_places, as_points, as_xy
from .threads import available_cores, thread_count

__all__ = ["as_places", "as_points", "as_xy", "available_cores", "thread_count"]
