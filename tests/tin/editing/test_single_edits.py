"""Edits of one vertex that the core does and logs are those that go through the session."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin import _kernel
from tinsmith.tin.editing import mesh_editor

LINES = [[[10.0, 10, 1], [40, 12, 2], [60, 40, 3]], [[20.0, 80, 1], [70, 70, 2]]]


def start(lines, duplicates):
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.random((300, 2)) * 100, rng.random(300)])
    return ts.triangulate(
        np.concatenate([points, points[:20]]) if duplicates else points, breaklines=lines
    )


def edits(rng, count, n):
    """Edits of one vertex, as plain numbers; some at places that are taken, and near lines."""
    for _ in range(count):
        name = str(rng.choice(["insert", "remove", "move", "set_elevation"]))
        vertex, z = int(rng.integers(n)), float(rng.integers(9))
        place = [float(c) for c in rng.integers(0, 101, 2)]
        n += (name == "insert") - (name == "remove")
        yield (
            name,
            {
                "insert": ([[*place, z]],),
                "remove": (vertex,),
                "move": (vertex, [*place, z]),
                "set_elevation": (vertex, z),
            }[name],
        )


def require_same(tin, other):
    assert tin == other
    np.testing.assert_array_equal(tin.vertex_of, other.vertex_of)
    assert tin.report.to_dict() == other.report.to_dict()
    assert repr([e.to_dict() for e in tin.edits]) == repr([e.to_dict() for e in other.edits])


def do_all(tin, script, look):
    for name, arguments in script:
        try:
            getattr(tin, name)(*arguments)
        except ts.TinsmithError:
            continue
        if look:
            assert len(tin.vertex_of) >= 300


@pytest.fixture
def logged(monkeypatch):
    """How many edits came from the log."""
    found = []
    take_log = mesh_editor.take_log

    def counted(edited):
        for edit in take_log(edited):
            found.append(edit)
            yield edit

    monkeypatch.setattr("tinsmith.tin.editing.mesh_editor.take_log", counted)
    return found


@pytest.mark.each_value
@pytest.mark.parametrize("duplicates", [False, True])
@pytest.mark.parametrize("lines", [[], LINES], ids=["points", "lines"])
def test_an_edit_that_is_logged_is_the_same_edit(lines, duplicates, logged):
    script = list(edits(np.random.default_rng(2), 150, 300))
    tin, watched = start(lines, duplicates), start(lines, duplicates)
    do_all(watched, script, look=True)
    assert logged == []  # between two looks there is one edit, which the session does
    do_all(tin, script, look=False)
    require_same(tin, watched)
    assert len(logged) > 100
    for one in (copy.copy(tin), pickle.loads(pickle.dumps(tin)), tin):
        one.undo(70)
        watched_before = copy.copy(watched)
        watched_before.undo(70)
        require_same(one, watched_before)
    assert ts.check(tin).ok


@pytest.mark.parametrize(
    "look",
    [
        copy.copy,
        copy.deepcopy,
        pickle.dumps,
        lambda tin: tin.edits,
        lambda tin: tin.report,
        lambda tin: tin.transform(lambda points: points),
        lambda tin: tin.undo(),
        lambda tin: tin.insert(np.array([[50.5, 50.5, 1.0]])),
        lambda tin: tin.add_breakline([[1.5, 1, 1], [5, 5.5, 5]]),
        lambda tin: ts.check(tin),
    ],
)
def test_whoever_looks_sees_what_was_only_logged(look):
    tin, other = start([], False), start([], False)
    first, second = ([3.5, 3.25, 1.0],), ([4.5, 3.25, -0.0],)
    for one in (tin, other):
        one.remove(0)
        one.insert([first[0]])
        if one is other:
            assert len(one.points) == 300
        one.insert([second[0]])
        one.move(5, [7.25, 7.5, 1.0])
        one.set_elevation(6, -0.0)
        look(one)
        one.set_elevation(7, 2.0)
    require_same(tin, other)


def test_the_log_is_not_the_callers_list():
    tin = start([], False)
    tin.remove(0)
    point = [3.5, 3.25, 1.0]
    tin.insert([point])
    point[0] = 99.0
    assert tin.edits[1].arguments == {"points": [[3.5, 3.25, 1.0]], "duplicates": "last"}


def test_what_is_refused_is_refused_in_the_same_words():
    tin, other = start([], False), start([], False)
    tin.remove(0)
    for name, arguments in [
        ("remove", (None,)),
        ("remove", (299,)),
        ("remove", (2**40,)),
        ("move", (None, None)),
        ("move", (3, [1.0, float("nan"), 2.0])),
        ("set_elevation", (3, None)),
        ("set_elevation", (299, 2.0)),
        ("insert", (None,)),
        ("insert", ([[1.0, 2.0, float("inf")]],)),
        ("insert", ([[1e-300, 2.0, 1.0]],)),
    ]:
        sentences = []
        for one in (tin, other):
            if one is other and len(other.points) == 300:
                other.remove(0)
            with pytest.raises(ts.TinsmithError) as error:
                getattr(one, name)(*arguments)
            sentences.append(str(error.value))
            assert len(one.points) == 299
            one.set_elevation(3, 1.0)  # from now on edits are logged
        assert sentences[0] == sentences[1]


def test_a_mesh_that_an_error_left_half_way_is_made_anew():
    tin = start([], False)
    tin.remove(0)
    tin.insert([[3.5, 3.25, 1.0]])

    class Broken:
        """A mesh after an error within an edit."""

        is_sound = False

        def __init__(self, edited):
            self._edited = edited

        def __getattr__(self, name):
            return getattr(self._edited, name)

    editor = tin._session._editor
    assert isinstance(editor.edited, _kernel.EditedMesh)
    editor.edited = Broken(editor.edited)
    tin.set_elevation([3], 7.0)
    assert tin._session._editor is not editor
    assert [edit.operation for edit in tin.edits] == ["remove", "insert", "set_elevation"]
    assert len(tin.points) == 300
    assert tin.points[3, 2] == 7.0
    assert ts.check(tin).ok
