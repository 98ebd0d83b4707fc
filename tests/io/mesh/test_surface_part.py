"""Meshes that are no surface: refused with an offer in every format, and read by it."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from click.testing import CliRunner
from support.each_value import list_seeds
from support.face_files import FACE_WRITERS, write_faces
from support.surfaces import hills

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.io.mesh.surface_part import find_surface_part

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")

SQUARE = [[0, 0, 1], [0, 1000, 2], [1000, 1000, 3], [1000, 0, 4]]
FOLDED = [*SQUARE, [80, 500, 2]]
"""A square of two triangles, and a third one beside an edge, on the side of the first."""
FOLDED_FACES = [[0, 1, 2], [0, 2, 3], [0, 1, 4]]
WALLED = [*SQUARE, [500, 1000, 900]]
WALLED_FACES = [[0, 1, 2], [0, 2, 3], [1, 2, 4]]


def turn(triangles, every=2):
    """Turn some triangles round."""
    return [one[::-1] if k % every == 0 else one for k, one in enumerate(triangles)]


@pytest.mark.parametrize("kind", FACE_WRITERS)
@pytest.mark.parametrize(
    ("points", "faces", "fault", "offer"),
    [
        (FOLDED, FOLDED_FACES, "must not overlap", "1 that overlaps others, 3.85 % of the area"),
        (WALLED, WALLED_FACES, "no area", "1 without area seen from above"),
    ],
    ids=["folded", "walled"],
)
def test_what_makes_no_surface_is_refused_with_an_offer(
    tmp_path, kind, points, faces, fault, offer
):
    path, how = write_faces(kind, points, faces, tmp_path)
    if kind == "terrain" and fault == "no area":  # which its 32,767 steps can make
        tin = ts.read(path, **how)
        assert "1 of 3 triangles (1 without area" in tin.report.notes[0]
        return
    with pytest.raises(ts.ReadError, match=fault) as caught:
        ts.read(path, **how)
    assert f"`faces='surface'` leaves out 1 of 3 triangles ({offer})" in str(caught.value)
    tin = ts.read(path, **how, faces="surface")
    assert len(tin.triangles) == 2
    assert any(f"1 of 3 triangles ({offer})" in note for note in tin.notes)
    assert not any("Triangles overlap" in note for note in tin.notes)


@pytest.mark.parametrize("kind", FACE_WRITERS)
def test_triangles_of_either_direction_are_read_in_every_format(tmp_path, kind):
    points = [*SQUARE, [400, 600, 9]]
    faces = turn([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    path, how = write_faces(kind, points, faces, tmp_path)
    tin = ts.read(path, **how)
    assert len(tin.triangles) == 4
    assert ts.check(tin, level=2).ok
    assert not any("Left out" in note for note in tin.notes)


@pytest.mark.parametrize("kind", FACE_WRITERS)
def test_triangles_that_overlap_elsewhere_are_told_with_the_offer(tmp_path, kind):
    points = [[0, 0, 1], [400, 0, 1], [0, 400, 1], [100, 100, 5], [500, 100, 5], [100, 500, 6]]
    path, how = write_faces(kind, points, [[0, 1, 2], [3, 4, 5]], tmp_path)
    tin = ts.read(path, **how)
    assert len(tin.triangles) == 2
    assert any("`faces='surface'` leaves out 1 of 2 triangles" in note for note in tin.notes)
    assert len(ts.read(path, **how, faces="surface").triangles) == 1


@pytest.mark.parametrize("kind", FACE_WRITERS)
def test_few_triangles_that_make_no_surface_are_left_out_and_told(tmp_path, kind):
    path, how = write_faces(kind, [*SQUARE, [8, 500, 2]], FOLDED_FACES, tmp_path)
    tin = ts.read(path, **how)
    assert len(tin.triangles) == 2
    assert any(" 1 of 3 triangles (1 that overlaps others" in note for note in tin.notes)
    with pytest.raises(ts.ReadError, match="`faces='surface'` leaves out 1 of 3"):
        ts.read(path, **how, faces="all")


@pytest.mark.parametrize("kind", ["obj", "ply", "off", "2dm"])
def test_a_triangle_that_names_a_vertex_twice_is_refused(tmp_path, kind):
    path, how = write_faces(kind, SQUARE, [[0, 1, 2], [0, 2, 2]], tmp_path)
    with pytest.raises(ts.ReadError, match="`faces='surface'` leaves out 1 of 2"):
        ts.read(path, **how)


def test_the_command_line_offers_its_flag(tmp_path):
    path, _ = write_faces("obj", FOLDED, FOLDED_FACES, tmp_path)
    done = CliRunner().invoke(main, ["info", str(path)])
    assert done.exit_code == 1
    assert "--faces 'surface' leaves out 1 of 3 triangles" in done.output
    done = CliRunner().invoke(main, ["info", str(path), "--faces", "surface"])
    assert done.exit_code == 0
    assert "Left out to make a surface: 1 of 3 triangles" in done.output


def test_another_word_for_faces_is_refused(tmp_path):
    path, _ = write_faces("obj", SQUARE, [[0, 1, 2]], tmp_path)
    with pytest.raises(ts.OptionError, match="Invalid faces 'some'"):
        ts.read(path, faces="some")


def test_the_top_of_a_closed_solid_is_its_surface(tmp_path):
    tin = hills(60, size=300.0, unit=None)
    path = ts.write(tin, tmp_path / "a.stl", solid=True, thickness=5)
    with pytest.raises(ts.ReadError, match="`faces='surface'` leaves out"):
        ts.read(path)
    top = ts.read(path, faces="surface")
    assert len(top.triangles) == len(tin.triangles)
    z = top.points[np.unique(top.triangles), 2]
    assert np.ptp(z) == pytest.approx(np.ptp(tin.points[:, 2]), rel=1e-5)  # the base lies below


def test_a_mesh_of_another_library_is_chosen_from_likewise():
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    with pytest.raises(ts.PointsError, match="`faces='surface'` leaves out 10 of 12 triangles"):
        ts.from_mesh(box)
    top = ts.from_mesh(box, faces="surface")
    assert len(top.triangles) == 2
    assert (top.points[np.unique(top.triangles), 2] == 0.5).all()


# --------------------------------------------------------------------- by brute force


def side(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in one[:2]] for one in (a, b, c))
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def cut(polygon, a, b):
    """Clip a polygon to the left of a line: Sutherland and Hodgman, in fractions."""
    kept = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        of_p, of_q = side(a, b, p), side(a, b, q)
        if of_p >= 0:
            kept.append(p)
        if (of_p > 0 > of_q) or (of_p < 0 < of_q):
            share = of_p / (of_p - of_q)
            kept.append(tuple(u + share * (v - u) for u, v in zip(p, q, strict=True)))
    return kept


def common_area(one, other):
    """Twice the area that two counter-clockwise triangles share, exactly."""
    polygon = [tuple(map(Fraction, p[:2])) for p in one]
    for a, b in zip(other, other[1:] + other[:1], strict=True):
        polygon = cut(polygon, a, b) if polygon else []
    return sum(side(polygon[0], p, q) for p, q in itertools.pairwise(polygon[1:])) if polygon else 0


@pytest.mark.parametrize("seed", list_seeds(60, few=15))
def test_what_is_kept_is_the_largest_by_brute_force(seed):
    rng = np.random.default_rng(seed)
    size = int(rng.choice([3, 6, 40]))
    points = np.column_stack([rng.integers(0, size, (12, 2)), rng.integers(0, 4, 12)]).astype(float)
    points[:, :2] *= rng.choice([1.0, 0.1])  # tenths are no exact numbers
    triangles = rng.integers(0, 12, (14, 3))
    part = find_surface_part(points, triangles)
    corners = [points[one].tolist() for one in triangles]
    areas = [side(*one) for one in corners]
    corners = [one if area >= 0 else one[::-1] for one, area in zip(corners, areas, strict=True)]
    assert part.is_flat.tolist() == [area == 0 for area in areas]
    share = {(i, k): common_area(corners[i], corners[k])
             for i in range(14) for k in range(14) if i != k and areas[i] and areas[k]}  # fmt: skip
    kept = np.flatnonzero(part.kept).tolist()
    assert all(share[i, k] == 0 for i in kept for k in kept if i != k)
    for i in np.flatnonzero(~part.kept & ~part.is_flat).tolist():
        holders = [k for k in kept if share[i, k] > 0]
        assert any(abs(areas[k]) >= abs(areas[i]) * (1 - Fraction(1, 10**12)) for k in holders)


@pytest.mark.parametrize("seed", range(10))
def test_slivers_of_our_own_float32_come_back(tmp_path, seed):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 200, (80, 2)) + np.array([752_600, 4_024_100])
    line = np.column_stack(
        [np.linspace(752_610, 752_790, 40), np.linspace(4_024_110, 4_024_290, 40)]
    )
    line += rng.normal(0, 1e-6, line.shape)  # nearly straight: slivers thinner than float32
    points = np.vstack([xy, line])
    tin = ts.triangulate(np.column_stack([points, rng.uniform(0, 9, len(points))]))
    again = ts.read(ts.write(tin, tmp_path / "a.stl"))
    assert len(again.triangles) >= 0.9 * len(tin.triangles)
    assert again.area == pytest.approx(tin.area, rel=1e-6)
