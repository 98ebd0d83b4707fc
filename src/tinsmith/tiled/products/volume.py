"""Volumes to a level or plane: each tile sums its triangles exactly, and sums are added exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS, Unit
from ...terrain.earthwork import as_plane, as_regions
from ...terrain.parts import volumes
from ...terrain.surface import Pieces, Surface, make_reference
from ..tasks import load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.results import Table
    from ..reading import StoredPoints
    from ..runs import Record
    from ..tasks import Part

__all__ = ["check_options", "compute", "join", "settle_options"]

_PURPOSE = "Volumes"


def check_options(*, base: Any, regions: Any = None, crs: CRS | None = None) -> dict[str, Any]:
    """Return plain options, or refuse what is none."""
    as_plane(base)
    plain = np.asarray(base, np.float64).tolist()
    if regions is None:
        return {"base": plain, "regions": None}
    names, pieces, notes = as_regions(regions, crs)
    return {"base": plain, "regions": _list_regions(tuple(names), pieces), "notes": list(notes)}


def _list_regions(names: tuple[str, ...], pieces: Pieces) -> dict[str, Any]:
    return {
        "names": list(names),
        "points": pieces.surface.points.tolist(),
        "triangles": pieces.surface.triangles.tolist(),
        "groups": pieces.groups.tolist(),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Add the units of all points."""
    crs, unit = points.crs, points.elevation_unit
    make_reference(crs, unit, _PURPOSE)
    return {
        **options,
        "crs": None if crs is None else str(crs),
        "elevation_unit": None if unit is None else unit.text,
    }


def _make_options(options: Mapping[str, Any]) -> volumes.VolumeOptions:
    crs, unit = CRS.of(options["crs"]), Unit.of(options["elevation_unit"] or None)
    given, names, pieces = options["regions"], ("all",), None
    if given is not None:
        surface = Surface(
            np.array(given["points"], np.float64), np.array(given["triangles"], np.int32)
        )
        names, pieces = tuple(given["names"]), Pieces(surface, np.array(given["groups"], np.int32))
    return volumes.VolumeOptions(
        make_reference(crs, unit, _PURPOSE), as_plane(options["base"]), names, pieces
    )


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Sum the triangles of a tile."""
    box = part.job.tile.box
    local = part.triangulate(box, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    found = volumes.compute_part(local, box, _make_options(part.job.options))
    return len(local.points), {}, save_arrays(part, **found._asdict())


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the table of all sums."""
    parts = (
        volumes.VolumePart(**load_arrays(folder, record))
        for record in records.values()
        if record.files
    )
    made = volumes.join(parts, _make_options(options))
    return replace(made, notes=[*points.notes, *options.get("notes", ()), *made.notes])
