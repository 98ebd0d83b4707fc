"""What the headers of many files say of their points, and where they disagree."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.errors import TinsmithError
from ..base.sentences import counted
from .streaming import describe_source

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    from ..base.types import Bounds
    from .registry import SourceHeader

_SHOWN = 3
_UNEVEN = 4.0
"""How many times more or less dense than usual a file is before it is told."""
_LEAST_SHARE = 0.01
"""Of the smaller file's bounds, above which an overlap is told: neighbours share their sides."""


class Disagreement(NamedTuple):
    """What is not as in the other files: what it is about, a sentence, and the files."""

    kind: str
    sentence: str
    files: tuple[str, ...]


class Overlap(NamedTuple):
    """Two files whose bounds overlap, and the share of the smaller bounds, 0 to 1."""

    first: str
    second: str
    share: float


@dataclass(frozen=True)
class Inventory:
    """What headers say of files.

    Attributes
    ----------
    headers : tuple of SourceHeader
        Of the files whose headers can be read.
    disagreements : tuple of Disagreement
        Files that cannot be read are among them.
    overlaps : tuple of Overlap
    """

    headers: tuple[SourceHeader, ...]
    disagreements: tuple[Disagreement, ...] = ()
    overlaps: tuple[Overlap, ...] = field(default=())

    @property
    def count(self) -> int | None:
        """Points of all files; None if one does not tell."""
        counts = [one.count for one in self.headers]
        return None if None in counts else sum(count for count in counts if count is not None)

    @property
    def densities(self) -> list[float]:
        """Points per square unit of the CRS of each file that tells, within its bounds."""
        return [found for one in self.headers if (found := measure_density(one)) is not None]


def take_inventory(files: Sequence[Path], **options: Any) -> Inventory:
    """Tell what the headers of files say, and what disagrees between them; no points are read.

    Parameters
    ----------
    files : sequence of Path
    **options
        As of :func:`tinsmith.read`.
    """
    headers: list[SourceHeader] = []
    found: list[Disagreement] = []
    for file in files:
        try:
            headers.append(describe_source(file, **options))
        except TinsmithError as error:
            found.append(Disagreement("unreadable", str(error), (file.name,)))
    overlaps = _find_overlaps(headers)
    found += _find_differences(headers)
    empty = [one.path.name for one in headers if one.count == 0]
    if empty:
        verb = "has" if len(empty) == 1 else "have"
        found.append(Disagreement("empty", f"{_name(empty)} {verb} no points.", tuple(empty)))
    return Inventory(
        tuple(headers),
        (*found, *_find_copies(headers), *_find_uneven(headers), *_describe_overlaps(overlaps)),
        tuple(overlaps),
    )


def measure_density(header: SourceHeader) -> float | None:
    """Return points per square unit of the CRS within the bounds of a file; None if not known."""
    box = header.bounds
    if box is None or not header.count or not box.width * box.height > 0.0:
        return None
    return header.count / (box.width * box.height)


def _name(files: Sequence[str]) -> str:
    more = f" and {len(files) - _SHOWN:,} more" if len(files) > _SHOWN else ""
    return ", ".join(f"'{file}'" for file in files[:_SHOWN]) + more


def _find_differences(headers: Sequence[SourceHeader]) -> list[Disagreement]:
    """Tell where files are in several CRSs, units, formats or versions: which are the few."""
    filled = [one for one in headers if one.count != 0]
    kinds: dict[str, tuple[str, Callable[[SourceHeader], Hashable]]] = {
        "format": ("formats", lambda one: one.format),
        "crs": ("CRSs", lambda one: "no CRS" if one.crs is None else one.crs.label),
        "elevation_unit": ("units of elevations", lambda one: str(one.elevation_unit or "unknown")),
        "records": ("versions or point formats", lambda one: one.records or one.format),
    }
    found = []
    for kind, (what, ask) in kinds.items():
        counts = Counter(map(ask, filled))
        if len(counts) < 2:
            continue
        values = counts.most_common()
        others = [one.path.name for one in filled if ask(one) != values[0][0]]
        listed = "; ".join(f"{value} ({counted(count, 'file')})" for value, count in values)
        text = f"The files are in several {what}: {listed}. The fewer are {_name(others)}."
        found.append(Disagreement(kind, text, tuple(others)))
    return found


def _find_copies(headers: Sequence[SourceHeader]) -> list[Disagreement]:
    """Tell which files have the same size, count and bounds as one before them."""
    alike: dict[Hashable, list[str]] = {}
    for one in headers:
        if one.bounds is not None and one.count:
            alike.setdefault((one.size, one.count, one.bounds), []).append(one.path.name)
    return [
        Disagreement(
            "copies",
            f"{_name(names[1:])} may be {'a copy' if len(names) == 2 else 'copies'} of "
            f"'{names[0]}': size, count and bounds are the same.",
            tuple(names),
        )
        for names in alike.values()
        if len(names) > 1
    ]


def _find_uneven(headers: Sequence[SourceHeader]) -> list[Disagreement]:
    """Tell which files are much more, or less, dense than the usual one."""
    known = [(one.path.name, found) for one in headers if (found := measure_density(one))]
    if len(known) < 2:
        return []
    usual = median(density for _, density in known)
    odd = [name for name, density in known if not usual / _UNEVEN <= density <= usual * _UNEVEN]
    if not odd:
        return []
    verb = "has" if len(odd) == 1 else "have"
    text = (
        f"{_name(odd)} {verb} more than {_UNEVEN:g} times as many, or as few, points in an area as "
        f"the usual file, which has {usual:.3g} per square unit."
    )
    return [Disagreement("density", text, tuple(odd))]


def _find_overlaps(headers: Sequence[SourceHeader]) -> list[Overlap]:
    """Return the pairs of files in one CRS whose bounds overlap, those that do most first."""
    known: list[tuple[SourceHeader, Bounds]] = [
        (one, one.bounds) for one in headers if one.bounds is not None and one.count != 0
    ]
    boxes = np.array([(b.xmin, b.ymin, b.xmax, b.ymax) for _, b in known]).reshape(-1, 4)
    areas = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    labels = np.array([str(one.crs) for one, _ in known])
    found = []
    for k in range(len(known)):
        low = np.maximum(boxes[k, :2], boxes[k + 1 :, :2])
        sides = np.maximum(np.minimum(boxes[k, 2:], boxes[k + 1 :, 2:]) - low, 0.0)
        smaller = np.minimum(areas[k], areas[k + 1 :])
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(smaller > 0.0, sides[:, 0] * sides[:, 1] / smaller, 0.0)
        shares[labels[k + 1 :] != labels[k]] = 0.0
        found += [
            Overlap(known[k][0].path.name, known[k + 1 + other][0].path.name, float(shares[other]))
            for other in np.flatnonzero(shares > _LEAST_SHARE).tolist()
        ]
    return sorted(found, key=lambda one: -one.share)


def _describe_overlaps(overlaps: Sequence[Overlap]) -> list[Disagreement]:
    if not overlaps:
        return []
    shown = [
        f"'{one.first}' and '{one.second}' ({one.share:.0%} of the smaller)"
        for one in overlaps[:_SHOWN]
    ]
    more = f" and {len(overlaps) - _SHOWN:,} more pairs" if len(overlaps) > _SHOWN else ""
    files = dict.fromkeys(name for one in overlaps for name in (one.first, one.second))
    return [
        Disagreement(
            "overlap", f"The bounds of files overlap: {'; '.join(shown)}{more}.", tuple(files)
        )
    ]
