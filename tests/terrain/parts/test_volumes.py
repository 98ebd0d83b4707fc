"""Volumes of tiles, added up: those of the whole surface, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, TURNS, Tiling, find_tilings
from support.point_cells import PointCells
from support.product_parts import join_volumes, make_volume_options, require_same_table
from support.tiled import divide

import tinsmith as ts
from tinsmith.terrain.parts import volumes
from tinsmith.tin.tiling import triangulate_box
from tinsmith.tin.tiling.boxes import widen


def list_squares(points, count):
    """Return regions: squares that overlap, and reach beyond the surface."""
    bounds = ts.Bounds.of(points)
    side = max(bounds.width, bounds.height) / 3
    return {
        f"region {k}": [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
        for k in range(count)
        for x, y in [(bounds.xmin - side / 3 + k * side * 0.7, bounds.ymin + k * side * 0.4)]
    }


@pytest.mark.each_value
@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("with_regions", [False, True])
@pytest.mark.parametrize("turn", TURNS)
def test_volumes_to_a_plane_are_those_of_the_whole(name, with_regions, turn):
    points = CLOUDS[name]
    tin = ts.triangulate(points)
    x, y = points[:, :2].mean(axis=0)
    for base in (float(np.median(points[:, 2])), [[x, y, 3.0], [x + 9, y, 4.0], [x, y + 9, 2.0]]):
        regions = list_squares(points, 3) if with_regions else None
        whole = ts.volume(tin, base=base, regions=regions)
        options = make_volume_options(tin, base, regions)
        for tiling in find_tilings(name, turn):
            require_same_table(join_volumes(tiling, options), whole)


@pytest.mark.each_value
@pytest.mark.parametrize("name", ["uniform", "lattice", "levels at vertices", "very few"])
@pytest.mark.parametrize("with_regions", [False, True])
@pytest.mark.parametrize("turn", TURNS)
def test_volumes_to_another_surface_are_those_of_the_whole(name, with_regions, turn):
    """The other one has some of the same triangles."""
    points = CLOUDS[name]
    rng = np.random.default_rng(1)
    others = points[rng.random(len(points)) < 0.9] if len(points) > 10 else points.copy()
    others[: len(others) // 2, 2] += rng.random(len(others) // 2)
    tin, other = ts.triangulate(points), ts.triangulate(others)
    regions = list_squares(points, 2) if with_regions else None
    whole = ts.volume(tin, other, regions=regions)
    options = make_volume_options(tin, None, regions)
    for tiling in find_tilings(name, turn):
        second = PointCells(others, tiling.source.xs, tiling.source.ys)

        def compute(part, box, second=second):
            reach = volumes.find_reach(part, box)
            beyond = triangulate_box(second, reach, around=widen(reach, 3.0))
            return volumes.compute_part(part, box, options, beyond)

        require_same_table(volumes.join(tiling.compute(compute), options), whole)


def test_parts_are_added_in_any_order():
    points = CLOUDS["clusters"] * (1.0, 1.0, 1e12)
    tin = ts.triangulate(points)
    options = make_volume_options(tin, 0.0, None)
    tiling = Tiling(divide(points, 4))
    parts = tiling.compute(lambda part, box: volumes.compute_part(part, box, options))
    for seed in range(3):
        order = np.random.default_rng(seed).permutation(len(parts))
        found = volumes.join([parts[k] for k in order], options)
        require_same_table(found, ts.volume(tin, base=0.0))
