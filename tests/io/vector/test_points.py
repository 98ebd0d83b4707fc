"""Points, lines and triangles of vector layers become surveys and TINs, in any CRS."""

import contextlib
import json
import sqlite3
import warnings

import numpy as np
import pyproj
import pytest
import shapely
from support import refusals

import tinsmith as ts
from tinsmith.io import CrsError, OptionError, ReadError, read, write

pyogrio = pytest.importorskip("pyogrio")

UTM = "EPSG:32616"
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])
FORMATS = (".gpkg", ".fgb", ".shp", ".parquet")
DRIVERS = {".gpkg": "GPKG", ".fgb": "FlatGeobuf", ".shp": "ESRI Shapefile", ".gml": "GML",
           ".geojson": "GeoJSON", ".geojsonl": "GeoJSONSeq", ".kml": "KML"}  # fmt: skip


def make_points(n=50, seed=1):
    return (CORNER + np.random.default_rng(seed).random((n, 3)) * (200, 100, 30)).round(3)


def in_order(points):
    """Return points in the order of their elevations: FlatGeobuf has an order of its own."""
    return points[np.argsort(points[:, 2])]


def by_ogr(path, shapes, *, crs=UTM, layer=None, append=False, **columns):
    """Write a layer as another program does."""
    shapes = np.array(shapes, object)
    names = {shape.geom_type + (" Z" if shape.has_z else "") for shape in shapes if shape}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pyogrio.raw.write(
            str(path),
            geometry=shapely.to_wkb(shapes, flavor="iso"),
            field_data=[np.array(values) for values in columns.values()],
            fields=list(columns),
            geometry_type=names.pop() if len(names) == 1 else "Unknown",
            crs=crs,
            driver=DRIVERS[path.suffix],
            layer=layer,
            append=append,
        )
    return path


def refuse(path, error=ReadError, **options):
    return refusals.refuse("", read, path, error=error, **options)


# ------------------------------------------------------------------------------ points


@pytest.mark.parametrize("suffix", [".gpkg", ".fgb", ".shp", ".gml"])
def test_points_of_another_program(tmp_path, suffix):
    points = make_points()
    numbers, codes = np.arange(50), np.array(["EP", "FL"] * 25)
    path = by_ogr(tmp_path / f"p{suffix}", shapely.points(points), Number=numbers, Code=codes)
    survey = read(path)
    order = np.argsort(survey.attributes["Number"])
    assert np.array_equal(survey.points[order], points)
    assert survey.attributes["Code"][order].tolist() == codes.tolist()
    assert survey.crs == UTM
    assert survey.source == path.name


def test_points_of_one_feature_have_its_attributes(tmp_path):
    points = make_points(6)
    shapes = [shapely.multipoints(points[:4]), shapely.multipoints(points[4:])]
    survey = read(by_ogr(tmp_path / "m.gpkg", shapes, run=np.array([7, 9])))
    assert np.array_equal(survey.points, points)
    assert survey.attributes["run"].tolist() == [7, 7, 7, 7, 9, 9]


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_survey_comes_back(tmp_path, suffix):
    points = make_points()
    attributes = {
        "number": np.arange(50),
        "code": np.array(["a", None, "ä"] * 17, object)[:50],
        "weight": np.linspace(0, 1, 50).round(3),
    }
    survey = ts.Survey(points=points, attributes=attributes, crs="EPSG:2274", elevation_unit="ft")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if suffix == ".shp" else "error")
        write(survey, tmp_path / f"s{suffix}")
    found = read(tmp_path / f"s{suffix}")
    order = np.argsort(found.attributes["number"])
    assert np.array_equal(found.points[order], points)
    for name, values in attributes.items():
        assert found.attributes[name][order].tolist() == values.tolist()
    assert found.crs == "EPSG:2274"
    assert found.elevation_unit == (None if suffix == ".shp" else survey.elevation_unit)


def test_several_layers_are_listed_and_one_is_chosen(tmp_path):
    path = tmp_path / "two.gpkg"
    by_ogr(path, shapely.points(make_points(3)), layer="spots")
    by_ogr(path, shapely.points(make_points(4)), layer="crown", append=True)
    assert "spots, crown" in refuse(path)
    assert len(read(path, layer="crown")) == 4
    assert "no layer 'nothing'" in refuse(path, layer="nothing")


def test_a_condition_chooses_features(tmp_path):
    path = by_ogr(tmp_path / "p.gpkg", shapely.points(make_points(9)), k=np.arange(9))
    assert read(path, where="k > 5").attributes["k"].tolist() == [6, 7, 8]


# -------------------------------------------------------------------------- elevations


def flat(n=5):
    return shapely.points(make_points(n)[:, :2])


def test_a_column_of_a_plain_name_holds_the_elevations_and_that_is_told(tmp_path):
    heights = np.array([5.0, 6, 7, 8, 9])
    survey = read(by_ogr(tmp_path / "p.gpkg", flat(), Elev=heights))
    assert survey.points[:, 2].tolist() == heights.tolist()
    assert survey.notes == ["Elevations are those of the column 'elev'."]


@pytest.mark.parametrize(
    ("name", "unit"),
    [("Elev (ft NAVD88)", "foot"), ("Cota", None), ("elevation_us_ft", "US survey foot")],
)
def test_a_column_of_elevations_is_named_as_in_survey_text(tmp_path, name, unit):
    points = make_points(9)
    shapes = [shapely.Point(x, y) for x, y, _ in points]
    found = read(by_ogr(tmp_path / "a.gpkg", shapes, **{name: points[:, 2]}))
    assert found.points[:, 2].tolist() == points[:, 2].tolist()
    assert (found.elevation_unit and found.elevation_unit.name) == unit


@pytest.mark.parametrize(
    "name", ["Z (sdev)", "-Z", "Z (depth)", "geoid height", "Height_instrument"]
)
def test_a_column_whose_name_says_more_than_elevation_is_none(tmp_path, name):
    shapes = [shapely.Point(x, y) for x, y, _ in make_points(9)]
    path = by_ogr(tmp_path / "a.gpkg", shapes, **{name: np.arange(9.0)})
    assert "no column of numbers with such a name" in refuse(path)


def test_no_elevations_are_refused(tmp_path):
    path = by_ogr(tmp_path / "p.gpkg", flat(), depth_of_well=np.arange(5.0))
    assert "depth_of_well" in refuse(path)
    assert read(path, z_field="depth_of_well").points[:, 2].tolist() == [0, 1, 2, 3, 4]
    assert "geometry" in refuse(path, z_field="geometry")
    assert "nothing" in refuse(path, OptionError, z_field="nothing")


def test_a_geometry_and_a_column_that_differ_are_refused_until_told(tmp_path):
    points = make_points(5)
    path = by_ogr(tmp_path / "p.gpkg", shapely.points(points), elevation=points[:, 2] + 1.5)
    message = refuse(path)
    assert "'geometry' or 'elevation'" in message
    assert np.array_equal(read(path, z_field="geometry").points, points)
    assert np.array_equal(read(path, z_field="Elevation").points[:, 2], points[:, 2] + 1.5)


def test_a_geometry_of_zeros_beside_a_column_is_refused_too(tmp_path):
    points = make_points(5) * (1, 1, 0)
    assert "differ" in refuse(
        by_ogr(tmp_path / "p.gpkg", shapely.points(points), z=np.arange(1, 6))
    )


def test_a_rounded_column_does_no_harm(tmp_path):
    points = make_points(5)
    path = by_ogr(tmp_path / "p.gpkg", shapely.points(points), z=points[:, 2].round(2))
    assert np.array_equal(read(path).points, points)


def test_columns_that_differ_are_refused_and_those_that_agree_are_one(tmp_path):
    first, second = np.arange(5.0), np.arange(5.0) + 1
    assert "z, height" in refuse(by_ogr(tmp_path / "a.gpkg", flat(), z=first, height=second))
    survey = read(by_ogr(tmp_path / "b.gpkg", flat(), z=first, height=first))
    assert survey.points[:, 2].tolist() == first.tolist()


def test_features_without_an_elevation_are_left_out_and_counted(tmp_path):
    heights = np.array([5.0, np.nan, 7, np.nan, 9])
    survey = read(by_ogr(tmp_path / "p.gpkg", flat(), z=heights, k=np.arange(5)))
    assert survey.attributes["k"].tolist() == [0, 2, 4]
    assert survey.skipped == {"features without an elevation": 2}


def test_some_geometries_without_elevation_are_refused(tmp_path):
    points = make_points(4)
    shapes = [*shapely.points(points[:3]), shapely.points(points[3, :2])]
    assert "without an elevation" in refuse(by_ogr(tmp_path / "p.gpkg", shapes))


def test_a_unit_is_that_of_the_file_or_told(tmp_path):
    points = make_points(4)
    path = by_ogr(tmp_path / "p.gpkg", shapely.points(points))
    assert read(path).elevation_unit is None
    assert read(path, elevation_unit="ft").elevation_unit.name == "foot"
    compound = by_ogr(tmp_path / "q.gpkg", shapely.points(points), crs="EPSG:32616+5703")
    assert read(compound).elevation_unit.name == "metre"
    assert "metre" in refuse(compound, OptionError, elevation_unit="ft")


# ------------------------------------------------------------------------------- lines


def contours(tmp_path, name="c.gpkg"):
    ring = CORNER[:2] + np.array([[0, 0], [30, 0], [30, 30], [0, 30], [0, 0]])
    inner = CORNER[:2] + np.array([[10, 10], [20, 10], [20, 20], [10, 10]])
    shapes = [shapely.linestrings(ring), shapely.linestrings(inner)]
    return by_ogr(tmp_path / name, shapes, elev=np.array([310.0, 320.0]), name=["a", "b"])


def test_lines_need_to_be_told_what_they_are(tmp_path):
    assert "lines_as" in refuse(contours(tmp_path))
    assert "lines_as" in refuse(contours(tmp_path), OptionError, lines_as="ridges")


def test_contours_as_points_and_as_breaklines(tmp_path):
    path = contours(tmp_path)
    points = read(path, lines_as="points")
    assert len(points) == 7  # a closed ring has its first vertex once
    assert sorted(set(points.points[:, 2].tolist())) == [310, 320]
    assert not points.breaklines
    lines = read(path, lines_as="breaklines")
    assert np.array_equal(lines.points, points.points)
    assert [len(one.coords) for one in lines.breaklines] == [5, 4]
    assert [one.name for one in lines.breaklines] == ["a", "b"]
    tin = ts.triangulate(lines)
    assert ts.check(tin).ok
    assert tin.constrained.any()


def test_points_and_lines_in_one_layer_are_refused(tmp_path):
    points = make_points(4)
    shapes = [shapely.points(points[0]), shapely.linestrings(points[1:])]
    assert "both points and lines" in refuse(by_ogr(tmp_path / "m.gpkg", shapes), lines_as="points")


# ------------------------------------------------------------------------------ a TIN


def make_tin():
    points = make_points(80)
    line = ts.Breakline(points[[3, 9]] + (0.5, 0.25, 0.125), name="kerb")
    return ts.triangulate(ts.Survey(points=points, crs=UTM), breaklines=[line])


def corner_set(tin, decimals=6):
    return {
        tuple(sorted(map(tuple, tin.points[row].round(decimals).tolist()))) for row in tin.triangles
    }


@pytest.mark.parametrize("suffix", [".fgb", ".shp", ".parquet"])
def test_triangles_come_back_as_the_tin(tmp_path, suffix):
    tin = make_tin()
    write(tin, tmp_path / f"t{suffix}")
    found = read(tmp_path / f"t{suffix}")
    assert isinstance(found, ts.TIN)
    assert corner_set(found, 12) == corner_set(tin, 12)
    assert len(found.points) == len(tin.points)
    assert found.crs == UTM
    assert ts.check(found, level=2).ok


def test_triangles_of_geojson_keep_their_vertices_and_are_reprojected_when_told(tmp_path):
    tin = make_tin()
    write(tin, tmp_path / "t.geojson")
    assert UTM in refuse(tmp_path / "t.geojson")
    found = read(tmp_path / "t.geojson", crs=UTM)
    assert corner_set(found, 2).__len__() == len(tin.triangles)
    distance = np.abs(found.points[:, None] - tin.points).max(axis=2).min(axis=1)
    assert distance.max() < 2e-4
    assert any("reprojected" in note for note in found.report.notes)
    write(tin, tmp_path / "p.geojson", projected=True)
    exact = read(tmp_path / "p.geojson")
    assert corner_set(exact, 12) == corner_set(tin, 12)
    assert exact.crs == UTM


@pytest.mark.parametrize("suffix", [".fgb", ".shp", ".parquet", ".geojsonl"])
@pytest.mark.parametrize("kind", ["points", "edges", "lines", "hull"])
def test_other_kinds_are_read_by_ogr_as_they_were_written(tmp_path, suffix, kind):
    tin = make_tin()
    path = tmp_path / f"k{suffix}"
    with warnings.catch_warnings():
        if suffix == ".shp":
            warnings.simplefilter("ignore", ts.LossWarning)  # of a name of ten bytes
        write(tin, path, kind=kind)
    counts = {"points": len(tin.points), "edges": len(tin.edges), "lines": 1, "hull": 1}
    if suffix == ".parquet":
        geopandas = pytest.importorskip("geopandas")
        frame = geopandas.read_parquet(path)
        shapes, crs = frame.geometry.to_numpy(), frame.crs
    else:
        meta, _, wkb, _ = pyogrio.raw.read(path)
        shapes, crs = shapely.from_wkb(wkb), meta["crs"]
    assert len(shapes) == counts[kind]
    assert shapely.has_z(shapes).all()
    if suffix != ".geojsonl":
        assert pyproj.CRS(crs) == pyproj.CRS(UTM)
        expected = {"points": tin.points, "hull": tin.points}.get(kind)
        if kind == "hull":
            assert shapes[0].area == pytest.approx(tin.area, rel=1e-12)
        elif expected is not None:
            found = shapely.get_coordinates(shapes, include_z=True)
            assert np.array_equal(np.unique(found, axis=0), np.unique(expected, axis=0))


def test_triangles_have_the_area_and_slope_of_geojson(tmp_path):
    tin = make_tin()
    write(tin, tmp_path / "t.geojson")
    write(tin, tmp_path / "t.fgb")
    told = {
        one["properties"]["id"]: one["properties"]
        for one in json.loads((tmp_path / "t.geojson").read_text())["features"]
    }
    meta, _, _, columns = pyogrio.raw.read(tmp_path / "t.fgb")
    found = dict(zip(meta["fields"].tolist(), columns, strict=True))
    for row, number in enumerate(found["id"].tolist()):
        assert found["area"][row] == pytest.approx(told[number]["area"], rel=1e-8)
        assert found["slope"][row] == pytest.approx(told[number]["slope"], abs=1e-4)


# ----------------------------------------------------------------------------- GeoJSON


@pytest.mark.parametrize("projected", [False, True])
def test_geojson_gives_back_the_points_that_were_written(tmp_path, projected):
    survey = ts.Survey(
        points=make_points(), crs=UTM, elevation_unit="ft", attributes={"code": np.arange(50)}
    )
    write(survey, tmp_path / "s.geojson", projected=projected)
    found = read(tmp_path / "s.geojson", crs=UTM)
    if projected:
        assert np.array_equal(found.points, survey.points)
        assert found.elevation_unit.name == "foot"
    else:
        assert np.abs(found.points[:, :2] - survey.points[:, :2]).max() < 2e-4
        assert np.abs(found.points[:, 2] - survey.points[:, 2] * 0.3048).max() < 1e-6
        assert found.elevation_unit.name == "metre"


def test_a_crs_of_null_is_not_known(tmp_path):
    survey = ts.Survey(points=make_points())
    write(survey, tmp_path / "s.geojson", projected=True)
    found = read(tmp_path / "s.geojson")
    assert found.crs is None
    assert np.array_equal(found.points, survey.points)
    assert read(tmp_path / "s.geojson", crs=UTM).crs == UTM
    line = {"type": "Feature", "properties": {}, "geometry": {
        "type": "LineString", "coordinates": survey.points[:3].tolist()}}  # fmt: skip
    (tmp_path / "l.geojson").write_text(
        json.dumps({"type": "FeatureCollection", "features": [line], "crs": None})
    )
    (found,) = ts.io.read_lines(tmp_path / "l.geojson", crs=UTM)
    assert np.array_equal(found.coords, survey.points[:3])


def test_the_undefined_cartesian_crs_of_a_geopackage_has_no_unit(tmp_path):
    survey = ts.Survey(points=make_points())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        write(survey, tmp_path / "s.gpkg")
    with contextlib.closing(sqlite3.connect(tmp_path / "s.gpkg")) as base:
        for table in ("gpkg_contents", "gpkg_geometry_columns"):
            base.execute(f"UPDATE {table} SET srs_id = -1")
        base.commit()
    found = read(tmp_path / "s.gpkg")
    assert np.array_equal(found.points, survey.points)
    assert found.crs is None
    assert found.elevation_unit is None
    told = read(tmp_path / "s.gpkg", crs=UTM, elevation_unit="ft")
    assert told.crs == UTM
    assert told.elevation_unit.name == "foot"


def test_a_sequence_with_separators(tmp_path):
    points = make_points(3)
    degrees = ts.transform_points(points, UTM, "EPSG:4326")
    places = [{"type": "Point", "coordinates": one} for one in degrees.tolist()]
    lines = [json.dumps({"type": "Feature", "properties": {}, "geometry": one}) for one in places]
    (tmp_path / "s.geojsonl").write_text("".join(f"\x1e{line}\n" for line in lines))
    found = read(tmp_path / "s.geojsonl", crs=UTM)
    assert np.abs(found.points - points).max() < 1e-5
    assert found.elevation_unit.name == "metre"


# ---------------------------------------------------------------------------- GeoParquet


def test_geoparquet_of_geopandas_with_native_points_and_without_crs(tmp_path):
    geopandas = pytest.importorskip("geopandas")
    points = make_points(9)
    frame = geopandas.GeoDataFrame(
        {"code": ["x"] * 9, "k": range(9)}, geometry=shapely.points(points), crs=UTM
    )
    for encoding in ("WKB", "geoarrow"):
        frame.to_parquet(tmp_path / "p.parquet", geometry_encoding=encoding, schema_version="1.1.0")
        found = read(tmp_path / "p.parquet")
        assert np.array_equal(found.points, points)
        assert found.attributes["k"].tolist() == list(range(9))
        assert found.crs == UTM
    frame.set_crs(None, allow_override=True).to_parquet(tmp_path / "n.parquet")
    assert read(tmp_path / "n.parquet").crs is None


def test_parquet_without_geometries_is_refused(tmp_path):
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    parquet.write_table(pyarrow.table({"a": [1.0]}), tmp_path / "t.parquet")
    assert "geometries" in refuse(tmp_path / "t.parquet")


# ---------------------------------------------------------------------------- axis order


@pytest.mark.each_value
@pytest.mark.parametrize("suffix", [".gpkg", ".fgb", ".shp", ".gml", ".geojson"])
@pytest.mark.parametrize(
    ("crs", "easting", "northing", "longitude", "latitude"),
    [
        ("EPSG:2193", 1_748_745.0, 5_427_614.0, 174.7762, -41.2887),  # Wellington; northing first
        ("EPSG:31467", 3_513_000.0, 5_404_000.0, 9.1755, 48.7733),  # Stuttgart; northing first
        ("EPSG:3812", 649_690.0, 670_350.0, 4.3632, 50.8457),  # Brussels; easting first
        ("EPSG:2180", 637_000.0, 486_500.0, 21.0, 52.2311),  # Warsaw; northing first
    ],
)
def test_northing_first_crs_have_easting_first_here(
    tmp_path, suffix, crs, easting, northing, longitude, latitude
):
    points = np.array([easting, northing, 40.0]) + make_points(5) - CORNER
    path = by_ogr(tmp_path / f"p{suffix}", shapely.points(points), crs=crs)
    if suffix == ".geojson":  # GDAL writes it in degrees
        survey = read(path, crs=crs)
        assert np.abs(in_order(survey.points) - in_order(points)).max() < 0.02
    else:
        survey = read(path)
        assert np.abs(in_order(survey.points) - in_order(points)).max() < 1e-6
    assert survey.crs == crs
    degrees = ts.transform_points([[easting, northing, 0.0]], crs, "EPSG:4326")[0]
    assert degrees[:2] == pytest.approx([longitude, latitude], abs=0.05)


def test_degrees_are_longitude_first_whatever_the_file_says(tmp_path):
    points = make_points(5)
    degrees = ts.transform_points(points, UTM, "EPSG:4326")
    for suffix in (".gpkg", ".fgb", ".gml", ".geojson"):
        path = by_ogr(tmp_path / f"p{suffix}", shapely.points(degrees), crs="EPSG:4326")
        assert UTM in refuse(path)
        found = read(path, crs=UTM).points
        assert np.abs(in_order(found) - in_order(points)).max() < 2e-2


def test_points_outside_the_earth_are_refused_not_wrapped(tmp_path):
    path = by_ogr(tmp_path / "p.gpkg", shapely.points(make_points(3)), crs="EPSG:4326")
    refuse(path, CrsError, crs=UTM)
