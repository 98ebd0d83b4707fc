"""Contour lines against closed forms, fractions, matplotlib and their own properties."""

from __future__ import annotations

import math
from itertools import pairwise

import matplotlib.tri
import numpy as np
import pytest
from contourpy import contour_generator  # noqa: F401 - matplotlib draws with it
from matplotlib import _tri
from support.each_value import list_seeds
from support.isolines import level_segments, rounded_segments, segments_of_lines

import tinsmith as ts


def lines_of(features):
    (offsets,) = features.offsets
    return [features.coordinates[a:b] for a, b in pairwise(offsets)]


def grid_tin(rng, side, highest, share=1.0):
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    z = rng.integers(0, highest + 1, side * side)
    kept = rng.random(side * side) < share
    return ts.triangulate(np.column_stack([x.ravel(), y.ravel(), z])[kept].astype(float))


def cone(sides, rings):
    """Return a TIN of nested regular polygons around a summit: z falls by 1 a ring."""
    turn = 2 * np.pi * np.arange(sides) / sides
    parts = [np.array([[0.0, 0.0, rings]])]
    for k in range(1, rings + 1):
        z = np.full(sides, rings - k)
        parts.append(np.column_stack([k * np.cos(turn), k * np.sin(turn), z]))
    return ts.triangulate(np.concatenate(parts))


# ------------------------------------------------------------------ closed forms


def test_lines_of_a_plane_are_straight_and_of_its_width():
    rng = np.random.default_rng(1)
    inside = rng.uniform(0, 10, (200, 2))
    xy = np.concatenate([[[0, 0], [10, 0], [10, 10], [0, 10]], inside])
    tin = ts.triangulate(np.column_stack([xy, 2 * xy[:, 0] + 1]))
    found = ts.contours(tin, interval=1.5, base=0.25)
    expected = np.arange(0.25 + 1.5, 21, 1.5)
    assert found.columns["elevation"] == pytest.approx(expected, abs=0)
    assert found.columns["length"] == pytest.approx(np.full(len(expected), 10), rel=1e-12)
    assert not found.columns["is_closed"].any()
    for line, level in zip(lines_of(found), expected, strict=True):
        assert line[:, 0] == pytest.approx(np.full(len(line), (level - 1) / 2), abs=1e-12)
        assert (np.diff(line[:, 1]) < 0).all()  # the east is higher, on the left of the way south


def test_lines_of_a_cone_are_regular_polygons():
    tin = cone(12, 4)
    found = ts.contours(tin, interval=0.5)
    side = 2 * math.sin(math.pi / 12)
    levels = found.columns["elevation"]
    assert levels == pytest.approx(np.arange(0.5, 4, 0.5))  # none around the foot and the summit
    assert found.columns["is_closed"].all()
    assert found.columns["length"] == pytest.approx(12 * side * (4 - levels), rel=1e-12)


def test_lines_of_a_paraboloid_pass_through_the_vertices_at_their_level():
    turn = 2 * np.pi * np.arange(8) / 8
    rings = [
        np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(8, -r * r)])
        for r in (1.0, 2.0, 3.0)
    ]
    tin = ts.triangulate(np.concatenate([[[0.0, 0.0, 0.0]], *rings]))
    found = ts.contours(tin, levels=[-4, -1])
    for line, radius in zip(lines_of(found), (2.0, 1.0), strict=True):
        assert len(line) == 9
        assert np.hypot(*line[:, :2].T) == pytest.approx(radius)


# ------------------------------------------------------- vertices at the level, and flats


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]


def square_with(corner_z, middle_z):
    return ts.TIN.from_triangles(
        [*([x, y, z] for (x, y), z in zip(SQUARE, corner_z, strict=True)), [2, 2, middle_z]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    )


def test_a_summit_that_only_reaches_the_level_has_no_line():
    assert len(ts.contours(square_with([0, 0, 0, 0], 5), levels=[5])) == 0


def test_a_pit_at_the_level_has_no_line():
    assert len(ts.contours(square_with([5, 5, 5, 5], 0), levels=[0])) == 0


def test_a_ridge_at_the_level_has_no_line():
    tin = ts.TIN.from_triangles(
        [[0, 0, 5], [4, 0, 5], [2, 3, 0], [2, -3, 0]], [[0, 1, 2], [1, 0, 3]]
    )
    assert len(ts.contours(tin, levels=[5])) == 0


def test_lines_around_a_flat_area_run_where_the_surface_begins_to_fall():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(6.0), np.arange(6.0)))
    z = np.where((x >= 2) & (x <= 3) & (y >= 2) & (y <= 3), 7.0, 3.0)
    tin = ts.triangulate(np.column_stack([x, y, z]))
    (line,) = lines_of(ts.contours(tin, levels=[7]))
    assert set(map(tuple, line[:, :2])) == {(2, 2), (3, 2), (3, 3), (2, 3)}
    assert len(line) == 5


def test_a_saddle_at_the_level_keeps_two_lines_that_touch():
    found = ts.contours(square_with([0, 4, 0, 4], 2), levels=[2])
    assert len(found) == 2
    assert all(any((line[:, :2] == (2, 2)).all(axis=1)) for line in lines_of(found))


@pytest.mark.parametrize("seed", list_seeds(150, few=40))
def test_segments_are_those_of_fractions_on_small_integer_grids(seed):
    rng = np.random.default_rng(seed)
    tin = grid_tin(rng, int(rng.integers(3, 8)), int(rng.integers(1, 6)))
    step = float(rng.choice([1.0, 0.5, 0.75]))
    found = ts.contours(tin, interval=step)
    for level in np.arange(0, 6, step):
        expected = rounded_segments(level_segments(tin.points, tin.triangles, level))
        assert segments_of_lines(found, level) == expected


@pytest.mark.parametrize("seed", range(40))
def test_open_lines_end_at_the_boundary(seed):
    rng = np.random.default_rng(seed)
    tin = grid_tin(rng, 7, 3, share=0.7)
    tin = ts.triangulate(tin.points, max_edge=1.5) if seed % 2 else tin
    found = ts.contours(tin, interval=0.5)
    ring_edges = [np.stack([ring, np.roll(ring, -1)], axis=1) for ring in tin.rings]
    a, b = (tin.points[np.concatenate(ring_edges)[:, k], :2] for k in (0, 1))
    closed = found.columns["is_closed"]
    for line, is_closed in zip(lines_of(found), closed, strict=True):
        assert is_closed == (line[0] == line[-1]).all() or not is_closed
        for place in line[[0, -1], :2] if not is_closed else []:
            gap = np.hypot(*(place - a).T) + np.hypot(*(place - b).T) - np.hypot(*(b - a).T)
            assert gap.min() < 1e-12


# ------------------------------------------------------------------- generic data


def hilly(n, seed=0):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 1000, (n, 2))
    z = 300 + 30 * np.sin(xy[:, 0] / 90) * np.cos(xy[:, 1] / 70) + 4 * rng.random(n)
    return ts.triangulate(np.column_stack([xy, z]))


def test_lines_are_those_of_matplotlib():
    tin = hilly(3000)
    levels = np.linspace(271.3, 333.1, 31)
    found = ts.contours(tin, levels=levels)
    x, y, z = tin.points.T
    triangulation = matplotlib.tri.Triangulation(x, y, tin.triangles)
    generator = _tri.TriContourGenerator(triangulation.get_cpp_triangulation(), z)
    for level in levels:
        ours = [line[:, :2] for line in lines_of(found) if line[0, 2] == level]
        theirs, _ = generator.create_contour(level)
        assert sorted(map(len, ours)) == sorted(map(len, theirs))
        spans = [
            sorted(np.hypot(*np.diff(line, axis=0).T).sum() for line in lines)
            for lines in (ours, theirs)
        ]
        assert spans[0] == pytest.approx(spans[1], rel=1e-9)


def test_every_point_lies_on_an_edge_at_the_level():
    tin = hilly(2000)
    found = ts.contours(tin, interval=2.5)
    z = tin.interpolate(found.coordinates[:, :2])
    inside = np.isfinite(z)  # points of the boundary may lie a rounding outside
    assert inside.mean() > 0.95
    assert z[inside] == pytest.approx(found.coordinates[inside, 2], abs=1e-10)


def test_lines_do_not_depend_on_the_order_of_triangles_and_corners():
    rng = np.random.default_rng(5)
    tin = grid_tin(rng, 12, 4)
    expected = ts.contours(tin, interval=0.5)
    for _ in range(5):
        triangles = tin.triangles[rng.permutation(len(tin.triangles))]
        turns = rng.integers(0, 3, len(triangles))
        turned = np.stack(
            [triangles[np.arange(len(triangles)), (turns + k) % 3] for k in range(3)], axis=1
        )
        found = ts.contours(ts.TIN.from_triangles(tin.points, turned), interval=0.5)
        assert np.array_equal(found.coordinates, expected.coordinates)
        assert np.array_equal(found.offsets[0], expected.offsets[0])


def test_the_higher_side_is_on_the_left():
    tin = hilly(800)
    for line in lines_of(ts.contours(tin, interval=3)):
        a, b = line[:-1, :2], line[1:, :2]
        left = 0.5 * (a + b) + 1e-6 * np.column_stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0]])
        z = tin.interpolate(left)
        assert (z[np.isfinite(z)] >= line[0, 2] - 1e-9).all()


def test_lines_stay_apart_from_holes_and_parts():
    tin = ts.triangulate(
        hilly(1500).points,
        boundary=[
            [[50, 50], [450, 50], [450, 950], [50, 950]],
            [[550, 50], [950, 50], [950, 950], [550, 950]],
        ],
        holes=[[[200, 400], [300, 400], [300, 500], [200, 500]]],
    )
    found = ts.contours(tin, interval=2)
    middles = np.concatenate([0.5 * (line[:-1] + line[1:]) for line in lines_of(found)])
    z = tin.interpolate(middles[:, :2])
    assert np.nanmax(np.abs(z - middles[:, 2])) < 1e-9
    assert np.isfinite(z).mean() > 0.95


# ------------------------------------------------------------------- levels, columns


def test_levels_are_decimal_numbers():
    tin = ts.triangulate([[0, 0, 0.3], [1, 0, 0.3], [1, 1, 0.2], [0, 1, 0.2]])
    found = ts.contours(tin, interval=0.1)
    assert found.columns["elevation"].tolist() == [0.3]
    assert found.coordinates[:, 1].tolist() == [0.0, 0.0]  # the edge at 0.3 itself


def test_index_contours_count_from_the_base():
    tin = ts.triangulate([[0, 0, 0], [10, 0, 0], [10, 10, 21], [0, 10, 21]])
    found = ts.contours(tin, interval=2, base=1, index=5)
    levels = found.columns["elevation"]
    assert levels.tolist() == list(range(1, 22, 2))
    assert levels[found.columns["is_index"]].tolist() == [1, 11, 21]
    assert not ts.contours(tin, interval=2, index=None).columns["is_index"].any()


def test_explicit_levels_are_sorted_and_taken_once():
    tin = ts.triangulate([[0, 0, 0], [10, 0, 0], [10, 10, 21], [0, 10, 21]])
    found = ts.contours(tin, levels=[7, 3, 7.0, 5], index=2)
    assert found.columns["elevation"].tolist() == [3, 5, 7]
    assert found.columns["is_index"].tolist() == [True, False, True]


def test_levels_outside_the_surface_are_told():
    tin = ts.triangulate([[0, 0, 0], [10, 0, 0], [10, 10, 20], [0, 10, 20]])
    found = ts.contours(tin, levels=[-5, 0, 10, 25])
    assert found.columns["elevation"].tolist() == [10]
    assert "3 of 4 levels lie outside" in found.notes[-1]
    empty = ts.contours(tin, interval=100, base=50)
    assert len(empty) == 0
    assert "there is no line" in empty.notes[-1]


def test_units_are_those_of_the_tin():
    points = [[0, 0, 0], [100, 0, 0], [100, 100, 9], [0, 100, 9]]
    found = ts.contours(ts.triangulate(points, crs="EPSG:2274", elevation_unit="m"), interval=4)
    assert found.units["elevation"].symbol == "m"
    assert found.units["length"].symbol == "US ft"
    assert ts.contours(ts.triangulate(points), interval=4).units["length"] is None


def test_lengths_in_degrees_are_metres_on_the_ellipsoid():
    points = [[-84, 36, 0], [-83.99, 36, 9], [-83.99, 36.01, 9], [-84, 36.01, 0]]
    found = ts.contours(ts.triangulate(points, crs="EPSG:4326"), levels=[5])
    assert found.units["length"].symbol == "m"
    assert found.columns["length"] == pytest.approx([1109.5], abs=0.5)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"interval": 0}, "Invalid interval 0: it must be a finite number > 0."),
        ({"interval": -1.5}, "Invalid interval -1.5: it must be a finite number > 0."),
        ({"interval": math.nan}, "Invalid interval nan: it must be a finite number > 0."),
        ({"interval": "1"}, "Invalid interval '1': it must be a finite number > 0."),
        ({"interval": 1e-5}, "at most 100,000 levels, and here there would be 2,000,001"),
        (
            {"levels": np.arange(1e6)},
            "Invalid number of levels 1000000: it must be at most 100,000",
        ),
        ({"levels": []}, "a list of one or more numbers"),
        ({"levels": [1, math.inf]}, "Invalid levels inf: it must be finite."),
        ({"levels": ["a"]}, "it must be numbers"),
        ({}, "Invalid interval and levels 'neither': it must be one of the two."),
        ({"interval": 1, "levels": [1]}, "'both': it must be one of the two."),
        ({"interval": 1, "base": math.nan}, "Invalid base nan: it must be a finite number."),
        ({"interval": 1, "index": 0}, "Invalid index 0: it must be a whole number >= 1, or None"),
        (
            {"interval": 1, "index": 2.5},
            "Invalid index 2.5: it must be a whole number >= 1, or None",
        ),
    ],
)
def test_options_that_are_none_are_refused_in_a_sentence(options, sentence):
    tin = ts.triangulate([[0, 0, 0], [10, 0, 0], [10, 10, 20], [0, 10, 20]])
    with pytest.raises(ts.OptionError) as refused:
        ts.contours(tin, **options)
    assert sentence in str(refused.value)


def chequerboard(side):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
    return ts.triangulate(np.column_stack([x, y, (x + y) % 2]))


@pytest.mark.parametrize(
    ("trace", "count", "what"),
    [
        (ts.contours, 2 * 199 * 199 * 30_000, "crossings of triangles"),
        (ts.contour_bands, 2 * 199 * 199 * 30_001, "parts of triangles"),
    ],
)
def test_more_crossings_than_can_be_numbered_are_refused(trace, count, what):
    """Every triangle is crossed by every level; memory for the lines is never asked for."""
    tin = chequerboard(200)
    step = 1 / 30_000
    most = f"at most 2,147,483,647 {what}, and here there would be {count:,}."
    with pytest.raises(ts.OptionError) as refused:
        trace(tin, levels=(np.arange(30_000) + 0.5) * step)
    sentence = f"Invalid number of levels 30000: it must be so small that there are {most}"
    assert str(refused.value) == sentence
    with pytest.raises(ts.OptionError, match=r"^Invalid interval .*: it must be so large"):
        trace(tin, interval=step)


def test_as_many_crossings_as_can_be_numbered_are_counted_exactly():
    """One level beyond the last that fits; 2**31 - 1 is a prime, so none fits exactly."""
    triangles = len(chequerboard(200).triangles)
    beyond = (2**31 - 1) // triangles + 1
    with pytest.raises(ts.OptionError, match=f"here there would be {beyond * triangles:,}"):
        ts.contours(chequerboard(200), levels=(np.arange(beyond) + 0.5) / beyond)


def test_an_interval_below_the_resolution_of_elevations_is_refused():
    z = 1e6 + np.array([0, 0, 1e-9, 1e-9])
    tin = ts.triangulate(np.column_stack([SQUARE, z]))
    with pytest.raises(ts.OptionError, match="so large that elevations here can differ by it"):
        ts.contours(tin, interval=1e-13)


def test_huge_elevations_do_not_overflow():
    tin = ts.triangulate([[0, 0, -1e300], [2, 0, 1e300], [2, 2, 1e300], [0, 2, -1e300]])
    (line,) = lines_of(ts.contours(tin, levels=[0.0]))
    assert line[:, 0] == pytest.approx(1.0)
