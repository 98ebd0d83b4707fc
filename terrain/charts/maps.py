"""Maps: what pictures of a surface in plan share: their frame, light, and paths of polygons."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.georeference import find_ground, label_axes
from ..drawing import choose_ticks
from ..gridding import hillshade
from .figures import INK, color_frame, start_figure, write_title

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.georeference import Ground
    from ...base.results import Features, Raster
    from ...tin import TIN

PIXELS = 1400
"""Of shading, along the longer side."""

_WIDTH = 9.0
"""Of the picture, inches."""
_LEFT, _TOP, _BOTTOM, _EDGE = 1.0, 0.58, 0.72, 0.25
"""Inches beside the map: for northings, the title, eastings with the CRS, and nothing."""
_FIRST_LINE, _NEXT_LINE = 0.12, 0.18
"""Inches above the map, besides, for lines of a caption."""
_LEAST, _MOST = 0.3, 1.5
"""How tall a map is by its width."""
_SHADES = (1, 255)
VEIL = 0.72
"""Opacity of polygons on a hillshade."""


@dataclass(frozen=True, slots=True, eq=False)
class Map:
    """A figure with axes that are true to scale."""

    figure: Any
    """``matplotlib.figure.Figure``."""
    axes: Any
    """``matplotlib.axes.Axes``."""
    ground: Ground
    """How the coordinates are measured."""
    beside: tuple[float, float, float, float]
    """Left, bottom, width and height of the room on the right of the map, shares of the figure."""

    def write_caption(self, caption: str, *, size: int) -> None:
        """Write what the map shows in a line between title and map."""
        self.axes.set_title(caption, loc="left", fontsize=size, color=INK, parse_math=False)


def start_map(
    tin: TIN,
    title: str,
    *,
    purpose: str,
    pad: float = 0.02,
    beside: float = 0.0,
    caption_lines: int = 0,
) -> Map:
    """Return a figure as tall as the map asks for, with a title and labelled axes.

    ``purpose`` is what matplotlib is needed for; ``pad`` the ground around the TIN, as a share of
    its extent; ``beside`` inches on the right of the map, for a scale or a legend; between title
    and map are ``caption_lines``.
    """
    ground, bounds = find_ground(tin), tin.bounds
    east, north, _ = ground.scale
    around = pad * max(bounds.width, bounds.height)
    across, up = bounds.width + 2 * around, bounds.height + 2 * around
    tall = float(np.clip(up * north / (across * east), _LEAST, _MOST))
    top = _TOP + (_FIRST_LINE + _NEXT_LINE * (caption_lines - 1) if caption_lines else 0.0)
    inner = _WIDTH - _LEFT - beside - _EDGE
    height = inner * tall + top + _BOTTOM
    figure = start_figure(purpose, _WIDTH, height)
    box = (_LEFT / _WIDTH, _BOTTOM / height, inner / _WIDTH, inner * tall / height)
    axes = figure.add_axes(box)
    axes.set_aspect(north / east, anchor="NW")
    axes.set_xlim(bounds.xmin - around, bounds.xmax + around)
    axes.set_ylim(bounds.ymin - around, bounds.ymax + around)
    write_title(figure, title, left=_LEFT)
    _label_axes(axes, tin, ground)
    right = (box[0] + box[2] + 0.15 / _WIDTH, box[1], (beside - 0.15) / _WIDTH, box[3])
    return Map(figure, axes, ground, right)


def _label_axes(axes: Any, tin: TIN, ground: Ground) -> None:
    symbol = "" if tin.crs is None else tin.crs.horizontal_unit.symbol
    unit = f", {symbol}" if symbol else ""
    across, up = label_axes(tin.crs)
    axes.set_xlabel(f"{across.name}{unit}\n{ground.crs_name}", color=INK, parse_math=False)
    axes.set_ylabel(f"{up.name}{unit}", color=INK)
    axes.ticklabel_format(style="plain", useOffset=False)
    axes.set_xticks(choose_ticks(*axes.get_xlim(), count=5))
    axes.set_yticks(choose_ticks(*axes.get_ylim(), count=5))
    for side, label in ((axes.xaxis, across), (axes.yaxis, up)):
        if label.sign < 0:
            side.set_major_formatter(_write_negated)
    axes.tick_params(labelsize=8)
    color_frame(axes)


def _write_negated(value: float, _: Any) -> str:
    """Write the coordinate of an axis that grows to the west or south."""
    return f"{-value + 0.0:.12g}"


def shade_for_map(tin: TIN, *, smooth: bool = True) -> Raster:
    """Return the hillshade of a TIN in as many cells as a map shows."""
    bounds = tin.bounds
    return hillshade(tin, spacing=max(bounds.width, bounds.height) / PIXELS, smooth=smooth)


def draw_shade(axes: Any, shade: Raster, *, limits: tuple[float, float] = _SHADES) -> None:
    """Draw a hillshade; ``limits`` are what is black and what is white."""
    how = {"cmap": "gray", "interpolation": "bilinear", "zorder": 0}
    draw_cells(axes, shade, limits=limits, **how)


def draw_cells(axes: Any, raster: Raster, *, limits: tuple[float, float], **how: Any) -> Any:
    """Draw the first band of a raster, between two values; what has none stays clear."""
    bounds, band = raster.grid.bounds, next(iter(raster.bands.values()))[:, :]
    view = axes.get_xlim(), axes.get_ylim()
    image = axes.imshow(
        np.ma.masked_array(band, np.isnan(band) | (band == raster.nodata)),
        extent=(bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax),
        vmin=limits[0],
        vmax=limits[1],
        aspect=axes.get_aspect(),
        **how,
    )
    axes.set_xlim(view[0])  # images bring limits of their own
    axes.set_ylim(view[1])
    return image


def draw_scale(drawn: Map, mapped: Any, name: str, **how: Any) -> None:
    """Draw a scale of colours on the right of the map, with the unit of elevations."""
    left, low, width, height = drawn.beside
    inner = drawn.figure.add_axes((left, low + 0.1 * height, 0.22 * width, 0.8 * height))
    bar = drawn.figure.colorbar(mapped, cax=inner, spacing="proportional", **how)
    unit = drawn.ground.elevation_caption
    bar.set_label(f"{name}, {unit}" if unit else name, color=INK)
    bar.ax.tick_params(colors=INK, labelsize=8)


def draw_polygons(axes: Any, features: Features, colors: Iterable[Any], purpose: str) -> None:
    """Fill each feature of polygons with a colour, through which the light is seen."""
    patches = optional.load("matplotlib.patches", purpose)
    how = {"edgecolor": "none", "alpha": VEIL, "zorder": 1}
    for path, color in zip(_find_paths(features, purpose), colors, strict=True):
        axes.add_patch(patches.PathPatch(path, facecolor=color, **how))


def _find_paths(features: Features, purpose: str) -> list[Any]:
    """Return one path of matplotlib for each feature of polygons, of all its rings."""
    path = optional.load("matplotlib.path", purpose).Path
    rings, polygons, *parts = features.offsets
    made = []
    for first, last in pairwise(parts[0] if parts else np.arange(len(polygons))):
        begin, end = rings[polygons[first]], rings[polygons[last]]
        codes = np.full(end - begin, path.LINETO, path.code_type)
        starts = rings[polygons[first] : polygons[last] + 1] - begin
        codes[starts[:-1]] = path.MOVETO
        codes[starts[1:] - 1] = path.CLOSEPOLY
        made.append(path(features.coordinates[begin:end, :2], codes))
    return made
