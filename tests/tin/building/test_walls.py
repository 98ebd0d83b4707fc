"""Walls: breaklines along one line with two elevations, put a stated distance apart."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tinsmith as ts

UTM = np.array([500_000.0, 4_000_000.0])
WALL = [[50, 0], [50, 40], [50, 100]]
SIZE = 100.0


def make_ground(west=10.0, east=5.0, *, origin=(0.0, 0.0), count=200, seed=1):
    """Return points of two level grounds, no nearer to their border at 50 than 2."""
    xy = np.random.default_rng(seed).uniform(0, SIZE, (count, 2))
    xy = xy[np.abs(xy[:, 0] - 50.0) > 2.0]
    xy = np.vstack([xy, [[0, 0], [SIZE, 0], [SIZE, SIZE], [0, SIZE]]])
    return np.column_stack([xy + origin, np.where(xy[:, 0] < 50.0, west, east)])


def make_line(z, path=WALL, origin=(0.0, 0.0)):
    return np.column_stack([np.add(path, origin), np.broadcast_to(z, len(path))])


def build(*lines, ground=None, walls=0.01, **more):
    return ts.triangulate(make_ground() if ground is None else ground, breaklines=lines,
                          walls=walls, **more)  # fmt: skip


def find_chains(tin):
    lines = tin.lines
    return {
        name: tin.points[chain] for chain, name in zip(lines.chains(), lines.names, strict=True)
    }


def find_note(tin):
    (note,) = [one for one in tin.report.notes if "wall" in one]
    return note


def measure_exactly(place, start, end):
    """Return the squared distance of a place from a segment."""
    px, py, ax, ay, bx, by = (Fraction(float(v)) for v in (*place[:2], *start[:2], *end[:2]))
    way = bx - ax, by - ay
    square = way[0] ** 2 + way[1] ** 2
    share = ((px - ax) * way[0] + (py - ay) * way[1]) / square
    share = min(max(share, Fraction(0)), Fraction(1))
    return (px - ax - share * way[0]) ** 2 + (py - ay - share * way[1]) ** 2


# ---------------------------------------------------------------- what is made


@pytest.mark.parametrize("origin", [np.zeros(2), UTM], ids=["small", "UTM"])
@pytest.mark.parametrize("walls", [0.001, 0.25])
@pytest.mark.parametrize("is_first", [True, False], ids=["top first", "foot first"])
def test_volume_section_and_contours_are_right_to_the_distance(origin, walls, is_first):
    pair = [
        ts.Breakline(make_line(10.0, origin=origin), name="top"),
        ts.Breakline(make_line(5.0, WALL[::-1], origin), name="foot"),
    ]
    ground = make_ground(origin=origin)
    tin = build(*(pair if is_first else pair[::-1]), ground=ground, walls=walls)
    assert ts.check(tin).ok
    lines = find_chains(tin)
    assert lines["top"].tolist() == pair[0].coords.tolist()
    shifted = np.array(WALL[::-1]) + np.array([walls, 0.0])
    assert lines["foot"][:, :2] - origin == pytest.approx(shifted, abs=2e-8)
    assert (lines["foot"][:, 2] == 5.0).all()
    assert "was moved by" in find_note(tin)
    assert "'foot' lies to the right of" in find_note(tin)
    # Two blocks, and a face as wide as the distance.
    wanted = 5.0 * SIZE * 50.0 + 0.5 * 5.0 * walls * SIZE
    assert ts.volume(tin, base=5.0)["cut"][0] == pytest.approx(wanted, abs=1e-3)
    away = np.array([-1e-6, walls + 1e-6, walls / 2.0, -40.0, 40.0])
    places = np.column_stack([50.0 + away, np.full(5, 33.0)]) + origin
    assert tin.interpolate(places) == pytest.approx([10.0, 5.0, 7.5, 10.0, 5.0], abs=1e-4)
    contours = ts.contours(tin, levels=[5.5, 7.0, 9.5])
    x = contours.coordinates[:, 0] - origin[0]
    assert len(contours) == 3
    assert x.min() >= 50.0
    assert x.max() <= 50.0 + walls + 1e-8
    assert any("wall" in note for note in contours.notes)


def test_without_walls_the_elevation_of_the_first_line_counts_and_is_told():
    tin = build(make_line(10.0), make_line(5.0), walls=None)
    assert not any("wall" in note for note in tin.report.notes)
    assert len(tin.report.overruled.vertices) == 3
    assert tin.interpolate([[50, 40]]) == pytest.approx([10.0])


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.integers(2, 30), st.integers(-9, 9)), min_size=1, max_size=6),
    st.sampled_from([0.001, 0.01, 0.05]),
    st.booleans(),
)
def test_no_vertex_is_nearer_than_the_distance_in_exact_numbers(steps, walls, is_left_high):
    path = np.vstack([[0, 0], np.cumsum(np.array(steps, float) / 1.7, axis=0)]) + UTM
    span = path.max(axis=0) - path.min(axis=0) + 60.0
    rng = np.random.default_rng(len(steps))
    xy = path.min(axis=0) - 30.0 + rng.uniform(0, 1, (300, 2)) * span
    nearest = np.interp(xy[:, 0], path[:, 0], path[:, 1])
    xy = xy[np.abs(xy[:, 1] - nearest) > 1.0]
    is_left = xy[:, 1] > np.interp(xy[:, 0], path[:, 0], path[:, 1])
    ground = np.column_stack([xy, np.where(is_left == is_left_high, 9.0, 3.0)])
    top = ts.Breakline(np.column_stack([path, np.full(len(path), 9.0)]), name="top")
    foot = ts.Breakline(np.column_stack([path, np.full(len(path), 3.0)]), name="foot")
    tin = ts.triangulate(ground, breaklines=[foot, top], walls=walls)
    lines = find_chains(tin)
    assert lines["top"][:, :2].tolist() == path.tolist()
    moved, least, most = (
        lines["foot"],
        Fraction(walls) ** 2,
        (Fraction(walls) + Fraction(1e-7)) ** 2,
    )
    for k, place in enumerate(moved):
        found = min(measure_exactly(place, path[j], path[j + 1]) for j in range(len(path) - 1))
        assert least <= found
        if k in (0, len(moved) - 1):
            assert found <= most
    where = "right" if is_left_high else "left"
    assert f"'foot' lies to the {where} of" in find_note(tin)


def test_a_wall_that_ends_in_the_ground_closes_there():
    ends = [8.0, 10.0, 10.0, 8.0], [8.0, 5.0, 5.0, 8.0]
    path = [[50, 10], [50, 30], [50, 60], [50, 90]]
    upper, lower = (ts.Breakline(make_line(z, path), name=n)
                    for z, n in zip(ends, ("top", "foot"), strict=True))  # fmt: skip
    lines = find_chains(build(upper, lower))
    assert lines["foot"][[0, 3]].tolist() == lines["top"][[0, 3]].tolist()
    assert lines["foot"][[1, 2], 0] == pytest.approx([50.01, 50.01])


@pytest.mark.parametrize("shift", [0, 2])
@pytest.mark.parametrize("is_basin", [True, False], ids=["basin", "platform"])
def test_a_ring_is_a_wall_all_around(shift, is_basin):
    ring = np.array([[30, 30], [70, 30], [70, 70], [30, 70]], float)
    other = np.roll(ring, shift, axis=0)[::-1]
    xy = np.random.default_rng(4).uniform(0, SIZE, (400, 2))
    inside = (np.abs(xy - 50.0) < 20.0).all(axis=1)
    far = (np.abs(np.abs(xy - 50.0).max(axis=1) - 20.0)) > 1.0
    z = np.where(inside == is_basin, 3.0, 9.0)
    lines = [
        ts.Breakline(make_line(9.0, [*ring, ring[0]]), name="top"),
        ts.Breakline(make_line(3.0, [*other, other[0]]), name="foot"),
    ]
    tin = ts.triangulate(np.column_stack([xy, z])[far], breaklines=lines, walls=0.5)
    assert ts.check(tin).ok
    foot = find_chains(tin)["foot"]
    half = 19.5 if is_basin else 20.5
    assert np.abs(foot[:, :2] - 50.0) == pytest.approx(np.full((5, 2), half))
    assert tin.interpolate([[50, 50]]) == pytest.approx([3.0 if is_basin else 9.0])


def test_kinds_names_and_other_lines_stay():
    other = ts.Breakline([[10, 10, 10], [20, 80, 10]], name="path", kind="soft")
    top = ts.Breakline(make_line(10.0), name="top", kind="soft")
    foot = ts.Breakline(make_line(5.0), name="foot", priority=3)
    tin = build(other, top, foot)
    assert dict(zip(tin.lines.names, tin.lines.kinds, strict=True)) == {
        "path": "soft", "top": "soft", "foot": "hard",
    }  # fmt: skip


def test_points_on_the_face_are_told():
    ground = np.vstack([make_ground(), [[50.2, 20, 6.0], [50.1, 60, 7.0], [50.6, 60, 5.0]]])
    tin = build(make_line(10.0), make_line(5.0), ground=ground, walls=0.5)
    assert any(note.startswith("2 points within that distance") for note in tin.report.notes)
    assert tin.interpolate([[50.2, 20]]) == pytest.approx([6.0])


def test_ground_that_is_lower_on_the_upper_side_for_a_part_is_told():
    ground = make_ground()
    is_south = (ground[:, 0] < 50) & (ground[:, 1] < 12)
    ground[is_south, 2] = 4.0
    note = find_note(build(make_line(10.0), make_line(5.0), ground=ground))
    assert "where it is so along" in note


def test_lines_without_a_second_elevation_are_told():
    tin = build(make_line(10.0), make_line(10.0))
    assert find_note(tin).startswith("There are no walls")


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("lines", "options", "error", "sentence"),
    [
        ([10.0, 5.0], {"walls": 0.0}, ts.OptionError, "walls"),
        ([10.0, 5.0], {"walls": -1.0}, ts.OptionError, "walls"),
        ([10.0, 5.0], {"walls": np.nan}, ts.OptionError, "walls"),
        ([10.0, 5.0], {"walls": "wide"}, ts.OptionError, "walls"),
        ([10.0, 5.0], {"walls": 1e-12}, ts.OptionError, "below which coordinates are rounded"),
        ([10.0, 5.0], {"snap": 0.5}, ts.OptionError, "above 0.5, the distance of `snap`"),
        ([10.0, 5.0, 7.0], {}, ts.LinesError, "3 breaklines with different elevations"),
        ([10.0, [9.0, 10.0, 11.0]], {}, ts.LinesError, "cross, .*an upper and a lower one"),
    ],
)
def test_what_is_no_wall_is_refused(lines, options, error, sentence):
    with pytest.raises(error, match=sentence):
        build(*(make_line(z) for z in lines), **{"walls": 0.01, **options})


def test_ground_that_does_not_tell_the_side_is_refused():
    ground = make_ground(west=5.0, east=5.0)
    with pytest.raises(ts.LinesError, match="on which side of the wall along breakline 0"):
        build(make_line(10.0), make_line(5.0), ground=ground)
    few = [[0.0, 0.0, 5.0], [SIZE, 0.0, 5.0]]
    with pytest.raises(ts.LinesError, match="points beside it are needed"):
        build(make_line(10.0), make_line(5.0), ground=few)


def test_a_distance_in_degrees_is_refused():
    path = [[10.5, 0], [10.5, 40], [10.5, 80]]
    with pytest.raises(ts.CrsError, match="are angles"):
        build(make_line(10.0, path), make_line(5.0, path), crs="EPSG:4326",
              ground=[[9, 0, 10], [9, 80, 10], [12, 0, 5], [12, 80, 5]])  # fmt: skip


@pytest.mark.parametrize(
    "path",
    [
        [[50, 0], [50, 90], [50.02, 80]],
        [[50, 0], [50, 90], [50.6, 90], [50.6, 85]],
        [[50, 0], [50, 50], [60, 50], [50, 50], [50, 90]],
    ],
    ids=["back", "narrow", "touches itself"],
)
def test_turns_too_sharp_for_the_distance_are_refused(path):
    with pytest.raises(ts.LinesError, match="turns too sharply"):
        build(make_line(10.0, path), make_line(5.0, path), walls=0.5)


# ---------------------------------------------------------------- files


@pytest.mark.parametrize("name", ["wall.gpkg", "wall.dxf", "wall.xml"])
def test_both_lines_are_written(tmp_path, name):
    ground = make_ground(origin=UTM)
    lines = [
        ts.Breakline(make_line(10.0, origin=UTM), name="top"),
        ts.Breakline(make_line(5.0, origin=UTM), name="foot"),
    ]
    tin = build(*lines, ground=ground, walls=0.125, crs="EPSG:25832", elevation_unit="m")
    again = ts.read(ts.write(tin, tmp_path / name))
    if not isinstance(again, ts.TIN):
        again = ts.triangulate(again)
    places = np.add([[49.9, 40], [50.0, 40], [50.125, 40], [50.0625, 40], [51, 40]], UTM)
    assert again.interpolate(places) == pytest.approx([10, 10, 5, 7.5, 5], abs=1e-6)
    found = [again.points[chain] for chain in again.lines.chains()]
    x = sorted({round(float(one[:, 0].mean() - UTM[0]), 3) for one in found if len(one) >= 3})
    assert {50.0, 50.125} <= set(x)
