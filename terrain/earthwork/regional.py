"""The difference of two surfaces in regions, each cut out by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import LinesError, PointsError
from ...base.results import Features
from .. import _kernel
from ..surface import Pieces, Surface, cut_pieces
from .meshes import as_mesh, drop_unused, unite
from .subtraction import subtract
from .zones import find_zones

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import Int64Array
    from ...tin import TIN
    from ..surface import Reference
    from .detection import Detection
    from .volumes import Measured


class Regional(NamedTuple):
    """The difference in one region, where there is any."""

    name: str
    tin: TIN


def subtract_in_regions(
    first: Surface,
    second: Surface,
    measured: Measured,
    holds: Callable[[Any], Any],
    detection: Detection | None = None,
) -> tuple[TIN, dict[str, float], tuple[Regional, ...]]:
    """Return the difference where any region is with its sums, and that in each region.

    ``holds`` tells whether both surfaces hold places, (k, 2).

    Raises PointsError if no region holds both surfaces, or as :func:`subtract`.
    """
    assert measured.parts is not None
    found, regions = [], split_pieces(measured.parts, len(measured.names))
    shares = split_pieces(measured.pieces, len(measured.names))
    for name, region, share, sums in zip(
        measured.names, regions, shares, measured.sums, strict=True
    ):
        by_name = dict(zip(_kernel.SUMS, sums.tolist(), strict=True))
        if by_name["area"] > 0.0:
            within = _hold_too(holds, [region])
            tin = subtract(share, second, by_name, within, measured.reference, detection)
            found.append((Regional(name, tin), by_name))
    if not found:
        raise PointsError("The regions lie outside of what both surfaces cover: they hold nothing.")
    if len(measured.names) == 1:
        return found[0][0].tin, found[0][1], (found[0][0],)
    whole = unite_regions(regions)
    pieces = cut_pieces(first, Pieces(whole, np.zeros(len(whole.triangles), np.int32)))
    sums_of_all = _sum(pieces, second)
    within = _hold_too(holds, [whole])
    tin = subtract(pieces.surface, second, sums_of_all, within, measured.reference, detection)
    return tin, sums_of_all, tuple(one for one, _ in found)


def find_regional_zones(
    parts: Sequence[Regional], reference: Reference, detection: Detection | None = None
) -> Features:
    """Return the parts that are cut, filled or unchanged, region by region."""
    zones = [find_zones(one.tin.triangulation, reference, detection) for one in parts]
    names = [
        np.repeat(np.array([one.name], object), len(z)) for one, z in zip(parts, zones, strict=True)
    ]
    columns: dict[str, Any] = {"region": np.concatenate(names)}
    for name in zones[0].columns:
        columns[name] = np.concatenate([one.columns[name] for one in zones])
    return Features.of_polygons(
        np.concatenate([one.coordinates for one in zones]),
        _join_offsets([one.offsets[0] for one in zones]),
        _join_offsets([one.offsets[1] for one in zones]),
        columns=columns,
        units=zones[0].units,
        crs=reference.crs,
        name=zones[0].name,
        notes=reference.notes,
    )


def _join_offsets(levels: Sequence[Int64Array]) -> Int64Array:
    return np.concatenate([[0], np.cumsum(np.concatenate([np.diff(one) for one in levels]))])


def split_pieces(pieces: Pieces, count: int) -> list[Surface]:
    """Return the surface of each group."""
    order = np.argsort(pieces.groups, kind="stable")
    ends = np.cumsum(np.bincount(pieces.groups, minlength=count))[:-1]
    return [
        Surface(*drop_unused(pieces.surface.points, pieces.surface.triangles[own]))
        for own in np.split(order, ends)
    ]


def _hold_too(holds: Callable[[Any], Any], regions: Sequence[Surface]) -> Callable[[Any], Any]:
    """Return a function that tells whether surfaces and any of the regions hold places."""
    meshes = [as_mesh(one.points, one.triangles) for one in regions]
    return lambda xy: holds(xy) & np.any([mesh.locate(xy) >= 0 for mesh in meshes], axis=0)


def unite_regions(regions: Sequence[Surface]) -> Surface:
    """Return triangles of all that is in any region.

    Raises LinesError if borders cross in ways that coordinates cannot tell apart.
    """
    starts = np.cumsum([0, *(len(one.points) for one in regions)])[:-1].tolist()
    points = np.concatenate([one.points for one in regions])
    pairs = np.concatenate(
        [one.find_border() + start for one, start in zip(regions, starts, strict=True)]
    )
    holds = _hold_too(lambda xy: np.ones(len(xy), bool), regions)
    for united in unite(points, pairs, holds):
        return Surface(*united)
    raise LinesError("Borders of the regions cross where coordinates cannot tell them apart.")


def _sum(pieces: Pieces, second: Surface) -> dict[str, float]:
    own = pieces.surface
    groups = np.zeros(len(own.triangles), np.int32)
    sums = _kernel.sum_between(
        own.points, own.triangles, groups, 1, second.points, second.triangles, 1.0, False, 1, None
    )
    return dict(zip(_kernel.SUMS, sums[0].tolist(), strict=True))
