"""The axis of a corridor: an alignment with its profile, or a line in space."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.checks import as_number
from ....base.errors import LinesError, OptionError
from ....base.georeference import agree, require_same_crs
from ....base.sentences import coordinate, height
from ...surface import as_features, find_reference
from ..alignments import Alignment, Element, VerticalAlignment, VerticalPoint

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from ....base.georeference import Reference
    from ....tin import TIN
    from ..alignments import VerticalAlignment as Profile

_APART = 1e-3
"""CRS units: an axis whose ends are nearer closes."""
_SHARE = 0.382
"""Of an element, at which an axis that closes is opened: so seldom anything else is there."""


class Lap(NamedTuple):
    """An axis that closes: stations go on behind the last one, and begin within an element."""

    start: float
    end: float

    @property
    def length(self) -> float:
        """Of the whole axis, CRS units."""
        return self.end - self.start

    def wrap(self, stations: Float64Array) -> Float64Array:
        """Return stations of the axis as it was given."""
        return np.where(stations > self.end, stations - self.length, stations)

    def split(self, low: float, high: float) -> list[tuple[float, float]]:
        """Return a range of stations as one or two of the axis as it was given."""
        if low < self.end < high:
            return [(low, self.end), (self.start, high - self.length)]
        low, high = self.wrap(np.array([low, high])).tolist()
        return [(low, high) if low <= high else (self.start, high)]

    def repeat(self, stations: Float64Array) -> Float64Array:
        """Return stations of the axis as it was given, and the same of the next time around."""
        within = stations[(stations >= self.start) & (stations <= self.end)]
        return np.concatenate([within, within + self.length])


class Axis(NamedTuple):
    """An alignment, one of its vertical alignments, and what of it is built."""

    alignment: Alignment
    profile: Profile
    span: tuple[float, float]
    """The first and the last station."""
    agreed: Reference
    """CRS and units of the ground and of the axis."""
    up: float
    """From elevations, in the unit that was agreed on, to the unit of eastings."""
    notes: tuple[str, ...]
    lap: Lap | None = None
    """Of an axis that closes."""

    def wrap(self, stations: Float64Array) -> Float64Array:
        """Return stations as they are given and told: of an axis that closes within one lap."""
        return stations if self.lap is None else self.lap.wrap(stations)

    def elevations_at(self, stations: Float64Array) -> Float64Array:
        """Return designed elevations in the unit that was agreed on."""
        low, high = self.span if self.lap is None else self.lap
        found = self.profile.elevations_at(np.clip(self.wrap(stations), low, high))
        return np.asarray(found * self.agreed.factors[1])

    def repeat(self, stations: Float64Array) -> Float64Array:
        """Return stations that are given, of an axis that closes those of the next lap as well."""
        return stations if self.lap is None else self.lap.repeat(stations)


def read_axis(tin: TIN, given: Any, vertical: str | None, start: Any, end: Any) -> Axis:
    """Return what a template is carried along.

    Raises OptionError, LinesError and CrsError as :func:`tinsmith.corridor`.
    """
    up = find_reference(tin, "Slopes").up
    is_line = not isinstance(given, Alignment)
    alignment = _follow_line(given) if is_line else given
    is_plain = is_line and not hasattr(given, "crs")
    notes = require_same_crs(alignment.crs, tin.crs, "the axis", is_plain=is_plain)
    if alignment.crs is None and tin.crs is not None:
        unit = alignment.elevation_unit or (tin.elevation_unit if is_plain else None)
        alignment = replace(alignment, crs=tin.crs, elevation_unit=unit)
    if not alignment.verticals:
        raise LinesError(
            "The alignment has no vertical alignment: a corridor needs designed elevations."
        )
    profile = alignment.find_vertical(vertical)
    span, short = _find_span(alignment, profile, start, end)
    lap = _find_lap(alignment, profile, span)
    agreed = agree((tin, alignment), ("the ground", "the axis"))
    if agreed.factors[0] != 1.0 or agreed.elevation_unit != tin.elevation_unit:
        up = agreed.up
    told = (*alignment.notes, *notes, *short)
    if lap is not None:
        alignment = _open(alignment)
        span = alignment.start, alignment.end
    return Axis(alignment, profile, span, agreed, up, told, lap)


def _find_lap(alignment: Alignment, profile: Profile, span: tuple[float, float]) -> Lap | None:
    """Return the stations of an axis that closes and is built as a whole, or None.

    Raises LinesError if its elevations do not close.
    """
    lap = Lap(alignment.start, alignment.end)
    first, last = alignment.points_at(lap)
    is_whole = np.abs(np.subtract(span, lap)).max() <= alignment.rounding
    if not is_whole or np.hypot(*(last - first)) > _APART:
        return None
    step = float(np.ptp(profile.elevations_at(np.array(span))))
    if step > _APART:
        raise LinesError(
            f"The axis closes, but its elevations at the first and the last station differ by "
            f"{height(step)}: they must be the same."
        )
    return lap


def _open(alignment: Alignment) -> Alignment:
    """Return an axis that closes from within a line or an arc on, where its tangent goes on."""
    elements = list(alignment.elements)
    lengths = [one.length if one.kind in ("line", "arc") else 0.0 for one in elements]
    chosen = int(np.argmax(lengths))
    if not lengths[chosen]:
        raise LinesError("The axis closes and has neither a line nor an arc: one is needed.")
    cut = elements[chosen]
    along = _SHARE * cut.length
    curved = cut.start_curvature, cut.end_curvature
    place, direction = cut.places([along])[0], float(cut.directions([along])[0])
    x, y = place.tolist()
    after = Element(cut.kind, (x, y), direction, cut.length - along, *curved)
    before = Element(cut.kind, cut.start, cut.direction, along, *curved)
    turned = [after, *elements[chosen + 1 :], *elements[:chosen], before]
    begin = alignment.start + sum(one.length for one in elements[:chosen]) + along
    return replace(alignment, elements=turned, start=begin, equations=(), verticals=())


def _follow_line(given: Any) -> Alignment:
    """Return a line in space as an alignment whose profile has its elevations."""
    features = as_features(given, "axis")
    if features.kind != "lines" or len(features.offsets[0]) != 2:
        raise LinesError("An axis is one line, or an alignment.")
    points = features.coordinates
    if points.shape[1] < 3 or not np.isfinite(points[:, 2]).all():
        raise LinesError("The axis has no elevations: a line in space, or an alignment, is needed.")
    is_new = np.append(True, (np.diff(points[:, :2], axis=0) != 0.0).any(axis=1))
    lost = np.flatnonzero(~is_new)
    if len(lost) and (points[lost, 2] != points[lost - 1, 2]).any():
        x, y = points[lost[0], :2].tolist()
        raise LinesError(f"The axis is vertical at {coordinate(x)} {coordinate(y)}.")
    points = points[is_new]
    if len(points) < 2:
        raise LinesError("The axis has no length.")
    plan = Alignment.from_points(points[:, :2], crs=features.crs)
    stations = [*plan.tabulate()["station"].tolist(), plan.end]
    heights = zip(stations, points[:, 2].tolist(), strict=True)
    profile = VerticalAlignment([VerticalPoint(*one) for one in heights])
    return replace(
        plan,
        verticals=(profile,),
        elevation_unit=features.elevation_unit,
        notes=features.notes,
    )


def _find_span(
    alignment: Alignment, profile: Profile, start: Any, end: Any
) -> tuple[tuple[float, float], tuple[str, ...]]:
    """Return the first and the last station, and what is told of them."""
    low, high = max(alignment.start, profile.start), min(alignment.end, profile.end)
    rounding = alignment.rounding
    if not low < high:
        raise LinesError(
            f"The vertical alignment goes from {coordinate(profile.start)} to "
            f"{coordinate(profile.end)}, and the alignment from {coordinate(alignment.start)} to "
            f"{coordinate(alignment.end)}: they have no station in common."
        )
    notes: tuple[str, ...] = ()
    is_short = low > alignment.start + rounding or high < alignment.end - rounding
    if start is None and end is None and is_short:
        notes = (
            f"The vertical alignment goes from {coordinate(low)} to {coordinate(high)}, and the "
            f"alignment from {coordinate(alignment.start)} to {coordinate(alignment.end)}: the "
            "corridor is built where both are.",
        )
    begin = low if start is None else as_number("start", start)
    finish = high if end is None else as_number("end", end)
    for name, value in (("start", begin), ("end", finish)):
        if not low - rounding <= value <= high + rounding:
            allowed = f"from {coordinate(low)} to {coordinate(high)}, where elevations are designed"
            raise OptionError(name, value, allowed)
    if not begin < finish:
        raise OptionError("end", finish, f"above {coordinate(begin)}, the start")
    return (max(begin, low), min(finish, high)), notes
