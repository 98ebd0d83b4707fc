"""Plain twins of operators on grids: cell by cell, as gdaldem's source has them."""

from __future__ import annotations

import math


def find_window(z, row, column, edges):
    """Return the nine elevations that gdaldem takes, the north-western first; None for no value."""
    rows, columns = len(z), len(z[0])
    window = [
        find_elevation(z, row, column, down, across) if edges or has(z, row + down, column + across)
        else math.nan
        for down in (-1, 0, 1)
        for across in (-1, 0, 1)
    ]  # fmt: skip
    middle = window[4]
    if math.isnan(middle) or (edges and min(rows, columns) < 2):
        return None
    if edges:
        return [middle if math.isnan(one) else one for one in window]
    return None if any(map(math.isnan, window)) else window


def has(z, row, column):
    return 0 <= row < len(z) and 0 <= column < len(z[0])


def find_elevation(z, row, column, down, across):
    """Return an elevation that may be beyond the rim: straight on, and at corners repeated."""
    rows, columns = len(z), len(z[0])
    if has(z, row + down, column + across):
        return z[row + down][column + across]
    if min(rows, columns) < 2:
        return math.nan
    if not 0 <= row + down < rows:
        column = min(max(column + across, 0), columns - 1)
        return 2 * z[row][column] - z[row - down][column]
    if row in (0, rows - 1):  # the first and the last row are computed apart
        return z[row + down][column]
    return 2 * z[row + down][column] - z[row + down][column - across]


def measure(window, value, operator, width, height, up, light=(315.0, 45.0)):
    """Return the value of a window of cells of a width and a height."""
    if value in RUGGEDNESS:
        return RUGGEDNESS[value](window, operator)
    if value.endswith("-curvature"):
        return measure_curvature(window, value, width, height, up)
    a, b, c, d, _, f, g, h, i = window
    if operator == "horn":
        east = (c + 2 * f + i - a - 2 * d - g) / (8 * width) * up
        north = (a + 2 * b + c - g - 2 * h - i) / (8 * height) * up
    else:
        east, north = (f - d) / (2 * width) * up, (b - h) / (2 * height) * up
    if value == "slope":
        return math.degrees(math.atan(math.hypot(east, north)))
    if value == "aspect":
        is_level = east == 0 == north
        return math.nan if is_level else math.degrees(math.atan2(-east, -north)) % 360.0
    azimuth, altitude = map(math.radians, light)
    toward = math.cos(altitude) * (math.sin(azimuth) * east + math.cos(azimuth) * north)
    light = (math.sin(altitude) - toward) / math.sqrt(1 + east**2 + north**2)
    return 1 + 254 * max(light, 0.0)


def measure_curvature(window, value, width, height, up):
    """Return a curvature by second derivatives along and across the slope, found by rotation."""
    a, b, c, d, e, f, g, h, i = (one * up for one in window)
    x, y = (f - d) / (2 * width), (b - h) / (2 * height)
    xx, yy = (d + f - 2 * e) / width**2, (b + h - 2 * e) / height**2
    xy = (c + g - a - i) / (4 * width * height)
    rise, secant = math.hypot(x, y), math.sqrt(1 + x * x + y * y)
    if value == "gaussian-curvature":
        return (xx * yy - xy * xy) / secant**4
    if value == "mean-curvature":
        return -((1 + y * y) * xx - 2 * x * y * xy + (1 + x * x) * yy) / (2 * secant**3)
    if rise == 0:
        return math.nan
    turn = math.atan2(y, x)
    along = xx * math.cos(turn) ** 2 + xy * math.sin(2 * turn) + yy * math.sin(turn) ** 2
    across = xx * math.sin(turn) ** 2 - xy * math.sin(2 * turn) + yy * math.cos(turn) ** 2
    if value == "profile-curvature":
        return -along / secant**3
    return -across / (rise if value == "plan-curvature" else secant)


def measure_ruggedness(window, operator):
    apart = [one - window[4] for one in window]
    if operator == "wilson":
        return sum(map(abs, apart)) / 8
    return math.sqrt(sum(one * one for one in apart))


RUGGEDNESS = {
    "tri": measure_ruggedness,
    "tpi": lambda window, _: window[4] - (sum(window) - window[4]) / 8,
    "roughness": lambda window, _: max(window) - min(window),
}
