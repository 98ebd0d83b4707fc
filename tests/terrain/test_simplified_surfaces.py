"""The tolerance between simplified surfaces, by all crossings of edges; and errors equal to it."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import surfaces
from support.commands import run
from support.point_sets import seeds
from support.simplification import errors, largest_difference
from support.surfaces import UTM

import tinsmith as ts
from tinsmith.terrain.simplification.rasters import simplify_raster
from tinsmith.tin.meshing.simplification import Goal


def scattered(n=250, seed=1):
    xy = np.random.default_rng(seed).random((n, 2)) * 100
    z = 8 * np.sin(xy[:, 0] / 15) * np.cos(xy[:, 1] / 20)
    return np.column_stack([xy, z]) + UTM


def flipped(seed=3):
    """A TIN of a file, in which some edges are not Delaunay."""
    tin = ts.triangulate(scattered(120, seed))
    edited = tin.replace()
    for edge in tin.edges[:: len(tin.edges) // 25].tolist():
        try:
            edited.flip(*edge)
        except ts.TinsmithError:
            continue
    return ts.TIN.from_triangles(edited.points, edited.triangles)


SURFACES = {
    "lines": lambda: surfaces.with_lines(scattered(200, 2)),
    "pond": lambda: surfaces.with_pond(scattered(200, 4)),
    "flipped": flipped,
}
PLAIN = {
    "scattered": lambda: ts.triangulate(scattered()),
    "boundary and hole": lambda: surfaces.with_boundary_and_hole(scattered(200, 3)),
    "trimmed": lambda: ts.triangulate(scattered(200, 5), max_edge=12.0),
}


def make_raster(seed, *, share=0.0, shape=(25, 30), whole=False, corner=(0.0, 0.0)):
    rng = np.random.default_rng(seed)
    z = rng.normal(size=shape).cumsum(axis=0).cumsum(axis=1)
    z = np.where(rng.random(shape) < share, np.nan, np.round(z) if whole else z)
    west, south = corner
    bounds = ts.Bounds(west, south, west + 2.0 * shape[1], south + 2.0 * shape[0])
    return ts.Raster({"elevation": z}, ts.Grid(bounds, shape, 2.0))


# ---------------------------------------------------------------- between the points


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("tolerance", [0.02, 0.2, 2.0])
def test_with_lines_surfaces_differ_nowhere_by_more_than_the_tolerance(name, tolerance):
    """They differed by metres between the points, which were within centimetres."""
    tin = SURFACES[name]()
    simple = ts.simplify(tin, tolerance=tolerance)
    told = simple.report.simplification
    true = largest_difference(tin, simple)
    assert told.hold == "surface"
    assert true <= tolerance + 1e-9
    assert told.surface_error == pytest.approx(true, abs=1e-9)
    assert told.largest_error == pytest.approx(errors(tin.points, simple).max(), abs=1e-9)
    assert ts.check(simple, level=3).ok
    loose = ts.simplify(tin, tolerance=tolerance, hold="points")
    assert largest_difference(tin, loose) > 1.5 * tolerance
    assert loose.report.simplification.hold == "points"
    assert loose.report.simplification.surface_error is None


@pytest.mark.parametrize("name", PLAIN)
def test_of_points_alone_they_are_held_unless_asked_otherwise(name):
    tin = PLAIN[name]()
    loose = ts.simplify(tin, tolerance=0.1)
    assert loose.report.simplification.hold == "points"
    assert "between them the surfaces may differ by more" in loose.report.notes[-1]
    simple = ts.simplify(tin, tolerance=0.1, hold="surface")
    told = simple.report.simplification
    true = largest_difference(tin, simple)
    assert true <= 0.1 + 1e-9 < largest_difference(tin, loose)
    assert told.surface_error == pytest.approx(true, abs=1e-9)
    assert f"anywhere the surfaces differ by at most {true:.4g}" in simple.report.notes[-1]
    assert len(loose.points) < len(simple.points) < len(tin.points)


def test_given_edges_that_are_not_delaunay_stay_where_the_tolerance_needs_them():
    tin = flipped()
    simple = ts.simplify(tin, tolerance=0.0)
    told = simple.report.simplification
    assert told.forced_edges > 0
    assert told.surface_error == pytest.approx(0.0, abs=1e-9)
    assert largest_difference(tin, simple) == pytest.approx(0.0, abs=1e-9)
    assert (
        f"{told.forced_edges} edges of the given triangles, not Delaunay, stayed" in told.sentence()
    )
    assert simple.constrained.any()
    assert ts.check(simple, level=3).ok
    again = ts.simplify(simple, tolerance=0.0)
    assert largest_difference(tin, again) == pytest.approx(0.0, abs=1e-9)


def test_with_a_number_of_points_the_difference_is_told():
    tin = SURFACES["lines"]()
    simple = ts.simplify(tin, points=150)
    told = simple.report.simplification
    assert (told.hold, len(simple.points)) == (None, 150)
    assert told.surface_error == pytest.approx(largest_difference(tin, simple), abs=1e-9)
    assert ts.simplify(PLAIN["scattered"](), points=150).report.simplification.surface_error is None


@given(seeds, st.sampled_from([0.0, 1.0, 2.5]))
@settings(max_examples=25, deadline=None)
def test_the_order_of_points_changes_nothing(seed, tolerance):
    """On small whole numbers, where nearly everything is a tie."""
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(8.0), np.arange(7.0)))
    points = np.column_stack([x, y, rng.integers(0, 5, len(x))])
    tins = [ts.triangulate(rows) for rows in (points, points[rng.permutation(len(points))])]
    one, other = (ts.simplify(tin, tolerance=tolerance, hold="surface") for tin in tins)
    assert set(map(tuple, one.points.tolist())) == set(map(tuple, other.points.tolist()))
    assert largest_difference(tins[0], one) <= tolerance + 1e-9


@pytest.mark.each_value
@pytest.mark.parametrize("share", [0.0, 0.05, 0.3])
@pytest.mark.parametrize("tolerance", [0.0, 0.5, 5.0])
def test_between_cells_of_a_raster(share, tolerance):
    raster = make_raster(4, share=share, corner=(500_000.0, 4_000_000.0))
    tin = ts.triangulate(ts.from_raster(raster))
    simple = ts.simplify(raster, tolerance=tolerance, hold="surface")
    told = simple.report.simplification
    true = largest_difference(tin, simple)
    assert true <= tolerance + 1e-9
    assert told.surface_error == pytest.approx(true, abs=1e-9)
    assert told.hold == "surface"
    assert ts.simplify(raster, tolerance=tolerance).report.simplification.hold == "points"


@pytest.mark.parametrize("shape", [(2, 2), (2, 30), (30, 2), (9, 9)])
def test_narrow_rasters(shape):
    raster = make_raster(7, shape=shape)
    simple = ts.simplify(raster, tolerance=0.5, hold="surface")
    tin = ts.triangulate(ts.from_raster(raster))
    assert largest_difference(tin, simple) <= 0.5 + 1e-9


def test_what_cannot_be_held_is_refused():
    tin, raster = PLAIN["scattered"](), make_raster(1)
    with pytest.raises(ts.OptionError, match="Invalid hold 'lines'"):
        ts.simplify(tin, tolerance=1.0, hold="lines")
    with pytest.raises(ts.OptionError, match="None where a number of points is given"):
        ts.simplify(tin, points=50, hold="surface")
    goal = Goal.of(1.0, None, "surface")
    with pytest.raises(ts.OptionError, match="points for a raster of more than 99 cells"):
        simplify_raster(raster, goal, (), None, largest_whole=99, block_side=5)


def test_the_command_tells_which_was_held(tmp_path):
    tin = SURFACES["lines"]()
    given_file = ts.write(tin, tmp_path / "given.gpkg")
    options = ("--tolerance", 0.1, "--json", "-o", tmp_path / "a.gpkg")
    for more, hold, words in (
        ((), "surface", "anywhere the surfaces differ by at most"),
        (("--hold", "points"), "points", "between them the surfaces may differ by more"),
    ):
        out = run("simplify", given_file, *options, *more)
        assert out.exit_code == 0, out.output
        told = json.loads(out.stdout)
        assert told["simplification"]["hold"] == hold
        assert words in out.stderr
        assert words in told["tin"]["notes"][-1]
        (tmp_path / "a.gpkg").unlink()


# ---------------------------------------------------------------- errors equal to the tolerance


@pytest.mark.parametrize("tolerance", [1.0, 2.0, 3.0])
@pytest.mark.parametrize("corner", [(0.0, 0.0), (500_000.0, 4_000_000.0)])
def test_an_error_equal_to_the_tolerance_is_within_it(tolerance, corner):
    """Whole metres have many; they cost a tenth more triangles."""
    y, x = np.mgrid[0:60, 0:60]
    noise = np.random.default_rng(1).normal(0, 2, x.shape)
    z = np.round(40 * np.sin(x / 17) * np.cos(y / 23) + 15 * np.sin(x / 5 + y / 7) + noise)
    west, south = corner
    raster = ts.Raster(
        {"elevation": z}, ts.Grid(ts.Bounds(west, south, west + 60, south + 60), z.shape, 1.0)
    )
    for given_surface in (raster, ts.triangulate(ts.from_raster(raster))):
        exact, more = (
            ts.simplify(given_surface, tolerance=wanted) for wanted in (tolerance, tolerance + 1e-9)
        )
        np.testing.assert_array_equal(exact.points, more.points)
        assert exact.report.simplification.largest_error == tolerance


def test_a_pyramid_as_high_as_the_tolerance_is_left_out():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    points = np.column_stack([x, y, np.where((x == 1) & (y == 1), 0.3, 0.0)])
    for z in (0.0, 100.7, -3.3):
        tin = ts.triangulate(points + np.array([0, 0, z]))
        height = float(tin.points[4, 2] - tin.points[0, 2])
        assert len(ts.simplify(tin, tolerance=height).points) == 4
        assert len(ts.simplify(tin, tolerance=height * (1 - 1e-9)).points) > 4
