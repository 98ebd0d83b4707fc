"""Mesh files of tests: what a text says, and whether a mesh comes back."""

from __future__ import annotations

import numpy as np

import tinsmith as ts


def read_text(path, text):
    """Write a text to a file and read that."""
    path.write_text(text)
    return ts.read(path)


def write_and_read(tin, path):
    """Write a TIN and read the file, which must have the same mesh."""
    back = ts.read(ts.write(tin, path))
    assert_same_mesh(back, tin)
    return back


def assert_same_mesh(found, wanted):
    """Require the same points and triangles, in the same order."""
    assert np.array_equal(found.points, wanted.points)
    assert np.array_equal(found.triangles, wanted.triangles)
