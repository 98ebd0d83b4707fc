"""The oracle of surfaces in tiles: the whole triangulation, in memory."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

import tinsmith as ts
from tinsmith.tin import _kernel
from tinsmith.tin.building.inputs import gather_inputs
from tinsmith.tin.building.options import BuildOptions
from tinsmith.tin.tiling.boxes import are_in_box, widen
from tinsmith.tin.tiling.draping import (
    Draping,
    KnownTriangles,
    find_rim,
    node_base,
    node_laid,
)
from tinsmith.tin.tiling.lines import choose_near, node_lines
from tinsmith.tin.tiling.local_triangulation import triangulate_box
from tinsmith.tin.tiling.proof import TileTriangles, check_tiles
from tinsmith.tin.tiling.sources import NumberedPoints

from .point_cells import PointCells, find_limits


def divide(points, side):
    """Divide points between side x side cells of equal size."""
    bounds = ts.Bounds.of(points)
    xs, ys = (
        np.linspace(low, high, side + 1)[1:-1]
        for low, high in ((bounds.xmin, bounds.xmax), (bounds.ymin, bounds.ymax))
    )
    return PointCells(points, xs, ys)


def find_triangles_at(xy, triangles, box):
    """Return the triangles that meet a closed box, exactly: the twin of the kernel.

    Of convex figures that do not meet, one lies beyond a side of the other.
    """
    corners = xy[triangles, :2]
    low, high = find_limits(box)
    rows = np.flatnonzero(
        ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    )
    doubtful = np.flatnonzero(~are_in_box(corners[rows], box).any(axis=1))
    west, south = np.maximum(low, xy[:, :2].min(axis=0))  # no side of a box at the rim is endless
    east, north = np.minimum(high, xy[:, :2].max(axis=0))
    is_beyond = np.zeros(len(doubtful), np.bool_)
    for k in range(3):
        start, end = corners[rows[doubtful], k], corners[rows[doubtful], (k + 1) % 3]
        is_right = np.ones(len(doubtful), np.bool_)
        for place in ((west, south), (east, south), (east, north), (west, north)):
            places = np.broadcast_to(np.array(place), start.shape)
            is_right &= _kernel.orientation(*map(np.ascontiguousarray, (start, end, places))) < 0
        is_beyond |= is_right
    return np.delete(rows, doubtful[is_beyond])


def list_corners(points, triangles):
    """Return the corners of triangles, each from its least vertex, as a sorted array."""
    corners = [[tuple(points[v]) for v in triangle] for triangle in triangles.tolist()]
    return sorted((*one[k:], *one[:k]) for one in corners for k in [one.index(min(one))])


def make_inputs(points, duplicates="mean", *, breaklines=(), boundary=(), holes=(), **options):
    """Return the inputs of a build."""
    return gather_inputs(
        points,
        BuildOptions(duplicates=duplicates, **options),
        breaklines=breaklines,
        boundary=boundary,
        holes=holes,
        erase=(),
        water=(),
        crs=None,
        elevation_unit=None,
    )


def node_all(points, duplicates="mean", *, chunk=100, source=None, **lines):
    """Cut the lines of a survey; points are looked at chunk by chunk, and draped on all cells."""
    inputs = make_inputs(points, duplicates, **lines)
    rows = NumberedPoints(points, np.arange(len(points)))
    near = [
        choose_near(rows.choose(slice(begin, begin + chunk)), inputs.lines)
        for begin in range(0, len(points), chunk)
    ]
    near = NumberedPoints.join(near)
    if not inputs.lines.is_draped.any():
        return node_lines(near, inputs, first_number=len(points))
    near = near.add(find_near_rim(rows, inputs)).sort()
    laid = drape_all(source, near, inputs, first_number=len(points))
    return node_laid(near, source.skeleton, laid, first_number=len(points))


def find_near_rim(rows, inputs):
    """Return the points near the convex hull of points and lines with elevations."""
    lines = inputs.lines.choose(~inputs.lines.is_draped)
    vertices = np.column_stack([lines.xy, lines.elevations])
    together = np.concatenate([rows.points, vertices])
    rim = find_rim(NumberedPoints(together, np.arange(len(together))))
    return choose_near(
        rows, make_inputs(rows.points, breaklines=[np.append(rim, rim[:1], 0)]).lines
    )


def drape_all(source, near, inputs, *, first_number):
    """Drape the lines that have no elevations, on the triangles of all cells."""
    lines = inputs.lines.choose(~inputs.lines.is_draped)
    duplicates, given, skeleton = inputs.options.duplicates, None, source.skeleton
    if lines.kinds:
        given = node_base(near, inputs, first_number=first_number)
        skeleton = NumberedPoints.join([skeleton, given.skeleton])
    draping = Draping.of(inputs, find_rim(skeleton))
    parts = [
        triangulate_box(source, source.box_of(key), lines=given, duplicates=duplicates)
        for key in source.list_cells()
    ]
    known = [KnownTriangles(one.points, one.triangles) for one in parts]
    laid, unknown = draping.lay(known)
    assert not len(unknown)
    return laid


def require_triangles_of_the_whole(points, source, *, margin, duplicates="mean", **lines):
    """Require of each cell the triangles, elevations and numbers that the whole has there.

    Of all cells together, require each triangle of the whole once among those that they own.
    """
    whole = ts.triangulate(points, duplicates=duplicates, **lines)
    noded = node_all(points, duplicates, source=source, **lines) if lines else None
    number_at = find_numbers(whole, len(points))
    constrained = find_constrained(whole.points, whole)
    owned, parts, rounds = [], [], 0
    for key in source.list_cells():
        box = source.box_of(key)
        local = triangulate_box(
            source, box, around=widen(box, margin), lines=noded, duplicates=duplicates
        )
        chosen = find_triangles_at(whole.points, whole.triangles, box)
        wanted = list_corners(whole.points.tolist(), whole.triangles[chosen])
        assert list_corners(local.points.tolist(), local.triangles) == wanted, f"tile {key}"
        for xyz, number in zip(local.points.tolist(), local.numbers.tolist(), strict=True):
            assert number_at.setdefault(tuple(xyz), number) == number, f"tile {key}: row of {xyz}"
        for edge, flag in find_constrained(local.points, local).items():
            assert constrained.get(edge, flag) == flag, f"tile {key}: edge {edge}"
        own = local.triangles[local.owned]
        owned += list_corners(local.points.tolist(), own)
        parts.append(TileTriangles(key, local.points, local.numbers, own))
        rounds = max(rounds, local.rounds)
    assert sorted(owned) == list_corners(whole.points.tolist(), whole.triangles)
    require_proof(whole, parts, hull=None if lines else whole.points[whole.hull])
    return rounds


def find_numbers(whole, n_rows):
    """Return the first row at the place of each vertex that rows have."""
    first = np.full(len(whole.points), n_rows)
    rows = np.flatnonzero(whole.vertex_of >= 0)
    np.minimum.at(first, whole.vertex_of[rows], rows)
    return {
        tuple(xyz): number
        for xyz, number in zip(whole.points.tolist(), first.tolist(), strict=True)
        if number < n_rows
    }


def find_constrained(points, surface):
    """Return whether each edge with triangles on both sides is constrained, by its ends."""
    found = {}
    for triangle, beside, flags in zip(
        surface.triangles.tolist(),
        surface.neighbors.tolist(),
        surface.constrained.tolist(),
        strict=True,
    ):
        for k in range(3):
            if beside[k] >= 0:
                ends = sorted(tuple(points[triangle[k - step]].tolist()) for step in (1, 2))
                found[tuple(ends)] = flags[k]
    return found


def require_proof(whole, parts, *, hull):
    """Require that the proof counts what the whole has."""
    proof = check_tiles(parts, hull=hull)
    assert proof.triangles == len(whole.triangles)
    assert proof.vertices == len(whole.points)
    assert proof.edges == len(whole.edges)
    assert proof.boundary_edges == np.count_nonzero(whole.neighbors == -1)
    assert proof.area == sum_areas(whole.points[whole.triangles])


def sum_areas(corners):
    """Sum the areas of triangles in fractions."""
    doubled = Fraction(0)
    for a, b, c in corners[:, :, :2].tolist():
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, one) for one in (a, b, c))
        doubled += (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return doubled / 2
