"""Alignment: the surfaces and points of one preview in one CRS, elevations in one unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from ...base.checks import require_tin
from ...base.errors import OptionError
from ...base.georeference import agree, find_axes
from ...tin import TIN
from ..drawing import draw_north_up

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import CRS, Unit
    from ...tin import Survey

_ALLOWED = "a TIN, or a sequence of TINs or a mapping of names to TINs with one at least"
_ALONE = "Surface"


class Aligned(NamedTuple):
    """What is shown together."""

    surfaces: dict[str, TIN]
    """In one CRS, elevations in one unit."""
    labelled: Float64Array | None
    """(k, 3), the points of the survey, in that unit."""
    notes: tuple[str, ...]
    """What had to be assumed or converted."""

    @property
    def crs(self) -> CRS | None:
        """The CRS of all."""
        return next(iter(self.surfaces.values())).crs

    def draw_north_up(self) -> Aligned:
        """Return the same with eastings and northings, whatever the axes of the CRS are."""
        axes = find_axes(self.crs)
        if axes.are_usual:
            return self
        return Aligned(
            {name: draw_north_up(tin) for name, tin in self.surfaces.items()},
            None if self.labelled is None else axes.turn(self.labelled),
            self.notes,
        )


def align(given: TIN | Sequence[TIN] | Mapping[str, TIN], survey: Survey | None) -> Aligned:
    """Bring surfaces and points together, elevations in the unit of the first that has one.

    Raises OptionError if there is no surface. Raises PointsError if one is no TIN. Raises CrsError
    as :func:`tinsmith.base.georeference.agree` says.
    """
    named = given if isinstance(given, Mapping) else _name_surfaces(given)
    if not named:
        raise OptionError("tin", given, _ALLOWED)
    for one in named.values():
        require_tin(one)
    tins = tuple(named.values())
    names = [f"the surface '{name}'" for name in named] if len(tins) > 1 else ["the surface"]
    added = [] if survey is None else [survey]
    found = agree([*tins, *added], [*names, *("the survey" for _ in added)])
    surfaces = {
        str(name): _convert(tin, factor, found.crs, found.elevation_unit)
        for (name, tin), factor in zip(named.items(), found.factors, strict=False)
    }
    labelled = None if survey is None else survey.points * (1.0, 1.0, found.factors[-1])
    return Aligned(surfaces, labelled, found.notes)


def _name_surfaces(given: TIN | Sequence[TIN]) -> dict[str, TIN]:
    """Name surfaces by their files, or by their numbers where files do not tell all apart."""
    if isinstance(given, TIN) or not isinstance(given, Sequence):
        return {_ALONE: given}
    for one in given:
        require_tin(one)
    if len(given) == 1:
        return {_ALONE: given[0]}
    names = [PurePath(tin.source).stem.replace("_", " ") for tin in given]
    if "" in names or len({*names}) < len(names):
        names = [f"{_ALONE} {number}" for number in range(1, len(given) + 1)]
    return dict(zip(names, given, strict=True))


def _convert(tin: TIN, factor: float, crs: CRS | None, unit: Unit | None) -> TIN:
    if factor == 1.0:
        return tin
    points = tin.points * (1.0, 1.0, factor)
    return tin.replace(points=points, crs=crs, elevation_unit=unit)
