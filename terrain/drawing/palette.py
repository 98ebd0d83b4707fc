"""Palette: every colour of pictures, charts, plans, pages and classes, and their ramps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array, UInt8Array
    from ...base.policies import Tint

Color = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

# ----------------------------------------------------------------------- the surface and its lines

LINES = {
    "soft": "#404448",
    "hard": "#222226",
    "hole": "#963a22",
    "boundary": "#963a22",
    "water": "#185c98",
}
"""Kinds of lines in a TIN."""

PLAIN, BLOCK, EDGES = "#b9b3a6", "#cecbc5", "#282e32"
"""A surface without tints, the block that it stands on, the edges of triangles in 3D."""

CONTOURS_3D, MARKS_3D = "#584230", "#c81e3c"
CONTOURS, CONTOURS_PLAN, INDEX_CONTOURS_PLAN = "#6b4a2b", "#8a5a33", "#7a4a23"
WATER = "#cfe5f5"
GROUND_BELOW = "#efe6da"
"""Below the line of a profile."""

# ----------------------------------------------------------------------- words, rules and frames

INK, INK_PLAN = "#333333", "#222222"
FAINT, GRID = "#d9d9d9", "#dddddd"
GREY_PLAN, GRID_PLAN, OUTLINE_PLAN, MATCH_LINE = "#666666", "#7a7a7a", "#888888", "#b0006d"
HALO = "#ffffffd9"
BACKGROUNDS = {"white": "#ffffff", "black": "#000000", "light": "#f4f2ee", "dark": "#171b1f"}
"""Backgrounds that have a name; light and dark are those of a page."""

# ----------------------------------------------------------------------- charts

EDGES_CHART = "#404040"
THUMBNAIL, THUMBNAIL_LINES = "#2672b5", "#c44e26"
"""A blue that stands out from white and from near black, and of lines among points."""
CURVES = ("#7a5230", "#c0392b", "#1f618d", "#6c3483", "#117864")
CUT, FILL = "#eba694", "#9cc9e4"
"""Of areas in sections: the hues of a map of cut and fill."""
EARTHWORK = ("#8c1c13", "#e07a5f", "#fbfaf5", "#5fa8d3", "#1b4965")
NO_CHANGE = "#111111"
BLUNDERS = {"high": "#c1121f", "medium": "#f77f00", "low": "#fcbf49"}
"""By certainty."""
BARS, MEDIAN = "#5f8f6b", "#b3472d"
TRIANGULATIONS = {
    "edge": "#5b6670",
    "sound": "#ffffff",
    "gap": "#c9d1d8",
    "violating": "#f2b134",
    "overlapping": "#c8371b",
    "unextended": "#1f5fbf",
}
"""Of triangulations that are compared."""

# ----------------------------------------------------------------------- classes

STEEPNESS = (
    *("#4575b4", "#74add1", "#abd9e9", "#e0f3f8", "#fee090"),
    *("#fdae61", "#f46d43", "#d73027", "#a50026"),
)
"""From gentle to steep: ColorBrewer's RdYlBu, turned round, which people who confuse red and green
tell apart as well (8 classes differ by 11 units of CIELAB at least, on a hillshade too)."""

COMPASS = (
    *("#3b6fb6", "#4fb0c6", "#5fbf7f", "#b8d05a", "#f2d24b", "#ee9b43", "#d9604c", "#9a5fa8"),
    "#d9d9d9",
)
"""A wheel of hues from north on, opposite directions far apart; grey for level ground."""

SIGHT = ("#7fbf7b", "#f6e8a6", "#b9aec4")
"""Seen, seen in part, and hidden."""

# ----------------------------------------------------------------------- the page

PAGE: dict[str, dict[str, Any]] = {
    "light": {
        "ground": BACKGROUNDS["light"], "panel": "#ffffffe8", "ink": "#20262b", "soft": "#5b6670",
        "line": "#d5d0c8", "mark": "#0b5fa5", "halo": "#ffffff",
    },
    "dark": {
        "ground": BACKGROUNDS["dark"], "panel": "#22282ee8", "ink": "#eceff1", "soft": "#a7b0b8",
        "line": "#3d464e", "mark": "#6cb2f0", "halo": BACKGROUNDS["dark"],
    },
}  # fmt: skip
"""Of each theme: background, boxes, words, lesser words, rules, what is chosen, around words."""
SAMPLE_FRAME = "#d9d4c8"
"""Around samples of lines."""

_PAGE_CURVES = {
    "light": ("#0b5fa5", "#c2185b", "#2e7d32", "#b84300", "#6a1b9a"),
    "dark": ("#6cb2f0", "#f48fb1", "#81c784", "#ffab70", "#ce93d8"),
}
PAGE_COLORS = {
    "themes": {name: theme | {"curves": _PAGE_CURVES[name]} for name, theme in PAGE.items()},
    "plain": PLAIN,
    "contours": "#3b2c1a",
    "objects": "#20262b",
    "measured": "#c2185b",
}
"""What the code of the page draws with: curves of profiles; contours, edges and points, and what
is measured on the surface."""

# ----------------------------------------------------------------------- ramps

# Rungs of the ramp from low to high: hue (degrees) and chroma in Oklch. Moss green, sage,
# straw, sand, limestone: no blue, which a reader takes for water, and no rainbow.
_HUES = (158.0, 138.0, 108.0, 80.0, 70.0)
_CHROMAS = (0.055, 0.080, 0.085, 0.065, 0.018)
_LIGHTNESS = (0.52, 0.94)

# Bjoern Ottosson, "A perceptual color space for image processing" (2020): Oklab to cone
# responses, and cone responses to linear sRGB.
_OKLAB_TO_CONES = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
_CONES_TO_LINEAR = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)

_SLOPE = ((0.93, 0.02, 110.0), (0.83, 0.12, 95.0), (0.66, 0.17, 55.0), (0.42, 0.15, 25.0))
_CIRCLE = tuple((0.72, 0.11, float(hue)) for hue in range(250, 250 + 361, 20))
CUT_RUNGS = ((0.50, 0.15, 30.0), (0.72, 0.10, 45.0), (0.96, 0.0, 90.0))
FILL_RUNGS = ((0.96, 0.0, 250.0), (0.70, 0.10, 250.0), (0.45, 0.13, 255.0))
"""Rungs of ramps in Oklch: lightness, chroma, hue in degrees."""


def parse_hex(code: str) -> Color:
    """Return red, green and blue.

    Examples
    --------
    >>> parse_hex("#ff8000")
    (255, 128, 0)
    """
    return int(code[1:3], 16), int(code[3:5], 16), int(code[5:7], 16)


def write_hex(colors: UInt8Array) -> list[str]:
    """Return the codes of (k, 3) colours."""
    return [f"#{red:02x}{green:02x}{blue:02x}" for red, green, blue in colors.tolist()]


def interpolate_colors(anchors: Sequence[str], count: int) -> list[str]:
    """Return so many colours at even distances between anchors.

    Examples
    --------
    >>> interpolate_colors(STEEPNESS, 2)
    ['#4575b4', '#a50026']
    """
    given = np.array([parse_hex(code) for code in anchors], float)
    places = np.linspace(0.0, len(given) - 1.0, count)
    channels = [np.interp(places, np.arange(len(given)), axis) for axis in given.T]
    return write_hex(np.rint(np.column_stack(channels)).astype(np.uint8))


def choose_ramp(tint: Tint, count: int) -> UInt8Array:
    """Return a ramp of two colours or more, (count, 3)."""
    if tint == "slope":
        return mix_tints(_SLOPE, count)
    return mix_tints(_CIRCLE, count) if tint == "aspect" else interpolate_tints(count)


def interpolate_tints(count: int = 256) -> UInt8Array:
    """Return a ramp of two hypsometric tints or more, low to high: (count, 3), sRGB.

    Perceived lightness (Oklab L) rises evenly, so that equal steps of elevation look equal, also in
    grey and to colour-blind eyes.
    """
    lightness = np.linspace(*_LIGHTNESS, len(_HUES))
    return mix_tints(list(zip(lightness, _CHROMAS, _HUES, strict=True)), count)


def mix_tints(rungs: Sequence[tuple[float, float, float]], count: int) -> UInt8Array:
    """Return a ramp of two colours or more between rungs at even distances: (count, 3), sRGB.

    Rungs are lightness, chroma and hue in Oklch, hues in degrees.
    """
    position = np.linspace(0.0, 1.0, count)
    at = np.linspace(0.0, 1.0, len(rungs))
    light, chroma, hue = (np.interp(position, at, values) for values in zip(*rungs, strict=True))
    hue = np.radians(hue)
    lab = np.column_stack([light, chroma * np.cos(hue), chroma * np.sin(hue)])
    linear = (lab @ _OKLAB_TO_CONES.T) ** 3 @ _CONES_TO_LINEAR.T
    return np.round(255 * _encode_gamma(np.clip(linear, 0.0, 1.0))).astype(np.uint8)


def compute_lightness(colors: UInt8Array) -> Float64Array:
    """Return the perceived lightness (Oklab L, 0 black to 1 white) of (k, 3) sRGB colours."""
    encoded = colors / 255.0
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    cones = np.cbrt(linear @ np.linalg.inv(_CONES_TO_LINEAR).T)
    light: Float64Array = (cones @ np.linalg.inv(_OKLAB_TO_CONES).T)[:, 0]
    return light


def _encode_gamma(linear: Float64Array) -> Float64Array:
    """Encode linear light as sRGB."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


# ----------------------------------------------------------------------- words on a background

_LIGHT_INK: Color = parse_hex("#f0f2f4")
_LEAST_OF_LIGHT = 0.62
"""Oklab lightness of a background from which on dark words are easier to read on it."""

_GREY_SHARE = 0.34
"""Share of the background in the colour of less important words."""


class Palette(NamedTuple):
    """Colours of annotations."""

    ink: Color = parse_hex("#1c2228")
    grey: Color = parse_hex("#606a72")
    """Of words and shapes, and of those that matter less."""
    paper: Color = parse_hex(BACKGROUNDS["white"])
    """The background."""
    warning: Color = parse_hex(LINES["boundary"])
    """Of what a reader must not miss."""


def choose_palette(background: Color) -> Palette:
    """Return the colours that can be read on a background.

    Examples
    --------
    >>> choose_palette((255, 255, 255)) == Palette()
    True
    >>> choose_palette((0, 0, 0)).ink
    (240, 242, 244)
    """
    usual = Palette()
    if background == usual.paper:
        return usual
    is_light = float(compute_lightness(np.array([background], np.uint8))[0]) >= _LEAST_OF_LIGHT
    ink = usual.ink if is_light else _LIGHT_INK
    warning = usual.warning if is_light else parse_hex("#ffaa82")
    red, green, blue = (
        round(one + _GREY_SHARE * (other - one)) for one, other in zip(ink, background, strict=True)
    )
    return Palette(ink, (red, green, blue), background, warning)
