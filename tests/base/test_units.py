"""Elevations and their unit: known, declared or unknown; one slope everywhere."""

from __future__ import annotations

import copy
import json
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith import TIN, OptionError, Survey, Unit
from tinsmith.base.crs import FOOT, METRE, US_SURVEY_FOOT
from tinsmith.base.georeference.scales import find_ground
from tinsmith.cli import main

CORNER = np.array([742_000.0, 4_030_000.0, 300.0])
TRIANGLES = [[0, 1, 2]]
US_FOOT = 1200 / 3937

# CRS, unit declared, metres in a unit of easting, metres in a unit of elevation
GROUNDS = {
    "metres": ("EPSG:32616", "m", 1.0, 1.0),
    "metres, not told": ("EPSG:32616", None, 1.0, 1.0),
    "US survey feet, not told": ("EPSG:2274", None, US_FOOT, US_FOOT),
    "international feet": ("EPSG:2222", "ft", 0.3048, 0.3048),
    "metres up from US survey feet": ("EPSG:2274", "m", US_FOOT, 1.0),
    "metres up, by the vertical axis": ("EPSG:2274+5703", None, US_FOOT, 1.0),
    "feet up from metres": ("EPSG:32616", "ft", 1.0, 0.3048),
    "US survey feet up from metres": ("EPSG:32616", "US survey foot", 1.0, US_FOOT),
    "US survey feet up, by the vertical axis": ("EPSG:32616+6360", None, 1.0, US_FOOT),
    "international feet up from US survey feet": ("EPSG:2274", "ft", US_FOOT, 0.3048),
    "centimetres up": ("EPSG:32616", "cm", 1.0, 0.01),
    "nothing known": (None, None, 1.0, 1.0),
    "feet up from nothing known": (None, "ft", 1.0, 1.0),
}


def steep(ground, *, degrees=45.0, origin=CORNER):
    """Return a triangle that falls to the west, at a slope on the ground that is known."""
    crs, unit, along, up = GROUNDS[ground]
    rise = np.tan(np.radians(degrees)) * 100.0 * along / up
    points = origin + np.array([[0, 0, 0], [100, 0, rise], [0, 100, 0]])
    return TIN.from_triangles(points, TRIANGLES, crs=crs, elevation_unit=unit)


def slope_of_terrain(tin, folder):
    return ts.terrain.slope(tin)[0]


def slope_of_geojson(tin, folder):
    ts.write(tin, folder / "a.geojson", projected=True)
    return json.loads((folder / "a.geojson").read_text())["features"][0]["properties"]["slope"]


def slope_of_info(tin, folder):
    ts.write(tin, folder / "a.ply")
    facts = invoke("info", folder / "a.ply", "--json")
    return json.loads(facts.stdout)["slope"]["max"]


def slope_of_vtp(tin, folder):
    pv = pytest.importorskip("pyvista")
    ts.write(tin, folder / "a.vtp")
    return pv.read(folder / "a.vtp").cell_data["slope"][0]


def slope_of_lift(tin, folder):
    pytest.importorskip("pyvista")
    return ts.terrain.lift(tin).cell_data["slope"][0]


def slope_of_lifted_shape(tin, folder):
    pytest.importorskip("pyvista")
    return angle_to_the_plane(ts.terrain.lift(tin).points)


def slope_of_scene(tin, folder):
    return angle_to_the_plane(tin.points * find_ground(tin).scale)


def slope_of_areas(tin, folder):
    return np.degrees(np.arccos(tin.area / tin.surface_area))


def angle_to_the_plane(points):
    normal = np.cross(points[1] - points[0], points[2] - points[0])
    return np.degrees(np.arccos(normal[2] / np.linalg.norm(normal)))


ENTRY_POINTS = (
    slope_of_terrain,
    slope_of_geojson,
    slope_of_info,
    slope_of_vtp,
    slope_of_lift,
    slope_of_lifted_shape,
    slope_of_scene,
    slope_of_areas,
)


def invoke(*arguments, code=0):
    result = CliRunner().invoke(main, [str(one) for one in arguments])
    assert result.exit_code == code, result.stderr
    return result


@pytest.mark.each_value
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("entry_point", ENTRY_POINTS)
@pytest.mark.parametrize("degrees", [45.0, 73.05])
def test_every_slope_is_that_of_the_true_surface(entry_point, ground, degrees, tmp_path):
    tin = steep(ground, degrees=degrees)
    assert entry_point(tin, tmp_path) == pytest.approx(degrees, abs=1e-4)


@pytest.mark.parametrize("ground", GROUNDS)
def test_aspect_does_not_depend_on_units(ground):
    assert ts.terrain.aspect(steep(ground))[0] == 270.0


@pytest.mark.parametrize("latitude", [-42.0, 0.0, 36.5, 70.0])
@pytest.mark.parametrize("unit", [None, "m", "ft"])
def test_slope_and_aspect_in_degrees_are_those_in_a_projected_crs(latitude, unit, tmp_path):
    """The same three places in degrees, and in a transverse Mercator through them."""
    up = 1.0 if unit is None else Unit.of(unit).metres
    places = np.array(
        [[10, latitude, 0], [10.0004, latitude, 4], [10.0001, latitude + 0.0003, 2.5]]
    )
    local = f"+proj=tmerc +lat_0={latitude} +lon_0=10.0002 +ellps=WGS84 +units=m"
    flat = TIN.from_triangles(ts.io.transform_points(places, 4326, local), TRIANGLES, crs=local)
    degrees = TIN.from_triangles(places / (1, 1, up), TRIANGLES, crs=4326, elevation_unit=unit)
    expected = ts.terrain.slope(flat)[0]
    assert expected > 2.0
    assert slope_of_terrain(degrees, tmp_path) == pytest.approx(expected, abs=1e-3)
    assert slope_of_geojson(degrees, tmp_path) == pytest.approx(expected, abs=1e-3)
    assert slope_of_info(degrees, tmp_path) == pytest.approx(expected, abs=1e-3)
    assert slope_of_scene(degrees, tmp_path) == pytest.approx(expected, abs=1e-3)
    assert ts.terrain.aspect(degrees)[0] == pytest.approx(ts.terrain.aspect(flat)[0], abs=0.02)


def test_grads_are_no_degrees():
    degrees = np.array([[10, 45, 0], [10.004, 45, 40], [10.001, 45.003, 25.0]])
    one = TIN.from_triangles(degrees, TRIANGLES, crs="+proj=longlat +ellps=plessis")
    grads = degrees * (400 / 360, 400 / 360, 1)
    other = TIN.from_triangles(grads, TRIANGLES, crs="EPSG:4901")
    assert ts.terrain.slope(other) == pytest.approx(ts.terrain.slope(one), rel=1e-6)


def test_angles_have_no_surface_area():
    tin = TIN.from_triangles([[10, 45, 0], [10.1, 45, 4], [10, 45.1, 2]], TRIANGLES, crs=4326)
    for measure in (
        lambda: tin.surface_area,
        lambda: ts.tin.quality(tin, space=True),
    ):
        with pytest.raises(ts.CrsError, match="a projected CRS is needed"):
            measure()


def test_shapes_in_space_take_both_units():
    metres, mixed = steep("metres"), steep("feet up from metres")
    for name in ("min_angle", "edge_lengths"):
        one, other = (getattr(ts.tin.quality(tin, space=True), name) for tin in (metres, mixed))
        assert other == pytest.approx(one, rel=1e-9)


# ------------------------------------------------------------------ what is known


@pytest.mark.parametrize(
    ("crs", "declared", "known"),
    [
        (None, None, None),
        (None, "ft", FOOT),
        ("EPSG:32616", None, None),
        ("EPSG:2274", None, None),
        ("EPSG:2274", "m", METRE),
        ("EPSG:2274", Unit.of("usft"), US_SURVEY_FOOT),
        ("EPSG:2274+5703", None, METRE),
        ("EPSG:2274+5703", "metre", METRE),
        ("EPSG:4979", None, METRE),
    ],
)
def test_the_unit_is_known_by_the_vertical_axis_or_declared(crs, declared, known):
    points = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
    survey = Survey(points=np.array(points), crs=crs, elevation_unit=declared)
    for found in (
        survey,
        ts.triangulate(survey),
        ts.triangulate(points, crs=crs, elevation_unit=declared),
        ts.triangulate(points, breaklines=[points[:2]], crs=crs, elevation_unit=declared),
        TIN.from_triangles(points, TRIANGLES, crs=crs, elevation_unit=declared),
    ):
        assert found.elevation_unit == known
    tin = ts.triangulate(survey)
    for again in (copy.copy(tin), copy.deepcopy(tin), pickle.loads(pickle.dumps(tin))):
        assert (again.crs, again.elevation_unit) == (tin.crs, known)
    assert ts.tin.refine(tin, min_angle=20).elevation_unit == known
    tin.insert([[0.25, 0.25, 1.0]])
    assert (str(tin.crs or ""), tin.elevation_unit) == (crs or "", known)


def test_two_units_that_differ_are_refused():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    feet = Survey(points=points, elevation_unit="ft")
    for both in (
        lambda: Survey(points=points, crs="EPSG:2274+5703", elevation_unit="ft"),
        lambda: ts.triangulate(points, crs="EPSG:2274+5703", elevation_unit="ft"),
        lambda: TIN.from_triangles(points, TRIANGLES, crs="EPSG:2274+5703", elevation_unit="ft"),
        lambda: ts.triangulate(feet, elevation_unit="m"),
        lambda: ts.triangulate(feet, crs="EPSG:2274+5703"),
    ):
        with pytest.raises(OptionError, match="unit of elevations"):
            both()


def test_a_declared_unit_that_is_none_is_refused_before_any_work(tmp_path):
    with pytest.raises(OptionError, match=r"'parsec'.*US survey foot"):
        ts.read(tmp_path / "missing.csv", elevation_unit="parsec")
    with pytest.raises(OptionError, match="parsec"):
        ts.triangulate([[0, 0, 0]], elevation_unit="parsec")
    said = invoke("info", "missing.csv", "--elevation-unit", "parsec", code=2).stderr
    assert "Invalid unit of elevations 'parsec'" in said
    assert "(--elevation-unit)" in said


# ------------------------------------------------------------------ reading


@pytest.fixture
def summit(tmp_path):
    path = tmp_path / "summit.csv"
    path.write_text(
        "easting,northing,elevation\n751428,4020862,1032\n751438,4020862,1031\n751428,4020872,1030\n"
    )
    return path


def test_a_summit_in_metres_is_reprojected_to_feet_and_back(summit, tmp_path):
    feet = ts.read(summit, source_crs=32616, crs=2274)
    assert feet.points[0, 2] == pytest.approx(3385.82, abs=1e-9)
    assert "converted to US survey foot" in feet.notes[-1]
    ts.write(feet, tmp_path / "feet.csv")
    back = ts.read(tmp_path / "feet.csv", source_crs=2274, crs=32616)
    assert back.points == pytest.approx(ts.read(summit).points, rel=1e-9)


@pytest.mark.parametrize(
    ("declared", "expected", "known"),
    [
        ("m", 3385.82, US_SURVEY_FOOT),
        ("ft", 1032 * 0.3048 / US_FOOT, US_SURVEY_FOOT),
        ("US survey foot", 1032.0, US_SURVEY_FOOT),
        (None, 3385.82, None),
    ],
)
def test_a_declared_unit_is_that_of_the_file(summit, declared, expected, known):
    survey = ts.read(summit, source_crs=32616, crs=2274, elevation_unit=declared)
    assert survey.points[0, 2] == pytest.approx(expected, rel=1e-12)
    assert survey.elevation_unit == known


def test_without_a_reprojection_a_declared_unit_stays(summit):
    survey = ts.read(summit, crs=32616, elevation_unit="ft")
    assert survey.points[0, 2] == 1032.0
    assert survey.elevation_unit == FOOT


def test_elevations_take_the_unit_of_the_vertical_axis(summit):
    survey = ts.read(summit, crs="EPSG:32616+6360", elevation_unit="m")
    assert survey.points[0, 2] == pytest.approx(3385.82)
    assert survey.elevation_unit == US_SURVEY_FOOT
    assert "converted from metre to US survey foot" in survey.notes[-1]


def test_geojson_is_in_metres_whatever_the_unit(tmp_path):
    for ground in GROUNDS:
        crs, _, _, up = GROUNDS[ground]
        if crs is None:
            continue
        tin = steep(ground, origin=np.array([742_000.0, 1_000_000.0, 300.0]))
        ts.write(tin, tmp_path / "a.geojson", kind="points")
        content = json.loads((tmp_path / "a.geojson").read_text())
        written = [one["geometry"]["coordinates"][2] for one in content["features"]]
        assert written == pytest.approx(tin.points[:, 2] * up, abs=1e-6), ground
        says = "US survey foot" in content.get("elevations", "")
        assert says == (ground == "US survey feet, not told")


@pytest.fixture
def dem(tmp_path):
    """Return a writer of a small DEM with a unit, scale and offset of the band."""
    rasterio = pytest.importorskip("rasterio")

    def write(unit=None, crs="EPSG:32616", scale=1.0, offset=0.0):
        array = np.arange(12, dtype=np.int16).reshape(3, 4) + 1000
        path = tmp_path / "dem.tif"
        how = {"driver": "GTiff", "width": 4, "height": 3, "count": 1, "dtype": "int16"}
        place = rasterio.Affine(10.0, 0.0, 751_428.0, 0.0, -10.0, 4_020_862.0)
        with rasterio.open(path, "w", crs=crs, transform=place, **how) as out:
            out.write(array, 1)
            out.scales, out.offsets = (scale,), (offset,)
            if unit is not None:
                out.units = (unit,)
        return path

    return write


@pytest.mark.parametrize(
    ("unit", "known"),
    [
        ("m", METRE),
        ("metre", METRE),
        ("ft", FOOT),
        ("US survey foot", US_SURVEY_FOOT),
        ("us-ft", US_SURVEY_FOOT),
        ("cm", Unit.of("cm")),
        (None, None),
    ],
)
def test_the_unit_of_a_band_is_honoured(dem, unit, known):
    survey = ts.read(dem(unit))
    assert survey.elevation_unit == known
    assert survey.points[0, 2] == 1000.0
    moved = ts.read(dem(unit), crs=2274)
    up = 1.0 if known is None else known.metres
    assert moved.points[0, 2] == pytest.approx(1000 * up / US_FOOT)


def test_scale_offset_and_unit_of_a_band_work_together(dem):
    survey = ts.read(dem("ft", scale=0.1, offset=50.0), crs="EPSG:32616+5703")
    assert survey.points[0, 2] == pytest.approx(150.0 * 0.3048)
    assert survey.elevation_unit == METRE


def test_a_band_and_a_vertical_axis_that_differ_ask_for_a_word(dem):
    path = dem("ft", crs="EPSG:32616+5703")
    with pytest.raises(ts.ReadError, match=r"two units: foot .* and metre"):
        ts.read(path)
    with pytest.raises(ts.ReadError, match="two units"):
        ts.read(path, elevation_unit="cm")
    assert ts.read(path, elevation_unit="m").points[0, 2] == 1000.0
    assert ts.read(path, elevation_unit="ft").points[0, 2] == pytest.approx(304.8)


def test_a_band_in_something_else_than_a_length_is_told(dem):
    survey = ts.read(dem("dB"))
    assert survey.elevation_unit is None
    assert "'dB', is no length" in survey.notes[0]
    assert ts.read(dem("dB"), elevation_unit="m").notes == []


def test_what_a_file_says_is_not_overruled(dem):
    with pytest.raises(OptionError, match=r"'foot'.*metre, as '.*dem.tif' itself says"):
        ts.read(dem("m"), elevation_unit="ft")


# ------------------------------------------------------------------ round trips


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl", ".vtp", ".vtu"])
@pytest.mark.parametrize("ground", GROUNDS)
def test_crs_and_unit_survive_a_file(suffix, ground, tmp_path):
    if suffix.startswith(".vt"):
        pytest.importorskip("pyvista")
    tin = steep(ground)
    ts.write(tin, tmp_path / f"a{suffix}")
    again = ts.read(tmp_path / f"a{suffix}")
    assert again.crs == tin.crs
    assert again.elevation_unit == tin.elevation_unit
    assert again.points[:, 2] == pytest.approx(tin.points[:, 2], abs=1e-4)


@pytest.mark.parametrize("unit", [None, "m", "ft", "US survey foot"])
def test_the_unit_survives_the_header_of_a_text_file(unit, tmp_path):
    points = np.array([[500_000.0, 4e6, 1], [500_010, 4e6, 2], [500_000, 4_000_010, 3]])
    survey = Survey(points=points, crs=32616, elevation_unit=unit)
    ts.write(survey, tmp_path / "a.csv")
    again = ts.read(tmp_path / "a.csv", crs=32616)
    assert again.elevation_unit == survey.elevation_unit
    assert np.array_equal(again.points, points)


def test_a_header_in_feet_is_honoured_and_not_overruled(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("easting,northing,elev (USft)\n751428,4020862,1032\n751438,4020862,1031\n")
    assert ts.read(path, crs=32616).elevation_unit == US_SURVEY_FOOT
    assert ts.read(path, source_crs=32616, crs=32617).points[0, 2] == pytest.approx(1032 * US_FOOT)
    vertical = ts.read(path, crs="EPSG:32616+5703")
    assert vertical.points[0, 2] == pytest.approx(1032 * US_FOOT)
    with pytest.raises(OptionError, match="US survey foot, as"):
        ts.read(path, crs=32616, elevation_unit="m")


@pytest.mark.parametrize("unit", [None, "ft", "Clarke's foot"])
def test_a_lifted_mesh_comes_back_in_its_own_unit(unit, tmp_path):
    pytest.importorskip("pyvista")
    tin = TIN.from_triangles(
        CORNER + np.array([[0, 0, 0], [9, 0, 1], [0, 9, 4]]),
        TRIANGLES,
        crs=32616,
        elevation_unit=unit,
    )
    ts.terrain.lift(tin, exaggeration=3).save(tmp_path / "a.vtp")
    again = ts.read(tmp_path / "a.vtp")
    assert again.points == pytest.approx(tin.points, abs=1e-9)
    assert again.elevation_unit == tin.elevation_unit


def test_a_unit_without_a_name_is_kept_by_the_crs_alone(tmp_path):
    crs = "+proj=utm +zone=16 +ellps=GRS80 +units=m +vto_meter=0.5 +geoidgrids=@null"
    tin = TIN.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 1]], TRIANGLES, crs=crs)
    ts.write(tin, tmp_path / "a.ply")
    assert ts.read(tmp_path / "a.ply").elevation_unit == tin.elevation_unit


def test_a_mesh_in_one_crs_is_not_declared_to_be_in_another(tmp_path):
    ts.write(steep("metres"), tmp_path / "a.ply")
    assert ts.read(tmp_path / "a.ply", crs=32616, elevation_unit="m").crs == 32616
    with pytest.raises(ts.CrsError, match=r"EPSG:32616.*EPSG:2274"):
        ts.read(tmp_path / "a.ply", crs=2274)
    with pytest.raises(OptionError, match="metre"):
        ts.read(tmp_path / "a.ply", elevation_unit="ft")


def test_a_unit_that_a_mesh_names_must_be_one(tmp_path):
    ts.write(steep("metres"), tmp_path / "a.obj")
    text = (tmp_path / "a.obj").read_text().replace("unit: metre", "unit: parsec")
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(ts.ReadError, match="'parsec' is no unit"):
        ts.read(tmp_path / "a.obj")


# ------------------------------------------------------------------ lines


@pytest.fixture
def kerb(tmp_path):
    """Return a writer of one line with elevations 1000 and 1010, in a CRS."""
    pyogrio = pytest.importorskip("pyogrio")
    import shapely

    def write(crs, *, level=None, geometry=None):
        shape = geometry or shapely.LineString(
            [[751_430, 4_020_864, 1000], [751_434, 4_020_865, 1010]]
        )
        columns = {} if level is None else {"level": [level]}
        pyogrio.raw.write(
            tmp_path / "kerb.gpkg",
            shapely.to_wkb([shape]),
            [np.array(column) for column in columns.values()],
            list(columns),
            crs=crs,
            geometry_type=shape.geom_type + " Z" * shape.has_z,
            driver="GPKG",
        )
        return tmp_path / "kerb.gpkg"

    return write


@pytest.mark.parametrize(
    ("theirs", "declared", "ours", "factor", "told"),
    [
        ("EPSG:32616", None, None, 1.0, False),
        ("EPSG:32616", "ft", None, 0.3048, True),
        ("EPSG:32616", "ft", "ft", 1.0, False),
        ("EPSG:32616", "m", "ft", 1 / 0.3048, True),
        ("EPSG:32616+6360", None, "m", US_FOOT, True),
        ("EPSG:32616+6360", None, None, US_FOOT, True),
        ("EPSG:32616+6360", None, "US survey foot", 1.0, False),
    ],
)
def test_lines_take_the_unit_of_the_points(kerb, theirs, declared, ours, factor, told):
    notes = []
    (line,) = ts.io.read_lines(
        kerb(theirs), crs=32616, target_unit=ours, elevation_unit=declared, notes=notes
    )
    assert line.coords[:, 2] == pytest.approx(np.array([1000, 1010]) * factor)
    assert any("were converted from" in note for note in notes) == told


def test_lines_in_another_crs_are_converted_and_what_is_assumed_is_told(kerb):
    notes = []
    (line,) = ts.io.read_lines(kerb("EPSG:32616"), crs=2274, notes=notes)
    assert line.coords[:, 2] == pytest.approx(np.array([1000, 1010]) / US_FOOT)
    assert "of the lines metre, of the points US survey foot" in notes[-1]


def test_lines_of_an_unknown_unit_are_refused_where_it_would_make_a_difference(kerb):
    path = kerb("EPSG:32616")
    with pytest.raises(ts.ReadError, match="declare the unit of the lines"):
        ts.io.read_lines(path, crs=32616, target_unit="ft")
    assert ts.io.read_lines(path, crs=32616, target_unit="ft", drape=True)[0].is_draped


def test_levels_of_water_take_the_unit_of_the_points(kerb):
    import shapely

    ring = shapely.Polygon([[751_430, 4_020_864], [751_434, 4_020_864], [751_434, 4_020_869]])
    path = kerb("EPSG:32616", level=1000.0, geometry=ring)
    (pond,) = ts.io.read_water(path, crs=2274)
    assert pond.z == pytest.approx(1000 / US_FOOT)
    (pond,) = ts.io.read_water(path, crs=2274, z=7.0)
    assert pond.z == 7.0


def test_lines_of_files_meet_the_points_in_their_unit(kerb, summit):
    survey = ts.read(summit, crs=32616, elevation_unit="ft")
    with_kerb = ts.io.with_lines(survey, breaklines=[kerb("EPSG:32616")], elevation_unit="m")
    assert with_kerb.breaklines[0].coords[0, 2] == pytest.approx(1000 / 0.3048)
    assert with_kerb.elevation_unit == FOOT


# ------------------------------------------------------------------ the command line


def test_the_command_line_declares_units_and_tells_what_is_assumed(summit, tmp_path):
    known = invoke(
        "build", summit, "--crs", "32616", "--elevation-unit", "ft", "-o", tmp_path / "a.ply"
    )
    assert "1,030.000 to 1,032.000 ft\n" in known.stderr
    assert ts.read(tmp_path / "a.ply").elevation_unit == FOOT
    unknown = invoke("build", summit, "--crs", "EPSG:32616", "-o", tmp_path / "a.ply")
    assert "1,032.000 (unit not known, taken to be metre" in " ".join(unknown.stderr.split())
    nothing = invoke("info", summit)
    assert "1,032.000 (unit not known)" in nothing.stdout
    facts = json.loads(invoke("info", summit, "--crs", "2274", "--json").stdout)
    assert facts["units"] == {"horizontal": "US survey foot", "vertical": "unknown"}
    assert facts["elevation"]["unit_assumed"] == "US survey foot"


def test_lines_on_the_command_line_declare_their_unit(kerb, summit, tmp_path):
    arguments = (
        "build",
        summit,
        "--crs",
        "32616",
        "--elevation-unit",
        "ft",
        "-o",
        tmp_path / "a.ply",
    )
    lines = ("--breaklines", kerb("EPSG:32616"))
    assert "declare the unit" in invoke(*arguments, *lines, code=1).stderr
    result = invoke(*arguments, *lines, "--lines-elevation-unit", "m")
    assert "converted from metre to foot" in " ".join(result.stderr.split())


def test_the_legend_says_what_is_known_of_the_unit():
    captions = {name: find_ground(steep(name)).elevation_caption for name in GROUNDS}
    expected = {
        "metres": "m",
        "metres, not told": "m assumed",
        "US survey feet, not told": "US ft assumed",
        "feet up from metres": "ft",
        "nothing known": "",
        "feet up from nothing known": "ft",
    }
    assert {name: captions[name] for name in expected} == expected


def test_the_examples_of_the_page_run(capsys):
    """Each line that prints says in a comment what it prints."""
    page = (Path(__file__).parents[2] / "docs" / "units.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(block, {})
    expected = re.findall(r"^print\(.*\)  # (.*)$", block, re.MULTILINE)
    assert capsys.readouterr().out.splitlines() == expected
