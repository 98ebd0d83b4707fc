"""Annotations: what makes a view of terrain a document - title, legend, scale, north."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...tin import Bounds
from ..drawing import NORTH_ARROW, Palette, choose_ticks, format_number, make_scale_bar
from ..surface import NORTHWEST
from .camera import View, measure_pixels_per_unit, name_direction, project_ground_axes
from .overlay import fit_title, shorten

if TYPE_CHECKING:
    from ...base.crs import Unit
    from ..drawing import Color, Legend
    from ..surface import Light
    from .overlay import Overlay

MARGIN = 44.0
_COMPASS_RADIUS = 32.0
_HEADER = 112.0
_FOOTER = 140.0
_BAR_LEFT = MARGIN + 112.0
BAR_WIDTH = 260.0
_NOTES_LEFT = MARGIN + 456.0
_LEGEND_WIDTH = 400.0
_LEAST_FORESHORTENING = 0.05
"""Length of an axis of the ground in the picture, for 1, from which on it has a direction."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The picture's layout, in design pixels from the lower left."""

    width: float
    height: float

    @property
    def frame(self) -> Bounds:
        """The part kept for the terrain, clear of all annotations."""
        return Bounds(MARGIN, _FOOTER, self.width - MARGIN, self.height - _HEADER)


@dataclass(frozen=True, slots=True)
class TitleBlock:
    """The words and numbers of the annotations."""

    title: str
    subtitle: str
    exaggeration: float
    legend: Legend | None
    """Of the colours; None where they tell nothing."""
    unit: Unit
    """Of lengths in the scene."""
    sun: Light = NORTHWEST
    """Where the light comes from."""
    warning: str = ""
    """What a reader must know of the elevations; "" for nothing."""
    palette: Palette = Palette()  # noqa: RUF009 - colours that are never changed


def annotate(overlay: Overlay, layout: Layout, title_block: TitleBlock, camera: Any) -> None:
    """Draw all annotations for the present camera, in place of earlier ones.

    The camera is one in parallel projection.
    """
    overlay.clear()
    palette = title_block.palette
    # The paper behind the words stays free, however far a user zooms into the terrain.
    frame, top = layout.frame, layout.height - layout.frame.ymax
    overlay.draw_rectangle((0.0, 0.0), (layout.width, frame.ymin - 8.0), palette.paper)
    overlay.draw_rectangle((0.0, frame.ymax + 8.0), (layout.width, top), palette.paper)
    _draw_title(overlay, layout, title_block)
    _draw_north_arrow(overlay, camera, palette)
    pixels = measure_pixels_per_unit(camera, layout.height)
    _draw_scale_bar(overlay, title_block.unit, pixels, palette)
    _draw_notes(overlay, title_block, View.of(camera))
    _draw_legend(overlay, layout, title_block)


def _draw_title(overlay: Overlay, layout: Layout, title_block: TitleBlock) -> None:
    room, palette = layout.width - 2 * MARGIN, title_block.palette
    title = fit_title(overlay, title_block.title, room)
    for words, drop in zip(title.lines, title.drops, strict=True):
        place = (MARGIN, layout.height - drop)
        overlay.draw_text(place, words, palette.ink, size=title.size, bold=True)
    words = shorten(overlay, title_block.subtitle, room, size=17.0)
    place = (MARGIN, layout.height - title.next_drop)
    overlay.draw_text(place, words, palette.grey, size=17.0)


def _draw_north_arrow(overlay: Overlay, camera: Any, palette: Palette) -> None:
    """Draw a compass that lies on the ground, foreshortened like the ground itself."""
    ink, grey, paper, _ = palette
    axes = project_ground_axes(camera) * _COMPASS_RADIUS
    center = np.array([MARGIN + _COMPASS_RADIUS, 66.0])
    turn = np.linspace(0.0, 2 * np.pi, 49)
    overlay.draw_line(np.column_stack([np.sin(turn), np.cos(turn)]) @ axes + center, grey)
    tip, left, notch, right = NORTH_ARROW @ axes + center
    overlay.draw_polygon([tip, left, notch], ink)
    overlay.draw_polygon([tip, notch, right], paper)
    overlay.draw_line([tip, left, notch, right, tip, notch], ink, width=1.2)
    length = float(np.linalg.norm(axes[1]))
    is_seen = length > _LEAST_FORESHORTENING * _COMPASS_RADIUS
    x, y = tip + 12.0 * (axes[1] / length if is_seen else np.array([0.0, 1.0]))
    overlay.draw_text((x, y - 6.0), "N", ink, size=17, bold=True, align="center")


def _draw_scale_bar(overlay: Overlay, unit: Unit, pixels: float, palette: Palette) -> None:
    ink, grey, paper, _ = palette
    bar = make_scale_bar(unit, BAR_WIDTH / pixels)
    left, bottom, height, width = _BAR_LEFT, 62.0, 7.0, bar.length * pixels
    for part, color in enumerate((ink, paper, ink, paper)):
        overlay.draw_rectangle((left + part * width / 4, bottom), (width / 4, height), color)
    outline = [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    overlay.draw_line(np.add(outline, (left, bottom)), ink, width=1.2)
    for share, words in bar.labels:
        place = (left + share * width, bottom + 14.0)
        overlay.draw_text(place, words, ink, size=15, align="center")
    beside = place[0] + overlay.measure_text(words, size=15) / 2 + 5.0
    overlay.draw_text((beside, place[1]), bar.symbol, ink, size=15)
    overlay.draw_text((left, 38.0), "true from left to right", grey, size=14)


def _draw_notes(overlay: Overlay, title_block: TitleBlock, view: View) -> None:
    left, palette = _NOTES_LEFT, title_block.palette
    # From above only the hillshade shows it.
    what = "Hillshade with vertical" if view.is_map else "Vertical"
    true = " (true to scale)" if title_block.exaggeration == 1 else ""
    words = f"{what} exaggeration {title_block.exaggeration:g}\N{MULTIPLICATION SIGN}{true}"
    overlay.draw_text((left, 84.0), words, palette.ink, size=17)
    overlay.draw_text((left, 61.0), view.caption, palette.grey, size=14)
    overlay.draw_text((left, 38.0), _describe_light(title_block.sun), palette.grey, size=14)


def _describe_light(sun: Light) -> str:
    """Say where the light comes from, as the cartographer does.

    Examples
    --------
    >>> from ..surface.normals import Light
    >>> _describe_light(Light(250.0, 30.0))
    'Light from the west-southwest, 30° high'
    """
    if sun.altitude > 89.5:
        return "Light from straight above"
    return f"Light from the {name_direction(sun.azimuth)}, {sun.altitude:.3g}° high"


def _draw_legend(overlay: Overlay, layout: Layout, title_block: TitleBlock) -> None:
    left, bottom, height = layout.width - MARGIN - _LEGEND_WIDTH, 62.0, 14.0
    palette = title_block.palette
    if title_block.warning:
        words = shorten(overlay, title_block.warning, _LEGEND_WIDTH, size=14)
        overlay.draw_text((left, bottom + height + 31.0), words, palette.warning, size=14)
    legend = title_block.legend
    if legend is None:
        return
    overlay.draw_text((left, bottom + height + 8.0), legend.name, palette.ink, size=15)
    overlay.draw_scale((left, bottom), (_LEGEND_WIDTH, height), legend.colors)
    if not legend.ticks:
        _draw_legend_ticks(overlay, legend.ends, (left, bottom), palette)
        return
    low, high = legend.ends
    for value, words in legend.ticks:
        x = left + _LEGEND_WIDTH * (value - low) / (high - low)
        _draw_legend_tick(overlay, words, (x, bottom), palette.ink)


def _draw_legend_tick(
    overlay: Overlay, words: str, place: tuple[float, float], color: Color
) -> None:
    x, bottom = place
    overlay.draw_line([(x, bottom), (x, bottom - 5.0)], color, width=1.0)
    overlay.draw_text((x, bottom - 19.0), words, color, size=13, align="center")


def _draw_legend_ticks(
    overlay: Overlay,
    elevations: tuple[float, float],
    corner: tuple[float, float],
    palette: Palette,
) -> None:
    ink, grey = palette.ink, palette.grey
    (low, high), (left, bottom) = elevations, corner
    inner = choose_ticks(low, high, count=5)
    step = (inner[1] - inner[0]) if len(inner) > 1 else max(high - low, 1.0)
    used: list[tuple[float, float]] = []
    ends = [(value, ink) for value in (low, high)]
    for value, color in [*ends, *((value, grey) for value in inner)]:
        words = format_number(value, step=step / 10 if color == ink else step)
        x = left + _LEGEND_WIDTH * ((value - low) / (high - low) if high > low else 0.5)
        half = overlay.measure_text(words, size=13) / 2 + 6.0
        if any(x - half < stop and start < x + half for start, stop in used):
            continue
        used.append((x - half, x + half))
        _draw_legend_tick(overlay, words, (x, bottom), color)
