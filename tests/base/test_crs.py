"""The CRS class: made of anything, equal to its text, and what it tells of units."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest

import tinsmith as ts
from tinsmith import CRS, CrsError, Unit
from tinsmith.base.crs import FOOT, METRE, US_SURVEY_FOOT

pyproj = pytest.importorskip("pyproj")

UTM = pyproj.CRS("EPSG:32616")
NEAR_UTM = UTM.to_wkt().replace("500000", "500001")
WAYS_TO_SAY_UTM = {
    "code": "EPSG:32616",
    "lower case": "epsg:32616",
    "blanks": " EPSG:32616 ",
    "digits": "32616",
    "number": 32616,
    "numpy number": np.int32(32616),
    "pyproj": UTM,
    "GDAL's WKT": UTM.to_wkt("WKT1_GDAL"),
    "ESRI's WKT": UTM.to_wkt("WKT1_ESRI"),
    "WKT 2": UTM.to_wkt("WKT2_2019"),
    "PROJJSON": UTM.to_json(),
    "CRS": CRS.of("EPSG:32616"),
}


@pytest.mark.parametrize("way", WAYS_TO_SAY_UTM)
def test_a_crs_is_made_of_anything_that_names_one(way):
    crs = CRS.of(WAYS_TO_SAY_UTM[way])
    assert isinstance(crs, CRS)
    assert str(crs) == "EPSG:32616"
    assert crs.name == "WGS 84 / UTM zone 16N"
    assert (crs.to_epsg(), crs.to_authority()) == (32616, ("EPSG", "32616"))


def test_none_stays_none():
    assert CRS.of(None) is None
    assert Unit.of(None) is None


ENTRY_POINTS = {
    "Survey": lambda crs, folder: ts.Survey(points=np.eye(3), crs=crs),
    "triangulate": lambda crs, folder: ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]], crs=crs),
    "from_triangles": lambda crs, folder: ts.TIN.from_triangles(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], crs=crs
    ),
    "read text": lambda crs, folder: ts.read(folder / "a.csv", crs=crs),
    "read a mesh": lambda crs, folder: ts.read(folder / "a.ply", crs=crs),
    "read lines": lambda crs, folder: ts.io.read_lines(folder / "a.geojson", crs=crs),
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a.csv").write_text("easting,northing,elevation\n5e5,4e6,0\n5e5,4.1e6,1\n")
    ts.write(ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), tmp_path / "a.ply")
    (tmp_path / "a.geojson").write_text(
        '{"type":"LineString","coordinates":[[-87,36,1],[-87.1,36,2]]}'
    )
    return tmp_path


@pytest.mark.parametrize("way", WAYS_TO_SAY_UTM)
@pytest.mark.parametrize("entry_point", ENTRY_POINTS)
def test_every_entry_point_takes_every_way(entry_point, way, folder):
    if entry_point == "read lines":
        pytest.importorskip("pyogrio")
    found = ENTRY_POINTS[entry_point](WAYS_TO_SAY_UTM[way], folder)
    if entry_point != "read lines":
        assert isinstance(found.crs, CRS)
        assert found.crs == "EPSG:32616"


@pytest.mark.each_value
@pytest.mark.parametrize("wrong", ["EPSG:99999", "nonsense", 7, True, 2.5, [1], "EPSG:4978", 5703])
@pytest.mark.parametrize("entry_point", ENTRY_POINTS)
def test_every_entry_point_refuses_what_is_no_crs(entry_point, wrong, folder):
    with pytest.raises(CrsError) as caught:
        ENTRY_POINTS[entry_point](wrong, folder)
    assert isinstance(caught.value, ts.TinsmithError)
    assert str(wrong) in str(caught.value)
    assert "is needed" in str(caught.value)


@pytest.mark.parametrize("text", ["EPSG:99999", "nonsense", "", "EPSG:", "PROJCRS[", "x" * 500])
def test_an_unknown_crs_is_one_short_sentence(text):
    with pytest.raises(CrsError, match="Unknown CRS") as caught:
        CRS.of(text)
    assert caught.value.crs == text
    assert len(str(caught.value)) < 200
    assert "\n" not in str(caught.value)


def test_elevations_that_grow_downwards_are_refused():
    with pytest.raises(CrsError, match="points down"):
        CRS.of("EPSG:32616+5715")


def test_it_equals_its_text_and_what_means_the_same():
    crs = CRS.of(32616)
    for same in WAYS_TO_SAY_UTM.values():
        assert crs == same
        assert not crs != same  # noqa: SIM202 - both operators are asked
    for other in ("EPSG:32617", 32617, pyproj.CRS(32617), "nonsense", None, 2.5, object()):
        assert crs != other
        assert not crs == other  # noqa: SIM201 - both operators are asked
    assert {crs: 1}["EPSG:32616"] == 1
    assert f"{crs}" == "EPSG:32616"
    assert f"{crs:.4}" == "EPSG"
    assert repr(crs) == "CRS('EPSG:32616')"


def test_other_libraries_take_it():
    crs = CRS.of(2274)
    assert pyproj.CRS(crs) == pyproj.CRS(2274)
    assert pyproj.Transformer.from_crs(crs, CRS.of(4326)).source_crs == pyproj.CRS(2274)
    rasterio = pytest.importorskip("rasterio")
    assert rasterio.crs.CRS.from_user_input(crs).to_epsg() == 2274


@pytest.mark.parametrize("value", [32616, NEAR_UTM, "EPSG:2274+6360"])
def test_copies_and_pickles_are_equal(value):
    crs = CRS.of(value)
    for again in (pickle.loads(pickle.dumps(crs)), copy.copy(crs), copy.deepcopy(crs)):
        assert again == crs
        assert hash(again) == hash(crs)
        assert again.name == crs.name


def test_unpickling_loads_no_pyproj():
    pickled = pickle.dumps(CRS.of(32616))
    code = (
        "import pickle, sys; "
        f"crs = pickle.loads({pickled!r}); assert str(crs) == 'EPSG:32616'; "
        "assert 'pyproj' not in sys.modules; assert crs.name.startswith('WGS 84')"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_a_code_it_is_wkt_and_keeps_its_meaning():
    crs = CRS.of(NEAR_UTM)
    assert str(crs).startswith("PROJCRS")
    assert crs.to_epsg() is crs.to_authority() is None
    assert crs.to_pyproj() == pyproj.CRS(NEAR_UTM)
    assert CRS.of(str(crs)) == crs
    assert crs.label == crs.caption == "WGS 84 / UTM zone 16N"
    assert not crs.is_same(32616)


def test_order_of_axes_makes_no_other_crs():
    assert CRS.of("EPSG:4326").is_same("OGC:CRS84")
    assert CRS.of("EPSG:4326") != "OGC:CRS84"


def test_a_compound_crs_of_codes_is_short():
    crs = CRS.of(pyproj.CRS("EPSG:32616+5703"))
    assert str(crs) == "EPSG:32616+5703"
    assert crs.horizontal == "EPSG:32616"
    assert CRS.of("EPSG:2274+6360") == "EPSG:8778"  # that pair has a code of its own


@pytest.mark.parametrize(
    ("crs", "horizontal", "vertical", "usual"),
    [
        ("EPSG:32616", METRE, None, METRE),
        ("EPSG:2274", US_SURVEY_FOOT, None, US_SURVEY_FOOT),
        ("EPSG:2222", FOOT, None, FOOT),
        ("EPSG:2274+5703", US_SURVEY_FOOT, METRE, METRE),
        ("EPSG:32616+6360", METRE, US_SURVEY_FOOT, US_SURVEY_FOOT),
        ("EPSG:32616+8228", METRE, FOOT, FOOT),
        ("EPSG:4326", Unit("degree", "°", None), None, METRE),
        ("EPSG:4979", Unit("degree", "°", None), METRE, METRE),
        ("EPSG:4901", Unit("grad", "grad", None), None, METRE),
        ("ESRI:102733", US_SURVEY_FOOT, None, US_SURVEY_FOOT),
        ("+proj=utm +zone=16 +units=km", Unit.of("km"), None, Unit.of("km")),
        ("+proj=utm +zone=16 +to_meter=0.5", Unit("unknown", "unknown", 0.5), None,
         Unit("unknown", "unknown", 0.5)),
    ],
)  # fmt: skip
def test_units_of_a_crs(crs, horizontal, vertical, usual):
    found = CRS.of(crs)
    assert found.horizontal_unit == horizontal
    assert found.vertical_unit == vertical
    assert found.usual_elevation_unit == usual
    assert found.is_geographic == (horizontal.metres is None)


@pytest.mark.parametrize("version", ["WKT1_GDAL", "WKT1_ESRI", "WKT2_2019"])
@pytest.mark.parametrize("code", [2274, 2222, 32616])
def test_units_are_the_same_in_every_wkt(version, code):
    wkt = pyproj.CRS(code).to_wkt(version).replace("0,", "0.5,", 1)
    assert CRS.of(wkt).horizontal_unit == CRS.of(code).horizontal_unit


@pytest.mark.parametrize(
    ("words", "metres"),
    [
        ("m M metre Metres meter", 1.0),
        ("ft foot FEET ift", 0.3048),
        ("usft us-ft ftUS US_survey_foot us_survey_feet Foot_US sft", 1200 / 3937),
        ("km", 1000.0),
        ("cm centimeter", 0.01),
        ("dm decimeter", 0.1),
        ("mm", 0.001),
        ("yd", 0.9144),
        ("in", 0.0254),
    ],
)
def test_units_as_people_write_them(words, metres):
    for word in words.split():
        assert Unit.of(word).metres == metres
        assert Unit.of(Unit.of(word)) == Unit.of(word)


def test_units_of_epsg_are_known_by_name():
    units = pyproj.get_units_map(auth_name="EPSG", category="linear")
    for name, unit in units.items():
        assert Unit.of(name).metres == pytest.approx(unit.conv_factor, rel=1e-10)
        assert Unit.of(Unit.of(name).text) == Unit.of(name)


@pytest.mark.parametrize(
    "wrong", ["", "parsec", "degree", 3, 0.3048, "m2", b"m", "µm", "m²", "m ü.M."]
)
def test_what_is_no_unit_is_refused_with_what_is_allowed(wrong):
    with pytest.raises(ts.OptionError, match="US survey foot") as caught:
        Unit.of(wrong)
    assert str(wrong) in str(caught.value)


def test_area_of_use_and_wkt():
    crs = CRS.of(32616)
    assert (crs.area_of_use.west, crs.area_of_use.east) == (-90.0, -84.0)
    assert CRS.of(NEAR_UTM).area_of_use is None or CRS.of(NEAR_UTM).area_of_use.west == -90.0
    assert crs.to_wkt("WKT1_ESRI").startswith("PROJCS[")


def test_a_survey_may_gain_a_vertical_axis_but_not_change_its_crs():
    survey = ts.Survey(points=np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), crs=2274)
    assert ts.triangulate(survey, crs="EPSG:2274").crs == 2274
    assert ts.triangulate(survey, crs="EPSG:2274+6360").elevation_unit == US_SURVEY_FOOT
    with pytest.raises(CrsError, match=r"EPSG:2274.*EPSG:32616"):
        ts.triangulate(survey, crs=32616)


def test_a_crs_equals_whatever_names_it():
    crs = CRS.of(32616)
    assert crs == 32616
    assert crs == "EPSG:32616"
    assert crs == CRS.of("epsg:32616")
    assert hash(crs) == hash(CRS.of("epsg:32616"))
    for other in (None, 32617, "EPSG:32617", "nonsense", object(), CRS.of(32617)):
        assert crs != other


def test_an_array_is_no_crs_in_a_sentence_of_one_line():
    with pytest.raises(CrsError, match=r"^Unknown CRS an array of shape \(2, 2, 2\): an auth"):
        CRS(np.zeros((2, 2, 2)))


def test_an_array_is_no_unit_in_a_sentence_of_one_line():
    with pytest.raises(ts.OptionError, match=r"^Invalid unit of elevations an array of shape"):
        Unit.of(np.ma.masked_array([[1.0, 2.0]], mask=[[True, False]]))
