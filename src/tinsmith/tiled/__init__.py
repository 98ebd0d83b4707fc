"""Many files as one surface: read once, triangulated tile by tile, joined to the same product.

:func:`tinsmith.tiles` takes files, :class:`TiledPoints` computes products of them in bounded
memory. The steps: ``reading`` (inputs into ``chunks`` of a ``store``), ``division`` of the plane,
``tasks`` (a tile), ``products``; ``runs`` keeps what is done, ``executors`` and ``workers`` do it.
"""

from .running import RunOptions, Status
from .tiled_points import TiledPoints, tiles

__all__ = ["RunOptions", "Status", "TiledPoints", "tiles"]
