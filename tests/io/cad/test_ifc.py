"""Terrain of IFC: what IfcOpenShell reads of it and validates, with the rules of the schema."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.surfaces import hills

import tinsmith as ts
from tinsmith.io.cad.ifc.step import format_real, make_identifier, quote

ifcopenshell = pytest.importorskip("ifcopenshell")

VERSIONS = ["IFC4X3", "IFC4"]
UTM = "EPSG:32616"
ENGINEERING = "+proj=tmerc +lat_0=36 +lon_0=-84 +k=1 +x_0=1000 +y_0=1000 +ellps=GRS80"


def make(crs=UTM, unit="m"):
    return hills().replace(crs=crs, elevation_unit=unit)


def write_and_open(tin, path, **options):
    return ifcopenshell.open(ts.write(tin, path, **options))


def read_triangles(model, version):
    entity = {"IFC4X3": "IfcTriangulatedIrregularNetwork", "IFC4": "IfcTriangulatedFaceSet"}
    (faces,) = model.by_type(entity[version])
    return faces, np.array(faces.Coordinates.CoordList), np.array(faces.CoordIndex) - 1


@pytest.mark.parametrize("version", VERSIONS)
def test_a_tin_is_terrain_at_its_place(tmp_path, version):
    tin = make()
    model = write_and_open(tin, tmp_path / "a.ifc", version=version)
    assert model.schema_identifier == {"IFC4X3": "IFC4X3_ADD2", "IFC4": "IFC4"}[version]
    faces, points, triangles = read_triangles(model, version)
    (place,) = model.by_type("IfcMapConversion")
    origin = [place.Eastings, place.Northings, place.OrthogonalHeight]
    np.testing.assert_allclose(points + origin, tin.points, rtol=1e-15)
    assert points.min() >= 0
    assert np.array_equal(triangles, tin.triangles)
    assert (place.TargetCRS.Name, place.TargetCRS.MapUnit.Name) == (UTM, "METRE")
    terrain = model.by_type("IfcGeographicElement")[0]
    assert (terrain.Name, terrain.PredefinedType) == ("terrain", "TERRAIN")
    assert terrain.Representation.Representations[0].Items[0] == faces
    (site,) = model.by_type("IfcSite")
    assert terrain in site.ContainsElements[0].RelatedElements
    assert site.Decomposes[0].RelatingObject == model.by_type("IfcProject")[0]


def test_constrained_edges_are_flags(tmp_path):
    tin = make()
    faces, _, _ = read_triangles(write_and_open(tin, tmp_path / "a.ifc"), "IFC4X3")
    assert len(faces.Flags) == len(tin.triangles)
    assert tin.constrained.any()
    for flags, corners, constrained in zip(
        faces.Flags, tin.triangles.tolist(), tin.constrained.tolist(), strict=True
    ):
        edges = [corners[k : k + 2] if k < 2 else [corners[2], corners[0]] for k in range(3)]
        told = [edge for k, edge in enumerate(edges) if flags >> k & 1]
        opposite = [corners[k] for k in range(3) if constrained[k]]
        assert sorted(opposite) == sorted(
            next(one for one in corners if one not in edge) for edge in told
        )


@pytest.mark.parametrize("version", VERSIONS)
def test_lines_are_curves_with_their_names_and_kinds(tmp_path, version):
    tin = make()
    model = write_and_open(tin, tmp_path / "a.ifc", version=version)
    (place,) = model.by_type("IfcMapConversion")
    origin = [place.Eastings, place.Northings, place.OrthogonalHeight]
    _, *lines = model.by_type("IfcGeographicElement")
    assert [one.Name for one in lines] == list(tin.lines.names)
    assert [one.ObjectType for one in lines] == ["BREAKLINE", "SOFTBREAKLINE"]
    for line, chain in zip(lines, tin.lines.chains(), strict=True):
        (curve,) = line.Representation.Representations[0].Items
        rows = np.array(curve.Points.CoordList) + origin
        np.testing.assert_allclose(rows, tin.points[chain], rtol=1e-15)


@pytest.mark.slow
@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # its open files
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(
    ("crs", "unit"), [(UTM, "m"), ("EPSG:2274", "US survey foot"), (None, "ft"), (ENGINEERING, "m")]
)
def test_files_are_valid_by_schema_and_rules(tmp_path, version, crs, unit):
    validate = pytest.importorskip("ifcopenshell.validate")
    logger = validate.json_logger()
    model = write_and_open(make(crs, unit), tmp_path / "a.ifc", version=version)
    validate.validate(model, logger, express_rules=True)
    assert logger.statements == []
    identifiers = [one.GlobalId for one in model.by_type("IfcRoot")]
    assert len(set(identifiers)) == len(identifiers) == 7


def test_feet_are_units_and_elevations_are_brought_to_them(tmp_path):
    tin = make("EPSG:2274", "m")
    with pytest.warns(ts.LossWarning, match="converted from metre to US survey foot, as IFC has"):
        model = write_and_open(tin, tmp_path / "a.ifc")
    (place,) = model.by_type("IfcMapConversion")
    _, points, _ = read_triangles(model, "IFC4X3")
    found = points[:, 2] + place.OrthogonalHeight
    np.testing.assert_allclose(found, tin.points[:, 2] * 3937 / 1200, rtol=1e-14)
    units = model.by_type("IfcConversionBasedUnit")
    assert {one.Name for one in units} == {"US SURVEY FOOT"}
    for one in units:
        assert one.ConversionFactor.ValueComponent.wrappedValue == pytest.approx(1200 / 3937)


def test_without_a_crs_the_site_is_placed(tmp_path):
    tin = make(None, "m")
    model = write_and_open(tin, tmp_path / "a.ifc")
    assert not model.by_type("IfcMapConversion")
    (site,) = model.by_type("IfcSite")
    origin = site.ObjectPlacement.RelativePlacement.Location.Coordinates
    _, points, _ = read_triangles(model, "IFC4X3")
    np.testing.assert_allclose(points + origin, tin.points, rtol=1e-15)


def test_a_crs_without_a_code_comes_as_text(tmp_path):
    model = write_and_open(make(ENGINEERING), tmp_path / "a.ifc")
    (text,) = model.by_type("IfcWellKnownText")
    assert ts.CRS(text.WellKnownText).is_same(ENGINEERING)
    assert text.CoordinateReferenceSystem == model.by_type("IfcProjectedCRS")[0]


def test_a_file_without_units_is_told(tmp_path):
    tin = make(None, None)
    with pytest.warns(ts.LossWarning, match="has no units, since none are known"):
        model = write_and_open(tin, tmp_path / "a.ifc")
    assert model.by_type("IfcProject")[0].UnitsInContext is None
    named = write_and_open(tin, tmp_path / "b.ifc", unit="ft")
    assert named.by_type("IfcConversionBasedUnit")[0].Name == "FOOT"


def test_an_unknown_unit_of_elevations_is_told_where_the_crs_has_one(tmp_path):
    with pytest.warns(ts.LossWarning, match="unit of elevations is not known, and is told to be m"):
        ts.write(make(UTM, None), tmp_path / "a.ifc")
    ts.write(make(UTM, None), tmp_path / "b.ifc", unit="m")  # which is one, without a word


def test_the_same_bytes_and_identifiers_that_differ_between_surfaces(tmp_path):
    tin = make()
    first = ts.write(tin, tmp_path / "a.ifc").read_bytes()
    assert ts.write(tin, tmp_path / "b.ifc").read_bytes() == first
    other = tin.replace(points=tin.points + np.array([0, 0, 1]))
    ids = [
        {one.GlobalId for one in write_and_open(one, tmp_path / "c.ifc").by_type("IfcRoot")}
        for one in (tin, other)
    ]
    assert not ids[0] & ids[1]


def test_names(tmp_path):
    name = "Gel'ände \\ \U0001f30d"
    model = write_and_open(make(), tmp_path / "a.ifc", name=name)
    assert model.by_type("IfcProject")[0].Name == name
    with pytest.raises(ts.OptionError, match="name"):
        ts.write(make(), tmp_path / "b.ifc", name=" ")


def test_identifiers_are_those_of_ifcopenshell():
    guid = pytest.importorskip("ifcopenshell.guid")
    for word in ("a", "b", "terrain"):
        own = make_identifier(word).strip("'")
        assert guid.compress(guid.expand(own)) == own


@pytest.mark.parametrize("value", [0.0, -0.5, 1e-9, 1.5e-9, 1e22, 123456.789, -2e300])
def test_numbers_are_those_of_step(value):
    text = format_real(value)
    assert re.fullmatch(r"-?\d+\.\d*(E[-+]\d+)?", text)
    assert float(text) == value


def test_control_letters_become_blanks():
    assert quote("a\nb") == "'a b'"


def test_what_it_cannot_write_is_refused(tmp_path):
    degrees = ts.triangulate([[9, 50, 1], [9.1, 50, 2], [9, 50.1, 3]], crs=4326)
    with pytest.raises(ts.CrsError, match="IFC holds lengths"):
        ts.write(degrees, tmp_path / "a.ifc")
    with pytest.raises(ts.FormatError, match="triangulate it first"):
        ts.write(ts.Survey(points=np.eye(3)), tmp_path / "a.ifc")
    with pytest.raises(ts.OptionError, match="one of IFC4X3, IFC4"):
        ts.write(make(), tmp_path / "a.ifc", version="IFC2X3")
    with pytest.raises(ts.FormatError, match=r"is written, not read"):
        ts.read(ts.write(make(), tmp_path / "a.ifc"))
