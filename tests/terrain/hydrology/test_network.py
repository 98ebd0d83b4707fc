"""Strips, links and cells of the compiled core are those of numpy and fractions, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import hydrology_plain as plain
from support.point_sets import seeds
from support.surfaces import (
    ORIGIN,
    UTM,
    hills,
    punched,
    triangulate_whole_numbers,
    with_boundary_and_hole,
)

import tinsmith as ts
from tinsmith.terrain import _kernel
from tinsmith.terrain.hydrology import divides, drainage, strips
from tinsmith.terrain.hydrology.descent import Walker
from tinsmith.terrain.hydrology.falls import find_falls
from tinsmith.terrain.hydrology.filling import fill
from tinsmith.terrain.hydrology.networks import accumulate, build_network
from tinsmith.terrain.hydrology.vertices import NOWHERE


def require_same(tin):
    for filling in (None, fill(tin)):
        require_same_network(tin, filling)
    require_same_cells(tin)


def require_same_network(tin, filling):
    network = build_network(tin, filling)
    falls = find_falls(tin)
    walker, bases = Walker(falls, filling), plain.find_bases(falls)
    cut = plain.cut_strips(falls, bases)
    owners = np.repeat(np.arange(len(tin.triangles)), np.diff(network.strips.offsets))
    assert (owners == cut.triangles).all()
    assert (network.strips.starts == cut.starts).all()
    areas = cut.parts * network.areas[cut.triangles]
    assert (network.measure_strips() == areas).all()
    found = plain.link(walker, bases, cut, network.grounds)
    # Where rounding lets strips run in a circle, build_network breaks it.
    is_sound = plain.find_ends(found.nexts) != NOWHERE
    assert (network.nexts == found.nexts)[is_sound].all()
    assert (network.uppers == found.uppers)[is_sound[: len(found.uppers)]].all()
    ends = plain.find_ends(network.nexts)
    assert (_kernel.find_ends(network.nexts) == ends).all()
    assert (ends >= network.first_end).all()
    totals = np.zeros(len(network.nexts))
    totals[: len(areas)] = areas
    level = np.flatnonzero(falls.is_level)
    np.add.at(totals, network.find_level_nodes(level), network.areas[level])
    totals = plain.accumulate(network.nexts, totals)
    assert (accumulate(network) == totals).all()
    given = network.uppers, network.nexts, totals, len(tin.points)
    for one, other in zip(_kernel.sum_channels(*given), plain.sum_channels(*given), strict=True):
        assert (one == other).all()


def require_same_cells(tin):
    asked = []

    def cut_both(*given):
        numbers, offsets, vertices = found = _kernel.cut_cells(*given)
        cells = np.split(vertices, offsets[1:-1])
        wanted, wanted_cells = plain.cut_cells(*given)
        assert numbers.tolist() == wanted
        assert [cell.tolist() for cell in cells if len(cell)] == wanted_cells
        asked.append(len(wanted))
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(divides, "_kernel", _Cutting(cut_both))
        ts.catchments(tin)
        drainage.catchments(tin, fill_depressions=True)
    assert len(asked) == 2


class _Cutting:
    """The compiled core, another function of its stead."""

    def __init__(self, cut_cells):
        self.cut_cells = cut_cells


def scatter(rng, count, *, digits):
    """Return points of few or many digits: whole numbers have ties and level ground."""
    xy = rng.uniform(0, 20, (count, 2)).round(digits)
    return np.column_stack([xy, rng.uniform(0, 4, count).round(digits)])


@settings(max_examples=40, deadline=None)
@given(seeds, st.integers(1, 6), st.integers(2, 8))
def test_integer_lattices(seed, relief, side):
    require_same(triangulate_whole_numbers(side, relief, np.random.default_rng(seed)))


@settings(max_examples=40, deadline=None)
@given(seeds, st.integers(5, 120), st.sampled_from([0, 1, 2, 15]))
def test_scattered_points(seed, count, digits):
    points = scatter(np.random.default_rng(seed), count, digits=digits)
    try:
        tin = ts.triangulate(points)
    except ts.TinsmithError:
        return  # all on a line
    require_same(tin)


@settings(max_examples=25, deadline=None)
@given(seeds, st.floats(1e-16, 1e-3))
def test_descents_about_as_small_as_rounding(seed, relief):
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(6.0), np.arange(6.0)))
    z = 300.1 + relief * rng.integers(0, 4, x.size)
    require_same(ts.triangulate(np.column_stack([x, y, z]) + ORIGIN))


@settings(max_examples=25, deadline=None)
@given(seeds)
def test_planes_on_lattices(seed):
    """Fall lines through corners, edges along the gradient, ways exactly as steep."""
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(7.0), np.arange(5.0)))
    east, north, bend = rng.integers(-2, 3, 3)
    z = east * x + north * y + bend * abs(x - y)
    require_same(ts.triangulate(np.column_stack([x, y, z])))


@pytest.mark.parametrize("seed", range(8))
def test_surfaces_with_holes_and_parts_that_touch(seed):
    require_same(punched(seed))


def test_level_ground_alone():
    """Without strips areas are no whole numbers either."""
    for points in ([[0, 0], [4, 0], [4, 3], [0, 3], [1, 1]], [[0, 0], [0.5, 0], [0, 0.5]]):
        tin = ts.triangulate([[x, y, 1] for x, y in points])
        require_same(tin)
        assert ts.catchments(tin).columns["area"].tolist() == [tin.area]


AROUND = [[0, 5], [3, 4], [5, 0], [4, -3], [0, -5], [-4, -3], [-5, 0], [-3, 4]]
"""Clockwise from north, all as far from the middle."""


def find_below(elevations):
    """Return which of the vertices around the middle its water comes to."""
    points = [[*xy, z] for xy, z in zip(AROUND, elevations, strict=True)]
    tin = ts.triangulate([*points, [0, 0, 5]])
    require_same(tin)
    network = build_network(tin)
    return network.nexts[network.first_vertex + 8] - network.first_vertex


@pytest.mark.parametrize("turn", range(8))
def test_of_ways_exactly_as_steep_the_smallest_azimuth_is_taken(turn):
    steep = [(turn + k) % 8 for k in (0, 2, 5)]
    assert find_below([0.0 if k in steep else 5.5 for k in range(8)]) == min(steep)


@pytest.mark.parametrize("much", [1e-12, 1e-15, 1e-20])
def test_of_ways_nearly_as_steep_the_steeper_one_is_taken(much):
    for steepest in (0, 2, 4, 6):
        z = [0.0 if k % 2 == 0 else 5.5 for k in range(8)]
        z[steepest] = -2 * much
        z[(steepest + 2) % 8] = -much
        assert find_below(z) == steepest


def test_slivers_between_points_nearly_on_a_line():
    rng = np.random.default_rng(5)
    x = np.sort(rng.uniform(0, 1000, 60))
    xy = np.column_stack([x, 1e-9 * rng.integers(-3, 4, len(x))])
    require_same(ts.triangulate(np.column_stack([xy, rng.integers(0, 5, len(x))]) + ORIGIN))


def test_hills_far_away():
    require_same(hills(3000, unit=None))


def test_a_boundary_with_a_hole():
    rng = np.random.default_rng(9)
    points = np.column_stack([rng.uniform(0, 100, (800, 2)), rng.uniform(0, 3, 800)])
    require_same(with_boundary_and_hole(points + UTM))


def test_the_sample_survey():
    require_same(ts.triangulate(ts.read("sample_data/site_survey.csv", crs="EPSG:32616")))


def test_too_many_cuts_are_refused(monkeypatch):
    tin = hills(300, unit=None)
    monkeypatch.setattr(strips, "_MOST_CUTS", 100)
    with pytest.raises(ts.PointsError, match="cross more than 100 triangles: simplify it first"):
        ts.flow_accumulation(tin)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"neighbors": np.full((1, 3), 7, np.int32)}, "neighbors must be triangles or -1"),
        ({"triangles": np.full((1, 3), 3, np.int32)}, "vertex numbers from 0 to n - 1"),
        ({"signs": np.zeros((2, 3), np.int8)}, "a row of signs and of values for each triangle"),
        (
            {"filling": _kernel.Filling(np.zeros(3), *4 * (np.full(3, 9),))},
            "next vertices must be vertices or -1",
        ),
        (
            {"filling": _kernel.Filling(np.zeros(2), *4 * (np.zeros(2, np.int64),))},
            "one value of each kind",
        ),
    ],
)
def test_the_core_refuses_what_is_no_falling_surface(change, words):
    with pytest.raises(ValueError, match=words):
        make_surface(**change)


def make_surface(**change):
    """Return one triangle that falls to vertex 0."""
    arrays = {
        "points": np.array([[0.0, 0, 0], [1, 0, 1], [0, 1, 1]]),
        "triangles": np.array([[0, 1, 2]], np.int32),
        "neighbors": np.full((1, 3), -1, np.int32),
        "signs": np.array([[-1, 1, 1]], np.int8),
        "values": np.array([[-2.0, 1, 1]]),
        "filling": None,
    }
    return _kernel.FallingSurface(**(arrays | change))


def test_the_core_refuses_strips_and_nodes_that_are_none():
    surface = make_surface()
    offsets, starts = surface.cut_strips(9)
    assert (offsets.tolist(), starts.tolist()) == ([0, 2], [0.0, 0.5])
    grounds = np.arange(3, dtype=np.int32)
    with pytest.raises(ValueError, match="offsets must ascend"):
        surface.link_strips(offsets[:1], starts, grounds)
    with pytest.raises(ValueError, match="offsets must ascend"):
        surface.link_strips(offsets + 1, starts, grounds)
    with pytest.raises(ValueError, match="one area for each triangle"):
        surface.measure_strips(offsets, starts, np.ones(2))
    with pytest.raises(ValueError, match="a vertex of its ground for each vertex"):
        surface.link_strips(offsets, starts, grounds + 1)
    with pytest.raises(ValueError, match="one flag for each vertex"):
        surface.link_vertices(np.ones(2, np.bool_), 2, grounds)
    with pytest.raises(ValueError, match="more nodes than 32-bit indices"):
        surface.link_vertices(np.ones(3, np.bool_), 2**31 - 5, grounds)
    with pytest.raises(ValueError, match="there must be such triangles"):
        surface.bases_of(np.array([1]))
    with pytest.raises(OverflowError):
        surface.cut_strips(0)


def test_the_core_refuses_networks_that_are_none():
    nexts, totals = np.array([1, 2, 2], np.int32), np.ones(3)
    for ask in (
        lambda: _kernel.find_ends(nexts + 1),
        lambda: _kernel.accumulate(nexts - 3, totals),
        lambda: _kernel.sum_channels(nexts, nexts + 1, totals, 3),
    ):
        with pytest.raises(ValueError, match="what is below a node must be a node"):
            ask()
    with pytest.raises(ValueError, match="one value for each node"):
        _kernel.accumulate(nexts, totals[:2])
    with pytest.raises(ValueError, match="nodes must be strips and vertices"):
        _kernel.sum_channels(np.array([9, -1, -1], np.int32), nexts, totals, 3)


def test_ends_of_nodes_that_run_in_a_circle_are_nowhere():
    nexts = np.array([1, 2, 0, 3, 3, 4, 1], np.int32)
    assert _kernel.find_ends(nexts).tolist() == [-1, -1, -1, 3, 3, 3, -1]
    assert plain.find_ends(nexts).tolist() == [-1, -1, -1, 3, 3, 3, -1]


def test_the_core_refuses_cuts_that_end_elsewhere():
    corners = np.array([[0, 1, 2]], np.int32)
    ranges = np.array([[0, 1, 1, 1, 1, 1]])
    cuts = np.array([0, 1]), np.array([3], np.int32)
    numbers, offsets, vertices = _kernel.cut_cells(corners, ranges, 3, *cuts, corners[0, 2:])
    assert (numbers.tolist(), offsets.tolist()) == ([0, 1], [0, 3, 6])
    assert vertices.tolist() == [0, 3, 2, 3, 1, 2]
    with pytest.raises(ValueError, match="must end on the edges of its triangle"):
        _kernel.cut_cells(corners, ranges, 3, *cuts, np.array([9], np.int32))
    with pytest.raises(ValueError, match="ranges must be of places"):
        _kernel.cut_cells(corners, ranges[:, ::-1].copy(), 3, *cuts, corners[0, 2:])
    with pytest.raises(ValueError, match="offsets must ascend"):
        _kernel.cut_cells(corners, ranges, 3, cuts[0], cuts[1], corners[0])
