"""Options of previews: how a surface is shown, and what is allowed."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, TypedDict

from ...base.checks import as_flag, as_number, is_finite_number, is_whole_number
from ...base.errors import OptionError, choice
from ...base.policies import Tint
from ..drawing import BACKGROUNDS, UNTITLED, Palette, choose_palette, parse_hex, parse_title
from ..surface import NORTHWEST, Light
from .camera import VIEWS, View

if TYPE_CHECKING:
    from collections.abc import Callable


class PreviewKeywords(TypedDict, total=False):
    """The keywords of :func:`tinsmith.preview` for type checkers: fields of PreviewOptions."""

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


def _parse_size(option: str, size: Any) -> tuple[int, int]:
    low, high = 200, 5000
    sides = tuple(size) if isinstance(size, tuple | list) else ()
    if len(sides) != 2 or not all(is_whole_number(one) and low <= one <= high for one in sides):
        raise OptionError(option, size, f"width and height, {low} to {high} pixels each")
    return int(sides[0]), int(sides[1])


def _parse_sun(option: str, sun: Any) -> Light:
    parts = tuple(sun) if isinstance(sun, tuple | list) else ()
    if len(parts) != 2 or not all(map(is_finite_number, parts)) or not 0.0 <= parts[1] <= 90.0:
        raise OptionError(
            option,
            sun,
            "azimuth and altitude: degrees clockwise from north, and 0 to 90 above the horizon",
        )
    return Light(float(parts[0]) % 360.0, float(parts[1]))


def _parse_background(option: str, color: Any) -> str:
    text = color.strip().lower() if isinstance(color, str) else ""
    code = BACKGROUNDS.get(text, text)
    if not re.fullmatch(r"#[0-9a-f]{6}", code):
        names = ", ".join(BACKGROUNDS)
        raise OptionError(option, color, f"{names}, or a colour such as '#e8edf2'")
    return code


def _parse_elevations(option: str, elevations: Any) -> tuple[float, float]:
    ends = tuple(elevations) if isinstance(elevations, tuple | list) else ()
    if len(ends) != 2 or not all(map(is_finite_number, ends)) or not ends[0] < ends[1]:
        raise OptionError(option, elevations, "the lowest and the highest, in this order")
    return float(ends[0]), float(ends[1])


def _by(parse: Callable[..., Any], *more: Any, **limits: Any) -> dict[str, Any]:
    """Return what a field is parsed by: a function of its name, a value, and more."""
    return {"parse": (parse, more, limits)}


@dataclass(frozen=True, slots=True, kw_only=True)
class PreviewOptions:
    """How a surface is shown: the options of :func:`tinsmith.preview`, checked.

    Raises OptionError if one is outside what is allowed, or two contradict each other.
    """

    exaggeration: float | None = field(default=None, metadata=_by(as_number, above=0))
    edges: bool = field(default=False, metadata=_by(as_flag))
    lines: bool = field(default=True, metadata=_by(as_flag))
    size: tuple[int, int] = field(default=(1600, 1000), metadata=_by(_parse_size))
    """Width and height, pixels."""
    title: str = field(
        default=UNTITLED, metadata=_by(lambda _, title: parse_title(title, UNTITLED))
    )
    view: str = field(default="oblique", metadata=_by(choice, VIEWS))
    azimuth: float | None = field(
        default=None, metadata=_by(as_number, unit="of degrees clockwise from north")
    )
    tilt: float | None = field(
        default=None,
        metadata=_by(as_number, "an angle", least=0, most=90, unit="degrees above the horizon"),
    )
    """Azimuth and tilt in place of those of the view."""
    sun: Light = field(default=NORTHWEST, metadata=_by(_parse_sun))
    background: str = field(default=BACKGROUNDS["white"], metadata=_by(_parse_background))
    dpi: float | None = field(
        default=None, metadata=_by(as_number, "a number", least=36, most=2400, unit="dots per inch")
    )
    elevations: tuple[float, float] | None = field(default=None, metadata=_by(_parse_elevations))
    """The lowest and the highest tint."""
    tint: Tint = field(default="elevation", metadata=_by(choice, Tint))
    """The quantity shown by colours."""
    contours: float | None = field(
        default=None,
        metadata=_by(as_number, "an interval", above=0, unit="in the unit of elevations"),
    )
    """Their interval."""

    def __post_init__(self) -> None:
        for one in fields(self):
            value, (parse, more, limits) = getattr(self, one.name), one.metadata["parse"]
            if value is not None or one.default is not None:
                object.__setattr__(self, one.name, parse(one.name, value, *more, **limits))
        if VIEWS[self.view].is_map and self.tilt not in (None, 90.0):
            allowed = f"90, or left out: the view '{self.view}' is from above"
            raise OptionError("tilt", self.tilt, allowed)

    @classmethod
    def of(cls, **given: Any) -> PreviewOptions:
        """Return the options that a caller gives; None stands for the default where it may."""
        never = ("edges", "lines", "view", "tint")
        return cls(**{k: value for k, value in given.items() if value is not None or k in never})

    @property
    def palette(self) -> Palette:
        """Colours that can be read on the background."""
        return choose_palette(parse_hex(self.background))

    @property
    def seen_from(self) -> View:
        """The direction asked for, or that of the view."""
        usual = VIEWS[self.view]
        return View(
            usual.azimuth if self.azimuth is None else self.azimuth % 360.0,
            usual.height if self.tilt is None else self.tilt,
        )
