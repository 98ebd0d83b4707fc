"""Contours: each tile traces the lines through its triangles, which are joined to whole lines."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...terrain.isolines import LevelOptions, Levels, as_levels
from ...terrain.parts import contours, require_local
from ..tasks import (
    TileProduct,
    add_units,
    find_reference,
    join_elevations,
    load_arrays,
    measure_elevations,
    save_arrays,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ...base.results import Features
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def check_options(
    *,
    interval: float | None = None,
    levels: Any = None,
    base: float = 0.0,
    index: int | None = 5,
    smooth: float | None = None,
    simplify: float | None = None,
) -> dict[str, Any]:
    """Return plain options, or refuse what is none, or needs all lines at a time."""
    for name, value in (("smooth", smooth), ("simplify", simplify)):
        if value is not None:
            require_local(name)
    chosen = None if levels is None else as_levels(levels).tolist()
    LevelOptions(interval, chosen, base, index)
    return {"interval": interval, "levels": chosen, "base": base, "index": index}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the levels, when the elevations of all points are known."""
    found = _make_levels(options).for_lines_between(*points.elevations)
    return {
        **add_units(points, options),
        "values": found.values.tolist(),
        "is_index": found.is_index.tolist(),
    }


def _make_levels(options: Mapping[str, Any]) -> LevelOptions:
    return LevelOptions(*(options[name] for name in ("interval", "levels", "base", "index")))


def _make_options(options: Mapping[str, Any]) -> contours.ContourOptions:
    levels = Levels(
        np.array(options["values"], np.float64),
        np.array(options["is_index"], np.bool_),
    )
    return contours.ContourOptions(levels, *find_reference(options))


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Trace the lines of a tile."""
    box = part.job.tile.box
    local = part.triangulate(box, rings=contours.RINGS)
    if not len(local.triangles):
        return 0, {}, []
    found = contours.compute_part(local, box, _make_options(part.job.options))
    finished = {f"finished_{name}": value for name, value in found.finished._asdict().items()}
    pieces = found._asdict()
    del pieces["finished"]
    names = save_arrays(part, **finished, **pieces)
    return len(local.points), measure_elevations(local, box), names


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Features:
    """Return all lines."""
    made = contours.join(_load(records, folder), _make_options(options))
    notes = _make_levels(options).for_lines_between(*join_elevations(records)).notes
    return replace(made, notes=[*points.notes, *made.notes, *notes])


def _load(records: Mapping[str, Record], folder: Path) -> Iterator[contours.ContourPart]:
    for record in records.values():
        if record.files:
            arrays = load_arrays(folder, record)
            finished = {name: arrays.pop(f"finished_{name}") for name in contours.Lines._fields}
            yield contours.ContourPart(finished=contours.Lines(**finished), **arrays)


PRODUCT = TileProduct(check_options, compute, join, settle_options=settle_options)
