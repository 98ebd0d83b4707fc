"""Pasted surfaces: the patch within its boundary, the base elsewhere, lines of both."""

import numpy as np
import pytest
from support.surfaces import stretch_triangles

import tinsmith as ts

UTM = np.array([500_000.0, 4_000_000.0])


def heights(xy):
    return 100 + 5 * np.sin(xy[:, 0] / 25) + 4 * np.cos(xy[:, 1] / 30)


def make_base(n=800, seed=0, **options):
    xy = np.random.default_rng(seed).random((n, 2)) * 200
    xy = np.vstack([xy, [[0, 0], [200, 0], [200, 200], [0, 200]]])
    return ts.triangulate(np.column_stack([xy + UTM, heights(xy)]), **options)


def make_star(seed, z):
    rng = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * np.pi, 31)[:-1]
    ring = (
        rng.uniform(20, 60, 30)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]) + 100
    )
    xy = np.vstack([ring, rng.random((30, 2)) * 20 + 90])
    return ts.triangulate(np.column_stack([xy + UTM, z(xy, rng)]), boundary=[ring + UTM])


def places(seed=9, n=20_000):
    return np.random.default_rng(seed).random((n, 2)) * 196 + 2 + UTM


@pytest.mark.parametrize("seed", range(4))
def test_the_patch_is_inside_and_the_base_beyond_the_triangles_at_the_seam(seed):
    base = make_base(seed=seed)
    patch = make_star(seed, lambda xy, rng: 100 + 3 * rng.random(len(xy)))
    pasted = ts.paste(base, patch)
    assert ts.check(pasted).ok
    xy = places(seed)
    new, inner, old = (tin.interpolate(xy) for tin in (pasted, patch, base))
    inside = np.isfinite(inner)
    assert np.abs(new - inner)[inside].max() < 1e-8
    joined = np.isin(base.locate(xy), touched(base, patch))
    assert np.abs(new - old)[~inside & ~joined].max() < 1e-8
    assert pasted.area == pytest.approx(base.area)
    assert "differ from those of the base by up to" in pasted.report.notes[-1]


def touched(base, patch):
    """Triangles of the base that the patch cuts: by many places on its boundary, and inside."""
    shapely = pytest.importorskip("shapely")
    area = shapely.union_all(shapely.polygons(patch.points[patch.triangles, :2]))
    triangles = shapely.polygons(base.points[base.triangles, :2])
    return np.flatnonzero(shapely.intersects(triangles, area))


@pytest.mark.parametrize("seed", range(3))
def test_triangles_that_are_not_delaunay_stay_in_base_and_patch(seed):
    base = stretch_triangles(make_base(seed=seed), (1.0, 8.0))
    patch = make_star(seed, lambda xy, rng: 100 + 3 * rng.random(len(xy)))
    patch = stretch_triangles(patch, (1.0, 8.0))
    pasted = ts.paste(base, patch)
    assert ts.check(pasted).ok
    xy = base.points[base.triangles, :2].mean(axis=1)
    new, inner, old = (tin.interpolate(xy) for tin in (pasted, patch, base))
    is_beyond = np.isnan(inner) & ~np.isin(base.locate(xy), touched(base, patch))
    assert is_beyond.sum() > 1000
    assert np.abs(new - old)[is_beyond].max() < 1e-6
    xy = patch.points[patch.triangles, :2].mean(axis=1)
    assert np.abs(pasted.interpolate(xy) - patch.interpolate(xy)).max() < 1e-6


def with_unused_vertices(tin):
    """Vertices of no triangle, as files have them: far away, and in the middle of a triangle."""
    middle = tin.points[tin.triangles].mean(axis=1)[:3]
    far = np.add(tin.points[:1], [9e3, 9e3, 0])
    points = np.vstack([tin.points, np.add(middle, [0, 0, 50]), far])
    names = np.arange(len(points))
    return ts.TIN.from_triangles(points, tin.triangles, attributes={"number": names})


def test_vertices_of_no_triangle_stay_out_of_the_surface():
    base = make_base(seed=1)
    patch = make_star(1, lambda xy, rng: 100 + 3 * rng.random(len(xy)))
    expected = ts.paste(base, patch)
    pasted = ts.paste(with_unused_vertices(base), with_unused_vertices(patch))
    assert pasted.area == pytest.approx(base.area)
    assert np.array_equal(pasted.points, expected.points)
    assert np.array_equal(pasted.triangles, expected.triangles)
    kept = (base.points[:, None, :] == pasted.points[0]).all(axis=2).argmax()
    assert pasted.attributes["number"][0] == kept


def test_a_patch_that_meets_the_base_changes_nothing_beyond_it():
    base = make_base()
    patch = make_star(5, lambda xy, _: base.interpolate(xy + UTM))
    ring = patch.points[patch.boundary[0]]
    draped = ts.triangulate(base.points, boundary=[ring[:, :2]])
    pasted = ts.paste(base, draped)
    xy = places()
    inner = draped.interpolate(xy)
    expected = np.where(np.isnan(inner), base.interpolate(xy), inner)
    assert np.abs(pasted.interpolate(xy) - expected).max() < 1e-8
    assert not any("seam" in note for note in pasted.report.notes)


def test_base_lines_are_clipped_and_lines_of_the_patch_stay():
    line = ts.Breakline(
        np.column_stack([np.add(UTM, [[10, 100], [100, 101], [190, 100]]), [90, 91, 92]]),
        name="kerb",
    )
    base = make_base(breaklines=[line])
    ring = np.array([[80.0, 80, 95], [120, 80, 95], [120, 120, 95], [80, 120, 95]])
    ring[:, :2] += UTM
    wall = ts.Breakline(ring[[0, 2]] + [[5, 5, 0], [-5, -5, 0]], name="wall")
    pasted = ts.paste(base, ts.triangulate(ring, breaklines=[wall]))
    lengths = dict.fromkeys(pasted.lines.names, 0.0)
    for chain, name in zip(pasted.lines.chains(), pasted.lines.names, strict=True):
        lengths[name] += np.hypot(*np.diff(pasted.points[chain, :2], axis=0).T).sum()
    assert lengths["kerb"] == pytest.approx(140 * np.hypot(1, 1 / 90))
    assert lengths["wall"] == pytest.approx(30 * np.sqrt(2))
    assert lengths["seam"] == pytest.approx(160)


def test_the_base_stays_in_holes_of_the_patch_and_its_own_holes_stay():
    hole = np.array([[20, 20], [40, 20], [40, 40], [20, 40]]) + UTM
    base = make_base(holes=[hole])
    ring = np.array([[80.0, 80], [140, 80], [140, 140], [80, 140]])
    inner = ring[::-1] * 0.5 + 55
    xy = np.vstack([ring, inner])
    patch = ts.triangulate(np.column_stack([xy + UTM, np.full(8, 90.0)]), holes=[inner + UTM])
    pasted = ts.paste(base, patch)
    assert ts.check(pasted).ok
    assert pasted.area == pytest.approx(base.area)
    assert np.isnan(pasted.interpolate(np.add(UTM, [[30, 30]]))).all()
    at = np.add(UTM, [[110, 110], [85, 110]])
    old = base.interpolate(at[:1])[0]
    assert pasted.interpolate(at) == pytest.approx([old, 90.0], abs=1e-6)


def test_elevations_are_converted_to_the_unit_of_the_base():
    base = make_base(crs="EPSG:32616", elevation_unit="m")
    ring = np.column_stack([np.array([[80, 80], [120, 80], [100, 120]]) + UTM, [300.0, 300, 300]])
    pasted = ts.paste(base, ts.triangulate(ring, crs="EPSG:32616", elevation_unit="ft"))
    assert pasted.interpolate(np.add(UTM, [[100, 100]])) == pytest.approx([91.44])
    assert any("converted" in note for note in pasted.report.notes)


def test_refusals():
    base = make_base()
    beyond = ts.triangulate(np.add([*UTM, 5], [[190, 190, 0], [250, 190, 0], [190, 195, 0]]))
    with pytest.raises(ts.CrsError):
        ts.paste(base.replace(crs=ts.CRS("EPSG:32616")), beyond)
    with pytest.raises(ts.PointsError, match="Invalid TIN"):
        ts.paste(base, "patch")


@pytest.mark.parametrize(
    ("first", "last"), [((3, 3), (6, 6)), ((0, 0), (4, 4)), ((0, 0), (10, 10))]
)
def test_a_patch_on_the_vertices_of_the_base_takes_their_place(first, last):
    """Its boundary runs along edges of the base, or along the boundary of that."""
    rows = [[x, y, 1.0] for x in range(11) for y in range(11)]
    base = ts.triangulate(rows)
    inner = [
        [x, y, 5.0] for x in range(first[0], last[0] + 1) for y in range(first[1], last[1] + 1)
    ]
    pasted = ts.paste(base, ts.triangulate(inner))
    assert ts.check(pasted).ok
    assert pasted.area == base.area
    raised = {tuple(row[:2]) for row in inner}
    for x, y, z in pasted.points.tolist():
        assert z == (5.0 if (x, y) in raised else 1.0)


def cover(tin):
    """The area of the triangles themselves."""
    shapely = pytest.importorskip("shapely")
    return shapely.union_all(shapely.polygons(tin.points[tin.triangles, :2]))


def shift_star(seed, way, **options):
    """A star of 60 m across whose middle is moved from that of the base."""
    star = make_star(seed, lambda xy, rng: 100 + 3 * rng.random(len(xy)))
    ring = star.points[star.boundary[0], :2] + way
    return ts.triangulate(np.add(star.points, [*way, 0.0]), boundary=[ring], **options)


@pytest.mark.each_value
@pytest.mark.parametrize("way", [(90, 10), (-100, 95), (0, -85), (300, 0)])
@pytest.mark.parametrize("limit", [None, 12.0])
def test_a_patch_beyond_the_base_makes_it_larger(way, limit):
    """Also across a ragged boundary with gaps, across a corner, and beside it."""
    base, patch = make_base(max_edge=limit), shift_star(3, way)
    pasted = ts.paste(base, patch)
    assert ts.check(pasted).ok
    outline = cover(base).union(cover(patch))
    assert pasted.area == pytest.approx(outline.area)
    assert cover(pasted).difference(outline.buffer(1e-6)).is_empty
    added = f"{cover(patch).difference(cover(base)).area:.6g} square units"
    said = "lies beside the base" if way == (300, 0) else "reaches beyond the base"
    assert any(said in note and added in note for note in pasted.report.notes)
    xy = np.random.default_rng(2).random((20_000, 2)) * 650 - 150 + UTM
    new, inner, old = (tin.interpolate(xy) for tin in (pasted, patch, base))
    inside = np.isfinite(inner)
    assert inside.sum() > 50
    assert np.abs(new - inner)[inside].max() < 1e-8
    joined = np.isin(base.locate(xy), touched(base, patch))
    stays = ~inside & ~joined
    np.testing.assert_allclose(new[stays], old[stays], rtol=0, atol=1e-8)


def test_surfaces_side_by_side_become_one():
    """Both have the vertices of the edge between them, and no other."""
    west = ts.triangulate([[x, y, 1.0] for x in range(5) for y in range(6)])
    east = ts.triangulate([[x, y, 2.0] for x in range(4, 8) for y in range(6)])
    merged = ts.paste(west, east)
    assert ts.check(merged).ok
    assert len(merged.points) == 8 * 6
    assert merged.area == 7 * 5
    assert merged.interpolate([[2.5, 2.5], [4.0, 3.0], [5.5, 2.5]]).tolist() == [1.0, 2.0, 2.0]


def make_square(low, high):
    return np.array([[low, low], [high, low], [high, high], [low, high]], float)


def test_an_island_in_a_hole_of_the_base_stays():
    rings = [make_square(20, 80) + UTM, make_square(40, 60) + UTM]
    base = make_base(holes=[rings])
    pasted = ts.paste(base, ts.triangulate(np.column_stack([make_square(5, 15) + UTM, [9] * 4])))
    assert ts.check(pasted).ok
    assert pasted.area == pytest.approx(base.area) == pytest.approx(200**2 - 60**2 + 20**2)
    assert np.isfinite(pasted.interpolate(UTM + 50))
    assert pasted.lines.kinds.count("hole") == 2


def test_a_boundary_that_touches_itself_stays():
    """Two squares that share a corner: one ring runs twice through that."""
    squares = [make_square(0, 4), make_square(4, 8)]
    rows = np.unique(np.concatenate([*squares, squares[0] / 2, squares[1] / 2 + 4]), axis=0)
    base = ts.triangulate(np.pad(rows, [(0, 0), (0, 1)]), boundary=squares)
    assert base.area == 32
    patch = ts.triangulate(np.column_stack([make_square(1, 3), [5] * 4]))
    pasted = ts.paste(base, patch)
    assert ts.check(pasted).ok
    assert pasted.area == base.area
    assert np.isnan(pasted.interpolate([[6, 2], [2, 6]])).all()


def test_a_patch_beside_a_hole_keeps_its_own_elevations():
    """The ring of the hole has vertices at elevations of the base, on the edge of the patch."""
    base = make_base(holes=[make_square(100, 150) + UTM])
    corners = make_square(100, 150) - [50, 0]
    patch = ts.triangulate(np.column_stack([corners + UTM, [300, 310, 320, 330]]))
    pasted = ts.paste(base, patch)
    xy = np.random.default_rng(1).uniform([50.01, 100.01], [99.99, 149.99], (500, 2)) + UTM
    assert np.abs(pasted.interpolate(xy) - patch.interpolate(xy)).max() < 1e-6
    assert pasted.area == pytest.approx(base.area)


def find_attributes(tin, name):
    """Return the values of a column by place."""
    return dict(zip(map(tuple, tin.points[:, :2].tolist()), tin.attributes[name], strict=True))


def test_vertices_keep_their_attributes_and_new_ones_have_none():
    rng = np.random.default_rng(4)
    base = make_base().points
    inner = np.column_stack([rng.random((30, 2)) * 40 + 80 + UTM, np.full(30, 90.0)])
    codes = np.array([f"P{k}" for k in range(len(inner))])
    columns = {"number": np.arange(len(base)), "flag": base[:, 2] > 99}
    surveys = [
        ts.Survey(points=base, attributes=columns),
        ts.Survey(points=inner, attributes={"number": 5000 + np.arange(30), "code": codes}),
    ]
    given = [ts.triangulate(survey) for survey in surveys]
    pasted = ts.paste(*given)
    wanted = [find_attributes(tin, "number") for tin in given]
    made = 0
    for place, number in find_attributes(pasted, "number").items():
        own = wanted[1].get(place, wanted[0].get(place))
        assert number == own or (own is None and np.isnan(number))
        made += own is None
    assert made > 0
    assert set(wanted[1]) <= set(find_attributes(pasted, "number"))
    of_patch, of_base = find_attributes(pasted, "code"), find_attributes(pasted, "flag")
    assert {code for code in of_patch.values() if code} == set(codes)
    assert all(of_patch[place] == codes[k] for k, place in enumerate(wanted[1]))
    assert all((of_base[place] is None) == (place not in wanted[0]) for place in of_base)
