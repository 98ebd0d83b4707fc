"""Results in the hands of other libraries, the real ones."""

from __future__ import annotations

import math

import geopandas
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import shapely
import xarray

import tinsmith as ts
from tinsmith.base.errors import MissingExtraError, OptionError

XYZ = np.array([[0, 0, 1], [4, 0, 2], [4, 3, math.nan], [0, 3, 4], [0, 0, 1]], float)
RINGS = np.concatenate([XYZ, XYZ * (0.1, 0.1, 1) + (1, 1, 0), XYZ + np.array([9, 0, 0])])
MADE = {
    "points": ts.Features.of_points(XYZ[:2]),
    "flat points": ts.Features.of_points(XYZ[:2, :2]),
    "lines": ts.Features.of_lines(XYZ, [0, 2, 5]),
    "multilines": ts.Features.of_lines(RINGS, [0, 5, 10, 15], [0, 2, 3]),
    "polygons": ts.Features.of_polygons(RINGS, [0, 5, 10, 15], [0, 2, 3]),
    "flat polygons": ts.Features.of_polygons(RINGS[:, :2], [0, 5, 10, 15], [0, 2, 3]),
    "multipolygons": ts.Features.of_polygons(RINGS, [0, 5, 10, 15], [0, 2, 3], [0, 2]),
    "no lines": ts.Features.of_lines(np.empty((0, 3)), [0]),
}


def with_columns(made):
    count = len(made)
    return ts.Features(
        kind=made.kind,
        coordinates=made.coordinates,
        offsets=made.offsets,
        columns={
            "level": np.arange(count) / 3,
            "n": np.arange(count),
            "text": np.array(["x", None][:count], object),
        },
        units={"level": "m", "n": None},
        crs="EPSG:32616",
        elevation_unit="ft",
        name="levels",
        notes=("One.",),
    )


@pytest.fixture(params=MADE)
def made(request):
    return with_columns(MADE[request.param])


@pytest.fixture(params=[name for name in MADE if not name.startswith("no ")])
def some(request):
    """Features that are there: GeoPandas cannot reshape the coordinates of none."""
    return with_columns(MADE[request.param])


def coordinates_of(geometries):
    return shapely.get_coordinates(geometries, include_z=True)


def test_shapely_has_every_coordinate(made):
    shapes = made.to_shapely()
    assert len(shapes) == len(made)
    expected = np.full((len(made.coordinates), 3), math.nan)
    expected[:, : made.coordinates.shape[1]] = made.coordinates
    np.testing.assert_array_equal(coordinates_of(shapes), expected)
    assert {shape.geom_type for shape in shapes} <= {made.geometry_type}
    assert (shapely.has_z(shapes) == made.has_elevations).all()


def test_geodataframe(made):
    frame = made.to_geodataframe()
    assert frame.crs == "EPSG:32616"
    assert shapely.equals_identical(frame.geometry.values, made.to_shapely()).all()
    assert frame["n"].tolist() == list(range(len(made)))
    assert frame.attrs == {
        "name": "levels",
        "units": {"level": "m", "n": "unknown"},
        "elevation_unit": "foot",
        "notes": ["One."],
    }
    frame["n"] = 0
    assert made.columns["n"].tolist() == list(range(len(made)))


def test_geopandas_takes_the_arrow_stream(some):
    frame = geopandas.GeoDataFrame.from_arrow(some)
    assert frame.crs == "EPSG:32616"
    np.testing.assert_array_equal(
        coordinates_of(frame.geometry.values), coordinates_of(some.to_shapely())
    )
    assert [one.geom_type for one in frame.geometry] == [some.geometry_type] * len(some)
    np.testing.assert_array_equal(frame["level"], some.columns["level"])


def test_pyarrow_takes_the_stream_with_its_metadata(made):
    table = pa.table(made)
    assert table.column_names == ["level", "n", "text", "geometry"]
    assert table.schema.field("level").metadata == {b"unit": b"m"}
    assert table.schema.field("n").metadata == {b"unit": b"unknown"}
    geometry = table.schema.field("geometry").metadata
    assert geometry[b"ARROW:extension:name"].decode() == f"geoarrow.{made.geometry_type.lower()}"
    assert b"projjson" in geometry[b"ARROW:extension:metadata"]
    assert table.schema.metadata[b"name"] == b"levels"
    assert table.validate(full=True) is None


def test_arrow_without_a_crs():
    made = MADE["lines"]
    table = pa.table(made)
    assert table.schema.field("geometry").metadata[b"ARROW:extension:metadata"] == b"{}"
    assert geopandas.GeoDataFrame.from_arrow(made).crs is None


def test_geo_interface(made):
    collection = made.__geo_interface__
    assert collection["type"] == "FeatureCollection"
    shapes = [shapely.geometry.shape(one["geometry"]) for one in collection["features"]]
    np.testing.assert_array_equal(coordinates_of(shapes), coordinates_of(made.to_shapely()))
    assert [one["properties"]["n"] for one in collection["features"]] == list(range(len(made)))
    frame = geopandas.GeoDataFrame.from_features(collection) if len(made) else ()
    assert len(frame) == len(made)


def test_geo_interface_has_none_for_nan():
    made = ts.Features.of_points([[0, 0]], columns={"a": [math.nan]})
    assert made.__geo_interface__["features"][0]["properties"] == {"a": None}


def test_a_column_called_geometry():
    made = ts.Features.of_points([[0, 0]], columns={"geometry": [1]})
    for action in (made.to_geodataframe, made.__arrow_c_stream__):
        with pytest.raises(OptionError, match="geometry"):
            action()


def test_dataframe():
    table = ts.Table(
        {"a": [1.5, 2.5], "t": np.array(["x", None], object)}, units={"a": None}, name="v"
    )
    frame = table.to_dataframe()
    assert isinstance(frame, pd.DataFrame)
    assert frame.attrs == {"name": "v", "units": {"a": "unknown"}, "notes": []}
    frame.loc[0, "a"] = 9.0
    assert table["a"][0] == 1.5


def test_xarray():
    grid = ts.Grid(ts.Bounds(10.0, 20.0, 13.0, 22.0), (2, 3), 1.0)
    bands = {"elevation": np.arange(6.0).reshape(2, 3), "class": np.ones((2, 3), np.int16)}
    made = ts.Raster(bands, grid, crs="EPSG:32616", units={"elevation": "m", "class": None})
    found = made.to_xarray()
    assert isinstance(found, xarray.Dataset)
    assert found["x"].values.tolist() == [10.5, 11.5, 12.5]
    assert found["y"].values.tolist() == [21.5, 20.5]
    assert float(found["elevation"].sel(x=11.5, y=20.5)) == 4.0
    assert found["elevation"].attrs["units"] == "m"
    assert found["class"].attrs["units"] == "unknown"
    assert found["elevation"].attrs["grid_mapping"] == "spatial_ref"
    assert "UTM zone 16N" in found["spatial_ref"].attrs["crs_wkt"]
    assert found["spatial_ref"].attrs["GeoTransform"] == "10.0 1.0 0.0 22.0 0.0 -1.0"
    assert math.isnan(found["elevation"].attrs["_FillValue"])
    assert "_FillValue" not in found["class"].attrs
    found["elevation"][0, 0] = 7.0
    assert made.bands["elevation"][0, 0] == 0.0


@pytest.mark.parametrize(
    ("library", "action"),
    [
        ("geopandas", lambda: MADE["lines"].to_geodataframe()),
        ("pyarrow", lambda: MADE["lines"].__arrow_c_stream__()),
        (
            "xarray",
            lambda: ts.Raster(
                {"z": np.eye(1)}, ts.Grid(ts.Bounds(0, 0, 1, 1), (1, 1), 1.0)
            ).to_xarray(),
        ),
    ],
)
def test_without_the_library_its_extra_is_named(monkeypatch, library, action):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr("tinsmith.base.optional.import_module", missing)
    with pytest.raises(MissingExtraError, match=rf"{library}.*tinsmith\[interop\]"):
        action()
