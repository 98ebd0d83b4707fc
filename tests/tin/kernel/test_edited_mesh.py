"""A TIN while it is edited in the core: numbers, elevations and log are those of plain lists."""

from __future__ import annotations

import numpy as np
import pytest

from tinsmith.tin import _kernel

INSERT, REMOVE, MOVE, SET_ELEVATION = range(4)


class Plain:
    """The same, slow: a list of what each slot holds, in order rows, inserted, lines."""

    def __init__(self, points, first_line, end_of_lines):
        self.slots = [tuple(point) for point in points.tolist()]
        self.first, self.end = first_line, end_of_lines
        self.log = []

    def order(self):
        places = [*range(self.first), *range(self.end, len(self.slots))]
        places += range(self.first, self.end)
        return [slot for slot in places if self.slots[slot] is not None]

    def numbers(self):
        number = [-1] * len(self.slots)
        for vertex, slot in enumerate(self.order()):
            number[slot] = vertex
        return number

    def points(self):
        return [self.slots[slot] for slot in self.order()]


def opened(points, lines=(0, 0)):
    """A mesh that does edits of one vertex."""
    growth = _kernel.grow(points)
    edited = _kernel.EditedMesh(points, *lines)
    edited.open(growth.triangles, growth.neighbors, np.zeros(growth.triangles.shape, np.bool_))
    edited.lend()
    return edited


def require_same(edited, plain):
    assert edited.numbers().tolist() == plain.numbers()
    assert edited.points().tolist() == [list(point) for point in plain.points()]
    assert (edited.slots, edited.count) == (len(plain.slots), len(plain.points()))
    slots = np.array(plain.order(), np.int32)
    assert edited.numbers_of(slots).tolist() == list(range(len(slots)))
    assert edited.slots_of(np.arange(len(slots))).tolist() == slots.tolist()
    assert [edited.point(slot) for slot in slots.tolist()] == plain.points()


def require_fresh(edited, lines):
    """Triangles are those of a growth of the points, numbered by slot without gaps."""
    triangles, neighbors, fixed = edited.mesh.arrays()
    number = edited.numbers()
    by_slot = edited.points()[number[number >= 0]]
    growth = _kernel.grow(np.ascontiguousarray(by_slot))
    np.testing.assert_array_equal(triangles, growth.triangles)
    np.testing.assert_array_equal(neighbors, growth.neighbors)
    assert not fixed.any()


def do_something(edited, plain, rng):
    kind, vertex = int(rng.integers(4)), int(rng.integers(edited.count))
    slot, z = plain.order()[vertex], float(rng.integers(-9, 9))
    is_of_line = plain.first <= slot < plain.end
    point = [*rng.random(2).tolist(), z]
    if kind == INSERT:
        vertex, slot = edited.insert_one([point], "last"), len(plain.slots)
        plain.slots.append(tuple(point))
        assert vertex == plain.numbers()[slot]
    elif kind == REMOVE and not is_of_line:
        assert edited.remove_one(vertex)
        plain.slots[slot], point = None, [0.0, 0.0, 0.0]
    elif kind == MOVE:
        assert edited.move_one(vertex, point)
        plain.slots[slot] = tuple(point)
    elif kind == SET_ELEVATION:
        assert edited.set_elevation_of_one(vertex, z)
        point = [*plain.slots[slot][:2], z]
        plain.slots[slot] = tuple(point)
    else:
        return
    plain.log.append(([kind, vertex, slot], point))


@pytest.mark.parametrize("count", [4, 63, 64, 65, 200])
@pytest.mark.parametrize("lines", [(0, 0), (0.5, 0.8), (0.0, 0.2), (0.9, 1.0)])
def test_any_edits_are_those_of_plain_lists(count, lines):
    rng = np.random.default_rng(count)
    points = np.column_stack([rng.random((count, 2)), rng.integers(-9, 9, count)])
    first, end = (int(share * count) for share in lines)
    edited, plain = opened(points, (first, end)), Plain(points, first, end)
    before = points.copy()
    for step in range(300):
        if edited.count > 4 or step == 0:
            do_something(edited, plain, rng)
        if step % 25 == 0:
            require_same(edited, plain)
    require_same(edited, plain)
    require_fresh(edited, (first, end))
    np.testing.assert_array_equal(points, before)
    numbers, given = edited.take_log()
    assert list(zip(numbers.tolist(), given.tolist(), strict=True)) == plain.log
    assert edited.logged == 0


def test_slots_that_are_empty_from_the_beginning_have_no_number():
    points = np.random.default_rng(3).random((200, 3))
    edited = _kernel.EditedMesh(points, 0, 0)
    edited.leave_empty(np.array([0, 63, 64, 150, 199], np.int32))
    kept = np.delete(points, [0, 63, 64, 150, 199], axis=0)
    np.testing.assert_array_equal(edited.points(), kept)
    assert edited.slots_of(np.array([0, 62, 194])).tolist() == [1, 65, 198]
    assert edited.count == 195


SQUARE = np.array([[0.0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])

REFUSED = [
    ("insert_one", ([[2.0, 1.0, 3.0]], "last")),  # a vertex is there
    ("insert_one", ([[2, 1.5, 3.0]], "last")),  # not all of them floats
    ("insert_one", ([(2.0, 1.5, 3.0)], "last")),
    ("insert_one", (([2.0, 1.5, 3.0],), "last")),
    ("insert_one", ([[2.0, 1.5]], "last")),
    ("insert_one", ([[2.0, 1.5, 3.0], [1.0, 1.0, 1.0]], "last")),
    ("insert_one", ([], "last")),
    ("insert_one", ([[2.0, 1.5, 3.0]], "first")),
    ("insert_one", ([[2.0, 1.5, 3.0]], None)),
    ("insert_one", ([[2.0, float("nan"), 3.0]], "last")),
    ("insert_one", ([[float("inf"), 1.0, 3.0]], "last")),
    ("insert_one", ([[1e300, 1.0, 3.0]], "last")),
    ("insert_one", ([[1e-300, 1.0, 3.0]], "last")),
    ("insert_one", ([[2.0, 1.5, float("inf")]], "last")),
    ("remove_one", (5,)),
    ("remove_one", (-1,)),
    ("remove_one", (True,)),
    ("remove_one", (2**31,)),
    ("remove_one", (2**70,)),
    ("remove_one", ([4],)),
    ("remove_one", (None,)),
    ("move_one", (4, [4.0, 0.0, 1.0])),  # another vertex is there
    ("move_one", (4, [1.0, 1.0])),
    ("move_one", (5, [1.0, 1.0, 1.0])),
    ("move_one", (4, [1.0, float("nan"), 1.0])),
    ("move_one", (4, None)),
    ("set_elevation_of_one", (5, 1.0)),
    ("set_elevation_of_one", (4, 1)),
    ("set_elevation_of_one", (4, float("nan"))),
    ("set_elevation_of_one", ([4], 1.0)),
]


@pytest.mark.parametrize(("name", "arguments"), REFUSED)
def test_what_needs_more_is_not_done_and_nothing_is_changed(name, arguments):
    edited = opened(SQUARE)
    assert getattr(edited, name)(*arguments) in (-1, False)
    assert edited.logged == 0
    assert edited.points().tolist() == SQUARE.tolist()
    require_fresh(edited, (0, 0))


EDITS = [
    ("insert_one", ([[2.0, 1.5, 3.0]], "last"), -1),
    ("remove_one", (4,), False),
    ("move_one", (4, [1.0, 1.0, 1.0]), False),
    ("set_elevation_of_one", (4, 1.0), False),
]


@pytest.mark.parametrize(("name", "arguments", "refusal"), EDITS)
def test_nothing_is_done_while_it_is_not_lent(name, arguments, refusal):
    edited = opened(SQUARE)
    edited.take_back()
    assert getattr(edited, name)(*arguments) == refusal
    edited.lend()
    assert getattr(edited, name)(*arguments) != refusal
    assert edited.logged == 1


def test_the_last_triangle_stays():
    edited = opened(SQUARE[:4])
    assert [edited.remove_one(0) for _ in range(2)] == [True, False]
    in_line = opened(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]]))
    assert not in_line.remove_one(3)
    assert not in_line.move_one(3, [5.0, 5.0, 1.0])
    require_fresh(in_line, (0, 0))


def test_minus_zero_is_kept_in_the_log_alone():
    edited = opened(SQUARE)
    edited.insert_one([[2.0, 2.0, -0.0]], "last")
    edited.move_one(0, [-0.0, -0.0, -0.0])
    assert not np.signbit(edited.points()).any()
    assert np.signbit(edited.take_log()[1]).tolist() == [[False, False, True], [True] * 3]


def fixed_square(edge):
    growth = _kernel.grow(SQUARE)
    edited = _kernel.EditedMesh(SQUARE, 0, 0)
    edited.open(growth.triangles, growth.neighbors, np.zeros(growth.triangles.shape, np.bool_))
    edited.mesh.force(np.array([edge], np.int32))
    edited.keep_clear(1e-3)
    edited.lend()
    return edited


def test_what_comes_near_a_line_is_not_done_and_nothing_is_changed():
    edited = fixed_square([0, 4])
    before = edited.mesh.arrays()
    on, near, far = [1.0, 0.5, 1.0], [1.0, 0.5 + 1e-4, 1.0], [3.0, 1.5, 1.0]
    assert edited.insert_one([on], "last") == edited.insert_one([near], "last") == -1
    assert not edited.remove_one(4)
    assert not edited.move_one(4, far)
    assert not edited.move_one(2, near)
    assert not edited.move_one(2, on)
    assert not edited.set_elevation_of_one(4, 1.0)
    assert edited.slots == 5
    for found, wanted in zip(edited.mesh.arrays(), before, strict=True):
        np.testing.assert_array_equal(found, wanted)
    assert edited.set_elevation_of_one(2, 1.0)
    assert edited.insert_one([far], "last") == 5
    assert edited.remove_one(5)


@pytest.mark.parametrize(
    "call",
    [
        lambda: _kernel.EditedMesh(SQUARE, 3, 2),
        lambda: _kernel.EditedMesh(SQUARE, 0, 6),
        lambda: _kernel.EditedMesh(SQUARE, 0, 0).mesh,
        lambda: _kernel.EditedMesh(SQUARE, 0, 0).empty(0),
        lambda: opened(SQUARE).open(*opened(SQUARE).mesh.arrays()),
        lambda: opened(SQUARE).point(5),
        lambda: opened(SQUARE).put_elevation(-1, 0.0),
        lambda: opened(SQUARE).slots_of(np.array([5])),
        lambda: opened(SQUARE).numbers_of(np.array([-1], np.int32)),
    ],
)
def test_wrong_numbers_are_refused(call):
    with pytest.raises(
        ValueError, match=r"^(no such|vertices of lines|the mesh (must be|is) open)"
    ):
        call()


def make_grid(count):
    side = int(np.sqrt(count))
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(side * side)]).astype(float)


def make_slivers(count):
    x = np.random.default_rng(2).random(count) * 100.0
    y = np.append(x[:-1] / 3.0, 80.0)  # collinear but for rounding, and one far from the line
    return np.column_stack([x, y, np.zeros(count)])


POINTS = {
    "random": np.random.default_rng(1).random((5000, 3)) * [500.0, 500.0, 9.0],
    "grid": make_grid(2500),
    "narrow": np.random.default_rng(3).random((3000, 3)) * [9000.0, 2.0, 9.0],
    "slivers": make_slivers(600),
}


@pytest.mark.parametrize("is_shuffled", [False, True])
@pytest.mark.parametrize("points", POINTS.values(), ids=POINTS)
def test_first_edits_of_touched_triangles_lead_where_those_of_all_lead(points, is_shuffled):
    rng = np.random.default_rng(4)
    growth = _kernel.grow(points)
    triangles, neighbors = growth.triangles, growth.neighbors
    if is_shuffled:  # no order is relied upon
        order = rng.permutation(len(triangles))
        number = np.append(np.argsort(order), -1).astype(np.int32)
        triangles, neighbors = triangles[order], number[neighbors[order]]
    fixed = np.zeros(triangles.shape, np.bool_)
    both = [_kernel.EditedMesh(points, 0, 0) for _ in range(2)]
    for edited in both:
        edited.open(triangles, neighbors, fixed)
        edited.lend()
    assert both[1].mesh.slots == len(points)  # all triangles, from the beginning
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    for _ in range(60):
        kind, vertex = int(rng.integers(3)), int(rng.integers(both[0].count))
        point = [*rng.uniform(low - 0.1 * (high - low), high).tolist(), 1.0]
        if kind == INSERT:
            done = [edited.insert_one([point], "last") for edited in both]
        elif kind == REMOVE:
            done = [edited.remove_one(vertex) for edited in both]
        else:
            done = [edited.move_one(vertex, point) for edited in both]
        assert done[0] == done[1]
    one, other = (edited.mesh.arrays() for edited in both)
    for found, wanted in zip(one, other, strict=True):
        np.testing.assert_array_equal(found, wanted)
