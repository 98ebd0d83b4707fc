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


# ---------------------------------------------------------------- those of another raster


def write_other(path, dtype, nodata, values=None):
    profile = {"driver": "GTiff", "width": 30, "height": 40, "count": 1, "crs": "EPSG:32616"}
    place = rasterio.Affine(1, 0, 5e5, 0, -1, 4e6 + 40)
    with rasterio.open(path, "w", dtype=dtype, nodata=nodata, transform=place, **profile) as file:
        file.write(np.ones((40, 30), dtype) if values is None else values, 1)
    return path


@pytest.fixture(scope="module")
def surface():
    rng = np.random.default_rng(2)
    points = rng.random((200, 3)) * [30, 40, 9] + [5e5, 4e6, 100]
    return ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")


@pytest.mark.parametrize(
    ("dtype", "nodata"),
    [("float32", -9999), ("float32", -9999.9), ("float64", 1e40), ("float32", np.nan),
     ("float32", None), ("float32", -3.4028234663852886e38)],
)  # fmt: skip
def test_a_raster_has_the_type_and_nodata_of_the_one_whose_cells_it_has(
    surface, tmp_path, dtype, nodata
):
    like = write_other(tmp_path / "other.tif", dtype, nodata)
    made = ts.rasterize(surface, like=like)
    assert made.bands["elevation"].dtype == np.float64
    assert np.isnan(made.bands["elevation"]).any()
    with rasterio.open(like) as one, rasterio.open(ts.write(made, tmp_path / "a.tif")) as other:
        assert other.dtypes == one.dtypes
        wanted = np.nan if nodata is None else np.dtype(dtype).type(nodata)
        np.testing.assert_equal(other.nodata, float(wanted))
        found = other.read(1, masked=True)
        np.testing.assert_array_equal(found.mask, np.isnan(made.bands["elevation"]))
        known = ~found.mask
        np.testing.assert_array_equal(
            found.data[known], made.bands["elevation"][known].astype(dtype)
        )
        of_dataset = ts.rasterize(surface, like=one)
    assert str(of_dataset.stored_as) == str(made.stored_as)
    if made.stored_as is not None:
        assert f"Cells are written as {dtype}" in made.notes[-1]
    cloud = ts.Survey(points=surface.points, crs=surface.crs)
    assert ts.rasterize_counts(cloud, like=made).stored_as is None


def test_whole_numbers_are_not_taken_over_and_what_is_asked_for_counts(surface, tmp_path):
    like = write_other(tmp_path / "other.tif", "int16", -32768)
    made = ts.rasterize(surface, like=like)
    assert "Cells of the other raster are int16, and these are float64" in made.notes[-1]
    with rasterio.open(ts.write(made, tmp_path / "a.tif")) as file:
        assert (file.dtypes[0], np.isnan(file.nodata)) == ("float64", True)
    like = write_other(tmp_path / "other.tif", "float32", -9999)
    made = ts.rasterize(surface, like=like)
    for asked, wanted in (
        ({"dtype": "int16"}, ("int16", -9999)),
        ({"nodata": 0.5}, ("float32", 0.5)),
        ({"dtype": "float64", "nodata": np.nan}, ("float64", np.nan)),
    ):
        with rasterio.open(ts.write(made, tmp_path / "b.tif", **asked)) as file:
            np.testing.assert_equal((file.dtypes[0], file.nodata), wanted)
    with pytest.raises(ts.OptionError, match="nodata"):
        ts.write(made, tmp_path / "c.tif", dtype="uint8")


@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")  # of rioxarray, in affine
def test_an_array_of_xarray_gives_its_type_and_fill_value(surface, tmp_path):
    pytest.importorskip("rioxarray")
    import rioxarray

    like = write_other(tmp_path / "other.tif", "float32", -9999)
    with rioxarray.open_rasterio(like) as opened:
        made = ts.rasterize(surface, like=opened.squeeze())
    assert made.stored_as == ("float32", -9999.0)
    again = ts.rasterize(surface, like=made.to_xarray())
    assert again.stored_as is None  # of floats of 64 bits, NaN without data


@pytest.mark.parametrize(
    ("dtype", "nodata"), [("float32", -9999), ("int16", -32768), ("uint8", 255), ("float64", 7)]
)
def test_a_raster_that_was_read_is_written_as_it_was(tmp_path, dtype, nodata):
    values = np.arange(1200).reshape(40, 30) % 200 + 1
    values[3, :5] = nodata
    path = write_other(tmp_path / "a.tif", dtype, nodata, values.astype(dtype))
    again = ts.write(ts.read_raster(path), tmp_path / "b.tif")
    with rasterio.open(path) as one, rasterio.open(again) as other:
        assert (other.dtypes, other.nodata) == (one.dtypes, one.nodata)
        np.testing.assert_array_equal(other.read(1), one.read(1))


def test_a_cell_that_has_the_value_without_data_is_refused(surface, tmp_path):
    level = ts.triangulate(
        [[5e5, 4e6, 5], [5e5 + 40, 4e6, 5], [5e5, 4e6 + 40, 5]], crs="EPSG:32616"
    )
    like = write_other(tmp_path / "other.tif", "float32", 5.0)
    with pytest.raises(ts.WriteError, match="has the value 5 itself"):
        ts.write(ts.rasterize(level, like=like), tmp_path / "a.tif")
    assert not (tmp_path / "a.tif").exists()
