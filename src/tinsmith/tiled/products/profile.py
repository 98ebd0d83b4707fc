"""Profiles: each tile has the triangles that the lines meet, which are joined and cut once."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_length, as_number
from ...base.crs import CRS
from ...base.results import Features
from ...terrain.parts import lines
from ...terrain.sections import lines_to_segments, profile
from ...terrain.surface import as_features, as_segments
from ...tin import triangulate
from ...tin.tiling import reduce_to_hull
from ..reading import open_store
from ..tasks import load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.results import Table
    from ..reading import StoredPoints
    from ..runs import Record
    from ..store import PointStore
    from ..tasks import Part

__all__ = ["check_options", "compute", "join", "settle_options"]


def check_options(
    *, line: Any, interval: float | None = None, start: float = 0.0
) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    features = as_features(line)
    lines_to_segments(features, start, "profile")
    if interval is not None:
        as_length("interval", interval)
    return {
        "coordinates": features.coordinates[:, :2].tolist(),
        "offsets": features.offsets[0].tolist(),
        "lines_crs": None if features.crs is None else str(features.crs),
        "interval": interval,
        "start": as_number("start", start),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options as they are: lines do not depend on points."""
    del points
    return dict(options)


def _find_rim(store: PointStore) -> Float64Array:
    """Return the vertices on the boundary of the whole surface, counter-clockwise."""
    tin = triangulate(reduce_to_hull(store.skeleton).points)
    return tin.points[tin.boundary[0]]


def _make_options(options: Mapping[str, Any], store: PointStore) -> lines.LineOptions:
    xy = np.array(options["coordinates"], np.float64).reshape(-1, 2) + 0.0
    return lines.LineOptions(
        as_segments(xy, np.array(options["offsets"], np.int64)), _find_rim(store)
    )


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Return the triangles of a tile that lines meet."""
    box = part.job.tile.box
    options = _make_options(part.job.options, part.store)
    local = part.triangulate(box, rings=lines.RINGS, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    found = lines.compute_part(local, box, options)
    return len(local.points), {}, save_arrays(part, **found._asdict())


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the profile along the triangles of all tiles."""
    parts = [
        lines.SurfacePart(**load_arrays(folder, record))
        for record in records.values()
        if record.files
    ]
    settled = _make_options(options, open_store(points.folder))
    tin = lines.join(parts, settled, points.crs, points.elevation_unit)
    line = Features.of_lines(
        np.array(options["coordinates"], np.float64),
        np.array(options["offsets"], np.int64),
        crs=CRS.of(options["lines_crs"]),
    )
    given: Any = line if options["lines_crs"] else _split(line)
    made = profile(tin, given, interval=options["interval"], start=options["start"])
    return replace(made, notes=[*points.notes, *made.notes])


def _split(line: Features) -> list[Float64Array]:
    """Return lines as plain arrays, which are in the CRS of the surface."""
    bounds = line.offsets[0]
    return [line.coordinates[a:b] for a, b in pairwise(bounds)]
