"""Every writer: the same TIN comes back, the same bytes every time, and never half a file."""

from __future__ import annotations

import json
import os
import resource
import time
from contextlib import contextmanager
from importlib import import_module

import numpy as np
import pyproj
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import oracles

import tinsmith as ts
from tinsmith.base.errors import WriteError
from tinsmith.io.mesh import obj, stl, vtk
from tinsmith.io.mesh.ply import file as ply

MODULES = {
    "geojson": "vector.geojson.writing",
    "ply": "mesh.ply",
    "obj": "mesh.obj",
    "stl": "mesh.stl",
    "vtp": "mesh.vtk",
    "vtu": "mesh.vtk",
}
SUFFIXES = sorted(MODULES)
EXACT = [(ply, "a.ply"), (obj, "a.obj"), (vtk, "a.vtp"), (vtk, "a.vtu")]
ORIGIN = np.array([745_000.0, 4_033_000.0, 200.0])
SITE = pyproj.CRS("+proj=tmerc +lat_0=36 +lon_0=-84 +k=1 +x_0=1000 +y_0=1000 +ellps=GRS80")


def hills(n=2000, crs="EPSG:32616"):
    rng = np.random.default_rng(11)
    tin = ts.triangulate(rng.uniform(0, 300, (n, 3)) + ORIGIN, crs=crs)
    flags = rng.random(tin.constrained.shape) < 0.1
    return ts.TIN.from_triangles(tin.points, tin.triangles, constrained=flags, crs=crs)


def write(suffix, tin, path, **options):
    import_module(f"tinsmith.io.{MODULES[suffix]}").write(tin, path, **options)


# ----------------------------------------------------------------------- round trips


@pytest.mark.parametrize(("module", "name"), EXACT)
@pytest.mark.parametrize("crs", ["EPSG:32616", SITE.to_wkt(), SITE.to_wkt(pretty=True), None])
def test_the_same_tin_comes_back(tmp_path, module, name, crs):
    tin = hills(crs=crs)
    module.write(tin, tmp_path / name)
    again = module.read(tmp_path / name)
    assert again.points.tobytes() == tin.points.tobytes()
    assert np.array_equal(again.triangles, tin.triangles)
    assert np.array_equal(again.neighbors, tin.neighbors)
    if module is not obj:
        assert np.array_equal(again.constrained, tin.constrained)
    if crs is None:
        assert again.crs is None
    else:
        assert "\n" not in str(again.crs)
        assert pyproj.CRS(again.crs) == pyproj.CRS(crs)
        assert again.crs == crs


def test_ply_through_the_front_door(tmp_path):
    tin = hills(50)
    ts.io.write(tin, tmp_path / "a.ply")
    again = ts.io.read(tmp_path / "a.ply")
    assert again.points.tobytes() == tin.points.tobytes()
    assert np.array_equal(again.triangles, tin.triangles)
    assert np.array_equal(again.constrained, tin.constrained)
    assert again.crs == tin.crs


def test_stl_comes_back_within_single_precision(tmp_path):
    tin = hills()
    stl.write(tin, tmp_path / "a.stl")
    again = stl.read(tmp_path / "a.stl")
    assert again.crs == tin.crs
    assert len(again.points) == len(tin.points)
    corners, expected = (t.points[t.triangles] for t in (again, tin))
    assert np.abs(corners - expected).max() <= 300 / 2**24


doubles = st.floats(-1e9, 1e9, allow_nan=False).filter(lambda x: x == 0 or abs(x) > 1e-9)


@settings(max_examples=25)
@given(points=st.lists(st.tuples(doubles, doubles, doubles), min_size=3, max_size=8))
def test_any_doubles_come_back_bit_by_bit(tmp_path_factory, points):
    try:
        tin = ts.triangulate(points)
    except ts.PointsError:
        assert oracles.are_collinear(points)
        return
    folder = tmp_path_factory.mktemp("doubles")
    for module, name in EXACT[:3]:
        module.write(tin, folder / name)
        again = module.read(folder / name)
        assert again.points.tobytes() == tin.points.tobytes()
        assert np.array_equal(again.triangles, tin.triangles)


def test_a_survey_comes_back_from_ply_with_its_numbers(tmp_path):
    survey = ts.Survey(
        points=hills(5).points,
        attributes={
            "number": np.array([1, 2, 3, 4, 70_000]),
            "point class": np.array([2, 2, 5, 6, 9], np.uint8),
            "depth": np.array([0.1, np.nan, 0.3, 0.4, 0.5]),
            "checked": np.array([True, False, True, True, False]),
            "code": np.array(["GR", "GR", "EP", "EP", "BLD"]),
            "x": np.arange(5.0),
            "point_class": np.arange(5),
            "id": np.arange(5) + 2**53,
        },
        crs="EPSG:32616",
    )
    with pytest.warns(ts.LossWarning, match="attributes code, x, point_class, id: PLY"):
        ply.write(survey, tmp_path / "a.ply")
    again = ply.read(tmp_path / "a.ply")
    assert isinstance(again, ts.Survey)
    assert again.points.tobytes() == survey.points.tobytes()
    assert again.crs == survey.crs
    assert list(again.attributes) == ["number", "point_class", "depth", "checked"]
    assert again.attributes["number"].tolist() == [1, 2, 3, 4, 70_000]
    assert again.attributes["point_class"].dtype == np.uint8
    assert np.array_equal(again.attributes["depth"], survey.attributes["depth"], equal_nan=True)
    assert again.attributes["checked"].tolist() == [1, 0, 1, 1, 0]


# -------------------------------------------------------------------- reproducibility


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_bytes_in_another_folder_and_at_another_time(tmp_path, suffix, monkeypatch):
    first, second = tmp_path / "a" / f"x.{suffix}", tmp_path / "b" / f"other.{suffix}"
    for path in (first, second):
        path.parent.mkdir()
        write(suffix, hills(), path)
        real = time.time
        monkeypatch.setattr(time, "time", lambda: real() + 86_400)  # noqa: B023 - one more day
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("kind", ["points", "edges", "hull"])
def test_the_same_bytes_of_every_kind(tmp_path, kind):
    for name in ("a", "b"):
        write("geojson", hills(), tmp_path / name, kind=kind)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_no_version_is_in_the_bytes(tmp_path, suffix):
    path = tmp_path / f"a.{suffix}"
    write(suffix, hills(10), path)
    content = path.read_bytes()
    assert b"tinsmith" not in content
    assert ts.__version__.encode() not in content[:300]


# ----------------------------------------------------------------- whole files or none


@contextmanager
def largest_file(size):
    """Let no file grow beyond a size, as a full disk would."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def old(tmp_path):
    """A function that makes an old file, and checks that it alone is in its folder, whole."""

    def make(suffix):
        path = tmp_path / f"a.{suffix}"
        path.write_text("old")
        return path

    yield make
    assert [one.read_text() for one in tmp_path.iterdir()] == ["old"]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_full_disk(old, suffix, capfd):
    path = old(suffix)
    with largest_file(30_000), pytest.raises(WriteError, match="Cannot write") as caught:
        ts.write(hills(), path)
    assert caught.value.file == path
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("suffix", ["geojson", "ply", "obj", "stl"])
def test_ctrl_c_in_the_middle(old, suffix):
    def interrupt(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write(suffix, hills(), old(suffix), progress=interrupt)


@pytest.mark.parametrize("suffix", ["vtp", "vtu"])
def test_ctrl_c_before_vtk_files_are_in_place(old, suffix, monkeypatch):
    def interrupt(self, target):
        raise KeyboardInterrupt

    path = old(suffix)
    monkeypatch.setattr(type(path), "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write(suffix, hills(10), path)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_is_not_there(tmp_path, suffix):
    with pytest.raises(WriteError, match="there is no folder"):
        write(suffix, hills(10), tmp_path / "missing" / f"a.{suffix}")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_where_the_folder_should_be(tmp_path, suffix):
    blocking = tmp_path / "file"
    blocking.write_text("old")
    with pytest.raises(WriteError, match="Cannot write"):
        write(suffix, hills(10), blocking / f"a.{suffix}")
    assert blocking.read_text() == "old"


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_may_not_be_written(tmp_path, suffix, monkeypatch):
    # The superuser may write anywhere, so the system's answer is put in its place.
    def refuse(*args, **kwargs):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(WriteError, match="Permission denied"):
        write(suffix, hills(10), tmp_path / f"a.{suffix}")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_an_old_file_is_replaced(tmp_path, suffix):
    path = tmp_path / f"a.{suffix}"
    path.write_text("old")
    write(suffix, hills(10), path)
    assert path.stat().st_size > 100
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_progress_ends_at_one(tmp_path, suffix):
    seen = []
    write(suffix, hills(), tmp_path / f"a.{suffix}", progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


# ---------------------------------------------------------- across formats, one surface


def test_every_format_holds_the_same_surface(tmp_path):
    tin = hills(400)
    areas = {}
    for module, name in [*EXACT, (stl, "a.stl")]:
        module.write(tin, tmp_path / name)
        areas[name] = module.read(tmp_path / name).surface_area
    write("geojson", tin, tmp_path / "a.geojson")
    features = json.loads((tmp_path / "a.geojson").read_text())["features"]
    flat = sum(feature["properties"]["area"] for feature in features)
    assert list(areas.values()) == pytest.approx([tin.surface_area] * len(areas), rel=1e-7)
    assert flat == pytest.approx(tin.area, rel=1e-8)
