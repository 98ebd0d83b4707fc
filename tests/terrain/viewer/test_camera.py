"""The camera: what it shows of the points, where it sees north, and views in words."""

from __future__ import annotations

import numpy as np
import pytest

from tinsmith.terrain.viewer import camera as views
from tinsmith.tin import Bounds

pv = pytest.importorskip("pyvista")


@pytest.mark.parametrize("view", views.VIEWS.values(), ids=views.VIEWS)
def test_the_scale_holds_from_left_to_right_and_all_points_are_in_the_frame(view):
    points = np.random.default_rng(5).uniform(-1, 1, (500, 3)) * (300, 200, 50)
    size, frame = (1200, 900), Bounds(50, 150, 1150, 800)
    camera = pv.Camera()
    views.aim(camera, points, view=view, frame=frame, size=size)
    shown = projected(camera, points, size)
    low, high = shown.min(axis=0), shown.max(axis=0)
    assert (low >= np.array([50, 150]) - 1e-6).all()
    assert (high <= np.array([1150, 800]) + 1e-6).all()
    assert np.isclose(high - low, [1100, 650]).any()
    across = view.axes[0]
    ends = projected(camera, np.array([points[0], points[0] + 100 * across]), size)
    drawn = np.subtract(*ends[::-1])
    pixels = 100 * views.measure_pixels_per_unit(camera, size[1])
    assert drawn == pytest.approx([pixels, 0.0], abs=1e-6)


def projected(camera, points, size):
    """Window coordinates by VTK's own matrix."""
    camera.clipping_range = (1.0, 1e5)
    matrix = camera.GetCompositeProjectionTransformMatrix(size[0] / size[1], -1, 1)
    values = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    clip = np.column_stack([points, np.ones(len(points))]) @ values.T
    return (clip[:, :2] / clip[:, 3:] + 1) / 2 * size


@pytest.mark.parametrize("view", views.VIEWS.values(), ids=views.VIEWS)
def test_the_north_arrow_points_where_the_camera_sees_north(view):
    camera = pv.Camera()
    size = (1000, 1000)
    views.aim(camera, np.eye(3) * 9, view=view, frame=Bounds(0, 0, 1000, 1000), size=size)
    start, north = projected(camera, np.array([[0, 0, 0], [0, 1.0, 0]]), size)
    expected = (north - start) / views.measure_pixels_per_unit(camera, 1000)
    np.testing.assert_allclose(views.project_ground_axes(camera)[1], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("view", "caption"),
    [
        (views.VIEWS["top"], "Map view, north up"),
        (views.View(90.0, 90.0), "Map view"),
        (views.View(359.0, 10.0), "Parallel view from the north, 10° above the horizon"),
        (views.View(135.0, 60.4), "Parallel view from the southeast, 60° above the horizon"),
        (views.View(270.0, -20.0), "Parallel view from the west, 20° below the horizon"),
    ],
)
def test_a_view_is_read_back_from_the_camera_and_put_in_words(view, caption):
    camera = pv.Camera()
    views.aim(camera, np.eye(3), view=view, frame=Bounds(0, 0, 100, 100), size=(100, 100))
    seen = views.View.of(camera)
    assert (seen.azimuth, seen.height) == pytest.approx((view.azimuth, view.height), abs=1e-5)
    assert seen.caption == caption
