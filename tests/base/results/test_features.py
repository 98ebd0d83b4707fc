"""Features, rasters and tables: what they hold, and what they refuse."""

import copy
import pickle

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.errors import OptionError

RING = [[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]
HOLE = [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]


def a_polygon(**given):
    return ts.Features.of_polygons(np.array([*RING, *HOLE], float), [0, 5, 10], [0, 2], **given)


def test_lengths_and_kinds():
    assert len(ts.Features.of_points([[0, 0], [1, 1]])) == 2
    assert len(ts.Features.of_lines([[0, 0], [1, 1], [2, 2], [3, 3]], [0, 2, 4])) == 2
    assert len(ts.Features.of_lines([[0, 0], [1, 1], [2, 2], [3, 3]], [0, 2, 4], [0, 2])) == 1
    assert len(a_polygon()) == 1
    assert a_polygon().geometry_type == "Polygon"
    multi = ts.Features.of_polygons([*RING, *RING], [0, 5, 10], [0, 1, 2], [0, 2])
    assert (len(multi), multi.geometry_type) == (1, "MultiPolygon")


@pytest.mark.parametrize("kind", ["points", "lines", "polygons"])
def test_no_features_are_features(kind):
    empty = np.empty((0, 3))
    made = {
        "points": lambda: ts.Features.of_points(empty),
        "lines": lambda: ts.Features.of_lines(empty, [0]),
        "polygons": lambda: ts.Features.of_polygons(empty, [0], [0]),
    }[kind]()
    assert (len(made), made.kind) == (0, kind)


def test_units_of_columns_are_told_known_unknown_or_none():
    made = ts.Features.of_points(
        [[0, 0, 1]],
        columns={"id": [7], "elevation": [1.0], "depth": [2.0]},
        units={"elevation": ts.Unit.of("ft"), "depth": None},
    )
    assert made.units["elevation"].metres == 0.3048
    assert made.units["depth"] is None
    assert "id" not in made.units


def test_elevations_have_the_unit_of_the_vertical_axis():
    assert ts.Features.of_points([[0, 0, 1]], crs="EPSG:2274+6360").elevation_unit.name == (
        "US survey foot"
    )
    with pytest.raises(OptionError, match="unit of elevations"):
        ts.Features.of_points([[0, 0, 1]], crs="EPSG:2274+6360", elevation_unit="m")


def everything():
    grid = ts.Grid(ts.Bounds(0, 0, 2, 2), (2, 2), 1.0)
    columns = {"a": [1.5], "text": ["x"], "gap": np.array([None], object)}
    return [
        a_polygon(columns=columns, units={"a": "m"}, crs="EPSG:32616", name="p", notes=["n"]),
        ts.Raster({"z": np.eye(2)}, grid, crs="EPSG:32616", units={"z": "m"}, nodata=-9),
        ts.Table(columns, units={"a": None}, name="t", notes=("n",)),
    ]


def arrays_of(made):
    if isinstance(made, ts.Features):
        yield made.coordinates
        yield from made.offsets
    yield from (made.bands if isinstance(made, ts.Raster) else made.columns).values()


@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize(
    "twin", [copy.copy, copy.deepcopy, lambda made: pickle.loads(pickle.dumps(made))]
)
def test_copies_and_pickles_are_the_same_and_read_only(number, twin):
    made = everything()[number]
    again = twin(made)
    assert repr(again) == repr(made)
    for array, other in zip(arrays_of(made), arrays_of(again), strict=True):
        np.testing.assert_array_equal(array, other)
        assert not other.flags.writeable
    assert (again.units, again.name, again.notes) == (made.units, made.name, made.notes)


@pytest.mark.parametrize("made", everything())
def test_nothing_can_be_changed(made):
    with pytest.raises(AttributeError):
        made.name = "other"
    mapping = made.bands if isinstance(made, ts.Raster) else made.columns
    with pytest.raises(TypeError):
        mapping["new"] = np.zeros(1)
    for array in arrays_of(made):
        assert not array.flags.writeable


def test_what_the_caller_holds_stays_its_own():
    own = np.zeros((2, 2))
    made = ts.Features.of_points(own, columns={"a": own[:, 0]})
    own[:] = 5
    assert made.coordinates.max() == 0 == made.columns["a"].max()
    sealed = np.zeros((2, 2))
    sealed.flags.writeable = False
    assert ts.Features.of_points(sealed).coordinates is sealed


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: ts.Features.of_points([1, 2, 3]), "shape of coordinates [3]"),
        (lambda: ts.Features.of_points([["a", "b"]]), "coordinates 'list'"),
        (lambda: ts.Features.of_points([[0, 0], [np.nan, 2]]), "row 1 of coordinates [nan, 2.0]"),
        (lambda: ts.Features.of_points([[0, 0, np.inf]]), "row 0 of coordinates"),
        (lambda: ts.Features.of_lines([[0, 0], [1, 1]], [0, 1]), "offsets of lines [0, 1]"),
        (lambda: ts.Features.of_lines([[0, 0], [1, 1]], [0.0, 2.0]), "offsets of lines 'float64'"),
        (lambda: ts.Features.of_lines([[0, 0], [1, 1]], [0, 1, 2]), "length of line 0 1"),
        (lambda: ts.Features.of_lines([[0, 0], [1, 1]], [0, 3, 2]), "length of line 1 -1"),
        (lambda: ts.Features.of_polygons(RING[:3], [0, 3], [0, 1]), "length of ring 0 3"),
        (lambda: ts.Features.of_polygons(RING[:4], [0, 4], [0, 1]), "last point of ring 0"),
        (lambda: ts.Features.of_polygons(RING, [0, 5], [0, 0, 1]), "length of part 0 0"),
        (lambda: ts.Features.of_points([[0, 0]], columns={"a": [1, 2]}), "column 'a' 2: it"),
        (lambda: ts.Features.of_points([[0, 0]], columns={"": [1]}), "name among columns ''"),
        (lambda: ts.Features.of_points([[0, 0]], columns={"a": [1j]}), "'complex128'"),
        (lambda: ts.Features.of_points([[0, 0]], columns={"a": [["b"]]}), "shape of column"),
        (lambda: ts.Features.of_points([[0, 0]], columns={"a": [object()]}), "row 0 of column"),
        (lambda: ts.Features.of_points([[0, 0]], units={"b": "m"}), "column with a unit 'b'"),
        (
            lambda: ts.Features.of_points([[0, 0]], columns={"a": [1]}, units={"a": 3}),
            "unit of 'a' 3",
        ),
        (lambda: ts.Features.of_points([[0, 0]], name=3), "name 3"),
        (lambda: ts.Features.of_points([[0, 0]], notes="one"), "notes 'one'"),
        (lambda: ts.Features(kind="blobs", coordinates=np.zeros((1, 2))), "kind 'blobs'"),
        (lambda: ts.Features(kind="lines", coordinates=np.zeros((0, 2))), "number of offset"),
        (lambda: ts.Table({}), "number of columns 0"),
        (lambda: ts.Table([1]), "columns [1]"),
        (lambda: ts.Table({"a": [1], "b": [1, 2]}), "length of column 'b' 2"),
        (lambda: a_raster(np.zeros((3, 2))), "shape of band 'z' [3, 2]"),
        (lambda: a_raster(np.zeros((2, 2), complex)), "type of band"),
        (lambda: a_raster(np.zeros((2, 2)), nodata="x"), "nodata 'x'"),
        (lambda: a_raster(np.zeros((2, 2)), spacing=0.0), "spacing of the grid 0.0"),
        (lambda: a_raster(np.zeros((2, 2)), spacing=1.01), "bounds of the grid [0, 2]"),
        (lambda: ts.Raster({}, ts.Grid(ts.Bounds(0, 0, 1, 1), (1, 1), 1.0)), "number of bands 0"),
        (lambda: ts.Raster({"z": np.zeros((2, 2))}, (2, 2)), "grid 'tuple'"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence(call, words):
    with pytest.raises(OptionError) as caught:
        call()
    assert words in str(caught.value)
    assert str(caught.value).count("\n") == 0


def a_raster(band, *, spacing=1.0, **given):
    return ts.Raster({"z": band}, ts.Grid(ts.Bounds(0, 0, 2, 2), (2, 2), spacing), **given)


def test_a_grid_far_from_the_origin_is_not_refused_for_its_rounding():
    x, y, spacing = 736_543.1, 4_012_345.7, 0.1
    bounds = ts.Bounds(x, y, x + 1000 * spacing, y + 700 * spacing)
    grid = ts.Grid(bounds, (700, 1000), spacing)
    assert ts.Raster({"z": np.zeros((700, 1000))}, grid).shape == (700, 1000)


def test_representations_are_short():
    many = {f"column {k}": [0.0] for k in range(3)}
    assert repr(ts.Table(many, name="volume")) == (
        "<Table volume: 1 row, columns column 0, column 1, column 2>"
    )
    assert repr(a_polygon(name="bands")) == "<Features bands: 1 polygon, crs unknown>"
    assert repr(a_raster(np.zeros((2, 2)))) == (
        "<Raster: 2 rows by 2 columns, spacing 1, bands z, crs unknown>"
    )
