"""Drawings that we write: what ezdxf's audit and GDAL find in them, and round trips."""

from collections import Counter

import ezdxf
import numpy as np
import pyogrio
import pytest
import shapely
from support.surfaces import scatter, survey_site

import tinsmith as ts


@pytest.fixture
def survey():
    points = scatter(200)
    lines = [
        ts.Breakline(points[[3, 9, 20]] + [0.5, 0.5, 0], name="Bordstein, höher"),
        ts.Breakline(points[[5, 40]], kind="soft"),
    ]
    columns = {"number": np.arange(1, 201), "description": np.array(["Zaun"] * 200)}
    return survey_site(points, lines, columns)


def corners_of(tin):
    return [tin.points[triangle].tolist() for triangle in tin.triangles]


def audit(path):
    document = ezdxf.readfile(path)
    auditor = document.audit()
    assert not auditor.errors
    assert not auditor.fixes
    return document


@pytest.mark.parametrize("version", ["R2010", "R12"])
def test_a_tin_comes_back_with_its_own_triangles_and_lines(survey, tmp_path, version):
    tin = ts.triangulate(survey)
    if version == "R12":
        with pytest.warns(ts.LossWarning, match="R12"):
            path = ts.write(tin, tmp_path / "a.dxf", version=version)
    else:
        path = ts.write(tin, tmp_path / "a.dxf")
    read = ts.read(path)
    assert corners_of(read) == corners_of(tin)
    assert np.array_equal(read.neighbors, tin.neighbors)
    assert np.array_equal(read.constrained, tin.constrained)
    assert (read.lines.kinds, read.lines.names) == (tin.lines.kinds, tin.lines.names)
    assert read.lines.sources.tolist() == tin.lines.sources.tolist()
    for chain, other in zip(read.lines.chains(), tin.lines.chains(), strict=True):
        assert np.array_equal(read.points[chain], tin.points[other])
    if version != "R12":
        assert (read.crs, read.elevation_unit) == (tin.crs, tin.elevation_unit)


@pytest.mark.parametrize("version", ["R2010", "R12"])
@pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
def test_layers_colours_and_audit(survey, tmp_path, version):
    tin = ts.triangulate(survey)
    contours = ts.contours(tin, interval=0.2)
    found = Counter()
    for number, obj in enumerate((tin, survey, contours)):
        document = audit(ts.write(obj, tmp_path / f"{number}.dxf", version=version))
        assert document.dxfversion == {"R2010": "AC1024", "R12": "AC1009"}[version]
        assert document.layers.get("BREAKLINES").color == 1
        found += Counter(one.dxf.layer for one in document.modelspace())
    assert found["TIN"] == len(tin.triangles)
    assert found["POINTS"] == found["POINT_NUMBERS"] == found["POINT_ELEVATIONS"] == 200
    assert found["CONTOURS"] + found["INDEX_CONTOURS"] == len(contours)
    assert found["INDEX_CONTOURS"] > 0
    assert {"BREAKLINES", "SOFT_BREAKLINES", "BOUNDARY", "HOLES", "WATER"} <= found.keys()


def test_a_survey_comes_back_with_its_lines(survey, tmp_path):
    read = ts.read(ts.write(survey, tmp_path / "a.dxf"))
    assert np.array_equal(read.points, survey.points)
    assert read.attributes["number"].tolist() == [str(k) for k in range(1, 201)]
    assert read.attributes["description"].tolist() == ["Zaun"] * 200
    for one, other in zip(read.breaklines, survey.breaklines, strict=True):
        assert np.array_equal(one.coords, other.coords)
        assert (one.kind, one.name) == (other.kind, other.name)
    assert np.array_equal(read.boundary[0], survey.boundary[0])
    assert np.array_equal(read.holes[0], survey.holes[0])
    assert read.water[0].z == 301.5
    assert read.crs == "EPSG:32616"
    assert np.array_equal(ts.triangulate(read).triangles, ts.triangulate(survey).triangles)


@pytest.mark.filterwarnings("ignore:Non closed ring:RuntimeWarning")  # GDAL's own triangles
def test_gdal_reads_triangles_lines_and_points(survey, tmp_path):
    tin = ts.triangulate(survey)
    meta, _, shapes, columns = pyogrio.raw.read(ts.write(tin, tmp_path / "a.dxf"))
    layers = columns[list(meta["fields"]).index("Layer")]
    faces = shapely.from_wkb(shapes[layers == "TIN"])
    assert len(faces) == len(tin.triangles)
    assert sum(face.area for face in faces) == pytest.approx(tin.area)
    rows = shapely.get_coordinates(faces, include_z=True).reshape(len(faces), -1, 3)[:, :3]
    assert rows.tolist() == corners_of(tin)
    _, _, shapes, _ = pyogrio.raw.read(ts.write(survey, tmp_path / "b.dxf", labels=False))
    points = [one for one in shapely.from_wkb(shapes) if one.geom_type == "Point"]
    assert np.array_equal(shapely.get_coordinates(points, include_z=True), survey.points)


def test_contours_are_plane_polylines_with_an_elevation(survey, tmp_path):
    contours = ts.contours(ts.triangulate(survey), interval=1)
    document = audit(ts.write(contours, tmp_path / "a.dxf"))
    elevations = {one.dxf.elevation for one in document.modelspace()}
    assert elevations == set(contours.columns["elevation"].tolist())
    read = ts.read(tmp_path / "a.dxf")
    first = contours.coordinates[: contours.offsets[0][1]]
    assert np.array_equal(read.breaklines[0].coords, first)


def test_polygons_and_points_of_features(tmp_path):
    polygons = ts.Features.of_polygons([[0, 0, 1], [4, 0, 2], [0, 3, 3], [0, 0, 1]], [0, 4], [0, 1])
    points = ts.Features.of_points([[1, 2, 3], [4, 5, np.nan]])
    with pytest.warns(ts.LossWarning, match="no units"):
        document = audit(ts.write(polygons, tmp_path / "a.dxf"))
    (line,) = document.modelspace()
    assert line.is_closed
    assert [tuple(one.dxf.location) for one in line.vertices] == [(0, 0, 1), (4, 0, 2), (0, 3, 3)]
    with (
        pytest.warns(ts.LossWarning, match="no units"),
        pytest.warns(ts.LossWarning, match="1 point of unknown elevation got the elevation 0"),
    ):
        document = audit(ts.write(points, tmp_path / "b.dxf", labels=False))
    assert [tuple(one.dxf.location) for one in document.modelspace()] == [(1, 2, 3), (4, 5, 0)]


def test_the_same_bytes_at_any_time(survey, tmp_path):
    a, b = (ts.write(survey, tmp_path / name).read_bytes() for name in ("a.dxf", "b.dxf"))
    assert a == b
    assert not ezdxf.options.write_fixed_meta_data_for_testing


@pytest.mark.parametrize(("crs", "code"), [(32616, 6), (2222, 2), (2274, 21)])
def test_units_are_those_of_the_crs(tmp_path, crs, code):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs=crs)
    path = ts.write(tin, tmp_path / "a.dxf")
    assert audit(path).header["$INSUNITS"] == code
    read = ts.read(path)
    assert (read.crs, read.elevation_unit) == (tin.crs, None)


def test_what_a_drawing_cannot_hold(tmp_path):
    points = [[0, 0, 5], [4, 0, 6], [0, 3, 8]]
    with pytest.raises(ts.CrsError, match="degrees"):
        ts.write(ts.triangulate(points, crs=4326), tmp_path / "a.dxf")
    with pytest.raises(ts.OptionError, match="Invalid version 'R9': it must be one of R2010, R12"):
        ts.write(ts.triangulate(points, crs=32616), tmp_path / "a.dxf", version="R9")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("version", ["R2010", "R12"])
@pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
def test_texts_that_a_drawing_cannot_hold_are_made_to_fit(tmp_path, version):
    names = ["a\nb\x00c", "Ω" * 400, "", "x\ud800"]
    points = [[0, 0, 5], [4, 0, 6], [0, 3, 8], [4, 4, 4]]
    survey = ts.Survey(points=points, attributes={"number": np.array(names, object)})
    path = ts.write(survey, tmp_path / "a.dxf", version=version)
    audit(path)
    read = ts.read(path)
    assert len(read) == 4
    assert read.attributes["number"].tolist()[0] == "a b c"
