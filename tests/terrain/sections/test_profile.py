"""Profiles: every break, exactly; several surfaces; gaps; the line in reverse."""

import numpy as np
import pytest
import shapely
from support.section_oracle import exact_rows

import tinsmith as ts

SQUARE = ts.TIN.from_triangles([[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]], [[0, 1, 2], [0, 2, 3]])
"""z = x + y."""


def grid(n, z, *, without=()):
    """Return n x n unit squares, each of two triangles, but for those without; z(x, y)."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0)))
    corner = np.array(
        [i + j * (n + 1) for j in range(n) for i in range(n) if (i, j) not in without]
    )
    east, north = corner + 1, corner + n + 1
    triangles = np.concatenate(
        [np.stack([corner, east, north + 1], 1), np.stack([corner, north + 1, north], 1)]
    )
    return ts.TIN.from_triangles(np.column_stack([x, y, z(x, y)]), triangles)


def rows(table):
    return list(zip(*(table[name].tolist() for name in ("x", "y", "crossed")), strict=True))


def assert_exact(tin, line):
    table = ts.profile(tin, line)
    is_gap = table["crossed"] == "gap"
    expected = []
    for k in range(len(line) - 1):
        found = exact_rows(tin, line[k], line[k + 1])
        expected += found if k == len(line) - 2 else found[:-1]
    x, y, z, grade = (table[name][~is_gap] for name in ("x", "y", "elevation", "grade"))
    assert x.tolist() == [float(row.x) for row in expected]
    assert y.tolist() == [float(row.y) for row in expected]
    assert z.tolist() == pytest.approx(
        [np.nan if row.elevation is None else float(row.elevation) for row in expected],
        rel=1e-15,
        nan_ok=True,
    )
    assert (~np.isnan(grade)).tolist() == [row.goes_on for row in expected]
    return table


def test_every_edge_crossed_is_a_break():
    table = assert_exact(SQUARE, [[1, 2], [5, 2]])
    assert rows(table) == [(1, 2, "line"), (2, 2, "edge"), (4, 2, "boundary"), (5, 2, "line")]
    assert table["station"].tolist() == [0, 1, 3, 4]
    assert table["grade"][:2].tolist() == [1, 1]


def test_a_line_through_vertices_has_each_once():
    table = assert_exact(grid(3, lambda x, y: x * y), [[0, 3], [3, 0]])
    assert [row[2] for row in rows(table)] == ["vertex", "edge"] * 3 + ["vertex"]


def test_a_line_along_edges_breaks_at_their_vertices():
    table = assert_exact(grid(3, lambda x, y: x * y), [[0, 1], [3, 1]])
    assert rows(table) == [(x, 1, "vertex") for x in range(4)]
    assert table["elevation"].tolist() == [0, 1, 2, 3]


def test_a_line_along_the_boundary_and_beyond():
    table = assert_exact(grid(2, lambda x, y: x - y), [[-1, 0], [3, 0]])
    assert [row[2] for row in rows(table)] == ["line", "vertex", "vertex", "vertex", "line"]
    assert np.isnan(table["elevation"][[0, -1]]).all()


def test_a_corner_that_is_touched_is_one_row_between_gaps():
    table = assert_exact(SQUARE, [[-1, 1], [1, -1]])
    assert rows(table) == [(-1, 1, "line"), (0, 0, "vertex"), (1, -1, "line")]
    assert table["elevation"].tolist()[1] == 0
    assert np.isnan(table["grade"]).all()


def test_a_line_that_starts_and_ends_on_edges():
    table = assert_exact(SQUARE, [[1, 0], [0, 3]])
    assert rows(table)[0] == (1, 0, "boundary")
    assert rows(table)[-1] == (0, 3, "boundary")


def test_within_one_edge():
    table = assert_exact(SQUARE, [[1, 1], [3, 3]])
    assert rows(table) == [(1, 1, "edge"), (3, 3, "edge")]


def test_within_one_triangle():
    assert rows(assert_exact(SQUARE, [[2, 1], [3, 1]])) == [(2, 1, "line"), (3, 1, "line")]


def test_holes_and_parts_leave_gaps_with_a_row_in_them():
    tin = grid(5, lambda x, y: x + 2 * y, without={(1, 2), (3, 0), (3, 1), (3, 2), (3, 3), (3, 4)})
    table = assert_exact(tin, [[-1, 2.5], [6, 2.5]])
    gaps = table["crossed"] == "gap"
    assert table["x"][gaps].tolist() == [1.5, 3.5]
    assert np.isnan(table["elevation"][gaps]).all()
    assert table.notes[1:] == ("There is no surface along 4 of 7.",)


def test_corners_that_meet_in_a_vertex_are_passed_without_a_gap():
    tin = grid(2, lambda x, y: x, without={(0, 1), (1, 0)})
    table = assert_exact(tin, [[0, 0], [2, 2]])
    assert rows(table) == [(0, 0, "vertex"), (1, 1, "vertex"), (2, 2, "vertex")]
    assert_exact(tin, [[0, 2], [2, 0]])


def test_two_successive_rows_with_elevations_are_joined_by_the_surface():
    tin = grid(6, lambda x, y: np.sin(x) + y * y, without={(1, 1), (4, 4), (2, 4)})
    rng = np.random.default_rng(1)
    line = rng.random((12, 2)) * 8 - 1
    table = ts.profile(tin, line)
    xy = np.column_stack([table["x"], table["y"]])
    z = table["elevation"]
    both = ~np.isnan(z[:-1] + z[1:])
    between = (z[:-1] + z[1:])[both] / 2
    assert tin.interpolate(((xy[:-1] + xy[1:]) / 2)[both]) == pytest.approx(between, abs=1e-12)
    assert both.sum() > 20


def test_elevations_are_those_of_interpolate():
    rng = np.random.default_rng(2)
    xyz = np.column_stack([rng.random((2000, 2)) * 100 + [500000, 4e6], rng.random(2000)])
    tin = ts.triangulate(xyz)
    table = ts.profile(tin, [[500010, 4e6 + 20], [500090, 4e6 + 70], [500050, 4e6 + 90]])
    places = np.column_stack([table["x"], table["y"]])
    steep = np.tan(np.radians(ts.slope(tin).max()))
    rounding = 2 * np.spacing(4e6) * steep
    assert np.abs(tin.interpolate(places) - table["elevation"]).max() < rounding
    own = np.flatnonzero(table["crossed"] == "line")
    assert len(own) == 3
    assert (tin.interpolate(places[own]) == table["elevation"][own]).all()


def test_the_reversed_line_has_the_mirror_image_bit_for_bit():
    rng = np.random.default_rng(3)
    tins = [ts.triangulate(rng.random((300, 3)) * [90, 70, 5] + [7e5, 4e6, 0]) for _ in range(2)]
    line = rng.random((5, 2)) * [110, 90] + [7e5 - 10, 4e6 - 10]
    table, mirror = ts.profile(tins, line), ts.profile(tins, line[::-1])
    assert len(table) == len(mirror) > 100
    for name in ("x", "y", "elevation_1", "elevation_2", "difference_2", "crossed_1", "crossed_2"):
        values, other = table[name], mirror[name][::-1]
        np.testing.assert_array_equal(values, other)
    length = table["station"][-1]
    assert mirror["station"][::-1] == pytest.approx(length - table["station"], abs=1e-9)
    for name in ("grade_1", "grade_2"):
        np.testing.assert_array_equal(-table[name][:-1], mirror[name][::-1][1:])


def test_surfaces_share_their_stations():
    other = ts.TIN.from_triangles(
        [[0, 0, 1], [4, 0, 4], [4, 4, 8], [0, 4, 3]], [[0, 1, 3], [1, 2, 3]]
    )
    table = ts.profile({"old": SQUARE, "new": other}, [[1, 2], [5, 2]])
    assert table["station"].tolist() == [0, 1, 3, 4]
    assert table["elevation_old"].tolist()[:3] == [3, 4, 6]
    assert table["elevation_new"].tolist()[:3] == pytest.approx([2.75, 3.5, 6])
    assert table["difference_new"].tolist()[:3] == pytest.approx([-0.25, -0.5, 0])
    assert "difference_old" not in table.columns
    assert table["crossed_new"].tolist() == ["line", "edge", "boundary", "line"]


def test_a_surface_that_is_missing_beside_another_has_no_elevation_there():
    part = ts.TIN.from_triangles([[1, 0, 0], [2, 0, 0], [1, 4, 0]], [[0, 1, 2]])
    table = ts.profile([SQUARE, part], [[0, 1], [4, 1]])
    x, z = table["x"], table["elevation_2"]
    assert (np.isnan(z) == ((x < 1) | (x > 1.75))).all()
    assert not np.isnan(table["elevation_1"]).any()
    assert np.isnan(table["difference_2"]).tolist() == np.isnan(z).tolist()


def test_stations_at_an_interval_are_rows_too():
    table = ts.profile(SQUARE, [[0, 1], [4, 1]], interval=1.5, start=10)
    assert table["station"].tolist() == [10, 10.5, 11, 12, 13.5, 14]
    assert table["crossed"].tolist() == [
        *("boundary", "station", "edge", "station", "station", "boundary")
    ]
    assert table["elevation"].tolist() == pytest.approx([1, 1.5, 2, 3, 4.5, 5])


def test_each_line_has_stations_of_its_own():
    table = ts.profile(SQUARE, [np.array([[1, 0], [1, 4]]), [[0, 2], [1, 2], [1, 1]]])
    assert table["line"].tolist() == [0, 0, 0, 1, 1, 1]
    assert table["station"].tolist() == [0, 1, 4, 0, 1, 2]


def test_a_vertex_given_twice_is_one_row():
    assert len(ts.profile(SQUARE, [[2, 1], [3, 1], [3, 1], [3.5, 1]])) == 3


def test_a_breakline_is_told_from_other_edges():
    points = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 1, 1], [2, 3, 1]]
    tin = ts.triangulate(points, breaklines=[[[2, 1, 1], [2, 3, 1]]])
    table = ts.profile(tin, [[1, 2], [3, 2]])
    assert table["crossed"].tolist().count("breakline") == 1


def test_the_grade_takes_both_units_into_account():
    tin = SQUARE.replace(crs="EPSG:32616", elevation_unit="ft")
    table = ts.profile(tin, [[2, 1], [3, 1]])
    assert table["grade"][0] == pytest.approx(0.3048)
    assert table.units["elevation"].symbol == "ft"
    assert table.units["station"].symbol == "m"
    assert "grade" not in table.units


def test_the_grade_of_a_sliver_is_that_of_its_rows():
    far = 1.8e40
    tin = ts.TIN.from_triangles([[0, 0, 0], [0, -1e-31, 0], [-far, -1e32, 0]], [[0, 1, 2]])
    table = ts.profile(tin, [[0, 0], [0, -1]])
    assert table["grade"].tolist()[0] == 0


def test_water_is_a_level_surface_and_a_hole_is_none():
    rng = np.random.default_rng(4)
    xyz = np.column_stack([rng.random((200, 2)) * 10, rng.random(200)])
    ring = [[3, 3], [7, 3], [7, 7], [3, 7]]
    line = [[1, 5], [9, 5]]
    pond = ts.profile(ts.triangulate(ts.Survey(points=xyz, water=[ts.Water(ring, 5.0)])), line)
    inside = (pond["x"] >= 3) & (pond["x"] <= 7)
    assert set(pond["elevation"][inside].tolist()) == {5.0}
    assert set(pond["grade"][inside][:-1].tolist()) == {0.0}
    hole = ts.profile(ts.triangulate(xyz, holes=[ring]), line)
    inside = (hole["x"] > 3) & (hole["x"] < 7)
    assert hole["crossed"][inside].tolist() == ["gap"]


# ---------------------------------------------------------------- units and CRS


def test_elevations_of_another_unit_are_converted():
    metres = SQUARE.replace(elevation_unit="m")
    feet = SQUARE.replace(elevation_unit="ft")
    table = ts.profile([metres, feet], [[1, 2], [3, 2]])
    assert table["elevation_2"] == pytest.approx(table["elevation_1"] * 0.3048)
    assert "converted from foot to metre" in table.notes[-1]


def test_an_unknown_unit_is_told_or_refused():
    unknown = SQUARE.replace(crs="EPSG:32616")
    metres = SQUARE.replace(crs="EPSG:32616", elevation_unit="m")
    feet = SQUARE.replace(crs="EPSG:32616", elevation_unit="ft")
    assert (
        "not known: taken to be the metre"
        in ts.profile([metres, unknown], [[1, 2], [3, 2]]).notes[0]
    )
    with pytest.raises(ts.CrsError, match="never mixed on a guess"):
        ts.profile([feet, unknown], [[1, 2], [3, 2]])


def test_surfaces_and_lines_of_different_crs_are_refused():
    here, there = SQUARE.replace(crs="EPSG:32616"), SQUARE.replace(crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="EPSG:32616 and the surface '2' in EPSG:32617"):
        ts.profile([here, there], [[1, 2], [3, 2]])
    line = ts.Features.of_lines([[1, 2], [3, 2]], [0, 2], crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="EPSG:32617, that of the surface EPSG:32616"):
        ts.profile(here, line)
    assert len(ts.profile(there, line)) == 3


def test_angles_have_no_stations():
    with pytest.raises(ts.CrsError, match="angles"):
        ts.profile(SQUARE.replace(crs="EPSG:4326"), [[1, 2], [3, 2]])


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ([[0, 0]], "shape"),
        ([[1, 1], [1, 1]], "no length"),
        ([[0, 0], [np.nan, 1]], "not finite"),
        ([[0, 0], [np.inf, 1]], "not finite"),
        ([[50, 50], [60, 60]], "outside the surface"),
        ([[1e300, 0], [0, 0]], "exact range"),
        ([], "no line"),
        ("abc", "Invalid line"),
        (None, "Invalid line"),
        (7, "Invalid line"),
        ([[1, 2], [3]], "no table of real numbers"),
        ({"type": "Point", "coordinates": [1, 1]}, "along lines"),
    ],
)
def test_what_is_no_line_is_refused_in_a_sentence(line, why):
    with pytest.raises(ts.LinesError, match=why) as caught:
        ts.profile(SQUARE, line)
    assert str(caught.value).endswith(".")


@pytest.mark.parametrize("interval", [0, -1, np.nan, np.inf, "1", True, [1]])
def test_an_interval_is_a_number_above_0(interval):
    with pytest.raises(ts.OptionError, match="interval"):
        ts.profile(SQUARE, [[0, 0], [4, 4]], interval=interval)


def test_a_billion_stations_are_refused_at_once():
    with pytest.raises(ts.OptionError, match="at most 1,000,000 stations are made"):
        ts.profile(SQUARE, [[0, 0], [4, 4]], interval=1e-9)
    with pytest.raises(ts.OptionError, match="at most"):
        ts.profile(SQUARE, [[0, 0], [4, 4]], interval=5e-324)


@pytest.mark.parametrize("start", [np.nan, "0", 1e30, -1e30])
def test_a_start_at_which_stations_cannot_be_told_apart(start):
    with pytest.raises(ts.OptionError, match="start"):
        ts.profile(SQUARE, [[0, 0], [4, 4]], start=start)


def test_no_surfaces_and_what_is_none():
    with pytest.raises(ts.OptionError, match="surfaces"):
        ts.profile([], [[0, 0], [4, 4]])
    with pytest.raises(ts.TinsmithError, match="Invalid TIN"):
        ts.profile([1], [[0, 0], [4, 4]])
    with pytest.raises(ts.OptionError, match="name of a surface"):
        ts.profile({"": SQUARE}, [[0, 0], [4, 4]])


def test_triangles_that_lie_over_each_other_are_refused():
    points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 5], [4, 1, 5], [0, 5, 5]]
    folded = ts.TIN.from_triangles(points, [[0, 1, 2], [3, 4, 5]])
    for line in ([[0.5, 0.5], [0.7, 2.0]], [[-1, 1], [5, 1]], [[0, 0], [1, 1]]):
        with pytest.raises(ts.LinesError, match="lie over each other"):
            ts.profile(folded, line)


# ---------------------------------------------------------------- geometries


@pytest.mark.parametrize(
    "line",
    [
        np.array([[1, 2], [3, 2]]),
        [(1, 2, 99), (3, 2, 99)],
        ts.Breakline([[1, 2], [3, 2]]),
        ts.Features.of_lines([[1, 2], [3, 2]], [0, 2]),
        {"type": "LineString", "coordinates": [[1, 2], [3, 2]]},
        {"type": "MultiLineString", "coordinates": [[[1, 2], [3, 2]]]},
        {
            "type": "FeatureCollection",
            "features": [
                {
                    "type": "Feature",
                    "properties": None,
                    "geometry": {"type": "LineString", "coordinates": [[1, 2], [3, 2]]},
                }
            ],
        },
        [ts.Breakline([[1, 2], [3, 2]])],
    ],
)
def test_lines_are_taken_as_people_have_them(line):
    assert ts.profile(SQUARE, line)["elevation"].tolist() == [3, 4, 5]


def test_shapely_lines_are_taken():
    line = shapely.LineString([[1, 2], [3, 2]])
    for given in (line, [line], shapely.MultiLineString([line])):
        assert ts.profile(SQUARE, given)["elevation"].tolist() == [3, 4, 5]
