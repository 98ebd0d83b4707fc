"""Rows that are changed and added to say what a plain list says."""

import numpy as np
import pytest

from tinsmith.tin.editing import row_buffer as growing
from tinsmith.tin.editing.row_buffer import GrowingRows


@pytest.mark.parametrize("many", [0, 3, 10_000])
def test_any_changes_are_those_of_a_list(many, monkeypatch):
    monkeypatch.setattr(growing, "_MANY", many)
    rng = np.random.default_rng(5)
    given = rng.random((20, 3))
    before = given.copy()
    rows, expected = GrowingRows(given), [row.copy() for row in given]
    for _ in range(300):
        what = rng.integers(4)
        if what == 0:
            more = rng.random((rng.integers(4), 3))
            rows.extend(more)
            expected += list(more)
        elif what < 3:
            place, value = int(rng.integers(len(expected))), rng.random(3)
            rows.put(place, value)
            expected[place] = value
        else:
            places = rng.integers(len(expected), size=5).tolist()
            np.testing.assert_array_equal(rows.take(places), [expected[i] for i in places])
        if rng.random() < 0.05:
            np.testing.assert_array_equal(rows.values(), expected)
    np.testing.assert_array_equal(rows.values(), expected)
    np.testing.assert_array_equal(given, before)


def test_rows_of_single_numbers():
    rows = GrowingRows(np.array([3, 1], np.int32))
    rows.extend(np.array([7], np.int32))
    assert rows.values().tolist() == [3, 1, 7]
    assert rows.values().dtype == np.int32
