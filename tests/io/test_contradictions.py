"""What contradicts itself is refused or told by the reader of every format: finds x readers.

Each row of a table is a find, each entry what the reader of one format makes of it, or why the
format cannot hold it. A format that is missing from a row fails.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np
import pytest
from support.doubtful_files import (
    DEPTHS,
    ERRORS,
    QUADRILATERALS,
    TIMES,
    write_above_ground,
    write_lines_in_feet,
    write_points_in_degrees,
)
from support.placed_files import READ, write_points

import tinsmith as ts
from tinsmith.io.vector.geometries import read_geometries

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")

CRS = "EPSG:32616"
RNG = np.random.default_rng(1)
OFFSETS = np.column_stack([50 * RNG.random((12, 2)), RNG.random(12)])
SITE = OFFSETS + np.array([752700.0, 4024200.0, 320.0])
WARSAW = OFFSETS + np.array([637000.0, 486000.0, 110.0])
DEGREES = OFFSETS * np.array([1e-4, 1e-4, 1.0]) + np.array([-84.5, 36.3, 320.0])
EXCHANGED = [1, 0, 2]
LOCAL = (
    'ENGCRS["Site grid",EDATUM["Site datum"],CS[Cartesian,2],AXIS["easting",east],'
    'AXIS["northing",north],LENGTHUNIT["metre",1]]'
)


class Refused(NamedTuple):
    """The reader raises an error with these words."""

    words: str


class Noted(NamedTuple):
    """The reader tells it in these words."""

    words: str


class Reason(NamedTuple):
    """Why the format cannot hold it."""

    words: str


TEXT = ("delimited",)
INSTRUMENTS = ("gsi", "sdr", "jobxml", "dc")
CELLS = ("raster",)
HYDRAULIC = ("2dm", "adcirc", "selafin", "ugrid")
MESHES = ("tin", "ply", "obj", "stl", "vtk", "gmsh", *HYDRAULIC, "esri-tin", "cityjson", "off",
          "glb")  # fmt: skip
IN_DEGREES = ("geojson", "geojsonseq")
LAYERS = ("gpkg", "flatgeobuf", "shapefile", "geoparquet", "vector")
DRAWINGS = ("landxml", "12da", "dxf")
PLAIN = (*TEXT, *INSTRUMENTS, *CELLS, *MESHES, *LAYERS, "las")
"""Formats whose coordinates are in whatever CRS the caller names."""
TILE = {"terrain": Reason("longitude and latitude by its definition, placed by its name")}
RFC = Reason("longitude and latitude by its definition")


def each(names, entry):
    return dict.fromkeys(sorted(names), entry)


# ------------------------------------------------------- places that contradict the CRS named

PLACED = {
    "easting and northing exchanged": {
        **each(PLAIN, Refused("inside")),
        **each(IN_DEGREES, Refused("in the other order")),
        **each(DRAWINGS, Noted("taken in the other order than the format says")),
        **TILE,
    },
    "degrees under a projected CRS": {
        **each((*TEXT, *INSTRUMENTS, *LAYERS, "las"), Noted("taken to be degrees of WGS 84")),
        "raster": Noted("taken to be degrees of WGS 84"),
        **each((*MESHES, *DRAWINGS), Refused("as longitude and latitude in degrees, inside")),
        "gpkg": Noted("taken to be degrees of WGS 84"),
        **each(IN_DEGREES, RFC),
        **TILE,
    },
    "latitude and longitude under a projected CRS": {
        **each((*PLAIN, *DRAWINGS), Refused("as latitude and longitude in degrees, inside")),
        **each(IN_DEGREES, Refused("in the other order")),
        **TILE,
    },
    "metres under a geographic CRS": {
        **each((*TEXT, *INSTRUMENTS, *CELLS, *LAYERS, *IN_DEGREES, "las"), Refused("are none")),
        **each((*MESHES, *DRAWINGS), Refused("no longitude and latitude")),
        **TILE,
    },
    "two orders within the area of use": {
        **each(
            (*CELLS, *MESHES, *LAYERS, "las", "12da", "dxf"),
            Noted("the northing before the easting"),
        ),
        "delimited": Reason("its header or columns name the axes"),
        **each(INSTRUMENTS, Reason("its records name the axes")),
        "landxml": Reason("northing and easting by its definition"),
        **each(IN_DEGREES, RFC),
        **TILE,
    },
}
POINTS = {
    "easting and northing exchanged": (SITE[:, EXCHANGED], CRS),
    "degrees under a projected CRS": (DEGREES, CRS),
    "latitude and longitude under a projected CRS": (DEGREES[:, EXCHANGED], CRS),
    "metres under a geographic CRS": (SITE, "EPSG:4326"),
    "two orders within the area of use": (WARSAW[:, EXCHANGED], "EPSG:2180"),
}

# ----------------------------------------------------------------- what files say of themselves

NO_WORD = Reason("nothing in it tells which way elevations grow, or what else numbers are")
ONE_TIME = Reason("one surface, or points of one time")
TRIANGLES = Reason("triangles only")
NO_POLYGONS = Reason("points only")
NOT_MOVED = Reason("triangles are not reprojected")
NO_MODE = Reason("heights are elevations by its definition")
SAYING = ("ugrid", "adcirc", "selafin")
OTHERS = {name for name in READ if name not in (*TEXT, *CELLS, *SAYING)}

SAID = {
    "depths": {
        **each(OTHERS, NO_WORD),
        **each(LAYERS, Refused("no column of numbers with such a name")),
        **each(IN_DEGREES, Refused("no column of numbers with such a name")),
        "delimited": Refused("'positive' may change what it means"),
        "raster": Noted("their sign was changed"),
        "ugrid": Noted("their sign was changed"),
        "adcirc": Noted("their sign was changed"),
        "selafin": Refused("no variable BOTTOM or FOND"),
    },
    "errors of elevations": {
        **each(OTHERS, NO_WORD),
        **each(LAYERS, Refused("no column of numbers with such a name")),
        **each(IN_DEGREES, Refused("no column of numbers with such a name")),
        "delimited": Refused("'uncertainty' may change what it means"),
        "adcirc": NO_WORD,
        "selafin": Refused("no variable BOTTOM or FOND"),
        "raster": Refused("which is no elevation"),
        "ugrid": Refused("no elevations of its nodes are told"),
    },
    "a time series": {
        **each({*OTHERS, "adcirc"}, ONE_TIME),
        "selafin": Refused("between which BOTTOM changes"),
        "delimited": Refused("may change what it means"),
        "raster": Refused("one for each time"),
        "ugrid": Refused("no elevations of its nodes are told"),
    },
    "polygons of four corners": {
        **each((*TEXT, *INSTRUMENTS, *CELLS, "las"), NO_POLYGONS),
        **each(("tin", "stl", "esri-tin", "terrain", "12da", "glb"), TRIANGLES),
        **each(
            ("ply", "obj", "off", "vtk", "gmsh", "ugrid", "cityjson"), Noted("1 polygon of the")
        ),
        **each(("2dm", "adcirc", "selafin"), Noted("1 polygon of the")),
        "dxf": Noted("1 face of four corners cut in two"),
        "landxml": Refused("a face has 4 numbers"),
        **each((*LAYERS, *IN_DEGREES), Refused("holds polygons, no points")),
    },
    "heights above the ground": {
        **each(set(READ) - {"vector"}, NO_MODE),
        "vector": Refused("by their altitudeMode relativeToGround, and are left out"),
    },
    "a place that PROJ cannot transform": {
        **each(("delimited", *INSTRUMENTS, *CELLS, *LAYERS, *IN_DEGREES), Refused("no image from")),
        "las": Refused("no image from"),
        **each(DRAWINGS, Reason("lengths by its definition, moved as all points are")),
        **each(MESHES, NOT_MOVED),
        **TILE,
    },
}
WRITERS = {
    "depths": DEPTHS,
    "errors of elevations": ERRORS,
    "a time series": TIMES,
    "polygons of four corners": QUADRILATERALS,
}


def list_cases(table):
    return [
        pytest.param(find, name, entry, id=f"{find}-{name}")
        for find, row in table.items()
        for name, entry in row.items()
        if not isinstance(entry, Reason)
    ]


def require(entry, read):
    if isinstance(entry, Refused):
        with pytest.raises(ts.TinsmithError, match=entry.words) as caught:
            read()
        assert str(caught.value).endswith(".")
    else:
        assert any(entry.words in note for note in read().notes)


@pytest.mark.parametrize("table", [PLACED, SAID], ids=["places", "content"])
def test_every_reader_is_in_every_row(table):
    for find, row in table.items():
        assert set(row) == set(READ), find


@pytest.mark.parametrize(("find", "name", "entry"), list_cases(PLACED))
def test_places_that_contradict_the_crs_are_refused_or_told(tmp_path, find, name, entry):
    points, crs = POINTS[find]
    if name in IN_DEGREES and find == "easting and northing exchanged":
        points = DEGREES[:, EXCHANGED]
    path = write_points(name, points, tmp_path)
    require(entry, lambda: ts.read(path, format=name, crs=crs))


@pytest.mark.parametrize("name", [one for one in READ if one not in (*IN_DEGREES, "terrain")])
def test_places_that_agree_with_the_crs_are_read_without_a_word(tmp_path, name):
    found = ts.read(write_points(name, SITE, tmp_path), format=name, crs=CRS)
    assert not any(word in note for note in found.notes for word in ("order", "degrees", "area"))
    assert abs(found.points[:, 0].mean() - SITE[:, 0].mean()) < 30
    assert found.points[:, 1].min() > 4e6


@pytest.mark.parametrize("name", [one for one in PLAIN if one != "delimited"])
def test_exchanged_axes_are_taken_where_the_caller_asks(tmp_path, name):
    path = write_points(name, SITE[:, EXCHANGED], tmp_path)
    found = ts.read(path, format=name, crs=CRS, check_crs=False)
    assert any("in the other order" in one for one in found.notes)


@pytest.mark.parametrize(("find", "name", "entry"), list_cases(SAID))
def test_what_a_file_says_of_its_numbers_is_refused_or_told(tmp_path, find, name, entry):
    if find == "heights above the ground":
        path, options = write_above_ground(tmp_path), {}
    elif find == "a place that PROJ cannot transform":
        path, options = write_points_in_degrees(name, DEGREES, tmp_path)
    else:
        path, options = WRITERS[find][name](SITE[:4], tmp_path)
    require(entry, lambda: ts.read(path, format=name, crs=CRS, **options))


# ------------------------------------------------------------------------------ units of layers


WRITTEN = [name for name, one in READ.items() if one.write]


@pytest.mark.parametrize("name", WRITTEN)
def test_feet_are_feet_after_a_file_or_its_format_says_that_it_loses_them(tmp_path, name):
    one = READ[name]
    feet = SITE / [1, 1, 0.3048]
    tin = ts.triangulate(feet, crs=CRS, elevation_unit="ft")
    survey = ts.Survey(points=feet, crs=CRS, elevation_unit="ft")
    for given in [tin] * ("TIN" in one.writes) + [survey] * ("Survey" in one.writes):
        path = ts.write(given, tmp_path / f"{type(given).__name__}{one.suffixes[0]}", format=name)
        found = ts.read(path, format=name, crs=CRS)
        unit = found.elevation_unit
        if unit is None:
            assert "elevation unit" in one.loses
            continue
        assert (found.points[:, 2] * unit.metres).max() == pytest.approx(SITE[:, 2].max(), abs=0.01)
        with pytest.raises(ts.OptionError, match="must be"):
            ts.read(path, format=name, crs=CRS, elevation_unit="yd")


@pytest.mark.parametrize("role", ["breaklines", "boundary", "water"])
@pytest.mark.parametrize("name", [one for one in WRITTEN if "Features" in READ[one].writes])
def test_lines_and_polygons_in_feet_join_points_in_metres(tmp_path, name, role):
    if name == "landxml" and role != "breaklines":
        return  # which has no polygons
    path = write_lines_in_feet(name, role, tmp_path)
    points = ts.Survey(points=SITE, crs=CRS, elevation_unit="m")
    declared = {"elevation_unit": "ft"} if "elevation unit" in READ[name].loses else {}
    if name in DRAWINGS:
        declared = {}  # whose units are those of all lengths
    found = getattr(ts.io.with_lines(points, **{role: [path]}, **declared), role)
    if role == "water":
        heights = found[0].z
    elif role == "breaklines":
        heights = found[0].coords[:, 2]
    else:
        heights = np.reshape(found[0], (-1, 3))[:, 2]
    assert heights == pytest.approx(320.0, abs=1e-3)


# ------------------------------------------------------------------------------- other CRSs


def test_a_crs_that_proj_cannot_transform_is_an_error_of_the_file(tmp_path):
    for name in ("delimited", "ply", "flatgeobuf"):
        path = write_points(name, SITE, tmp_path)
        assert ts.read(path, crs=LOCAL).crs.name == "Site grid"
    with pytest.raises(ts.CrsError, match="No transformation from Site grid"):
        ts.read(write_points("delimited", SITE, tmp_path), source_crs=LOCAL, crs=CRS)


@pytest.mark.parametrize("name", ["ply", "flatgeobuf", "gpkg", "las", "geoparquet"])
def test_a_file_that_names_its_crs_leaves_no_order_open(tmp_path, name):
    one = READ[name]
    given = ts.Survey(points=WARSAW, crs="EPSG:2180", elevation_unit="m")
    path = ts.write(given, tmp_path / f"a{one.suffixes[0]}", format=name)
    assert not any("before the easting" in note for note in ts.read(path).notes)


@pytest.mark.parametrize("reader", [ts.io.read_lines, read_geometries])
def test_what_readers_of_lines_offer_is_an_option_of_theirs(reader, tmp_path):
    path = tmp_path / "swapped.geojson"
    places = [[36.3, -84.5, 300], [36.31, -84.49, 301], [36.32, -84.47, 302]]
    line = {"type": "LineString", "coordinates": places}
    path.write_text(json.dumps({"type": "Feature", "properties": {}, "geometry": line}))
    with pytest.raises(ts.CrsError, match="`check_crs=False` takes them"):
        reader(path, crs="EPSG:32616")
    assert len(reader(path, crs="EPSG:32616", check_crs=False)) == 1
    survey = ts.Survey(points=[[0, 0, 1], [1, 0, 2], [0, 1, 3]], crs="EPSG:32616")
    with pytest.raises(ts.CrsError, match="`check_crs=False` takes them"):
        ts.with_lines(survey, breaklines=[path])
