"""GeoPackages hold the layers of several programs: what tinsmith did not write stays."""

import os
import shutil
import sqlite3
import subprocess
from contextlib import closing

import numpy as np
import pytest
import shapely
from support.commands import refuse, run_command

import tinsmith as ts

pyogrio = pytest.importorskip("pyogrio")
geopandas = pytest.importorskip("geopandas")

X, Y = np.divmod(np.arange(100.0), 10)
TIN = ts.triangulate(
    np.column_stack([700_000 + X, 4_000_000 + Y, 320 + X + 0.1 * Y]),
    crs="EPSG:32616",
    elevation_unit="m",
)
LINES = ts.contours(TIN, 1.0)
CLASSES = ts.slope_classes(TIN)


@pytest.fixture
def project(tmp_path):
    """Return a GeoPackage of another program: parcels in another CRS, a table, a style, a view."""
    path = tmp_path / "project.gpkg"
    boxes = [shapely.box(i, i, i + 1, i + 1) for i in range(5)]
    frame = geopandas.GeoDataFrame({"owner": list("abcde")}, geometry=boxes, crs=2056)
    frame.to_file(path, layer="parcels")
    with closing(sqlite3.connect(path)) as file:
        file.execute("CREATE TABLE layer_styles (id INTEGER PRIMARY KEY, style TEXT)")
        file.execute("INSERT INTO layer_styles VALUES (1, 'red')")
        file.execute("CREATE VIEW owners AS SELECT owner FROM parcels")
        file.commit()
    return path


def dump(path, layers=("parcels", "layer_styles", "owners")):
    """Return what SQLite finds in some tables, and what the registers say of them."""
    with closing(sqlite3.connect(path)) as file:
        found = [file.execute(f"SELECT * FROM {name}").fetchall() for name in layers]
        marks = ", ".join("?" * len(layers))
        for register in ("gpkg_contents", "gpkg_geometry_columns", "gpkg_ogr_contents"):
            query = f"SELECT * FROM {register} WHERE table_name IN ({marks}) ORDER BY 1"
            found.append(file.execute(query, layers).fetchall())
        boxes = file.execute("SELECT * FROM rtree_parcels_geom ORDER BY id").fetchall()
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert file.execute("PRAGMA foreign_key_check").fetchall() == []
    return found, boxes


def list_layers(path):
    return sorted(name for name, _ in pyogrio.list_layers(path))


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_products_and_a_tin_share_a_file_with_others(project, order):
    before = dump(project)
    writes = (
        lambda: ts.write(LINES, project),
        lambda: ts.write(CLASSES, project, layer="steepness"),
        lambda: ts.write(TIN, project),
    )
    for i in order:
        writes[i]()
    assert dump(project) == before
    assert ts.read(project) == TIN
    assert {"contours", "steepness", "triangles", "parcels"} <= set(list_layers(project))
    for name, features in (("contours", LINES), ("steepness", CLASSES)):
        found = geopandas.read_file(project, layer=name)
        assert len(found) == len(features)
        assert found.crs.to_epsg() == 32616
        want = features.to_geodataframe()
        assert shapely.equals(found.geometry.values, want.geometry.values).all()
        part = tuple(want.total_bounds[:2]) + tuple(want.total_bounds[:2] + 3)
        assert len(geopandas.read_file(project, layer=name, bbox=part)) == sum(
            want.intersects(shapely.box(*part))
        )


def test_what_tinsmith_wrote_is_replaced_and_gives_the_same_file(tmp_path):
    path, again = tmp_path / "a.gpkg", tmp_path / "b.gpkg"
    ts.write(LINES, path)
    shutil.copy(path, again)
    ts.write(LINES, again)
    assert path.read_bytes() == again.read_bytes()
    ts.write(ts.contours(TIN, 2.0), again)
    assert len(geopandas.read_file(again)) == len(ts.contours(TIN, 2.0))


def test_a_layer_of_another_program_is_refused_unless_it_is_meant(project):
    before = project.read_bytes()
    with pytest.raises(ts.WriteError, match="'parcels' was not written by tinsmith"):
        ts.write(LINES, project, layer="parcels")
    with pytest.raises(ts.WriteError, match="'parcels' was not"):
        ts.write(LINES, project, layer="Parcels")
    assert project.read_bytes() == before
    ts.write(LINES, project, layer="parcels", overwrite=True)
    assert len(geopandas.read_file(project, layer="parcels")) == len(LINES)


def test_a_layer_that_was_edited_since_is_refused(tmp_path):
    path = tmp_path / "a.gpkg"
    ts.write(LINES, path)
    frame = geopandas.read_file(path, layer="contours")
    frame.to_file(path, layer="contours", mode="a")
    with pytest.raises(ts.WriteError, match="changed by another program"):
        ts.write(LINES, path)
    assert len(geopandas.read_file(path)) == 2 * len(LINES)
    ts.write(LINES, path, overwrite=True)
    assert len(geopandas.read_file(path)) == len(LINES)


def test_layers_of_a_tin_are_no_layers_for_features(tmp_path):
    path = ts.write(TIN, tmp_path / "site.gpkg")
    with pytest.raises(ts.WriteError, match="'lines' is part of the TIN"):
        ts.write(LINES, path, layer="lines", overwrite=True)
    other = tmp_path / "other.gpkg"
    geopandas.GeoDataFrame(geometry=[shapely.Point(0, 0)], crs=32616).to_file(other, layer="lines")
    with pytest.raises(ts.WriteError, match="'lines' was not written by tinsmith"):
        ts.write(TIN, other)


def test_features_are_appended_to_a_layer_of_the_same_kind(project):
    before = dump(project)
    low, high = ts.contours(TIN, levels=[322.5]), ts.contours(TIN, levels=[325.5, 327.5])
    for part in (low, high):
        ts.write(part, project, layer="levels", append=True)
    found = geopandas.read_file(project, layer="levels")
    assert sorted(found["elevation"]) == [322.5, 325.5, 327.5]
    assert pyogrio.read_info(project, layer="levels")["features"] == 3
    assert (
        len(geopandas.read_file(project, layer="levels", bbox=(7e5, 4e6, 700_009, 4_000_009))) == 3
    )
    with pytest.raises(ts.WriteError, match="Cannot append to the layer 'levels'"):
        ts.write(CLASSES, project, layer="levels", append=True)
    with pytest.raises(ts.WriteError, match="'parcels' was not written"):
        ts.write(low, project, layer="parcels", append=True)
    assert dump(project) == before


@pytest.mark.parametrize("layer", ["", " ", 5, "gpkg_contents", "rtree_a", "sqlite_master"])
def test_a_name_that_is_none_is_refused(tmp_path, layer):
    with pytest.raises(ts.OptionError, match="layer"):
        ts.write(LINES, tmp_path / "a.gpkg", layer=layer)
    assert list(tmp_path.iterdir()) == []


def test_names_that_sql_would_read_are_names(tmp_path):
    path = tmp_path / "a.gpkg"
    for name in ('a "b"', "x'; DROP TABLE gpkg_contents; --", "select", "höhe"):
        ts.write(LINES, path, layer=name)
        ts.write(LINES, path, layer=name)
        assert len(geopandas.read_file(path, layer=name)) == len(LINES)


def test_what_is_no_geopackage_is_not_replaced(tmp_path):
    path = tmp_path / "notes.gpkg"
    path.write_text("my notes")
    for what in (LINES, TIN):
        with pytest.raises(ts.WriteError, match="no GeoPackage"):
            ts.write(what, path)
    assert path.read_text() == "my notes"
    assert [one.name for one in tmp_path.iterdir()] == ["notes.gpkg"]


def test_a_failed_write_leaves_the_file_whole(project, monkeypatch):
    from tinsmith.io.mesh.geopackage import existing_layers

    def fail(*_):
        raise sqlite3.OperationalError("database or disk is full")

    before = project.read_bytes()
    monkeypatch.setattr(existing_layers, "_register", fail)
    for what in (LINES, TIN):
        with pytest.raises(ts.WriteError, match="disk is full"):
            ts.write(what, project)
    assert project.read_bytes() == before
    assert [one.name for one in project.parent.iterdir()] == ["project.gpkg"]


def test_a_locked_file_is_told(project):
    with closing(sqlite3.connect(project, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(ts.WriteError, match=r"locked|open in another program"):
            ts.write(LINES, project)


def test_one_crs_with_another_number_is_found_again(tmp_path):
    """GDAL numbers a CRS of no authority itself; two of them must not be taken for one."""
    path = tmp_path / "a.gpkg"
    local = "+proj=tmerc +lat_0=10 +lon_0={} +x_0=500000 +units=m +type=crs"
    geopandas.GeoDataFrame(geometry=[shapely.Point(1, 2)], crs=local.format(3)).to_file(
        path, layer="theirs"
    )
    ours = ts.contours(TIN.replace(crs=local.format(7)), 1.0)
    for name in ("first", "second"):
        ts.write(ours, path, layer=name)
        assert geopandas.read_file(path, layer=name).crs == ours.crs.to_wkt()
    assert geopandas.read_file(path, layer="theirs").crs != ours.crs.to_wkt()
    lined = ts.triangulate(TIN.points, breaklines=[TIN.points[[0, 55, 99]]])
    lined = lined.replace(crs=local.format(7))
    lined.insert([[700_004.5, 4_000_004.5, 9.0]])
    ts.write(lined, path)
    assert ts.read(path).edits == lined.edits
    assert ts.read(path).report.notes == lined.report.notes
    with closing(sqlite3.connect(path)) as file:
        numbers = dict(file.execute("SELECT table_name, srs_id FROM gpkg_contents"))
    assert numbers["first"] == numbers["second"] != numbers["theirs"]


@pytest.mark.skipif(shutil.which("ogrinfo") is None, reason="needs GDAL's programs")
def test_commands_name_layers(project, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = dump(project)
    ts.write(TIN, "site.gpkg")
    both = ("-o", "project.gpkg:low", "-o", "project.gpkg:high")
    run_command("contours", "site.gpkg", "--interval", 1, *both)
    run_command("slope", "site.gpkg", "-o", "project.gpkg:slope")
    run_command("contours", "site.gpkg", "--interval", 1, "-o", "site.gpkg:contours")
    assert dump(project) == before
    assert {"low", "high", "slope"} <= set(list_layers(project))
    assert ts.read("site.gpkg") == TIN
    told = subprocess.run(
        ["ogrinfo", "-q", "site.gpkg"], capture_output=True, text=True, check=True
    )
    assert "contours" in told.stdout
    assert "was not written by tinsmith" in refuse(
        "contours", "site.gpkg", "--interval", 1, "-o", "project.gpkg:parcels"
    )
    assert "part of the TIN" in refuse(
        "contours", "site.gpkg", "--interval", 1, "-o", "site.gpkg:lines", "--overwrite"
    )
    assert "takes no name of a layer" in refuse("refine", "site.gpkg", "-o", "a.gpkg:mesh")
    assert "--append" in refuse("contours", "site.gpkg", "--interval", 1, "-o", "a.dxf", "--append")
    assert "named twice" in refuse("slope", "site.gpkg", "-o", "a.gpkg:b", "-o", "a.gpkg:b")
    run_command("slope", "site.gpkg", "-o", "project.gpkg:parcels", "--overwrite")
    assert "parcels" in list_layers(project)


def test_a_file_of_the_whole_name_is_meant(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ts.write(TIN, "site.ply")
    name = "a.gpkg:b.gpkg" if os.name != "nt" else "a.gpkg"
    shutil.copy(ts.write(LINES, "c.gpkg"), name)
    run_command("contours", "site.ply", "--interval", 2, "-o", name)
    assert len(geopandas.read_file(tmp_path / name)) == len(ts.contours(TIN, 2.0))


SINGLE = [
    one
    for one in ts.known_formats()
    if one.write is not None and one.name not in ("gpkg", "tin") and one.is_built_in
]


@pytest.mark.parametrize("one", SINGLE, ids=lambda one: one.name)
def test_other_formats_hold_one_thing_and_have_no_layers(one, tmp_path):
    """Their files are replaced as a whole; who names a layer is told."""
    things = {"TIN": TIN, "Features": LINES, "Survey": ts.Survey(points=TIN.points, crs=TIN.crs)}
    things |= {"Raster": ts.rasterize(TIN, spacing=1.0), "Table": ts.volume(TIN, base=320.0)}
    path = tmp_path / f"out{next(iter(one.suffixes), '')}"
    thing = next(things[kind] for kind in one.writes if kind in things)
    for option in ({"layer": "a"}, {"append": True}, {"overwrite": True}):
        with pytest.raises(ts.TinsmithError, match=next(iter(option))):
            ts.write(thing, path, format=one.name, **option)
    assert list(tmp_path.iterdir()) == []


def test_layers_have_the_form_that_older_programs_read(tmp_path):
    """Milliseconds in the time of change, and the triggers of the version before 1.4."""
    path = ts.write(LINES, tmp_path / "a.gpkg")
    with closing(sqlite3.connect(path)) as file:
        times = [row[0] for row in file.execute("SELECT last_change FROM gpkg_contents")]
        (version,) = file.execute("PRAGMA user_version").fetchone()
        rows = file.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'")
        triggers = {row[0] for row in rows}
    assert times == ["1970-01-01T00:00:00.000Z"]
    assert version == 10300
    assert {f"rtree_contours_geom_{name}" for name in ("insert", "update1", "delete")} <= triggers


def test_the_name_of_a_format_that_two_share_is_told_apart_by_content(tmp_path):
    points = np.array([[752700, 4024200, 320], [752710, 4024200, 321], [752700, 4024210, 322.0]])
    ts.write(ts.Survey(points=points, crs="EPSG:32616"), tmp_path / "points.gpkg")
    ts.write(ts.triangulate(points, crs="EPSG:32616"), tmp_path / "tin.gpkg")
    assert isinstance(ts.read(tmp_path / "points.gpkg", format="gpkg"), ts.Survey)
    assert isinstance(ts.read(tmp_path / "tin.gpkg", format="gpkg"), ts.TIN)
    with pytest.raises(ts.ReadError, match="no GeoPackage of a TIN"):
        ts.read(tmp_path / "points.gpkg", format="tin")
