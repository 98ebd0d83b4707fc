"""The figures of the structure of a checkout."""

from __future__ import annotations

import pytest

from benchmarks.structure import ROOT, count_options, measure

FILES = {
    "src/tinsmith/__init__.py": "",
    "src/tinsmith/cli/__init__.py": "from ..io.text.reading import read\n",
    "io/__init__.py": "",
    "io/text/__init__.py": "",
    "io/text/reading.py": "def read(path, crs):\n    return _parse(path, 1, 2, 3, 4)\n\n\n"
    "def _parse(path, a, b, c, d):\n    return path\n",
    "terrain/__init__.py": "from ..tin.mesh import build\n",
    "tin/__init__.py": "",
    "tin/mesh/__init__.py": "def build(self, elevation_unit):\n    pass\n",
    "tin/edits.py": "from .mesh import build\n",
}


@pytest.fixture
def checkout(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def test_figures_of_a_small_checkout(checkout):
    found = measure(checkout)
    assert sum(found.lines.values()) == sum(text.count("\n") for text in FILES.values())
    assert found.arrows["the whole"] == {("cli", "io"), ("terrain", "tin")}
    assert found.arrows["tin"] == {("tin.edits", "tin.mesh")}
    assert found.past_a_face == [("cli", "io.text.reading")]
    assert (found.functions, found.called_once) == (3, 1)
    assert found.splinters == ["io.text.reading._parse"]
    assert found.carriers == {"crs": {"io.text.reading"}, "path": {"io.text.reading"}} | {
        "elevation_unit": {"tin.mesh"}
    }
    assert found.with_path == 2


def test_a_checkout_that_does_not_run_has_no_options_and_says_why(checkout, capsys):
    assert count_options(checkout) == "-"
    assert "do not run: ImportError" in capsys.readouterr().err


def test_options_are_counted_by_an_interpreter_that_can_run_the_commands(monkeypatch):
    monkeypatch.setattr("benchmarks.structure.find_spec", lambda name: None)
    assert 0 < int(count_options(ROOT)) < 500


def test_no_figure_stands_twice(checkout):
    labels = [label for label, _ in measure(checkout).rows]
    assert len(labels) == len(set(labels))


def test_this_checkout_lists_less_than_500_options():
    assert 0 < int(count_options(ROOT)) < 500
