"""LandXML as other programs write it: surfaces, units, axes, and what is refused."""

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from support.refusals import refuse

import tinsmith as ts

DATA = Path(__file__).parents[3] / "data" / "landxml"
METRIC = '<Units><Metric linearUnit="meter" areaUnit="squareMeter"/></Units>'
FEET = '<Units><Imperial linearUnit="foot"/></Units>'
SURVEY_FEET = '<Units><Imperial linearUnit="USSurveyFoot"/></Units>'
NAMESPACE = 'xmlns="http://www.landxml.org/schema/LandXML-1.2"'
CORNERS = [(0, 0, 1), (4, 0, 2), (4, 4, 3), (0, 4, 4)]


def points_of(rows, ids=None):
    """Write P elements of easting, northing, elevation."""
    ids = range(1, len(rows) + 1) if ids is None else ids
    return "".join(f'<P id="{k}">{n} {e} {z}</P>' for k, (e, n, z) in zip(ids, rows, strict=True))


def surface(points=None, faces="<F>1 2 3</F><F>1 3 4</F>", name="EG", source=""):
    points = points_of(CORNERS) if points is None else points
    return (
        f'<Surface name="{name}">{source}<Definition surfType="TIN"><Pnts>{points}</Pnts>'
        f"<Faces>{faces}</Faces></Definition></Surface>"
    )


def document(*surfaces, units=METRIC, system="", points="", root=NAMESPACE):
    held = f"<Surfaces>{''.join(surfaces)}</Surfaces>" if surfaces else ""
    content = f"{units}{system}{points}{held}"
    return f'<?xml version="1.0"?><LandXML {root} version="1.2">{content}</LandXML>'


@pytest.fixture
def write(tmp_path):
    def place(text, name="a.xml", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text.encode(encoding))
        return path

    return place


def refused(words, path, error=ts.ReadError, **options):
    return refuse(words, ts.read, path, error=error, **options)


def read_plainly(path, name):
    """Read visible faces with another XML library: sets of corners, easting first."""
    root = ET.parse(path).getroot()
    space = root.tag.removesuffix("LandXML")
    (found,) = [one for one in root.iter(f"{space}Surface") if one.get("name") == name]
    points = {}
    for one in found.iter(f"{space}P"):
        n, e, z = map(float, one.text.split())
        points[one.get("id")] = (e, n, z)
    return {
        frozenset(points[k] for k in one.text.split())
        for one in found.iter(f"{space}F")
        if one.get("i") != "1"
    }


def corners_of(tin):
    return {frozenset(map(tuple, tin.points[triangle].tolist())) for triangle in tin.triangles}


# ------------------------------------------------------------------ files of programs


@pytest.mark.parametrize(
    ("name", "surface", "unit", "n_lines"),
    [
        ("civil3d_2020_breaklines.xml", "DGM_PW", "metre", 2),
        ("civil3d_2020_25_breaklines.xml", "surface", "foot", 25),
    ],
)
def test_a_surface_of_civil_3d_keeps_its_own_triangles(name, surface, unit, n_lines):
    tin = ts.read(DATA / name)
    assert corners_of(tin) == read_plainly(DATA / name, surface)
    assert tin.elevation_unit.name == unit
    source = ts.read(DATA / name, content="source")
    assert len(source.breaklines) == n_lines
    assert all(line.coords.shape == (5, 3) for line in source.breaklines)


def test_breaklines_of_civil_3d_are_found_along_edges_whatever_their_last_digits():
    tin = ts.read(DATA / "civil3d_2020_breaklines.xml")
    assert set(tin.lines.kinds) == {"hard"}
    assert set(tin.lines.names) == {"Oberkante", "Unterkante"}
    assert len(tin.lines) == 2
    for chain in tin.lines.chains():
        assert chain[0] == chain[-1]
        assert len(chain) > 20  # Civil 3D puts vertices on the segments too
    assert {one.kind for one in ts.check(tin, level=2).problems} <= {"boundary", "hull", "euler"}


@pytest.mark.parametrize(
    "text",
    [
        document(surface()),
        document(surface()).replace(NAMESPACE, 'xmlns="http://www.landxml.org/schema/LandXML-1.0"'),
        document(surface()).replace(NAMESPACE, ""),
        document(surface(points_of(CORNERS, [5, 1_000_000_007, 7, -3]),
                         "<F>5 1000000007 7</F><F>5 7 -3</F>")),
        document(surface(faces="<F>3 2 1</F><F>4 3 1</F>")),
        document(surface(faces="<F n='2 0 0'>1 2 3</F></Faces><Faces name='2'><F i='0'>1 3 4</F>")),
        document(surface(faces="<F>\n 1\t2\r\n 3 </F><F>1 3 4</F><F i='1'>1 2 4</F>")),
        document(surface()).replace("<", "<lx:").replace("<lx:/", "</lx:").replace("<lx:?", "<?")
        .replace("xmlns=", "xmlns:lx="),
        document(surface(points_of([(f"{e}.", f"{n}.0e0", z) for e, n, z in CORNERS]))),
    ],
    ids=["plain", "1.0", "no namespace", "ids", "clockwise", "groups", "white space", "prefix",
         "numbers"],
)  # fmt: skip
def test_manners_of_writers(write, text):
    tin = ts.read(write(text))
    assert tin.points.tolist() == [list(map(float, row)) for row in CORNERS]
    assert len(tin.triangles) == 2
    assert tin.area == 16


def test_encodings(write):
    text = document(surface(name="Höhen"))
    for encoding in ("utf-8", "utf-8-sig"):
        assert len(ts.read(write(text, encoding=encoding), surface="Höhen").triangles) == 2
    for encoding in ("utf-16", "iso-8859-1", "windows-1252"):
        declared = text.replace('version="1.0"?', f'version="1.0" encoding="{encoding}"?')
        assert len(ts.read(write(declared, encoding=encoding), surface="Höhen").triangles) == 2


def test_points_of_no_visible_face_are_left_out_and_told(write):
    points = points_of([*CORNERS, (9, 9, -99), (8, 8, 0)])
    tin = ts.read(write(document(surface(points, "<F>1 2 3</F><F>1 3 4</F><F i='1'>3 5 4</F>"))))
    assert tin.points[:, 2].min() == 1
    told = " ".join(tin.report.notes)
    assert "1 invisible face." in told
    assert "2 points of no visible triangle left out" in told


def test_elevations_that_stand_for_no_data_are_told(write):
    corners = [(float(x), float(y), 100.0 + x + y) for x in range(5) for y in range(5)]
    corners[7] = (*corners[7][:2], -9999.0)
    tin = ts.triangulate(corners)
    faces = "".join(f"<F>{a} {b} {c}</F>" for a, b, c in (tin.triangles + 1).tolist())
    read = ts.read(write(document(surface(points_of(tin.points.tolist()), faces))))
    assert np.count_nonzero(read.points[:, 2] == -9999.0) == 1
    (note,) = [note for note in read.report.notes if "-9999" in note]
    assert "no data" in note


def test_corners_given_once_for_each_face_become_one(write):
    rows = [CORNERS[k] for k in (0, 1, 2, 0, 2, 3)]
    tin = ts.read(write(document(surface(points_of(rows), "<F>1 2 3</F><F>4 5 6</F>"))))
    assert len(tin.points) == 4
    assert (tin.neighbors >= 0).sum() == 2
    assert "2 points have the coordinates of another one" in tin.report.notes[0]


def test_sides_marked_as_breaklines_are_constrained(write):
    tin = ts.read(write(document(surface(faces='<F b="4">1 2 3</F><F b="1">1 3 4</F>'))))
    edges = {
        frozenset(np.delete(tin.triangles[t], corner).tolist())
        for t, corner in np.argwhere(tin.constrained)
    }
    assert edges == {frozenset({0, 2})}


def test_points_may_refer_to_survey_points(write):
    group = (
        '<CgPoints><CgPoint name="a">0 0 1</CgPoint><CgPoint name="b">0 4 2</CgPoint></CgPoints>'
    )
    points = '<P id="1" pntRef="a"/><P id="2" pntRef="b"></P>' + points_of(CORNERS[2:], [3, 4])
    tin = ts.read(write(document(surface(points), points=group)))
    assert tin.points.tolist() == [list(map(float, row)) for row in CORNERS]
    refused(
        "'c', which there is not",
        write(document(surface(points.replace('"b"', '"c"')), points=group)),
    )


# ------------------------------------------------------------------ several surfaces


def test_one_of_several_surfaces_is_chosen_by_name_or_number(write):
    other = surface(points_of([(e + 9, n, z) for e, n, z in CORNERS]), name="FG")
    path = write(document(surface(), other, surface(name="FG")))
    assert "'EG', 'FG', 'FG'" in refused("has 3 surfaces", path)
    assert ts.read(path, surface="EG").bounds.xmin == 0
    assert ts.read(path, surface=2).bounds.xmin == 9
    assert ts.read(path, surface="2").bounds.xmin == 9
    refused(r"by its number in the file \(2, 3\)", path, surface="FG")
    refused("Invalid surface 'XX'.*'EG'", path, error=ts.OptionError, surface="XX")
    refused("Invalid surface", path, error=ts.OptionError, surface="")
    assert "'FG'" in " ".join(ts.read(path, surface="EG").report.notes)


def test_an_empty_surface_is_no_second_one(write):
    empty = '<Surface name="old"><Definition surfType="TIN"/></Surface>'
    tin = ts.read(write(document(empty, surface())))
    assert len(tin.triangles) == 2
    assert "Not read: 1 surface ('old')." in tin.report.notes


def test_a_grid_is_refused(write):
    text = document(surface(faces="<F>1 2 3 4</F>")).replace('"TIN"', '"grid"')
    refused("is a grid", write(text))


# ------------------------------------------------------------------ units and axes


def test_a_file_without_units_is_refused_until_told(write):
    path = write(document(surface(), units=""))
    text = refused("does not say its units", path)
    assert "--" not in text
    assert ts.read(path, elevation_unit="ft").elevation_unit.name == "foot"
    assert ts.read(path, unit="m").elevation_unit.name == "metre"


@pytest.mark.parametrize(
    ("system", "name", "unit"),
    [
        ("Metric", "meter", "metre"),
        ("Metric", "millimeter", "millimetre"),
        ("Metric", "centimeter", "centimetre"),
        ("Metric", "kilometer", "kilometre"),
        ("Imperial", "foot", "foot"),
        ("Imperial", "USSurveyFoot", "US survey foot"),
        ("Imperial", "inch", "inch"),
        ("Imperial", "mile", "Statute mile"),
    ],
)
def test_units_of_lengths(write, system, name, unit):
    path = write(document(surface(), units=f'<Units><{system} linearUnit="{name}"/></Units>'))
    assert ts.read(path).elevation_unit.name == unit
    refused("unit of elevations", path, error=ts.OptionError, elevation_unit="yd")


def test_an_unknown_unit_and_two_units_are_refused(write):
    refused("'cubit'", write(document(surface(), units=METRIC.replace("meter", "cubit"))))
    refused("gives its units twice", write(document(surface(), units=METRIC + FEET)))


def test_another_unit_of_elevations_has_two_readings(write):
    units = '<Units><Imperial linearUnit="foot" elevationUnit="meter"/></Units>'
    path = write(document(surface(), units=units))
    refused("`elevation_unit='foot'` or `elevation_unit='metre'`", path)
    tin = ts.read(path, elevation_unit="foot")
    assert (tin.elevation_unit.name, tin.points[0, 2]) == ("foot", 1)
    tin = ts.read(path, elevation_unit="m")
    assert tin.elevation_unit.name == "foot"
    assert tin.points[0, 2] == pytest.approx(1 / 0.3048)
    feet = units.replace("foot", "USSurveyFoot").replace("meter", "feet")
    assert ts.read(write(document(surface(), units=feet))).elevation_unit.name == "US survey foot"


UTM = [(e + 500_000, n + 4_000_000, z) for e, n, z in CORNERS]
SYSTEM = '<CoordinateSystem epsgCode="32616"/>'


def test_the_crs_is_read_by_code_by_wkt_and_by_name(write):
    wkt = ts.CRS(32616).to_wkt("WKT1_GDAL").replace('"', "&quot;")
    for system in (
        SYSTEM,
        f'<CoordinateSystem ogcWktCode="{wkt}"/>',
        f'<CoordinateSystem desc="x" epsgCode="EPSG:32616" ogcWktCode="{wkt}"/>',
        '<CoordinateSystem name="WGS 84 / UTM zone 16N"/>',
    ):
        tin = ts.read(write(document(surface(points_of(UTM)), system=system)))
        assert tin.crs == "EPSG:32616"
    words = '<CoordinateSystem desc="site grid of 1953"/>'
    tin = ts.read(write(document(surface(), system=words)))
    assert tin.crs is None
    assert "'site grid of 1953'" in tin.report.notes[0]


def test_two_different_crs_are_refused(write):
    wkt = ts.CRS(32633).to_wkt("WKT1_GDAL").replace('"', "&quot;")
    system = f'<CoordinateSystem epsgCode="32616" ogcWktCode="{wkt}"/>'
    path = write(document(surface(points_of(UTM)), system=system))
    refused("names two CRSs", path)
    refused("another CRS", path, error=ts.CrsError, crs=32633)


def test_a_wkt_that_leads_nowhere_is_another_crs(write):
    wkt = ts.CRS(32616).to_wkt("WKT1_GDAL").replace("Transverse_Mercator", "Transverse_Nonsense")
    wkt = wkt.replace('AUTHORITY["EPSG","32616"]', 'AUTHORITY["EPSG","1"]').replace('"', "&quot;")
    system = f'<CoordinateSystem epsgCode="32616" ogcWktCode="{wkt}"/>'
    path = write(document(surface(points_of(UTM)), system=system))
    refused("names two CRSs", path)


def test_lines_far_beyond_any_coordinate_are_no_edges(write):
    line = "<PntList3D>0 0 1 -1e308 4 3</PntList3D>"
    source = f"<SourceData><Breaklines><Breakline>{line}</Breakline></Breaklines></SourceData>"
    tin = ts.read(write(document(surface(source=source))))
    assert len(tin.lines) == 0
    assert "1 line of 1 does not run along edges" in tin.report.notes[0]


def test_units_that_the_crs_does_not_have_are_refused_until_told(write):
    path = write(document(surface(points_of(UTM)), system=SYSTEM, units=FEET))
    refused("`unit='foot'` or `unit='metre'`", path)
    refused("Invalid unit 'yard'", path, error=ts.OptionError, unit="yd")
    tin = ts.read(path, unit="m")
    assert (tin.points[0].tolist(), tin.elevation_unit.name) == ([500_000, 4_000_000, 1], "metre")
    tin = ts.read(path, unit="ft")
    assert tin.points[0] == pytest.approx([152_400, 1_219_200, 1])
    assert tin.elevation_unit.name == "foot"
    assert "Coordinates were converted from foot to metre" in " ".join(tin.report.notes)
    path = write(document(surface(), units=SURVEY_FEET))
    refused("`unit='US survey foot'` or `unit='foot'`", path, crs=2222)


def test_easting_before_northing_is_found_by_the_area_of_the_crs(write):
    wrong = [(n, e, z) for e, n, z in UTM]
    tin = ts.read(write(document(surface(points_of(wrong)), system=SYSTEM)))
    assert sorted(map(tuple, tin.points.tolist())) == sorted(UTM)
    assert "in the other order" in tin.report.notes[0]


def test_a_tin_is_not_reprojected_but_points_are(write):
    group = "<CgPoints>" + "".join(
        f'<CgPoint name="{k}">{n} {e} {z}</CgPoint>' for k, (e, n, z) in enumerate(UTM)
    ) + "</CgPoints>"  # fmt: skip
    refused("another CRS", write(document(surface(points_of(UTM)), system=SYSTEM)),
            error=ts.CrsError, crs=32617)  # fmt: skip
    survey = ts.read(write(document(system=SYSTEM, points=group)), crs=32617)
    assert survey.crs == "EPSG:32617"
    assert survey.points[:, 0].max() < 0


# ------------------------------------------------------------------ hostile texts

BOMB = '<!DOCTYPE a [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;">]>'


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('<?xml version="1.0"?>', f'<?xml version="1.0"?>{BOMB}', "document type"),
        ('<?xml version="1.0"?>', '<!DOCTYPE LandXML SYSTEM "http://127.0.0.1:9/a">', "document"),
        ("<Surfaces>", '<xi:include xmlns:xi="x" href="b.xml"/><Surfaces>', "includes another"),
        ("<F>1 2 3</F>", "<F>1 2 &x;</F>", "well-formed"),
        ("</LandXML>", "", "cut short"),
        ("<F>1 2 3</F>", "<F>1 2</F>", r"2 numbers \('1 2'\), not 3"),
        ("<F>1 2 3</F>", "<F>1 2 3 4</F>", "4 numbers"),
        ("<F>1 2 3</F>", "<F>1 2 x</F>", "'x', not whole numbers"),
        ("<F>1 2 3</F>", "<F>1 2 3.0</F>", "'3.0', not whole numbers"),
        ("<F>1 2 3</F>", "<F>1 2 1_0</F>", "'1_0'"),
        ("<F>1 2 3</F>", "<F>1 2 9</F>", "point 9, and there is no point"),
        ("<F>1 2 3</F>", "<F>1 2 99999999999999999999</F>", "whole numbers of at most 18 digits"),
        ("<F>1 2 3</F>", "<F>1 2 9223372036854775807</F>", "at most 18 digits"),
        ("<F>1 2 3</F>", "<F>1 2 2</F>", "no area"),
        ("<F>1 2 3</F>", "<F>1 2 3</F><F>1 2 3</F>", "holds no TIN"),
        ("<F>1 2 3</F>", "<F i='2'>1 2 3</F>", "i='2'"),
        ("<F>1 2 3</F>", "<F b='8'>1 2 3</F>", "b='8'"),
        ("<F>1 2 3</F>", "<F>1<F>2 3</F></F>", "numbers"),
        ('<P id="2">', '<P id="1">', "id 1 stands for two points"),
        ('<P id="2">', '<P id="-99999999999999999999">', "at most 18 digits"),
        ('<P id="2">', "<P>", "the id of a point has 0 numbers"),
        (">0 0 1<", ">0 0<", "2 numbers"),
        (">0 0 1<", ">0 0 nan<", "'nan', not numbers"),
        (">0 0 1<", ">0 0 inf<", "'inf'"),
        (">0 0 1<", ">0 0 1e400<", "holds no TIN"),
        (">0 0 1<", ">0 0 1d0<", "'1d0'"),
        (">0 0 1<", ">0,0,1<", "'0,0,1'"),
        (">0 0 1<", ">0 0 1-2<", "'1-2'"),
        (">0 0 1<", f">0 0 1e{'9' * 400}<", "TIN"),
        (">0 0 1<", f">0 0 {'1' * 400}<", "TIN"),
        ("<Surfaces>", "<a>" * 300, "nested more than 200"),
        ("<LandXML", "<GML", "no LandXML|XML document"),
    ],
)
def test_what_is_no_landxml_is_refused_with_its_line(write, before, after, words):
    text = document(surface())
    assert before in text
    error = (ts.ReadError, ts.FormatError)
    refused(words, write(text.replace(before, after, 1)), error=error)


def test_another_encoding_is_refused(write):
    text = document(surface()).replace('version="1.0"?', 'version="1.0" encoding="klingon"?')
    refused("encoding|well-formed", write(text))


def test_the_line_at_fault_is_named(write):
    text = document(surface()).replace("<P ", "\n<P ").replace(">0 4 2<", ">0 4 x<")
    with pytest.raises(ts.ReadError, match="line 3: a point has 'x'") as caught:
        ts.read(write(text))
    assert caught.value.line == 3


def test_ids_as_large_as_can_be_take_no_memory(write):
    ids = [1, 10**17, 10**18 - 1, -(10**18 - 1)]
    faces = f"<F>1 {ids[1]} {ids[2]}</F><F>1 {ids[2]} {ids[3]}</F>"
    assert len(ts.read(write(document(surface(points_of(CORNERS, ids), faces)))).points) == 4
