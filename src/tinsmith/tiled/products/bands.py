"""Bands between contours: each tile lists the segments around them, of which polygons are made."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...terrain.isolines import LevelOptions, Levels, as_levels
from ...terrain.parts import bands
from ...terrain.surface import measure_rounding
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
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.results import Features
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def check_options(
    *, interval: float | None = None, levels: Any = None, base: float = 0.0
) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    chosen = None if levels is None else as_levels(levels).tolist()
    LevelOptions(interval, chosen, base)
    return {"interval": interval, "levels": chosen, "base": base}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Settle the levels, when the elevations of all points are known."""
    found = _make_levels(options).for_bands_between(*points.elevations)
    box = points.bounds
    corners = np.array([[box.xmin, box.ymin], [box.xmax, box.ymax]])
    return {
        **add_units(points, options),
        "values": found.values.tolist(),
        "rounding": measure_rounding(corners),
        "extent": float(np.ptp(corners, axis=0).sum()),
    }


def _make_levels(options: Mapping[str, Any]) -> LevelOptions:
    return LevelOptions(*(options[name] for name in ("interval", "levels", "base")))


def _make_options(options: Mapping[str, Any]) -> bands.BandOptions:
    values = np.array(options["values"], np.float64)
    levels = Levels(values, np.zeros(len(values), np.bool_))
    reference = find_reference(options)
    return bands.BandOptions(levels, options["rounding"], options["extent"], *reference)


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """List the segments around the bands of a tile."""
    box = part.job.tile.box
    local = part.triangulate(box, rings=bands.RINGS)
    if not len(local.triangles):
        return 0, {}, []
    found = bands.compute_part(local, box, _make_options(part.job.options))
    names = save_arrays(part, **found._asdict())
    return len(local.points), measure_elevations(local, box), names


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Features:
    """Return all polygons."""
    parts = [
        bands.BandPart(**load_arrays(folder, record)) for record in records.values() if record.files
    ]
    made = bands.join(parts, _make_options(options))
    notes = _make_levels(options).for_bands_between(*join_elevations(records)).notes
    return replace(made, notes=[*points.notes, *made.notes, *notes])


PRODUCT = TileProduct(check_options, compute, join, settle_options=settle_options)
