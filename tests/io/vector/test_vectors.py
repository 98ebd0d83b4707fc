"""Lines, rings and water from vector files: what is read is what was written, in the CRS asked."""

import json
import sys
import warnings
from pathlib import Path

import numpy as np
import pyproj
import pytest
import shapely
from support.refusals import refuse as refused

import tinsmith as ts
from tinsmith.io import read_lines, read_rings, read_water, with_lines

pyogrio = pytest.importorskip("pyogrio")

UTM = "EPSG:32616"
CORNER = np.array([752_640.0, 4_024_180.0])
DRIVERS = {
    ".gpkg": "GPKG",
    ".shp": "ESRI Shapefile",
    ".fgb": "FlatGeobuf",
    ".geojson": "GeoJSON",
    ".dxf": "DXF",
    ".gml": "GML",
}
KERB = CORNER + np.array([[0.0, 0.0], [10.0, 1.25], [20.0, 0.5]])
KERB_Z = np.column_stack([KERB, [318.123, 319.5, 320.25]])
SQUARE = CORNER + np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]])
INNER = CORNER + np.array([[10.0, 10.0], [10.0, 20.0], [20.0, 20.0]])


def kind_of(shapes):
    """Name the one type of all shapes, as GDAL does, or none."""
    kinds = {shape.geom_type + (" Z" if shape.has_z else "") for shape in shapes if shape}
    return kinds.pop() if len(kinds) == 1 else "Unknown"


def write(path, shapes, *, crs=UTM, columns=None, layer=None, append=False):
    columns = columns or {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no CRS is what some of these files are about
        pyogrio.raw.write(
            str(path),
            geometry=shapely.to_wkb(np.array(shapes, object)),
            field_data=[np.array(values) for values in columns.values()],
            fields=list(columns),
            geometry_type=kind_of(shapes),
            crs=crs,
            driver=DRIVERS[Path(path).suffix],
            layer=layer,
            append=append,
        )
    return path


def write_json(path, *geometries, crs=None, **properties):
    features = [
        {"type": "Feature", "properties": properties, "geometry": geometry}
        for geometry in geometries
    ]
    document = {"type": "FeatureCollection", "features": features}
    if crs is not None:
        document["crs"] = {"type": "name", "properties": {"name": crs}}
    path.write_text(json.dumps(document))
    return path


# -------------------------------------------------------------------------- geometry


@pytest.mark.parametrize("suffix", [".gpkg", ".shp", ".fgb", ".dxf", ".gml"])
def test_heights_come_back_bit_by_bit(tmp_path, suffix):
    path = write(tmp_path / f"a{suffix}", [shapely.LineString(KERB_Z)])
    (line,) = read_lines(path)
    assert np.array_equal(line.coords, KERB_Z)
    assert (line.kind, line.priority, line.name) == ("hard", 0, "")


def test_geometry_without_heights_is_draped(tmp_path):
    path = write(tmp_path / "a.gpkg", [shapely.LineString(KERB), shapely.LineString(KERB_Z)])
    flat, solid = read_lines(path)
    assert flat.is_draped
    assert np.array_equal(flat.coords, KERB)
    assert not solid.is_draped
    assert all(line.is_draped for line in read_lines(path, drape=True))


def test_measures_are_no_heights(tmp_path):
    wkt = "LINESTRING M (0 0 7, 3 4 8)"
    (tmp_path / "a.csv").write_text(f'WKT,k\n"{wkt}",1\n')
    (line,) = read_lines(tmp_path / "a.csv")
    assert line.coords.tolist() == [[0, 0], [3, 4]]


def test_parts_collections_and_polygons_become_lines_in_their_order(tmp_path):
    shapes = [
        shapely.MultiLineString([KERB, KERB + 5]),
        shapely.Polygon(SQUARE, [INNER]),
        shapely.GeometryCollection(
            [shapely.LineString(KERB + 7), shapely.MultiPolygon([shapely.Polygon(SQUARE + 100)])]
        ),
        shapely.LineString(KERB + 9),
    ]
    names = ["two", "yard", "mixed", "last"]
    path = write(tmp_path / "a.gpkg", shapes, columns={"name": names})
    lines = read_lines(path)
    assert [line.name for line in lines] == ["two", "two", "yard", "yard", "mixed", "mixed", "last"]
    closed = [bool((line.coords[0] == line.coords[-1]).all()) for line in lines]
    assert closed == [False, False, True, True, False, True, False]
    assert np.array_equal(lines[1].coords, KERB + 5)
    assert shapely.Polygon(lines[2].coords).equals(shapely.Polygon(SQUARE))
    assert shapely.Polygon(lines[3].coords).equals(shapely.Polygon(INNER))


def test_arcs_are_followed(tmp_path):
    (tmp_path / "a.csv").write_text('WKT,k\n"CIRCULARSTRING (0 0, 1 1, 2 0)",1\n')
    (line,) = read_lines(tmp_path / "a.csv")
    assert np.hypot(*(line.coords - [1, 0]).T) == pytest.approx(1.0, abs=1e-12)
    assert len(line.coords) > 20


def test_rings_of_polygons_and_closed_lines(tmp_path):
    closed = np.vstack([SQUARE, SQUARE[:1]]) + 50
    shapes = [shapely.Polygon(SQUARE, [INNER]), shapely.LineString(closed)]
    outer, inner, line = read_rings(write(tmp_path / "a.gpkg", shapes))
    assert [len(ring) for ring in (outer, inner, line)] == [4, 3, 4]
    assert shapely.Polygon(outer).equals(shapely.Polygon(SQUARE))
    assert shapely.Polygon(inner).equals(shapely.Polygon(INNER))
    assert np.array_equal(line, closed[:-1])


def test_rings_keep_heights_of_their_own(tmp_path):
    ring = np.column_stack([SQUARE, [1.0, 2.0, 3.0, 4.0]])
    path = write(tmp_path / "a.gpkg", [shapely.Polygon(ring)])
    assert {tuple(p) for p in read_rings(path)[0].tolist()} == {tuple(p) for p in ring.tolist()}
    assert read_rings(path, drape=True)[0].shape == (4, 2)


# --------------------------------------------------------------------------- columns


def test_kind_priority_and_name_are_honoured(tmp_path):
    columns = {
        "Kind": np.array(["Soft", "hard", None], object),
        "PRIORITY": np.array([3.0, np.nan, -2.0]),
        "name": np.array(["a", None, "c"], object),
    }
    path = write(tmp_path / "a.gpkg", [shapely.LineString(KERB)] * 3, columns=columns)
    found = [(line.kind, line.priority, line.name) for line in read_lines(path)]
    assert found == [("soft", 3, "a"), ("hard", 0, ""), ("hard", -2, "c")]
    assert {line.kind for line in read_lines(path, kind="soft")} == {"soft"}


def test_where_and_layer_choose(tmp_path):
    path = tmp_path / "a.gpkg"
    shapes = [shapely.LineString(KERB), shapely.LineString(KERB + 1)]
    write(path, shapes, columns={"name": ["a", "b"]}, layer="kerbs")
    write(path, [shapely.Polygon(SQUARE)], layer="site", append=True)
    assert [line.name for line in read_lines(path, layer="kerbs", where="name = 'b'")] == ["b"]
    assert len(read_rings(path, layer="site")) == 1
    text = refused("has 2 layers", read_lines, path)
    assert "kerbs, site" in text
    refused("no layer 'walls'", read_lines, path, layer="walls")
    refused("no features where name = 'z'", read_lines, path, layer="kerbs", where="name = 'z'")
    refused("cannot be read", read_lines, path, layer="kerbs", where="depth = 3")


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"kind": ["firm"]}, "feature 1 has the kind 'firm': hard or soft"),
        ({"kind": ["water"]}, "kind 'water'"),
        ({"priority": ["high"]}, "priority 'high': a whole number"),
        ({"priority": [1.5]}, "priority '1.5': a whole number"),
    ],
)
def test_a_column_with_another_value(tmp_path, columns, words):
    path = write(tmp_path / "a.gpkg", [shapely.LineString(KERB)], columns=columns)
    refused(words, read_lines, path)


# ----------------------------------------------------------------------------- water


def test_water_takes_its_height_from_where_it_is(tmp_path):
    flat = np.column_stack([SQUARE, np.full(4, 7.5)])
    shapes = [shapely.Polygon(SQUARE), shapely.Polygon(flat)]
    columns = {"Level": [3.25, np.nan], "deep": ["1.5", "2.5"], "name": ["lake", "pool"]}
    path = write(tmp_path / "a.gpkg", shapes, columns=columns)
    assert [(w.name, w.z) for w in read_water(path)] == [("lake", 3.25), ("pool", 7.5)]
    assert [w.z for w in read_water(path, z="DEEP")] == [1.5, 2.5]
    assert [w.z for w in read_water(path, z=9)] == [9.0, 9.0]
    refused("no column 'depth': there is level, deep, name", read_water, path, z="depth")


def test_water_without_one_height_or_with_an_island(tmp_path):
    slope = np.column_stack([SQUARE, [1.0, 2.0, 3.0, 4.0]])
    refused(
        "heights from 1 to 4",
        read_water,
        write(tmp_path / "a.gpkg", [shapely.Polygon(slope)]),
    )
    flat = write(tmp_path / "b.gpkg", [shapely.Polygon(SQUARE)])
    refused("needs one height and has none", read_water, flat)
    island = write(tmp_path / "c.gpkg", [shapely.Polygon(SQUARE, [INNER])])
    refused("has an island", read_water, island, z=3.0)


# ------------------------------------------------------------------------------- CRS


def test_longitude_and_latitude_come_to_utm_to_the_millimetre(tmp_path):
    to_globe = pyproj.Transformer.from_crs(UTM, "OGC:CRS84", always_xy=True)
    degrees = np.column_stack([*to_globe.transform(*KERB.T), KERB_Z[:, 2]]).round(9)
    path = write_json(
        tmp_path / "a.geojson", {"type": "LineString", "coordinates": degrees.tolist()}
    )
    notes = []
    (line,) = read_lines(path, crs=UTM, notes=notes)
    assert line.coords[:, :2] == pytest.approx(KERB, abs=1e-3)
    assert np.array_equal(line.coords[:, 2], KERB_Z[:, 2])
    assert notes == []


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("EPSG:32616+5773", "EPSG:32617"),
        ("EPSG:32616", "EPSG:32617+5703"),
        ("EPSG:32616+5773", "EPSG:32617+5703"),
        ("EPSG:4979", "EPSG:32617+5703"),
    ],
)
def test_heights_are_left_alone_whatever_the_vertical_datum(tmp_path, source, target):
    start = KERB_Z.copy()
    if source == "EPSG:4979":
        to_globe = pyproj.Transformer.from_crs(UTM, "OGC:CRS84", always_xy=True)
        start[:, :2] = np.stack(to_globe.transform(*KERB.T), axis=1)
    path = write(tmp_path / "a.gpkg", [shapely.LineString(start)], crs=source)
    (line,) = read_lines(path, crs=target)
    move = pyproj.Transformer.from_crs(UTM, "EPSG:32617", always_xy=True)
    assert line.coords[:, :2] == pytest.approx(np.stack(move.transform(*KERB.T), axis=1), abs=1e-6)
    assert np.array_equal(line.coords[:, 2], KERB_Z[:, 2])


def test_degrees_need_a_crs_and_the_sentence_names_a_fitting_one(tmp_path):
    coordinates = [[-84.2, 36.3], [-84.1, 36.4]]
    path = write_json(tmp_path / "a.geojson", {"type": "LineString", "coordinates": coordinates})
    refused("EPSG:32616", read_lines, path)


def test_what_is_assumed_of_a_crs_is_noted(tmp_path):
    unknown = write(tmp_path / "a.shp", [shapely.LineString(KERB)], crs=None)
    known = write(tmp_path / "b.gpkg", [shapely.LineString(KERB_Z)])
    notes = []
    assert np.array_equal(read_lines(unknown, crs=UTM, notes=notes)[0].coords, KERB)
    read_lines(known, notes=notes)
    read_lines(known, crs="EPSG:2274", notes=notes)
    assert notes[:2] == [
        "'a.shp' names no CRS: taken to be in EPSG:32616.",
        "'b.gpkg' is in EPSG:32616: taken to be the CRS of the points.",
    ]
    assert "metre" in notes[2]
    assert "US survey foot" in notes[2]


def test_lines_outside_the_domain_of_the_crs(tmp_path):
    coordinates = [[10.0, 95.0], [11.0, 96.0]]
    path = write_json(tmp_path / "a.geojson", {"type": "LineString", "coordinates": coordinates})
    refused("no image", read_lines, path, crs=UTM, error=ts.CrsError)


# --------------------------------------------------------------------- faulty content


def test_a_height_that_is_no_number(tmp_path):
    broken = KERB_Z.copy()
    broken[1, 2] = np.nan
    shapes = [shapely.LineString(KERB_Z), shapely.LineString(broken)]
    path = write(tmp_path / "a.gpkg", shapes)
    text = refused("1 vertex that is not finite", read_lines, path)
    assert "vertex 1 of feature 2" in text
    assert len(read_lines(path, drape=True)) == 2


def test_points_are_no_lines(tmp_path):
    shapes = [shapely.LineString(KERB), shapely.MultiPoint(KERB), shapely.Point(KERB[0])]
    path = write(tmp_path / "a.gpkg", shapes)
    refused("4 points .first: feature 2", read_lines, path)


def test_open_lines_are_no_rings(tmp_path):
    path = write(tmp_path / "a.gpkg", [shapely.Polygon(SQUARE), shapely.LineString(KERB)])
    refused("feature 2 is an open line", read_rings, path)


def test_a_triangulated_surface_is_another_kind(tmp_path):
    (tmp_path / "a.csv").write_text('WKT,k\n"TIN Z (((0 0 1, 1 0 1, 0 1 1, 0 0 1)))",1\n')
    refused("geometry of another kind", read_lines, tmp_path / "a.csv")


def test_features_without_geometry_are_noted_unless_all_are(tmp_path):
    shapes = [shapely.LineString(KERB), None, shapely.LineString()]
    notes = []
    path = write(tmp_path / "a.gpkg", shapes, columns={"name": ["a", "b", "c"]})
    assert [line.name for line in read_lines(path, notes=notes)] == ["a"]
    assert "'a.gpkg': 2 features have no geometry (first: 2)." in notes
    nothing = write_json(tmp_path / "b.geojson", None, None)
    refused("geometry", read_lines, nothing)
    refused("of 2 features, none", read_lines, write(tmp_path / "c.gpkg", [None, None]))


def test_an_empty_layer(tmp_path):
    path = write(tmp_path / "a.gpkg", [])
    refused("no features in layer 'a'", read_lines, path)


@pytest.mark.parametrize("suffix", [".gpkg", ".shp", ".fgb", ".geojson", ".gml"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 0.9])
def test_a_truncated_file(tmp_path, suffix, share):
    whole = write(tmp_path / f"a{suffix}", [shapely.LineString(KERB_Z + k) for k in range(40)])
    content = whole.read_bytes()
    whole.write_bytes(content[: int(share * len(content))])
    refused(f"a{suffix}", read_lines, whole, crs=UTM)


def test_files_that_are_none(tmp_path):
    refused("There is no file", read_lines, tmp_path / "a.gpkg")
    refused("is a folder", read_lines, tmp_path)
    (tmp_path / "a.gpkg").write_text("hello")
    refused("no vector file that GDAL knows", read_lines, tmp_path / "a.gpkg")


def test_without_pyogrio_what_brings_it_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyogrio", None)
    text = refused("pyogrio", read_lines, tmp_path / "a.gpkg", error=ts.MissingExtraError)
    assert "run pip install pyogrio" in text


# ------------------------------------------------------------------------- a survey's


def survey(crs=UTM):
    rng = np.random.default_rng(7)
    xy = CORNER + rng.uniform(-10, 60, (200, 2))
    return ts.Survey(points=np.column_stack([xy, 300 + rng.random(200)]), crs=crs)


def test_a_survey_gains_the_lines_of_files_in_its_crs(tmp_path):
    to_globe = pyproj.Transformer.from_crs(UTM, "OGC:CRS84", always_xy=True)
    ring = np.stack(to_globe.transform(*np.vstack([SQUARE, SQUARE[:1]]).T), axis=1).round(9)
    site = write_json(tmp_path / "s.geojson", {"type": "Polygon", "coordinates": [ring.tolist()]})
    kerbs = write(tmp_path / "k.gpkg", [shapely.LineString(KERB_Z)])
    pond = write(tmp_path / "p.gpkg", [shapely.Polygon(INNER)])
    rings = write(tmp_path / "r.gpkg", [shapely.Polygon(np.column_stack([INNER + 5, [1, 2, 3]]))])
    lined = with_lines(
        survey(),
        breaklines=[kerbs],
        soft_breaklines=[kerbs],
        boundary=[site],
        holes=[rings],
        erase=[rings],
        water=[pond],
        water_z=299.5,
    )
    assert [line.kind for line in lined.breaklines] == ["hard", "soft"]
    assert lined.boundary[0] == pytest.approx(SQUARE, abs=1e-3)
    assert lined.holes[0].shape == (3, 3)
    assert lined.erase[0].shape == (3, 2)
    assert [water.z for water in lined.water] == [299.5]
    assert not survey().has_lines


def test_lines_are_added_to_those_that_a_survey_has(tmp_path):
    kerbs = write(tmp_path / "k.gpkg", [shapely.LineString(KERB_Z)])
    once = with_lines(survey(), breaklines=[kerbs])
    twice = with_lines(once, breaklines=[kerbs, str(kerbs)])
    assert len(twice.breaklines) == 3


def test_a_layer_stands_behind_a_colon(tmp_path):
    path = tmp_path / "a.gpkg"
    write(path, [shapely.LineString(KERB)], layer="kerbs")
    write(path, [shapely.LineString(KERB)] * 2, layer="walls", append=True)
    assert len(with_lines(survey(), breaklines=[f"{path}:walls"]).breaklines) == 2
    odd = write(tmp_path / "b:c.geojson", [shapely.LineString(KERB)], crs="EPSG:32616")
    assert len(with_lines(survey(), breaklines=[odd]).breaklines) == 1
    refused("There is no file", with_lines, survey(), breaklines=[tmp_path / "no.gpkg:walls"])


def test_lines_far_from_the_points_have_the_wrong_crs(tmp_path):
    degrees = write(
        tmp_path / "a.shp", [shapely.LineString([(-84.2, 36.3), (-84.1, 36.4)])], crs=None
    )
    notes = with_lines(survey(), breaklines=[degrees]).notes
    assert any("taken to be degrees of WGS 84" in note for note in notes)
    far = CORNER + np.array([[9e4, 9e4], [9.01e4, 9.01e4]])
    beside = write(tmp_path / "b.shp", [shapely.LineString(far)], crs=None)
    refused("nowhere near the points", with_lines, survey(), breaklines=[beside])


def test_lines_of_our_own_geojson_come_back(tmp_path):
    inside = np.column_stack([CORNER + np.array([[0, 0], [30, 30]]), [300.0, 301.0]])
    built = ts.triangulate(survey(), breaklines=[ts.Breakline(inside, kind="soft", name="a")])
    ts.write(built, tmp_path / "a.geojson", kind="lines")
    (line,) = read_lines(tmp_path / "a.geojson", crs=UTM)
    assert (line.kind, line.name) == ("soft", "a")
    (chain,) = built.lines.chains()
    assert line.coords == pytest.approx(built.points[chain], abs=1e-3)


# -------------------------------------------------------------- elevations and their units


def write_kml(path, mode):
    """Five points; elements as Google Earth writes them."""
    told = "" if mode is None else f"<altitudeMode>{mode}</altitudeMode>"
    marks = "".join(
        f"<Placemark><Point>{told}<coordinates>{-84.5 + 0.002 * i},{36.3 + 0.001 * i * i},{300 + i}"
        "</coordinates></Point></Placemark>"
        for i in range(5)
    )
    path.write_text(
        f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{marks}</Document></kml>'
    )
    return path


@pytest.mark.parametrize("mode", ["relativeToGround", "clampToGround"])
def test_heights_above_ground_of_kml_are_no_elevations(tmp_path, mode):
    with pytest.raises(ts.ReadError, match=f"no elevations.*altitudeMode {mode}"):
        ts.read(write_kml(tmp_path / "a.kml", mode), crs=UTM)


def test_elevations_of_kml_are_absolute_or_told(tmp_path):
    found = ts.read(write_kml(tmp_path / "a.kml", "absolute"), crs=UTM)
    assert (found.points[:, 2].min(), found.notes) == (300, [])
    (note,) = ts.read(write_kml(tmp_path / "b.kml", None), crs=UTM).notes
    assert "without an altitudeMode" in note


@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "parquet", "geojson"])
def test_lines_have_the_unit_that_their_layer_tells(tmp_path, suffix):
    """As points of the same file have it."""
    metres = survey()
    feet = ts.triangulate(metres.points / [1, 1, 0.3048], crs=UTM, elevation_unit="ft")
    path, options = tmp_path / f"lines.{suffix}", {}
    if suffix == "geojson":
        options = {"projected": True}
    ts.write(ts.contours(feet, interval=0.5), path, **options)
    notes = []
    lines = read_lines(path, crs=UTM, target_unit="m", notes=notes)
    elevations = np.concatenate([line.coords[:, 2] for line in lines])
    assert metres.points[:, 2].min() <= elevations.min()
    assert elevations.max() <= metres.points[:, 2].max()
    assert any("converted from foot to metre" in note for note in notes)
    with pytest.raises(ts.OptionError, match="foot"):
        read_lines(path, crs=UTM, elevation_unit="m")


def test_a_column_of_elevations_that_lines_do_not_take_is_told(tmp_path):
    lines = [shapely.LineString(KERB_Z[:, :2]), shapely.LineString(KERB_Z[:, :2] + 5)]
    path = write(tmp_path / "a.gpkg", lines, columns={"ELEV": [300.0, 301.0]})
    notes = []
    read_lines(path, crs=UTM, notes=notes)
    assert any("not from the column 'elev'" in note for note in notes)
    read_lines(path, crs=UTM, notes=(quiet := []), drape=True)
    assert not any("column" in note for note in quiet)
