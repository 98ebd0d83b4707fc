"""Rasters of any geotransform: cells that are rectangles, rotated or sheared, rows from the south.

The oracles are the surface at the centres of cells, their places by rasterio; shapely, for means;
gdaldem, and GDAL's own description of what was written.
"""

from __future__ import annotations

import io
import json
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
import rasterio
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from rasterio.transform import xy as find_places
from support import relief_oracle
from support.operator_oracle import find_window, measure

import tinsmith as ts
from tinsmith.base.policies import RasterValue
from tinsmith.terrain.gridding import OPERATORS

CRS = "EPSG:32616"
CORNER = (700_000.0, 4_000_000.0)
EAST, NORTH = CORNER
TRANSFORMS = {
    "rectangles": (2.0, 0.0, EAST + 10, 0.0, -3.5, NORTH + 90),
    "south up": (2.0, 0.0, EAST + 10, 0.0, 2.0, NORTH + 10),
    "from the east": (-2.5, 0.0, EAST + 90, 0.0, -1.5, NORTH + 70),
    "turned about": (-2.0, 0.0, EAST + 90, 0.0, 3.0, NORTH + 10),
    "rotated": (1.6, 1.2, EAST + 10, 1.2, -1.6, NORTH + 60),
    "rotated by 90 degrees": (0.0, 2.0, EAST + 20, 2.0, 0.0, NORTH + 20),
    "mirrored": (1.6, -1.2, EAST + 60, 1.2, 1.6, NORTH + 10),
    "sheared": (2.0, 0.7, EAST + 20, 0.3, -2.5, NORTH + 80),
}
ALIGNED = ["rectangles", "south up", "from the east", "turned about"]
SHAPE = (24, 31)


def make_tin(*, crs=CRS):
    rng = np.random.default_rng(4)
    points = rng.random((700, 3)) * [100, 100, 12]
    points += np.array([*CORNER, 300])
    return ts.triangulate(points, crs=crs, elevation_unit="m")


TIN = make_tin()


def list_places(transform, shape=SHAPE):
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    x, y = find_places(rasterio.Affine(*transform), rows.ravel(), columns.ravel())
    return np.column_stack([x, y])


def write_raster(path, transform, *, shape=SHAPE, values=None, **profile):
    known = {"driver": "GTiff", "count": 1, "dtype": "float32", "crs": CRS, "nodata": -9999.0}
    known |= profile
    height, width = shape
    with rasterio.open(
        path, "w", width=width, height=height, transform=rasterio.Affine(*transform), **known
    ) as file:
        file.write(np.zeros(shape) if values is None else values, 1)
    return path


# ---------------------------------------------------------------- values


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("method", ["linear", "nearest", "natural"])
def test_cells_have_the_elevation_at_their_centres(name, method):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    made = ts.rasterize(TIN, grid=grid, method=method, threads=2).bands["elevation"]
    x, y = grid.transform.apply(np.arange(31) + 0.5, (np.arange(24) + 0.5)[:, None])
    x, y = np.broadcast_arrays(x, y)
    places = np.column_stack([x.ravel(), y.ravel()])
    np.testing.assert_allclose(places, list_places(grid.transform), rtol=0, atol=1e-9)
    wanted = TIN.interpolate(places, method=method)
    np.testing.assert_array_equal(made.ravel(), wanted)
    lazy = ts.rasterize(TIN, grid=grid, method=method, lazy=True).bands["elevation"]
    np.testing.assert_array_equal(lazy[3:17, 5:29], made[3:17, 5:29])


@settings(max_examples=25, deadline=None)
@given(
    st.tuples(*[st.integers(-6, 6)] * 4).filter(lambda t: t[0] * t[3] != t[1] * t[2]),
    st.tuples(st.integers(-20, 20), st.integers(-20, 20)),
    st.sampled_from([0.25, 0.5]),
)
def test_centres_on_edges_and_vertices_are_decided_exactly(turn, corner, factor):
    """On a lattice of whole numbers many centres lie on edges and vertices."""
    rng = np.random.default_rng(0)
    x, y = np.divmod(np.arange(49.0), 7)
    tin = ts.triangulate(np.column_stack([x - 3, y - 3, rng.integers(0, 9, 49)]))
    (a, d, b, e), (c, f) = np.array(turn) * factor, np.array(corner) * 0.25
    grid = ts.Grid.of_transform((a, b, c, d, e, f), (5, 6))
    places = list_places(grid.transform, (5, 6))  # exact, of multiples of an eighth
    if (tin.locate(places) < 0).all():
        with pytest.raises(ts.PointsError):
            ts.rasterize(tin, grid=grid)
        return
    made = ts.rasterize(tin, grid=grid).bands["elevation"]
    np.testing.assert_array_equal(made.ravel(), tin.interpolate(places))
    gradient_at = relief_oracle.GradientAt(tin.points, tin.triangles)
    found = ts.rasterize(tin, grid=grid, value="slope").bands["slope"].ravel()
    np.testing.assert_allclose(found, [gradient_at.slope(*place) for place in places], atol=1e-9)


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("value", ["slope", "aspect", "hillshade"])
def test_directions_are_those_of_the_map_and_not_of_rows(name, smooth, value):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    made = ts.rasterize(TIN, grid=grid, value=value, smooth=smooth).bands[value]
    for row, column in ((0, 0), (7, 3), (12, 30), (23, 5)):
        x, y = grid.transform.apply(column + 0.5, row + 0.5)
        cell = ts.Grid(ts.Bounds(x - 1, y - 1, x + 1, y + 1), (1, 1), 2.0)
        try:
            wanted = ts.rasterize(TIN, grid=cell, value=value, smooth=smooth).bands[value][0, 0]
        except ts.PointsError:
            wanted = np.nan
        np.testing.assert_allclose(made[row, column], wanted, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("value", ["elevation", "slope"])
def test_means_are_integrals_over_the_cells(name, value):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    made = ts.rasterize(TIN, grid=grid, at="mean", value=value).bands[value]
    slopes = ts.slope(TIN)
    triangles = shapely.polygons(TIN.points[TIN.triangles][:, :, :2])
    tree = shapely.STRtree(triangles)
    for row, column in ((0, 0), (5, 20), (23, 30), (13, 1)):
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        cell = shapely.Polygon([grid.transform.apply(column + i, row + j) for i, j in corners])
        total, area = 0.0, 0.0
        for t in tree.query(cell, "intersects"):
            part = shapely.intersection(triangles[t], cell)
            if part.area == 0:
                continue
            middle = TIN.interpolate(part.centroid.x, part.centroid.y)
            total += part.area * (middle if value == "elevation" else slopes[t])
            area += part.area
        wanted = total / area if area else np.nan
        np.testing.assert_allclose(made[row, column], wanted, rtol=1e-9)


@pytest.mark.parametrize("at", ["center", "mean"])
@pytest.mark.parametrize("value", [*OPERATORS, "elevation"])
def test_rows_from_the_south_have_the_values_of_those_from_the_north(value, at):
    if (value, at) == ("aspect", "mean"):
        return
    north_up = ts.Grid.of_transform((2.0, 0, EAST + 8, 0, -4.0, NORTH + 88), (20, 300))
    for a, e, west, south in ((2.0, 4.0, 8, 8), (-2.0, -4.0, 608, 88), (-2.0, 4.0, 608, 8)):
        turned = ts.Grid.of_transform((a, 0, EAST + west, 0, e, NORTH + south), (20, 300))
        assert turned.bounds == north_up.bounds
        for edges in (
            (False, True)
            if value not in ("elevation", "slope", "aspect", "hillshade")
            else (False,)
        ):
            asked = {"value": value, "at": at, "compute_edges": edges}
            one, other = (ts.rasterize(TIN, grid=g, **asked) for g in (north_up, turned))
            steps = slice(None, None, 1 if e < 0 else -1), slice(None, None, 1 if a > 0 else -1)
            np.testing.assert_array_equal(other.bands[value][steps], one.bands[value])
            lazy = ts.rasterize(TIN, grid=turned, lazy=True, **asked).bands[value]
            np.testing.assert_array_equal(lazy[2:9, 10:40], other.bands[value][2:9, 10:40])


@pytest.mark.skipif(shutil.which("gdaldem") is None, reason="needs gdaldem")
@pytest.mark.parametrize("operator", ["horn", "zevenbergen-thorne"])
@pytest.mark.parametrize("value", ["slope", "hillshade"])
def test_cells_that_are_rectangles_have_what_gdaldem_says(tmp_path, value, operator):
    transform = (2.0, 0.0, EAST, 0.0, -5.0, NORTH)
    z = np.random.default_rng(3).integers(0, 400, (23, 31)) / 4.0
    path = write_raster(tmp_path / "dem.tif", transform, shape=z.shape, values=z)
    tin = ts.triangulate(ts.read(path))
    found = ts.rasterize(tin, like=path, value=value, operator=operator).bands[value]
    name = {"horn": "Horn", "zevenbergen-thorne": "ZevenbergenThorne"}[operator]
    made = tmp_path / "made.tif"
    subprocess.run(["gdaldem", value, path, made, "-q", "-alg", name], check=True)
    with rasterio.open(made) as file:
        wanted = file.read(1).astype(float)
        wanted[wanted == file.nodata] = np.nan
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    assert np.nanmax(np.abs(found - wanted)) <= (
        1.0 if value == "hillshade" else 1e-4
    )  # whole numbers; 32 bits


@pytest.mark.parametrize("name", ["rectangles", "south up"])
@pytest.mark.parametrize("value", [*OPERATORS])
def test_operators_of_rectangles_are_those_of_the_plain_twin(name, value):
    """The aspect, too, which gdaldem computes as if cells were square."""
    operator = next(iter(OPERATORS[value]), None)
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    found = ts.rasterize(TIN, grid=grid, value=value, operator=operator).bands[value]
    z = ts.rasterize(TIN, grid=grid).bands["elevation"]
    z, found = (z[::-1], found[::-1]) if name == "south up" else (z, found)
    for row, column in ((3, 4), (10, 20), (17, 9)):
        window = find_window(z.tolist(), row, column, False)
        wanted = measure(window, value, operator, *grid.cell_size, 1.0)
        wanted = np.rint(wanted) if value == "hillshade" else wanted
        np.testing.assert_allclose(found[row, column], wanted, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ["rotated", "sheared"])
@pytest.mark.parametrize("value", ["tri", "tpi", "roughness"])
def test_ruggedness_is_of_the_neighbours_among_rotated_cells(name, value):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    found = ts.rasterize(TIN, grid=grid, value=value).bands[value]
    z = ts.rasterize(TIN, grid=grid).bands["elevation"].tolist()
    for row, column in ((3, 4), (10, 20), (17, 9)):
        window = find_window(z, row, column, False)
        wanted = np.nan if window is None else measure(window, value, "riley", 1.0, 1.0, 1.0)
        np.testing.assert_allclose(found[row, column], wanted, rtol=1e-12)


@pytest.mark.parametrize("name", ["rotated", "mirrored", "sheared"])
@pytest.mark.parametrize(
    "value", [name for name in OPERATORS if name not in ("tri", "tpi", "roughness")]
)
def test_operators_of_rotated_cells_are_refused(name, value):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    operator = OPERATORS[value][0]
    with pytest.raises(ts.OptionError, match="rotated or sheared cells"):
        ts.rasterize(TIN, grid=grid, value=value, operator=operator)


# ---------------------------------------------------------------- points


@pytest.mark.parametrize("name", TRANSFORMS)
def test_points_count_in_the_cells_that_hold_them(name):
    grid = ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
    cloud = np.random.default_rng(8).random((4000, 3)) * [100, 100, 30] + [*CORNER, 300]
    counts = ts.rasterize_counts(ts.Survey(points=cloud, crs=CRS), grid=grid).bands["count"]
    at = ~rasterio.Affine(*grid.transform) @ (cloud[:, 0], cloud[:, 1])
    column, row = np.floor(at).astype(int)
    inside = (row >= 0) & (row < SHAPE[0]) & (column >= 0) & (column < SHAPE[1])
    wanted = np.zeros(SHAPE, int)
    np.add.at(wanted, (row[inside], column[inside]), 1)
    np.testing.assert_array_equal(counts, wanted)
    canopy = ts.rasterize_canopy(TIN, ts.Survey(points=cloud, crs=CRS), grid=grid)
    highest = np.full(SHAPE, -np.inf)
    np.maximum.at(highest, (row[inside], column[inside]), cloud[inside, 2])
    np.testing.assert_array_equal(canopy.bands["dsm"], np.where(wanted > 0, highest, np.nan))
    np.testing.assert_array_equal(
        canopy.bands["dtm"], ts.rasterize(TIN, grid=grid).bands["elevation"]
    )


def test_points_between_cells_are_in_the_eastern_or_southern_one_whichever_way_rows_run():
    cloud = np.array([[2.0, 2.0, 1], [2.0, 0.0, 1], [0.0, 2.0, 1], [4.0, 4.0, 1]])
    north_up = ts.Grid.of_transform((2, 0, 0, 0, -2, 4), (2, 2))
    counts = ts.rasterize_counts(cloud, grid=north_up).bands["count"]
    south_up = ts.Grid.of_transform((2, 0, 0, 0, 2, 0), (2, 2))
    np.testing.assert_array_equal(
        ts.rasterize_counts(cloud, grid=south_up).bands["count"], counts[::-1]
    )


# ---------------------------------------------------------------- every product

PRODUCTS = {
    **{f"rasterize {value}": (value, "center") for value in RasterValue.__args__},
    "rasterize means": ("elevation", "mean"),
    "hillshade": None,
    "rasterize_counts": None,
    "rasterize_heights": None,
    "rasterize_canopy": None,
}
CLOUD = ts.Survey(
    points=np.random.default_rng(1).random((900, 3)) * [100, 100, 30] + [*CORNER, 300],
    crs=CRS,
    elevation_unit="m",
)


def make_product(name, **how):
    if name.startswith("rasterize "):
        value, at = PRODUCTS[name]
        return ts.rasterize(TIN, value=value, at=at, **how)
    return {
        "hillshade": lambda: ts.hillshade(TIN, **how),
        "rasterize_counts": lambda: ts.rasterize_counts(CLOUD, **how),
        "rasterize_heights": lambda: ts.rasterize_heights(TIN, CLOUD, **how),
        "rasterize_canopy": lambda: ts.rasterize_canopy(TIN, CLOUD, **how),
    }[name]()


def test_every_function_that_makes_a_raster_of_cells_is_among_these():
    import inspect

    known = {name.partition(" ")[0] for name in PRODUCTS}
    takes_cells = {
        name
        for name in ts.__all__
        if callable(getattr(ts, name))
        and not inspect.isclass(getattr(ts, name))
        and {"spacing", "grid"} <= set(inspect.signature(getattr(ts, name)).parameters)
    }
    assert takes_cells == known
    for name in takes_cells:
        assert "like" in inspect.signature(getattr(ts, name)).parameters


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("product", PRODUCTS)
def test_every_raster_is_written_with_the_geotransform_of_the_other(tmp_path, product, name):
    like = write_raster(tmp_path / "like.tif", TRANSFORMS[name])
    is_refused = name not in ALIGNED and product.endswith("-curvature")
    if is_refused:
        with pytest.raises(ts.OptionError, match="rotated or sheared"):
            make_product(product, like=like)
        return
    made = make_product(product, like=like)
    path = ts.write(made, tmp_path / "made.tif")
    with rasterio.open(like) as one, rasterio.open(path) as other:
        assert other.transform == one.transform
        assert (other.shape, other.crs) == (one.shape, one.crs)
        is_float = next(iter(made.bands.values())).dtype.kind == "f"
        if is_float:
            assert (other.dtypes, other.nodata) == (one.dtypes * other.count, one.nodata)
        for number, band in enumerate(made.bands.values(), 1):
            wanted = np.nan_to_num(band.astype("float32"), nan=-9999.0) if is_float else band
            np.testing.assert_array_equal(other.read(number), wanted)
        again = make_product(product, like=one)
    assert again.grid == made.grid
    content = io.BytesIO(like.read_bytes())
    assert make_product(product, like=content).grid == made.grid
    assert make_product(product, like=made.to_xarray()).grid == made.grid
    assert make_product(product, like=made).grid == made.grid


@pytest.mark.skipif(shutil.which("gdalinfo") is None, reason="needs gdalinfo")
@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("kind", ["geotiff", "cog"])
def test_gdalinfo_says_the_same_of_both(tmp_path, name, kind):
    like = write_raster(tmp_path / "like.tif", TRANSFORMS[name])
    made = ts.write(ts.rasterize(TIN, like=like), tmp_path / "made.tif", format=kind)
    one, other = (
        json.loads(subprocess.run(["gdalinfo", "-json", f], check=True, capture_output=True).stdout)
        for f in (like, made)
    )
    for key in ("geoTransform", "cornerCoordinates", "size"):
        assert other[key] == one[key]


# ---------------------------------------------------------------- as others have it


@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")  # of rioxarray, in affine
@pytest.mark.parametrize("name", TRANSFORMS)
def test_xarray_and_rasterio_have_the_places_of_cells(name):
    rioxarray = pytest.importorskip("rioxarray")
    assert rioxarray is not None
    made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS[name], SHAPE))
    dataset = made.to_xarray()
    places = list_places(TRANSFORMS[name]).reshape(*SHAPE, 2)
    if name in ALIGNED:
        np.testing.assert_allclose(dataset["x"], places[0, :, 0], rtol=0, atol=1e-9)
        np.testing.assert_allclose(dataset["y"], places[:, 0, 1], rtol=0, atol=1e-9)
    else:
        np.testing.assert_allclose(dataset["xc"], places[..., 0], rtol=0, atol=1e-9)
        np.testing.assert_allclose(dataset["yc"], places[..., 1], rtol=0, atol=1e-9)
    assert tuple(dataset.rio.transform()) == tuple(rasterio.Affine(*TRANSFORMS[name]))
    with ts.to_rasterio(made) as opened:
        assert opened.transform == rasterio.Affine(*TRANSFORMS[name])
    points = ts.from_raster(made, fill=True).points
    again = ts.from_raster(dataset, fill=True).points
    np.testing.assert_array_equal(points, again)
    is_known = np.isfinite(made.bands["elevation"]).ravel()
    np.testing.assert_allclose(points[:, :2], places.reshape(-1, 2)[is_known], rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", TRANSFORMS)
def test_a_notebook_shows_rasters_north_up_where_that_can_be(name):
    made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS[name], SHAPE))
    page = made._repr_html_()
    assert ("north up" in page) == (name in ALIGNED)
    assert repr(made).startswith("<Raster elevation: 24 rows by 31 columns")


def test_the_axes_of_a_crs_that_run_west_and_south_turn_what_is_drawn():
    """EPSG:2052 has westings and southings: what is east in its numbers is drawn to the west."""
    from tinsmith.terrain.drawing import draw_north_up

    tin = make_tin(crs=None).replace(crs="EPSG:2052")
    for name in TRANSFORMS:
        made = ts.rasterize(tin, grid=ts.Grid.of_transform(TRANSFORMS[name], SHAPE))
        drawn = draw_north_up(made)
        assert sorted(drawn.bands["elevation"].ravel()) == pytest.approx(
            sorted(made.bands["elevation"].ravel()), nan_ok=True
        )
        x, y = drawn.grid.transform.apply(0.5, 0.5)
        value = drawn.bands["elevation"][0, 0]
        np.testing.assert_allclose(value, tin.interpolate([[-x, -y]])[0])


def test_text_grids_have_rectangles_and_refuse_other_rows(tmp_path):
    made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS["rectangles"], SHAPE))
    with pytest.warns(ts.LossWarning):
        path = ts.write(made, tmp_path / "made.asc")
    with rasterio.open(path) as file:
        assert file.transform.almost_equals(rasterio.Affine(*TRANSFORMS["rectangles"]))
        band = made.bands["elevation"]
        found = np.where(file.read(1) == file.nodata, np.nan, file.read(1))
        np.testing.assert_allclose(found, band, rtol=1e-6)
    for name in set(TRANSFORMS) - {"rectangles"}:
        made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS[name], SHAPE))
        for suffix in ("asc", "mbtiles"):
            with pytest.raises(ts.FormatError, match=r"from north to south .* GeoTIFF holds any"):
                ts.write(made, tmp_path / f"refused.{suffix}")
            assert not (tmp_path / f"refused.{suffix}").exists()


def test_tiles_for_browsers_are_of_rectangles_too(tmp_path):
    made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS["rectangles"], SHAPE))
    with pytest.warns(ts.LossWarning) as told:
        path = ts.write(made, tmp_path / "made.mbtiles")
    assert "Tiles of 512 pixels" in str(told[0].message)
    with rasterio.open(path) as file:
        assert file.count >= 3


def test_simplification_refuses_other_cells(tmp_path):
    for name in TRANSFORMS:
        if name == "rotated":
            path = write_raster(tmp_path / "dem.tif", TRANSFORMS[name])
            made = ts.read_raster(path)
            assert made.grid == ts.Grid.of_transform(TRANSFORMS[name], SHAPE)
        made = ts.rasterize(TIN, grid=ts.Grid.of_transform(TRANSFORMS[name], SHAPE))
        with pytest.raises(ts.OptionError, match="a north-up raster of square cells"):
            ts.simplify(made, tolerance=1.0)


# ---------------------------------------------------------------- hostile geotransforms

HOSTILE = {
    "no area": ((2.0, 4.0, EAST, 1.0, 2.0, NORTH), SHAPE, "cells have an area"),
    "no width": ((0.0, 0.0, EAST, 0.0, -2.0, NORTH), SHAPE, "cells have an area"),
    "NaN": ((np.nan, 0.0, EAST, 0.0, -2.0, NORTH), SHAPE, "six finite numbers"),
    "infinite": ((2.0, 0.0, np.inf, 0.0, -2.0, NORTH), SHAPE, "six finite numbers"),
    "huge": ((1e308, 0.0, EAST, 0.0, -1e308, NORTH), SHAPE, "area|corners are finite"),
    "shear of 1e15": ((2.0, 2e15, EAST, 0.0, -2.0, NORTH), SHAPE, "cells have an area"),
    "tiny": ((1e-12, 0.0, EAST + 50, 0.0, -2.0, NORTH + 50), SHAPE, "spacing 1e-12.* at least"),
    "tiny and turned": (
        (6e-13, 8e-13, EAST + 50, 8e-13, -6e-13, NORTH + 50), SHAPE, "at least .* at these"
    ),
    "no rows": ((2.0, 0.0, EAST, 0.0, -2.0, NORTH), (0, 4), "1 or more rows"),
    "too many": ((1e-3, 0.0, EAST, 0.0, -2.0, NORTH), (2**20, 2**20), "number of cells"),
    "rows that are no number": ((2.0, 0.0, EAST, 0.0, -2.0, NORTH), ("a", 4), "1 or more rows"),
    "one side": ((2.0, 0.0, EAST, 0.0, -2.0, NORTH), (4,), "1 or more rows"),
    "half a row": ((2.0, 0.0, EAST, 0.0, -2.0, NORTH), (4.5, 4), "1 or more rows"),
    "a word": ("abcdef", SHAPE, "six finite numbers"),
    "nothing": (None, SHAPE, "six finite numbers"),
    "five numbers": ((1.0, 0.0, EAST, 0.0, -2.0), SHAPE, "six finite numbers"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_geotransforms_are_refused_in_a_sentence(name):
    transform, shape, sentence = HOSTILE[name]
    with pytest.raises(ts.OptionError, match=sentence) as caught:
        ts.rasterize(TIN, grid=ts.Grid.of_transform(transform, shape))
    assert str(caught.value).count(". ") == 0


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_data_sets_of_others_are_refused_in_a_sentence(name):
    transform, shape, _ = HOSTILE[name]
    with pytest.raises(ts.OptionError) as caught:
        ts.rasterize(TIN, like=SimpleNamespace(transform=transform, shape=shape, crs=None))
    assert str(caught.value).count(". ") == 0


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (40, 1)])
@pytest.mark.parametrize("name", TRANSFORMS)
def test_single_rows_and_columns(name, shape):
    grid = ts.Grid.of_transform(TRANSFORMS[name], shape)
    places = np.column_stack(
        [
            axis.ravel()
            for axis in np.broadcast_arrays(
                *grid.transform.apply(
                    np.arange(shape[1]) + 0.5, (np.arange(shape[0]) + 0.5)[:, None]
                )
            )
        ]
    )
    for at in ("center", "mean"):
        try:
            made = ts.rasterize(TIN, grid=grid, at=at).bands["elevation"]
        except ts.PointsError:
            assert (TIN.locate(places) < 0).all()
            continue
        if at == "center":
            np.testing.assert_array_equal(made.ravel(), TIN.interpolate(places))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"bounds": ts.Bounds(0, 0, 5, 5)}, "bounds of the grid"),
        ({"spacing": 2.0}, "spacing of the grid"),
        ({"spacing": "wide"}, "Invalid spacing 'wide'"),
        ({"spacing": (2.0, -3.0)}, "spacing of the grid"),
        ({"spacing": (2.0, 3.0, 4.0)}, "spacing of the grid"),
        ({"shape": (3, 3)}, "bounds of the grid"),
    ],
)
@pytest.mark.parametrize("name", ["rectangles", "sheared"])
def test_grids_whose_numbers_contradict_each_other_are_refused(name, change, sentence):
    from dataclasses import replace

    grid = replace(ts.Grid.of_transform(TRANSFORMS[name], SHAPE), **change)
    with pytest.raises(ts.OptionError, match=sentence):
        ts.rasterize(TIN, grid=grid)


def test_a_grid_of_rectangles_needs_no_geotransform():
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 8.0, 9.0), shape=(3, 4), spacing=(2.0, 3.0))
    assert grid == ts.Grid.of_transform((2.0, 0.0, 0.0, 0.0, -3.0, 9.0), (3, 4))
    assert "transform" not in repr(grid)
    turned = ts.Grid.of_transform((2.0, 0.0, 0.0, 0.0, 3.0, 0.0), (3, 4))
    assert "transform=(2.0, 0.0, 0.0, 0.0, 3.0, 0.0)" in repr(turned)


def test_cells_that_are_square_but_for_rounding_keep_their_own_geotransform(tmp_path):
    transform = (1 / 3, 0.0, EAST + 10, 0.0, -0.333333333, NORTH + 40)
    like = write_raster(tmp_path / "like.tif", transform, shape=(30, 30))
    made = ts.rasterize(TIN, like=like)
    assert made.grid.spacing == pytest.approx(1 / 3)
    with rasterio.open(ts.write(made, tmp_path / "made.tif")) as file, rasterio.open(like) as one:
        assert file.transform == one.transform
