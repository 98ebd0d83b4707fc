"""Seeds of the ground: low noise left out, then the lowest points that no opening lifts away.

References
----------
K. Zhang et al., "A progressive morphological filter for removing nonground measurements from
airborne LIDAR data", IEEE Transactions on Geoscience and Remote Sensing 41 (2003). T. Pingel,
K. Clarke and W. McBride, "An improved simple morphological filter for the terrain classification
of airborne LIDAR data", ISPRS Journal 77 (2013). X. Zhao et al., "Improved progressive TIN
densification filtering algorithm for airborne LiDAR data in forested areas", ISPRS Journal 117
(2016): seeds by opening in place of the lowest point of a large cell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.progress import Progress
from .morphology import find_covered, least_around, list_windows, open_grid, split_columns

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.progress import Tell
    from .frame import Cells
    from .parameters import Parameters

_FRAMES = ((2, 7, False), (1, 4, True), (3, 10, True))
"""A group of low points is no wider than the first to each side, and compared with points up to the
second; in cells. What another group hides in a wide frame is found in a narrow one. At a border
some of a frame is empty, and the lowest corner of a slope would be taken for a pit."""

_ROUNDS = 5
"""How often low points are looked for again, when others that hid them have gone."""

_GAP = 4
"""Half width in cells of gaps between points; what is wider is beyond the border of the data."""


def find_low_noise(
    points: Float64Array,
    cells: Cells,
    is_taken: BoolArray,
    parameters: Parameters,
    progress: Tell | None = None,
) -> BoolArray:
    """Find points of those taken that lie deeper than all around, alone or in a small group."""
    done = Progress(progress)
    is_noise = np.zeros(len(points), bool)
    z = np.ascontiguousarray(points[:, 2])
    for number in range(_ROUNDS):
        grid = cells.spread(cells.find_lowest(is_taken & ~is_noise), z)
        is_low = np.zeros(len(points), bool)
        for k, frame in enumerate(_FRAMES, 1):
            least = _find_least_around(grid, *frame).reshape(-1)[cells.number]
            is_low |= (z < least - parameters.noise_depth) & np.isfinite(least)
            done((number + k / len(_FRAMES)) / _ROUNDS)
        is_low &= is_taken & ~is_noise
        if not is_low.any():
            break
        is_noise |= is_low
    return is_noise


def _find_least_around(grid: Float64Array, core: int, reach: int, is_whole: bool) -> Float64Array:
    around = np.empty_like(grid)
    for wide, inner, own in split_columns(grid.shape, reach):
        around[own] = least_around(grid[wide], core, reach, is_whole=is_whole)[inner]
    return around


def find_seeds(
    heights: Float64Array,
    cells: Cells,
    lowest: Int64Array,
    parameters: Parameters,
    progress: Tell | None = None,
) -> BoolArray:
    """Tell which of the lowest points of cells, by their rows, are part of no object.

    Openings by growing windows take off whatever is narrower: what one of them lifts by more than
    the terrain can rise within the window, by its slope, is an object. The heights of all points
    are above a level, or above a first surface of the ground, which takes its slope away.
    """
    grid = cells.spread(lowest, heights)
    half = max(1, int(np.ceil(parameters.building / (2 * parameters.cell))))
    is_object = _find_objects(grid, list_windows(half), parameters, Progress(progress))
    is_seed: BoolArray = ~is_object.reshape(-1)[cells.number[lowest]]
    return is_seed


def _find_objects(
    grid: Float64Array, windows: list[int], parameters: Parameters, done: Progress
) -> BoolArray:
    is_empty = np.isinf(grid)
    is_object = np.zeros(grid.shape, bool)
    is_covered = np.empty(grid.shape, bool)
    for wide, inner, own in split_columns(grid.shape, 2 * _GAP):
        is_covered[own] = find_covered(~is_empty[wide], _GAP)[inner]
    for number, window in enumerate(windows, 1):
        opened = np.empty_like(grid)
        for wide, inner, own in split_columns(grid.shape, 2 * window):
            opened[own] = open_grid(grid[wide], window, is_covered[wide])[inner]
        opened[is_empty] = np.inf
        rise = parameters.terrain_slope * window * parameters.cell
        with np.errstate(invalid="ignore"):  # cells that are empty, which compare as false
            rounding = np.finfo(float).eps * np.maximum(np.abs(grid), np.abs(opened))
            is_object |= grid - opened > rise + rounding
        grid = opened
        done(number / len(windows))
    return is_object
