"""Bands filled from the segments of tiles: those of the whole surface."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, TURNS, Tiling, find_tilings
from support.point_sets import points as make_points
from support.product_parts import join_bands, require_same_features
from support.tiled import divide

import tinsmith as ts
from tinsmith.terrain.parts import bands


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("turn", TURNS)
def test_polygons_are_those_of_the_whole(name, turn):
    points = CLOUDS[name]
    given = {"levels": [60.0, 62.5, 70.0, 75.0]} if name == "contours" else {"interval": 2.0}
    whole = ts.contour_bands(ts.triangulate(points), **given)
    for tiling in find_tilings(name, turn):
        require_same_features(join_bands(tiling, points, given), whole)


def test_slivers_along_the_boundary_are_left_out_as_in_memory():
    x, y = np.meshgrid(np.arange(14.0), np.arange(14.0))
    turn = np.radians(17.0)
    east = 5e5 + x.ravel() * np.cos(turn) - y.ravel() * np.sin(turn)
    north = 5e6 + x.ravel() * np.sin(turn) + y.ravel() * np.cos(turn)
    points = np.column_stack([east, north, np.random.default_rng(3).random(x.size) * 9])
    whole = ts.contour_bands(ts.triangulate(points), 2.0)
    for side in (1, 2, 4):
        tiling = Tiling(divide(points, side), rings=bands.RINGS)
        require_same_features(join_bands(tiling, points, {"interval": 2.0}), whole)


def test_polygons_that_are_made_valid_are_those_in_memory():
    """Points near one line or a rounding apart, whose bands meet themselves."""
    compared = refused = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        points = np.asarray(make_points(rng, int(rng.integers(4, 60))))
        try:
            tin = ts.triangulate(points)
            levels = np.unique(np.quantile(tin.points[:, 2], [0.2, 0.4, 0.6, 0.8]))
            whole = ts.contour_bands(tin, levels=levels)
        except ts.PointsError:
            continue
        if not any("made valid" in note for note in whole.notes):
            continue
        for side in (1, 2):
            tiling = Tiling(divide(tin.points, side), rings=bands.RINGS)
            try:
                found = join_bands(tiling, tin.points, {"levels": levels})
            except ts.PointsError:
                refused += 1
                if side == 1 and not any("were joined from" in note for note in whole.notes):
                    raise
                continue
            require_same_features(found, whole)
            assert [note for note in whole.notes if "valid" in note] == [
                note for note in found.notes if "valid" in note
            ]
            compared += 1
    assert compared > 10
    assert refused > 0
