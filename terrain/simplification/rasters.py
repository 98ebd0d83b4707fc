"""Simplify a raster without a TIN of all its cells.

The core finds the cells of triangles by scan conversion. A large raster is simplified in blocks, so
that memory holds the result and one block for each thread; then the vertices of all are
triangulated, and cells that are too far from that surface are inserted until none is.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import OptionError, PointsError
from ...base.progress import Progress
from ...base.sentences import counted
from ...tin import Survey, topology, triangulate
from ...tin.meshing import Errors, Goal, choose_rows, insert_until_near
from ...tin.report import Simplification
from ...tin.screening import describe_suspects, find_suspect_elevations
from ...tin.topology import NO_NEIGHBOR
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import find_surface
from .cell_crossings import cross_cells
from .elevations import Block, Elevations, Heights, cut_blocks
from .seams import Frame, find_frame, trace_block

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.progress import Tell
    from ...base.results import Raster
    from ...tin import TIN

_LARGEST_WHOLE = 2**24
"""Cells of a raster that is simplified in one piece: 300 MB."""

_BLOCK_SIDE = 2048
"""Rows and columns of a block of a larger one."""

_CHOOSING = 0.75
"""Of the work as it is told, choosing the cells of all blocks."""


class _Chosen(NamedTuple):
    """The cells of a block that are left, how many were removed again, and those kept."""

    cells: Int64Array
    z: Float64Array
    needless: int
    kept: Int64Array


class _Measured(NamedTuple):
    """Cells, their elevations, and how far the surface is from these."""

    cells: Int64Array
    z: Float64Array
    error: Float64Array


def simplify_raster(
    raster: Raster,
    goal: Goal,
    keep: ArrayLike,
    threads: int | None,
    *,
    progress: Tell | None = None,
    largest_whole: int = _LARGEST_WHOLE,
    block_side: int = _BLOCK_SIDE,
) -> TIN:
    """Return the TIN of few cells of a raster; :func:`tinsmith.simplify` tells what is promised."""
    done = Progress(progress)
    elevations = Elevations(raster)
    count = elevations.shape[0] * elevations.shape[1]
    is_whole = count <= largest_whole or goal.points is not None
    if goal.hold == "surface" and not is_whole:
        allowed = f"points for a raster of more than {largest_whole:,} cells"
        raise OptionError("hold", goal.hold, allowed)
    blocks = list(cut_blocks(elevations.shape, None if is_whole else block_side))
    kept = _as_cells(keep, count)
    work = _Work(elevations, goal, thread_count(threads, count), blocks, kept)
    rows, needless = work.choose_cells(done)
    tin, errors = insert_until_near(
        goal,
        work.frame.rounding,
        rows,
        build=work.build,
        measure=work.measure,
        progress=done,
    )
    found = Simplification(
        points=work.n_points,
        vertices=len(tin.points),
        required=len(np.union1d(work.frame.required, kept)),
        needless=needless,
        tolerance=goal.tolerance,
        largest_error=errors.largest,
        rms_error=errors.rms,
        hold=None if goal.tolerance is None else goal.hold or "points",
        surface_error=errors.surface,
    )
    suspects = describe_suspects(find_suspect_elevations(tin.points[:, 2]), "cell")
    notes = [*raster.notes, *tin.report.notes, *suspects, *_describe_blocks(blocks)]
    simple: TIN = tin.replace(
        report=replace(tin.report, simplification=found, notes=(*notes, found.sentence())),
        crs=raster.crs,
        elevation_unit=elevations.unit,
    )
    return simple


def _as_cells(keep: ArrayLike, count: int) -> Int64Array:
    """Return the cells to be kept."""
    cells = np.asarray(keep)
    if cells.size == 0:
        return np.empty(0, np.int64)
    if cells.dtype.kind not in "iu":
        raise OptionError("keep", keep, "numbers of cells, row by row from the north-west")
    cells = np.unique(cells.astype(np.int64))
    wrong = cells[(cells < 0) | (cells >= count)]
    if len(wrong):
        raise PointsError(f"There is no cell {wrong[0]}: the raster has cells 0 to {count - 1:,}.")
    return cells


def _describe_blocks(blocks: list[Block]) -> list[str]:
    if len(blocks) == 1:
        return []
    return [
        f"The raster was simplified in {counted(len(blocks), 'block')}: along their seams there "
        "may be vertices that are needless."
    ]


class _Work:
    """The steps from a raster to the surface of a few of its cells."""

    def __init__(
        self,
        elevations: Elevations,
        goal: Goal,
        threads: int,
        blocks: list[Block],
        kept: Int64Array,
    ) -> None:
        self.elevations, self.goal, self.threads = elevations, goal, threads
        self.blocks, self.kept = blocks, kept
        self.frame: Frame = find_frame(elevations, blocks, goal)
        self.n_points = 0
        self._heights = Heights(np.empty(0, np.int64), np.empty(0))
        self._cells = np.empty(0, np.int64)  # of the vertices of the surface at hand

    # ------------------------------------------------------------- which cells are left

    def choose_cells(self, progress: Tell) -> tuple[Int64Array, int]:
        """Return the cells that are left, and how many were removed again."""
        chosen = []
        for block in self._simplify_blocks():
            chosen.append(block)
            progress(_CHOOSING * len(chosen) / len(self.blocks))
        kept = np.unique(np.concatenate([one.kept for one in chosen]))
        if len(kept) < len(self.kept):
            cell = int(np.setdiff1d(self.kept, kept)[0])
            raise PointsError(f"Cell {cell}, which is to be kept, is not on the surface.")
        cells = np.concatenate([one.cells for one in chosen])
        self._heights = Heights(cells, np.concatenate([one.z for one in chosen]))
        return self._heights.cells, sum(one.needless for one in chosen)

    def _simplify_blocks(self) -> Iterator[_Chosen]:
        """Simplify blocks, as many at a time as there are threads."""
        if len(self.blocks) == 1:
            block = self.blocks[0]
            yield self._simplify_block(block, self.elevations.read(block))
            return
        with ThreadPoolExecutor(self.threads) as pool:
            for first in range(0, len(self.blocks), self.threads):
                blocks = self.blocks[first : first + self.threads]
                parts = [self.elevations.read(block) for block in blocks]
                yield from pool.map(self._simplify_block, blocks, parts)

    def _simplify_block(self, block: Block, z: Float64Array) -> _Chosen:
        valid = np.isfinite(z)
        is_used = valid if valid.all() else find_surface(valid)
        width = self.elevations.shape[1]
        kept = block.find(self.kept, width)
        kept = kept[is_used.ravel()[kept]]
        required = block.find(self.frame.required, width)
        required = np.union1d(required[is_used.ravel()[required]], kept)
        if len(required) < 3:
            return _Chosen(np.empty(0, np.int64), np.empty(0), 0, np.empty(0, np.int64))
        if self.goal.points is not None:
            self.goal.require_count(len(required), int(is_used.sum()))
        skeleton = self._build_skeleton(block, z, valid, required)
        tolerance, most = self.goal.limits(self.frame.rounding)
        cells, needless = _kernel.simplify_cells(
            self.elevations.x[block.columns],
            np.ascontiguousarray(self.elevations.y[block.rows][::-1]),
            np.ascontiguousarray((z if is_used is valid else np.where(is_used, z, np.nan))[::-1]),
            _turn_over(required, block.shape).astype(np.int32),
            skeleton.points,
            skeleton.triangles,
            skeleton.neighbors,
            skeleton.constrained | (skeleton.neighbors == NO_NEIGHBOR),
            tolerance,
            most,
            self.goal.points is None,
        )
        left = _turn_over(cells.astype(np.int64), block.shape)
        return _Chosen(
            block.to_raster(left, width), z.ravel()[left], needless, block.to_raster(kept, width)
        )

    def _build_skeleton(
        self,
        block: Block,
        z: Float64Array,
        valid: BoolArray,
        required: Int64Array,
    ) -> TIN:
        """Triangulate what must be left of a block."""
        cells = block.to_raster(required, self.elevations.shape[1])
        points = self.elevations.points(cells, z.ravel()[required])
        rings = [] if valid.all() else trace_block(valid)
        return _triangulate(points, required, rings, 1)

    # --------------------------------------------------------------------- the result

    def build(self, cells: Int64Array) -> TIN:
        """Triangulate cells within the boundary."""
        points = self.elevations.points(cells, self._heights.of(cells))
        self._cells = cells
        rings = [] if self.elevations.is_rectangle(self.frame.rings) else self.frame.rings
        return _triangulate(points, cells, rings, self.threads)

    def measure(self, tin: TIN, limit: float) -> Errors:
        """Measure all cells of the surface; of those too far, tell the worst of each triangle."""
        meter = _Meter(self.elevations, tin, self._cells, self.threads)
        far = [_Measured(np.empty(0, np.int64), np.empty(0), np.empty(0))]
        largest, squares, count = 0.0, 0.0, 0
        for block in self.blocks:
            own = block.own(self.elevations.shape)
            z, error = meter.measure(block.widen(), own)
            is_near = error <= limit  # false where there is no surface
            near = error if is_near.all() else error[is_near]
            count += near.size
            largest = max(largest, float(near.max(initial=0.0)))
            squares += float(np.square(near).sum())
            if near.size == z.size:
                continue
            cells = np.flatnonzero(~is_near & ~np.isnan(z))
            places = own.to_raster(cells, self.elevations.shape[1])
            far.append(_Measured(places, z.ravel()[cells], error.ravel()[cells]))
        self.n_points = count
        worst = self._choose_worst(tin, _Measured(*map(np.concatenate, zip(*far, strict=True))))
        errors = Errors(worst, largest, float(np.sqrt(squares / max(count, 1))))
        return self._measure_between(tin, errors, limit) if self.goal.hold == "surface" else errors

    def _measure_between(self, tin: TIN, errors: Errors, limit: float) -> Errors:
        """Add what is beyond the tolerance between the cells, of a raster in one block."""
        (block,) = self.blocks
        z = self.elevations.read(block)
        valid = np.isfinite(z)
        if not valid.all():
            z = np.where(find_surface(valid), z, np.nan)
        across = np.arange(len(tin.triangles), dtype=np.int32)[:, None]
        inner = np.nonzero(tin.neighbors > across)
        start, end = (self._cells[ends] for ends in topology.ends(tin.triangles, *inner))
        found = cross_cells(z, start, end)
        is_left = np.zeros(z.size + 1, np.bool_)
        is_left[self._cells] = is_left[-1] = True
        rows, _ = choose_rows(found, is_left, limit)
        self._heights = self._heights.join(rows, z.ravel()[rows])
        surface = max(errors.largest, float(found.errors.max(initial=0.0)))
        return errors._replace(far=np.union1d(errors.far, rows), surface=surface)

    def _choose_worst(self, tin: TIN, far: _Measured) -> Int64Array:
        """Return the cell of each triangle that is farthest from it, of those too far."""
        if len(far.cells) == 0:
            return far.cells
        self._heights = self._heights.join(far.cells, far.z)
        triangle = tin.locate(self.elevations.points(far.cells, far.z)[:, :2])
        order = np.lexsort((far.cells, -far.error, triangle))
        is_first = np.append(True, np.diff(triangle[order]) != 0) | (triangle[order] < 0)
        return np.sort(far.cells[order][is_first])


class _Meter:
    """Measures cells against a surface between cells.

    Where centres are evenly spaced to the last bit, planes over columns and rows are those over
    eastings and northings. Elsewhere the surface is interpolated at each centre.
    """

    def __init__(self, elevations: Elevations, tin: TIN, cells: Int64Array, threads: int) -> None:
        self.elevations, self.tin, self.threads = elevations, tin, threads
        row, column = np.divmod(cells, elevations.shape[1])
        self._places = np.column_stack([column, -row])
        self._drawn = None
        if not (_is_even(elevations.x) and _is_even(elevations.y)):
            self._drawn = _kernel.GriddedSurface(tin.points, tin.triangles)

    def measure(self, wide: Block, own: Block) -> tuple[Float64Array, Float64Array]:
        """Return elevations and errors of cells, within a block that holds their neighbours.

        Elevations are NaN where there is no surface, errors where it was not built.
        """
        z = self.elevations.read(wide)
        valid = np.isfinite(z)
        if not valid.all():
            z = np.where(find_surface(valid), z, np.nan)
        rows, columns = own.within(wide)
        return z[rows, columns], self._measure(wide, z)[rows, columns]

    def _measure(self, wide: Block, z: Float64Array) -> Float64Array:
        if self._drawn is None:
            south_west = [-wide.columns.start, wide.rows.stop - 1]
            error = _kernel.measure_cells(
                np.ascontiguousarray(z[::-1]),
                (self._places + south_west).astype(np.int32),
                np.ascontiguousarray(self.tin.points[:, 2]),
                self.tin.triangles,
            )
            return np.asarray(error[::-1])
        x, y = self.elevations.x[wide.columns], self.elevations.y[wide.rows]
        size = self.elevations.cell_size
        values = self._drawn.values_at_centers(x, y, size, None, self.threads)
        return np.abs(np.asarray(values) - z)


def _is_even(centres: Float64Array) -> bool:
    steps = np.diff(centres)
    return bool((steps == steps[0]).all())


def _triangulate(
    points: Float64Array,
    cells: Int64Array,
    rings: list[Int64Array],
    threads: int,
) -> TIN:
    """Triangulate the points of cells within rings, of which the cells given are followed."""
    extent = []
    for ring in rings:
        place = np.searchsorted(cells, ring)
        place[place == len(cells)] = 0
        extent.append(points[place[cells[place] == ring]])
    survey = Survey(points=points, extent=extent, from_raster=True)
    return triangulate(survey, threads=threads)


def _turn_over(cells: Int64Array, shape: tuple[int, int]) -> Int64Array:
    """Return the numbers of cells from the southernmost row on; of such, those from the north."""
    row, column = np.divmod(cells, shape[1])
    return (shape[0] - 1 - row) * shape[1] + column
