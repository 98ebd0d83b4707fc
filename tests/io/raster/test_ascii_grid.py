"""Text grids: each number is the same double, for GDAL and for us."""

import numpy as np
import pytest

import tinsmith as ts
from tinsmith import LossWarning
from tinsmith.io import OptionError, WriteError, read, write

rasterio = pytest.importorskip("rasterio")


def make_raster(values, *, nodata=np.nan, crs="EPSG:32616", spacing=0.5, **more):
    rows, columns = values.shape
    box = ts.Bounds(752_640.25, 4_024_180.5, 752_640.25 + columns * spacing,
                    4_024_180.5 + rows * spacing)  # fmt: skip
    grid = ts.Grid(box, shape=(rows, columns), spacing=spacing)
    return ts.Raster({"elevation": values, **more}, grid, crs=crs, nodata=nodata)


@pytest.mark.parametrize("dtype", ["float64", "float32", "int16", "uint8", "bool"])
def test_numbers_are_the_same(tmp_path, dtype):
    values = (np.random.default_rng(1).random((7, 5)) * 200).astype(dtype)
    write(make_raster(values), tmp_path / "g.asc")
    with rasterio.open(tmp_path / "g.asc") as found:
        assert np.allclose(found.read(1), values.astype(float), rtol=1e-6)
        assert found.bounds[:2] == (752_640.25, 4_024_180.5)
        assert found.res == (0.5, 0.5)
    expected = values.astype(float).ravel()
    assert np.allclose(
        read(tmp_path / "g.asc").points[:, 2], expected, rtol=1e-6 if dtype == "float32" else 1e-12
    )
    assert read(tmp_path / "g.asc").crs.name == "WGS 84 / UTM zone 16N"


def test_a_double_comes_back_to_the_last_bit(tmp_path):
    values = np.random.default_rng(1).random((4, 6)) * 1e3
    write(make_raster(values, crs=None), tmp_path / "g.asc")
    text = (tmp_path / "g.asc").read_text().splitlines()[6:]
    assert np.array_equal(np.array([line.split() for line in text], float), values)
    assert not (tmp_path / "g.prj").exists()


def test_cells_without_data(tmp_path):
    values = np.array([[1.0, np.nan], [np.inf, 4.0]])
    write(make_raster(values), tmp_path / "g.asc")
    with rasterio.open(tmp_path / "g.asc") as found:
        assert found.nodata == -9999
        assert found.read(1).tolist() == [[1, -9999], [-9999, 4]]
    with pytest.raises(WriteError, match="-9999"):
        write(make_raster(np.array([[1.0, -9999.0]])), tmp_path / "g.asc")


def test_one_of_several_bands(tmp_path):
    raster = make_raster(np.ones((2, 2)), other=np.full((2, 2), 2.0))
    with pytest.raises(OptionError, match="elevation, other"):
        write(raster, tmp_path / "g.asc")
    write(raster, tmp_path / "g.asc", band="other")
    with rasterio.open(tmp_path / "g.asc") as found:
        assert found.read(1).tolist() == [[2, 2], [2, 2]]


def test_units_are_told_to_be_lost(tmp_path):
    raster = make_raster(np.ones((2, 2)))
    told = ts.Raster(dict(raster.bands), raster.grid, units={"elevation": "m"})
    with pytest.warns(LossWarning, match="units"):
        write(told, tmp_path / "g.asc")
