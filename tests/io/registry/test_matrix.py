"""Every format written, read back, and compared with what it says that it rounds and loses.

The formats are those of the registry: a new one joins by being there.
"""

from __future__ import annotations

import csv
import importlib
import json
import os
import subprocess
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from support import matrix

import tinsmith as ts
from tinsmith.io.registry.format import KINDS

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case

FORMATS = [one for one in ts.io.known_formats() if one.is_built_in]
WRITTEN = [
    pytest.param(one, kind, id=f"{one.name}-{kind}")
    for one in FORMATS
    if one.write is not None
    for kind in one.writes
]
ROUND_TRIPS = [
    case for case in WRITTEN if case.values[0].read is not None and case.values[1] in KINDS[:2]
]
IN_DEGREES = ("geojson", "geojsonseq")
"""Formats of WGS 84, which are read with the CRS that is wanted."""
LOST_ELSEWHERE = {"elevation unit"}
"""What some formats lose where elevations have another unit than coordinates; not so here."""
FINEST_DEGREES = 0.5e-9 + 1e-12
"""Half of the last decimal of GeoJSON."""


def make(kind):
    if kind == "Survey":
        return matrix.make_survey_with_lines()
    tin = matrix.make_tin()
    makers = {
        "TIN": lambda: tin,
        "Features": lambda: ts.contours(tin, interval=1.0),
        "Raster": lambda: ts.rasterize(tin, spacing=5.0),
        "Table": lambda: ts.stage_storage(tin, levels=[300, 302, 305.5]),
    }
    return makers[kind]()


def write_and_read(one, kind, folder, suffix):
    given = make(kind)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if one.losses else "error", ts.LossWarning)
        path = ts.write(given, folder / f"a{suffix}", format=one.name)
    return given, ts.read(path, **({"crs": given.crs} if one.name in IN_DEGREES else {}))


@pytest.mark.parametrize(("one", "kind"), ROUND_TRIPS)
def test_what_comes_back_is_as_precise_as_is_said(one, kind, tmp_path):
    for suffix in one.suffixes:
        given, found = write_and_read(one, kind, tmp_path, suffix)
        rounding = matrix.measure_rounding(given.points, found.points)
        extent = np.ptp(given.points[:, :2], axis=0).max()
        assert rounding is not None
        assert rounding <= one.rounding + one.relative_rounding * extent
        assert len(found.points) == len(given.points)
        find = matrix.find_losses_of_tin if kind == "TIN" else matrix.find_losses_of_survey
        assert find(given, found) <= set(one.loses)


@pytest.mark.parametrize(
    "one",
    dict.fromkeys(case.values[0] for case in WRITTEN if case.values[0].suffixes),
    ids=lambda one: one.name,
)
def test_what_is_text_is_said(one, tmp_path):
    for suffix in one.suffixes:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ts.LossWarning)
            path = ts.write(make(one.writes[0]), tmp_path / f"a{suffix}", format=one.name)
        content = path.read_bytes()
        is_utf_8 = content.decode("utf-8", "ignore").encode() == content
        assert (is_utf_8 and b"\0" not in content) == one.is_text


@pytest.mark.parametrize(
    "one", dict.fromkeys(case.values[0] for case in ROUND_TRIPS), ids=lambda one: one.name
)
def test_nothing_is_said_to_be_lost_that_is_not(one, tmp_path):
    lost, rounding = set(), 0.0
    for kind in set(one.writes) & {"TIN", "Survey"}:
        for suffix in one.suffixes:
            given, found = write_and_read(one, kind, tmp_path, suffix)
            find = matrix.find_losses_of_tin if kind == "TIN" else matrix.find_losses_of_survey
            lost |= find(given, found)
            rounding = max(rounding, matrix.measure_rounding(given.points, found.points))
    assert lost <= set(one.loses) <= lost | LOST_ELSEWHERE
    assert (rounding > 0) == (one.rounding + one.relative_rounding > 0)


@pytest.mark.parametrize(
    "one",
    [one for one in FORMATS if one.write and "Survey" in one.writes],
    ids=lambda one: one.name,
)
def test_lines_of_a_survey_are_kept_or_told(one, tmp_path):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", ts.LossWarning)
        ts.write(matrix.make_survey_with_lines(), tmp_path / f"a{one.suffixes[0]}", format=one.name)
    words = {
        "survey lines": "(3 breaklines, 1 boundary, 2 holes, 1 erased area, 1 water body)",
        "erased areas": "(1 erased area)",
    }
    wanted = [sentence for word, sentence in words.items() if word in one.loses]
    about_lines = [str(one.message) for one in told if "lines of the survey" in str(one.message)]
    assert len(about_lines) == len(wanted)
    assert all(sentence in text for sentence, text in zip(wanted, about_lines, strict=True))


def test_points_that_are_asked_for_have_no_lines_to_lose(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ts.write(matrix.make_survey_with_lines(), tmp_path / "a.fgb", kind="points")


@pytest.mark.parametrize("one", FORMATS, ids=lambda one: one.name)
def test_every_format_says_what_it_keeps(one):
    if one.write is not None:
        assert one.precision.endswith(".")
    assert one.losses == "" or one.losses.endswith(".")
    assert not one.loses or one.losses
    for sentence in (one.precision, one.losses):
        assert sentence.isprintable()


# ------------------------------------------------------------------ read by other programs


UNKNOWN_TO_GDAL = ("landxml",)


def cases(kind):
    return [case.values[0] for case in WRITTEN if case.values[1] == kind]


@pytest.mark.parametrize(
    "one",
    [one for one in cases("Features") if one.name not in UNKNOWN_TO_GDAL],
    ids=lambda one: one.name,
)
def test_features_are_what_gdal_reads(one, tmp_path):
    features = make("Features")
    if one.name == "csv":  # points alone
        features = ts.contour_labels(features)
        units = {name: unit for name, unit in features.units.items() if name != "elevation"}
        kept = {name: column for name, column in features.columns.items() if name != "elevation"}
        features = replace(features, columns=kept, units=units)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if one.losses else "error", ts.LossWarning)
        path = ts.write(features, tmp_path / f"a{one.suffixes[0]}", format=one.name)
    pyogrio = pytest.importorskip("pyogrio")
    if one.name == "csv":
        assert len(path.read_text().splitlines()) == len(features) + 1
        return
    if one.name == "geoparquet":  # GDAL's wheel has no driver for it
        frame = pytest.importorskip("geopandas").read_parquet(path)
    else:
        frame = pyogrio.read_dataframe(path)
    if one.name == "dxf":  # labels are texts beside the lines
        frame = frame[frame["Layer"] != "CONTOUR_LABELS"]
    assert len(frame) == len(features)
    wanted = features.to_geodataframe().geometry
    if one.name in IN_DEGREES:
        wanted = wanted.to_crs("OGC:CRS84")
    found, wanted = (sorted(shapes, key=_key) for shapes in (frame.geometry, wanted))
    for shape, given in zip(found, wanted, strict=True):
        ends, given_ends = (shapely.get_coordinates(g) for g in (shape, given))
        if one.name in IN_DEGREES:
            np.testing.assert_allclose(ends, given_ends, rtol=0, atol=FINEST_DEGREES)
        else:
            assert ends.tobytes() == given_ends.tobytes()


def _key(shape):
    """Return what sorts shapes whatever their order is, rounding aside."""
    ends = shapely.get_coordinates(shape)
    return (len(ends), *np.round(ends.mean(axis=0), 6).tolist())


RASTERS = [one for one in cases("Raster") if one.name != "terrain-tiles"]
"""Those of cells; what tiles mean is asked in test_terrain_tiles.py."""


@pytest.mark.parametrize("one", RASTERS, ids=lambda one: one.name)
def test_rasters_are_what_gdal_reads(one, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    raster = make("Raster")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if one.losses else "error", ts.LossWarning)
        path = ts.write(raster, tmp_path / f"a{one.suffixes[0]}", format=one.name)
    with rasterio.Env(AAIGRID_DATATYPE="Float64"), rasterio.open(path) as found:
        cells = found.read(1, masked=True).filled(np.nan)
        assert found.crs.to_epsg() == 32616
    wanted = next(iter(raster.bands.values()))[:]
    np.testing.assert_array_equal(cells, np.asarray(wanted))


@pytest.mark.parametrize("one", cases("Table"), ids=lambda one: one.name)
def test_tables_hold_every_number(one, tmp_path):
    table = make("Table")
    path = ts.write(table, tmp_path / f"a{one.suffixes[0]}", format=one.name)
    text = path.read_text(encoding="utf-8")
    columns = [np.asarray(column).tolist() for column in table.columns.values()]
    if one.name == "json":
        found = json.dumps(json.loads(text))
        assert all(json.dumps(value) in found for column in columns for value in column)
    else:
        rows = list(csv.reader(text.splitlines()))[1:]
        words = {"": "nan", "true": "1", "false": "0"}
        cells = [
            [float(words.get(cell, cell)) for cell in column] for column in zip(*rows, strict=True)
        ]
        np.testing.assert_array_equal(cells, columns)


def test_layers_of_a_whole_tin_are_what_gdal_reads(tmp_path):
    pyogrio = pytest.importorskip("pyogrio")
    tin = make("TIN")
    path = ts.write(tin, tmp_path / "a.gpkg")
    layers = dict(pyogrio.list_layers(path).tolist())
    assert layers == {
        "vertices": "Point Z",
        "triangles": "Polygon Z",
        "lines": "LineString Z",
        "boundary": "LineString Z",
        "water": "Polygon Z",
        "tinsmith_tin": None,
        "layer_styles": None,
    }
    frames = {name: pyogrio.read_dataframe(path, layer=name) for name in list(layers)[:5]}
    assert {frame.crs.to_epsg() for frame in frames.values()} == {32616}
    vertices = shapely.get_coordinates(frames["vertices"].geometry, include_z=True)
    assert vertices.tobytes() == tin.points.tobytes()
    triangles = frames["triangles"]
    assert triangles[["a", "b", "c"]].to_numpy().tolist() == tin.triangles.tolist()
    np.testing.assert_array_equal(triangles["slope"], ts.slope(tin))
    corners = shapely.get_coordinates(triangles.geometry, include_z=True).reshape(-1, 4, 3)
    assert (corners == tin.points[tin.triangles[:, [0, 1, 2, 0]]]).all()
    assert frames["triangles"].geometry.area.sum() == pytest.approx(tin.area, rel=1e-9)
    assert list(frames["lines"]["name"]) == list(tin.lines.names)
    assert list(frames["lines"]["kind"]) == list(tin.lines.kinds)
    assert frames["water"][["name", "elevation"]].to_numpy().tolist() == [["pond", 299.5]]


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl"])
def test_meshes_are_what_trimesh_reads(suffix, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = make("TIN")
    mesh = trimesh.load(ts.write(tin, tmp_path / f"a{suffix}"), process=False)
    assert len(mesh.faces) == len(tin.triangles)
    assert mesh.area == pytest.approx(tin.surface_area, rel=1e-6)


@pytest.mark.parametrize(
    ("suffix", "reader"),
    [
        (".ply", "vtkIOPLY.vtkPLYReader"),
        (".obj", "vtkIOGeometry.vtkOBJReader"),
        (".stl", "vtkIOGeometry.vtkSTLReader"),
        (".vtp", "vtkIOXML.vtkXMLPolyDataReader"),
        (".vtu", "vtkIOXML.vtkXMLUnstructuredGridReader"),
    ],
)
def test_meshes_are_what_vtk_reads(suffix, reader, tmp_path):
    pytest.importorskip("vtkmodules")
    module, _, name = reader.partition(".")
    tin = make("TIN")
    found = getattr(importlib.import_module(f"vtkmodules.{module}"), name)()
    found.SetFileName(str(ts.write(tin, tmp_path / f"a{suffix}")))
    found.Update()
    assert found.GetOutput().GetNumberOfCells() == len(tin.triangles)
    assert found.GetOutput().GetNumberOfPoints() == len(tin.points)


# ------------------------------------------------------------------ read by QGIS


QGIS = """
import json, os, sys
from qgis.core import QgsApplication, QgsMeshLayer, QgsVectorLayer
application = QgsApplication([], False)
application.initQgis()
told = {}
for path in sys.argv[1:]:
    if path.endswith(".gpkg"):
        for name in ["vertices", "triangles", "lines", "boundary", "water"]:
            layer = QgsVectorLayer(path + "|layername=" + name, name, "ogr")
            told[name] = [layer.isValid(), layer.featureCount(), layer.crs().authid()]
    else:
        layer = QgsMeshLayer(path, "mesh", "mdal")
        data = layer.dataProvider()
        groups = [data.datasetGroupMetadata(i).name() for i in range(data.datasetGroupCount())]
        told[path.rpartition(".")[2]] = [
            layer.isValid(), data.vertexCount(), data.faceCount(), groups, layer.crs().authid()
        ]
print(json.dumps(told), flush=True)
os._exit(0)  # QGIS crashes where layers are left as it ends
"""


def run_qgis(folder, *paths):
    """Return what QGIS, which has a Python of its own, tells of files."""
    folder.chmod(0o700)
    surroundings = {
        **{name: value for name, value in os.environ.items() if not name.startswith("PYTHON")},
        "QT_QPA_PLATFORM": "offscreen",
        "XDG_RUNTIME_DIR": str(folder),
        "HOME": str(folder),
    }
    python = "/usr/bin/python3"
    probe = [python, "-c", "import qgis.core"]
    if not Path(python).exists() or subprocess.run(probe, capture_output=True).returncode:
        pytest.skip("needs QGIS with its Python")
    command = [python, "-c", QGIS, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings, timeout=600)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.slow
def test_a_tin_opens_in_qgis(tmp_path):
    tin = make("TIN")
    paths = [ts.write(tin, tmp_path / name) for name in ("a.ply", "a.gpkg")]
    told = run_qgis(tmp_path, *paths)
    counts = (len(tin.points), len(tin.triangles))
    assert told["ply"] == [True, *counts, ["Bed Elevation", "number"], "EPSG:32616"]
    assert told["vertices"] == [True, len(tin.points), "EPSG:32616"]
    assert told["triangles"] == [True, len(tin.triangles), "EPSG:32616"]
    assert told["lines"] == [True, len(tin.lines), "EPSG:32616"]
    assert [told[name][:2] for name in ("boundary", "water")] == [[True, 1], [True, 1]]
