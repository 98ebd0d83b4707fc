"""Places on a surface, in whatever a program of Python has them, for every product that asks."""

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import shapely

import tinsmith as ts

XYZ = [[0, 0, 3], [6, 0, 3], [6, 6, 2], [0, 6, 3], [3, 3, 0]]  # a pit in the middle
TIN = ts.triangulate(XYZ, crs="EPSG:32616", elevation_unit="m")
AT = (1.0, 1.0)
PRODUCTS = {
    "flow_path": ts.flow_path,
    "catchments": lambda tin, places: ts.catchments(tin, outlets=places),
    "viewshed": lambda tin, places: ts.viewshed(tin, places, eye_height=1.0),
    "line_of_sight": lambda tin, places: ts.line_of_sight(tin, places, [(3.0, 2.0)]),
}
FORMS = {
    "row": AT,
    "rows": [AT],
    "array": np.array(AT),
    "point": shapely.Point(AT),
    "points": [shapely.Point(AT)],
    "columns": {"x": [1.0], "y": [1.0]},
    "frame": pd.DataFrame({"easting": [1.0], "northing": [1.0]}),
    "series": gpd.GeoSeries([shapely.Point(AT)], crs=32616),
    "features": ts.Features.of_points([AT], crs="EPSG:32616"),
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", PRODUCTS)
def test_places_may_have_any_form(name, form):
    made, plain = PRODUCTS[name](TIN, FORMS[form]), PRODUCTS[name](TIN, [AT])
    assert np.array_equal(made.coordinates, plain.coordinates, equal_nan=True)
    assert made.notes == plain.notes


@pytest.mark.parametrize("form", ["series", "features"])
@pytest.mark.parametrize("name", PRODUCTS)
def test_places_in_another_crs_are_refused(name, form):
    other = ts.triangulate(XYZ, crs="EPSG:32617", elevation_unit="m")
    with pytest.raises(ts.CrsError, match=r"EPSG:32616.*EPSG:32617"):
        PRODUCTS[name](other, FORMS[form])


@pytest.mark.parametrize("odd", [5, np.array(1.5), [[], []], [1, 1, 1], [[1], [2, 3]], "a", b"a"])
@pytest.mark.parametrize("name", PRODUCTS)
def test_what_is_no_place_is_refused_in_a_sentence(name, odd):
    with pytest.raises(ts.PointsError, match="Query points"):
        PRODUCTS[name](TIN, odd)


# ---------------------------------------------------------------- two places

TWO = np.array([(1.0, 1.0), (4.0, 5.0)])
FORMS_OF_TWO = {
    "array": TWO,
    "points": list(shapely.points(TWO)),
    "array of points": shapely.points(TWO),
    "several": shapely.MultiPoint(TWO),
    "series": gpd.GeoSeries(shapely.points(TWO), crs=32616),
    "frame of points": gpd.GeoDataFrame({"a": [1, 2]}, geometry=shapely.points(TWO), crs=32616),
    "frame": pd.DataFrame(TWO, columns=["lon", "lat"]),
    "columns": {"x": TWO[:, 0], "y": TWO[:, 1]},
}
OF_SEVERAL = {
    "interpolate": lambda tin, places: tin.interpolate(places),
    "natural": lambda tin, places: tin.interpolate(places, method="natural"),
    "locate": lambda tin, places: tin.locate(places),
    "stakeout": lambda tin, places: ts.stakeout(tin, places)["elevation"],
    "flow_path": lambda tin, places: ts.flow_path(tin, places).coordinates,
    "line_of_sight": lambda tin, places: (
        ts.line_of_sight(tin, places, [(3.0, 2.0), (2.0, 3.0)], eye_height=1.0).coordinates
    ),
}


@pytest.mark.parametrize("form", FORMS_OF_TWO)
@pytest.mark.parametrize("name", OF_SEVERAL)
def test_two_points_are_two_places_and_no_coordinates_of_one(name, form):
    found, wanted = (OF_SEVERAL[name](TIN, one) for one in (FORMS_OF_TWO[form], TWO))
    np.testing.assert_array_equal(found, wanted)


def test_a_mesh_and_a_raster_are_told_by_what_takes_them():
    pv = pytest.importorskip("pyvista")
    with pytest.raises(ts.PointsError, match=r"a mesh of PyVista: tinsmith\.from_mesh"):
        ts.triangulate(pv.PolyData(np.array(XYZ, float)))
    raster = ts.rasterize(TIN, spacing=1.0)
    with ts.to_rasterio(raster) as dataset:
        for refused in (dataset, raster.to_xarray()["elevation"]):
            with pytest.raises(ts.OptionError, match=r"tinsmith\.from_raster takes rasters"):
                ts.read(refused)
    with pytest.raises(ts.OptionError, match=r"io\.BytesIO makes a file object"):
        ts.read(b"x,y,z\n1,2,3\n")
