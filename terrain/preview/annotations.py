"""Annotations: what makes a view of terrain a document - title, legend, scale, north."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...tin import Bounds
from ..rounding import choose_ticks, format_number, round_down
from .camera import View, measure_pixels_per_unit, project_ground_axes
from .tints import interpolate_tints

if TYPE_CHECKING:
    from ...crs import Unit
    from .overlay import Color, Overlay

__all__ = ["Caption", "Sheet", "annotate", "scale_bar_length"]

INK: Color = (28, 34, 40)
GREY: Color = (96, 106, 114)
PAPER: Color = (255, 255, 255)

MARGIN = 44.0
_COMPASS_RADIUS = 32.0
_HEADER = 112.0
_FOOTER = 140.0
_BAR_LEFT = MARGIN + 96.0
_BAR_WIDTH = 260.0
_LEGEND_WIDTH = 400.0


@dataclass(frozen=True, slots=True)
class Sheet:
    """The picture's layout, in design pixels from the lower left.

    Attributes
    ----------
    width, height : float
    """

    width: float
    height: float

    @property
    def frame(self) -> Bounds:
        """The part kept for the terrain, clear of all annotations."""
        return Bounds(MARGIN, _FOOTER, self.width - MARGIN, self.height - _HEADER)


@dataclass(frozen=True, slots=True)
class Caption:
    """The words and numbers of the annotations.

    Attributes
    ----------
    title, subtitle : str
    exaggeration : float
    elevations : tuple of float
        Lowest and highest.
    elevation_caption : str
        Their unit, as it stands behind "Elevation"; "" if it is not known.
    unit : Unit
        Of lengths in the scene.
    has_tints : bool
        Whether tints by elevation are seen anywhere.
    """

    title: str
    subtitle: str
    exaggeration: float
    elevations: tuple[float, float]
    elevation_caption: str
    unit: Unit
    has_tints: bool = True


def annotate(overlay: Overlay, sheet: Sheet, caption: Caption, camera: Any) -> None:
    """Draw all annotations for the present camera, in place of earlier ones.

    Parameters
    ----------
    overlay : Overlay
    sheet : Sheet
    caption : Caption
    camera : pyvista.Camera
        In parallel projection.
    """
    overlay.clear()
    _draw_margins(overlay, sheet)
    _draw_title(overlay, sheet, caption)
    _draw_north_arrow(overlay, camera)
    _draw_scale_bar(overlay, caption.unit, measure_pixels_per_unit(camera, sheet.height))
    _draw_notes(overlay, caption.exaggeration, View.of(camera))
    if caption.has_tints:
        _draw_legend(overlay, sheet, caption)


def scale_bar_length(unit: Unit, pixels: float) -> tuple[float, float, str]:
    """Choose the length of the scale bar.

    Parameters
    ----------
    unit : Unit
        Of lengths in the scene.
    pixels : float
        Design pixels for a length of 1.

    Returns
    -------
    length : float
        In ``unit``.
    shown : float
        The number to write for it.
    symbol : str
        The unit to write behind it.
    """
    length = round_down(_BAR_WIDTH / pixels)
    if unit.symbol == "m" and length >= 1000:
        return length, length / 1000, "km"
    return length, length, unit.symbol


def _draw_margins(overlay: Overlay, sheet: Sheet) -> None:
    """Keep the paper behind the words free, however far a user zooms into the terrain."""
    frame = sheet.frame
    overlay.draw_rectangle((0.0, 0.0), (sheet.width, frame.ymin - 8.0), PAPER)
    overlay.draw_rectangle((0.0, frame.ymax + 8.0), (sheet.width, sheet.height - frame.ymax), PAPER)


def _draw_title(overlay: Overlay, sheet: Sheet, caption: Caption) -> None:
    room = sheet.width - 2 * MARGIN
    for words, drop, size, bold, color in (
        (caption.title, 62.0, 30.0, True, INK),
        (caption.subtitle, 92.0, 17.0, False, GREY),
    ):
        fitting = _elide(overlay, words, room, size=size, bold=bold)
        overlay.draw_text((MARGIN, sheet.height - drop), fitting, color, size=size, bold=bold)


def _elide(overlay: Overlay, words: str, room: float, *, size: float, bold: bool) -> str:
    """Cut words that are too long for the room, and show that they are cut."""
    if overlay.measure_text(words, size=size, bold=bold) <= room:
        return words
    while words and overlay.measure_text(words + "...", size=size, bold=bold) > room:
        words = words[:-1]
    return words.rstrip() + "..."


def _draw_north_arrow(overlay: Overlay, camera: Any) -> None:
    """Draw a compass that lies on the ground, foreshortened like the ground itself."""
    axes = project_ground_axes(camera) * _COMPASS_RADIUS
    center = np.array([MARGIN + _COMPASS_RADIUS, 66.0])
    turn = np.linspace(0.0, 2 * np.pi, 49)
    overlay.draw_line(np.column_stack([np.sin(turn), np.cos(turn)]) @ axes + center, GREY)
    needle = np.array([(0.0, 1.25), (-0.42, -0.7), (0.0, -0.4), (0.42, -0.7)]) @ axes + center
    tip, left, notch, right = needle
    overlay.draw_polygon([tip, left, notch], INK)
    overlay.draw_polygon([tip, notch, right], PAPER)
    overlay.draw_line([tip, left, notch, right, tip, notch], INK, width=1.2)
    north = axes[1] / max(float(np.linalg.norm(axes[1])), 1e-9)
    x, y = tip + 12.0 * north
    overlay.draw_text((x, y - 6.0), "N", INK, size=17, bold=True, align="center")


def _draw_scale_bar(overlay: Overlay, unit: Unit, pixels: float) -> None:
    length, shown, symbol = scale_bar_length(unit, pixels)
    left, bottom, height, width = _BAR_LEFT, 62.0, 7.0, length * pixels
    for part, color in enumerate((INK, PAPER, INK, PAPER)):
        overlay.draw_rectangle((left + part * width / 4, bottom), (width / 4, height), color)
    outline = [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    overlay.draw_line(np.add(outline, (left, bottom)), INK, width=1.2)
    for fraction in (0.0, 0.5, 1.0):
        words = format_number(fraction * shown, step=shown / 2) if fraction else "0"
        if fraction == 1.0:
            words = format_number(shown, step=shown)
        place = (left + fraction * width, bottom + 14.0)
        overlay.draw_text(place, words, INK, size=15, align="center")
        if fraction == 1.0:
            half = overlay.measure_text(words, size=15) / 2
            overlay.draw_text((place[0] + half + 5.0, place[1]), symbol, INK, size=15)
    overlay.draw_text((left, 38.0), "true from left to right", GREY, size=14)


def _draw_notes(overlay: Overlay, exaggeration: float, view: View) -> None:
    left = _BAR_LEFT + _BAR_WIDTH + 100.0
    overlay.draw_text((left, 62.0), _describe_exaggeration(exaggeration, view), INK, size=17)
    overlay.draw_text((left, 38.0), view.caption, GREY, size=14)


def _describe_exaggeration(factor: float, view: View) -> str:
    """Say how much heights are exaggerated; from above only the hillshade shows it."""
    what = "Hillshade with vertical" if view.is_map else "Vertical"
    true = " (true to scale)" if factor == 1 else ""
    return f"{what} exaggeration {factor:g}\N{MULTIPLICATION SIGN}{true}"


def _draw_legend(overlay: Overlay, sheet: Sheet, caption: Caption) -> None:
    left, bottom, height = sheet.width - MARGIN - _LEGEND_WIDTH, 62.0, 14.0
    unit = caption.elevation_caption
    name = f"Elevation ({unit})" if unit else "Elevation (unit not known)"
    overlay.draw_text((left, bottom + height + 8.0), name, INK, size=15)
    colors = interpolate_tints(100).tolist()
    step = _LEGEND_WIDTH / len(colors)
    for k, (red, green, blue) in enumerate(colors):
        overlay.draw_rectangle((left + k * step, bottom), (step + 0.5, height), (red, green, blue))
    _draw_legend_ticks(overlay, caption.elevations, (left, bottom))


def _draw_legend_ticks(
    overlay: Overlay, elevations: tuple[float, float], corner: tuple[float, float]
) -> None:
    (low, high), (left, bottom) = elevations, corner
    inner = choose_ticks(low, high, count=5)
    step = (inner[1] - inner[0]) if len(inner) > 1 else max(high - low, 1.0)
    used: list[tuple[float, float]] = []
    ends = [(value, INK) for value in (low, high)]
    for value, color in [*ends, *((value, GREY) for value in inner)]:
        words = format_number(value, step=step / 10 if color == INK else step)
        x = left + _LEGEND_WIDTH * ((value - low) / (high - low) if high > low else 0.5)
        half = overlay.measure_text(words, size=13) / 2 + 6.0
        if any(x - half < stop and start < x + half for start, stop in used):
            continue
        used.append((x - half, x + half))
        overlay.draw_line([(x, bottom), (x, bottom - 5.0)], color, width=1.0)
        overlay.draw_text((x, bottom - 19.0), words, color, size=13, align="center")
