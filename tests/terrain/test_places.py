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
