"""DXF: sheets side by side in the model space of a drawing, true to scale in the CRS's own unit."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.atomic import replacing
from ....base.crs import FOOT, METRE, US_SURVEY_FOOT
from ...drawing import fixed_dxf_dates, set_paper
from .canvas import HATCH_SPACING, PLAIN
from .lettering import CAPITAL

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path
    from typing import Unpack

    from ....base.arrays import AnyArray, Float64Array
    from ....base.crs import Unit
    from ....tin import Bounds
    from .canvas import Drawable, Pen, TextStyle

_WEIGHTS = np.array([13, 18, 25, 35, 50, 70, 100])
"""Widths of lines that drawings have, hundredths of a millimetre."""
_CODES = {METRE: 6, FOOT: 2, US_SURVEY_FOOT: 21}
"""Units of ``$INSUNITS``."""
_ODD = '<>/\\":;?*|=`,'
_LONGEST = 100
_STYLE = "SHEETS"
_SPACE = 20.0
"""Millimetres between sheets."""
_WHITE = "#ffffff"
_GREY, _HALF = 8, 128
"""A number that all programs show grey, and how light a grey is from where on it has that."""
_FOREGROUND = 7
"""The number that is black on white windows, and white on black ones."""


class Model(NamedTuple):
    """How sheets lie in the model space of a drawing."""

    unit: Unit
    mm_per_unit: float
    """Length of a unit on paper."""
    layers: Mapping[str, str]
    """Names of layers by those of what is drawn; what is in none of them is on the layer of ""."""
    properties: Mapping[str, str]
    origin: tuple[float, float] = (0.0, 0.0)
    """Coordinates of the lower left corner of the first sheet."""


def write_drawing(
    path: Path,
    drawers: Sequence[Callable[[Drawable], None]],
    size: tuple[float, float],
    model: Model,
) -> None:
    """Write sheets of a size in millimetres, each drawn by a function, from left to right."""
    ezdxf = optional.load("ezdxf", "Sheets as a drawing")
    with fixed_dxf_dates():
        document = ezdxf.new("R2010")
        document.header["$INSUNITS"] = _CODES.get(model.unit, 0)
        document.header["$MEASUREMENT"] = int(model.unit not in (FOOT, US_SURVEY_FOOT))
        step = size[0] + _SPACE
        paper = (len(drawers) * step - _SPACE, size[1])
        set_paper(document, paper, model.origin, model.mm_per_unit, model.unit)
        document.styles.add(_STYLE, font="arial.ttf")
        for name, value in model.properties.items():
            document.header.custom_vars.append(name, value)
        for number, draw in enumerate(drawers):
            draw(DxfCanvas(document, number * step, model))
        zoom = optional.load("ezdxf.zoom", "Sheets as a drawing")
        zoom.extents(document.modelspace())
        stream = io.StringIO(newline="\n")
        document.write(stream)
    with replacing(path) as file:
        file.write(stream.getvalue().replace("\r\n", "\n").encode("utf-8", "replace"))


def name_layers(names: Sequence[str], taken: Sequence[str]) -> list[str]:
    """Return a layer for each name: without the letters that DXF refuses, and none of them twice.

    Examples
    --------
    >>> name_layers(["ground", "Ground", "a/b", "GRID"], ["GRID"])
    ['ground', 'Ground_2', 'a_b', 'GRID_2']
    """
    known = {one.casefold() for one in taken}
    layers = []
    for name in names:
        plain = "".join("_" if one in _ODD or not one.isprintable() else one for one in name)
        plain = plain.strip()[:_LONGEST] or "_"
        chosen, number = plain, 1
        while chosen.casefold() in known:
            number += 1
            chosen = f"{plain}_{number}"
        known.add(chosen.casefold())
        layers.append(chosen)
    return layers


class DxfCanvas:
    """A sheet in the model space of a drawing."""

    def __init__(self, document: Any, left: float, model: Model) -> None:
        self._document = document
        self._space = document.modelspace()
        self._left = left
        self._origin = np.array(model.origin)
        self._factor = 1.0 / model.mm_per_unit
        self._layers = model.layers

    def draw_paths(
        self,
        parts: Sequence[Float64Array],
        pen: Pen,
        name: str,
        heights: Sequence[float] | None = None,
    ) -> None:
        """Draw polylines, each of one height, on the layer of what they are."""
        how = self._style(name, pen.color)
        how["lineweight"] = int(_WEIGHTS[np.abs(_WEIGHTS - 100.0 * pen.width).argmin()])
        if pen.dashes:
            how["linetype"] = self._find_linetype(pen.dashes)
        levels = [0.0] * len(parts) if heights is None else heights
        for part, level in zip(parts, levels, strict=True):
            given = how | {"elevation": float(level)} if level else how
            self._space.add_lwpolyline(self._place(part).tolist(), dxfattribs=given)

    def fill(self, rings: Sequence[Float64Array], color: str, name: str) -> None:
        """Fill the area within rings; white is what a drawing has without."""
        if color in (_WHITE, "white"):
            return
        hatch = self._space.add_hatch(dxfattribs=self._style(name, color))
        for ring in rings:
            hatch.paths.add_polyline_path(self._place(ring[:-1]).tolist(), is_closed=True)

    def hatch(self, ring: Float64Array, pen: Pen, angle: float, name: str) -> None:
        """Add a hatch of parallel lines."""
        hatch = self._space.add_hatch(dxfattribs=self._style(name, pen.color))
        step = HATCH_SPACING * self._factor
        turned = np.radians(angle)
        offset = (-step * float(np.sin(turned)), step * float(np.cos(turned)))
        hatch.set_pattern_definition([[angle, (0.0, 0.0), offset, []]], factor=1.0)
        hatch.dxf.hatch_style = 0
        hatch.dxf.pattern_name = name.upper()
        hatch.paths.add_polyline_path(self._place(ring[:-1]).tolist(), is_closed=True)

    def write(
        self, place: tuple[float, float], text: str, *, size: float, **how: Unpack[TextStyle]
    ) -> None:
        """Write a text on one line; ``size`` is that of its letters in millimetres."""
        style = PLAIN | how
        given = self._style(style["name"], style["color"])
        given |= {"style": _STYLE, "rotation": style["rotation"]}
        made = self._space.add_text(text, height=CAPITAL * size * self._factor, dxfattribs=given)
        heights = {"center_baseline": "MIDDLE", "center": "MIDDLE", "top": "TOP"}
        enums = optional.load("ezdxf.enums", "Sheets as a drawing")
        row, across = heights.get(style["up"], ""), style["across"].upper()
        word = f"{row}_{across}" if row else across
        at = self._place(np.array([place], np.float64))[0].tolist()
        made.set_placement(at, align=enums.TextEntityAlignment[word])

    def draw_picture(self, _box: Bounds, _picture: AnyArray) -> bool:
        """Draw none: a drawing would need the picture's file beside it."""
        return False

    def _place(self, mm: Float64Array) -> Float64Array:
        placed: Float64Array = self._origin + self._factor * (
            np.asarray(mm, np.float64) + np.array([self._left, 0.0])
        )
        return placed

    def _style(self, name: str, color: str) -> dict[str, Any]:
        layer = self._layers.get(name, self._layers[""])
        chosen = _find_color(color)
        if layer not in self._document.layers:
            self._document.layers.add(layer).update_dxf_attribs(chosen)
        return {"layer": layer, **chosen}

    def _find_linetype(self, dashes: tuple[float, ...]) -> str:
        name = "DASHES_" + "_".join(f"{10 * one:.0f}" for one in dashes)
        if name not in self._document.linetypes:
            lengths = [
                one * self._factor * (-1.0 if number % 2 else 1.0)
                for number, one in enumerate(dashes)
            ]
            pattern = [sum(map(abs, lengths)), *lengths]
            self._document.linetypes.add(name, pattern, description="dashes of sheets")
        return name


def _find_color(color: str) -> dict[str, int]:
    """Return the attribute of a colour; ink and greys are seen on windows of any colour."""
    value = int(color[1:], 16)
    channels = value.to_bytes(3, "big")
    if min(channels) < max(channels):
        return {"true_color": value}
    return {"color": _FOREGROUND if channels[0] < _HALF else _GREY}
