"""Corridors: found by their elongation, seen from their side, drawn in strips that lose nothing."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from PIL import Image

from tinsmith import triangulate
from tinsmith.base.georeference.scales import find_ground
from tinsmith.terrain import preview
from tinsmith.terrain.viewer.annotations import Layout
from tinsmith.terrain.viewer.camera import View
from tinsmith.terrain.viewer.corridor import (
    STRIP_GAP,
    cut_into_strips,
    find_corridor,
    measure_mean_width,
)
from tinsmith.terrain.viewer.options import PreviewOptions
from tinsmith.terrain.viewer.scene import make_scene
from tinsmith.terrain.viewer.strips import place_strips

LAYOUT = Layout(1600.0, 1000.0)


def corridor(length=20_000.0, width=40.0, azimuth=55.0, *, count=900, relief=80.0, seed=1):
    """Random points in a rectangle that is turned, rising along it."""
    along, across = np.random.default_rng(seed).random((2, count)) * [[length], [width]]
    ends = np.array([(0, 0), (0, width), (length, 0), (length, width)], float).T
    along, across = np.append(along, ends[0]), np.append(across, ends[1])
    turn = math.radians(azimuth)
    x = along * math.sin(turn) + across * math.cos(turn)
    y = along * math.cos(turn) - across * math.sin(turn)
    z = 300 + relief * along / length
    return triangulate(np.column_stack([500_000 + x, 4_200_000 + y, z]), crs="EPSG:32616")


# ------------------------------------------------------------------ what a corridor is


@pytest.mark.parametrize("azimuth", [0.0, 12.345, 55.0, 90.0, 135.0, 179.0])
def test_the_axis_of_a_corridor_is_found(azimuth):
    tin = corridor(azimuth=azimuth)
    found = find_corridor(tin, find_ground(tin))
    apart = (found.azimuth - azimuth + 90.0) % 180.0 - 90.0
    assert abs(apart) < math.degrees(0.5 / 20_000)
    assert found.width == pytest.approx(40.0, rel=0.01)
    assert found.length == pytest.approx(20_000.0, rel=0.001)


@pytest.mark.parametrize(("width", "is_corridor"), [(90.0, True), (110.0, False), (1000.0, False)])
def test_a_corridor_is_ten_times_as_long_as_wide(width, is_corridor):
    tin = corridor(length=1000.0, width=width)
    assert (find_corridor(tin, find_ground(tin)) is not None) == is_corridor


@pytest.mark.parametrize("azimuth", np.arange(0.0, 180.0, 15.0))
@pytest.mark.parametrize("usual", [202.5, 180.0, 10.0])
def test_it_is_seen_from_the_nearer_of_its_long_sides(azimuth, usual):
    tin = corridor(azimuth=azimuth, length=2000.0)
    found = find_corridor(tin, find_ground(tin))
    side = found.find_side(usual)
    assert math.cos(math.radians(side - azimuth)) == pytest.approx(0.0, abs=1e-3)
    assert math.cos(math.radians(side - usual)) >= -1e-3


def test_degrees_are_measured_on_the_ground():
    """At 60 north a degree of longitude is half as long: 8 by 1 degrees are 4 to 1."""
    for longitude, is_corridor in ((0.018, False), (0.022, True)):
        corners = [[x, 60 + y, 0] for x in (0, longitude) for y in (0, 0.001)]
        tin = triangulate(corners, crs="EPSG:4326")
        assert (find_corridor(tin, find_ground(tin)) is not None) == is_corridor


def test_the_mean_width_is_that_of_a_strip():
    tin = corridor()
    expected = 2 * 20_000 * 40 / (2 * 20_040)
    assert measure_mean_width(tin, find_ground(tin)) == pytest.approx(expected, rel=1e-3)


# ------------------------------------------------------------------ strips


@pytest.mark.parametrize("elongation", [12.0, 30.0, 500.0])
def test_strips_hold_all_ground_and_fit_the_sheet(elongation):
    tin = corridor(width=20_000 / elongation)
    scene = make_scene(tin, PreviewOptions.of())
    strips, (right, up, _) = scene.strips, scene.view.axes
    assert len(strips.lows) > 1
    across, along = scene.points @ right, scene.points @ up
    assert strips.edges[0] == pytest.approx(across.min())
    assert strips.edges[-1] == pytest.approx(across.max())
    strip = np.clip(np.searchsorted(strips.edges, across, "right") - 1, 0, len(strips.lows) - 1)
    assert (along >= strips.lows[strip] - 1e-9).all()
    assert (along <= strips.highs[strip] + 1e-9).all()
    places = place_strips(strips, LAYOUT)
    frame = LAYOUT.frame
    assert places[0].top <= frame.ymax - STRIP_GAP + 1e-9
    assert places[-1].top - places[-1].height >= frame.ymin - 1e-6
    for upper, lower in itertools.pairwise(places):
        assert upper.top - upper.height - lower.top >= STRIP_GAP - 1e-9
    assert places[0].left >= frame.xmin - 1e-9
    assert places[0].left + strips.length * strips.scale <= frame.xmax + 1e-6


def test_strips_are_larger_than_one_picture_would_be():
    tin = corridor()
    scene = make_scene(tin, PreviewOptions.of())
    single = LAYOUT.frame.width / 20_000
    assert scene.strips.scale > 8 * single


def test_ground_between_points_far_apart_is_within_its_strip():
    """Two triangles from end to end: the strips between have edges, and no point."""
    points = np.array([[0, 0, 0], [1000, 0, 0], [1000, 20, 0], [0, 20, 0]], float)
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]], np.int32)
    strips = cut_into_strips(points, edges, View(180.0, 90.0), LAYOUT.frame)
    assert len(strips.lows) > 3
    np.testing.assert_allclose(strips.lows, 0.0, atol=1e-9)
    np.testing.assert_allclose(strips.highs, 20.0)


@pytest.mark.parametrize(
    ("options", "azimuth"), [({}, 145.0), ({"azimuth": 60.0}, 60.0), ({"view": "top"}, 145.0)]
)
def test_who_chooses_where_to_look_from_gets_one_picture(options, azimuth):
    scene = make_scene(corridor(), PreviewOptions.of(**options))
    assert scene.view.azimuth == pytest.approx(azimuth, abs=0.01)
    assert (scene.strips is None) == ("azimuth" in options)
    assert not scene.has_block
    assert ("strips of" in scene.title_block.subtitle) == (scene.strips is not None)


@pytest.mark.parametrize(("width", "has_block"), [(1000.0, True), (100.0, True), (40.0, False)])
def test_ground_narrower_than_its_block_is_high_stands_on_none(width, has_block):
    tin = corridor(length=1000.0, width=width)
    assert make_scene(tin, PreviewOptions.of(azimuth=0.0)).has_block == has_block


def test_the_exaggeration_of_strips_goes_by_the_relief_within_one():
    scene = make_scene(corridor(relief=80.0), PreviewOptions.of())
    within = 80.0 / len(scene.strips.lows)
    assert scene.exaggeration * within >= 0.5 * 39.9
    assert scene.exaggeration * within <= 40.0
    assert make_scene(corridor(), PreviewOptions.of(exaggeration=7.0)).exaggeration == 7.0


@pytest.mark.slow
@pytest.mark.usefixtures("can_draw")
def test_each_strip_shows_its_own_part(tmp_path):
    """Tints rise from strip to strip, and each strip is as long and wide as the scale says."""
    pytest.importorskip("pyvista")
    tin = corridor(width=400.0)
    path = preview(tin, output=tmp_path / "a.png", size=(1600, 1000), view="top", lines=False)
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    scene = make_scene(tin, PreviewOptions.of(view="top"))
    means = []
    for place in place_strips(scene.strips, LAYOUT):
        row, left = round(1000 - place.top), round(place.left)
        width = round(scene.strips.length * scene.strips.scale)
        band = pixels[row : row + round(place.height), left : left + width]
        colored = np.ptp(band, axis=2) > 15
        assert colored[3:-3].mean() > 0.9
        means.append(band[colored].mean())
        above = pixels[row - 5 : row - 1, left : left + width]
        assert (above.min(axis=2) > 60).all()
    assert len(means) > 2
    assert (np.diff(means) > 0).all()


def test_level_strips_seen_from_the_horizon_stay_on_the_sheet():
    """They have no height at all, so that no number of them would be too many."""
    tin = corridor(relief=0.0)
    scene = make_scene(tin, PreviewOptions.of(tilt=0.0))
    places = place_strips(scene.strips, LAYOUT)
    assert len(places) > 5
    assert places[-1].top - places[-1].height >= LAYOUT.frame.ymin
