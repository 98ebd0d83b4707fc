"""The cells of a raster in tiles: which they are, and their values in the files of tiles."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.atomic import replacing
from ..base.checks import as_length
from ..base.crs import CRS
from ..base.errors import OptionError
from ..base.georeference import require_same_crs
from ..base.types import Affine, Bounds, CellStorage, Grid
from ..io.raster import take_cells
from ..terrain.gridding import (
    add_cells,
    as_cells,
    cover,
    require_cells,
    require_overlap,
    settle_storage,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ..base.arrays import AnyArray
    from .reading import StoredPoints
    from .running import Record
    from .tasks import Part


def check_cells(spacing: float | None, like: Any, bounds: Bounds | None) -> dict[str, Any]:
    """Return plain options of cells, or refuse what is none.

    ``bounds`` are those that headers name: too many cells are refused before anything is read.
    """
    if (spacing is None) == (like is None):
        raise OptionError("grid", [spacing, like], "one of spacing and like")
    if spacing is not None:
        as_length("spacing", spacing)
    cells = None if like is None else as_cells(take_cells(like))
    like_crs = None if cells is None else cells.crs
    if cells is not None:
        require_cells(cells.grid, in_memory=False)
    elif bounds is not None and spacing is not None:
        require_cells(cover(bounds, spacing), in_memory=False)
    stored_as, noted = settle_storage(cells)
    return {
        "spacing": spacing,
        "stored_as": None if stored_as is None else list(stored_as),
        "stored_notes": noted,
        "like": None if cells is None else asdict(cells.grid),
        "like_crs": None if like_crs is None else str(like_crs),
    }


def settle_cells(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the cells, when the bounds of all points are known: ``grid`` and ``notes``."""
    like = options["like"]
    cells = make_grid(like) if like else cover(points.bounds, options["spacing"])
    require_cells(cells, in_memory=False)
    require_overlap(cells.bounds, points.bounds)
    notes: tuple[str, ...] = ()
    if like:
        notes = require_same_crs(CRS.of(options["like_crs"]), points.crs, "the other raster")
    return {"grid": asdict(cells), "notes": list(notes)}


def find_storage(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a raster of floating numbers is told of its cells in files, and its notes."""
    stored_as = options["stored_as"]
    return {
        "stored_as": None if stored_as is None else CellStorage(*stored_as),
        "notes": options["stored_notes"],
    }


def make_grid(cells: Mapping[str, Any]) -> Grid:
    """Return a grid from plain values."""
    spacing = cells["spacing"]
    return Grid(
        Bounds(**cells["bounds"]),
        tuple(cells["shape"]),
        tuple(spacing) if isinstance(spacing, list) else spacing,
        Affine(*cells["transform"]),
    )


def save_block(part: Part, rows: slice, columns: slice, values: AnyArray) -> dict[str, Any]:
    """Write the cells of a tile to a file of its name, and return where they lie."""
    with replacing(part.folder / name_block(part)) as file:
        np.save(file, values)
    return {"rows": [rows.start, rows.stop], "columns": [columns.start, columns.stop]}


def name_block(part: Part) -> str:
    """Return the name of the file of a tile."""
    return f"{part.job.key}.npy"


class Blocks:
    """A band whose cells lie in the files of tiles.

    Parameters
    ----------
    folder : Path
        Of the run.
    records : mapping of str to Record
    grid : Grid
    empty : scalar
        Value of cells that no tile has; its type is that of the band. Cells of several tiles are
        joined by :func:`tinsmith.terrain.gridding.point_cells.add_cells`.
    """

    def __init__(self, folder: Path, records: Mapping[str, Record], grid: Grid, empty: Any) -> None:
        self.shape = grid.shape
        self.dtype = np.dtype(type(empty))
        self._empty = empty
        made = [(record.values, name) for record in records.values() for name in record.files]
        self._paths = [folder / name for _, name in made]
        ends = [[*values["rows"], *values["columns"]] for values, _ in made]
        self._ends = np.array(ends, np.int64).reshape(-1, 4)

    def __getitem__(self, key: tuple[slice, slice]) -> AnyArray:
        """Return a block; slices have no step."""
        rows, columns = key
        shape = rows.stop - rows.start, columns.stop - columns.start
        found = np.full(shape, self._empty, self.dtype)
        starts, stops = self._ends[:, ::2], self._ends[:, 1::2]
        is_met = (starts < [rows.stop, columns.stop]) & (stops > [rows.start, columns.start])
        for k in np.flatnonzero(is_met.all(axis=1)).tolist():
            own_rows, own_columns = (slice(*ends) for ends in self._ends[k].reshape(2, 2).tolist())
            target = _find_common(rows, own_rows), _find_common(columns, own_columns)
            source = _find_common(own_rows, rows), _find_common(own_columns, columns)
            add_cells(found[target], np.load(self._paths[k], mmap_mode="r")[source])
        return found


def _find_common(part: slice, other: slice) -> slice:
    """Return what two ranges have in common, counted from the start of the first."""
    start, stop = max(part.start, other.start), min(part.stop, other.stop)
    return slice(start - part.start, max(start, stop) - part.start)
