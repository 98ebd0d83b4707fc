"""A TIN is an ordinary value: its attributes, copies and pickles."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import tinsmith as ts

SQUARE = [[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8], [2, 1, 9]]
ARRAYS = ("points", "triangles", "neighbors", "constrained", "vertex_of")
COPIERS = (copy.copy, copy.deepcopy, lambda tin: pickle.loads(pickle.dumps(tin)))


def with_line(tin):
    tin.add_breakline([[1, 0.5, 1], [3, 3, 2]], name="kerb")


STATES = {
    "fresh": lambda tin: None,
    "asked": lambda tin: (tin.locate([[1, 1]]), tin.edges, tin.rings, tin.bounds),
    "edited": lambda tin: tin.set_elevation(0, 5.5),
    "edited and asked": lambda tin: (tin.insert([[1, 1, 1]]), tin.interpolate([[1, 1]])),
    "with a line": with_line,
}


def square():
    return ts.triangulate(SQUARE, crs="EPSG:32616")


def state(tin):
    arrays = [getattr(tin, name).tolist() for name in ARRAYS]
    return arrays, tin.lines.vertices.tolist(), tin.report.to_dict(), tin.crs, len(tin.edits)


def arrays_in(value):
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from arrays_in(part)
    elif hasattr(value, "__dict__"):
        for part in vars(value).values():
            yield from arrays_in(part)


@pytest.mark.parametrize("copied", COPIERS)
@pytest.mark.parametrize("prepare", STATES.values(), ids=STATES)
def test_a_copy_is_the_same_and_is_edited_on_its_own(prepare, copied):
    tin = square()
    prepare(tin)
    before = state(tin)
    other = copied(tin)
    assert state(other) == before
    other.insert([[3, 2, 1]])
    other.remove(0)
    assert state(tin) == before
    changed = state(other)
    tin.set_elevation(1, 77.0)
    tin.undo(len(tin.edits))
    assert state(other) == changed
    other.undo(len(other.edits))
    assert state(other) == state(square())


@pytest.mark.parametrize("copied", COPIERS)
def test_arrays_of_copies_are_read_only(copied):
    tin = square()
    with_line(tin)
    other = copied(tin)
    found = [*arrays_in(other.triangulation), *arrays_in(other.lines), *arrays_in(other.report)]
    assert len(found) > 12
    assert not any(array.flags.writeable for array in [*found, other.vertex_of, other.edges])


def test_a_pickle_holds_no_index():
    tin = ts.triangulate(np.random.default_rng(0).random((2000, 3)))
    size = len(pickle.dumps(tin))
    tin.locate([[0.5, 0.5]])
    assert len(tin.edges) > 0
    assert len(pickle.dumps(tin)) == size


def test_a_misspelt_attribute_is_refused():
    tin = square()
    with pytest.raises(AttributeError, match="trianlges"):
        tin.trianlges  # noqa: B018
    with pytest.raises(AttributeError):
        tin.trianlges = tin.triangles
    with pytest.raises(AttributeError):
        tin.triangles = tin.triangles[:1]
    assert not hasattr(tin, "__dict__")
    assert not any(hasattr(tin, name) for name in ("seal", "remember", "renew"))


def test_a_tin_that_differs_in_one_argument():
    tin = square()
    tin.set_elevation(0, 1.0)
    for other in (tin.replace(crs="EPSG:4326"), tin.snapshot().replace(crs="EPSG:4326")):
        assert other.crs == "EPSG:4326"
        np.testing.assert_array_equal(other.points, tin.points)
        assert other.edits == ()
    with pytest.raises(TypeError):
        tin.replace(trianlges=tin.triangles)
