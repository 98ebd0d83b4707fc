"""Clipped surfaces: the same surface inside polygons and outside, exact areas, kept rows."""

import pickle
from fractions import Fraction

import numpy as np
import pytest

import tinsmith as ts

UTM = np.array([500_000.0, 4_000_000.0])
PARCEL = np.array([[40.3, 30.1], [150.7, 45.2], [170.1, 160.4], [90.9, 120.6], [35.2, 150.8]])
COURT = np.array([[80.0, 70.0], [110.0, 72.0], [100.0, 95.0]])


def heights(xy):
    return 100 + 5 * np.sin(xy[:, 0] / 25) + 4 * np.cos(xy[:, 1] / 30)


def make_tin(n=800, seed=0, **options):
    xy = np.random.default_rng(seed).random((n, 2)) * 200
    xy = np.vstack([xy, [[0, 0], [200, 0], [200, 200], [0, 200]]])
    survey = ts.Survey(
        points=np.column_stack([xy + UTM, heights(xy)]),
        attributes={"number": np.arange(len(xy)) + 1000},
        crs="EPSG:32616",
        elevation_unit="m",
    )
    return ts.triangulate(survey, **options)


def measure(tin):
    """Return the area exactly."""
    total = Fraction(0)
    for corners in tin.points[tin.triangles][:, :, :2].tolist():
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, corner) for corner in corners)
        total += (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    return total / 2


def list_triangles(tin):
    """Return the triangles as sets of places with elevations."""
    return {tuple(sorted(map(tuple, corners))) for corners in tin.points[tin.triangles].tolist()}


def clip_both(tin, polygons):
    return [ts.clip(tin, polygons, keep=keep) for keep in ("inside", "outside")]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("polygon", [[PARCEL + UTM], [PARCEL + UTM, COURT + UTM]])
def test_both_parts_together_are_the_surface_exactly(seed, polygon):
    shapely = pytest.importorskip("shapely")
    tin = make_tin(seed=seed)
    inside, outside = clip_both(tin, [polygon])
    assert ts.check(inside).ok
    assert ts.check(outside).ok
    assert measure(inside) + measure(outside) == measure(tin)
    area = shapely.Polygon(polygon[0], polygon[1:])
    assert inside.area == pytest.approx(area.area, rel=1e-12)
    held = shapely.contains_properly(area, shapely.polygons(tin.points[tin.triangles, :2]))
    whole = {
        tuple(sorted(map(tuple, corners))) for corners in tin.points[tin.triangles[held]].tolist()
    }
    assert len(whole) > 50
    assert whole <= list_triangles(inside)
    assert len(list_triangles(tin) & list_triangles(outside)) > 300


def test_elevations_are_those_of_the_surface_to_a_rounding():
    tin = make_tin()
    places = np.random.default_rng(1).random((20_000, 2)) * 200 + UTM
    old = tin.interpolate(places)
    found = np.array([part.interpolate(places) for part in clip_both(tin, [PARCEL + UTM])])
    assert (np.isfinite(found).sum(axis=0) == 1).all()
    assert np.abs(np.nanmax(found, axis=0) - old).max() < 1e-8  # a rounding of eastings is 1e-10


def test_volumes_are_those_in_the_region():
    tin = make_tin()
    inside, outside = clip_both(tin, [PARCEL + UTM])
    wanted = ts.volume(tin, base=101.0, regions=[PARCEL + UTM])
    whole = ts.volume(tin, base=101.0)
    for name in ("cut", "fill", "area"):
        assert ts.volume(inside, base=101.0)[name][0] == pytest.approx(wanted[name][0], rel=1e-9)
        rest = whole[name][0] - wanted[name][0]
        assert ts.volume(outside, base=101.0)[name][0] == pytest.approx(rest, rel=1e-9)


def test_vertices_keep_rows_and_attributes_and_new_ones_have_none():
    tin = make_tin()
    inside, outside = clip_both(tin, [PARCEL + UTM])
    for part in (inside, outside):
        assert len(part.vertex_of) == len(tin.vertex_of)
        rows = np.flatnonzero(part.vertex_of >= 0)
        np.testing.assert_array_equal(part.points[part.vertex_of[rows]], tin.points[rows])
        numbers = part.attributes["number"]
        np.testing.assert_array_equal(numbers[part.vertex_of[rows]], rows + 1000)
        assert np.isnan(numbers).sum() == len(part.points) - len(rows) > 0
        assert part.crs == tin.crs
        assert part.elevation_unit == tin.elevation_unit
        assert pickle.loads(pickle.dumps(part)) == part
    assert set(inside.report.to_dict()["left_out"]) == {"outside the boundary"}
    assert set(outside.report.to_dict()["left_out"]) == {"in a hole"}
    assert ((inside.vertex_of >= 0) != (outside.vertex_of >= 0)).all()


def test_lines_end_at_the_polygon():
    kerb = np.array([[10, 60, 104.0], [120, 80, 103.0], [190, 60, 102.0]])
    kerb[:, :2] += UTM
    tin = make_tin(breaklines=[ts.Breakline(kerb, name="kerb")])
    inside, outside = clip_both(tin, [PARCEL + UTM])
    lengths = []
    for part, count in ((inside, 1), (outside, 2)):
        kerbs = [
            part.points[chain]
            for chain, name in zip(part.lines.chains(), part.lines.names, strict=True)
            if name == "kerb"
        ]
        assert len(kerbs) == count
        lengths += [np.hypot(*np.diff(path[:, :2], axis=0).T).sum() for path in kerbs]
    assert sum(lengths) == pytest.approx(np.hypot(*np.diff(kerb[:, :2], axis=0).T).sum())
    assert inside.lines.kinds.count("boundary") == 1
    assert outside.lines.kinds.count("hole") == 1


def test_a_clipped_surface_is_edited_and_taken_back():
    part = ts.clip(make_tin(), [PARCEL + UTM])
    before = part.snapshot()
    part.insert([[*np.add(UTM, [100.0, 60.0]), 120.0]])
    assert ts.check(part).ok
    assert len(part.points) == len(before.points) + 1
    part.undo()
    assert part == before


def test_triangles_that_are_not_delaunay_stay():
    tin = make_tin()
    flat = ts.TIN.from_triangles(tin.points * [1.0, 0.25, 1.0], tin.triangles)
    scaled = (PARCEL + UTM) * [1.0, 0.25]
    inside, outside = clip_both(flat, [scaled])
    assert ts.check(inside).ok
    assert ts.check(outside).ok
    assert measure(inside) + measure(outside) == measure(flat)
    kept = list_triangles(flat) & list_triangles(inside)
    assert len(kept) > 100
    assert "joint" in inside.lines.names
    assert "named 'joint'" in inside.report.notes[-1]


def lattice(size=4):
    x, y = np.meshgrid(np.arange(size + 1.0), np.arange(size + 1.0))
    return ts.triangulate(np.column_stack([x.ravel(), y.ravel(), (x + 2 * y).ravel()]))


ON_EDGES = {
    "on vertices": ([[1, 1], [3, 1], [3, 3], [1, 3]], 0),
    "through vertices": ([[1, 1], [3, 2], [2, 3]], None),
    "a corner on an edge": ([[1.5, 1], [3, 1], [3, 3]], None),
    "a corner in a triangle": ([[1.25, 1.5], [3, 1], [3, 3]], None),
    "the hull": ([[0, 0], [4, 0], [4, 4], [0, 4]], 0),
    "beyond the hull": ([[-1, -1], [2, -1], [2, 2], [-1, 2]], 0),
    "a strip as thin as a rounding": ([[1, 1], [3, 1], [3, 1 + 4e-16], [1, 1 + 4e-16]], None),
}


@pytest.mark.parametrize("name", ON_EDGES)
def test_polygons_on_vertices_and_edges(name):
    ring, made = ON_EDGES[name]
    tin = lattice()
    part = ts.clip(tin, [ring])
    assert ts.check(part).ok
    np.testing.assert_allclose(part.points[:, 2], part.points[:, :2] @ [1, 2], atol=1e-14)
    if made is not None:
        assert len(part.points) == int((part.vertex_of >= 0).sum()) + made
    if name != "the hull":
        rest = ts.clip(tin, [ring], keep="outside")
        assert ts.check(rest).ok
        assert measure(part) + measure(rest) == 16


def test_the_whole_stays_as_it_is():
    tin = make_tin()
    part = ts.clip(tin, [np.array([[-9, -9], [209, -9], [209, 209], [-9, 209]]) + UTM])
    np.testing.assert_array_equal(part.points, tin.points)
    assert list_triangles(part) == list_triangles(tin)
    assert "reach beyond the surface by 7524 m²" in part.report.notes[-1]


def test_what_several_polygons_hold_counts_once():
    shapely = pytest.importorskip("shapely")
    tin = make_tin()
    one = shapely.box(20, 20, 90, 90)
    others = [
        shapely.box(60, 50, 140, 120),
        shapely.box(90, 20, 120, 50),
        shapely.box(150, 150, 180, 190),
    ]
    moved = [shapely.transform(shape, lambda xy: xy + UTM) for shape in (one, *others)]
    wanted = shapely.union_all(moved).area
    for given in (moved, shapely.MultiPolygon(moved[:1] + moved[3:]), {"a": moved[0]}):
        shapes = given if isinstance(given, list) else getattr(given, "geoms", None) or moved[:1]
        part = ts.clip(tin, given)
        assert part.area == pytest.approx(shapely.union_all(list(shapes)).area, rel=1e-12)
        assert ts.check(part).ok
    assert ts.clip(tin, moved).area == pytest.approx(wanted, rel=1e-12)
    assert ts.clip(tin, moved, keep="outside").area == pytest.approx(40_000 - wanted, rel=1e-12)


def test_degrees_are_clipped_as_they_are():
    x, y = np.meshgrid(np.arange(5) * 0.01 + 7, np.arange(5) * 0.01 + 50)
    tin = ts.triangulate(np.column_stack([x.ravel(), y.ravel(), x.ravel()]), crs="EPSG:4326")
    part = ts.clip(tin, [[[7.005, 50.005], [7.025, 50.005], [7.015, 50.03]]])
    assert ts.check(part).ok
    assert "triangles are left" in part.report.notes[0]


REFUSED = {
    "beside": ([[300, 300], [400, 300], [400, 400]], "inside", "nothing of it is inside them"),
    "beside, outside": ([[300, 300], [400, 300], [400, 400]], "outside", "cut nothing off it"),
    "all": ([[-1, -1], [201, -1], [201, 201], [-1, 201]], "outside", "cover the whole surface"),
    "bow tie": ([[0, 0], [9, 9], [9, 0], [0, 9]], "inside", "crosses itself at 1 place"),
    "no area": ([[0, 0], [9, 9], [18, 18]], "inside", "polygon '1'"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_polygons_that_cannot_clip_are_refused(name):
    ring, keep, sentence = REFUSED[name]
    with pytest.raises(ts.LinesError, match=sentence):
        ts.clip(make_tin(50), [np.array(ring) + UTM], keep=keep)


def test_other_arguments_are_refused():
    tin = make_tin(50)
    ring = np.concatenate([PARCEL, PARCEL[:1]]) + UTM
    elsewhere = ts.Features.of_polygons(ring, [0, 6], [0, 1], crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="CRS of the polygons is EPSG:32617"):
        ts.clip(tin, elsewhere)
    with pytest.raises(ts.OptionError, match="keep"):
        ts.clip(tin, [PARCEL + UTM], keep="both")
    with pytest.raises(ts.OptionError, match="number of polygons"):
        ts.clip(tin, [])
    doubled = ts.TIN.from_triangles(
        [[0, 0, 1], [4, 0, 1], [0, 4, 1], [0, 0, 2], [4, 0, 2], [0, 4, 2]], [[0, 1, 2], [3, 4, 5]]
    )
    with pytest.raises(ts.PointsError, match="two of its vertices are at one place"):
        ts.clip(doubled, [[1, 1], [2, 1], [1, 2]])


@pytest.mark.parametrize("n", [3_000])
def test_near_edges_are_found_by_any_length_of_ring(n):
    tin = make_tin(n)
    angles = np.linspace(0, 2 * np.pi, 400)[:-1]
    star = (60 + 30 * np.sin(7 * angles))[:, None] * np.column_stack(
        [np.cos(angles), np.sin(angles)]
    )
    inside, outside = clip_both(tin, [star + 100 + UTM])
    assert measure(inside) + measure(outside) == measure(tin)
