"""Classes as polygons: against shapely's own union of the triangles, and by their areas."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_hex
from support.point_sets import seeds

import tinsmith as ts
from tinsmith.terrain.surface.dissolving import dissolve
from tinsmith.terrain.surface.normals import measure_plane_areas


def dissolved(tin, classes):
    """Return the polygons of each class, by class."""
    found = dissolve(tin, np.asarray(classes))
    features = ts.Features.of_polygons(
        tin.points[found.vertices, :2],
        found.ring_offsets,
        found.polygon_offsets,
        found.feature_offsets,
    )
    return dict(zip(found.classes.tolist(), features.to_shapely(), strict=True))


def triangles_of(tin):
    return shapely.polygons(tin.points[tin.triangles, :2])


def assert_dissolved(tin, classes):
    """Compare with shapely: valid, the same place, as many parts as are connected by edges."""
    classes = np.asarray(classes)
    found, triangles = dissolved(tin, classes), triangles_of(tin)
    assert sorted(found) == sorted(set(classes[classes >= 0].tolist()))
    for number, shape in found.items():
        assert shape.is_valid, shapely.is_valid_reason(shape)
        own = triangles[classes == number]
        assert shape.area == pytest.approx(shapely.area(own).sum(), rel=1e-12)
        assert shapely.contains_xy(shape, *shapely.get_coordinates(shapely.centroid(own)).T).all()
        for part in shapely.get_parts(shape):
            assert part.exterior.is_ccw
            assert not any(hole.is_ccw for hole in part.interiors)
        whole = shapely.union_all(own)
        assert shape.symmetric_difference(whole).area <= 1e-9 * whole.area
        assert shapely.get_num_interior_rings(shapely.get_parts(whole)).sum() <= (
            shapely.get_num_interior_rings(shapely.get_parts(shape)).sum()
        )


def grid(n):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(n, dtype=float), np.arange(n)))
    return ts.triangulate(np.column_stack([x, y, np.zeros(len(x))]))


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 6), seeds, st.integers(1, 3))
def test_random_classes_of_a_grid(n, seed, count):
    """Nearly every vertex is one where parts and holes touch."""
    tin = grid(n)
    classes = np.random.default_rng(seed).integers(-1, count, len(tin.triangles))
    assert_dissolved(tin, classes)


@pytest.mark.parametrize("seed", range(5))
def test_random_classes_of_random_points(seed):
    random = np.random.default_rng(seed)
    tin = ts.triangulate(random.uniform(0, 100, (60, 3)) + np.array([742_000.1, 4_030_000.3, 0]))
    assert_dissolved(tin, random.integers(-1, 2, len(tin.triangles)))


def test_a_ring_of_triangles_has_a_hole():
    tin = grid(5)
    middle = tin.points[tin.triangles, :2].mean(axis=1)
    inside = (np.abs(middle - 2.0) < 1.0).all(axis=1)
    found = dissolved(tin, np.where(inside, 1, 0))
    assert found[0].area == 12.0
    assert [len(part.interiors) for part in found[0].geoms] == [1]
    assert found[1].bounds == (1.0, 1.0, 3.0, 3.0)


def test_holes_that_touch_the_exterior_at_its_westernmost_vertex():
    """A kite with a kite cut out of it: both rings begin at the same vertex."""
    points = [[0, 0, 0], [4, 4, 0], [8, 0, 0], [4, -4, 0], [4, 2, 0], [6, 0, 0], [4, -2, 0]]
    tin = ts.triangulate(points)
    middle = tin.points[tin.triangles, :2].mean(axis=1)
    hole = shapely.Polygon([(0, 0), (4, 2), (6, 0), (4, -2)])
    assert_dissolved(tin, np.where(shapely.contains_xy(hole, *middle.T), -1, 0))


def test_no_class_at_all():
    found = dissolve(grid(3), np.full(8, -1))
    assert [len(part) for part in found] == [0, 1, 1, 1, 0]


def test_parts_of_a_tin_with_holes_and_islands():
    square = np.array([[0, 0], [40, 0], [40, 40], [0, 40]], float)
    random = np.random.default_rng(3)
    points = np.column_stack([random.uniform(0, 40, (400, 2)), random.uniform(0, 9, 400)])
    tin = ts.triangulate(
        points,
        boundary=[square[:, :2] * 0.4 + 1, square[:, :2] * 0.4 + 20],
        holes=[square * 0.1 + 4],
    )
    assert_dissolved(tin, np.arange(len(tin.triangles)) % 2)


# ------------------------------------------------------------------------------ slope


def rough(n=400, seed=1, **about):
    random = np.random.default_rng(seed)
    xy = random.uniform(0, 100, (n, 2)) + np.array([742_000.0, 4_030_000.0])
    return ts.triangulate(np.column_stack([xy, random.uniform(0, 6, n)]), **about)


@pytest.mark.parametrize("unit", ["degrees", "percent", "ratio"])
def test_classes_tile_the_surface(unit):
    tin = rough(crs="EPSG:32616")
    made = ts.slope_classes(tin, unit=unit)
    assert made.columns["area"].sum() == pytest.approx(tin.area, rel=1e-12)
    assert made.columns["share"].sum() == pytest.approx(100.0)
    assert made.columns["triangles"].sum() == len(tin.triangles)
    shapes = made.to_shapely()
    assert shapely.is_valid(shapes).all()
    np.testing.assert_allclose(shapely.area(shapes), made.columns["area"], rtol=1e-9)
    assert shapely.union_all(shapes).area == pytest.approx(tin.area, rel=1e-9)
    assert made.units["area"] == "m²"


def test_usual_breaks_are_those_of_the_page():
    """The limits that docs/slope.md gives for degrees."""
    made = ts.slope_classes(ts.triangulate([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 60]]))
    assert set(made.columns["upper"]) <= {2.0, 5.0, 10.0, 15.0, 25.0, 35.0, 45.0, 90.0}
    cuts = [
        set(ts.slope_classes(plane).columns["lower"])
        | set(ts.slope_classes(plane).columns["upper"])
        for slope in (14.99, 15.01)
        for plane in [ts.triangulate([[0, 0, 0], [0, 9, 0], [9, 0, 9 * np.tan(np.radians(slope))]])]
    ]
    assert cuts == [{10.0, 15.0}, {15.0, 25.0}]


@pytest.mark.parametrize("unit", ["degrees", "percent", "ratio"])
def test_every_triangle_lies_in_the_class_of_its_slope(unit):
    tin = rough()
    made = ts.slope_classes(tin, unit=unit, breaks=[0.01, 3, 7.5])
    steepness = ts.slope(tin, unit=unit)
    middles = tin.points[tin.triangles, :2].mean(axis=1)
    for row, shape in enumerate(made.to_shapely()):
        inside = shapely.contains_xy(shape, *middles.T)
        low, high = made.columns["lower"][row], made.columns["upper"][row]
        np.testing.assert_array_equal(inside, (steepness >= low) & (steepness < high))


def test_a_slope_on_a_limit_belongs_to_the_class_above():
    tin = ts.TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    assert ts.slope(tin, unit="percent")[0] == 100.0
    made = ts.slope_classes(tin, breaks=[50, 100, 150], unit="percent")
    assert made.columns["label"].tolist() == ["100 to 150 %"]


def test_labels_and_colors_make_a_legend():
    made = ts.slope_classes(rough(), breaks=[15, 27.5])
    assert made.columns["label"].tolist() == ["0 to 15°", "15 to 27.5°", "27.5° and more"]
    assert all(color.startswith("#") and len(color) == 7 for color in made.columns["color"])
    assert len(set(made.columns["color"])) == 3
    assert made.columns["upper"][-1] == 90.0
    assert ts.slope_classes(rough(), unit="ratio").columns["upper"][-1] == math.inf


@pytest.mark.parametrize(
    "breaks", [[], [0, 5], [5, 5], [5, 3], [-1], [math.nan], [math.inf], [90.0], "abc", [[1]], None]
)
def test_breaks_that_are_none(breaks):
    if breaks is None:
        breaks = np.linspace(1, 80, 1000)
    with pytest.raises(ts.OptionError, match="Invalid breaks"):
        ts.slope_classes(rough(10), breaks=breaks)


def test_units_of_both_axes_are_taken_into_account():
    feet = rough(crs="EPSG:2274")
    metres = ts.triangulate(feet.points, crs="EPSG:2274", elevation_unit="m")
    steep = ts.slope_classes(feet, unit="percent").columns["lower"]
    steeper = ts.slope_classes(metres, unit="percent").columns["lower"]
    assert steeper.max() > steep.max() or len(steeper) < len(steep)
    assert ts.slope_classes(feet).columns["area"].sum() == pytest.approx(
        measure_plane_areas(feet).sum()
    )
    assert "foot" in ts.slope_classes(feet).notes[-1]
    assert ts.slope_classes(metres).notes == metres.notes


# ------------------------------------------------------------------------------ aspect


def test_aspects_are_those_of_the_compass():
    turns = np.radians(np.arange(0, 360, 45.0))
    tins = [plane(-math.sin(turn), -math.cos(turn)) for turn in turns]
    labels = [ts.aspect_classes(tin).columns["label"].tolist() for tin in tins]
    assert labels == [["N"], ["NE"], ["E"], ["SE"], ["S"], ["SW"], ["W"], ["NW"]]
    assert ts.aspect_classes(plane(0, 0)).columns["label"].tolist() == ["level"]


def plane(east, north):
    return ts.triangulate([[0, 0, 0], [1, 0, east], [1, 1, east + north], [0, 1, north]])


@pytest.mark.parametrize(
    ("azimuth", "label"), [(337.5, "N"), (337.4, "NW"), (22.4, "N"), (22.6, "NE")]
)
def test_north_reaches_over_the_full_circle(azimuth, label):
    turn = math.radians(azimuth)
    tin = plane(-math.sin(turn) - 1e-9, -math.cos(turn))
    assert ts.aspect_classes(tin).columns["label"].tolist() == [label]


def test_aspect_classes_tile_the_surface():
    tin = rough(crs="EPSG:32616")
    made = ts.aspect_classes(tin)
    assert made.columns["area"].sum() == pytest.approx(tin.area, rel=1e-12)
    assert shapely.is_valid(made.to_shapely()).all()


@pytest.mark.parametrize("make", [ts.slope_classes, ts.aspect_classes])
def test_the_map_draws_each_class_with_all_its_rings_and_its_color(make):
    rng = np.random.default_rng(8)
    tin = ts.triangulate(np.column_stack([rng.uniform(0, 90, (150, 2)), rng.uniform(0, 30, 150)]))
    classes = make(tin)
    (axes,) = ts.relief_map(tin, classes).axes
    columns = classes.columns
    shares = []
    for patch, key, shape, color, label in zip(
        axes.patches, axes.get_legend().get_patches(), classes.to_shapely(), columns["color"],
        columns["label"], strict=True,
    ):  # fmt: skip
        drawn = [shapely.Polygon(r) for r in patch.get_path().to_polygons(closed_only=False)]
        assert sum(one.area * (1 if one.exterior.is_ccw else -1) for one in drawn) == pytest.approx(
            shape.area
        )
        assert to_hex(patch.get_facecolor()) == to_hex(key.get_facecolor()) == color.lower()
        shares.append(f"{label}, {100 * shape.area / tin.triangle_areas.sum():.1f} %")
    assert [text.get_text() for text in axes.get_legend().get_texts()] == shares
