"""Surfaces: one TIN or several that are cut along the same lines, in one CRS and one unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from ...base.checks import is_collection, require_tin
from ...base.crs import CRS, Unit
from ...base.errors import OptionError
from ...base.georeference import agree

if TYPE_CHECKING:
    from ...tin import TIN

_ALLOWED = "a TIN, a sequence of TINs, or a mapping of names to TINs"


class Surfaces(NamedTuple):
    """TINs with names, and how their elevations become those of one unit."""

    names: tuple[str, ...]
    """The one name of a TIN given by itself is empty."""
    tins: tuple[TIN, ...]
    factors: tuple[float, ...]
    """From each TIN's elevations to ``elevation_unit``."""
    crs: CRS | None
    elevation_unit: Unit | None
    notes: tuple[str, ...]
    """What had to be assumed or converted."""

    def column(self, name: str, k: int) -> str:
        """Return what the column of surface ``k`` is called."""
        return f"{name}_{self.names[k]}" if self.names[k] else name


def as_surfaces(given: Any) -> Surfaces:
    """Return one TIN or several as surfaces of one CRS and one unit of elevations.

    Without names, in a sequence, they are called 1, 2, ... Raises OptionError if there is none, or
    a name is no printable text; PointsError if one is no TIN; CrsError as
    :func:`tinsmith.base.georeference.agree` does.
    """
    names, tins = _name_tins(given)
    for tin in tins:
        require_tin(tin)
    phrases = [f"the surface '{name}'" if name else "the surface" for name in names]
    found = agree(tins, phrases)
    return Surfaces(names, tins, found.factors, found.crs, found.elevation_unit, found.notes)


def _name_tins(given: Any) -> tuple[tuple[str, ...], tuple[TIN, ...]]:
    if isinstance(given, Mapping):
        names = tuple(given)
        for name in names:
            if not (isinstance(name, str) and name.strip() and name.isprintable()):
                raise OptionError("name of a surface", name, allowed="a printable text")
        tins = tuple(given.values())
    elif is_collection(given):
        tins = tuple(given)
        names = tuple(str(number + 1) for number in range(len(tins)))
    else:
        names, tins = ("",), (given,)
    if not tins:
        raise OptionError("surfaces", [], allowed=_ALLOWED)
    return names, tins
