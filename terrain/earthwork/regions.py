"""Region polygons as triangles, for the overlay with surfaces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS
from ...base.errors import LinesError, OptionError
from ...base.georeference import require_same_crs
from ...base.results import Features
from ...tin import triangulate
from ...tin.constraints import gather_rings_of_regions
from ..surface import Pieces, Surface

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array

_NAMES = ("name", "region", "id", "label")
"""Columns that name a region, in this order."""


def as_regions(
    regions: Any, crs: CRS | None, *, option: str = "regions", noun: str = "region"
) -> tuple[list[str], Pieces, tuple[str, ...]]:
    """Return the names of regions, their triangles at elevation 0, and what was assumed.

    Regions are a mapping of names to polygons, a sequence of polygons, Features, or an object with
    polygons; a polygon is a ring, a sequence of rings, or an object with a ``__geo_interface__``.
    ``crs`` is that of the surfaces; ``option`` and ``noun`` are words for them in sentences.

    Raises CrsError if the regions name another CRS, or that of the surfaces is not known;
    LinesError if one is no sound polygon; OptionError if there is none.
    """
    is_plain = not hasattr(regions, "crs")
    theirs = CRS.of(getattr(regions, "crs", None))
    notes = require_same_crs(theirs, crs, f"the {option}", is_plain=is_plain)
    notes += tuple(regions.notes) if isinstance(regions, Features) else ()
    named = list(_name_regions(regions, option))
    if not named:
        raise OptionError(option, 0, allowed="1 or more", what=f"number of {option}")
    parts = [_triangulate(f"{noun} '{name}'", shape) for name, shape in named]
    first = np.cumsum([0, *(len(points) for points, _ in parts)])[:-1]
    triangles = [corners + start for (_, corners), start in zip(parts, first, strict=True)]
    groups = np.repeat(np.arange(len(parts)), [len(corners) for corners in triangles])
    surface = Surface(
        np.concatenate([points for points, _ in parts]),
        np.concatenate(triangles).astype(np.int32),
    )
    return [name for name, _ in named], Pieces(surface, groups.astype(np.int32)), notes


def _name_regions(regions: Any, option: str) -> Iterator[tuple[str, Any]]:
    if isinstance(regions, Features):
        yield from _take_features(regions, option)
    elif isinstance(regions, Mapping) and "type" not in regions:
        yield from ((str(name), shape) for name, shape in regions.items())
    elif isinstance(given := getattr(regions, "__geo_interface__", regions), Mapping):
        yield from _name_features(given)
    elif isinstance(regions, Sequence | np.ndarray) or hasattr(regions, "__iter__"):
        yield from ((str(number), shape) for number, shape in enumerate(regions, start=1))
    else:
        raise OptionError(option, type(regions).__name__, allowed="polygons")


def _name_features(given: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    if given["type"] != "FeatureCollection":
        yield "1", given
        return
    for number, feature in enumerate(given["features"], start=1):
        yield _find_name(feature.get("properties") or {}, number), feature["geometry"]


def _find_name(properties: Mapping[str, Any], number: int) -> str:
    by_lower = {str(key).lower(): value for key, value in properties.items()}
    found = [by_lower[key] for key in _NAMES if by_lower.get(key) not in (None, "")]
    return str(found[0]) if found else str(number)


def _take_features(features: Features, option: str) -> Iterator[tuple[str, Any]]:
    if features.kind != "polygons":
        raise OptionError(option, f"{features.kind}", allowed="polygons")
    rings, spans, *multi = features.offsets
    for level in multi:
        spans = spans[level]
    for number in range(len(features)):
        properties = {name: column[number] for name, column in features.columns.items()}
        shape = [
            features.coordinates[rings[j] : rings[j + 1], :2]
            for j in range(int(spans[number]), int(spans[number + 1]))
        ]
        yield _find_name(properties, number + 1), shape


def _triangulate(what: str, shape: Any) -> tuple[Float64Array, Int64Array]:
    """Triangulate a polygon; inside is what an odd number of its rings holds."""
    rings = [ring[:, :2] for polygon in gather_rings_of_regions([shape], what) for ring in polygon]
    if not rings:
        raise LinesError(f"The {what} has no area.")
    points = np.concatenate([np.column_stack([ring, np.zeros(len(ring))]) for ring in rings])
    try:
        tin = triangulate(points, boundary=rings)
    except ValueError as error:
        raise LinesError(f"The {what} is no sound polygon: {error}") from error
    flat = tin.points.copy()
    flat[:, 2] = 0.0
    return flat, tin.triangles.astype(np.int64)
