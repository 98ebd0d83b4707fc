"""GeoJSON is cut at the antimeridian (RFC 7946, 3.1.9), against shapely and PROJ."""

from __future__ import annotations

import json

import numpy as np
import pyproj
import pytest
import shapely

import tinsmith as ts

UTM1 = "EPSG:32601"
FLAT = "+proj=eqc +lon_0=180 +lat_ts=0 +ellps=WGS84 +units=m +type=crs"
"""Eastings are degrees from the antimeridian, times this:"""
DEGREE = float(np.radians(6_378_137.0))

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")


def place(longitude, latitude, crs=UTM1):
    return pyproj.Transformer.from_crs("OGC:CRS84", crs, always_xy=True).transform(
        longitude, latitude
    )


def across(n=300, seed=3, crs=UTM1):
    """A surface of 80 by 60 kilometres on both sides of the antimeridian."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform([-40_000, -30_000], [40_000, 30_000], (n, 2)) + place(180, 63, crs)
    return ts.triangulate(np.c_[xy, rng.uniform(0, 100, n).round(2)], crs=crs)


def written(surface, path, **options):
    return json.loads(ts.write(surface, path, **options).read_text(encoding="utf-8"))


def shapes_of(document):
    return np.array([shapely.from_geojson(json.dumps(one["geometry"])) for one in
                     document["features"]], object)  # fmt: skip


def in_plane(shapes, crs):
    transform = pyproj.Transformer.from_crs("OGC:CRS84", crs, always_xy=True).transform
    return shapely.transform(shapes, transform, interleaved=False)


def assert_on_one_side(shapes):
    """No part reaches over the antimeridian, and at least one does reach it on each side."""
    ends = shapely.bounds(shapely.get_parts(shapes))[:, [0, 2]]
    assert (np.abs(ends) <= 180).all()
    assert (ends[:, 1] - ends[:, 0] < 180).all()
    assert ends.min() == -180.0
    assert ends.max() == 180.0


def assert_same_triangles(found, wanted):
    """Triangles may begin at another corner."""
    corners = []
    for tin in (found, wanted):
        xyz = tin.points[tin.triangles]
        corners.append([one[np.lexsort(one.round(2).T)] for one in xyz])
    assert np.abs(np.array(corners[0]) - np.array(corners[1])).max() < 2e-4


# ------------------------------------------------------------------------- surfaces


def test_triangles_keep_their_areas_and_join_again(tmp_path):
    tin = across()
    with pytest.warns(ts.LossWarning, match="features cross the antimeridian and were cut there"):
        path = ts.write(tin, tmp_path / "a.geojson")
    document = json.loads(path.read_text())
    shapes = shapes_of(document)
    assert_on_one_side(shapes)
    assert shapely.is_valid(shapes).all()
    assert shapely.coverage_is_valid(shapely.get_parts(shapes))
    corners = shapely.polygons(tin.points[tin.triangles][:, [0, 1, 2, 0], :2])
    found = in_plane(shapes, UTM1)
    assert shapely.area(found) == pytest.approx(shapely.area(corners), abs=20.0)
    assert shapely.hausdorff_distance(found, corners).max() < 1e-3
    back = ts.read(path, crs=UTM1)
    assert len(back.triangles) == len(tin.triangles)
    assert_same_triangles(back, tin)
    assert any("joined again" in note for note in back.report.notes)


def test_elevations_at_the_cut_are_those_of_the_surface(tmp_path):
    tin = across()
    for kind in ("triangles", "edges", "hull"):
        shapes = shapes_of(written(tin, tmp_path / f"{kind}.geojson", kind=kind))
        xyz = shapely.get_coordinates(shapes, include_z=True)
        cut = xyz[np.abs(xyz[:, 0]) == 180.0]
        assert len(cut) >= 4
        x, y = place(cut[:, 0], cut[:, 1])
        found = tin.interpolate(np.column_stack([x, y]))
        inside = np.isfinite(found)  # not so on the hull, by rounding
        assert inside.sum() > len(cut) / 2 or kind == "hull"
        assert np.abs(found - cut[:, 2])[inside].max(initial=0) < 1e-5


def test_the_box_goes_from_west_to_east(tmp_path):
    tin = across()
    for kind in ("triangles", "points", "edges", "hull"):
        document = written(tin, tmp_path / f"{kind}.geojson", kind=kind)
        west, south, low, east, north, high = document["bbox"]
        xyz = shapely.get_coordinates(shapes_of(document), include_z=True)
        assert west == xyz[xyz[:, 0] > 0, 0].min()
        assert east == xyz[xyz[:, 0] < 0, 0].max()
        assert west > east
        assert (south, north) == (xyz[:, 1].min(), xyz[:, 1].max())
        if kind != "hull":  # whose box has the elevations of the whole surface
            assert (low, high) == (xyz[:, 2].min(), xyz[:, 2].max())


def test_a_vertex_and_an_edge_on_the_antimeridian(tmp_path):
    points = np.array([[-1, 50, 0], [1, 50, 2], [0, 51, 4], [0, 49, 6]])
    tin = ts.triangulate(points * (DEGREE, DEGREE, 1), crs=FLAT)
    shapes = shapes_of(written(tin, tmp_path / "a.geojson"))
    assert_on_one_side(shapes)
    back = ts.read(tmp_path / "a.geojson", crs=FLAT)
    assert_same_triangles(back, tin)
    # Both triangles have an edge there, and none is cut.
    points = np.array([[-1, 50, 0], [1, 50, 2], [0, 50.1, 4], [0, 49.9, 6]])
    tin = ts.triangulate(points * (DEGREE, DEGREE, 1), crs=FLAT)
    shapes = shapes_of(written(tin, tmp_path / "b.geojson"))
    assert (shapely.get_type_id(shapes) == 3).all()
    assert_on_one_side(shapes)


def test_a_surface_all_round_is_not_cut_where_it_does_not_cross(tmp_path):
    """In the plane of Mercator the way from 170 W to 170 E goes over Greenwich."""
    points = np.array([[-170, 0, 0], [170, 0, 0], [0, 40, 10], [0, -40, 20]])
    xy = np.column_stack(place(points[:, 0], points[:, 1], "EPSG:3857"))
    tin = ts.triangulate(np.c_[xy, points[:, 2]], crs="EPSG:3857")
    document = written(tin, tmp_path / "a.geojson", kind="edges")
    shapes = shapes_of(document)
    assert (shapely.get_type_id(shapes) == 1).all()
    assert document["bbox"][0] < document["bbox"][3]


def test_a_ring_around_a_pole_is_refused(tmp_path):
    points = [[2.0e6, 2.1e6, 0], [1.9e6, 1.9e6, 0], [2.1e6, 1.9e6, 0]]
    tin = ts.triangulate(points, crs="EPSG:32661")
    with pytest.raises(ts.WriteError, match="holds a pole"):
        ts.write(tin, tmp_path / "a.geojson")
    beside = ts.triangulate(np.array(points) + np.array([0, 3e5, 0]), crs="EPSG:32661")
    shapes = shapes_of(written(beside, tmp_path / "b.geojson"))
    assert_on_one_side(shapes)
    assert shapely.area(in_plane(shapes, "EPSG:32661")).sum() == pytest.approx(beside.area)


# ------------------------------------------------------------------------- features


def test_a_line_of_longitudes_beyond_180(tmp_path):
    line = ts.Features.of_lines([[179, 0, 10], [181, 1, 20], [182, 1, np.nan]], [0, 3], crs=4326)
    (feature,) = written(line, tmp_path / "a.geojson")["features"]
    assert feature["geometry"] == {
        "type": "MultiLineString",
        "coordinates": [[[179, 0, 10], [180, 0.5, 15]], [[-180, 0.5, 15], [-179, 1, 20],
                                                         [-178, 1]]],
    }  # fmt: skip
    flat = ts.Features.of_lines([[179, 0], [181, 1]], [0, 2], crs=4326)
    (feature,) = written(flat, tmp_path / "b.geojson")["features"]
    assert feature["geometry"]["coordinates"] == [[[179, 0], [180, 0.5]], [[-180, 0.5], [-179, 1]]]


def test_longitudes_that_do_not_tell_the_way_are_refused(tmp_path):
    lines = ts.Features.of_lines([[0, 0], [1, 1], [179, 0], [-179, 1]], [0, 2, 4], crs=4326)
    for suffix in (".geojson", ".geojsonl"):
        with pytest.raises(ts.WriteError, match=r"line 1 crosses the antimeridian.*beyond 180"):
            ts.write(lines, tmp_path / f"a{suffix}")


def comb(teeth=3):
    """A polygon of which the teeth reach over the antimeridian, with a hole in its back."""
    outer = [[-3, 0], [-2, 0]]
    for k in range(teeth):
        outer += [[2, 2 * k], [2, 2 * k + 1], [-2, 2 * k + 1], [-2, 2 * k + 2]]
    outer += [[-3, 2 * teeth], [-3, 0]]
    hole = [[-2.8, 1], [-2.8, 2], [-2.2, 2], [-2.2, 1], [-2.8, 1]]
    xy = np.array(outer + hole)
    return np.c_[xy, xy @ (3, 7)] * (DEGREE, DEGREE, 1), [0, len(outer), len(xy)]


def test_polygons_that_cross_often_and_have_holes(tmp_path):
    xyz, rings = comb()
    tooth = np.array([[-1, 0.2, 1], [1, 0.2, 1], [1, 0.8, 1], [-1, 0.8, 1], [-1, 0.2, 1]])
    hole = np.array([[-0.5, 0.4, 1], [-0.5, 0.6, 1], [0.5, 0.6, 1], [0.5, 0.4, 1], [-0.5, 0.4, 1]])
    every = np.concatenate([xyz, tooth * (DEGREE, DEGREE, 1), hole * (DEGREE, DEGREE, 1)])
    made = ts.Features.of_polygons(
        every, [*rings, rings[-1] + 5, rings[-1] + 10], [0, 2, 4], crs=FLAT
    )
    document = written(made, tmp_path / "a.geojson")
    shapes = shapes_of(document)
    assert_on_one_side(shapes)
    assert shapely.is_valid(shapes).all()
    assert shapely.get_num_geometries(shapes).tolist() == [4, 2]
    rings = [ring for part in shapely.get_parts(shapes) for ring in shapely.get_rings(part)[:1]]
    assert all(shapely.is_ccw(ring) for ring in rings)
    # The antimeridian is a straight line of the plane: shapely cuts there.
    plane = made.to_shapely()
    for side in (shapely.box(-9e6, -9e6, 0, 9e6), shapely.box(0, -9e6, 9e6, 9e6)):
        wanted = shapely.intersection(plane, side)
        east = side.bounds[0] == 0
        mine = [
            shapely.multipolygons([p for p in shapely.get_parts(one) if (p.bounds[0] < 0) == east])
            for one in shapes
        ]
        found = in_plane(np.array(mine, object), FLAT)
        assert shapely.area(shapely.symmetric_difference(found, wanted)).max() < 1e3
    z = shapely.get_coordinates(shapes[0], include_z=True)
    east = np.where(z[:, 0] < 0, z[:, 0] + 360, z[:, 0]) - 180
    assert np.abs(z[:, 2] - (east * 3 + z[:, 1] * 7)).max() < 1e-5
    back = ts.read_polygons(tmp_path / "a.geojson", crs=FLAT)
    assert [len(rings) for rings in back] == [2, 2]
    areas = [shapely.Polygon(rings[0][:, :2], [r[:, :2] for r in rings[1:]]).area for rings in back]
    assert areas == pytest.approx(shapely.area(plane), rel=1e-9)


def test_contours_keep_their_lengths_and_are_whole_again(tmp_path):
    tin = across()
    made = ts.contours(tin, interval=10)
    for suffix in (".geojson", ".geojsonl"):
        path = ts.write(made, tmp_path / f"a{suffix}")
        lines = ts.read_lines(path, crs=UTM1)
        assert len(lines) == len(made)
        found = [shapely.LineString(line.coords[:, :2]) for line in lines]
        assert shapely.length(found) == pytest.approx(shapely.length(made.to_shapely()), abs=1e-2)
        assert shapely.hausdorff_distance(found, made.to_shapely()).max() < 1e-3
    assert_on_one_side(shapes_of(json.loads((tmp_path / "a.geojson").read_text())))


def test_a_line_that_winds_about_the_pole(tmp_path):
    angles = np.linspace(0.3, 4 * np.pi, 50)
    xy = 2e6 + np.column_stack([np.cos(angles), np.sin(angles)]) * (2e5 + 1e4 * angles[:, None])
    made = ts.Features.of_lines(xy, [0, 50], crs="EPSG:32661")
    (shape,) = shapes_of(written(made, tmp_path / "a.geojson"))
    ends = shapely.bounds(shapely.get_parts(shape))[:, [0, 2]]
    assert len(ends) == 3
    assert (np.abs(ends) <= 180).all()
    found = in_plane(shape, "EPSG:32661")
    assert shapely.length(found) == pytest.approx(shapely.length(made.to_shapely())[0], abs=1e-2)


def test_points_on_the_antimeridian_are_places(tmp_path):
    x, y = place(np.full(3, 180.0), np.array([62.0, 63.0, 64.0]))
    survey = ts.Survey(points=np.c_[x, y, [1.0, 2.0, 3.0]], crs=UTM1)
    found = shapely.get_coordinates(shapes_of(written(survey, tmp_path / "a.geojson")))
    assert (np.abs(found[:, 0]) == 180.0).all()


def test_parts_that_do_not_meet_are_left_apart(tmp_path):
    lines = [[[179, 0], [180, 0.5]], [[-180, 0.6], [-179, 1]]]
    geometry = {"type": "MultiLineString", "coordinates": lines}
    feature = {"type": "Feature", "properties": {}, "geometry": geometry}
    path = tmp_path / "a.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    assert len(ts.read_lines(path, crs=UTM1)) == 2


def test_a_file_of_the_whole_world_stays_as_it_is(tmp_path):
    """Features elsewhere must not move by 360 degrees because another one was cut."""
    cut = [[[170, 60], [180, 60], [180, 70], [170, 60]]], [[[-180, 60], [-170, 65], [-180, 70],
                                                            [-180, 60]]]  # fmt: skip
    here = [[[0, 40], [10, 40], [10, 50], [0, 40]]]
    geometries = [
        {"type": "MultiPolygon", "coordinates": [*cut]},
        {"type": "Polygon", "coordinates": here},
    ]
    features = [{"type": "Feature", "properties": {}, "geometry": one} for one in geometries]
    path = tmp_path / "a.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    pacific = "+proj=eqc +lon_0=180 +ellps=WGS84 +type=crs"
    assert len(ts.read_rings(path, crs=pacific)) == 3
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features[:1]}))
    (ring,) = ts.read_rings(path, crs=pacific)
    ends = ring[:, 0].min() / DEGREE, ring[:, 0].max() / DEGREE
    assert ends == pytest.approx((-10, 10))
    # The map of Mercator ends there: joined, the ring would go all round it.
    rings = ts.read_rings(path, crs="EPSG:3857")
    assert sorted(np.ptp(ring[:, 0]) / DEGREE for ring in rings) == pytest.approx([10, 10])
