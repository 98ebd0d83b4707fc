"""The Blender add-on: its zip, what it reads of files, and imports in Blender itself."""

from __future__ import annotations

import sqlite3
import tomllib
import zipfile
from contextlib import closing

import numpy as np
import pytest
from PIL import Image
from support.blender_addon import ADDON, drive_blender, load_part
from support.qgis_plugin import pack_plug_in

import tinsmith as ts

ply, geopackage, reference = (load_part(name) for name in ("ply", "geopackage", "reference"))
UTM, FEET = "EPSG:32616", "EPSG:2274"
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])
METRE, FOOT = (reference.Unit.find(name) for name in ("metre", "US survey foot"))
UNKNOWN = reference.Reference()


def make_tin(crs=UTM, **options):
    points = CORNER + np.random.default_rng(6).random((80, 3)) * (90, 70, 12)
    ring = CORNER[:2] + np.array([[5, 5], [80, 8], [75, 60], [8, 55]])
    lines = [ts.Breakline(points[:3], name='the "kerb", é'), ts.Breakline(points[5:7], kind="soft")]
    return ts.triangulate(
        points, crs=crs, breaklines=lines, boundary=[ring], crossing="split", **options
    )


# ------------------------------------------------------------------- the zip


def test_the_zip_holds_the_add_on_and_its_licence(tmp_path):
    path = pack_plug_in("blender", tmp_path / "deep" / "a.zip")
    modules = {path.name for path in (ADDON / "tinsmith").glob("*.py")}
    wanted = {"LICENSE", "blender_manifest.toml", *modules}
    with zipfile.ZipFile(path) as packed:
        assert set(packed.namelist()) == {f"tinsmith/{name}" for name in wanted}
        assert packed.read("tinsmith/LICENSE") == (ADDON.parent / "LICENSE").read_bytes()
        manifest = tomllib.loads(packed.read("tinsmith/blender_manifest.toml").decode())
    assert manifest["version"] == ts.__version__
    assert manifest["license"] == ["SPDX:MIT"]
    assert "MIT License" in (ADDON.parent / "LICENSE").read_text()
    assert len(manifest["tagline"]) <= 64
    again = pack_plug_in("blender", tmp_path / "b.zip")
    assert again.read_bytes() == path.read_bytes()


# ------------------------------------------------------------------- what is read


@pytest.mark.parametrize(
    ("crs", "unit"),
    [(UTM, "metre"), (FEET, "US survey foot"), ("EPSG:2256", "foot"), ("EPSG:27700", "metre")],
)
def test_a_tin_is_read_bit_for_bit_with_its_unit(tmp_path, crs, unit):
    tin = make_tin(crs, elevation_unit="ft")
    found = ply.read(ts.write(tin, tmp_path / "a.ply"))
    assert found.points.tobytes() == tin.points.tobytes()
    assert found.triangles.tobytes() == tin.triangles.tobytes()
    chains = tin.lines.chains()
    assert [(one.kind, one.name) for one in found.lines] == [
        *zip(tin.lines.kinds, tin.lines.names, strict=True)
    ]
    for line, chain in zip(found.lines, chains, strict=True):
        assert line.points.tobytes() == tin.points[chain].tobytes()
    assert (found.reference.crs, found.reference.horizontal.name) == (crs, unit)
    assert found.reference.horizontal.metres == ts.CRS(crs).horizontal_unit.metres
    assert found.reference.elevation.metres == 0.3048


@pytest.mark.parametrize("crs", [UTM, FEET, "EPSG:2256", "EPSG:27700", "EPSG:2154", None])
def test_contours_are_read_with_crs_and_units(tmp_path, crs):
    contours = ts.contours(make_tin(crs, elevation_unit="US survey foot"), interval=2)
    found = geopackage.read(ts.write(contours, tmp_path / "a.gpkg"))
    every = np.concatenate([line.points for line in found.lines])
    assert every.tobytes() == contours.coordinates.tobytes()
    assert {float(line.name) for line in found.lines} == set(contours.columns["elevation"].tolist())
    assert found.reference.crs == (crs or "")
    assert found.reference.elevation == FOOT
    along = found.reference.horizontal
    assert (along is None) == (crs is None)
    assert crs is None or along.metres == pytest.approx(
        ts.CRS(crs).horizontal_unit.metres, rel=1e-12
    )


def test_lines_of_a_whole_tin_are_read(tmp_path):
    tin = make_tin(elevation_unit="m")
    found = geopackage.read(ts.write(tin, tmp_path / "a.gpkg"))
    assert {"hard", "soft", "boundary"} <= {line.kind for line in found.lines}
    assert found.reference == reference.Reference(UTM, METRE, METRE)


def test_what_is_no_file_of_this_kind_is_refused(tmp_path):
    tin = make_tin()
    flat = ts.Features.of_lines(tin.points[:4, :2], np.array([0, 4]), crs=UTM)
    ts.write(flat, tmp_path / "flat.gpkg")
    ts.write(ts.Survey(points=tin.points, crs=UTM), tmp_path / "points.gpkg")
    for name, words in (("flat", "without elevations"), ("points", "no layer of lines")):
        with pytest.raises(reference.Refused, match=words):
            geopackage.read(tmp_path / f"{name}.gpkg")
    path = ts.write(tin, tmp_path / "a.ply")
    whole = path.read_bytes()
    for content in (whole[:-9], b"solid", whole.replace(b"binary_little", b"binary_big", 1),
                    whole.replace(b"property double x", b"property double q", 1)):  # fmt: skip
        path.write_bytes(content)
        with pytest.raises(reference.Refused, match=r"a\.ply"):
            ply.read(path)
    path.with_suffix(".gpkg").write_bytes(whole)
    with pytest.raises(reference.Refused, match="no GeoPackage"):
        geopackage.read(path.with_suffix(".gpkg"))


def test_a_damaged_geometry_is_refused(tmp_path):
    path = ts.write(ts.contours(make_tin(), interval=2), tmp_path / "a.gpkg")
    with closing(sqlite3.connect(path)) as file, file:
        for (name,) in file.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'"):
            file.execute(f'DROP TRIGGER "{name}"')
        file.execute("UPDATE contours SET geom = substr(geom, 1, length(geom) - 8)")
    with pytest.raises(reference.Refused, match="damaged"):
        geopackage.read(path)


# ------------------------------------------------------------------- where it goes


def place(found, there=None, asked=UNKNOWN, box=(CORNER, CORNER + 9), scale=1.0):
    return reference.choose_placement(found, np.array(box), there, asked, scale)


def test_units_become_metres_and_are_told():
    placement, told = place(reference.Reference(FEET, FOOT, METRE))
    metres = np.array([1200 / 3937, 1200 / 3937, 1.0])
    points = CORNER + np.array([[3, 4, 5], [0.25, -7, 1]])
    np.testing.assert_allclose(
        placement.place(points), (points - placement.shift) * metres, rtol=1e-15
    )
    assert placement.shift == (752_644.0, 4_024_184.0, 0.0)
    assert any("from US survey foot, elevations from metre" in one for one in told)
    _, told = place(reference.Reference(UTM, METRE))
    assert any("elevations are: taken to be metre" in one for one in told)


def test_the_first_file_of_a_scene_sets_shift_and_scale():
    first, _ = place(reference.Reference(UTM, METRE, METRE), scale=0.001)
    kept = reference.Placement.from_properties(first.to_properties())
    assert kept == first
    far = (CORNER + 250_000, CORNER + 250_009)
    second, told = place(reference.Reference(UTM, METRE, FOOT), first, box=far)
    assert (second.shift, second.scale) == (first.shift, 0.001)
    assert any("The scale is that of the scene" in one for one in told)
    assert any("km from the shift" in one for one in told)


@pytest.mark.parametrize(
    ("found", "asked", "words"),
    [
        (reference.Reference("", None, None), UNKNOWN, "choose the unit"),
        (reference.Reference(UTM, METRE), reference.Reference("", FOOT), "leave the choice"),
        (reference.Reference(FEET, FOOT), UNKNOWN, "The scene is in EPSG:32616"),
        (reference.Reference("", METRE), UNKNOWN, "no known CRS.*check 'CRS of the scene'"),
        (reference.Reference("", FOOT), reference.Reference(UTM), "coordinates of the scene"),
    ],
)
def test_what_does_not_fit_is_refused(found, asked, words):
    there, _ = place(reference.Reference(UTM, METRE, METRE))
    with pytest.raises(reference.Refused, match=words):
        place(found, there, asked)


def test_a_file_without_crs_goes_into_the_scene_on_request():
    there, _ = place(reference.Reference(UTM, METRE, METRE))
    found, told = place(UNKNOWN, there, reference.Reference(UTM, METRE))
    assert found.shift == there.shift
    assert any("as chosen" in one for one in told)


# ------------------------------------------------------------------- in Blender


def make_files(folder):
    """Write a TIN, its contours, and the same in feet, without a CRS, and level."""
    tin = make_tin(elevation_unit="m")
    ts.write(tin, folder / "site.ply")
    ts.write(ts.contours(tin, interval=2), folder / "contours.gpkg")
    ts.write(make_tin(FEET, elevation_unit="ft"), folder / "feet.ply")
    ts.write(ts.triangulate(tin.points), folder / "bare.ply")
    ts.write(ts.triangulate(tin.points * [1, 1, 0], crs=UTM), folder / "level.ply")
    return tin


@pytest.mark.proof
@pytest.mark.timeout(400)
def test_imports_in_blender(tmp_path):
    tin = make_files(tmp_path)
    paths = {path.name: str(path) for path in tmp_path.iterdir()}
    jobs = {
        "site": {"imports": [
            {"filepath": paths["site.ply"]},
            {"filepath": paths["contours.gpkg"], "line_width": 0.5},
            {"filepath": paths["feet.ply"]},
            {"filepath": paths["bare.ply"], "unit": "metre"},
            {"filepath": paths["bare.ply"], "unit": "metre", "take_crs": True},
            {"filepath": str(tmp_path / "none.ply")},
        ], "picture": str(tmp_path / "picture.png")},
        "feet": {"imports": [{"filepath": paths["feet.ply"], "scale": 0.5}], "scale_length": 2.0},
        "level": {"imports": [{"filepath": paths["level.ply"]}]},
        "bare": {"imports": [{"filepath": paths["bare.ply"]}]},
    }  # fmt: skip
    told = drive_blender(tmp_path, jobs)
    assert told["left"] is False
    site, contours, *others = told["site"]["imports"]
    check_surface(site["objects"], tin)
    lines = [one for one in contours["objects"] if one["type"] == "CURVE"]
    assert all(one["bevel"] == 0.25 for one in lines)
    assert sum(len(one["splines"]) for one in lines) == len(ts.contours(tin, interval=2))
    errors = [one["error"] for one in others]
    assert "The scene is in EPSG:32616, and the file in EPSG:2274" in errors[0]
    assert "no known CRS" in errors[1]
    assert errors[2] is None
    assert "'none.ply' cannot be read" in errors[3]
    assert [len(others[k]["objects"]) for k in (0, 1, 3)] == [0, 0, 0]
    shift = told["site"]["scene"]["tinsmith_shift"]
    assert shift == [*np.rint((tin.points.min(axis=0) + tin.points.max(axis=0)) / 2)[:2], 0.0]
    assert all(one["properties"]["tinsmith_shift"] == shift for one in site["objects"])
    assert told["feet"]["scene"]["tinsmith_scale"] == 0.25
    assert told["feet"]["scene"]["tinsmith_metres"] == [1200 / 3937, 0.3048]
    (level,) = told["level"]["imports"][0]["objects"]
    assert np.ptp(np.array(level["colors"]), axis=0).max() == 0
    assert "choose the unit" in told["bare"]["imports"][0]["error"]
    assert told["bare"]["scene"] == {}
    assert (tmp_path / "picture.png").stat().st_size > 20_000


@pytest.mark.proof
@pytest.mark.timeout(400)
@pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
def test_blenders_own_importers(tmp_path):
    """GLB, OBJ, PLY and STL by the importers of Blender: Z up, in place, whole, with the image."""
    points = np.random.default_rng(8).random((200, 3)) * (90, 70, 12)
    tin = ts.triangulate(np.round(points, 3), crs=UTM, elevation_unit="m")
    far = tin.replace(points=tin.points + CORNER)
    image = tmp_path / "ortho.png"
    Image.fromarray(np.full((64, 32, 3), 200, np.uint8)).save(image)
    image.with_suffix(".pgw").write_text("3\n0\n0\n-1.2\n1.5\n70\n")
    files = {
        "glb": ts.write(tin, tmp_path / "a.glb", frame="local"),
        "far.glb": ts.write(far, tmp_path / "far.glb", frame="local"),
        "ortho.glb": ts.write(tin, tmp_path / "ortho.glb", frame="local", ortho=image),
        "obj": ts.write(tin, tmp_path / "a.obj"),
        "ortho.obj": ts.write(tin, tmp_path / "ortho.obj", ortho=image),
        "ply": ts.write(tin, tmp_path / "a.ply"),
        "stl": ts.write(tin, tmp_path / "a.stl"),
    }
    told = drive_blender(tmp_path, {"native": {key: str(path) for key, path in files.items()}})
    for name, found in told["native"].items():
        vertices = np.array(found["vertices"])
        if "glb" in name:  # about its middle, in whole metres
            assert np.abs(vertices.min(axis=0) + vertices.max(axis=0)).max() < 2, name
        if name not in ("obj", "ortho.obj", "ply"):  # STL from its corner
            vertices += tin.points.min(axis=0) - vertices.min(axis=0)
        check_native(name, found, vertices, tin)


def check_native(name, found, vertices, tin):
    assert found["least_area"] > 0, name
    assert not found["is_changed"], name
    assert found["normals_up"] == len(tin.triangles), name
    assert len(vertices) == len(tin.points), name
    nearest = np.linalg.norm(vertices[:, None] - tin.points, axis=2)
    order = nearest.argmin(axis=1)
    assert sorted(order) == list(range(len(tin.points))), name
    assert nearest.min(axis=1).max() < 1e-4, name
    same = {frozenset(corners) for corners in tin.triangles.tolist()}
    assert {frozenset(order[corners]) for corners in found["triangles"]} == same, name
    if "ortho" not in name:
        return
    assert found["images"] == [[32, 64]], name
    uv, at = np.array(found["uv"]), tin.points[order[found["corners"]]]
    np.testing.assert_allclose(uv[:, 0], (at[:, 0] - 0) / 96, atol=1e-3, err_msg=name)
    np.testing.assert_allclose(1 - uv[:, 1], (70.6 - at[:, 1]) / 76.8, atol=1e-3, err_msg=name)


def check_surface(objects, tin):
    (mesh,) = [one for one in objects if one["type"] == "MESH"]
    shift = np.array(mesh["properties"]["tinsmith_shift"])
    wanted = (tin.points - shift).astype(np.float32)
    np.testing.assert_array_equal(np.array(mesh["vertices"], np.float32), wanted)
    np.testing.assert_array_equal(mesh["triangles"], tin.triangles)
    assert mesh["normals_up"] == len(tin.triangles)
    assert not mesh["is_changed"]
    colors = np.array(mesh["colors"])
    assert colors[tin.points[:, 2].argmin()].sum() < colors[tin.points[:, 2].argmax()].sum()
    curves = {one["name"]: one for one in objects if one["type"] == "CURVE"}
    assert 'the "kerb", é' in curves
    for chain, name in zip(tin.lines.chains(), tin.lines.names, strict=True):
        if list(tin.lines.names).count(name) == 1:
            (spline,) = curves[name]["splines"]
            places = wanted[chain[:-1] if spline["closed"] else chain]
            np.testing.assert_array_equal(np.array(spline["points"], np.float32), places)
