"""Every vector format that is written opens in QGIS: layers, counts, CRS, elevations."""

import warnings

import numpy as np
import pytest
from support.qgis_layers import open_layers_in_qgis

import tinsmith as ts

pytestmark = pytest.mark.slow

pytest.importorskip("pyogrio")
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])
UTM = "EPSG:32616"


def make_tin():
    points = CORNER + np.random.default_rng(4).random((60, 3)) * (90, 70, 12)
    points = points.round(3)
    ring = CORNER[:2] + np.array([[5, 5], [80, 8], [75, 60], [8, 55]])
    return ts.triangulate(
        points, crs=UTM, breaklines=[ts.Breakline(points[:2], name="kerb")], boundary=[ring]
    )


def write_all(folder):
    tin = make_tin()
    survey = ts.Survey(points=tin.points, crs=UTM, attributes={"k": np.arange(len(tin.points))})
    contours = ts.contours(tin, interval=2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        ts.write(tin, folder / "whole.gpkg")
        ts.write(survey, folder / "survey.gpkg")
        ts.write(contours, folder / "contours.gpkg")
        for suffix in (".fgb", ".shp", ".geojsonl"):
            ts.write(tin, folder / f"triangles{suffix}")
            ts.write(survey, folder / f"survey{suffix}")
            ts.write(contours, folder / f"contours{suffix}")
        ts.write(tin, folder / "patch.shp", multipatch=True)
        ts.write(tin, folder / "tin.dxf")
        ts.write(tin, folder / "triangles.geojson")
    return tin, survey, contours


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    folder = tmp_path_factory.mktemp("qgis")
    made = write_all(folder)
    suffixes = (".gpkg", ".fgb", ".shp", ".geojsonl", ".dxf", ".geojson")
    paths = sorted(path for path in folder.iterdir() if path.suffix in suffixes)
    return made, open_layers_in_qgis(paths, folder)


def sort_rows(rows):
    rows = np.asarray(rows, np.float64)
    return rows[np.lexsort(rows.T[::-1])]


def require_same(layer, vertices, count, *, crs=UTM, name=""):
    """Require count, CRS and every vertex with its elevation, in any order of the features."""
    assert layer["valid"], name
    assert layer["count"] == count
    assert layer["crs"] == crs
    found = np.array(layer["vertices"], np.float64)
    np.testing.assert_array_equal(sort_rows(found), sort_rows(vertices))


def list_corners(tin):
    return tin.points[tin.triangles[:, [0, 1, 2, 0]]].reshape(-1, 3)


@pytest.mark.parametrize("suffix", [".fgb", ".shp"])
def test_triangles(seen, suffix):
    (tin, _, _), told = seen
    ((name, layer),) = told[f"triangles{suffix}"].items()
    assert name == "triangles"
    assert {"id", "slope", "aspect", "area"} <= set(layer["fields"])
    require_same(layer, list_corners(tin), len(tin.triangles))


@pytest.mark.parametrize("suffix", [".gpkg", ".fgb", ".shp"])
def test_points_of_a_survey(seen, suffix):
    (_, survey, _), told = seen
    ((name, layer),) = told[f"survey{suffix}"].items()
    assert name == ("survey" if suffix == ".shp" else "points")
    assert "k" in layer["fields"]
    require_same(layer, survey.points, len(survey))


@pytest.mark.parametrize("suffix", [".gpkg", ".fgb", ".shp"])
def test_contours(seen, suffix):
    (_, _, contours), told = seen
    ((_, layer),) = told[f"contours{suffix}"].items()
    require_same(layer, contours.coordinates, len(contours))


def test_layers_of_a_whole_tin(seen):
    (tin, _, _), told = seen
    layers = told["whole.gpkg"]
    assert {"vertices", "triangles", "lines", "boundary"} <= set(layers)
    require_same(layers["vertices"], tin.points, len(tin.points))
    require_same(layers["triangles"], list_corners(tin), len(tin.triangles))
    assert layers["lines"]["count"] == len(tin.lines)
    elevations = {row[2] for row in layers["lines"]["vertices"]}
    assert elevations <= set(tin.points[:, 2].tolist())


def test_layers_of_a_tin_have_styles_for_every_feature(seen):
    (tin, _, _), told = seen
    layers = told["whole.gpkg"]
    kinds = {name: layer["renderer"] for name, layer in layers.items()}
    assert kinds["triangles"] == "graduatedSymbol"
    assert kinds["lines"] == "categorizedSymbol"
    assert not any(layer["unclassified"] for layer in layers.values())
    legend = layers["triangles"]["legend"]
    assert 4 <= len(legend) <= 12
    low, high = float(legend[0].split()[1]), float(legend[-1].split()[1])
    assert tin.points[:, 2].min() < low < high < tin.points[:, 2].max()
    assert legend[0].startswith("below")
    assert legend[-1].startswith("above")


def test_a_level_tin_has_one_class(tmp_path):
    points = CORNER + np.array([[0, 0, 0], [5, 0, 0], [0, 5, 0]])
    tin = ts.triangulate(points, crs=UTM, elevation_unit="ft")
    path = ts.write(tin, tmp_path / "level.gpkg")
    layers = open_layers_in_qgis([path], tmp_path)[path.name]
    assert layers["triangles"]["legend"] == ["elevation (ft)"]
    assert layers["triangles"]["unclassified"] == 0


def test_a_multipatch_has_every_triangle(seen):
    (tin, _, _), told = seen
    ((_, layer),) = told["patch.shp"].items()
    assert (layer["valid"], layer["count"], layer["crs"]) == (True, 1, UTM)
    found = {tuple(row) for row in layer["vertices"]}
    assert found == {tuple(row) for row in tin.points[np.unique(tin.triangles)].tolist()}


@pytest.mark.parametrize("name", ["triangles.geojsonl", "triangles.geojson"])
def test_geojson_is_longitude_latitude_and_metres(seen, name):
    (tin, _, _), told = seen
    ((_, layer),) = told[name].items()
    wanted = ts.transform_points(list_corners(tin), UTM, "EPSG:4326")
    assert layer["valid"]
    assert layer["count"] == len(tin.triangles)
    assert layer["crs"] in ("EPSG:4326", "EPSG:4979")
    found = np.array(layer["vertices"])
    assert found.shape == wanted.shape
    for axis, step in enumerate((1.1e-9, 1.1e-9, 1.1e-6)):
        np.testing.assert_allclose(
            np.sort(found[:, axis]), np.sort(wanted[:, axis]), rtol=0, atol=step
        )


def test_entities_of_a_drawing(seen):
    (tin, _, _), told = seen
    ((name, layer),) = told["tin.dxf"].items()
    assert name == "entities"
    assert layer["valid"]
    assert "Layer" in layer["fields"]
    found = {tuple(row) for row in layer["vertices"]}
    assert {tuple(row) for row in tin.points[np.unique(tin.triangles)].tolist()} <= found


def test_geoparquet_opens_where_the_gdal_of_qgis_has_the_driver(tmp_path):
    tin = make_tin()
    path = ts.write(tin, tmp_path / "triangles.parquet")
    from support.qgis_meshes import run_in_qgis

    drivers = run_in_qgis(
        "from osgeo import ogr; import json\n"
        "names = [ogr.GetDriver(k).GetName() for k in range(ogr.GetDriverCount())]\n"
        "print('ANSWER' + json.dumps(names))",
        [],
        tmp_path,
    )
    assert "GPKG" in drivers
    if "Parquet" in drivers:
        ((_, layer),) = open_layers_in_qgis([path], tmp_path)[path.name].items()
        require_same(layer, list_corners(tin), len(tin.triangles))
