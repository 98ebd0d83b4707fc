"""Hypsometric tints: a colour for each elevation, lighter with every step up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array, UInt8Array

__all__ = ["compute_lightness", "interpolate_tints", "mix_tints"]

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
