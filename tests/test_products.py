"""Every product begins from a snapshot of its surfaces, and has what is known of them.

A function of a surface that is public and missing here, or that forgets either, fails.
"""

import inspect
import pickle
import re
from importlib import import_module

import pytest
from support.product_calls import ALL, HILL, NOTE, PICTURES, RESULTS, make_hill

import tinsmith as ts
from tinsmith.base.products import is_product
from tinsmith.tin.surface import Surface

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case


class Live(ts.TIN):
    """A TIN that someone edits all the time: only a snapshot of it can be relied on."""

    @property
    def _current(self):
        raise AssertionError("a TIN was asked that may have been edited meanwhile")

    def snapshot(self):
        return self.__dict__["_still"]


def make_live(tin):
    live = Live.__new__(Live)
    live.__setstate__(tin.__getstate__() | {"_still": tin.snapshot()})
    return live


def list_functions_of_surfaces():
    """Return the public functions that take a surface, by the annotations of their arguments."""
    for name in ts.__all__:
        function = getattr(ts, name)
        if not inspect.isfunction(function):
            continue
        said = inspect.signature(function).parameters.values()
        if any(re.search(r"\b(TIN|Surface)\b", str(one.annotation)) for one in said):
            yield name
    yield "write"


def test_every_function_of_a_surface_is_listed_and_begins_from_a_snapshot():
    assert set(list_functions_of_surfaces()) == set(ALL)
    assert [name for name in ALL if not is_product(getattr(ts, name))] == []


@pytest.mark.parametrize("name", ALL)
def test_a_live_tin_is_asked_only_for_a_snapshot(name):
    ALL[name](make_live(HILL))


@pytest.mark.parametrize("name", RESULTS)
def test_results_have_what_is_known_of_their_surface(name):
    told = " ".join(RESULTS[name](HILL).notes)
    assert NOTE in told
    assert "looks like a blunder" in told


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_show_what_is_known_of_their_surface(name):
    words = " ".join(text.get_text() for text in PICTURES[name](HILL).texts)
    assert NOTE in words.replace("\n", " ")


def test_parts_of_a_difference_have_its_notes():
    found = ts.difference(HILL, make_hill(320.0))
    for part in (found.zones, found.zero_line):
        assert any("looks like a blunder" in note for note in part.notes)
    assert any("looks like a blunder" in note for note in found.statistics.notes)


def test_notes_of_several_surfaces_name_them():
    other = make_hill().with_source("other.csv")
    mine = make_hill().with_source("mine.csv")
    told = ts.volume(mine, other).notes
    assert {f"mine.csv: {NOTE}", f"other.csv: {NOTE}"} <= set(told)
    told = ts.volume(mine, make_hill().with_source("mine.csv")).notes
    assert {f"Surface 1 (mine.csv): {NOTE}", f"Surface 2 (mine.csv): {NOTE}"} <= set(told)


def test_notes_go_with_files_and_pickles(tmp_path):
    assert pickle.loads(pickle.dumps(HILL.snapshot())).notes == HILL.notes
    path = ts.write(HILL, tmp_path / "hill.gpkg")
    assert NOTE in ts.read(path).notes


def test_notes_are_those_of_the_surface_as_it_is_now():
    tin = make_hill()
    before = tin.snapshot()
    tin.set_elevation(213, (tin.points[212, 2] + tin.points[214, 2]) / 2)
    assert any("looks like a blunder" in note for note in before.notes)
    assert not any("looks like a blunder" in note for note in tin.notes)
    tin.undo()
    assert tin.notes == before.notes


def test_a_snapshot_has_no_edits():
    edits = vars(import_module("tinsmith.tin.editing.editable").Editable)
    public = [name for name in edits if not name.startswith("_") and name != "edits"]
    assert [name for name in public if hasattr(HILL.snapshot(), name)] == []
    assert isinstance(HILL.snapshot(), Surface)
    assert HILL.snapshot() == HILL
