"""Graded pads: against closed forms, a fine raster, and refusals."""

import numpy as np
import pytest
from support.surfaces import stretch_triangles

import tinsmith as ts

shapely = pytest.importorskip("shapely")
UTM = np.array([500_000.0, 4_000_000.0])
SQUARE = np.array([[25.0, 25], [35, 25], [35, 35], [25, 35]])
FLAT = [[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]]


def frustum(area, perimeter, height, ratio):
    """Return what lies between a pad and flat ground: walls, wedges beside edges, a cone."""
    reach = ratio * height
    return area * height + perimeter * reach * height / 2 + np.pi * reach**2 * height / 3


@pytest.mark.parametrize(("level", "kind"), [(3.0, "cut"), (8.0, "fill")])
def test_flat_ground_gives_the_frustum_with_rounded_corners(level, kind):
    ground = ts.triangulate(FLAT)
    graded = ts.grade(ground, SQUARE, level, cut_slope=2, fill_slope=3)
    found = ts.volume(ground, graded)
    height, ratio = abs(level - 5), 2 if kind == "cut" else 3
    cone = np.pi * (ratio * height) ** 2 * height / 3
    exact = frustum(100, 40, height, ratio)
    assert exact - 0.001 * cone < found[kind][0] < exact
    assert found["cut"][0] + found["fill"][0] == pytest.approx(found[kind][0])
    assert ts.check(graded).ok
    assert {"pad edge", "daylight", "slope"} <= set(graded.lines.names)


def test_inclined_plane_meets_the_slopes_where_the_planes_meet():
    corners = np.array([[0.0, 0], [100, 0], [100, 100], [0, 100]])
    ground = ts.triangulate(np.column_stack([corners, corners[:, 0] / 10]))
    pad = np.array([[40.0, 40], [60, 40], [60, 60], [40, 60]])
    graded = ts.grade(ground, pad, 5.0, cut_slope=2, fill_slope=4)
    # The planes meet where both are at one elevation, to the east and to the west.
    east, west = 60 + 1 / 0.4, 40 - 1 / 0.15
    xs = np.array([west - 0.01, west, (west + 40) / 2, 50, (east + 60) / 2, east, east + 0.01])
    got = graded.interpolate(np.column_stack([xs, np.full(7, 50.0)]))
    expected = np.where(xs > 60, 5 + (xs - 60) / 2, np.where(xs < 40, 5 - (40 - xs) / 4, 5.0))
    expected[[0, -1]] = xs[[0, -1]] / 10
    assert got == pytest.approx(expected, abs=1e-9)


PADS = [
    [[80, 80], [120, 80], [120, 110], [80, 110]],
    [[80, 80], [120, 80], [120, 120], [105, 120], [105, 95], [80, 95]],
    [[90, 80], [130, 95], [100, 125]],
]


@pytest.mark.each_value
@pytest.mark.parametrize("pad", PADS)
@pytest.mark.parametrize("seed", [0, 1])
def test_hilly_ground_agrees_with_a_fine_raster(pad, seed):
    from scipy import ndimage

    ground, pad = make_hills(seed), np.array(pad)
    graded = ts.grade(ground, pad + UTM, 100.0, cut_slope=2, fill_slope=1.5)
    assert ts.check(graded).ok
    n = 200
    q = (np.arange(n) + 0.5) * 200 / n
    xy = np.column_stack([one.ravel() for one in np.meshgrid(q, q)])
    away = shapely.distance(shapely.Polygon(pad), shapely.points(xy))
    old = ground.interpolate(xy + UTM)
    new = np.clip(old, 100 - away / 1.5, 100 + away / 2)
    parts, _ = ndimage.label(((np.abs(new - old) > 1e-9) | (away == 0)).reshape(n, n))
    made = (parts == parts.ravel()[np.flatnonzero(away == 0)[0]]).ravel()
    expected = np.where(made, new, old)
    assert np.abs(graded.interpolate(xy + UTM) - expected).max() < 0.01


def make_hills(seed):
    xy = np.random.default_rng(seed).random((2000, 2)) * 200
    xy = np.vstack([xy, [[0, 0], [200, 0], [200, 200], [0, 200]]])
    z = 100 + 5 * np.sin(xy[:, 0] / 25) + 4 * np.cos(xy[:, 1] / 30)
    return ts.triangulate(np.column_stack([xy + UTM, z]))


def test_ground_whose_triangles_are_not_delaunay_stays_beyond_the_slopes():
    ground = stretch_triangles(make_hills(0), (1.0, 6.0))
    middle = (ground.points.min(axis=0) + ground.points.max(axis=0))[:2] / 2
    pad = middle + SQUARE - 30.0
    level = float(ground.interpolate(middle))
    graded = ts.grade(ground, pad, level, cut_slope=1, fill_slope=1)
    xy = ground.points[ground.triangles, :2].mean(axis=1)
    daylight = [
        graded.points[c]
        for c, n in zip(graded.lines.chains(), graded.lines.names, strict=False)
        if n == "daylight"
    ]
    area = shapely.union_all(shapely.polygons([ring[:, :2] for ring in daylight]))
    beyond = ~shapely.intersects(shapely.buffer(area, 1e-6), shapely.points(xy))
    assert beyond.sum() > 100
    assert np.abs(graded.interpolate(xy) - ground.interpolate(xy))[beyond].max() < 1e-6


def test_a_narrow_notch_is_graded_within_what_is_told():
    pad = np.array(
        [[20.0, 20], [40, 20], [40, 40], [33, 40], [33, 25], [27, 25], [27, 40], [20, 40]]
    )
    ground = ts.triangulate([[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]])
    graded = ts.grade(ground, pad, 3.0, cut_slope=2, fill_slope=2)
    xy = np.random.default_rng(3).random((5000, 2)) * 60
    expected = np.minimum(5.0, 3 + shapely.distance(shapely.Polygon(pad), shapely.points(xy)) / 2)
    assert np.abs(graded.interpolate(xy) - expected).max() < 0.02 * 2


def test_the_ring_gives_the_elevation_and_feet_count():
    ring = np.column_stack([SQUARE, np.full(4, 3.0)])
    ground = ts.triangulate(FLAT)
    level = ts.grade(ground, SQUARE, 3.0, cut_slope=2, fill_slope=3)
    assert ts.grade(ground, ring, cut_slope=2, fill_slope=3) == level
    feet = ts.triangulate(FLAT, crs="EPSG:32616", elevation_unit="ft")
    graded = ts.grade(feet, SQUARE, 3.0, cut_slope=2, fill_slope=3)
    # Two metres along rise one metre.
    assert graded.interpolate([[35.3, 30]]) == pytest.approx([3 + 0.15 / 0.3048])


def test_vertices_of_the_ground_keep_their_attributes():
    points = make_hills(0).points
    ground = ts.triangulate(ts.Survey(points=points, attributes={"number": np.arange(len(points))}))
    pad = np.add(UTM, PADS[0])
    graded = ts.grade(ground, pad, 100.0, cut_slope=2, fill_slope=1.5)
    kept = np.isfinite(graded.attributes["number"])
    rows = graded.attributes["number"][kept].astype(int)
    np.testing.assert_array_equal(graded.points[kept], points[rows])
    inside = shapely.contains(shapely.Polygon(pad), shapely.points(points[:, :2]))
    assert not inside[rows].any()
    same = np.abs(graded.interpolate(points[:, :2]) - points[:, 2]) == 0
    assert set(rows) == set(np.flatnonzero(same & ~inside))


def test_level_ground_at_the_level_of_the_pad_is_left():
    ground = ts.triangulate(FLAT)
    graded = ts.grade(ground, SQUARE, 5.0, cut_slope=2, fill_slope=3)
    assert (graded.points[:, 2] == 5).all()


@pytest.mark.parametrize(
    ("pad", "options", "kind", "text"),
    [
        (SQUARE + 30, {"elevation": 5.0}, ts.PointsError, "lies off the ground, at"),
        (SQUARE, {"elevation": 30.0}, ts.PointsError, "fill slope does not meet the ground"),
        (SQUARE, {"elevation": -20.0}, ts.PointsError, "cut slope does not meet the ground"),
        (SQUARE, {"elevation": 3.0, "cut_slope": 0}, ts.OptionError, "2 is 2:1"),
        (SQUARE, {"elevation": 3.0, "fill_slope": -1}, ts.OptionError, "2 is 2:1"),
        (SQUARE, {"elevation": 3.0, "fill_slope": np.nan}, ts.OptionError, "2 is 2:1"),
        (SQUARE, {}, ts.OptionError, "no elevations"),
        (np.column_stack([SQUARE, [1, 2, 3, 4]]), {}, ts.OptionError, "not level"),
        (SQUARE, {"elevation": np.inf}, ts.OptionError, "finite"),
        (SQUARE[[0, 2, 1, 3]], {"elevation": 3.0}, ts.LinesError, "pad"),
        ([SQUARE, SQUARE / 10 + 27], {"elevation": 3.0}, ts.OptionError, "one ring"),
    ],
)
def test_refusals(pad, options, kind, text):
    ground = ts.triangulate(FLAT)
    with pytest.raises(kind, match=text):
        ts.grade(ground, pad, **({"cut_slope": 2, "fill_slope": 3} | options))


def test_degrees_are_refused():
    ground = ts.triangulate([[0, 0, 5], [1, 0, 5], [1, 1, 5]], crs="EPSG:4326")
    with pytest.raises(ts.CrsError, match="degrees"):
        ts.grade(ground, SQUARE, 3.0, cut_slope=2, fill_slope=3)
