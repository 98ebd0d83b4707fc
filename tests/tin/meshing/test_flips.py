"""Triangles of files that are not Delaunay: it is told where they are made so."""

from __future__ import annotations

import numpy as np
import pytest
from support.commands import run
from support.surfaces import stretch_triangles

import tinsmith as ts

RNG = np.random.default_rng(8)
CLOUD = np.column_stack([RNG.random((80, 2)) * 100, RNG.random(80)])
TOLD = "not in the Delaunay triangulation: triangles around"


@pytest.fixture
def given():
    return stretch_triangles(ts.triangulate(CLOUD), (1.0, 6.0))


@pytest.mark.parametrize(
    "change", [lambda tin: ts.refine(tin, min_angle=20), lambda tin: ts.simplify(tin, tolerance=0)]
)
def test_edges_that_are_not_kept_are_counted(change, given):
    problems = {one.kind: one for one in ts.check(given).problems}
    notes = [note for note in change(given).report.notes if TOLD in note]
    assert len(notes) == 1
    assert notes[0].startswith(f"{problems['delaunay'].count} edges of the given triangles are not")
    again = ts.triangulate(given.points)
    assert not any(TOLD in note for note in change(again).report.notes)


def test_one_edge_is_not_kept():
    corners = [[0, 0, 0], [9, 0, 0], [9, 1, 4], [0, 2, 0]]
    ways = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]]
    made = [ts.simplify(ts.TIN.from_triangles(corners, way), tolerance=0) for way in ways]
    said = [note for tin in made for note in tin.report.notes if TOLD in note]
    assert len(said) == 1
    assert said[0].startswith(
        "1 edge of the given triangles is not in the Delaunay triangulation: triangles around it"
    )


@pytest.mark.parametrize("command", [("simplify", "--tolerance", "0"), ("refine",)])
def test_the_commands_tell_it(command, given, tmp_path):
    name, *options = command
    ts.write(given, tmp_path / "given.ply")
    done = run(name, tmp_path / "given.ply", *options, "-o", tmp_path / "made.ply")
    assert TOLD in " ".join(done.stderr.split())
