"""Statistics of the slope: each tile sums its triangles exactly, and sums are added exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import choice
from ...base.policies import SlopeUnit
from ...terrain.parts import statistics
from ...terrain.relief.statistics import as_table
from ..tasks import load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ...base.results import Table
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def check_options(*, unit: SlopeUnit = "degrees") -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    return {"unit": choice("unit", unit, SlopeUnit)}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Add the units of all points."""
    crs, unit = points.crs, points.elevation_unit
    return {
        **options,
        "crs": None if crs is None else str(crs),
        "elevation_unit": None if unit is None else unit.text,
    }


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Sum the slopes of the triangles of a tile."""
    box, options = part.job.tile.box, part.job.options
    local = part.triangulate(box, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    asked = statistics.StatisticsOptions(
        options["unit"], CRS.of(options["crs"]), Unit.of(options["elevation_unit"] or None)
    )
    found = statistics.compute_part(local, box, asked)
    extremes = np.array([found.minimum, found.maximum])
    return len(local.points), {}, save_arrays(part, terms=found.terms, extremes=extremes)


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the statistics of all triangles."""
    made = as_table(statistics.join(_load(records, folder)), options["unit"], points)
    return replace(made, notes=[*points.notes, *made.notes])


def _load(records: Mapping[str, Record], folder: Path) -> Iterator[statistics.StatisticsPart]:
    for record in records.values():
        if record.files:
            arrays = load_arrays(folder, record)
            low, high = arrays["extremes"].tolist()
            yield statistics.StatisticsPart(arrays["terms"], low, high)
