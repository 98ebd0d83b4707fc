"""Strips: a corridor drawn piece by piece, one below the other, in one picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..drawing import format_number
from .actors import fade_edges
from .camera import place_camera
from .corridor import STRIP_GAP
from .scene import add_scene, fit_layout, open_plotter

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import UInt8Array
    from .annotations import Layout
    from .corridor import Strips
    from .scene import Scene, ScenePlotter

_LABEL_SIZE = 13.0
_LABEL_RISE = 7.0


class _Place(NamedTuple):
    """Where a strip stands: its left and upper edge and its height, design pixels."""

    left: float
    top: float
    height: float


def place_strips(strips: Strips, layout: Layout) -> list[_Place]:
    """Return where each strip stands on a layout, the first at the top."""
    frame = layout.frame
    heights = (strips.highs - strips.lows) * strips.scale
    left = frame.xmin + (frame.width - strips.length * strips.scale) / 2
    gap = max((frame.height - float(heights.sum())) / len(heights), STRIP_GAP)
    tops = frame.ymax - gap * np.arange(1, len(heights) + 1) - np.cumsum(heights) + heights
    return [_Place(left, *row) for row in zip(tops.tolist(), heights.tolist(), strict=True)]


def label_strips(drawn: ScenePlotter) -> None:
    """Write above each strip of a picture where along the axis it begins and ends."""
    strips, title_block = drawn.scene.strips, drawn.scene.title_block
    if strips is None:
        return
    layout, _ = fit_layout(tuple(drawn.plotter.window_size))
    unit = f" {title_block.unit.symbol}" if title_block.unit.symbol else ""
    step = 1.0 if strips.length >= 100 else 0.01
    along = [format_number(value - strips.edges[0], step=step) for value in strips.edges]
    for place, start, stop in zip(place_strips(strips, layout), along, along[1:], strict=False):
        words = f"{start} to {stop}{unit}"
        corner = (place.left, place.top + _LABEL_RISE)
        drawn.overlay.draw_text(corner, words, title_block.palette.grey, size=_LABEL_SIZE)


def paste_strips(pixels: UInt8Array, scene: Scene) -> None:
    """Draw the strips of a corridor into a picture that has all but the terrain.

    Of a surface that is no corridor nothing is drawn.
    """
    if scene.strips is None:
        return
    height, width = pixels.shape[:2]
    layout, factor = fit_layout((width, height))
    drawn = _draw_strips(scene, scene.strips, factor)
    for place, strip in zip(place_strips(scene.strips, layout), drawn, strict=True):
        row, column = round(height - factor * place.top), round(factor * place.left)
        room = pixels[row : row + strip.shape[0], column : column + strip.shape[1]]
        room[:] = strip[: room.shape[0], : room.shape[1]]


def _draw_strips(scene: Scene, strips: Strips, factor: float) -> Iterator[UInt8Array]:
    """Draw each strip alone, as large as it is in the picture."""
    scale = factor * strips.scale
    heights = [math.ceil(scale * one) for one in (strips.highs - strips.lows)]
    window = max(math.ceil(scale * strips.length), 1), max(*heights, 1)
    plotter = open_plotter(scene, window, off_screen=True)
    try:
        surfaces, seen = add_scene(plotter, scene, factor)
        for surface in surfaces:
            fade_edges(surface, scene.tin, scene.ground, strips.scale)
        for k, height in enumerate(heights):
            middle = (
                float(strips.edges[k] + strips.edges[k + 1]) / 2,
                float(strips.lows[k] + strips.highs[k]) / 2,
            )
            place_camera(
                plotter.camera, seen, view=scene.view, middle=middle, height=window[1] / scale
            )
            plotter.renderer.ResetCameraClippingRange()
            plotter.render()  # a screenshot alone keeps the picture before
            shot = np.array(plotter.screenshot(return_img=True))
            spare = (window[1] - height) // 2
            yield shot[spare : spare + height]
    finally:
        plotter.close()
