"""``tinsmith raster`` as people run it."""

import json

import numpy as np
import pytest
from support.commands import refuse, run

import tinsmith as ts

rasterio = pytest.importorskip("rasterio")


@pytest.fixture
def surface(tmp_path):
    points = np.random.default_rng(1).random((80, 3)) * [100, 100, 10] + [500_000, 4e6, 300]
    return ts.write(ts.triangulate(points, crs="EPSG:32616"), tmp_path / "tin.ply")


def test_a_surface_becomes_a_geotiff(tmp_path, surface):
    path = tmp_path / "out.tif"
    out = run("raster", surface, "--spacing", 2.5, "-o", path, "--json")
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    wanted = ts.rasterize(ts.read(surface), spacing=2.5)
    assert (facts["rows"], facts["columns"]) == wanted.shape
    with rasterio.open(path) as file:
        assert file.crs.to_epsg() == 32616
        assert file.res == (2.5, 2.5)
        np.testing.assert_array_equal(file.read(1), wanted.bands["elevation"])


def test_the_cells_of_another_raster(tmp_path, surface):
    first, second = tmp_path / "a.tif", tmp_path / "b.tif"
    assert run("raster", surface, "--spacing", 5, "-o", first).exit_code == 0
    out = run("raster", surface, "--like", first, "--value", "slope", "--at", "mean", "-o", second)
    assert out.exit_code == 0, out.output
    with rasterio.open(first) as one, rasterio.open(second) as other:
        assert one.transform == other.transform
        assert other.descriptions == ("slope",)
        assert np.isfinite(other.read(1)).sum() > np.isfinite(one.read(1)).sum()


@pytest.mark.parametrize(
    ("transform", "size"),
    [
        ((4.0, 0.0, 500_000.0, 0.0, 2.5, 4e6 + 5), "of 4 by 2.5"),
        ((3.0, 4.0, 500_020.0, 4.0, -3.0, 4e6 + 40), "of 5"),
    ],
)
def test_the_cells_of_any_other_raster(tmp_path, surface, transform, size):
    like = tmp_path / "like.tif"
    place = rasterio.Affine(*transform)
    profile = {"width": 12, "height": 9, "count": 1, "dtype": "float32", "nodata": -9999.0}
    with rasterio.open(like, "w", transform=place, crs="EPSG:32616", **profile) as file:
        file.write(np.zeros((1, 9, 12), np.float32))
    points = ts.write(ts.Survey(points=ts.read(surface).points), tmp_path / "cloud.csv")
    for source, more in (
        (surface, ()),
        (surface, ("--value", "hillshade")),
        (points, ("--crs", "EPSG:32616", "--value", "count")),
        (points, ("--crs", "EPSG:32616", "--value", "canopy", "--above", points)),
        (points, ("--crs", "EPSG:32616", "--tiles", 3)),
    ):
        path = tmp_path / "made.tif"
        out = run("raster", source, "--like", like, *more, "-o", path, "--json")
        assert out.exit_code == 0, out.output
        with rasterio.open(path) as file:
            assert (file.transform, file.shape) == (place, (9, 12))
            if "count" not in more:
                assert (file.dtypes[0], file.nodata) == ("float32", -9999.0)
        facts = json.loads(out.stdout)
        assert facts["bounds"]["xmin"] == 500_000.0 + 20 * bool(transform[1])
        assert str(facts["spacing"]) in ("[4.0, 2.5]", "5.0")
        path.unlink()
    out = run("raster", surface, "--like", like, "-o", tmp_path / "made.tif")
    assert size in out.output
    if transform[1]:
        refused = refuse("raster", surface, "--like", like, "-o", tmp_path / "a.asc", code=1)
        assert "GeoTIFF holds any" in refused
        horn = ("--value", "slope", "--operator", "horn", "-o", tmp_path / "b.tif")
        assert "rotated or sheared" in refuse("raster", surface, "--like", like, *horn, code=2)


@pytest.mark.parametrize(
    ("options", "code", "sentence"),
    [
        ((), 2, "One of --spacing and --like is needed."),
        (("--spacing", 1, "--like", "x.tif"), 2, "One of --spacing and --like is needed."),
        (("--spacing", 0), 2, "Invalid --spacing 0.0"),
        (("--spacing", -1), 2, "Invalid --spacing -1.0"),
        (("--spacing", "1e-4"), 2, "(--spacing)"),
        (("--spacing", 1, "--at", "mean", "--method", "natural"), 2, "Invalid --at"),
        (("--spacing", 1, "--value", "height"), 2, "height"),
        (("--spacing", 1, "--operator", "horn"), 2, "Invalid --operator 'horn'"),
        (("--spacing", 1, "--value", "tri", "--operator", "horn"), 2, "riley or wilson"),
        (("--spacing", 1, "--compute-edges"), 2, "Invalid --compute-edges"),
        (("--spacing", 1, "--value", "count", "--compute-edges"), 2, "--compute-edges is of"),
        (("--spacing", 90, "--value", "tpi"), 1, "No cell has a value of tpi"),
        (("--like", "missing.tif"), 1, "There is no file 'missing.tif'"),
    ],
)
def test_what_cannot_be_done_is_said(tmp_path, surface, options, code, sentence):
    path = tmp_path / "out.tif"
    assert sentence in refuse("raster", surface, *options, "-o", path, code=code)
    assert not path.exists()


def test_like_reads_plain_files_alone_and_cells_elsewhere_are_refused(tmp_path, surface):
    text = """<GDAL_WMS><Service name="WMS"><ServerUrl>http://127.0.0.1:9/?</ServerUrl></Service>
        <DataWindow><SizeX>9</SizeX><SizeY>9</SizeY></DataWindow></GDAL_WMS>"""
    (tmp_path / "like.tif").write_text(text)
    out = run("raster", surface, "--like", tmp_path / "like.tif", "-o", tmp_path / "out.tif")
    assert (out.exit_code, "like.tif" in out.stderr) == (1, True), out.output
    profile = {"width": 2, "height": 2, "count": 1, "dtype": "float32", "crs": "EPSG:32616"}
    far = rasterio.Affine(1.0, 0.0, 100.0, 0.0, -1.0, 100.0)
    with rasterio.open(tmp_path / "far.tif", "w", transform=far, **profile) as file:
        file.write(np.zeros((1, 2, 2), np.float32))
    out = run("raster", surface, "--like", tmp_path / "far.tif", "-o", tmp_path / "out.tif")
    assert out.exit_code == 1, out.output
    assert "The cells do not meet the surface: they cover 100 to 102 east" in out.stderr
    assert not (tmp_path / "out.tif").exists()


def test_the_raster_of_like_is_never_overwritten(tmp_path, surface):
    path = tmp_path / "a.tif"
    assert run("raster", surface, "--spacing", 5, "-o", path).exit_code == 0
    before = path.read_bytes()
    assert run("raster", surface, "--like", path, "-o", path).exit_code == 2
    assert path.read_bytes() == before


def test_an_operator_of_cells_is_chosen_by_a_word(tmp_path, surface):
    path = tmp_path / "slope.tif"
    options = ("--spacing", 2, "--value", "slope", "--operator", "horn", "--compute-edges")
    out = run("raster", surface, *options, "-o", path, "--json")
    assert out.exit_code == 0, out.output
    wanted = ts.rasterize(
        ts.read(surface), spacing=2, value="slope", operator="horn", compute_edges=True
    )
    assert wanted.notes[-1] in json.loads(out.stdout)["notes"]
    with rasterio.open(path) as file:
        np.testing.assert_array_equal(file.read(1), wanted.bands["slope"])
        assert file.units == ("°",)
