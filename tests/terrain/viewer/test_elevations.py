"""The range of elevations of a picture: blunders are left out and told, relief never is."""

from __future__ import annotations

import numpy as np
import pytest

from tinsmith import triangulate
from tinsmith.terrain import preview
from tinsmith.terrain.viewer.options import PreviewOptions
from tinsmith.terrain.viewer.relief import find_elevation_range
from tinsmith.terrain.viewer.scene import make_scene

pytest.importorskip("pyvista")


def hill(blunders=(), *, level=False):
    axis = np.linspace(0.0, 240.0, 25)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    z = 310.0 + (0 if level else 1) * 8.0 * np.sin(x / 50) * np.cos(y / 70)
    for row, elevation in blunders:
        z[row] = elevation
    return triangulate(np.column_stack([742_000 + x, 4_030_000 + y, z]), crs="EPSG:32616")


@pytest.mark.parametrize("value", [9999.0, 0.0, -99.0, 400.0])
@pytest.mark.parametrize("rows", [(300,), (0,), (17, 300, 471)])
def test_a_blunder_changes_neither_tints_nor_exaggeration_nor_frame(value, rows):
    sound, wrong = (
        make_scene(hill([(row, z) for row in rows]), PreviewOptions.of()) for z in (310.0, value)
    )
    assert wrong.exaggeration == sound.exaggeration
    assert wrong.elevations == pytest.approx(sound.elevations, abs=0.2)
    assert wrong.title_block.legend.ends == wrong.elevations
    assert np.flatnonzero(wrong.shown.is_far_off).tolist() == sorted(rows)
    assert f"{value:,g}" in wrong.title_block.warning
    assert sound.title_block.warning == ""
    count = "1 elevation" if len(rows) == 1 else f"{len(rows)} elevations"
    assert wrong.title_block.warning.startswith(count)
    assert preview(wrong.tin).notes[-1] == wrong.title_block.warning + "."
    assert not any("far off" in note for note in preview(sound.tin).notes)


@pytest.mark.parametrize(
    "elevations",
    [
        np.linspace(0.0, 1.0, 500) ** 8 * 100,  # a lone peak
        np.append(np.zeros(480), np.linspace(0.0, 30.0, 20)),  # a mound on level ground
        np.append(np.linspace(0, 10, 97), [48.0, 49.0, 50.0]),  # within four times the range
        np.append(np.linspace(0, 10, 80), np.full(20, 500.0)),  # two levels, no blunder
        np.append(np.linspace(0, 1, 18), 500.0),  # too few to tell
        np.full(50, 7.0),
        np.array([3.0]),
    ],
    ids=["peak", "mound", "near", "two levels", "few", "level", "one"],
)
def test_relief_is_never_left_out(elevations):
    found = find_elevation_range(elevations, 100.0)
    assert (found.low, found.high) == (elevations.min(), elevations.max())
    assert not found.is_far_off.any()


def test_on_level_ground_a_point_is_far_off_by_the_extent():
    level = np.full(50, 7.0)
    near, far = (find_elevation_range(np.append(level, z), 100.0) for z in (106.0, 108.0))
    assert not near.is_far_off.any()
    assert np.flatnonzero(far.is_far_off).tolist() == [50]


def test_blunders_at_both_ends_are_left_out():
    z = np.append(np.linspace(300.0, 310.0, 400), [0.0, 0.0, -1e6, 9999.0])
    found = find_elevation_range(z, 100.0)
    assert (found.low, found.high) == (300.0, 310.0)
    assert np.flatnonzero(found.is_far_off).tolist() == [400, 401, 402, 403]


def test_a_range_asked_for_is_that_of_the_tints_and_the_legend_says_what_is_outside():
    tin = hill()
    scene = make_scene(tin, PreviewOptions.of(elevations=(305.0, 312.0)))
    assert scene.elevations == scene.title_block.legend.ends == (305.0, 312.0)
    z = tin.points[:, 2]
    count = int(((z < 305) | (z > 312)).sum())
    assert scene.title_block.warning == f"{count} elevations out of this range"
    wide = make_scene(tin, PreviewOptions.of(elevations=(300.0, 320.0)))
    assert wide.title_block.warning == ""
    assert wide.exaggeration == scene.exaggeration
