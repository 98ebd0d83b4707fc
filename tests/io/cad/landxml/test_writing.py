"""LandXML that we write: what the schema asks for, what a plain reader finds, and round trips."""

import pickle
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from click.testing import CliRunner
from support.surfaces import hills, scatter, survey_site

import tinsmith as ts
from tinsmith.cli import main

SPACE = "{http://www.landxml.org/schema/LandXML-1.2}"


@pytest.fixture
def survey():
    points = scatter(400)
    lines = [
        ts.Breakline(points[[3, 9, 20]] + [0.5, 0.5, 0], name='the "wall" & <kerb>'),
        ts.Breakline(points[[5, 40]], kind="soft", priority=2),
        ts.Breakline(points[[7, 30], :2]),
    ]
    columns = {
        "number": np.arange(1, 401),
        "description": np.array(["a<b"] * 400),
        "code": np.array(["EP1", ""] * 200),
    }
    return survey_site(points, lines, columns, pond="pond")


def test_a_tin_comes_back_bit_by_bit_with_its_lines(survey, tmp_path):
    tin = ts.triangulate(survey)
    read = ts.read(ts.write(tin, tmp_path / "a.xml"))
    for name in ("points", "triangles", "constrained", "neighbors"):
        assert np.array_equal(getattr(read, name), getattr(tin, name)), name
    assert (read.crs, read.elevation_unit) == (tin.crs, tin.elevation_unit)
    assert read.lines.kinds == tin.lines.kinds
    assert read.lines.names == tin.lines.names
    assert read.lines.sources.tolist() == tin.lines.sources.tolist()
    assert read.lines.vertices.tolist() == tin.lines.vertices.tolist()
    assert not read.report.notes


def test_a_survey_comes_back_with_its_lines(survey, tmp_path):
    read = ts.read(ts.write(survey, tmp_path / "a.xml"))
    assert np.array_equal(read.points, survey.points)
    assert read.attributes["number"].tolist() == [str(k) for k in range(1, 401)]
    assert read.attributes["code"].tolist() == survey.attributes["code"].tolist()
    for one, other in zip(read.breaklines, survey.breaklines, strict=True):
        assert np.array_equal(one.coords, other.coords)
        assert (one.kind, one.priority, one.name) == (other.kind, other.priority, other.name)
    assert np.array_equal(read.boundary[0], survey.boundary[0])
    assert np.array_equal(read.holes[0], survey.holes[0])
    assert read.water[0].z == 301.5
    assert np.array_equal(ts.triangulate(read).triangles, ts.triangulate(survey).triangles)


def test_a_plain_reader_finds_northing_first_and_whole_numbers_from_1(survey, tmp_path):
    tin = ts.triangulate(survey)
    root = ET.parse(ts.write(tin, tmp_path / "a.xml", name="EG")).getroot()
    assert root.tag == f"{SPACE}LandXML"
    assert root.get("version") == "1.2"
    assert root.find(f"{SPACE}Units/{SPACE}Metric").get("linearUnit") == "meter"
    assert root.find(f"{SPACE}CoordinateSystem").get("epsgCode") == "32616"
    definition = root.find(f"{SPACE}Surfaces/{SPACE}Surface[@name='EG']/{SPACE}Definition")
    rows = [one.text.split() for one in definition.iter(f"{SPACE}P")]
    assert np.array_equal(np.array(rows, float)[:, [1, 0, 2]], tin.points)
    faces = [one.text.split() for one in definition.iter(f"{SPACE}F")]
    assert np.array_equal(np.array(faces, int) - 1, tin.triangles)
    kinds = [one.get("bndType") for one in root.iter(f"{SPACE}Boundary")]
    assert set(kinds) == {"outer", "void"}


def test_the_same_bytes_at_any_time(survey, tmp_path):
    a, b = (ts.write(survey, tmp_path / name).read_bytes() for name in ("a.xml", "b.xml"))
    assert a == b


@pytest.mark.parametrize(
    ("crs", "system", "name"),
    [(32616, "Metric", "meter"), (2222, "Imperial", "foot"), (2274, "Imperial", "USSurveyFoot")],
)
def test_units_are_those_of_the_crs(tmp_path, crs, system, name):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs=crs)
    path = ts.write(tin, tmp_path / "a.xml")
    assert f"<{system} " in path.read_text()
    assert f'linearUnit="{name}"' in path.read_text()
    read = ts.read(path)
    assert (read.crs, read.elevation_unit) == (tin.crs, None)


def test_elevations_come_to_the_one_unit_and_that_is_told(tmp_path):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs=32616, elevation_unit="ft")
    with pytest.warns(ts.LossWarning, match="converted from foot to metre"):
        path = ts.write(tin, tmp_path / "a.xml")
    assert ts.read(path).points[0, 2] == pytest.approx(5 * 0.3048)


def test_without_a_unit_it_is_told_and_refused_on_reading(tmp_path):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]])
    with pytest.warns(ts.LossWarning, match="no units"):
        path = ts.write(tin, tmp_path / "a.xml")
    with pytest.raises(ts.ReadError, match="does not say its units"):
        ts.read(path)
    path = ts.write(tin, tmp_path / "b.xml", unit="US survey foot")
    assert ts.read(path).elevation_unit.name == "US survey foot"


def test_a_compound_crs_comes_back(tmp_path):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:2274+6360")
    assert ts.read(ts.write(tin, tmp_path / "a.xml")).crs == "EPSG:2274+6360"


@pytest.mark.parametrize(
    ("crs", "error", "words"),
    [(4326, ts.CrsError, "degrees"), (3167, ts.WriteError, "no unit")],
)
def test_what_landxml_cannot_measure_is_refused(tmp_path, crs, error, words):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs=crs)
    with pytest.raises(error, match=words):
        ts.write(tin, tmp_path / "a.xml")
    assert not list(tmp_path.iterdir())


def test_contours_and_other_lines(survey, tmp_path):
    contours = ts.contours(ts.triangulate(survey), interval=1)
    read = ts.read(ts.write(contours, tmp_path / "a.xml"))
    assert len(read.breaklines) == len(contours)
    assert {line.coords[0, 2] for line in read.breaklines} == set(contours.columns["elevation"])
    polygons = ts.Features.of_polygons([[0, 0], [1, 0], [0, 1], [0, 0]], [0, 4], [0, 1])
    with pytest.raises(ts.FormatError, match="not polygons"):
        ts.write(polygons, tmp_path / "b.xml")


def test_names_that_xml_cannot_hold(tmp_path):
    line = ts.Breakline([[1, 1, 5], [2, 1, 6]], name='a\x00b\n"c"')
    points = [[0, 0, 5], [4, 0, 6], [0, 3, 8]]
    tin = ts.triangulate(ts.Survey(points=points, breaklines=[line], elevation_unit="m"))
    read = ts.read(ts.write(tin, tmp_path / "a.xml"))
    assert read.lines.names == ('a b "c"',)


def test_the_name_of_a_surface_goes_from_file_to_file(tmp_path):
    tin = hills(20, size=50.0, unit="m").with_name("Existing <ground> & more")
    first = ts.write(tin, tmp_path / "a.xml")
    again = ts.read(first)
    assert again.name == "Existing <ground> & more"
    moved = ts.reproject(again, "EPSG:32617")
    for made in (again, again.snapshot(), again.copy(), pickle.loads(pickle.dumps(again)), moved):
        assert ts.read(ts.write(made, tmp_path / "b.xml")).name == again.name
    assert ts.read(ts.write(again, tmp_path / "c.xml", name="Design")).name == "Design"
    assert ts.read(ts.write(tin.with_name(""), tmp_path / "d.xml")).name == "surface"


def test_the_command_line_keeps_and_sets_the_name(tmp_path):
    first = ts.write(hills(20, size=50.0, unit="m"), tmp_path / "a.xml", name="Ground 2026")
    for options, name in (((), "Ground 2026"), (("--name", "Design"), "Design")):
        done = CliRunner().invoke(
            main, ["convert", str(first), "-o", str(tmp_path / "b.xml"), *options]
        )
        assert done.exit_code == 0, done.output
        assert f'<Surface name="{name}">' in (tmp_path / "b.xml").read_text()


def test_what_receivers_of_machine_control_ask_for(survey, tmp_path):
    """Units, project and application first, one surface, ids from 1 on, no invisible faces."""
    tin = ts.triangulate(survey)
    root = ET.parse(ts.write(tin, tmp_path / "a.xml", name="EG")).getroot()
    tags = [one.tag.removeprefix(SPACE) for one in root]
    assert tags == ["Units", "CoordinateSystem", "Project", "Application", "Surfaces"]
    assert root.find(f"{SPACE}Project").get("name") == "EG"
    (surface,) = root.iter(f"{SPACE}Surface")
    assert surface.get("name") == "EG"
    ids = [int(one.get("id")) for one in root.iter(f"{SPACE}P")]
    assert ids == list(range(1, len(tin.points) + 1))
    faces = list(root.iter(f"{SPACE}F"))
    assert all(set(one.attrib) <= {"b"} for one in faces)
    corners = np.array([one.text.split() for one in faces], int)
    assert corners.shape == (len(tin.triangles), 3)
    assert {*corners.ravel().tolist()} <= {*ids}


def test_fewer_decimals_make_smaller_files_of_the_same_triangles(survey, tmp_path):
    tin = ts.triangulate(survey.points + np.array([0.123456789, 1 / 3, 1 / 7]), crs=survey.crs,
                         elevation_unit="m", breaklines=survey.breaklines[:1])  # fmt: skip
    whole = ts.write(tin, tmp_path / "a.xml")
    path = ts.write(tin, tmp_path / "b.xml", decimals=4)
    assert path.stat().st_size < 0.85 * whole.stat().st_size
    read = ts.read(path)
    assert np.array_equal(read.points, np.round(tin.points, 4))
    assert np.array_equal(read.triangles, tin.triangles)
    assert read.lines.vertices.tolist() == tin.lines.vertices.tolist()
    longest = max(len(word.partition(".")[2]) for one in ET.parse(path).getroot().iter(f"{SPACE}P")
                  for word in one.text.split())  # fmt: skip
    assert longest == 4
    points = ts.write(ts.Survey(points=tin.points), tmp_path / "c.xml", decimals=2, unit="m")
    assert np.array_equal(ts.read(points).points, np.round(tin.points, 2))


@pytest.mark.parametrize("decimals", [-1, 16, 1.5, True, "2"])
def test_decimals_that_are_none_are_refused(survey, tmp_path, decimals):
    with pytest.raises(ts.OptionError, match="decimals"):
        ts.write(ts.triangulate(survey), tmp_path / "a.xml", decimals=decimals)


@pytest.mark.parametrize(("rows", "decimals"), [(3, 0), (2, 1)])
def test_decimals_so_few_that_triangles_vanish_are_refused(tmp_path, rows, decimals):
    step = 10.0**-decimals / 4
    xy = np.array([[x, y] for x in range(rows) for y in range(rows)]) * step + 500_000
    tin = ts.triangulate(np.column_stack([xy, xy[:, 0]]), elevation_unit="m")
    with pytest.raises(ts.OptionError, match="triangles would lose area or turn over"):
        ts.write(tin, tmp_path / "a.xml", decimals=decimals)
    assert not (tmp_path / "a.xml").exists()
    ts.write(tin, tmp_path / "a.xml", decimals=decimals + 2)


def test_alignments_are_not_rounded(tmp_path):
    axis = ts.Alignment.from_points([[0, 0], [100, 0], [200, 50]])
    with pytest.raises(ts.OptionError, match="an alignment keeps all digits"):
        ts.write(axis, tmp_path / "a.xml", decimals=2)
