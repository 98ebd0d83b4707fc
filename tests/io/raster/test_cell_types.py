"""Types of cells and the value of cells without data, as GDAL reads them again."""

import numpy as np
import pytest
import rasterio

import tinsmith as ts

SUFFIXES = {"geotiff": ".tif", "cog": ".tif"}


def make(values, nodata=np.nan):
    values = np.asarray(values)
    rows, columns = values.shape
    grid = ts.Grid(ts.Bounds(5e5, 4e6, 5e5 + columns, 4e6 + rows), (rows, columns), 1.0)
    return ts.Raster({"elevation": values}, grid, crs="EPSG:32616", nodata=nodata)


HILL = np.round(np.add.outer(np.arange(40.0), np.arange(30.0)) * 7.3, 3) - 100.0
HILL[3, 4] = np.nan


@pytest.mark.parametrize("name", SUFFIXES)
@pytest.mark.parametrize(
    ("dtype", "nodata"),
    [("float32", None), ("float32", -9999), ("float64", -3.5e38), ("int16", -32768),
     ("int32", 99999), ("int8", None), ("uint16", 0), (None, -9999.25)],
)  # fmt: skip
def test_cells_have_the_type_and_the_value_that_were_asked_for(tmp_path, name, dtype, nodata):
    values = np.clip(HILL, -100, 120) if dtype == "int8" else np.abs(HILL) + (dtype == "uint16")
    if nodata is None and dtype == "int8":
        values = np.nan_to_num(values).astype(np.int16)
    path = ts.write(make(values), tmp_path / "a.tif", format=name, dtype=dtype, nodata=nodata)
    with rasterio.open(path) as file:
        found = file.read(1)
        assert found.dtype == np.dtype(dtype or "float64")
        gaps = np.isnan(np.asarray(values, float))
        if nodata is not None:
            assert file.nodata == nodata
        assert (file.read_masks(1) == 0).tolist() == gaps.tolist()
    wanted = np.rint(values) if np.dtype(dtype or "float64").kind in "iu" else values
    np.testing.assert_array_equal(found[~gaps], wanted[~gaps].astype(found.dtype))


@pytest.mark.parametrize("name", SUFFIXES)
@pytest.mark.parametrize(
    ("values", "options", "sentence"),
    [
        (HILL, {"dtype": "int16"}, "given with dtype='int16', which has no NaN"),
        (HILL, {"dtype": "uint8", "nodata": 300}, "a whole number from 0 to 255"),
        (HILL, {"dtype": "uint8", "nodata": 0.5}, "a whole number from 0 to 255"),
        (HILL, {"dtype": "float32", "nodata": 0.1}, "a value that float32 holds exactly"),
        (HILL, {"dtype": "complex"}, "Invalid dtype 'complex'"),
        (HILL, {"nodata": np.inf}, "a number or NaN"),
        (HILL, {"nodata": "none"}, "a number or NaN"),
        (HILL, {"dtype": "uint8", "nodata": 255}, "is none that uint8 can hold"),
        (HILL, {"nodata": HILL[0, 0]}, "has the value -100 itself"),
        (HILL, {"dtype": "int16", "nodata": -100}, "has the value -100 itself"),
        (HILL * 1e300, {"dtype": "float32"}, "is none that float32 can hold"),
    ],
)
def test_a_value_is_never_changed_in_silence(tmp_path, name, values, options, sentence):
    path = tmp_path / "a.tif"
    with pytest.raises((ts.OptionError, ts.WriteError), match=sentence):
        ts.write(make(values), path, format=name, **options)
    assert list(tmp_path.iterdir()) == []


def test_cells_without_data_that_have_a_number_get_the_new_one(tmp_path):
    path = ts.write(make([[1, 2], [-1, 4]], nodata=-1), tmp_path / "a.tif", nodata=9)
    with rasterio.open(path) as file:
        assert (file.read(1).tolist(), file.nodata) == ([[1, 2], [9, 4]], 9)
