"""Longitudes and latitudes are that, at every door."""

import numpy as np
import pytest

import tinsmith as ts

UTM = np.array([[752_760.0, 4_024_275.0, 1.0], [752_860, 4_024_275, 2], [752_760, 4_024_375, 3]])
DEGREES = np.array([[9.0, 50.0, 1.0], [9.001, 50.0, 2.0], [9.0, 50.001, 3.0]])

DOORS = {
    "triangulate": lambda points: ts.triangulate(points, crs="EPSG:4326"),
    "survey": lambda points: ts.Survey(points=points, crs="EPSG:4326"),
    "from_triangles": lambda points: ts.TIN.from_triangles(points, [[0, 1, 2]], crs="EPSG:4326"),
    "replace": lambda points: ts.triangulate(points).replace(crs="EPSG:4326"),
    "insert": lambda points: ts.triangulate(DEGREES, crs="EPSG:4326").insert(points),
    "move": lambda points: ts.triangulate(DEGREES, crs="EPSG:4326").move(0, points[0]),
    "add_breakline": lambda points: ts.triangulate(DEGREES, crs=4326).add_breakline(points),
    "breaklines": lambda points: ts.triangulate(DEGREES, breaklines=[points], crs="EPSG:4326"),
    "features": lambda points: ts.Features.of_points(points, crs="EPSG:4326"),
}


@pytest.mark.parametrize("door", DOORS)
def test_eastings_are_no_degrees(door):
    with pytest.raises(ts.PointsError, match=r"longitude.* -180 to 360 .* -90 to 90"):
        DOORS[door](UTM)


def test_an_edit_after_others_is_checked_too():
    tin = ts.triangulate(DEGREES, crs="EPSG:4326")
    tin.insert([[9.0005, 50.0005, 2.0]])
    with pytest.raises(ts.PointsError, match="longitude"):
        tin.insert(UTM[:1])
    assert len(tin.points) == 4


def test_points_on_both_sides_of_the_antimeridian_are_refused():
    longitudes = np.array([179.99, -179.99, 179.98])
    points = np.column_stack([longitudes, [-17.0, -17.0, -17.1], [1.0, 2.0, 3.0]])
    with pytest.raises(ts.PointsError, match=r"antimeridian.*Add 360"):
        ts.triangulate(points, crs="EPSG:4326")
    points[:, 0] %= 360.0
    assert ts.triangulate(points, crs="EPSG:4326").bounds.width == pytest.approx(0.03)


def test_points_around_the_globe_are_told():
    x, y = np.meshgrid(np.arange(-170.0, 180.0, 20.0), [-10.0, 10.0])
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    assert "span 340 degrees" in ts.triangulate(points, crs="EPSG:4326").report.notes[0]


def test_areas_in_degrees_are_refused_or_square_metres():
    tin = ts.triangulate(DEGREES, crs="EPSG:4326")
    for name in ("area", "triangle_areas", "surface_area"):
        with pytest.raises(ts.CrsError, match=r"angles|degrees|longitude"):
            getattr(tin, name)
    row = ts.slope_statistics(tin)
    assert row.units["area"] == "m²"
    metres = 0.5 * 71_700 * 111_230 * 1e-6  # half a rectangle at 50 degrees north
    assert row["area"][0] == pytest.approx(metres, rel=0.01)
