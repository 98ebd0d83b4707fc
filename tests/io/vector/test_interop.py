"""Parts of a TIN in the hands of GeoPandas, Arrow, Polars and shapely, the real ones."""

from __future__ import annotations

import geopandas
import numpy as np
import polars as pl
import pyarrow as pa
import pytest
import shapely
from support.surfaces import hills

import tinsmith as ts

KINDS = ("triangles", "points", "edges", "lines", "hull")


@pytest.fixture(scope="module")
def tin():
    return hills()


def test_triangles_as_a_geodataframe(tin):
    frame = tin.to_geodataframe()
    assert frame.crs == tin.crs.to_pyproj()
    assert len(frame) == len(tin) == len(tin.triangles)
    np.testing.assert_allclose(frame.area, tin.triangle_areas, rtol=1e-9)
    np.testing.assert_allclose(frame["area"], tin.triangle_areas, rtol=1e-9)
    np.testing.assert_array_equal(frame["slope"], ts.slope(tin))
    corners = shapely.get_coordinates(frame.geometry, include_z=True).reshape(-1, 4, 3)
    np.testing.assert_array_equal(corners[:, :3], tin.points[tin.triangles])


def test_edges_points_lines_and_outline(tin):
    edges = tin.to_geodataframe("edges")
    assert len(edges) == len(tin.edges)
    ends = tin.points[tin.edges][..., :2]
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    assert sorted(edges.length) == pytest.approx(sorted(lengths))
    assert edges["constrained"].sum() == len(np.unique(_constrained_edges(tin), axis=0))
    points = tin.to_geodataframe("points")
    np.testing.assert_array_equal(
        shapely.get_coordinates(points.geometry, include_z=True), tin.points
    )
    lines = tin.to_geodataframe("lines")
    assert list(lines["kind"]) == list(tin.lines.kinds)
    for shape, chain in zip(lines.geometry, tin.lines.chains(), strict=True):
        np.testing.assert_array_equal(
            shapely.get_coordinates(shape, include_z=True), tin.points[chain]
        )
    assert tin.to_geodataframe("hull").area.sum() == pytest.approx(tin.area)


def _constrained_edges(tin):
    triangle, corner = np.nonzero(tin.constrained)
    ends = [tin.triangles[triangle, (corner + k) % 3] for k in (1, 2)]
    return np.sort(np.stack(ends, axis=1), axis=1)


@pytest.mark.parametrize(
    "boundary", [None, [[0, 0], [9, 0], [9, 1], [1, 1], [1, 8], [9, 9], [0, 9]]]
)
def test_cells_of_a_voronoi_diagram(boundary):
    points = np.random.default_rng(4).random((30, 3)) * 10
    tin = ts.triangulate(points, crs="EPSG:32616")
    for diagram in (ts.voronoi(tin, boundary=boundary), tin.voronoi(boundary=boundary)):
        frame = ts.to_features(diagram).to_geodataframe()
        assert frame.crs == "EPSG:32616"
        mine = diagram.to_shapely()
        assert set(frame["vertex"]) == {k for k, cell in enumerate(mine) if not cell.is_empty}
        np.testing.assert_allclose(frame.area, frame["area"])
        for vertex, cell in zip(frame["vertex"], frame.geometry, strict=True):
            assert shapely.equals(cell, mine[vertex])


def test_no_lines_are_no_features_instead_of_an_error():
    tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]], crs="EPSG:32616")
    frame = tin.to_geodataframe("lines")
    assert (len(frame), list(frame.columns)[:2]) == (0, ["id", "kind"])
    assert frame.crs == "EPSG:32616"


def test_a_survey_has_points():
    survey = ts.Survey(points=np.eye(3), attributes={"number": [7, 8, 9]})
    assert ts.to_features(survey).to_geodataframe()["number"].tolist() == [7, 8, 9]


def test_arrow_is_opened_by_its_readers(tin):
    table = pa.table(tin)
    assert table.num_rows == len(tin)
    metadata = table.schema.field("geometry").metadata
    assert metadata[b"ARROW:extension:name"] == b"geoarrow.polygon"
    assert b"32616" in metadata[b"ARROW:extension:metadata"]
    frame = geopandas.GeoDataFrame.from_arrow(tin)
    assert frame.crs == tin.crs.to_pyproj()
    assert shapely.equals_identical(frame.geometry, tin.to_geodataframe().geometry).all()


@pytest.mark.filterwarnings("ignore:Extension type")  # Polars keeps the storage, and says so
def test_polars_takes_the_columns(tin):
    frame = pl.DataFrame(tin)
    np.testing.assert_array_equal(frame["slope"].to_numpy(), ts.slope(tin))
    assert len(frame) == len(tin)


def test_geo_interface_is_that_of_the_triangles(tin):
    frame = geopandas.GeoDataFrame.from_features(tin.__geo_interface__)
    assert shapely.equals_identical(frame.geometry, tin.to_geodataframe().geometry).all()


@pytest.mark.parametrize("kind", KINDS)
def test_features_come_back_as_what_they_were(tin, kind):
    """The outline is a boundary, lines are breaklines, points are points: the same surface."""
    features = ts.to_features(tin, kind)
    if kind == "points":
        assert ts.triangulate(features).crs == tin.crs
    elif kind in ("edges", "lines"):
        again = ts.triangulate(ts.to_features(tin, "points"), breaklines=features)
        assert set(map(frozenset, tin.lines.segments().tolist())) <= set(
            map(frozenset, again.edges.tolist())
        )
    else:
        again = ts.triangulate(ts.to_features(tin, "points"), boundary=ts.to_features(tin, "hull"))
        assert again.area == pytest.approx(tin.area)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda tin: ts.to_features(5), "Invalid surface 5"),
        (lambda tin: ts.to_features(tin, "faces"), "Invalid kind 'faces'"),
        (lambda tin: ts.to_features(ts.voronoi(tin), "points"), "has cells only"),
        (lambda tin: ts.to_features(ts.Survey(points=np.eye(3)), "edges"), "only points"),
    ],
)
def test_what_has_no_such_parts_is_refused(tin, call, words):
    with pytest.raises(ts.TinsmithError, match=words):
        call(tin)
