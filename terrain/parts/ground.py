"""The ground among the points of a tile, found with those of a margin around it.

The filter is not local: an opening reaches as far as its windows are wide, and a vertex that is
added to a TIN lets its neighbours in. The cells, the origin and the rim are those of all points, so
that nothing but the reach tells a tile from the whole. How many labels differ is measured by
``python -m benchmarks.ground_tiles``; docs/many-files.md says how many.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.progress import Progress
from ...base.types import Bounds
from ..ground_filter import Frame, Units, classify

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, UInt8Array
    from ..ground_filter import Parameters

_BUILDINGS = 3.0
"""Widths of the largest building that are read around a tile."""


def choose_reach(parameters: Parameters) -> float:
    """Return how far around a tile points are looked at, in metres."""
    return _BUILDINGS * parameters.building


@dataclass(frozen=True)
class GroundWindow:
    """A tile with its margin."""

    units: Units
    """Of all points."""
    frame: Frame
    """Cells of the tile and its margin, among those of all points."""
    parameters: Parameters

    @classmethod
    def around(
        cls, box: Bounds, whole: Frame, units: Units, parameters: Parameters, reach: float
    ) -> GroundWindow:
        """Return the window of a tile; ``reach`` is in metres."""
        low, high = (
            (np.array(corner) - units.low[:2]) * units.across
            for corner in ((box.xmin, box.ymin), (box.xmax, box.ymax))
        )
        return cls(units, whole.cut(low - reach, high + reach), parameters)

    @property
    def bounds(self) -> Bounds:
        """A box that holds the window, in the unit of the points."""
        low, high = self.frame.corners
        slack = self.frame.side / 2
        west, south = ((low - slack) / self.units.across + self.units.low[:2]).tolist()
        east, north = ((high + slack) / self.units.across + self.units.low[:2]).tolist()
        return Bounds(west, south, east, north)

    def classify(self, points: Float64Array) -> UInt8Array:
        """Return the classes of candidates, 0 for those beyond the window.

        Parameters
        ----------
        points : (n, 3) float64 array
            All candidates within ``bounds``, in the unit of the points.
        """
        classes = np.zeros(len(points), np.uint8)
        metric = self.units.to_metric(points)
        cells = self.frame.locate(metric)
        rows = np.flatnonzero(((cells >= 0) & (cells < self.frame.shape)).all(axis=1))
        if len(rows):
            metric = np.ascontiguousarray(metric[rows])
            is_candidate = np.ones(len(rows), np.bool_)
            found, _ = classify(metric, is_candidate, self.frame, self.parameters, Progress(None))
            classes[rows] = found
        return classes
