"""Rasters in blocks, each from the triangles that meet it: those of the whole surface."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, TURNS, Tiling, divide_at_points, find_tilings
from support.product_parts import join_raster, make_grid, require_same_bits
from support.tiled import divide

import tinsmith as ts
from tinsmith.terrain.parts import rasters
from tinsmith.terrain.surface import Light
from tinsmith.tin.tiling.boxes import widen
from tinsmith.tin.tiling.local_triangulation import triangulate_box

VALUES = ["elevation", "slope", "aspect", "hillshade"]


def make_grid_of_points(points):
    """Return a grid with centres at the points of a lattice, and half way between."""
    side = float(np.diff(np.unique(points[:, 0])[:2])[0]) / 2
    bounds = ts.Bounds.of(points)
    rows, columns = (round(n / side) + 3 for n in (bounds.height, bounds.width))
    west, north = bounds.xmin - 1.5 * side, bounds.ymax + 1.5 * side
    around = ts.Bounds(west, north - rows * side, west + columns * side, north)
    return ts.Grid(around, (rows, columns), side)


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("turn", TURNS)
def test_blocks_are_those_of_the_whole(name, turn):
    points = CLOUDS[name]
    grids = [make_grid(points, 61)]
    if name.startswith("lattice"):
        grids.append(make_grid_of_points(points))
    tin = ts.triangulate(points)
    for tiling in find_tilings(name, turn):
        for grid in grids:
            for value in VALUES:
                for is_smooth in (False, True) if value != "elevation" else (None,):
                    whole = ts.rasterize(
                        tin, grid=grid, value=value, smooth=is_smooth, azimuth=200.0, altitude=30.0
                    )
                    options = rasters.RasterOptions(
                        grid, value, bool(is_smooth), light=Light(200.0, 30.0)
                    )
                    require_same_bits(join_raster(tiling, options), whole.bands[value])


class Reaches:
    """Parts of the box that each tile's cells need."""

    def __init__(self, source, options):
        self.blocks = []
        for key in source.list_cells():
            rows, columns = rasters.find_cells(options.grid, source.box_of(key))
            if rows.stop > rows.start:
                reach = rasters.find_reach(options, rows, columns)
                part = triangulate_box(source, reach, around=widen(reach, 5.0))
                self.blocks.append(rasters.compute_block(part, rows, columns, options))


@pytest.mark.each_value
@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("value", ["elevation", "slope"])
def test_means_of_cells_are_those_of_the_whole(name, value):
    """With several squares of cells that are computed together, whose sides no tile keeps to."""
    points = CLOUDS[name]
    tin = ts.triangulate(points)
    for cells, sides in ((300, (1, 4)), (40, (2, 8))):
        grid = make_grid(points, cells)
        whole = ts.rasterize(tin, grid=grid, value=value, at="mean").bands[value]
        options = rasters.RasterOptions(grid, value, at="mean")
        for side in sides:
            found = rasters.join(Reaches(divide(points, side), options).blocks, options)
            require_same_bits(found, whole)


def test_means_do_not_depend_on_how_points_are_numbered():
    points = CLOUDS["levels at vertices"]
    grid = make_grid(points, 70)
    order = np.random.default_rng(3).permutation(len(points))
    one, other = (
        ts.rasterize(ts.triangulate(some), grid=grid, at="mean").bands["elevation"]
        for some in (points, points[order])
    )
    require_same_bits(one, other)


def test_slopes_above_longitude_and_latitude_are_those_of_the_whole():
    points = CLOUDS["uniform"] * (1e-4, 1e-4, 1.0) + (9.0, 47.0, 0.0)
    tin = ts.triangulate(points, crs="EPSG:4326", elevation_unit="metre")
    grid = make_grid(points, 40)
    whole = ts.rasterize(tin, grid=grid, value="slope", smooth=True).bands["slope"]
    options = rasters.RasterOptions(
        grid, "slope", is_smooth=True, crs=tin.crs, elevation_unit=tin.elevation_unit
    )
    require_same_bits(join_raster(Tiling(divide(points, 4)), options), whole)


def test_any_block_of_cells_can_be_asked_for():
    points = CLOUDS["uniform"]
    grid = make_grid(points, 50)
    whole = ts.rasterize(ts.triangulate(points), grid=grid).bands["elevation"]
    source = divide_at_points(points, 4)
    options = rasters.RasterOptions(grid)
    for rows, columns in ((slice(3, 17), slice(20, 41)), (slice(30, 31), slice(5, 6))):
        reach = rasters.find_reach(options, rows, columns)
        part = triangulate_box(source, reach, around=widen(reach, 10.0))
        block = rasters.compute_block(part, rows, columns, options)
        require_same_bits(block.values, whole[rows, columns])


def test_elevations_need_no_triangles_around_those_of_the_cells():
    points = CLOUDS["levels at vertices"]
    options = rasters.RasterOptions(make_grid(points, 50))
    assert rasters.count_rings(options) == 0
    assert rasters.count_rings(options._replace(value="slope")) == 0
    assert rasters.count_rings(options._replace(value="slope", is_smooth=True)) == 1
    for value in VALUES:
        whole = ts.rasterize(ts.triangulate(points), grid=options.grid, value=value)
        tiling = Tiling(divide(points, 4), rings=0)
        require_same_bits(join_raster(tiling, options._replace(value=value)), whole.bands[value])


@pytest.mark.parametrize("seed", range(5))
def test_each_cell_is_in_one_box_of_those_that_tile_the_plane(seed):
    rng = np.random.default_rng(seed)
    spacing = float(rng.choice([0.1, 0.3, 1.0, 7.0]))
    west, south = rng.integers(-(10**6), 10**6, 2) * spacing
    shape = (23, 31)
    around = ts.Bounds(west, south, west + 31 * spacing, south + 23 * spacing)
    grid = ts.Grid(around, shape, spacing)
    x = around.xmin + (np.arange(31) + 0.5) * spacing
    y = around.ymax - (np.arange(23) + 0.5) * spacing
    xs = np.sort(np.concatenate([rng.choice(x, 4), x[:1] + rng.random(4) * 30 * spacing]))
    ys = np.sort(np.concatenate([rng.choice(y, 4), y[-1:] + rng.random(4) * 22 * spacing]))
    count = np.zeros(shape, int)
    for i in range(len(xs) + 1):
        for j in range(len(ys) + 1):
            limits = [np.concatenate([[-np.inf], one, [np.inf]]) for one in (xs, ys)]
            (low, high), (south, north) = limits[0][i : i + 2], limits[1][j : j + 2]
            rows, columns = rasters.find_cells(grid, ts.Bounds(low, south, high, north))
            count[rows, columns] += 1
            assert ((x[columns] >= low) & (x[columns] < high)).all()
            assert ((y[rows] >= south) & (y[rows] < north)).all()
    assert (count == 1).all()


def test_missing_cells_are_refused():
    grid = make_grid(CLOUDS["uniform"], 10)
    block = rasters.RasterBlock(slice(0, 2), slice(0, 3), np.zeros((2, 3)))
    with pytest.raises(ts.OptionError, match="all 182 cells"):
        rasters.join([block], rasters.RasterOptions(grid))
