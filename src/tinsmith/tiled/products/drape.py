"""Draping: points have the elevations of the tile that they lie in, lines the triangles of all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS
from ...base.georeference import require_same_crs
from ...terrain.sections import check_features, drape, drape_points
from ...terrain.surface import as_segments
from ..along import compute_along, join_along, keep_lines
from ..given import GivenPlaces
from ..tasks import TileProduct
from . import places

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.results import Features
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

_LINES = "lines"
"""Option and folder of lines and rings."""


def check_options(*, features: Any, outside: Any = "error") -> dict[str, Any]:
    """Return options, or refuse what is none."""
    features = list(features) if isinstance(features, Iterator) else features
    found = check_features(features, outside)
    options = {
        "kind": found.kind,
        "features_crs": None if found.crs is None else str(found.crs),
        "outside": outside,
    }
    if found.kind == "points":
        xy = np.ascontiguousarray(found.coordinates[:, :2]) + 0.0
        count = {"count": len(xy), "known": len(xy)}
        return {**options, **count, places.PLACES: GivenPlaces(xy, features)}
    as_segments(found.coordinates[:, :2], found.offsets[0], what=found.kind[:-1])
    return {**options, _LINES: keep_lines(features, found)}


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Refuse features in another CRS than that of all points."""
    require_same_crs(CRS.of(options["features_crs"]), points.crs, "the features", is_plain=True)
    return dict(options)


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Return the elevations of points, or the triangles that lines meet, in a tile."""
    if part.job.options["kind"] == "points":
        return places.compute(part)
    return compute_along(part, _LINES)


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Features:
    """Return the features on the surface."""
    outside = options["outside"]
    if options["kind"] == "points":
        elevations = places.join_elevations(options, records, folder)
        features = options[places.PLACES].value
        made = drape_points(
            points,
            check_features(features, outside),
            elevations,
            outside=outside,
            is_plain=not hasattr(features, "crs"),
        )
    else:
        tin = join_along(points, options[_LINES], records, folder)
        made = drape(tin, options[_LINES].value, outside=outside)
    return replace(made, notes=[*points.notes, *made.notes])


PRODUCT = TileProduct(
    check_options, compute, join, settle_options=settle_options, has_all_tiles=True
)
