"""Options of previews: how a surface is shown, and what is allowed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypedDict

from ...base.checks import as_flag, as_number, is_finite_number, is_whole_number
from ...base.errors import OptionError, choice
from ...base.policies import Tint
from ..drawing import BACKGROUNDS, Palette, choose_palette, parse_hex
from ..surface import Light
from .actors import NORTHWEST
from .camera import VIEWS, View

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


class PreviewKeywords(TypedDict, total=False):
    """The keywords of :func:`tinsmith.preview` for type checkers: those of PreviewOptions."""

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


@dataclass(frozen=True, slots=True, kw_only=True)
class PreviewOptions:
    """How a surface is shown: the options of :func:`tinsmith.preview`, checked by :meth:`of`."""

    exaggeration: float | None = None
    edges: bool = False
    lines: bool = True
    size: tuple[int, int] = (1600, 1000)
    """Width and height, pixels."""
    title: str = "Terrain surface"
    view: str = "oblique"
    """A key of ``VIEWS``."""
    azimuth: float | None = None
    tilt: float | None = None
    """Azimuth and tilt in place of those of the view."""
    sun: Light = NORTHWEST
    background: str = BACKGROUNDS["white"]
    dpi: float | None = None
    elevations: tuple[float, float] | None = None
    """The lowest and the highest tint."""
    tint: Tint = "elevation"
    """The quantity shown by colours."""
    contours: float | None = None
    """Their interval."""

    @classmethod
    def of(cls, **given: Any) -> PreviewOptions:
        """Return options that are checked; None stands for the default.

        Raises OptionError if one is outside what is allowed, or two contradict each other.
        """
        always: dict[str, Callable[[Any], Any]] = {
            "edges": partial(as_flag, "edges"),
            "lines": partial(as_flag, "lines"),
            "view": _parse_view,
            "tint": lambda tint: choice("tint", tint, Tint),
        }
        checked = {name: parse(given[name]) for name, parse in always.items() if name in given}
        for name, value in given.items():
            if value is not None and name not in always:
                checked[name] = _PARSERS[name](value) if name in _PARSERS else value
        found = cls(**checked)
        if VIEWS[found.view].is_map and found.tilt not in (None, 90.0):
            allowed = f"90, or left out: the view '{found.view}' is from above"
            raise OptionError("tilt", given["tilt"], allowed)
        return found

    @property
    def palette(self) -> Palette:
        """Colours that can be read on the background."""
        return choose_palette(parse_hex(self.background))

    @property
    def seen_from(self) -> View:
        """The direction asked for, or that of the view."""
        usual = VIEWS[self.view]
        return View(
            usual.azimuth if self.azimuth is None else self.azimuth,
            usual.height if self.tilt is None else self.tilt,
        )


def _parse_view(view: Any) -> str:
    if not isinstance(view, str) or view not in VIEWS:
        raise OptionError("view", view, " or ".join(map(repr, VIEWS)))
    return view


def _parse_title(title: Any) -> str:
    if not isinstance(title, str):
        raise OptionError("title", title, "text, or None")
    return title or "Terrain surface"


def _parse_size(size: Any) -> tuple[int, int]:
    low, high = 200, 5000
    sides = tuple(size) if isinstance(size, tuple | list) else ()
    if len(sides) != 2 or not all(is_whole_number(one) and low <= one <= high for one in sides):
        raise OptionError("size", size, f"width and height, {low} to {high} pixels each")
    return int(sides[0]), int(sides[1])


def _parse_azimuth(azimuth: Any) -> float:
    return as_number("azimuth", azimuth, unit="of degrees clockwise from north") % 360.0


def _parse_sun(sun: Any) -> Light:
    parts = tuple(sun) if isinstance(sun, tuple | list) else ()
    if len(parts) != 2 or not all(map(is_finite_number, parts)) or not 0.0 <= parts[1] <= 90.0:
        raise OptionError(
            "sun",
            sun,
            "azimuth and altitude: degrees clockwise from north, and 0 to 90 above the horizon",
        )
    return Light(float(parts[0]) % 360.0, float(parts[1]))


def _parse_background(color: Any) -> str:
    text = color.strip().lower() if isinstance(color, str) else ""
    code = BACKGROUNDS.get(text, text)
    if not re.fullmatch(r"#[0-9a-f]{6}", code):
        names = ", ".join(BACKGROUNDS)
        raise OptionError("background", color, f"{names}, or a colour such as '#e8edf2'")
    return code


def _parse_elevations(elevations: Any) -> tuple[float, float]:
    ends = tuple(elevations) if isinstance(elevations, tuple | list) else ()
    if len(ends) != 2 or not all(map(is_finite_number, ends)) or not ends[0] < ends[1]:
        raise OptionError("elevations", elevations, "the lowest and the highest, in this order")
    return float(ends[0]), float(ends[1])


_PARSERS: Mapping[str, Callable[[Any], Any]] = {
    "exaggeration": lambda value: as_number("exaggeration", value, above=0),
    "size": _parse_size,
    "title": _parse_title,
    "azimuth": _parse_azimuth,
    "tilt": lambda value: as_number(
        "tilt", value, "an angle", least=0, most=90, unit="degrees above the horizon"
    ),
    "sun": _parse_sun,
    "background": _parse_background,
    "dpi": lambda value: as_number(
        "dpi", value, "a number", least=36, most=2400, unit="dots per inch"
    ),
    "elevations": _parse_elevations,
    "contours": lambda value: as_number(
        "contours", value, "an interval", above=0, unit="in the unit of elevations"
    ),
}
