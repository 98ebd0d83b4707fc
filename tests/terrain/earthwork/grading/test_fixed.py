"""Regions held fixed: brute force on a grid, exact ground within them, refusals."""

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.earthwork.grading import balances

shapely = pytest.importorskip("shapely")
CORNERS = np.array([[0.0, 0], [120, 0], [120, 120], [0, 120]])
RISE = np.array([0.05, 0.02])
PAD = [[40.0, 40], [80, 40], [80, 80], [40, 80]]
TREE = np.array([[55.0, 55], [62, 55], [62, 63], [55, 63]])
HOUSE = np.array([[66.0, 60], [74, 60], [74, 70], [66, 70]])
BESIDE = np.array([[75.0, 75], [90, 75], [95, 90], [75, 90]])
HOW = {"cut_slope": 2.0, "fill_slope": 3.0}


def at(ring, level):
    return np.column_stack([ring, np.full(len(ring), level)])


def plane(**more):
    return ts.triangulate(np.column_stack([CORNERS, CORNERS @ RISE]), **more)


def hills(seed, origin=(0.0, 0.0)):
    rng = np.random.default_rng(seed)
    xy = np.vstack([rng.random((300, 2)) * 120, CORNERS])
    z = xy @ RISE + np.sin(xy[:, 0] / 15) * 0.6
    return ts.triangulate(np.column_stack([xy + origin, z]))


def limit(base, xy, ring, measure):
    """Clip elevations to the slopes about a ring whose edge has elevations."""
    shape, places = shapely.Polygon(ring[:, :2]), shapely.points(xy)
    line = shapely.shortest_line(places, shape)
    feet = shapely.get_coordinates(line).reshape(-1, 2, 2)[:, 1]
    away = shapely.distance(shape, places)
    level = measure(feet)
    low, high = level - away / HOW["fill_slope"], level + away / HOW["cut_slope"]
    return np.clip(base, low, high), away == 0.0


def expect(ground, level, regions, n=300):
    q = (np.arange(n) + 0.5) * 120 / n
    xy = np.column_stack([one.ravel() for one in np.meshgrid(q, q)])
    own = ground.interpolate(xy)
    found, _ = limit(own, xy, np.array(PAD), lambda feet: np.full(len(feet), level))
    for ring in regions:
        if ring.shape[1] == 3:
            found, _ = limit(found, xy, ring, lambda feet, z=ring[0, 2]: np.full(len(feet), z))
        else:
            found, is_inside = limit(found, xy, ring, ground.interpolate)
            found = np.where(is_inside, own, found)
    return xy, own, found


CASES = {
    "the ground": [TREE],
    "a level": [at(HOUSE, 5.0)],
    "both": [TREE, at(HOUSE, 4.5)],
    "beyond the edge": [BESIDE],
    "a low level outside": [at(BESIDE + 10, 4.0), TREE],
    "notches at a level": [at(np.array([[75.0, 75], [90, 75], [90, 80], [80, 80], [80, 90]]), 6)],
    "two convex parts": [TREE, np.array([[62.0, 55], [70, 55], [70, 58], [62, 63]])],
}


@pytest.mark.parametrize("name", CASES)
def test_regions_on_a_plane_agree_with_a_grid_and_are_in_balance(name):
    ground, regions = plane(), CASES[name]
    found = ts.balance(ground, PAD, fixed=regions, shrink_factor=0.9, **HOW)
    assert ts.check(found.tin).ok
    xy, own, wanted = expect(ground, found.elevation, regions)
    # Cones have facets of two degrees.
    assert np.abs(found.tin.interpolate(xy) - wanted).max() < 2e-3
    again = ts.volume(ground, found.tin)
    cut, fill = float(again["cut"][0]), float(again["fill"][0])
    assert abs(0.9 * cut - fill) < 1e-6 * (cut + fill)
    assert cut == pytest.approx(float(found.table["cut"][0]), rel=1e-7)
    assert fill == pytest.approx(float(found.table["fill"][0]), rel=1e-7)
    cell = (120 / 300) ** 2
    assert cut == pytest.approx(np.clip(own - wanted, 0, None).sum() * cell, rel=2e-3)
    assert fill == pytest.approx(np.clip(wanted - own, 0, None).sum() * cell, rel=2e-3)


def test_sensitivity_is_that_of_what_moves():
    ground, regions = plane(), [TREE, at(HOUSE, 4.5)]
    found = ts.balance(ground, PAD, fixed=regions, shrink_factor=0.9, **HOW)
    rest = []
    for step in (-0.01, 0.01):
        graded = ts.grade(ground, PAD, found.elevation + step, fixed=regions, **HOW)
        table = ts.volume(ground, graded)
        rest.append(0.9 * float(table["cut"][0]) - float(table["fill"][0]))
    slope = (rest[0] - rest[1]) / 0.02
    assert float(found.table["sensitivity"][0]) == pytest.approx(slope, rel=1e-3)


@pytest.mark.parametrize("seed", [0, 1])
def test_kept_ground_does_not_change(seed):
    origin = np.array([500_000.0, 4_000_000.0])
    ground = hills(seed, origin)
    ring = TREE + origin
    found = ts.balance(ground, np.add(PAD, origin), fixed=[ring], **HOW)
    assert ts.check(found.tin).ok
    rng = np.random.default_rng(seed)
    xy = ring.min(axis=0) + rng.random((400, 2)) * np.ptp(ring, axis=0)
    assert np.abs(found.tin.interpolate(xy) - ground.interpolate(xy)).max() < 1e-7
    inside = shapely.contains_xy(shapely.Polygon(ring).buffer(-0.01), *ground.points[:, :2].T)
    assert inside.any()
    kept = set(map(tuple, found.tin.points.tolist()))
    assert set(map(tuple, ground.points[inside].tolist())) <= kept
    assert "fixed" in found.tin.lines.names


def test_a_frustum_around_a_low_level():
    """A pit about a slab that lies 1 below a pad on level ground, with a cone at each corner."""
    flat = ts.triangulate(np.column_stack([CORNERS, np.full(4, 10.0)]))
    graded = ts.grade(flat, PAD, 10.0, fixed=[at(TREE, 9.0)], **HOW)
    exact = 7 * 8 * 1 + 30 * 2 * 1 / 2 + np.pi * 4 / 3
    assert float(ts.volume(flat, graded)["cut"][0]) == pytest.approx(exact, rel=1e-3)
    assert any("Fixed region 1 is held at 9" in note for note in graded.report.notes)


def test_a_region_that_is_not_reached_changes_nothing():
    ground = plane()
    far = np.add(TREE, [-50.0, -50])
    one, other = (ts.grade(ground, PAD, 4.0, fixed=f, **HOW) for f in (None, [far]))
    assert (one.points == other.points).all()
    assert "Fixed region 1 is not reached." in other.report.notes


def test_forms_of_regions():
    ground = plane(crs="EPSG:32616", elevation_unit="m")
    rings = [TREE, at(HOUSE, 4.5)]
    closed = [np.vstack([one[:, :2], one[:1, :2]]) for one in rings]
    features = ts.Features.of_polygons(
        np.concatenate(closed),
        [0, 5, 10],
        [0, 1, 2],
        columns={"name": ["oak", "house"], "elevation": [np.nan, 4.5 / 0.3048]},
        units={"elevation": "ft"},
        crs="EPSG:32616",
    )
    forms = [
        rings,
        {"oak": TREE, "house": rings[1]},
        [shapely.Polygon(TREE), shapely.Polygon(rings[1])],
        features,
    ]
    found = [ts.balance(ground, PAD, fixed=one, **HOW) for one in forms]
    for one in found:
        assert one.elevation == pytest.approx(found[0].elevation, abs=1e-6)
    assert any("converted from" in note for note in found[-1].notes)
    assert "Fixed region house is held at 4.5." in found[1].notes
    alone = ts.grade(ground, PAD, 4.0, fixed=TREE, **HOW)
    assert alone.points == pytest.approx(ts.grade(ground, PAD, 4.0, fixed=[TREE], **HOW).points)


def test_elevations_in_feet():
    metres = plane(crs="EPSG:32616", elevation_unit="m")
    feet = ts.triangulate(metres.points * (1, 1, 1 / 0.3048), crs="EPSG:32616", elevation_unit="ft")
    one = ts.balance(metres, PAD, fixed=[TREE, at(HOUSE, 4.5)], **HOW)
    other = ts.balance(feet, PAD, fixed=[TREE, at(HOUSE, 4.5 / 0.3048)], **HOW)
    assert other.elevation * 0.3048 == pytest.approx(one.elevation, abs=1e-6)
    assert float(other.table["fill"][0]) == pytest.approx(float(one.table["fill"][0]), rel=1e-6)


NOTCHED = np.array([[75.0, 75], [90, 75], [90, 80], [80, 80], [80, 90], [75, 90]])


@pytest.mark.parametrize(
    ("fixed", "kind", "text"),
    [
        ([], ts.OptionError, "number of fixed regions"),
        (3.0, ts.OptionError, "polygons"),
        ("tree.shp", ts.OptionError, "polygons"),
        ([[[0, 0], [1, 1]]], ts.LinesError, "fixed region 1"),
        ([[[50, 50], [60, 60], [60, 50], [50, 60]]], ts.LinesError, "Self-intersection"),
        ([[[50, 50], [60, 50], [55, 50]]], ts.LinesError, "fixed region 1"),
        ([TREE * np.nan], ts.LinesError, "finite"),
        ([TREE, TREE + 3], ts.LinesError, "lie over each other"),
        ([TREE + 60], ts.PointsError, "lies off the ground"),
        ([CORNERS * 0.9 + 3], ts.PointsError, "leave nothing of the pad"),
        ([np.column_stack([TREE, [1.0, 2, 3, 4]])], ts.LinesError, "elevations are 1 to 4"),
        ([NOTCHED], ts.LinesError, "notches"),
        ([at(TREE, 4.0), at(HOUSE, 9.0)], ts.PointsError, "meet"),
        ([at(TREE, 4.0), at(HOUSE - np.array([4.0, 0]), 7.0)], ts.PointsError, "meet"),
        ([at(TREE, 900.0)], ts.PointsError, "does not meet the ground"),
        ([shapely.Polygon(BESIDE, [BESIDE * 0.1 + 75])], ts.LinesError, "2 rings"),
    ],
)
def test_refusals(fixed, kind, text):
    with pytest.raises(kind, match=f"(?i){text}"):
        ts.balance(plane(), PAD, fixed=fixed, **HOW)


def test_regions_in_another_crs_and_of_columns_that_differ_are_refused():
    ring = np.vstack([TREE, TREE[:1]])

    def features(**columns):
        return ts.Features.of_polygons(ring, [0, 5], [0, 1], columns=columns, crs="EPSG:32617")

    with pytest.raises(ts.CrsError, match="fixed regions"):
        ts.grade(plane(crs="EPSG:32616"), PAD, 4.0, fixed=features(), **HOW)
    ground = plane(crs="EPSG:32617", elevation_unit="m")
    with pytest.raises(ts.OptionError, match="one level"):
        ts.grade(ground, PAD, 4.0, fixed=features(elevation=[4.0], z=[5.0]), **HOW)
    with pytest.raises(ts.OptionError, match="a level, or none"):
        ts.grade(ground, PAD, 4.0, fixed=features(elevation=["high"]), **HOW)


@pytest.mark.parametrize("level", [None, 4.9])
@pytest.mark.parametrize("origin", [(0.0, 0.0), (500_000.0, 4_000_000.0)])
@pytest.mark.parametrize(
    "ring",
    [
        [[80, 50], [95, 50], [95, 60], [80, 60]],  # shares an edge with the pad
        [[80, 80], [90, 80], [90, 90], [80, 90]],  # a corner
        [[30, 58], [90, 58], [90, 62], [30, 62]],  # across it
        [[50, 50], [60, 50.001], [70, 50]],
        [[50, 50], [50.001, 50], [50, 50.001]],
        [[50, 60], [50, 60], [60, 60], [60, 50], [55, 50], [50, 50], [50, 60]],
    ],
)
def test_odd_regions_are_held_too(ring, origin, level):
    ground, ring = hills(3, origin), np.add(ring, origin)
    given = ring if level is None else at(ring, level)
    found = ts.balance(ground, np.add(PAD, origin), fixed=[given], **HOW)
    assert ts.check(found.tin).ok
    table = ts.volume(ground, found.tin)
    assert abs(float(table["cut"][0] - table["fill"][0])) < 1e-3
    middle = ring[:-1].mean(axis=0)[None] if len(ring) > 4 else ring.mean(axis=0)[None]
    kept = float(ground.interpolate(middle)[0]) if level is None else level
    assert float(found.tin.interpolate(middle)[0]) == pytest.approx(kept, abs=1e-5)


def test_a_pad_with_a_corner_twice():
    once = ts.grade(plane(), PAD, 4.0, **HOW)
    twice = ts.grade(plane(), [PAD[0], *PAD, PAD[0]], 4.0, **HOW)
    assert (once.points == twice.points).all()


def large_hills(seed, origin):
    """Hills that reach far beyond the pad, so that trials take a part of them."""
    rng = np.random.default_rng(seed)
    xy = np.vstack([rng.uniform(-400, 600, (600, 2)), [[-500, -500], [700, -500], [700, 700]]])
    z = xy @ RISE + np.sin(xy[:, 0] / 15) * 0.6
    return ts.triangulate(np.column_stack([xy + origin, z]))


def test_trials_on_the_ground_nearby_find_what_those_on_all_of_it_find(monkeypatch):
    origin = 500_000.0, 4_000_000.0
    ground = large_hills(5, origin)
    moved = np.array(TREE) + origin, at(np.array(HOUSE) + origin, 5.0)
    taken = []
    take = balances.take_near
    monkeypatch.setattr(balances, "take_near", lambda *how: taken.append(take(*how)) or taken[-1])
    made = ts.balance(ground, np.add(PAD, origin), fixed=moved, **HOW)
    assert taken
    assert all(len(one.triangles) < 0.2 * len(ground.triangles) for one in taken)
    monkeypatch.setattr(balances, "_MARGIN", 1e3)
    whole = ts.balance(ground, np.add(PAD, origin), fixed=moved, **HOW)
    for name, column in whole.table.columns.items():
        most = 1e-6 if name == "balance" else 0.0
        assert made.table[name] == pytest.approx(column, rel=1e-9, abs=most), name
    assert made.tin.points == pytest.approx(whole.tin.points, abs=1e-7)
    assert made.notes == whole.notes


def test_slopes_that_do_not_end_nearby_are_measured_on_all_of_the_ground(monkeypatch):
    """A region far above falling ground: its fill reaches farther than the margin."""
    ground = large_hills(5, (0.0, 0.0))
    monkeypatch.setattr(balances, "_MARGIN", 0.01)
    made = ts.balance(ground, PAD, fixed=[at(HOUSE, 9.0)], **HOW)
    table = ts.volume(ground, made.tin)
    assert float(table["cut"][0]) == pytest.approx(float(table["fill"][0]), rel=1e-6)
    assert ts.check(made.tin).ok
