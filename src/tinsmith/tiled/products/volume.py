"""Volumes: each tile sums its triangles exactly, and sums are added exactly."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import require_tin
from ...base.crs import CRS, Unit
from ...base.errors import OptionError
from ...terrain.earthwork import as_plane, as_regions
from ...terrain.parts import volumes
from ...terrain.surface import Pieces, Reference, Surface, agree_on_reference, make_reference
from ...tin.tiling import find_triangles_at, triangulate_box, widen
from ..given import Given, load_given
from ..reading import open_store, tell_differing
from ..tasks import HALO, TileProduct, find_reference, load_arrays, measure_differing, save_arrays
from ..tiled_points import TiledPoints

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.results import Table
    from ...base.types import Bounds
    from ...tin import TIN
    from ...tin.tiling import LocalTriangulation
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

_PURPOSE = "Volumes"
_OTHER = "other"
"""Option and folder of another surface that is in memory."""
_DIFFERING = "other_differing"
"""At how many places the other points differ in elevation, and by how much."""


class _Referenced(NamedTuple):
    crs: CRS | None
    elevation_unit: Unit | None


def check_options(
    *,
    base: Any = None,
    other: TIN | TiledPoints | None = None,
    regions: Any = None,
    crs: CRS | None = None,
) -> dict[str, Any]:
    """Return options, or refuse what is none."""
    if (other is None) == (base is None):
        given = "neither" if other is None else "both"
        raise OptionError("base", given, "a level, a plane, or another surface, one of them")
    found: dict[str, Any] = {"base": None, "regions": None}
    if base is not None:
        as_plane(base)
        found["base"] = np.asarray(base, np.float64).tolist()
    elif isinstance(other, TiledPoints):
        if other.lines is not None:
            raise OptionError("other", other, "points without lines, where it is in many files")
        found["other_duplicates"] = other.duplicates
    else:
        found |= _keep_surface(other)
    if regions is not None:
        names, pieces, notes = as_regions(regions, crs)
        found |= {"regions": _list_regions(tuple(names), pieces), "notes": list(notes)}
    return found


def _keep_surface(other: Any) -> dict[str, Any]:
    """Return a surface in memory as options."""
    require_tin(other)
    surface, unit = other.snapshot().triangulation, other.elevation_unit
    if unit is not None and not unit.text:
        raise OptionError("elevation_unit", unit, "a unit with a name by which tiles find it again")
    return {
        _OTHER: Given(points=surface.points, triangles=surface.triangles),
        "other_crs": None if other.crs is None else str(other.crs),
        "other_unit": None if unit is None else unit.text,
        "other_notes": list(other.notes),
    }


def _list_regions(names: tuple[str, ...], pieces: Pieces) -> dict[str, Any]:
    return {
        "names": list(names),
        "points": pieces.surface.points.tolist(),
        "triangles": pieces.surface.triangles.tolist(),
        "groups": pieces.groups.tolist(),
    }


def settle_options(
    points: StoredPoints, options: Mapping[str, Any], other: StoredPoints | None = None
) -> dict[str, Any]:
    """Add the units of all points, and where those of the other surface are."""
    more: dict[str, Any] = {}
    if options["base"] is not None:
        reference = make_reference(points.crs, points.elevation_unit, _PURPOSE)
    else:
        second: Any = other
        if other is None:
            own = Unit.of(options["other_unit"] or None)
            second = _Referenced(CRS.of(options["other_crs"]), own)
        reference = agree_on_reference(points, second, _PURPOSE)
    if other is not None:
        box = other.bounds
        more = {
            "other_points": str(other.folder),
            "other_halo": HALO * math.sqrt(box.width * box.height / other.count),
            "other_notes": list(other.notes),
        }
    unit = reference.elevation_unit
    return {
        **options,
        **more,
        "crs": None if reference.crs is None else str(reference.crs),
        "elevation_unit": None if unit is None else unit.text,
        "reference_notes": list(reference.notes),
        "scales": list(reference.factors),
    }


def _make_options(options: Mapping[str, Any]) -> volumes.VolumeOptions:
    crs, unit = find_reference(options)
    given, names, pieces = options["regions"], ("all",), None
    if given is not None:
        surface = Surface(
            np.array(given["points"], np.float64), np.array(given["triangles"], np.int32)
        )
        names, pieces = tuple(given["names"]), Pieces(surface, np.array(given["groups"], np.int32))
    plane = None if options["base"] is None else as_plane(options["base"])
    reference = Reference(crs, unit, tuple(options["reference_notes"]))
    first, second = options["scales"]
    return volumes.VolumeOptions(reference, plane, names, pieces, (first, second))


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Sum the triangles of a tile."""
    box, options = part.job.tile.box, part.job.options
    local = part.triangulate(box, ordered=False)
    other: Surface | LocalTriangulation | None = None
    told: dict[str, Any] = {}
    if "other_points" in options:
        other, told[_DIFFERING] = _triangulate_other(part, volumes.find_reach(local, box))
    elif options["base"] is None:
        other = _choose_other(part, volumes.find_reach(local, box))
    count = len(local.points) + (0 if other is None else len(other.triangles))
    if not count:
        return 0, told, []
    found = volumes.compute_part(local, box, _make_options(options), other)
    return count, told, save_arrays(part, **found._asdict())


def _triangulate_other(part: Part, box: Bounds) -> tuple[LocalTriangulation, list[float]]:
    """Return triangles of the other points that meet a box, and how these differ in the tile."""
    options = part.job.options
    store, around = open_store(Path(options["other_points"])), widen(box, options["other_halo"])
    local = triangulate_box(
        store, box, around=around, duplicates=options["other_duplicates"], ordered=False
    )
    return local, measure_differing(store, part.job.tile.box, {around: local.differing})


def _choose_other(part: Part, box: Bounds) -> Surface:
    """Return the triangles of the other surface, which is in memory, that meet a box."""
    job = part.job
    given: Any = load_given(job.folder / _OTHER, job.options[_OTHER])
    chosen = find_triangles_at(given["points"], given["triangles"], box)
    return Surface(given["points"], np.ascontiguousarray(given["triangles"][chosen]))


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
    told = [*options.get("other_notes", ())]
    if "other_points" in options:
        told += tell_differing(records, _DIFFERING, options["other_duplicates"])
    others = [f"The other surface: {note}" for note in told]
    return replace(made, notes=[*points.notes, *others, *options.get("notes", ()), *made.notes])


PRODUCT = TileProduct(
    check_options, compute, join, settle_options=settle_options, has_all_tiles=True
)
