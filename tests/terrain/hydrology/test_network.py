"""Strips, links and cells of the compiled core are those of numpy and fractions, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import hydrology_plain as plain
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
from tinsmith.terrain.hydrology import divides, drainage
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
    strips = plain.cut_strips(falls, bases)
    owners = np.repeat(np.arange(len(tin.triangles)), np.diff(network.strips.offsets))
    assert (owners == strips.triangles).all()
    assert (network.strips.starts == strips.starts).all()
    areas = strips.parts * network.areas[strips.triangles]
    assert (network.measure_strips() == areas).all()
    found = plain.link(walker, bases, strips, network.grounds)
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
@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(2, 8))
def test_integer_lattices(seed, relief, side):
    require_same(triangulate_whole_numbers(side, relief, np.random.default_rng(seed)))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(5, 120), st.sampled_from([0, 1, 2, 15]))
def test_scattered_points(seed, count, digits):
    points = scatter(np.random.default_rng(seed), count, digits=digits)
    try:
        tin = ts.triangulate(points)
    except ts.TinsmithError:
        return  # all on a line
    require_same(tin)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(1e-16, 1e-3))
def test_descents_about_as_small_as_rounding(seed, relief):
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(6.0), np.arange(6.0)))
    z = 300.1 + relief * rng.integers(0, 4, x.size)
    require_same(ts.triangulate(np.column_stack([x, y, z]) + ORIGIN))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
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
    require_same(ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 3, 1], [0, 3, 1], [1, 1, 1]]))
    require_same(ts.triangulate([[0, 0, 1], [4, 0, 1], [0, 3, 1]]))


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
