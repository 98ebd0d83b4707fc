"""Labels of contours: where an elevation is written along a line, and how it is turned."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.checks import as_flag, as_length
from ...base.errors import OptionError
from ...base.results import Features
from ...base.types import seal
from ..drawing import turn_upright

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int64Array

_MOST_DECIMALS = 15
_SMALL_SHARE = 1e-6
_SHARE_OF_EXTENT = 3.0
_SHORTEST = 0.2
"""A line shorter than this share of the spacing has no label."""
_WINDOW = 0.04
"""Of the spacing, to each side: so far a line is taken to run along its label."""
_TRIES = np.linspace(-0.25, 0.25, 11)
"""Shares of the spacing by which a label is moved to where the line is straightest."""
_APART = 0.12
"""Labels are no nearer to one another than this share of the spacing."""


class _Label(NamedTuple):
    x: float
    y: float
    rotation: float
    uphill: str
    line: int


def contour_labels(
    lines: Features, *, spacing: float | None = None, index_only: bool = True
) -> Features:
    """Place labels along contours.

    Parameters
    ----------
    lines : Features
        As :func:`tinsmith.contours` returns them.
    spacing : float, optional
        Between labels of one line, in CRS units; default a third of the extent.
    index_only : bool, optional
        Label index contours alone, unless there are none.

    Returns
    -------
    Features
        Points with the columns text, elevation, rotation, uphill and line (the number of the line).
        ``rotation`` is in degrees counter-clockwise from east, above -90 up to 90, so that a text
        centred there reads upright on a map with north up. ``uphill`` tells on which side of the
        text the ground rises: "above" or "below" it.

    Raises
    ------
    OptionError
        If the spacing is not above 0, or the features are no contours.

    Notes
    -----
    A label stands where the line is straightest near its regular place. Lines shorter than a fifth
    of the spacing have none, and of labels that would lie nearer than an eighth the first is kept.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [9, 0, 9], [9, 9, 9], [0, 9, 0]])
    >>> labels = ts.contour_labels(ts.contours(tin, interval=5, index=1), spacing=9)
    >>> labels.columns["text"], labels.columns["rotation"], labels.columns["uphill"]
    (array(['5'], dtype=object), array([90.]), array(['below'], dtype=object))
    """
    names = ("elevation", "is_index", "is_closed")
    if not isinstance(lines, Features) or not all(name in lines.columns for name in names):
        raise OptionError("lines", lines, "contours, as tinsmith.contours returns them")
    if spacing is None:
        spacing = _choose_spacing(lines)
    spacing = as_length("spacing", spacing)
    is_chosen = lines.columns["is_index"]
    if not as_flag("index_only", index_only) or not is_chosen.any():
        is_chosen = np.ones(len(lines), np.bool_)
    placed = _place_labels(lines, np.flatnonzero(is_chosen), spacing)
    return _as_features(lines, placed)


def _choose_spacing(lines: Features) -> float:
    if len(lines) == 0:
        return 1.0
    bounds = lines.bounds
    return max(bounds.xmax - bounds.xmin, bounds.ymax - bounds.ymin) / _SHARE_OF_EXTENT


def _place_labels(lines: Features, chosen: Int64Array, spacing: float) -> list[_Label]:
    placed: list[_Label] = []
    taken = _TakenPlaces(_APART * spacing)
    for number in chosen.tolist():
        first, last = lines.offsets[0][number : number + 2]
        way = _Way(lines.coordinates[first:last, :2], bool(lines.columns["is_closed"][number]))
        for at in way.places(spacing):
            label = way.label_at(at, _WINDOW * spacing, number)
            if taken.take(label.x, label.y):
                placed.append(label)
    return placed


class _Way:
    """A line by the distance along it."""

    def __init__(self, xy: Float64Array, is_closed: bool) -> None:
        self._xy = xy
        self._along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))])
        self._is_closed = is_closed

    @property
    def length(self) -> float:
        return float(self._along[-1])

    def places(self, spacing: float) -> list[float]:
        """Return the distances at which labels stand."""
        if self.length < _SHORTEST * spacing:
            return []
        count = max(1, round(self.length / spacing))
        regular = (np.arange(count) + 0.5) * self.length / count
        reach = min(spacing, self.length / count)
        tried = regular[:, None] + _TRIES * reach
        window = _WINDOW * spacing
        chords = np.linalg.norm(self._at(tried + window) - self._at(tried - window), axis=-1)
        order = np.lexsort((np.broadcast_to(np.abs(_TRIES), tried.shape), -chords.round(9)))
        best = tried[np.arange(count), order[:, 0]]
        places: list[float] = (best if self._is_closed else best.clip(0.0, self.length)).tolist()
        return places

    def label_at(self, at: float, window: float, number: int) -> _Label:
        x, y = self._at(np.array([at]))[0]
        east, north = np.subtract(*self._at(np.array([at + window, at - window])))
        heading = float(np.degrees(np.arctan2(north, east)))
        is_upright = -90.0 < heading <= 90.0  # along the line the higher side is on the left
        uphill = "above" if is_upright else "below"
        return _Label(float(x), float(y), float(turn_upright(heading)), uphill, number)

    def _at(self, along: Float64Array) -> Float64Array:
        if self._is_closed:
            along = along % self.length
        along = np.clip(along, 0.0, self.length)
        return np.stack([np.interp(along, self._along, axis) for axis in self._xy.T], axis=-1)


class _TakenPlaces:
    """Places by cells as wide as they must be apart."""

    def __init__(self, apart: float) -> None:
        self._apart = apart
        self._cells: dict[tuple[int, int], list[tuple[float, float]]] = {}

    def take(self, x: float, y: float) -> bool:
        """Take a place, unless one nearby is taken."""
        column, row = int(x // self._apart), int(y // self._apart)
        near = [
            place
            for i in (column - 1, column, column + 1)
            for j in (row - 1, row, row + 1)
            for place in self._cells.get((i, j), ())
        ]
        if any(np.hypot(x - one, y - other) < self._apart for one, other in near):
            return False
        self._cells.setdefault((column, row), []).append((x, y))
        return True


def _as_features(lines: Features, labels: list[_Label]) -> Features:
    numbers = np.array([label.line for label in labels], np.int64)
    levels = lines.columns["elevation"][numbers]
    decimals = count_decimals(lines.columns["elevation"])
    places = np.array([(label.x, label.y) for label in labels], np.float64).reshape(-1, 2)
    columns: dict[str, AnyArray] = {
        "text": np.array([f"{level + 0.0:.{decimals}f}" for level in levels] or [], object),
        "elevation": levels,
        "rotation": np.array([label.rotation for label in labels], np.float64),
        "uphill": np.array([label.uphill for label in labels] or [], object),
        "line": numbers,
    }
    return Features.of_points(
        seal(np.column_stack([places, levels])),
        columns={name: seal(values) for name, values in columns.items()},
        units={"elevation": lines.units.get("elevation"), "rotation": "°"},
        crs=lines.crs,
        elevation_unit=lines.elevation_unit,
        name="contour labels",
        notes=lines.notes,
    )


def count_decimals(levels: Float64Array) -> int:
    """Return how many decimals tell the levels to a millionth of the least step between them."""
    levels = np.unique(levels)
    steps = np.diff(levels) if len(levels) > 1 else np.abs(levels)
    allowed = _SMALL_SHARE * float(steps.min(initial=np.inf))
    for decimals in range(_MOST_DECIMALS):
        if (np.abs(levels.round(decimals) - levels) <= allowed).all():
            return decimals
    return _MOST_DECIMALS
