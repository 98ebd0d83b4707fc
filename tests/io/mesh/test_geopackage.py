"""A whole TIN as a GeoPackage: it comes back bit for bit, and damaged files are refused."""

from __future__ import annotations

import json
import sqlite3
import xml.etree.ElementTree as ET
from contextlib import closing

import numpy as np
import pytest
from support.each_value import list_seeds
from support.same_tins import find_differences

import tinsmith as ts
from tinsmith.io.mesh.geopackage import writing
from tinsmith.io.mesh.geopackage.schema import digest_arrays

CRSES = [
    "EPSG:32616",
    "EPSG:2274+6360",  # compound, in feet
    None,
    "EPSG:4326",
    "+proj=tmerc +lat_0=10.1 +lon_0=3 +k=0.9996 +x_0=123.25 +units=m +type=crs",  # no code
    'ENGCRS["Site",EDATUM["Site"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],'
    'LENGTHUNIT["metre",1]]',
]


def make_tin(seed=1, **more):
    """Return a TIN with every kind of line, merges, crossings and rows left out."""
    points = np.random.default_rng(seed).integers(0, 60, (300, 3)).astype(float)
    given = {
        "breaklines": [
            ts.Breakline([[1, 1, 3], [50, 40, 5.0]], name="kerb & wall", priority=2),
            ts.Breakline([[1, 50], [55, 2.0]], kind="soft", name="Böschung"),
            ts.Breakline([[5, 30, 1], [45, 31, 1 / 3]]),
        ],
        "water": [ts.Water([[10, 10], [20, 10], [20, 20], [10, 20]], 0.1, name="pond")],
        "boundary": [[[0, 0], [58, 0], [58, 58], [0, 58]]],
        "holes": [[[40, 45], [50, 45], [45, 52]]],
        "erase": [[[30, 5], [35, 5], [33, 9]]],
        "snap": 0.5,
    }
    return ts.triangulate(points, **(given | more))


def edit(tin):
    tin.insert([[30.5, 30.5, 9], [31.25, 12.125, 1e-9]], duplicates="mean")
    tin.add_breakline([[5, 5, 1], [40, 6, 2.0]], name="new", crossing="split")
    tin.set_elevation([3, 7], [77, -1])
    tin.remove_breakline(2)


def reread(tin, path):
    return ts.read(ts.write(tin, path))


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.gpkg"


@pytest.mark.parametrize("crs", CRSES)
def test_all_comes_back_bit_for_bit(path, crs):
    tin = make_tin(crs=crs, elevation_unit=None if crs and "+" in crs[:10] else "US survey foot")
    found = reread(tin, path)
    assert find_differences(tin, found) == []
    assert found.report.to_dict() == tin.report.to_dict()
    assert (found.crs, found.elevation_unit) == (tin.crs, tin.elevation_unit)
    assert found.lines.names == tin.lines.names
    assert len(found.report.notes) == len(tin.report.notes)


@pytest.mark.parametrize("seed", list_seeds(4, few=2))
def test_edits_go_on_as_they_would_have(path, seed):
    tin = make_tin(seed, crossing="split", max_edge=None if seed % 2 else 30.0)
    found = reread(tin, path)
    for one in (tin, found):
        edit(one)
    assert find_differences(tin, found) == []
    again = reread(found, path)
    assert find_differences(tin, again) == []
    assert [one.to_dict() for one in again.edits] == [one.to_dict() for one in tin.edits]
    for count in (1, 3):
        tin.undo(count)
        again.undo(count)
        assert find_differences(tin, again) == []


def test_existing_triangles_and_their_edits_come_back(path):
    built = ts.triangulate([[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 5, 4.0]])
    tin = ts.TIN.from_triangles(built.points, built.triangles[:, [1, 2, 0]], crs=32616)
    assert find_differences(tin, reread(tin, path)) == []
    tin.insert([[1, 2, 3.0]])
    found = reread(tin, path)
    assert find_differences(tin, found) == []
    tin.undo()
    found.undo()
    assert find_differences(tin, found) == []


def test_a_refined_and_a_clipped_surface_come_back(path):
    tin = ts.refine(make_tin(), min_angle=25)
    assert find_differences(tin, reread(tin, path)) == []


def test_masked_rows_and_what_a_survey_says_come_back(path):
    rows = np.ma.masked_equal([[0, 0, 1], [4, 0, 2], [4, 4, 9], [0, 5, 4], [9, 9, 9.0]], 9.0)
    survey = ts.Survey(points=rows, notes=["guessed"], skipped={"nodata cells": 3})
    for tin in (ts.triangulate(survey), ts.triangulate(rows)):
        assert find_differences(tin, reread(tin, path)) == []


def test_copies_of_what_was_read_are_edited_alike(path):
    import copy
    import pickle

    tin = make_tin()
    edit(tin)
    found = reread(tin, path)
    for twin in (copy.copy(found), pickle.loads(pickle.dumps(found))):
        twin.undo(4)
        assert find_differences(make_tin(), twin) == []
    assert len(found.edits) == 4


NUMBERS = "SELECT fid, a, b, c, constrained FROM triangles ORDER BY fid"


def list_kinds(path):
    with closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert file.execute("PRAGMA foreign_key_check").fetchall() == []
        kinds = dict(file.execute("SELECT name, type FROM sqlite_master WHERE type <> 'index'"))
        return kinds | dict(file.execute("SELECT table_name, data_type FROM gpkg_contents"))


@pytest.mark.parametrize("is_there", [False, True])
def test_a_compact_file_holds_all_without_polygons(path, tmp_path, is_there):
    tin = make_tin(crs=32616)
    edit(tin)
    whole = ts.write(tin, tmp_path / "whole.gpkg")
    if is_there:  # the polygons of a file that is there go, a layer of another product stays
        ts.write(ts.contours(tin, interval=20.0), path)
        ts.write(make_tin(2, crs=32616), path)
    found = ts.read(ts.write(tin, path, compact=True))
    assert find_differences(tin, found) == []
    found.undo(2)
    tin.undo(2)
    assert find_differences(tin, found) == []
    kinds = list_kinds(path)
    assert (kinds["triangles"], kinds["tinsmith_triangles"]) == ("features", "table")
    assert ("contours" in kinds) == is_there
    with closing(sqlite3.connect(path)) as file, closing(sqlite3.connect(whole)) as other:
        assert file.execute(NUMBERS).fetchall() == other.execute(NUMBERS).fetchall()


def test_triangles_of_a_compact_file_are_the_polygons_of_a_whole_one(path, tmp_path):
    """The view puts the same coordinates together; only the box that may precede them lacks."""
    tin = make_tin(crs=32616)
    ts.write(ts.contours(make_tin(2), interval=20.0), path)  # the CRS of the TIN gets a number
    ts.write(tin, path, compact=True)
    whole = ts.write(tin, tmp_path / "whole.gpkg")
    found = []
    for name in (path, whole):
        with closing(sqlite3.connect(name)) as file:
            query = "SELECT typeof(geom), geom FROM triangles ORDER BY fid"
            found.append([shape for kind, shape in file.execute(query) if kind == "blob"])
    assert len(found[0]) == len(found[1]) == len(tin.triangles)
    headers = {shape[:8] for shape in found[0]}
    assert headers == {b"GP\0\1" + (32616).to_bytes(4, "little")}
    assert [shape[8:] for shape in found[0]] == [shape[40:] for shape in found[1]]


@pytest.mark.parametrize("layer", ["triangles", "vertices"])
def test_gdal_reads_the_layers_of_a_compact_file(path, tmp_path, layer):
    import pyogrio

    tin = make_tin(crs=32616)
    ts.write(tin, path, compact=True)
    whole = ts.write(tin, tmp_path / "whole.gpkg")
    kinds = dict(pyogrio.list_layers(path))
    assert kinds["triangles"] == "Polygon Z"
    one, two = (pyogrio.raw.read(name, layer=layer) for name in (path, whole))
    assert one[0]["crs"] == two[0]["crs"] == "EPSG:32616"
    assert one[2].tolist() == two[2].tolist()
    box = (*tin.points[:, :2].min(axis=0), *tin.points[:, :2].mean(axis=0))
    few = [pyogrio.raw.read(name, layer=layer, bbox=box)[2] for name in (path, whole)]
    assert few[0].tolist() == few[1].tolist()
    assert 0 < len(few[0]) < len(one[2])


def test_polygons_take_the_place_of_a_view_and_a_view_theirs(path):
    tin = make_tin(crs=32616)
    ts.write(ts.contours(tin, interval=20.0), path)
    for is_compact in (True, False, False, True):
        ts.write(tin, path, compact=is_compact)
        kinds = list_kinds(path)
        assert ("tinsmith_triangles" in kinds) == is_compact
        assert {"contours", "triangles", "vertices", "tinsmith_tin"} <= set(kinds)
        assert find_differences(tin, ts.read(path)) == []
    ts.write(tin, path.with_name("alone.gpkg"), compact=True)
    ts.write(tin, path.with_name("alone.gpkg"))
    assert "tinsmith_triangles" not in list_kinds(path.with_name("alone.gpkg"))


def test_a_compact_file_of_the_first_kind_is_read(path):
    """It had the numbers as a table ``triangles``, and no view."""
    tin = make_tin(crs=32616)
    edit(tin)
    ts.write(tin, path, compact=True)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("DROP VIEW triangles")
        file.execute("PRAGMA writable_schema = ON")
        file.execute(
            "UPDATE sqlite_master SET name = 'triangles', tbl_name = 'triangles', "
            "sql = replace(replace(sql, 'tinsmith_triangles', 'triangles'), ', geom POLYGON', '') "
            "WHERE name = 'tinsmith_triangles'"
        )
    assert find_differences(tin, ts.read(path)) == []
    ts.write(tin, path, compact=True, overwrite=True)
    assert find_differences(tin, ts.read(path)) == []
    assert list_kinds(path)["triangles"] == "features"


def test_a_view_of_numbers_is_refused(path):
    """Only tables are read; what a view of another file calls is never run."""
    ts.write(make_tin(), path, compact=True)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("DROP VIEW triangles")
        file.execute("ALTER TABLE tinsmith_triangles RENAME TO other")
        file.execute("CREATE VIEW tinsmith_triangles AS SELECT * FROM other")
    with pytest.raises(ts.ReadError, match="no table 'triangles'"):
        ts.read(path)


def test_the_same_tin_gives_the_same_bytes(tmp_path):
    for name in ("a.gpkg", "b.gpkg"):
        ts.write(make_tin(), tmp_path / name)
    assert (tmp_path / "a.gpkg").read_bytes() == (tmp_path / "b.gpkg").read_bytes()


def test_reference_can_be_declared_where_there_is_none(path):
    ts.write(make_tin(), path)
    found = ts.read(path, crs=32616, elevation_unit="ft")
    assert (found.crs, found.elevation_unit) == ("EPSG:32616", ts.Unit.of("ft"))
    edit(found)
    ts.write(make_tin(crs=32616), path)
    with pytest.raises(ts.CrsError, match="another CRS"):
        ts.read(path, crs=32617)


def list_styles(path):
    query = "SELECT f_table_name, owner, useAsDefault FROM layer_styles ORDER BY f_table_name, id"
    with closing(sqlite3.connect(path)) as file:
        return file.execute(query).fetchall()


def test_styles_are_written_anew_and_those_of_a_user_stay(path):
    names = ["boundary", "lines", "triangles", "vertices", "water"]
    ts.write(make_tin(), path)
    assert list_styles(path) == [(name, "tinsmith", 1) for name in names]
    keep = (
        "INSERT INTO layer_styles (f_table_name, styleName, styleQML, useAsDefault, owner) "
        "VALUES ('lines', 'mine', '<qgis/>', 1, 'me')"
    )
    change(path, keep)
    for _ in range(2):
        ts.write(make_tin(2), path)
        rest = [(name, "tinsmith", 1) for name in names if name != "lines"]
        assert sorted(list_styles(path)) == sorted(
            [("lines", "me", 1), ("lines", "tinsmith", 0), *rest]
        )
    assert find_differences(make_tin(2), ts.read(path)) == []


@pytest.mark.parametrize("span", [1e-9, 0.03, 1.0, 7.5, 119.0, 1e6])
def test_classes_of_elevations_are_few_and_round(path, span):
    rows = np.random.default_rng(3).random((40, 3)) * (9.0, 9.0, span) + (0.0, 0.0, 100.0)
    ts.write(ts.triangulate(rows), path)
    with closing(sqlite3.connect(path)) as file:
        query = "SELECT styleQML FROM layer_styles WHERE f_table_name = 'triangles'"
        (text,) = file.execute(query).fetchone()
    ranges = list(ET.fromstring(text.partition(">")[2]).iter("range"))
    assert 1 <= len(ranges) <= 12
    limits = [float(one.get("upper")) for one in ranges][:-1]
    assert limits == sorted(set(limits))
    assert [float(one.get("lower")) for one in ranges[1:]] == limits
    assert all(rows[:, 2].min() < one < rows[:, 2].max() for one in limits)


# ------------------------------------------------------------------ changed and damaged files


def change(path, *statements):
    with closing(sqlite3.connect(path)) as file, file:
        for one in statements:
            file.execute(*one) if isinstance(one, tuple) else file.execute(one)


def load(path, name):
    with closing(sqlite3.connect(path)) as file:
        query = "SELECT data FROM tinsmith_tin WHERE name = ?"
        return json.loads(file.execute(query, (name,)).fetchone()[0])


def rewrite_document(path, alter):
    """Alter the document as one would who knows how digests are made."""
    document, digests = load(path, "document"), load(path, "digests")
    alter(document)
    text = json.dumps(document)
    with closing(sqlite3.connect(path)) as file:
        rows = file.execute("SELECT type, shape, data FROM tinsmith_tin WHERE type <> 'json'")
        arrays = [
            np.frombuffer(data, kind).reshape([int(axis) for axis in shape.split()])
            for kind, shape, data in rows
        ]
    digests["record"] = digest_arrays(*arrays, text=text)
    update = "UPDATE tinsmith_tin SET data = ? WHERE name = ?"
    change(path, (update, (text.encode(), "document")))
    change(path, (update, (json.dumps(digests).encode(), "digests")))


def test_what_another_program_changed_is_read_and_told(path):
    tin = make_tin(crs=32616)
    ts.write(tin, path)
    change(path, "DELETE FROM triangles WHERE fid = 5")
    found = ts.read(path)
    assert len(found.triangles) == len(tin.triangles) - 1
    assert len(found.lines) == 0
    assert found.crs == tin.crs
    assert "changed by another program" in found.report.notes[-1]
    ts.write(tin, path)
    change(path, "UPDATE lines SET name = 'other'")
    assert "changed by another program" in ts.read(path).report.notes[-1]


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("DELETE FROM vertices WHERE vertex = 5", "no point with z of number 5"),
        ("UPDATE vertices SET geom = x'00' WHERE vertex = 3", "no point with z of number 3"),
        ("UPDATE triangles SET a = 9999 WHERE fid = 2", "row 2 of the layer 'triangles'"),
        ("UPDATE triangles SET a = -1 WHERE fid = 2", "row 2 of the layer 'triangles'"),
        ("UPDATE triangles SET a = 'x' WHERE fid = 2", "no whole number"),
        ("UPDATE triangles SET b = a WHERE fid = 2", "holds no TIN"),
        ("DELETE FROM triangles", "'triangles'"),
        ("DELETE FROM tinsmith_tin", "has no document"),
        ("UPDATE tinsmith_tin SET data = x'00' WHERE name = '0'", "damaged at '0'"),
        ("UPDATE tinsmith_tin SET shape = '99999999999' WHERE name = '0'", "damaged at '0'"),
        ("UPDATE tinsmith_tin SET type = 'O' WHERE name = '0'", "damaged at '0'"),
        ("UPDATE tinsmith_tin SET data = x'7b7d' WHERE name = 'document'", "not as written"),
        ("UPDATE tinsmith_tin SET data = x'5b' WHERE name = 'document'", "no JSON object"),
        ("DROP TABLE lines", "no table 'lines'"),
    ],
)
def test_damaged_files_are_refused(path, statement, reason):
    ts.write(make_tin(), path)
    change(path, statement)
    with pytest.raises(ts.ReadError) as caught:
        ts.read(path)
    assert reason in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_view_in_place_of_a_table_is_refused(path):
    ts.write(make_tin(), path)
    change(
        path,
        "ALTER TABLE vertices RENAME TO moved",
        "CREATE VIEW vertices AS SELECT vertex, geom FROM moved",
    )
    with pytest.raises(ts.ReadError, match="no table 'vertices'"):
        ts.read(path)


@pytest.mark.parametrize(
    "alter",
    [
        lambda document: document["lines"].update(type="BuildInputs"),
        lambda document: document["lines"].update(type="os"),
        lambda document: document.update(vertex_of=document["lines"]["offsets"]),
        lambda document: document["report"].update(n_rows=3),
        lambda document: document["report"].update(merged_rows=document["vertex_of"]),
        lambda document: document.pop("report"),
        lambda document: document["lines"].update(vertices={"array": "nothing"}),
        lambda document: document["lines"].update(kinds={"tuple": ["river"] * 9}),
        lambda document: document["inputs"]["lines"].update(offsets=document["vertex_of"]),
        lambda document: document["inputs"].update(lines=document["lines"]),
        lambda document: document.update(n_rows=10**9),
        lambda document: document.update(edits={"tuple": ["x"]}),
        lambda document: document["report"].update(edits={"tuple": ["x"]}),
        lambda document: document["report"].update(duplicates="any"),
        lambda document: document["report"].update(notes=3),
        lambda document: document["inputs"].update(holes={"list": []}),
        lambda document: document["inputs"]["options"].update(trim="nowhere"),
        lambda document: document["inputs"]["options"].update(threads=0),
        lambda document: document["inputs"]["options"].update(snap=-1.0),
    ],
)
def test_a_record_that_does_not_fit_is_refused(path, alter):
    ts.write(make_tin(), path)
    rewrite_document(path, alter)
    with pytest.raises(ts.ReadError, match="holds no TIN"):
        ts.read(path)


def test_a_deep_document_is_refused(path):
    ts.write(make_tin(), path)
    tree = 1
    for _ in range(200):
        tree = {"list": [tree]}
    rewrite_document(path, lambda document: document.update(vertex_of=tree))
    with pytest.raises(ts.ReadError, match="too deep"):
        ts.read(path)


def test_edits_with_wrong_arguments_are_not_done_again(path):
    tin = make_tin()
    edit(tin)
    ts.write(tin, path)
    wrong = {"map": {"list": 3}}
    rewrite_document(path, lambda document: document["edits"]["tuple"][0].update(arguments=wrong))
    found = ts.read(path)
    with pytest.raises(ts.PointsError, match=r"edit 0 \(insert\) of its record"):
        found.undo()


def test_edits_that_lead_elsewhere_are_not_done_again(path):
    tin = make_tin()
    edit(tin)
    ts.write(tin, path)
    rewrite_document(path, lambda document: document["edits"]["tuple"].pop())
    found = ts.read(path)
    with pytest.raises(ts.PointsError, match="do not lead to it"):
        found.undo()


def test_cut_files_are_refused(path):
    tin = make_tin()
    ts.write(tin, path)
    whole = path.read_bytes()
    for size in (100, 5000, 40_000, len(whole) // 2, len(whole) * 3 // 4):
        path.write_bytes(whole[:size])
        with pytest.raises(ts.TinsmithError):
            ts.read(path)
    path.write_bytes(whole[:-1])  # a byte that no table uses
    assert find_differences(tin, ts.read(path)) == []


def test_a_file_that_is_open_elsewhere_is_neither_read_nor_written(path):
    tin = make_tin()
    ts.write(tin, path)
    path.with_name("a.gpkg-wal").write_bytes(b"x")
    with pytest.raises(ts.ReadError, match="open in another program"):
        ts.read(path)
    with pytest.raises(ts.WriteError, match="open in another program"):
        ts.write(tin, path)


COLUMNS = {
    "number": np.arange(44),
    "code": [f"C{i}ä" for i in range(44)],
    "weight": np.where(np.arange(44) % 7 == 0, np.nan, np.arange(44) / 4),
    "seen": np.arange(44) % 2 == 0,
    "mixed": np.array([None, 1, 2.5, "x"] * 11, object),
    "short": np.arange(44).astype("i2"),
    "large": np.arange(44).astype("u8") + 2**63,
    "half": np.arange(44).astype("f2"),
    "day": np.array(["2026-11-22"] * 44, "M8[D]"),
    "Vertex": np.arange(44),
    'we "ird; DROP': np.arange(44),
    "big endian": np.arange(44).astype(">i4"),
}


def test_attributes_of_every_type_come_back(tmp_path):
    points = np.random.default_rng(5).random((44, 3)) * 100
    survey = ts.Survey(points=points, attributes=COLUMNS)
    tin = ts.triangulate(survey, breaklines=[[[1, 1, 5], [99, 99, 5]]])
    tin.insert([[50.5, 50.25, 3]])
    tin.remove([3, 7])
    path = ts.write(tin, tmp_path / "a.gpkg")
    found = ts.read(path)
    assert ts.write(found, tmp_path / "b.gpkg").read_bytes() == path.read_bytes()
    for name, column in tin.row_attributes.items():
        kept = found.row_attributes[name]
        assert kept.dtype == column.dtype.newbyteorder("=")
        for one, other in zip(column.tolist(), kept.tolist(), strict=True):
            assert one == other or (one != one and other != other)
    found.undo(2)
    assert len(found.attributes["code"]) == len(found.points)
    frame = pytest.importorskip("pyogrio").read_dataframe(
        path, layer="vertices", read_geometry=False
    )
    assert frame["code"].tolist() == tin.attributes["code"].tolist()
    assert {"Vertex_2", 'we "ird; DROP'} <= set(frame.columns)
    assert frame["vertex"].tolist() == list(range(len(tin.points)))


def make_attributes(count, seed):
    """Return columns of all types, with gaps, in which hard values come early."""
    rng = np.random.default_rng(seed)
    reals = rng.normal(size=count) * 10.0 ** rng.integers(-300, 300, count)
    reals[:4] = [np.nan, -0.0, np.inf, 3.0]
    words = ["", "a", "Bö\0schung", "\U0001f30d", "x" * int(rng.integers(50, 70)), None, "12"]
    whole = {"big": 62, "small": 6, "medium": 20}
    texts = np.empty(count, object)
    texts[:] = [words[k] for k in rng.integers(0, len(words), count)]
    few = np.array(["gnd", "tree"])[rng.integers(0, 2, count)]
    integers = {name: rng.integers(-(2**n), 2**n, count) for name, n in whole.items()}
    kinds = {"flag": rng.random(count) < 0.5, "half": reals[::-1].astype("f4")}
    return {"texts": texts, "reals": reals, "few": few, **integers, **kinds}


@pytest.mark.parametrize("seed", range(4))
def test_attributes_laid_out_as_pages_are_those_that_sqlite_writes(tmp_path, monkeypatch, seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 900))
    with np.errstate(over="ignore"):
        attributes = make_attributes(count, seed)
    survey = ts.Survey(points=rng.random((count, 3)) * 100, attributes=attributes)
    tin = ts.triangulate(survey)
    paths = [ts.write(tin, tmp_path / "pages.gpkg")]
    monkeypatch.setattr(writing, "_MOST_COLUMNS", -1)
    paths.append(ts.write(tin, tmp_path / "rows.gpkg"))
    found = []
    for path in paths:
        with closing(sqlite3.connect(path)) as file:
            assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
            kinds = ", ".join(f"typeof({name}), {name}" for name in ("fid", "vertex", *attributes))
            found.append(file.execute(f"SELECT {kinds}, geom FROM vertices").fetchall())
    assert found[0] == found[1]
    assert find_differences(tin, ts.read(paths[0])) == []


@pytest.mark.parametrize("attribute", ["x" * 40_000, "long"])
def test_rows_that_no_page_holds_are_written_by_sqlite(path, attribute):
    columns = {"note": np.array([attribute, "b", "c", "d"], object)}
    if attribute == "long":
        columns = {f"c{k}": np.arange(4) for k in range(200)}
    points = [[0, 0, 1], [4, 0, 2], [4, 4, 9], [0, 5, 4.0]]
    tin = ts.triangulate(ts.Survey(points=points, attributes=columns))
    assert find_differences(tin, ts.read(ts.write(tin, path))) == []
    with closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        found = file.execute("SELECT * FROM vertices ORDER BY fid").fetchall()
    assert [row[3] for row in found] == tin.attributes[next(iter(columns))].tolist()
