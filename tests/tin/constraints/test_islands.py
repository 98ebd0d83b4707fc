"""Polygons with islands: what lies on an island stays, however the polygon is given."""

import numpy as np
import pytest
import shapely

import tinsmith as ts
from tinsmith.tin.constraints.polygons import gather_rings_of_regions

SIDE = np.arange(0.0, 11.0)
GRID = np.array([[x, y, x / 10] for x in SIDE for y in SIDE])
OUTER, INNER = [[2, 2], [8, 2], [8, 8], [2, 8]], [[4, 4], [6, 4], [6, 6], [4, 6]]
DONUT = shapely.Polygon(OUTER, [INNER])
NEST = shapely.MultiPolygon([DONUT, shapely.box(4.5, 4.5, 5.5, 5.5)])


class Interface:
    """Something with polygons that is not of shapely."""

    __geo_interface__ = {  # noqa: RUF012 - as libraries have it
        "type": "FeatureCollection",
        "features": [{"type": "Feature", "geometry": shapely.geometry.mapping(DONUT)}],
    }


FORMS = {
    "polygon": DONUT,
    "list of polygons": [DONUT],
    "multipolygon": [shapely.MultiPolygon([DONUT])],
    "collection": [shapely.GeometryCollection([DONUT])],
    "geo interface": Interface(),
    "rings": [[OUTER, INNER]],
    "rings run the same way": [[OUTER[::-1], INNER[::-1]]],
    "closed rings": [[[*OUTER, OUTER[0]], [*INNER, INNER[0]]]],
    "tuples": [(tuple(map(tuple, OUTER)), tuple(map(tuple, INNER)))],
    "arrays": [[np.array(OUTER, float), np.array(INNER, float)]],
    "one array": [np.array([OUTER, INNER], float)],
}


@pytest.mark.parametrize("form", FORMS)
def test_the_island_of_a_hole_stays(form):
    tin = ts.triangulate(GRID, holes=FORMS[form])
    assert tin.area == pytest.approx(100 - 32, rel=1e-12)
    assert np.isfinite(tin.interpolate([[5.0, 5.0]])).all()
    assert np.isnan(tin.interpolate([[3.0, 5.0]])).all()
    assert ts.check(tin).ok
    assert tin.lines.kinds == ("hole", "hole")


@pytest.mark.parametrize("form", FORMS)
def test_the_island_of_an_erased_part_stays(form):
    tin = ts.triangulate(GRID, erase=FORMS[form])
    inside = shapely.contains(DONUT, shapely.points(GRID[:, :2]))
    np.testing.assert_array_equal(tin.vertex_of < 0, inside)
    assert tin.report.to_dict()["left_out"] == {"erased": np.flatnonzero(inside).tolist()}
    assert tin.area == 100


@pytest.mark.parametrize("form", FORMS)
def test_the_island_of_a_boundary_is_cut_out(form):
    assert ts.triangulate(GRID, boundary=FORMS[form]).area == pytest.approx(32, rel=1e-12)


def test_what_follows_a_collection_in_a_collection_is_not_lost():
    nested = shapely.GeometryCollection([shapely.box(0.5, 0.5, 1.5, 1.5)])
    holes = shapely.GeometryCollection([nested, DONUT, shapely.box(0.25, 8.0, 0.75, 9.0)])
    assert ts.triangulate(GRID, holes=holes).area == pytest.approx(100 - 1 - 32 - 0.5, rel=1e-12)


def test_rings_alone_are_regions_of_their_own():
    assert ts.triangulate(GRID, holes=[OUTER, INNER]).area == pytest.approx(100 - 36, rel=1e-12)
    erased = ts.triangulate(GRID, erase=[OUTER, INNER]).vertex_of < 0
    np.testing.assert_array_equal(
        erased, shapely.contains(shapely.Polygon(OUTER), shapely.points(GRID[:, :2]))
    )


def test_a_polygon_on_an_island_is_cut_too():
    assert ts.triangulate(GRID, holes=[NEST]).area == pytest.approx(100 - 32 - 1, rel=1e-12)
    assert ts.triangulate(GRID, boundary=[NEST]).area == pytest.approx(32 + 1, rel=1e-12)
    rings = [OUTER, INNER, [[4.5, 4.5], [5.5, 4.5], [5.5, 5.5], [4.5, 5.5]]]
    assert ts.triangulate(GRID, holes=[rings]).area == pytest.approx(100 - 32 - 1, rel=1e-12)


def test_an_island_may_touch_the_ring_around_it():
    corner = [[2, 2], [5, 4], [4, 5]]
    tin = ts.triangulate(GRID, holes=[[OUTER, corner]])
    assert tin.area == pytest.approx(100 - 36 + shapely.Polygon(corner).area, rel=1e-12)
    side = [[2, 4], [4, 4], [4, 6], [2, 6]]
    tin = ts.triangulate(GRID, holes=[[OUTER, side]])
    assert tin.area == pytest.approx(100 - 36 + 4, rel=1e-12)
    assert ts.check(tin).ok


def test_an_edited_tin_keeps_its_islands():
    tin = ts.triangulate(GRID, holes=[DONUT])
    tin.insert([[5.2, 5.1, 3.0], [3.0, 5.3, 3.0]])
    assert tin.area == pytest.approx(100 - 32, rel=1e-12)
    assert tin.interpolate([[5.2, 5.1]]) == pytest.approx(3.0)


def test_a_survey_carries_polygons():
    survey = ts.Survey(points=GRID, holes=[DONUT], erase=[[OUTER, INNER]])
    tin = ts.triangulate(survey)
    assert tin.area == pytest.approx(100 - 32, rel=1e-12)
    assert ts.check(tin, points=survey).ok


def test_a_hole_that_cuts_nothing_is_named_by_its_number():
    far = shapely.box(20, 20, 30, 30)
    with pytest.raises(ts.LinesError, match="Hole 1 lies outside") as caught:
        ts.triangulate(GRID, holes=[DONUT, far])
    assert caught.value.lines == (1,)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ([shapely.Point(1, 1)], "a Point is no polygon"),
        ([shapely.LineString([[0, 0], [1, 1]])], "a LineString is no polygon"),
        ([[]], "has shape"),
        ([[OUTER, [[1, 1], [2, 2]]]], "hole ring 1 has shape"),
        ([["a", "b"]], "no table of real numbers"),
    ],
)
def test_what_is_no_polygon_is_refused(given, words):
    with pytest.raises(ts.LinesError, match=f"(?i){words}"):
        ts.triangulate(GRID, holes=given)


def plane(xy):
    return np.column_stack([np.asarray(xy, float), np.zeros(len(xy))])


@pytest.mark.parametrize("option", ["holes", "boundary"])
def test_rings_that_leave_the_hull_cut_what_shapely_cuts(option):
    """A place where a ring leaves the hull is rounded, and may come to lie beyond it.

    Then the sliver between it and the next hull edge in line joined the outside with the surface,
    and all beyond the ring was lost without a word.
    """
    rng = np.random.default_rng(3)
    built = 0
    while built < 150:
        points = rng.integers(0, 7, (rng.integers(3, 9), 2))
        ring = shapely.Polygon(rng.integers(-1, 8, (3, 2)))
        hull = shapely.MultiPoint(points).convex_hull
        wanted = hull.difference(ring) if option == "holes" else hull.intersection(ring)
        if 0 in (ring.area, hull.area, wanted.area) or not ring.intersects(hull.buffer(-1e-6)):
            continue
        tin = ts.triangulate(plane(points), **{option: [np.array(ring.exterior.coords)[:-1]]})
        assert tin.area == pytest.approx(wanted.area, rel=1e-12)
        assert ts.check(tin).ok
        built += 1


def test_a_hole_across_collinear_points_of_the_hull():
    points = plane([[4, 2], [6, 4], [2, 0], [0, 0]])
    tin = ts.triangulate(points, holes=[[[1, 1], [4, 0], [0, 3]]])
    assert tin.area == pytest.approx(4 - 0.6886087768440714, rel=1e-12)
    assert tin.report.to_dict()["left_out"] == {}


def test_a_closed_line_of_shapely_is_a_ring_and_an_open_one_is_none():
    square = [[2, 2], [6, 2], [6, 6], [2, 6]]
    whole = ts.triangulate(GRID).area
    for ring in (shapely.LinearRing(square), shapely.LineString([*square, square[0]])):
        assert ts.triangulate(GRID, holes=[ring]).area == whole - 16
    with pytest.raises(ts.LinesError, match="Invalid hole: a LineString is no polygon"):
        ts.triangulate(GRID, holes=[shapely.LineString(square)])
    with pytest.raises(ts.LinesError, match="Invalid hole: a polygon without a ring"):
        ts.triangulate(GRID, holes=[np.empty((0, 3, 2))])


def test_regions_are_numbered_in_the_order_in_which_they_are_given():
    squares = [shapely.box(x, 1, x + 1, 2) for x in (1, 3, 5, 7)]
    mapping = shapely.geometry.mapping
    one, four = ({"type": "Feature", "geometry": mapping(squares[k])} for k in (0, 3))

    class Features:
        __geo_interface__ = {  # noqa: RUF012 - as libraries have it
            "type": "FeatureCollection",
            "features": [
                one,
                {
                    "type": "Feature",
                    "geometry": {
                        "type": "GeometryCollection",
                        "geometries": [mapping(shapely.MultiPolygon(squares[1:3]))],
                    },
                },
                four,
            ],
        }

    for given in (Features(), shapely.GeometryCollection(squares)):
        wests = [ring[0][:, 0].min() for ring in gather_rings_of_regions([given], "hole")]
        assert wests == [1, 3, 5, 7]
    closed = shapely.LinearRing([[0, 0], [1, 0], [0, 1]])
    assert len(gather_rings_of_regions([closed, shapely.LineString(closed.coords)], "hole")) == 2
    for open_line in (shapely.LineString([[0, 0], [1, 0], [0, 1]]), shapely.Point(0, 0)):
        with pytest.raises(ts.LinesError, match=f"Invalid hole: a {open_line.geom_type} is no"):
            gather_rings_of_regions([open_line], "hole")
    with pytest.raises(ts.LinesError, match="Invalid hole: a LineString is no polygon"):
        gather_rings_of_regions([shapely.LineString([[0, 0], [1, 0], [0, 0]])], "hole")
    assert gather_rings_of_regions([shapely.Polygon()], "hole") == []


def test_rings_are_called_by_their_number_over_all_regions():
    bad = [[0, 0], [1, 0], [np.nan, 1]]
    for given, number in (
        ([bad], 0), ([OUTER, bad], 1), ([[OUTER, INNER], bad], 2), ([DONUT, [OUTER, bad]], 3),
    ):  # fmt: skip
        with pytest.raises(ts.LinesError, match=rf"[Hh]ole ring {number}\b"):
            gather_rings_of_regions(given, "hole")
