"""Which points of a lidar file are taken, and what is said of the others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_length, is_finite_number, is_whole_number, require_count
from ...base.errors import OptionError
from ...base.sentences import counted
from ...tin import Bounds
from ..registry import Counts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...base.arrays import Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.progress import Tell

CHEAP_ATTRIBUTES = ("classification", "intensity", "return_number", "number_of_returns")
"""Attributes that are kept without asking: five bytes a point."""

N_CLASSES = 256
_MOST_RETURNS = 15
_RETURNS = ("first", "last", "only")
_CLASS_NAMES = {
    0: "never classified",
    1: "unclassified",
    2: "ground",
    3: "low vegetation",
    4: "medium vegetation",
    5: "high vegetation",
    6: "building",
    7: "low noise",
    8: "key points",
    9: "water",
    10: "rail",
    11: "road",
    12: "overlap",
    13: "wire guard",
    14: "wire",
    15: "tower",
    16: "wire connector",
    17: "bridge deck",
    18: "high noise",
}
_UNCLASSIFIED = frozenset({0, 1, 12})
_GROUND = 2


@dataclass(frozen=True, slots=True)
class Asked:
    """The options of the reader."""

    crs: CrsLike | None = None
    elevation_unit: UnitLike | None = None
    classes: int | str | Sequence[int] | None = None
    returns: int | str | Sequence[int | str] | None = None
    window: Bounds | Sequence[float] | None = None
    resolution: float | None = None
    every: int = 1
    withheld: bool = False
    attributes: str | Sequence[str] | None = None
    progress: Tell | None = None

    def select(self) -> Selection:
        """Return which points are taken.

        Raises
        ------
        OptionError
            If a value is none that its option can have.
        """
        require_count("every", self.every)
        fine = self.resolution
        return Selection(
            None if self.classes is None else _parse_classes(self.classes),
            None if self.returns is None else _parse_returns(self.returns),
            None if self.window is None else _parse_window(self.window),
            None if fine is None else as_length("resolution", fine, or_none=True),
            int(self.every),
            bool(self.withheld),
            _parse_attributes(self.attributes),
        )


@dataclass(frozen=True, slots=True)
class Selection:
    """Which points are taken; None takes all."""

    classes: tuple[int, ...] | None
    returns: tuple[int | str, ...] | None
    """Numbers of returns, or "first", "last", "only"."""
    window: Bounds | None
    resolution: float | None
    """Distance of points that is fine enough."""
    every: int
    withheld: bool
    """Whether points that are marked as withheld are taken too."""
    attributes: tuple[str, ...] | None
    """None for all."""

    def to_request(self) -> dict[str, Any]:
        """Return it as values that JSON can hold."""
        box = self.window
        return {
            "classes": self.classes,
            "returns": self.returns,
            "window": None if box is None else [box.xmin, box.ymin, box.xmax, box.ymax],
            "resolution": self.resolution,
            "every": self.every,
            "withheld": self.withheld,
            "attributes": self.attributes,
        }


@dataclass(slots=True, eq=False)
class Tally:
    """How many points there are and why some were left out, of one file or several."""

    classes: Int64Array
    """(256,), points of each class, withheld ones apart."""
    withheld: int = 0
    of_other_classes: int = 0
    of_other_returns: int = 0
    outside: int = 0
    thinned: int = 0
    """These five are points left out, in this order."""
    synthetic: int = 0
    overlap: int = 0
    """These two are points among those taken that are marked so."""

    def add(self, part: dict[str, int], classes: Int64Array) -> None:
        """Add the counts of some points."""
        self.classes += classes
        for name, count in part.items():
            setattr(self, name, getattr(self, name) + count)

    @property
    def left_out(self) -> int:
        """How many points were seen and not taken."""
        others = self.of_other_classes + self.of_other_returns
        return self.withheld + others + self.outside + self.thinned

    @property
    def skipped(self) -> dict[str, int]:
        """What was left out, for a survey."""
        found = {
            "points marked as withheld": self.withheld,
            "points of other classes": self.of_other_classes,
            "points of other returns": self.of_other_returns,
        }
        return {what: count for what, count in found.items() if count}


def _split(given: object) -> list[object]:
    if isinstance(given, str):
        return [word for word in given.replace(",", " ").split() if word]
    return list(given) if isinstance(given, Iterable) else [given]


def _parse_whole(value: Any) -> int | None:
    if isinstance(value, str) and value.isdecimal():
        return int(value)
    return int(value) if is_whole_number(value) else None


def _parse_classes(given: object) -> tuple[int, ...]:
    numbers = [_parse_whole(one) for one in _split(given)]
    if not numbers or not all(one is not None and 0 <= one < N_CLASSES for one in numbers):
        raise OptionError(
            "classes", given, "numbers of classes from 0 to 255, such as 2 (ground) or 2, 8, 9"
        )
    return tuple(sorted({one for one in numbers if one is not None}))


def _parse_returns(given: object) -> tuple[int | str, ...]:
    found: list[int | str] = []
    for one in _split(given):
        number = _parse_whole(one)
        if one in _RETURNS:
            found.append(str(one))
        elif number is not None and 1 <= number <= _MOST_RETURNS:
            found.append(number)
        else:
            raise OptionError("returns", one, f"{', '.join(_RETURNS)}, or a number from 1 to 15")
    if not found:
        raise OptionError("returns", given, f"{', '.join(_RETURNS)}, or a number from 1 to 15")
    return tuple(found)


def _parse_window(given: Bounds | Sequence[float]) -> Bounds:
    allowed = "Bounds, or four finite numbers: west, south, east, north, with some area"
    if isinstance(given, Bounds):
        box: list[Any] = [given.xmin, given.ymin, given.xmax, given.ymax]
    else:
        box = _split(given)
    if len(box) != 4 or not all(map(is_finite_number, box)):
        raise OptionError("window", given, allowed)
    if not (box[0] < box[2] and box[1] < box[3]):
        raise OptionError("window", tuple(box), allowed)
    return Bounds(*map(float, box))


def _parse_attributes(given: str | Sequence[str] | None) -> tuple[str, ...] | None:
    if given is None:
        return CHEAP_ATTRIBUTES
    names = given.split(",") if isinstance(given, str) else [str(one) for one in given]
    names = [name.strip() for name in names]
    return None if names == ["all"] else tuple(dict.fromkeys(names))


# ---------------------------------------------------------------------------- notes


def count_points(tally: Tally, selection: Selection) -> Counts:
    """Return the counts of classes and of marks, of which notes are made."""
    numbers = {str(one): int(tally.classes[one]) for one in np.flatnonzero(tally.classes).tolist()}
    marks = {"synthetic": tally.synthetic, "overlap": tally.overlap}
    classes = None if selection.classes is None else list(selection.classes)
    return Counts(f"{__name__}:describe_counts", numbers | marks, {"classes": classes})


def describe_counts(numbers: Mapping[str, int], classes: Sequence[int] | None) -> list[str]:
    """Tell which classes and marks there are, and which classes were taken."""
    found = {int(name): number for name, number in numbers.items() if name.isdigit()}
    return [
        *describe_classes(found, classes),
        *_describe_marks(numbers["synthetic"], numbers["overlap"]),
    ]


def describe_classes(found: Mapping[int, int], classes: Sequence[int] | None) -> list[str]:
    """Tell how many points each class has, and which were taken, where that matters."""
    there = sorted(found)
    if not there or (set(there) <= _UNCLASSIFIED and classes is None):
        return []
    listed = ", ".join(_describe_class(one, found[one]) for one in there)
    if classes is not None:
        return [f"Classes of the points: {listed}; taken: {_list_taken(classes)}."]
    if len(there) == 1:
        return [f"All points are of one class: {listed}."]
    advice = f"; {_GROUND} alone is the ground" if _GROUND in there else ""
    return [
        f"Classes of the points: {listed}. All were taken, vegetation, buildings and noise too: "
        f"the option `classes` takes some{advice}."
    ]


def _list_taken(classes: Sequence[int]) -> str:
    """Write which classes are taken, or which are not where these are fewer."""
    others = sorted({*range(N_CLASSES)} - {*classes})
    if 0 < len(others) < len(classes):
        return f"all but {', '.join(map(str, others))}"
    return ", ".join(map(str, classes))


def _describe_marks(synthetic: int, overlap: int) -> list[str]:
    """Tell of marked points among those taken."""
    marks = {"synthetic": synthetic, "overlap of flight lines": overlap}
    said = [f"{counted(n, 'point')} as {what}" for what, n in marks.items() if n]
    return [f"Marked, and taken: {', '.join(said)}."] if said else []


def _describe_class(number: int, count: int) -> str:
    name = _CLASS_NAMES.get(number, "")
    return f"{number} {name} ({count:,})" if name else f"{number} ({count:,})"
