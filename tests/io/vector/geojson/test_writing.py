"""GeoJSON: the rules of RFC 7946, and what GDAL, shapely and PROJ make of the file."""

from __future__ import annotations

import json
import math
import warnings
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pyproj
import pytest
import shapely

import tinsmith as ts
from tinsmith.base.errors import CrsError, FormatError, OptionError, WriteError
from tinsmith.io.vector.geojson import features
from tinsmith.io.vector.geojson import writing as geojson

UTM16 = "EPSG:32616"
TENNESSEE = np.array([1_700_000.0, 600_000.0, 0.0])  # US survey feet
ORIGIN = np.array([745_000.0, 4_033_000.0, 0.0])


def hills(n=300, seed=7, crs=UTM16):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 400, (n, 2))
    z = 200 + 10 * np.sin(xy[:, 0] / 60) + xy[:, 1] / 40 + rng.normal(0, 0.05, n)
    return ts.triangulate(np.c_[xy, z.round(3)] + ORIGIN, crs=crs)


def ring_with_hole(crs=UTM16):
    """A square frame: eight triangles about a square hole."""
    outer = np.array([[0, 0], [30, 0], [30, 30], [0, 30]])
    inner = np.array([[10, 10], [20, 10], [20, 20], [10, 20]])
    points = np.c_[np.vstack([outer, inner]), np.arange(8)] + ORIGIN
    sides = [(k, (k + 1) % 4) for k in range(4)]
    triangles = [t for a, b in sides for t in ((a, b, 4 + b), (a, 4 + b, 4 + a))]
    return ts.TIN.from_triangles(points, triangles, crs=crs)


def written(surface, path, **options):
    geojson.write(surface, path, **options)
    return json.loads(path.read_text(encoding="utf-8"), parse_constant=pytest.fail)


def coordinates(document, depth):
    """All positions of all features, flattened."""
    found = [feature["geometry"]["coordinates"] for feature in document["features"]]
    for _ in range(depth):
        found = [inner for outer in found for inner in outer]
    return np.array(found)


def signed_area(ring):
    """By the shoelace formula in exact rational arithmetic."""
    corners = [(Fraction(x), Fraction(y)) for x, y, *_ in ring]
    return sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in pairwise(corners)) / 2


# ------------------------------------------------------------------- rules of the RFC


@pytest.mark.parametrize("kind", ["triangles", "points", "edges", "hull"])
def test_document_follows_rfc_7946(tmp_path, kind):
    document = written(hills(), tmp_path / "a.geojson", kind=kind)
    assert list(document) == ["type", "bbox", "features"]
    assert document["type"] == "FeatureCollection"
    geometry = {"triangles": "Polygon", "points": "Point", "edges": "LineString", "hull": "Polygon"}
    for feature in document["features"]:
        assert list(feature) == ["type", "properties", "geometry"]
        assert feature["type"] == "Feature"
        assert isinstance(feature["properties"], dict)
        assert feature["geometry"]["type"] == geometry[kind]
    ids = [feature["properties"]["id"] for feature in document["features"]]
    assert ids == list(range(len(ids)))


def test_bbox_holds_all_positions_and_touches_them(tmp_path):
    document = written(hills(), tmp_path / "a.geojson")
    positions = coordinates(document, 2)
    expected = [*positions.min(axis=0), *positions.max(axis=0)]
    assert document["bbox"] == expected


@pytest.mark.parametrize("tin", [hills(), hills(crs="EPSG:2053"), ring_with_hole()])
def test_rings_are_closed_and_counter_clockwise(tmp_path, tin):
    for kind in ("triangles", "hull"):
        for feature in written(tin, tmp_path / "a.geojson", kind=kind)["features"]:
            for k, ring in enumerate(feature["geometry"]["coordinates"]):
                assert ring[0] == ring[-1]
                assert len(ring) >= 4
                assert (signed_area(ring) > 0) == (k == 0)


def test_a_crs_of_mirrored_axes_is_turned_counter_clockwise(tmp_path):
    # Its first coordinate grows to the west.
    mirrored = "+proj=tmerc +lat_0=0 +lon_0=29 +k=1 +ellps=WGS84 +axis=wnu +type=crs"
    points = np.array([[0, -3e6, 1], [100, -3e6, 2], [0, -2_999_900, 3]])
    to_degrees = pyproj.Transformer.from_crs(mirrored, "OGC:CRS84", always_xy=True)
    in_degrees = np.stack(to_degrees.transform(*points[[0, 1, 2, 0], :2].T), axis=1)
    assert signed_area(in_degrees) < 0
    document = written(ts.triangulate(points, crs=mirrored), tmp_path / "a.geojson")
    (ring,) = document["features"][0]["geometry"]["coordinates"]
    assert signed_area(ring) > 0
    assert sorted(p[2] for p in ring[:3]) == [1.0, 2.0, 3.0]


def test_positions_have_at_most_nine_decimals(tmp_path):
    path = tmp_path / "a.geojson"
    geojson.write(hills(), path)
    document = json.loads(path.read_text(), parse_float=str)
    for feature in document["features"]:
        for x, y, z in feature["geometry"]["coordinates"][0]:
            for number, most in ((x, 9), (y, 9), (z, 6)):
                assert "e" not in number
                assert len(number.partition(".")[2]) <= most


# -------------------------------------------------------------- second opinions: numbers


def test_positions_are_those_of_proj(tmp_path):
    tin = hills()
    document = written(tin, tmp_path / "a.geojson", kind="points")
    # Not our transformer: the projection alone, inverted.
    lon, lat = pyproj.Proj(UTM16)(tin.points[:, 0], tin.points[:, 1], inverse=True)
    found = coordinates(document, 0)
    assert np.abs(found[:, 0] - lon).max() <= 1e-9
    assert np.abs(found[:, 1] - lat).max() <= 1e-9
    assert np.abs(found[:, 2] - tin.points[:, 2]).max() <= 5e-7


def test_gdal_reads_every_triangle(tmp_path):
    pyogrio = pytest.importorskip("pyogrio")
    tin = hills()
    path = tmp_path / "a.geojson"
    geojson.write(tin, path)
    meta, _, wkb, fields = pyogrio.raw.read(path)
    shapes = shapely.from_wkb(wkb)
    assert meta["crs"] == "EPSG:4979"  # WGS 84 in three dimensions
    assert len(shapes) == len(tin.triangles)
    assert shapely.is_valid(shapes).all()
    assert shapely.has_z(shapes).all()
    assert list(meta["fields"]) == ["id", "slope", "aspect", "area"]
    corners = shapely.get_coordinates(shapes, include_z=True).reshape(-1, 4, 3)[:, :3, 2]
    assert np.abs(np.sort(corners) - np.sort(tin.points[tin.triangles, 2])).max() <= 5e-7
    back = pyproj.Transformer.from_crs("EPSG:4326", UTM16, always_xy=True)
    projected = shapely.transform(shapes, back.transform, interleaved=False)
    assert shapely.area(projected) == pytest.approx(fields[3], rel=1e-4, abs=0.05)


def test_triangles_tile_the_hull_without_gap_or_overlap(tmp_path):
    tin = hills()
    document = written(tin, tmp_path / "a.geojson")
    shapes = shapely.from_geojson(
        [json.dumps(feature["geometry"]) for feature in document["features"]]
    )
    (hull,) = written(tin, tmp_path / "h.geojson", kind="hull")["features"]
    outline = shapely.from_geojson(json.dumps(hull["geometry"]))
    assert shapely.coverage_is_valid(shapes)
    assert shapely.coverage_union_all(shapes).symmetric_difference(outline).area < 1e-16
    assert shapely.area(shapes).sum() == pytest.approx(outline.area, rel=1e-9)


def test_every_point_is_a_vertex(tmp_path):
    tin = hills()
    corners = coordinates(written(tin, tmp_path / "a.geojson"), 2)
    points = coordinates(written(tin, tmp_path / "b.geojson", kind="points"), 0)
    assert {tuple(p) for p in corners} == {tuple(p) for p in points}
    assert len(points) == len(tin.points)


def test_slope_and_aspect_of_a_known_plane(tmp_path):
    # z falls by 1 in 1 towards the east; grid azimuth 90.
    points = [[0, 0, 10], [10, 0, 0], [0, 10, 10], [10, 10, 0]]
    tin = ts.triangulate(np.array(points) + ORIGIN, crs=UTM16)
    for feature in written(tin, tmp_path / "a.geojson")["features"]:
        assert feature["properties"]["slope"] == 45.0
        assert feature["properties"]["aspect"] == 90.0
        assert feature["properties"]["area"] == 50.0


def test_aspect_of_level_ground_is_null(tmp_path):
    tin = ts.triangulate(np.array([[0, 0, 5], [9, 0, 5], [0, 9, 5]]) + ORIGIN, crs=UTM16)
    (feature,) = written(tin, tmp_path / "a.geojson")["features"]
    assert feature["properties"] == {"id": 0, "slope": 0.0, "aspect": None, "area": 40.5}


def test_aspect_a_hair_west_of_north_is_not_the_full_circle(tmp_path):
    tin = ts.triangulate(
        np.array([[0, 0, 1e6], [1e6, 0, 1e6 + 1e-2], [0, 1e6, 0]]) + np.array([0, 4e6, 0]),
        crs=UTM16,
    )
    assert 0 < 360 - float(ts.terrain.aspect(tin)[0]) < 5e-5
    (feature,) = written(tin, tmp_path / "a.geojson", projected=True)["features"]
    assert feature["properties"]["aspect"] == 0.0


def test_many_batches_give_every_triangle_once(tmp_path, monkeypatch):
    tin = hills()
    whole, pieces = tmp_path / "a.geojson", tmp_path / "b.geojson"
    for kind in ("triangles", "points", "edges"):
        geojson.write(tin, whole, kind=kind)
        with monkeypatch.context() as patch:
            patch.setattr(features, "_BATCH", 7)
            geojson.write(tin, pieces, kind=kind)
        assert whole.read_bytes() == pieces.read_bytes()


# ---------------------------------------------------------------------- units and CRSs


def test_feet_become_metres(tmp_path):
    foot = 1200 / 3937
    points = np.array([[0, 0, 100], [300, 0, 100], [0, 300, 400]]) + TENNESSEE
    (feature,) = written(ts.triangulate(points, crs="EPSG:2274"), tmp_path / "a.geojson")[
        "features"
    ]
    heights = sorted({p[2] for p in feature["geometry"]["coordinates"][0]})
    assert heights == pytest.approx([100 * foot, 400 * foot], abs=1e-6)
    assert feature["properties"]["slope"] == 45.0
    assert feature["properties"]["area"] == pytest.approx(45_000 * foot**2, rel=1e-8)


def test_a_vertical_axis_of_another_unit_counts_in_slope(tmp_path):
    # Feet along, metres up (EPSG:5703 is NAVD88 height in metres).
    foot = 1200 / 3937
    points = np.array([[0, 0, 0], [300, 0, 0], [0, 300, 300]]) + TENNESSEE
    tin = ts.triangulate(points, crs="EPSG:2274+5703")
    (feature,) = written(tin, tmp_path / "a.geojson", projected=True)["features"]
    expected = math.degrees(math.atan2(300, 300 * foot))
    assert feature["properties"]["slope"] == pytest.approx(expected, abs=1e-4)


def test_a_compound_crs_in_feet_gives_metres(tmp_path):
    points = [[-84.0, 36.0, 1000.0], [-83.9, 36.0, 1000.0], [-84.0, 36.1, 1000.0]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # PROJ may say that a geoid grid is not at hand
        tin = ts.triangulate(points, crs="EPSG:6318+6360")
        found = coordinates(written(tin, tmp_path / "a.geojson", kind="points"), 0)
    # Within the height of the geoid, should a grid be there.
    assert found[:, 2] == pytest.approx(1000 * 1200 / 3937, abs=60)


def test_degrees_have_the_slope_that_they_have_on_the_ground(tmp_path):
    tin = ts.triangulate([[10, 50, 1], [10.1, 50, 2], [10, 50.1, 3]], crs="EPSG:4326")
    (feature,) = written(tin, tmp_path / "a.geojson")["features"]
    found = feature["properties"]
    # Lengths of a degree at 50 1/30 degrees north, from the tables of the ellipsoid.
    east, north = 1 / (0.1 * 71_648.0), 2 / (0.1 * 111_230.0)
    assert found["slope"] == pytest.approx(np.degrees(np.arctan(np.hypot(east, north))), abs=1e-4)
    assert found["aspect"] == pytest.approx(180 + np.degrees(np.arctan(east / north)), abs=0.02)
    assert found["area"] == pytest.approx(7164.8 * 11123.0 / 2, rel=1e-3)
    assert [10.1, 50.0, 2.0] in feature["geometry"]["coordinates"][0]


# -------------------------------------------------------------------- projected variant


def test_projected_keeps_every_digit_and_names_the_crs(tmp_path):
    tin = hills()
    path = tmp_path / "a.geojson"
    document = written(tin, path, kind="points", projected=True)
    assert np.array_equal(coordinates(document, 0), tin.points)
    assert document["crs"] == {
        "type": "name",
        "properties": {"name": "urn:ogc:def:crs:EPSG::32616"},
    }
    pyogrio = pytest.importorskip("pyogrio")
    assert pyogrio.read_info(path)["crs"] == UTM16


def test_projected_with_an_unknown_crs_says_so(tmp_path):
    path = tmp_path / "a.geojson"
    assert written(hills(crs=None), path, projected=True)["crs"] is None


def test_projected_custom_crs_is_understood_by_gdal(tmp_path):
    pyogrio = pytest.importorskip("pyogrio")
    site = pyproj.CRS("+proj=tmerc +lat_0=36 +lon_0=-84 +k=1 +x_0=1000 +y_0=1000 +ellps=GRS80")
    path = tmp_path / "a.geojson"
    geojson.write(hills(crs=site.to_wkt()), path, projected=True)
    assert pyproj.CRS(pyogrio.read_info(path)["crs"]).equals(site)


# ------------------------------------------------------------- edges, hull and points


def test_edges_once_each_with_their_flag(tmp_path):
    base = hills(60)
    flags = np.zeros_like(base.constrained)
    inside = np.argwhere(base.neighbors >= 0)
    flags[tuple(inside[:: len(inside) // 9].T)] = True  # each flagged from one side only
    tin = ts.TIN.from_triangles(base.points, base.triangles, constrained=flags, crs=UTM16)
    document = written(tin, tmp_path / "a.geojson", kind="edges", projected=True)
    vertex = {tuple(p): i for i, p in enumerate(tin.points.tolist())}
    found = {
        frozenset(vertex[tuple(p)] for p in f["geometry"]["coordinates"]): f["properties"][
            "constrained"
        ]
        for f in document["features"]
    }
    expected = {frozenset(edge): False for edge in tin.edges.tolist()}
    for triangle, corner in np.argwhere(flags):
        a, b = (int(tin.triangles[triangle, (corner + k) % 3]) for k in (1, 2))
        expected[frozenset((a, b))] = True
    assert found == expected
    assert len(document["features"]) == len(tin.edges)


def test_hull_has_holes_and_area(tmp_path):
    (feature,) = written(ring_with_hole(), tmp_path / "a.geojson", kind="hull")["features"]
    assert [len(ring) for ring in feature["geometry"]["coordinates"]] == [5, 5]
    assert feature["properties"] == {"id": 0, "area": 800.0}
    assert shapely.from_geojson(json.dumps(feature["geometry"])).is_valid


def test_hull_of_two_islands_is_two_features(tmp_path):
    frame = ring_with_hole()
    far = frame.points + np.array([100, 0, 0])
    tin = ts.TIN.from_triangles(
        np.vstack([frame.points, far]), np.vstack([frame.triangles, frame.triangles + 8]), crs=UTM16
    )
    features = written(tin, tmp_path / "a.geojson", kind="hull", projected=True)["features"]
    shapes = [shapely.from_geojson(json.dumps(f["geometry"])) for f in features]
    assert [shape.area for shape in shapes] == [800.0, 800.0]
    assert shapes[0].disjoint(shapes[1])


def test_survey_points_carry_their_attributes(tmp_path):
    survey = ts.Survey(
        points=hills(4).points,
        attributes={
            "number": np.array([7, 8, 9, 10]),
            'code "100%"': np.array(["GR", 'é"\\', "", None], object),
            "depth": np.array([1.5, np.nan, np.inf, -0.25]),
            "checked": np.array([True, False, True, False]),
        },
        crs=UTM16,
    )
    features = written(survey, tmp_path / "a.geojson")["features"]
    assert [f["properties"] for f in features] == [
        {"id": 0, "number": 7, 'code "100%"': "GR", "depth": 1.5, "checked": True},
        {"id": 1, "number": 8, 'code "100%"': 'é"\\', "depth": None, "checked": False},
        {"id": 2, "number": 9, 'code "100%"': "", "depth": None, "checked": True},
        {"id": 3, "number": 10, 'code "100%"': None, "depth": -0.25, "checked": False},
    ]


def test_an_attribute_called_id_takes_the_place_of_ours(tmp_path):
    survey = ts.Survey(points=hills(3).points, attributes={"id": np.array([5, 6, 7])}, crs=UTM16)
    features = written(survey, tmp_path / "a.geojson")["features"]
    assert [f["properties"] for f in features] == [{"id": 5}, {"id": 6}, {"id": 7}]


def test_an_empty_survey_is_an_empty_collection(tmp_path):
    document = written(ts.Survey(points=np.empty((0, 3)), crs=UTM16), tmp_path / "a.geojson")
    assert document == {"type": "FeatureCollection", "features": []}


def test_progress_rises_to_one(tmp_path, monkeypatch):
    monkeypatch.setattr(features, "_BATCH", 100)
    for kind in ("triangles", "points", "edges", "hull"):
        seen = []
        geojson.write(hills(), tmp_path / "a.geojson", kind=kind, progress=seen.append)
        assert seen == sorted(seen)
        assert seen[-1] == 1.0


# --------------------------------------------------------------------------- bad input


def refused(error, words, surface, path, **options):
    path.write_text("old")
    with pytest.raises(error, match=words) as caught:
        geojson.write(surface, path, **options)
    assert path.read_text() == "old"
    assert "\n" not in str(caught.value)


def test_no_crs_says_how_to_declare_it(tmp_path):
    words = r'declare it, for example `crs="EPSG:32616"`.*projected=True'
    refused(CrsError, words, hills(crs=None), tmp_path / "a.geojson")


def test_metres_declared_as_degrees():
    with pytest.raises(ts.PointsError, match="no longitude and latitude"):
        hills(crs="EPSG:4326")


def test_points_outside_the_domain_of_the_projection(tmp_path):
    tin = ts.triangulate([[1e9, 1e9, 0], [2e9, 1e9, 0], [1e9, 2e9, 0]], crs=UTM16)
    refused(CrsError, "3 points", tin, tmp_path / "a.geojson")


def test_a_surface_about_the_pole(tmp_path):
    points = [[2.0e6, 2.1e6, 0], [1.9e6, 1.9e6, 0], [2.1e6, 1.9e6, 0]]
    tin = ts.triangulate(points, crs="EPSG:32661")
    refused(WriteError, "pole", tin, tmp_path / "a.geojson")


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_survey_with_a_coordinate_that_is_not_finite(tmp_path, value):
    survey = ts.Survey(points=np.array([[5e5, 4e6, 1], [5e5, value, 1]]), crs=UTM16)
    for projected in (False, True):
        words = r"1 point is not finite \(first: point 1"
        refused(WriteError, words, survey, tmp_path / "a.geojson", projected=projected)


def test_a_kind_that_there_is_not(tmp_path):
    refused(
        OptionError,
        "'faces': it must be one of triangles, points, edges, lines, hull",
        *(hills(9), tmp_path / "a.geojson"),
        kind="faces",
    )


def test_triangles_of_a_survey(tmp_path):
    survey = ts.Survey(points=hills(9).points, crs=UTM16)
    refused(FormatError, "triangulate it first", survey, tmp_path / "a.geojson", kind="triangles")


def test_something_that_is_no_surface(tmp_path):
    refused(FormatError, "a list is neither", [[1, 2, 3]], tmp_path / "a.geojson")
