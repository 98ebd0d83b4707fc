"""Look: how a surface is shown, as callers ask for it, and what is allowed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, TypedDict

from ...base.checks import as_flag, is_finite_number, is_whole_number
from ...base.errors import OptionError, choice
from ...base.policies import Tint
from ..drawing.models import parse_exaggeration
from ..relief.light import Light
from .camera import VIEWS, View
from .palette import Palette, choose_palette
from .scene import NORTHWEST

__all__ = ["Look", "LookOptions", "make_look"]

_SIZE = (1600, 1000)
_SIZE_RANGE = (200, 5000)
_DPI_RANGE = (36, 2400)
_COLORS = {"white": "#ffffff", "black": "#000000", "light": "#f4f2ee", "dark": "#171b1f"}
"""Backgrounds that have a name; light and dark are those of a page."""


class LookOptions(TypedDict, total=False):
    """What callers may ask for; :func:`make_look` has the usual values."""

    exaggeration: float | None
    edges: bool
    lines: bool
    size: tuple[int, int] | None
    title: str | None
    view: str
    azimuth: float | None
    tilt: float | None
    sun: tuple[float, float] | None
    background: str | None
    dpi: float | None
    elevations: tuple[float, float] | None
    tint: Tint
    contours: float | None


@dataclass(frozen=True, slots=True)
class Look:
    """How a surface is shown: the options of :func:`tinsmith.preview`, checked."""

    exaggeration: float | None = None
    edges: bool = False
    lines: bool = True
    size: tuple[int, int] = _SIZE
    """Width and height, pixels."""
    title: str = "Terrain surface"
    view: str = "oblique"
    """A key of ``VIEWS``."""
    azimuth: float | None = None
    tilt: float | None = None
    """Azimuth and tilt in place of those of the view."""
    sun: Light = NORTHWEST
    palette: Palette = Palette()  # noqa: RUF009 - colours that are never changed
    dpi: float | None = None
    elevations: tuple[float, float] | None = None
    """The lowest and the highest tint."""
    tint: Tint = "elevation"
    """What colours tell."""
    contours: float | None = None
    """Their interval."""

    @property
    def seen_from(self) -> View:
        """The direction asked for, or that of the view."""
        usual = VIEWS[self.view]
        return View(
            usual.azimuth if self.azimuth is None else self.azimuth,
            usual.height if self.tilt is None else self.tilt,
        )


def make_look(
    *,
    exaggeration: float | None = None,
    edges: bool = False,
    lines: bool = True,
    size: tuple[int, int] | None = None,
    title: str | None = None,
    view: str = "oblique",
    azimuth: float | None = None,
    tilt: float | None = None,
    sun: tuple[float, float] | None = None,
    background: str | None = None,
    dpi: float | None = None,
    elevations: tuple[float, float] | None = None,
    tint: Tint = "elevation",
    contours: float | None = None,
) -> Look:
    """Return options that are checked; None is the usual one.

    Raises
    ------
    OptionError
        If one is outside what is allowed, or two contradict each other.
    """
    if not isinstance(view, str) or view not in VIEWS:
        raise OptionError("view", view, " or ".join(map(repr, VIEWS)))
    if title is not None and not isinstance(title, str):
        raise OptionError("title", title, "text", or_none=True)
    return Look(
        exaggeration=None if exaggeration is None else parse_exaggeration(exaggeration),
        edges=as_flag("edges", edges),
        lines=as_flag("lines", lines),
        size=_parse_size(size),
        title=title or "Terrain surface",
        view=view,
        azimuth=_parse_azimuth(azimuth),
        tilt=_parse_tilt(tilt, view),
        sun=_parse_sun(sun),
        palette=choose_palette(_parse_color(background)),
        dpi=_parse_dpi(dpi),
        elevations=_parse_elevations(elevations),
        tint=choice("tint", tint, Tint),
        contours=_parse_interval(contours),
    )


def _parse_size(size: Any) -> tuple[int, int]:
    if size is None:
        return _SIZE
    low, high = _SIZE_RANGE
    sides = tuple(size) if isinstance(size, tuple | list) else ()
    if len(sides) != 2 or not all(is_whole_number(one) and low <= one <= high for one in sides):
        raise OptionError("size", size, f"width and height, {low} to {high} pixels each")
    return int(sides[0]), int(sides[1])


def _parse_azimuth(azimuth: Any) -> float | None:
    if azimuth is None:
        return None
    if not is_finite_number(azimuth):
        raise OptionError("azimuth", azimuth, "a finite number of degrees clockwise from north")
    return float(azimuth) % 360.0


def _parse_tilt(tilt: Any, view: str) -> float | None:
    if tilt is None:
        return None
    if not is_finite_number(tilt) or not 0.0 <= tilt <= 90.0:
        raise OptionError("tilt", tilt, "0 (from the horizon) to 90 (from above) degrees")
    if VIEWS[view].is_map and tilt != 90.0:
        raise OptionError("tilt", tilt, f"90, or left out: the view '{view}' is from above")
    return float(tilt)


def _parse_sun(sun: Any) -> Light:
    if sun is None:
        return NORTHWEST
    parts = tuple(sun) if isinstance(sun, tuple | list) else ()
    if len(parts) != 2 or not all(map(is_finite_number, parts)) or not 0.0 <= parts[1] <= 90.0:
        raise OptionError(
            "sun",
            sun,
            "azimuth and altitude: degrees clockwise from north, and 0 to 90 above the horizon",
        )
    return Light(float(parts[0]) % 360.0, float(parts[1]))


def _parse_color(color: Any) -> tuple[int, int, int]:
    if color is None:
        return Palette().paper
    text = color.strip().lower() if isinstance(color, str) else ""
    code = _COLORS.get(text, text)
    if not re.fullmatch(r"#[0-9a-f]{6}", code):
        names = ", ".join(_COLORS)
        raise OptionError("background", color, f"{names}, or a colour such as '#e8edf2'")
    return int(code[1:3], 16), int(code[3:5], 16), int(code[5:7], 16)


def _parse_dpi(dpi: Any) -> float | None:
    low, high = _DPI_RANGE
    if dpi is None:
        return None
    if not is_finite_number(dpi) or not low <= dpi <= high:
        raise OptionError("dpi", dpi, f"{low} to {high} dots per inch")
    return float(dpi)


def _parse_elevations(elevations: Any) -> tuple[float, float] | None:
    if elevations is None:
        return None
    ends = tuple(elevations) if isinstance(elevations, tuple | list) else ()
    if len(ends) != 2 or not all(map(is_finite_number, ends)) or not ends[0] < ends[1]:
        raise OptionError("elevations", elevations, "the lowest and the highest, in this order")
    return float(ends[0]), float(ends[1])


def _parse_interval(interval: Any) -> float | None:
    if interval is None:
        return None
    if not is_finite_number(interval) or interval <= 0:
        raise OptionError("contours", interval, "an interval above 0, in the unit of elevations")
    return float(interval)
