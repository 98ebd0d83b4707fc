"""Statistics of the slope: each tile sums its triangles exactly, and keeps their slopes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...base.checks import as_percentages
from ...base.errors import choice
from ...base.policies import SlopeUnit
from ...terrain.parts import statistics
from ...terrain.relief import PERCENTILES, as_table
from ..tasks import TileProduct, find_reference, load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike

    from ...base.results import Table
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def check_options(
    *, unit: SlopeUnit = "degrees", percentiles: ArrayLike = PERCENTILES
) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    shares = as_percentages("percentiles", percentiles).tolist()
    return {"unit": choice("unit", unit, SlopeUnit), "percentiles": shares}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Sum the slopes of the triangles of a tile."""
    box, options = part.job.tile.box, part.job.options
    local = part.triangulate(box, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    asked = statistics.StatisticsOptions(options["unit"], *find_reference(options))
    found = statistics.compute_part(local, box, asked)
    return len(local.points), {}, save_arrays(part, **found._asdict())


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the statistics of all triangles."""
    found = statistics.join(lambda: _load(records, folder), options["percentiles"])
    made = as_table(found, options["unit"], points)
    return replace(made, notes=[*points.notes, *made.notes])


def _load(records: Mapping[str, Record], folder: Path) -> Iterator[statistics.StatisticsPart]:
    for record in records.values():
        if record.files:
            yield statistics.StatisticsPart(**load_arrays(folder, record))


PRODUCT = TileProduct(check_options, compute, join)
