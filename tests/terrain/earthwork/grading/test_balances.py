"""Pads in balance, and inclined pads: closed forms, a fine raster, measured again; refusals."""

import numpy as np
import pytest

import tinsmith as ts

shapely = pytest.importorskip("shapely")
UTM = np.array([500_000.0, 4_000_000.0])
SQUARE = np.array([[25.0, 25], [35, 25], [35, 35], [25, 35]])
CORNERS = np.array([[0.0, 0], [60, 0], [60, 60], [0, 60]])


def plane(east, north=0.0, height=0.0, **more):
    z = height + CORNERS @ [east, north]
    return ts.triangulate(np.column_stack([CORNERS, z]), **more)


def hills(seed):
    xy = np.random.default_rng(seed).random((2000, 2)) * 200
    xy = np.vstack([xy, [[0, 0], [200, 0], [200, 200], [0, 200]]])
    z = 100 + 5 * np.sin(xy[:, 0] / 25) + 4 * np.cos(xy[:, 1] / 30)
    return ts.triangulate(np.column_stack([xy + UTM, z]))


def one(table, name):
    return float(table[name][0])


# ---------------------------------------------------------------- closed forms


@pytest.mark.parametrize("gradient", [None, (0.02, -0.03)])
def test_on_an_inclined_plane_cut_and_fill_mirror_each_other(gradient):
    found = ts.balance(plane(0.1), SQUARE, cut_slope=2, fill_slope=2, gradient=gradient)
    assert found.elevation == pytest.approx(3.0, abs=1e-6)
    assert one(found.table, "cut") == pytest.approx(one(found.table, "fill"), rel=1e-8)
    assert ts.check(found.tin).ok


def test_a_surplus_on_flat_ground_makes_a_frustum():
    """100 d + 40 s d²/2 + pi s² d³/3 of a pad d above the ground, cones cut flat by facets."""
    found = ts.balance(plane(0.0, height=5.0), SQUARE, cut_slope=2, fill_slope=3, surplus=300.0)
    high = found.elevation - 5.0
    exact = 100 * high + 40 * 3 * high**2 / 2 + np.pi * 9 * high**3 / 3
    assert exact == pytest.approx(300.0, rel=1e-3)
    assert one(found.table, "fill") == pytest.approx(300.0, rel=1e-9)
    # Raised, the fill grows by its area.
    area = 100 + 40 * 3 * high + np.pi * (3 * high) ** 2
    assert one(found.table, "sensitivity") == pytest.approx(area, rel=1e-3)


def test_a_round_pad_on_a_cone():
    """A hill 10 high that falls by 1:10; a pad of radius 20: all integrals in the radius."""
    from scipy.optimize import brentq

    k, radius, shrink, ratio = 0.1, 20.0, 0.85, 3.0
    angle = np.arange(240) * np.pi / 120
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    rim = np.column_stack([ring * 90, np.full(240, 10 - 90 * k)])
    ground = ts.triangulate(np.vstack([rim, [[0, 0, 10.0]]]))
    found = ts.balance(ground, ring * radius, cut_slope=2, fill_slope=ratio, shrink_factor=shrink)

    def rest(level):
        top = (10 - level) / k
        cut = np.pi * k * top**3 / 3
        foot = (radius / ratio + level - 10) / (1 / ratio - k)
        r = np.linspace(top, radius, 20001)
        within = np.trapezoid((level - 10 + k * r) * 2 * np.pi * r, r)
        r = np.linspace(radius, foot, 20001)
        beyond = np.trapezoid((level - (r - radius) / ratio - 10 + k * r) * 2 * np.pi * r, r)
        return cut * shrink - within - beyond

    assert found.elevation == pytest.approx(brentq(rest, 8.1, 9.9), abs=1e-3)


# ---------------------------------------------------------------- measured again


@pytest.mark.parametrize("gradient", [None, (0.03, 0.02)])
@pytest.mark.parametrize("seed", [0, 1])
def test_the_graded_ground_is_in_balance(gradient, seed):
    ground = hills(seed)
    pad = np.add(UTM, [[80, 80], [120, 80], [120, 110], [80, 110]])
    how = {"cut_slope": 2, "fill_slope": 1.5, "gradient": gradient}
    found = ts.balance(ground, pad, shrink_factor=0.9, swell_factor=1.3, surplus=-200.0, **how)
    assert ts.check(found.tin).ok
    again = ts.volume(ground, found.tin)
    for name in ("cut", "fill"):
        assert one(again, name) == pytest.approx(one(found.table, name), rel=1e-6)
    assert 0.9 * one(again, "cut") - 200 - one(again, "fill") == pytest.approx(0.0, abs=1e-2)
    assert one(found.table, "haul") == pytest.approx(1.3 * one(found.table, "cut"))
    graded = ts.grade(ground, pad, found.elevation, **how)
    assert graded.points == pytest.approx(found.tin.points)
    rest = []
    for step in (-0.01, 0.01):
        near = ts.volume(ground, ts.grade(ground, pad, found.elevation + step, **how))
        rest.append(0.9 * one(near, "cut") - one(near, "fill"))
    slope = (rest[0] - rest[1]) / 0.02
    assert one(found.table, "sensitivity") == pytest.approx(slope, rel=1e-3)


@pytest.mark.parametrize("seed", [0, 1])
def test_an_inclined_pad_agrees_with_a_fine_raster(seed):
    from scipy import ndimage

    ground, pad = hills(seed), np.array([[80.0, 80], [120, 80], [125, 112], [80, 110]])
    gradient = np.array([0.05, -0.04])
    graded = ts.grade(
        ground, pad + UTM, 100.0, cut_slope=2, fill_slope=1.5, gradient=tuple(gradient)
    )
    assert ts.check(graded).ok
    n = 200
    q = (np.arange(n) + 0.5) * 200 / n
    xy = np.column_stack([one.ravel() for one in np.meshgrid(q, q)])
    shape, places = shapely.Polygon(pad), shapely.points(xy)
    away = shapely.distance(shape, places)
    feet = shapely.get_coordinates(shapely.shortest_line(places, shape)).reshape(-1, 2, 2)[:, 1]
    middle = [shape.centroid.x, shape.centroid.y]
    level = 100 + (feet - middle) @ gradient
    old = ground.interpolate(xy + UTM)
    new = np.clip(old, level - away / 1.5, level + away / 2)
    parts, _ = ndimage.label(((np.abs(new - old) > 1e-9) | (away == 0)).reshape(n, n))
    made = (parts == parts.ravel()[np.flatnonzero(away == 0)[0]]).ravel()
    expected = np.where(made, new, old)
    assert np.abs(graded.interpolate(xy + UTM) - expected).max() < 0.01


@pytest.mark.parametrize("shrink", [1.0, 0.85])
def test_a_site_with_fixed_pads_is_in_balance_by_what_they_leave(shrink):
    ground = hills(4)
    ratios = {"cut_slope": 1.5, "fill_slope": 2}
    fixed = ground
    for corner, level in (([20, 20], 103.0), ([150, 30], 98.5)):
        ring = np.add(SQUARE - 25.0 + corner, UTM)
        fixed = ts.grade(fixed, ring, level, **ratios)
    moved = ts.volume(ground, fixed)
    surplus = shrink * one(moved, "cut") - one(moved, "fill")
    assert abs(surplus) > 1.0
    pad = np.add((SQUARE - 25.0) * 4.0 + [80, 110], UTM)
    found = ts.balance(fixed, pad, shrink_factor=shrink, surplus=surplus, **ratios)
    whole = ts.volume(ground, found.tin)
    rest = shrink * one(whole, "cut") - one(whole, "fill")
    assert abs(rest) < 1e-6 * (one(whole, "cut") + one(whole, "fill"))


def test_an_inclined_pad_of_the_gradient_of_the_ground_changes_nothing():
    ground = plane(0.05, 0.02)
    found = ts.balance(ground, SQUARE, cut_slope=2, fill_slope=2, gradient=(0.05, 0.02))
    assert found.elevation == pytest.approx(30 * 0.07, abs=1e-6)
    assert one(found.table, "cut") + one(found.table, "fill") < 1e-4
    assert one(found.table, "sensitivity") >= 99.0  # any rise fills the pad


def test_elevations_in_feet():
    """A third of a metre of elevation is about a foot: the same pad, volumes in metres cubed."""
    metres = plane(0.1, crs="EPSG:32616", elevation_unit="m")
    points = metres.points * (1, 1, 1 / 0.3048)
    feet = ts.triangulate(points, crs="EPSG:32616", elevation_unit="ft")
    how = {"cut_slope": 2, "fill_slope": 3, "shrink_factor": 0.9, "gradient": (0.01, 0.02)}
    one_way, other = (ts.balance(tin, SQUARE, **how) for tin in (metres, feet))
    assert other.elevation * 0.3048 == pytest.approx(one_way.elevation, abs=1e-6)
    assert one(other.table, "cut") == pytest.approx(one(one_way.table, "cut"), rel=1e-6)
    sensitivity = one(other.table, "sensitivity") / 0.3048
    assert sensitivity == pytest.approx(one(one_way.table, "sensitivity"), rel=1e-6)
    assert str(other.table.units["sensitivity"]) == "m³/ft"


def test_notes_of_the_ground_are_those_of_table_and_pad():
    found = ts.balance(plane(0.1, crs="EPSG:32616"), SQUARE, cut_slope=2, fill_slope=2)
    assert any("not known" in note for note in found.table.notes)
    assert list(found.notes) == list(found.table.notes)


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("options", "kind", "text"),
    [
        ({"shrink_factor": 0.0}, ts.OptionError, "a factor > 0"),
        ({"swell_factor": -1.0}, ts.OptionError, "a factor > 0"),
        ({"surplus": np.nan}, ts.OptionError, "finite"),
        ({"cut_slope": 0}, ts.OptionError, "2 is 2:1"),
        ({"gradient": (0.1,)}, ts.OptionError, "two numbers"),
        ({"gradient": (0.6, 0.0)}, ts.OptionError, "below that of the side slopes, 0.5"),
        ({"surplus": 1e6}, ts.PointsError, "No elevation that the ground allows is in balance"),
        ({"surplus": -1e6}, ts.PointsError, "No elevation that the ground allows is in balance"),
    ],
)
def test_refusals(options, kind, text):
    with pytest.raises(kind, match=text):
        ts.balance(plane(0.05), SQUARE, **({"cut_slope": 2, "fill_slope": 2} | options))


def test_an_inclined_pad_with_a_notch_is_refused():
    pad = [[20, 20], [40, 20], [40, 40], [30, 25], [20, 40]]
    with pytest.raises(ts.LinesError, match="an inclined pad must be convex"):
        ts.grade(plane(0.0), pad, 1.0, cut_slope=2, fill_slope=2, gradient=(0.1, 0.0))
