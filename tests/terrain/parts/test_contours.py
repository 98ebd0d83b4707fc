"""Contours traced tile by tile and joined: those of the whole surface."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, TURNS, find_tilings, tile_cloud
from support.product_parts import join_contours, list_contour_parts, require_same_features

import tinsmith as ts
from tinsmith.terrain.parts import contours


def choose_levels(name):
    """Return levels, of contours those of some flat triangles."""
    return {"levels": [60.0, 62.5, 70.0, 75.0, 95.0]} if name == "contours" else {"interval": 2.0}


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("turn", TURNS)
def test_lines_are_those_of_the_whole(name, turn):
    points = CLOUDS[name]
    given = choose_levels(name)
    whole = ts.contours(ts.triangulate(points), **given)
    for tiling in find_tilings(name, turn):
        require_same_features(join_contours(tiling, points, given), whole)


def test_tiles_may_come_in_any_order():
    points = CLOUDS["levels at vertices"]
    tiling = tile_cloud("levels at vertices", "through points", 2)
    options, parts = list_contour_parts(tiling, points, {"interval": 4.0})
    wanted = contours.join(parts, options)
    for seed in range(3):
        order = np.random.default_rng(seed).permutation(len(parts))
        require_same_features(contours.join([parts[k] for k in order], options), wanted)


def test_a_missing_tile_is_noticed():
    options, parts = list_contour_parts(
        tile_cloud("uniform", "even", 2), CLOUDS["uniform"], {"interval": 2.0}
    )
    with pytest.raises(ValueError, match="a tile that is missing"):
        contours.join(parts[1:], options)


def test_lines_come_as_soon_as_they_are_finished():
    points = CLOUDS["lattice"]
    _, parts = list_contour_parts(
        tile_cloud("lattice", "through points", 2), points, {"interval": 2.0}
    )
    joiner = contours.LineJoiner()
    finished = [len(joiner.add(part).level) for part in parts]
    assert joiner.is_done
    assert sum(finished[: len(parts) // 2]) > 0
    assert sum(finished) >= len(ts.contours(ts.triangulate(points), 2.0))
