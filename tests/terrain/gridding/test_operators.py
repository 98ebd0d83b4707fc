"""Operators on grids: beside gdaldem, closed forms and plain twins of gdaldem's source."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest
import rasterio
from support.operator_oracle import find_window, measure

import tinsmith as ts
from tinsmith.terrain.gridding import OPERATORS

NODATA = -9999.0
ASKED = [
    ("slope", "horn", ("slope",)),
    ("slope", "zevenbergen-thorne", ("slope", "-alg", "ZevenbergenThorne")),
    ("aspect", "horn", ("aspect",)),
    ("aspect", "zevenbergen-thorne", ("aspect", "-alg", "ZevenbergenThorne")),
    ("hillshade", "horn", ("hillshade",)),
    ("hillshade", "zevenbergen-thorne", ("hillshade", "-alg", "ZevenbergenThorne")),
    ("tri", "riley", ("TRI",)),
    ("tri", "wilson", ("TRI", "-alg", "Wilson")),
    ("tpi", None, ("TPI",)),
    ("roughness", None, ("roughness",)),
]
CURVATURES = [value for value in OPERATORS if value.endswith("-curvature")]
needs_gdaldem = pytest.mark.skipif(shutil.which("gdaldem") is None, reason="needs gdaldem")


def write_dem(path, z, *, spacing=2.0, crs="EPSG:32616", corner=(500_000.0, 4_000_000.0)):
    profile = {
        "driver": "GTiff",
        "height": z.shape[0],
        "width": z.shape[1],
        "count": 1,
        "dtype": "float32",
        "crs": crs,
        "nodata": NODATA,
        "transform": rasterio.Affine(spacing, 0, corner[0], 0, -spacing, corner[1]),
    }
    with rasterio.open(path, "w", **profile) as file:
        file.write(np.where(np.isnan(z), NODATA, z).astype("float32"), 1)
    return path


def make_elevations(seed, shape=(23, 31), *, holes=0.08):
    rng = np.random.default_rng(seed)
    z = rng.integers(0, 400, shape) / 4.0  # sums of which are exact in 32 bits
    z[rng.random(shape) < holes] = np.nan
    return z


def ask_gdaldem(path, *options):
    made = path.with_name("gdaldem.tif")
    subprocess.run(["gdaldem", options[0], path, made, "-q", *options[1:]], check=True)
    with rasterio.open(made) as file:
        band = file.read(1).astype(float)
        return np.where(band == file.nodata, np.nan, band)


def require_equal(value, found, wanted):
    """Refuse what differs by more than the rounding to 32 bits."""
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    off = np.abs(found - wanted)
    if value == "aspect":
        off = np.minimum(off, 360.0 - off)
    assert np.nanmax(off) <= 4 * np.finfo(np.float32).eps * np.nanmax(np.abs(wanted))


@needs_gdaldem
@pytest.mark.parametrize("edges", [False, True])
@pytest.mark.parametrize(("value", "operator", "options"), ASKED)
def test_a_dem_has_what_gdaldem_says_at_its_own_cells(tmp_path, value, operator, options, edges):
    """The raster is read as points and triangulated; its holes stay holes.

    A cell among holes that is in no triangle has no surface: it is made a hole of gdaldem's too.
    """
    for seed, shape in enumerate([(23, 31), (2, 9), (40, 3)]):
        path = write_dem(tmp_path / "dem.tif", make_elevations(seed, shape, holes=0.06))
        tin = ts.triangulate(ts.read(path))
        write_dem(path, ts.rasterize(tin, like=path).bands["elevation"])
        wanted = ask_gdaldem(path, *options, *(["-compute_edges"] if edges else []))
        how = {"value": value, "operator": operator, "compute_edges": edges}
        if not np.isfinite(wanted).any():
            with pytest.raises(ts.PointsError, match=f"No cell has a value of {value}"):
                ts.rasterize(tin, like=path, **how)
            continue
        found = ts.rasterize(tin, like=path, **how)
        require_equal(value, found.bands[value], wanted)
        assert "cells and their eight neighbours" in found.notes[-1]


@needs_gdaldem
@pytest.mark.parametrize("operator", ["horn", "zevenbergen-thorne"])
def test_any_light_is_that_of_gdaldem(tmp_path, operator):
    path = write_dem(tmp_path / "dem.tif", make_elevations(5))
    tin = ts.triangulate(ts.read(path))
    light = ["-az", "100", "-alt", "20", "-alg"]
    name = {"horn": "Horn", "zevenbergen-thorne": "ZevenbergenThorne"}[operator]
    wanted = ask_gdaldem(
        path, "hillshade", *light[:-1], *(["-alg", name] if name[0] == "Z" else [])
    )
    options = {"value": "hillshade", "operator": operator, "azimuth": 100, "altitude": 20}
    found = ts.rasterize(tin, like=path, **options).bands["hillshade"]
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    assert np.nanmax(np.abs(found - wanted)) <= 1.0  # of whole numbers


@needs_gdaldem
def test_the_real_dem_has_the_slopes_of_gdaldem(tmp_path):
    path = shutil.copy("sample_data/jacksboro.tif", tmp_path / "dem.tif")
    found = ts.rasterize(
        ts.triangulate(ts.read(path)), like=str(path), value="slope", operator="horn"
    ).bands["slope"]
    wanted = ask_gdaldem(path, "slope")
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    assert np.nanmax(np.abs(found - wanted)) < 2e-3  # whose sums are of 32 bits


@needs_gdaldem
def test_feet_above_metres_are_scaled_as_gdaldem_scales_them(tmp_path):
    path = write_dem(tmp_path / "dem.tif", make_elevations(7))
    tin = ts.triangulate(ts.read(path, elevation_unit="ft"))
    found = ts.rasterize(tin, like=path, value="slope", operator="horn").bands["slope"]
    require_equal("slope", found, ask_gdaldem(path, "slope", "-s", repr(1 / 0.3048)))
    rough = ts.rasterize(tin, like=path, value="roughness")
    require_equal("roughness", rough.bands["roughness"], ask_gdaldem(path, "roughness"))
    assert str(rough.units["roughness"]) == "foot"


# ------------------------------------------------------------------------- closed forms


def triangulate_function(function, *, spacing=2.0, side=9, crs="EPSG:32616", unit=None, at=(0, 0)):
    """Triangulate the cells of a grid, whose middle is at a place, and return both."""
    half = side * spacing / 2
    bounds = ts.Bounds(at[0] - half, at[1] - half, at[0] + half, at[1] + half)
    grid = ts.Grid(bounds, shape=(side, side), spacing=spacing)
    x = bounds.xmin + (np.arange(side) + 0.5) * spacing
    y = bounds.ymax - (np.arange(side) + 0.5) * spacing
    east, north = np.meshgrid(x, y)
    z = function(east - at[0], north - at[1])
    points = np.column_stack([east.ravel(), north.ravel(), z.ravel()])
    return ts.triangulate(points, crs=crs, elevation_unit=unit), grid


@pytest.mark.parametrize("kind", [value.removesuffix("-curvature") for value in CURVATURES])
def test_curvatures_of_a_quadratic_surface_are_the_true_ones(kind):
    """At the middle the derivatives are the coefficients; signs are those of ts.curvature."""
    tin, grid = triangulate_function(
        lambda x, y: 0.5 * x - 0.25 * y + 0.03 * x * x + 0.02 * x * y - 0.05 * y * y
    )
    value = f"{kind}-curvature"
    raster = ts.rasterize(tin, grid=grid, value=value)
    x, y, xx, xy, yy = 0.5, -0.25, 0.06, 0.02, -0.1
    p, q = x * x + y * y, 1 + x * x + y * y
    along, across = (
        xx * x * x + 2 * xy * x * y + yy * y * y,
        xx * y * y - 2 * xy * x * y + yy * x * x,
    )
    wanted = {
        "profile": -along / (p * q**1.5),
        "plan": -across / p**1.5,
        "tangential": -across / (p * q**0.5),
        "mean": -((1 + y * y) * xx - 2 * x * y * xy + (1 + x * x) * yy) / (2 * q**1.5),
        "gaussian": (xx * yy - xy * xy) / q**2,
    }[kind]
    assert raster.bands[value][4, 4] == pytest.approx(wanted, abs=1e-12)
    assert str(raster.units[value]) == ("1/m²" if kind == "gaussian" else "1/m")
    vertex = np.flatnonzero((tin.points[:, :2] == 0).all(axis=1))[0]
    assert ts.curvature(tin, kind=kind)[vertex] == pytest.approx(wanted, abs=1e-9)


def test_curvatures_of_a_sphere_are_those_of_its_radius():
    tin, grid = triangulate_function(lambda x, y: np.sqrt(100.0**2 - x * x - y * y), spacing=0.05)
    for value in ("profile-curvature", "tangential-curvature", "mean-curvature"):
        inner = ts.rasterize(tin, grid=grid, value=value).bands[value][1:-1, 1:-1]
        # Nothing falls at the top itself.
        np.testing.assert_allclose(inner[np.isfinite(inner)], 1 / 100.0, rtol=1e-4)


def test_curvature_along_and_across_a_level_place_has_no_direction():
    tin, grid = triangulate_function(lambda x, y: 0 * x)
    for value in ("profile-curvature", "plan-curvature", "tangential-curvature"):
        assert np.isnan(ts.rasterize(tin, grid=grid, value=value).bands[value]).all()
    assert ts.rasterize(tin, grid=grid, value="mean-curvature").bands["mean-curvature"][4, 4] == 0


@pytest.mark.parametrize("operator", ["horn", "zevenbergen-thorne"])
def test_degrees_count_as_their_length_in_each_row(operator):
    """A rise of 1 m a metre to the east and to the north, at 60 degrees north."""
    parallel, meridian = 55_800.0, 111_412.0  # metres of a degree
    tin, grid = triangulate_function(
        lambda x, y: x * parallel + y * meridian,
        spacing=1e-4,
        crs="EPSG:4326",
        unit="m",
        at=(10.0, 60.0),
    )
    for value, wanted in (("slope", np.degrees(np.arctan(np.sqrt(2)))), ("aspect", 225.0)):
        found = ts.rasterize(tin, grid=grid, value=value, operator=operator).bands[value]
        assert found[4, 4] == pytest.approx(wanted, abs=0.02)
    curved, grid = triangulate_function(
        lambda x, y: ((x * parallel) ** 2 + (y * meridian) ** 2) / 200,
        spacing=1e-4,
        crs="EPSG:4326",
        unit="m",
        at=(10.0, 60.0),
    )
    mean = ts.rasterize(curved, grid=grid, value="mean-curvature").bands["mean-curvature"]
    assert mean[4, 4] == pytest.approx(-1 / 100, rel=1e-3)


def test_aspect_is_clockwise_from_north_where_coordinates_grow_to_the_south_west():
    """Lo19: westings and southings. As ts.aspect, whose cells are turned already."""
    tin, grid = triangulate_function(lambda x, y: x + 0 * y, crs="EPSG:2048", at=(0, 3_000_000))
    exact = ts.rasterize(tin, grid=grid, value="aspect").bands["aspect"][4, 4]
    found = ts.rasterize(tin, grid=grid, value="aspect", operator="horn").bands["aspect"][4, 4]
    assert found == exact == 90.0


def test_cells_of_other_surfaces_have_operators_of_their_elevations(tmp_path):
    """The elevations at centres, by any method, or means: then those of their neighbours."""
    rng = np.random.default_rng(4)
    points = rng.random((200, 3)) * [30, 30, 9]
    tin = ts.triangulate(points)
    for how in ({}, {"method": "natural"}, {"at": "mean"}):
        z = ts.rasterize(tin, spacing=1.5, **how).bands["elevation"].tolist()
        for value, operator in (("aspect", "horn"), ("tri", "wilson"), ("plan-curvature", None)):
            made = ts.rasterize(tin, spacing=1.5, value=value, operator=operator, **how)
            for row, column in rng.integers(0, 20, (60, 2)).tolist():
                window = find_window(z, row, column, edges=False)
                wanted = np.nan if window is None else measure(window, value, operator, 1.5, 1.5, 1)
                assert made.bands[value][row, column] == pytest.approx(wanted, nan_ok=True)


# -------------------------------------------------------------------- blocks and refusals


@pytest.mark.parametrize("edges", [False, True])
@pytest.mark.parametrize(("value", "operator"), [one[:2] for one in ASKED[::2]])
def test_blocks_are_those_of_the_whole(tmp_path, value, operator, edges, monkeypatch):
    path = write_dem(tmp_path / "dem.tif", make_elevations(11, (13, 17)))
    tin = ts.triangulate(ts.read(path))
    options = {"like": path, "value": value, "operator": operator, "compute_edges": edges}
    monkeypatch.setattr("tinsmith.terrain.gridding.operators._BLOCK_CELLS", 40)
    told = []
    whole = ts.rasterize(tin, progress=told.append, **options).bands[value]
    assert told == sorted(told)
    assert told[-1] == 1.0
    lazy = ts.rasterize(tin, lazy=True, **options).bands[value]
    rng = np.random.default_rng(2)
    for _ in range(40):
        top, bottom = np.sort(rng.integers(0, 14, 2))
        left, right = np.sort(rng.integers(0, 18, 2))
        block = lazy[top:bottom, left:right]
        np.testing.assert_array_equal(block, whole[top:bottom, left:right])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"operator": "horn"}, "Invalid operator 'horn': it must be None for elevation"),
        ({"value": "slope", "operator": "sobel"}, "Invalid operator 'sobel'"),
        ({"value": "slope", "operator": "riley"}, "horn or zevenbergen-thorne for slope"),
        ({"value": "tri", "operator": "horn"}, "riley or wilson for tri"),
        ({"value": "tpi", "operator": "horn"}, "None for tpi"),
        ({"value": "plan-curvature", "operator": "horn"}, "zevenbergen-thorne for plan-curvature"),
        ({"value": "slope", "compute_edges": True}, "False for slope without an operator"),
        ({"compute_edges": True}, "False for elevation without an operator"),
        ({"value": "tpi", "compute_edges": 1}, "True or False"),
        ({"value": "tpi", "smooth": True}, "None for values of cells"),
        ({"value": "curvature"}, "Invalid value 'curvature'"),
    ],
)
def test_options_that_do_not_go_together_are_refused(options, said):
    tin = ts.triangulate([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5]])
    with pytest.raises(ts.OptionError) as refused:
        ts.rasterize(tin, spacing=1, **options)
    assert said in str(refused.value)


def test_a_raster_of_which_no_cell_has_all_neighbors_is_refused():
    tin = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 2, 5], [0, 2, 5]])
    with pytest.raises(ts.PointsError, match="an elevation and eight neighbours with one: the"):
        ts.rasterize(tin, spacing=1, value="roughness")
    edges = ts.rasterize(tin, spacing=1, value="roughness", compute_edges=True)
    np.testing.assert_array_equal(edges.bands["roughness"], 0.0)
    with pytest.raises(ts.PointsError, match="1 row"):
        ts.rasterize(tin, spacing=2, value="roughness", compute_edges=True, lazy=True)


@pytest.mark.parametrize(
    ("value", "operator"), [one[:2] for one in ASKED] + [(CURVATURES[0], None)]
)
def test_elevations_that_overflow_are_refused(value, operator):
    points = [[0, 0, 1e160], [40, 0, -1e160], [40, 40, 1e160], [0, 40, -1e160]]
    tin = ts.triangulate(points)
    with pytest.raises(ts.PointsError, match="overflow"):
        ts.rasterize(tin, spacing=4, value=value, operator=operator)
