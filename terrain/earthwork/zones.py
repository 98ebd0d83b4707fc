"""Where a surface is cut, where filled, and the line between, as features."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.results import Features
from ...tin import topology
from .. import _kernel
from ..surface import cut_at_repeats
from .detection import classify_beyond
from .meshes import classify_signs, number_parts

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array
    from ...tin.triangulation import Triangulation
    from ..surface import Reference
    from .detection import Detection

NAMES = {-1: "cut", 0: "unchanged", 1: "fill"}


def classify(mesh: Triangulation, detection: Detection | None = None) -> Int8Array:
    """Return +1 where triangles are filled, -1 where cut, 0 where nothing changes.

    With a level of detection, what differs by no more does not change.
    """
    if detection is not None:
        levels = detection.measure(mesh.points[:, :2])
        return classify_beyond(mesh.points[:, 2], levels, mesh.triangles)
    return classify_signs(mesh.points, mesh.triangles)


def trace_zero_line(
    mesh: Triangulation, reference: Reference, detection: Detection | None = None
) -> Features:
    """Return the lines between cut, fill and unchanged parts, what is higher on the left.

    Lines end where three parts meet, and at the boundary.
    """
    classes = classify(mesh, detection)
    across = np.where(mesh.neighbors >= 0, classes[mesh.neighbors], np.int8(127))
    triangle, corner = np.nonzero(across < classes[:, None])
    start, end = topology.ends(mesh.triangles, triangle.astype(np.int64), corner.astype(np.int64))
    chains = join_segments(start, end)
    offsets = np.cumsum([0, *map(len, chains)])
    vertices = np.concatenate([np.array(chain) for chain in chains]) if chains else np.zeros(0, int)
    xy = mesh.points[vertices, :2].reshape(-1, 2)
    steps = np.hypot(*np.diff(xy, axis=0, prepend=xy[:1]).T)
    steps[offsets[:-1]] = 0.0
    return Features.of_lines(
        xy,
        offsets,
        columns={"length": np.add.reduceat(steps, offsets[:-1]) if len(steps) else steps},
        units={"length": reference.units.length},
        crs=reference.crs,
        name="zero line",
        notes=reference.notes,
    )


def join_segments(start: Int64Array, end: Int64Array) -> list[list[int]]:
    """Join directed segments to lines; where more than two meet, lines end."""
    leaving = np.unique(start, return_counts=True)
    arriving = np.unique(end, return_counts=True)
    inner = np.intersect1d(
        leaving[0][leaving[1] == 1], arriving[0][arriving[1] == 1], assume_unique=True
    )
    order = np.argsort(start, kind="stable")
    following = dict(zip(start[order].tolist(), end[order].tolist(), strict=True))
    inside = set(inner.tolist())
    segments = list(zip(start.tolist(), end.tolist(), strict=True))
    chains = [_follow(a, b, following, inside) for a, b in segments if a not in inside]
    passed = {vertex for chain in chains for vertex in chain}
    for a, b in segments:
        if a in inside and a not in passed:
            chain = _follow(a, b, following, inside)
            chains.append(chain)
            passed.update(chain)
    return chains


def _follow(a: int, b: int, following: dict[int, int], inside: set[int]) -> list[int]:
    chain = [a, b]
    while chain[-1] in inside and chain[-1] != a:
        chain.append(following[chain[-1]])
    return chain


def number_zones(mesh: Triangulation, classes: Int8Array) -> tuple[BoolArray, Int32Array]:
    """Return which edges end a connected part of one class, and the part of each triangle."""
    barrier = (mesh.neighbors < 0) | (classes[mesh.neighbors] != classes[:, None])
    return barrier, number_parts(mesh.neighbors, barrier)


def find_zones(
    mesh: Triangulation, reference: Reference, detection: Detection | None = None
) -> Features:
    """Return the connected parts that are cut, filled or unchanged as polygons."""
    classes = classify(mesh, detection)
    barrier, part = number_zones(mesh, classes)
    count = int(part.max()) + 1
    rings, ring_offsets, polygon_offsets = _close_rings(mesh, barrier, part, count)
    sums = _kernel.sum_heights(
        mesh.points, mesh.triangles, np.ascontiguousarray(mesh.points[:, 2]), part, count, 1.0
    )
    kinds = np.zeros(count, np.int8)
    kinds[part] = classes
    columns: dict[str, Any] = {
        "kind": np.array([NAMES[kind] for kind in kinds.tolist()], object),
        "area": sums[:, 0],
        "volume": (sums[:, 3] + sums[:, 4]) * reference.up,
        "lowest": sums[:, 8],
        "highest": sums[:, 9],
    }
    units: dict[str, Any] = {"area": reference.units.area, "volume": reference.units.volume}
    units |= dict.fromkeys(("lowest", "highest"), reference.elevation_unit)
    return Features.of_polygons(
        mesh.points[rings, :2],
        ring_offsets,
        polygon_offsets,
        columns=columns,
        units=units,
        crs=reference.crs,
        name="cut and fill",
        notes=reference.notes,
    )


def _close_rings(
    mesh: Triangulation, barrier: BoolArray, part: Int32Array, count: int
) -> tuple[Int64Array, Int64Array, Int64Array]:
    """Return the closed rings of the parts, each part's exterior first."""
    cut = np.where(barrier, np.int32(topology.NO_NEIGHBOR), mesh.neighbors)
    edges, offsets = topology.boundary_walks(mesh.triangles, cut)
    starts = mesh.triangles[edges // 3, (edges % 3 + 1) % 3]
    rings, owners = [], []
    for first, last in pairwise(offsets.tolist()):
        # A part around another one up to a vertex has an exterior and a hole that touch there.
        found = cut_at_repeats(starts[first:last].tolist())
        rings += found
        owners += [int(part[edges[first] // 3])] * len(found)
    owner = np.array(owners, np.int64)
    is_hole = np.array([_measure_doubled_area(mesh.points[ring, :2]) < 0 for ring in rings])
    order = np.lexsort((is_hole, owner))
    closed = [np.array([*rings[i], rings[i][0]], np.int64) for i in order]
    return (
        np.concatenate(closed),
        np.cumsum([0, *map(len, closed)]),
        np.append(0, np.cumsum(np.bincount(owner, minlength=count))),
    )


def _measure_doubled_area(ring: Float64Array) -> float:
    x, y = (ring - ring[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
