"""Elevations at places: each tile has those of the places in it, which are put in order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS
from ...base.errors import OptionError, choice
from ...base.georeference import describe_unknown, require_same_crs
from ...base.policies import Extrapolation, InterpolationMethod
from ...base.results import Table
from ...base.types import Bounds
from ...terrain.parts import are_owned, places, require_local
from ...tin.building import find_crs
from ...tin.validation import as_xy
from ..given import GivenPlaces, read_places
from ..tasks import TileProduct, load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

PLACES = "places"
"""Option and folder of the places."""


def check_options(
    *, places: Any, method: str = "linear", extrapolate: str | None = None
) -> dict[str, Any]:
    """Return options, or refuse what is none, or needs all triangles at a time."""
    choice("method", method, InterpolationMethod)
    if method != "linear":
        raise OptionError("method", method, "linear where elevations are computed in tiles")
    if extrapolate is not None:
        choice("extrapolate", extrapolate, Extrapolation)
        require_local("extrapolate")
    xy, crs = as_xy(places) + 0.0, find_crs(places)
    return {
        PLACES: GivenPlaces(xy),
        "count": len(xy),
        "known": int(np.count_nonzero(~np.isnan(xy).any(axis=1))),
        "places_crs": None if crs is None else str(crs),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Refuse places in another CRS than that of all points."""
    require_same_crs(CRS.of(options["places_crs"]), points.crs, "the places", is_plain=True)
    return dict(options)


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Interpolate at the places of a tile."""
    box = part.job.tile.box
    asked = read_places(part.job.folder / PLACES, box)
    is_owned = are_owned(asked.points, box)
    if not is_owned.any():
        return 0, {}, []
    asked = asked.choose(is_owned)
    local = part.triangulate(Bounds.of(asked.points))
    found = places.compute_part(local, box, asked.points, asked.numbers)
    return len(asked.points), {}, save_arrays(part, **found._asdict())


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the elevations at all places."""
    return Table(
        {"elevation": join_elevations(options, records, folder)},
        units={"elevation": points.elevation_unit},
        name="elevations",
        notes=[*points.notes, *describe_unknown(points.crs, points.elevation_unit)],
    )


def join_elevations(
    options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Float64Array:
    """Return the elevations at all places, NaN outside the surface."""
    parts = (
        places.PlacePart(**load_arrays(folder, record))
        for record in records.values()
        if record.files
    )
    return places.join(parts, options["count"], known=options["known"])


PRODUCT = TileProduct(
    check_options, compute, join, settle_options=settle_options, has_all_tiles=True
)
