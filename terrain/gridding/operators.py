"""Operators: what a cell of a grid and its eight neighbours tell, as of gdaldem.

`OPERATORS` lists them. A cell without an elevation has no value, and neither has one beside such a
cell or at the rim of the grid, unless edges are computed: then a neighbour without an elevation has
that of the cell itself, and beyond the rim elevations go on straight, as gdaldem has it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_flag
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, PointsError, choice
from ...base.georeference import find_axes, find_scales
from ...base.policies import GridOperator, NeighborhoodValue, PlaneValue, RasterValue
from ...base.results import find_turn, locate_centers
from ...base.sentences import counted, write_spacing
from ..surface import NORTHWEST, Derivatives, Light, PlaneMeasure, measure_curvatures
from .grids import as_parts

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import Float64Array
    from ...base.progress import Progress
    from ...base.types import Grid
    from .bands import SurfaceBand

_BLOCK_CELLS = 1 << 20
"""Cells computed in one go, about: nine copies of them are held."""

_CURVATURES: tuple[NeighborhoodValue, ...] = (
    "profile-curvature",
    "plan-curvature",
    "tangential-curvature",
    "mean-curvature",
    "gaussian-curvature",
)

OPERATORS: dict[RasterValue, tuple[GridOperator, ...]] = {
    **dict.fromkeys(("slope", "aspect", "hillshade"), ("horn", "zevenbergen-thorne")),
    **dict.fromkeys(_CURVATURES, ("zevenbergen-thorne",)),
    "tri": ("riley", "wilson"),
    "tpi": (),
    "roughness": (),
}
"""The operators of each value that has any; the first is usual, but of values of planes, which the
surface has without one."""

_LARGEST = 1e150
"""Of elevations: squares of the differences of larger ones overflow."""

_OF_PLANES = ("slope", "aspect", "hillshade")

_OVERFLOW = (
    "Elevations are too large, or cells too small, for what is computed of cells and their "
    "neighbours in double precision: it overflows."
)

_SOURCES = {
    "horn": "Horn's operator (1981)",
    "zevenbergen-thorne": "the operator of Zevenbergen and Thorne (1987)",
    "riley": "the formula of Riley et al. (1999)",
    "wilson": "the formula of Wilson et al. (2007)",
}


class GridMeasure(NamedTuple):
    """What is measured of a cell and its neighbours, and how."""

    value: PlaneValue | NeighborhoodValue
    operator: GridOperator | None
    computes_edges: bool = False
    light: Light = NORTHWEST
    crs: CRS | None = None
    elevation_unit: Unit | None = None

    def describe(self) -> str:
        """Return a sentence that tells how values were found."""
        source = f" by {_SOURCES[self.operator]}" if self.operator else ""
        edges = (
            "neighbours without an elevation have that of the cell, and beyond the rim of the grid "
            "elevations go on straight"
            if self.computes_edges
            else "cells at the rim of the grid, and beside a cell without an elevation, have none"
        )
        return (
            f"Values of {self.value} are of cells and their eight neighbours{source}, not of the "
            f"surface between them; {edges}."
        )


def has_operator(value: RasterValue, operator: GridOperator | None) -> bool:
    """Whether a value is computed from cells and their neighbours."""
    return operator is not None or (value in OPERATORS and value not in _OF_PLANES)


def make_measure(
    value: RasterValue,
    operator: Any,
    compute_edges: Any,
    *,
    light: Light,
    crs: CRS | None = None,
    elevation_unit: Unit | None = None,
) -> GridMeasure | None:
    """Return what is measured of cells and their neighbours; None for what the surface tells.

    Raises OptionError for an operator that the value does not have, or edges where there is none.
    """
    edges = as_flag("compute_edges", compute_edges)
    if operator is not None:
        choice("operator", operator, GridOperator)
        known = OPERATORS.get(value, ())
        if operator not in known:
            allowed = f"{' or '.join(known)} for {value}" if known else f"None for {value}"
            raise OptionError("operator", operator, allowed)
    if not has_operator(value, operator):
        if edges:
            raise OptionError("compute_edges", edges, f"False for {value} without an operator")
        return None
    chosen = operator or next(iter(OPERATORS[value]), None)
    found: Any = value
    return GridMeasure(found, chosen, edges, light, crs, elevation_unit)


def describe_no_value(measure: GridMeasure, grid: Grid) -> str:
    """Return a sentence that says why no cell has a value."""
    need = (
        "an elevation" if measure.computes_edges else "an elevation and eight neighbours with one"
    )
    rows, columns = grid.shape
    return (
        f"No cell has a value of {measure.value}, for which it needs {need}: the raster has "
        f"{counted(rows, 'row')} and {counted(columns, 'column')} of cells "
        f"{write_spacing(grid.spacing)} wide."
    )


def require_aligned(measure: GridMeasure | None, grid: Grid) -> None:
    """Refuse, by an OptionError, operators whose neighbours lie to the east and north elsewhere."""
    if measure is None or grid.is_aligned or (measure.value, measure.operator) in _RUGGEDNESS:
        return
    what = "rotated or sheared cells, whose neighbours are not to the east and north of them"
    if measure.value in _OF_PLANES:
        raise OptionError("operator", measure.operator, f"None for {measure.value} of {what}")
    others = ", ".join(("elevation", *_OF_PLANES, *(name for name, _ in _RUGGEDNESS)))
    raise OptionError("value", measure.value, f"one of {others} for {what}")


class OperatorBand:
    """Cells computed from those of a band of elevations, as they are asked for."""

    dtype = np.dtype(np.float64)

    def __init__(self, elevations: SurfaceBand, grid: Grid, measure: GridMeasure) -> None:
        self._elevations = elevations
        self._grid = grid
        self._measure = measure

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._grid.shape

    def __getitem__(self, key: tuple[slice, slice]) -> Float64Array:
        """Compute a block; slices have no step."""
        rows, columns = as_parts(key, self.shape)
        shape = max(0, rows.stop - rows.start), max(0, columns.stop - columns.start)
        if 0 in shape:
            return np.empty(shape)
        return self._compute(rows, columns)

    def compute(self, progress: Progress) -> Float64Array:
        """Compute all cells, and tell how far it is."""
        height, width = self.shape
        made, step = np.empty(self.shape), max(1, _BLOCK_CELLS // width)
        tell = progress.stage(0.1, 1.0)
        for top in range(0, height, step):
            rows = slice(top, min(top + step, height))
            made[rows] = self._compute(rows, slice(0, width))
            if tell is not None:
                tell(rows.stop / height)
        return made

    def require_any(self) -> None:
        """Refuse, by a PointsError, a raster no cell of which would have a value."""
        height, width = self.shape
        step = max(1, _BLOCK_CELLS // width)
        for top in range(0, height, step):
            if self._list_neighbors(slice(top, min(top + step, height)), slice(0, width))[1].any():
                return
        raise PointsError(describe_no_value(self._measure, self._grid))

    def _compute(self, rows: slice, columns: slice) -> Float64Array:
        z, is_known = self._list_neighbors(rows, columns)
        if np.nanmax(np.abs(z[4]), initial=0.0) > _LARGEST:
            raise PointsError(_OVERFLOW)
        measure = self._measure
        if (measure.value, measure.operator) in _RUGGEDNESS:
            return self._measure_ruggedness(z, is_known)
        y = locate_centers(self._grid, rows, columns)[1]
        scales = find_scales(measure.crs, measure.elevation_unit, y)
        steps = [
            np.reshape(scale * side, (-1, 1))
            for scale, side in zip(scales[:2], self._grid.cell_size, strict=True)
        ]
        with np.errstate(over="ignore", invalid="ignore"):  # refused below
            if measure.value in _OF_PLANES:
                found = _measure_planes(z, (steps[0], steps[1]), scales.up, measure)
            else:
                found = _measure_curvature(z, (steps[0], steps[1]), scales.up, measure)
        return _require_finite(found, is_known)

    def _measure_ruggedness(self, z: list[Float64Array], is_known: Any) -> Float64Array:
        with np.errstate(over="ignore", invalid="ignore"):
            found = _RUGGEDNESS[self._measure.value, self._measure.operator](z)
        return _require_finite(found, is_known)

    def _list_neighbors(self, rows: slice, columns: slice) -> tuple[list[Float64Array], Any]:
        """Return elevations of cells and neighbours, and which cells have all that are needed.

        They are nine arrays, of the cells to the north-west first, row by row.
        """
        height, width = rows.stop - rows.start, columns.stop - columns.start
        around = self._read_around(rows, columns)
        z = [around[k : k + height, j : j + width] for k in range(3) for j in range(3)]
        if self._measure.computes_edges and min(self.shape) > 1:
            z = [one.copy() for one in z]
            self._repeat_at_corners(z, rows, columns)
            z = [np.where(np.isnan(one), z[4], one) for one in z]
        is_known = ~np.isnan(z[4])
        for one in z:
            is_known &= ~np.isnan(one)
        turn = find_turn(self._grid)
        order = np.arange(9).reshape(3, 3)[:: turn.rows, :: turn.columns].ravel()
        return [z[k] for k in order], is_known

    def _read_around(self, rows: slice, columns: slice) -> Float64Array:
        """Return elevations of cells with one more on each side, beyond the rim NaN or straight."""
        wide = [slice(part.start - 1, part.stop + 1) for part in (rows, columns)]
        held = [
            slice(max(0, part.start), min(side, part.stop))
            for part, side in zip(wide, self.shape, strict=True)
        ]
        beyond = [
            (inner.start - outer.start, outer.stop - inner.stop)
            for inner, outer in zip(held, wide, strict=True)
        ]
        z = np.pad(self._elevations[held[0], held[1]], beyond, constant_values=math.nan)
        if self._measure.computes_edges and min(self.shape) > 1:
            for turned, (first, last) in ((z, beyond[0]), (z.T, beyond[1])):
                if first:
                    turned[0] = 2 * turned[1] - turned[2]
                if last:
                    turned[-1] = 2 * turned[-2] - turned[-3]
        return z

    def _repeat_at_corners(self, z: list[Float64Array], rows: slice, columns: slice) -> None:
        """Give the cells at the corners of the grid, beyond its sides, the elevations within."""
        height, width = self.shape
        ends = [k for k, is_end in ((0, rows.start == 0), (-1, rows.stop == height)) if is_end]
        for row in ends:
            for k in (0, 3, 6):
                if columns.start == 0:
                    z[k][row, 0] = z[k + 1][row, 0]
                if columns.stop == width:
                    z[k + 2][row, -1] = z[k + 1][row, -1]


def _require_finite(found: Float64Array, is_known: Any) -> Float64Array:
    """Return values where they are known, NaN elsewhere; refuse an overflow."""
    if np.isinf(found).any():
        raise PointsError(_OVERFLOW)
    found[~is_known] = np.nan
    return found


# ------------------------------------------------------------------------------ formulas

_Steps = tuple["Float64Array", "Float64Array"]
"""Widths and heights of cells, in the unit of lengths."""


def _measure_planes(
    z: Sequence[Float64Array], steps: _Steps, up: float, measure: GridMeasure
) -> Float64Array:
    """Return slope, aspect or light of the planes of the gradients; see :class:`PlaneMeasure`."""
    gradient = _GRADIENTS[measure.operator](z)
    normals = np.ones((*z[4].shape, 3))
    for axis, (side, step) in enumerate(zip(gradient, steps, strict=True)):
        normals[..., axis] = -(side * up) / step
    if np.isinf(normals).any():
        raise PointsError(_OVERFLOW)
    axes = find_axes(measure.crs)
    upward = normals.reshape(-1, 3)
    value: Any = measure.value
    turned = upward if axes.are_usual else axes.turn(upward)
    return PlaneMeasure(value, measure.light).of(turned).reshape(z[4].shape)


def _find_horn_gradient(z: Sequence[Float64Array]) -> tuple[Float64Array, Float64Array]:
    """Return rises a cell to the east and to the north: means of three, the middle one twice."""
    east = ((z[2] + 2 * z[5] + z[8]) - (z[0] + 2 * z[3] + z[6])) / 8
    north = ((z[0] + 2 * z[1] + z[2]) - (z[6] + 2 * z[7] + z[8])) / 8
    return east, north


def _find_middle_gradient(z: Sequence[Float64Array]) -> tuple[Float64Array, Float64Array]:
    """Return rises a cell to the east and to the north, of the four cells at the sides."""
    return (z[5] - z[3]) / 2, (z[1] - z[7]) / 2


def _measure_curvature(
    z: Sequence[Float64Array], steps: _Steps, up: float, measure: GridMeasure
) -> Float64Array:
    """Return a curvature of the polynomial of Zevenbergen and Thorne through nine elevations."""
    across, along = steps
    east, north = _find_middle_gradient(z)
    derivatives = Derivatives(
        x=east * up / across,
        y=north * up / along,
        xx=(z[3] - 2 * z[4] + z[5]) * up / across**2,
        xy=((z[2] - z[0]) - (z[8] - z[6])) * up / (4 * across * along),
        yy=(z[1] - 2 * z[4] + z[7]) * up / along**2,
    )
    kind: Any = measure.value.removesuffix("-curvature")
    return measure_curvatures(kind, derivatives)


def _measure_riley(z: Sequence[Float64Array]) -> Float64Array:
    return np.sqrt(sum((one - z[4]) ** 2 for one in z))


def _measure_wilson(z: Sequence[Float64Array]) -> Float64Array:
    return np.asarray(sum(np.abs(one - z[4]) for one in z) / 8)


def _measure_position(z: Sequence[Float64Array]) -> Float64Array:
    return np.asarray(sum(z[4] - one for one in z) / 8)


def _measure_roughness(z: Sequence[Float64Array]) -> Float64Array:
    highest, lowest = z[0].copy(), z[0].copy()
    for one in z[1:]:
        np.maximum(highest, one, out=highest)
        np.minimum(lowest, one, out=lowest)
    return highest - lowest


_Gradient = tuple["Float64Array", "Float64Array"]

_GRADIENTS: dict[Any, Callable[[Sequence[Float64Array]], _Gradient]] = {
    "horn": _find_horn_gradient,
    "zevenbergen-thorne": _find_middle_gradient,
}

_RUGGEDNESS: dict[tuple[str, Any], Callable[[Sequence[Float64Array]], Float64Array]] = {
    ("tri", "riley"): _measure_riley,
    ("tri", "wilson"): _measure_wilson,
    ("tpi", None): _measure_position,
    ("roughness", None): _measure_roughness,
}
