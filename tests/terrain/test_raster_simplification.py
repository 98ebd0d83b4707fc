"""Rasters simplified cell by cell: near every cell, in one piece or in blocks, voids stay voids."""

from functools import partial

import numpy as np
import pytest
from support.simplification import errors, is_needed

import tinsmith as ts
from tinsmith.base.results.gridded import locate_centers
from tinsmith.terrain import _kernel
from tinsmith.terrain.simplification.rasters import simplify_raster
from tinsmith.terrain.simplification.seams import choose_vertices, trace_block
from tinsmith.terrain.surface.voids import find_surface
from tinsmith.tin._kernel import VECTOR_PATHS
from tinsmith.tin.meshing.simplification import Goal


def hills(rows=24, columns=21, seed=1):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(rows, columns)).cumsum(axis=0).cumsum(axis=1)


def raster_of(z, spacing=1.0, west=0.0, north=0.0, **options):
    rows, columns = z.shape
    bounds = ts.Bounds(west, north - rows * spacing, west + columns * spacing, north)
    return ts.Raster({"elevation": z}, ts.Grid(bounds, z.shape, spacing), **options)


def with_voids(seed, share=0.08):
    z = hills(seed=seed)
    z[np.random.default_rng(seed).random(z.shape) < share] = np.nan
    z[10:17, 5:15] = np.nan
    return z


def list_cells(raster):
    """Return the points of cells that are corners of a surface."""
    z = np.array(raster.bands["elevation"], float)
    z[z == raster.nodata] = np.nan
    row, column = np.nonzero(find_surface(np.isfinite(z)))
    x, y = locate_centers(raster.grid)
    return np.column_stack([x[column], y[row], z[row, column]])


RASTERS = {
    "whole": lambda: raster_of(hills()),
    "whole numbers": lambda: raster_of(np.round(hills(seed=2))),
    "voids": lambda: raster_of(with_voids(3)),
    "many voids": lambda: raster_of(with_voids(4, 0.3)),
    "centres that are rounded": lambda: raster_of(with_voids(5), 0.1, 4.7e6 + 1 / 3, 5.2e6 + 1 / 7),
    "integers": lambda: raster_of(
        np.round(np.nan_to_num(with_voids(6), nan=-99)).astype("i2"), nodata=-99.0
    ),
}


@pytest.mark.each_value
@pytest.mark.parametrize("name", RASTERS)
@pytest.mark.parametrize("share", [0.0, 0.01, 0.1])
@pytest.mark.parametrize("side", [None, 7, 16])
def test_no_cell_is_beyond_the_tolerance(name, share, side):
    raster = RASTERS[name]()
    cells = list_cells(raster)
    tolerance = share * float(np.ptp(cells[:, 2]))
    largest = 2**24 if side is None else 0
    simple = simplify_raster(
        raster, Goal.of(tolerance, None), (), 1, largest_whole=largest, block_side=side or 1
    )
    assert ts.check(simple, level=3).ok
    found, told = errors(cells, simple), simple.report.simplification
    assert found.max() <= tolerance + 1e-8
    assert told.largest_error == pytest.approx(found.max(), abs=1e-8)
    assert told.rms_error == pytest.approx(np.sqrt(np.mean(found**2)), abs=1e-8)
    assert told.points == len(cells)
    assert told.largest_error <= max(tolerance, np.abs(cells[:, 2]).max() * 2**-46)
    whole = ts.triangulate(ts.from_raster(raster))
    assert simple.area == pytest.approx(whole.area, rel=1e-9)
    assert {tuple(p) for p in simple.points.tolist()} <= {tuple(p) for p in cells.tolist()}


@pytest.mark.parametrize("name", ["whole", "voids"])
def test_no_vertex_inside_is_needless(name):
    raster = RASTERS[name]()
    cells = list_cells(raster)
    tolerance = 0.1 * float(np.ptp(cells[:, 2]))
    simple = ts.simplify(raster, tolerance=tolerance)
    inner = np.setdiff1d(np.arange(len(simple.points)), np.concatenate(simple.rings))
    assert len(inner) > 5
    assert all(is_needed(simple, vertex, cells, tolerance) for vertex in inner.tolist())


def test_a_raster_and_the_tin_of_its_cells_are_simplified_alike():
    raster = raster_of(hills(40, 40))
    tin = ts.triangulate(ts.from_raster(raster))
    tolerance = 0.02 * float(np.ptp(tin.points[:, 2]))
    one, other = (ts.simplify(surface, tolerance=tolerance) for surface in (raster, tin))
    assert len(one.points) == pytest.approx(len(other.points), rel=0.03)
    assert one.report.simplification.required == other.report.simplification.required == 4


def simplify_plainly(z, tolerance):
    """Insert the worst cell until none is beyond the tolerance, measuring all each time."""
    rows, columns = z.shape
    y, x = np.mgrid[:rows, :columns]
    points = np.column_stack([x.ravel(), -y.ravel(), z.ravel()]).astype(float)
    chosen = {0, columns - 1, (rows - 1) * columns, rows * columns - 1}
    while True:
        found = errors(points, ts.triangulate(points[sorted(chosen)]))
        found[sorted(chosen)] = 0.0
        if found.max() <= tolerance:
            return chosen
        chosen.add(int(found.argmax()))


@pytest.mark.parametrize("seed", range(3))
def test_vertices_are_inserted_as_the_worst_of_all_cells(seed):
    z = hills(14, 17, seed)
    tolerance = 0.1 * float(np.ptp(z))
    raster = raster_of(z, north=0.5, west=-0.5)
    count = len(simplify_plainly(z, tolerance))
    assert len(ts.simplify(raster, tolerance=tolerance).points) <= count
    counted = ts.simplify(raster, points=count)  # none of these is removed again
    expected = {(c % 17, -(c // 17)) for c in simplify_plainly(z, tolerance)}
    assert {tuple(p) for p in counted.points[:, :2].tolist()} == expected


def test_the_core_measures_what_brute_force_does():
    z = hills(20, 24)
    cells = np.array([[0, 0], [23, 0], [23, 19], [0, 19], [11, 8], [5, 15]], np.int32)
    heights = z[::-1][cells[:, 1], cells[:, 0]]
    tin = ts.triangulate(np.column_stack([cells, heights]).astype(float))
    at = np.ascontiguousarray(tin.points[:, :2].astype(np.int32))
    z_up = np.ascontiguousarray(z[::-1])
    measured = _kernel.measure_cells(
        z_up, at, np.ascontiguousarray(tin.points[:, 2]), tin.triangles
    )
    y, x = np.mgrid[:20, :24]
    points = np.column_stack([x.ravel(), y.ravel(), z_up.ravel()])
    assert measured.ravel() == pytest.approx(errors(points, tin), abs=1e-9)


@pytest.mark.each_value
@pytest.mark.parametrize("tolerance", [0.0, 0.05, 2.0])
@pytest.mark.parametrize("name", RASTERS)
def test_vector_paths_choose_the_same_cells(name, tolerance, monkeypatch):
    raster, found = RASTERS[name](), {}
    simplify_cells = _kernel.simplify_cells
    for path in VECTOR_PATHS:
        monkeypatch.setattr(_kernel, "simplify_cells", partial(simplify_cells, path=path))
        found[path] = ts.simplify(raster, tolerance=tolerance)
    assert {"plain"} <= set(found)
    for simple in found.values():
        assert np.array_equal(simple.points, found["plain"].points)
        assert simple.report.simplification == found["plain"].report.simplification


def test_a_vector_path_that_is_none_is_refused(monkeypatch):
    unknown = partial(_kernel.simplify_cells, path="avx9")
    monkeypatch.setattr(_kernel, "simplify_cells", unknown)
    with pytest.raises(ValueError, match="no such vector path on this processor: avx9"):
        ts.simplify(raster_of(hills()), tolerance=1.0)


def test_blocks_and_threads_change_nothing_but_the_seams():
    raster = raster_of(with_voids(8))
    goal = Goal.of(2.0, None)
    found = [
        simplify_raster(raster, goal, (), threads, largest_whole=0, block_side=9)
        for threads in (1, 3)
    ]
    assert np.array_equal(found[0].points, found[1].points)
    assert np.array_equal(found[0].triangles, found[1].triangles)
    notes = " ".join(found[0].report.notes)
    assert "simplified in 9 blocks" in notes
    assert "needless" in notes


def test_a_band_that_is_read_in_blocks_gives_the_same():
    class Band:
        def __init__(self, z):
            self.z, self.shape, self.dtype, self.most = z, z.shape, z.dtype, 0

        def __getitem__(self, key):
            part = self.z[key]
            self.most = max(self.most, part.size)
            return part

    raster = raster_of(hills(50, 60))
    band = Band(raster.bands["elevation"])
    lazy = ts.Raster({"elevation": band}, raster.grid)
    goal = Goal.of(5.0, None)
    one, other = (
        simplify_raster(one, goal, (), 1, largest_whole=0, block_side=16) for one in (raster, lazy)
    )
    assert np.array_equal(one.points, other.points)
    assert band.most <= 18 * 18


def test_cells_to_be_kept_are_kept_and_what_is_told_of_a_raster_stays():
    z = hills()
    raster = raster_of(z, crs="EPSG:32616", units={"elevation": "ft"}, notes=["Flown in May."])
    keep = [5, 21 * 7 + 4, 21 * 24 - 3]
    simple = ts.simplify(raster, tolerance=1e6, keep=keep)
    assert len(simple.points) == 4 + 3
    assert simple.crs == ts.CRS.of("EPSG:32616")
    assert simple.elevation_unit.symbol == "ft"
    assert "Flown in May." in simple.report.notes
    assert set(z.ravel()[keep]) <= set(simple.points[:, 2])


def test_a_number_of_points_is_met_exactly():
    raster = raster_of(with_voids(9))
    least = ts.simplify(raster, tolerance=1e9).report.simplification.required
    for points in (least, least + 40, len(list_cells(raster))):
        assert len(ts.simplify(raster, points=points).points) == points


def test_an_elevation_that_stands_for_no_data_is_told():
    z = hills()
    z[4, 5:8] = -9999.0
    assert "-9999" in " ".join(ts.simplify(raster_of(z), tolerance=3.0).report.notes)


@pytest.mark.parametrize(
    ("raster", "options", "words"),
    [
        (lambda: raster_of(np.full((4, 5), np.nan)), {"tolerance": 1.0}, "has no surface"),
        (
            lambda: raster_of(np.eye(3) + np.where(np.eye(3), 0, np.nan)),
            {"tolerance": 1.0},
            "No three cells side by side",
        ),
        (lambda: raster_of(np.zeros((1, 5))), {"tolerance": 1.0}, "1 by 5 cells has no surface"),
        (lambda: raster_of(hills()), {"tolerance": 1.0, "keep": [504]}, "There is no cell 504"),
        (
            lambda: raster_of(with_voids(1)),
            {"tolerance": 1.0, "keep": [21 * 12 + 8]},
            "to be kept, is not on the surface",
        ),
        (lambda: raster_of(hills()), {"tolerance": 1.0, "keep": [0.5]}, "numbers of cells"),
        (lambda: raster_of(hills()), {"points": 3}, "it must be from 4"),
        (lambda: raster_of(hills()), {"points": 2000}, "to 504, for there are no more"),
    ],
)
def test_what_cannot_be_is_refused(raster, options, words):
    with pytest.raises((ts.PointsError, ts.OptionError), match=words):
        ts.simplify(raster(), **options)


def test_of_several_bands_the_elevations_are_taken():
    raster = raster_of(hills())
    bands = {"slope": np.zeros(raster.shape), "elevation": raster.bands["elevation"]}
    assert len(ts.simplify(ts.Raster(bands, raster.grid), tolerance=5.0).points) > 4
    other = {"slope": bands["slope"], "aspect": bands["slope"]}
    with pytest.raises(ts.OptionError, match="with one band, or with a band 'elevation'"):
        ts.simplify(ts.Raster(other, raster.grid), tolerance=5.0)


@pytest.mark.parametrize("shape", [(2, 2), (2, 5), (6, 4)])
def test_the_ring_of_a_block_without_voids_runs_about_it(shape):
    (ring,) = trace_block(np.ones(shape, bool))
    row, column = np.divmod(ring, shape[1])
    area = np.sum(column * np.roll(-row, -1) - np.roll(column, -1) * -row) / 2
    assert area == (shape[0] - 1) * (shape[1] - 1)
    assert len(set(ring.tolist())) == len(ring) == 2 * sum(shape) - 4


def test_vertices_of_a_profile_keep_it_within_the_limit():
    z = np.random.default_rng(1).normal(size=200).cumsum()
    chosen = np.concatenate([[0], choose_vertices(z, 1.5), [199]])
    assert np.abs(np.interp(np.arange(200), chosen, z[chosen]) - z).max() <= 1.5
    assert len(chosen) < 150
