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
    elevations = {one.dxf.elevation for one in document.modelspace().query("LWPOLYLINE")}
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


# ---------------------------------------------------------------- labels of contours

LABELS = ("text", "elevation", "rotation")


@pytest.fixture
def contours():
    rows, columns = np.mgrid[:13, :13] * 10.0
    z = 320 + 4 * np.sin(columns / 40) * np.cos(rows / 35)
    points = np.column_stack([columns.ravel() + 752700, rows.ravel() + 4024200, z.ravel()])
    tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
    return ts.contours(tin, interval=0.5)


def read_labels(path):
    """Return the labels of a drawing: places, texts, rotations, heights, kinds."""
    found = []
    for one in audit(path).modelspace().query('*[layer=="CONTOUR_LABELS"]'):
        if one.dxftype() == "MTEXT":
            assert one.dxf.attachment_point == 5
            assert (one.dxf.bg_fill, one.dxf.box_fill_scale) == (3, 1.2)
            found.append((tuple(one.dxf.insert), one.text, one.dxf.rotation, one.dxf.char_height))
        else:
            assert (one.dxf.halign, one.dxf.valign) == (1, 2)
            place = tuple(one.dxf.align_point)
            found.append((place, one.dxf.text, one.dxf.rotation, one.dxf.height))
    return found


@pytest.mark.parametrize("version", ["R2010", "R12"])
@pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
def test_contours_are_labelled_along_the_lines(contours, tmp_path, version):
    path = ts.write(contours, tmp_path / "a.dxf", version=version)
    labels = ts.contour_labels(contours)
    found = read_labels(path)
    assert len(found) == len(labels) > 3
    texts, elevations, rotations = (labels.columns[name].tolist() for name in LABELS)
    for k, (place, text, rotation, height) in enumerate(found):
        assert place == tuple(labels.coordinates[k].tolist())
        assert (text, rotation, place[2]) == (texts[k], rotations[k], elevations[k])
        assert 0.1 < height < 3
        first, last = contours.offsets[0][labels.columns["line"][k] :][:2]
        line = shapely.LineString(contours.coordinates[first:last, :2])
        assert line.distance(shapely.Point(place[:2])) < 1e-6
    drawn = [one for one in audit(path).modelspace() if one.dxftype().endswith("POLYLINE")]
    assert len(drawn) == len(contours)


def test_index_contours_are_heavier(contours, tmp_path):
    layers = audit(ts.write(contours, tmp_path / "a.dxf")).layers
    assert layers.get("INDEX_CONTOURS").dxf.lineweight == 35
    assert layers.get("CONTOURS").dxf.lineweight < 0  # the usual one


def test_labels_alone_are_the_same_texts_without_points(contours, tmp_path):
    labels = ts.contour_labels(contours)
    alone = ts.write(labels, tmp_path / "labels.dxf")
    assert read_labels(alone) == read_labels(ts.write(contours, tmp_path / "a.dxf"))
    assert not audit(alone).modelspace().query("POINT")


def test_labels_are_left_out_or_of_a_height(contours, tmp_path):
    assert read_labels(ts.write(contours, tmp_path / "a.dxf", labels=False)) == []
    found = read_labels(ts.write(contours, tmp_path / "b.dxf", label_height=2.5))
    assert {height for *_, height in found} == {2.5}
    with pytest.raises(ts.OptionError, match="label_height"):
        ts.write(contours, tmp_path / "c.dxf", label_height=0)
    assert not (tmp_path / "c.dxf").exists()


@pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
def test_labels_are_in_the_unit_of_the_drawing(contours, tmp_path):
    """A drawing has one unit: elevations in feet above metres become metres, labels with them."""
    feet = ts.Features.of_lines(
        contours.coordinates, contours.offsets[0], columns=contours.columns, crs="EPSG:32616",
        elevation_unit="ft", name="contours",
    )  # fmt: skip
    found = read_labels(ts.write(feet, tmp_path / "a.dxf"))
    assert found
    for place, text, *_ in found:
        assert float(text) == pytest.approx(place[2], abs=0.005)
        assert 90 < place[2] < 105


def test_lines_that_are_called_contours_need_no_columns(tmp_path):
    line = ts.Features.of_lines([[0, 0, 5], [4, 0, 5]], [0, 2], name="contours")
    assert read_labels(ts.write(line, tmp_path / "a.dxf", unit="m")) == []
