"""Draping: features lie on the surface, what is outside is told."""

import numpy as np
import pytest
import shapely

import tinsmith as ts

SQUARE = ts.TIN.from_triangles([[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]], [[0, 1, 2], [0, 2, 3]])
"""z = x + y."""

TWO = ts.TIN.from_triangles(
    [[0, 0, 0], [4, 0, 4], [0, 4, 8], [4, 4, 4], [8, 0, 1], [8, 8, 1]], [[0, 1, 2], [3, 4, 5]]
)


def test_a_line_gets_a_vertex_at_every_edge():
    draped = ts.drape(SQUARE, [[1, 2], [3, 2]])
    assert draped.coordinates.tolist() == [[1, 2, 3], [2, 2, 4], [3, 2, 5]]
    assert draped.kind == "lines"


def test_polygons_keep_their_rings_and_columns():
    ring = shapely.box(1, 1, 3, 3).difference(shapely.box(1.25, 2, 1.75, 2.5))
    lot = {
        "type": "Feature",
        "properties": {"name": "lot", "n": 7},
        "geometry": shapely.geometry.mapping(ring),
    }
    given = {"type": "FeatureCollection", "features": [lot]}
    draped = ts.drape(SQUARE, given)
    assert draped.kind == "polygons"
    assert draped.columns["name"].tolist() == ["lot"]
    assert draped.columns["n"].tolist() == [7]
    assert len(draped.offsets[0]) == 3
    x, y, z = draped.coordinates.T
    assert z.tolist() == (x + y).tolist()
    first, last = draped.offsets[0][:-1], draped.offsets[0][1:] - 1
    assert (draped.coordinates[first] == draped.coordinates[last]).all()
    (shape,) = draped.to_shapely()
    assert shape.equals(ring)


def test_points_take_what_interpolate_gives():
    draped = ts.drape(SQUARE, ts.Features.of_points([[1, 1], [3, 2]], columns={"id": [4, 5]}))
    assert draped.coordinates.tolist() == [[1, 1, 2], [3, 2, 5]]
    assert draped.columns["id"].tolist() == [4, 5]


def test_elevations_that_were_there_are_replaced():
    assert ts.drape(SQUARE, [[1, 2, 99], [3, 2, 99]]).coordinates[:, 2].tolist() == [3, 4, 5]


def test_crs_and_unit_are_those_of_the_surface():
    tin = SQUARE.replace(crs="EPSG:32616", elevation_unit="ft")
    draped = ts.drape(tin, [[1, 2], [3, 2]])
    assert draped.crs == "EPSG:32616"
    assert draped.elevation_unit.symbol == "ft"
    with pytest.raises(ts.CrsError, match="EPSG:32617"):
        ts.drape(tin, ts.Features.of_lines([[1, 2], [3, 2]], [0, 2], crs="EPSG:32617"))


def test_degrees_can_be_draped():
    assert len(ts.drape(SQUARE.replace(crs="EPSG:4326"), [[1, 2], [3, 2]]).coordinates) == 3


LINES = [[[0, 2], [8, 2]], [[1, 1], [1, 2]], [[20, 20], [21, 21]]]


def test_what_is_outside_is_refused_unless_asked_for():
    with pytest.raises(
        ts.LinesError, match=r"2 of 3 lines lie outside .* \(first: line 0"
    ) as caught:
        ts.drape(TWO, LINES)
    assert caught.value.lines == (0, 2)


def test_without_elevations_the_line_stays_whole():
    draped = ts.drape(TWO, LINES, outside="nan")
    assert len(draped) == 3
    assert draped.coordinates[:5, 0].tolist() == [0, 2, 4, 6, 8]
    assert (
        np.isnan(draped.coordinates[:, 2]).tolist()
        == [False] * 2 + [True] + [False] * 4 + [True] * 2
    )
    assert "2 of 3 lines" in draped.notes[1]


def test_cut_lines_have_parts_and_lost_features_are_told():
    given = ts.Features.of_lines(
        np.concatenate(LINES), [0, 2, 4, 6], columns={"name": ["a", "b", "c"]}
    )
    draped = ts.drape(TWO, given, outside="cut")
    assert draped.columns["name"].tolist() == ["a", "b"]
    assert [len(line.geoms) for line in draped.to_shapely()] == [2, 1]
    assert not np.isnan(draped.coordinates).any()
    assert draped.notes[-1] == "1 feature wholly outside was left out."


def test_points_outside():
    given = ts.Features.of_points([[1, 1], [9, 9]], columns={"name": ["in", "out"]})
    with pytest.raises(ts.LinesError, match=r"1 of 2 points lies outside .* \(first: point 1"):
        ts.drape(SQUARE, given)
    assert np.isnan(ts.drape(SQUARE, given, outside="nan").coordinates[1, 2])
    assert ts.drape(SQUARE, given, outside="cut").columns["name"].tolist() == ["in"]


def test_polygons_outside_are_not_cut():
    lot = shapely.box(1, 1, 9, 3)
    with pytest.raises(ts.LinesError, match="1 of 1 ring lies outside"):
        ts.drape(SQUARE, lot)
    with pytest.raises(ts.OptionError, match="error or nan for polygons"):
        ts.drape(SQUARE, lot, outside="cut")
    z = ts.drape(SQUARE, lot, outside="nan").coordinates[:, 2]
    assert 0 < np.isnan(z).sum() < len(z)


def test_several_parts_stay_together():
    given = shapely.MultiLineString([[[1, 2], [3, 2]], [[1, 1], [1, 3]]])
    draped = ts.drape(SQUARE, given)
    assert draped.is_multi
    assert len(draped) == 1


def test_points_of_one_feature_become_several():
    points = {"type": "MultiPoint", "coordinates": [[1, 1], [9, 9], [2, 1]]}
    given = {"type": "Feature", "properties": {"name": "a"}, "geometry": points}
    draped = ts.drape(SQUARE, given, outside="cut")
    assert draped.coordinates.tolist() == [[1, 1, 2], [2, 1, 3]]
    assert draped.columns["name"].tolist() == ["a", "a"]


@pytest.mark.parametrize(
    ("features", "why"),
    [
        ([], "no feature"),
        ([shapely.Point(1, 1), shapely.LineString([[1, 1], [2, 2]])], "lines and points together"),
        ({"type": "GeometryCollection", "geometries": []}, "no coordinates"),
        ({"type": "Curve", "coordinates": []}, "'Curve'"),
        (shapely.LineString(), "no coordinates"),
        ([[20, 20], [21, 21]], "outside"),
    ],
)
def test_what_cannot_be_draped_is_refused_in_a_sentence(features, why):
    with pytest.raises(ts.LinesError, match=why):
        ts.drape(SQUARE, features)


def test_nothing_is_left():
    with pytest.raises(ts.LinesError, match="1 feature lies wholly outside"):
        ts.drape(SQUARE, [[20, 20], [21, 21]], outside="cut")
    with pytest.raises(ts.OptionError, match="outside"):
        ts.drape(SQUARE, [[1, 1], [2, 2]], outside="clip")
