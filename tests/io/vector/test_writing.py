"""Features written, and read back by GDAL, GeoPandas and plain JSON."""

from __future__ import annotations

import json
import math
import warnings

import geopandas
import numpy as np
import pyogrio
import pytest
import shapely

import tinsmith as ts
from tinsmith.base.errors import CrsError, FormatError, LossWarning, WriteError
from tinsmith.io.vector.shapefile import short_names

UTM = np.array([500_000.1, 4_000_000.7])
SQUARE = np.array([[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]], float)
HOLE = np.array([[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]], float)
COLUMNS = {
    "level": np.array([0.1 + 0.2, 1e-3 / 3]),
    "number": np.array([2**53 - 1, -7]),
    "kind": np.array(["höhe, 'ß'", None], object),
    "flag": np.array([True, False]),
}
UNITS = {"level": ts.Unit.of("ft"), "number": None}
VECTOR = [".gpkg", ".fgb", ".shp"]
KINDS = ["points", "lines", "multilines", "polygons", "multipolygons"]


def features(kind, *, flat=False, crs="EPSG:32616", **about):
    """Two features, of which the first has two parts if there are several."""
    rings = np.concatenate([SQUARE, HOLE, SQUARE + 10, SQUARE + 20]) + UTM
    heights = [0.25, 1, 2, 3, 0.25, 5, 6, 7, 8, 5, *(range(5, 9)), 5, *range(5, 9), 5]
    xyz = rings if flat else np.column_stack([rings, heights])
    given = {"crs": crs, "elevation_unit": "m", "name": kind, **about}
    given = {"columns": COLUMNS, "units": UNITS, **given}
    if kind == "points":
        return ts.Features.of_points(xyz[:2], **given)
    if kind == "lines":
        return ts.Features.of_lines(xyz[:10], [0, 5, 10], **given)
    if kind == "multilines":
        return ts.Features.of_lines(xyz, [0, 5, 10, 20], [0, 2, 3], **given)
    if kind == "polygons":
        return ts.Features.of_polygons(xyz[:15], [0, 5, 10, 15], [0, 2, 3], **given)
    return ts.Features.of_polygons(xyz, [0, 5, 10, 15, 20], [0, 2, 3, 4], [0, 2, 3], **given)


def quietly(action, *args, **given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LossWarning)
        return action(*args, **given)


def by_number(frame):
    return frame.sort_values("number", ascending=False).reset_index(drop=True)


# ------------------------------------------------------------------------------ GDAL


@pytest.mark.parametrize("suffix", VECTOR)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("flat", [False, True])
def test_what_gdal_reads_back(tmp_path, kind, suffix, flat):
    made = features(kind, flat=flat)
    path = quietly(ts.write, made, tmp_path / f"a{suffix}")
    frame = by_number(geopandas.read_file(path))
    assert frame.crs == "EPSG:32616"
    expected = made.to_shapely()
    if suffix == ".shp":  # a single part is no multi-part there, and rings begin where they like
        expected, found = shapely.normalize(expected), shapely.normalize(frame.geometry.values)
        assert all(
            a.equals_exact(b, 0) or a.equals(b) for a, b in zip(expected, found, strict=True)
        )
        coordinates = [
            np.unique(shapely.get_coordinates(shape, include_z=not flat), axis=0)
            for shape in (expected, np.asarray(found))
        ]
        np.testing.assert_array_equal(*coordinates)
    else:
        assert shapely.equals_identical(expected, frame.geometry.values).all()
    assert shapely.has_z(frame.geometry.values).all() == (not flat)
    np.testing.assert_allclose(frame["level"], COLUMNS["level"], atol=5e-16, rtol=0)
    assert frame["number"].tolist() == COLUMNS["number"].tolist()
    assert frame["kind"].iloc[0] == COLUMNS["kind"][0]
    assert frame["kind"].isna().tolist() == [False, True]
    assert frame["flag"].tolist() == [True, False]


@pytest.mark.parametrize("suffix", [".gpkg", ".fgb"])
def test_layers_are_named_after_the_product_and_tell_units(tmp_path, suffix):
    made = features("lines", name="contours", elevation_unit=None, notes=["One.", "Two."])
    path = ts.write(made, tmp_path / f"a{suffix}")
    assert pyogrio.list_layers(path)[:, 0].tolist() == ["contours"]
    mark = {"written by": "tinsmith"} if suffix == ".gpkg" else {}
    assert pyogrio.read_info(path)["layer_metadata"] == mark | {
        "elevation_unit": "unknown",
        "unit of level": "ft",
        "unit of number": "unknown",
        "notes": "One. Two.",
    }
    unnamed = ts.write(features("lines", name=""), tmp_path / f"b{suffix}")
    assert pyogrio.list_layers(unnamed)[:, 0].tolist() == ["b"]


@pytest.mark.parametrize("suffix", [".gpkg", ".fgb"])
def test_elevations_that_are_not_known_stay_so(tmp_path, suffix):
    made = ts.Features.of_lines([[0, 0, 1.5], [1, 0, math.nan]], [0, 2], crs="EPSG:32616")
    found = geopandas.read_file(ts.write(made, tmp_path / f"a{suffix}")).geometry.iloc[0]
    np.testing.assert_array_equal(shapely.get_coordinates(found, include_z=True), made.coordinates)


@pytest.mark.parametrize("suffix", [*VECTOR, ".geojson"])
@pytest.mark.parametrize("kind", KINDS)
def test_no_features(tmp_path, kind, suffix):
    empty = np.empty((0, 3))
    offsets = {"points": (), "lines": ([0],), "multilines": ([0], [0])}.get(kind, ([0], [0]))
    offsets = ([0], [0], [0]) if kind == "multipolygons" else offsets
    make = getattr(ts.Features, f"of_{kind.removeprefix('multi')}")
    made = make(empty, *offsets, columns={"a": np.empty(0)}, crs="EPSG:32616")
    path = quietly(ts.write, made, tmp_path / f"a{suffix}")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Measured")  # of a shapefile with elevations
        assert len(geopandas.read_file(path)) == 0


@pytest.mark.parametrize("suffix", VECTOR)
@pytest.mark.parametrize(
    "crs", [None, "EPSG:2274", "EPSG:2274+6360", "EPSG:32616+5703", "EPSG:4326", "EPSG:28992+5709"]
)
def test_the_crs_comes_back(tmp_path, suffix, crs):
    made = ts.Features.of_points([[1.0, 2.0, 3.0]], crs=crs)
    found = pyogrio.read_info(quietly(ts.write, made, tmp_path / f"a{suffix}"))["crs"]
    assert found is None if crs is None else ts.CRS(found).is_same(crs)


@pytest.mark.parametrize("suffix", [*VECTOR, ".geojson"])
def test_the_same_features_give_the_same_bytes(tmp_path, suffix):
    contents = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        quietly(ts.write, features("polygons"), tmp_path / folder / f"x{suffix}")
        contents.append({p.name: p.read_bytes() for p in (tmp_path / folder).iterdir()})
    assert contents[0] == contents[1]


# ------------------------------------------------------------------------------ shapefiles


def test_a_shapefile_tells_what_it_loses(tmp_path):
    columns = {"elevation_mean": [1.0, 2.0], "elevation_max": [3.0, 4.0]}
    made = ts.Features.of_points(
        [[0, 0], [1, 1]], columns=columns, units={"elevation_max": "m"}, notes=["Why."]
    )
    with pytest.warns(LossWarning) as told:
        ts.write(made, tmp_path / "a.shp")
    text = str(told[0].message)
    assert "'elevation_mean' is 'elevation_'" in text
    assert "'elevation_max' is 'elevatio_2'" in text
    assert "units" in text
    assert "notes" in text
    frame = geopandas.read_file(tmp_path / "a.shp")
    assert frame["elevation_"].tolist() == [1, 2]
    assert frame["elevatio_2"].tolist() == [3, 4]


def test_nothing_is_told_where_nothing_is_lost(tmp_path):
    ts.write(ts.Features.of_points([[0, 0]], columns={"a": [1.0]}), tmp_path / "a.shp")


def test_short_names_are_unique():
    names = ["ELEVATION_1", "elevation_2", "elevation_", "é" * 9, "ok", "OK", "x" * 10]
    short = short_names(names)
    assert len({name.casefold() for name in short}) == len(names)
    assert all(len(name.encode()) <= 10 for name in short)
    many = short_names([f"elevation_{k}" for k in range(150)])
    assert len(set(many)) == 150
    assert max(len(name) for name in many) == 10


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"a": ["x" * 255]}, "text of 255 bytes"),
        ({"a": [1e22]}, "the number 1e+22"),
        ({"a": [math.inf]}, "not finite"),
        ({"a": [10**18]}, "the number 1000000000000000000"),
        ({f"c{k}": [0] for k in range(256)}, "256 columns"),
    ],
)
def test_what_a_shapefile_has_no_room_for(tmp_path, columns, words):
    with pytest.raises(WriteError) as caught:
        ts.write(ts.Features.of_points([[0, 0]], columns=columns), tmp_path / "a.shp")
    assert words in str(caught.value)
    assert ".gpkg" in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_shapefile_has_no_word_for_unknown_elevations(tmp_path):
    with pytest.raises(WriteError, match="elevations are not known"):
        ts.write(ts.Features.of_points([[0, 0, math.nan]]), tmp_path / "a.shp")


def test_parts_of_an_earlier_shapefile_are_removed(tmp_path):
    for part in ("qix", "sbn", "prj", "shp.xml"):
        (tmp_path / f"a.{part}").write_text("stale")
    (tmp_path / "a.txt").write_text("mine")
    ts.write(ts.Features.of_points([[0, 0]]), tmp_path / "a.shp")
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "a.cpg",
        "a.dbf",
        "a.shp",
        "a.shx",
        "a.txt",
    ]


# ------------------------------------------------------------------------------ refusals


def test_a_geopackage_that_is_open_elsewhere(tmp_path):
    (tmp_path / "a.gpkg-wal").write_text("")
    with pytest.raises(WriteError, match="open in another program"):
        ts.write(features("points"), tmp_path / "a.gpkg")


@pytest.mark.parametrize("name", ["fid", "FID", "geom"])
def test_names_that_a_geopackage_has_itself(tmp_path, name):
    made = ts.Features.of_points([[0, 0]], columns={name: [1]})
    with pytest.raises(WriteError, match=name):
        ts.write(made, tmp_path / "a.gpkg")


def test_names_that_differ_by_capitals(tmp_path):
    made = ts.Features.of_points([[0, 0]], columns={"a": [1], "A": [2]})
    with pytest.raises(WriteError, match="there twice"):
        ts.write(made, tmp_path / "a.gpkg")


@pytest.mark.parametrize("suffix", VECTOR)
def test_whole_numbers_that_would_wrap_around(tmp_path, suffix):
    made = ts.Features.of_points([[0, 0]], columns={"a": np.array([2**63], np.uint64)})
    with pytest.raises(WriteError):
        ts.write(made, tmp_path / f"a{suffix}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [*VECTOR, ".geojson"])
def test_a_failed_write_leaves_the_old_file(tmp_path, suffix, monkeypatch):
    path = tmp_path / f"a{suffix}"
    path.write_text("old")

    def fail(*_args, **_given):
        raise RuntimeError("no space; left")

    monkeypatch.setattr("tinsmith.base.results.geometries.build_geometries", fail)
    monkeypatch.setattr("tinsmith.io.vector.ogr.build_geometries", fail)
    monkeypatch.setattr("tinsmith.io.vector.ogr.encode_equal_shapes", fail)
    monkeypatch.setattr("tinsmith.io.vector.geojson.features._format_features", fail)
    with pytest.raises((WriteError, RuntimeError), match="no space"):
        quietly(ts.write, features("lines"), path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("kind", "suffix", "words"),
    [
        ("lines", ".tif", "GeoTIFF holds a Raster, not Features"),
        ("lines", ".csv", "CSV holds points, not lines"),
        ("lines", ".ply", "not Features"),
        ("lines", ".nothing", "unknown suffix"),
    ],
)
def test_formats_that_do_not_fit(tmp_path, kind, suffix, words):
    with pytest.raises(FormatError) as caught:
        ts.write(features(kind), tmp_path / f"a{suffix}")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_geojson_kinds_are_for_surfaces(tmp_path):
    with pytest.raises(FormatError, match="kind"):
        ts.write(features("lines"), tmp_path / "a.geojson", kind="hull")


# ------------------------------------------------------------------------------ GeoJSON


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("flat", [False, True])
def test_geojson_in_degrees(tmp_path, kind, flat):
    made = features(kind, flat=flat)
    path = ts.write(made, tmp_path / "a.geojson")
    frame = geopandas.read_file(path)
    expected = made.to_geodataframe().to_crs("OGC:CRS84").geometry
    for one, other in zip(frame.geometry, expected, strict=True):
        assert one.geom_type == other.geom_type
        np.testing.assert_allclose(
            shapely.get_coordinates(one, include_z=not flat),
            shapely.get_coordinates(other, include_z=not flat),
            atol=1e-9,
        )
    assert frame["level"].tolist() == COLUMNS["level"].tolist()
    document = json.loads(path.read_text())
    assert document["name"] == kind
    assert document["units"] == {"level": "ft", "number": "unknown"}
    assert [one["properties"]["kind"] for one in document["features"]] == ["höhe, 'ß'", None]
    assert len(document["bbox"]) == (4 if flat else 6)


@pytest.mark.parametrize("kind", KINDS)
def test_geojson_in_the_crs_keeps_every_digit(tmp_path, kind):
    made = features(kind)
    path = ts.write(made, tmp_path / "a.geojson", projected=True)
    frame = geopandas.read_file(path)
    assert frame.crs == "EPSG:32616"
    assert shapely.equals_identical(frame.geometry.values, made.to_shapely()).all()


def test_geojson_elevations_become_metres(tmp_path):
    made = ts.Features.of_points([[1.75e6, 6e5, 1000.0]], crs="EPSG:2274", elevation_unit="ft")
    position = position_of(ts.write(made, tmp_path / "a.geojson"))
    assert position[2] == 304.8
    unknown = ts.Features.of_points([[1.75e6, 6e5, 1000.0]], crs="EPSG:2274")
    document = json.loads(ts.write(unknown, tmp_path / "b.geojson").read_text())
    assert "US survey foot" in document["elevations"]


def position_of(path):
    return json.loads(path.read_text())["features"][0]["geometry"]["coordinates"]


def test_geojson_has_two_numbers_where_the_elevation_is_not_known(tmp_path):
    made = ts.Features.of_lines([[9, 50, 1.5], [9, 51, math.nan]], [0, 2], crs="EPSG:4326")
    path = ts.write(made, tmp_path / "a.geojson")
    assert position_of(path) == [[9.0, 50.0, 1.5], [9.0, 51.0]]
    assert "bbox" not in json.loads(path.read_text())


def test_geojson_has_no_word_for_numbers_that_are_not_finite(tmp_path):
    made = ts.Features.of_points(
        [[9, 50]] * 3, columns={"a": [math.nan, math.inf, 1.0]}, crs="EPSG:4326"
    )
    document = json.loads(ts.write(made, tmp_path / "a.geojson").read_text())
    assert [one["properties"]["a"] for one in document["features"]] == [None, None, 1.0]


def test_geojson_rings_turn_as_rfc_7946_says_also_on_a_mirrored_map(tmp_path):
    """Eastings that grow to the west: the counter-clockwise ring runs clockwise on Earth."""
    lo = "+proj=tmerc +lat_0=0 +lon_0=25 +ellps=WGS84 +units=m +axis=wsu"
    made = features("polygons", crs=lo, flat=True)
    path = ts.write(made, tmp_path / "a.geojson")
    for shape in geopandas.read_file(path).geometry:
        assert shape.exterior.is_ccw
        assert not any(ring.is_ccw for ring in shape.interiors)


def test_geojson_without_a_crs_is_refused(tmp_path):
    with pytest.raises(CrsError, match="not known"):
        ts.write(features("points", crs=None), tmp_path / "a.geojson")
    ts.write(features("points", crs=None), tmp_path / "a.geojson", projected=True)


def test_progress_ends_with_all(tmp_path):
    seen = []
    ts.write(features("lines"), tmp_path / "a.geojson", progress=seen.append)
    assert seen[-1] == 1.0
