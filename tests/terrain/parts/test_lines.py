"""Profiles, draped lines and elevations of a surface in tiles: those of the whole."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, TURNS, find_tilings, tile_cloud
from support.product_parts import (
    join_lines,
    join_places,
    require_same_bits,
    require_same_features,
    require_same_table,
)

import tinsmith as ts
from tinsmith.terrain.parts import places


def list_lines(points, seed=0):
    """Return lines across the surface, through vertices, along an edge of it, and beside it."""
    rng = np.random.default_rng(seed)
    bounds = ts.Bounds.of(points)
    low, size = np.array([bounds.xmin, bounds.ymin]), np.array([bounds.width, bounds.height])
    tin = ts.triangulate(points)
    edge = tin.points[tin.edges[len(tin.edges) // 2], :2]
    rim = tin.points[tin.boundary[0][:4], :2]
    return [
        low - 0.1 * size + rng.random((6, 2)) * size * 1.2,
        tin.points[rng.choice(len(tin.points), min(5, len(tin.points)), replace=False), :2],
        np.array([edge[0] * 2 - edge[1], edge[1] * 2 - edge[0]]),
        rim,
        np.array([low, low + size]),
        np.array([low - size, low - 0.5 * size]),
    ]


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("turn", TURNS)
def test_profiles_and_draped_lines_are_those_of_the_whole(name, turn):
    points = CLOUDS[name]
    given = list_lines(points)
    tin = ts.triangulate(points)
    profile = ts.profile(tin, given, interval=0.7)
    draped = {how: ts.drape(tin, given, outside=how) for how in ("nan", "cut")}
    for tiling in find_tilings(name, turn):
        surface = join_lines(tiling, tin, given)
        require_same_table(ts.profile(surface, given, interval=0.7), profile)
        for how, wanted in draped.items():
            found = ts.drape(surface, given, outside=how)
            require_same_features(found, wanted)


def test_few_triangles_are_kept():
    points = CLOUDS["uniform"]
    tin = ts.triangulate(points)
    line = np.array([[10.0, 10.0], [60.0, 70.0]])
    surface = join_lines(tile_cloud("uniform", "even", 4), tin, [line])
    assert len(surface.triangles) < 0.3 * len(tin.triangles)


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("turn", TURNS)
def test_elevations_at_places_are_those_of_the_whole(name, turn):
    points = CLOUDS[name]
    rng = np.random.default_rng(1)
    bounds = ts.Bounds.of(points)
    size = np.array([bounds.width, bounds.height])
    free = np.array([bounds.xmin, bounds.ymin]) + (rng.random((400, 2)) * 1.2 - 0.1) * size
    middle = 0.5 * (points[:-1, :2] + points[1:, :2])
    asked = np.concatenate([free, points[:, :2], middle])
    wanted = ts.triangulate(points).interpolate(asked)
    for tiling in find_tilings(name, turn):
        require_same_bits(join_places(tiling, asked), wanted)


def test_missing_places_are_refused():
    with pytest.raises(ts.OptionError, match="all 3 places"):
        places.join([places.PlacePart(np.array([0]), np.array([1.0]))], 3)
