"""Index sheet: the whole surface with the frames of the sheets on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .clipping import clip_paths, join_paths
from .mapping import MATCH_PEN, Map

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .contents import Contents
    from .mapping import Drawn
    from .paper import Drawable
    from .windows import Window

_LEAST, _LARGEST = 1.6, 5.0
"""Of the numbers of sheets, millimetres."""


def draw_index(
    canvas: Drawable,
    window: Window,
    contents: Contents,
    maps: Mapping[int, Window],
    *,
    grid: str,
) -> Drawn:
    """Draw the edge of a surface, its lines, its water, and the frames of sheets by number."""
    drawn = Map(canvas, window, contents).draw_outline(grid=grid)
    rings = [window.to_paper(one.corners) for one in maps.values()]
    closed = [ring[[0, 1, 2, 3, 0]] for ring in rings]
    pen = MATCH_PEN._replace(dashes=(), width=0.25)
    canvas.draw_paths(clip_paths(join_paths(closed), window.frame).parts(), pen, "sheets")
    drawn.kinds.add("sheet")
    for ring, number in zip(rings, maps, strict=True):
        sides = np.hypot(*np.diff(ring[:3], axis=0).T)
        size = float(np.clip(0.4 * sides.min(), _LEAST, _LARGEST))
        canvas.write(
            tuple(ring.mean(axis=0).tolist()),
            str(number),
            size=size,
            color=MATCH_PEN.color,
            across="center",
            up="center_baseline",
            name="sheet-number",
        )
    return drawn
