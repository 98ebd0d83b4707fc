"""Read an axis of a drawing: lines, arcs and polylines of the plane, joined end to end."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import ReadError
from ....base.georeference import find_axes
from ....base.sentences import FILE, coordinate, counted
from ....terrain import Alignment, Element
from ..reference import Declared, choose_measures, require_own_crs
from .model_space import read_model_space

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import Float64Array
    from ....base.crs import CrsLike, UnitLike

_JOINED = 1e-6
"""Of the extent of all: ends that are nearer than this, or a millionth of a unit, are one."""

_TOLERANCE = 1e-4
"""Units of the drawing that splines and ellipses may lie from their chords."""


class _Path(NamedTuple):
    """A polyline with arcs."""

    places: Float64Array
    """(k, 2)."""
    bulges: Float64Array
    """(k,), of what follows each place."""

    def reverse(self) -> _Path:
        """Return it from its end to its start."""
        return _Path(self.places[::-1], np.append(-self.bulges[:-1][::-1], 0.0))

    def join(self, after: _Path) -> _Path:
        """Return it with another one that begins where it ends."""
        places = np.concatenate([self.places[:-1], after.places])
        return _Path(places, np.concatenate([self.bulges[:-1], after.bulges]))


def read_alignment(
    path: Path,
    layer: str | None = None,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
) -> Alignment:
    """Read the one axis of a drawing, or of a layer, as :func:`tinsmith.read_alignment` does."""
    declared = Declared.of(crs, unit, elevation_unit)
    found = read_model_space(path, layer=layer, tolerance=_TOLERANCE, keeps_arcs=True)
    rows = found.arrays["lines"]
    stated = found.stated
    require_own_crs(stated, declared)
    measures = choose_measures(stated, declared, sample=rows[:64, :2])
    ends = np.cumsum(found.arrays["lengths"])[:-1]
    places = np.split(found.arrays["lines"][:, :2], ends)
    bulges = np.split(found.arrays["bulges"], ends)
    paths = [
        _Path(xy, own)
        for xy, own in zip(places, bulges, strict=True)
        if len(xy) > 1 and (xy != xy[0]).any()
    ]
    if not paths:
        raise ReadError(f"{FILE} has no lines in the layers read.")
    joined = _join(paths)
    sign = -1.0 if measures.is_swapped or find_axes(measures.source).are_mirrored else 1.0
    placed = _Path(measures.apply(joined.places)[:, :2] + 0.0, sign * joined.bulges)
    notes = [*measures.notes, *found.describe_left_out()]
    if found.value["n_curves"]:
        notes.append(f"Splines and ellipses became chords within {_TOLERANCE} of them.")
    if len(paths) > 1:
        notes.append(
            f"{counted(len(paths), 'line')} were joined end to end, in the direction of the first."
        )
    return Alignment(
        _lay_elements(placed),
        name=layer or "",
        crs=measures.source,
        elevation_unit=measures.elevation_unit,
        notes=notes,
    )


def _join(paths: list[_Path]) -> _Path:
    """Return paths as one, in the direction of the first; refuse what is several or forks."""
    everything = np.concatenate([one.places for one in paths])
    near = max(1e-6, _JOINED * float(np.ptp(everything, axis=0).max()))
    chain, rest = paths[0], list(paths[1:])
    while rest:
        options = [
            (k, joined)
            for k, one in enumerate(rest)
            for turned in (one, one.reverse())
            for joined in _try_join(chain, turned, near)
        ]
        if not options:
            x, y = chain.places[-1].tolist()
            raise ReadError(
                f"{FILE} has {counted(len(paths), 'line')} that do not make one axis: nothing goes "
                f"on at ({coordinate(x)}, {coordinate(y)}). Name the layer of one axis."
            )
        if len({k for k, _ in options}) > 2 or len(options) > 2:
            raise ReadError(
                f"{FILE} has {counted(len(paths), 'line')} that fork, where one axis is needed: "
                "name the layer of one axis."
            )
        k, chain = options[0]
        del rest[k]
    return chain


def _try_join(chain: _Path, other: _Path, near: float) -> list[_Path]:
    """Return the chain with another path behind or before it, where their ends meet."""
    found = []
    if math.dist(chain.places[-1], other.places[0]) <= near:
        found.append(chain.join(other))
    elif math.dist(other.places[-1], chain.places[0]) <= near:
        found.append(other.join(chain))
    return found


def _lay_elements(path: _Path) -> list[Element]:
    elements = []
    for start, end, bulge in zip(
        path.places[:-1].tolist(), path.places[1:].tolist(), path.bulges.tolist(), strict=False
    ):
        chord = math.dist(start, end)
        if chord == 0.0:
            continue
        direction = math.atan2(end[1] - start[1], end[0] - start[0])
        if bulge == 0.0:
            elements.append(Element("line", (start[0], start[1]), direction, chord))
            continue
        angle = 4.0 * math.atan(bulge)
        curvature = 2.0 * math.sin(angle / 2.0) / chord
        first = direction - angle / 2.0
        elements.append(
            Element("arc", (start[0], start[1]), first, angle / curvature, curvature, curvature)
        )
    return elements
