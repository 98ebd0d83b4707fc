"""Edges that a triangulation would not make: constrained, they bring any triangles back."""

from __future__ import annotations

import numpy as np
import pytest
from support.surfaces import stretch_triangles

import tinsmith as ts
from tinsmith.tin import topology
from tinsmith.tin.triangulation.illegal_edges import mark_illegal_edges

LATTICE = np.column_stack([*np.indices((6, 6)).reshape(2, -1), np.arange(36)]).astype(float)


def list_triangles(tin):
    return {frozenset(corners) for corners in tin.triangles.tolist()}


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_illegal_edges_as_breaklines_bring_the_triangles_back(seed, turn):
    rng = np.random.default_rng(seed)
    scattered = np.column_stack([rng.integers(0, 60, (300, 2)), rng.random(300)]).astype(float)
    points = ts.triangulate(LATTICE if seed == 0 else scattered).points
    tin = stretch_triangles(ts.triangulate(points), (turn, 6.0 if seed else 1.0))
    marks = mark_illegal_edges(tin.triangulation)
    assert seed == 0 or marks.sum(axis=1).max() == 2, "no triangle has two of them"
    ends = np.stack(topology.ends(tin.triangles, *np.nonzero(marks)), axis=1)
    lines = [ts.Breakline(tin.points[pair], kind="soft") for pair in ends]
    assert list_triangles(ts.triangulate(tin.points, breaklines=lines)) == list_triangles(tin)
    assert (len(lines) == 0) == (list_triangles(ts.triangulate(tin.points)) == list_triangles(tin))


def test_what_is_triangulated_has_no_illegal_edges():
    assert not mark_illegal_edges(ts.triangulate(LATTICE).triangulation).any()
    line = LATTICE[[0, 35]] + [[0, 1, 0], [0, -1, 0]]
    tin = ts.triangulate(LATTICE, breaklines=[line])
    assert not mark_illegal_edges(tin.triangulation).any()
