"""What is written as LAS comes back, for laspy as for us."""

import warnings

import numpy as np
import pytest
from support.lidar_files import CORNER

import tinsmith as ts
from tinsmith import LossWarning
from tinsmith.io import OptionError, WriteError, read, write

laspy = pytest.importorskip("laspy")
pytestmark = pytest.mark.filterwarnings("error")


def make_points(n=200, *, decimals=3, seed=1):
    return (CORNER + np.random.default_rng(seed).random((n, 3)) * (900, 700, 80)).round(decimals)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize("decimals", [0, 1, 2, 3, 4, 5, 6])
def test_coordinates_come_back_with_the_coarsest_scale_that_holds_them(tmp_path, suffix, decimals):
    points = make_points(decimals=decimals)
    write(ts.Survey(points=points), tmp_path / f"cloud{suffix}")
    found = read(tmp_path / f"cloud{suffix}").points
    assert np.abs(found - points).max() <= 4 * np.spacing(np.abs(points).max())
    assert found.round(decimals).tolist() == points.tolist()
    cloud = laspy.read(tmp_path / f"cloud{suffix}")
    assert np.array_equal(cloud.xyz, found)
    assert cloud.header.scales.max() == pytest.approx(10.0**-decimals)


def test_any_double_comes_back_within_half_a_millionth(tmp_path):
    points = make_points(decimals=12)
    write(ts.Survey(points=points), tmp_path / "cloud.laz")
    assert np.abs(read(tmp_path / "cloud.laz").points - points).max() < 0.51e-6


def test_a_large_extent_gets_a_scale_that_32_bits_hold(tmp_path):
    points = np.array([[-2e7, -2e7, 0.0], [2e7, 2e7, 8000.0], [0.123456, 0.25, 1.5]])
    write(ts.Survey(points=points), tmp_path / "world.laz")
    assert np.abs(read(tmp_path / "world.laz").points - points).max() <= 0.05


@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:2193", "EPSG:8778", "EPSG:25832+5783", None])
def test_crs_and_unit_come_back(tmp_path, crs):
    write(ts.Survey(points=make_points(), crs=crs), tmp_path / "cloud.laz")
    survey = read(tmp_path / "cloud.laz")
    assert survey.crs == crs
    assert survey.elevation_unit == (survey.crs and survey.crs.vertical_unit)
    theirs = laspy.read(tmp_path / "cloud.laz").header.parse_crs()
    assert (theirs is None) == (crs is None)
    if crs is not None:
        assert ts.CRS.of(theirs).is_same(crs)


def test_attributes_take_their_places(tmp_path):
    points = make_points(50)
    attributes = {
        "classification": np.arange(50),
        "intensity": np.arange(50) * 1000,
        "gps_time": np.arange(50) * 0.125,
        "red": np.arange(50) * 5,
        "withheld": np.zeros(50, bool),
        "number": np.arange(50) - 7,
        "quality": np.linspace(0, 1, 50),
    }
    write(ts.Survey(points=points, attributes=attributes), tmp_path / "cloud.laz")
    survey = read(tmp_path / "cloud.laz", attributes="all")
    for name, values in attributes.items():
        assert np.array_equal(survey.attributes[name], values), name
    assert laspy.read(tmp_path / "cloud.laz").point_format.id == 7


def test_texts_are_told_to_be_lost(tmp_path):
    survey = ts.Survey(points=make_points(2), attributes={"code": np.array(["a", "b"], object)})
    with pytest.warns(LossWarning, match="attributes code"):
        write(survey, tmp_path / "cloud.las")


def test_a_unit_that_the_crs_does_not_tell_is_told_to_be_lost(tmp_path):
    survey = ts.Survey(points=make_points(2), crs="EPSG:32616", elevation_unit="ft")
    with pytest.warns(LossWarning, match="foot"):
        write(survey, tmp_path / "cloud.las")


def test_a_tin_is_written_as_its_vertices(tmp_path):
    tin = ts.triangulate(make_points(), crs="EPSG:32616")
    write(tin, tmp_path / "cloud.laz")
    assert np.abs(read(tmp_path / "cloud.laz").points - tin.points).max() < 1e-9


def test_the_same_points_give_the_same_bytes(tmp_path):
    survey = ts.Survey(points=make_points(), crs="EPSG:32616")
    for name in ("a.laz", "b.laz"):
        write(survey, tmp_path / name)
    assert (tmp_path / "a.laz").read_bytes() == (tmp_path / "b.laz").read_bytes()


@pytest.mark.parametrize("scale", [0, -1, np.nan, np.inf, "fine"])
def test_wrong_scales(tmp_path, scale):
    with pytest.raises(OptionError, match="scale"):
        write(ts.Survey(points=make_points()), tmp_path / "cloud.las", scale=scale)


def test_a_scale_that_is_too_fine_is_refused_and_the_old_file_stays(tmp_path):
    path = tmp_path / "cloud.las"
    path.write_bytes(b"old")
    with pytest.raises(WriteError, match="32 bits"):
        write(ts.Survey(points=make_points()), path, scale=1e-9)
    for points in (np.empty((0, 3)), np.array([[0, 0, np.nan]])):
        with pytest.raises(WriteError):
            write(ts.Survey(points=points), path)
    survey = ts.Survey(points=make_points(2), attributes={"return_number": np.array([1, 16])})
    with pytest.raises(WriteError, match="return_number 16"):
        write(survey, path)
    assert path.read_bytes() == b"old"


def test_a_scale_is_kept(tmp_path):
    write(ts.Survey(points=make_points()), tmp_path / "cloud.laz", scale=0.01)
    assert laspy.read(tmp_path / "cloud.laz").header.scales.tolist() == [0.01] * 3


def test_random_points_of_every_size_come_back_within_the_scale(tmp_path):
    rng = np.random.default_rng(3)
    for _ in range(30):
        size, middle = 10.0 ** rng.uniform(-3, 7, 3), rng.normal(size=3) * 10.0 ** rng.uniform(0, 7)
        points = middle + rng.random((20, 3)) * size
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            write(ts.Survey(points=points), tmp_path / "cloud.las")
        scales = laspy.read(tmp_path / "cloud.las").header.scales
        assert (np.abs(read(tmp_path / "cloud.las").points - points) <= scales * 0.51).all()
