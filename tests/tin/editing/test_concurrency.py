"""Several threads read and edit one TIN; under ThreadSanitizer these show races in the core."""

from __future__ import annotations

import copy
import pickle
import threading

import numpy as np
import pytest

import tinsmith as ts

READERS, EDITORS = 2, 3
GRID = np.stack(np.meshgrid(np.arange(12.0), np.arange(12.0)), axis=-1).reshape(-1, 2)
LINE = [[2.5, 2.5, 1.0], [8.5, 3.5, 2.0], [8.5, 9.5, 3.0]]


REFUSALS = ("There is no vertex", "goes with them", "would vanish with the vertex")
"""What an edit may say that comes after those of other threads."""


def survey(seed):
    rng = np.random.default_rng(seed)
    return np.column_stack([GRID + rng.uniform(-0.3, 0.3, GRID.shape), rng.random(len(GRID))])


def run_together(*tasks):
    """Run tasks in a thread each; raise what one of them raises."""
    failures = []

    def guarded(task):
        try:
            task()
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=guarded, args=(task,)) for task in tasks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]


def edit(tin, seed, count):
    """Edit at random; only a vertex that another thread took away may fail."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        try:
            if rng.random() < 0.5:
                tin.insert([[*rng.uniform(0, 11, 2), 1.0]])
            elif rng.random() < 0.8:
                tin.remove(int(rng.integers(len(tin.points))))
            else:
                tin.move(int(rng.integers(len(tin.points))), [*rng.uniform(0, 11, 2), 5.0])
        except (ts.PointsError, ts.LinesError) as error:
            sentence = str(error)
            assert any(words in sentence for words in REFUSALS), sentence


def require_sound(tin):
    """The TIN is what it is built of."""
    assert ts.check(tin).ok
    assert len(tin.vertex_of) == tin.report.n_rows
    fresh = ts.triangulate(
        tin.points, breaklines=[tin.points[chain] for chain in tin.lines.chains()]
    )
    np.testing.assert_array_equal(fresh.triangles, tin.triangles)


@pytest.mark.parametrize("lines", [[], [LINE]], ids=["points", "lines"])
def test_threads_edit_one_tin(lines):
    tin = ts.triangulate(survey(0), breaklines=lines)
    run_together(*(lambda k=k: edit(tin, k, 25) for k in range(EDITORS)))
    require_sound(tin)
    assert len(tin.edits) > 25


@pytest.mark.parametrize("lines", [[], [LINE]], ids=["points", "lines"])
def test_threads_read_while_others_edit(lines):
    tin = ts.triangulate(survey(1), breaklines=lines)
    places = np.random.default_rng(2).uniform(1, 10, (200, 2))
    is_over = threading.Event()

    def write():
        try:
            edit(tin, 3, 60)
        finally:
            is_over.set()

    def read():
        while not is_over.is_set():
            surface = tin.triangulation
            assert surface.triangles.max() < len(surface.points)
            assert len(surface.neighbors) == len(surface.triangles) == len(surface.constrained)
            inside = tin.locate(places) >= 0
            assert inside.any()
            heights = tin.interpolate(places)
            assert heights[~np.isnan(heights)].max() <= 6.0
            assert tin.area > 50.0
            assert len(tin.edges) > 200

    run_together(write, *(read for _ in range(READERS)))
    require_sound(tin)


def test_threads_copy_while_others_edit():
    tin = ts.triangulate(survey(4), breaklines=[LINE])
    copies = []

    def make_copies():
        for _ in range(8):
            other = copy.copy(tin)
            other.insert([[5.25, 5.25, 9.0]])
            copies.append(pickle.loads(pickle.dumps(other)))

    run_together(lambda: edit(tin, 5, 30), make_copies)
    require_sound(tin)
    for other in copies:
        require_sound(other)
        other.undo()
        assert len(other.points) == len(np.unique(other.points[:, :2], axis=0))


def test_threads_ask_one_index():
    """A first question makes the index; all may come at once."""
    tin = ts.triangulate(survey(6))
    places = np.random.default_rng(7).uniform(0, 11, (5000, 2))
    wanted = ts.triangulate(survey(6)).interpolate(places)
    results = []
    run_together(*(lambda: results.append(tin.interpolate(places)) for _ in range(4)))
    for found in results:
        np.testing.assert_array_equal(found, wanted)


def test_threads_take_back_edits():
    tin = ts.triangulate(survey(8))
    before = tin.triangles
    for k in range(20):
        tin.insert([[*np.random.default_rng(k).uniform(0, 11, 2), 1.0]])
    run_together(*(lambda: [tin.undo() for _ in range(5)] for _ in range(4)))
    assert tin.edits == ()
    np.testing.assert_array_equal(tin.triangles, before)


def test_threads_edit_and_take_back_what_is_only_logged():
    """Edits of one vertex need no lock; whoever looks, copies or takes back waits for them."""
    tin = ts.triangulate(survey(9))
    n_before, is_over = len(tin.points), threading.Event()

    def insert(seed):
        rng = np.random.default_rng(seed)
        for _ in range(200):
            tin.insert([[*rng.uniform(0, 11, 2).tolist(), 1.0]])

    def look():
        while not is_over.is_set():
            assert len(tin.vertex_of) >= n_before
            assert len(copy.copy(tin).edits) <= 200 * EDITORS
            tin.insert(np.array([[5.0, 5.0, 1.0]]))
            tin.undo()

    def insert_all():
        try:
            run_together(*(lambda k=k: insert(k) for k in range(EDITORS)))
        finally:
            is_over.set()

    run_together(insert_all, look)
    require_sound(tin)
    assert len(tin.edits) == len(tin.vertex_of) - n_before
