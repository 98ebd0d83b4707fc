"""Lines laid on a surface."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import tinsmith as ts
from tinsmith.tin.constraints import draping


def test_memory_that_nothing_was_written_to_is_not_read(monkeypatch):
    """Places of a mesh that no line uses were checked as whatever the memory held before."""

    def make(shape, dtype=float):
        made = np.empty(shape, dtype)
        if made.dtype.kind == "f":
            made.fill(np.nan)
        return made

    turns = np.linspace(0, 6, 40)
    points = np.column_stack([30 * np.cos(turns) + 50, 30 * np.sin(turns) + 50, np.zeros(40)])
    ring = points[:, :2]
    wanted = ts.triangulate(points, boundary=[ring])
    monkeypatch.setattr(draping, "np", SimpleNamespace(**vars(np) | {"empty": make}))
    found = ts.triangulate(points, boundary=[ring])
    assert (found.points == wanted.points).all()
    assert (found.triangles == wanted.triangles).all()
