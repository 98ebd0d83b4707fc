"""Mesh files of tests: read what a text says, and whether a mesh came back."""

from __future__ import annotations

import numpy as np

import tinsmith as ts


def read_text(path, text):
    """Write a text to a file and read that."""
    path.write_text(text)
    return ts.read(path)


def assert_same_mesh(found, wanted):
    """Require the same points and triangles, in the same order."""
    assert np.array_equal(found.points, wanted.points)
    assert np.array_equal(found.triangles, wanted.triangles)
