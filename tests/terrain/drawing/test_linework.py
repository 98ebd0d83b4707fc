"""Lines in pictures: every edge once, of the right kind, where it is."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import tinsmith as ts
from tinsmith.terrain import preview
from tinsmith.terrain.drawing.linework import EDGE_KINDS, cut_into_dashes, find_line_edges

SIDE = 100.0


def ground(relief=0.0):
    xs = np.linspace(0.0, SIDE, 11)
    x, y = (part.ravel() for part in np.meshgrid(xs, xs))
    return np.column_stack([x, y, 10.0 + relief * x / SIDE])


def lined(**lines):
    return ts.triangulate(ground(), crs="EPSG:32616", **lines)


def kinds_by_edge(tin, **options):
    found = find_line_edges(tin, **options)
    assert len(found.pairs) == len(found.kinds)
    return {
        frozenset(map(tuple, tin.points[pair, :2].tolist())): EDGE_KINDS[kind]
        for pair, kind in zip(found.pairs, found.kinds, strict=True)
    }


def steps(*corners):
    places = [tuple(map(float, corner)) for corner in corners]
    return [frozenset(pair) for pair in pairwise(places)]


def test_edges_have_the_kind_of_their_line():
    tin = lined(
        breaklines=[
            ts.Breakline([[0, 10, 10], [10, 10, 10], [20, 10, 10]]),
            ts.Breakline([[0, 20, 10], [10, 20, 10]], kind="soft"),
        ],
        water=[ts.Water([[50, 50], [60, 50], [60, 60], [50, 60]], 10.0)],
    )
    expected = dict.fromkeys(steps((0, 10), (10, 10), (20, 10)), "hard")
    expected |= dict.fromkeys(steps((0, 20), (10, 20)), "soft")
    expected |= dict.fromkeys(steps((50, 50), (60, 50), (60, 60), (50, 60), (50, 50)), "water")
    assert kinds_by_edge(tin) == expected


@pytest.mark.parametrize("first", ["hard", "soft"])
def test_a_shared_edge_is_drawn_once_as_the_stronger_kind(first):
    other = {"hard": "soft", "soft": "hard"}[first]
    coords = [[10, 10, 10], [20, 10, 10]]
    tin = lined(breaklines=[ts.Breakline(coords, kind=kind) for kind in (first, other)])
    assert kinds_by_edge(tin) == dict.fromkeys(steps((10, 10), (20, 10)), "hard")


def test_edges_of_a_tin_from_a_file_are_hard_inside_and_boundary_on_the_rim():
    built = lined(breaklines=[ts.Breakline([[10, 10, 10], [20, 10, 10]])])
    flags = built.constrained.copy()
    rim = np.argwhere(built.neighbors < 0)[0]
    flags[tuple(rim)] = True
    tin = ts.TIN.from_triangles(built.points, built.triangles, constrained=flags)
    found = kinds_by_edge(tin)
    ends = tin.triangles[rim[0], [(rim[1] + 1) % 3, (rim[1] + 2) % 3]]
    assert found == {
        steps((10, 10), (20, 10))[0]: "hard",
        frozenset(map(tuple, tin.points[ends, :2].tolist())): "boundary",
    }
    assert kinds_by_edge(tin, guess=False) == {}


def test_without_lines_there_are_none():
    assert kinds_by_edge(lined()) == {}


def test_dashes_are_as_long_as_their_gaps_and_run_on_round_corners():
    ends = np.array([[[0, 0, 0], [25, 0, 0]], [[25, 0, 0], [25, 15, 0]]], float)
    cut = cut_into_dashes(ends, np.array([[0, 1], [1, 2]], np.int32), 10.0)
    lengths = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1)
    assert lengths == pytest.approx([10, 5, 5])  # 0-10, 20-25 and on round the corner to 30
    assert cut[1].tolist() == [[20, 0, 0], [25, 0, 0]]
    assert cut[2].tolist() == [[25, 0, 0], [25, 5, 0]]
    begun_anew = cut_into_dashes(ends, np.array([[0, 1], [3, 2]], np.int32), 10.0)
    assert begun_anew[2].tolist() == [[25, 0, 0], [25, 10, 0]]


@pytest.mark.parametrize("length", [0.3, 1.0, 7.0, 1000.0])
def test_dashes_agree_with_a_walk_in_small_steps(length):
    rng = np.random.default_rng(5)
    places = np.cumsum(rng.uniform(0.5, 9.0, (12, 3)), axis=0)
    ends = np.stack([places[:-1], places[1:]], axis=1)
    pairs = np.stack([np.arange(11), np.arange(1, 12)], axis=1).astype(np.int32)
    drawn = np.linalg.norm(
        np.diff(cut_into_dashes(ends, pairs, length), axis=1)[:, 0], axis=1
    ).sum()
    total = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    walk = (np.arange(200_000) + 0.5) * total / 200_000
    assert drawn == pytest.approx(np.mean(walk // length % 2 == 0) * total, rel=1e-3, abs=1e-2)


# ------------------------------------------------------------------------- pictures


def drawn(tin, path, **options):
    preview(tin, output=path, size=(500, 400), view="top", **options)
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def changed(tin, tmp_path):
    """Return the colours that lines put in place of others, and where, in rows and columns."""
    bare = drawn(tin, tmp_path / "a.png", lines=False)
    with_lines = drawn(tin, tmp_path / "b.png")
    where = np.abs(bare - with_lines).sum(axis=2) > 60
    return with_lines[where], np.argwhere(where)


@pytest.mark.parametrize(
    ("lines", "is_color"),
    [
        ({"breaklines": [ts.Breakline([[10, 50, 10], [90, 50, 10]])]}, "dark"),
        ({"water": [ts.Water([[20, 20], [80, 20], [80, 80], [20, 80]], 10.0)]}, "blue"),
        ({"holes": [[[20, 20], [80, 20], [80, 80], [20, 80]]]}, "brown"),
        ({"boundary": [[[20, 20], [80, 20], [80, 80], [20, 80]]]}, "brown"),
    ],
)
def test_each_kind_has_its_colour(tmp_path, can_draw, lines, is_color):
    colors, _ = changed(lined(**lines), tmp_path)
    assert len(colors) > 100
    red, green, blue = np.median(colors, axis=0)
    seen = "brown" if red > green + 20 else "blue" if blue > red + 20 else "dark"
    assert seen == is_color


def test_a_line_is_drawn_where_it_is_and_a_soft_one_has_gaps(tmp_path, can_draw):
    coords = [[10, 50, 10], [90, 50, 10]]
    _, hard = changed(lined(breaklines=[ts.Breakline(coords)]), tmp_path)
    _, soft = changed(lined(breaklines=[ts.Breakline(coords, kind="soft")]), tmp_path)
    assert np.ptp(hard[:, 0]) <= 3
    assert len(np.unique(hard[:, 1])) == np.ptp(hard[:, 1]) + 1
    assert np.ptp(soft[:, 1]) == pytest.approx(np.ptp(hard[:, 1]), abs=6)
    assert len(np.unique(soft[:, 1])) < 0.9 * len(np.unique(hard[:, 1]))


@pytest.mark.parametrize(("y", "is_seen"), [(10.0, True), (90.0, False)])
def test_a_hill_hides_the_lines_behind_it(tmp_path, can_draw, y, is_seen):
    points = ground()
    points[:, 2] += 60.0 * np.exp(-(((points[:, 1] - 50.0) / 18.0) ** 2))
    line = points[(points[:, 1] == y) & (np.abs(points[:, 0] - 50.0) <= 20.0)]
    tin = ts.triangulate(points, breaklines=[line], crs="EPSG:32616")
    pictures = []
    for lines in (True, False):
        path = tmp_path / f"{lines}.png"
        preview(tin, output=path, size=(500, 400), lines=lines, exaggeration=1)
        pictures.append(np.asarray(Image.open(path)).astype(int))
    count = np.count_nonzero(np.abs(pictures[0] - pictures[1]).sum(axis=2) > 60)
    assert (count > 50) if is_seen else (count == 0)


def test_lines_are_the_same_picture_every_time(tmp_path, can_draw):
    tin = lined(breaklines=[ts.Breakline([[10, 50], [90, 53]], kind="soft")])
    for name in ("a.png", "b.png"):
        preview(tin, output=tmp_path / name, size=(400, 300))
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
