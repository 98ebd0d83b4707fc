"""Shapes of triangles against VTK's Verdict, exact fractions, and triangles known by hand."""

from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import tinsmith as ts
from tinsmith.tin import TIN, Quality, quality

UTM = np.array([742_000.0, 4_030_000.0, 300.0])
MEASURES = ("min_angle", "max_angle", "aspect_ratio", "circumradius", "radius_edge")


def one(*corners):
    xyz = [[*corner, 0.0][:3] for corner in corners]
    return TIN.from_triangles(xyz, [[0, 1, 2]])


def rough(n=400, seed=11):
    return ts.triangulate(np.random.default_rng(seed).uniform(0, 100, (n, 3)) + UTM)


def exact(tin):
    """Squared edge lengths and area of every triangle in the plane, as fractions."""
    found = []
    for triangle in tin.triangles:
        a, b, c = ([Fraction(float(v)) for v in tin.points[vertex, :2]] for vertex in triangle)
        sides = [
            sum((p - q) ** 2 for p, q in zip(*ends, strict=True))
            for ends in ((b, c), (c, a), (a, b))
        ]
        doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        found.append((sides, doubled / 2))
    return found


# ------------------------------------------------------------------ known by hand


def test_an_equilateral_triangle_is_the_best():
    found = quality(one((0, 0), (2, 0), (1, math.sqrt(3))))
    assert found.min_angle[0] == pytest.approx(60)
    assert found.max_angle[0] == pytest.approx(60)
    assert found.aspect_ratio[0] == pytest.approx(1)
    assert found.circumradius[0] == pytest.approx(2 / math.sqrt(3))
    assert found.radius_edge[0] == pytest.approx(1 / math.sqrt(3))


def test_a_right_triangle_of_three_four_five():
    found = quality(one((0, 0), (4, 0), (0, 3)))
    np.testing.assert_array_equal(found.edge_lengths, [[5, 3, 4]])
    assert found.max_angle[0] == 90
    assert found.min_angle[0] == pytest.approx(math.degrees(math.asin(3 / 5)))
    assert found.circumradius[0] == 2.5
    assert found.radius_edge[0] == pytest.approx(2.5 / 3)
    assert found.aspect_ratio[0] == pytest.approx(5 / (2 * math.sqrt(3) * 1))


@pytest.mark.parametrize("height", [1e-3, 1e-8, 1e-12, 1e-60])
def test_a_flat_sliver_keeps_its_digits(height):
    """Legs at 1 : height; the acute angles are its arc tangent."""
    found = quality(one((0, 0), (2, 0), (1, height)))
    small = math.degrees(math.atan(height))
    assert found.min_angle[0] == pytest.approx(small, rel=1e-14)
    assert found.max_angle[0] == pytest.approx(180 - 2 * small, rel=1e-15)
    assert found.circumradius[0] == pytest.approx((1 + height**2) / (2 * height), rel=1e-14)


def test_a_needle_at_utm_coordinates_keeps_its_digits():
    """A short edge of 2^-20, seen from 1024 away: both are exact at these coordinates."""
    x, y, _ = UTM
    short = 2.0**-20
    found = quality(one((x, y), (x + 1024, y), (x + 1024, y + short)))
    assert found.min_angle[0] == pytest.approx(math.degrees(math.atan2(short, 1024)), rel=1e-14)
    assert found.max_angle[0] == 90
    assert found.radius_edge[0] == pytest.approx(math.hypot(1024, short) / 2 / short, rel=1e-14)


def test_a_needle_whose_long_edges_cancel_keeps_its_digits():
    """Twice its area is 1, the difference of products of 2^60: rounded from the far corner, 0."""
    far = 2.0**30
    found = quality(one((0, 0), (far, far - 1), (far + 1, far)))
    squares = [2, Fraction(far) ** 2 + (Fraction(far) - 1) ** 2]
    squares.append(Fraction(far) ** 2 + (Fraction(far) + 1) ** 2)
    radius = math.sqrt(math.prod(squares) / 4)
    assert found.circumradius[0] == pytest.approx(radius, rel=1e-14)
    assert found.min_angle[0] == pytest.approx(math.degrees(math.sqrt(2) / 2 / radius), rel=1e-14)


def test_an_area_that_rounds_to_nothing_is_the_worst_there_is():
    """Twice its area is 1, and its edges at every corner are about 2^30 long."""
    far = 2.0**30
    found = quality(one((0, 0), (far, far - 1), (2 * far + 1, 2 * far - 1)))
    assert found.min_angle[0] == 0
    assert found.max_angle[0] == 180
    assert found.aspect_ratio[0] == found.circumradius[0] == found.radius_edge[0] == np.inf
    assert found.summary()["aspect_ratio"]["median"] == np.inf


# ------------------------------------------------------------------ second opinions


@pytest.mark.parametrize("space", [False, True])
def test_angles_and_aspect_ratio_are_verdicts(space):
    pyvista = pytest.importorskip("pyvista")
    tin = rough()
    points = (tin.points - UTM) * [1, 1, float(space)]
    mesh = pyvista.PolyData.from_regular_faces(points, tin.triangles)
    theirs = mesh.cell_quality(["min_angle", "max_angle", "aspect_ratio"])
    mine = quality(tin, space=space)
    assert mine.space is space
    for name in ("min_angle", "max_angle", "aspect_ratio"):
        np.testing.assert_allclose(getattr(mine, name), theirs[name], rtol=1e-6)


@pytest.mark.parametrize("turn", range(3))
def test_measures_are_those_of_fractions(turn):
    tin = rough()
    tin = TIN.from_triangles(tin.points, np.roll(tin.triangles, turn, axis=1))
    mine = quality(tin)
    for row, (sides, area) in enumerate(exact(tin)):
        lengths = [math.sqrt(side) for side in sides]
        np.testing.assert_allclose(mine.edge_lengths[row], lengths, rtol=1e-14)
        radius = math.sqrt(sides[0] * sides[1] * sides[2] / (16 * area * area))
        assert mine.circumradius[row] == pytest.approx(radius, rel=1e-9)
        inradius = float(2 * area) / sum(lengths)
        aspect = max(lengths) / (2 * math.sqrt(3) * inradius)
        assert mine.aspect_ratio[row] == pytest.approx(aspect, rel=1e-9)
        smallest = math.degrees(math.asin(min(lengths) / (2 * radius)))
        assert mine.min_angle[row] == pytest.approx(smallest, rel=1e-9)


def test_level_triangles_have_the_same_shape_in_space():
    tin = rough()
    level = TIN.from_triangles(tin.points * [1, 1, 0], tin.triangles)
    plane, space = quality(level), quality(level, space=True)
    for name in MEASURES:
        np.testing.assert_allclose(getattr(space, name), getattr(plane, name), rtol=1e-12)


def test_in_space_a_steep_triangle_is_longer():
    tin = TIN.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 2]], [[0, 1, 2]])
    np.testing.assert_allclose(
        quality(tin, space=True).edge_lengths, [np.sqrt([6, 5, 1])], rtol=1e-15
    )


coordinate = st.integers(-1000, 1000)


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=3), st.integers(-40, 40))
def test_scaling_and_turning_change_no_shape(corners, power):
    (ax, ay), (bx, by), (cx, cy) = corners
    assume((bx - ax) * (cy - ay) != (by - ay) * (cx - ax))
    plain = quality(one(*corners))
    turned = quality(one(*((-y, x) for x, y in corners)))
    scaled = quality(one(*((x * 2.0**power, y * 2.0**power) for x, y in corners)))
    assert 0 < plain.min_angle[0] <= 60 + 1e-12
    assert 60 - 1e-12 <= plain.max_angle[0] < 180
    assert plain.aspect_ratio[0] >= 1 - 1e-12
    for name in ("min_angle", "max_angle", "aspect_ratio", "radius_edge"):
        assert getattr(turned, name)[0] == pytest.approx(getattr(plain, name)[0], rel=1e-12)
        assert getattr(scaled, name)[0] == getattr(plain, name)[0]
    assert scaled.circumradius[0] == plain.circumradius[0] * 2.0**power


# ------------------------------------------------------------------ summary


def test_summary_counts_and_ranks():
    """Four right triangles with legs 1 and 1, 2, 4, 8, far from each other."""
    points, triangles = [], []
    for k, leg in enumerate((1, 2, 4, 8)):
        points += [[20 * k, 0, 0], [20 * k + leg, 0, 0], [20 * k, 1, 0]]
        triangles.append([3 * k, 3 * k + 1, 3 * k + 2])
    summary = quality(TIN.from_triangles(points, triangles)).summary()
    assert summary["triangles"] == 4
    assert summary["space"] is False
    angles = [math.degrees(math.atan(1 / leg)) for leg in (1, 2, 4, 8)]
    smallest = summary["min_angle"]
    assert smallest["min"] == pytest.approx(angles[3])
    assert smallest["median"] == pytest.approx(angles[2])
    assert smallest["max"] == pytest.approx(angles[0])
    assert summary["max_angle"] == dict.fromkeys(("min", "q05", "median", "q95", "max"), 90.0)
    assert summary["edge_lengths"]["max"] == pytest.approx(math.sqrt(65))
    assert summary["shares"]["min_angle_below"] == {"1": 0, "10": 0.25, "20": 0.5, "30": 0.75}
    assert summary["shares"]["max_angle_above"] == {"90": 0, "120": 0, "150": 0}


def test_quantiles_are_values_of_triangles_by_rank():
    found = quality(rough())
    ranked = np.sort(found.aspect_ratio)
    summary = found.summary()["aspect_ratio"]
    for name, share in (("q05", 0.05), ("median", 0.5), ("q95", 0.95)):
        assert summary[name] == ranked[math.ceil(share * len(ranked)) - 1]
    assert (summary["min"], summary["max"]) == (ranked[0], ranked[-1])


def test_to_dict_is_plain_and_whole():
    found = quality(rough(50))
    again = json.loads(json.dumps(found.to_dict()))
    assert set(again) == {*MEASURES, "edge_lengths"}
    for name, values in again.items():
        np.testing.assert_array_equal(values, getattr(found, name))


def test_arrays_are_read_only_and_the_repr_is_a_line():
    found = quality(one((0, 0), (4, 0), (0, 3)))
    assert isinstance(found, Quality)
    assert len(found) == 1
    assert not any(getattr(found, name).flags.writeable for name in (*MEASURES, "edge_lengths"))
    assert (
        repr(found) == "<Quality: 1 triangle, angles 36.9 to 90 degrees, worst aspect ratio 1.44>"
    )


def test_refinement_would_be_judged_by_the_angle():
    """Circumradius over shortest edge and smallest angle say the same."""
    found = quality(rough())
    sine = np.sin(np.radians(found.min_angle))
    np.testing.assert_allclose(found.radius_edge, 0.5 / sine, rtol=1e-9)
