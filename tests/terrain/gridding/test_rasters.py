"""Rasters of a surface: against interpolation, clipping by shapely, and closed forms."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from support import oracles
from support.clipping import covered_area
from support.point_sets import places
from support.relief_oracle import GradientAt

import tinsmith as ts
from tinsmith.base.errors import CrsError, OptionError, PointsError, ReadError
from tinsmith.terrain.gridding import bands, grids

UTM = (500_000.0, 4_000_000.0)


def rng(seed=0):
    return np.random.default_rng(seed)


def uniform(n, seed=0, size=100.0):
    return rng(seed).random((n, 3)) * [size, size, 10.0] + [*UTM, 100.0]


def centers_of(grid):
    rows, columns = grid.shape
    x = grid.bounds.xmin + (np.arange(columns) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (np.arange(rows) + 0.5) * grid.spacing
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def elevations(raster):
    return raster.bands["elevation"]


def with_a_hole():
    outer = np.array([(0, 0), (30, 2), (28, 30), (-1, 27)], float)
    points = np.column_stack([rng(1).random((80, 2)) * 30, rng(2).random(80)])
    return ts.triangulate(points, boundary=outer, holes=[outer / 3 + 8])


SURFACES = {
    "uniform": lambda: ts.triangulate(uniform(500)),
    "with a hole": with_a_hole,
    "raster": lambda: ts.triangulate(grid_points(12)),
    "one triangle": lambda: ts.triangulate([[0, 0, 1], [90, 10, 5], [20, 70, 9]]),
    "needles": lambda: ts.triangulate(uniform(200) * [1, 1e-3, 1]),
}


def grid_points(n):
    x, y = np.meshgrid(np.arange(float(n)), np.arange(float(n)))
    return np.column_stack([x.ravel(), y.ravel(), rng(0).random(n * n)])


# ---------------------------------------------------------------- centres


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("cells", [3, 60, 700])
@pytest.mark.parametrize("threads", [1, 3])
def test_centres_have_the_interpolated_elevation_to_the_last_bit(surface, cells, threads):
    tin = SURFACES[surface]()
    spacing = tin.bounds.diagonal / cells
    if surface == "needles" and cells < 700:
        with pytest.raises(PointsError, match="No centre of a cell lies on the surface"):
            ts.rasterize(tin, spacing=spacing, threads=threads)
        return
    raster = ts.rasterize(tin, spacing=spacing, threads=threads)
    wanted = tin.interpolate(centers_of(raster.grid)).reshape(raster.shape)
    np.testing.assert_array_equal(elevations(raster), wanted)
    assert np.isfinite(wanted).any()


@settings(max_examples=20, deadline=None)
@given(
    places(st.integers(0, 6), 16),
    st.sampled_from([0.25, 0.5, 1.0, 2.0]),
    st.booleans(),
)
def test_centres_on_edges_and_vertices_belong_to_the_located_triangle(sites, spacing, is_shifted):
    if oracles.are_collinear(sites):
        return
    points = np.column_stack([np.array(sites, float), np.arange(len(sites)) ** 2])
    if is_shifted:  # vertices are centres
        points[:, :2] += spacing / 2
    tin = ts.triangulate(points)
    xy = centers_of(grids.cover(tin.bounds, spacing))
    if (tin.locate(xy) < 0).all():
        with pytest.raises(PointsError, match="No centre of a cell lies on the surface"):
            ts.rasterize(tin, spacing=spacing)
        return
    raster = ts.rasterize(tin, spacing=spacing)
    np.testing.assert_array_equal(elevations(raster).ravel(), tin.interpolate(xy))
    gradient_at = GradientAt(tin.points, tin.triangles)
    found = ts.rasterize(tin, spacing=spacing, value="slope").bands["slope"].ravel()
    np.testing.assert_allclose(found, [gradient_at.slope(*place) for place in xy], atol=1e-9)
    found = ts.rasterize(tin, spacing=spacing, value="aspect").bands["aspect"].ravel()
    wanted = np.array([gradient_at.aspect(*place) for place in xy])
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    off = np.abs(found - wanted)
    assert np.nanmax(np.minimum(off, 360 - off), initial=0.0) < 1e-9


def test_a_surface_whose_parts_meet_without_being_neighbours():
    """A vertex in the middle of a long edge: the smallest triangle has the centres there."""
    points = [[0, 0, 0], [4, 0, 8], [2, 3, 1], [0, -3, 5], [4, -3, 6], [2, 0, 1]]
    tin = ts.TIN.from_triangles(points, [[3, 5, 0], [4, 1, 5], [3, 4, 5], [0, 1, 2]])
    grid = ts.Grid(ts.Bounds(-0.5, -3.5, 4.5, 3.5), shape=(7, 5), spacing=1.0)
    for triangles in (tin.triangles, tin.triangles[::-1]):
        again = ts.TIN.from_triangles(points, triangles)
        found = elevations(ts.rasterize(again, grid=grid))
        np.testing.assert_array_equal(found.ravel(), again.interpolate(centers_of(grid)))


@pytest.mark.parametrize("method", ["nearest", "laplace", "natural", "c1"])
def test_other_methods_are_those_of_interpolation(method, monkeypatch):
    monkeypatch.setattr(bands, "_STRIP", 100)
    tin = ts.triangulate(uniform(100))
    raster = ts.rasterize(tin, spacing=2.5, method=method)
    wanted = tin.interpolate(centers_of(raster.grid), method=method)
    np.testing.assert_array_equal(elevations(raster).ravel(), wanted)


@pytest.mark.parametrize("value", ["slope", "aspect", "hillshade"])
def test_values_are_those_of_the_located_triangles(value):
    tin = ts.triangulate(uniform(300))
    raster = ts.rasterize(tin, spacing=1.0, value=value)
    triangles = tin.locate(centers_of(raster.grid))
    found = raster.bands[value].ravel()
    assert np.isnan(found[triangles < 0]).all()
    inside = triangles >= 0
    if value == "hillshade":
        turn, rise = np.radians([315.0, 45.0])
        light = [np.sin(turn) * np.cos(rise), np.cos(turn) * np.cos(rise), np.sin(rise)]
        wanted = 1 + 254 * np.maximum(tin.triangle_normals @ light, 0)
        np.testing.assert_array_equal(found[inside], np.rint(wanted[triangles[inside]]))
        shade = ts.hillshade(tin, spacing=1.0).bands["hillshade"].ravel()
        np.testing.assert_array_equal(np.nan_to_num(found), shade)
    else:
        each = {"slope": ts.slope, "aspect": ts.aspect}[value](tin)
        np.testing.assert_array_equal(found[inside], each[triangles[inside]])


def test_a_level_surface_lit_from_above_is_bright():
    tin = ts.triangulate([[0, 0, 5], [9, 0, 5], [0, 9, 5]])
    raster = ts.rasterize(tin, spacing=3, value="hillshade", altitude=90)
    np.testing.assert_allclose(raster.bands["hillshade"][2], 255)


# ---------------------------------------------------------------- means


@pytest.mark.parametrize("surface", ["uniform", "with a hole", "one triangle", "raster"])
def test_means_are_the_integrals_over_the_parts_of_cells(surface):
    tin = SURFACES[surface]()
    raster = ts.rasterize(tin, spacing=tin.bounds.diagonal / 13, at="mean")
    found, spacing, b = elevations(raster), raster.grid.spacing, raster.grid.bounds
    corners = tin.points[tin.triangles]
    triangles = shapely.polygons(corners[:, :, :2])
    for row in range(raster.shape[0]):
        for column in range(raster.shape[1]):
            west, north = b.xmin + column * spacing, b.ymax - row * spacing
            cell = shapely.box(west, north - spacing, west + spacing, north)
            parts = shapely.intersection(triangles, cell)
            areas = shapely.area(parts)
            if areas.sum() < 1e-9 * spacing**2:
                continue
            met = np.flatnonzero(areas > 0)
            middles = shapely.get_coordinates(shapely.centroid(parts[met]))
            z = [plane_at(corners[t], middle) for t, middle in zip(met, middles, strict=True)]
            wanted = np.average(z, weights=areas[met])
            assert found[row, column] == pytest.approx(wanted, abs=1e-7)


def plane_at(corners, place):
    """The elevation of a triangle's plane."""
    shifted = corners - corners[0]
    gradient = np.linalg.solve(shifted[1:, :2], shifted[1:, 2])
    return corners[0, 2] + gradient @ (place - corners[0, :2])


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_a_cell_that_is_touched_in_a_point_has_no_mean(mirror):
    """Rounding left it a value in one of two mirror images."""
    points = np.array([[54.0, 40, 1], [32, 17, 7], [19, 2, 5], [4, 1, 8]]) * [mirror, 1, 1]
    tin = ts.triangulate(points)
    raster = ts.rasterize(tin, spacing=0.5, at="mean")
    found, bounds = elevations(raster), raster.grid.bounds
    corners = tin.points[tin.triangles, :2]
    x, y = centers_of(raster.grid).T
    areas = [
        covered_area(corners, (east - 0.25, north - 0.25, east + 0.25, north + 0.25))
        for east, north in zip(x.tolist(), y.tolist(), strict=True)
    ]
    np.testing.assert_array_equal(np.isnan(found).ravel(), [area == 0 for area in areas])
    assert bounds.xmin == points[:, 0].min()


def test_a_cell_that_is_hardly_covered_has_a_mean_of_the_surface():
    tin = ts.triangulate([[0, 0, 10], [1 + 1e-12, 0.5, 20], [0, 1, 10]])
    found = elevations(ts.rasterize(tin, spacing=1.0, at="mean"))
    assert found.shape == (1, 2)
    assert found[0, 1] == pytest.approx(20, abs=1e-6)


def test_means_add_up_to_the_volume():
    tin = with_a_hole()
    raster = ts.rasterize(tin, spacing=0.5, at="mean")
    area = (~np.isnan(elevations(raster))).sum() * 0.25
    assert area > tin.area  # cells on the boundary are covered in part
    grid = ts.Grid(ts.Bounds(-2, -2, 34, 34), shape=(1, 1), spacing=36.0)
    mean = elevations(ts.rasterize(tin, grid=grid, at="mean"))[0, 0]
    volume = (tin.triangle_areas * tin.points[tin.triangles, 2].mean(axis=1)).sum()
    assert mean * tin.area == pytest.approx(volume, rel=1e-12)


def test_means_of_planes_and_slopes():
    points = uniform(200)
    points[:, 2] = points[:, 0] - UTM[0] + 2 * (points[:, 1] - UTM[1])
    tin = ts.triangulate(points)
    grid = ts.Grid(ts.Bounds(500_020, 4_000_020, 500_080, 4_000_080), shape=(60, 60), spacing=1.0)
    centre, mean = (elevations(ts.rasterize(tin, grid=grid, at=at)) for at in ("center", "mean"))
    np.testing.assert_allclose(mean, centre, atol=1e-7)
    slopes = ts.rasterize(tin, grid=grid, value="slope", at="mean").bands["slope"]
    np.testing.assert_allclose(slopes, np.degrees(np.arctan(np.sqrt(5))), atol=1e-6)


@pytest.mark.parametrize("at", ["center", "mean"])
def test_any_number_of_threads_and_any_blocks_give_the_same_bits(at):
    tin = ts.triangulate(uniform(3000))
    whole = elevations(ts.rasterize(tin, spacing=0.15, at=at, threads=1))
    again = ts.rasterize(tin, spacing=0.15, at=at, threads=4, lazy=True).bands["elevation"]
    np.testing.assert_array_equal(again[:, :], whole)
    for rows, columns in (
        (slice(13, 300), slice(55, 601)),
        (slice(256, 257), slice(0, 1)),
        (slice(3, 20), slice(250, 300)),
    ):
        np.testing.assert_array_equal(again[rows, columns], whole[rows, columns])
    assert again[5:5, :].shape == (0, whole.shape[1])


# ---------------------------------------------------------------- grids


def test_cells_are_aligned_to_multiples_of_the_spacing():
    tin = ts.triangulate([[1.2, -0.3, 0], [7.9, 0.1, 1], [2.0, 6.1, 2]])
    grid = ts.rasterize(tin, spacing=2).grid
    assert grid == ts.Grid(ts.Bounds(0.0, -2.0, 8.0, 8.0), shape=(5, 4), spacing=2.0)


def test_the_cells_of_another_raster(tmp_path):
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616")
    grid = ts.Grid(ts.Bounds(500_010, 4_000_010, 500_030, 4_000_025), shape=(30, 40), spacing=0.5)
    first = ts.rasterize(tin, grid=grid)
    again = ts.rasterize(tin, like=first)
    assert again.grid == grid
    np.testing.assert_array_equal(elevations(first), elevations(again))


def write_raster(path, transform, crs="EPSG:32616", shape=(4, 5)):
    rasterio = pytest.importorskip("rasterio")
    profile = {"width": shape[1], "height": shape[0], "count": 1, "dtype": "float32"}
    with rasterio.open(
        path, "w", driver="GTiff", crs=crs, transform=rasterio.Affine(*transform), **profile
    ) as file:
        file.write(np.zeros(shape, np.float32), 1)


def test_the_cells_of_a_raster_file(tmp_path):
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616")
    path = tmp_path / "other.tif"
    write_raster(path, (2.0, 0, 500_010, 0, -2.0, 4_000_050))
    grid = ts.rasterize(tin, like=path).grid
    assert grid == ts.Grid(
        ts.Bounds(500_010, 4_000_042, 500_020, 4_000_050), shape=(4, 5), spacing=2.0
    )


@pytest.mark.parametrize(
    ("transform", "crs", "error", "sentence"),
    [
        ((2.0, 4.0, 5.0, 1.0, 2.0, 0), "EPSG:32616", ReadError, "a cell has no size"),
        ((2.0, 0, 0, 0, -2.0, 0), "EPSG:32617", CrsError, "they must be the same"),
    ],
)
def test_files_whose_cells_cannot_be_taken(tmp_path, transform, crs, error, sentence):
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616")
    path = tmp_path / "other.tif"
    write_raster(path, transform, crs)
    with pytest.raises(error, match=sentence):
        ts.rasterize(tin, like=path)


def test_what_is_no_raster_file(tmp_path):
    path = tmp_path / "text.tif"
    path.write_text("no raster")
    with pytest.raises(ReadError, match=r"text\.tif"):
        ts.rasterize(ts.triangulate(uniform(9)), like=path)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({}, "one of spacing, like and grid"),
        ({"spacing": 1, "like": "x.tif"}, "one of spacing, like and grid"),
        ({"spacing": 0}, "Invalid spacing 0: it must be a length > 0"),
        ({"spacing": -2.0}, "Invalid spacing -2.0"),
        ({"spacing": float("nan")}, "Invalid spacing nan"),
        ({"spacing": float("inf")}, "Invalid spacing inf"),
        ({"spacing": "wide"}, "Invalid spacing 'wide'"),
        (
            {"spacing": 1e-4},
            "number of cells 8.* at most 2,147,483,648, not 8.* rows by 9.* columns",
        ),
        ({"spacing": 1e-4, "lazy": True}, "number of cells .* at most 100,000,000,000"),
        ({"spacing": 1e-12}, "Invalid spacing 1e-12: it must be at least"),
        ({"spacing": 1e-300}, "Invalid spacing 1e-300: it must be at least"),
        ({"spacing": 1, "method": "cubic"}, "Invalid method 'cubic'"),
        ({"spacing": 1, "value": "height"}, "Invalid value 'height'"),
        ({"spacing": 1, "at": "corner"}, "Invalid at 'corner'"),
        ({"spacing": 1, "at": "mean", "method": "natural"}, "center for method natural"),
        ({"spacing": 1, "at": "mean", "value": "aspect"}, "directions have no mean"),
        ({"spacing": 1, "value": "slope", "method": "c1"}, "linear for slope"),
        ({"spacing": 1, "value": "hillshade", "altitude": 91}, "Invalid altitude 91"),
        ({"spacing": 1, "threads": 0}, "Invalid threads 0"),
        ({"spacing": 1, "lazy": 1}, "Invalid lazy 1"),
        ({"grid": (3, 4)}, "a Grid"),
        ({"like": 3}, "or the path of a raster file"),
    ],
)
def test_wrong_options_are_refused(options, sentence):
    tin = ts.triangulate(uniform(20))
    with pytest.raises(OptionError, match=sentence):
        ts.rasterize(tin, **options)


# ---------------------------------------------------------------- cells of others

REFERENCES = {
    "VRT": """<VRTDataset rasterXSize="5" rasterYSize="4"><SRS>EPSG:32616</SRS>
        <GeoTransform>500010, 2, 0, 4000050, 0, -2</GeoTransform>
        <VRTRasterBand dataType="Float32" band="1"><SimpleSource>
        <SourceFilename>{source}</SourceFilename><SourceBand>1</SourceBand>
        </SimpleSource></VRTRasterBand></VRTDataset>""",
    "WMS": """<GDAL_WMS><Service name="WMS"><ServerUrl>http://127.0.0.1:9/?</ServerUrl>
        <Layers>a</Layers></Service><DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>9</UpperLeftY>
        <LowerRightX>9</LowerRightX><LowerRightY>0</LowerRightY><SizeX>9</SizeX><SizeY>9</SizeY>
        </DataWindow></GDAL_WMS>""",
}


@pytest.mark.parametrize("kind", REFERENCES)
def test_a_file_that_refers_to_others_is_refused_as_cells(tmp_path, kind):
    source, path = tmp_path / "secret.tif", tmp_path / "other.tif"
    write_raster(source, (2.0, 0, 500_010, 0, -2.0, 4_000_050))
    path.write_text(REFERENCES[kind].format(source=source))
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616")
    with pytest.raises(ReadError, match=r"other\.tif"):
        ts.rasterize(tin, like=path)


def test_urls_and_virtual_paths_are_no_files():
    tin = ts.triangulate(uniform(9)).replace(crs="EPSG:32616")
    for path in ("/vsicurl/http://127.0.0.1:9/a.tif", "http://127.0.0.1:9/a.tif", "WMS:http://a"):
        with pytest.raises(ReadError):
            ts.rasterize(tin, like=path)


def test_terrain_itself_opens_no_file(tmp_path):
    path = tmp_path / "other.tif"
    write_raster(path, (2.0, 0, 500_010, 0, -2.0, 4_000_050))
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616")
    with pytest.raises(OptionError, match="Invalid like"):
        ts.terrain.rasterize(tin, like=str(path))


def test_cells_of_data_sets_of_rasterio_and_xarray(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    tin = ts.triangulate(uniform(100)).replace(crs="EPSG:32616", elevation_unit="m")
    path = tmp_path / "other.tif"
    write_raster(path, (2.0, 0, 500_010, 0, -2.0, 4_000_050))
    of_file = ts.rasterize(tin, like=path)
    with rasterio.open(path) as opened:
        assert ts.rasterize(tin, like=opened).grid == of_file.grid
    found = ts.rasterize(tin, like=of_file.to_xarray())
    assert found.grid == of_file.grid
    assert found.notes == tin.notes
    turned = of_file.to_xarray().isel(x=[0, 1, 3])
    with pytest.raises(OptionError, match="even steps"):
        ts.rasterize(tin, like=turned)


@pytest.mark.parametrize("value", ["elevation", "hillshade", "aspect"])
@pytest.mark.parametrize("is_lazy", [False, True])
def test_cells_beside_the_surface_are_refused_with_both_extents(value, is_lazy):
    tin = ts.triangulate(grid_points(5))
    grid = ts.Grid(ts.Bounds(100, 100, 102, 102), shape=(2, 2), spacing=1.0)
    with pytest.raises(PointsError, match=r"100 to 102 east.*0 to 4 east"):
        ts.rasterize(tin, grid=grid, value=value, lazy=is_lazy)
    with pytest.raises(PointsError, match=r"100 to 102 east.*0 to 4 east"):
        ts.hillshade(tin, grid=grid)


def test_cells_in_a_hole_or_past_a_corner_are_refused():
    tin = ts.triangulate(grid_points(9), holes=[[[2, 2], [6, 2], [6, 6], [2, 6]]])
    inside = ts.Grid(ts.Bounds(3, 3, 5, 5), shape=(2, 2), spacing=1.0)
    with pytest.raises(PointsError, match="No centre of a cell lies on the surface"):
        ts.rasterize(tin, grid=inside, lazy=True)
    with pytest.raises(PointsError, match="No part of a cell lies on the surface"):
        ts.rasterize(tin, grid=inside, at="mean")
    touching = ts.Grid(ts.Bounds(1.5, 3, 2.5, 4), shape=(1, 1), spacing=1.0)
    assert np.isfinite(ts.rasterize(tin, grid=touching, at="mean").bands["elevation"]).all()
    level = ts.triangulate([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5]])
    assert np.isnan(ts.rasterize(level, spacing=1, value="aspect").bands["aspect"]).all()


def test_cells_whose_crs_is_not_known_are_told_and_of_an_unknown_surface_refused():
    tin = ts.triangulate(grid_points(5)).replace(elevation_unit="m")
    named = tin.replace(crs="EPSG:32616")
    plain = ts.rasterize(tin, spacing=1)
    (note,) = ts.rasterize(named, like=plain).notes
    assert (
        note == "The CRS of the other raster is not known: taken to be that of the surface, "
        "EPSG:32616."
    )
    with pytest.raises(CrsError, match="EPSG:32616 and that of the surface is not known"):
        ts.rasterize(tin, like=ts.rasterize(named, spacing=1))


def test_rasters_know_unit_and_crs():
    tin = ts.triangulate(uniform(20)).replace(crs="EPSG:32616", elevation_unit="ft")
    raster = ts.rasterize(tin, spacing=10)
    assert str(raster.crs) == "EPSG:32616"
    assert raster.units["elevation"] == tin.elevation_unit
    assert ts.rasterize(tin, spacing=10, value="slope").units["slope"] == "°"


def test_edits_do_not_reach_a_lazy_raster():
    tin = ts.triangulate(grid_points(5))
    raster = ts.rasterize(tin, spacing=1, lazy=True)
    before = raster.bands["elevation"][:, :]
    tin.insert([[2.5, 2.5, 99.0]])
    np.testing.assert_array_equal(raster.bands["elevation"][:, :], before)
    assert np.nanmax(elevations(ts.rasterize(tin, spacing=1))) == 99.0


def test_the_far_edge_of_a_grid_is_its_cells_away():
    for spacing in (0.1, 0.3, 1 / 3, 7e-3):
        grid = grids.cover(ts.triangulate(uniform(20)).bounds, spacing)
        tin = ts.triangulate(uniform(20))
        assert grid.bounds.xmin <= tin.bounds.xmin
        assert grid.bounds.xmax >= tin.bounds.xmax
        ts.rasterize(tin, grid=grid, lazy=True)


@pytest.mark.parametrize("value", ["slope", "aspect", "hillshade"])
@pytest.mark.parametrize("smooth", [False, True])
def test_centres_on_vertices_and_edges_do_not_depend_on_the_order_of_triangles(value, smooth):
    """To the last bit: an arbitrary triangle of each vertex was taken."""
    side = np.arange(9.0)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    even = ts.triangulate(np.column_stack([x, y, np.zeros(81)]))
    order = rng(4).permutation(len(even.triangles))
    steep = even.points + np.column_stack([np.zeros((81, 2)), rng(5).integers(0, 9, 81)])
    grids_asked = [
        ts.Grid(ts.Bounds(-0.5, -0.5, 8.5, 8.5), shape=(9, 9), spacing=1.0),
        ts.Grid(ts.Bounds(0.0, 0.0, 8.0, 8.0), shape=(16, 16), spacing=0.5),
    ]
    turned = np.roll(even.triangles[order], 1, axis=1)
    tins = [ts.TIN.from_triangles(steep, one) for one in (even.triangles, turned)]
    for grid in grids_asked:
        one, other = (
            ts.rasterize(tin, grid=grid, value=value, smooth=smooth).bands[value] for tin in tins
        )
        np.testing.assert_array_equal(one, other)


def test_a_vertex_in_the_middle_of_an_edge_is_the_vertex():
    points = [[0, 0, 0], [4, 0, 8], [2, 3, 1], [0, -3, 5], [4, -3, 6], [2, 0, 1]]
    triangles = [[0, 1, 2], [3, 5, 0], [4, 1, 5], [3, 4, 5]]
    grid = ts.Grid(ts.Bounds(1.5, -0.5, 2.5, 0.5), shape=(1, 1), spacing=1.0)
    for order in (triangles, triangles[::-1]):
        tin = ts.TIN.from_triangles(points, order)
        found = ts.rasterize(tin, grid=grid, value="slope").bands["slope"]
        assert found[0, 0] == ts.slope(tin, per="vertex")[5]


def test_a_lazy_raster_can_be_copied_to_another_process():
    tin = ts.triangulate([[0, 0, 1], [4, 0, 5], [0, 4, 9]])
    raster = ts.rasterize(tin, spacing=1, lazy=True)
    band = raster.bands["elevation"]
    before = band[0:4, 0:4]
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(band))[0:4, 0:4], before)
