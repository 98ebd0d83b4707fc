"""Where a tile lies: on the globe, or in a pyramid of web Mercator, by the centre it tells."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from ....base.errors import ReadError

if TYPE_CHECKING:
    from .tile import TileName

__all__ = ["HALF_WORLD", "Placing", "find_placing"]

HALF_WORLD = 20_037_508.342789244
"""Half the width of the world in web Mercator, metres."""

_LEAST_RADIUS, _MOST_RADIUS = 6.2e6, 6.6e6
"""Metres from the centre of the Earth between which its surface lies."""

_LEAST_FLAT = 4
"""The level from which the middle of a tile lies near the surface, wherever a program puts it."""

_EXACTLY = 1e-3
"""Widths of a tile within which a centre is that of the tile."""


class Placing(NamedTuple):
    """The rectangle that a tile covers, and the CRS of its coordinates."""

    west: float
    south: float
    width: float
    crs: str = "EPSG:4979"
    unit: str | None = None
    """Of heights, where the CRS does not tell."""
    notes: tuple[str, ...] = ()


def find_placing(
    center: tuple[float, float, float], name: TileName, *, is_declared: bool
) -> Placing:
    """Return where a tile of a name lies, by the centre that its header tells.

    Raises
    ------
    ReadError
        If the centre lies in another tile, and the name is not declared by the caller.
    """
    west, south, east, _ = name.bounds
    globe = Placing(west, south, east - west)
    if not any(center):
        note = "The header of the tile does not tell where it lies: taken to be one of the globe."
        return globe._replace(notes=(note,))
    mercator = _place_in_mercator(name)
    if _find_distance(center[:2], mercator) <= _EXACTLY:
        return mercator
    degrees = _find_degrees(center, name.level)
    if degrees is not None and _find_distance(degrees, globe) <= 0.5 + _EXACTLY:
        return globe
    if degrees is None and _find_distance(center[:2], mercator) <= 0.5 + _EXACTLY:
        return mercator
    fault = (
        f"the centre that the header tells, {_describe(center, degrees)}, does not lie in tile "
        f"{name.level}/{name.x}/{name.y}, neither of longitude and latitude nor of web Mercator"
        f"{_advise(center, degrees, name)}"
    )
    if is_declared:
        return globe._replace(notes=(f"The tile lies where it is declared to lie, and {fault}.",))
    raise ReadError(f"{fault}.")


def _place_in_mercator(name: TileName) -> Placing:
    width = 2 * HALF_WORLD / 2**name.level
    note = (
        "By the centre that its header tells, the tile is one of a pyramid of web Mercator: its "
        "coordinates are those of EPSG:3857."
    )
    west, south = name.x * width - HALF_WORLD, name.y * width - HALF_WORLD
    return Placing(west, south, width, "EPSG:3857", "metre", (note,))


def _find_distance(place: tuple[float, ...], placing: Placing) -> float:
    """Return how far a place lies from the middle of a rectangle, in widths."""
    away = (place[0] - placing.west, place[1] - placing.south)
    return max(abs(one / placing.width - 0.5) for one in away)


def _find_degrees(center: tuple[float, float, float], level: int) -> tuple[float, float] | None:
    """Return longitude and latitude of a place in space; None if it is not near the surface."""
    x, y, z = center
    least = _LEAST_RADIUS if level >= _LEAST_FLAT else 0.0
    if not least < math.hypot(x, y, z) < _MOST_RADIUS:
        return None
    squeeze = 1 - (1 - 1 / 298.257223563) ** 2
    return math.degrees(math.atan2(y, x)), math.degrees(
        math.atan2(z, math.hypot(x, y) * (1 - squeeze))
    )


def _describe(center: tuple[float, float, float], degrees: tuple[float, float] | None) -> str:
    if degrees is not None:
        return f"longitude {degrees[0]:.6f}, latitude {degrees[1]:.6f}"
    return f"({', '.join(f'{one:,.1f}' for one in center)})"


def _advise(
    center: tuple[float, float, float], degrees: tuple[float, float] | None, name: TileName
) -> str:
    """Name the tile of the level in which the centre lies, if rows are counted from the north."""
    world = (
        Placing(-180.0, -90.0, name.width)
        if degrees is not None
        else _place_in_mercator(type(name)(name.level, 0, 0))
    )
    place = center if degrees is None else degrees
    x, y = (math.floor((one - low) / world.width)
            for one, low in zip(place[:2], (world.west, world.south), strict=True))  # fmt: skip
    if not (0 <= y < 2**name.level and 0 <= x < 2 ** (name.level + (degrees is not None))):
        return ""
    counted = "rows are counted from the south, and " if y == 2**name.level - 1 - name.y else ""
    return f": {counted}tile='{name.level}/{x}/{y}' is where it lies"
