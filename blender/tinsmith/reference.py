"""CRS, units and shift: how coordinates of a map become places in a scene. Needs no Blender.

Blender keeps places in 32 bits: of a northing of 4,000,000 m a quarter of a metre would be lost.
The first file of a scene sets the shift, whole numbers that are taken off eastings and northings;
it stands in custom properties of the scene and of each object.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

METRES = {
    "metre": 1.0,
    "foot": 0.3048,
    "US survey foot": 1200 / 3937,
    "kilometre": 1000.0,
    "millimetre": 0.001,
}
"""Length of the units that files name."""

_OTHER_NAMES = {"meter": "metre", "m": "metre", "foot_us": "US survey foot", "ft": "foot"}
_FAR = 100_000.0
"""Metres from the shift at which 32 bits keep about a centimetre."""


class Refused(Exception):
    """What cannot be imported, as a sentence."""


@dataclass(frozen=True)
class Unit:
    """A unit of length."""

    name: str
    metres: float

    @staticmethod
    def find(name: str) -> Unit | None:
        """Return a unit by its name, or None if it is not known."""
        own = _OTHER_NAMES.get(name.strip().lower(), name.strip())
        return Unit(own, METRES[own]) if own in METRES else None


@dataclass(frozen=True)
class Reference:
    """What a file says of its coordinates; None and "" where it says nothing."""

    crs: str = ""
    horizontal: Unit | None = None
    elevation: Unit | None = None


@dataclass(frozen=True)
class Placement:
    """How coordinates become places: shift and metres per unit, and Blender units per metre."""

    shift: tuple[float, float, float]
    crs: str
    horizontal: Unit
    elevation: Unit
    scale: float = 1.0

    def place(self, points: Any) -> Any:
        """Return places in the scene, (n, 3) float64, of points of the map."""
        metres = np.array([self.horizontal.metres] * 2 + [self.elevation.metres])
        return (np.asarray(points, np.float64) - self.shift) * (metres * self.scale)

    def to_properties(self) -> dict[str, Any]:
        """Return the custom properties that tell it."""
        return {
            "tinsmith_shift": list(self.shift),
            "tinsmith_crs": self.crs,
            "tinsmith_horizontal_unit": self.horizontal.name,
            "tinsmith_elevation_unit": self.elevation.name,
            "tinsmith_metres": [self.horizontal.metres, self.elevation.metres],
            "tinsmith_scale": self.scale,
        }

    @staticmethod
    def from_properties(properties: Any) -> Placement | None:
        """Return the placement of a scene, or None if it has none."""
        if "tinsmith_shift" not in properties:
            return None
        along, up = (float(one) for one in properties["tinsmith_metres"])
        east, north, height = (float(one) for one in properties["tinsmith_shift"])
        return Placement(
            shift=(east, north, height),
            crs=str(properties["tinsmith_crs"]),
            horizontal=Unit(str(properties["tinsmith_horizontal_unit"]), along),
            elevation=Unit(str(properties["tinsmith_elevation_unit"]), up),
            scale=float(properties["tinsmith_scale"]),
        )


def choose_placement(
    found: Reference, box: Any, there: Placement | None, asked: Reference, scale: float
) -> tuple[Placement, list[str]]:
    """Return how a file is placed, and what is to be told of that.

    Parameters
    ----------
    found : Reference
        What the file says.
    box : (2, 3) array
        Least and greatest coordinates.
    there : Placement, optional
        That of the scene, if something was imported before.
    asked : Reference
        What the user states; its ``crs`` is that of the scene if a file without one is taken so.
    scale : float
        Blender units per metre, of the first file.

    Raises
    ------
    Refused
        If the unit is not known, or the CRS is another than that of the scene.
    """
    horizontal, elevation, told = _choose_units(found, asked)
    if there is None:
        middle = np.rint((box[0] + box[1]) / 2)
        shift = (float(middle[0]), float(middle[1]), 0.0)
        made = Placement(shift, found.crs, horizontal, elevation, scale)
        told.append(f"Shift of the scene: easting {shift[0]:.0f}, northing {shift[1]:.0f}.")
        return made, told
    _require_same_crs(found, there, asked)
    if horizontal.metres != there.horizontal.metres:
        raise Refused(
            f"The coordinates of the scene are in {there.horizontal.name}, those of the file in "
            f"{horizontal.name}: import the file into a scene of its own."
        )
    if scale != there.scale:
        told.append(f"The scale is that of the scene: {there.scale:g} units per metre.")
    told.append(f"Shift as the scene has it: {there.shift[0]:.0f}, {there.shift[1]:.0f}.")
    made = Placement(there.shift, there.crs, horizontal, elevation, there.scale)
    farthest = float(np.abs(made.place(box)[:, :2]).max() / there.scale)
    if farthest > _FAR:
        told.append(
            f"The file lies up to {farthest / 1000:.0f} km from the shift: Blender's 32 bits "
            "place it to about a centimetre at best."
        )
    return made, told


def _choose_units(found: Reference, asked: Reference) -> tuple[Unit, Unit, list[str]]:
    """Return the units of eastings and of elevations, and what is to be told of them."""
    told = []
    for known, stated, what in (
        (found.horizontal, asked.horizontal, "coordinates"),
        (found.elevation, asked.elevation, "elevations"),
    ):
        if known and stated and known.metres != stated.metres:
            raise Refused(
                f"The file says that its {what} are in {known.name}, and {stated.name} was "
                "chosen: leave the choice to the file."
            )
    horizontal = found.horizontal or asked.horizontal
    if horizontal is None:
        raise Refused(
            "The file does not say in which unit its coordinates are: choose the unit (metre, "
            "foot, US survey foot)."
        )
    if found.horizontal is None:
        told.append(f"Coordinates are taken to be in {horizontal.name}, as chosen.")
    elevation = found.elevation or asked.elevation
    if elevation is None:
        elevation = horizontal
        told.append(
            f"The file does not say in which unit elevations are: taken to be {horizontal.name}, "
            "as the coordinates."
        )
    if (horizontal.metres, elevation.metres) != (1.0, 1.0):
        told.append(
            f"Converted to metres: coordinates from {horizontal.name}, elevations from "
            f"{elevation.name}."
        )
    return horizontal, elevation, told


def _require_same_crs(found: Reference, there: Placement, asked: Reference) -> None:
    if found.crs == there.crs or (not found.crs and asked.crs == there.crs):
        return
    raise Refused(
        f"The scene is in {_name(there.crs)}, and the file in {_name(found.crs)}: reproject the "
        "file (tinsmith convert --crs), or import it into a scene of its own."
        + ("" if found.crs else " If it is in that of the scene, check 'CRS of the scene'.")
    )


def _name(crs: str) -> str:
    """Return a CRS in few words."""
    if not crs:
        return "no known CRS"
    name = re.match(r'\w+\["([^"]+)"', crs)
    return name[1] if name else crs
