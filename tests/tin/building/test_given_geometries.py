"""Points and lines of other libraries give the TIN of plain arrays, in the CRS that they have."""

from __future__ import annotations

import itertools
import json

import geopandas
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
import shapely
import xarray
from support.same_tins import find_differences

import tinsmith as ts

CRS = "EPSG:32616"
RNG = np.random.default_rng(3)
POINTS = np.column_stack([RNG.random((60, 2)) * 100, RNG.random(60) * 9]).round(2)
LINES = [
    np.array([[5.0, 5, 1], [50, 60, 2], [90, 95, 3]]),
    np.array([[10.0, 90, 4], [95, 20, 6]]),
]
SQUARE = np.array([[20.0, 20], [70, 20], [70, 60], [20, 60]])
ISLAND = np.array([[40.0, 30], [40, 40], [50, 40]])
POND = np.array([[75.0, 75], [85, 75], [80, 85]])


class Interface:
    """What is of no library that anyone knows."""

    def __init__(self, *geometries, **columns):
        rows = zip(*columns.values(), strict=True) if columns else itertools.repeat(())
        features = [
            {
                "type": "Feature",
                "properties": dict(zip(columns, row, strict=True)),
                "geometry": shapely.geometry.mapping(one),
            }
            for one, row in zip(geometries, rows, strict=False)
        ]
        self.__geo_interface__ = {"type": "FeatureCollection", "features": features}


def frame_of(geometries, crs=CRS, **columns):
    return geopandas.GeoDataFrame(columns, geometry=list(geometries), crs=crs)


POINT_FORMS = {
    "pandas": pd.DataFrame(POINTS, columns=["x", "y", "z"]).assign(code="EP"),
    "pandas, other order": pd.DataFrame(POINTS[:, ::-1], columns=["elev", "North", "East"]),
    "polars": pl.DataFrame(dict(zip("xyz", POINTS.T, strict=True))),
    "pyarrow": pa.table(dict(zip("xyz", POINTS.T, strict=True))),
    "mapping": dict(zip(("easting", "northing", "elevation"), POINTS.T, strict=True)),
    "structured": np.rec.fromarrays(POINTS.T, names="x, y, z"),
    "xarray": xarray.DataArray(POINTS, dims=("point", "axis")),
    "xarray of variables": xarray.Dataset(
        {name: ("i", column) for name, column in zip("xyz", POINTS.T, strict=True)}
    ),
    "GeoSeries": geopandas.GeoSeries(shapely.points(POINTS)),
    "GeoDataFrame": frame_of(shapely.points(POINTS), None),
    "GeoDataFrame, column": frame_of(shapely.points(POINTS[:, :2]), None, height=POINTS[:, 2]),
    "multipoint": shapely.multipoints(shapely.points(POINTS)),
    "multipoints": [shapely.MultiPoint(POINTS[:9]), shapely.MultiPoint(POINTS[9:])],
    "features": ts.Features.of_points(POINTS),
    "interface": Interface(*shapely.points(POINTS)),
    "mapping of GeoJSON": Interface(*shapely.points(POINTS)).__geo_interface__,
}


@pytest.mark.parametrize("form", POINT_FORMS)
def test_points_in_every_form_give_one_tin(form):
    tin = ts.triangulate(POINT_FORMS[form])
    assert find_differences(tin, ts.triangulate(POINTS)) == []
    assert len(ts.Survey(points=POINT_FORMS[form])) == len(POINTS)


LINE_FORMS = {
    "lines": [shapely.LineString(line) for line in LINES],
    "array of lines": np.array([shapely.LineString(line) for line in LINES], object),
    "multiline": shapely.MultiLineString(LINES),
    "list with a multiline": [shapely.MultiLineString(LINES)],
    "mixed with arrays": [LINES[0], shapely.LineString(LINES[1])],
    "collection": shapely.GeometryCollection([shapely.LineString(line) for line in LINES]),
    "GeoSeries": geopandas.GeoSeries([shapely.LineString(line) for line in LINES]),
    "GeoDataFrame": frame_of([shapely.MultiLineString(LINES)], None),
    "features": ts.Features.of_lines(np.concatenate(LINES), [0, 3, 5]),
    "multi features": ts.Features.of_lines(np.concatenate(LINES), [0, 3, 5], [0, 2]),
    "interface": Interface(shapely.MultiLineString(LINES)),
    "list of frames": [frame_of([shapely.LineString(line)], None) for line in LINES],
    "text of GeoJSON": json.loads(shapely.to_geojson(shapely.MultiLineString(LINES))),
}


@pytest.mark.parametrize("form", LINE_FORMS)
@pytest.mark.parametrize("is_flat", [False, True])
def test_breaklines_in_every_form_give_one_tin(form, is_flat):
    lines = LINE_FORMS[form]
    if is_flat and form not in ("lines", "array of lines", "multiline", "GeoSeries"):
        return
    plain = [line[:, :2] for line in LINES] if is_flat else LINES
    flat = shapely.force_2d(lines) if is_flat else lines
    wanted = ts.triangulate(POINTS, breaklines=plain)
    assert find_differences(ts.triangulate(POINTS, breaklines=flat), wanted) == []
    survey = ts.Survey(points=POINTS, breaklines=flat)
    assert find_differences(ts.triangulate(survey), wanted) == []
    assert ts.check(wanted, points=POINTS, breaklines=flat).ok


def test_rings_of_polygons_are_closed_breaklines():
    found = ts.triangulate(POINTS, breaklines=shapely.Polygon(SQUARE, [ISLAND]))
    rings = [np.vstack([ring, ring[:1]]) for ring in (SQUARE, ISLAND)]
    assert find_differences(found, ts.triangulate(POINTS, breaklines=rings)) == []


@pytest.mark.parametrize("role", ["boundary", "holes", "erase"])
def test_regions_in_every_form_give_one_tin(role):
    donut = shapely.Polygon(SQUARE, [ISLAND])
    forms = [
        donut,
        [donut],
        shapely.MultiPolygon([donut]),
        geopandas.GeoSeries([donut]),
        frame_of([donut], None, name=["a"]),
        Interface(donut),
        ts.Features.of_polygons(
            shapely.get_coordinates(donut), [0, 5, 9], [0, 2], columns={"kind": ["x"]}
        ),
    ]
    rings = [np.array(ring.coords)[:-1] for ring in (donut.exterior, *donut.interiors)]
    wanted = ts.triangulate(POINTS, **{role: [rings]})
    for form in forms:
        assert find_differences(ts.triangulate(POINTS, **{role: form}), wanted) == [], form
        survey = ts.Survey(points=POINTS, **{role: form})
        assert find_differences(ts.triangulate(survey), wanted) == [], form


def test_water_in_every_form_gives_one_tin():
    solid = shapely.force_3d(shapely.Polygon(POND), 2.5)
    wanted = ts.triangulate(POINTS, water=[ts.Water(POND, 2.5)])
    for form in (
        solid,
        [solid],
        geopandas.GeoSeries([solid]),
        frame_of([shapely.Polygon(POND)], None, level=[2.5]),
        frame_of([shapely.MultiPolygon([shapely.Polygon(POND)])], None, Z=["2.5"]),
        Interface(shapely.Polygon(POND), height=[2.5], z=[2.5]),
    ):
        assert find_differences(ts.triangulate(POINTS, water=form), wanted) == [], form
    named = frame_of([solid], None, name=["pond"])
    assert ts.triangulate(POINTS, water=named).lines.names == ("pond",)


def test_columns_of_lines_are_honoured_as_those_of_files_are():
    lines = [shapely.LineString(line) for line in LINES]
    frame = frame_of(lines, None, kind=["Soft", None], priority=[1, 3], Name=["kerb", None])
    given = [
        ts.Breakline(LINES[0], kind="soft", priority=1, name="kerb"),
        ts.Breakline(LINES[1], priority=3),
    ]
    found = ts.triangulate(POINTS, breaklines=frame)
    assert find_differences(found, ts.triangulate(POINTS, breaklines=given)) == []
    assert found.lines.names[0] == "kerb"


# -------------------------------------------------------------------------- CRS


@pytest.mark.parametrize("role", ["breaklines", "boundary", "holes", "erase", "water"])
def test_the_crs_of_lines_must_be_that_of_the_points(role):
    shape = shapely.force_3d(shapely.Polygon(SQUARE), 1.0)
    mine, other = (geopandas.GeoSeries([shape], crs=crs) for crs in (CRS, "EPSG:32617"))
    points = geopandas.GeoSeries(shapely.points(POINTS), crs=CRS)
    assert ts.triangulate(points, **{role: mine}).crs == CRS
    for build in (ts.triangulate, lambda points, **lines: ts.Survey(points=points, **lines)):
        with pytest.raises(ts.CrsError, match=rf"The {role} are in EPSG:32617, and EPSG:32616"):
            build(points, **{role: other})
        with pytest.raises(ts.CrsError, match=rf"The {role} are in EPSG:32617"):
            build(points, **{role: [other]})
    with pytest.raises(ts.CrsError, match="The points are in EPSG:32616"):
        ts.triangulate(points, crs="EPSG:32617")


def test_the_crs_of_lines_is_taken_and_told_where_the_points_have_none():
    lines = geopandas.GeoSeries([shapely.LineString(LINES[0])], crs=CRS)
    tin = ts.triangulate(POINTS, breaklines=lines)
    assert tin.crs == CRS
    assert "The CRS, EPSG:32616, is that of the breaklines." in tin.report.notes
    survey = ts.Survey(points=POINTS, breaklines=lines)
    assert (survey.crs, list(survey.notes)) == (CRS, list(tin.report.notes))


def test_a_vertical_axis_may_be_added_to_the_crs():
    points = geopandas.GeoSeries(shapely.points(POINTS), crs=CRS)
    tin = ts.triangulate(points, crs="EPSG:32616+5703")
    assert tin.elevation_unit.name == "metre"
    compound = geopandas.GeoSeries(shapely.points(POINTS), crs="EPSG:32616+6360")
    assert ts.triangulate(compound).elevation_unit.name == "US survey foot"
    with pytest.raises(ts.OptionError, match="vertical axis"):
        ts.triangulate(compound, elevation_unit="m")


def test_places_and_edits_in_another_crs_are_refused():
    tin = ts.triangulate(POINTS, crs=CRS)
    other = geopandas.GeoSeries(shapely.points(POINTS[:3] + 0.5), crs="EPSG:4326")
    same = other.set_crs(CRS, allow_override=True)
    line = geopandas.GeoSeries([shapely.LineString(LINES[0])], crs="EPSG:4326")
    for ask in (tin.locate, tin.interpolate, tin.closest_vertex, tin.insert):
        with pytest.raises(ts.CrsError, match="EPSG:4326, and EPSG:32616 is another CRS"):
            ask(other)
        ask(same)
    with pytest.raises(ts.CrsError, match="coords of the edit are in EPSG:4326"):
        tin.add_breakline(line)
    tin.add_breakline(line.set_crs(CRS, allow_override=True))
    plain = ts.triangulate(POINTS, crs=CRS)
    plain.insert(POINTS[:3] + 0.5)
    plain.add_breakline(LINES[0])
    assert find_differences(tin, plain) == []
    assert json.dumps([edit.to_dict() for edit in tin.edits])


# --------------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda: ts.triangulate(POINTS, breaklines=shapely.Point(1, 1)), "a Point is no line"),
        (lambda: ts.triangulate(POINTS, water=shapely.LineString(LINES[0])), "is no polygon"),
        (lambda: ts.triangulate(POINTS, water=shapely.Polygon(POND)), "one elevation and has none"),
        (
            lambda: ts.triangulate(POINTS, water=frame_of([shapely.Polygon(POND)], z=["a"])),
            "the elevation 'a': a number",
        ),
        (
            lambda: ts.triangulate(
                POINTS, water=frame_of([shapely.Polygon(POND)], z=[1], level=[2])
            ),
            "several columns .* differ: z, level",
        ),
        (
            lambda: ts.triangulate(POINTS, water=shapely.Polygon([*LINES[0], *LINES[1]])),
            "corners of several",
        ),
        (
            lambda: ts.triangulate(POINTS, water=shapely.Polygon(SQUARE, [ISLAND])),
            "an island, and a water polygon has one ring",
        ),
        (
            lambda: ts.triangulate(
                POINTS, breaklines=frame_of([shapely.LineString(LINES[0])], kind=["road"])
            ),
            "the kind 'road': hard or soft, or none",
        ),
        (
            lambda: ts.triangulate(
                POINTS, breaklines=frame_of([shapely.LineString(LINES[0])], priority=[0.5])
            ),
            r"the priority 0\.5: a whole number",
        ),
        (
            lambda: ts.triangulate(
                POINTS, breaklines=geopandas.GeoSeries([shapely.LineString(LINES[0]), None])
            ),
            "a missing geometry is no line",
        ),
        (
            lambda: ts.Breakline(shapely.MultiLineString(LINES)),
            r"other than one line or ring \(LineString, LineString\)",
        ),
        (
            lambda: ts.Water(shapely.Polygon(SQUARE, [ISLAND]), 1.0),
            r"other than one line or ring \(Polygon\)",
        ),
    ],
)
def test_geometries_that_are_no_lines_are_refused(act, sentence):
    with pytest.raises(ts.LinesError, match=sentence):
        act()


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        (geopandas.GeoSeries([shapely.Point(1, 1, 1), None]), "not all of them points"),
        (geopandas.GeoSeries([shapely.Point(1, 1, 1), shapely.Point()]), "not all of them points"),
        (Interface(shapely.LineString(LINES[0])), "not all of them points"),
        (frame_of(shapely.points(POINTS), z=POINTS[:, 2] + 1), "elevations in their geometries"),
        (xarray.DataArray(np.ones((3, 3)), dims=("y", "x")), "cells of a raster"),
        (xarray.DataArray(np.ones((3, 3)), dims=("y", "x")).to_dataset(name="z"), "of a raster"),
    ],
)
def test_points_in_doubt_are_refused(points, sentence):
    with pytest.raises(ts.PointsError, match=sentence):
        ts.triangulate(points)


RING_FORMS = {
    "rows": SQUARE.tolist(),
    "tuples": [tuple(row) for row in SQUARE.tolist()],
    "frame": pd.DataFrame(SQUARE, columns=["x", "y"]),
    "columns": {"easting": SQUARE[:, 0], "northing": SQUARE[:, 1]},
    "dataset": xarray.Dataset({"x": ("row", SQUARE[:, 0]), "y": ("row", SQUARE[:, 1])}),
    "polars": pl.DataFrame({"x": SQUARE[:, 0], "y": SQUARE[:, 1]}),
    "structured": np.array([tuple(row) for row in SQUARE], [("x", float), ("y", float)]),
}


@pytest.mark.parametrize("form", RING_FORMS)
@pytest.mark.parametrize("role", ["boundary", "holes", "erase", "breaklines"])
def test_one_line_needs_no_list_around_it(role, form):
    found, wanted = (ts.triangulate(POINTS, **{role: one}) for one in (RING_FORMS[form], [SQUARE]))
    assert not find_differences(found, wanted)


@pytest.mark.parametrize("form", RING_FORMS)
def test_a_table_is_a_line_to_drape_and_to_cut_along(form):
    tin = ts.triangulate(POINTS)
    for product in (ts.drape, lambda tin, line: ts.profile({"a": tin}, line)):
        found, wanted = (product(tin, one) for one in (RING_FORMS[form], SQUARE))
        columns = {**getattr(found, "columns", {})}
        assert {*columns} == {*getattr(wanted, "columns", {})}
        if hasattr(found, "coordinates"):
            np.testing.assert_array_equal(found.coordinates, wanted.coordinates)
